/* Simplifications for 16 lanes only.
 *
 *   eq (and uniform bits) bits       ->  coverage
 *   when coverage ... end            ->  ...
 *   store (select mask a (load p))   ->  store_where a mask
 *   div 1 (mad x dx (mad y dy v))    ->  reciprocal x y
 *
 * Sixteen lanes are a whole 4x4 block, and a mask has 16 bits. So the coverage of an entry is already a mask:
 * a load of two bytes replaces a comparison of each lane's bit. Every entry has coverage, so a region whose
 * condition is the coverage always runs. A store of a selection between a new value and the old contents
 * becomes a masked store, which does not read.
 *
 * A reciprocal is w at a pixel. On a triangle that is parallel to the screen, such as all triangles of flat
 * pictures, 1/w is the same at all pixels. If the plane of 1/w is 1 everywhere, which is cheap to test, the
 * routine skips the division.
 *
 * Values that are no longer used afterwards are removed. */
#include "base/bits.h"
#include "contract/lane.h"
#include "contract/arguments.h"
#include "engines/specialize/passes/pass.h"

#include <stddef.h>

static const struct ir_instruction *operand(const struct ir *ir, const struct ir_instruction *i, int o)
{
    return &ir->instruction[i->operand[o]];
}

static bool is_bits_of_float(const struct ir_instruction *i)
{
    return i->op == IR_load && i->base == BASE_LANES && i->k == (int32_t)offsetof(struct lane_table, bit);
}

/* The word of the entry whose `and` with the lanes' bits this is, or null. */
static const struct ir_instruction *entry_bits(const struct ir *ir, const struct ir_instruction *i)
{
    for (int o = 0; i->op == IR_and_i && o < 2; o++) {
        const struct ir_instruction *bits = operand(ir, i, o);
        if (bits->op == IR_uniform && bits->base == BASE_ENTRY && is_bits_of_float(operand(ir, i, 1 - o)))
            return bits;
    }
    return NULL;
}

static bool become_coverage(const struct ir *ir, struct ir_instruction *i)
{
    for (int o = 0; o < 2; o++) {
        const struct ir_instruction *bits = entry_bits(ir, operand(ir, i, o));
        if (!bits || !is_bits_of_float(operand(ir, i, 1 - o)))
            continue;
        *i = (struct ir_instruction){.op = IR_coverage,
                                     .type = TYPE_msk,
                                     .base = BASE_ENTRY,
                                     .k = bits->k,
                                     .line = i->line,
                                     .file = i->file,
                                     .origin = i->origin};
        return true;
    }
    return false;
}

/* Opens a region whose condition is the coverage of the block, which is never empty. */
static bool open_covered(struct ir *ir, uint32_t when)
{
    const struct ir_instruction *mask = operand(ir, &ir->instruction[when], 0);
    if (mask->op != IR_coverage || mask->k != (int32_t)offsetof(struct entry, coverage))
        return false;
    pass_open_region(ir, when);
    return true;
}

/* Returns true if no instruction between two numbers writes to `base`. */
static bool is_unwritten(const struct ir *ir, unsigned base, uint32_t from, uint32_t to)
{
    for (uint32_t n = from + 1; n < to; n++) {
        const struct ir_instruction *i = &ir->instruction[n];
        bool writes = ir_properties(i) & IR_WRITES && i->base == base;
        if (writes || i->op == IR_loop || i->op == IR_again)
            return false;
    }
    return true;
}

static bool become_store_where(const struct ir *ir, uint32_t number, struct ir_instruction *i)
{
    const struct ir_instruction *select = operand(ir, i, 0);
    if (select->op != IR_select_i && select->op != IR_select_f)
        return false;
    const struct ir_instruction *before = operand(ir, select, 2);
    if (before->op != IR_load || before->base != i->base || before->k != i->k ||
        !is_unwritten(ir, i->base, select->operand[2], number))
        return false;
    i->op = IR_store_where;
    i->operand[0] = select->operand[1];
    i->operand[1] = select->operand[0];
    return true;
}

/* Returns true if this is the word of a triangle's record at `offset`, or any of its words if that is -1. */
static bool is_record_word(const struct ir_instruction *i, int32_t offset)
{
    return i->op == IR_uniform && i->base == BASE_TRIANGLE && (offset < 0 || i->k == offset);
}

/* The operand of a multiply-add that is multiplied by a word of the record; -1 if neither is, or both. */
static int multiplied(const struct ir *ir, const struct ir_instruction *i)
{
    bool first = is_record_word(operand(ir, i, 0), -1), second = is_record_word(operand(ir, i, 1), -1);
    return i->op != IR_mad_f || first == second ? -1 : first;
}

static bool become_reciprocal(const struct ir *ir, struct ir_instruction *i)
{
    const struct ir_instruction *one = operand(ir, i, 0), *column = operand(ir, i, 1);
    if (one->op != IR_literal || one->k != (int32_t)bits_of_float(1.0f))
        return false;
    int x = multiplied(ir, column);
    const struct ir_instruction *row = operand(ir, column, 2);
    int y = x < 0 ? -1 : multiplied(ir, row);
    if (y < 0 || !is_record_word(operand(ir, row, 2), -1))
        return false;
    int32_t plane = operand(ir, row, 2)->k;
    if (!is_record_word(operand(ir, column, !x), plane + (int32_t)offsetof(struct plane, dx)) ||
        !is_record_word(operand(ir, row, !y), plane + (int32_t)offsetof(struct plane, dy)))
        return false;
    *i = (struct ir_instruction){.op = IR_reciprocal,
                                 .type = TYPE_flt,
                                 .base = BASE_TRIANGLE,
                                 .operand = {column->operand[x], row->operand[y]},
                                 .k = plane,
                                 .line = i->line,
                                 .file = i->file,
                                 .origin = i->origin};
    return true;
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
            changes += open_covered(ir, number);
        else if (i->op == IR_store)
            changes += become_store_where(ir, number, i);
    }
    if (changes)
        pass_dead(ir, memory);
    return changes;
}
