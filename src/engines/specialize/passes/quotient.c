/* Divisions of whole numbers by constants, such as the channel / 255 of a packed colour:
 *
 *   div x d   ->   mad x high (mul x low),   with high = round(1 / d), low = round(1 / d - high)
 *   div x d   ->   mul x (1 / d),            if d is a power of two
 *
 * A division keeps the processor's divider busy for five cycles and more; the other two take one together.
 *
 * The bits stay the same. x is an integer that was rounded to binary32, so x is 0 or at least 1 in
 * magnitude. d is an integer from 2 to 2^16. No value is a denormal, infinite or NaN. x is not -0: if it
 * is 0, x * low may be -0, but its sum with +0 is +0, as x / d is. Otherwise, high + low is 1 / d with a
 * relative error of about 2^-48, and the rounding of the product x * low adds as much. So the sum is q = x
 * / d with a relative error below 2^-46 before it is rounded. It is rounded as q is, unless a number m
 * halfway between two neighbours of binary32 is q or lies between q and the sum. m is an odd number of 25
 * bits, times a power of two, and x has at most 24 bits, so m * d is not x. Both are multiples of the last
 * place of m, so they differ by at least that, which is more than x / 2^42. So m is further away from q
 * than the sum. */
#include "base/bits.h"
#include "engines/specialize/passes/pass.h"

#include <math.h>
#include <string.h>

enum { DIVISOR_MAXIMUM = 1 << 16 };

struct quotient_memory {
    uint16_t divisions[IR_CAPACITY]; /* of each literal: those by it that are replaced */
    uint16_t high[IR_CAPACITY];      /* of such a literal: its reciprocal in the new program, and */
    uint16_t low[IR_CAPACITY];       /* what is left of it; 0: nothing */
};

static_assert(sizeof(struct quotient_memory) <= PASS_SCRATCH, "scratch memory is large enough");

static bool is_divisor(const struct ir_instruction *literal)
{
    const float d = bits_to_float(literal->k);
    return literal->op == IR_literal && d >= 2 && d <= DIVISOR_MAXIMUM && d == floorf(d);
}

static bool is_replaced(const struct ir *ir, const struct ir_instruction *i)
{
    return i->op == IR_div_f && ir->instruction[i->operand[0]].op == IR_float_f &&
           is_divisor(&ir->instruction[i->operand[1]]);
}

/* Counts the divisions by each literal. Returns the number of all, or 0 if the new program would be too
 * long. */
static unsigned find_divisions(const struct ir *ir, struct quotient_memory *m)
{
    unsigned divisions = 0, divisors = 0;
    memset(m->divisions, 0, ir->count * sizeof *m->divisions);
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (!is_replaced(ir, i))
            continue;
        divisions++;
        divisors += !m->divisions[i->operand[1]]++;
    }
    return ir->count + divisions + 2 * divisors <= IR_CAPACITY ? divisions : 0;
}

static uint16_t append(struct pass_memory *memory, uint32_t *count, struct ir_instruction i)
{
    memory->rebuilt[*count] = i;
    return (uint16_t)(*count)++;
}

/* The literals have the place of the divisor, so they can be used wherever it can. */
static void append_literals(struct pass_memory *memory, struct quotient_memory *m,
                            const struct ir_instruction *divisor, uint32_t number, uint32_t *count)
{
    struct ir_instruction literal = *divisor;
    const double exact = 1.0 / (double)bits_to_float(divisor->k);
    const float high = (float)exact, low = (float)(exact - (double)high);
    literal.k = (int32_t)bits_of_float(high);
    m->high[number] = append(memory, count, literal);
    literal.k = (int32_t)bits_of_float(low);
    m->low[number] = low == 0 ? 0 : append(memory, count, literal);
}

static void append_quotient(struct pass_memory *memory, const struct quotient_memory *m,
                            const struct ir_instruction *division, uint32_t number, uint32_t *count)
{
    const uint16_t x = memory->map[division->operand[0]], high = m->high[division->operand[1]],
                   low = m->low[division->operand[1]];
    struct ir_instruction i = *division;
    i.op = IR_mul_f;
    i.operand[0] = x;
    i.operand[1] = low ? low : high;
    uint16_t value = append(memory, count, i);
    if (low) {
        i.op = IR_mad_f;
        i.operand[1] = high;
        i.operand[2] = value;
        value = append(memory, count, i);
    }
    memory->map[number] = value;
}

unsigned pass_quotient(struct ir *ir, struct pass_memory *memory)
{
    struct quotient_memory *m = pass_scratch(memory, sizeof *m);
    const unsigned divisions = find_divisions(ir, m);
    if (!divisions)
        return 0;
    uint32_t count = pass_rebuild(ir, memory);
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (is_replaced(ir, i))
            append_quotient(memory, m, i, number, &count);
        else
            pass_append(ir, memory, number, &count);
        if (i->op == IR_literal && m->divisions[number])
            append_literals(memory, m, i, number, &count);
    }
    pass_replace(ir, memory, count);
    pass_dead(ir, memory);
    return divisions;
}
