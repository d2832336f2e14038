/* Probes: what values an engine's code has, seen by stores that are added to the recording.
 *
 * An engine that works from the recording is given one in which every probed instruction is followed by a store of
 * its value, to a row behind the lanes' table (replay.h). In loops the store happens in one pass only, which rows
 * of numbers choose when the code runs: the loops count their passes in variables. What an engine computes is not
 * changed by this; whether its code still has the fault that is looked for is another question, which is answered
 * by comparing its outputs with those of the code without probes: an observation is `faithful` or not. */
#ifndef FUZZ_PROBE_H
#define FUZZ_PROBE_H

#include "fuzz/interpret.h"

/* How an engine's routines can be looked into. */
enum reading {
    READING_TRACED,   /* emulate: its own reading, written down */
    READING_RECORDED, /* from the recording, with probes */
    READING_STAGES    /* stage fragments: no operations inside */
};

enum reading reading_of(const struct routine *routine);

/* A routine for a recording by the engine that made `like`: with the passes in `disabled` left out and told to the
 * observer, if it has passes. Null with the reason. */
struct probe_options {
    uint32_t disabled;
    void (*observer)(void *context, unsigned pass, const struct ir *ir);
    void *context;
};
struct routine *probe_build(const struct routine *like, struct code_arena *arena, const struct ir *ir,
                            const struct probe_options *options, struct error *error);
void probe_free(const struct routine *like, struct code_arena *arena, struct routine *routine);

/* Writes `from` to `to` with probes behind the instructions whose byte in `wanted` is set. Rows: first one for
 * each loop of the recording, the pass that is looked at, then one for each instruction. Returns 0, or -1 when it
 * finds no room. */
int probe_insert(struct ir *to, const struct ir *from, const uint8_t *wanted, const struct replay *replay);
uint32_t probe_rows(const struct ir *ir);
uint32_t probe_row(const struct ir *ir, uint32_t instruction);

/* Values of an engine at the events of a quad. */
struct observation {
    uint32_t (*value)[4]; /* by event */
    uint8_t *known;       /* by event: 1 seen, 0 not seen */
};

int observation_start(struct observation *observation, const struct event_list *events);
void observation_free(struct observation *observation);

/* What a quad is observed with. */
struct probing {
    const struct ir *ir;
    struct replay *replay; /* with room for probe_rows(ir) */
    struct event_list events;
    uint32_t lane;
    struct code_arena *arena;
    struct interpreter *interpreter; /* scratch */
    bool bare;                       /* the specializer's passes are left out */
};

/* Observes the routine's engine at all events. Instructions are probed all at once if that leaves the outputs as
 * they are, else one at a time, and what cannot be seen without changing the outputs stays unknown. Emulate is
 * traced; its values are known up to the first that another line of the specification made. Returns 0, or -1 with
 * the reason. */
int probe_observe(const struct probing *probing, const struct routine *routine,
                  struct observation *observation, struct error *error);

/* Stitches a recording (probe_stitch.c). */
struct routine *probe_stitch(const struct ir *ir, struct code_arena *arena, const struct routine *like,
                             struct error *error);

#endif
