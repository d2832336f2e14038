/* A plan: the list of parts, fragments with arguments, that a routine is joined from.
 *
 * A planner makes one from a key (stages.c from hand-tuned whole stages, operations.c from the spec, one
 * fragment an operation); the joiner turns it into code; the contract check and the listing read it. Parts
 * run in order except where a fragment jumps; a jump's argument is the number of the part it goes to. */
#ifndef STITCH_PLAN_H
#define STITCH_PLAN_H

#include "base/code.h"
#include "draw/engine.h"
#include "stitch/operation.h"

#include <stdio.h>

/* Far above any routine; what is not used of a plan is never touched. */
enum {
    OPERATION_CAPACITY = 65536,
    PART_CAPACITY = 2 * OPERATION_CAPACITY,
    POOL_CAPACITY = 8192,
    SLOT_BYTES = 32
};

/* Regions inside one another. */
enum { NESTING_MAXIMUM = 256 };

/* A thread's stack may have no more than 2 MiB. */
enum { FRAME_BYTES_MAXIMUM = 1024 * 1024 };

struct arguments {
    int32_t value[ARGUMENT_COUNT];
};

struct part {
    const struct fragment *fragment;
    struct arguments arguments;
    uint32_t offset;  /* of its code in the routine, known when joining */
    uint16_t line;    /* the line of the spec that appended it */
    const char *file; /* null in stage plans */
};

/* What became of an operation plan's operands and results. */
struct plan_counts {
    unsigned operations; /* whose results are read, literals and reads of memory included */
    unsigned carried;    /* operands that were in a register */
    unsigned fused;      /* of two of the specification's, or more */
    unsigned folded;     /* operands that a fragment takes from memory itself */
    unsigned loaded;     /* parts that bring a value from memory */
    unsigned stored;     /* parts that keep one in the frame */
};

struct plan {
    unsigned count;
    unsigned dropped;    /* parts that found no room: the plan is unusable */
    unsigned unrecorded; /* operations, likewise */
    unsigned unpooled;   /* literals, likewise */
    unsigned depth;      /* of the regions inside one another */
    unsigned lost;       /* values that are read where control may have avoided them */
    int32_t frame_bytes; /* of the slots */
    unsigned literals;   /* behind the code, eight times 32 bits each */
    uint32_t code_bytes, literals_offset, bytes; /* joined: of the parts; of the first literal; of both */
    unsigned operations;                         /* operation 0 is none */
    unsigned variables;                          /* those used are below this */
    uint32_t stored;                             /* bit n: something is stored to base n */
    struct plan_counts counts;
    struct part part[PART_CAPACITY];
    struct operation operation[OPERATION_CAPACITY];
    struct value value[OPERATION_CAPACITY];
    int32_t free_slot[OPERATION_CAPACITY];
    uint32_t literal[POOL_CAPACITY];
    struct variable_state variable[VARIABLES];
};

/* A plan to use, kept between uses since plans are large, or null with the reason. Give it back. */
struct plan *plan_take(struct error *error);
void plan_give(struct plan *plan);

/* Appends a part and returns its number; when there is no room, the last part's. */
static inline unsigned plan_append(struct plan *plan, const struct fragment *fragment,
                                   struct arguments arguments)
{
    if (plan->count == PART_CAPACITY) {
        plan->dropped++;
        return PART_CAPACITY - 1;
    }
    plan->part[plan->count] = (struct part){.fragment = fragment, .arguments = arguments};
    return plan->count++;
}

/* Lets the part's argument n, a jump, go to the next part that will be appended. */
void plan_land(struct plan *plan, unsigned part, unsigned n);

/* Returns 0, or -1 with the reason when parts found no room or the frame is too large. */
int plan_complete(const struct plan *plan, struct error *error);

/* Makes one of an operation that is about to be appended and what gives its operands, if it can. */
void plan_fuse(const struct plan *plan, struct operation *operation);

/* Finds the readers of each value, and what nobody reads. */
void plan_find_readers(struct plan *plan);

/* Appends the operations' parts: finds registers for values, and slots of the frame for what finds no
 * register. Readers have been found. Returns the bytes of the slots. */
int32_t plan_place(struct plan *plan);

/* Makes a routine of a plan that has been entered and has operations. `program` is the unit's shader or null.
 */
void plan_place_operations(struct plan *plan, enum unit unit, const union key *key,
                           const struct program *program);

/* The two planners. Operations cover every key whose fields are below their radix, stages those of
 * stages_cover() (stitch/cover.h). */
typedef void planner(struct plan *plan, enum unit unit, const union key *key);
planner plan_stages, plan_operations;

/* Entry and exit of a routine and the loop of its unit (asm/frame.asm), around the parts appended in between.
 */
struct loop {
    unsigned begin; /* the part that may jump behind the loop */
    unsigned top;   /* the loop's first part */
    unsigned chunk; /* pixel: the part that may jump to the chunk's end */
};

/* Empties the plan and enters; parts to run once may follow. */
void plan_enter(struct plan *plan);
struct loop plan_begin(struct plan *plan, enum unit unit);
void plan_leave(struct plan *plan, enum unit unit, const union key *key, const struct loop *loop,
                int frame_bytes);

/* The registers that a part reads, gives, and gives or destroys, as masks of struct fragment. */
uint32_t part_reads(const struct part *part);
uint32_t part_gives(const struct part *part);
uint32_t part_changes(const struct part *part);

/* The register of a bit of those masks. */
const char *register_name(unsigned bit);

/* Checks the register contract: whatever way control takes, each part's inputs were given by an earlier part
 * and not destroyed since. Returns 0, or -1 naming the part and the register. */
int plan_check(const struct plan *plan, struct error *error);

/* Finds where each part is in the routine. Returns 0, or -1 with the reason why it cannot be joined. */
int plan_lay_out(struct plan *plan, struct error *error);

/* Copies the plan's code into the arena and fills the holes. Returns 0, or -1 with the reason. */
int plan_join(struct plan *plan, struct code_arena *arena, struct code_span *span, struct error *error);

/* A routine of a plan; free it like the engine's. Null with the reason. */
struct routine *plan_routine(struct plan *plan, const struct engine *engine, struct code_arena *arena,
                             enum unit unit, const union key *key, struct error *error);

/* Part by part: fragment, arguments, spec line, instructions. The plan has been joined to the code at `code`.
 */
void plan_print(const struct plan *plan, const struct code_span *span, FILE *out);

#endif
