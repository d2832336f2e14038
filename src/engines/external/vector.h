/* The beginning of every text that the external engine compiles: eight lanes as vectors of gcc and clang,
 * and the operations of def/op.def on them. No C file includes it.
 *
 * It includes no headers: the headers of intrinsics take longer to read than a routine takes to compile.
 * Operations that C defines exactly are written in C, the others with builtins. Compilers fold constants
 * with denormals, but the routine flushes denormals, so compilers must not see constant operands: floats
 * that may be constant pass through hide_f(). */

typedef float flt __attribute__((vector_size(32), may_alias));
typedef int itg __attribute__((vector_size(32), may_alias));
typedef int msk __attribute__((vector_size(32), may_alias));
typedef unsigned short fix __attribute__((vector_size(32), may_alias));
typedef unsigned word __attribute__((vector_size(32)));
typedef short halves __attribute__((vector_size(32)));
typedef short binary16 __attribute__((vector_size(16)));
typedef float flt_memory __attribute__((vector_size(32), aligned(4), may_alias));
typedef int itg_memory __attribute__((vector_size(32), aligned(4), may_alias));
typedef int int_memory __attribute__((aligned(1), may_alias));
typedef unsigned short short_memory __attribute__((may_alias));
typedef char *pointer_memory __attribute__((aligned(1), may_alias));

#define OPERATION static inline __attribute__((always_inline))

enum { WIDTH = 8 };

OPERATION flt hide_f(flt a)
{
    __asm__("" : "+x"(a));
    return a;
}

OPERATION itg all_lanes(int a)
{
    return (itg){a, a, a, a, a, a, a, a};
}

OPERATION flt literal_f(int bits)
{
    return hide_f((flt)all_lanes(bits));
}

/* The same bits as another type: TO_of_FROM. */
#define flt_of_itg(a) hide_f((flt)(a))
#define flt_of_fix(a) hide_f((flt)(a))
#define flt_of_msk(a) hide_f((flt)(a))
#define itg_of_flt(a) ((itg)(a))
#define itg_of_fix(a) ((itg)(a))
#define itg_of_msk(a) ((itg)(a))
#define fix_of_flt(a) ((fix)(a))
#define fix_of_itg(a) ((fix)(a))
#define fix_of_msk(a) ((fix)(a))
#define msk_of_flt(a) ((msk)(a))
#define msk_of_itg(a) ((msk)(a))
#define msk_of_fix(a) ((msk)(a))

/* binary32 */
OPERATION flt add_f(flt a, flt b)
{
    return a + b;
}

OPERATION flt sub_f(flt a, flt b)
{
    return a - b;
}

OPERATION flt mul_f(flt a, flt b)
{
    return a * b;
}

OPERATION flt div_f(flt a, flt b)
{
    return a / b;
}

OPERATION flt mad_f(flt a, flt b, flt c)
{
    return __builtin_ia32_vfmaddps256(a, b, c);
}

OPERATION flt sqrt_f(flt a)
{
    return __builtin_ia32_sqrtps256(a);
}

OPERATION flt min_f(flt a, flt b)
{
    return __builtin_ia32_minps256(a, b);
}

OPERATION flt max_f(flt a, flt b)
{
    return __builtin_ia32_maxps256(a, b);
}

OPERATION flt neg_f(flt a)
{
    return (flt)((word)a ^ (word)all_lanes((int)0x80000000u));
}

OPERATION flt floor_f(flt a)
{
    return __builtin_ia32_roundps256(a, 1);
}

OPERATION flt half_f(flt a)
{
    return __builtin_ia32_vcvtph2ps256((binary16)__builtin_ia32_vcvtps2ph256(a, 0));
}

OPERATION flt select_f(msk a, flt b, flt c)
{
    return __builtin_ia32_blendvps256(c, b, (flt)a);
}

OPERATION msk lt_f(flt a, flt b)
{
    return (msk)(a < b);
}

OPERATION msk le_f(flt a, flt b)
{
    return (msk)(a <= b);
}

OPERATION msk eq_f(flt a, flt b)
{
    return (msk)(a == b);
}

OPERATION msk ne_f(flt a, flt b)
{
    return (msk)(a != b);
}

/* conversions */
OPERATION itg round_i(flt a)
{
    return (itg)__builtin_ia32_cvtps2dq256(a);
}

OPERATION itg trunc_i(flt a)
{
    return (itg)__builtin_ia32_cvttps2dq256(a);
}

OPERATION flt float_f(itg a)
{
    return hide_f(__builtin_convertvector(a, flt));
}

/* 32-bit integers */
OPERATION itg add_i(itg a, itg b)
{
    return (itg)((word)a + (word)b);
}

OPERATION itg sub_i(itg a, itg b)
{
    return (itg)((word)a - (word)b);
}

OPERATION itg mul_i(itg a, itg b)
{
    return (itg)((word)a * (word)b);
}

OPERATION itg dot_i(itg a, itg b)
{
    return (itg)__builtin_ia32_pmaddwd256((halves)a, (halves)b);
}

OPERATION itg and_i(itg a, itg b)
{
    return a & b;
}

OPERATION itg or_i(itg a, itg b)
{
    return a | b;
}

OPERATION itg xor_i(itg a, itg b)
{
    return a ^ b;
}

#ifdef __clang__
#define minimum_i(a, b) __builtin_elementwise_min(a, b)
#define maximum_i(a, b) __builtin_elementwise_max(a, b)
#define minimum_x(a, b) __builtin_elementwise_min(a, b)
#else
#define minimum_i(a, b) __builtin_ia32_pminsd256(a, b)
#define maximum_i(a, b) __builtin_ia32_pmaxsd256(a, b)
#define minimum_x(a, b) __builtin_ia32_pminuw256((halves)(a), (halves)(b))
#endif

OPERATION itg min_i(itg a, itg b)
{
    return (itg)minimum_i(a, b);
}

OPERATION itg max_i(itg a, itg b)
{
    return (itg)maximum_i(a, b);
}

OPERATION msk eq_i(itg a, itg b)
{
    return (msk)(a == b);
}

OPERATION msk gt_i(itg a, itg b)
{
    return (msk)(a > b);
}

OPERATION itg select_i(msk a, itg b, itg c)
{
    return (itg)__builtin_ia32_blendvps256((flt)c, (flt)b, (flt)a);
}

OPERATION itg shl_i(itg a, int k)
{
    return (itg)((word)a << k);
}

OPERATION itg shr_i(itg a, int k)
{
    return a >> k;
}

OPERATION itg ushr_i(itg a, int k)
{
    return (itg)((word)a >> k);
}

OPERATION itg rotl_i(itg a, int k)
{
    return (itg)((word)a << k | (word)a >> (-k & 31));
}

/* pairs of 16-bit integers */
OPERATION fix add_x(fix a, fix b)
{
    return a + b;
}

OPERATION fix sub_x(fix a, fix b)
{
    return a - b;
}

OPERATION fix mul_x(fix a, fix b)
{
    return a * b;
}

OPERATION fix min_x(fix a, fix b)
{
    return (fix)minimum_x(a, b);
}

OPERATION fix shl_x(fix a, int k)
{
    return a << k;
}

OPERATION fix ushr_x(fix a, int k)
{
    return a >> k;
}

/* masks */
OPERATION msk and_m(msk a, msk b)
{
    return a & b;
}

OPERATION msk or_m(msk a, msk b)
{
    return a | b;
}

OPERATION msk andn_m(msk a, msk b)
{
    return a & ~b;
}

OPERATION int any(msk a)
{
    return __builtin_ia32_movmskps256((flt)a);
}

#define permute_f(a, k) __builtin_ia32_vpermilps256(a, k)

/* memory */
OPERATION int read_int(const char *at)
{
    return *(const int_memory *)at;
}

OPERATION int read_short(const char *at)
{
    return *(const short_memory *)at;
}

OPERATION char *read_pointer(const char *at)
{
    return *(const pointer_memory *)at;
}

OPERATION flt load_f(const char *at)
{
    return (flt) * (const flt_memory *)at;
}

OPERATION itg load_i(const char *at)
{
    return (itg) * (const itg_memory *)at;
}

OPERATION void store_f(char *at, flt a)
{
    *(flt_memory *)at = a;
}

OPERATION void store_i(char *at, itg a)
{
    *(itg_memory *)at = a;
}

OPERATION itg uniform_i(const char *at)
{
    return all_lanes(read_int(at));
}

OPERATION flt uniform_f(const char *at)
{
    return (flt)all_lanes(read_int(at));
}

#ifdef __clang__
#define gather_words __builtin_ia32_gatherd_d256
#else
#define gather_words __builtin_ia32_gathersiv8si
#endif

#define gather_i(start, index, scale)                                                                        \
    ((itg)gather_words(all_lanes(0), (const int *)(start), index, all_lanes(-1), scale))
#define gather_f(start, index, scale) ((flt)gather_i(start, index, scale))

OPERATION void scatter_i(char *at, int stride, itg a)
{
    for (int lane = 0; lane < 8; lane++)
        *(int_memory *)(at + lane * stride) = a[lane];
}

OPERATION void scatter_f(char *at, int stride, flt a)
{
    scatter_i(at, stride, (itg)a);
}
