/* A program: a valid shader prepared for execution by the specification (spec/shader/shader_flow.h).
 *
 * Declarations and definitions are removed. Each step of flow control has its targets, and each region the
 * set of cells that it writes, so values that must survive the region can be saved before it begins. Programs
 * are immutable. Equal shaders are one program, even on different devices. A program has a number, which
 * represents it in the keys of routines. Numbers are never used again, so a routine that outlives its program
 * is harmless: no later key can match it.
 *
 * Cells are the components of the registers that are written: floats first, then addresses, predicates, the
 * killed pixels, and the temporaries that only models of OpenGL have. */
#ifndef SHADER_PROGRAM_PROGRAM_H
#define SHADER_PROGRAM_PROGRAM_H

#include "shader/interface.h"
#include "shader/shader.h"

#include <stdint.h>

enum cell {
    CELL_TEMPORARY = 0,   /* r0 to r31 */
    CELL_TEXTURE = 128,   /* t0 to t7, where they are written: ps_1_1 to ps_1_3 */
    CELL_OUTPUT = 160,    /* vertices: 16 outputs (enum vertex_output); pixels: oC0 to oC3 */
    CELL_DEPTH = 176,     /* pixels: oDepth.x */
    CELL_FLOATS = 224,    /* number of float cells */
    CELL_ADDRESS = 224,   /* a0 */
    CELL_PREDICATE = 228, /* p0 */
    CELL_KILLED = 232,
    CELL_MORE = 256, /* r32 to r255 */
    CELL_COUNT = CELL_MORE + 4 * 224
};

enum { CELL_TEMPORARIES = (CELL_TEXTURE - CELL_TEMPORARY) / 4, PROGRAM_TEMPORARIES = 256 };

/* The cell of component x of r#. */
static inline unsigned cell_of_temporary(unsigned index)
{
    bool more = index >= CELL_TEMPORARIES;
    return more ? CELL_MORE + 4 * (index - CELL_TEMPORARIES) : CELL_TEMPORARY + 4 * index;
}

static inline bool cell_is_float(unsigned cell)
{
    return cell < CELL_FLOATS || cell >= CELL_MORE;
}

/* Outputs of vertex shaders below 3.0; those of vs_3_0 are numbered as written. */
enum vertex_output {
    OUTPUT_COLOR = 0,      /* oD0, oD1 */
    OUTPUT_COORDINATE = 2, /* oT0 to oT7 */
    OUTPUT_POSITION = 10,
    OUTPUT_FOG,
    OUTPUT_POINT,
    OUTPUT_COUNT = 16
};

/* A set of cells: bit c % 64 of word c / 64. */
struct cell_set {
    uint64_t word[(CELL_COUNT + 63) / 64];
};

static inline int cell_in(const struct cell_set *set, unsigned cell)
{
    return (int)(set->word[cell / 64] >> cell % 64 & 1);
}

static inline void cell_add(struct cell_set *set, unsigned cell)
{
    set->word[cell / 64] |= (uint64_t)1 << cell % 64;
}

/* The first cell of the set from `cell` on; `end` or more if there is none below it. */
static inline unsigned cell_next(const struct cell_set *set, unsigned cell, unsigned end)
{
    for (; cell < end; cell = (cell | 63) + 1) {
        uint64_t rest = set->word[cell / 64] >> cell % 64;
        if (rest)
            return cell + (unsigned)__builtin_ctzll(rest);
    }
    return end;
}

struct program_step {
    struct shader_instruction instruction;
    /* if: its else, or its endif; else: its endif; loop, rep: its end; call, label: the first step of the
     * body */
    uint32_t match;
    uint32_t end; /* if: its endif; call, label: the body's ret */
    /* if, else: a break or a continue inside leaves the pass of the loop around it; loops: one inside leaves
     * their own */
    bool leaves;
    bool continues;          /* the same of `continue` only */
    bool returns;            /* if, else, loops: a ret inside */
    bool early;              /* call, label: a ret inside a block of the body */
    struct cell_set written; /* of those steps: cells written in the region or the body */
};

/* The ports of a pixel shader's varyings: two of colours, then eight of coordinates, of four components each.
 * In ps_1_x and ps_2_x, v0 and v1 use the first two, t0 to t7 the others. In ps_3_0, registers declared as
 * color 0 and 1 or texcoord 0 to 7 use the same ports; registers of other usages take free ports, the last
 * one first. There are ten ports for ten registers. */
enum { PROGRAM_PORTS = 10, PORT_COORDINATE = 2 };

struct program_port {
    uint8_t file, index; /* v# or t# */
    uint8_t mask;        /* components that are read; 0: the port is unused */
    bool color;          /* declared as color 0 or 1 */
    bool coordinate;     /* declared as a texcoord */
    uint16_t third;      /* samplers, if only they read the third component; else 0 */
    bool centroid;       /* interpolated at the centroid, as colours always are */
};

/* A def, defi or defb: bits. */
struct program_constant {
    uint8_t file; /* FILE_CONSTANT, FILE_INTEGER, FILE_BOOLEAN */
    uint16_t index;
    uint32_t value[4];
};

struct program {
    uint32_t number;              /* from 1 */
    char name[SHADER_NAME_BYTES]; /* of the first shader's file, for reports */
    const struct shader_model *model;
    struct shader_interface interface;
    struct program_step *step;
    uint32_t steps; /* of the main program and the subroutines that follow it */
    uint32_t main;  /* steps of the main program: it ends there, or at its ret */
    bool early;     /* a ret inside a block of the main program */
    struct program_constant *defined;
    uint32_t defined_count;
    uint32_t constants;      /* rows of float constants from a draw: the highest read + 1; all if indexed */
    uint32_t integers;       /* the same of integer constants */
    uint16_t booleans;       /* bits: those that are read and not defined by the shader */
    struct cell_set initial; /* cells that some region writes: they begin as 0 */
    struct cell_set written; /* all cells that are written */
    uint32_t cells;          /* they are below this number */
    /* r#: the first register and one more than the last of the array that it belongs to; 0 of none */
    uint16_t array_begin[PROGRAM_TEMPORARIES], array_end[PROGRAM_TEMPORARIES];
    uint8_t input_mask[SHADER_PORTS]; /* v#: components that are read; all of them if they are indexed */
    uint8_t texture_mask[8];          /* t#: components that are read as coordinates */
    /* Samplers whose lookups read the third component; the masks then do not include it. */
    uint16_t input_third[SHADER_PORTS], texture_third[8];
    struct program_port port[PROGRAM_PORTS]; /* of a pixel shader */
    uint32_t slots;                          /* as the validator counts */
    /* used by the registry */
    uint32_t users;
    uint64_t hash;
    uint32_t *tokens;
    size_t token_count;
    struct program *next;
};

enum {
    PROGRAM_EXECUTED = 1 << 20, /* the most instructions that one run may execute, loops and calls included */
    PROGRAM_LOOPS = 16,         /* the most loops around an instruction, those around calls included */
    PROGRAM_CALLS = 16,         /* the deepest nesting of calls in any model */
    PROGRAM_PASSES = 65536      /* the most passes of a loop in models of OpenGL (CHECK_PASSES) */
};

/* Returns true for an instruction that is a step of its program: no declaration and no definition. */
static inline bool program_has_step(const struct shader_instruction *instruction)
{
    return instruction->opcode == SHADER_PHASE || !(shader_operations[instruction->opcode].flags & IS_SETUP);
}

/* The program of a valid shader, with one more user. Returns null with the reason if the shader exceeds the
 * bounds or memory is short. The shader may be freed. */
const struct program *program_acquire(const struct shader *shader, struct error *error);
void program_release(const struct program *program);

/* The program with that number while it has users, else null. All these functions are thread-safe. */
const struct program *program_find(uint32_t number);

/* The same with one more user; release it later. */
const struct program *program_hold(uint32_t number);

/* The defined constant, or null if the draw supplies it. */
const struct program_constant *program_defined(const struct program *program, enum shader_file file,
                                               unsigned index);

/* The declaration of an input's component, by dcl or by the register's name; null if there is none. */
const struct shader_port *program_input(const struct program *program, unsigned file, unsigned index,
                                        unsigned component);

/* The declaration of the first declared component of a register. */
const struct shader_port *program_declaration(const struct program *program, unsigned file, unsigned index);

/* The number of the output that has component c of that usage and writes it, or -1. */
int program_gives(const struct program *program, unsigned usage, unsigned usage_index, unsigned c);

/* The cell of a destination register's component x. */
unsigned program_cell(const struct shader_operand *destination);

/* A draw supplies `constants` rows of four floats, then a row of zeros (for relative addressing out of
 * range), then `integers` rows of four integers: program_constant_bytes bytes in all. program_write_constants
 * writes them from the state's registers. Defined constants have the shader's values, and those of ps_1_x are
 * clamped to -1 to 1. */
size_t program_constant_bytes(const struct program *program);
void program_write_constants(const struct program *program, const float (*floats)[4],
                             const int32_t (*integers)[4], void *to);

/* Checks the instructions that one run executes with these integer constants. Returns 0, or -1 with the
 * reason if a loop's numbers are not allowed (count and start 0 to 255, step -128 to 127), or if there are
 * more than PROGRAM_EXECUTED. In models of OpenGL, a count is 0 to PROGRAM_PASSES, and nothing else is
 * checked. */
int program_check_integers(const struct program *program, const int32_t (*integers)[4], struct error *error);

/* Byte offset of an integer constant's component x in what a draw brings. */
static inline int program_integer_offset(const struct program *program, unsigned index)
{
    return (int)(16 * (program->constants + 1 + index));
}

/* A text of a program, and where each step is in it. */
struct program_text {
    char *text;  /* the lines, each ended by a zero byte */
    char **line; /* line n is line[n - 1] */
    uint32_t lines;
    uint32_t *line_of_step;
    uint32_t steps;
};

/* Fills `text` with the written text of a shader that is this program: `bytes` bytes and a zero byte, which
 * it frees in any case. Returns 0, or -1 with the reason; `text` is then empty. */
int program_text_read(const struct program *program, char *written, size_t bytes, struct program_text *text,
                      struct error *error);

/* The same with the canonical text. */
int program_text_open(const struct program *program, struct program_text *text, struct error *error);
void program_text_free(struct program_text *text);

/* --- For the parts ------------------------------------------------------------------------------------- */

/* Computes the targets of flow control, the cells that regions write, and the nesting of loops
 * (program_flow.c). */
int program_connect(struct program *program, struct error *error);

/* Assigns a pixel shader's ports (program_link.c). */
void program_link(struct program *program);

#endif
