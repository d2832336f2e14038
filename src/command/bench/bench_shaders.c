/* The cost of each shader on each engine, and how it depends on the length of the shader.
 *
 * All routines of a shader are taken together, whatever their streams and keys: the time of all calls divided
 * by all elements (vertices or covered pixels), and the build time and code size of the median routine. The
 * times are those of the routines, including the fixed part of the unit: fetch and clip codes of vertices;
 * depth test, interpolation and blending of pixels.
 *
 * The second table shows if stitching keeps up as shaders grow (thesis, section 4.2): by instruction slots,
 * the geometric means of times per element, and of build times and code size per slot. */
#include "command/bench/bench_shaders.h"

#include "contract/key.h"
#include "command/support/choose.h"
#include "command/support/json.h"
#include "command/support/table.h"
#include "triptych.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One shader with one engine. */
struct figures {
    double ns, us, bytes, parts, spills, fused, carried; /* ns: per element */
    unsigned lanes;                                      /* of its widest routine */
    const char *instruction_set;                         /* of that; null: no routine */
};

struct shader_row {
    const struct build *shader; /* any of its routines, for what it is */
    size_t routines;            /* of the first engine */
    double elements;
    struct figures engine[CHOICE_CAPACITY];
};

struct shader_table {
    struct shader_row *row;
    size_t count;
    unsigned engines;
};

/* Upper ends of the lengths that are taken together, in slots. */
static const unsigned lengths[] = {8, 16, 32, 64, 128, 256, 0xffffffff};
enum { LENGTHS = sizeof lengths / sizeof *lengths };

/* --- Collecting ----------------------------------------------------------------------------------------- */

static bool is_same(const struct build *a, const struct build *b)
{
    return a->unit == b->unit && a->model == b->model && a->hash == b->hash;
}

static bool is_listed(const struct shader_table *table, const struct build *build)
{
    for (size_t i = 0; i < table->count; i++)
        if (is_same(table->row[i].shader, build))
            return true;
    return false;
}

static int by_length(const void *a, const void *b)
{
    const struct build *x = ((const struct shader_row *)a)->shader,
                       *y = ((const struct shader_row *)b)->shader;
    if (x->slots != y->slots)
        return x->slots < y->slots ? -1 : 1;
    return strcmp(x->shader, y->shader);
}

/* Sums over all routines of the shader with that engine; us and bytes are medians. `scratch` has room for
 * as many numbers as there are routines, twice. */
static struct figures figures_of(const struct bench *bench, const struct build *shader, unsigned engine,
                                 double *scratch, struct shader_row *row)
{
    struct figures r = {0};
    double ns = 0, elements = 0, *bytes = scratch;
    size_t count = 0;
    for (unsigned s = 0; s < bench->stream_count; s++)
        count += bench->streams[s].runs[engine].build_count;
    double *us = scratch + count;
    count = 0;
    for (unsigned s = 0; s < bench->stream_count; s++) {
        const struct bench_run *run = &bench->streams[s].runs[engine];
        for (size_t i = 0; i < run->build_count; i++) {
            const struct build *build = &run->builds[i];
            if (!build->model || !is_same(build, shader))
                continue;
            us[count] = build->us;
            bytes[count++] = build->code_bytes;
            ns += build->run_ns;
            if (r.lanes < build->lanes) {
                r.lanes = build->lanes;
                r.instruction_set = build->instruction_set;
            }
            elements += build->elements;
            r.parts = fmax(r.parts, build->parts);
            r.spills = fmax(r.spills, build->spills);
            r.fused = fmax(r.fused, build->fused);
            r.carried = fmax(r.carried, build->carried);
        }
    }
    if (!engine) {
        row->routines = count;
        row->elements = elements;
    }
    r.ns = elements > 0 ? ns / elements : 0;
    r.us = summary_of(us, count).median;
    r.bytes = summary_of(bytes, count).median;
    return r;
}

static size_t count_routines(const struct bench *bench)
{
    size_t most = 0;
    for (unsigned engine = 0; engine < bench->streams->run_count; engine++) {
        size_t count = 0;
        for (unsigned s = 0; s < bench->stream_count; s++)
            count += bench->streams[s].runs[engine].build_count;
        most = count > most ? count : most;
    }
    return most;
}

static bool collect(const struct bench *bench, struct shader_table *table)
{
    size_t routines = count_routines(bench);
    double *scratch = calloc(2 * routines + 1, sizeof *scratch);
    *table = (struct shader_table){.row = calloc(routines + 1, sizeof *table->row),
                                   .engines = bench->streams->run_count};
    for (unsigned s = 0; s < bench->stream_count && scratch && table->row; s++)
        for (size_t i = 0; i < bench->streams[s].runs->build_count; i++) {
            const struct build *build = &bench->streams[s].runs->builds[i];
            if (build->model && !is_listed(table, build))
                table->row[table->count++].shader = build;
        }
    for (size_t i = 0; i < table->count; i++)
        for (unsigned engine = 0; engine < table->engines; engine++)
            table->row[i].engine[engine] =
                figures_of(bench, table->row[i].shader, engine, scratch, &table->row[i]);
    if (table->row)
        qsort(table->row, table->count, sizeof *table->row, by_length);
    bool complete = scratch && table->row;
    free(scratch);
    return complete;
}

/* --- Printing ------------------------------------------------------------------------------------------- */

static const char *engine_name_of(const struct bench *bench, unsigned engine)
{
    return triptych_engine_name(bench->streams->runs[engine].engine);
}

static void print_rows(const struct bench *bench, const struct shader_table *shaders)
{
    struct table table = {0};
    static const char *const headings[] = {"ns", "build us", "bytes", "parts", "spills", "fused", "carried"};
    puts("\nshaders: ns per vertex or covered pixel of their routines");
    table_column(&table, "shader", TABLE_LEFT);
    table_column(&table, "model", TABLE_LEFT);
    table_column(&table, "slots", TABLE_RIGHT);
    table_column(&table, "engine", TABLE_LEFT);
    table_column(&table, "lanes", TABLE_RIGHT);
    table_column(&table, "set", TABLE_LEFT);
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        table_column(&table, headings[i], TABLE_RIGHT);
    for (size_t i = 0; i < shaders->count; i++)
        for (unsigned engine = 0; engine < shaders->engines; engine++) {
            const struct shader_row *row = &shaders->row[i];
            const struct figures *f = &row->engine[engine];
            table_cell(&table, "%s", engine ? "" : row->shader->shader);
            table_cell(&table, "%s", engine ? "" : row->shader->model);
            if (engine)
                table_cell(&table, "%s", "");
            else
                table_cell(&table, "%u", row->shader->slots);
            table_cell(&table, "%s", engine_name_of(bench, engine));
            table_cell(&table, "%u", f->lanes);
            table_cell(&table, "%s", f->instruction_set ? f->instruction_set : "");
            table_cell(&table, "%.2f", f->ns);
            table_cell(&table, "%.1f", f->us);
            table_cell(&table, "%.0f", f->bytes);
            table_cell(&table, "%.0f", f->parts);
            table_cell(&table, "%.0f", f->spills);
            table_cell(&table, "%.0f", f->fused);
            table_cell(&table, "%.0f", f->carried);
        }
    table_print(&table, 2, stdout);
}

/* Geometric means over the shaders of a unit whose slots are above `least`, up to `most`. */
struct length_summary {
    size_t count;
    struct figures mean[CHOICE_CAPACITY]; /* us and bytes: per slot */
};

static struct length_summary summarize_length(const struct shader_table *shaders, unsigned unit,
                                              unsigned least, unsigned most)
{
    struct length_summary r = {0};
    for (size_t i = 0; i < shaders->count; i++) {
        const struct shader_row *row = &shaders->row[i];
        if (row->shader->unit != unit || row->shader->slots <= least || row->shader->slots > most ||
            row->elements <= 0)
            continue;
        r.count++;
        for (unsigned engine = 0; engine < shaders->engines; engine++) {
            const struct figures *f = &row->engine[engine];
            r.mean[engine].ns += log(fmax(f->ns, 1e-3));
            r.mean[engine].us += log(fmax(f->us, 1e-3) / row->shader->slots);
            r.mean[engine].bytes += log(fmax(f->bytes, 1) / row->shader->slots);
        }
    }
    for (unsigned engine = 0; engine < shaders->engines && r.count; engine++) {
        struct figures *f = &r.mean[engine];
        *f = (struct figures){.ns = exp(f->ns / (double)r.count),
                              .us = exp(f->us / (double)r.count),
                              .bytes = exp(f->bytes / (double)r.count)};
    }
    return r;
}

static void print_length_cells(struct table *table, const struct length_summary *summary, unsigned engine,
                               unsigned baseline)
{
    const struct figures *f = &summary->mean[engine];
    table_cell(table, "%.2f", f->ns);
    table_cell(table, "%.2f", summary->mean[baseline].ns / f->ns);
    table_cell(table, "%.3f", f->us);
    if (f->bytes <= 1) /* an engine without code has 1 for each shader */
        table_cell(table, "%s", "-");
    else
        table_cell(table, "%.1f", f->bytes);
}

static void print_lengths(const struct bench *bench, const struct shader_table *shaders)
{
    struct table table = {0};
    unsigned baseline = bench->streams->baseline;
    static const char *const headings[] = {"ns", "x", "build us/slot", "bytes/slot"};
    printf("\nshaders by length: geometric means; x: times the speed of %s\n",
           engine_name_of(bench, baseline));
    table_column(&table, "unit", TABLE_LEFT);
    table_column(&table, "slots", TABLE_RIGHT);
    table_column(&table, "shaders", TABLE_RIGHT);
    table_column(&table, "engine", TABLE_LEFT);
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        table_column(&table, headings[i], TABLE_RIGHT);
    for (unsigned unit = 0; unit < UNIT_COUNT; unit++)
        for (unsigned l = 0; l < LENGTHS; l++) {
            unsigned least = l ? lengths[l - 1] : 0;
            struct length_summary summary = summarize_length(shaders, unit, least, lengths[l]);
            for (unsigned engine = 0; engine < shaders->engines && summary.count; engine++) {
                table_cell(&table, "%s", engine ? "" : unit_name[unit]);
                if (engine)
                    table_cell(&table, "%s", "");
                else if (l + 1 < LENGTHS)
                    table_cell(&table, "%u-%u", least + 1, lengths[l]);
                else
                    table_cell(&table, "%u-", least + 1);
                if (engine)
                    table_cell(&table, "%s", "");
                else
                    table_cell(&table, "%zu", summary.count);
                table_cell(&table, "%s", engine_name_of(bench, engine));
                print_length_cells(&table, &summary, engine, baseline);
            }
        }
    table_print(&table, 2, stdout);
}

int bench_print_shaders(const struct command *self, const struct bench *bench)
{
    struct shader_table shaders;
    bool complete = collect(bench, &shaders);
    if (complete) {
        print_rows(bench, &shaders);
        print_lengths(bench, &shaders);
    }
    free(shaders.row);
    return complete ? STATUS_OK : tool_fail(self, "no memory for the table of shaders");
}

/* --- JSON ----------------------------------------------------------------------------------------------- */

static cJSON *json_row(const struct bench *bench, const struct shader_table *shaders,
                       const struct shader_row *row)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "shader", row->shader->shader);
    cJSON_AddStringToObject(json, "model", row->shader->model);
    cJSON_AddStringToObject(json, "unit", unit_name[row->shader->unit]);
    cJSON_AddNumberToObject(json, "slots", row->shader->slots);
    cJSON_AddNumberToObject(json, "routines", (double)row->routines);
    cJSON_AddNumberToObject(json, "elements", row->elements);
    cJSON *engines = cJSON_AddArrayToObject(json, "engines");
    for (unsigned engine = 0; engine < shaders->engines; engine++) {
        const struct figures *f = &row->engine[engine];
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "engine", engine_name_of(bench, engine));
        cJSON_AddNumberToObject(item, "lanes", f->lanes);
        cJSON_AddStringToObject(item, "instruction_set", f->instruction_set ? f->instruction_set : "");
        cJSON_AddNumberToObject(item, "ns", f->ns);
        cJSON_AddNumberToObject(item, "build_us", f->us);
        cJSON_AddNumberToObject(item, "code_bytes", f->bytes);
        cJSON_AddNumberToObject(item, "parts", f->parts);
        cJSON_AddNumberToObject(item, "spills", f->spills);
        cJSON_AddNumberToObject(item, "fused", f->fused);
        cJSON_AddNumberToObject(item, "carried", f->carried);
        cJSON_AddItemToArray(engines, item);
    }
    return json;
}

cJSON *bench_json_shaders(const struct bench *bench)
{
    struct shader_table shaders;
    cJSON *json = NULL;
    if (collect(bench, &shaders)) {
        json = cJSON_CreateArray();
        for (size_t i = 0; i < shaders.count; i++)
            cJSON_AddItemToArray(json, json_row(bench, &shaders, &shaders.row[i]));
    } else {
        tool_report_mark_incomplete();
    }
    free(shaders.row);
    return json;
}
