/* The parts of the validator. Each checks one aspect of the rules, all in one pass through the instructions:
 *
 *   check.c          order, slots, declarations, results that must have been written at the end
 *   check_operand.c  sources: registers, ports, swizzles, modifiers, reads before any write
 *   check_result.c   destinations: registers, masks, modifiers, a pixel shader's outputs
 *   check_flow.c     blocks, loops, subroutines, their depths and counts, divergence
 *   check_pixel.c    texture instructions and pairs of ps_1_x, dependent reads of ps_2_0
 *
 * A component counts as written from the first instruction in the text that can write it, even inside a
 * branch; after a call, from the subroutine's instructions. In models of OpenGL all are written before. Each
 * function returns 0, or -1 with the reason.
 */
#ifndef SHADER_CHECK_CHECK_H
#define SHADER_CHECK_CHECK_H

#include "shader/shader.h"

enum {
    CHECK_TEMPORARIES = 256,
    CHECK_INPUTS = 16,
    CHECK_STAGES = 8,
    CHECK_SAMPLERS = 16,
    CHECK_TARGETS = 4,
    CHECK_PASSES = 65536, /* of a loop in models of OpenGL */
    CHECK_BLOCKS = 160,   /* more than any model's depths together */
};

/* Masks of components that an instruction has written. */
struct written {
    uint8_t temporary[CHECK_TEMPORARIES], texture[CHECK_STAGES], address, predicate;
};

struct block {
    uint8_t opcode; /* the instruction that opened it: if, its comparison, loop, rep, while */
    bool dynamic;   /* pixels may differ in whether they run it */
    bool has_else;
    uint32_t opened;
};

struct subroutine {
    uint32_t position; /* of its label; UINT32_MAX if there is none */
    uint16_t depth;    /* nesting of calls, this one included */
    bool divergent;    /* called where pixels may differ */
    struct written written;
};

struct check {
    const struct shader *shader;
    const struct shader_model *model;
    struct error *error;
    const struct shader_instruction *at; /* the instruction that is checked */
    const struct shader_operation *row;
    unsigned slots, arithmetic, texture;
    bool begun; /* an instruction that executes has been checked */
    struct written written;

    /* check.c */
    uint8_t declared_input[CHECK_INPUTS], declared_texture[CHECK_STAGES], declared_output[CHECK_INPUTS];
    uint8_t declared_kind[CHECK_SAMPLERS]; /* of the texture; 0 if the sampler is not declared */
    bool declared_place, declared_face, declared_sprite;
    uint8_t position, target[CHECK_TARGETS], depth; /* components written */
    uint8_t output[CHECK_INPUTS];
    int position_output; /* vs_3_0: the register declared as the position, or -1 */

    /* check_flow.c */
    struct block blocks[CHECK_BLOCKS];
    unsigned block_count, branches, dynamic, loops, flow;
    bool ended;                     /* after the ret of the main program or of a subroutine */
    struct subroutine *subroutines; /* null if the shader has none */
    unsigned labels;                /* their number: one more than the highest l# of a label */
    struct subroutine *inside;      /* null in the main program */

    /* check_pixel.c */
    unsigned stages_done; /* ps_1_1 to ps_1_3: one more than the last stage that was used */
    unsigned pads;        /* rows of a matrix so far, and the last one's instruction and stage */
    unsigned pad_opcode, pad_stage;
    unsigned phase, divides;          /* ps_1_4: 1 or 2, 0 before the first instruction; uses of _dz */
    bool arithmetic_begun, bumped;    /* in this phase; bem has been seen */
    uint8_t selected[CHECK_STAGES];   /* ps_1_4: how t# has been read, as the third component plus one */
    uint8_t stage_used;               /* ps_1_4: r# that this phase has sampled to */
    uint8_t order[CHECK_TEMPORARIES]; /* of the texture reads that r# depends on */
};

/* Sets the reason, with the place of an operand of the current instruction; or of the instruction if
 * `operand` is null. Returns -1. */
#define REFUSE(check, operand, ...)                                                                          \
    shader_fail((check)->shader, (check)->at, operand, (check)->error, __VA_ARGS__)

/* check.c: the pass in steps, for code that writes a shader and checks each instruction as it is added. Call
 * check_flow_begin first, then check_instruction for each. Labels, breaks and `phase`, which the rules look
 * ahead for, must be in the shader when check_flow_begin is called, or check.labels must be their number. */
struct check check_of(const struct shader *shader, struct error *error);
int check_instruction(struct check *check, uint32_t number);
void check_free(struct check *check);

/* check_operand.c */
bool check_is_in_array(const struct check *check, unsigned index); /* r#: an array has it */
int check_predicate(struct check *check);
int check_sources(struct check *check);

/* check_result.c */
int check_destination(struct check *check);

/* Adds what the instruction writes. */
void check_note_written(struct written *written, const struct shader_instruction *instruction);

/* check_flow.c */
int check_flow_begin(struct check *check); /* before the first instruction; allocates */
int check_flow(struct check *check);
int check_flow_end(struct check *check);

/* Returns true if pixels of a quad may differ in whether they run the current instruction. */
bool check_is_divergent(const struct check *check);

/* check_pixel.c */
int check_pixel(struct check *check);
int check_pairing(struct check *check);

#endif
