/* Passes that make what remains plain: fewer primitives and vertices, fewer items of blocks and attributes of vertices,
 * smaller textures, common formats and operands, numbers that are 0 or 1. */
#include "fuzz/reduce.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is(const struct reduction *r, const struct statement *statement, const char *text)
{
    return word_is(r->word + statement->first, text);
}

static bool draws(const struct reduction *r, const struct statement *statement)
{
    return is(r, statement, "draw") || is(r, statement, "draw-indexed");
}

/* --- Draws ------------------------------------------------------------------------------------------------ */

/* How far apart the first vertices of two primitives are. */
static long long primitive_step(const struct word *word)
{
    return word_is(word, "triangles") ? 3 : word_is(word, "lines") ? 2 : 1;
}

static void put_draw(struct reduction *r, uint32_t first, long long begin, long long count)
{
    reduction_put_number(r, first, begin);
    reduction_put_number(r, first + 1, count);
}

/* One primitive alone, else the first or the second half, again and again. */
static void narrow_draw(struct reduction *r, uint32_t at, long long step)
{
    long long begin, count;
    bool found = true;
    while (found && word_integer(r->word + at, &begin) && word_integer(r->word + at + 1, &count) &&
           count > 1) {
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

/* --- Vertices --------------------------------------------------------------------------------------------- */

/* Numbers above `place` are less by `less`. */
static void lower(struct reduction *r, uint32_t index, long long place, long long less)
{
    long long value;
    if (!r->word[index].gone && word_integer(r->word + index, &value) && value > place)
        reduction_put_number(r, index, value - less > place ? value - less : place);
}

/* What counts vertices: where draws begin, indices, and with `fewer` the draws' primitives. */
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

/* Vertices go by threes, twos and ones, and what stands behind them moves up. */
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

/* --- Items of blocks -------------------------------------------------------------------------------------- */

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

/* Indices, values and texels: groups down to triples, pairs and single ones; each also with a primitive less. */
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

/* --- Attributes of vertices ------------------------------------------------------------------------------- */

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
#include "def/vertex_type.def"
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
    if (length > 0 && (size_t)length < sizeof text && !word_is(word, text)) {
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

/* --- Textures --------------------------------------------------------------------------------------------- */

/* Contents that fit every size, in place of all words from `first` to the statement's end. */
static void put_contents(struct reduction *r, const struct statement *statement, uint32_t first,
                         const char *text)
{
    reduction_drop(r, first, statement->end);
    reduction_put(r, first, text, strlen(text));
    reduction_try(r);
}

/* Half a side, with as many texels as that takes where they are listed one by one: those of the first rows. */
static void halve(struct reduction *r, const struct statement *statement, uint32_t side)
{
    long long value;
    while (word_integer(r->word + side, &value) && value > 1 && !reduction_exhausted(r)) {
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
                if (r->word[i].gone || !word_is(r->word + i, contents[c]))
                    continue;
                put_contents(r, statement, i, "empty");
                if (!word_is(r->word + i, "empty") && !word_is(r->word + i, "gradient"))
                    put_contents(r, statement, i, "gradient");
            }
        }
        for (uint32_t i = statement->first + 2; i < head; i++)
            if (!r->word[i].gone)
                halve(r, statement, i);
    }
}

/* --- Words ------------------------------------------------------------------------------------------------ */

static bool is_format(const struct word *word)
{
    static const char *const formats[] = {
#define FORMAT(name, ...) #name,
#include "def/format.def"
#undef FORMAT
    };
    for (unsigned i = 0; i < sizeof formats / sizeof *formats; i++)
        if (word_is(word, formats[i]))
            return true;
    return false;
}

/* Formats of textures and targets become the common one, formats of buffers and indices the wide one. */
void reduce_words(struct reduction *r)
{
    static const char plain[] = "A8R8G8B8";
    for (uint32_t s = 1; s < r->statements; s++) {
        uint32_t head = r->statement[s].open ? r->statement[s].open : r->statement[s].end;
        for (uint32_t i = r->statement[s].first + 1; i < head; i++) {
            if (r->word[i].gone || word_is(r->word + i, plain) || !is_format(r->word + i))
                continue;
            reduction_put(r, i, plain, sizeof plain - 1);
            reduction_try(r);
        }
    }
}

/* --- Operands of shaders ---------------------------------------------------------------------------------- */

/* The word up to `length`, and the comma it had. */
static bool shorten(struct reduction *r, uint32_t index, uint32_t from, uint32_t length)
{
    const struct word *word = r->word + index;
    char text[128];
    if (length >= word->length || length + 2 > sizeof text || length <= from)
        return false;
    memcpy(text, word->text + from, length - from);
    length -= from;
    if (word->text[word->length - 1] == ',' && text[length - 1] != ',')
        text[length++] = ',';
    if (length >= word->length)
        return false;
    reduction_put(r, index, text, length);
    return reduction_try(r);
}

static uint32_t find(const struct word *word, char c)
{
    const char *at = memchr(word->text, c, word->length);
    return at ? (uint32_t)(at - word->text) : word->length;
}

/* Modifiers of instructions (`_sat`), swizzles and masks (`.xyz`), signs. */
static void plain_operand(struct reduction *r, uint32_t index)
{
    shorten(r, index, 0, find(r->word + index, '.'));
    shorten(r, index, 0, find(r->word + index, '_'));
    if (*r->word[index].text == '-' && r->word[index].length > 1) {
        reduction_put(r, index, r->word[index].text + 1, r->word[index].length - 1);
        reduction_try(r);
    }
}

/* An instruction of more operands becomes a move of its first source, or of its last. */
static void plain_instruction(struct reduction *r, uint32_t first, uint32_t end)
{
    if (end - first < 4 || word_is(r->word + first, "def") || word_is(r->word + first, "mov"))
        return;
    for (int last = 0; last < 2; last++) {
        uint32_t source = last ? end - 1 : first + 2;
        reduction_put(r, first, "mov", 3);
        reduction_drop(r, first + 2, end);
        const struct word word = r->word[source];
        reduction_put(r, source, word.text, word.length - (word.text[word.length - 1] == ','));
        if (reduction_try(r))
            return;
    }
}

void reduce_operands(struct reduction *r)
{
    for (uint32_t i = 1, end; i < r->count; i = end) {
        for (end = i + 1; end < r->count && r->word[end].line == r->word[i].line; end++)
            ;
        if (!r->word[i].in_shader)
            continue;
        plain_instruction(r, i, end);
        for (uint32_t w = i; w < end; w++)
            if (!r->word[w].gone)
                plain_operand(r, w);
    }
}

/* --- Numbers ---------------------------------------------------------------------------------------------- */

static bool is_color(const struct word *word)
{
    bool marked = word->length == 10 && word->text[0] == '0' && word->text[1] == 'x';
    if (word->length != 8 && !marked)
        return false;
    for (uint32_t i = marked ? 2 : 0; i < word->length; i++)
        if (!isxdigit((unsigned char)word->text[i]))
            return false;
    return true;
}

static bool is_number(const struct word *word, double *value)
{
    char text[64], *end;
    if (word->length >= sizeof text)
        return false;
    memcpy(text, word->text, word->length);
    text[word->length] = 0;
    if (text[word->length - 1] == ',')
        text[word->length - 1] = 0;
    *value = strtod(text, &end);
    return end != text && !*end;
}

/* Tries the number written otherwise; a comma behind it stays. */
static bool try_number(struct reduction *r, uint32_t index, const char *text)
{
    const struct word *word = r->word + index;
    bool comma = word->text[word->length - 1] == ',';
    char written[64];
    int length = snprintf(written, sizeof written, "%s%s", text, comma ? "," : "");
    if (length < 0 || (size_t)length >= sizeof written || word_is(word, written))
        return false;
    reduction_put(r, index, written, (size_t)length);
    return reduction_try(r);
}

static void simplify_color(struct reduction *r, uint32_t index)
{
    const char *mark = r->word[index].length == 10 ? "0x" : "";
    static const char *const values[] = {"00000000", "ffffffff", "ff000000", "ffff0000"};
    char text[16];
    for (unsigned i = 0; i < sizeof values / sizeof *values; i++) {
        snprintf(text, sizeof text, "%s%s", mark, values[i]);
        if (word_is(r->word + index, text))
            return;
        if (try_number(r, index, text))
            return;
    }
}

/* 0, 1, -1; else fewer digits, half, one less: each step is shorter or nearer to 0. */
static void simplify_number(struct reduction *r, uint32_t index, double value)
{
    static const char *const simple[] = {"0", "1", "-1"};
    char text[32];
    for (unsigned i = 0; i < sizeof simple / sizeof *simple; i++)
        if (value == strtod(simple[i], NULL) || try_number(r, index, simple[i]))
            return;
    for (int digits = 1; digits < 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strlen(text) < r->word[index].length && try_number(r, index, text))
            return;
    }
    long long whole;
    while (word_integer(r->word + index, &whole) && (whole > 1 || whole < -1)) {
        snprintf(text, sizeof text, "%lld", whole / 2);
        if (try_number(r, index, text))
            continue;
        snprintf(text, sizeof text, "%lld", whole - (whole > 0 ? 1 : -1));
        if (!try_number(r, index, text))
            return;
    }
}

static bool is_plain(const struct reduction *r, uint32_t index)
{
    double value;
    const struct word *word = r->word + index;
    if (word->gone || word->line == r->word[0].line || *word->text == '"')
        return true;
    if (is_color(word))
        return word_is(word, "00000000") || word_is(word, "0x00000000");
    return !is_number(word, &value) || value == 0;
}

static void put_zero(struct reduction *r, uint32_t index)
{
    const struct word *word = r->word + index;
    if (is_color(word))
        reduction_put(r, index, word->length == 10 ? "0x00000000" : "00000000", word->length);
    else
        reduction_put(r, index, "0,", word->text[word->length - 1] == ',' ? 2 : 1);
}

/* Many numbers at once become zeros, in groups as ranges are removed; then each for itself. */
void reduce_numbers(struct reduction *r)
{
    for (uint32_t i = 1; i < r->count; i++)
        if (!is_plain(r, i))
            reduction_add_range(r, i, i + 1);
    for (uint32_t size = r->ranges; size > 1; size = (size + 1) / 2 == size ? 1 : (size + 1) / 2) {
        for (uint32_t first = 0; first < r->ranges && !reduction_exhausted(r); first += size) {
            for (uint32_t i = first; i < r->ranges && i < first + size; i++)
                if (!is_plain(r, r->range[i].first))
                    put_zero(r, r->range[i].first);
            reduction_try(r);
        }
    }
    for (uint32_t i = 0; i < r->ranges && !reduction_exhausted(r); i++) {
        double value;
        uint32_t index = r->range[i].first;
        if (is_color(r->word + index))
            simplify_color(r, index);
        else if (is_number(r->word + index, &value) && value != 0)
            simplify_number(r, index, value);
    }
    r->ranges = 0;
}
