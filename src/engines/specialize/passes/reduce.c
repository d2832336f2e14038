/* Strength reduction (thesis, section 3.4), restated for IEEE arithmetic.
 *
 * The rules of the thesis are y * 1 = y, y + 0 = y, y * 0 = 0 and y - y = 0. Only the first is an identity of
 * IEEE binary32: -0 + 0 is +0, and infinity * 0 and infinity - infinity are NaN. Where denormals are flushed
 * the first is not an identity either: y * 1 of a denormal is a zero. So each rule is applied where the
 * operands' ranges prove it (range.c). Clamps that the range already satisfies are removed too, and
 * selections, mask operations and integer operations with a neutral operand, and products of packed colours
 * with white.
 *
 * Each rule is a row of def/engine/peephole.def, by which it can be left out. A rule makes its instruction a
 * copy of an operand, a literal, or a cheaper operation; copy propagation does the rest. Most rules test for
 * a literal first, so few ranges are needed, and ranges are computed on demand.
 */
#include "engines/specialize/passes/pass.h"
#include "engines/specialize/passes/range.h"

#include "base/bits.h"
#include "contract/lane.h"

#include <math.h>

enum { PLUS_ZERO = 0, ONE = 0x3f800000 };
#define MINUS_ZERO INT32_MIN

static_assert(sizeof(struct range_memory) <= PASS_SCRATCH, "scratch memory is large enough");

/* An instruction in its program, and the ranges of its operands. */
struct view {
    const struct ir *ir;
    struct range_memory *memory;
    struct peepholes *rules;
    const struct ir_instruction *instruction;
};

static struct range operand_range(const struct view *view, int operand)
{
    range_demand(view->ir, view->memory, view->instruction->operand[operand]);
    return range_of_operand(view->ir, view->memory, view->instruction, operand);
}

static bool applies(const struct view *view, enum peephole rule)
{
    return peephole_applies(view->rules, rule);
}

static bool is_literal(const struct view *view, unsigned value, int32_t bits)
{
    const struct ir_instruction *i = &view->ir->instruction[value];
    return i->op == IR_literal && i->k == bits;
}

static bool is_finite(struct range r)
{
    return !r.nan && r.low > -INFINITY && r.high < INFINITY;
}

static bool is_sign_clear(struct range r)
{
    return r.low >= 0 && !r.minus_zero;
}

static bool become_copy(struct ir_instruction *i, unsigned source)
{
    i->op = IR_copy;
    i->operand[0] = (uint16_t)source;
    i->operand[1] = i->operand[2] = 0;
    i->k = 0;
    return true;
}

static bool become_literal(struct ir_instruction *i, int32_t bits)
{
    i->op = IR_literal;
    i->operand[0] = i->operand[1] = i->operand[2] = 0;
    i->k = bits;
    return true;
}

static bool become(struct ir_instruction *i, enum ir_op op, unsigned a, unsigned b)
{
    i->op = (uint8_t)op;
    i->operand[0] = (uint16_t)a;
    i->operand[1] = (uint16_t)b;
    i->operand[2] = 0;
    return true;
}

/* Returns true if arithmetic that keeps y's value keeps its bits: it would flush a denormal. */
static bool keeps_bits(struct range y)
{
    return !y.denormal;
}

/* Returns true if y + 0 = y. */
static bool keeps_zero(struct range y)
{
    return !y.minus_zero && !y.nan && keeps_bits(y);
}

/* Returns true if a value is an integer that was converted: 0, or at least 1 in magnitude. */
static bool is_whole(const struct view *view, unsigned value)
{
    return view->ir->instruction[value].op == IR_float_f;
}

/* Returns true if the factor is a power of two, 2^-64 to 2^64. */
static bool is_power(float factor)
{
    int exponent;
    return fabsf(frexpf(factor, &exponent)) == 0.5f && exponent > -64 && exponent <= 65;
}

/* Returns true if operand `o` of a multiplication times its other operand, a literal, is exact: no rounding,
 * no denormal that would be flushed, no infinity. A fused multiply-add rounds only the sum, so it has the
 * same bits as two operations only in this case. */
static bool is_exact_product(const struct view *product, int o)
{
    const struct ir_instruction *literal = &product->ir->instruction[product->instruction->operand[1 - o]];
    if (literal->op != IR_literal)
        return false;
    const float factor = bits_to_float(literal->k), most = 0x1p24f;
    const struct range y = operand_range(product, o);
    bool whole = is_whole(product, product->instruction->operand[o]);
    if (y.nan || !(fabsf(factor) < 0x1p63f))
        return false;
    if (is_power(factor) && (whole || fabsf(factor) >= 1) && y.low > -0x1p60f && y.high < 0x1p60f)
        return true;
    return whole && factor == floorf(factor) && y.low * fabsf(factor) >= -most &&
           y.high * fabsf(factor) <= most;
}

/* x * y + z becomes a fused multiply-add if the product is exact. */
static bool fuse(const struct view *view, struct ir_instruction *i, int o)
{
    const struct ir_instruction *product = &view->ir->instruction[i->operand[o]];
    const struct view of_product = {view->ir, view->memory, view->rules, product};
    if (product->op != IR_mul_f || !(is_exact_product(&of_product, 0) || is_exact_product(&of_product, 1)) ||
        !applies(view, PEEPHOLE_fuse))
        return false;
    i->operand[2] = i->operand[1 - o];
    i->operand[0] = product->operand[0];
    i->operand[1] = product->operand[1];
    i->op = IR_mad_f;
    return true;
}

/* y + 0 = y unless y is -0; y + -0 = y; y + -x = y - x. */
static bool reduce_add(const struct view *view, struct ir_instruction *i)
{
    for (int o = 0; o < 2; o++) {
        unsigned zero = i->operand[1 - o];
        if (((is_literal(view, zero, PLUS_ZERO) && keeps_zero(operand_range(view, o))) ||
             (is_literal(view, zero, MINUS_ZERO) && keeps_bits(operand_range(view, o)))) &&
            applies(view, PEEPHOLE_add_zero))
            return become_copy(i, i->operand[o]);
    }
    for (int o = 0; o < 2; o++) {
        const struct ir_instruction *negated = &view->ir->instruction[i->operand[1 - o]];
        if (negated->op == IR_neg_f && applies(view, PEEPHOLE_add_negated))
            return become(i, IR_sub_f, i->operand[o], negated->operand[0]);
    }
    return fuse(view, i, 0) || fuse(view, i, 1);
}

/* y - 0 = y; y - y = 0 when y is finite. */
static bool reduce_sub(const struct view *view, struct ir_instruction *i)
{
    unsigned a = i->operand[0], b = i->operand[1];
    if (is_literal(view, b, PLUS_ZERO) && keeps_bits(operand_range(view, 0)) &&
        applies(view, PEEPHOLE_sub_zero))
        return become_copy(i, a);
    if (a == b && is_finite(operand_range(view, 0)) && applies(view, PEEPHOLE_sub_self))
        return become_literal(i, PLUS_ZERO);
    return false;
}

/* y * 1 = y; y * 0 = 0 when y is finite and its sign clear. */
static bool reduce_mul(const struct view *view, struct ir_instruction *i)
{
    for (int o = 0; o < 2; o++) {
        unsigned x = i->operand[1 - o];
        if (is_literal(view, x, ONE) && keeps_bits(operand_range(view, o)) && applies(view, PEEPHOLE_mul_one))
            return become_copy(i, i->operand[o]);
        if (is_literal(view, x, PLUS_ZERO) && is_finite(operand_range(view, o)) &&
            is_sign_clear(operand_range(view, o)) && applies(view, PEEPHOLE_mul_zero))
            return become_literal(i, PLUS_ZERO);
    }
    return false;
}

/* y * 1 + z = y + z; y * z + -0 = y * z; y * 0 + z = z when y is finite and z is not -0. */
static bool reduce_mad(const struct view *view, struct ir_instruction *i)
{
    unsigned z = i->operand[2];
    for (int o = 0; o < 2; o++) {
        unsigned x = i->operand[1 - o];
        if (is_literal(view, x, ONE) && applies(view, PEEPHOLE_mad_one))
            return become(i, IR_add_f, i->operand[o], z);
        if (is_literal(view, x, PLUS_ZERO) && is_finite(operand_range(view, o)) &&
            keeps_zero(operand_range(view, 2)) && applies(view, PEEPHOLE_mad_zero))
            return become_copy(i, z);
    }
    if (is_literal(view, z, MINUS_ZERO) && applies(view, PEEPHOLE_mad_product))
        return become(i, IR_mul_f, i->operand[0], i->operand[1]);
    return false;
}

/* y / 1 = y. */
static bool reduce_div(const struct view *view, struct ir_instruction *i)
{
    if (is_literal(view, i->operand[1], ONE) && keeps_bits(operand_range(view, 0)) &&
        applies(view, PEEPHOLE_div_one))
        return become_copy(i, i->operand[0]);
    return false;
}

/* min and max whose result is always the same operand. Of equal operands the result is b, which matters only
 * if they are zeros of different signs. */
static bool reduce_extreme(const struct view *view, struct ir_instruction *i, bool minimum)
{
    const struct range a = operand_range(view, 0), b = operand_range(view, 1);
    if (a.nan || b.nan || a.denormal || b.denormal ||
        ((a.minus_zero || b.minus_zero) && a.low <= 0 && a.high >= 0))
        return false;
    bool first = minimum ? a.high <= b.low : a.low >= b.high;
    bool second = minimum ? b.high <= a.low : b.low >= a.high;
    if ((first || second) && applies(view, PEEPHOLE_extreme))
        return become_copy(i, i->operand[!first]);
    return false;
}

static bool reduce_select(const struct view *view, struct ir_instruction *i)
{
    bool first = i->operand[1] == i->operand[2] || is_literal(view, i->operand[0], -1);
    bool second = is_literal(view, i->operand[0], 0);
    if ((first || second) && applies(view, PEEPHOLE_select_same))
        return become_copy(i, i->operand[first ? 1 : 2]);
    return false;
}

/* y op neutral = y, on either side. */
static bool reduce_neutral(const struct view *view, struct ir_instruction *i, int32_t neutral)
{
    for (int o = 0; o < 2; o++)
        if (is_literal(view, i->operand[1 - o], neutral) && applies(view, PEEPHOLE_neutral))
            return become_copy(i, i->operand[o]);
    return false;
}

/* y op absorbing = absorbing, on either side. */
static bool reduce_absorbing(const struct view *view, struct ir_instruction *i, int32_t absorbing)
{
    if ((is_literal(view, i->operand[0], absorbing) || is_literal(view, i->operand[1], absorbing)) &&
        applies(view, PEEPHOLE_absorbing))
        return become_literal(i, absorbing);
    return false;
}

/* y op y = y. */
static bool reduce_same(const struct view *view, struct ir_instruction *i)
{
    if (i->operand[0] == i->operand[1] && applies(view, PEEPHOLE_same))
        return become_copy(i, i->operand[0]);
    return false;
}

/* `not x and y` becomes andn_m, which works on all bits. */
static bool reduce_and(const struct view *view, struct ir_instruction *i)
{
    for (int o = 0; o < 2; o++) {
        const struct ir_instruction *complement = &view->ir->instruction[i->operand[o]];
        if (complement->op == IR_xor_i && is_literal(view, complement->operand[1], -1) &&
            applies(view, PEEPHOLE_complement))
            return become(i, IR_andn_m, i->operand[1 - o], complement->operand[0]);
    }
    return reduce_same(view, i) || reduce_neutral(view, i, -1) || reduce_absorbing(view, i, 0);
}

/* The bits that two shifts by the same amount keep: of the low part of y (left, then right) or of its high
 * part, in words or in both halves of words. Returns the number of y, or 0 if it is something else. */
static unsigned shifted_back(const struct view *view, const struct ir_instruction *last, uint32_t *kept)
{
    const struct ir_instruction *first = &view->ir->instruction[last->operand[0]];
    if (first->k != last->k)
        return 0;
    if (last->op == IR_shl_x && first->op == IR_ushr_x)
        *kept = (0xffffu << last->k & 0xffffu) * 0x10001u;
    else if (last->op == IR_ushr_i && first->op == IR_shl_i)
        *kept = UINT32_MAX >> last->k;
    else
        return 0;
    return first->operand[0];
}

/* The literal of `y and literal`; 0 if a value is something else. */
static uint32_t masked_bits(const struct view *view, unsigned value, unsigned *y)
{
    const struct ir_instruction *i = &view->ir->instruction[value];
    for (int o = 0; i->op == IR_and_i && o < 2; o++) {
        const struct ir_instruction *mask = &view->ir->instruction[i->operand[o]];
        *y = i->operand[1 - o];
        if (mask->op == IR_literal)
            return (uint32_t)mask->k;
    }
    return 0;
}

/* (y and mask) or (y shifted to and fro) = y, if they keep all bits: colours that are split and joined. */
static bool reduce_rejoined(const struct view *view, struct ir_instruction *i)
{
    for (int o = 0; o < 2; o++) {
        unsigned y = 0;
        uint32_t kept = 0, bits = masked_bits(view, i->operand[1 - o], &y);
        const struct ir_instruction *shifted = &view->ir->instruction[i->operand[o]];
        if (bits && shifted_back(view, shifted, &kept) == y && (bits | kept) == UINT32_MAX &&
            applies(view, PEEPHOLE_rejoin))
            return become_copy(i, y);
    }
    return false;
}

/* y shifted to and fro = y, if y has no other bits. */
static bool reduce_shifted(const struct view *view, struct ir_instruction *i)
{
    unsigned masked;
    uint32_t kept = 0;
    unsigned y = shifted_back(view, i, &kept);
    uint32_t bits = y ? masked_bits(view, y, &masked) : 0;
    if (bits && !(bits & ~kept) && applies(view, PEEPHOLE_rejoin))
        return become_copy(i, y);
    return false;
}

static bool reduce_or(const struct view *view, struct ir_instruction *i)
{
    return reduce_rejoined(view, i) || reduce_same(view, i) || reduce_neutral(view, i, 0) ||
           reduce_absorbing(view, i, -1);
}

static bool reduce_difference(const struct view *view, struct ir_instruction *i)
{
    if (i->operand[0] == i->operand[1] && applies(view, PEEPHOLE_difference))
        return become_literal(i, 0);
    return false;
}

/* y - 0 = y, of integers; y - y = 0. */
static bool reduce_subtraction(const struct view *view, struct ir_instruction *i)
{
    if (is_literal(view, i->operand[1], 0) && applies(view, PEEPHOLE_neutral))
        return become_copy(i, i->operand[0]);
    return reduce_difference(view, i);
}

static bool reduce_shift(const struct view *view, struct ir_instruction *i)
{
    if (!i->k && applies(view, PEEPHOLE_neutral))
        return become_copy(i, i->operand[0]);
    if (is_literal(view, i->operand[0], 0) && applies(view, PEEPHOLE_absorbing))
        return become_literal(i, 0);
    return reduce_shifted(view, i);
}

/* The other operand of an operation that has this literal; 0 if a value is something else. */
static unsigned beside(const struct view *view, const struct ir_instruction *i, enum ir_op op, int32_t bits)
{
    for (int o = 0; i->op == op && o < 2; o++)
        if (is_literal(view, i->operand[o], bits))
            return i->operand[1 - o];
    return 0;
}

/* y * 255 / 255 = y: a packed colour times white. The quotient is computed as the high half of
 * (y * 255 + 128) * 257 = y * 65535 + 32896. It is y if y is 0 to 255, and the sum is below 2^16. */
static bool reduce_high(const struct view *view, struct ir_instruction *i)
{
    enum { HALF = 0x00800080, DIVISOR = 0x01010101, WHITE = 0x00ff00ff };
    const struct ir_instruction *at = view->ir->instruction;
    const unsigned sum = beside(view, i, IR_high_x, DIVISOR);
    const unsigned product = sum ? beside(view, &at[sum], IR_add_x, HALF) : 0;
    const unsigned y = product ? beside(view, &at[product], IR_mul_x, WHITE) : 0;
    if (!y)
        return false;
    const struct halves most = range_halves(view->ir, y);
    if (most.low > 255 || most.high > 255 || !applies(view, PEEPHOLE_white))
        return false;
    return become_copy(i, y);
}

static bool reduce(const struct view *view, struct ir_instruction *i)
{
    switch (i->op) {
    case IR_add_f: return reduce_add(view, i);
    case IR_sub_f: return reduce_sub(view, i);
    case IR_mul_f: return reduce_mul(view, i);
    case IR_mad_f: return reduce_mad(view, i);
    case IR_div_f: return reduce_div(view, i);
    case IR_min_f:
    case IR_min_i: return reduce_extreme(view, i, true);
    case IR_max_f:
    case IR_max_i: return reduce_extreme(view, i, false);
    case IR_select_f:
    case IR_select_i: return reduce_select(view, i);
    case IR_add_i:
    case IR_add_x: return reduce_neutral(view, i, 0);
    case IR_mul_i: return reduce_neutral(view, i, 1) || reduce_absorbing(view, i, 0);
    case IR_mul_x: return reduce_neutral(view, i, 0x10001) || reduce_absorbing(view, i, 0);
    case IR_high_x: return reduce_high(view, i);
    case IR_and_i:
    case IR_and_m: return reduce_and(view, i);
    case IR_or_i:
    case IR_or_m: return reduce_or(view, i);
    case IR_xor_i: return reduce_difference(view, i) || reduce_neutral(view, i, 0);
    case IR_sub_i:
    case IR_sub_x: return reduce_subtraction(view, i);
    case IR_shl_i:
    case IR_shr_i:
    case IR_ushr_i:
    case IR_rotl_i:
    case IR_shl_x:
    case IR_ushr_x: return reduce_shift(view, i);
    default: return false;
    }
}

unsigned pass_reduce(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = 0;
    struct view view = {
        .ir = ir, .memory = pass_scratch(memory, sizeof *view.memory), .rules = &memory->rules};
    range_begin(ir, view.memory);
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        view.instruction = i;
        if (ir_properties(i) & IR_COMPUTES)
            changes += reduce(&view, i);
        ir->typed &= i->op != IR_andn_m || i->type == TYPE_msk;
    }
    return changes;
}
