/* Plays the streams only for their keys (keys.h): the distinct routines, and the distinct sets of three that
 * a draw needs. Then the engines take turns in rounds: in each round every engine builds all routines, in the
 * order in which the streams need them, in a new arena. The figure of a routine is the median of its rounds,
 * which other work on the machine hardly changes. The figure of a set is the sum of its three routines. A
 * *burst* is the largest sum of any ten routines that the first frame of a stream needs one after the other,
 * as at a change of the scene. The first round is reported separately: its caches and pages are cold.
 *
 * If interrupted, the command reports the rounds that all engines have done. */
#include "command/bench/bench_builds.h"

#include "base/clock.h"
#include "machine/code.h"
#include "engines/list.h"
#include "command/support/choose.h"
#include "command/support/interrupt.h"
#include "command/support/json.h"
#include "command/list/keys.h"
#include "command/bench/execution.h"
#include "command/bench/machine.h"
#include "command/bench/summary.h"
#include "command/support/session.h"
#include "command/support/table.h"

#include <stdlib.h>
#include <string.h>

enum { ARENA_BYTES = 256 << 20, BURST = 10 };

/* A routine of an engine. */
struct sample {
    struct routine *routine;
    double *us; /* of each round */
    double median;
};

struct builder {
    const struct engine *engine;
    struct sample *sample; /* of each routine that was found */
    double *us;            /* of all samples */
    struct execution execution;
};

/* The routines of a stream's first frame, as indices into keys.found, in the order of their first use. */
struct opening {
    size_t count, *routine;
    double *us; /* of each */
};

struct collection {
    struct keys keys;
    struct opening *opening; /* of each stream */
    unsigned openings;
    unsigned rounds; /* to be done; later, those that are done */
    unsigned builder_count;
    struct builder builder[CHOICE_CAPACITY];
};

static int collect_opening(struct collection *c, const struct stream *stream, struct error *error)
{
    struct keys own = {0};
    struct opening *opening = &c->opening[c->openings];
    int bad = keys_collect_first(&own, stream, error);
    opening->routine = calloc(own.count + 1, sizeof *opening->routine);
    opening->us = calloc(own.count + 1, sizeof *opening->us);
    c->openings++;
    if (!bad && (!opening->routine || !opening->us))
        bad = error_set(error, "no memory for %zu routines", own.count);
    for (; opening->count < own.count && !bad; opening->count++)
        opening->routine[opening->count] = keys_index(&c->keys, &own.found[opening->count]);
    keys_free(&own);
    return bad;
}

static int collect(const struct command *self, const char *path, struct collection *c)
{
    struct error error = {""};
    struct stream *stream = session_load(self, path);
    if (!stream)
        return STATUS_BAD;
    tool_progress("%s: %zu routines so far", path, c->keys.count);
    int bad = keys_collect(&c->keys, stream, interrupt_signal, &error);
    if (!bad && !interrupt_signal())
        bad = collect_opening(c, stream, &error);
    stream_free(stream);
    return bad ? tool_fail(self, "%s: %s", path, error.text) : STATUS_OK;
}

/* --- Building ------------------------------------------------------------------------------------------- */

static int build_round(struct builder *builder, const struct keys *keys, unsigned round, struct error *error)
{
    const struct engine *engine = builder->engine;
    struct code_arena *arena = engine->without_arena ? NULL : code_create(ARENA_BYTES, NULL, error);
    bool bad = !arena && !engine->without_arena;
    size_t built = 0;
    for (; built < keys->count && !bad; built++) {
        const struct key_found *found = keys->found + built;
        struct sample *sample = builder->sample + built;
        double start = clock_seconds() * 1e6;
        sample->routine = engine_build(engine, arena, found->unit, &found->key, error);
        sample->us[round] = clock_seconds() * 1e6 - start;
        bad = !sample->routine;
        if (!bad && !round)
            execution_add(&builder->execution, sample->routine);
    }
    for (size_t i = 0; i < built; i++)
        if (builder->sample[i].routine)
            engine->free(arena, builder->sample[i].routine);
    code_destroy(arena);
    return bad;
}

/* A kind of row: the routines of a unit, sets, or the bursts of streams. */
enum { KIND_SET = UNIT_COUNT, KIND_BURST, KINDS };

static const char *kind_name(unsigned kind)
{
    return kind < UNIT_COUNT ? unit_name[kind] : kind == KIND_SET ? "set" : "burst";
}

static double of_round(const struct sample *sample, int round)
{
    return round < 0 ? sample->median : sample->us[round];
}

static double burst_of(const struct opening *opening, const struct sample *samples, int round)
{
    for (size_t i = 0; i < opening->count; i++)
        opening->us[i] = of_round(samples + opening->routine[i], round);
    return summary_window(opening->us, opening->count, BURST);
}

/* Of a kind, in a round or, if that is -1, by their medians. */
static struct summary summarize_kind(const struct collection *c, const struct sample *samples, unsigned kind,
                                     int round, double *values)
{
    size_t count = 0;
    for (size_t i = 0; i < c->keys.count && kind < UNIT_COUNT; i++)
        if (c->keys.found[i].unit == kind)
            values[count++] = of_round(samples + i, round);
    for (size_t i = 0; i < c->keys.sets && kind == KIND_SET; i++, count++) {
        values[count] = 0;
        for (int unit = 0; unit < UNIT_COUNT; unit++)
            values[count] += of_round(samples + c->keys.set[i].routine[unit], round);
    }
    for (size_t i = 0; i < c->openings && kind == KIND_BURST; i++)
        if (c->opening[i].count)
            values[count++] = burst_of(&c->opening[i], samples, round);
    return summary_of(values, count);
}

static void find_medians(const struct collection *c, struct sample *samples, double *values)
{
    for (size_t i = 0; i < c->keys.count; i++) {
        memcpy(values, samples[i].us, c->rounds * sizeof *values);
        samples[i].median = summary_of(values, c->rounds).median;
    }
}

static cJSON *json_row(const struct engine *engine, const struct execution *execution, unsigned kind,
                       const struct summary *all, const struct summary *first)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "engine", engine->name);
    execution_json(execution, json);
    cJSON_AddStringToObject(json, "what", kind_name(kind));
    cJSON_AddNumberToObject(json, "count", (double)all->count);
    cJSON_AddNumberToObject(json, "least_us", all->least);
    cJSON_AddNumberToObject(json, "p10_us", all->p10);
    cJSON_AddNumberToObject(json, "median_us", all->median);
    cJSON_AddNumberToObject(json, "p90_us", all->p90);
    cJSON_AddNumberToObject(json, "p99_us", all->p99);
    cJSON_AddNumberToObject(json, "most_us", all->most);
    cJSON_AddNumberToObject(json, "first_median_us", first->median);
    cJSON_AddNumberToObject(json, "first_p99_us", first->p99);
    cJSON_AddNumberToObject(json, "first_most_us", first->most);
    return json;
}

static void report(const struct collection *c, const struct builder *builder, double *values,
                   struct table *table, cJSON *rows)
{
    char lanes[EXECUTION_TEXT];
    const struct execution *execution = &builder->execution;
    find_medians(c, builder->sample, values);
    for (unsigned kind = 0; kind < KINDS; kind++) {
        struct summary first = summarize_kind(c, builder->sample, kind, 0, values);
        struct summary all = summarize_kind(c, builder->sample, kind, -1, values);
        const double cells[] = {all.least, all.p10,      all.median, all.p90,   all.p99,
                                all.most,  first.median, first.p99,  first.most};
        table_cell(table, "%s", builder->engine->name);
        table_cell(table, "%s", execution_lanes(execution, lanes));
        table_cell(table, "%s", execution_set(execution));
        table_cell(table, "%s", kind_name(kind));
        table_cell(table, "%zu", all.count);
        for (size_t i = 0; i < sizeof cells / sizeof *cells; i++)
            table_cell(table, "%.1f", cells[i]);
        cJSON_AddItemToArray(rows, json_row(builder->engine, execution, kind, &all, &first));
    }
}

/* Every second round is in the opposite order, as in bench.c. */
static int measure(const struct command *self, struct collection *c)
{
    struct error error = {""};
    unsigned round = 0;
    for (; round < c->rounds && !interrupt_signal(); round++)
        for (unsigned i = 0; i < c->builder_count; i++) {
            struct builder *builder = c->builder + (round % 2 ? c->builder_count - 1 - i : i);
            tool_progress("round %u of %u: %s", round + 1, c->rounds, builder->engine->name);
            if (build_round(builder, &c->keys, round, &error))
                return tool_fail(self, "engine %s: %s", builder->engine->name, error.text);
        }
    c->rounds = round;
    return STATUS_OK;
}

static int start_builders(const struct command *self, const struct choice *engines, struct collection *c)
{
    for (; c->builder_count < engines->count; c->builder_count++) {
        struct builder *builder = c->builder + c->builder_count;
        *builder = (struct builder){.engine = engine_at(engines->index[c->builder_count]),
                                    .sample = calloc(c->keys.count + 1, sizeof *builder->sample),
                                    .us = calloc(c->keys.count * c->rounds + 1, sizeof *builder->us)};
        if (!builder->sample || !builder->us)
            return c->builder_count++, tool_fail(self, "no memory for %zu routines", c->keys.count);
        for (size_t i = 0; i < c->keys.count; i++)
            builder->sample[i].us = builder->us + i * c->rounds;
    }
    return STATUS_OK;
}

static void begin_table(struct table *table)
{
    static const char *const headings[] = {"count", "min", "p10",           "median", "p90",
                                           "p99",   "max", "first: median", "p99",    "max"};
    table_column(table, "engine", TABLE_LEFT);
    table_column(table, "lanes", TABLE_LEFT);
    table_column(table, "set", TABLE_LEFT);
    table_column(table, "microseconds", TABLE_LEFT);
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        table_column(table, headings[i], TABLE_RIGHT);
}

static int measure_all(const struct command *self, const struct choice *engines, struct collection *c,
                       cJSON *rows)
{
    struct table table = {0};
    size_t most = c->keys.sets > c->keys.count ? c->keys.sets : c->keys.count;
    double *values = calloc(most + c->rounds + c->openings + 1, sizeof *values);
    int status =
        values ? start_builders(self, engines, c) : tool_fail(self, "no memory for %zu routines", most);
    if (!status)
        status = measure(self, c);
    tool_progress(NULL);
    begin_table(&table);
    for (unsigned i = 0; i < c->builder_count && !status && c->rounds; i++)
        report(c, c->builder + i, values, &table, rows);
    table_print(&table, 0, stdout);
    for (unsigned i = 0; i < c->builder_count; i++) {
        free(c->builder[i].sample);
        free(c->builder[i].us);
    }
    free(values);
    return status;
}

static void free_openings(struct collection *c)
{
    for (unsigned i = 0; i < c->openings; i++) {
        free(c->opening[i].routine);
        free(c->opening[i].us);
    }
    free(c->opening);
}

int bench_builds(const struct command *self, char **paths, unsigned count, const struct choice *engines,
                 unsigned rounds, const char *json)
{
    struct collection c = {.rounds = rounds, .opening = calloc(count + 1, sizeof *c.opening)};
    const struct machine machine = machine_describe();
    int status = c.opening ? STATUS_OK : tool_fail(self, "no memory for %u streams", count);
    for (unsigned i = 0; i < count && !status && !interrupt_signal(); i++)
        status = collect(self, paths[i], &c);
    tool_progress(NULL);
    cJSON *report = cJSON_CreateObject();
    cJSON_AddItemToObject(report, "machine", machine_json(&machine));
    cJSON *rows = cJSON_AddArrayToObject(report, "builds");
    if (interrupt_signal())
        c.rounds = 0;
    if (!status && c.rounds) {
        printf("%u streams, %zu routines, %zu sets, %u rounds; commit %s, %s\n", count, c.keys.count,
               c.keys.sets, rounds, machine.commit, machine.date);
        status = measure_all(self, engines, &c, rows);
    }
    cJSON_AddNumberToObject(report, "rounds", c.rounds);
    if (interrupt_signal())
        cJSON_AddStringToObject(report, "interrupted", interrupt_name());
    if (!status && json)
        status = json_write(self, report, json);
    if (!status && interrupt_signal()) {
        printf("\ninterrupted by %s: %u of %u rounds\n", interrupt_name(), c.rounds, rounds);
        status = interrupt_status();
    }
    cJSON_Delete(report);
    free_openings(&c);
    keys_free(&c.keys);
    return status;
}
