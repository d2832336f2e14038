#include "command/fuzz/bisect/probe.h"

#include "emu/batch/batch.h"
#include "emu/emulate/emulate.h"
#include "engines/external/external.h"
#include "command/fuzz/bisect/trace.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "engines/stitch/stitch.h"

#include <stdlib.h>
#include <string.h>

#define NOT_SEEN 0x5a17b0e5u /* what rows hold before */

enum { RUNS_MAXIMUM = 100000 }; /* of code with one probe: what has not been seen by then stays unknown */

/* --- Engines -------------------------------------------------------------------------------------------- */

enum reading probe_reading(const struct routine *routine)
{
    if (emulate_is_engine(routine->engine))
        return READING_TRACED;
    return routine->granularity && !strcmp(routine->granularity, "stage") ? READING_STAGES : READING_RECORDED;
}

static bool is_jit(const struct engine *engine)
{
    return specialize_is_engine(engine);
}

struct teller {
    const struct probe_options *options;
};

static void tell(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    const struct probe_options *options = ((struct teller *)context)->options;
    if (changed)
        options->observer(options->context, pass, ir);
}

struct routine *probe_build(const struct routine *like, struct code_arena *arena, const struct ir *ir,
                            const struct probe_options *options, struct error *error)
{
    const struct engine *engine = like->engine;
    struct teller teller = {options};
    if (is_jit(engine))
        return specialize_routine_of(engine, ir, options ? options->disabled : 0,
                                     options && options->observer ? tell : NULL, &teller, arena, like->unit,
                                     &like->key, error);
    if (external_is_engine(engine))
        return external_routine(engine, ir, like->unit, &like->key, error);
    if (like->granularity)
        return probe_stitch(ir, arena, like, error);
    struct routine *routine =
        batch_routine(ir, (unsigned)engine->width, batch_fuses(engine), like->unit, &like->key, error);
    if (routine)
        routine->engine = engine;
    return routine;
}

void probe_free(const struct routine *like, struct code_arena *arena, struct routine *routine)
{
    if (routine)
        like->engine->free(arena, routine);
}

/* --- Inserting ------------------------------------------------------------------------------------------ */

uint32_t probe_rows(const struct ir *ir)
{
    return ir->loops + ir->count;
}

static uint32_t row_of(const struct ir *ir, uint32_t instruction)
{
    return ir->loops + instruction;
}

struct inserter {
    struct ir *to;
    const struct ir *from;
    const struct replay *replay;
    const uint8_t *selected;
    uint16_t *number; /* of each instruction of `from` in `to` */
    uint16_t chosen
        [LOOP_DEPTH]; /* of each open loop: the mask of the pass that is looked at, outer loops included */
    uint16_t counter[LOOP_DEPTH]; /* and its variable */
    uint32_t depth, loops;
    uint32_t body;        /* the first instruction that probes can follow */
    uint32_t waiting;     /* phis or joins directly before the current one, which no probe can follow */
    bool prepared, ended; /* the next loop; the innermost one */
};

static uint16_t add(struct inserter *s, enum ir_op op, enum ir_type type, uint16_t a, uint16_t b, int32_t k)
{
    return ir_append(
        s->to, (struct ir_instruction){.op = (uint8_t)op, .type = (uint8_t)type, .operand = {a, b}, .k = k});
}

static uint16_t add_memory(struct inserter *s, enum ir_op op, enum ir_type type, uint16_t a, uint32_t row)
{
    return ir_append(s->to, (struct ir_instruction){.op = (uint8_t)op,
                                                    .type = (uint8_t)type,
                                                    .base = (uint8_t)replay_probe_base(s->replay->unit),
                                                    .operand = {a},
                                                    .k = replay_probe_place(s->replay, row)});
}

/* Before the loop its count is 0. */
static void prepare_loop(struct inserter *s)
{
    s->counter[s->depth] = (uint16_t)(s->from->variables + s->loops);
    add(s, IR_set, TYPE_itg, add(s, IR_literal, TYPE_itg, 0, 0, 0), 0, s->counter[s->depth]);
}

static void begin_loop(struct inserter *s)
{
    uint16_t count = add(s, IR_get, TYPE_itg, 0, 0, s->counter[s->depth]);
    uint16_t chosen = add(s, IR_eq_i, TYPE_msk, count, add_memory(s, IR_load, TYPE_itg, 0, s->loops), 0);
    if (s->depth)
        chosen = add(s, IR_and_m, TYPE_msk, chosen, s->chosen[s->depth - 1], 0);
    s->chosen[s->depth++] = chosen;
    s->loops++;
}

static void end_loop(struct inserter *s)
{
    uint16_t count = add(s, IR_get, TYPE_itg, 0, 0, s->counter[--s->depth]);
    uint16_t more = add(s, IR_add_i, TYPE_itg, count, add(s, IR_literal, TYPE_itg, 0, 0, 1), 0);
    add(s, IR_set, TYPE_itg, more, 0, s->counter[s->depth]);
}

static void insert_probe(struct inserter *s, uint32_t number)
{
    if (s->depth)
        add(s, IR_when, TYPE_non, s->chosen[s->depth - 1], 0, 0);
    add_memory(s, IR_store, TYPE_non, s->number[number], row_of(s->from, number));
    if (s->depth)
        add(s, IR_end, TYPE_non, 0, 0, 0);
}

static bool is_value(const struct ir_instruction *i)
{
    return i->type && !(ir_op_information[i->op].properties & IR_EFFECT);
}

/* Probes of phis and joins follow the last of them. The phis of a loop are before it, and its `next`s before
 * its end. */
static void insert_waiting(struct inserter *s, uint32_t number)
{
    for (; s->waiting; s->waiting--)
        if (s->selected[number - s->waiting])
            insert_probe(s, number - s->waiting);
}

static void insert_before(struct inserter *s, uint32_t number, enum ir_op op)
{
    if (op != IR_join && op != IR_phi && op != IR_loop)
        insert_waiting(s, number);
    if ((op == IR_phi || op == IR_loop) && !s->prepared) {
        insert_waiting(s, number);
        prepare_loop(s);
        s->prepared = true;
    }
    if ((op == IR_next || op == IR_again) && !s->ended) {
        end_loop(s);
        s->ended = true;
    }
}

/* The preamble writes no memory, so probes of its values follow it. */
static void insert_of_preamble(struct inserter *s, uint32_t section)
{
    for (uint32_t n = 1; n < section; n++)
        if (is_value(&s->from->instruction[n]) && s->selected[n])
            insert_probe(s, n);
    s->body = section + 1;
}

static void insert_behind(struct inserter *s, uint32_t number, const struct ir_instruction *i)
{
    if (i->op == IR_section)
        insert_of_preamble(s, number);
    if (i->op == IR_loop) {
        begin_loop(s);
        insert_waiting(s, number);
        s->prepared = false;
    }
    if (i->op == IR_again)
        s->ended = false;
    if (i->op == IR_phi || i->op == IR_join)
        s->waiting++;
    else if (number >= s->body && is_value(i) && s->selected[number])
        insert_probe(s, number);
}

/* Probes in a sampling belong to it. */
static void note_sampling(struct inserter *s, uint32_t number)
{
    const struct ir_sampling *sampling = &s->from->sampling[s->to->samplings];
    if (s->to->samplings < s->from->samplings && sampling->end == number) {
        ir_note_sampling(s->to, false);
        sampling++;
    }
    if (s->to->samplings < s->from->samplings && sampling->first == number)
        ir_note_sampling(s->to, true);
}

static void insert_all(struct inserter *s)
{
    for (uint32_t n = 1; n < s->from->count; n++) {
        struct ir_instruction i = s->from->instruction[n];
        note_sampling(s, n);
        for (int o = 0; o < ir_op_information[i.op].operands; o++)
            i.operand[o] = s->number[i.operand[o]];
        insert_before(s, n, i.op);
        s->number[n] = ir_append(s->to, i);
        insert_behind(s, n, &i);
    }
    note_sampling(s, s->from->count);
}

/* How deep loops are in one another. */
static uint32_t loop_depth(const struct ir *ir)
{
    uint32_t depth = 0, most = 0;
    for (uint32_t n = 1; n < ir->count; n++) {
        depth += ir->instruction[n].op == IR_loop;
        most = depth > most ? depth : most;
        depth -= ir->instruction[n].op == IR_again;
    }
    return most;
}

/* Writes `from` to `to`, with a probe after each instruction whose byte in `selected` is set. Rows: one for
 * each loop of the recording, with the number of the pass to observe, then one for each instruction. Returns
 * 0, or -1 if there is no room. */
static int insert_probes(struct ir *to, const struct ir *from, const uint8_t *selected,
                         const struct replay *replay)
{
    struct inserter s = {
        .to = to, .from = from, .replay = replay, .selected = selected, .body = ir_find_body(from)};
    if (loop_depth(from) > LOOP_DEPTH || from->variables + from->loops > VARIABLES)
        return -1;
    s.number = calloc(from->count, sizeof *s.number);
    if (!s.number)
        return -1;
    ir_start(to);
    memcpy(to->file, from->file, sizeof to->file);
    memcpy(to->constant, from->constant, sizeof to->constant);
    to->file_count = from->file_count;
    to->constant_count = from->constant_count;
    to->phis = from->phis;
    to->preamble = from->preamble;
    to->typed = from->typed;
    insert_all(&s);
    free(s.number);
    return to->overflow ? -1 : 0;
}

/* --- Observing ------------------------------------------------------------------------------------------ */

int observation_start(struct observation *observation, const struct event_list *events)
{
    observation->value = calloc(events->count + 1, sizeof *observation->value);
    observation->known = calloc(events->count + 1, 1);
    return observation->value && observation->known ? 0 : -1;
}

void observation_free(struct observation *observation)
{
    free(observation->value);
    free(observation->known);
    *observation = (struct observation){0};
}

/* The emulator's values are the events' as long as both are of the same lines. */
static int observe_trace(const struct probing *p, struct observation *observation, struct error *error)
{
    const uint8_t *base[BASE_COUNT];
    struct trace trace = {0};
    uint8_t *image = replay_image(p->replay);
    if (!image)
        return error_set(error, "out of memory for tracing the emulator");
    memcpy(image, p->replay->before, p->replay->output_bytes + p->replay->table_bytes);
    replay_bases(p->replay, image, p->lane, base);
    trace_emulate(&trace, p->replay->unit, p->replay->key, base);
    for (uint32_t n = 0; n < p->events.count && n < trace.count; n++) {
        if (p->ir->instruction[p->events.event[n].instruction].line != trace.value[n].line)
            break;
        memcpy(observation->value[n], trace.value[n].lane, sizeof *observation->value);
        observation->known[n] = OBSERVED_ALL;
    }
    trace_free(&trace);
    free(image);
    return 0;
}

/* One routine with probes, and what it is run with. */
struct run {
    const struct probing *probing;
    const struct routine *routine; /* without probes */
    struct routine *probed;
    uint8_t *image, *expected;
    uint8_t *selected;
    uint32_t *first, *next; /* of each visit, the first of its events + 1; of each event, the next one + 1 */
    uint32_t runs;          /* of the code so far */
};

static void list_events(struct run *run)
{
    const struct event_list *events = &run->probing->events;
    for (uint32_t n = events->count; n-- > 0;) {
        run->next[n] = run->first[events->event[n].visit];
        run->first[events->event[n].visit] = n + 1;
    }
}

/* Rows of loops: the pass of each that the visit is in. */
static void choose_visit(const struct run *run, uint32_t visit)
{
    const struct probing *p = run->probing;
    for (uint32_t row = 0; row < p->ir->loops; row++)
        memset(replay_probe_row(p->replay, run->image, row), 0xff, PROBE_ROW_BYTES);
    for (; visit; visit = p->events.visit[visit].outer)
        for (int lane = 0; lane < LANES_MAXIMUM; lane++)
            replay_probe_row(p->replay, run->image, p->events.visit[visit].loop)[lane] =
                p->events.visit[visit].pass;
}

static void clear_rows(const struct run *run)
{
    uint32_t *row = replay_probe_row(run->probing->replay, run->image, run->probing->ir->loops);
    for (size_t i = 0; i < (size_t)run->probing->ir->count * LANES_MAXIMUM; i++)
        row[i] = NOT_SEEN;
}

static void read_rows(const struct run *run, uint32_t visit, struct observation *observation)
{
    const struct probing *p = run->probing;
    for (uint32_t n = run->first[visit]; n; n = run->next[n - 1]) {
        uint32_t instruction = p->events.event[n - 1].instruction;
        if (!run->selected[instruction])
            continue;
        const uint32_t *row = replay_probe_row(p->replay, run->image, row_of(p->ir, instruction)) + p->lane;
        unsigned seen = 0;
        for (int lane = 0; lane < QUAD_LANES; lane++)
            seen |= (unsigned)(row[lane] != NOT_SEEN) << lane;
        memcpy(observation->value[n - 1], row, sizeof *observation->value);
        observation->known[n - 1] =
            (uint8_t)(seen && routine_lanes(run->routine) >= QUAD_LANES ? OBSERVED_ALL : seen);
    }
}

static bool has_visit(const struct run *run, uint32_t visit)
{
    for (uint32_t n = run->first[visit]; n; n = run->next[n - 1])
        if (run->selected[run->probing->events.event[n - 1].instruction])
            return true;
    return false;
}

/* Runs the routine once for each visit. Returns true if the outputs are those without probes; if not, the
 * values are unknown. */
static bool run_visits(struct run *run, struct observation *observation)
{
    const struct probing *p = run->probing;
    for (uint32_t visit = 0; visit < p->events.visits; visit++) {
        if (visit && !has_visit(run, visit))
            continue;
        clear_rows(run);
        choose_visit(run, visit);
        run->runs++;
        replay_run(p->replay, run->probed, run->image);
        if (replay_differs(p->replay, run->expected, run->image, NULL))
            return false;
        read_rows(run, visit, observation);
    }
    return true;
}

static bool observe_selected(struct run *run, struct ir *probed, struct observation *observation,
                             struct error *error)
{
    const struct probing *p = run->probing;
    if (insert_probes(probed, p->ir, run->selected, p->replay))
        return false;
    const struct probe_options bare = {.disabled = UINT32_MAX};
    run->probed = probe_build(run->routine, p->arena, probed, p->bare ? &bare : NULL, error);
    if (!run->probed)
        return false;
    bool faithful = run_visits(run, observation);
    probe_free(run->routine, p->arena, run->probed);
    return faithful;
}

static void forget(const struct probing *p, struct observation *observation, uint32_t instruction)
{
    for (uint32_t n = 0; n < p->events.count; n++)
        if (!instruction || p->events.event[n].instruction == instruction)
            observation->known[n] = 0;
}

/* Probes all instructions together, else one after the other. A compiler is called only for the first. */
static void observe_recorded(struct run *run, struct ir *probed, struct observation *observation)
{
    const struct probing *p = run->probing;
    struct error ignored = {{0}};
    memset(run->selected, 1, p->ir->count);
    if (observe_selected(run, probed, observation, &ignored))
        return;
    forget(p, observation, 0);
    if (external_is_engine(run->routine->engine))
        return;
    for (uint32_t number = 1; number < p->ir->count && run->runs < RUNS_MAXIMUM; number++) {
        memset(run->selected, 0, p->ir->count);
        run->selected[number] = 1;
        error_clear(&ignored);
        if (is_value(&p->ir->instruction[number]) && !observe_selected(run, probed, observation, &ignored))
            forget(p, observation, number);
    }
}

int probe_observe(const struct probing *p, const struct routine *routine, struct observation *observation,
                  struct error *error)
{
    if (probe_reading(routine) == READING_TRACED)
        return observe_trace(p, observation, error);
    struct ir *probed = ir_take(routine->unit, &routine->key, error);
    struct run run = {.probing = p, .routine = routine};
    run.image = replay_image(p->replay);
    run.expected = replay_image(p->replay);
    run.selected = calloc(p->ir->count, 1);
    run.first = calloc(p->events.visits, sizeof *run.first);
    run.next = calloc(p->events.count + 1, sizeof *run.next);
    int result = 0;
    if (!probed || !run.image || !run.expected || !run.selected || !run.first || !run.next) {
        result = error_set(error, "out of memory for observing a routine");
    } else {
        list_events(&run);
        replay_run(p->replay, routine, run.expected);
        observe_recorded(&run, probed, observation);
    }
    free(run.image);
    free(run.expected);
    free(run.selected);
    free(run.first);
    free(run.next);
    if (probed)
        ir_give(probed);
    return result;
}
