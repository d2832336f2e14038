/* The calls of the text format that say what vertices are: declarations, flexible vertex formats,
 * frequencies. */
#include "stream/layout.h"
#include "stream/parse.h"

#include <string.h>

int parse_attribute(struct parser *parser, size_t length, unsigned *element, enum triptych_format *format)
{
    struct lexer *lex = &parser->lex;
    const struct token *token = &lex->token;
    const char *colon = token->type == TOKEN_WORD ? memchr(token->text, ':', length) : NULL;
    size_t before = colon ? (size_t)(colon - token->text) : 0;
    unsigned type;
    char choices[384];
    if (!colon || word_value(WORDS_ATTRIBUTE, token->text, before, element)) {
        word_choices(WORDS_ATTRIBUTE, choices, sizeof choices);
        return lex_expected(lex, "ATTRIBUTE:FORMAT with %s", choices);
    }
    if (word_value(WORDS_FORMAT, colon + 1, length - before - 1, &type)) {
        word_choices(WORDS_FORMAT, choices, sizeof choices);
        return lex_expected(lex, "a format: %s", choices);
    }
    *format = (enum triptych_format)type;
    return 0;
}

/* The digits behind an element's @. */
static int parse_offset(struct parser *parser, const char *at, uint32_t *offset)
{
    const struct token *token = &parser->lex.token;
    uint32_t value = 0;
    const char *end = token->text + token->length;
    for (const char *c = at + 1; c < end; c++) {
        if (*c < '0' || *c > '9' || value > 65532)
            return lex_expected(&parser->lex, "an offset up to 65532 behind @");
        value = 10 * value + (uint32_t)(*c - '0');
    }
    if (at + 1 == end || value % 4 || value > 65532)
        return lex_expected(&parser->lex, "a multiple of 4 up to 65532 behind @");
    *offset = value;
    return 0;
}

/* ATTRIBUTE:FORMAT or ATTRIBUTE:FORMAT@OFFSET */
static int parse_declared(struct parser *parser, struct call *call, unsigned stream, uint32_t *offset)
{
    const struct token *token = &parser->lex.token;
    const char *at = token->type == TOKEN_WORD ? memchr(token->text, '@', token->length) : NULL;
    unsigned element;
    enum triptych_format format;
    size_t length = at ? (size_t)(at - token->text) : token->length;
    if (parse_attribute(parser, length, &element, &format))
        return -1;
    for (uint32_t i = 0; i < call->declare.count; i++)
        if (call->declare.element[i].element == element)
            return lex_expected(&parser->lex, "each attribute once");
    if (at && parse_offset(parser, at, offset))
        return -1;
    if (*offset > 65532)
        return lex_expected(&parser->lex, "@OFFSET behind it, an element does not fit behind the one before");
    call->declare.element[call->declare.count++] =
        (struct declared){(uint8_t)element, (uint8_t)format, (uint8_t)stream, (uint16_t)*offset};
    *offset += vertex_types[format].bytes;
    return lex_next(&parser->lex);
}

int parse_declare(struct parser *parser, struct call *call)
{
    struct lexer *lex = &parser->lex;
    uint32_t next[TRIPTYCH_STREAMS] = {0}, stream = 0;
    while (lex->token.type != TOKEN_LINE_END && lex->token.type != TOKEN_END)
        if (lex->token.type == TOKEN_WORD && lex->token.text[0] >= '0' && lex->token.text[0] <= '9') {
            if (parse_integer(parser, "stream", TRIPTYCH_STREAMS - 1, &stream))
                return -1;
        } else if (parse_declared(parser, call, stream, &next[stream])) {
            return -1;
        }
    return 0;
}

static const struct {
    enum triptych_usage usage;
    unsigned index;
} usages[STREAM_ELEMENTS] = {
#define ATTRIBUTE(name, word, usage, index, meaning) {TRIPTYCH_USAGE_##usage, index},
#include "def/attribute.def"
#undef ATTRIBUTE
#define ELEMENT(word, usage, index) {TRIPTYCH_USAGE_##usage, index},
#include "stream/element.def"
#undef ELEMENT
};

unsigned stream_declaration(const struct call *call,
                            struct triptych_declaration_element elements[STREAM_ELEMENTS])
{
    for (uint32_t i = 0; i < call->declare.count; i++) {
        const struct declared *from = &call->declare.element[i];
        elements[i] =
            (struct triptych_declaration_element){from->stream, from->offset, from->format,
                                                  usages[from->element].usage, usages[from->element].index};
    }
    return call->declare.count;
}

unsigned stream_declare_layout(const struct layout *layout,
                               struct triptych_declaration_element elements[STREAM_ELEMENTS])
{
    unsigned count = 0;
    int others = 0;
    for (unsigned e = 0; e < STREAM_ELEMENTS; e++) {
        if (layout->format[e] == TRIPTYCH_FORMAT_NONE)
            continue;
        elements[count++] = (struct triptych_declaration_element){0, layout->offset[e], layout->format[e],
                                                                  usages[e].usage, usages[e].index};
        others |= e >= TRIPTYCH_ATTRIBUTE_COUNT;
    }
    return others ? count : 0;
}

const char *stream_element_word(unsigned usage, unsigned usage_index)
{
    unsigned e = 0;
    while (e + 1 < STREAM_ELEMENTS && (usages[e].usage != usage || usages[e].index != usage_index))
        e++;
    return word_text(WORDS_ATTRIBUTE, e);
}

int parse_fvf(struct parser *parser, struct call *call)
{
    static const struct {
        const char *word;
        uint32_t mask, value;
    } rows[] = {
#define FVF(word, mask, value, meaning) {#word, mask, value},
#include "def/fvf.def"
#undef FVF
    };
    enum { ROWS = sizeof rows / sizeof rows[0] };
    struct lexer *lex = &parser->lex;
    uint32_t given = 0;
    do {
        int i = 0;
        while (i < ROWS && !lex_is(lex, rows[i].word))
            i++;
        if (i == ROWS)
            return lex_expected(lex, "parts of a vertex format: xyz, normal, diffuse, tex1 and the like");
        if (given & rows[i].mask)
            return lex_expected(lex, "one part of its kind");
        given |= rows[i].mask;
        call->fvf |= rows[i].value;
        if (lex_next(lex))
            return -1;
    } while (lex->token.type != TOKEN_LINE_END && lex->token.type != TOKEN_END);
    return 0;
}

int parse_frequency(struct parser *parser, struct call *call)
{
    unsigned frequency;
    if (parse_integer(parser, "stream", TRIPTYCH_STREAMS - 1, &call->frequency.stream) ||
        parse_word(parser, WORDS_FREQUENCY, "a frequency", &frequency))
        return -1;
    call->frequency.frequency = (enum triptych_frequency)frequency;
    return parse_integer(parser, "count", UINT32_MAX, &call->frequency.count);
}
