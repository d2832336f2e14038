/* A program: a valid shader made ready to run, as the specification walks through it (spec/shader.h).
 *
 * Declarations and definitions are gone, flow control knows where it goes, and each region of it which cells it
 * writes, so that what must survive it is known before it begins. Programs are immutable. Shaders that say the same
 * are one program, whoever made them: a program has a number, which stands for it in the keys of routines. Numbers
 * are never used again, so a routine outlives its program without harm; nobody can ask for it any more.
 *
 * Cells are the components of the registers that are written: floats first, then addresses, predicates and whether
 * the pixel is killed. */
#ifndef SHADER_PROGRAM_H
#define SHADER_PROGRAM_H

#include "shader/interface.h"
#include "shader/shader.h"

#include <stdint.h>

enum cell {
    CELL_TEMPORARY = 0,   /* r0 to r31 */
    CELL_TEXTURE = 128,   /* t0 to t7, where they are written: ps_1_1 to ps_1_3 */
    CELL_OUTPUT = 160,    /* vertices: 16 outputs (enum vertex_output); pixels: oC0 to oC3 */
    CELL_DEPTH = 176,     /* pixels: oDepth.x */
    CELL_FLOATS = 224,    /* how many are floats */
    CELL_ADDRESS = 224,   /* a0 */
    CELL_PREDICATE = 228, /* p0 */
    CELL_KILLED = 232,
    CELL_COUNT
};

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

/* The first cell of the set from `cell` on; CELL_COUNT if there is none. */
static inline unsigned cell_next(const struct cell_set *set, unsigned cell)
{
    for (; cell < CELL_COUNT; cell = (cell | 63) + 1) {
        uint64_t rest = set->word[cell / 64] >> cell % 64;
        if (rest)
            return cell + (unsigned)__builtin_ctzll(rest);
    }
    return CELL_COUNT;
}

struct program_step {
    struct shader_instruction instruction;
    /* if: its else, or its endif; else: its endif; loop, rep: its end; call, label: the first step of the body */
    uint32_t match;
    uint32_t end; /* if: its endif; call, label: the body's ret */
    /* if, else: a break inside leaves the loop around it; loop, rep: one inside leaves it */
    bool leaves;
    struct cell_set written; /* the same and label: in its region, up to the match, or in the body */
};

/* Where a pixel shader's varyings come in: two ports of colours, then eight of coordinates, of four components each.
 * ps_1_x and ps_2_x have v0 and v1 in the first two and t0 to t7 in the others. Registers of ps_3_0 that are declared
 * as color 0 and 1 or texcoord 0 to 7 go the same way, those of other usages through free ports, from the ninth back
 * behind the coordinates: ten ports for ten registers. */
enum { PROGRAM_PORTS = 10, PORT_COORDINATE = 2 };

struct program_port {
    uint8_t file, index; /* v# or t# */
    uint8_t mask;        /* components that are read; 0: nothing comes in here */
    bool color;          /* declared as color 0 or 1 */
    bool coordinate;     /* declared as a texcoord */
    uint16_t third;      /* samplers that alone read the third component; 0: other instructions do, or none */
    bool centroid;       /* looked up inside the triangle, as colours always are */
};

/* A def, defi or defb: bits. */
struct program_constant {
    uint8_t file; /* FILE_CONSTANT, FILE_INTEGER, FILE_BOOLEAN */
    uint16_t index;
    uint32_t value[4];
};

struct program {
    uint32_t number;              /* from 1 */
    char name[SHADER_NAME_BYTES]; /* of the file or the like that it was first made of, for reports */
    const struct shader_model *model;
    struct shader_interface interface;
    struct program_step *step;
    uint32_t steps; /* of the main program and the subroutines behind it */
    uint32_t main;  /* steps of the main program: it ends there, or at its ret */
    struct program_constant *defined;
    uint32_t defined_count;
    uint32_t constants; /* rows of float constants that a draw brings: the highest read + 1; all if indexed */
    uint32_t integers;  /* the same of integer constants */
    uint16_t booleans;  /* bits: those that are read and not defined by the shader */
    struct cell_set initial;          /* cells that some region writes: they begin as 0 */
    struct cell_set written;          /* all cells that are written */
    uint8_t input_mask[SHADER_PORTS]; /* v#: components that are read; all of them if they are indexed */
    uint8_t texture_mask[8];          /* t#: components that are read as coordinates */
    /* Samplers whose lookups read the third component, which counts for nothing in the masks then. */
    uint16_t input_third[SHADER_PORTS], texture_third[8];
    struct program_port port[PROGRAM_PORTS]; /* of a pixel shader */
    uint32_t slots;                          /* as the validator counts */
    /* the registry's */
    uint32_t users;
    uint64_t hash;
    uint32_t *tokens;
    size_t token_count;
    struct program *next;
};

enum {
    PROGRAM_EXECUTED = 1 << 20, /* the most instructions that one run may execute, loops and calls included */
    PROGRAM_LOOPS = 16          /* the most loops around an instruction, those around calls included */
};

/* The program of a valid shader, one more user; null with the reason when it is beyond the bounds or memory is short.
 * The shader may be freed. */
const struct program *program_acquire(const struct shader *shader, struct error *error);
void program_release(const struct program *program);

/* The program of that number while it has users, else null. Thread-safe, as all of this is. */
const struct program *program_find(uint32_t number);

/* The same with one more user, to be released. */
const struct program *program_hold(uint32_t number);

/* The places of a source that the instruction reads: bit 0 x to bit 3 w of the swizzled value. */
unsigned program_source_mask(const struct shader_instruction *instruction, unsigned source);

/* The defined constant, or null if the draw brings it. */
const struct program_constant *program_defined(const struct program *program, enum shader_file file,
                                               unsigned index);

/* What dcl, or the register's name, says that a component of an input is; null if nothing. */
const struct shader_port *program_input(const struct program *program, unsigned file, unsigned index,
                                        unsigned component);

/* The same of a register's first component that has any. */
const struct shader_port *program_declaration(const struct program *program, unsigned file, unsigned index);

/* The number of the output that has component c of that usage and writes it, or -1. */
int program_gives(const struct program *program, unsigned usage, unsigned usage_index, unsigned c);

/* The cell of a destination register's component x. */
unsigned program_cell(const struct shader_operand *destination);

/* What a draw brings: `constants` rows of four floats, a row of zeros (where relative addressing goes that is out of
 * range), `integers` rows of four. Bytes of it, and writing it from the state's registers, of which there are enough:
 * defined constants have the shader's values, and ps_1_x's are clamped to -1 to 1. */
size_t program_constant_bytes(const struct program *program);
void program_write_constants(const struct program *program, const float (*floats)[4],
                             const int32_t (*integers)[4], void *to);

/* The instructions that one run executes at most with these integer constants. Returns 0, or -1 with the reason if a
 * loop's numbers are not allowed (count and start 0 to 255, step -128 to 127), or more than PROGRAM_EXECUTED. */
int program_check_integers(const struct program *program, const int32_t (*integers)[4], struct error *error);

/* Byte offset of an integer constant's component x in what a draw brings. */
static inline int program_integer_offset(const struct program *program, unsigned index)
{
    return (int)(16 * (program->constants + 1 + index));
}

/* --- For the parts ----------------------------------------------------------------------------------------
 */

/* Where flow control goes, what regions write, how deep loops nest (program_flow.c). */
int program_connect(struct program *program, struct error *error);

/* A pixel shader's ports (program_link.c). */
void program_link(struct program *program);

#endif
