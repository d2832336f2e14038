/* The calls that name surfaces of textures: attach and copy. */
#include "draw/surface.h"
#include "stream/check.h"
#include "stream/parse.h"

#include <string.h>

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

/* TEXTURE [level L] [slice S]: a surface that the call changes or reads. */
static int parse_surface(struct parser *parser, struct stream_surface *surface)
{
    if (parse_name(parser, 1 << RESOURCE_TEXTURE, "a texture", &surface->resource))
        return -1;
    return parse_option(parser, "level", &surface->level) || parse_option(parser, "slice", &surface->slice)
               ? -1
               : 0;
}

static void note_change(struct parser *parser, const struct stream_surface *surface)
{
    if (surface->resource != NO_RESOURCE)
        parser->stream->resources[surface->resource].changes = 1;
}

static int parse_attached(struct parser *parser, struct stream_surface *surface)
{
    if (lex_next(&parser->lex) || parse_surface(parser, surface))
        return -1;
    note_change(parser, surface);
    return 0;
}

/* Behind `color`: none where only targets behind it are drawn to. */
static int parse_color(struct parser *parser, struct stream_surface *surface)
{
    if (lex_next(&parser->lex))
        return -1;
    if (lex_is(&parser->lex, "none"))
        return lex_next(&parser->lex);
    if (parse_surface(parser, surface))
        return -1;
    note_change(parser, surface);
    return 0;
}

/* attach none, or attach [color SURFACE]... [depth SURFACE | depthformat FORMAT] */
int parse_attach(struct parser *parser, struct call *call)
{
    struct lexer *lex = &parser->lex;
    unsigned colors = 0, format;
    call->attach.depth.resource = NO_RESOURCE;
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        call->attach.color[t].resource = NO_RESOURCE;
    if (lex_is(lex, "none"))
        return lex_next(lex);
    call->attach.some = 1;
    while (lex_is(lex, "color") && colors < TRIPTYCH_TARGETS)
        if (parse_color(parser, &call->attach.color[colors++]))
            return -1;
    if (lex_is(lex, "depth"))
        return parse_attached(parser, &call->attach.depth);
    if (!colors)
        return lex_expected(lex, "none, color TEXTURE or depth TEXTURE");
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

/* The target is called that: `target [slice N]`, N being the number of one of its colours. */
static int parse_copy_end(struct parser *parser, struct stream_surface *surface,
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

int parse_copy(struct parser *parser, struct call *call)
{
    struct lexer *lex = &parser->lex;
    if (parse_copy_end(parser, &call->copy.surface[0], &call->copy.part[0]))
        return -1;
    if (!lex_is(lex, "to"))
        return lex_expected(lex, "level, slice, part, or to");
    if (lex_next(lex) || parse_copy_end(parser, &call->copy.surface[1], &call->copy.part[1]))
        return -1;
    note_change(parser, &call->copy.surface[1]);
    call->copy.filter = lex_is(lex, "linear") ? TRIPTYCH_COPY_LINEAR : TRIPTYCH_COPY_POINT;
    return call->copy.filter == TRIPTYCH_COPY_LINEAR ? lex_next(lex) : 0;
}

/* --- Following --------------------------------------------------------------------------------------------
 */

/* A texture without texels, for checks; a null one for the target. */
static struct triptych_surface shape_of(const struct stream *stream, const struct stream_surface *surface,
                                        struct triptych_texture *shape)
{
    struct triptych_surface r = {NULL, surface->level, surface->slice};
    if (surface->resource == NO_RESOURCE)
        return r;
    texture_describe(&stream->resources[surface->resource].texture, shape, NULL);
    r.texture = shape;
    return r;
}

int check_attach(const struct stream *stream, const struct call *call,
                 struct triptych_target_description *description, struct error *error)
{
    struct triptych_texture shape[TRIPTYCH_TARGETS + 1];
    struct triptych_target_textures textures = {.depth_format = call->attach.depth_format};
    for (int t = 0; t < TRIPTYCH_TARGETS; t++) {
        const struct stream_surface *color = call->attach.color;
        int first = 0; /* of the same texture */
        while (color[first].resource != color[t].resource)
            first++;
        textures.color[t] = shape_of(stream, &color[t], &shape[first]);
    }
    textures.depth = shape_of(stream, &call->attach.depth, &shape[TRIPTYCH_TARGETS]);
    return surfaces_describe(&textures, description, error) ? -1 : 0;
}

int check_copy(const struct stream *stream, const struct call *call,
               const struct triptych_target_description *target, struct error *error)
{
    struct triptych_texture shape[2];
    struct triptych_surface surface[2];
    struct surface_copy copy = {.filter = call->copy.filter};
    for (int i = 0; i < 2; i++) {
        surface[i] = shape_of(stream, &call->copy.surface[i], &shape[i]);
        copy.surface[i] = &surface[i];
        copy.part[i] = call->copy.part[i];
    }
    return surface_check_copy(&copy, target, error) ? -1 : 0;
}
