/* Calls of the text that describe vertices: declarations and flexible vertex formats. */
#include "capture/layout.h"
#include "command/text/parse.h"

#include <stdio.h>
#include <string.h>

enum { OFFSET_MAXIMUM = 65535 };

static int parse_format(struct parser *parser, const char *text, size_t length, enum triptych_format *format)
{
    unsigned type;
    char choices[384];
    if (!word_value(WORDS_FORMAT, text, length, &type)) {
        *format = (enum triptych_format)type;
        return 0;
    }
    words_join(word_list(WORDS_FORMAT), choices, sizeof choices);
    lex_expected(&parser->lex, "a format: %s", choices);
    return words_suggest_in(word_list(WORDS_FORMAT), text, length, parser->lex.error);
}

static int expect_attribute(struct parser *parser)
{
    const struct token *token = &parser->lex.token;
    const char *colon = memchr(token->text, ':', token->length);
    char choices[384];
    words_join(word_list(WORDS_ATTRIBUTE), choices, sizeof choices);
    lex_expected(&parser->lex, "ATTRIBUTE:FORMAT with %s", choices);
    return words_suggest_in(word_list(WORDS_ATTRIBUTE), token->text,
                            colon ? (size_t)(colon - token->text) : token->length, parser->lex.error);
}

int parse_attribute(struct parser *parser, size_t length, unsigned *element, enum triptych_format *format)
{
    const struct token *token = &parser->lex.token;
    const char *colon = token->type == TOKEN_WORD ? memchr(token->text, ':', length) : NULL;
    size_t before = colon ? (size_t)(colon - token->text) : 0;
    if (!colon || word_value(WORDS_ATTRIBUTE, token->text, before, element))
        return expect_attribute(parser);
    return parse_format(parser, colon + 1, length - before - 1, format);
}

/* Reads a usage by its word and index, such as "color.5", if no word exists for both. */
static int parse_usage(const char *text, size_t length, unsigned *usage, unsigned *index)
{
    const char *dot = memchr(text, '.', length);
    size_t before = dot ? (size_t)(dot - text) : 0;
    size_t digits = dot ? length - before - 1 : 0;
    if (!digits || digits > 2 || word_value(WORDS_USAGE, text, before, usage))
        return -1;
    *index = 0;
    for (const char *c = dot + 1; c < text + length; c++) {
        if (*c < '0' || *c > '9')
            return -1;
        *index = 10 * *index + (unsigned)(*c - '0');
    }
    return *index < TRIPTYCH_USAGE_INDICES ? 0 : -1;
}

/* Reads the digits after the @ of an element. */
static int parse_offset(struct parser *parser, const char *at, uint32_t *offset)
{
    const struct token *token = &parser->lex.token;
    uint32_t value = 0;
    const char *end = token->text + token->length;
    for (const char *c = at + 1; c < end; c++) {
        if (*c < '0' || *c > '9' || value > OFFSET_MAXIMUM)
            return lex_expected(&parser->lex, "an offset up to %d after @", OFFSET_MAXIMUM);
        value = 10 * value + (uint32_t)(*c - '0');
    }
    if (at + 1 == end || value > OFFSET_MAXIMUM)
        return lex_expected(&parser->lex, "an offset up to %d after @", OFFSET_MAXIMUM);
    *offset = value;
    return 0;
}

/* ATTRIBUTE:FORMAT, or USAGE.INDEX:FORMAT */
static int parse_what(struct parser *parser, size_t length, struct call_declared *declared)
{
    const struct token *token = &parser->lex.token;
    const char *colon = token->type == TOKEN_WORD ? memchr(token->text, ':', length) : NULL;
    size_t before = colon ? (size_t)(colon - token->text) : 0;
    unsigned usage, index, element;
    enum triptych_format format = TRIPTYCH_FORMAT_NONE;
    if (!colon)
        return expect_attribute(parser);
    if (!word_value(WORDS_ATTRIBUTE, token->text, before, &element))
        usage = resource_element_usage(element, &index);
    else if (parse_usage(token->text, before, &usage, &index))
        return expect_attribute(parser);
    if (parse_format(parser, colon + 1, length - before - 1, &format))
        return -1;
    declared->usage = (uint8_t)usage;
    declared->usage_index = (uint8_t)index;
    declared->format = (uint8_t)format;
    return 0;
}

/* Reads an element, with or without @OFFSET. */
static int parse_declared(struct parser *parser, struct call *call, unsigned stream, uint32_t *offset)
{
    const struct token *token = &parser->lex.token;
    const char *at = token->type == TOKEN_WORD ? memchr(token->text, '@', token->length) : NULL;
    size_t length = at ? (size_t)(at - token->text) : token->length;
    struct call_declared made = {.stream = (uint8_t)stream};
    if (parse_what(parser, length, &made))
        return -1;
    for (uint32_t i = 0; i < call->declare.count; i++)
        if (call->declare.element[i].usage == made.usage &&
            call->declare.element[i].usage_index == made.usage_index)
            return lex_expected(&parser->lex, "each attribute once");
    if (call->declare.count == TRIPTYCH_DECLARATION_ELEMENTS)
        return lex_expected(&parser->lex, "at most %d elements", TRIPTYCH_DECLARATION_ELEMENTS);
    if (at && parse_offset(parser, at, offset))
        return -1;
    if (*offset > OFFSET_MAXIMUM)
        return lex_expected(&parser->lex, "@OFFSET after it: the element does not fit after the one before");
    made.offset = (uint16_t)*offset;
    call->declare.element[call->declare.count++] = made;
    *offset += key_vertex_types[made.format].bytes;
    return lex_next(&parser->lex);
}

int parse_declare(struct parser *parser, struct call *call, unsigned word)
{
    struct lexer *lex = &parser->lex;
    (void)word;
    uint32_t next[TRIPTYCH_STREAMS] = {0}, stream = 0;
    while (lex->token.type != TOKEN_LINE_END && lex->token.type != TOKEN_END)
        if (lex_is_digits(lex)) {
            if (parse_integer(parser, "stream", TRIPTYCH_STREAMS - 1, &stream))
                return -1;
        } else if (parse_declared(parser, call, stream, &next[stream])) {
            return -1;
        }
    call->type = call_declare_type(&call->declare);
    return 0;
}

static const struct {
    const char *word;
    uint32_t mask, value;
} fvf_parts[] = {
#define FVF(word, mask, value, meaning) {#word, mask, value},
#include "def/state/fvf.def"
#undef FVF
};

enum { FVF_PARTS = sizeof fvf_parts / sizeof fvf_parts[0] };

int parse_fvf(struct parser *parser, struct call *call, unsigned word)
{
    struct lexer *lex = &parser->lex;
    (void)word;
    uint32_t given = 0;
    do {
        int i = 0;
        while (i < FVF_PARTS && !lex_is(lex, fvf_parts[i].word))
            i++;
        if (i == FVF_PARTS)
            return lex_expected_word(lex, WORDS_OF_ROWS(fvf_parts),
                                     "parts of a vertex format: xyz, normal, diffuse, tex1 and the like");
        if (given & fvf_parts[i].mask)
            return lex_expected(lex, "one part of its kind");
        given |= fvf_parts[i].mask;
        call->fvf.code |= fvf_parts[i].value;
        if (lex_next(lex))
            return -1;
    } while (lex->token.type != TOKEN_LINE_END && lex->token.type != TOKEN_END);
    return 0;
}
