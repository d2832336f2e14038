/* The intermediate representation that the specializer compiles, the batch interpreter runs and the
 * external engine prints: one flat array of instructions in SSA form. Where control flow joins, recordings
 * have variables; the specializer replaces them by phis and joins.
 *
 * An instruction's number is its index, and the number of the value it defines; 0 is no value. Operands are
 * defined before they are used. The loop over what a call lists is outside of it all. Inside are regions:
 * `when mask ... end`, skipped when no lane of the mask is set, and `loop ... again mask`, run once and
 * again as long as a lane of the mask is set. Regions nest. A value defined in a `when` is used in that
 * region only, inner regions included; a value defined in a loop may be used behind it, too, since the loop
 * has run by then (recordings make no use of this). What else leaves a region, or goes from one pass of a
 * loop to the next, goes through a variable: `set` gives it all lanes of a value, `get` is a value of its
 * own, what the variable holds at that place. A variable holds nothing until it is set, and nothing from
 * one chunk of lanes to the next.
 *
 * Opcodes are the rows of def/op.def, and these:
 *   copy a                      the same bits (the casts)
 *   literal k                   the 32 bits k in every lane
 *   load base k                 the lanes' consecutive words at base + k
 *   uniform base k              the word at base + k in every lane
 *   gather a base field k scale words at start + a * scale + k; start is base, or the pointer at base + field
 *   store a base k              the lanes' consecutive words to base + k
 *   scatter a base k field      lane l's word to base + k + l * field
 *   when a, end                 a region
 *   loop, again a               a loop; `a` is defined before or in it
 *   set a k, get k              variable k, below VARIABLES; all its sets and gets have its type
 *   phi a, next p b             directly before a loop and before its end: p is a in the loop's first pass, and
 *                               from one pass to the next becomes b, all phis of a loop at once; behind the loop
 *                               it is what it was in the last pass. Each phi has one `next`
 *   join a b                    directly behind an `end`: b if the region ran, else a; b may be of the region
 *   constant k                  slot k of the frame's constants, filled before the loop (hoist.c)
 *   permute a k                 lanes change places within each four: lane l takes lane (k >> 2 * l) & 3
 *   coverage base k             bit l of the half word at base + k, all of lane l; of 16 lanes (jit/wide.c)
 *   reciprocal a b base k       1 / the plane at base + k, at x = a and y = b; of 16 lanes
 *   store_where a b base k      a store of the lanes that b has; of 16 lanes
 *   window a b c field k        the gathers that follow read words of the pointer at field, at a + b * pitch and, of four,
 *                               at a + c * pitch too, the pitch being the word at base + k: a hint (jit/window.c); `scale`
 *                               instructions, the last of them the gathers, are the way for lanes far apart
 * The number of lanes appears nowhere here: the same recording serves every W. */
#ifndef IR_IR_H
#define IR_IR_H

#include "base/error.h"
#include "def/binding.h"

#include <stdio.h>

enum ir_type { TYPE_non, TYPE_flt, TYPE_itg, TYPE_fix, TYPE_msk };

enum ir_op {
    IR_nop,
#define OP(name, ...)  IR_##name,
#define OPK(name, ...) IR_##name,
#define CAST(name, ...)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
    IR_copy,
    IR_literal,
    IR_load,
    IR_uniform,
    IR_gather,
    IR_store,
    IR_scatter,
    IR_when,
    IR_end,
    IR_loop,
    IR_again,
    IR_set,
    IR_get,
    IR_constant,
    IR_permute,
    IR_phi,
    IR_next,
    IR_join,
    IR_coverage,
    IR_reciprocal,
    IR_store_where,
    IR_window,
    IR_OP_COUNT
};

enum ir_property {
    IR_COMMUTES = 1, /* a and b may change places */
    IR_EFFECT = 2,   /* not a value: memory or control */
    IR_READS = 4,    /* reads memory */
    IR_SHIFTS = 8,   /* takes the staged immediate k */
    IR_OPENS = 16,   /* begins a region */
    IR_CLOSES = 32,  /* ends one */
    IR_PLACED = 64   /* depends on where it stands, not on its operands alone */
};

struct ir_op_information {
    const char *name;
    uint8_t
        result; /* enum ir_type; TYPE_non for effects, and for the opcodes whose type the instruction says */
    uint8_t operand[3];
    uint8_t operands;
    uint8_t properties;
};

extern const struct ir_op_information ir_op_information[IR_OP_COUNT];

struct ir_instruction {
    uint8_t op;   /* enum ir_op */
    uint8_t type; /* enum ir_type of the value; of a set, the variable's */
    uint8_t base; /* enum base */
    uint8_t scale;
    uint16_t operand[3];
    uint16_t line; /* of the spec file that made it */
    uint8_t file;
    int32_t k;
    int32_t field;
};

/* Numbers are 16 bits wide, and 0xffff is none. The arrays of a build are this long, which costs address
 * space: only what a routine uses of them is ever touched. */
enum { IR_CAPACITY = 65535, IR_FILES = 64, IR_CONSTANTS = 512 };

/* A hoisted word: broadcast from base + offset before the loop. */
struct ir_constant {
    uint8_t base;
    int32_t offset;
};

struct ir {
    uint32_t count;     /* instruction 0 is a nop */
    uint32_t loops;     /* so many were recorded */
    uint32_t variables; /* those set or got are below this */
    uint32_t phis;      /* and joins: there are no more than so many */
    uint32_t file_count;
    uint32_t constant_count;
    int overflow; /* more than IR_CAPACITY instructions were recorded: the routine cannot be built */
    const char *file[IR_FILES];
    struct ir_constant constant[IR_CONSTANTS];
    struct ir_instruction instruction[IR_CAPACITY];
};

/* Empties it. */
void ir_start(struct ir *ir);

/* Makes it the same as another. */
void ir_duplicate(struct ir *ir, const struct ir *from);

/* Appends an instruction and returns its number; past the capacity sets `overflow` and returns 0. */
uint16_t ir_append(struct ir *ir, struct ir_instruction instruction);

/* Whether the instruction only reads memory that no routine writes (so that it may move). */
int ir_is_invariant_read(const struct ir_instruction *instruction);

/* The other end of the region that the instruction opens or closes. */
uint32_t ir_other_end(const struct ir *ir, uint32_t number);

/* Removes nops and renumbers. `map` is scratch of IR_CAPACITY entries. */
void ir_compact(struct ir *ir, uint16_t *map);

/* Checks that operands are defined before use, in an open region, that regions nest, that all sets and gets
 * of a variable have one type, that every get is reached by a set whichever way control takes, and that phis, next
 * values and joins stand where they belong (verify.c).
 * Returns null, or one line that says what is wrong (static storage: for one thread at a time). */
const char *ir_verify(const struct ir *ir);

/* The same for any number of threads. Returns 0, or -1 with the reason, which begins with what `made` the program: "the
 * recording", "pass common". */
int ir_check(const struct ir *ir, const char *made, struct error *error);

/* Whether this is a build (make CHECK_IR=1, and any with sanitizers) in which every recording and what every pass
 * leaves is checked, and refused if it is wrong. */
enum {
#ifdef TRIPTYCH_CHECK_IR
    IR_CHECKED = 1
#else
    IR_CHECKED = 0
#endif
};

/* One line a instruction: number, type, operation, operands, spec line. */
void ir_print(const struct ir *ir, FILE *out);
void ir_print_instruction(const struct ir *ir, uint32_t number, FILE *out);

/* Records the spec of a unit for a key (record.c). */
void ir_record(struct ir *ir, enum unit unit, const union key *key);

/* A recording in memory of a pool of the process (pool.c), for those who have none of their own; null with
 * the reason. Give it back. */
struct ir *ir_take(enum unit unit, const union key *key, struct error *error);
void ir_give(struct ir *ir);

/* Evaluates one operation of def/op.def on one lane's bits (fix: both halves). Runs under the caller's MXCSR.
 */
uint32_t ir_evaluate(enum ir_op op, uint32_t a, uint32_t b, uint32_t c, int32_t k);

#endif
