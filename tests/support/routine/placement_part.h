/* Shared by the parts of the proof (placement.h): locations and their contents (placement_place.c), the
 * effect of an instruction (placement_code.c), the code of an operation (placement_range.c), stretched rows
 * (placement_stretch.c), and the walk over operations and control flow (placement.c). */
#ifndef TESTS_SUPPORT_ROUTINE_PLACEMENT_PART_H
#define TESTS_SUPPORT_ROUTINE_PLACEMENT_PART_H

#include "placement.h"

#include <Zydis/Zydis.h>
#include <stdbool.h>

/* Registers have the numbers that allocation gives them, masks included. */
enum { LANES = REGISTERS, SLOTS, SET = VARIABLES + 16, DEPTH = 64, LOCAL_JUMPS = 3 };

enum origin {
    FROM_NOTHING,
    FROM_LITERAL,
    FROM_CONSTANT,
    FROM_WORD,
    FROM_LANES,
    FROM_VARIABLE,
    FROM_ELSEWHERE
};

/* The content of a register or a slot. */
struct content {
    uint64_t made_in; /* the operation, by visit, whose intermediate result it is */
    uint8_t origin;
    uint8_t base;   /* FROM_WORD, FROM_LANES: a general-purpose register */
    uint8_t bits;   /* one element for each lane: a mask shorter than all lanes */
    uint16_t count; /* of the values that it is */
    int32_t number; /* bits of the literal, of the constant, of the variable; displacement */
    uint16_t value[SET];
};

/* Registers, the room for lanes in the stack frame, slots. */
struct places {
    bool reached;
    struct content *at;
};

struct loop_state {
    uint32_t number; /* of the loop */
    size_t offset;   /* of its head */
    struct places head;
};

struct check {
    const struct builder *b;
    const struct ir *ir;
    const struct emitter *m;
    ZydisDecoder decoder;
    unsigned places; /* in all */
    uint64_t visit;
    uint32_t number; /* of the operation */
    uint32_t line;
    size_t offset;
    struct places now;
    unsigned regions, loops;
    struct places skipped[REGION_DEPTH]; /* by open region: the state on the path around it */
    size_t skipped_to[REGION_DEPTH];
    struct loop_state loop[DEPTH];
    struct places local[LOCAL_JUMPS]; /* after a jump within an operation's code */
    size_t local_to[LOCAL_JUMPS];
    unsigned stores;
    unsigned read; /* a bit for each operand that was read */
    bool coded;    /* the operation has code */
    bool again;    /* the loop must be walked once more */
    bool inside;   /* the operation is in a subroutine */
    int64_t job;   /* by how much the call has moved the job so far */
    bool called;   /* it has called its subroutine */
    ZydisDecodedInstruction instruction;
    ZydisDecodedOperand operand[ZYDIS_MAX_OPERAND_COUNT]; /* without the mask register that masks it */
    unsigned mask;                                        /* which is this one; 0: none */
    bool wrong;
    char text[256];
};

/* Records the first error, with the operation and the position in the code. */
__attribute__((format(printf, 2, 3))) void placement_wrong(struct check *c, const char *format, ...);

static inline const struct ir_instruction *placement_operation(const struct check *c, unsigned number)
{
    return &c->ir->instruction[number];
}

/* Returns true for an operation whose code includes that of those after it. */
static inline bool placement_covers(const struct ir_instruction *i)
{
    return i->op == IR_window || i->op == IR_near;
}

/* Adds a value to a set. Copies only the used part of a set. */
void place_add(struct content *p, unsigned value);
void place_assign(struct content *to, const struct content *from);

/* Returns true if a value can be read again. Only the operation itself can read memory that routines
 * write. */
bool place_lasts(const struct ir_instruction *i);

/* Returns true if a location contains a value, by one of its names or by the memory that it was loaded
 * from. */
bool place_holds(const struct check *c, const struct content *p, unsigned value);

/* Records the operands of the current operation that are read here. Returns true if any is. Reports an
 * error if the value read is neither an operand nor an intermediate result of the operation. */
bool place_note_operands(struct check *c, const struct content *p);
void place_expect(struct check *c, const struct content *p, const char *where, long number);

void places_copy(const struct check *c, struct places *to, const struct places *from);

/* Keeps in `to` the values that both states have. Returns true if any value was removed. */
bool places_merge(const struct check *c, struct places *to, const struct places *from);

/* From now on, every location that contains `source` also contains `name`. The joins after a region are
 * their operands of one path; the phis of a loop that ends are their next values. */
void places_rename(struct check *c, struct places *s, unsigned name, unsigned source);
void places_name_joins(struct check *c, struct places *s, uint32_t end, int operand);
void places_name_next(struct check *c, struct places *s);

/* The effect of the instruction that was decoded last (placement_code.c). */
void placement_run_instruction(struct check *c);

/* The code that was selected for the current operation, if any; the code that loads the constants that the
 * body has in registers (placement_range.c). */
void placement_run_code(struct check *c);
void placement_run_kept(struct check *c);

/* The end of the operations that the code of the current one covers. */
uint32_t placement_selected_end(const struct check *c);

/* The operands of the current operation; for scatters that one selection covers, the operands of all of
 * them. */
int placement_operands(const struct check *c);
unsigned placement_operand(const struct check *c, int o);

/* The code of a call: the call itself, a move of the job; and its end (placement.c). */
void placement_run_call(struct check *c);
void placement_move_job(struct check *c);
void placement_end_call(struct check *c);

/* The variable in the frame of a `set` or a `get`; arguments and results of calls follow the variables. */
static inline int32_t placement_variable(const struct check *c, const struct ir_instruction *i)
{
    return ir_properties(i) & IR_EXCHANGED ? (int32_t)c->ir->variables + i->k : i->k;
}

/* How much further rsp is from the frame. */
static inline int64_t placement_shift(const struct check *c)
{
    return c->inside ? 8 : 0;
}

/* The location at a displacement from rsp without that shift: a slot, a register that is saved around a
 * call, or the room for lanes; -1: something else in the stack frame. */
int placement_place_in_frame(struct check *c, int64_t displacement);

/* The number of a register as in allocation: vectors, then masks; -1: neither. */
int placement_vector_number(ZydisRegister r);

/* The loops of stretched rows (placement_stretch.c). Returns true for a loop that may run no time. */
bool placement_may_skip(const struct check *c, uint32_t loop);
/* Reports a read of stretched rows that are not those of the current operation. */
void placement_expect_stretched(struct check *c, const ZydisDecodedOperand *o);
/* Reports a write of a general register in which such a loop has something. */
void placement_keep_general(struct check *c, const ZydisDecodedOperand *o);

/* A jump in it (placement.c). */
void placement_run_jump(struct check *c);

#endif
