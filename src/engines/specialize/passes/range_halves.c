/* Bounds of the halves of packed values, from the value back to what it is computed from. They are needed for
 * few values, so they are found anew for each.
 *
 * Operations are monotone: the bound of a result is the operation's result on the bounds of its operands, if it
 * has 16 bits. One form of several operations has a bound of its own, the interpolation of texels: p + scale_x(q
 * - p, w), where p, q and w are below 2^15. scale_x rounds (q - p) * w / 2^15 to an integer, and w / 2^15 is
 * from 0 to 1, so the integer is from 0 to q - p. The sum is therefore from p to q. */
#include "engines/specialize/passes/range_halves.h"

#include "base/minmax.h"

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

/* A word that is shifted. Bits of the high half that remain in part in the low one leave nothing known there. */
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
