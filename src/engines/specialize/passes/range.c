/* Range analysis, front to back: bounds of each value, and whether it may be NaN, -0 or a denormal. IEEE
 * arithmetic allows many strength reductions only under such conditions (reduce.c).
 *
 * The bounds of a result are the operation's results on the bounds of its operands, in binary32 under the
 * contract's rounding. This is correct because rounding and flushing are monotone. A tiny negative result is
 * flushed to -0, so a sum that may be negative may be -0. Arithmetic never results in a denormal, but loads,
 * selections and operations on bits may. Integers have float bounds, which are exact up to 2^24; a larger
 * integer may be anything. */
#include "engines/specialize/passes/range.h"

#include "base/bits.h"
#include "base/minmax.h"
#include "contract/lane.h"

#include <float.h>
#include <string.h>

static const struct range anything = {-INFINITY, INFINITY, 1, 1, 1};

static bool is_finite(struct range r)
{
    return !r.nan && r.low > -INFINITY && r.high < INFINITY;
}

static bool contains_zero(struct range r)
{
    return r.low <= 0 && r.high >= 0;
}

static bool is_sign_clear(struct range r)
{
    return r.low >= 0 && !r.minus_zero;
}

/* A bound that is NaN (infinity minus infinity) means that nothing is known. */
static struct range checked(struct range r)
{
    return r.low <= r.high ? r : anything;
}

static struct range literal_range(const struct ir_instruction *i)
{
    if (i->type == TYPE_flt) {
        float value = bits_to_float((uint32_t)i->k);
        if (value != value)
            return anything;
        /* By the bits: under DAZ a denormal compares equal to zero. */
        bool denormal = !(i->k & 0x7f800000) && i->k & 0x007fffff;
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

/* The range of a product or quotient of finite numbers: its bounds are two of its values at their bounds. */
static struct range extremes(struct range a, struct range b, const float at[4])
{
    struct range r = {min_f32(min_f32(at[0], at[1]), min_f32(at[2], at[3])),
                      max_f32(max_f32(at[0], at[1]), max_f32(at[2], at[3])), 0, 0, 0};
    r.minus_zero = !(is_sign_clear(a) && is_sign_clear(b));
    return r;
}

static struct range multiply_range(struct range a, struct range b)
{
    if (!is_finite(a) || !is_finite(b)) {
        if (a.nan || b.nan || !is_sign_clear(a) || !is_sign_clear(b))
            return anything;
        return (struct range){0, INFINITY, 1, 0, 0};
    }
    const float at[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    return extremes(a, b, at);
}

/* A denormal divisor counts as zero. */
static struct range divide_range(struct range a, struct range b)
{
    if (!is_finite(a) || !is_finite(b) || contains_zero(b) || b.denormal)
        return anything;
    const float at[4] = {a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high};
    return extremes(a, b, at);
}

/* A fused multiply-add rounds once. The bounds of the rounded product are extended by the largest step that
 * its rounding may have taken; from zero, that is the least normal number, since smaller products are
 * flushed. */
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
    return (struct range){min_f32(a.low, b.low), a.nan ? b.high : min_f32(a.high, b.high), b.nan,
                          a.minus_zero || b.minus_zero, a.denormal || b.denormal};
}

static struct range maximum_range(struct range a, struct range b)
{
    return (struct range){a.nan ? b.low : max_f32(a.low, b.low), max_f32(a.high, b.high), b.nan,
                          a.minus_zero || b.minus_zero, a.denormal || b.denormal};
}

static struct range union_range(struct range a, struct range b)
{
    return (struct range){min_f32(a.low, b.low), max_f32(a.high, b.high), a.nan || b.nan,
                          a.minus_zero || b.minus_zero, a.denormal || b.denormal};
}

static struct range sqrt_range(struct range a)
{
    if (!(a.low >= 0))
        return anything;
    return (struct range){lane_sqrt(a.low), lane_sqrt(a.high), a.nan, a.minus_zero, 0};
}

/* The bounds of integers below 2^24 are exact; larger integers may be anything. */
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
        r = (struct range){0, r.nan ? b.high : min_f32(r.high, b.high), 0, 0, 0};
    return r;
}

static struct range shift_right_range(struct range a, int k, bool logical)
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

/* The range of a value, used as a type that it may not have. */
static struct range range_as(const struct ir *ir, const struct range_memory *memory, unsigned value,
                             unsigned type)
{
    return ir->instruction[value].type == type ? memory->range[value] : anything;
}

struct range range_of_operand(const struct ir *ir, const struct range_memory *memory,
                              const struct ir_instruction *i, int operand)
{
    unsigned value = i->operand[operand];
    if (ir->instruction[value].type != ir_op_information[i->op].operand[operand])
        return anything;
    return memory->range[value];
}

/* The range of an operation that is not a row of def/op.def. */
static struct range other_range(const struct ir *ir, const struct range_memory *memory,
                                const struct ir_instruction *i)
{
    switch (i->op) {
    case IR_literal: return literal_range(i);
    case IR_uniform: return i->scale == IR_UNIT ? (struct range){0, 1, 0, 0, 0} : anything;
    case IR_copy: return range_as(ir, memory, i->operand[0], i->type);
    case IR_join:
        return union_range(range_as(ir, memory, i->operand[0], i->type),
                           range_as(ir, memory, i->operand[1], i->type));
    default: return anything;
    }
}

/* The rows of def/op.def that have a rule in computed_range. The results of all others may be anything. */
static const bool has_rule[IR_OP_COUNT] = {
    [IR_add_f] = true,    [IR_sub_f] = true,   [IR_mul_f] = true,   [IR_mad_f] = true,   [IR_div_f] = true,
    [IR_sqrt_f] = true,   [IR_min_f] = true,   [IR_max_f] = true,   [IR_neg_f] = true,   [IR_select_f] = true,
    [IR_select_i] = true, [IR_float_f] = true, [IR_round_i] = true, [IR_trunc_i] = true, [IR_and_i] = true,
    [IR_ushr_i] = true,   [IR_shr_i] = true,   [IR_min_i] = true,   [IR_max_i] = true,
};

static struct range computed_range(const struct ir *ir, const struct range_memory *memory,
                                   const struct ir_instruction *i)
{
    struct range a = range_of_operand(ir, memory, i, 0);
    struct range b = range_of_operand(ir, memory, i, 1);
    struct range c = range_of_operand(ir, memory, i, 2);
    switch (i->op) {
    case IR_add_f: return add_range(a, b);
    case IR_sub_f: return add_range(a, negate_range(b));
    case IR_mul_f: return multiply_range(a, b);
    case IR_mad_f: return fused_range(a, b, c);
    case IR_div_f: return divide_range(a, b);
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
    case IR_ushr_i: return shift_right_range(a, i->k, true);
    case IR_shr_i: return shift_right_range(a, i->k, false);
    case IR_min_i: return a.nan || b.nan ? anything : minimum_range(a, b);
    default: return a.nan || b.nan ? anything : maximum_range(a, b);
    }
}

static struct range value_range(const struct ir *ir, const struct range_memory *memory,
                                const struct ir_instruction *i)
{
    return has_rule[i->op] ? computed_range(ir, memory, i) : other_range(ir, memory, i);
}

static bool contains(struct range outer, struct range inner)
{
    return outer.low <= inner.low && outer.high >= inner.high && outer.nan >= inner.nan &&
           outer.minus_zero >= inner.minus_zero && outer.denormal >= inner.denormal;
}

/* Extends a bound that has moved to the next value at which it is likely to stop: zero, one, infinity. */
static struct range widened(struct range old, struct range r)
{
    if (r.low < old.low)
        r.low = r.low >= 0 ? 0 : r.low >= -1 ? -1 : -INFINITY;
    if (r.high > old.high)
        r.high = r.high <= 0 ? 0 : r.high <= 1 ? 1 : INFINITY;
    return r;
}

/* Before round ROUNDS_EXACT the range of a phi is extended exactly, and before ROUNDS_WIDENED generously. A
 * phi that is extended later may be anything, and from ROUNDS on every phi may be. */
enum { ROUNDS_EXACT = 1, ROUNDS_WIDENED = 3, ROUNDS = 5 };

/* Extends the range of a phi by one of its values. Returns true if it has changed. */
static bool extend_phi(struct range *phi, struct range value, unsigned round)
{
    if (contains(*phi, value))
        return false;
    struct range both = checked(union_range(*phi, value));
    *phi = round < ROUNDS_EXACT ? both : round < ROUNDS_WIDENED ? widened(*phi, both) : anything;
    return true;
}

/* Extends the range of a phi by its first value, or by its next value. Returns true if it has changed. */
static bool analyse_phi(const struct ir *ir, struct range_memory *memory, uint32_t number, unsigned round)
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
    return false;
}

/* Analyses the program from an instruction on. Returns true if the range of a phi was extended. */
static bool analyse(const struct ir *ir, struct range_memory *memory, uint32_t from, unsigned round)
{
    bool extended = false;
    for (uint32_t number = from; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (i->op == IR_phi || i->op == IR_next)
            extended |= analyse_phi(ir, memory, number, round);
        else
            memory->range[number] = value_range(ir, memory, i);
    }
    return extended;
}

/* The range of a phi begins as that of its first value, and is extended by its next value in rounds until no
 * phi changes. The results of a round are valid if each phi is in the range that the round began with, so
 * those of the last round are valid. Values before the first phi are analysed once. */
void range_analyse(const struct ir *ir, struct range_memory *memory)
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

/* --- Single values, on demand -------------------------------------------------------------------------- */

void range_begin(const struct ir *ir, struct range_memory *memory)
{
    if (ir->loops && ir->phis) {
        range_analyse(ir, memory);
        memset(memory->known, 1, ir->count);
        return;
    }
    memset(memory->known, 0, ir->count);
    memory->known[0] = 1;
    memory->range[0] = anything;
}

/* An operand that has to be analysed first, 0: none. */
static unsigned unknown_operand(const struct ir_instruction *i, const struct range_memory *memory)
{
    if (!has_rule[i->op] && i->op != IR_copy && i->op != IR_join)
        return 0;
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (!memory->known[i->operand[o]])
            return i->operand[o];
    return 0;
}

/* Operands are earlier in the program, so no value is on the stack twice. */
void range_demand(const struct ir *ir, struct range_memory *memory, unsigned value)
{
    uint32_t depth = 0;
    while (!memory->known[value]) {
        const struct ir_instruction *i = &ir->instruction[value];
        unsigned operand = unknown_operand(i, memory);
        if (operand) {
            memory->waiting[depth++] = (uint16_t)value;
            value = operand;
            continue;
        }
        memory->range[value] = value_range(ir, memory, i);
        memory->known[value] = 1;
        if (depth)
            value = memory->waiting[--depth];
    }
}

/* --- Halves of packed values -----------------------------------------------------------------------------
 *
 * Bounds are needed for few values, so they are found anew for each, from the value back to what it is
 * computed from. Operations are monotone: the bound of a result is the operation's result on the bounds of
 * its operands, if it has 16 bits. The interpolation of texels has a bound of its own: p + scale_x(q - p, w),
 * where p, q and w are below 2^15. scale_x rounds (q - p) * w / 2^15 to an integer, and w / 2^15 is from 0 to
 * 1, so the integer is from 0 to q - p. The sum is therefore from p to q. */

/* VALUES: how many values are looked at for one bound, at most. Of others, nothing is known. */
enum { MOST = 0xffff, SIGNED_MOST = 0x7fff, VALUES = 128 };

/* The program, and how many values may still be looked at. */
struct search {
    const struct ir *ir;
    unsigned left;
};

static const struct halves unknown = {MOST, MOST};

static struct halves bound(struct search *search, unsigned value);

static uint32_t at_most(uint64_t number)
{
    return number < MOST ? (uint32_t)number : MOST;
}

static struct halves larger(struct halves a, struct halves b)
{
    return (struct halves){max_u32(a.low, b.low), max_u32(a.high, b.high)};
}

/* All bits up to the highest of a number. */
static uint32_t filled(uint32_t number)
{
    return number ? UINT32_MAX >> __builtin_clz(number) : 0;
}

/* The bound of a half, of an operation that has one for each half. */
static uint32_t half_bound(const struct ir_instruction *i, uint32_t a, uint32_t b)
{
    switch (i->op) {
    case IR_add_x: return at_most(a + b);
    case IR_mul_x: return at_most((uint64_t)a * b);
    case IR_high_x: return (uint32_t)((uint64_t)a * b >> 16);
    case IR_and_i:
    case IR_min_x: return min_u32(a, b);
    case IR_or_i: return filled(a | b);
    case IR_shl_x: return at_most((uint64_t)a << i->k);
    case IR_ushr_x: return a >> i->k;
    default: return MOST;
    }
}

/* A word that is shifted. If bits of the high half move to the low one, nothing is known of that. */
static struct halves shifted(const struct ir_instruction *i, struct halves a)
{
    const unsigned k = (unsigned)i->k;
    if (i->op == IR_shl_i && k < 16)
        return a.low << k > MOST ? unknown : (struct halves){a.low << k, at_most((uint64_t)a.high << k)};
    if (i->op == IR_shl_i)
        return (struct halves){0, at_most((uint64_t)a.low << (k - 16))};
    if (k < 16)
        return (struct halves){a.high ? MOST : a.low >> k, a.high >> k};
    return (struct halves){a.high >> (k - 16), 0};
}

/* p + scale_x(q - p, w), for operand o of the sum as p and operand s of scale_x as q - p. */
static bool interpolates(struct search *search, const struct ir_instruction *sum, int o, int s,
                         struct halves *most)
{
    const struct ir_instruction *at = search->ir->instruction, *change = &at[sum->operand[1 - o]];
    const struct ir_instruction *difference = &at[change->operand[s]];
    if (change->op != IR_scale_x || difference->op != IR_sub_x || difference->operand[1] != sum->operand[o])
        return false;
    *most = larger(bound(search, sum->operand[o]), bound(search, difference->operand[0]));
    const struct halves all = larger(*most, bound(search, change->operand[1 - s]));
    return all.low <= SIGNED_MOST && all.high <= SIGNED_MOST;
}

static struct halves sum_bound(struct search *search, const struct ir_instruction *i)
{
    struct halves most;
    for (int form = 0; form < 4; form++)
        if (interpolates(search, i, form & 1, form >> 1, &most))
            return most;
    const struct halves a = bound(search, i->operand[0]), b = bound(search, i->operand[1]);
    return (struct halves){half_bound(i, a.low, b.low), half_bound(i, a.high, b.high)};
}

static struct halves operation_bound(struct search *search, const struct ir_instruction *i)
{
    const struct halves a = bound(search, i->operand[0]);
    const struct halves b = ir_operands(i) > 1 ? bound(search, i->operand[1]) : a;
    return (struct halves){half_bound(i, a.low, b.low), half_bound(i, a.high, b.high)};
}

static struct halves bound(struct search *search, unsigned value)
{
    const struct ir_instruction *i = &search->ir->instruction[value];
    if (!search->left)
        return unknown;
    search->left--;
    switch (i->op) {
    case IR_literal: return (struct halves){(uint32_t)i->k & MOST, (uint32_t)i->k >> 16};
    case IR_copy: return bound(search, i->operand[0]);
    case IR_join: return larger(bound(search, i->operand[0]), bound(search, i->operand[1]));
    case IR_select_i: return larger(bound(search, i->operand[1]), bound(search, i->operand[2]));
    case IR_shl_i:
    case IR_ushr_i: return shifted(i, bound(search, i->operand[0]));
    case IR_add_x: return sum_bound(search, i);
    case IR_mul_x:
    case IR_high_x:
    case IR_and_i:
    case IR_min_x:
    case IR_or_i:
    case IR_shl_x:
    case IR_ushr_x: return operation_bound(search, i);
    default: return unknown;
    }
}

struct halves range_halves(const struct ir *ir, unsigned value)
{
    struct search search = {ir, VALUES};
    return bound(&search, value);
}
