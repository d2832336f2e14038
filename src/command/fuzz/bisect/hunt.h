/* The data that the parts of the bisector share. */
#ifndef COMMAND_FUZZ_BISECT_HUNT_H
#define COMMAND_FUZZ_BISECT_HUNT_H

#include "command/fuzz/bisect/bisect.h"
#include "command/fuzz/bisect/probe.h"

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

/* Returns true if two values of an instruction of the type are the same. All NaNs are the same. */
bool hunt_agrees(const struct ir *ir, uint32_t instruction, uint32_t a, uint32_t b);

/* Notes a lane of the call: its pixel, or the number of its element. */
void hunt_note_lane(struct bisection *bisection, const struct replay *replay, uint32_t lane);

/* Notes the operation of an event as the first that differs. */
void hunt_note(struct hunt *hunt, const struct ir *ir, const struct event_list *events, uint32_t event,
               unsigned lane, const uint32_t value[2]);

/* Finds the operation (bisect_operation.c), among those of the four lanes in which the outputs differ. */
int hunt_operation(struct hunt *hunt, struct error *error);

/* Finds the fault in the specializer (bisect_pass.c): the pass, and the operation where probes in the
 * recording have shown none. `side` is the number of the engine. */
int hunt_passes(struct hunt *hunt, unsigned side, struct error *error);

/* The first stage fragment that is wrong (bisect_stage.c). */
int hunt_stages(struct hunt *hunt, unsigned side, struct error *error);

#endif
