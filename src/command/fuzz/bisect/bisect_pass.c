/* The pass of the specializer that makes a routine wrong. The table of operations executes the result of each
 * pass; the first pass whose outputs differ from those of the recording is at fault. If none is, a phase
 * after the passes is. Then the values of the code made from the last form, probed without passes, show the
 * wrong instruction. */
#include "command/fuzz/bisect/hunt.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"

#include <stdlib.h>
#include <string.h>

struct look {
    struct hunt *hunt;
    uint8_t *expected, *image;
    struct ir *last; /* what the last pass has left */
    int culprit;     /* -1: none yet */
    unsigned runs;   /* of passes that changed something, up to the culprit */
};

static void look_after(void *context, unsigned pass, const struct ir *ir)
{
    struct look *look = context;
    struct hunt *hunt = look->hunt;
    ir_duplicate(look->last, ir);
    if (look->culprit >= 0)
        return;
    look->runs++;
    if (!interpret_all(hunt->interpreter, ir, hunt->replay, look->image) ||
        replay_differs(hunt->replay, look->expected, look->image, NULL))
        look->culprit = (int)pass;
}

/* The first instruction of the last form whose value in the code is not the one that it should have. */
static int probe_last_form(struct look *look, const struct routine *routine, struct error *error)
{
    struct hunt *hunt = look->hunt;
    struct probing probing = hunt->probing;
    struct observation seen = {0};
    uint16_t *map = malloc(IR_CAPACITY * sizeof *map);
    if (!map)
        return error_set(error, "out of memory for %u operations", look->last->count);
    ir_compact(look->last, map);
    free(map);
    if (replay_reserve(hunt->replay, probe_rows(look->last)))
        return error_set(error, "out of memory for the values of %u operations", look->last->count);
    memcpy(look->image, hunt->replay->before, hunt->replay->output_bytes + hunt->replay->table_bytes);
    interpret(hunt->interpreter, look->last, hunt->replay, look->image, probing.lane, true);
    probing.ir = look->last;
    probing.bare = true;
    probing.events = interpreter_events(hunt->interpreter);
    int result = observation_start(&seen, &probing.events);
    if (!result)
        result = probe_observe(&probing, routine, &seen, error);
    for (uint32_t n = 0; n < probing.events.count && !result && hunt->bisection->outcome != BISECT_FOUND; n++)
        for (unsigned lane = 0; lane < QUAD_LANES; lane++) {
            uint32_t value[2] = {probing.events.event[n].lane[lane], probing.events.event[n].lane[lane]};
            value[routine == hunt->routine[1]] = seen.value[n][lane];
            if (!(seen.known[n] >> lane & 1) ||
                hunt_agrees(look->last, probing.events.event[n].instruction, value[0], value[1]))
                continue;
            hunt_note(hunt, look->last, &probing.events, n, lane, value);
            snprintf(hunt->bisection->reason, sizeof hunt->bisection->reason,
                     "found after the passes: probes in the recording make the difference disappear");
            break;
        }
    observation_free(&seen);
    return result;
}

static int find_pass(struct look *look, const struct routine *routine, struct error *error)
{
    struct hunt *hunt = look->hunt;
    struct bisection *b = hunt->bisection;
    struct probe_options options = {0, look_after, look};
    if (!interpret_all(hunt->interpreter, hunt->ir, hunt->replay, look->expected))
        return 0;
    ir_duplicate(look->last, hunt->ir);
    struct routine *again = probe_build(routine, hunt->arena, hunt->ir, &options, error);
    if (!again)
        return -1;
    probe_free(routine, hunt->arena, again);
    if (look->culprit >= 0) {
        snprintf(b->pass, sizeof b->pass, "pass %s (run %u of the passes)",
                 pass_name((unsigned)look->culprit), look->runs);
        return 0;
    }
    snprintf(b->pass, sizeof b->pass, "registers, selection or encoding: no pass");
    return b->outcome == BISECT_FOUND ? 0 : probe_last_form(look, routine, error);
}

int hunt_passes(struct hunt *hunt, unsigned side, struct error *error)
{
    const struct routine *routine = hunt->routine[side];
    if (!specialize_is_engine(routine->engine))
        return 0;
    struct look look = {.hunt = hunt, .culprit = -1};
    look.expected = replay_image(hunt->replay);
    look.image = replay_image(hunt->replay);
    look.last = ir_take(routine->unit, &routine->key, error);
    int result = look.expected && look.image && look.last
                     ? find_pass(&look, routine, error)
                     : error_set(error, "out of memory for the passes' results");
    free(look.expected);
    free(look.image);
    if (look.last)
        ir_give(look.last);
    return result;
}
