/* A plan: the list of parts that a routine is joined from. A part is a fragment with arguments.
 *
 * A planner makes a plan from a key: stages.c from hand-tuned fragments for whole stages, operations.c
 * from the specification, one fragment for each operation. The joiner converts a plan to code. The
 * contract check and the listing read it. Parts run in order, except where a fragment jumps. The argument
 * of a jump is the number of the part to jump to. */
#ifndef ENGINES_STITCH_PLAN_H
#define ENGINES_STITCH_PLAN_H

#include "machine/code.h"
#include "contract/engine.h"
#include "engines/stitch/operation.h"

#include <stdio.h>

/* Far more than any routine needs. Unused memory of a plan is never touched. */
enum {
    OPERATION_CAPACITY = 65536,
    PART_CAPACITY = 2 * OPERATION_CAPACITY,
    POOL_CAPACITY = 8192,
    SLOT_BYTES = 32
};

/* The greatest depth of nested regions. */
enum { NESTING_MAXIMUM = 256 };

/* The stack of a thread may be limited to 2 MiB. */
enum { FRAME_BYTES_MAXIMUM = 1024 * 1024 };

struct part {
    const struct fragment *fragment;
    union arguments arguments;
    uint32_t offset;  /* of its code in the routine, set by plan_lay_out() */
    uint16_t line;    /* the line of the specification */
    const char *file; /* null in stage plans */
};

/* Statistics of an operation plan. */
struct plan_counts {
    unsigned operations; /* whose results are read, including literals and reads of memory */
    unsigned carried;    /* operands that were in a register already */
    unsigned fused;      /* operations that combine two or more of the specification */
    unsigned folded;     /* operands that a fragment reads from memory */
    unsigned loaded;     /* parts that load a value */
    unsigned stored;     /* parts that store a value to the stack frame */
};

struct plan {
    unsigned count;
    unsigned dropped;    /* parts that exceeded the capacity: the plan is unusable */
    unsigned unrecorded; /* the same for operations */
    unsigned unpooled;   /* the same for literals */
    unsigned missing;    /* parts without a fragment: the plan is unusable */
    unsigned depth;      /* of the nested regions */
    unsigned lost;       /* values that are read where control flow may have skipped them */
    int32_t frame_bytes; /* of the slots */
    unsigned literals;   /* after the code, 32 bytes each */
    uint32_t code_bytes, literals_offset,
        bytes; /* after plan_lay_out(): the size of the parts, the offset of the first literal, the total */
    unsigned operations; /* operation 0 is none */
    unsigned variables;  /* variables in use have lower numbers */
    uint32_t stored;     /* bit n: the routine stores to base n */
    struct plan_counts counts;
    struct part part[PART_CAPACITY];
    struct operation operation[OPERATION_CAPACITY];
    struct value value[OPERATION_CAPACITY];
    int32_t free_slot[OPERATION_CAPACITY];
    uint32_t literal[POOL_CAPACITY];
    struct variable_state variable[VARIABLES];
};

/* Returns a plan, or null with the reason. Plans are large, so one is kept for reuse. Give it back. */
struct plan *plan_take(struct error *error);
void plan_give(struct plan *plan);

/* Appends a part and returns its number, or the last part's when there is no room. A planner's table may have
 * no fragment, which makes the plan unusable. */
static inline unsigned plan_append(struct plan *plan, const struct fragment *fragment,
                                   union arguments arguments)
{
    if (!fragment) {
        plan->missing++;
        return plan->count;
    }
    if (plan->count == PART_CAPACITY) {
        plan->dropped++;
        return PART_CAPACITY - 1;
    }
    plan->part[plan->count] = (struct part){.fragment = fragment, .arguments = arguments};
    return plan->count++;
}

/* Appends a part without arguments. */
static inline unsigned plan_append_plain(struct plan *plan, const struct fragment *fragment)
{
    return plan_append(plan, fragment, (union arguments){{0}});
}

/* Sets argument n of the part, a jump, to the next part that will be appended. */
void plan_land(struct plan *plan, unsigned part, unsigned n);

/* Returns 0, or -1 with the reason if a capacity is exceeded or the stack frame is too large. */
int plan_complete(const struct plan *plan, struct error *error);

/* Combines an operation that is about to be appended with the operations of its operands, where a rule
 * applies. */
void plan_fuse(const struct plan *plan, struct operation *operation);

/* The entry and the exit of a routine and the loop of its unit (asm/stitch/frame.asm). The other parts are
 * appended in between. */
struct loop {
    unsigned begin; /* the part that jumps to the end if there is nothing to do */
    unsigned top;   /* the loop's first part */
    unsigned chunk; /* pixel: the part that jumps to the chunk's end */
};

/* Finds the readers of each value, and the operations whose values are not read. */
void plan_find_readers(struct plan *plan);

/* Appends the parts of the operations: chooses a register for each value, or a slot of the stack frame. Those
 * that are executed once are followed by the begin of the loop. Needs plan_find_readers(). Returns the bytes
 * of the slots. */
int32_t plan_locate(struct plan *plan, enum unit unit, struct loop *loop);

/* Completes a plan that has been entered and has operations. `program` is the shader of the unit, or null. */
void plan_locate_operations(struct plan *plan, enum unit unit, const union key *key,
                            const struct program *program);

/* The two planners. Operations cover every key whose fields are below their radix. Stages cover the keys
 * of stages_cover() (engines/stitch/cover.h). */
typedef void planner(struct plan *plan, enum unit unit, const union key *key);
planner plan_stages, plan_operations;

/* Empties the plan and appends the entry. Parts that run once may follow. */
void plan_enter(struct plan *plan);
struct loop plan_begin(struct plan *plan, enum unit unit);

/* The same in two steps: the part that loads the job, and the loop's first parts. Parts that run once and
 * read the job may be in between. */
struct loop plan_begin_call(struct plan *plan, enum unit unit);
void plan_begin_loop(struct plan *plan, enum unit unit, struct loop *loop);
void plan_leave(struct plan *plan, enum unit unit, const union key *key, const struct loop *loop,
                int frame_bytes);

/* The registers that a part reads, gives a value, and changes, as masks like those of struct fragment. */
uint32_t part_reads(const struct part *part);
uint32_t part_gives(const struct part *part);
uint32_t part_changes(const struct part *part);

/* The name of the register of a bit of those masks. */
const char *stitch_register_name(unsigned bit);

/* Checks the register contract: on every path, each part's inputs are given by an earlier part and not
 * destroyed since. Returns 0, or -1 with the part and the register in the reason. */
int plan_check(const struct plan *plan, struct error *error);

/* Finds the offset of each part in the routine. Returns 0, or -1 with the reason. */
int plan_lay_out(struct plan *plan, struct error *error);

/* Copies the plan's code into the arena and fills the holes. Returns 0, or -1 with the reason. */
int plan_join(struct plan *plan, struct code_arena *arena, struct code_span *span, struct error *error);

/* Makes a routine of a plan. Free it with the engine's free(). Returns null with the reason. */
struct routine *plan_routine(struct plan *plan, const struct engine *engine, struct code_arena *arena,
                             enum unit unit, const union key *key, struct error *error);

/* Writes a part: its fragment's name, and its arguments with their names. */
void plan_print_part(const struct part *part, FILE *out);

/* Writes each part: its fragment, arguments, line of the specification and instructions. The plan must be
 * joined to `span`. */
void plan_print(const struct plan *plan, const struct code_span *span, FILE *out);

#endif
