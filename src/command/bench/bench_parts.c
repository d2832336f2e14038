/* Builds each routine of the streams several times, in rounds as bench_builds.c, and measures the parts of
 * each build (engines/specialize/parts.h). The time of a part is the median of its rounds. The summaries are
 * over all routines; what passes remove does not change from round to round. */
#include "command/bench/bench_builds.h"
#include "command/rules/rules.h"

#include "engines/list.h"
#include "engines/specialize/parts.h"
#include "engines/specialize/specialize.h"
#include "command/list/keys.h"
#include "command/support/interrupt.h"
#include "command/support/json.h"
#include "command/support/session.h"
#include "command/support/table.h"
#include "command/bench/machine.h"
#include "command/bench/summary.h"

#include <stdlib.h>
#include <string.h>

enum { ALL = BUILD_PARTS, TIMES }; /* the whole build, after its parts */

/* The measurements of an engine. */
struct parts {
    const struct keys *keys;
    unsigned rounds;
    double *us;                /* by routine, part and round */
    struct build_parts *build; /* by routine, of the last round */
    double *values;            /* for summaries: of all routines or rounds */
    struct rules rules;
};

static double *us_of(const struct parts *p, size_t routine, unsigned part)
{
    return p->us + (routine * TIMES + part) * p->rounds;
}

static int measure_routine(const struct parts *p, const struct engine *engine, size_t n, unsigned round,
                           struct error *error)
{
    const struct key_found *found = p->keys->found + n;
    struct build_parts *build = p->build + n;
    double all = 0;
    if (specialize_measure(engine, found->unit, &found->key, build, error))
        return -1;
    for (unsigned part = 0; part < BUILD_PARTS; part++) {
        us_of(p, n, part)[round] = (double)build->part[part].ns / 1e3;
        all += us_of(p, n, part)[round];
    }
    us_of(p, n, ALL)[round] = all;
    return 0;
}

/* Over the routines of a unit, or of all with UNIT_COUNT. */
static struct summary summarize(const struct parts *p, unsigned unit, unsigned part)
{
    size_t count = 0;
    for (size_t n = 0; n < p->keys->count; n++)
        if (unit == UNIT_COUNT || p->keys->found[n].unit == unit)
            p->values[count++] = us_of(p, n, part)[0];
    return summary_of(p->values, count);
}

static void find_medians(const struct parts *p)
{
    for (size_t n = 0; n < p->keys->count; n++)
        for (unsigned part = 0; part < TIMES; part++)
            us_of(p, n, part)[0] = summary_of(us_of(p, n, part), p->rounds).median;
}

/* --- Report --------------------------------------------------------------------------------------------- */

/* Sums over the routines of a unit. */
struct sums {
    double us[TIMES], runs[BUILD_PARTS], removed[BUILD_PARTS], first_left[BUILD_PARTS];
    double recorded, left, bytes, spills;
    size_t routines;
};

static void add_routine(const struct parts *p, size_t n, struct sums *sums)
{
    const struct build_parts *build = p->build + n;
    for (unsigned part = 0; part < TIMES; part++)
        sums->us[part] += us_of(p, n, part)[0];
    for (unsigned part = 0; part < BUILD_PARTS; part++) {
        sums->runs[part] += build->part[part].runs;
        sums->removed[part] += build->part[part].removed;
        sums->first_left[part] += build->part[part].first_left;
    }
    sums->recorded += build->recorded;
    sums->left += build->left;
    sums->bytes += build->bytes;
    sums->spills += build->spills;
    sums->routines++;
}

static struct sums sum_of(const struct parts *p, unsigned unit)
{
    struct sums sums = {.routines = 0};
    for (size_t n = 0; n < p->keys->count; n++)
        if (unit == UNIT_COUNT || p->keys->found[n].unit == unit)
            add_routine(p, n, &sums);
    return sums;
}

static const char *part_name(unsigned part)
{
    return part == ALL ? "all" : specialize_part_name(part);
}

static double share_of(const struct sums *sums, unsigned part)
{
    return sums->us[ALL] > 0 ? sums->us[part] / sums->us[ALL] : 0;
}

static cJSON *json_part(const struct sums *sums, unsigned part, const struct summary *us)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "part", part_name(part));
    cJSON_AddNumberToObject(json, "median_us", us->median);
    cJSON_AddNumberToObject(json, "p99_us", us->p99);
    cJSON_AddNumberToObject(json, "most_us", us->most);
    cJSON_AddNumberToObject(json, "sum_us", sums->us[part]);
    cJSON_AddNumberToObject(json, "share", share_of(sums, part));
    if (part == ALL)
        return json;
    cJSON_AddNumberToObject(json, "runs", sums->runs[part]);
    cJSON_AddNumberToObject(json, "removed", sums->removed[part]);
    cJSON_AddNumberToObject(json, "first_left", sums->first_left[part]);
    return json;
}

static cJSON *json_unit(const struct parts *p, const struct engine *engine, unsigned unit)
{
    const struct sums sums = sum_of(p, unit);
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "engine", engine->name);
    cJSON_AddStringToObject(json, "unit", unit == UNIT_COUNT ? "all" : unit_name[unit]);
    cJSON_AddNumberToObject(json, "routines", (double)sums.routines);
    cJSON_AddNumberToObject(json, "recorded", sums.recorded);
    cJSON_AddNumberToObject(json, "left", sums.left);
    cJSON_AddNumberToObject(json, "bytes", sums.bytes);
    cJSON_AddNumberToObject(json, "spills", sums.spills);
    double seconds = sums.us[ALL] / 1e6;
    const double instructions = p->rules.instructions[unit];
    cJSON_AddNumberToObject(json, "instructions_per_second", seconds > 0 ? sums.left / seconds : 0);
    cJSON_AddNumberToObject(json, "machine_instructions", instructions);
    cJSON_AddNumberToObject(json, "machine_instructions_per_second",
                            seconds > 0 ? instructions / seconds : 0);
    cJSON_AddNumberToObject(json, "bytes_per_second", seconds > 0 ? sums.bytes / seconds : 0);
    cJSON *parts = cJSON_AddArrayToObject(json, "parts");
    for (unsigned part = 0; part < TIMES; part++) {
        const struct summary us = summarize(p, unit, part);
        cJSON_AddItemToArray(parts, json_part(&sums, part, &us));
    }
    rules_report(&p->rules, unit, json);
    return json;
}

static void print_engine(const struct parts *p, const struct engine *engine)
{
    static const char *const headings[] = {"median us", "p99", "share %", "runs", "removed", "left"};
    const struct sums sums = sum_of(p, UNIT_COUNT);
    struct table table = {0};
    table_column(&table, engine->name, TABLE_LEFT);
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        table_column(&table, headings[i], TABLE_RIGHT);
    for (unsigned part = 0; part < TIMES; part++) {
        const struct summary us = summarize(p, UNIT_COUNT, part);
        table_cell(&table, "%s", part_name(part));
        table_cell(&table, "%.2f", us.median);
        table_cell(&table, "%.2f", us.p99);
        table_cell(&table, "%.1f", 100 * share_of(&sums, part));
        for (unsigned column = 0; column < 3; column++)
            if (part == ALL)
                table_cell(&table, "%s", "");
            else
                table_cell(&table, "%.0f",
                           (column == 0   ? sums.runs
                            : column == 1 ? sums.removed
                                          : sums.first_left)[part]);
    }
    table_print(&table, 0, stdout);
    const double instructions = p->rules.instructions[UNIT_COUNT];
    printf(
        "%.0f operations recorded, %.0f left; a second: %.2f million operations, %.2f million instructions "
        "and %.1f MB of code\n\n",
        sums.recorded, sums.left, sums.left / sums.us[ALL], instructions / sums.us[ALL],
        sums.bytes / sums.us[ALL]);
    rules_print(&p->rules);
    putchar('\n');
}

/* --- Measuring ------------------------------------------------------------------------------------------ */

static int measure(const struct command *self, const struct engine *engine, struct parts *p, cJSON *rows)
{
    struct error error = {""};
    for (unsigned round = 0; round < p->rounds && !interrupt_signal(); round++) {
        tool_progress("round %u of %u: %s", round + 1, p->rounds, engine->name);
        for (size_t n = 0; n < p->keys->count; n++)
            if (measure_routine(p, engine, n, round, &error))
                return tool_fail(self, "engine %s: %s", engine->name, error.text);
    }
    tool_progress("rules: %s", engine->name);
    int bad = interrupt_signal() ? 0 : rules_count(engine, p->keys, &p->rules, &error);
    tool_progress(NULL);
    if (bad)
        return tool_fail(self, "engine %s: %s", engine->name, error.text);
    if (interrupt_signal())
        return STATUS_OK;
    find_medians(p);
    print_engine(p, engine);
    for (unsigned unit = 0; unit <= UNIT_COUNT; unit++)
        cJSON_AddItemToArray(rows, json_unit(p, engine, unit));
    return STATUS_OK;
}

static int measure_engines(const struct command *self, const struct choice *engines, const struct keys *keys,
                           unsigned rounds, cJSON *rows)
{
    size_t most = keys->count > rounds ? keys->count : rounds;
    struct parts p = {.keys = keys,
                      .rounds = rounds,
                      .us = calloc(keys->count * TIMES * rounds + 1, sizeof *p.us),
                      .build = calloc(keys->count + 1, sizeof *p.build),
                      .values = calloc(most + 1, sizeof *p.values)};
    int status = STATUS_OK;
    if (!p.us || !p.build || !p.values)
        status = tool_fail(self, "no memory for %zu routines", keys->count);
    for (unsigned i = 0; i < engines->count && !status && !interrupt_signal(); i++)
        status = measure(self, engine_at(engines->index[i]), &p, rows);
    free(p.us);
    free(p.build);
    free(p.values);
    return status;
}

static int collect(const struct command *self, const char *path, struct keys *keys)
{
    struct error error = {""};
    struct stream *stream = session_load(self, path);
    if (!stream)
        return STATUS_BAD;
    int bad = keys_collect(keys, stream, interrupt_signal, &error);
    stream_free(stream);
    return bad ? tool_fail(self, "%s: %s", path, error.text) : STATUS_OK;
}

/* Only the specializer's engines have parts. Of a default list, the others are left out. */
static int select_engines(const struct command *self, bool named, struct choice *engines)
{
    unsigned count = 0;
    for (unsigned i = 0; i < engines->count; i++) {
        const struct engine *engine = engine_at(engines->index[i]);
        if (specialize_is_engine(engine))
            engines->index[count++] = engines->index[i];
        else if (named)
            return tool_fail(self, "engine %s has no parts, expected specialize or one of its kind",
                             engine->name);
    }
    engines->count = count;
    return count ? STATUS_OK : tool_fail(self, "none of the specializer's engines can run here");
}

int bench_parts(const struct command *self, char **paths, unsigned count, bool named, struct choice *engines,
                unsigned rounds, const char *json)
{
    struct keys keys = {0};
    const struct machine machine = machine_describe();
    int status = select_engines(self, named, engines);
    for (unsigned i = 0; i < count && !status && !interrupt_signal(); i++) {
        tool_progress("%s: %zu routines so far", paths[i], keys.count);
        status = collect(self, paths[i], &keys);
    }
    tool_progress(NULL);
    cJSON *report = cJSON_CreateObject();
    cJSON_AddItemToObject(report, "machine", machine_json(&machine));
    cJSON_AddNumberToObject(report, "rounds", rounds);
    cJSON *rows = cJSON_AddArrayToObject(report, "engines");
    if (!status && !interrupt_signal()) {
        printf("%u streams, %zu routines, %u rounds; commit %s, %s\n\n", count, keys.count, rounds,
               machine.commit, machine.date);
        status = measure_engines(self, engines, &keys, rounds, rows);
    }
    if (interrupt_signal())
        cJSON_AddStringToObject(report, "interrupted", interrupt_name());
    if (!status && json)
        status = json_write(self, report, json);
    if (!status && interrupt_signal())
        status = interrupt_status();
    cJSON_Delete(report);
    keys_free(&keys);
    return status;
}
