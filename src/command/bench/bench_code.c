/* The streams are played only for their keys (keys.h). Each engine then builds every routine once, and its
 * code is decoded: instructions, memory operands, and those of them in the stack frame. The figures depend on
 * the code only, so they are the same in every run. An instruction in a loop counts once. */
#include "command/bench/bench_builds.h"

#include "machine/code.h"
#include "machine/disassemble.h"
#include "engines/list.h"
#include "command/list/keys.h"
#include "command/support/interrupt.h"
#include "command/support/json.h"
#include "command/support/session.h"
#include "command/support/table.h"
#include "command/bench/machine.h"
#include "shader/program/program.h"

enum { ARENA_BYTES = 256 << 20 };

enum figure {
    FIGURE_lanes,
    FIGURE_code_bytes,
    FIGURE_instructions,
    FIGURE_reads,
    FIGURE_writes,
    FIGURE_frame,
    FIGURE_spills,
    FIGURE_parts,
    FIGURES
};

static const char *const figure_name[FIGURES] = {"lanes",  "code_bytes", "instructions", "reads",
                                                 "writes", "frame",      "spills",       "parts"};

/* The sums over the routines of a unit. */
struct sums {
    size_t routines;
    double figure[FIGURES];
    double per_element; /* instructions / lanes */
};

static void find_figures(const struct routine *routine, double figure[FIGURES])
{
    struct disassemble_counts counts = {0};
    if (routine->code)
        counts = disassemble_count(routine->code, routine->code_bytes - routine->constant_bytes);
    figure[FIGURE_lanes] = routine_lanes(routine);
    figure[FIGURE_code_bytes] = routine->code_bytes;
    figure[FIGURE_instructions] = counts.instructions;
    figure[FIGURE_reads] = counts.reads;
    figure[FIGURE_writes] = counts.writes;
    figure[FIGURE_frame] = counts.frame;
    figure[FIGURE_spills] = routine->spills;
    figure[FIGURE_parts] = routine->parts;
}

static cJSON *json_routine(const struct engine *engine, const struct key_found *found, size_t number,
                           const char *set, const double figure[FIGURES])
{
    char text[KEY_TEXT_CAPACITY];
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "engine", engine->name);
    cJSON_AddStringToObject(json, "unit", unit_name[found->unit]);
    cJSON_AddNumberToObject(json, "routine", (double)number);
    cJSON_AddStringToObject(json, "key", key_print(found->unit, &found->key, text));
    cJSON_AddStringToObject(json, "shader", found->program ? found->program->name : "");
    cJSON_AddStringToObject(json, "instruction_set", set);
    for (int f = 0; f < FIGURES; f++)
        cJSON_AddNumberToObject(json, figure_name[f], figure[f]);
    return json;
}

static int add_routine(const struct engine *engine, struct code_arena *arena, const struct key_found *found,
                       size_t number, struct sums *sums, cJSON *rows, struct error *error)
{
    double figure[FIGURES];
    struct routine *routine = engine_build(engine, arena, found->unit, &found->key, error);
    if (!routine)
        return -1;
    find_figures(routine, figure);
    const char *set = routine_instruction_set(routine);
    cJSON_AddItemToArray(rows, json_routine(engine, found, number, set, figure));
    engine->free(arena, routine);
    sums->routines++;
    for (int f = 0; f < FIGURES; f++)
        sums->figure[f] += figure[f];
    sums->per_element += figure[FIGURE_instructions] / (figure[FIGURE_lanes] > 0 ? figure[FIGURE_lanes] : 1);
    return 0;
}

static void begin_table(struct table *table)
{
    table_column(table, "engine", TABLE_LEFT);
    table_column(table, "unit", TABLE_LEFT);
    table_column(table, "routines", TABLE_RIGHT);
    for (int f = 0; f < FIGURES; f++)
        table_column(table, figure_name[f], TABLE_RIGHT);
    table_column(table, "instructions/lane", TABLE_RIGHT);
}

static void print_sums(const struct engine *engine, enum unit unit, const struct sums *sums,
                       struct table *table)
{
    double routines = sums->routines ? (double)sums->routines : 1;
    table_cell(table, "%s", engine->name);
    table_cell(table, "%s", unit_name[unit]);
    table_cell(table, "%zu", sums->routines);
    for (int f = 0; f < FIGURES; f++)
        table_cell(table, "%.1f", sums->figure[f] / routines);
    table_cell(table, "%.1f", sums->per_element / routines);
}

static int count_engine(const struct command *self, const struct engine *engine, const struct keys *keys,
                        struct table *table, cJSON *rows)
{
    struct error error = {""};
    struct sums sums[UNIT_COUNT] = {{0}};
    struct code_arena *arena = engine->without_arena ? NULL : code_create(ARENA_BYTES, NULL, &error);
    bool bad = !arena && !engine->without_arena;
    for (size_t n = 0; n < keys->count && !bad && !interrupt_signal(); n++)
        bad = add_routine(engine, arena, keys->found + n, n + 1, sums + keys->found[n].unit, rows, &error);
    code_destroy(arena);
    for (unsigned unit = 0; unit < UNIT_COUNT; unit++)
        print_sums(engine, unit, sums + unit, table);
    return bad ? tool_fail(self, "engine %s: %s", engine->name, error.text) : STATUS_OK;
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

static cJSON *begin_report(cJSON **rows)
{
    const struct machine machine = machine_describe();
    cJSON *report = cJSON_CreateObject();
    cJSON_AddItemToObject(report, "machine", machine_json(&machine));
    *rows = cJSON_AddArrayToObject(report, "routines");
    return report;
}

int bench_code(const struct command *self, char **paths, unsigned count, const struct choice *engines,
               const char *json)
{
    struct keys keys = {0};
    struct table table = {0};
    cJSON *rows, *report = begin_report(&rows);
    int status = STATUS_OK;
    for (unsigned i = 0; i < count && !status; i++)
        status = collect(self, paths[i], &keys);
    begin_table(&table);
    for (unsigned i = 0; i < engines->count && !status; i++)
        status = count_engine(self, engine_at(engines->index[i]), &keys, &table, rows);
    if (!status && !interrupt_signal()) {
        printf("%u streams, %zu routines; means of a routine\n", count, keys.count);
        table_print(&table, 0, stdout);
        status = json ? json_write(self, report, json) : STATUS_OK;
    }
    cJSON_Delete(report);
    keys_free(&keys);
    return !status && interrupt_signal() ? interrupt_status() : status;
}
