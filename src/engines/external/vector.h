/* The beginning of every text that the external engine compiles: eight lanes as vectors of gcc and clang,
 * and the operations of def/op.def on them. No C file includes it.
 *
 * It includes no headers: the headers of intrinsics take longer to read than a routine takes to compile.
 * Operations that C defines exactly are written in C, the others with builtins. Compilers fold constants
 * with denormals, but the routine flushes denormals, so compilers must not see constant operands: floats
 * that may be constant pass through hide_f(). */

/* COMPONENTS: vectors of four components of a pixel, for external:c=pixels. Without it: of eight lanes. */
#ifdef COMPONENTS
#define BYTES     16
#define ALL(a)    {a, a, a, a}
#define BUILTIN(name) __builtin_ia32_##name
#define SIZED(four, eight) __builtin_ia32_##four
#else
#define BYTES     32
#define ALL(a)    {a, a, a, a, a, a, a, a}
#define BUILTIN(name) __builtin_ia32_##name##256
#define SIZED(four, eight) __builtin_ia32_##eight
#endif

typedef float flt __attribute__((vector_size(BYTES), may_alias));
typedef int itg __attribute__((vector_size(BYTES), may_alias));
typedef int msk __attribute__((vector_size(BYTES), may_alias));
typedef unsigned short fix __attribute__((vector_size(BYTES), may_alias));
typedef unsigned word __attribute__((vector_size(BYTES)));
typedef short halves __attribute__((vector_size(BYTES)));
typedef short binary16 __attribute__((vector_size(16)));
typedef float flt_memory __attribute__((vector_size(BYTES), aligned(4), may_alias));
typedef int itg_memory __attribute__((vector_size(BYTES), aligned(4), may_alias));
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
    return (itg)ALL(a);
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
    return BUILTIN(vfmaddps)(a, b, c);
}

OPERATION flt sqrt_f(flt a)
{
    return BUILTIN(sqrtps)(a);
}

OPERATION flt min_f(flt a, flt b)
{
    return BUILTIN(minps)(a, b);
}

OPERATION flt max_f(flt a, flt b)
{
    return BUILTIN(maxps)(a, b);
}

OPERATION flt neg_f(flt a)
{
    return (flt)((word)a ^ (word)all_lanes((int)0x80000000u));
}

OPERATION flt floor_f(flt a)
{
    return BUILTIN(roundps)(a, 1);
}

OPERATION flt half_f(flt a)
{
    return BUILTIN(vcvtph2ps)((binary16)BUILTIN(vcvtps2ph)(a, 0));
}

OPERATION flt select_f(msk a, flt b, flt c)
{
    return BUILTIN(blendvps)(c, b, (flt)a);
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
    return (itg)BUILTIN(cvtps2dq)(a);
}

OPERATION itg trunc_i(flt a)
{
    return (itg)BUILTIN(cvttps2dq)(a);
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
    return (itg)SIZED(pmaddwd128, pmaddwd256)((halves)a, (halves)b);
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
#define minimum_i(a, b) SIZED(pminsd128, pminsd256)(a, b)
#define maximum_i(a, b) SIZED(pmaxsd128, pmaxsd256)(a, b)
#define minimum_x(a, b) SIZED(pminuw128, pminuw256)((halves)(a), (halves)(b))
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
    return (itg)BUILTIN(blendvps)((flt)c, (flt)b, (flt)a);
}

OPERATION itg upper_i(itg a)
{
    return (itg)((word)a >> 16 | ((word)a & 0xffff0000u));
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

/* The compiler finds the instruction for the high halves of products. */
typedef unsigned halves_wide __attribute__((vector_size(2 * BYTES)));

OPERATION fix high_x(fix a, fix b)
{
    const halves_wide product =
        __builtin_convertvector(a, halves_wide) * __builtin_convertvector(b, halves_wide);
    return __builtin_convertvector(product >> 16, fix);
}

OPERATION fix scale_x(fix a, fix b)
{
    return (fix)SIZED(pmulhrsw128, pmulhrsw256)((halves)a, (halves)b);
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
    return BUILTIN(movmskps)((flt)a);
}

#define permute_f(a, k) BUILTIN(vpermilps)(a, k)

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
#define gather_words SIZED(gatherd_d, gatherd_d256)
#else
#define gather_words SIZED(gathersiv4si, gathersiv8si)
#endif

#define gather_i(start, index, scale)                                                                        \
    ((itg)gather_words(all_lanes(0), (const int *)(start), index, all_lanes(-1), scale))
#define gather_f(start, index, scale) ((flt)gather_i(start, index, scale))

#ifdef COMPONENTS
#define shuffle(type, a, b, ...) ((type)__builtin_shufflevector((itg)(a), (itg)(b), __VA_ARGS__))
#define words_i(a, b, c, d)      ((itg){read_int(a), read_int(b), read_int(c), read_int(d)})
#define words_f(a, b, c, d)      ((flt)words_i(a, b, c, d))

OPERATION void store_word(char *at, int a)
{
    *(int_memory *)at = a;
}

/* Returns true if a lane of a mask is set in any pixel. */
OPERATION int any_of(const itg *a, int lane)
{
    int found = 0;
    for (int i = 0; i < WIDTH; i++)
        found |= a[i][lane];
    return found;
}
#else
OPERATION void scatter_i(char *at, int stride, itg a)
{
    for (int lane = 0; lane < 8; lane++)
        *(int_memory *)(at + lane * stride) = a[lane];
}

OPERATION void scatter_f(char *at, int stride, flt a)
{
    scatter_i(at, stride, (itg)a);
}
#endif
