#include "command/results/results.h"
#include "base/file.h"
#include "command/support/command.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FILE_MOST = 512 << 20, VALUE_TEXT = 120 };

/* 2^53: greater numbers of JSON are not exact. */
static const double most_exact = 9007199254740992.0;

static const char *const same_fuzz[] = {"seed", "first", "count", "engines", "threads", "settings", NULL};
static const char *const same_verify[] = {"inputs",  "engines", "threads",   "settings", "frames",
                                          "shuffle", "golden",  "tolerance", NULL};
static const char *const same_bench[] = {"inputs",      "engines", "threads", "settings",
                                         "repetitions", "seconds", "frames",  NULL};
static const char *const same_claims[] = {"inputs", NULL};

static const struct results_kind kinds[] = {
    {"fuzz", "case", same_fuzz, NULL, NULL, false},
    {"verify", "stream", same_verify, "streams", "path", true},
    {"bench", "stream", same_bench, "streams", "path", false},
    {"claims", "claim", same_claims, "claims", "id", false},
};

const char *const results_outcomes[] = {"same",   "refused", "limited", "different",
                                        "failed", "crashed", "hung",    NULL};

/* --- Values --------------------------------------------------------------------------------------------- */

const char *results_text(const cJSON *object, const char *field)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, field));
    return text ? text : "";
}

double results_value(const cJSON *object, const char *field)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, field);
    return cJSON_IsNumber(value) ? value->valuedouble : 0;
}

/* Returns true if the field is a whole number from 0 to 2^53. */
static bool is_count(const cJSON *object, const char *field)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, field);
    return cJSON_IsNumber(value) && value->valuedouble >= 0 && value->valuedouble <= most_exact &&
           value->valuedouble == floor(value->valuedouble);
}

static uint64_t count_of(const cJSON *object, const char *field)
{
    return (uint64_t)results_value(object, field);
}

/* The name of an element of "engines". */
static const char *engine_name_of(const cJSON *element)
{
    return cJSON_IsString(element) ? cJSON_GetStringValue(element) : results_text(element, "engine");
}

int results_engine(const cJSON *engines, const char *name)
{
    int index = 0;
    const cJSON *element;
    cJSON_ArrayForEach(element, engines)
    {
        if (!strcmp(engine_name_of(element), name))
            return index;
        index++;
    }
    return -1;
}

unsigned results_engine_count(const struct results *results)
{
    const cJSON *engines = cJSON_GetObjectItemCaseSensitive(results->json, "engines");
    return results->kind->engines ? (unsigned)cJSON_GetArraySize(engines) : 1;
}

int64_t results_number(const struct results *results, const cJSON *entry)
{
    const cJSON *inputs = cJSON_GetObjectItemCaseSensitive(results->json, "inputs"), *input;
    const char *name = results_text(entry, results->kind->name);
    bool numbered = cJSON_HasObjectItem(entry, "number");
    int64_t index = 0;
    if (numbered && !is_count(entry, "number"))
        return -1;
    cJSON_ArrayForEach(input, inputs)
    {
        bool is_there = numbered ? (uint64_t)index == count_of(entry, "number") : true;
        if (is_there && cJSON_IsString(input) && !strcmp(cJSON_GetStringValue(input), name))
            return index;
        index++;
    }
    return -1;
}

bool results_complete(const cJSON *entry)
{
    const cJSON *complete = cJSON_GetObjectItemCaseSensitive(entry, "complete");
    return !cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(entry, "interrupted")) && !cJSON_IsFalse(complete);
}

/* --- Checks --------------------------------------------------------------------------------------------- */

static int fail_damaged(const struct command *self, const struct results *results, const char *what)
{
    return tool_fail(self, "%s: is damaged: %s", results->path, what);
}

/* A finding is a case that is done, and its outcome. */
static int check_findings(const struct command *self, const struct results *results)
{
    const cJSON *finding, *findings = cJSON_GetObjectItemCaseSensitive(results->json, "findings");
    if (!cJSON_IsArray(findings))
        return fail_damaged(self, results, "it has no array of findings");
    cJSON_ArrayForEach(finding, findings)
    {
        const char *outcome = results_text(finding, "outcome");
        int index = RESULTS_FINDING;
        while (results_outcomes[index] && strcmp(results_outcomes[index], outcome))
            index++;
        if (!results_outcomes[index] || !is_count(finding, "case") ||
            !ranges_has(&results->done, count_of(finding, "case")))
            return fail_damaged(self, results, "a finding has no outcome, or no case of \"done\"");
    }
    return STATUS_OK;
}

static int check_counts(const struct command *self, const struct results *results)
{
    uint64_t sum = 0, size = ranges_size(&results->done);
    for (int i = 0; results_outcomes[i]; i++) {
        if (!is_count(results->json, results_outcomes[i]))
            return fail_damaged(self, results, "an outcome has no count");
        sum += count_of(results->json, results_outcomes[i]);
    }
    if (!is_count(results->json, "cases") || !is_count(results->json, "pixels"))
        return fail_damaged(self, results, "it has no number of cases or of pixels");
    if (count_of(results->json, "cases") != size || sum != size)
        return tool_fail(
            self, "%s: is damaged: %llu cases with %llu outcomes, expected %llu: the cases of \"done\"",
            results->path, (unsigned long long)count_of(results->json, "cases"), (unsigned long long)sum,
            (unsigned long long)size);
    return check_findings(self, results);
}

static int read_counts(const struct command *self, struct results *results)
{
    const cJSON *json = results->json, *done = cJSON_GetObjectItemCaseSensitive(json, "done");
    if (!is_count(json, "seed") || !is_count(json, "first") || !is_count(json, "count") ||
        !cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(json, "engines")))
        return fail_damaged(self, results, "it has no seed, first case, count or engines");
    results->first = count_of(json, "first");
    results->count = count_of(json, "count");
    if (!cJSON_IsString(done) || !ranges_read(cJSON_GetStringValue(done), &results->done))
        return fail_damaged(self, results, "it has no ranges of cases in \"done\"");
    const struct ranges *ranges = &results->done;
    if (ranges->count && (ranges->item[0].first < results->first ||
                          ranges->item[ranges->count - 1].last >= results->first + results->count))
        return fail_damaged(self, results, "a case of \"done\" is not one of the campaign");
    return check_counts(self, results);
}

/* Adds a unit that must be new. */
static int add_unit(const struct command *self, struct results *results, uint64_t unit)
{
    if (ranges_has(&results->done, unit))
        return fail_damaged(self, results, "an entry is there twice");
    ranges_add(&results->done, unit, unit);
    return STATUS_OK;
}

static int add_entry(const struct command *self, struct results *results, const cJSON *entry)
{
    int64_t number = results_number(results, entry);
    const cJSON *engines = cJSON_GetObjectItemCaseSensitive(results->json, "engines"), *engine;
    if (number < 0)
        return fail_damaged(self, results, "an entry has a name or a number that \"inputs\" does not have");
    if (!results_complete(entry))
        return STATUS_OK;
    if (!results->kind->engines)
        return add_unit(self, results, (uint64_t)number);
    cJSON_ArrayForEach(engine, cJSON_GetObjectItemCaseSensitive(entry, "engines"))
    {
        int index = results_engine(engines, engine_name_of(engine));
        if (index < 0)
            return fail_damaged(self, results, "an entry has an engine that \"engines\" does not have");
        if (add_unit(self, results, (uint64_t)number * results_engine_count(results) + (unsigned)index))
            return STATUS_BAD;
    }
    return STATUS_OK;
}

static int read_entries(const struct command *self, struct results *results)
{
    const cJSON *entry, *inputs = cJSON_GetObjectItemCaseSensitive(results->json, "inputs");
    const cJSON *entries = cJSON_GetObjectItemCaseSensitive(results->json, results->kind->entries);
    if (!cJSON_IsArray(inputs) || !cJSON_IsArray(entries))
        return tool_fail(self, "%s: is damaged: it has no array \"inputs\" or \"%s\"", results->path,
                         results->kind->entries);
    results->count = (uint64_t)cJSON_GetArraySize(inputs) * results_engine_count(results);
    cJSON_ArrayForEach(entry, entries)
    {
        if (add_entry(self, results, entry))
            return STATUS_BAD;
    }
    return STATUS_OK;
}

static const struct results_kind *find_kind(const char *command)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (!strcmp(kinds[i].command, command))
            return &kinds[i];
    return NULL;
}

int results_take(const struct command *self, const char *path, cJSON *json, struct results *results)
{
    *results = (struct results){.path = path, .json = json};
    if (!tool_report_is_complete())
        return tool_fail(self, "no memory for %s", path);
    results->kind = find_kind(results_text(json, "command"));
    if (!results->kind)
        return tool_fail(self,
                         "%s: no results with a \"command\", expected a file that triptych fuzz, verify, "
                         "bench or claims wrote with --json",
                         path);
    int status = results->kind->entries ? read_entries(self, results) : read_counts(self, results);
    return !status && results->done.failed ? tool_fail(self, "no memory for %s", path) : status;
}

int results_load(const struct command *self, const char *path, struct results *results)
{
    struct error error = {""};
    char *text;
    size_t bytes;
    *results = (struct results){.path = path};
    if (file_read(path, FILE_MOST, &text, &bytes, &error))
        return tool_fail(self, "%s", error.text);
    cJSON *json = cJSON_ParseWithLength(text, bytes);
    free(text);
    return results_take(self, path, json, results);
}

void results_free(struct results *results)
{
    cJSON_Delete(results->json);
    ranges_free(&results->done);
    *results = (struct results){0};
}

/* --- Comparing ------------------------------------------------------------------------------------------ */

static int fail_unlike(const struct command *self, const struct results *a, const struct results *b,
                       const char *field, const char *in_a, const char *in_b)
{
    return tool_fail(self, "%s: %s is %.*s, expected %.*s as in %s", b->path, field, VALUE_TEXT, in_b,
                     VALUE_TEXT, in_a, a->path);
}

/* Engines are equal if their names are. */
static bool are_same_engines(const cJSON *a, const cJSON *b)
{
    int index = 0;
    const cJSON *element;
    if (cJSON_GetArraySize(a) != cJSON_GetArraySize(b))
        return false;
    cJSON_ArrayForEach(element, a)
    {
        if (results_engine(b, engine_name_of(element)) != index++)
            return false;
    }
    return true;
}

static int match_field(const struct command *self, const struct results *a, const struct results *b,
                       const char *field)
{
    const cJSON *x = cJSON_GetObjectItemCaseSensitive(a->json, field);
    const cJSON *y = cJSON_GetObjectItemCaseSensitive(b->json, field);
    if (!strcmp(field, "engines") ? are_same_engines(x, y) : (!x && !y) || cJSON_Compare(x, y, true))
        return STATUS_OK;
    char *in_a = x ? cJSON_PrintUnformatted(x) : NULL, *in_b = y ? cJSON_PrintUnformatted(y) : NULL;
    fail_unlike(self, a, b, field, in_a ? in_a : "missing", in_b ? in_b : "missing");
    cJSON_free(in_a);
    cJSON_free(in_b);
    return STATUS_BAD;
}

static const char *commit_of(const struct results *results)
{
    return results_text(cJSON_GetObjectItemCaseSensitive(results->json, "machine"), "commit");
}

int results_match(const struct command *self, const struct results *a, const struct results *b)
{
    if (a->kind != b->kind)
        return fail_unlike(self, a, b, "command", a->kind->command, b->kind->command);
    if (strcmp(commit_of(a), commit_of(b)))
        return fail_unlike(self, a, b, "commit", commit_of(a), commit_of(b));
    for (const char *const *field = a->kind->same; *field; field++)
        if (match_field(self, a, b, *field))
            return STATUS_BAD;
    return STATUS_OK;
}

int results_resume(const struct command *self, const char *path, const struct results *fresh,
                   struct results *results, bool *found)
{
    *results = (struct results){.path = path};
    if (file_is_standard(path))
        return tool_fail(self, "--resume is \"-\", expected the path of a file");
    *found = !access(path, F_OK);
    if (!*found)
        return STATUS_OK;
    if (results_load(self, path, results) || results_match(self, fresh, results))
        return STATUS_BAD;
    return match_field(self, fresh, results, "shard");
}
