/* The intermediate representation (IR): one flat array of instructions in static single assignment (SSA)
 * form. The specializer compiles it, the batch interpreter runs it and the external engine prints it as C.
 * The number of lanes is not part of it: one recording serves every width.
 *
 * An instruction's number is its index in the array, and names the value that it defines; 0 names none.
 * Operands are defined before they are used. A routine repeats the array for each group of lanes; that outer
 * loop is not part of the IR. Inside there are regions:
 *   when a ... end      is skipped when no lane of the mask a is set
 *   loop ... again a    runs once, and is repeated while a lane of a is set
 * Regions nest. The condition of a loop may be defined in the loop. A value that is defined in a `when` is
 * used only in that region and the regions inside it. A value that is defined in a loop may also be used
 * after it, because a loop runs at least once (recordings make no use of this).
 *
 * Other values that leave a region, or pass from one iteration of a loop to the next, go through a variable:
 * `set` stores all lanes of a value and `get` is a new value, the contents of the variable at that position.
 * Variables are numbered below VARIABLES, times `parts`. All sets and gets of a variable have its type. A
 * variable has no value until it is set, and keeps none from one group of lanes to the next. The specializer
 * replaces variables by phis and joins.
 *
 * A program can begin with what a routine executes once a call, its preamble. The instruction `section` ends
 * the preamble and `repeat` the program: what is between them is repeated for each group of lanes. Values of
 * the preamble are the same in all lanes, and can be used everywhere after their definition. Neither
 * instruction is in a region. Recordings have no preamble (passes/preamble.c).
 *
 * After the program there can be subroutines (passes/subroutine.h), which `call` runs. Their arguments and
 * results are numbered: the caller `put`s the arguments and the subroutine `take`s them, and the other way
 * round for results. Recordings have none.
 *
 * The operations are the rows of three tables: def/op.def computes, def/ir.def is the rest of what is
 * recorded, and def/engine/lowered.def is what only the specializer's passes make. Each row has its types and
 * properties, which are what generic code tests: the order of the operations has no meaning, except that
 * those of def/op.def come first. */
#ifndef IR_IR_H
#define IR_IR_H

#include "base/error.h"
#include "contract/binding.h"

#include <stdio.h>

/* `any` appears only in tables: an operand of any type. */
enum ir_type { TYPE_non, TYPE_flt, TYPE_itg, TYPE_fix, TYPE_msk, TYPE_any = TYPE_non };

enum ir_op {
    IR_nop,
#define OP(name, ...)  IR_##name,
#define OPK(name, ...) IR_##name,
#define CAST(name, ...)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
#define IR_OP(name, ...) IR_##name,
#include "def/ir.def"
#include "def/engine/lowered.def"
#undef IR_OP
    IR_OP_COUNT
};

/* Operations 1 to IR_COMPUTED have IR_COMPUTES. */
enum { IR_COMPUTED = IR_copy - 1 };

enum ir_property {
    IR_COMMUTES = 1 << 0, /* a and b may be exchanged */
    IR_EFFECT = 1 << 1,   /* defines no value */
    IR_READS = 1 << 2,    /* reads memory */
    IR_WRITES = 1 << 3,   /* writes memory */
    IR_SHIFTS = 1 << 4,   /* has the immediate k */
    IR_OPENS = 1 << 5,    /* begins a region */
    IR_CLOSES = 1 << 6,   /* ends a region */
    IR_PLACED = 1 << 7,   /* its value depends on its position, not only on its operands */
    /* a row of def/op.def: each lane is computed from the operands' lane (ir_evaluate) */
    IR_COMPUTES = 1 << 8,
    IR_VARIABLE = 1 << 9,   /* k is a variable */
    IR_KEPT = 1 << 10,      /* kept although it has no value and writes no memory */
    IR_EXCHANGED = 1 << 11, /* k is an argument or a result of a call */
    IR_CALLS = 1 << 12      /* a call, or an end of a subroutine */
};

struct ir_op_information {
    const char *name;
    uint8_t result; /* enum ir_type; TYPE_non: see def/ir.def */
    uint8_t operand[3];
    uint8_t operands;
    uint16_t properties;
};

/* The sections of a routine, from the outermost. Each is repeated inside of the one before it, and computes
 * what does not change in those inside of it. */
enum ir_section {
    IR_SECTION_CALL, /* once a call: words of the job, constants of shaders, literals */
    IR_SECTION_BODY, /* for each group of lanes */
    IR_SECTIONS
};

extern const struct ir_op_information ir_op_information[IR_OP_COUNT];

enum { IR_UNIT = 1 };

struct ir_instruction {
    uint8_t op;    /* enum ir_op */
    uint8_t type;  /* enum ir_type of the value; of a set, the variable's type */
    uint8_t base;  /* enum base */
    uint8_t scale; /* of a uniform: IR_UNIT if the word is from 0 to 1, and neither -0 nor a denormal */
    uint16_t operand[3];
    uint16_t line; /* of the file of the specification that recorded it; 0: none */
    uint8_t file;  /* index in `file` of struct ir */
    /* The number of the recorded instruction that it was made from; 0: none. Passes keep it, so that listings
     * can relate the code to the recording. */
    uint16_t origin;
    int32_t k;
    int32_t field;
};

static inline unsigned ir_properties(const struct ir_instruction *instruction)
{
    return ir_op_information[instruction->op].properties;
}

static inline unsigned ir_operands(const struct ir_instruction *instruction)
{
    return ir_op_information[instruction->op].operands;
}

/* Numbers have 16 bits and 0xffff is reserved. The arrays of a build have IR_CAPACITY entries. That costs
 * address space only: pages that a routine does not reach are never touched. */
enum { IR_CAPACITY = 65535, IR_FILES = 64, IR_CONSTANTS = 512, IR_PARTS = 16, IR_SAMPLINGS = 4096 };

/* The recorded instructions from `first` on belong to a step of the shader (struct program), or to
 * NO_STEP. */
struct ir_step {
    uint32_t first, step;
};

/* The recorded instructions from `first` up to `end` sample a texture. They have no effect but their values.
 */
struct ir_sampling {
    uint32_t first, end;
};

/* A slot of the routine's constant table: the word at base + offset, broadcast to all lanes. */
struct ir_constant {
    uint8_t base;
    int32_t offset;
};

/* The field k of a `loop` and its `again`: which loop it is. Recordings have loops of lanes. The pass
 * separate makes the others of the span reading, and the code around the program repeats them. Here, with the
 * mask of no lanes, they run once, for one chunk of a block; those of the pass stretch do not run. */
enum ir_loop {
    IR_LOOP_LANES,
    IR_LOOP_TRIANGLES,
    IR_LOOP_COLUMNS,
    IR_LOOP_RUNS,
    IR_LOOP_ROWS,
    IR_LOOP_CHUNKS,
    IR_LOOP_STRETCH,
    IR_LOOP_PAIRS,
    IR_LOOP_BLOCKS
};

struct ir {
    uint32_t count;     /* of instructions; instruction 0 is a nop */
    uint32_t loops;     /* the number of loops recorded */
    uint32_t variables; /* every variable in use is below this */
    uint32_t phis;      /* at least the number of phis and joins */
    bool preamble;      /* the program has a section */
    uint32_t file_count;
    uint32_t constant_count;
    uint32_t parts;       /* of each value, up to IR_PARTS; 1 until the pass split */
    uint32_t subroutines; /* that are called */
    uint32_t exchanged;   /* every argument and result of a call is below this */
    /* Operands have exactly the types of the tables. Passes that use a value instead of another with the
     * same bits clear it: afterwards only masks and words are distinguished, and literals are either. */
    bool typed;
    uint8_t unit; /* enum unit: whose records memory has (field.h); UNIT_COUNT: memory is words of any type */
    struct triangle_layout layout;        /* of the unit's key */
    uint8_t interpolation[VARYING_COUNT]; /* of the unit's key, except vertices: enum interpolation */
    bool span;                            /* of a pixel routine: the recording is the span reading */
    bool separated; /* it has the loops of the pass separate; the values of a column and of a row: */
    uint32_t column_words, row_words;
    bool early;           /* it has the instruction `rest` */
    uint32_t early_words; /* the pass early: of what a block's first part stores; registers */
    uint32_t chunks; /* of a block's lanes, which the loops of rows and blocks compute together: 1 or 2 */
    /* The pass near: columns and rows of texels that it notes. In a column's entry, the places of each begin
     * at word `near_words`. */
    uint32_t near_words, near_columns, near_rows;
    uint32_t stretch_words; /* the pass stretch: the words of a stretched row; 0: it has added no loops */
    bool overflow; /* more than IR_CAPACITY - 1 instructions were recorded: the routine cannot be built */
    const char *file[IR_FILES];
    struct ir_constant constant[IR_CONSTANTS];
    struct ir_instruction instruction[IR_CAPACITY];
    uint32_t steps;
    struct ir_step step[IR_CAPACITY]; /* in order of `first` */
    uint32_t samplings;               /* those after the first IR_SAMPLINGS are not noted */
    struct ir_sampling sampling[IR_SAMPLINGS];
};

/* Makes `ir` an empty program. */
void ir_start(struct ir *ir);

/* Copies the program `from` to `ir`. */
void ir_duplicate(struct ir *ir, const struct ir *from);

/* Appends an instruction, whose number becomes its origin, and returns the number; past the capacity sets
 * `overflow` and returns 0. */
uint16_t ir_append(struct ir *ir, struct ir_instruction instruction);

/* Notes that the next recorded instructions belong to a step of the shader, or to NO_STEP. */
void ir_note_step(struct ir *ir, uint32_t step);

/* Notes that the sampling of a texture begins with the next recorded instruction, or ends with the last one.
 */
void ir_note_sampling(struct ir *ir, bool begins);

/* Returns the step of the shader that recorded instruction `origin`, or NO_STEP. */
uint32_t ir_step_of(const struct ir *ir, uint32_t origin);

/* Returns true if the instruction only reads memory that no routine writes, so that it may move. */
bool ir_is_invariant_read(const struct ir_instruction *instruction);

/* Returns true if the instruction reads memory that is the same in the whole call: a word of the job, a
 * constant of the shader. */
static inline bool ir_reads_call(const struct ir_instruction *instruction)
{
    switch (instruction->op) {
    case IR_uniform: return instruction->base == BASE_JOB || instruction->base == BASE_CONSTANT;
    case IR_gather: return instruction->base == BASE_CONSTANT && instruction->field == GATHER_DIRECT;
    default: return false;
    }
}

/* Returns the number of the other end of the region that the instruction opens or closes. */
uint32_t ir_other_end(const struct ir *ir, uint32_t number);

/* Returns the number of the first instruction that is repeated for each group of lanes: the one after
 * `section`, or 1 if the program has no preamble. */
uint32_t ir_find_body(const struct ir *ir);

/* Removes nops and renumbers. `map` is scratch memory of IR_CAPACITY entries. */
void ir_compact(struct ir *ir, uint16_t *map);

/* Verifies that
 *   - operands are values, defined before their use in a region that is still open,
 *   - operands and results have the types of the tables of operations,
 *   - memory is read and written by fields, of their type, in programs of a unit (field.h),
 *   - regions nest,
 *   - all sets and gets of a variable have one type, and a set precedes every get on each path of control,
 *   - phis, next values and joins are at their positions,
 *   - before a section there are only values that are the same in all lanes, and nothing is between
 *     `repeat` and the subroutines,
 *   - subroutines follow the program, one after the other, and use no value of what precedes them.
 * Returns null, or one line that describes the first error. The line is in static memory of the calling
 * thread. For tests: the reason for which a recording is invalid; ir_check calls it. */
const char *ir_verify(const struct ir *ir);

/* Does the same, from several threads too. Returns 0, or -1 with the reason, which begins with the name of
 * the program: "the recording", "the result of pass common". For tests: recordings that are invalid; builds
 * with CHECK_IR call it too. */
int ir_check(const struct ir *ir, const char *name, struct error *error);

/* True in builds that verify every recording and the result of every pass (make CHECK_IR=1, and builds with
 * sanitizers). A routine that fails the check is not built. */
enum {
#ifdef TRIPTYCH_CHECK_IR
    IR_CHECKED = 1
#else
    IR_CHECKED = 0
#endif
};

/* Prints an instruction: type, operation, operands. */
void ir_print_instruction(const struct ir *ir, uint32_t number, FILE *out);

/* Prints one line per instruction: number, type, operation, operands, line of the specification. If `text` is
 * not null, the lines of the shader are printed before the instructions that they record. */
void ir_print(const struct ir *ir, const struct program_text *text, FILE *out);

/* Prints the shader's line of recorded instruction `origin` if it is not line *last, which it becomes. */
void ir_print_source(const struct ir *ir, const struct program_text *text, uint32_t origin, uint32_t *last,
                     FILE *out);

/* Records the specification of a unit for a key (record.c). */
void ir_record(struct ir *ir, enum unit unit, const union key *key);

/* Notes whose records an empty program reads and writes, so that fields have names. ir_record calls it. */
void ir_note_records(struct ir *ir, enum unit unit, const union key *key);

/* Returns a recording in memory of the process's pool (pool.c), for callers without memory of their own, or
 * null with the reason. Return it with ir_give. */
struct ir *ir_take(enum unit unit, const union key *key, struct error *error);
void ir_give(struct ir *ir);

/* The same for what `record` records of `context`: kernels, which have no key. `name` is in the reason. */
typedef void ir_recorder(struct ir *ir, const void *context);
struct ir *ir_take_recording(ir_recorder *record, const void *context, const char *name, struct error *error);

/* Evaluates an operation of def/op.def on one lane's bits (a pair: both halves), under the caller's MXCSR. */
uint32_t ir_evaluate(enum ir_op op, uint32_t a, uint32_t b, uint32_t c, int32_t k);

#endif
