/* The bisector's parts: what they know of the case. */
#ifndef FUZZ_HUNT_H
#define FUZZ_HUNT_H

#include "fuzz/bisect.h"
#include "fuzz/probe.h"

struct hunt {
    struct bisection *bisection;
    const struct routine *routine[2];
    struct replay *replay; /* narrowed */
    struct replay_place place;
    struct ir *ir;
    struct interpreter *interpreter;
    struct code_arena *arena;
    struct probing probing;
    struct observation seen[2];
};

/* Whether two values of an instruction of the type are the same: any NaN is as good as any other. */
bool hunt_agrees(const struct ir *ir, uint32_t instruction, uint32_t a, uint32_t b);

/* Notes the operation of an event as the first that differs. */
void hunt_note(struct hunt *hunt, const struct ir *ir, const struct event_list *events, uint32_t event,
               unsigned lane, const uint32_t value[2]);

/* What in the specializer is wrong (bisect_pass.c): the pass; and the operation, where probes in the recording have
 * shown none. `side` is the engine of the two. */
int hunt_passes(struct hunt *hunt, unsigned side, struct error *error);

/* The first stage fragment that is wrong (bisect_stage.c). */
int hunt_stages(struct hunt *hunt, unsigned side, struct error *error);

#endif
