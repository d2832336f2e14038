#include "capture/word.h"

#include "capture/call.h"

#include <string.h>

static const struct row {
    enum word_list list;
    const char *word;
    unsigned value;
} rows[] = {
#define WORD(list, word, value) {WORDS_##list, #word, value},
#include "capture/word.def"
#undef WORD
#define PRIMITIVE(name, word, ...) {WORDS_PRIMITIVE, #word, TRIPTYCH_##name},
#include "def/state/primitive.def"
#undef PRIMITIVE
#define ATTRIBUTE(name, word, usage, index, meaning) {WORDS_ATTRIBUTE, #word, TRIPTYCH_##name},
#include "def/state/attribute.def"
#undef ATTRIBUTE
#define ELEMENT(word, usage, index) {WORDS_ATTRIBUTE, #word, ELEMENT_##word},
#include "capture/element.def"
#undef ELEMENT
#define VERTEX_TYPE(name, word, components, encoding, bits, divisor, meaning)                                \
    {WORDS_FORMAT, #word, TRIPTYCH_FORMAT_##name},
#include "def/state/vertex_type.def"
#undef VERTEX_TYPE
#define DEPTH_FORMAT(name, word, storage, depth_bits, stencil_bits, meaning)                                 \
    {WORDS_DEPTH, #word, TRIPTYCH_DEPTH_##name},
#include "def/state/depth_format.def"
#undef DEPTH_FORMAT
};

enum { ROWS = sizeof rows / sizeof *rows };

const char *word_text(enum word_list list, unsigned value)
{
    for (int i = 0; i < ROWS; i++)
        if (rows[i].list == list && rows[i].value == value)
            return rows[i].word;
    return NULL;
}

int word_value(enum word_list list, const char *text, size_t length, unsigned *value)
{
    for (int i = 0; i < ROWS; i++)
        if (rows[i].list == list && strlen(rows[i].word) == length && !memcmp(rows[i].word, text, length)) {
            *value = rows[i].value;
            return 0;
        }
    return -1;
}

static const char *choice_at(const struct words *words, unsigned index)
{
    return index >= ROWS ? NULL : rows[index].list == words->count ? rows[index].word : "";
}

struct words word_list(enum word_list list)
{
    return (struct words){.at = choice_at, .count = list};
}
