/* The code of one stage while it is lowered: instructions on registers without a limit.
 *
 * A register has four components, as the machine's. A scalar or vector has one register, in the components
 * from x on. A matrix has one for each column, a structure or array those of its parts one after the other.
 * A bool is 0 or 1, an int a whole number in binary32.
 *
 * Registers of the file TEMPORARY are made without a limit; allocate.c gives them numbers. Those of other
 * files are numbered in the order of declarations; the linker gives them places. */
#ifndef FRONT_GLSL_LOWER_CODE_H
#define FRONT_GLSL_LOWER_CODE_H

#include "front/glsl/node.h"

#include <stdbool.h>
#include <stdint.h>

enum glsl_op {
#define GLSL_OP(id, text, sources, kind) GLSL_OP_##id,
#include "front/glsl/lower/op.def"
#undef GLSL_OP
    GLSL_OPS
};

enum glsl_op_kind { GLSL_EACH, GLSL_ONE, GLSL_FIXED, GLSL_APART, GLSL_FLOW, GLSL_SCALAR };

extern const struct glsl_op_row {
    const char *text;
    uint8_t sources, kind;
} glsl_ops[GLSL_OPS];

enum glsl_file {
    GLSL_FILE_NONE,
    GLSL_FILE_TEMPORARY,
    GLSL_FILE_LITERAL,   /* number: of a register of literals */
    GLSL_FILE_UNIFORM,   /* samplers too */
    GLSL_FILE_ATTRIBUTE, /* of a vertex shader */
    GLSL_FILE_VARYING,   /* results of a vertex shader, sources of a fragment shader */
    GLSL_FILE_RESULT,    /* number: enum glsl_result */
    GLSL_FILE_SOURCE     /* number: enum glsl_source */
};

/* The colours of GLSL_COLORS targets, then the second colour of blending. */
enum { GLSL_COLORS = 4 };
enum glsl_result {
    GLSL_RESULT_POSITION,
    GLSL_RESULT_POINT_SIZE,
    GLSL_RESULT_DEPTH,
    GLSL_RESULT_COLOR,
    GLSL_RESULT_SECOND = GLSL_RESULT_COLOR + GLSL_COLORS
};
enum glsl_source { GLSL_SOURCE_COORD, GLSL_SOURCE_FACING, GLSL_SOURCE_POINT };

enum glsl_comparison {
    GLSL_IS_GREATER,
    GLSL_IS_EQUAL,
    GLSL_IS_GREATER_EQUAL,
    GLSL_IS_LESS,
    GLSL_IS_NOT_EQUAL,
    GLSL_IS_LESS_EQUAL
};

/* Four components of two bits. */
enum { GLSL_XYZW = 0xe4, GLSL_XXXX = 0, GLSL_LITERALS = 256, GLSL_LEVELS = 4 };

static inline unsigned glsl_component(unsigned swizzle, unsigned i)
{
    return swizzle >> 2 * i & 3;
}

/* Returns the swizzle with component c in all places. */
static inline uint8_t glsl_replicate(unsigned c)
{
    return (uint8_t)(c * 0x55);
}

static inline unsigned glsl_mask(unsigned rows)
{
    return (1u << rows) - 1;
}

struct glsl_operand {
    uint8_t file; /* enum glsl_file */
    uint8_t swizzle;
    bool negative, absolute;
    uint8_t index_component;
    uint16_t access; /* of a relative operand: its struct glsl_access; 0: it is not relative */
    uint32_t number;
    uint32_t index; /* the temporary whose component is added to the number */
};

/* The registers that a relative operand can mean: number + the sum of stride * (0 to count - 1) of each
 * level. They are within a block, which keeps its order and has no gaps. */
struct glsl_access {
    uint32_t first, registers; /* the block */
    unsigned levels;
    struct {
        uint32_t stride, count;
    } level[GLSL_LEVELS];
};

struct glsl_instruction {
    uint8_t op;         /* enum glsl_op */
    uint8_t comparison; /* enum glsl_comparison */
    uint8_t mask;       /* the written components; 0: removed, unless it is FLOW */
    uint32_t region;
    struct glsl_operand to, from[4];
};

struct glsl_temporary {
    uint32_t home; /* the region in which it was made; all uses are inside of it */
    uint32_t writes;
    bool variable; /* it has a name in the source, so it can change */
    bool global;
    uint8_t live;              /* components that are read later */
    uint32_t block, registers; /* of an array that is accessed by a relative address; 0 registers: none */
    uint32_t first, last;      /* the instructions that need it */
    uint32_t place;            /* r# */
};

/* A uniform, attribute or varying: its registers. */
struct glsl_slot {
    const struct glsl_variable *variable;
    uint32_t first, registers;
};

struct glsl_slots {
    struct glsl_slot *slot;
    unsigned count, room;
    uint32_t registers;
};

struct glsl_literal {
    float value[4];
    unsigned count;
};

struct glsl_code {
    struct glsl_arena *arena;
    const struct glsl_unit *unit;
    const char *failure; /* the reason why the stage cannot be lowered; null: none */
    struct glsl_instruction *instruction;
    uint32_t count, room;
    struct glsl_temporary *temporary;
    uint32_t temporaries, temporary_room;
    struct glsl_access *access; /* the first one is not used */
    uint32_t accesses, access_room;
    uint32_t region, regions; /* the current one, and their number; numbered in order */
    uint32_t *parent;         /* of each region */
    uint32_t parent_room;
    unsigned blocks, loops; /* around the next instruction */
    bool has_loop;
    struct glsl_literal literal[GLSL_LITERALS];
    unsigned literals;
    struct glsl_slots uniform, attribute, varying;
    const uint8_t *needed; /* the components of each varying that the fragment shader reads; null: all */
};

enum { GLSL_MOST_INSTRUCTIONS = 65000, GLSL_MOST_BLOCKS = 64, GLSL_MOST_LOOPS = 16 };

/* Notes the first reason; nothing is emitted after it. */
void glsl_code_fail(struct glsl_code *code, const char *reason);

/* Makes consecutive temporaries; returns the first. */
uint32_t glsl_code_temporary(struct glsl_code *code, unsigned count);

/* The registers of a variable; added at its first use. */
struct glsl_slot *glsl_code_slot(struct glsl_code *code, struct glsl_slots *slots,
                                 const struct glsl_variable *variable);

/* The number of registers of a value. */
uint32_t glsl_registers(struct glsl_type type);

struct glsl_operand glsl_operand_temporary(uint32_t number, unsigned rows);
/* The operand's components rearranged: component i of the result is component i of `swizzle` of it. */
struct glsl_operand glsl_operand_swizzled(struct glsl_operand operand, uint8_t swizzle);
struct glsl_operand glsl_operand_scalar(struct glsl_operand operand, unsigned component);
struct glsl_operand glsl_operand_negative(struct glsl_operand operand);
/* A register with up to four literals in the order of the components; a register is shared if it has
 * them. */
struct glsl_operand glsl_operand_literals(struct glsl_code *code, const float *value, unsigned count);
struct glsl_operand glsl_operand_literal(struct glsl_code *code, float value);

/* Appends an instruction. Unused sources have the file NONE. */
struct glsl_instruction *glsl_emit(struct glsl_code *code, enum glsl_op op, struct glsl_operand to,
                                   unsigned mask, const struct glsl_operand *from);

/* Appends an instruction with a new temporary of `rows` components as its result, which is returned. */
struct glsl_operand glsl_emit_1(struct glsl_code *code, enum glsl_op op, unsigned rows,
                                struct glsl_operand a);
struct glsl_operand glsl_emit_2(struct glsl_code *code, enum glsl_op op, unsigned rows, struct glsl_operand a,
                                struct glsl_operand b);
struct glsl_operand glsl_emit_3(struct glsl_code *code, enum glsl_op op, unsigned rows, struct glsl_operand a,
                                struct glsl_operand b, struct glsl_operand c);

/* a . b of vectors of `rows` components. */
struct glsl_operand glsl_emit_dot(struct glsl_code *code, unsigned rows, struct glsl_operand a,
                                  struct glsl_operand b);

/* Writes components of `to`: component c of the mask is component c of the operand. The instructions that
 * computed the operand write `to` themselves if nothing else reads their result: then the operand is no
 * longer valid. */
void glsl_emit_store(struct glsl_code *code, struct glsl_operand to, unsigned mask,
                     struct glsl_operand value);

/* Flow control. Blocks are regions. */
void glsl_emit_if(struct glsl_code *code, enum glsl_comparison comparison, struct glsl_operand a,
                  struct glsl_operand b);
void glsl_emit_else(struct glsl_code *code);
void glsl_emit_endif(struct glsl_code *code);
void glsl_emit_while(struct glsl_code *code);
void glsl_emit_endwhile(struct glsl_code *code);
void glsl_emit_jump(struct glsl_code *code, enum glsl_op op);
void glsl_emit_jump_if(struct glsl_code *code, enum glsl_op op, enum glsl_comparison comparison,
                       struct glsl_operand a, struct glsl_operand b);

/* live.c: removes instructions without an effect. */
void glsl_code_remove_dead(struct glsl_code *code);

/* allocate.c: gives temporaries their r#. Returns the number of r#. */
unsigned glsl_code_allocate(struct glsl_code *code);

#endif
