/* The calls of the text format: one function reads each, from behind its first word up to where its line
 * should end. What a call means is not looked at here beyond its own words and numbers; check.c does. */
#include "draw/format.h"
#include "stream/check.h"
#include "stream/parse.h"
#include "stream/skeleton.h"
#include "stream/transform.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Parts of calls ---------------------------------------------------------------------------------------
 */

int parse_word(struct parser *parser, enum word_list list, const char *what, unsigned *value)
{
    const struct token *token = &parser->lex.token;
    if (token->type == TOKEN_WORD && !word_value(list, token->text, token->length, value))
        return lex_next(&parser->lex);
    char choices[384];
    word_choices(list, choices, sizeof choices);
    return lex_expected(&parser->lex, "%s: %s", what, choices);
}

int parse_integer(struct parser *parser, const char *what, int64_t high, uint32_t *value)
{
    int64_t integer;
    if (lex_integer(&parser->lex, what, 0, high, &integer))
        return -1;
    *value = (uint32_t)integer;
    return 0;
}

/* A word followed by numbers, at most once in its call. */
struct field {
    const char *word;
    float *numbers;
    size_t count;
    int given;
};

/* Fields in any order up to the end of the line. */
static int parse_fields(struct parser *parser, struct field *fields, size_t count)
{
    struct lexer *lex = &parser->lex;
    while (lex->token.type != TOKEN_LINE_END && lex->token.type != TOKEN_END) {
        char choices[128] = "";
        size_t at = 0, i = 0;
        while (i < count && (fields[i].given || !lex_is(lex, fields[i].word)))
            i++;
        for (size_t j = 0; i == count && j < count; j++)
            if (!fields[j].given)
                at += (size_t)snprintf(choices + at, sizeof choices - at, "%s, ", fields[j].word);
        if (i == count)
            return lex_expected(lex, "%sor the end of the line", choices);
        fields[i].given = 1;
        if (lex_next(lex) || lex_numbers(lex, fields[i].word, fields[i].numbers, fields[i].count))
            return -1;
    }
    return 0;
}

/* --- Calls ------------------------------------------------------------------------------------------------
 */

static int parse_depth_format(struct parser *parser, struct triptych_target_description *target)
{
    unsigned format;
    if (lex_next(&parser->lex) || parse_word(parser, WORDS_DEPTH, "a depth format", &format))
        return -1;
    target->depth_format = (enum triptych_depth_format)format;
    return 0;
}

/* One to four. */
static int parse_color_formats(struct parser *parser, struct triptych_target_description *target)
{
    struct lexer *lex = &parser->lex;
    if (lex_next(lex))
        return -1;
    for (unsigned t = 0; t < TRIPTYCH_TARGETS; t++) {
        const struct format *format =
            lex->token.type == TOKEN_WORD ? format_named(lex->token.text, lex->token.length) : NULL;
        if (!format && t)
            return 0;
        if (!format || !(format->roles & ROLE_TARGET))
            return lex_expected(lex, "the name of a format that can be a target");
        target->color_format[t] = (enum triptych_surface_format)format->number;
        if (lex_next(lex))
            return -1;
    }
    return 0;
}

static int parse_samples(struct parser *parser, struct triptych_target_description *target)
{
    int64_t samples;
    struct token place = parser->lex.token;
    if (lex_next(&parser->lex) || lex_integer(&parser->lex, "samples per pixel", 1, 8, &samples))
        return -1;
    if (samples & (samples - 1))
        return lex_fail(&parser->lex, &place, "found %d samples, expected 1, 2, 4 or 8", (int)samples);
    target->samples = (unsigned)samples;
    return 0;
}

static int parse_target_formats(struct parser *parser, struct triptych_target_description *target)
{
    struct token place = parser->lex.token;
    if (lex_is(&parser->lex, "depth") && parse_depth_format(parser, target))
        return -1;
    if (lex_is(&parser->lex, "samples") && parse_samples(parser, target))
        return -1;
    if (lex_is(&parser->lex, "color") && parse_color_formats(parser, target))
        return -1;
    if (target->samples > 1 && target->color_format[1])
        return lex_fail(&parser->lex, &place, "found several colours, expected one with %u samples",
                        target->samples);
    return 0;
}

int parse_target(struct parser *parser, struct call *call)
{
    int64_t width, height;
    if (lex_integer(&parser->lex, "target width", 1, TRIPTYCH_TARGET_MAXIMUM, &width) ||
        lex_integer(&parser->lex, "target height", 1, TRIPTYCH_TARGET_MAXIMUM, &height))
        return -1;
    call->target.width = (unsigned)width;
    call->target.height = (unsigned)height;
    return parse_target_formats(parser, &call->target);
}

int parse_viewport(struct parser *parser, struct call *call)
{
    float v[6];
    if (lex_numbers(&parser->lex, "viewport X Y WIDTH HEIGHT NEAR FAR", v, 6))
        return -1;
    call->viewport = (struct triptych_viewport){v[0], v[1], v[2], v[3], v[4], v[5]};
    return 0;
}

int parse_scissor(struct parser *parser, struct call *call)
{
    return parse_integer(parser, "scissor x", TRIPTYCH_TARGET_MAXIMUM, &call->scissor.x) ||
                   parse_integer(parser, "scissor y", TRIPTYCH_TARGET_MAXIMUM, &call->scissor.y) ||
                   parse_integer(parser, "scissor width", TRIPTYCH_TARGET_MAXIMUM, &call->scissor.width) ||
                   parse_integer(parser, "scissor height", TRIPTYCH_TARGET_MAXIMUM, &call->scissor.height)
               ? -1
               : 0;
}

static int parse_row(struct parser *parser, enum triptych_state_table table, uint32_t *row)
{
    const struct triptych_state_row *state;
    for (*row = 0; (state = triptych_state_at(table, *row)); ++*row)
        if (lex_is(&parser->lex, state->name))
            return lex_next(&parser->lex);
    if (table == TRIPTYCH_RENDER_STATES)
        return lex_expected(&parser->lex, "the name of a state");
    return lex_expected(&parser->lex, "the name of a %s state", triptych_table_name(table));
}

/* The words of a state, as many as fit. */
static int expect_state_word(struct parser *parser, const struct triptych_state_row *state)
{
    const struct triptych_value *value;
    char choices[384] = "";
    size_t at = 0;
    for (unsigned i = 0; (value = triptych_value_at(state->kind, i)) && at < sizeof choices; i++)
        if (value->support == TRIPTYCH_SUPPORT_YES)
            at += (size_t)snprintf(choices + at, sizeof choices - at, "%s%s", at ? ", " : "", value->word);
    return lex_expected(&parser->lex, "a value of %s: %s", state->name, at ? choices : "a number");
}

static int parse_real(struct parser *parser, const char *what, uint32_t *value)
{
    float number;
    if (lex_number(&parser->lex, what, &number))
        return -1;
    *value = triptych_float_bits(number);
    return 0;
}

/* A word of the state, eight hexadecimal digits, or a number; whether the state takes the number is checked
 * with the state. */
static int parse_value(struct parser *parser, const struct triptych_state_row *state, uint32_t *value)
{
    struct lexer *lex = &parser->lex;
    char word[LIMIT_NAME_BYTES + 1];
    if (state->kind->notation == TRIPTYCH_NOTATION_REAL)
        return parse_real(parser, state->name, value);
    if (lex->token.type != TOKEN_WORD || lex->token.length > LIMIT_NAME_BYTES)
        return expect_state_word(parser, state);
    memcpy(word, lex->token.text, lex->token.length);
    word[lex->token.length] = 0;
    if (!triptych_value_number(state->kind, word, value))
        return lex_next(lex);
    if (word[0] == '0' && (word[1] | 32) == 'x')
        return lex_color(lex, state->name, value);
    if (word[0] >= '0' && word[0] <= '9')
        return parse_integer(parser, state->name, UINT32_MAX, value);
    return expect_state_word(parser, state);
}

static int parse_table(struct parser *parser, enum triptych_state_table table, struct call *call)
{
    call->set.table = table;
    call->set.i = 0;
    if (table != TRIPTYCH_RENDER_STATES &&
        parse_integer(parser, triptych_table_name(table), triptych_table_size(table) - 1, &call->set.i))
        return -1;
    if (parse_row(parser, table, &call->set.row))
        return -1;
    return parse_value(parser, triptych_state_at(table, call->set.row), &call->set.value);
}

int parse_clip_plane(struct parser *parser, struct call *call)
{
    if (parse_integer(parser, "clip plane", TRIPTYCH_CLIP_PLANES - 1, &call->clip_plane.index))
        return -1;
    return lex_numbers(&parser->lex, "clipplane I A B C D", call->clip_plane.plane, 4);
}

int parse_convention(struct parser *parser, struct call *call)
{
    unsigned which, value;
    if (parse_word(parser, WORDS_CONVENTION, "a convention", &which) ||
        parse_word(parser, WORDS_PIXEL_CENTER + which, "its value", &value))
        return -1;
    call->convention.which = (enum triptych_convention)which;
    call->convention.value = value;
    return 0;
}

int parse_state(struct parser *parser, struct call *call)
{
    return parse_table(parser, TRIPTYCH_RENDER_STATES, call);
}

int parse_sampler(struct parser *parser, struct call *call)
{
    return parse_table(parser, TRIPTYCH_SAMPLER_STATES, call);
}

int parse_stage(struct parser *parser, struct call *call)
{
    return parse_table(parser, TRIPTYCH_STAGE_STATES, call);
}

int parse_operation(struct parser *parser, double made[4][4])
{
    struct lexer *lex = &parser->lex;
    const struct transform_operation *operation;
    struct token place = lex->token;
    double arguments[TRANSFORM_ARGUMENTS_MAXIMUM];
    size_t i = 0;
    while ((operation = transform_operation(i)) && !lex_is(lex, operation->word))
        i++;
    if (!operation)
        return lex_expected(
            lex, "identity, matrix, translate, scale, rotate, lookat, perspective or orthographic");
    if (lex_next(lex))
        return -1;
    for (size_t a = 0; a < operation->count; a++)
        if (lex_double(lex, operation->word, &arguments[a]))
            return -1;
    const char *expected = operation->make(arguments, made);
    if (expected)
        return lex_fail(lex, &place, "found another '%s', expected %s", operation->word, expected);
    return 0;
}

int parse_round(struct parser *parser, const struct token *place, double matrix[4][4], float out[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            out[i][j] = (float)matrix[i][j];
            if (!isfinite(out[i][j]))
                return lex_fail(&parser->lex, place,
                                "found a matrix with infinite values, expected finite ones");
        }
    return 0;
}

/* The number of a texture's matrix, and of a world matrix other than the first: what is added to the
 * transform. */
static int parse_transform_number(struct parser *parser, unsigned which, uint32_t *number)
{
    const struct token *token = &parser->lex.token;
    int given = token->type == TOKEN_WORD && token->text[0] >= '0' && token->text[0] <= '9';
    if (which == TRIPTYCH_TRANSFORM_TEXTURE0)
        return parse_integer(parser, "texture matrix", 7, number);
    if (which != TRIPTYCH_TRANSFORM_WORLD || !given)
        return 0;
    if (parse_integer(parser, "world matrix", 255, number))
        return -1;
    if (*number)
        *number += TRIPTYCH_TRANSFORM_WORLD1 - 1;
    return 0;
}

/* The product of the operations up to the end of the line. The first matrix is not multiplied by the
 * identity, which would lose the sign of its zeros. */
static int parse_operations(struct parser *parser, double matrix[4][4])
{
    struct lexer *lex = &parser->lex;
    double next[4][4];
    if (parse_operation(parser, matrix))
        return -1;
    for (int count = 1; lex->token.type != TOKEN_LINE_END && lex->token.type != TOKEN_END; count++) {
        if (count == LIMIT_OPERATIONS)
            return lex_expected(lex, "at most %d operations", LIMIT_OPERATIONS);
        if (parse_operation(parser, next))
            return -1;
        transform_multiply(matrix, next, matrix);
    }
    return 0;
}

int parse_transform_name(struct parser *parser, enum triptych_transform *which)
{
    unsigned word;
    uint32_t number = 0;
    if (parse_word(parser, WORDS_TRANSFORM, "a transform", &word) ||
        parse_transform_number(parser, word, &number))
        return -1;
    *which = (enum triptych_transform)(word + number);
    return 0;
}

int parse_transform(struct parser *parser, struct call *call)
{
    double matrix[4][4];
    if (parse_transform_name(parser, &call->transform.which))
        return -1;
    struct token place = parser->lex.token;
    if (parse_operations(parser, matrix))
        return -1;
    return parse_round(parser, &place, matrix, call->transform.matrix);
}

/* As many transforms as the mesh has bones; the last is left in `call`. */
static int add_pose(struct parser *parser, const struct skeleton *skeleton, double (*matrices)[4][4],
                    double world[4][4], const struct token *place, struct call *call)
{
    for (uint32_t b = 0; b < skeleton->bone_count; b++) {
        transform_multiply(matrices[b], world, matrices[b]);
        call->transform.which =
            (enum triptych_transform)(b ? TRIPTYCH_TRANSFORM_WORLD1 + b - 1 : TRIPTYCH_TRANSFORM_WORLD);
        if (parse_round(parser, place, matrices[b], call->transform.matrix) ||
            (b + 1 < skeleton->bone_count && parse_add_call(parser, call, place)))
            return -1;
    }
    return 0;
}

static int parse_animation(struct parser *parser, const struct skeleton *skeleton, int *animation)
{
    struct token place = parser->lex.token;
    char *name;
    if (lex_string(&parser->lex, "the name of an animation", &name))
        return -1;
    *animation = skeleton_find(skeleton, name);
    free(name);
    if (*animation < 0)
        return lex_fail(&parser->lex, &place,
                        "found an animation that the mesh does not have, expected %s%s%s",
                        skeleton->animation_count ? "\"" : "one with animations",
                        skeleton->animation_count ? skeleton->animations[0].name : "",
                        skeleton->animation_count ? "\"" : "");
    return 0;
}

int parse_pose(struct parser *parser, struct call *call)
{
    struct lexer *lex = &parser->lex;
    struct token place = lex->token;
    double time, world[4][4];
    uint32_t mesh;
    int animation;
    if (parse_name(parser, 1 << RESOURCE_MESH, "a mesh", &mesh))
        return -1;
    const struct skeleton *skeleton = parser->stream->resources[mesh].skeleton;
    if (!skeleton)
        return lex_fail(lex, &place, "found a mesh without bones, expected one with");
    if (parse_animation(parser, skeleton, &animation) || lex_double(lex, "time", &time))
        return -1;
    if (lex->token.type == TOKEN_LINE_END || lex->token.type == TOKEN_END)
        transform_operation(0)->make(NULL, world);
    else if (parse_operations(parser, world))
        return -1;
    double(*matrices)[4][4] = malloc(skeleton->bone_count * sizeof *matrices);
    if (!matrices || skeleton_pose(skeleton, (uint32_t)animation, time, matrices)) {
        free(matrices);
        return lex_fail(lex, &place, "not enough memory");
    }
    int result = add_pose(parser, skeleton, matrices, world, &place, call);
    free(matrices);
    return result;
}

int parse_material(struct parser *parser, struct call *call)
{
    call->material = stream_default_material;
    struct field fields[] = {{"diffuse", call->material.diffuse, 4, 0},
                             {"ambient", call->material.ambient, 4, 0},
                             {"emissive", call->material.emissive, 4, 0},
                             {"specular", call->material.specular, 4, 0},
                             {"power", &call->material.power, 1, 0}};
    return parse_fields(parser, fields, 5);
}

/* Those of the fields whose bit is set; there are no more than a light has. */
static int parse_chosen_fields(struct parser *parser, const struct field *fields, unsigned chosen)
{
    struct field left[16];
    size_t count = 0;
    for (unsigned i = 0; chosen >> i; i++)
        if (chosen >> i & 1)
            left[count++] = fields[i];
    return parse_fields(parser, left, count);
}

int parse_light(struct parser *parser, struct call *call)
{
    struct lexer *lex = &parser->lex;
    struct triptych_light *light = &call->light.value;
    struct field fields[] = {{"diffuse", light->diffuse, 4, 0},
                             {"ambient", light->ambient, 4, 0},
                             {"specular", light->specular, 4, 0},
                             {"direction", light->direction, 3, 0},
                             {"position", light->position, 3, 0},
                             {"range", &light->range, 1, 0},
                             {"attenuation", light->attenuation, 3, 0},
                             {"theta", &light->theta, 1, 0},
                             {"phi", &light->phi, 1, 0},
                             {"falloff", &light->falloff, 1, 0}};
    static const struct {
        const char *word;
        unsigned fields; /* that it has */
    } types[] = {{"directional", 0x00f}, {"point", 0x077}, {"spot", 0x3ff}};
    if (parse_integer(parser, "light", TRIPTYCH_LIGHTS - 1, &call->light.index))
        return -1;
    *light = stream_default_light;
    for (unsigned type = 0; type < sizeof types / sizeof *types; type++)
        if (lex_is(lex, types[type].word)) {
            light->type = (enum triptych_light_type)type;
            return lex_next(lex) ? -1 : parse_chosen_fields(parser, fields, types[type].fields);
        }
    if (!lex_is(lex, "on") && !lex_is(lex, "off"))
        return lex_expected(lex, "directional, point, spot, on or off");
    call->type = CALL_ENABLE_LIGHT;
    call->light.on = lex_is(lex, "on");
    return lex_next(lex);
}

enum {
    TEXTURES = 1 << RESOURCE_TEXTURE,
    MESHES = 1 << RESOURCE_MESH,
    DRAWABLES = 1 << RESOURCE_VERTICES | MESHES,
    INDICES = 1 << RESOURCE_INDICES | 1 << RESOURCE_BUFFER | MESHES,
    ELEMENTS = 1 << RESOURCE_VERTICES | 1 << RESOURCE_BUFFER | MESHES
};

int parse_name_or_none(struct parser *parser, unsigned types, const char *what, uint32_t *resource)
{
    if (lex_is(&parser->lex, "none"))
        return lex_next(&parser->lex);
    return parse_name(parser, types, what, resource);
}

/* The first sampler's number may be left out. */
static int bind_texture(struct parser *parser, struct call *call)
{
    struct lexer *lex = &parser->lex;
    int64_t sampler = 0;
    if (lex->token.type == TOKEN_WORD && isdigit((unsigned char)*lex->token.text) &&
        lex_integer(lex, "sampler", 0, TRIPTYCH_SAMPLERS - 1, &sampler))
        return -1;
    call->sampler = (uint32_t)sampler;
    return parse_name_or_none(parser, TEXTURES, "a texture, or none,", &call->resource);
}

static int bind_vertices(struct parser *parser, struct call *call)
{
    return parse_name(parser, DRAWABLES, "vertices or a mesh", &call->resource);
}

/* What the bytes of a buffer are as indices. */
static int parse_bits(struct parser *parser, uint32_t *bits)
{
    *bits = lex_is(&parser->lex, "16") ? 16 : 32;
    if (*bits == 32 && !lex_is(&parser->lex, "32"))
        return lex_expected(&parser->lex, "16 or 32 bits");
    return lex_next(&parser->lex);
}

static int bind_indices(struct parser *parser, struct call *call)
{
    struct token place = parser->lex.token;
    if (parse_name_or_none(parser, INDICES, "indices, a mesh, a buffer of u16 or u32, or none,",
                           &call->resource))
        return -1;
    if (call->resource == NO_RESOURCE)
        return 0;
    const struct resource *resource = &parser->stream->resources[call->resource];
    if (resource->type == RESOURCE_BUFFER && resource->value_type == VALUE_BYTES)
        return parse_bits(parser, &call->index_bits);
    if (!resource->indices)
        return lex_fail(&parser->lex, &place, "found a buffer of other values, expected one of u16 or u32");
    return 0;
}

/* OFFSET STRIDE, multiples of `step`. */
static int parse_place(struct parser *parser, uint32_t step, uint32_t *offset, uint32_t *stride)
{
    struct lexer *lex = &parser->lex;
    for (int i = 0; i < 2; i++) {
        struct token place = lex->token;
        uint32_t *value = i ? stride : offset;
        if (parse_integer(parser, i ? "stride" : "offset", i ? 65536 : INT32_MAX, value))
            return -1;
        if (*value % step)
            return lex_fail(lex, &place, "found '%u', expected a multiple of %u", *value, step);
    }
    return 0;
}

static int bind_stream(struct parser *parser, struct call *call)
{
    if (parse_integer(parser, "stream", TRIPTYCH_STREAMS - 1, &call->bind_stream.number) ||
        parse_name_or_none(parser, ELEMENTS, "a buffer, vertices or a mesh, or none,", &call->resource))
        return -1;
    if (call->resource == NO_RESOURCE)
        return 0;
    return parse_place(parser, 4, &call->bind_stream.offset, &call->bind_stream.stride);
}

static int bind_element(struct parser *parser, struct call *call)
{
    struct lexer *lex = &parser->lex;
    unsigned attribute, format;
    struct token place = lex->token;
    if (parse_word(parser, WORDS_ATTRIBUTE, "an attribute", &attribute))
        return -1;
    if (attribute >= TRIPTYCH_ATTRIBUTE_COUNT)
        return lex_fail(lex, &place,
                        "found '%s', expected an attribute, or declare for what only shaders read",
                        word_text(WORDS_ATTRIBUTE, attribute));
    call->element.attribute = (enum triptych_attribute)attribute;
    call->element.format = TRIPTYCH_FORMAT_NONE;
    if (lex_is(lex, "none"))
        return lex_next(lex);
    if (parse_word(parser, WORDS_FORMAT, "a format, or none", &format) ||
        parse_name(parser, ELEMENTS, "a buffer, vertices or a mesh", &call->resource))
        return -1;
    call->element.format = (enum triptych_format)format;
    return parse_place(parser, 1, &call->element.offset, &call->element.stride);
}

int parse_bind(struct parser *parser, struct call *call)
{
    static const struct {
        const char *word;
        enum call_type type;
        int (*parse)(struct parser *parser, struct call *call);
    } rows[] = {{"texture", CALL_BIND_TEXTURE, bind_texture},
                {"vertices", CALL_BIND_VERTICES, bind_vertices},
                {"indices", CALL_BIND_INDICES, bind_indices},
                {"element", CALL_BIND_ELEMENT, bind_element},
                {"stream", CALL_BIND_STREAM, bind_stream}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (lex_is(&parser->lex, rows[i].word)) {
            call->type = rows[i].type;
            return lex_next(&parser->lex) ? -1 : rows[i].parse(parser, call);
        }
    return lex_expected(&parser->lex, "texture, vertices, indices, element or stream");
}

/* Numbers all; the stencil's value is a whole one, whatever its bits keep of it. */
int parse_clear(struct parser *parser, struct call *call)
{
    float stencil = 0;
    struct token place = parser->lex.token;
    struct field fields[] = {
        {"color", call->clear.color, 4, 0}, {"depth", &call->clear.depth, 1, 0}, {"stencil", &stencil, 1, 0}};
    if (parse_fields(parser, fields, 3))
        return -1;
    call->clear.flags = (fields[0].given ? TRIPTYCH_CLEAR_COLOR : 0) |
                        (fields[1].given ? TRIPTYCH_CLEAR_DEPTH : 0) |
                        (fields[2].given ? TRIPTYCH_CLEAR_STENCIL : 0);
    if (!call->clear.flags)
        return lex_expected(&parser->lex, "color R G B A, depth D, stencil S, or several of them");
    if (!(stencil >= 0 && stencil <= 255 && stencil == floorf(stencil)))
        return lex_fail(&parser->lex, &place, "found stencil %g, expected an integer from 0 to 255",
                        (double)stencil);
    call->clear.stencil = (uint32_t)stencil;
    return 0;
}

int parse_texels(struct parser *parser, struct call *call)
{
    if (parse_name(parser, TEXTURES, "a texture", &call->resource) ||
        parse_name(parser, 1 << RESOURCE_BUFFER, "a buffer", &call->texels.source))
        return -1;
    stream_note_changes(parser->stream, call);
    return 0;
}

int parse_contents(struct parser *parser, struct call *call)
{
    return parse_name(parser, 1 << RESOURCE_BUFFER, "a buffer", &call->resource);
}

int parse_release(struct parser *parser, struct call *call)
{
    return parse_name(parser, ~(1u << RESOURCE_SEQUENCE), "a resource that is no sequence", &call->resource);
}

int parse_query_part(struct parser *parser, struct call *call)
{
    return parse_name(parser, 1 << RESOURCE_QUERY, "a query", &call->resource);
}

int parse_primitives(struct parser *parser, struct call *call)
{
    unsigned primitive;
    int64_t base = 0;
    const char *what = call->type == CALL_DRAW_INDEXED ? "a primitive" : "a primitive, or mesh NAME";
    if (parse_word(parser, WORDS_PRIMITIVE, what, &primitive))
        return -1;
    if (call->type == CALL_DRAW_INDEXED &&
        lex_integer(&parser->lex, "base vertex", INT32_MIN, INT32_MAX, &base))
        return -1;
    call->draw.primitive = (enum triptych_primitive)primitive;
    call->draw.base = (int32_t)base;
    if (parse_integer(parser, "first", UINT32_MAX, &call->draw.first))
        return -1;
    return parse_integer(parser, "count of primitives", UINT32_MAX, &call->draw.count);
}

int parse_draw(struct parser *parser, struct call *call)
{
    if (!lex_is(&parser->lex, "mesh"))
        return parse_primitives(parser, call);
    call->type = CALL_DRAW_MESH;
    return lex_next(&parser->lex) ? -1 : parse_name(parser, MESHES, "a mesh", &call->resource);
}
