/* The calls of the text format: one function reads each, from behind its first word, and the table at the end
 * lists them. A call is appended to the stream when its line has ended well. */
#include "stream/check.h"
#include "stream/container.h"
#include "stream/parse.h"
#include "stream/skeleton.h"

#include "base/file.h"
#include "shader/program.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- Names ------------------------------------------------------------------------------------------------
 */

static int is_name(const struct token *token)
{
    return token->type == TOKEN_WORD && build_is_name(token->text, token->length);
}

int parse_new_name(struct parser *parser, enum resource_type type, struct resource **resource)
{
    const struct token *token = &parser->lex.token;
    struct error reason = {{0}};
    if (!is_name(token))
        return lex_expected(&parser->lex,
                            "a name: a letter or _, then letters, digits, _ - . (at most %d bytes)",
                            LIMIT_NAME_BYTES);
    if (build_resource(&parser->build, token->text, token->length, type, resource, &reason))
        return lex_fail(&parser->lex, token, "%s", reason.text);
    return lex_next(&parser->lex);
}

int parse_name(struct parser *parser, unsigned types, const char *what, uint32_t *resource)
{
    const struct token *token = &parser->lex.token;
    uint32_t number = is_name(token) ? build_find(&parser->build, token->text, token->length) : NO_RESOURCE;
    if (number == NO_RESOURCE || !(types >> parser->stream->resources[number].type & 1))
        return lex_expected(&parser->lex, "the name of %s defined before", what);
    *resource = number;
    return lex_next(&parser->lex);
}

/* --- Sequences --------------------------------------------------------------------------------------------
 */

static int parse_sequence(struct parser *parser, struct call *call)
{
    struct resource *sequence;
    if (parse_new_name(parser, RESOURCE_SEQUENCE, &sequence))
        return -1;
    call->resource = parser->stream->resource_count - 1;
    return 0;
}

static int parse_frame(struct parser *parser, struct call *call)
{
    (void)parser;
    (void)call;
    return 0;
}

static int parse_end(struct parser *parser)
{
    build_end(&parser->build);
    return 0;
}

static int parse_play(struct parser *parser, struct call *call)
{
    struct token place = parser->lex.token;
    struct error reason = {{0}};
    if (parse_name(parser, 1 << RESOURCE_SEQUENCE, "a sequence", &call->resource))
        return -1;
    if (build_play(&parser->build, call->resource, &reason))
        return lex_fail(&parser->lex, &place, "%s", reason.text);
    return 0;
}

/* --- Lines ------------------------------------------------------------------------------------------------
 */

/* OUTSIDE: not in a sequence. END: only in one. */
enum place { ANYWHERE, OUTSIDE, END };

static const struct command {
    const char *word;
    enum place place;
    enum call_type type;
    int (*parse)(struct parser *parser, struct call *call); /* null: */
    int (*define)(struct parser *parser);                   /* makes no call */
} commands[] = {
    {"target", ANYWHERE, CALL_TARGET, parse_target, NULL},
    {"viewport", ANYWHERE, CALL_VIEWPORT, parse_viewport, NULL},
    {"scissor", ANYWHERE, CALL_SCISSOR, parse_scissor, NULL},
    {"state", ANYWHERE, CALL_SET, parse_state, NULL},
    {"sampler", ANYWHERE, CALL_SET, parse_sampler, NULL},
    {"stage", ANYWHERE, CALL_SET, parse_stage, NULL},
    {"convention", ANYWHERE, CALL_CONVENTION, parse_convention, NULL},
    {"clipplane", ANYWHERE, CALL_CLIP_PLANE, parse_clip_plane, NULL},
    {"transform", ANYWHERE, CALL_TRANSFORM, parse_transform, NULL},
    {"pose", ANYWHERE, CALL_TRANSFORM, parse_pose, NULL},
    {"material", ANYWHERE, CALL_MATERIAL, parse_material, NULL},
    {"light", ANYWHERE, CALL_LIGHT, parse_light, NULL},
    {"bind", ANYWHERE, CALL_BIND_TEXTURE, parse_bind, NULL},
    {"declare", ANYWHERE, CALL_DECLARE, parse_declare, NULL},
    {"fvf", ANYWHERE, CALL_FVF, parse_fvf, NULL},
    {"frequency", ANYWHERE, CALL_FREQUENCY, parse_frequency, NULL},
    {"vertexshader", ANYWHERE, CALL_SHADER, parse_vertex_shader, NULL},
    {"pixelshader", ANYWHERE, CALL_SHADER, parse_pixel_shader, NULL},
    {"vertexconstant", ANYWHERE, CALL_CONSTANTS, parse_vertex_constants, NULL},
    {"pixelconstant", ANYWHERE, CALL_CONSTANTS, parse_pixel_constants, NULL},
    {"vertexinteger", ANYWHERE, CALL_CONSTANTS, parse_vertex_integers, NULL},
    {"pixelinteger", ANYWHERE, CALL_CONSTANTS, parse_pixel_integers, NULL},
    {"vertexboolean", ANYWHERE, CALL_CONSTANTS, parse_vertex_booleans, NULL},
    {"pixelboolean", ANYWHERE, CALL_CONSTANTS, parse_pixel_booleans, NULL},
    {"update", ANYWHERE, CALL_UPDATE, parse_update, NULL},
    {"mips", ANYWHERE, CALL_MIPS, parse_mips, NULL},
    {"texels", ANYWHERE, CALL_TEXELS, parse_texels, NULL},
    {"contents", ANYWHERE, CALL_CONTENTS, parse_contents, NULL},
    {"release", OUTSIDE, CALL_RELEASE, parse_release, NULL},
    {"attach", ANYWHERE, CALL_ATTACH, parse_attach, NULL},
    {"copy", ANYWHERE, CALL_COPY, parse_copy, NULL},
    {"clear", ANYWHERE, CALL_CLEAR, parse_clear, NULL},
    {"draw", ANYWHERE, CALL_DRAW, parse_draw, NULL},
    {"draw-indexed", ANYWHERE, CALL_DRAW_INDEXED, parse_primitives, NULL},
    {"begin-query", ANYWHERE, CALL_BEGIN_QUERY, parse_query_part, NULL},
    {"end-query", ANYWHERE, CALL_END_QUERY, parse_query_part, NULL},
    {"frame", ANYWHERE, CALL_FRAME, parse_frame, NULL},
    {"play", ANYWHERE, CALL_PLAY, parse_play, NULL},
    {"sequence", OUTSIDE, CALL_SEQUENCE, parse_sequence, NULL},
    {"texture", OUTSIDE, 0, NULL, parse_texture},
    {"vertices", OUTSIDE, 0, NULL, parse_vertices},
    {"indices", OUTSIDE, 0, NULL, parse_indices},
    {"buffer", OUTSIDE, 0, NULL, parse_buffer},
    {"mesh", OUTSIDE, 0, NULL, parse_mesh},
    {"shader", OUTSIDE, 0, NULL, parse_shader},
    {"query", OUTSIDE, 0, NULL, parse_query},
    {"end", END, 0, NULL, parse_end},
};

enum { COMMANDS = sizeof commands / sizeof *commands };

static int is_allowed(const struct parser *parser, const struct command *command)
{
    int inside = parser->build.sequence != NO_RESOURCE;
    return command->place == ANYWHERE || (command->place == END) == inside;
}

static int expect_command(struct parser *parser)
{
    char words[1024] = "";
    size_t at = 0;
    for (int i = 0; i < COMMANDS; i++)
        if (is_allowed(parser, &commands[i]))
            at += (size_t)snprintf(words + at, sizeof words - at, "%s%s", at ? ", " : "", commands[i].word);
    return lex_expected(&parser->lex, "a call%s: %s",
                        parser->build.sequence == NO_RESOURCE ? "" : " of a sequence", words);
}

int parse_add_call(struct parser *parser, const struct call *call, const struct token *place)
{
    struct error reason = {{0}};
    if (build_call(&parser->build, call, &reason))
        return lex_fail(&parser->lex, place, "%s", reason.text);
    return 0;
}

static int parse_line(struct parser *parser)
{
    struct lexer *lex = &parser->lex;
    struct token place = lex->token;
    const struct command *command = NULL;
    for (int i = 0; i < COMMANDS && !command; i++)
        if (lex_is(lex, commands[i].word) && is_allowed(parser, &commands[i]))
            command = &commands[i];
    if (!command)
        return expect_command(parser);
    struct call call = {
        .type = command->type, .line = place.line, .column = place.column, .resource = NO_RESOURCE};
    if (lex_next(lex))
        return -1;
    int result = command->define ? command->define(parser) : command->parse(parser, &call);
    if (result || lex_line_end(lex))
        return -1;
    return command->define ? 0 : parse_add_call(parser, &call, &place);
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
    if (parser->build.sequence != NO_RESOURCE)
        return lex_expected(lex, "the end of sequence %s",
                            parser->stream->resources[parser->build.sequence].name);
    if (!parser->build.executed)
        return lex_expected(lex, "at least one call");
    if (stream_expand(parser->stream, parser->build.executed, lex->error))
        return -1;
    if (!parser->stream->frame_count)
        return lex_expected(lex, "at least one call that is executed");
    return stream_check(parser->stream, lex->error);
}

/* --- Streams ----------------------------------------------------------------------------------------------
 */

void stream_free(struct stream *stream)
{
    if (!stream)
        return;
    for (uint32_t i = 0; i < stream->resource_count; i++)
        resource_free(&stream->resources[i]);
    if (stream->streamed)
        close(stream->descriptor);
    free(stream->path);
    free(stream->resources);
    free(stream->calls);
    free(stream->executed);
    free(stream->frames);
    free(stream);
}

static int parse_in_locale(struct stream *stream, const char *text, size_t bytes, struct error *error)
{
    struct parser parser = {.stream = stream};
    build_start(&parser.build, stream);
    int result = lex_start(&parser.lex, stream->path, text, bytes, error);
    if (!result)
        result = parse_all(&parser);
    build_free(&parser.build);
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

int stream_parse(const char *path, const char *text, size_t bytes, struct stream **stream,
                 struct error *error)
{
    *stream = NULL;
    if (chunk_is_container(text, bytes))
        return container_parse(path, text, bytes, 0, stream, error);
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

int stream_read(const char *path, struct stream **stream, struct error *error)
{
    char *text;
    size_t bytes;
    *stream = NULL;
    if (file_read(path, LIMIT_FILE_BYTES, &text, &bytes, error))
        return -1;
    int result = stream_parse(path, text, bytes, stream, error);
    free(text);
    return result;
}
