/* The sections of values: the outermost section (ir.h) in which each can be computed.
 *
 * A value belongs to the section IR_SECTION_CALL if it is computed from literals, words of the job and
 * constants of shaders: it is the same in all lanes and for all elements of a call. A phi, a join and a
 * variable depend on their position, and belong to the body; so do reads of textures, which a routine may
 * also write. */
#ifndef ENGINES_SPECIALIZE_PASSES_SECTION_H
#define ENGINES_SPECIALIZE_PASSES_SECTION_H

#include "ir/ir.h"

#include <assert.h>

/* The section of a value whose operands' sections are known; that of value 0, which means no operand, is the
 * outermost. */
static inline uint8_t pass_section_of(const struct ir_instruction *i, const uint8_t *section)
{
    static_assert(IR_SECTION_CALL == 0 && IR_SECTION_BODY == 1, "the sections of operands can be combined");
    if (!(ir_properties(i) & IR_COMPUTES) && i->op != IR_copy && i->op != IR_literal &&
        i->op != IR_constant && !ir_reads_call(i))
        return IR_SECTION_BODY;
    return section[i->operand[0]] | section[i->operand[1]] | section[i->operand[2]];
}

/* Finds the section of each value. */
static inline void pass_find_sections(const struct ir *ir, uint8_t section[IR_CAPACITY])
{
    section[0] = IR_SECTION_CALL;
    for (uint32_t number = 1; number < ir->count; number++)
        section[number] = (uint8_t)pass_section_of(&ir->instruction[number], section);
}

#endif
