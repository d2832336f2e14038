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

/* The largest operation plan, eight point lights, has some six hundred parts; a test watches it. */
enum { PART_CAPACITY = 1024 };

struct arguments {
    int32_t value[ARGUMENT_COUNT];
};

struct part {
    const struct fragment *fragment;
    struct arguments arguments;
    uint32_t offset;  /* of its code in the routine, known when joining */
    const char *file; /* the line of the spec that appended it; null in stage plans */
    int line;
};

struct plan {
    unsigned count;
    unsigned dropped; /* parts that found no room: the plan is unusable */
    struct part part[PART_CAPACITY];
};

/* Appends a part and returns its number. */
unsigned plan_append(struct plan *plan, const struct fragment *fragment, struct arguments arguments);

/* Lets the part's argument n, a jump, go to the next part that will be appended. */
void plan_land(struct plan *plan, unsigned part, unsigned n);

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
