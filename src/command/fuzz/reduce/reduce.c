#include "command/fuzz/reduce/reduce.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

/* A word's new text, kept until the end. */
struct spelling {
    struct spelling *next;
    char text[];
};

/* --- Words ---------------------------------------------------------------------------------------------- */

bool reduction_word_is(const struct word *word, const char *text)
{
    return strlen(text) == word->length && !memcmp(word->text, text, word->length);
}

bool reduction_word_is_name(const struct word *word)
{
    return isalpha((unsigned char)*word->text) || *word->text == '_';
}

bool reduction_word_integer(const struct word *word, long long *value)
{
    char digits[24], *end;
    if (word->length >= sizeof digits)
        return false;
    memcpy(digits, word->text, word->length);
    digits[word->length] = 0;
    *value = strtoll(digits, &end, 10);
    return !*end && end != digits;
}

/* The length of the word at `at`. Outside of the text of shaders a brace is a word by itself. */
static size_t word_length(const char *at, const char *end, bool in_shader)
{
    const char *from = at;
    if (*at == '"' && !in_shader) {
        for (at++; at < end && *at != '"' && *at != '\n'; at++)
            at += *at == '\\' && at + 1 < end;
        return (size_t)(at - from) + (at < end && *at == '"');
    }
    if (*at == '{' || *at == '}')
        return 1;
    while (at < end && !isspace((unsigned char)*at) && (in_shader || !strchr("{}\"#", *at)))
        at++;
    return (size_t)(at - from);
}

static bool begins_comment(const char *at, const char *end, bool in_shader)
{
    if (!in_shader)
        return *at == '#';
    return *at == ';' || (at + 1 < end && at[0] == '/' && at[1] == '/');
}

/* Counts the words of the text, and writes them if there is room. */
static uint32_t split(const char *at, const char *end, struct word *word)
{
    uint32_t count = 0, line = 1;
    bool in_shader = false, shader_line = false, line_begins = true;
    while (at < end) {
        if (*at == '\n') {
            line++, at++;
            line_begins = true;
        } else if (isspace((unsigned char)*at)) {
            at++;
        } else if (begins_comment(at, end, in_shader)) {
            while (at < end && *at != '\n')
                at++;
        } else {
            size_t length = word_length(at, end, in_shader);
            if (line_begins)
                shader_line = length == 6 && !memcmp(at, "shader", 6);
            if (*at == '{')
                in_shader = shader_line;
            else if (*at == '}' && line_begins)
                in_shader = false;
            if (word)
                word[count] = (struct word){at, (uint32_t)length, line, false, in_shader && *at != '{'};
            count++;
            at += length;
            line_begins = false;
        }
    }
    return count;
}

/* --- Statements ----------------------------------------------------------------------------------------- */

/* The end of the statement that begins at `first`: the word after its line or its block. */
static struct statement statement_at(const struct reduction *r, uint32_t first)
{
    struct statement found = {.first = first};
    uint32_t i = first;
    for (; i < r->count && (r->word[i].line == r->word[first].line || found.open); i++) {
        if (!found.open && reduction_word_is(r->word + i, "{")) {
            found.open = i;
        } else if (found.open && reduction_word_is(r->word + i, "}") && !r->word[i].in_shader) {
            found.close = i++;
            break;
        }
    }
    found.end = i;
    return found;
}

void reduction_sweep(struct reduction *r)
{
    uint32_t count = 0, sequence = UINT32_MAX;
    for (uint32_t i = 0; i < r->count; i++)
        if (!r->word[i].gone)
            r->word[count++] = r->word[i];
    r->count = count;
    r->statements = r->undos = 0;
    for (uint32_t i = 0; i < count; i = r->statement[r->statements++].end) {
        struct statement *statement = r->statement + r->statements;
        *statement = statement_at(r, i);
        bool ends = reduction_word_is(r->word + i, "end");
        statement->depth = sequence != UINT32_MAX && !ends;
        if (reduction_word_is(r->word + i, "sequence"))
            sequence = r->statements;
        if (ends && sequence != UINT32_MAX) {
            r->statement[sequence].close = i;
            sequence = UINT32_MAX;
        }
    }
}

/* --- Candidates ----------------------------------------------------------------------------------------- */

static void remember(struct reduction *r, uint32_t index)
{
    if (r->undos == r->undo_capacity) {
        uint32_t capacity = r->undo_capacity ? 2 * r->undo_capacity : 256;
        struct undo *larger = realloc(r->undo, capacity * sizeof *larger);
        if (!larger) {
            r->failed = true;
            return;
        }
        r->undo = larger;
        r->undo_capacity = capacity;
    }
    r->undo[r->undos++] = (struct undo){index, r->word[index]};
}

void reduction_drop(struct reduction *r, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end && !r->failed; i++) {
        if (r->word[i].gone)
            continue;
        remember(r, i);
        r->word[i].gone = true;
    }
}

void reduction_put(struct reduction *r, uint32_t index, const char *text, size_t length)
{
    struct spelling *spelling = malloc(sizeof *spelling + length + 1);
    remember(r, index);
    if (!spelling || r->failed) {
        free(spelling);
        r->failed = true;
        return;
    }
    memcpy(spelling->text, text, length);
    spelling->text[length] = 0;
    spelling->next = r->spelling;
    r->spelling = spelling;
    r->word[index].text = spelling->text;
    r->word[index].length = (uint32_t)length;
    r->word[index].gone = false;
}

void reduction_put_number(struct reduction *r, uint32_t index, long long number)
{
    char digits[24];
    reduction_put(r, index, digits, (size_t)snprintf(digits, sizeof digits, "%lld", number));
}

static void write_candidate(struct reduction *r)
{
    uint32_t line = 0;
    text_cut(&r->candidate, 0);
    for (uint32_t i = 0; i < r->count; i++) {
        const struct word *word = r->word + i;
        if (word->gone)
            continue;
        if (line)
            text_add_bytes(&r->candidate, word->line == line ? " " : "\n", 1);
        text_add_bytes(&r->candidate, word->text, word->length);
        line = word->line;
    }
    text_add_bytes(&r->candidate, "\n", 1);
    r->failed |= r->candidate.failed;
}

/* Returns true if a text of that hash is known not to fail, and notes it as tried. A collision would cost one
 * candidate. */
static bool tried_before(struct reduction *r, uint64_t hash)
{
    if (2 * r->tried_count >= r->tried_capacity) {
        uint32_t capacity = r->tried_capacity ? 2 * r->tried_capacity : 4096;
        uint64_t *larger = calloc(capacity, sizeof *larger);
        if (!larger) {
            r->failed = true;
            return true;
        }
        for (uint32_t i = 0; i < r->tried_capacity; i++) {
            if (!r->tried[i])
                continue;
            uint32_t at = (uint32_t)r->tried[i] & (capacity - 1);
            while (larger[at])
                at = (at + 1) & (capacity - 1);
            larger[at] = r->tried[i];
        }
        free(r->tried);
        r->tried = larger;
        r->tried_capacity = capacity;
    }
    uint32_t at = (uint32_t)hash & (r->tried_capacity - 1);
    for (; r->tried[at]; at = (at + 1) & (r->tried_capacity - 1))
        if (r->tried[at] == hash)
            return true;
    r->tried[at] = hash;
    r->tried_count++;
    return false;
}

bool reduction_exhausted(const struct reduction *r)
{
    return r->failed || r->tries >= r->limit;
}

static bool fails(struct reduction *r)
{
    if (reduction_exhausted(r))
        return false;
    write_candidate(r);
    uint64_t hash = XXH3_64bits(r->candidate.data, r->candidate.length);
    if (r->failed || tried_before(r, hash ? hash : 1))
        return false;
    r->tries++;
    return r->still_fails(r->user, r->candidate.data, r->candidate.length);
}

bool reduction_try(struct reduction *r)
{
    bool kept = r->undos && fails(r);
    if (kept) {
        struct text kept_before = r->kept;
        r->kept = r->candidate;
        r->candidate = kept_before;
        r->accepted++;
    } else {
        while (r->undos) {
            r->undos--;
            r->word[r->undo[r->undos].index] = r->undo[r->undos].word;
        }
    }
    r->undos = 0;
    return kept;
}

/* --- Ranges --------------------------------------------------------------------------------------------- */

void reduction_add_range(struct reduction *r, uint32_t first, uint32_t end)
{
    if (first < end)
        r->range[r->ranges++] = (struct range){first, end};
}

static void remove_groups(struct reduction *r, uint32_t size)
{
    for (uint32_t end = r->ranges; end && !reduction_exhausted(r);) {
        uint32_t first = end > size ? end - size : 0;
        for (uint32_t i = first; i < end; i++)
            reduction_drop(r, r->range[i].first, r->range[i].end);
        reduction_try(r);
        end = first;
    }
}

void reduction_remove_ranges(struct reduction *r)
{
    for (uint32_t size = r->ranges; size; size = size == 1 ? 0 : (size + 1) / 2)
        remove_groups(r, size);
    r->ranges = 0;
}

/* --- Beginning and end ---------------------------------------------------------------------------------- */

int reduction_start(struct reduction *r, const char *text, size_t bytes, minimize_test *still_fails,
                    void *user, unsigned limit, struct error *error)
{
    *r = (struct reduction){.still_fails = still_fails, .user = user, .limit = limit};
    r->count = split(text, text + bytes, NULL);
    r->word = calloc(r->count + 1, sizeof *r->word);
    r->statement = calloc(r->count + 1, sizeof *r->statement);
    r->range = calloc(r->count + 1, sizeof *r->range);
    if (!r->word || !r->statement || !r->range)
        return error_set(error, "out of memory for %u words of a stream", r->count);
    split(text, text + bytes, r->word);
    reduction_sweep(r);
    return 0;
}

void reduction_free(struct reduction *r)
{
    while (r->spelling) {
        struct spelling *spelling = r->spelling;
        r->spelling = spelling->next;
        free(spelling);
    }
    free(r->word);
    free(r->statement);
    free(r->range);
    free(r->undo);
    free(r->tried);
    text_free(&r->candidate);
    text_free(&r->kept);
}
