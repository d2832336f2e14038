/* Passes that make what remains plain: fewer primitives and vertices, fewer items of blocks and attributes
 * of vertices, smaller textures, common formats and operands, numbers that are 0 or 1. */
#include "command/fuzz/reduce/reduce.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is(const struct reduction *r, const struct statement *statement, const char *text)
{
    return reduction_word_is(r->word + statement->first, text);
}

static bool draws(const struct reduction *r, const struct statement *statement)
{
    return is(r, statement, "draw") || is(r, statement, "draw-indexed");
}

/* --- Draws ---------------------------------------------------------------------------------------------- */

/* How far apart the first vertices of two primitives are. */
static long long primitive_step(const struct word *word)
{
    return reduction_word_is(word, "triangles") ? 3 : reduction_word_is(word, "lines") ? 2 : 1;
}

static void put_draw(struct reduction *r, uint32_t first, long long begin, long long count)
{
    reduction_put_number(r, first, begin);
    reduction_put_number(r, first + 1, count);
}

/* Only one primitive, else the first or the second half, repeatedly. */
static void narrow_draw(struct reduction *r, uint32_t at, long long step)
{
    long long begin, count;
    bool found = true;
    while (found && reduction_word_integer(r->word + at, &begin) &&
           reduction_word_integer(r->word + at + 1, &count) && count > 1) {
        long long half = count / 2;
        put_draw(r, at, begin, half);
        found = reduction_try(r);
        if (!found) {
            put_draw(r, at, begin + half * step, count - half);
            found = reduction_try(r);
        }
        if (!found) {
            put_draw(r, at, begin, count - 1);
            found = reduction_try(r);
        }
        if (!found) {
            put_draw(r, at, begin + step, count - 1);
            found = reduction_try(r);
        }
    }
}

void reduce_draws(struct reduction *r)
{
    for (uint32_t s = 1; s < r->statements; s++) {
        const struct statement *statement = r->statement + s;
        if (draws(r, statement) && statement->end - statement->first >= 4)
            narrow_draw(r, statement->end - 2, primitive_step(r->word + statement->first + 1));
    }
}

/* --- Vertices ------------------------------------------------------------------------------------------- */

/* Numbers above `place` are less by `less`. */
static void lower(struct reduction *r, uint32_t index, long long place, long long less)
{
    long long value;
    if (!r->word[index].gone && reduction_word_integer(r->word + index, &value) && value > place)
        reduction_put_number(r, index, value - less > place ? value - less : place);
}

/* The numbers that count vertices: the starts of draws, indices, and with `fewer` the draws' primitives. */
static void follow_removal(struct reduction *r, long long place, long long removed, bool fewer)
{
    for (uint32_t s = 1; s < r->statements; s++) {
        const struct statement *statement = r->statement + s;
        if (draws(r, statement) && statement->end - statement->first >= 4) {
            if (is(r, statement, "draw"))
                lower(r, statement->end - 2, place, removed);
            if (fewer)
                lower(r, statement->end - 1, 1, 1);
        } else if (statement->open && is(r, statement, "indices")) {
            for (uint32_t i = statement->open + 1; i < statement->close; i++)
                lower(r, i, place, removed);
        }
    }
}

static uint32_t lines_of(const struct reduction *r, const struct statement *statement, uint32_t first[],
                         uint32_t capacity)
{
    uint32_t count = 0;
    for (uint32_t i = statement->open + 1; i < statement->close && count < capacity; i++)
        if (!r->word[i].gone && (i == statement->open + 1 || r->word[i - 1].line != r->word[i].line))
            first[count++] = i;
    return count;
}

enum { VERTICES_MOST = 4096 };

/* Removes vertices by threes, twos and ones; later vertices move up. */
static void remove_vertices(struct reduction *r, const struct statement *statement, uint32_t group)
{
    uint32_t first[VERTICES_MOST + 1], lines = lines_of(r, statement, first, VERTICES_MOST);
    first[lines] = statement->close;
    for (uint32_t i = lines; i-- > 0 && !reduction_exhausted(r);) {
        if (i + group > lines)
            continue;
        for (int fewer = 0; fewer < 2; fewer++) {
            reduction_drop(r, first[i], first[i + group]);
            follow_removal(r, i, group, fewer);
            if (!reduction_try(r))
                continue;
            memmove(first + i, first + i + group, (lines + 1 - i - group) * sizeof *first);
            lines -= group;
            break;
        }
    }
}

void reduce_vertices(struct reduction *r)
{
    for (uint32_t s = 1; s < r->statements; s++)
        for (uint32_t group = 3; group && r->statement[s].open && is(r, r->statement + s, "vertices");
             group--)
            remove_vertices(r, r->statement + s, group);
}

/* --- Items of blocks ------------------------------------------------------------------------------------ */

static void remove_items(struct reduction *r, const struct statement *statement, uint32_t group, bool fewer)
{
    for (uint32_t end = statement->close; end > statement->open + 1 && !reduction_exhausted(r);) {
        uint32_t first = end, found = 0;
        while (found < group && first > statement->open + 1)
            found += !r->word[--first].gone;
        reduction_drop(r, first, end);
        if (fewer)
            follow_removal(r, INT32_MAX, 0, true);
        reduction_try(r);
        end = first;
    }
}

/* Indices, values and texels: groups down to triples, pairs and single ones; each also with a primitive
 * less. */
void reduce_items(struct reduction *r)
{
    for (uint32_t s = 1; s < r->statements; s++) {
        const struct statement *statement = r->statement + s;
        if (!statement->open || !statement->close || r->word[statement->open + 1].in_shader ||
            is(r, statement, "vertices"))
            continue;
        uint32_t items = statement->close - statement->open - 1;
        for (uint32_t group = items; group; group = group > 6 ? group / 2 : group - 1) {
            remove_items(r, statement, group, false);
            if (group <= 3 && is(r, statement, "indices"))
                remove_items(r, statement, group, true);
        }
    }
}

/* --- Attributes of vertices ----------------------------------------------------------------------------- */

/* Values that an attribute has in a vertex's line, and the plain type that has as many. */
static const struct vertex_word {
    const char *word;
    uint32_t values;
    const char *plain;
} vertex_words[] = {
#define PLAIN_FLOAT(components)                                                                              \
    (components) == 1 ? "float1" : (components) == 2 ? "float2" : (components) == 3 ? "float3" : "float4"
#define PLAIN_UNSIGNED PLAIN_FLOAT
#define PLAIN_SIGNED   PLAIN_FLOAT
#define PLAIN_HALF     PLAIN_FLOAT
#define PLAIN_COLOR(c) "color"
#define VERTEX_TYPE(name, word, components, encoding, bits, divisor, meaning)                                \
    {":" #word, (#encoding)[0] == 'C' ? 1 : components, PLAIN_##encoding(components)},
#include "def/state/vertex_type.def"
#undef VERTEX_TYPE
};

static const struct vertex_word *vertex_word(const struct word *word)
{
    for (unsigned i = 0; i < sizeof vertex_words / sizeof *vertex_words; i++) {
        size_t length = strlen(vertex_words[i].word);
        if (word->length > length &&
            !memcmp(word->text + word->length - length, vertex_words[i].word, length))
            return vertex_words + i;
    }
    return NULL;
}

static void drop_column(struct reduction *r, const struct statement *statement, uint32_t place,
                        uint32_t values)
{
    uint32_t column = 0, line = 0;
    for (uint32_t i = statement->open + 1; i < statement->close; i++) {
        if (r->word[i].gone)
            continue;
        column = r->word[i].line == line ? column + 1 : 0;
        line = r->word[i].line;
        if (column >= place && column < place + values)
            reduction_drop(r, i, i + 1);
    }
}

static void put_type(struct reduction *r, uint32_t index, const struct vertex_word *type)
{
    const struct word *word = r->word + index;
    char text[96];
    int length = snprintf(text, sizeof text, "%.*s%s", (int)(word->length - strlen(type->word) + 1),
                          word->text, type->plain);
    if (length > 0 && (size_t)length < sizeof text && !reduction_word_is(word, text)) {
        reduction_put(r, index, text, (size_t)length);
        reduction_try(r);
    }
}

void reduce_columns(struct reduction *r)
{
    for (uint32_t s = 1; s < r->statements; s++) {
        const struct statement *statement = r->statement + s;
        if (!is(r, statement, "vertices") || !statement->close)
            continue;
        uint32_t place = 0;
        for (uint32_t i = statement->first + 2; i < statement->open; i++) {
            const struct vertex_word *type = r->word[i].gone ? NULL : vertex_word(r->word + i);
            if (!type)
                continue;
            reduction_drop(r, i, i + 1);
            drop_column(r, statement, place, type->values);
            if (reduction_try(r))
                continue;
            put_type(r, i, type);
            place += type->values;
        }
    }
}

/* --- Textures ------------------------------------------------------------------------------------------- */

/* Contents that fit every size, instead of all words from `first` to the statement's end. */
static void put_contents(struct reduction *r, const struct statement *statement, uint32_t first,
                         const char *text)
{
    reduction_drop(r, first, statement->end);
    reduction_put(r, first, text, strlen(text));
    reduction_try(r);
}

/* Half a side, with as many texels as that takes where they are listed one by one: those of the first
 * rows. */
static void halve(struct reduction *r, const struct statement *statement, uint32_t side)
{
    long long value;
    while (reduction_word_integer(r->word + side, &value) && value > 1 && !reduction_exhausted(r)) {
        uint32_t texels = 0;
        for (uint32_t i = statement->open; statement->open && i < statement->close; i++)
            texels += i > statement->open && !r->word[i].gone;
        uint32_t keep = texels / (uint32_t)value * (uint32_t)(value / 2);
        reduction_put_number(r, side, value / 2);
        for (uint32_t i = statement->open + 1; statement->open && i < statement->close; i++) {
            if (!r->word[i].gone && keep)
                keep--;
            else
                reduction_drop(r, i, i + 1);
        }
        if (reduction_try(r))
            continue;
        reduction_put_number(r, side, value / 2); /* procedural contents */
        if (!reduction_try(r))
            return;
    }
}

void reduce_textures(struct reduction *r)
{
    static const char *const contents[] = {"checker", "gradient", "empty", "bytes",
                                           "colors",  "fill",     "files"};
    for (uint32_t s = 1; s < r->statements; s++) {
        const struct statement *statement = r->statement + s;
        if (!is(r, statement, "texture"))
            continue;
        uint32_t head = statement->open ? statement->open : statement->end;
        for (uint32_t i = statement->first + 2; i < head; i++) {
            for (unsigned c = 0; c < sizeof contents / sizeof *contents; c++) {
                if (r->word[i].gone || !reduction_word_is(r->word + i, contents[c]))
                    continue;
                put_contents(r, statement, i, "empty");
                if (!reduction_word_is(r->word + i, "empty") && !reduction_word_is(r->word + i, "gradient"))
                    put_contents(r, statement, i, "gradient");
            }
        }
        for (uint32_t i = statement->first + 2; i < head; i++)
            if (!r->word[i].gone)
                halve(r, statement, i);
    }
}
