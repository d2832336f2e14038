/* Range analysis: bounds of values, NaN and -0, front to back, for the strength reductions that IEEE
 * arithmetic allows only under conditions (reduce.c).
 *
 * Bounds are computed with the operations themselves in binary32 under the contract's rounding: rounding and
 * flushing are monotone, so the result of the bounds bounds the results. A flushed tiny negative result is
 * -0, hence any sum that may be negative may be -0. Arithmetic never gives a denormal; what was loaded, and
 * what merely chooses among or rewrites bits, may. Integers keep float bounds, exact up to 2^24, and are
 * given up beyond. */
#include "def/lane.h"
#include "jit/pass.h"

#include <float.h>
#include <string.h>

static const struct range anything = {-INFINITY, INFINITY, 1, 1, 1};

static float least(float a, float b)
{
    return a < b ? a : b;
}

static float greatest(float a, float b)
{
    return a > b ? a : b;
}

static int is_finite(struct range r)
{
    return !r.nan && r.low > -INFINITY && r.high < INFINITY;
}

static int contains_zero(struct range r)
{
    return r.low <= 0 && r.high >= 0;
}

static int is_sign_clear(struct range r)
{
    return r.low >= 0 && !r.minus_zero;
}

/* Bounds that came out as NaN (infinity minus infinity) say nothing. */
static struct range checked(struct range r)
{
    return r.low <= r.high ? r : anything;
}

static struct range literal_range(const struct ir_instruction *i)
{
    if (i->type == TYPE_flt) {
        float value = lane_from_bits((uint32_t)i->k);
        if (value != value)
            return anything;
        /* By the bits: under DAZ a denormal compares equal to zero. */
        int denormal = !(i->k & 0x7f800000) && i->k & 0x007fffff;
        return (struct range){value, value, 0, (uint8_t)(i->k < 0 && !(i->k & 0x7f800000)),
                              (uint8_t)denormal};
    }
    if (i->type == TYPE_itg && i->k > -(1 << 24) && i->k < 1 << 24)
        return (struct range){(float)i->k, (float)i->k, 0, 0, 0};
    return anything;
}

static struct range add_range(struct range a, struct range b)
{
    struct range r = {a.low + b.low, a.high + b.high, (uint8_t) !(is_finite(a) || is_finite(b)), 0, 0};
    r.nan = a.nan || b.nan || r.nan;
    r.minus_zero = signbit(r.low) || (a.minus_zero && b.minus_zero);
    return checked(r);
}

static struct range negate_range(struct range a)
{
    return (struct range){-a.high, -a.low, a.nan, (uint8_t)contains_zero(a), a.denormal};
}

static struct range multiply_range(struct range a, struct range b)
{
    if (!is_finite(a) || !is_finite(b)) {
        if (a.nan || b.nan || !is_sign_clear(a) || !is_sign_clear(b))
            return anything;
        return (struct range){0, INFINITY, 1, 0, 0};
    }
    float p[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    struct range r = {least(least(p[0], p[1]), least(p[2], p[3])),
                      greatest(greatest(p[0], p[1]), greatest(p[2], p[3])), 0, 0, 0};
    r.minus_zero = !(is_sign_clear(a) && is_sign_clear(b));
    return r;
}

/* One rounding instead of two: the product's bounds go outward by the step that its rounding may have taken,
 * which from zero is the whole way that flushing takes. */
static struct range fused_range(struct range a, struct range b, struct range c)
{
    struct range product = multiply_range(a, b);
    if (product.low != 0)
        product.low = nextafterf(product.low, -INFINITY);
    else if (product.minus_zero)
        product.low = -FLT_MIN;
    product.high = product.high != 0 ? nextafterf(product.high, INFINITY) : FLT_MIN;
    return add_range(product, c);
}

/* a < b ? a : b, which is b when either is NaN. */
static struct range minimum_range(struct range a, struct range b)
{
    return (struct range){least(a.low, b.low), a.nan ? b.high : least(a.high, b.high), b.nan,
                          a.minus_zero || b.minus_zero, a.denormal || b.denormal};
}

static struct range maximum_range(struct range a, struct range b)
{
    return (struct range){a.nan ? b.low : greatest(a.low, b.low), greatest(a.high, b.high), b.nan,
                          a.minus_zero || b.minus_zero, a.denormal || b.denormal};
}

static struct range union_range(struct range a, struct range b)
{
    return (struct range){least(a.low, b.low), greatest(a.high, b.high), a.nan || b.nan,
                          a.minus_zero || b.minus_zero, a.denormal || b.denormal};
}

static struct range sqrt_range(struct range a)
{
    if (!(a.low >= 0))
        return anything;
    return (struct range){lane_sqrt(a.low), lane_sqrt(a.high), a.nan, a.minus_zero, 0};
}

/* Integer results within 2^24 are exact in the bounds; larger ones are given up. */
static struct range integer_range(float low, float high)
{
    if (low > -0x1p24f && high < 0x1p24f)
        return (struct range){low, high, 0, 0, 0};
    return anything;
}

static struct range and_range(struct range a, struct range b)
{
    struct range r = anything;
    if (a.low >= 0 && !a.nan)
        r = (struct range){0, a.high, 0, 0, 0};
    if (b.low >= 0 && !b.nan)
        r = (struct range){0, r.nan ? b.high : least(r.high, b.high), 0, 0, 0};
    return r;
}

static struct range shift_right_range(struct range a, int k, int logical)
{
    if (!a.nan && (a.low >= 0 || !logical))
        return integer_range(floorf(ldexpf(a.low, -k)), floorf(ldexpf(a.high, -k)));
    return logical && k >= 8 ? (struct range){0, ldexpf(1, 32 - k) - 1, 0, 0, 0} : anything;
}

static struct range rounded_range(struct range a)
{
    if (!is_finite(a))
        return anything;
    return integer_range(floorf(a.low), ceilf(a.high));
}

/* Of a value under a type that it may not have. */
static struct range range_as(const struct ir *ir, const struct pass_memory *memory, unsigned value,
                             unsigned type)
{
    return ir->instruction[value].type == type ? memory->range[value] : anything;
}

struct range range_of_operand(const struct ir *ir, const struct pass_memory *memory,
                              const struct ir_instruction *i, int operand)
{
    unsigned value = i->operand[operand];
    if (ir->instruction[value].type != ir_op_information[i->op].operand[operand])
        return anything;
    return memory->range[value];
}

/* Of what is no operation of the table. */
static struct range other_range(const struct ir *ir, const struct pass_memory *memory,
                                const struct ir_instruction *i)
{
    switch (i->op) {
    case IR_literal: return literal_range(i);
    case IR_copy: return range_as(ir, memory, i->operand[0], i->type);
    case IR_join:
        return union_range(range_as(ir, memory, i->operand[0], i->type),
                           range_as(ir, memory, i->operand[1], i->type));
    default: return anything;
    }
}

/* The operations of the table of which something is known: all others' values may be anything. */
static const uint8_t is_known[IR_OP_COUNT] = {
    [IR_add_f] = 1,   [IR_sub_f] = 1,   [IR_mul_f] = 1,   [IR_mad_f] = 1,    [IR_sqrt_f] = 1,
    [IR_min_f] = 1,   [IR_max_f] = 1,   [IR_neg_f] = 1,   [IR_select_f] = 1, [IR_select_i] = 1,
    [IR_float_f] = 1, [IR_round_i] = 1, [IR_trunc_i] = 1, [IR_and_i] = 1,    [IR_ushr_i] = 1,
    [IR_shr_i] = 1,   [IR_min_i] = 1,   [IR_max_i] = 1,
};

static struct range value_range(const struct ir *ir, const struct pass_memory *memory,
                                const struct ir_instruction *i)
{
    if (i->op >= IR_copy)
        return other_range(ir, memory, i);
    if (!is_known[i->op])
        return anything;
    struct range a = range_of_operand(ir, memory, i, 0);
    struct range b = range_of_operand(ir, memory, i, 1);
    struct range c = range_of_operand(ir, memory, i, 2);
    switch (i->op) {
    case IR_add_f: return add_range(a, b);
    case IR_sub_f: return add_range(a, negate_range(b));
    case IR_mul_f: return multiply_range(a, b);
    case IR_mad_f: return fused_range(a, b, c);
    case IR_sqrt_f: return sqrt_range(a);
    case IR_min_f: return minimum_range(a, b);
    case IR_max_f: return maximum_range(a, b);
    case IR_neg_f: return negate_range(a);
    case IR_select_f:
    case IR_select_i: return union_range(b, c);
    case IR_float_f: return a.nan ? (struct range){-0x1p31f, 0x1p31f, 0, 0, 0} : a;
    case IR_round_i:
    case IR_trunc_i: return rounded_range(a);
    case IR_and_i: return and_range(a, b);
    case IR_ushr_i: return shift_right_range(a, i->k, 1);
    case IR_shr_i: return shift_right_range(a, i->k, 0);
    case IR_min_i: return a.nan || b.nan ? anything : minimum_range(a, b);
    default: return a.nan || b.nan ? anything : maximum_range(a, b);
    }
}

static int contains(struct range outer, struct range inner)
{
    return outer.low <= inner.low && outer.high >= inner.high && outer.nan >= inner.nan &&
           outer.minus_zero >= inner.minus_zero && outer.denormal >= inner.denormal;
}

/* A bound that moved goes on to where it likely comes to rest: zero, one, infinity. */
static struct range widened(struct range old, struct range r)
{
    if (r.low < old.low)
        r.low = r.low >= 0 ? 0 : r.low >= -1 ? -1 : -INFINITY;
    if (r.high > old.high)
        r.high = r.high <= 0 ? 0 : r.high <= 1 ? 1 : INFINITY;
    return r;
}

/* After so many rounds a phi that is still extended may be anything; after some more, every phi. */
enum { ROUNDS_EXACT = 1, ROUNDS_WIDENED = 3, ROUNDS = 5 };

/* What a phi may be, given another of its values; in later rounds generously. */
static int extend_phi(struct range *phi, struct range value, unsigned round)
{
    if (contains(*phi, value))
        return 0;
    struct range both = checked(union_range(*phi, value));
    *phi = round < ROUNDS_EXACT ? both : round < ROUNDS_WIDENED ? widened(*phi, both) : anything;
    return 1;
}

/* The range of a phi's first or next value, which the phi's includes from now on. */
static int analyse_phi(const struct ir *ir, struct pass_memory *memory, uint32_t number, unsigned round)
{
    const struct ir_instruction *i = &ir->instruction[number];
    if (i->op == IR_next) {
        unsigned phi = i->operand[0];
        return extend_phi(&memory->range[phi], range_as(ir, memory, i->operand[1], ir->instruction[phi].type),
                          round);
    }
    struct range start = range_as(ir, memory, i->operand[0], i->type);
    if (round && round < ROUNDS)
        return extend_phi(&memory->range[number], start, round);
    memory->range[number] = round ? anything : start;
    return 0;
}

/* One round from an instruction on; whether a phi was extended. */
static int analyse(const struct ir *ir, struct pass_memory *memory, uint32_t from, unsigned round)
{
    int extended = 0;
    for (uint32_t number = from; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (i->op == IR_phi || i->op == IR_next)
            extended |= analyse_phi(ir, memory, number, round);
        else
            memory->range[number] = value_range(ir, memory, i);
    }
    return extended;
}

/* Each phi begins as its first value; what is then found to come around the loop is added until nothing is.
 * Each round holds for phis within the ranges that it begins with: what the last one finds holds for all.
 * What stands before the first phi is as it was. */
void range_analyse(const struct ir *ir, struct pass_memory *memory)
{
    uint32_t first = 1;
    memory->range[0] = anything;
    if (!analyse(ir, memory, 1, 0))
        return;
    while (ir->instruction[first].op != IR_phi)
        first++;
    for (unsigned round = 1; analyse(ir, memory, first, round); round++)
        continue;
}

/* --- One value's, when it is asked for ----------------------------------------------------------------- */

void range_begin(const struct ir *ir, struct pass_memory *memory)
{
    if (ir->loops && ir->phis) {
        range_analyse(ir, memory);
        memset(memory->flag, 1, ir->count);
        return;
    }
    memset(memory->flag, 0, ir->count);
    memory->flag[0] = 1;
    memory->range[0] = anything;
}

/* An operand that has to be looked at first; 0: none. */
static unsigned unknown_operand(const struct ir_instruction *i, const struct pass_memory *memory)
{
    if (i->op < IR_copy ? !is_known[i->op] : i->op != IR_copy && i->op != IR_join)
        return 0;
    for (int o = 0; o < ir_op_information[i->op].operands; o++)
        if (!memory->flag[i->operand[o]])
            return i->operand[o];
    return 0;
}

/* Operands first, which are earlier: a stack of what waits for them, in which nothing stands twice. */
void range_demand(const struct ir *ir, struct pass_memory *memory, unsigned value)
{
    uint16_t *waiting = memory->table;
    uint32_t depth = 0;
    while (!memory->flag[value]) {
        const struct ir_instruction *i = &ir->instruction[value];
        unsigned operand = unknown_operand(i, memory);
        if (operand) {
            waiting[depth++] = (uint16_t)value;
            value = operand;
            continue;
        }
        memory->range[value] = value_range(ir, memory, i);
        memory->flag[value] = 1;
        if (depth)
            value = waiting[--depth];
    }
}
