/* What 16 lanes have of their own: first of all masks that are 16 bits.
 *
 * Sixteen lanes are a whole block, so the coverage of an entry is a mask as it stands, a load of two bytes in place of a
 * comparison of each lane's bit; and since an entry has coverage, what asks for any need not ask. A store of a selection
 * between a new value and what was there becomes a store of the lanes selected, without reading:
 *
 * Last, w where perspective has none of it: a triangle parallel to the screen, as all of flat pictures are, has 1/w the same
 * at all pixels. The routine looks at the plane, which is cheaper than to divide, if that says 1 everywhere.
 *
 *   eq (and uniform bits) bits       ->  coverage
 *   when coverage ... end            ->  ...
 *   store (select mask a (load p))   ->  store_where a mask
 *   div 1 (mad x dx (mad y dy v))    ->  reciprocal x y
 *
 * What was computed for these is removed at once. */
#include "def/lane.h"
#include "draw/call.h"
#include "jit/pass.h"

#include <stddef.h>

static const struct ir_instruction *operand(const struct ir *ir, const struct ir_instruction *i, int o)
{
    return &ir->instruction[i->operand[o]];
}

static int is_lane_bits(const struct ir_instruction *i)
{
    return i->op == IR_load && i->base == BASE_LANES && i->k == (int32_t)offsetof(struct lane_table, bit);
}

/* What an `and` of the lanes' bits is with: a word of the entry; null if it is something else. */
static const struct ir_instruction *entry_bits(const struct ir *ir, const struct ir_instruction *i)
{
    for (int o = 0; i->op == IR_and_i && o < 2; o++) {
        const struct ir_instruction *bits = operand(ir, i, o);
        if (bits->op == IR_uniform && bits->base == BASE_ENTRY && is_lane_bits(operand(ir, i, 1 - o)))
            return bits;
    }
    return NULL;
}

static unsigned become_coverage(const struct ir *ir, struct ir_instruction *i)
{
    for (int o = 0; o < 2; o++) {
        const struct ir_instruction *bits = entry_bits(ir, operand(ir, i, o));
        if (!bits || !is_lane_bits(operand(ir, i, 1 - o)))
            continue;
        *i = (struct ir_instruction){.op = IR_coverage,
                                     .type = TYPE_msk,
                                     .base = BASE_ENTRY,
                                     .k = bits->k,
                                     .line = i->line,
                                     .file = i->file};
        return 1;
    }
    return 0;
}

/* A region that always runs is none: what is joined behind it is what it computed. */
static unsigned open_region(struct ir *ir, uint32_t when)
{
    const struct ir_instruction *mask = operand(ir, &ir->instruction[when], 0);
    if (mask->op != IR_coverage || mask->k != (int32_t)offsetof(struct entry, coverage))
        return 0;
    uint32_t end = ir_other_end(ir, when);
    for (uint32_t join = end + 1; join < ir->count && ir->instruction[join].op == IR_join; join++) {
        struct ir_instruction *i = &ir->instruction[join];
        i->op = IR_copy;
        i->operand[0] = i->operand[1];
        i->operand[1] = 0;
    }
    ir->instruction[when] = ir->instruction[end] = (struct ir_instruction){.op = IR_nop};
    return 1;
}

/* Whether nothing is written to a base between two places. */
static int is_unwritten(const struct ir *ir, unsigned base, uint32_t from, uint32_t to)
{
    for (uint32_t n = from + 1; n < to; n++) {
        const struct ir_instruction *i = &ir->instruction[n];
        int writes = i->op == IR_store || i->op == IR_scatter || i->op == IR_store_where;
        if ((writes && i->base == base) || i->op == IR_loop || i->op == IR_again)
            return 0;
    }
    return 1;
}

static unsigned become_store_where(const struct ir *ir, uint32_t number, struct ir_instruction *i)
{
    const struct ir_instruction *select = operand(ir, i, 0);
    if (select->op != IR_select_i && select->op != IR_select_f)
        return 0;
    const struct ir_instruction *before = operand(ir, select, 2);
    if (before->op != IR_load || before->base != i->base || before->k != i->k ||
        !is_unwritten(ir, i->base, select->operand[2], number))
        return 0;
    i->op = IR_store_where;
    i->operand[0] = select->operand[1];
    i->operand[1] = select->operand[0];
    return 1;
}

/* Whether this is the word of a triangle's record at `offset`; with an offset of -1, any. */
static int is_record_word(const struct ir_instruction *i, int32_t offset)
{
    return i->op == IR_uniform && i->base == BASE_TRIANGLE && (offset < 0 || i->k == offset);
}

/* The operand of a multiply-add that is multiplied by a word of the record; -1: neither or both. */
static int multiplied(const struct ir *ir, const struct ir_instruction *i)
{
    int first = is_record_word(operand(ir, i, 0), -1), second = is_record_word(operand(ir, i, 1), -1);
    return i->op != IR_mad_f || first == second ? -1 : first;
}

static unsigned become_reciprocal(const struct ir *ir, struct ir_instruction *i)
{
    const struct ir_instruction *one = operand(ir, i, 0), *column = operand(ir, i, 1);
    if (one->op != IR_literal || one->k != (int32_t)lane_bits(1.0f))
        return 0;
    int x = multiplied(ir, column);
    const struct ir_instruction *row = operand(ir, column, 2);
    int y = x < 0 ? -1 : multiplied(ir, row);
    if (y < 0 || !is_record_word(operand(ir, row, 2), -1))
        return 0;
    int32_t plane = operand(ir, row, 2)->k;
    if (!is_record_word(operand(ir, column, !x), plane + (int32_t)offsetof(struct plane, dx)) ||
        !is_record_word(operand(ir, row, !y), plane + (int32_t)offsetof(struct plane, dy)))
        return 0;
    *i = (struct ir_instruction){.op = IR_reciprocal,
                                 .type = TYPE_flt,
                                 .base = BASE_TRIANGLE,
                                 .operand = {column->operand[x], row->operand[y]},
                                 .k = plane,
                                 .line = i->line,
                                 .file = i->file};
    return 1;
}

unsigned pass_wide(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = 0;
    if (memory->lanes != 16)
        return 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        if (i->op == IR_eq_i)
            changes += become_coverage(ir, i);
        else if (i->op == IR_div_f)
            changes += become_reciprocal(ir, i);
        else if (i->op == IR_when)
            changes += open_region(ir, number);
        else if (i->op == IR_store)
            changes += become_store_where(ir, number, i);
    }
    if (changes)
        pass_dead(ir, memory);
    return changes;
}
