/* The lines of the text: calls, definitions and sequences. A call is appended to the stream after its line
 * was read without an error. */
#include "command/stream/expand.h"
#include "command/stream/follow.h"
#include "command/stream/functions.h"
#include "command/text/parse.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Names ---------------------------------------------------------------------------------------------- */

static bool is_name(const struct token *token)
{
    return token->type == TOKEN_WORD && stream_build_is_name(token->text, token->length);
}

int parse_new_name(struct parser *parser, enum resource_type type, struct resource **resource)
{
    const struct token *token = &parser->lex.token;
    struct error reason = {{0}};
    if (!is_name(token))
        return lex_expected(&parser->lex,
                            "a name: a letter or _, then letters, digits, _ - . (at most %d bytes)",
                            LIMIT_NAME_BYTES);
    if (stream_build_resource(&parser->build, token->text, token->length, type, resource, &reason))
        return lex_fail(&parser->lex, token, "%s", reason.text);
    return lex_next(&parser->lex);
}

/* The names of resources of some types, a mask of 1 << type. */
static const char *name_choice(const struct words *words, unsigned index)
{
    const struct stream *stream = words->list;
    if (index >= stream->resource_count)
        return NULL;
    const struct resource *resource = stream->resources + index;
    return words->count >> resource->type & 1 ? resource->name : "";
}

int parse_name(struct parser *parser, unsigned types, const char *what, uint32_t *resource)
{
    const struct token *token = &parser->lex.token;
    uint32_t number =
        is_name(token) ? stream_build_find(&parser->build, token->text, token->length) : NO_RESOURCE;
    if (number == NO_RESOURCE || !(types >> parser->stream->resources[number].type & 1))
        return lex_expected_word(&parser->lex,
                                 (struct words){.at = name_choice, .list = parser->stream, .count = types},
                                 "the name of %s defined before", what);
    *resource = number;
    return lex_next(&parser->lex);
}

/* --- Sequences ------------------------------------------------------------------------------------------ */

int parse_sequence(struct parser *parser, struct call *call, unsigned word)
{
    struct resource *sequence;
    (void)word;
    if (parse_new_name(parser, RESOURCE_SEQUENCE, &sequence))
        return -1;
    call->resource = parser->stream->resource_count - 1;
    parser->sequence_variables = parser->scope.variable_count;
    return 0;
}

/* The end of the innermost repeat, or else of the sequence. */
static int parse_end(struct parser *parser)
{
    if (parser->repeat_count)
        return parse_end_repeat(parser);
    stream_build_end(&parser->build);
    parser->scope.variable_count = parser->sequence_variables;
    return lex_line_end(&parser->lex);
}

int parse_play(struct parser *parser, struct call *call, unsigned word)
{
    struct token place = parser->lex.token;
    struct error reason = {{0}};
    (void)word;
    if (parse_name(parser, 1 << RESOURCE_SEQUENCE, "a sequence", &call->resource))
        return -1;
    if (stream_build_play(&parser->build, call->resource, &reason))
        return lex_fail(&parser->lex, &place, "%s", reason.text);
    return 0;
}

/* --- Lines ---------------------------------------------------------------------------------------------- */

enum place { OUTSIDE, INSIDE, EVERYWHERE }; /* of sequences and repeats */

/* Lines that are not calls. */
static const struct definition {
    const char *word;
    enum place place;
    int (*parse)(struct parser *parser);
} definitions[] = {
    {"texture", OUTSIDE, parse_texture},  {"vertices", OUTSIDE, parse_vertices},
    {"indices", OUTSIDE, parse_indices},  {"buffer", OUTSIDE, parse_buffer},
    {"mesh", OUTSIDE, parse_mesh},        {"model", OUTSIDE, parse_model},
    {"shader", OUTSIDE, parse_shader},    {"query", OUTSIDE, parse_query},
    {"image", OUTSIDE, parse_new_image},  {"let", EVERYWHERE, parse_let},
    {"repeat", EVERYWHERE, parse_repeat}, {"end", INSIDE, parse_end},
};

enum { DEFINITIONS = sizeof definitions / sizeof *definitions };

static bool is_inside(const struct parser *parser)
{
    return parser->build.sequence != NO_RESOURCE;
}

static bool allows_definition(const struct parser *parser, const struct definition *definition)
{
    bool inside = is_inside(parser) || parser->repeat_count;
    return definition->place == EVERYWHERE || definition->place == (inside ? INSIDE : OUTSIDE);
}

static bool allows_call(const struct parser *parser, const struct call_row *row, unsigned type)
{
    if (type == CALL_SEQUENCE && parser->repeat_count)
        return false;
    return !(row->traits & CALL_SHARES_LINE) && !(row->traits & CALL_OUTSIDE && is_inside(parser));
}

/* Word number `i` among those that begin the lines of a type of calls; null if there is none, or not here. */
static const char *call_line_word(const struct parser *parser, unsigned type, unsigned i)
{
    const struct call_row *row = call_row(type);
    const char *const *words = calls_functions[type].words;
    if (!row || !allows_call(parser, row, type))
        return NULL;
    if (!words[0])
        return i ? NULL : row->word;
    return i < STREAM_WORDS ? words[i] : NULL;
}

/* The words that begin lines here: STREAM_WORDS places for each type of calls, then the definitions. */
static const char *line_choice(const struct words *words, unsigned index)
{
    const struct parser *parser = words->list;
    unsigned type = index / STREAM_WORDS, definition = index - CALL_TYPES * STREAM_WORDS;
    if (type >= CALL_TYPES)
        return definition >= DEFINITIONS                             ? NULL
               : allows_definition(parser, definitions + definition) ? definitions[definition].word
                                                                     : "";
    const char *word = call_line_word(parser, type, index % STREAM_WORDS);
    return word ? word : "";
}

static int expect_line(struct parser *parser)
{
    struct words words = {.at = line_choice, .list = parser};
    char choices[1024];
    words_join(words, choices, sizeof choices);
    const char *where = parser->repeat_count ? " of a repeat" : is_inside(parser) ? " of a sequence" : "";
    return lex_expected_word(&parser->lex, words, "a call%s: %s", where, choices);
}

int parse_add_call(struct parser *parser, const struct call *call, const struct token *place)
{
    struct error reason = {{0}};
    if (stream_build_call(&parser->build, call, &reason))
        return lex_fail(&parser->lex, place, "%s", reason.text);
    return 0;
}

static int parse_call(struct parser *parser, enum call_type type, unsigned word)
{
    struct token place = parser->lex.token;
    struct call call = {.type = type, .resource = NO_RESOURCE};
    call.position.text.line = place.line;
    call.position.text.column = place.column;
    if (lex_next(&parser->lex))
        return -1;
    int result = calls_functions[type].parse ? calls_functions[type].parse(parser, &call, word)
                                             : parse_regular(parser, &call, 0);
    return result || lex_line_end(&parser->lex) ? -1 : parse_add_call(parser, &call, &place);
}

static int parse_line(struct parser *parser)
{
    struct lexer *lex = &parser->lex;
    const char *word;
    parser->scope.builtin[EXPRESSION_frame] = parser->build.frames;
    parser->scope.known[EXPRESSION_frame] = !is_inside(parser);
    for (int i = 0; i < DEFINITIONS; i++)
        if (lex_is(lex, definitions[i].word) && allows_definition(parser, &definitions[i]))
            return lex_next(lex) || definitions[i].parse(parser) ||
                           (definitions[i].place == OUTSIDE && lex_line_end(lex))
                       ? -1
                       : 0;
    for (unsigned type = 0; type < CALL_TYPES; type++)
        for (unsigned i = 0; (word = call_line_word(parser, type, i)); i++)
            if (lex_is(lex, word))
                return parse_call(parser, (enum call_type)type, i);
    return expect_line(parser);
}

static int parse_header(struct parser *parser)
{
    struct lexer *lex = &parser->lex;
    if (!lex_is(lex, "triptych"))
        return lex_expected(lex, "the first line: triptych 1");
    if (lex_next(lex))
        return -1;
    if (!lex_is(lex, "1"))
        return lex_expected(lex, "version 1 of the format");
    return lex_next(lex) ? -1 : lex_line_end(lex);
}

static int parse_all(struct parser *parser)
{
    struct lexer *lex = &parser->lex;
    if (parse_header(parser) || lex_skip_lines(lex))
        return -1;
    while (lex->token.type != TOKEN_END)
        if (parse_line(parser) || lex_skip_lines(lex))
            return -1;
    if (parser->repeat_count)
        return lex_expected(lex, "the end of the repeat of line %u",
                            parser->repeats[parser->repeat_count - 1].place.line);
    if (parser->build.sequence != NO_RESOURCE)
        return lex_expected(lex, "the end of sequence %s",
                            parser->stream->resources[parser->build.sequence].name);
    if (!parser->build.executed)
        return lex_expected(lex, "at least one call");
    if (stream_expand(parser->stream, parser->build.executed, lex->error))
        return -1;
    if (!parser->stream->frame_count)
        return lex_expected(lex, "at least one call that is executed");
    return follower_check(parser->stream, lex->error);
}

/* --- Streams -------------------------------------------------------------------------------------------- */

static int parse_in_locale(struct stream *stream, const char *text, size_t bytes, struct error *error)
{
    struct parser parser = {.stream = stream};
    stream_build_start(&parser.build, stream);
    expression_start(&parser.scope);
    int result = lex_start(&parser.lex, stream->path, text, bytes, error);
    parser.lex.scope = &parser.scope;
    if (!result)
        result = parse_all(&parser);
    stream_build_free(&parser.build);
    return result;
}

static int parse_text(struct stream *stream, const char *text, size_t bytes, struct error *error)
{
    locale_t locale = newlocale(LC_NUMERIC_MASK, "C", NULL);
    if (!locale)
        return error_set(error, "%s: not enough memory", stream->path);
    locale_t before = uselocale(locale);
    int result = parse_in_locale(stream, text, bytes, error);
    uselocale(before);
    freelocale(locale);
    return result;
}

int parse_stream(const char *path, const char *text, size_t bytes, struct stream **stream,
                 struct error *error)
{
    struct stream *made = calloc(1, sizeof *made);
    int result = -1;
    if (made)
        made->path = strdup(path);
    if (made && made->path)
        result = parse_text(made, text, bytes, error);
    else
        error_set(error, "%s: not enough memory", path);
    if (result)
        stream_free(made);
    else
        *stream = made;
    return result;
}
