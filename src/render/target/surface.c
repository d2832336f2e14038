#include "render/target/surface.h"

#include <stdio.h>
#include <string.h>

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

/* Fails if the texture does not have the surface's level and slice. The reason names it `what`. */
static enum triptych_result surface_check(const struct triptych_surface *surface, const char *what,
                                          struct error *error)
{
    if (surface->level >= surface->texture->levels)
        error_set(error, "%s: level %u of a texture with %u", what, surface->level, surface->texture->levels);
    else if (surface->slice >= slices(surface))
        error_set(error, "%s: slice %u of a level with %u", what, surface->slice, slices(surface));
    else
        return TRIPTYCH_OK;
    return TRIPTYCH_BAD_ARGUMENT;
}

/* The surface's first texel. */
static void *surface_texels(const struct triptych_surface *surface)
{
    const struct triptych_texture *texture = surface->texture;
    bool cube = texture->type == TRIPTYCH_TEXTURE_CUBE;
    uint8_t *first = texture_level_texels(texture, cube ? surface->slice : 0, surface->level);
    size_t slice = cube ? 0 : (size_t)surface->slice * (size_t)surface_level(surface)->slice_texels;
    return first + slice * format_texel_bytes(texture->format);
}

/* --- A target's description --- */

static enum triptych_result match_size(const struct triptych_surface *surface, const char *what,
                                       struct triptych_target_description *description, struct error *error)
{
    const struct texture_level *level = surface_level(surface);
    if (!description->width) {
        description->width = (unsigned)level->width;
        description->height = (unsigned)level->height;
    }
    if ((unsigned)level->width == description->width && (unsigned)level->height == description->height)
        return TRIPTYCH_OK;
    error_set(error, "%s of %d x %d texels: expected %u x %u, the size of the others", what, level->width,
              level->height, description->width, description->height);
    return TRIPTYCH_BAD_ARGUMENT;
}

static enum triptych_result describe_one(const struct triptych_surface *surface, const char *what, int role,
                                         struct triptych_target_description *description, struct error *error)
{
    enum triptych_result result = surface_check(surface, what, error);
    if (result != TRIPTYCH_OK)
        return result;
    if (!(surface->texture->format->roles & role)) {
        error_set(error, "%s: format %s cannot be drawn to", what, surface->texture->format->name);
        return TRIPTYCH_UNSUPPORTED;
    }
    return match_size(surface, what, description, error);
}

static enum triptych_result describe_colors(const struct triptych_target_textures *textures,
                                            struct triptych_target_description *description,
                                            struct error *error)
{
    enum triptych_result result = TRIPTYCH_OK;
    for (unsigned t = 0; t < TARGETS && result == TRIPTYCH_OK; t++) {
        const struct triptych_surface *surface = textures->color + t;
        char what[32];
        snprintf(what, sizeof what, "colour target %u", t);
        if (!surface->texture)
            continue;
        result = describe_one(surface, what, ROLE_TARGET, description, error);
        description->color_format[t] = (enum triptych_surface_format)surface->texture->format->number;
    }
    if (!textures->color[0].texture)
        description->color_format[0] = TRIPTYCH_SURFACE_NULL;
    return result;
}

/* A texel that is drawn to in two tiles would keep what one of them has. */
static enum triptych_result check_distinct(const struct triptych_target_textures *textures,
                                           struct error *error)
{
    const struct triptych_surface *color = textures->color;
    for (unsigned b = 1; b < TARGETS; b++)
        for (unsigned a = 0; a < b; a++)
            if (color[b].texture && color[a].texture == color[b].texture &&
                color[a].level == color[b].level && color[a].slice == color[b].slice) {
                error_set(error, "colour targets %u and %u: the same surface, expected another one", a, b);
                return TRIPTYCH_BAD_ARGUMENT;
            }
    return TRIPTYCH_OK;
}

enum triptych_result surfaces_describe(const struct triptych_target_textures *textures,
                                       struct triptych_target_description *description, struct error *error)
{
    *description = (struct triptych_target_description){.depth_format = textures->depth_format};
    enum triptych_result result = describe_colors(textures, description, error);
    if (result == TRIPTYCH_OK)
        result = check_distinct(textures, error);
    if (result == TRIPTYCH_OK && textures->depth.texture) {
        result = describe_one(&textures->depth, "depth target", ROLE_DEPTH, description, error);
        description->depth_format = (enum triptych_depth_format)textures->depth.texture->format->depth;
    }
    if (result == TRIPTYCH_OK && !description->width) {
        error_set(error, "no texture to draw to: expected at least one");
        return TRIPTYCH_BAD_ARGUMENT;
    }
    return result;
}

bool surfaces_include(const struct triptych_target_textures *textures, const struct triptych_texture *texture)
{
    bool includes = textures->depth.texture == texture;
    for (unsigned t = 0; t < TARGETS; t++)
        includes |= textures->color[t].texture == texture;
    return texture && includes;
}

/* --- Copies --- */

enum triptych_result surface_size(const struct triptych_surface *surface, const char *what,
                                  const struct triptych_target_description *target, uint32_t size[2],
                                  struct error *error)
{
    size[0] = target->width;
    size[1] = target->height;
    if (surface->texture) {
        enum triptych_result result = surface_check(surface, what, error);
        if (result != TRIPTYCH_OK)
            return result;
        size[0] = (uint32_t)surface_level(surface)->width;
        size[1] = (uint32_t)surface_level(surface)->height;
        return TRIPTYCH_OK;
    }
    if (target->width && surface->slice < TARGETS && target_format(target, surface->slice))
        return TRIPTYCH_OK;
    error_set(error, "%s: colour target %u: the target has none of that number", what, surface->slice);
    return TRIPTYCH_BAD_ARGUMENT;
}

static enum triptych_result check_part(const char *what, const uint32_t size[2],
                                       const struct triptych_rectangle *part, struct error *error)
{
    if (!part->width || (part->height && part->x < size[0] && part->y < size[1] &&
                         part->width <= size[0] - part->x && part->height <= size[1] - part->y))
        return TRIPTYCH_OK;
    error_set(error, "%s: %u x %u pixels at %u, %u: expected a part of %u x %u", what, part->width,
              part->height, part->x, part->y, size[0], size[1]);
    return TRIPTYCH_BAD_ARGUMENT;
}

/* Only colour is copied, and only to surfaces that can be drawn to. */
static enum triptych_result check_copied_formats(const struct surface_copy *copy, struct error *error)
{
    const struct triptych_texture *from = copy->surface[0]->texture, *to = copy->surface[1]->texture;
    if (from && from->format->roles & ROLE_DEPTH)
        error_set(error, "source of a copy: format %s is one of depth", from->format->name);
    else if (to && !(to->format->roles & ROLE_TARGET))
        error_set(error, "target of a copy: format %s cannot be drawn to", to->format->name);
    else
        return TRIPTYCH_OK;
    return TRIPTYCH_UNSUPPORTED;
}

enum triptych_result surface_check_copy(const struct surface_copy *copy,
                                        const struct triptych_target_description *target, struct error *error)
{
    static const char *const what[2] = {"source of a copy", "target of a copy"};
    if ((unsigned)copy->filter >= TRIPTYCH_COPY_COUNT) {
        error_set(error, "filter %u of a copy: expected point (0) or linear (1)", (unsigned)copy->filter);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    for (int i = 0; i < 2; i++) {
        uint32_t size[2];
        enum triptych_result result = surface_size(copy->surface[i], what[i], target, size, error);
        if (result == TRIPTYCH_OK)
            result = check_part(what[i], size, &copy->part[i], error);
        if (result != TRIPTYCH_OK)
            return result;
    }
    return check_copied_formats(copy, error);
}

/* --- Texels and tiles --- */

static void load_depth(const struct triptych_surface *surface, struct target *target)
{
    const float *texel = surface_texels(surface);
    size_t gap = 4 * (size_t)(surface_level(surface)->pitch - surface_level(surface)->width);
    for (uint32_t y = 0; y < target->height; y++, texel += gap)
        for (uint32_t x = 0; x < target->width; x++, texel += 4)
            *target_depth_word(target, x, y) = depth_encode(target->depth_format, *texel);
}

static void store_depth(const struct triptych_surface *surface, const struct target *target)
{
    const struct texture_level *level = surface_level(surface);
    float *first = surface_texels(surface), *texel = first;
    for (uint32_t y = 0; y < target->height; y++, texel += 4 * (level->pitch - level->width))
        for (uint32_t x = 0; x < target->width; x++, texel += 4) {
            float depth = depth_decode(target->depth_format, target_depth_at(target, x, y));
            texel[0] = texel[1] = texel[2] = texel[3] = depth;
        }
    texture_close_rows(surface->texture, level, first, target->height);
}

void surfaces_load(const struct triptych_target_textures *textures, struct target *target)
{
    for (unsigned t = 0; t < TARGETS; t++)
        if (textures->color[t].texture)
            target_write_texels(target, t, surface_texels(&textures->color[t]),
                                (size_t)surface_level(&textures->color[t])->pitch);
    if (textures->depth.texture)
        load_depth(&textures->depth, target);
}

static void store_color(const struct triptych_surface *surface, const struct target *target, unsigned t)
{
    void *texels = surface_texels(surface);
    size_t pitch = (size_t)surface_level(surface)->pitch;
    for (uint32_t row = 0; row < target->rows; row++)
        if (surface->texture->format->storage == STORAGE_RGBA8)
            target_read_color(target, t, SAMPLE_RESOLVED, row, texels, pitch);
        else
            target_read_numbers(target, t, SAMPLE_RESOLVED, row, texels, pitch);
    texture_close_rows(surface->texture, surface_level(surface), texels, target->height);
}

void surfaces_store(const struct triptych_target_textures *textures, const struct target *target)
{
    for (unsigned t = 0; t < TARGETS; t++)
        if (textures->color[t].texture)
            store_color(&textures->color[t], target, t);
    if (textures->depth.texture)
        store_depth(&textures->depth, target);
}

/* --- Numbers --- */

void surface_read_numbers(const struct triptych_surface *surface, float *image)
{
    const struct texture_level *level = surface_level(surface);
    size_t bytes = format_texel_bytes(surface->texture->format), width = (size_t)level->width;
    const uint8_t *row = surface_texels(surface);
    for (int y = 0; y < level->height; y++, row += (size_t)level->pitch * bytes, image += 4 * width)
        if (surface->texture->format->storage == STORAGE_FLOAT4)
            memcpy(image, row, width * bytes);
        else
            for (size_t x = 0; x < width; x++)
                color_numbers(TARGET_8888, (const uint32_t *)(const void *)row + x, image + 4 * x);
}

void surface_write_numbers(const struct triptych_surface *surface, const struct triptych_rectangle *part,
                           const float *image)
{
    const struct format *format = surface->texture->format;
    const struct texture_level *level = surface_level(surface);
    size_t bytes = format_texel_bytes(format), pitch = (size_t)level->pitch;
    uint8_t *texels = surface_texels(surface);
    for (size_t y = part->y; y < (size_t)part->y + part->height; y++)
        for (size_t x = part->x; x < (size_t)part->x + part->width; x++, image += 4) {
            uint32_t words[4];
            color_encode(format, image, words);
            memcpy(texels + (y * pitch + x) * bytes, words, bytes);
        }
    texture_close_rows(surface->texture, level, texels + part->y * pitch * bytes, part->height);
}
