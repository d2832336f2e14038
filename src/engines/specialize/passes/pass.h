/* The passes over the IR and their list, def/engine/pass.def. The file of each pass states its preconditions
 * and postconditions.
 *
 * Every pass keeps the IR valid (ir_verify) and its results identical to the bit, and returns the number of
 * instructions that it changed. */
#ifndef ENGINES_SPECIALIZE_PASSES_PASS_H
#define ENGINES_SPECIALIZE_PASSES_PASS_H

#include "engines/specialize/peephole/peephole.h"
#include "ir/ir.h"

#include <assert.h>

enum pass {
#define PASS(name, ...) PASS_##name,
#include "def/engine/pass.def"
#undef PASS
    PASS_COUNT
};

enum profile { PROFILE_NONE, PROFILE_THESIS, PROFILE_FULL };

enum {
    PASS_LOOPS = IR_CAPACITY / 2 + 1, /* more loops than any program has */
    PASS_SCRATCH = 8 << 20            /* bytes */
};

/* The estimated cycles of a block of 16 pixels with one register of 8 lanes for each value, with two, and
 * with four registers for two blocks together; 0: not estimated, or `four` is not possible. */
struct pass_shapes {
    uint32_t one, two, four;
};

/* The memory of the passes, one for each build. Every pass keeps its working data in a structure of its own
 * in `scratch` (pass_scratch). */
struct pass_memory {
    unsigned lanes;            /* of a register: 1, 4, 8 or 16; 0: unknown */
    unsigned parts;            /* that each value is split into; 0 or 1: it is not split */
    bool judges;               /* the pass shape fills `shapes` */
    bool may_pair;             /* it sets `parts` to 4 where two blocks together are faster */
    struct pass_shapes shapes; /* those that are 0 */
    struct peepholes rules;
    struct ir_instruction
        rebuilt[IR_CAPACITY];  /* the new program, while a pass inserts or moves instructions */
    uint16_t map[IR_CAPACITY]; /* from old numbers to those of the new program */
    _Alignas(64) uint8_t scratch[PASS_SCRATCH];
};

/* Returns true if a program of 8 lanes may compute two blocks of 16 pixels together. It may not if it counts
 * pixels, because a block can be computed twice (split.c), or if it has windows or hints, whose code needs
 * the registers of the second block's addresses. */
bool pass_may_pair(const struct ir *ir);

/* Returns the scratch memory, as the structure of the pass that runs. Its contents are undefined. */
static inline void *pass_scratch(struct pass_memory *memory, size_t bytes)
{
    assert(bytes <= sizeof memory->scratch);
    return memory->scratch;
}

/* Building a new program in memory->rebuilt: pass_rebuild begins it with the nop and returns its count of
 * instructions; pass_append adds instruction `number` of the old program, with its operands renumbered;
 * pass_replace copies the first `count` instructions over the old program. */
uint32_t pass_rebuild(const struct ir *ir, struct pass_memory *memory);
void pass_replace(struct ir *ir, const struct pass_memory *memory, uint32_t count);

static inline void pass_append(const struct ir *ir, struct pass_memory *memory, uint32_t number,
                               uint32_t *count)
{
    struct ir_instruction *to = &memory->rebuilt[*count];
    *to = ir->instruction[number];
    for (int o = 0; o < 3; o++)
        to->operand[o] = memory->map[to->operand[o]];
    memory->map[number] = (uint16_t)(*count)++;
}

/* Removes the ends of a region that always runs; the joins after it become copies. */
void pass_open_region(struct ir *ir, uint32_t when);

/* The estimate of the pass shape for two registers, of a program in two parts (passes/early.c). */
uint32_t pass_estimate_parts(const struct ir *ir, struct pass_memory *memory);

typedef unsigned pass_function(struct ir *ir, struct pass_memory *memory);

#define PASS(name, ...) pass_function pass_##name;
#include "def/engine/pass.def"
#undef PASS

/* The name of pass i and one line about it; null past the last. */
const char *pass_name(unsigned i);
const char *pass_description(unsigned i);

/* Called after each run of a pass, with the number of instructions that it changed. */
typedef void pass_observer(void *context, enum pass pass, unsigned changed, const struct ir *ir);

/* Returns true if a pass runs in every profile and cannot be disabled. */
bool pass_is_required(unsigned i);

/* The passes of the profile and those enabled, without those disabled; bit p: pass p. */
uint32_t pass_select(enum profile profile, uint32_t enabled, uint32_t disabled);

/* Runs the passes whose bit is set in `passes` and the required ones, and compacts the program. Returns the
 * number of rounds. */
unsigned pass_run_all(struct ir *ir, struct pass_memory *memory, uint32_t passes, pass_observer *observer,
                      void *context);

/* The sections of values: the outermost section (ir.h) in which each can be computed.
 *
 * A value belongs to the section IR_SECTION_CALL if it is computed from literals, words of the job and
 * constants of shaders: it is the same in all lanes and for all elements of a call. A phi, a join and a
 * variable depend on their position, and belong to the body; so do reads of textures, which a routine may
 * also write. */

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
