#include "render/target/surface.h"

#include "base/minmax.h"

#include <stdio.h>
#include <stdlib.h>

/* The level of the surface's texture. */
static const struct texture_level *surface_level(const struct triptych_surface *surface)
{
    return surface->texture->level + surface->level;
}

static unsigned slices(const struct triptych_surface *surface)
{
    return surface->texture->type == TRIPTYCH_TEXTURE_CUBE ? CUBE_FACES
                                                           : (unsigned)surface_level(surface)->depth;
}

/* Fails if the surface is a texture's and an image, or if the texture does not have the level and slice. The
 * reason names it `what`. */
static enum triptych_result surface_check(const struct triptych_surface *surface, const char *what,
                                          struct error *error)
{
    if (surface->image && surface->texture)
        error_set(error, "%s: a texture and an image, expected one of them", what);
    else if (surface->image)
        return TRIPTYCH_OK;
    else if (surface->level >= surface->texture->levels)
        error_set(error, "%s: level %u of a texture with %u", what, surface->level, surface->texture->levels);
    else if (surface->slice >= slices(surface))
        error_set(error, "%s: slice %u of a level with %u", what, surface->slice, slices(surface));
    else
        return TRIPTYCH_OK;
    return TRIPTYCH_BAD_ARGUMENT;
}

/* The face of the surface's texture, and the slice of its level. */
static unsigned surface_face(const struct triptych_surface *surface)
{
    return surface->texture->type == TRIPTYCH_TEXTURE_CUBE ? surface->slice : 0;
}

static unsigned surface_slice(const struct triptych_surface *surface)
{
    return surface->texture->type == TRIPTYCH_TEXTURE_CUBE ? 0 : surface->slice;
}

static struct texture_image surface_texels(const struct triptych_surface *surface)
{
    return texture_slice(surface->texture, surface_face(surface), surface->level, surface_slice(surface));
}

/* --- Shapes --- */

/* The properties of a surface that a target depends on. */
struct shape {
    const struct format *format;             /* null: depth that is not a texture's */
    enum triptych_depth_format depth_format; /* NONE: a colour */
    uint32_t width, height, samples;
};

static struct shape shape_of(const struct triptych_surface *surface)
{
    if (surface->image) {
        const struct triptych_image_description *d = &surface->image->description;
        return (struct shape){format_find(d->format), d->format ? TRIPTYCH_DEPTH_NONE : d->depth_format,
                              d->width, d->height, d->samples ? d->samples : 1};
    }
    const struct texture_level *level = surface_level(surface);
    const struct format *format = surface->texture->format;
    enum triptych_depth_format depth =
        format->roles & ROLE_DEPTH ? (enum triptych_depth_format)format->depth : TRIPTYCH_DEPTH_NONE;
    return (struct shape){format, depth, (uint32_t)level->width, (uint32_t)level->height, 1};
}

enum triptych_result image_check(const struct triptych_image_description *d, struct error *error)
{
    const struct format *format = format_find(d->format);
    if (!d->width || !d->height || d->width > TARGET_SIZE_MAXIMUM || d->height > TARGET_SIZE_MAXIMUM)
        error_set(error, "image of %u x %u pixels: expected 1 to %d a side", d->width, d->height,
                  TARGET_SIZE_MAXIMUM);
    else if (samples_exponent(d->samples) < 0)
        error_set(error, "%u samples per pixel: expected 1, 2, 4 or 8", d->samples);
    else if (!d->format && (unsigned)d->depth_format >= TRIPTYCH_DEPTH_COUNT)
        error_set(error, "depth format %u: expected 0 to %u", (unsigned)d->depth_format,
                  TRIPTYCH_DEPTH_COUNT - 1);
    else if (!d->format && !depth_formats[d->depth_format].depth_bits)
        error_set(error, "image without a format: expected one of a colour or one of depth");
    else if (d->format && !format)
        error_set(error, "format %u of an image: expected one of Direct3D 9's", (unsigned)d->format);
    else if (!d->format || format->roles & ROLE_TARGET)
        return TRIPTYCH_OK;
    else {
        error_set(error, "format %s of an image: expected one that can be a target", format->name);
        return TRIPTYCH_UNSUPPORTED;
    }
    return TRIPTYCH_BAD_ARGUMENT;
}

size_t image_bytes(const struct triptych_image_description *d)
{
    const struct format *format = format_find(d->format);
    size_t words = format ? storage_planes[format->target] : 1;
    return words * sizeof(uint32_t) * d->width * d->height * (d->samples ? d->samples : 1);
}

/* --- A target's description --- */

/* The target has the pixels that all colours have. */
static enum triptych_result match(const struct shape *shape, const char *what,
                                  struct triptych_target_description *description, struct error *error)
{
    if (!description->width) {
        description->width = shape->width;
        description->height = shape->height;
        description->samples = shape->samples;
    }
    if (shape->samples != description->samples) {
        error_set(error, "%s with %u samples per pixel: expected %u, the number of the others", what,
                  shape->samples, description->samples);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    description->width = min_u32(description->width, shape->width);
    description->height = min_u32(description->height, shape->height);
    return TRIPTYCH_OK;
}

static enum triptych_result check_role(const struct shape *shape, const char *what, bool depth,
                                       struct error *error)
{
    if (depth ? shape->depth_format != TRIPTYCH_DEPTH_NONE
              : shape->format && shape->format->roles & ROLE_TARGET)
        return TRIPTYCH_OK;
    error_set(error, "%s: format %s cannot be drawn to", what,
              shape->format ? shape->format->name : depth_formats[shape->depth_format].name);
    return TRIPTYCH_UNSUPPORTED;
}

static enum triptych_result describe_color(const struct triptych_surface *surface, unsigned t,
                                           struct triptych_target_description *description,
                                           struct error *error)
{
    char what[32];
    snprintf(what, sizeof what, "colour target %u", t);
    enum triptych_result result = surface_check(surface, what, error);
    if (result != TRIPTYCH_OK)
        return result;
    struct shape shape = shape_of(surface);
    result = check_role(&shape, what, false, error);
    if (result != TRIPTYCH_OK)
        return result;
    description->color_format[t] = (enum triptych_surface_format)shape.format->number;
    return match(&shape, what, description, error);
}

/* Depth has at least the pixels of the colours. */
static enum triptych_result describe_depth(const struct triptych_surface *surface,
                                           struct triptych_target_description *description,
                                           struct error *error)
{
    enum triptych_result result = surface_check(surface, "depth target", error);
    if (result != TRIPTYCH_OK)
        return result;
    struct shape shape = shape_of(surface);
    result = check_role(&shape, "depth target", true, error);
    if (result != TRIPTYCH_OK)
        return result;
    description->depth_format = shape.depth_format;
    if (shape.width >= description->width && shape.height >= description->height)
        return match(&shape, "depth target", description, error);
    error_set(error, "depth target of %u x %u pixels: expected at least %u x %u, the size of the colours",
              shape.width, shape.height, description->width, description->height);
    return TRIPTYCH_BAD_ARGUMENT;
}

static bool same_surface(const struct triptych_surface *a, const struct triptych_surface *b)
{
    return surface_is_given(a) && a->image == b->image && a->texture == b->texture &&
           (a->image || (a->level == b->level && a->slice == b->slice));
}

/* A pixel that is drawn to in two tiles would keep what one of them has. */
static enum triptych_result check_distinct(const struct triptych_surface *color, struct error *error)
{
    for (unsigned b = 1; b < TARGETS; b++)
        for (unsigned a = 0; a < b; a++)
            if (same_surface(&color[a], &color[b])) {
                error_set(error, "colour targets %u and %u: the same surface, expected another one", a, b);
                return TRIPTYCH_BAD_ARGUMENT;
            }
    return TRIPTYCH_OK;
}

enum triptych_result surfaces_describe(const struct triptych_target_surfaces *surfaces,
                                       struct triptych_target_description *description, struct error *error)
{
    enum triptych_result result = TRIPTYCH_OK;
    *description = (struct triptych_target_description){.depth_format = surfaces->depth_format,
                                                        .color_format = {TRIPTYCH_SURFACE_NULL}};
    for (unsigned t = 0; t < TARGETS && result == TRIPTYCH_OK; t++)
        if (surface_is_given(&surfaces->color[t]))
            result = describe_color(&surfaces->color[t], t, description, error);
    if (result == TRIPTYCH_OK)
        result = check_distinct(surfaces->color, error);
    if (result == TRIPTYCH_OK && surface_is_given(&surfaces->depth))
        result = describe_depth(&surfaces->depth, description, error);
    if (result == TRIPTYCH_OK && !description->width) {
        error_set(error, "no surface to draw to: expected at least one");
        return TRIPTYCH_BAD_ARGUMENT;
    }
    return result;
}

bool surfaces_include(const struct triptych_target_surfaces *surfaces, const struct triptych_texture *texture)
{
    bool includes = surfaces->depth.texture == texture;
    for (unsigned t = 0; t < TARGETS; t++)
        includes |= surfaces->color[t].texture == texture;
    return texture && includes;
}

bool surfaces_include_image(const struct triptych_target_surfaces *surfaces,
                            const struct triptych_image *image)
{
    bool includes = surfaces->depth.image == image;
    for (unsigned t = 0; t < TARGETS; t++)
        includes |= surfaces->color[t].image == image;
    return image && includes;
}

/* --- Attachments --- */

static struct drawn_surface *find_drawn(const struct triptych_surface *surface)
{
    struct drawn_surface *drawn = surface->texture->drawn;
    while (drawn && (drawn->level != surface->level || drawn->slice != surface->slice))
        drawn = drawn->next;
    return drawn;
}

struct attachment *surface_attachment(const struct triptych_surface *surface)
{
    if (surface->image)
        return surface->image->attachment;
    const struct drawn_surface *drawn = find_drawn(surface);
    return drawn ? drawn->attachment : NULL;
}

struct attachment *surface_make_attachment(const struct triptych_surface *surface, struct error *error)
{
    struct attachment *a = surface_attachment(surface);
    if (a || surface->image)
        return a;
    struct drawn_surface *drawn = malloc(sizeof *drawn);
    if (!drawn) {
        error_set(error, "out of memory for a target");
        return NULL;
    }
    struct shape s = shape_of(surface);
    a = s.depth_format != TRIPTYCH_DEPTH_NONE
            ? attachment_create_depth(s.depth_format, s.width, s.height, 1, error)
            : attachment_create_color(s.format, s.width, s.height, 1, error);
    if (!a) {
        free(drawn);
        return NULL;
    }
    a->texels_newer = true;
    *drawn = (struct drawn_surface){surface->texture->drawn, surface->level, surface->slice, a};
    surface->texture->drawn = drawn;
    return a;
}

void surface_free_attachments(struct triptych_texture *texture)
{
    for (struct drawn_surface *drawn = texture->drawn, *next; drawn; drawn = next) {
        next = drawn->next;
        attachment_release(drawn->attachment);
        free(drawn);
    }
    texture->drawn = NULL;
}

/* --- Pixels --- */

enum triptych_result surface_find_form(const struct triptych_surface *surface, const char *what,
                                       const struct triptych_target_description *target,
                                       struct surface_form *form, struct error *error)
{
    if (surface_is_given(surface)) {
        enum triptych_result result = surface_check(surface, what, error);
        if (result != TRIPTYCH_OK)
            return result;
        struct shape shape = shape_of(surface);
        bool depth = shape.depth_format != TRIPTYCH_DEPTH_NONE;
        *form =
            (struct surface_form){depth ? NULL : shape.format, shape.depth_format, shape.width, shape.height};
        return TRIPTYCH_OK;
    }
    if (target->width && surface->slice < TARGETS && target_format(target, surface->slice)) {
        *form = (struct surface_form){target_format(target, surface->slice), TRIPTYCH_DEPTH_NONE,
                                      target->width, target->height};
        return TRIPTYCH_OK;
    }
    error_set(error, "%s: colour target %u: the target has none of that number", what, surface->slice);
    return TRIPTYCH_BAD_ARGUMENT;
}

struct pixels surface_pixels(const struct triptych_surface *surface, const struct surface_form *form,
                             struct attachment *tiles)
{
    struct pixels pixels = {form->format, form->depth_format, form->width, form->height, tiles, false, {0}};
    if (surface->texture && !tiles)
        pixels.image = surface_texels(surface);
    return pixels;
}

/* The blocks of a compressed texture that contain texels of the part. */
static struct triptych_box block_box(const struct triptych_surface *surface,
                                     const struct triptych_rectangle *part)
{
    const struct texture_level *level = surface_level(surface);
    unsigned side = surface->texture->format->side;
    struct triptych_box box = {.x = part->x / side * side, .y = part->y / side * side, .depth = 1};
    box.z = surface_slice(surface);
    box.width = min_u32((part->x + part->width + side - 1) / side * side, (uint32_t)level->width) - box.x;
    box.height = min_u32((part->y + part->height + side - 1) / side * side, (uint32_t)level->height) - box.y;
    return box;
}

void surface_close_texels(const struct triptych_surface *surface, const struct triptych_rectangle *part)
{
    struct triptych_texture *texture = surface->texture;
    struct triptych_box box = block_box(surface, part);
    if (texture->blocks)
        texture_compress(texture, surface_face(surface), surface->level, &box);
    texture_close_rows(texture, surface_face(surface), surface->level, box.z, box.y, box.height);
}

/* --- Transfers --- */

/* Without memory nothing is known, and every changed tile is stored. */
static struct stored_clear *stored_clears(struct attachment *a)
{
    if (!a->stored)
        a->stored = calloc((size_t)a->columns * a->rows, sizeof *a->stored);
    return a->stored;
}

void surface_begin_transfer(const struct triptych_surface *surface, bool store,
                            struct surface_transfer *transfer)
{
    struct attachment *a = surface_attachment(surface);
    *transfer = (struct surface_transfer){
        .store = store,
        .attachment = attachment_retain(a),
        .memory = attachment_memory_retain(a->memory),
        .plane = a->plane,
        .image = surface_texels(surface),
        .stored = stored_clears(a),
    };
}

void surface_end_transfer(struct surface_transfer *transfer)
{
    attachment_release(transfer->attachment);
    attachment_memory_release(transfer->memory);
}
