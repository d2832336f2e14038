/* A plan: the list of parts, fragments with arguments, that a routine is joined from.
 *
 * A planner makes one from a key (stages.c from hand-tuned whole stages, operations.c from the spec, one
 * fragment an operation); the joiner turns it into code; the contract check and the listing read it. Parts
 * run in order except where a fragment jumps; a jump's argument is the number of the part it goes to. */
#ifndef STITCH_PLAN_H
#define STITCH_PLAN_H

#include "base/code.h"
#include "draw/engine.h"
#include "stitch/fragment.h"

#include <stdio.h>

/* Far above any routine; what is not used of a plan is never touched. */
enum { PART_CAPACITY = 65536, SLOT_BYTES = 32 };

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
    uint8_t slots;    /* bit n: argument n is a slot of the frame; SLOTS_RESULT */
    const char *file; /* null in stage plans */
};

/* Argument 0 is a slot that the part gives a value; it is one whose value the part reads. */
enum { SLOTS_RESULT = 1 << 7, SLOTS_STORED = 1 };

/* A slot while it has the only value that it is ever given: the last part that reads it, the one it becomes,
 * and the next free one (slots.c). */
struct slot {
    uint32_t last_reader;
    int32_t place;
    uint32_t next_free;
};

struct plan {
    unsigned count;
    unsigned dropped;    /* parts that found no room: the plan is unusable */
    int32_t frame_bytes; /* of the slots */
    struct part part[PART_CAPACITY];
    struct slot slot[PART_CAPACITY];
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

/* Lets values that are not alive together share slots. Until then each of the `bytes / SLOT_BYTES` slots is
 * the result of one part. Returns the bytes of the slots that are left. */
int32_t plan_share_slots(struct plan *plan, int32_t bytes);

/* Where a frame is too large for the first-level cache otherwise; sharing takes a fifth of a plan's time. */
enum { UNSHARED_BYTES = 24 * 1024 };

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

/* `once`, which may be null, is a fragment with one argument or none to run before the loop. */
struct loop plan_enter(struct plan *plan, enum unit unit, const struct fragment *once, int32_t argument);
void plan_leave(struct plan *plan, enum unit unit, const union key *key, const struct loop *loop,
                int frame_bytes);

/* Checks the register contract: whatever way control takes, each part's inputs were given by an earlier part
 * and not destroyed since. Returns 0, or -1 naming the part and the register. */
int plan_check(const struct plan *plan, struct error *error);

/* Copies the plan's code into the arena and fills the holes. Returns 0, or -1 with the reason. */
int plan_join(struct plan *plan, struct code_arena *arena, struct code_span *span, struct error *error);

/* Part by part: fragment, arguments, spec line, instructions. The plan has been joined to the code at `code`.
 */
void plan_print(const struct plan *plan, const struct code_span *span, FILE *out);

#endif
