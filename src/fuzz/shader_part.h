/* The parts of the writer of random shaders:
 *
 *   shader.c          whole shaders, and what the caller learns of them
 *   shader_operand.c  operands: registers that can be read or written here, swizzles, modifiers
 *   shader_propose.c  instructions: proposed from the table, put before the validator, kept if it agrees
 *   shader_body.c     runs of instructions, conditions, loops, subroutines
 *   shader_vertex.c   declarations and outputs of vertex shaders
 *   shader_pixel.c    those of pixel shaders from 2.0 on
 *   shader_stage.c    ps_1_1 to ps_1_4 */
#ifndef FUZZ_SHADER_PART_H
#define FUZZ_SHADER_PART_H

#include "fuzz/shader.h"
#include "shader/check.h"

enum {
    MAKER_WILD = 120,    /* magnitude of what can be anything */
    MAKER_LARGE = 8,     /* magnitudes above are avoided */
    MAKER_LABELS = 4,    /* most subroutines */
    MAKER_MARGIN = 12,   /* slots of the most expensive instruction, under a predicate */
    MAKER_BUDGET = 1500, /* instructions that a run executes about, at most */
    MAKER_SAMPLERS = 16
};

/* Components, as masks. */
enum { MASK_X = 1, MASK_XY = 3, MASK_XYZ = 7, MASK_W = 8 };

struct maker {
    struct random *random;
    const struct fuzz_shader_options *options;
    const struct shader_model *model;
    struct fuzz_shader *made;
    struct shader *shader;
    struct check check; /* knows what is declared, written, open and used up */
    struct error refusal;
    struct error *error; /* of memory; `failed` with it */
    bool failed, wild;

    /* style */
    unsigned pool;      /* r0 to here are written */
    unsigned constants; /* c0 to here are read */
    unsigned flow;      /* one in so many instructions is flow control; 0: none */
    unsigned predicated, textured;
    unsigned depth; /* of blocks, at most */

    uint32_t fresh;                  /* r# written and not read since */
    uint8_t size[CHECK_TEMPORARIES]; /* values of r# are about below 2 to this power */
    unsigned left;                   /* instructions still to write */
    unsigned reserve;                /* slots that must be left for what is open and for the end */
    unsigned trips,
        executed; /* how often the loops around run what is in them; instructions that a run executes */
    uint16_t defined_integers; /* i#, by the shader */
    uint16_t known_integers;   /* those, and others that made->integer has values for */
    uint16_t defined_booleans; /* b# */
    unsigned labels, label;    /* subroutines, and which is being written; labels in the main program */
    bool nested;               /* subroutines call later ones */
};

/* --- Chance */

static inline unsigned below(struct maker *maker, unsigned limit)
{
    return random_below(maker->random, limit);
}

static inline bool one_in(struct maker *maker, unsigned count)
{
    return random_chance(maker->random, count);
}

/* The number of a bit that is set, any of them; the mask is not 0. */
unsigned any_bit(struct maker *maker, uint32_t mask);

/* --- Operands (shader_operand.c) */

struct shader_operand operand_of(enum shader_file file, unsigned index);
struct shader_operand result_of(enum shader_file file, unsigned index, unsigned mask);

/* A source for the instruction, whose destination and earlier sources are chosen. False if there is none. */
bool choose_source(struct maker *maker, struct shader_instruction *instruction, unsigned source);

/* A destination, with mask and modifiers. */
void choose_result(struct maker *maker, struct shader_instruction *instruction);

/* An input that is there, without swizzle; of no file if there is none. */
struct shader_operand choose_input(struct maker *maker);

/* A mask that the instruction takes. */
unsigned choose_mask(struct maker *maker, const struct shader_operation *row);

/* Modifiers that the result can have: _sat, _pp, shifts. */
void choose_result_modifiers(struct maker *maker, struct shader_instruction *instruction);

/* A component of p0 that is written, replicated, or all, of which those in the mask are needed. */
struct shader_operand choose_predicate(struct maker *maker, unsigned mask);

/* An r# with all of these components written, one that nobody has read if there is one; -1 if there is none. */
int written_register(struct maker *maker, unsigned mask);

/* --- Instructions (shader_propose.c) */

/* Adds the instruction if the validator agrees. */
bool add(struct maker *maker, const struct shader_instruction *instruction);

/* A random instruction of the operation, to the destination if it is not null (which then has mask and modifiers). */
bool propose(struct maker *maker, enum shader_opcode opcode, const struct shader_operand *destination);

/* Of a random operation among those that give a value (no texture instructions). Falls back on mov. */
bool propose_any(struct maker *maker, const struct shader_operand *destination);

/* A declaration or a definition. */
bool declare(struct maker *maker, struct shader_operand declared, unsigned usage, unsigned usage_index,
             unsigned kind);

/* Whether the model has the operation. */
bool has_operation(const struct maker *maker, enum shader_opcode opcode);

/* Whether so many slots are left, besides those that are reserved. */
bool has_room(const struct maker *maker, unsigned slots);

/* --- Bodies (shader_body.c) */

/* def, defi and defb, and the maker's style; before all others. */
void write_definitions(struct maker *maker);

/* About as many instructions as are left; plans subroutines, which end_body adds behind the main program's ret. */
void write_body(struct maker *maker);
void end_body(struct maker *maker);

/* Adds up what nobody has read, into the register. Its magnitude stays below MAKER_LARGE if the maker is tame. */
void gather_fresh(struct maker *maker, unsigned into);

/* --- Whole shaders */

void write_vertex(struct maker *maker);
void write_pixel(struct maker *maker);
void write_stages(struct maker *maker);

/* dcl of so many samplers, with kinds. */
void declare_samplers(struct maker *maker, unsigned count);

#endif
