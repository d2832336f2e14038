/* The steps of the batch interpreter: each row of def/op.def as a loop over the groups of a batch around the
 * emulator's four-lane operation; then memory, variables and control. */
#include "machine/cpu.h"
#include "emu/emulate/bind.h"
#include "emu/batch/schedule.h"

#include <immintrin.h>

_Static_assert(sizeof(flt) == GROUP_BYTES && sizeof(itg) == GROUP_BYTES && sizeof(fix) == GROUP_BYTES &&
                   sizeof(msk) == GROUP_BYTES,
               "a group is a value of the emulator");

#define ORDER_a 0
#define ORDER_b 1
#define ORDER_c 2

/* Parts of a row's step by the types of its operands: OPERAND declares the address and the stride of an
 * operand's groups, NEXT loads the next group, and PASS passes it as an argument. */
#define OPERAND(n)                                                                                           \
    const uint8_t *n##_at = batch->scratch + step->operand[ORDER_##n];                                       \
    const size_t n##_stride = step->stride[ORDER_##n];
#define OPERAND_flt(n) OPERAND(n)
#define OPERAND_itg(n) OPERAND(n)
#define OPERAND_fix(n) OPERAND(n)
#define OPERAND_msk(n) OPERAND(n)
#define OPERAND_non(n)
#define NEXT(type, n)                                                                                        \
    type n;                                                                                                  \
    memcpy(&n, n##_at, sizeof n);                                                                            \
    n##_at += n##_stride;
#define NEXT_flt(n) NEXT(flt, n)
#define NEXT_itg(n) NEXT(itg, n)
#define NEXT_fix(n) NEXT(fix, n)
#define NEXT_msk(n) NEXT(msk, n)
#define NEXT_non(n)
#define PASS_flt(n) , n
#define PASS_itg(n) , n
#define PASS_fix(n) , n
#define PASS_msk(n) , n
#define PASS_non(n)

#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    static const struct schedule_step *step_##name(struct batch *batch, const struct schedule_step *step)    \
    {                                                                                                        \
        OPERAND_##ta(a) OPERAND_##tb(b) OPERAND_##tc(c) uint8_t *to = batch->scratch + step->to;             \
        for (unsigned groups = batch->groups[step->once]; groups; groups--) {                                \
            NEXT_##ta(a) NEXT_##tb(b) NEXT_##tc(c) result r =                                                \
                name(NULL PASS_##ta(a) PASS_##tb(b) PASS_##tc(c));                                           \
            memcpy(to, &r, sizeof r);                                                                        \
            to += GROUP_BYTES;                                                                               \
        }                                                                                                    \
        return step + 1;                                                                                     \
    }
#define OPK(name, result, ta, tb, tc, properties, expression)                                                \
    static const struct schedule_step *step_##name(struct batch *batch, const struct schedule_step *step)    \
    {                                                                                                        \
        const int k = step->k;                                                                               \
        OPERAND_##ta(a) uint8_t *to = batch->scratch + step->to;                                             \
        for (unsigned groups = batch->groups[step->once]; groups; groups--) {                                \
            NEXT_##ta(a) result r = name(NULL, a, k);                                                        \
            memcpy(to, &r, sizeof r);                                                                        \
            to += GROUP_BYTES;                                                                               \
        }                                                                                                    \
        return step + 1;                                                                                     \
    }
#define CAST(name, ...)
#include "def/op.def"

/* Steps with instructions that are not in baseline x86-64. */
#define NEEDS_SSE4 __attribute__((target("sse4.1")))
#define NEEDS_FMA  __attribute__((target("fma")))

NEEDS_SSE4 static inline flt vector_floor_f(struct env *e, flt a)
{
    (void)e;
    return (flt){_mm_floor_ps(a.lane)};
}

NEEDS_FMA static inline flt vector_mad_f(struct env *e, flt a, flt b, flt c)
{
    (void)e;
    return (flt){_mm_fmadd_ps(a.lane, b.lane, c.lane)};
}

NEEDS_SSE4 OP(vector_floor_f, flt, flt, non, non, 0, )
NEEDS_FMA OP(vector_mad_f, flt, flt, flt, flt, 0, )
#undef OP
#undef OPK
#undef CAST

/* A pair as one step: the operands are the two of the first operation, then the other one of the second. The
 * product stays in a register, rounded. It is a multiplication and an addition, not a fused one. */
#define VALUE_mul_f flt
#define VALUE_mul_i itg
#define VALUE_mul_x fix
#define PAIR(first, second, position)                                                                        \
    static const struct schedule_step *step_##first##_##second##_##position(                                 \
        struct batch *batch, const struct schedule_step *step)                                               \
    {                                                                                                        \
        OPERAND(a) OPERAND(b) OPERAND(c) uint8_t *to = batch->scratch + step->to;                            \
        for (unsigned groups = batch->groups[0]; groups; groups--) {                                         \
            NEXT(VALUE_##first, a)                                                                           \
            NEXT(VALUE_##first, b) NEXT(VALUE_##first, c) VALUE_##first product = first(NULL, a, b);         \
            VALUE_##first r = (position) ? second(NULL, c, product) : second(NULL, product, c);              \
            memcpy(to, &r, sizeof r);                                                                        \
            to += GROUP_BYTES;                                                                               \
        }                                                                                                    \
        return step + 1;                                                                                     \
    }
#include "def/engine/pair.def"
#undef PAIR

static const struct schedule_step *step_permute(struct batch *batch, const struct schedule_step *step)
{
    const int k = step->k;
    OPERAND(a)
    uint8_t *to = batch->scratch + step->to;
    for (unsigned groups = batch->groups[step->once]; groups; groups--) {
        NEXT(flt, a)
        flt r = permute_f(NULL, a, k);
        memcpy(to, &r, sizeof r);
        to += GROUP_BYTES;
    }
    return step + 1;
}

static const struct schedule_step *step_load(struct batch *batch, const struct schedule_step *step)
{
    const uint8_t *const *base = batch->base[step->base];
    const ptrdiff_t offset = step->k;
    uint8_t *to = batch->scratch + step->to;
    for (unsigned groups = batch->groups[0]; groups; groups--, to += GROUP_BYTES)
        memcpy(to, *base++ + offset, GROUP_BYTES);
    return step + 1;
}

static const struct schedule_step *step_store(struct batch *batch, const struct schedule_step *step)
{
    const uint8_t *const *base = batch->base[step->base];
    const ptrdiff_t offset = step->k;
    OPERAND(a)
    for (unsigned groups = batch->groups[0]; groups; groups--, a_at += a_stride)
        memcpy((uint8_t *)*base++ + offset, a_at, GROUP_BYTES);
    return step + 1;
}

static const struct schedule_step *step_uniform(struct batch *batch, const struct schedule_step *step)
{
    const uint8_t *const *base = batch->base[step->base];
    const ptrdiff_t offset = step->k;
    uint8_t *to = batch->scratch + step->to;
    for (unsigned groups = batch->groups[step->once]; groups; groups--, to += GROUP_BYTES) {
        int32_t word;
        memcpy(&word, *base++ + offset, sizeof word);
        itg r = lit_i(NULL, word);
        memcpy(to, &r, sizeof r);
    }
    return step + 1;
}

static const struct schedule_step *step_gather(struct batch *batch, const struct schedule_step *step)
{
    const uint8_t *const *base = batch->base[step->base];
    const ptrdiff_t scale = step->scale, displacement = step->k;
    const int32_t field = step->field;
    OPERAND(a)
    uint8_t *to = batch->scratch + step->to;
    for (unsigned groups = batch->groups[step->once]; groups; groups--, to += GROUP_BYTES) {
        NEXT(itg, a)
        itg r;
        const uint8_t *start = *base++;
        if (field != GATHER_DIRECT)
            memcpy(&start, start + field, sizeof start);
        for (int i = 0; i < GROUP_LANES; i++)
            r.lane[i] = word_at(start + a.lane[i] * scale + displacement);
        memcpy(to, &r, sizeof r);
    }
    return step + 1;
}

static const struct schedule_step *step_scatter(struct batch *batch, const struct schedule_step *step)
{
    const uint8_t *const *base = batch->base[step->base];
    const ptrdiff_t offset = step->k, stride = step->field;
    OPERAND(a)
    for (unsigned groups = batch->groups[0]; groups; groups--) {
        NEXT(itg, a)
        uint8_t *at = (uint8_t *)*base++ + offset;
        for (int i = 0; i < GROUP_LANES; i++)
            memcpy(at + i * stride, a_at - a_stride + 4 * i, 4);
    }
    return step + 1;
}

/* `set` and `get`: a copy between the value's row and the variable's. */
static const struct schedule_step *step_move(struct batch *batch, const struct schedule_step *step)
{
    OPERAND(a)
    uint8_t *to = batch->scratch + step->to;
    for (unsigned groups = batch->groups[0]; groups; groups--, a_at += a_stride, to += GROUP_BYTES)
        memcpy(to, a_at, GROUP_BYTES);
    return step + 1;
}

static bool any_set(const struct batch *batch, const struct schedule_step *step)
{
    OPERAND(a)
    int32_t any = 0;
    for (unsigned groups = batch->groups[0]; groups; groups--) {
        NEXT(msk, a)
        any |= a.lane[0] | a.lane[1] | a.lane[2] | a.lane[3];
    }
    return any != 0;
}

static const struct schedule_step *step_when(struct batch *batch, const struct schedule_step *step)
{
    return any_set(batch, step) ? step + 1 : step + step->k;
}

static const struct schedule_step *step_again(struct batch *batch, const struct schedule_step *step)
{
    return any_set(batch, step) ? step - step->k : step + 1;
}

const struct schedule_step *schedule_step_end(struct batch *batch, const struct schedule_step *step)
{
    (void)batch, (void)step;
    return NULL;
}

static step_function *const steps[IR_OP_COUNT] = {
#define OP(name, ...)  [IR_##name] = step_##name,
#define OPK(name, ...) [IR_##name] = step_##name,
#define CAST(name, ...)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
    [IR_load] = step_load,       [IR_uniform] = step_uniform, [IR_gather] = step_gather,
    [IR_store] = step_store,     [IR_scatter] = step_scatter, [IR_when] = step_when,
    [IR_again] = step_again,     [IR_set] = step_move,        [IR_get] = step_move,
    [IR_permute] = step_permute,
};

step_function *schedule_step_of(enum ir_op op)
{
    switch (op) {
    case IR_floor_f: return cpu_has_avx2_fma() ? step_vector_floor_f : step_floor_f;
    case IR_mad_f: return cpu_has_avx2_fma() ? step_vector_mad_f : step_mad_f;
    default: return steps[op];
    }
}

step_function *schedule_pair_of(enum ir_op first, enum ir_op second, int position)
{
#define PAIR(a, b, at)                                                                                       \
    if (first == IR_##a && second == IR_##b && position == (at))                                             \
        return step_##a##_##b##_##at;
#include "def/engine/pair.def"
#undef PAIR
    return NULL;
}

void schedule_run(const struct schedule *schedule, struct batch *batch)
{
    const struct schedule_step *step = schedule->step;
    while (step)
        step = step->run(batch, step);
}
