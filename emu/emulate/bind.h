/* The emulator's binding: a value is four lanes, an operation computes all four, and every decision of the
 * host on the state is repeated for every group of four. Nothing here depends on the key, and nothing is
 * slowed down on purpose: four lanes are one SSE2 register, which every x86-64 processor has, and
 * compilers translate most rows of def/op.def to one or two of its instructions. The other rows are in
 * emu/emulate/quad.h. */
#ifndef EMU_EMULATE_BIND_H
#define EMU_EMULATE_BIND_H

#include "contract/binding.h"
#include "contract/lane.h"

enum { EMULATE_WIDTH = 4 };

typedef float floats __attribute__((vector_size(4 * EMULATE_WIDTH)));
typedef int32_t words __attribute__((vector_size(4 * EMULATE_WIDTH)));
typedef uint16_t halves __attribute__((vector_size(4 * EMULATE_WIDTH)));

typedef struct {
    floats lane;
} flt;
typedef struct {
    words lane;
} itg;
typedef struct {
    halves half;
} fix;
typedef struct {
    words lane; /* 0 or -1 */
} msk;

union variable {
    flt f;
    itg i;
    msk m;
};

struct env {
    const uint8_t *base[BASE_COUNT];
    const struct program *program;         /* of the shader, if the key has one */
    bool fuses;                            /* the processor has fused multiply-additions */
    const struct emulate_routine *routine; /* only in the forms of the engine (emu/emulate/form.h) */
    struct machine *machine;               /* the same, with files=array */
    union variable variable[VARIABLES];
};

#ifndef GIVE
#define E e

/* The result of every operation passes through GIVE, which command/fuzz/bisect/trace.c redefines to record
 * it. */
#define GIVE(value) (value)
#endif

/* Loop bodies of def/op.def's rows: per lane for the 32-bit types, per half for pairs. */
#define LANES_flt       for (int i = 0; i < EMULATE_WIDTH; i++)
#define LANES_itg       for (int i = 0; i < EMULATE_WIDTH; i++)
#define LANES_msk       for (int i = 0; i < EMULATE_WIDTH; i++)
#define LANES_fix       for (int i = 0; i < 2 * EMULATE_WIDTH; i++)
#define PUT_flt         lane
#define PUT_itg         lane
#define PUT_msk         lane
#define PUT_fix         half
#define ARGUMENT_flt(n) , flt n##_
#define ARGUMENT_itg(n) , itg n##_
#define ARGUMENT_msk(n) , msk n##_
#define ARGUMENT_fix(n) , fix n##_
#define ARGUMENT_non(n)
#define LOAD_flt(n) float n = n##_.lane[i];
#define LOAD_itg(n) int32_t n = n##_.lane[i];
#define LOAD_msk(n) int32_t n = n##_.lane[i];
#define LOAD_fix(n) uint16_t n = n##_.half[i];
#define LOAD_non(n)

/* An operation accesses only its arguments and its result. With AddressSanitizer, the checks of these few
 * words were a quarter of the time of tests that emulate. The checks of undefined behaviour remain. */
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define VALUES_ONLY __attribute__((no_sanitize("address"), no_sanitize("thread")))
#else
#define VALUES_ONLY
#endif

#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    VALUES_ONLY static inline result name(struct env *e ARGUMENT_##ta(a) ARGUMENT_##tb(b) ARGUMENT_##tc(c))  \
    {                                                                                                        \
        (void)e;                                                                                             \
        result r;                                                                                            \
        LANES_##result                                                                                       \
        {                                                                                                    \
            LOAD_##ta(a) LOAD_##tb(b) LOAD_##tc(c) r.PUT_##result[i] = (expression);                         \
        }                                                                                                    \
        return GIVE(r);                                                                                      \
    }
#define OPK(name, result, ta, tb, tc, properties, expression)                                                \
    VALUES_ONLY static inline result name(struct env *e ARGUMENT_##ta(a), int k)                             \
    {                                                                                                        \
        (void)e;                                                                                             \
        result r;                                                                                            \
        LANES_##result                                                                                       \
        {                                                                                                    \
            LOAD_##ta(a) r.PUT_##result[i] = (expression);                                                   \
        }                                                                                                    \
        return GIVE(r);                                                                                      \
    }
#define CAST(name, result, from)                                                                             \
    VALUES_ONLY static inline result name(struct env *e, from a)                                             \
    {                                                                                                        \
        (void)e;                                                                                             \
        result r;                                                                                            \
        memcpy(&r, &a, sizeof r);                                                                            \
        return GIVE(r);                                                                                      \
    }
#include "emu/emulate/quad.h"

VALUES_ONLY static inline flt lit_f(struct env *e, float value)
{
    (void)e;
    flt r = {{value, value, value, value}};
    return GIVE(r);
}

VALUES_ONLY static inline itg lit_i(struct env *e, int32_t value)
{
    (void)e;
    itg r = {{value, value, value, value}};
    return GIVE(r);
}

VALUES_ONLY static inline msk lit_m(struct env *e, int32_t value)
{
    (void)e;
    msk r = {{value, value, value, value}};
    return GIVE(r);
}

VALUES_ONLY static inline fix lit_x(struct env *e, uint16_t value)
{
    (void)e;
    fix r = {{value, value, value, value, value, value, value, value}};
    return GIVE(r);
}

VALUES_ONLY static inline flt permute_f(struct env *e, flt a, int lanes)
{
    (void)e;
    flt r = {{a.lane[lanes & 3], a.lane[lanes >> 2 & 3], a.lane[lanes >> 4 & 3], a.lane[lanes >> 6 & 3]}};
    return GIVE(r);
}

static inline flt load_f(struct env *e, enum base base, int offset)
{
    flt r;
    memcpy(&r, e->base[base] + offset, sizeof r);
    return GIVE(r);
}

static inline itg load_i(struct env *e, enum base base, int offset)
{
    itg r;
    memcpy(&r, e->base[base] + offset, sizeof r);
    return GIVE(r);
}

static inline void store_f(struct env *e, enum base base, int offset, flt value)
{
    memcpy((uint8_t *)e->base[base] + offset, &value, sizeof value);
}

static inline void store_i(struct env *e, enum base base, int offset, itg value)
{
    memcpy((uint8_t *)e->base[base] + offset, &value, sizeof value);
}

static inline flt uniform_f(struct env *e, enum base base, int offset)
{
    float value;
    memcpy(&value, e->base[base] + offset, sizeof value);
    return lit_f(e, value);
}

static inline flt uniform_unit_f(struct env *e, enum base base, int offset)
{
    return uniform_f(e, base, offset);
}

static inline itg uniform_i(struct env *e, enum base base, int offset)
{
    int32_t value;
    memcpy(&value, e->base[base] + offset, sizeof value);
    return lit_i(e, value);
}

/* The address of a lane: start + index * scale + displacement, where start is the pointer at base + field,
 * or the base. */
static inline const uint8_t *gather_start(struct env *e, enum base base, int field)
{
    if (field == GATHER_DIRECT)
        return e->base[base];
    const uint8_t *start;
    memcpy(&start, e->base[base] + field, sizeof start);
    return start;
}

static inline int32_t word_at(const uint8_t *address)
{
    int32_t word;
    memcpy(&word, address, sizeof word);
    return word;
}

static inline itg gather(struct env *e, enum base base, int field, itg index, int scale, int displacement)
{
    const uint8_t *start = gather_start(e, base, field) + displacement;
    itg r = {{word_at(start + (ptrdiff_t)index.lane[0] * scale),
              word_at(start + (ptrdiff_t)index.lane[1] * scale),
              word_at(start + (ptrdiff_t)index.lane[2] * scale),
              word_at(start + (ptrdiff_t)index.lane[3] * scale)}};
    return r;
}

static inline itg gather_i(struct env *e, enum base base, int field, itg index, int scale, int displacement)
{
    itg r = gather(e, base, field, index, scale, displacement);
    return GIVE(r);
}

static inline flt gather_f(struct env *e, enum base base, int field, itg index, int scale, int displacement)
{
    itg words = gather(e, base, field, index, scale, displacement);
    flt r;
    memcpy(&r, &words, sizeof r);
    return GIVE(r);
}

static inline void scatter_i(struct env *e, enum base base, int offset, int stride, itg value)
{
    for (int i = 0; i < EMULATE_WIDTH; i++) {
        int32_t word = value.lane[i];
        memcpy((uint8_t *)e->base[base] + offset + i * stride, &word, sizeof word);
    }
}

static inline void scatter_f(struct env *e, enum base base, int offset, int stride, flt value)
{
    itg bits;
    memcpy(&bits, &value, sizeof bits);
    scatter_i(e, base, offset, stride, bits);
}

static inline flt get_f(struct env *e, int variable)
{
    return GIVE(e->variable[variable].f);
}

static inline itg get_i(struct env *e, int variable)
{
    return GIVE(e->variable[variable].i);
}

static inline msk get_m(struct env *e, int variable)
{
    return GIVE(e->variable[variable].m);
}

static inline void set_f(struct env *e, int variable, flt value)
{
    e->variable[variable].f = value;
}

static inline void set_i(struct env *e, int variable, itg value)
{
    e->variable[variable].i = value;
}

static inline void set_m(struct env *e, int variable, msk value)
{
    e->variable[variable].m = value;
}

static inline bool any_lane(msk mask)
{
    return _mm_movemask_ps((__m128)mask.lane) != 0;
}

/* The body runs when any lane of the mask is set. */
#define WHEN(e, mask) if (any_lane(mask))

/* The body runs once, and repeats while any lane of the variable, a mask, is set. */
#define LOOP(e, variable) for (int again_ = 1; again_; again_ = any_lane(get_m(e, variable)))

#endif
