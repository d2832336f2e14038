/* Textures of the text format: their definitions, and the calls that change them.
 *
 * A definition ends up as one array of bytes in the texture's format, in the order of DDS files: face by
 * face, each with all its levels, each slice by slice, rows of texels or blocks without gaps. Contents that
 * are made (fill, checker, gradient) and colors are encoded into it, so that formats with fewer bits show
 * what is left of them. */
#include "render/texture/texture.h"
#include "command/assets/asset.h"
#include "command/stream/valid.h"
#include "command/assets/paint.h"
#include "command/text/parse.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* --- Images --------------------------------------------------------------------------------------------- */

/* Reads { color... }, exactly the expected number, into an array that the caller frees. */
static int parse_colors(struct parser *parser, size_t count, const char *item, uint32_t **colors)
{
    struct lexer *lex = &parser->lex;
    struct token place = lex->token;
    size_t at = 0;
    if (place.type != TOKEN_OPEN)
        return lex_expected(lex, "{");
    *colors = malloc(count * sizeof **colors);
    if (!*colors)
        return lex_fail(lex, &place, "not enough memory");
    if (lex_next(lex) || lex_skip_lines(lex))
        return -1;
    while (lex_is_value(lex)) {
        if (at == count)
            return lex_expected(lex, "at most %zu %ss", count, item);
        if (lex_color(lex, item, &(*colors)[at++]) || lex_skip_lines(lex))
            return -1;
    }
    if (lex->token.type != TOKEN_CLOSE)
        return lex_expected(lex, "%s or }", item);
    if (at != count)
        return lex_fail(lex, &place, "found %zu %ss, expected %zu", at, item, count);
    return lex_next(lex);
}

static int parse_image(struct parser *parser, struct resource *resource)
{
    struct lexer *lex = &parser->lex;
    int64_t width, height;
    uint32_t *colors = NULL;
    if (lex_integer(lex, "texture width", 1, TRIPTYCH_TEXTURE_MAXIMUM, &width) ||
        lex_integer(lex, "texture height", 1, TRIPTYCH_TEXTURE_MAXIMUM, &height))
        return -1;
    paint_describe_image(resource, (uint32_t)width, (uint32_t)height);
    if (parse_account(parser, &lex->token, resource->texel_bytes))
        return -1;
    int result = parse_colors(parser, (size_t)(width * height), "texel", &colors);
    resource->texels = (uint8_t *)colors;
    for (size_t i = 0; !result && i < resource->texel_bytes / 4; i++)
        colors[i] = paint_swap(colors[i]);
    return result;
}

int parse_texture_file(struct parser *parser, struct resource *resource, const struct token *place)
{
    struct triptych_texture shape;
    if (parse_load(parser, resource, resource->path, place, asset_load_texture))
        return -1;
    texture_describe(&resource->texture, &shape, NULL);
    return parse_account(parser, place, texture_storage_bytes(&shape));
}

static int parse_file(struct parser *parser, struct resource *resource)
{
    struct token place = parser->lex.token;
    return parse_path(parser, &resource->path) ? -1 : parse_texture_file(parser, resource, &place);
}

/* --- Sources -------------------------------------------------------------------------------------------- */

static int paint(struct parser *parser, struct resource *resource, const struct triptych_texture *shape)
{
    struct error reason = {{0}};
    if (paint_texture(resource, shape, &reason))
        return lex_fail(&parser->lex, &parser->lex.token, "%s", reason.text);
    return 0;
}

static int parse_empty(struct parser *parser, struct resource *resource, const struct triptych_texture *shape)
{
    (void)parser;
    (void)resource;
    (void)shape;
    return 0;
}

/* A word of pairs of hexadecimal digits. */
static int parse_hex(struct parser *parser, struct resource *resource, size_t *at)
{
    const struct token *token = &parser->lex.token;
    if (token->length % 2)
        return lex_expected(&parser->lex, "bytes: pairs of hexadecimal digits");
    if (token->length / 2 > resource->texel_bytes - *at)
        return lex_expected(&parser->lex, "at most %zu bytes", resource->texel_bytes);
    for (size_t i = 0; i < token->length; i += 2) {
        int high = lex_hexadecimal_digit(token->text[i]), low = lex_hexadecimal_digit(token->text[i + 1]);
        if (high < 0 || low < 0)
            return lex_expected(&parser->lex, "bytes: pairs of hexadecimal digits");
        resource->texels[(*at)++] = (uint8_t)(high << 4 | low);
    }
    return lex_next(&parser->lex) || lex_skip_lines(&parser->lex) ? -1 : 0;
}

static int parse_bytes(struct parser *parser, struct resource *resource, const struct triptych_texture *shape)
{
    struct lexer *lex = &parser->lex;
    struct token place = lex->token;
    size_t at = 0;
    (void)shape;
    if (place.type != TOKEN_OPEN)
        return lex_expected(lex, "{");
    if (lex_next(lex) || lex_skip_lines(lex))
        return -1;
    while (lex->token.type == TOKEN_WORD)
        if (parse_hex(parser, resource, &at))
            return -1;
    if (lex->token.type != TOKEN_CLOSE)
        return lex_expected(lex, "bytes or }");
    if (at != resource->texel_bytes)
        return lex_fail(lex, &place, "found %zu bytes, expected %zu", at, resource->texel_bytes);
    return lex_next(lex);
}

static int parse_colored(struct parser *parser, struct resource *resource,
                         const struct triptych_texture *shape)
{
    size_t count = 0;
    for (unsigned level = 0; level < paint_given_levels(resource, shape); level++)
        count += texture_level_count(&shape->level[level]);
    resource->color_count = (uint32_t)(count * shape->faces);
    if (parse_colors(parser, resource->color_count, "texel", &resource->colors))
        return -1;
    return paint(parser, resource, shape);
}

static int parse_fill(struct parser *parser, struct resource *resource, const struct triptych_texture *shape)
{
    resource->color_count = shape->faces * paint_given_levels(resource, shape);
    if (parse_colors(parser, resource->color_count, "color", &resource->colors))
        return -1;
    return paint(parser, resource, shape);
}

static int parse_checker(struct parser *parser, struct resource *resource,
                         const struct triptych_texture *shape)
{
    int64_t cell;
    if (lex_integer(&parser->lex, "side of a square", 1, TRIPTYCH_TEXTURE_MAXIMUM, &cell))
        return -1;
    resource->cell = (uint32_t)cell;
    resource->color_count = 2;
    resource->colors = calloc(2, sizeof *resource->colors);
    if (!resource->colors)
        return lex_fail(&parser->lex, &parser->lex.token, "not enough memory");
    if (lex_color(&parser->lex, "color", &resource->colors[0]) ||
        lex_color(&parser->lex, "color", &resource->colors[1]))
        return -1;
    return paint(parser, resource, shape);
}

static int parse_gradient(struct parser *parser, struct resource *resource,
                          const struct triptych_texture *shape)
{
    return paint(parser, resource, shape);
}

static int parse_face(struct parser *parser, struct resource *resource, const struct triptych_texture *shape,
                      unsigned number)
{
    struct token place = parser->lex.token;
    struct error reason = {{0}};
    if (parse_path(parser, &resource->face_path[number]))
        return -1;
    char *path = asset_path(parser->lex.path, resource->face_path[number]);
    int result = path ? asset_load_face(resource, shape, number, path, &reason)
                      : error_set(&reason, "not enough memory");
    free(path);
    return result ? lex_fail(&parser->lex, &place, "%s", reason.text) : 0;
}

static int parse_files(struct parser *parser, struct resource *resource, const struct triptych_texture *shape)
{
    if (paint_given_levels(resource, shape) > 1 || shape->depth > 1)
        return lex_expected(&parser->lex, "one level and one slice, or mips, for files");
    for (unsigned face = 0; face < shape->faces; face++)
        if (parse_face(parser, resource, shape, face))
            return -1;
    return 0;
}

static const struct maker {
    const char *word;
    enum texture_source source;
    int encodes; /* into the format, which must not be a compressed one */
    int (*parse)(struct parser *parser, struct resource *resource, const struct triptych_texture *shape);
} sources[] = {
    {"empty", TEXTURE_EMPTY, 0, parse_empty},       {"bytes", TEXTURE_BYTES, 0, parse_bytes},
    {"colors", TEXTURE_COLORS, 1, parse_colored},   {"fill", TEXTURE_FILL, 1, parse_fill},
    {"checker", TEXTURE_CHECKER, 1, parse_checker}, {"gradient", TEXTURE_GRADIENT, 1, parse_gradient},
    {"files", TEXTURE_FILES, 1, parse_files},
};

enum { SOURCES = sizeof sources / sizeof *sources };

static const char source_words[] = "empty, bytes, colors, fill, checker, gradient or files";

static int assemble_source(struct parser *parser, struct resource *resource,
                           const struct triptych_texture *shape)
{
    const struct maker *source = NULL;
    struct token place = parser->lex.token;
    for (int i = 0; i < SOURCES && !source; i++)
        if (lex_is(&parser->lex, sources[i].word))
            source = &sources[i];
    if (!source)
        return lex_expected_word(&parser->lex, WORDS_OF_ROWS(sources), "the contents: %s", source_words);
    if (source->encodes && shape->format->coding != CODING_PACKED)
        return lex_fail(&parser->lex, &place, "found '%s', expected empty or bytes for format %s",
                        source->word, shape->format->name);
    resource->source = source->source;
    return lex_next(&parser->lex) || source->parse(parser, resource, shape) ? -1 : 0;
}

/* --- Definitions ---------------------------------------------------------------------------------------- */

static int parse_side(struct parser *parser, const char *what, unsigned *side)
{
    int64_t value;
    if (lex_integer(&parser->lex, what, 1, TRIPTYCH_TEXTURE_MAXIMUM, &value))
        return -1;
    *side = (unsigned)value;
    return 0;
}

static int parse_sides(struct parser *parser, struct triptych_texture_description *texture)
{
    texture->depth = 1;
    if (parse_side(parser, "texture width", &texture->width))
        return -1;
    texture->height = texture->width;
    if (texture->type != TRIPTYCH_TEXTURE_CUBE && parse_side(parser, "texture height", &texture->height))
        return -1;
    return texture->type == TRIPTYCH_TEXTURE_VOLUME ? parse_side(parser, "texture depth", &texture->depth)
                                                    : 0;
}

/* [levels N] [mips], after the sides; with neither there is one level. */
static int parse_levels(struct parser *parser, struct resource *resource)
{
    int64_t levels = 1;
    int given = lex_is(&parser->lex, "levels");
    if (given && (lex_next(&parser->lex) || lex_integer(&parser->lex, "levels", 0, TEXTURE_LEVELS, &levels)))
        return -1;
    resource->mips = lex_is(&parser->lex, "mips");
    if (resource->mips && lex_next(&parser->lex))
        return -1;
    resource->texture.levels = resource->mips && !given ? 0 : (unsigned)levels;
    return 0;
}

static int allocate_texels(struct parser *parser, struct resource *resource,
                           const struct triptych_texture *shape, const struct token *place)
{
    for (unsigned level = 0; level < paint_given_levels(resource, shape); level++)
        resource->texel_bytes += shape->faces * texture_level_bytes(shape, level);
    if (parse_account(parser, place, texture_storage_bytes(shape)))
        return -1;
    resource->texels = calloc(resource->texel_bytes, 1);
    return resource->texels ? 0 : lex_fail(&parser->lex, place, "not enough memory");
}

static int parse_typed(struct parser *parser, struct resource *resource)
{
    struct lexer *lex = &parser->lex;
    struct triptych_texture shape;
    struct error reason = {{0}};
    struct token place = lex->token;
    unsigned type;
    if (parse_word(parser, WORDS_TEXTURETYPE, "a type of texture", &type))
        return -1;
    const struct format *format =
        lex->token.type == TOKEN_WORD ? format_named(lex->token.text, lex->token.length) : NULL;
    if (!format)
        return parse_expect_format(parser, 0, "the name of a format of Direct3D 9, without D3DFMT_");
    resource->texture.type = (enum triptych_texture_type)type;
    resource->texture.format = (enum triptych_surface_format)format->number;
    if (lex_next(lex) || parse_sides(parser, &resource->texture) || parse_levels(parser, resource))
        return -1;
    if (texture_describe(&resource->texture, &shape, &reason))
        return lex_fail(lex, &place, "%s", reason.text);
    if (allocate_texels(parser, resource, &shape, &place))
        return -1;
    return assemble_source(parser, resource, &shape);
}

int parse_texture(struct parser *parser)
{
    struct lexer *lex = &parser->lex;
    struct resource *resource;
    unsigned type;
    if (parse_new_name(parser, RESOURCE_TEXTURE, &resource))
        return -1;
    if (lex_is(lex, "file"))
        return lex_next(lex) ? -1 : parse_file(parser, resource);
    if (lex->token.type == TOKEN_WORD &&
        !word_value(WORDS_TEXTURETYPE, lex->token.text, lex->token.length, &type))
        return parse_typed(parser, resource);
    if (!lex_is_value(lex) || lex->token.text[0] > '9')
        return lex_expected_word(lex, word_list(WORDS_TEXTURETYPE),
                                 "file \"PATH\", WIDTH HEIGHT { color... }, 2d, cube or volume");
    return parse_image(parser, resource);
}

/* --- Calls ---------------------------------------------------------------------------------------------- */

static int parse_number(struct parser *parser, const char *what, uint32_t *number)
{
    int64_t value;
    if (lex_integer(&parser->lex, what, 0, TRIPTYCH_TEXTURE_MAXIMUM, &value))
        return -1;
    *number = (uint32_t)value;
    return 0;
}

static int parse_box(struct parser *parser, struct triptych_box *box)
{
    return parse_number(parser, "box x", &box->x) || parse_number(parser, "box y", &box->y) ||
                   parse_number(parser, "box z", &box->z) || parse_number(parser, "box width", &box->width) ||
                   parse_number(parser, "box height", &box->height) ||
                   parse_number(parser, "box depth", &box->depth)
               ? -1
               : 0;
}

int parse_update(struct parser *parser, struct call *call, unsigned word)
{
    struct lexer *lex = &parser->lex;
    (void)word;
    struct token place = lex->token;
    if (parse_name(parser, CALL_TEXTURES, "a texture", &call->resource))
        return -1;
    if (lex_is(lex, "face") && (lex_next(lex) || parse_number(parser, "face", &call->update.face)))
        return -1;
    if (lex_is(lex, "level") && (lex_next(lex) || parse_number(parser, "level", &call->update.level)))
        return -1;
    if (lex_is(lex, "box")) {
        if (lex_next(lex) || parse_box(parser, &call->update.box))
            return -1;
        if (!call->update.box.width)
            return lex_fail(lex, &place, "found a box without texels, expected at least one");
    }
    if (parse_name(parser, 1 << RESOURCE_BUFFER, "face, level, box, or a buffer", &call->update.source))
        return -1;
    struct error reason = {{0}};
    if (valid_update_bytes(parser->stream, call, &reason))
        return lex_fail(lex, &place, "%s", reason.text);
    return 0;
}
