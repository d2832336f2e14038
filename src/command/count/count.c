#include "command/count/count.h"

#include "command/count/counted.h"
#include "command/support/interrupt.h"
#include "command/support/session.h"
#include "command/support/table.h"
#include "engines/list.h"

#include <math.h>
#include <stdlib.h>

/* --- Reporting ------------------------------------------------------------------------------------------ */

static void add_number(cJSON *json, const char *name, double value)
{
    cJSON_AddNumberToObject(json, name, value);
}

/* The bits that number all values of a unit's key. */
static double key_bits(enum unit unit)
{
    double bits = 0;
    size_t count;
    const struct key_field *fields = key_fields(unit, &count);
    for (size_t i = 0; i < count; i++)
        bits += fields[i].count * log2(fields[i].radix);
    return bits;
}

/* An array of the classes up to the last that is not empty. */
static void add_classes(cJSON *json, const char *name, const uint32_t classes[CACHE_CLASSES])
{
    int last = CACHE_CLASSES - 1;
    while (last >= 0 && !classes[last])
        last--;
    cJSON *array = cJSON_AddArrayToObject(json, name);
    for (int i = 0; i <= last; i++)
        cJSON_AddItemToArray(array, cJSON_CreateNumber(classes[i]));
}

static cJSON *json_unit(const struct counted *c, enum unit unit)
{
    const struct cache_unit *counts = &c->cache.unit[unit];
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "unit", unit_name[unit]);
    add_number(json, "key_bits", key_bits(unit));
    add_number(json, "keys", (double)c->states.keys[unit].count);
    add_number(json, "hits", (double)counts->hits);
    add_number(json, "misses", (double)counts->misses);
    add_number(json, "evictions", (double)counts->evictions);
    add_number(json, "routines", (double)counts->routines);
    add_number(json, "bytes", (double)counts->bytes);
    add_number(json, "lookups", (double)counts->lookups);
    add_number(json, "wrong_keys", (double)counts->wrong_keys);
    add_number(json, "shared_keys", (double)counts->shared_keys);
    add_number(json, "lookup_ns", (double)counts->lookup_ns);
    add_number(json, "build_ns", (double)counts->build_ns);
    add_classes(json, "builds_by_us", counts->build_us);
    add_classes(json, "builds_by_bytes", counts->code_bytes);
    return json;
}

static cJSON *json_tier(const struct routine_tier *tier)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "engine", tier->engine);
    add_number(json, "runs", (double)tier->runs);
    add_number(json, "elements", (double)tier->elements);
    add_number(json, "builds", tier->builds);
    add_number(json, "drops", tier->drops);
    add_number(json, "build_ns", (double)tier->build_ns);
    add_number(json, "code_bytes", tier->code_bytes);
    return json;
}

static cJSON *json_tracking(const struct counted *c, enum unit unit)
{
    const struct routine_tracking *tracking = &c->tracking[unit];
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "unit", unit_name[unit]);
    add_number(json, "routines", c->tracked[unit]);
    add_number(json, "words", tracking->words);
    add_number(json, "draws", (double)tracking->draws);
    add_number(json, "burnt_draws", (double)tracking->burnt_draws);
    add_number(json, "compared", (double)tracking->compared);
    add_number(json, "guards", (double)tracking->guards);
    add_number(json, "failures", (double)tracking->failures);
    add_number(json, "variants", tracking->variants);
    add_number(json, "burnt", tracking->burnt);
    add_number(json, "refused", tracking->refused);
    add_number(json, "bytes", (double)tracking->bytes);
    return json;
}

static void add_second(cJSON *json, const struct count_second *second)
{
    cJSON *object = cJSON_AddObjectToObject(json, "second");
    add_number(object, "routines", second->routines);
    add_number(object, "built", second->built);
    add_number(object, "blocks", (double)second->blocks);
    add_number(object, "runs", (double)second->runs);
    add_number(object, "bytes", (double)second->bytes);
}

static cJSON *json_frame(const struct count_frame *frame)
{
    cJSON *json = cJSON_CreateObject();
    add_number(json, "draws", frame->states.draws);
    add_number(json, "states", frame->states.states);
    add_number(json, "new", frame->states.fresh);
    add_number(json, "changes", frame->states.changes);
    add_number(json, "returns", frame->states.returns);
    add_number(json, "ms", frame->ms);
    return json;
}

static cJSON *json_of(const struct counted *c, const struct setting_values *settings)
{
    char text[SETTING_TEXT];
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "stream", c->name);
    cJSON_AddStringToObject(json, "engine", c->engine->name);
    cJSON_AddStringToObject(json, "settings", setting_write(settings, text));
    add_number(json, "budget", (double)c->budget);
    add_number(json, "states", (double)c->states.sets.count);
    cJSON *units = cJSON_AddArrayToObject(json, "units");
    for (enum unit unit = 0; unit < UNIT_COUNT; unit++)
        cJSON_AddItemToArray(units, json_unit(c, unit));
    cJSON *tiers = cJSON_AddArrayToObject(json, "tiers");
    for (unsigned i = 0; i < c->tiers.count; i++)
        cJSON_AddItemToArray(tiers, json_tier(c->tiers.tier + i));
    cJSON *tracking = cJSON_AddArrayToObject(json, "tracking");
    for (enum unit unit = 0; unit < UNIT_COUNT; unit++)
        if (c->tracked[unit])
            cJSON_AddItemToArray(tracking, json_tracking(c, unit));
    add_second(json, &c->second);
    cJSON *frames = cJSON_AddArrayToObject(json, "frames");
    for (unsigned i = 0; i < c->frames; i++)
        cJSON_AddItemToArray(frames, json_frame(c->frame + i));
    return json;
}

/* Of units, tiers, tracked constants, and second codes. */
enum { COUNT_TABLES = 4 };

static void begin_tables(struct table tables[COUNT_TABLES])
{
    static const char *const unit[] = {"keys",     "hits",  "misses",    "evictions",
                                       "routines", "bytes", "lookup ns", "build us"};
    static const char *const tier[] = {"runs", "elements", "builds", "drops", "build us", "bytes"};
    static const char *const track[] = {"words",  "draws",    "with variant", "guards",
                                        "failed", "variants", "burnt words",  "bytes"};
    static const char *const second[] = {"routines", "second codes", "blocks before", "calls", "bytes"};
    for (int i = 0; i < COUNT_TABLES; i++) {
        table_column(&tables[i], "stream", TABLE_LEFT);
        table_column(&tables[i], "engine", TABLE_LEFT);
        table_column(&tables[i], i == 1 ? "tier" : "unit", TABLE_LEFT);
    }
    for (size_t i = 0; i < sizeof unit / sizeof *unit; i++)
        table_column(&tables[0], unit[i], TABLE_RIGHT);
    for (size_t i = 0; i < sizeof tier / sizeof *tier; i++)
        table_column(&tables[1], tier[i], TABLE_RIGHT);
    for (size_t i = 0; i < sizeof track / sizeof *track; i++)
        table_column(&tables[2], track[i], TABLE_RIGHT);
    for (size_t i = 0; i < sizeof second / sizeof *second; i++)
        table_column(&tables[3], second[i], TABLE_RIGHT);
}

static double mean(double sum, uint64_t count)
{
    return count ? sum / (double)count : 0;
}

static void add_unit_row(const struct counted *c, enum unit unit, struct table *table)
{
    const struct cache_unit *counts = &c->cache.unit[unit];
    table_cell(table, "%s", c->name);
    table_cell(table, "%s", c->engine->name);
    table_cell(table, "%s", unit_name[unit]);
    table_cell(table, "%zu", c->states.keys[unit].count);
    table_cell(table, "%llu", (unsigned long long)counts->hits);
    table_cell(table, "%llu", (unsigned long long)counts->misses);
    table_cell(table, "%llu", (unsigned long long)counts->evictions);
    table_cell(table, "%zu", counts->routines);
    table_cell(table, "%zu", counts->bytes);
    table_cell(table, "%.0f", mean((double)counts->lookup_ns, counts->lookups));
    table_cell(table, "%.1f", mean((double)counts->build_ns / 1e3, counts->misses));
}

static void add_tier_row(const struct counted *c, const struct routine_tier *tier, struct table *table)
{
    table_cell(table, "%s", c->name);
    table_cell(table, "%s", c->engine->name);
    table_cell(table, "%s", tier->engine);
    table_cell(table, "%llu", (unsigned long long)tier->runs);
    table_cell(table, "%llu", (unsigned long long)tier->elements);
    table_cell(table, "%u", tier->builds);
    table_cell(table, "%u", tier->drops);
    table_cell(table, "%.1f", mean((double)tier->build_ns / 1e3, tier->builds));
    table_cell(table, "%u", tier->code_bytes);
}

static void add_tracking_row(const struct counted *c, enum unit unit, struct table *table)
{
    const struct routine_tracking *tracking = &c->tracking[unit];
    table_cell(table, "%s", c->name);
    table_cell(table, "%s", c->engine->name);
    table_cell(table, "%s", unit_name[unit]);
    table_cell(table, "%u", tracking->words);
    table_cell(table, "%llu", (unsigned long long)tracking->draws);
    table_cell(table, "%llu", (unsigned long long)tracking->burnt_draws);
    table_cell(table, "%llu", (unsigned long long)tracking->guards);
    table_cell(table, "%llu", (unsigned long long)tracking->failures);
    table_cell(table, "%u", tracking->variants);
    table_cell(table, "%u", tracking->burnt);
    table_cell(table, "%zu", tracking->bytes);
}

static void add_second_row(const struct counted *c, struct table *table)
{
    const struct count_second *second = &c->second;
    table_cell(table, "%s", c->name);
    table_cell(table, "%s", c->engine->name);
    table_cell(table, "%s", unit_name[UNIT_PIXEL]);
    table_cell(table, "%u", second->routines);
    table_cell(table, "%u", second->built);
    table_cell(table, "%llu", (unsigned long long)second->blocks);
    table_cell(table, "%llu", (unsigned long long)second->runs);
    table_cell(table, "%llu", (unsigned long long)second->bytes);
}

static void report(const struct counted *c, const struct setting_values *settings,
                   struct table tables[COUNT_TABLES], cJSON *rows)
{
    for (enum unit unit = 0; unit < UNIT_COUNT; unit++)
        add_unit_row(c, unit, &tables[0]);
    for (unsigned i = 0; i < c->tiers.count; i++)
        add_tier_row(c, c->tiers.tier + i, &tables[1]);
    for (enum unit unit = 0; unit < UNIT_COUNT; unit++)
        if (c->tracked[unit])
            add_tracking_row(c, unit, &tables[2]);
    if (c->second.routines)
        add_second_row(c, &tables[3]);
    cJSON_AddItemToArray(rows, json_of(c, settings));
}

/* --- All of them ---------------------------------------------------------------------------------------- */

static int count_one(const struct command *self, const struct stream *stream, const struct engine *engine,
                     const struct count_settings *settings, struct table tables[COUNT_TABLES], cJSON *rows)
{
    char name[64];
    struct counted c = {.stream = stream, .name = name, .engine = engine, .frames = stream->frame_count};
    tool_path_stem(stream->path, name, sizeof name);
    if (settings->frames && settings->frames < c.frames)
        c.frames = settings->frames;
    c.budget = (size_t)settings->budget_kib << 10;
    c.frame = calloc(c.frames + 1, sizeof *c.frame);
    if (!c.frame)
        return tool_fail(self, "no memory for %u frames", c.frames);
    struct error error = {""};
    int status = count_play(&c, settings->threads, &settings->renderer, interrupt_signal, &error);
    if (status)
        status = tool_fail(self, "%s: %s", name, error.text);
    if (!status && !interrupt_signal())
        report(&c, &settings->renderer, tables, rows);
    count_states_free(&c.states);
    free(c.frame);
    return status;
}

static int count_stream(const struct command *self, const char *path, const struct choice *engines,
                        const struct count_settings *settings, struct table tables[COUNT_TABLES], cJSON *rows)
{
    struct stream *stream = session_load(self, path);
    int status = stream ? STATUS_OK : STATUS_BAD;
    for (unsigned i = 0; i < engines->count && !status && !interrupt_signal(); i++)
        status = count_one(self, stream, engine_at(engines->index[i]), settings, tables, rows);
    stream_free(stream);
    return status;
}

int count_all(const struct command *self, char **paths, unsigned count, const struct choice *engines,
              const struct count_settings *settings, cJSON *report)
{
    struct table tables[COUNT_TABLES] = {{0}};
    cJSON *rows = cJSON_AddArrayToObject(report, "counts");
    int status = STATUS_OK;
    begin_tables(tables);
    for (unsigned i = 0; i < count && !status && !interrupt_signal(); i++)
        status = count_stream(self, paths[i], engines, settings, tables, rows);
    table_print(&tables[0], 0, stdout);
    for (int i = 1; i < COUNT_TABLES; i++)
        if (tables[i].cells)
            table_print(&tables[i], 0, stdout);
    return status;
}
