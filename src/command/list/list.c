/* `triptych list`: engines, their options, settings, states, shaders, formats and features of the
 * processor, as tables or as JSON.
 *
 * Each subject fills a JSON array of objects. The table for people is made from the same objects, one
 * column per member, so that the two agree. States and shaders do not fit one table and print themselves
 * (command/list/states.h, command/list/shaders.h). */
#include "machine/cpu.h"
#include "contract/key.h"
#include "render/texture/format.h"
#include "engines/list.h"
#include "engines/variant.h"
#include "engines/specialize/allocate/allocate.h"
#include "engines/specialize/passes/pass.h"
#include "engines/specialize/peephole/peephole.h"
#include "command/support/json.h"
#include "command/support/option.h"
#include "command/list/shaders.h"
#include "command/list/states.h"
#include "command/support/table.h"
#include "setting/setting.h"
#include "triptych.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void add_text(cJSON *row, const char *name, const char *text)
{
    cJSON_AddStringToObject(row, name, text);
}

static cJSON *add_row(cJSON *rows)
{
    cJSON *row = cJSON_CreateObject();
    cJSON_AddItemToArray(rows, row);
    return row;
}

static void list_engines(cJSON *rows)
{
    for (unsigned i = 0; triptych_engine_name(i); i++) {
        const char *reason = triptych_engine_unavailable(i);
        cJSON *row = add_row(rows);
        add_text(row, "engine", triptych_engine_name(i));
        if (triptych_engine_width(i))
            cJSON_AddNumberToObject(row, "width", triptych_engine_width(i));
        else
            add_text(row, "width", "chosen");
        add_text(row, "here", reason ? reason : "available");
        add_text(row, "runs", engine_at(i)->on_request ? "if named" : "always");
        add_text(row, "options", engine_takes_options(engine_at(i)) ? "yes" : "no");
        add_text(row, "description", triptych_engine_description(i));
    }
}

/* The options that names of engines can have. */
static void list_options(cJSON *rows)
{
    const struct engine_option *option;
    for (unsigned i = 0; (option = engine_option_at(i)); i++) {
        char engines[512] = "";
        for (unsigned e = 0; engine_at(e); e++)
            if (option->takes(engine_at(e)))
                snprintf(engines + strlen(engines), sizeof engines - strlen(engines), "%s%s",
                         engines[0] ? " " : "", engine_at(e)->name);
        cJSON *row = add_row(rows);
        add_text(row, "option", option->name);
        add_text(row, "values", *option->values ? option->values : "none is given");
        add_text(row, "meaning", option->meaning);
        add_text(row, "engines", engines);
    }
}

/* A row for each value; the first of a setting is its default. */
static void list_settings(cJSON *rows)
{
    for (unsigned i = 0; setting_name(i); i++)
        for (unsigned value = 0; setting_value_name(i, value); value++) {
            cJSON *row = add_row(rows);
            add_text(row, "setting", setting_name(i));
            add_text(row, "value", setting_value_name(i, value));
            add_text(row, "default", value ? "" : "yes");
            add_text(row, "meaning", setting_value_meaning(i, value));
            add_text(row, "of", setting_meaning(i));
        }
}

static void list_cpu(cJSON *rows)
{
    const struct cpu *cpu = cpu_native();
    cJSON *row = add_row(rows);
    add_text(row, "what", "model");
    add_text(row, "here", cpu->model);
    add_text(row, "meaning", "brand string of the processor");
    for (unsigned i = 0; i < CPU_FEATURE_COUNT; i++) {
        row = add_row(rows);
        add_text(row, "what", cpu_feature_name(i));
        add_text(row, "here", cpu->has[i] ? "yes" : cpu->hidden[i] ? "hidden" : "no");
        add_text(row, "meaning", cpu_feature_meaning(i));
    }
}

static void list_passes(cJSON *rows)
{
    for (unsigned i = 0; pass_name(i); i++) {
        cJSON *row = add_row(rows);
        add_text(row, "pass", pass_name(i));
        add_text(row, "meaning", pass_description(i));
    }
}

static void list_rules(cJSON *rows)
{
    for (unsigned i = 0; peephole_name(i); i++) {
        cJSON *row = add_row(rows);
        add_text(row, "rule", peephole_name(i));
        add_text(row, "where", peephole_reduces(i) ? "pass reduce" : "selection");
        add_text(row, "meaning", peephole_meaning(i));
    }
}

static void list_allocators(cJSON *rows)
{
    for (unsigned i = 0; allocate_name(i); i++) {
        cJSON *row = add_row(rows);
        add_text(row, "allocator", allocate_name(i));
        add_text(row, "meaning", allocate_meaning(i));
    }
}

static double bits_of(const struct key_field *field)
{
    return field->count * log2(field->radix);
}

static void list_keys(cJSON *rows)
{
    size_t count;
    for (enum unit unit = 0; unit < UNIT_ALL; unit++)
        for (const struct key_field *field = key_fields(unit, &count), *end = field + count; field < end;
             field++) {
            cJSON *row = add_row(rows);
            add_text(row, "unit", unit_name[unit]);
            add_text(row, "field", field->name);
            cJSON_AddNumberToObject(row, "values", field->radix);
            cJSON_AddNumberToObject(row, "times", field->count);
            add_text(row, "meaning", field->meaning);
        }
}

/* The number of different keys of each unit: a routine for each would be a template for each. */
static void list_space(cJSON *rows)
{
    for (enum unit unit = 0; unit < UNIT_ALL; unit++) {
        size_t count, values = 0;
        double bits = 0;
        const struct key_field *field = key_fields(unit, &count);
        if (!count)
            continue;
        for (size_t i = 0; i < count; i++) {
            values += field[i].count;
            bits += bits_of(field + i);
        }
        char keys[32];
        snprintf(keys, sizeof keys, "10^%.0f", bits * log10(2));
        cJSON *row = add_row(rows);
        add_text(row, "unit", unit_name[unit]);
        cJSON_AddNumberToObject(row, "fields", (double)count);
        cJSON_AddNumberToObject(row, "values", (double)values);
        cJSON_AddNumberToObject(row, "bits", bits);
        add_text(row, "keys", keys);
    }
}

static void list_formats(cJSON *rows)
{
    static const struct {
        unsigned role;
        const char *word;
    } roles[] = {
        {ROLE_TEXTURE, "texture"}, {ROLE_TARGET, "target"}, {ROLE_DEPTH, "depth"}, {ROLE_COMPARE, "compare"}};
    const struct format *format;
    for (unsigned i = 0; (format = format_at(i)); i++) {
        char text[64] = "";
        for (unsigned r = 0; r < sizeof roles / sizeof *roles; r++)
            if (format->roles & roles[r].role)
                snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s", text[0] ? " " : "",
                         roles[r].word);
        cJSON *row = add_row(rows);
        add_text(row, "format", format->name);
        cJSON_AddNumberToObject(row, "number", format->number);
        cJSON_AddNumberToObject(row, "bytes", format->bytes);
        cJSON_AddNumberToObject(row, "texels", format->side * format->side);
        add_text(row, "stored", format_stored_name(format));
        add_text(row, "roles", text[0] ? text : "not supported");
    }
}

/* A subject that does not fit one table has its own functions to print it. */
static const struct subject {
    const char *name;
    void (*list)(cJSON *rows);
    void (*print)(FILE *out);
    void (*print_markdown)(FILE *out);
} subjects[] = {
    {"engines", list_engines, NULL, NULL},
    {"options", list_options, NULL, NULL},
    {"settings", list_settings, NULL, NULL},
    {"states", states_list, states_print, states_print_markdown},
    {"shaders", shaders_list, shaders_print, shaders_print_markdown},
    {"formats", list_formats, NULL, NULL},
    {"cpu", list_cpu, NULL, NULL},
    {"passes", list_passes, NULL, NULL},
    {"rules", list_rules, NULL, NULL},
    {"allocators", list_allocators, NULL, NULL},
    {"keys", list_keys, NULL, NULL},
    {"space", list_space, NULL, NULL},
};

static void print_table(const cJSON *rows)
{
    struct table table = {0};
    const cJSON *row, *cell;
    cJSON_ArrayForEach(cell, rows->child)
        table_column(&table, cell->string, cJSON_IsNumber(cell) ? TABLE_RIGHT : TABLE_LEFT);
    cJSON_ArrayForEach(row, rows) cJSON_ArrayForEach(cell, row)
    {
        if (cJSON_IsNumber(cell))
            table_cell(&table, "%.0f", cell->valuedouble);
        else
            table_cell(&table, "%s", cell->valuestring);
    }
    table_print(&table, 0, stdout);
}

static int print_rows(const struct command *self, const struct subject *subject, bool json)
{
    cJSON *rows = cJSON_CreateArray();
    subject->list(rows);
    char *text = json ? json_text(self, rows) : NULL;
    if (text)
        puts(text);
    else if (!json && tool_report_is_complete())
        print_table(rows);
    cJSON_Delete(rows);
    cJSON_free(text);
    return json && !text ? STATUS_BAD : STATUS_OK;
}

static int print(const struct command *self, const struct subject *subject, bool json, bool markdown)
{
    if (markdown && (json || !subject->print_markdown))
        return tool_fail(self, json ? "--markdown and --json are both given, expected one of them"
                                    : "--markdown is for states and shaders only");
    if (markdown)
        subject->print_markdown(stdout);
    else if (!json && subject->print)
        subject->print(stdout);
    else
        return print_rows(self, subject, json);
    return STATUS_OK;
}

struct settings {
    bool json, markdown;
};

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    return print(self, subjects + operands->word, settings->json, settings->markdown);
}

static const char *subject_at(unsigned index)
{
    return index < sizeof subjects / sizeof *subjects ? subjects[index].name : NULL;
}

static const struct option options[] = {
    {"json", NULL, "as JSON, an array of objects", OPTION_IS_FLAG(struct settings, json)},
    {"markdown", NULL, "states or shaders as a page of documentation",
     OPTION_IS_FLAG(struct settings, markdown)},
    {0},
};

static const struct operand operands[] = {
    {"WHAT",
     "engines, options, settings, states, shaders, formats, cpu, passes, rules, allocators, keys or space",
     .kind = OPERAND_WORD, .words = subject_at},
    {0},
};

const struct command command_list = {
    .name = "list",
    .summary = "engines, their options, settings, states, shaders, formats, cpu, passes, rules, allocators, "
               "keys or space",
    .options = options,
    .operands = operands,
    .settings_bytes = sizeof(struct settings),
    .run = run,
};
