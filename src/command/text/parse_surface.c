/* Images, and calls that name surfaces: attach and copy. */
#include "command/text/parse.h"

#include "command/stream/valid.h"
#include "render/target/surface.h"

#include <string.h>

/* --- Images --------------------------------------------------------------------------------------------- */

static int parse_image_samples(struct parser *parser, unsigned *samples)
{
    int64_t value;
    if (!lex_is(&parser->lex, "samples"))
        return 0;
    if (lex_next(&parser->lex) || lex_integer(&parser->lex, "samples per pixel", 1, 8, &value))
        return -1;
    *samples = (unsigned)value;
    return 0;
}

/* image NAME WIDTH HEIGHT FORMAT | depth FORMAT [samples N] */
int parse_new_image(struct parser *parser)
{
    struct triptych_image_description image = {.depth_format = TRIPTYCH_DEPTH_D32F_LOCKABLE};
    struct resource *resource;
    struct error reason = {""};
    int64_t width, height;
    unsigned depth;
    if (parse_new_name(parser, RESOURCE_IMAGE, &resource))
        return -1;
    struct token place = parser->lex.token;
    if (lex_integer(&parser->lex, "image width", 1, TRIPTYCH_TARGET_MAXIMUM, &width) ||
        lex_integer(&parser->lex, "image height", 1, TRIPTYCH_TARGET_MAXIMUM, &height))
        return -1;
    image.width = (unsigned)width;
    image.height = (unsigned)height;
    if (lex_is(&parser->lex, "depth")) {
        if (lex_next(&parser->lex) || parse_word(parser, WORDS_DEPTH, "a depth format", &depth))
            return -1;
        image.depth_format = (enum triptych_depth_format)depth;
    } else if (parse_color_format(parser, &image.format)) {
        return -1;
    }
    if (parse_image_samples(parser, &image.samples))
        return -1;
    if (image_check(&image, &reason) != TRIPTYCH_OK)
        return lex_fail(&parser->lex, &place, "%s", reason.text);
    resource->image = image;
    return parse_account(parser, &place, image_bytes(&image));
}

/* --- Calls --- */

static int parse_option(struct parser *parser, const char *word, uint32_t *number)
{
    int64_t value;
    if (!lex_is(&parser->lex, word))
        return 0;
    if (lex_next(&parser->lex) || lex_integer(&parser->lex, word, 0, TRIPTYCH_TEXTURE_MAXIMUM, &value))
        return -1;
    *number = (uint32_t)value;
    return 0;
}

/* Reads TEXTURE [level L] [slice S], or IMAGE. */
static int parse_surface(struct parser *parser, struct call_surface *surface)
{
    if (parse_name(parser, CALL_SURFACES, "a texture or an image", &surface->resource))
        return -1;
    return parse_option(parser, "level", &surface->level) || parse_option(parser, "slice", &surface->slice)
               ? -1
               : 0;
}

/* Reads the surface after `color`. `none` skips a colour before others. */
static int parse_color(struct parser *parser, struct call_surface *surface)
{
    if (lex_next(&parser->lex))
        return -1;
    if (lex_is(&parser->lex, "none"))
        return lex_next(&parser->lex);
    return parse_surface(parser, surface);
}

/* attach none, or attach [color SURFACE]... [depth SURFACE | depthformat FORMAT] */
int parse_attach(struct parser *parser, struct call *call, unsigned word)
{
    static const char *const words[] = {"none", "color", "depth"};
    struct lexer *lex = &parser->lex;
    unsigned colors = 0, format;
    (void)word;
    call->attach.depth.resource = NO_RESOURCE;
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        call->attach.color[t].resource = NO_RESOURCE;
    if (lex_is(lex, "none"))
        return lex_next(lex);
    call->attach.some = true;
    while (lex_is(lex, "color") && colors < TRIPTYCH_TARGETS)
        if (parse_color(parser, &call->attach.color[colors++]))
            return -1;
    if (lex_is(lex, "depth"))
        return lex_next(lex) ? -1 : parse_surface(parser, &call->attach.depth);
    if (!colors)
        return lex_expected_word(lex, WORDS_OF_ROWS(words), "none, color SURFACE or depth SURFACE");
    if (!lex_is(lex, "depthformat"))
        return 0;
    if (lex_next(lex) || parse_word(parser, WORDS_DEPTH, "a depth format", &format))
        return -1;
    call->attach.depth_format = (enum triptych_depth_format)format;
    return 0;
}

/* [part X Y WIDTH HEIGHT] */
static int parse_part(struct parser *parser, struct triptych_rectangle *part)
{
    int64_t n[4];
    if (!lex_is(&parser->lex, "part"))
        return 0;
    if (lex_next(&parser->lex))
        return -1;
    for (int i = 0; i < 4; i++)
        if (lex_integer(&parser->lex, "part X Y WIDTH HEIGHT", i < 2 ? 0 : 1, TRIPTYCH_TARGET_MAXIMUM, &n[i]))
            return -1;
    *part = (struct triptych_rectangle){(unsigned)n[0], (unsigned)n[1], (unsigned)n[2], (unsigned)n[3]};
    return 0;
}

/* Reads a surface, or `target [slice N]`, colour N of the target, and a part of it. */
static int parse_surface_part(struct parser *parser, struct call_surface *surface,
                              struct triptych_rectangle *part)
{
    surface->resource = NO_RESOURCE;
    if (lex_is(&parser->lex, "target")) {
        if (lex_next(&parser->lex) || parse_option(parser, "slice", &surface->slice))
            return -1;
    } else if (parse_surface(parser, surface)) {
        return -1;
    }
    return parse_part(parser, part);
}

int parse_copy(struct parser *parser, struct call *call, unsigned word)
{
    static const char *const words[] = {"level", "slice", "part", "to"};
    struct lexer *lex = &parser->lex;
    (void)word;
    if (parse_surface_part(parser, &call->copy.surface[0], &call->copy.part[0]))
        return -1;
    if (!lex_is(lex, "to"))
        return lex_expected_word(lex, WORDS_OF_ROWS(words), "level, slice, part, or to");
    if (lex_next(lex) || parse_surface_part(parser, &call->copy.surface[1], &call->copy.part[1]))
        return -1;
    call->copy.filter = lex_is(lex, "linear") ? TRIPTYCH_COPY_LINEAR : TRIPTYCH_COPY_POINT;
    return call->copy.filter == TRIPTYCH_COPY_LINEAR ? lex_next(lex) : 0;
}

/* format FORMAT */
static int parse_memory_format(struct parser *parser, enum triptych_surface_format *result)
{
    struct lexer *lex = &parser->lex;
    if (!lex_is(lex, "format"))
        return 0;
    if (lex_next(lex))
        return -1;
    const struct format *format =
        lex->token.type == TOKEN_WORD ? format_named(lex->token.text, lex->token.length) : NULL;
    if (!format)
        return parse_expect_format(parser, 0, "the name of a format of Direct3D 9, without D3DFMT_");
    *result = (enum triptych_surface_format)format->number;
    return lex_next(lex);
}

/* pixels SURFACE part X Y WIDTH HEIGHT [format FORMAT] BUFFER */
int parse_set_pixels(struct parser *parser, struct call *call, unsigned word)
{
    struct token place = parser->lex.token;
    struct error reason = {""};
    (void)word;
    if (parse_surface_part(parser, &call->set_pixels.surface, &call->set_pixels.part) ||
        parse_memory_format(parser, &call->set_pixels.format) ||
        parse_name(parser, CALL_BUFFERS, "level, slice, part, format, or a buffer", &call->set_pixels.source))
        return -1;
    if (valid_set_pixels(parser->stream, call, &reason))
        return lex_fail(&parser->lex, &place, "%s", reason.text);
    return 0;
}

/* fill SURFACE [part X Y WIDTH HEIGHT] color R G B A */
int parse_fill_surface(struct parser *parser, struct call *call, unsigned word)
{
    static const char *const words[] = {"level", "slice", "part", "color"};
    struct parse_field fields[] = {{"color", call->fill.color, 4, false}};
    (void)word;
    if (parse_surface_part(parser, &call->fill.surface, &call->fill.part) || parse_fields(parser, fields, 1))
        return -1;
    if (!fields[0].given)
        return lex_expected_word(&parser->lex, WORDS_OF_ROWS(words), "level, slice, part, or color");
    return 0;
}
