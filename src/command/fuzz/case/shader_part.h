/* The parts of the writer of random shaders:
 *
 *   shader.c          whole shaders, and the interface for the caller
 *   shader_operand.c  operands: registers that can be read or written here, swizzles, modifiers
 *   shader_result.c   destinations: registers that can be written, masks, modifiers
 *   shader_propose.c  instructions: proposed from the table, put before the validator, kept if it agrees
 *   shader_body.c     runs of instructions, conditions, loops, subroutines
 *   shader_vertex.c   declarations and outputs of vertex shaders
 *   shader_pixel.c    those of pixel shaders from 2.0 on
 *   shader_stage.c    ps_1_1 to ps_1_4 */
#ifndef COMMAND_FUZZ_CASE_SHADER_PART_H
#define COMMAND_FUZZ_CASE_SHADER_PART_H

#include "command/fuzz/case/shader.h"
#include "shader/check/check.h"

enum {
    MAKER_WILD = 120,    /* magnitude of what can be anything */
    MAKER_LARGE = 8,     /* magnitudes above are avoided */
    MAKER_LABELS = 4,    /* most subroutines */
    MAKER_MARGIN = 12,   /* slots of the most expensive instruction, under a predicate */
    MAKER_BUDGET = 1500, /* instructions that a run executes about, at most */
    MAKER_SAMPLERS = 16,
    MAKER_TEMPORARIES = 32, /* r# that are chosen; in models of OpenGL they are moved in the end */
    MAKER_COUNTER = 254     /* r# and the one after it count the passes of the outermost `while` */
};

/* Components, as masks. */
enum { MASK_X = 1, MASK_XY = 3, MASK_XYZ = 7, MASK_W = 8 };

struct maker {
    struct random *random;
    const struct fuzz_shader_options *options;
    const struct shader_model *model;
    struct fuzz_shader *made;
    struct shader *shader;
    struct check check; /* the declared and written registers, open blocks, used slots */
    struct error refusal;
    struct error *error; /* of memory; `failed` with it */
    bool failed, wild;

    /* style */
    unsigned pool;      /* r0 to here are written */
    unsigned constants; /* c0 to here are read */
    unsigned flow;      /* one in `flow` instructions is flow control; 0: none */
    unsigned predicated, textured;
    unsigned depth; /* of blocks, at most */

    uint32_t fresh;                  /* r# written and not read since */
    uint8_t size[CHECK_TEMPORARIES]; /* values of r# are about below 2 to this power */
    unsigned array, array_end; /* the first r# of an array, and one more than the last; 0: there is none */
    unsigned left;             /* instructions still to write */
    unsigned reserve;          /* slots that must be left for what is open and for the end */
    unsigned trips,
        executed; /* how often the loops around run what is in them; instructions that a run executes */
    uint16_t defined_integers; /* i#, by the shader */
    uint16_t known_integers;   /* those, and others that made->integer has values for */
    uint16_t defined_booleans; /* b# */
    unsigned labels, label;    /* subroutines, and which is being written; labels in the main program */
    bool nested;               /* subroutines call later ones */
};

/* --- Chance --------------------------------------------------------------------------------------------- */

static inline unsigned below(struct maker *maker, unsigned limit)
{
    return random_below(maker->random, limit);
}

static inline bool one_in(struct maker *maker, unsigned count)
{
    return random_chance(maker->random, count);
}

static inline bool is_pixel(const struct maker *maker)
{
    return maker->model->stage == STAGE_PIXEL;
}

/* ps_1_1 to ps_1_3: t# are values. */
static inline bool has_texture_values(const struct maker *maker)
{
    return maker->model->column >= COLUMN_PS_1_1 && maker->model->column <= COLUMN_PS_1_3;
}

static inline bool is_opengl(const struct maker *maker)
{
    return shader_is_opengl(maker->model);
}

/* The number of a bit that is set, any of them; the mask is not 0. */
unsigned fuzz_shader_any_bit(struct maker *maker, uint32_t mask);

/* --- Operands (shader_operand.c) ------------------------------------------------------------------------ */

struct shader_operand fuzz_shader_operand(enum shader_file file, unsigned index);
struct shader_operand fuzz_shader_result(enum shader_file file, unsigned index, unsigned mask);

/* A source for the instruction, whose destination and earlier sources are chosen. False if there is none. */
bool fuzz_shader_choose_source(struct maker *maker, struct shader_instruction *instruction, unsigned source);

/* A destination, with mask and modifiers. */
void fuzz_shader_choose_result(struct maker *maker, struct shader_instruction *instruction);

/* An input that is there, without swizzle; of no file if there is none. */
struct shader_operand fuzz_shader_choose_input(struct maker *maker);

/* Addresses a register of an array by a0 now and then. */
void fuzz_shader_make_element(struct maker *maker, struct shader_operand *operand);

/* A mask that the instruction takes. */
unsigned fuzz_shader_choose_mask(struct maker *maker, const struct shader_operation *row);

/* Modifiers that the result can have: _sat, _pp, shifts. */
void fuzz_shader_choose_modifiers(struct maker *maker, struct shader_instruction *instruction);

/* A written component of p0, replicated, or all of p0 if the components of the mask are written. */
struct shader_operand fuzz_shader_choose_predicate(struct maker *maker, unsigned mask);

/* An r# with all of these components written, if possible one that no instruction has read; -1 if there is
 * none. */
int fuzz_shader_written(struct maker *maker, unsigned mask);

/* --- Instructions (shader_propose.c) -------------------------------------------------------------------- */

/* Adds the instruction if the validator agrees. */
bool fuzz_shader_add(struct maker *maker, const struct shader_instruction *instruction);

/* A random instruction of the operation, to the destination if it is not null (which then has mask and
 * modifiers). */
bool fuzz_shader_propose(struct maker *maker, enum shader_opcode opcode,
                         const struct shader_operand *destination);

/* Of a random operation among those that give a value (no texture instructions). Falls back on mov. */
bool fuzz_shader_propose_any(struct maker *maker, const struct shader_operand *destination);

/* A declaration or a definition. */
bool fuzz_shader_declare(struct maker *maker, struct shader_operand declared, unsigned usage,
                         unsigned usage_index, unsigned kind);

/* Returns true if the model has the operation. */
bool fuzz_shader_has(const struct maker *maker, enum shader_opcode opcode);

/* Returns true if this number of slots is left, besides those that are reserved. */
bool fuzz_shader_has_room(const struct maker *maker, unsigned slots);

/* --- Bodies (shader_body.c) ----------------------------------------------------------------------------- */

/* def, defi and defb, and the maker's style; before all others. */
void fuzz_shader_definitions(struct maker *maker);

/* Writes about maker->left instructions and plans subroutines, which fuzz_shader_end adds after the main
 * program's ret. */
void fuzz_shader_body(struct maker *maker);
void fuzz_shader_end(struct maker *maker);

/* Adds the unread registers to register `into`. Its magnitude stays below MAKER_LARGE if the maker is
 * tame. */
void fuzz_shader_gather(struct maker *maker, unsigned into);

/* --- Whole shaders -------------------------------------------------------------------------------------- */

void fuzz_shader_vertex(struct maker *maker);
void fuzz_shader_pixel(struct maker *maker);
void fuzz_shader_stages(struct maker *maker);

/* Declares `count` samplers, with kinds. */
void fuzz_shader_samplers(struct maker *maker, unsigned count);

#endif
