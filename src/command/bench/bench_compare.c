/* A file that was edited or damaged can contain anything: every value is looked up with its type. */
#include "command/bench/bench_compare.h"

#include "base/file.h"
#include "command/bench/bench_run.h"
#include "command/support/json.h"
#include "command/support/table.h"

#include <stdlib.h>
#include <string.h>

enum { FILE_MOST = 256 << 20 };

static const char *const measures[MEASURE_COUNT] = {
    [MEASURE_FRAME_MS] = "frame_ms", [MEASURE_VERTEX_NS] = "vertex_ns", [MEASURE_PIXEL_NS] = "pixel_ns"};

/* The rows of the report, and their numbers by verdict. */
struct comparison {
    struct table table;
    cJSON *rows;
    unsigned faster, slower, same, few;
};

/* The samples of an engine on a stream, in the two files. */
struct pair {
    const char *stream, *engine;
    const cJSON *samples[2];
};

/* --- Reading -------------------------------------------------------------------------------------------- */

static const char *text_of(const cJSON *object, const char *name)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(object, name));
    return text ? text : "?";
}

static int load(const struct command *self, const char *path, cJSON **json)
{
    struct error error = {""};
    char *text;
    size_t bytes;
    if (file_read(path, FILE_MOST, &text, &bytes, &error))
        return tool_fail(self, "%s", error.text);
    *json = cJSON_ParseWithLength(text, bytes);
    free(text);
    if (!tool_report_is_complete())
        return tool_fail(self, "no memory for %s", path);
    if (!cJSON_IsArray(cJSON_GetObjectItem(*json, "streams")))
        return tool_fail(self, "%s: has no streams, expected a file that triptych bench --json wrote", path);
    return STATUS_OK;
}

/* The element of an array whose field has the text; null if there is none. */
static const cJSON *find(const cJSON *array, const char *field, const char *text)
{
    const cJSON *element;
    cJSON_ArrayForEach(element, array)
    {
        const char *found = cJSON_GetStringValue(cJSON_GetObjectItem(element, field));
        if (found && !strcmp(found, text))
            return element;
    }
    return NULL;
}

/* Copies the numbers of an array. Returns their count; 0 if it is not an array of at most
 * REPETITIONS_MAXIMUM numbers. */
static size_t read_samples(const cJSON *array, double values[REPETITIONS_MAXIMUM])
{
    size_t count = 0;
    const cJSON *element;
    if (!cJSON_IsArray(array) || cJSON_GetArraySize(array) > REPETITIONS_MAXIMUM)
        return 0;
    cJSON_ArrayForEach(element, array)
    {
        if (!cJSON_IsNumber(element))
            return 0;
        values[count++] = element->valuedouble;
    }
    return count;
}

/* --- Comparing ------------------------------------------------------------------------------------------ */

static int measure(const struct command *self, const struct pair *pair, enum measure which,
                   struct summary summary[2], struct interval *interval)
{
    double values[2][REPETITIONS_MAXIMUM];
    size_t count[2];
    for (int i = 0; i < 2; i++)
        count[i] = read_samples(cJSON_GetObjectItem(pair->samples[i], measures[which]), values[i]);
    if (interval_of(values[0], count[0], values[1], count[1], interval))
        return tool_fail(self, "no memory to compare %zu runs with %zu", count[0], count[1]);
    for (int i = 0; i < 2; i++)
        summary[i] = summary_of(values[i], count[i]);
    return STATUS_OK;
}

static void add_json(struct comparison *comparison, const struct pair *pair, enum measure which,
                     const struct summary summary[2], const struct interval *interval)
{
    cJSON *row = cJSON_CreateObject();
    cJSON_AddStringToObject(row, "stream", pair->stream);
    cJSON_AddStringToObject(row, "engine", pair->engine);
    cJSON_AddStringToObject(row, "measure", measures[which]);
    cJSON_AddNumberToObject(row, "a", summary[0].median);
    cJSON_AddNumberToObject(row, "b", summary[1].median);
    cJSON_AddNumberToObject(row, "times", interval->times);
    cJSON_AddNumberToObject(row, "low", interval->low);
    cJSON_AddNumberToObject(row, "high", interval->high);
    cJSON_AddStringToObject(row, "b_is", interval_verdict(interval, "slower", "faster"));
    cJSON_AddItemToArray(comparison->rows, row);
}

static void count(struct comparison *comparison, const struct interval *interval)
{
    if (!(interval->low > 0))
        comparison->few++;
    else if (!interval_shows_difference(interval))
        comparison->same++;
    else if (interval->low > 1)
        comparison->faster++;
    else
        comparison->slower++;
}

static void add_row(struct comparison *comparison, const struct pair *pair, const struct summary summary[2],
                    const struct interval *interval)
{
    const double cells[] = {summary[0].median, summary[1].median, interval->times, interval->low,
                            interval->high};
    table_cell(&comparison->table, "%s", pair->stream);
    table_cell(&comparison->table, "%s", pair->engine);
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++)
        if (cells[i] > 0)
            table_cell(&comparison->table, "%.3f", cells[i]);
        else
            table_cell(&comparison->table, "-");
    table_cell(&comparison->table, "%s", interval_verdict(interval, "slower", "faster"));
    count(comparison, interval);
}

static int compare_pair(const struct command *self, const struct pair *pair, struct comparison *comparison)
{
    struct summary summary[2];
    struct interval interval;
    for (int which = 0; which < MEASURE_COUNT; which++) {
        if (measure(self, pair, which, summary, &interval))
            return STATUS_BAD;
        add_json(comparison, pair, which, summary, &interval);
        if (which == MEASURE_FRAME_MS)
            add_row(comparison, pair, summary, &interval);
    }
    return STATUS_OK;
}

/* Fails if a stream that both files have was not drawn in the same size with the same number of frames, or if
 * there is no such stream. */
static int check_work(const struct command *self, char *const paths[2], cJSON *const files[2])
{
    static const char *const fields[] = {"width", "height", "frames"};
    bool any = false;
    const cJSON *a;
    cJSON_ArrayForEach(a, cJSON_GetObjectItem(files[0], "streams"))
    {
        const cJSON *b = find(cJSON_GetObjectItem(files[1], "streams"), "stream", text_of(a, "stream"));
        any |= b != NULL;
        for (size_t i = 0; i < sizeof fields / sizeof *fields && b; i++)
            if (!cJSON_Compare(cJSON_GetObjectItem(a, fields[i]), cJSON_GetObjectItem(b, fields[i]), true))
                return tool_fail(self, "stream %s: another %s, expected the same in both files",
                                 text_of(a, "stream"), fields[i]);
    }
    return any ? STATUS_OK : tool_fail(self, "%s and %s have no stream in common", paths[0], paths[1]);
}

static int compare_stream(const struct command *self, const cJSON *a, const cJSON *b,
                          struct comparison *comparison)
{
    const cJSON *run;
    const char *name = text_of(a, "stream");
    const cJSON *other = find(cJSON_GetObjectItem(b, "streams"), "stream", name);
    cJSON_ArrayForEach(run, cJSON_GetObjectItem(a, "engines"))
    {
        const char *engine = text_of(run, "engine");
        const cJSON *same = find(cJSON_GetObjectItem(other, "engines"), "engine", engine);
        struct pair pair = {
            name, engine, {cJSON_GetObjectItem(run, "samples"), cJSON_GetObjectItem(same, "samples")}};
        if (same && compare_pair(self, &pair, comparison))
            return STATUS_BAD;
    }
    return STATUS_OK;
}

/* --- The report ----------------------------------------------------------------------------------------- */

static void print_heads(char *const paths[2], cJSON *const files[2])
{
    for (int i = 0; i < 2; i++) {
        const cJSON *machine = cJSON_GetObjectItem(files[i], "machine");
        printf("%c: %s, commit %s, %s, %s\n", 'A' + i, paths[i], text_of(machine, "commit"),
               text_of(machine, "date"), text_of(machine, "cpu"));
    }
    printf("A / B: times the frame time of B, with an interval of %s\n", interval_method);
}

static void begin_table(struct table *table)
{
    static const char *const headings[] = {"A ms/frame", "B ms/frame", "A / B", "low", "high"};
    table_column(table, "stream", TABLE_LEFT);
    table_column(table, "engine", TABLE_LEFT);
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        table_column(table, headings[i], TABLE_RIGHT);
    table_column(table, "B is", TABLE_LEFT);
}

static int compare_all(const struct command *self, char *const paths[2], cJSON *const files[2],
                       struct comparison *comparison)
{
    const cJSON *stream;
    int status = STATUS_OK;
    print_heads(paths, files);
    begin_table(&comparison->table);
    cJSON_ArrayForEach(stream, cJSON_GetObjectItem(files[0], "streams"))
    {
        if (!status)
            status = compare_stream(self, stream, files[1], comparison);
    }
    table_print(&comparison->table, 0, stdout);
    printf("B is faster %u times, slower %u times, no difference is shown %u times, too few runs %u times\n",
           comparison->faster, comparison->slower, comparison->same, comparison->few);
    return status;
}

int bench_compare(const struct command *self, char *const paths[2], const char *json)
{
    cJSON *files[2] = {NULL, NULL};
    struct comparison comparison = {.rows = cJSON_CreateArray()};
    int status = tool_check_output(self, json);
    for (int i = 0; i < 2 && !status; i++)
        status = load(self, paths[i], &files[i]);
    if (!status)
        status = check_work(self, paths, files);
    if (!status)
        status = compare_all(self, paths, files, &comparison);
    cJSON *report = cJSON_CreateObject();
    cJSON_AddStringToObject(report, "a", paths[0]);
    cJSON_AddStringToObject(report, "b", paths[1]);
    cJSON_AddStringToObject(report, "interval", interval_method);
    cJSON_AddItemToObject(report, "rows", comparison.rows);
    if (!status && json)
        status = json_write(self, report, json);
    cJSON_Delete(report);
    for (int i = 0; i < 2; i++)
        cJSON_Delete(files[i]);
    return status;
}
