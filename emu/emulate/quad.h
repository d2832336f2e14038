/* The operations of the emulator's binding (emu/emulate/bind.h includes this file): each row of
 * def/op.def, lane by lane.
 *
 * Where SSE2 has one or two instructions for four lanes, and compilers need more for the row's expression,
 * the operation is written with intrinsics. tests/spec/operation.c compares these with the rows. Their
 * lane-by-lane versions have the prefix each_; each_mad_f remains in use on processors without fused
 * multiply-additions.
 *
 * Inline assembly prevents two transformations of compilers: they treat minima and maxima as commutative,
 * and they do not emit instructions that baseline x86-64 lacks. */
#define sqrt_f   each_sqrt_f
#define min_f    each_min_f
#define max_f    each_max_f
#define floor_f  each_floor_f
#define mad_f    each_mad_f
#define select_f each_select_f
#define select_i each_select_i
#define round_i  each_round_i
#define trunc_i  each_trunc_i
#define dot_i    each_dot_i
#define upper_i  each_upper_i
#define min_x    each_min_x
#define high_x   each_high_x
#define scale_x  each_scale_x
#define shl_x    each_shl_x
#define ushr_x   each_ushr_x
#include "def/op.def"
#undef sqrt_f
#undef min_f
#undef max_f
#undef floor_f
#undef mad_f
#undef select_f
#undef select_i
#undef round_i
#undef trunc_i
#undef dot_i
#undef upper_i
#undef min_x
#undef high_x
#undef scale_x
#undef shl_x
#undef ushr_x
#undef OP
#undef OPK
#undef CAST

VALUES_ONLY static inline flt sqrt_f(struct env *e, flt a)
{
    (void)e;
    flt r = {_mm_sqrt_ps(a.lane)};
    return GIVE(r);
}

VALUES_ONLY static inline flt min_f(struct env *e, flt a, flt b)
{
    (void)e;
    __asm__("minps %1, %0" : "+x"(a.lane) : "x"(b.lane));
    return GIVE(a);
}

VALUES_ONLY static inline flt max_f(struct env *e, flt a, flt b)
{
    (void)e;
    __asm__("maxps %1, %0" : "+x"(a.lane) : "x"(b.lane));
    return GIVE(a);
}

/* From 2^23 on, where the conversion would overflow, numbers are whole; -0 is unchanged. */
VALUES_ONLY static inline flt floor_f(struct env *e, flt a)
{
    (void)e;
    const __m128 sign = _mm_set1_ps(-0.0f);
    __m128 toward_zero = _mm_cvtepi32_ps(_mm_cvttps_epi32(a.lane));
    __m128 above = _mm_and_ps(_mm_cmplt_ps(a.lane, toward_zero), _mm_set1_ps(1.0f));
    __m128 whole = _mm_or_ps(_mm_sub_ps(toward_zero, above), _mm_and_ps(a.lane, sign));
    __m128 has_fraction = _mm_cmplt_ps(_mm_andnot_ps(sign, a.lane), _mm_set1_ps(0x1p23f));
    flt r = {_mm_or_ps(_mm_and_ps(has_fraction, whole), _mm_andnot_ps(has_fraction, a.lane))};
    return GIVE(r);
}

VALUES_ONLY static inline flt mad_f(struct env *e, flt a, flt b, flt c)
{
    if (!e || !e->fuses)
        return each_mad_f(e, a, b, c);
    __asm__("vfmadd213ps %2, %1, %0" : "+x"(a.lane) : "x"(b.lane), "x"(c.lane));
    return GIVE(a);
}

VALUES_ONLY static inline flt select_f(struct env *e, msk mask, flt a, flt b)
{
    (void)e;
    __m128 m = (__m128)mask.lane;
    flt r = {_mm_or_ps(_mm_and_ps(m, a.lane), _mm_andnot_ps(m, b.lane))};
    return GIVE(r);
}

VALUES_ONLY static inline itg select_i(struct env *e, msk mask, itg a, itg b)
{
    (void)e;
    itg r = {(mask.lane & a.lane) | (~mask.lane & b.lane)};
    return GIVE(r);
}

VALUES_ONLY static inline itg round_i(struct env *e, flt a)
{
    (void)e;
    itg r = {(words)_mm_cvtps_epi32(a.lane)};
    return GIVE(r);
}

VALUES_ONLY static inline itg trunc_i(struct env *e, flt a)
{
    (void)e;
    itg r = {(words)_mm_cvttps_epi32(a.lane)};
    return GIVE(r);
}

VALUES_ONLY static inline itg dot_i(struct env *e, itg a, itg b)
{
    (void)e;
    itg r = {(words)_mm_madd_epi16((__m128i)a.lane, (__m128i)b.lane)};
    return GIVE(r);
}

VALUES_ONLY static inline itg upper_i(struct env *e, itg a)
{
    (void)e;
    itg r = {(words)_mm_shufflehi_epi16(_mm_shufflelo_epi16((__m128i)a.lane, 0xf5), 0xf5)};
    return GIVE(r);
}

VALUES_ONLY static inline fix min_x(struct env *e, fix a, fix b)
{
    (void)e;
    halves above = (halves)_mm_subs_epu16((__m128i)a.half, (__m128i)b.half);
    fix r = {a.half - above};
    return GIVE(r);
}

VALUES_ONLY static inline fix high_x(struct env *e, fix a, fix b)
{
    (void)e;
    fix r = {(halves)_mm_mulhi_epu16((__m128i)a.half, (__m128i)b.half)};
    return GIVE(r);
}

/* The high half of twice the product, which is rounded: its bit 15 is that before the last of the product's
 * low half. Processors with fused multiply-additions have an instruction for it. */
VALUES_ONLY static inline fix scale_x(struct env *e, fix a, fix b)
{
    fix r;
    if (e && e->fuses) {
        __asm__("pmulhrsw %1, %0" : "+x"(a.half) : "x"(b.half));
        return GIVE(a);
    }
    __m128i low = _mm_mullo_epi16((__m128i)a.half, (__m128i)b.half);
    __m128i high = _mm_mulhi_epi16((__m128i)a.half, (__m128i)b.half);
    __m128i carry = _mm_srli_epi16(_mm_add_epi16(_mm_srli_epi16(low, 14), _mm_set1_epi16(1)), 1);
    r.half = (halves)_mm_add_epi16(_mm_add_epi16(high, high), carry);
    return GIVE(r);
}

VALUES_ONLY static inline fix shl_x(struct env *e, fix a, int k)
{
    (void)e;
    fix r = {a.half << k};
    return GIVE(r);
}

VALUES_ONLY static inline fix ushr_x(struct env *e, fix a, int k)
{
    (void)e;
    fix r = {a.half >> k};
    return GIVE(r);
}
