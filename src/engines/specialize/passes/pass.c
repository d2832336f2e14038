/* The passes in order, repeated until nothing changes (thesis, section 3.4).
 *
 * A pass runs again only if it, or another pass that wakes it, has changed something since its last run;
 * without this rule the last rounds of a fixpoint would inspect the whole program to find nothing. At the end
 * the program is compacted. */
#include "engines/specialize/passes/pass.h"
#include "engines/specialize/passes/subroutine.h"

#include <string.h>

enum group { THESIS, FULL, OPTIONAL, ONCE, LAST };
enum wakes { NONE, OTHERS, ALL };

static const struct {
    const char *name;
    pass_function *run;
    enum group group;
    enum wakes wakes;
    const char *meaning;
} passes[PASS_COUNT] = {
#define PASS(name, profile, wakes, meaning) {#name, pass_##name, profile, wakes, meaning},
#include "def/engine/pass.def"
#undef PASS
};

const char *pass_name(unsigned i)
{
    return i < PASS_COUNT ? passes[i].name : NULL;
}

const char *pass_description(unsigned i)
{
    return i < PASS_COUNT ? passes[i].meaning : NULL;
}

uint32_t pass_rebuild(const struct ir *ir, struct pass_memory *memory)
{
    memory->map[0] = 0;
    memory->rebuilt[0] = ir->instruction[0];
    return 1;
}

void pass_replace(struct ir *ir, const struct pass_memory *memory, uint32_t count)
{
    memcpy(ir->instruction, memory->rebuilt, count * sizeof *memory->rebuilt);
    ir->count = count;
}

static bool is_in(unsigned pass, enum profile profile)
{
    if (profile == PROFILE_NONE || passes[pass].group == OPTIONAL)
        return false;
    return profile == PROFILE_FULL || passes[pass].group == THESIS;
}

/* Those that run once after the repeated ones, from a group on. */
static uint32_t passes_from(enum group group)
{
    uint32_t once = 0;
    for (unsigned p = 0; p < PASS_COUNT; p++)
        once |= (uint32_t)(passes[p].group >= group) << p;
    return once;
}

bool pass_is_required(unsigned i)
{
    return passes[i].group == LAST;
}

uint32_t pass_select(enum profile profile, uint32_t enabled, uint32_t disabled)
{
    uint32_t selected = 0;
    for (unsigned p = 0; p < PASS_COUNT; p++)
        selected |= (uint32_t)is_in(p, profile) << p;
    return ((selected | enabled) & ~disabled & ((1u << PASS_COUNT) - 1)) | passes_from(LAST);
}

/* The passes that `pass` wakes when it has changed something; bit p: pass p. */
static uint32_t woken(unsigned pass, uint32_t repeated)
{
    switch (passes[pass].wakes) {
    case ALL: return repeated;
    case OTHERS: return repeated & ~(1u << pass);
    default: return 0;
    }
}

struct run {
    struct ir *ir;
    struct pass_memory *memory;
    pass_observer *observer;
    void *context;
};

/* Runs the waiting passes in order, and those that are woken by an earlier row. Returns those that still
 * wait. */
static uint32_t run_round(const struct run *run, uint32_t waiting, uint32_t repeated)
{
    for (unsigned p = 0; p < PASS_COUNT; p++) {
        if (!(waiting >> p & 1))
            continue;
        waiting &= ~(1u << p);
        unsigned changed = passes[p].run(run->ir, run->memory);
        if (changed)
            waiting |= woken(p, repeated);
        if (run->observer)
            run->observer(run->context, p, changed, run->ir);
    }
    return waiting;
}

/* Runs the selected passes but the required ones. Returns the number of rounds. */
static unsigned run_selected(const struct run *run, uint32_t selected)
{
    const uint32_t after = selected & passes_from(ONCE) & ~passes_from(LAST);
    const uint32_t repeated = selected & ~passes_from(ONCE);
    unsigned rounds = 0;
    for (uint32_t waiting = repeated; waiting; rounds++)
        waiting = run_round(run, waiting, repeated);
    run_round(run, after, 0);
    return rounds;
}

static void run_required(const struct run *run)
{
    run_round(run, passes_from(LAST), 0);
    ir_compact(run->ir, run->memory->map);
}

unsigned pass_run_all(struct ir *ir, struct pass_memory *memory, uint32_t selected, pass_observer *observer,
                      void *context)
{
    const struct run run = {ir, memory, observer, context};
    unsigned rounds = run_selected(&run, selected);
    run_required(&run);
    return rounds;
}

static void announce(const struct run *run)
{
    if (run->observer)
        run->observer(run->context, PASS_COUNT, run->ir->count, run->ir);
}

/* A subroutine has no preamble: it is called in the routine's loop. A subroutine whose callers move the job
 * cannot use the constant table, which is filled once. */
static void run_subroutine(const struct run *run, struct subroutines *s, uint32_t number, uint32_t selected)
{
    struct run body = *run;
    body.ir = &s->body;
    selected &= ~(1u << PASS_preamble);
    pass_take_subroutine(s, number);
    announce(&body);
    run_selected(&body, s->of[number].moved ? selected & ~(1u << PASS_hoist) : selected);
    pass_append_subroutine(run->ir, s, number, run->memory->map);
}

void pass_run_with_subroutines(struct ir *ir, struct pass_memory *memory, struct subroutines *subroutines,
                               uint32_t selected, pass_observer *observer, void *context)
{
    const struct run run = {ir, memory, observer, context};
    announce(&run);
    run_selected(&run, selected);
    for (uint32_t number = 0; number < subroutines->count; number++)
        run_subroutine(&run, subroutines, number, selected);
    announce(&run);
    run_required(&run);
}

/* --- Regions -------------------------------------------------------------------------------------------- */

void pass_open_region(struct ir *ir, uint32_t when)
{
    uint32_t end = ir_other_end(ir, when);
    for (uint32_t join = end + 1; join < ir->count && ir->instruction[join].op == IR_join; join++) {
        struct ir_instruction *i = &ir->instruction[join];
        i->op = IR_copy;
        i->operand[0] = i->operand[1];
        i->operand[1] = 0;
    }
    ir->instruction[when] = ir->instruction[end] = (struct ir_instruction){.op = IR_nop};
}
