/* The calls of the text format: one function reads each, from behind its first word, and the table at the end
 * lists them. A call is appended to the stream when its line has ended well. */
#include "stream/parse.h"
#include "stream/skeleton.h"

#include "base/file.h"
#include "shader/program.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Names ------------------------------------------------------------------------------------------------
 */

static uint32_t hash_name(const char *name, size_t length)
{
    uint32_t hash = 2166136261; /* FNV-1a */
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)name[i]) * 16777619;
    return hash ^ hash >> 15;
}

/* The place of a name in the table, or the free place where it belongs. */
static uint32_t *find_place(const struct parser *parser, const char *name, size_t length)
{
    uint32_t mask = parser->name_places - 1;
    for (uint32_t i = hash_name(name, length) & mask;; i = (i + 1) & mask) {
        uint32_t number = parser->names[i];
        if (!number)
            return &parser->names[i];
        const char *other = parser->stream->resources[number - 1].name;
        if (strlen(other) == length && !memcmp(other, name, length))
            return &parser->names[i];
    }
}

static int grow_names(struct parser *parser)
{
    uint32_t *old = parser->names, places = parser->name_places;
    if (2 * (parser->stream->resource_count + 1) <= places)
        return 0;
    parser->names = calloc(places ? 2 * places : 64, sizeof *parser->names);
    if (!parser->names) {
        parser->names = old;
        return -1;
    }
    parser->name_places = places ? 2 * places : 64;
    for (uint32_t i = 0; i < places; i++)
        if (old[i]) {
            const char *name = parser->stream->resources[old[i] - 1].name;
            *find_place(parser, name, strlen(name)) = old[i];
        }
    free(old);
    return 0;
}

static int is_name(const struct token *token)
{
    if (token->type != TOKEN_WORD || token->length > LIMIT_NAME_BYTES)
        return 0;
    for (size_t i = 0; i < token->length; i++) {
        char c = token->text[i], letter = (char)(c | 32);
        int first = (letter >= 'a' && letter <= 'z') || c == '_';
        if (!first && (i == 0 || !((c >= '0' && c <= '9') || c == '-' || c == '.')))
            return 0;
    }
    return !(token->length == 4 && !memcmp(token->text, "none", 4));
}

static int grow(void **array, uint32_t count, uint32_t *capacity, size_t size)
{
    if (count < *capacity)
        return 0;
    void *larger = realloc(*array, (*capacity ? 2 * (size_t)*capacity : 16) * size);
    if (!larger)
        return -1;
    *array = larger;
    *capacity = *capacity ? 2 * *capacity : 16;
    return 0;
}

int parse_new_name(struct parser *parser, enum resource_type type, struct resource **resource)
{
    struct stream *stream = parser->stream;
    const struct token *token = &parser->lex.token;
    if (!is_name(token))
        return lex_expected(&parser->lex,
                            "a name: a letter or _, then letters, digits, _ - . (at most %d bytes)",
                            LIMIT_NAME_BYTES);
    if (stream->resource_count == LIMIT_NAMES)
        return lex_expected(&parser->lex, "at most %d names", LIMIT_NAMES);
    if (grow_names(parser) || grow((void **)&stream->resources, stream->resource_count,
                                   &parser->resource_capacity, sizeof **resource))
        return lex_fail(&parser->lex, token, "not enough memory");
    uint32_t *place = find_place(parser, token->text, token->length);
    if (*place)
        return lex_expected(&parser->lex, "a name that is not in use");
    struct resource *made = &stream->resources[stream->resource_count];
    *made = (struct resource){.type = type, .name = strndup(token->text, token->length)};
    if (!made->name)
        return lex_fail(&parser->lex, token, "not enough memory");
    *place = ++stream->resource_count;
    *resource = made;
    return lex_next(&parser->lex);
}

int parse_name(struct parser *parser, unsigned types, const char *what, uint32_t *resource)
{
    const struct token *token = &parser->lex.token;
    uint32_t number = 0;
    if (is_name(token) && parser->name_places)
        number = *find_place(parser, token->text, token->length);
    if (!number || !(types >> parser->stream->resources[number - 1].type & 1))
        return lex_expected(&parser->lex, "the name of %s defined before", what);
    *resource = number - 1;
    return lex_next(&parser->lex);
}

/* --- Sequences --------------------------------------------------------------------------------------------
 */

static uint32_t *executed_here(struct parser *parser)
{
    return parser->sequence == NO_RESOURCE ? &parser->executed
                                           : &parser->stream->resources[parser->sequence].executed;
}

static int parse_sequence(struct parser *parser, struct call *call)
{
    struct resource *sequence;
    if (parse_new_name(parser, RESOURCE_SEQUENCE, &sequence))
        return -1;
    sequence->call = parser->stream->call_count;
    sequence->depth = 1;
    parser->sequence = call->resource = parser->stream->resource_count - 1;
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
    struct stream *stream = parser->stream;
    const struct resource *sequence = &stream->resources[parser->sequence];
    stream->calls[sequence->call].sequence.count = stream->call_count - sequence->call - 1;
    parser->sequence = NO_RESOURCE;
    return 0;
}

static int parse_play(struct parser *parser, struct call *call)
{
    struct token place = parser->lex.token;
    if (parse_name(parser, 1 << RESOURCE_SEQUENCE, "a sequence", &call->resource))
        return -1;
    const struct resource *played = &parser->stream->resources[call->resource];
    if (call->resource == parser->sequence)
        return lex_fail(&parser->lex, &place, "found '%s' playing itself, expected a sequence that has ended",
                        played->name);
    if (parser->sequence != NO_RESOURCE) {
        struct resource *sequence = &parser->stream->resources[parser->sequence];
        if (sequence->depth < played->depth + 1)
            sequence->depth = played->depth + 1;
        if (sequence->depth > LIMIT_DEPTH)
            return lex_fail(&parser->lex, &place, "found sequences %u deep, expected at most %d",
                            sequence->depth, LIMIT_DEPTH);
    }
    *executed_here(parser) += played->executed;
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
    int inside = parser->sequence != NO_RESOURCE;
    return command->place == ANYWHERE || (command->place == END) == inside;
}

static int expect_command(struct parser *parser)
{
    char words[1024] = "";
    size_t at = 0;
    for (int i = 0; i < COMMANDS; i++)
        if (is_allowed(parser, &commands[i]))
            at += (size_t)snprintf(words + at, sizeof words - at, "%s%s", at ? ", " : "", commands[i].word);
    return lex_expected(&parser->lex, "a call%s: %s", parser->sequence == NO_RESOURCE ? "" : " of a sequence",
                        words);
}

int parse_add_call(struct parser *parser, const struct call *call, const struct token *place)
{
    struct stream *stream = parser->stream;
    if (stream->call_count == LIMIT_CALLS)
        return lex_fail(&parser->lex, place, "found one more call, expected at most %d", LIMIT_CALLS);
    if (grow((void **)&stream->calls, stream->call_count, &parser->call_capacity, sizeof *call))
        return lex_fail(&parser->lex, place, "not enough memory");
    stream->calls[stream->call_count++] = *call;
    if (call->type == CALL_SEQUENCE)
        return 0;
    /* Plays have added at most LIMIT_EXECUTED to at most as many: no overflow. */
    if (++*executed_here(parser) > LIMIT_EXECUTED)
        return lex_fail(&parser->lex, place, "found more calls with sequences played, expected at most %d",
                        LIMIT_EXECUTED);
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
    if (parser->sequence != NO_RESOURCE)
        return lex_expected(lex, "the end of sequence %s", parser->stream->resources[parser->sequence].name);
    return stream_expand(parser) ? -1 : stream_check(parser);
}

/* --- Streams ----------------------------------------------------------------------------------------------
 */

void stream_free(struct stream *stream)
{
    if (!stream)
        return;
    for (uint32_t i = 0; i < stream->resource_count; i++) {
        struct resource *resource = &stream->resources[i];
        free(resource->name);
        free(resource->path);
        free(resource->texels);
        free(resource->colors);
        for (unsigned face = 0; face < sizeof resource->face_path / sizeof *resource->face_path; face++)
            free(resource->face_path[face]);
        free(resource->vertices);
        free(resource->indices);
        skeleton_free(resource->skeleton);
        free(resource->code);
        program_release(resource->program);
    }
    free(stream->path);
    free(stream->resources);
    free(stream->calls);
    free(stream->executed);
    free(stream->frames);
    free(stream);
}

static int parse_in_locale(struct stream *stream, const char *text, size_t bytes, struct error *error)
{
    struct parser parser = {.stream = stream, .sequence = NO_RESOURCE};
    int result = lex_start(&parser.lex, stream->path, text, bytes, error);
    if (!result)
        result = parse_all(&parser);
    free(parser.names);
    return result;
}

int stream_parse(const char *path, const char *text, size_t bytes, struct stream **stream,
                 struct error *error)
{
    locale_t locale = newlocale(LC_NUMERIC_MASK, "C", NULL);
    struct stream *made = calloc(1, sizeof *made);
    int result = -1;
    *stream = NULL;
    if (made)
        made->path = strdup(path);
    if (!locale || !made || !made->path) {
        error_set(error, "%s: not enough memory", path);
    } else {
        locale_t before = uselocale(locale);
        result = parse_in_locale(made, text, bytes, error);
        uselocale(before);
    }
    if (locale)
        freelocale(locale);
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
