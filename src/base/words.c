#include "base/words.h"
#include "base/minmax.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { WORD_MAXIMUM = 64, PREFIX_MINIMUM = 3 };

const char *words_row(const struct words *words, unsigned index)
{
    const char *rows = words->list;
    return index < words->count ? *(const char *const *)(const void *)(rows + index * words->stride) : NULL;
}

const char *words_find(struct words words, const char *given, size_t length, unsigned *index)
{
    const char *word;
    for (unsigned i = 0; (word = words.at(&words, i)); i++)
        if (*word && strlen(word) == length && !memcmp(word, given, length))
            return *index = i, word;
    return NULL;
}

/* --- Distances --- */

static bool same(char a, char b)
{
    return tolower((unsigned char)a) == tolower((unsigned char)b);
}

static bool begins_with(const char *word, const char *given, size_t length)
{
    size_t i = 0;
    while (i < length && word[i] && same(word[i], given[i]))
        i++;
    return i == length;
}

/* Rows of the usual table: row i has the distances of the first i bytes of `a` to each beginning of `b`. */
static unsigned distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    unsigned rows[3][WORD_MAXIMUM + 1];
    for (size_t j = 0; j <= b_length; j++)
        rows[0][j] = (unsigned)j;
    for (size_t i = 1; i <= a_length; i++) {
        unsigned *row = rows[i % 3];
        const unsigned *above = rows[(i + 2) % 3], *two_above = rows[(i + 1) % 3];
        row[0] = (unsigned)i;
        for (size_t j = 1; j <= b_length; j++) {
            row[j] = min_u32(above[j - 1] + !same(a[i - 1], b[j - 1]), min_u32(above[j], row[j - 1]) + 1);
            if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
                row[j] = min_u32(row[j], two_above[j - 2] + 1);
        }
    }
    return rows[a_length % 3][b_length];
}

/* The distance, or WORD_MAXIMUM, which is larger than all that count as similar. */
static unsigned distance_if_similar(const char *word, const char *given, size_t length)
{
    size_t longer = strlen(word);
    if (longer > WORD_MAXIMUM || (longer == length && !memcmp(word, given, length)))
        return WORD_MAXIMUM;
    if (length >= PREFIX_MINIMUM && begins_with(word, given, length))
        return 1;
    size_t shorter = min_size(longer, length), allowed;
    longer = max_size(longer, length);
    allowed = (longer + 2) / 3;
    if (longer - shorter > allowed)
        return WORD_MAXIMUM;
    unsigned apart = distance(word, strlen(word), given, length);
    return apart < length && apart <= allowed ? apart : WORD_MAXIMUM;
}

const char *words_nearest(struct words words, const char *given, size_t length)
{
    const char *word, *nearest = NULL;
    unsigned least = WORD_MAXIMUM;
    if (length > WORD_MAXIMUM)
        return NULL;
    for (unsigned i = 0; (word = words.at(&words, i)); i++) {
        unsigned apart = *word ? distance_if_similar(word, given, length) : WORD_MAXIMUM;
        if (apart < least) {
            least = apart;
            nearest = word;
        }
    }
    return nearest;
}

/* --- Texts --- */

void words_join(struct words words, char *text, size_t capacity)
{
    static const char more[] = ", ...";
    const char *word;
    size_t length = 0;
    *text = 0;
    for (unsigned i = 0; (word = words.at(&words, i)); i++) {
        size_t needed = strlen(word) + 2;
        if (!*word)
            continue;
        if (length + needed + sizeof more > capacity) {
            snprintf(text + length, capacity - length, "%s", more);
            return;
        }
        length += (size_t)snprintf(text + length, capacity - length, "%s%s", length ? ", " : "", word);
    }
}

const char *words_suggest(struct words words, const char *given, size_t length, char text[WORDS_SUGGESTION])
{
    const char *nearest = words_nearest(words, given, length);
    *text = 0;
    if (nearest)
        snprintf(text, WORDS_SUGGESTION, "; did you mean \"%s\"?", nearest);
    return text;
}

int words_suggest_in(struct words words, const char *given, size_t length, struct error *error)
{
    static const char more[] = "...";
    char suggestion[WORDS_SUGGESTION];
    size_t needed = strlen(words_suggest(words, given, length, suggestion));
    size_t used = error ? strlen(error->text) : 0;
    if (!error || !needed)
        return -1;
    if (used + needed >= sizeof error->text) {
        used = sizeof error->text - 1 - needed - strlen(more);
        while (used && (error->text[used] & 0xc0) == 0x80)
            used--;
        used += (size_t)sprintf(error->text + used, "%s", more);
    }
    memcpy(error->text + used, suggestion, needed + 1);
    return -1;
}

int words_choose(struct words words, const char *option, const char *value, unsigned *index,
                 struct error *error)
{
    char choices[ERROR_CAPACITY / 2];
    if (words_find(words, value, strlen(value), index))
        return 0;
    words_join(words, choices, sizeof choices);
    error_set(error, "%s is \"%.40s\", expected one of: %s", option, value, choices);
    return words_suggest_in(words, value, strlen(value), error);
}
