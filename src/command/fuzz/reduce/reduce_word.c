/* Passes that make single words plain: common formats, plain operands of shaders, numbers that are 0 or 1. */
#include "command/fuzz/reduce/reduce.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Words ---------------------------------------------------------------------------------------------- */

static bool is_format(const struct word *word)
{
    static const char *const formats[] = {
#define FORMAT(name, ...) #name,
#include "def/state/format.def"
#undef FORMAT
    };
    for (unsigned i = 0; i < sizeof formats / sizeof *formats; i++)
        if (reduction_word_is(word, formats[i]))
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
            if (r->word[i].gone || reduction_word_is(r->word + i, plain) || !is_format(r->word + i))
                continue;
            reduction_put(r, i, plain, sizeof plain - 1);
            reduction_try(r);
        }
    }
}

/* --- Operands of shaders -------------------------------------------------------------------------------- */

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
    if (end - first < 4 || reduction_word_is(r->word + first, "def") ||
        reduction_word_is(r->word + first, "mov"))
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

/* --- Numbers -------------------------------------------------------------------------------------------- */

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

/* Tries another notation of the number; a comma after it stays. */
static bool try_number(struct reduction *r, uint32_t index, const char *text)
{
    const struct word *word = r->word + index;
    bool comma = word->text[word->length - 1] == ',';
    char written[64];
    int length = snprintf(written, sizeof written, "%s%s", text, comma ? "," : "");
    if (length < 0 || (size_t)length >= sizeof written || reduction_word_is(word, written))
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
        if (reduction_word_is(r->word + index, text))
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
    while (reduction_word_integer(r->word + index, &whole) && (whole > 1 || whole < -1)) {
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
        return reduction_word_is(word, "00000000") || reduction_word_is(word, "0x00000000");
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

/* Many numbers together become zeros, in groups as ranges are removed; then each by itself. */
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
