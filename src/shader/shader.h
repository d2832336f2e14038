/* Shaders of the models 1.1 to 3.0 of Direct3D 9 and the models of OpenGL, as the tables in def/shader
 * describe them.
 *
 * A `struct shader` is one decoded shader: a flat array of instructions whose operands are resolved to a
 * register file, a number and modifiers. It is made from text (shader_assemble) or from bytecode
 * (shader_read), and converted to bytecode (shader_encode) or canonical text (shader_print). shader_validate
 * validates it against the rules of its model; engines run validated shaders only. Text and bytecode are
 * equivalent: printed text assembles to the same tokens, and encoded tokens read back as the same
 * instructions.
 *
 * The two readers check only that a shader can be represented: that its model has the instructions and
 * registers, that operands have the right number, that modifiers exist, that numbers fit their fields. The
 * validator checks everything else: limits, ports, masks, flow control, reads of registers that were never
 * written.
 *
 * Bounds: SHADER_BYTES of input, SHADER_INSTRUCTIONS. Nothing is recursive.
 *
 * Sources: Microsoft's reference of the shader assembly (asm-vs, asm-ps), d3d9types.h, and the driver kit's
 * "Shader Code Tokens". */
#ifndef SHADER_SHADER_H
#define SHADER_SHADER_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SHADER_BYTES = 16 << 20, SHADER_INSTRUCTIONS = 65536, SHADER_SOURCES = 4, SHADER_NAME_BYTES = 64 };

/* --- Tables -------------------------------------------------------------------------------------------- */

enum shader_stage { STAGE_VERTEX, STAGE_PIXEL };

enum shader_column {
    COLUMN_VS_1_1,
    COLUMN_VS_2_0,
    COLUMN_VS_2_X,
    COLUMN_VS_3_0,
    COLUMN_VS_GL,
    COLUMN_PS_1_1,
    COLUMN_PS_1_2,
    COLUMN_PS_1_3,
    COLUMN_PS_1_4,
    COLUMN_PS_2_0,
    COLUMN_PS_2_X,
    COLUMN_PS_3_0,
    COLUMN_PS_GL,
    COLUMN_COUNT
};

enum {
    CAN_SOFTWARE = 1,
    CAN_SWIZZLE = 2,
    CAN_DIFFERENCE = 4,
    CAN_PREDICATION = 8,
    CAN_DEPENDENT = 16,
    CAN_OPENGL = 32
};

struct shader_model {
    const char *name;
    uint8_t stage, column, capabilities;
    uint16_t version;            /* the low half of the version token */
    uint16_t slots;              /* 0: no limit */
    uint8_t arithmetic, texture; /* slots of each sort; 0: no limit */
    uint16_t temporaries;        /* r registers */
    uint8_t flow;                /* instructions of static flow control; 0: no limit */
    uint8_t branches, dynamic;   /* the deepest nesting: of if by constants, by values */
    uint8_t loops, calls;
};

enum shader_model_id {
#define MODEL(id, ...) MODEL_##id,
#include "def/shader/shader_model.def"
#undef MODEL
    MODEL_COUNT
};

extern const struct shader_model shader_models[MODEL_COUNT];

/* Kinds of operands. */
enum shader_operand_kind {
    OPERAND_NONE,
    /* destinations */
    OPERAND_RESULT,           /* anything that can be written */
    OPERAND_ADDRESS,          /* a0 */
    OPERAND_FLAGS,            /* p0 */
    OPERAND_STAGE,            /* t#: the texture stage is the register's number */
    OPERAND_TEMPORARY,        /* r# */
    OPERAND_KILL,             /* t#, r# or v#, which is read */
    OPERAND_DECLARED,         /* the register that dcl declares */
    OPERAND_CONSTANT,         /* c#, with four literals */
    OPERAND_CONSTANT_INTEGER, /* i#, with four literals */
    OPERAND_CONSTANT_BOOLEAN, /* b#, with one literal */
    /* sources */
    OPERAND_VECTOR,      /* a float register */
    OPERAND_SCALAR,      /* one component of it */
    OPERAND_MATRIX,      /* the first of consecutive registers */
    OPERAND_SCRATCH,     /* r#, whose value is lost */
    OPERAND_SERIES,      /* c#, unmodified */
    OPERAND_COORDINATES, /* the position to sample at */
    OPERAND_SAMPLER,
    OPERAND_SET,       /* ps_1_4: t#, or r# in the second phase */
    OPERAND_SAMPLED,   /* ps_1_1 to ps_1_3: t# that was sampled */
    OPERAND_CONDITION, /* b#, or a component of p0 */
    OPERAND_PREDICATE, /* a component of p0 */
    OPERAND_INTEGER,   /* i# */
    OPERAND_COUNTER,   /* aL */
    OPERAND_LABEL,
};

/* Write masks that an instruction takes. */
enum shader_masks {
    MASKS_ANY,
    MASKS_FULL,
    MASKS_FULL_2,     /* all four in models 2, any in 3 */
    MASKS_XY,         /* .xy */
    MASKS_XYZ,        /* .xyz */
    MASKS_XY_XYZ,     /* either */
    MASKS_NORMAL,     /* .xyz or all */
    MASKS_WITHIN_XYZ, /* no w */
    MASKS_WITHIN_XY,  /* x, y or both */
    MASKS_FRACTION,   /* vs_1_1: .y or .xy; any elsewhere */
};

/* The components that an instruction reads of a source, after its swizzle: a byte for the first source, and
 * one for all others. Bits 0 to 3 are x to w; bit 4 adds the components of the destination's mask. */
enum shader_reads {
    READS_NONE = 0,
    READS_XY = 0x0303,
    READS_XYZ = 0x0707,
    READS_XYZW = 0x0f0f,
    READS_XYW = 0x0b0b,
    READS_RESULT = 0x1010,
    READS_XYZ_RESULT = 0x1717,
    READS_YZ_YW = 0x0a06, /* .yz of the first source, .yw of the second */
};

enum { COMPARISON = 0xff };

enum {
    IS_SETUP = 1,
    IS_FLOW = 2,
    IS_TEXTURE = 4,
    IS_GRADIENT = 8,
    IS_DIFFERENCE = 16,
    IS_PREDICATES = 32,
    IS_STATIC = 64,
    IS_DYNAMIC = 128,
    IS_UNSATURATED = 256,
    IS_APART = 512
};

/* A row of def/shader/shader.def. */
struct shader_operation {
    const char *name, *meaning;
    const char *slots; /* a character per column */
    uint16_t opcode, flags, reads;
    uint8_t control, cube, destination, source[SHADER_SOURCES], masks, rows;
};

enum shader_opcode {
#define INSTRUCTION(id, ...) SHADER_##id,
#include "def/shader/shader.def"
#undef INSTRUCTION
    SHADER_COUNT
};

extern const struct shader_operation shader_operations[SHADER_COUNT];

enum shader_file {
    FILE_NONE,
#define REGISTER(id, ...) FILE_##id,
#include "def/shader/shader_register.def"
#undef REGISTER
    FILE_COUNT
};

enum { NUMBERED = 0xff, CAN_READ = 1, CAN_WRITE = 2, IS_FLOAT = 4 };

/* A row of def/shader/shader_register.def. */
struct shader_register {
    const char *name, *ports, *meaning;
    uint8_t type, index, access;
    uint16_t count[COLUMN_COUNT], software;
};

extern const struct shader_register shader_registers[FILE_COUNT];

enum shader_modifier_id {
#define MODIFIER(id, ...) MODIFIER_##id,
#include "def/shader/shader_modifier.def"
#undef MODIFIER
    MODIFIER_COUNT
};

/* Numbers of def/shader/shader_comparison.def. */
enum shader_comparison_id {
#define COMPARISON(id, suffix, number) COMPARISON_##id = (number),
#include "def/shader/shader_comparison.def"
#undef COMPARISON
};

struct shader_modifier {
    const char *before, *after, *columns, *meaning;
};

/* By the token's number. */
extern const struct shader_modifier shader_modifiers[MODIFIER_COUNT];

/* The usage of a register, from dcl. */
enum shader_usage {
#define USAGE(id, name, number) USAGE_##id = number,
#include "def/shader/shader_usage.def"
#undef USAGE
};

struct shader_word {
    const char *name;
    uint8_t number;
};

extern const struct shader_word shader_comparisons[], shader_usages[],
    shader_kinds[]; /* end with a null name */

/* The name of that number, or null. */
const char *shader_word_name(const struct shader_word *words, unsigned number);

/* Slots of the instruction in the model's column, or -1 if the model does not have it. */
int shader_slots(const struct shader_operation *operation, const struct shader_model *model);

/* The number of registers of the file in the model. */
unsigned shader_register_count(enum shader_file file, const struct shader_model *model);

/* Returns true if dcl gives registers of the file a usage: elements, outputs, and varyings of ps_3_0 and
 * ps_gl. */
bool shader_has_usage(enum shader_file file, const struct shader_model *model);

struct shader_instruction;

/* The components that the instruction reads of a source, after its swizzle: bit 0 x to bit 3 w. A scalar
 * source is read in x only; _dw adds w. */
unsigned shader_source_components(const struct shader_instruction *instruction, unsigned source);

static inline unsigned shader_major(const struct shader_model *model)
{
    return model->version >> 8;
}

/* Returns true for vs_gl and ps_gl. */
static inline bool shader_is_opengl(const struct shader_model *model)
{
    return model->capabilities & CAN_OPENGL;
}

static inline bool is_if(unsigned opcode)
{
    return opcode == SHADER_IF || opcode == SHADER_IF_COMPARE;
}

static inline bool is_call(unsigned opcode)
{
    return opcode == SHADER_CALL || opcode == SHADER_CALLNZ;
}

static inline bool is_loop(unsigned opcode)
{
    return opcode == SHADER_LOOP || opcode == SHADER_REP || opcode == SHADER_WHILE;
}

static inline bool ends_loop(unsigned opcode)
{
    return opcode == SHADER_ENDLOOP || opcode == SHADER_ENDREP || opcode == SHADER_ENDWHILE;
}

static inline bool is_kill(unsigned opcode)
{
    return opcode == SHADER_TEXKILL || opcode == SHADER_KILL || opcode == SHADER_KILL_COMPARE;
}

static inline bool is_break(unsigned opcode)
{
    return opcode == SHADER_BREAK || opcode == SHADER_BREAK_COMPARE || opcode == SHADER_BREAKP;
}

/* Returns true if registers have the ranges of ps_1_x: values within -8 and 8, constants within -1 and 1. */
static inline bool shader_is_narrow(const struct shader_model *model)
{
    return model->stage == STAGE_PIXEL && shader_major(model) == 1;
}

/* --- One shader ---------------------------------------------------------------------------------------- */

/* Bits of a destination's modifier. */
enum { RESULT_SATURATE = 1, RESULT_PARTIAL = 2, RESULT_CENTROID = 4 };

enum { MASK_FULL = 15, SWIZZLE_NONE = 0xe4 };

/* The component that the swizzle selects for a place. */
static inline unsigned swizzle_component(unsigned swizzle, unsigned place)
{
    return swizzle >> 2 * place & 3;
}

static inline bool swizzle_replicates(unsigned swizzle)
{
    return swizzle == (swizzle & 3) * 0x55;
}

struct shader_operand {
    uint8_t file;      /* enum shader_file; FILE_NONE if there is no operand */
    uint8_t modifier;  /* of a source: enum shader_modifier_id; of a destination: RESULT_* */
    uint8_t swizzle;   /* of a source: two bits per component, x lowest; of a destination: mask, x lowest */
    int8_t shift;      /* of a destination: the result is multiplied by 2 to this power, -3 to 3 */
    uint16_t index;    /* added to the relative index if there is one */
    uint8_t relative;  /* FILE_NONE, FILE_ADDRESS or FILE_LOOP: the register added to the index */
    uint8_t component; /* the component of a0 */
    uint16_t place;    /* text: the column; bytecode: tokens after the instruction's */
};

struct shader_instruction {
    uint8_t opcode;     /* enum shader_opcode */
    uint8_t comparison; /* number of def/shader/shader_comparison.def, or 0 */
    bool coissue;       /* executes together with the one before */
    uint8_t usage, usage_index,
        kind;        /* of dcl: numbers of def/shader/shader_usage.def; kind only of samplers */
    uint16_t column; /* text: where the instruction begins */
    uint32_t place;  /* text: the line, from 1; bytecode: the token, from 0 */
    struct shader_operand destination, predicate, source[SHADER_SOURCES];
    uint32_t literal[4]; /* of def, defi: bits; of defb: the first is 0 or 1 */
};

/* The application's name of a range of constants (from the bytecode's constant table). */
struct shader_name {
    char name[SHADER_NAME_BYTES];
    uint8_t file; /* c, i, b or s */
    uint16_t index, count;
};

struct shader {
    char *path;
    bool bytecode; /* places are tokens */
    const struct shader_model *model;
    struct shader_instruction *instructions; /* in order, with dcl and def */
    uint32_t count, capacity;
    struct shader_name *names;
    uint32_t name_count;
};

/* All return 0, or -1 with the reason: "PATH:LINE:COLUMN: found ..., expected ..." for text, "PATH: token N:
 * ..." for bytecode. On failure *shader is null. The locale must write numbers with a point. */

int shader_assemble(const char *path, const char *text, size_t bytes, struct shader **shader,
                    struct error *error);

/* Little-endian tokens, from the version token to the end token. */
int shader_read(const char *path, const void *code, size_t bytes, struct shader **shader,
                struct error *error);

/* Loads a file of either form. In bytecode the highest byte of the version token is 0xff, which no text has.
 */
int shader_load(const char *path, struct shader **shader, struct error *error);

/* The tokens in the byte order of this machine; the caller frees them. */
int shader_encode(const struct shader *shader, uint32_t **tokens, size_t *count, struct error *error);

/* Canonical text, zero-terminated, which the caller frees. */
int shader_print(const struct shader *shader, char **text, size_t *bytes, struct error *error);

/* A valid shader's use of its model's limits. */
struct shader_counts {
    unsigned slots; /* in all; of ps_1_4 both phases together */
    unsigned flow;  /* instructions of static flow control */
};

/* Validates the shader against its model; `counts` may be null. */
int shader_validate(const struct shader *shader, struct shader_counts *counts, struct error *error);

void shader_free(struct shader *shader);

/* --- For the parts ------------------------------------------------------------------------------------- */

struct shader *shader_create(const char *path, bool bytecode, struct error *error);

/* Room for one more instruction, zeroed; null with the reason. */
struct shader_instruction *shader_append(struct shader *shader, struct error *error);

/* Sets the reason with the place of an operand, or of the instruction if `operand` is null. Returns -1. */
int shader_fail(const struct shader *shader, const struct shader_instruction *instruction,
                const struct shader_operand *operand, struct error *error, const char *reason, ...)
    __attribute__((format(printf, 5, 6)));

#endif
