/* Probes: stores that are added to the recording to observe the values of an engine's code.
 *
 * An engine that works from the recording receives one in which a store follows each probed instruction. It
 * stores the value to a row after the table of the lanes (replay.h). In a loop the store happens in one pass
 * only, which rows of numbers choose when the code runs: the loops count their passes in variables. Probes do
 * not change the computation, but the code with probes may no longer have the fault. Comparing its outputs
 * with those of the code without probes shows that: only then is an observation `faithful`. */
#ifndef COMMAND_FUZZ_BISECT_PROBE_H
#define COMMAND_FUZZ_BISECT_PROBE_H

#include "command/fuzz/bisect/interpret.h"

/* The ways to observe an engine's routines. */
enum reading {
    READING_TRACED,   /* emulate: its own reading, traced */
    READING_RECORDED, /* from the recording, with probes */
    READING_STAGES    /* stage fragments: no operations inside */
};

enum reading probe_reading(const struct routine *routine);

/* Builds a routine for a recording with the engine that made `like`. If the engine has passes, those in
 * `disabled` are left out, and each run of another that changes something is reported to the observer. Null
 * with the reason. */
struct probe_options {
    uint32_t disabled;
    void (*observer)(void *context, unsigned pass, const struct ir *ir);
    void *context;
};
struct routine *probe_build(const struct routine *like, struct code_arena *arena, const struct ir *ir,
                            const struct probe_options *options, struct error *error);
void probe_free(const struct routine *like, struct code_arena *arena, struct routine *routine);

uint32_t probe_rows(const struct ir *ir);

enum { OBSERVED_ALL = 15 };

/* Values of an engine at the events of a quad. Code of one lane runs only for covered pixels, and in a region
 * only for those that are in it; the other lanes are not seen. */
struct observation {
    uint32_t (*value)[4]; /* by event */
    uint8_t *known;       /* by event: bit l: lane l was seen */
};

int observation_start(struct observation *observation, const struct event_list *events);
void observation_free(struct observation *observation);

/* The means to observe a quad. */
struct probing {
    const struct ir *ir;
    struct replay *replay; /* with room for probe_rows(ir) */
    struct event_list events;
    uint32_t lane;
    struct code_arena *arena;
    struct interpreter *interpreter; /* scratch */
    bool bare;                       /* the specializer's passes are left out */
};

/* Observes the routine's engine at all events. All instructions are probed together if that leaves the
 * outputs unchanged, else one at a time. A value that cannot be observed without changing the outputs stays
 * unknown. Emulate is traced: its values are known up to the first one that another line of the specification
 * computed. Returns 0, or -1 with the reason. */
int probe_observe(const struct probing *probing, const struct routine *routine,
                  struct observation *observation, struct error *error);

/* Stitches a recording (probe_stitch.c). */
struct routine *probe_stitch(const struct ir *ir, struct code_arena *arena, const struct routine *like,
                             struct error *error);

#endif
