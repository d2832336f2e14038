/* The texels of textures: in memory until the renderer needs them. */
#include "front/gl/state.h"
#include "front/gl/texture/texture.h"

#include <stdlib.h>
#include <string.h>

static unsigned levels_of(unsigned width, unsigned height)
{
    unsigned levels = 1;
    for (unsigned side = width > height ? width : height; side > 1; side /= 2)
        levels++;
    return levels;
}

static unsigned side_at(unsigned side, unsigned level)
{
    return side >> level ? side >> level : 1;
}

/* --- Completeness --- */

static bool fits(const struct gl_level *level, const struct gl_level *first, unsigned i)
{
    return level->texel == first->texel && level->internal_format == first->internal_format &&
           level->width == side_at(first->width, i) && level->height == side_at(first->height, i);
}

/* Levels `from` to `to` - 1 of all faces fit to the first image. */
static bool levels_fit(const struct gl_texture *texture, unsigned from, unsigned to)
{
    for (unsigned face = 0; face < gl_texture_faces(texture); face++)
        for (unsigned i = from; i < to; i++)
            if (!fits(&texture->level[face][i], &texture->level[0][0], i))
                return false;
    return true;
}

static bool is_set(const struct gl_texture *texture, bool mipmaps)
{
    const struct gl_level *first = &texture->level[0][0];
    if (!first->texel || !first->width || !first->height)
        return false;
    if (texture->target == GL_TEXTURE_CUBE_MAP && first->width != first->height)
        return false;
    return levels_fit(texture, 0, mipmaps ? levels_of(first->width, first->height) : 1);
}

bool gl_texture_has_first(const struct gl_texture *texture)
{
    return is_set(texture, false);
}

static bool has_mipmaps(const struct gl_texture *texture)
{
    return texture->min_filter != GL_NEAREST && texture->min_filter != GL_LINEAR;
}

static bool is_complete(struct gl_texture *texture)
{
    if (!texture->checked)
        texture->complete = is_set(texture, has_mipmaps(texture));
    texture->checked = true;
    return texture->complete;
}

/* --- The renderer's texture --- */

static bool belongs(const struct gl_texture *texture, const struct gl_level *level, unsigned i)
{
    const struct triptych_texture_description *made = &texture->description;
    return texture->renderer && i < made->levels && level->texel && level->texel->storage == made->format &&
           level->width == side_at(made->width, i) && level->height == side_at(made->height, i);
}

/* A texture of one level is the image itself. */
static bool is_image(const struct gl_texture *texture)
{
    return texture->level[0][0].image && texture->target != GL_TEXTURE_CUBE_MAP && !has_mipmaps(texture);
}

static size_t pitch_of(const struct gl_level *level)
{
    return (size_t)level->width * level->texel->storage_bytes;
}

static size_t bytes_of(const struct gl_level *level)
{
    return pitch_of(level) * level->height;
}

/* Texels with a stencil that a framebuffer can have are words of the surface (texture/depth.h). It has no
 * other place. */
static bool has_words(const struct gl_level *level, unsigned i)
{
    return !i && level->texel->stencil;
}

static bool read_words(struct gl_context *context, const struct gl_texture *texture,
                       const struct gl_level *level)
{
    const struct triptych_surface surface = {.texture = texture->renderer};
    return triptych_read_rectangle(context->renderer, &surface, NULL, 0, level->memory, pitch_of(level)) ==
           TRIPTYCH_OK;
}

static bool write_words(struct gl_context *context, struct gl_texture *texture,
                        const struct triptych_rectangle *part, const void *data, size_t pitch)
{
    const struct triptych_surface surface = {.texture = texture->renderer};
    return gl_depth_part(context->share, &texture->depth) &&
           triptych_write_rectangle(context->renderer, &surface, part, 0, data, pitch) == TRIPTYCH_OK;
}

/* Moves texels to memory. */
static bool fetch(struct gl_context *context, struct gl_texture *texture, unsigned face, unsigned i)
{
    struct gl_level *level = &texture->level[face][i];
    if (!level->kept)
        return true;
    if (level->image) {
        level->kept = false;
        return true;
    }
    level->memory = malloc(bytes_of(level));
    if (!level->memory)
        return false;
    level->kept = false;
    if (has_words(level, i))
        return read_words(context, texture, level);
    return triptych_texture_read(context->renderer, texture->renderer, face, i, NULL, level->memory,
                                 pitch_of(level), 0) == TRIPTYCH_OK;
}

static bool update(struct gl_context *context, struct gl_texture *texture, unsigned face, unsigned i)
{
    const struct gl_level *level = &texture->level[face][i];
    size_t pitch = pitch_of(level);
    if (has_words(level, i))
        return write_words(context, texture, NULL, level->memory, pitch);
    return triptych_texture_update(context->renderer, texture->renderer, face, i, NULL, level->memory, pitch,
                                   0) == TRIPTYCH_OK;
}

/* Copies an image to the renderer's texture, if it was changed since. */
static bool pass_image(struct gl_context *context, struct gl_texture *texture, unsigned face, unsigned i)
{
    struct gl_level *level = &texture->level[face][i];
    const struct triptych_surface to = {.texture = texture->renderer, .level = i, .slice = face};
    if (!belongs(texture, level, i) || (level->kept && level->copied == level->image->changes))
        return true;
    level->kept = true;
    level->copied = level->image->changes;
    level->image->has_copies = true;
    return triptych_copy(context->renderer, &level->image->surface, NULL, &to, NULL, TRIPTYCH_COPY_POINT) ==
           TRIPTYCH_OK;
}

/* Moves texels to the renderer. */
static bool pass(struct gl_context *context, struct gl_texture *texture, unsigned face, unsigned i)
{
    struct gl_level *level = &texture->level[face][i];
    if (level->image)
        return pass_image(context, texture, face, i);
    if (level->kept || !belongs(texture, level, i))
        return true;
    if (level->memory && !update(context, texture, face, i))
        return false;
    free(level->memory);
    level->memory = NULL;
    level->kept = true;
    return true;
}

static bool each_level(struct gl_context *context, struct gl_texture *texture,
                       bool (*visit)(struct gl_context *, struct gl_texture *, unsigned, unsigned))
{
    for (unsigned face = 0; face < gl_texture_faces(texture); face++)
        for (unsigned i = 0; i < GL_LEVELS; i++)
            if (!visit(context, texture, face, i))
                return false;
    return true;
}

static bool remake(struct gl_context *context, struct gl_texture *texture,
                   const struct triptych_texture_description *description)
{
    triptych_texture *made;
    if (!gl_depth_part(context->share, &texture->depth) || !each_level(context, texture, fetch) ||
        triptych_texture_define(context->renderer, description, &made) != TRIPTYCH_OK)
        return false;
    triptych_texture_destroy(context->renderer, texture->renderer);
    texture->renderer = made;
    texture->description = *description;
    texture->loose = true;
    context->late |= GL_LATE_TARGET | GL_LATE_TEXTURES;
    return true;
}

/* The texture for images that fit to `anchor`, with at least `levels` levels. */
static bool ensure(struct gl_context *context, struct gl_texture *texture, const struct gl_level *anchor,
                   unsigned levels)
{
    struct triptych_texture_description wanted = {
        .type = texture->target == GL_TEXTURE_CUBE_MAP ? TRIPTYCH_TEXTURE_CUBE : TRIPTYCH_TEXTURE_2D,
        .format = anchor->texel->storage,
        .width = anchor->width,
        .height = anchor->height,
        .depth = 1,
        .levels = levels};
    if ((!belongs(texture, anchor, 0) || texture->description.levels < levels) &&
        !remake(context, texture, &wanted))
        return false;
    if ((texture->loose || texture->images) && !each_level(context, texture, pass))
        return false;
    texture->loose = false;
    return true;
}

triptych_texture *gl_texture_use(struct gl_context *context, struct gl_texture *texture)
{
    const struct gl_level *first = &texture->level[0][0];
    if (!is_complete(texture))
        return NULL;
    if (is_image(texture))
        return first->image->surface.texture;
    unsigned levels = has_mipmaps(texture) ? levels_of(first->width, first->height) : 1;
    return ensure(context, texture, first, levels) ? texture->renderer : NULL;
}

bool gl_texture_draw(struct gl_context *context, struct gl_texture *texture, unsigned face, unsigned i,
                     struct triptych_surface *surface)
{
    struct gl_level *level = &texture->level[face][i];
    if (texture->target == GL_TEXTURE_CUBE_MAP && level->width != level->height)
        return false;
    if (level->image) {
        gl_image_change(level->image);
        *surface = level->image->surface;
        return true;
    }
    if ((!belongs(texture, level, i) || !level->kept) && !ensure(context, texture, level, 1))
        return false;
    *surface = (struct triptych_surface){.texture = texture->renderer, .level = i, .slice = face};
    texture->depth.surface = *surface;
    texture->depth.width = level->width;
    texture->depth.height = level->height;
    texture->depth.has_depth = level->texel->depth;
    texture->depth.has_stencil = level->texel->stencil;
    return true;
}

/* --- Images --- */

/* Frees the texels of a level. The image of others stays theirs. */
static void clear_level(struct gl_texture *texture, struct gl_level *level)
{
    free(level->memory);
    if (level->image) {
        gl_image_part(level->image, texture);
        gl_image_release(level->image);
        texture->images--;
    }
    *level = (struct gl_level){0};
}

void gl_texture_define(struct gl_context *context, struct gl_texture *texture, unsigned face, unsigned i,
                       const struct gl_texel *texel, GLenum internal_format, unsigned width, unsigned height)
{
    struct gl_level *level = &texture->level[face][i];
    bool same = level->texel == texel && level->width == width && level->height == height;
    texture->checked = texture->checked && level->internal_format == internal_format;
    level->internal_format = internal_format;
    texture->checked = texture->checked && same;
    if (same && level->kept && !level->image)
        return;
    clear_level(texture, level);
    *level = (struct gl_level){
        .texel = texel, .internal_format = internal_format, .width = width, .height = height};
    texture->loose = true;
    context->late |= GL_LATE_TARGET | GL_LATE_TEXTURES;
}

/* Memory of an image that the renderer does not have. */
static bool allocate(struct gl_level *level)
{
    if (!level->memory)
        level->memory = calloc(1, bytes_of(level));
    return level->memory;
}

static void copy_rows(struct gl_level *level, const struct triptych_rectangle *part, const uint8_t *data,
                      size_t pitch)
{
    unsigned bytes = level->texel->storage_bytes;
    uint8_t *to = level->memory + part->y * pitch_of(level) + part->x * bytes;
    for (unsigned y = 0; y < part->height; y++)
        memcpy(to + y * pitch_of(level), data + y * pitch, part->width * bytes);
}

/* The renderer converts between formats of colours. */
static bool write_converted(struct gl_context *context, struct gl_texture *texture, unsigned face, unsigned i,
                            const struct gl_texel *texel, const struct triptych_rectangle *part,
                            const void *data, size_t pitch)
{
    struct gl_level *level = &texture->level[face][i];
    struct triptych_surface surface = {.level = i, .slice = face};
    if (!level->kept && !level->image) /* the first level can always be the renderer's */
        if (i || !ensure(context, texture, level, 1))
            return false;
    surface.texture = texture->renderer;
    if (level->image)
        surface = level->image->surface;
    return triptych_write_rectangle(context->renderer, &surface, part, texel->storage, data, pitch) ==
           TRIPTYCH_OK;
}

static bool write_image(struct gl_context *context, const struct gl_level *level,
                        const struct triptych_rectangle *part, const void *data, size_t pitch)
{
    const struct triptych_surface *surface = &level->image->surface;
    const struct triptych_box box = {part->x, part->y, 0, part->width, part->height, 1};
    if (level->texel->stencil)
        return gl_depth_part(context->share, &level->image->depth) &&
               triptych_write_rectangle(context->renderer, surface, part, 0, data, pitch) == TRIPTYCH_OK;
    return triptych_texture_update(context->renderer, surface->texture, 0, 0, &box, data, pitch, 0) ==
           TRIPTYCH_OK;
}

bool gl_texture_write(struct gl_context *context, struct gl_texture *texture, unsigned face, unsigned i,
                      const struct gl_texel *texel, const struct triptych_rectangle *part, const void *data,
                      size_t pitch)
{
    struct gl_level *level = &texture->level[face][i];
    struct triptych_box box = {part->x, part->y, 0, part->width, part->height, 1};
    if (!part->width || !part->height)
        return true;
    if (level->image)
        gl_image_change(level->image);
    if (texel->storage != level->texel->storage)
        return write_converted(context, texture, face, i, texel, part, data, pitch);
    if (level->image)
        return write_image(context, level, part, data, pitch);
    if (level->kept && has_words(level, i))
        return write_words(context, texture, part, data, pitch);
    if (level->kept)
        return triptych_texture_update(context->renderer, texture->renderer, face, i, &box, data, pitch, 0) ==
               TRIPTYCH_OK;
    if (!allocate(level))
        return false;
    copy_rows(level, part, data, pitch);
    texture->loose = true;
    return true;
}

/* --- Images of others --- */

bool gl_texture_lends(const struct gl_texture *texture, unsigned i)
{
    if (is_set(texture, true))
        return true;
    for (unsigned face = 0; face < gl_texture_faces(texture); face++)
        for (unsigned other = 1; other < GL_LEVELS; other++)
            if (texture->level[face][other].texel)
                return false;
    return !i && is_set(texture, false);
}

static bool copy_to_image(struct gl_texture *texture, unsigned face, unsigned i, const struct gl_image *image)
{
    const struct gl_level *level = &texture->level[face][i];
    const struct triptych_surface from = {.texture = texture->renderer, .level = i, .slice = face};
    if (level->memory && level->texel->stencil)
        return triptych_write_rectangle(image->renderer, &image->surface, NULL, 0, level->memory,
                                        pitch_of(level)) == TRIPTYCH_OK;
    if (level->memory)
        return triptych_texture_update(image->renderer, image->surface.texture, 0, 0, NULL, level->memory,
                                       pitch_of(level), 0) == TRIPTYCH_OK;
    return !level->kept || triptych_copy(image->renderer, &from, NULL, &image->surface, NULL,
                                         TRIPTYCH_COPY_POINT) == TRIPTYCH_OK;
}

struct gl_image *gl_texture_lend(struct gl_texture *texture, unsigned face, unsigned i)
{
    struct gl_level *level = &texture->level[face][i];
    if (level->image)
        return gl_image_hold(level->image);
    struct gl_image *image =
        gl_image_make(texture->object.share->device, level->texel, level->width, level->height);
    if (!image)
        return NULL;
    if (!gl_depth_part(texture->object.share, &texture->depth) || !copy_to_image(texture, face, i, image)) {
        gl_image_release(image);
        return NULL;
    }
    free(level->memory);
    level->memory = NULL;
    level->kept = false;
    level->image = image;
    texture->images++;
    return gl_image_hold(image);
}

void gl_texture_take(struct gl_texture *texture, struct gl_image *image)
{
    struct gl_image *held = image ? gl_image_hold(image) : NULL;
    for (unsigned face = 0; face < GL_FACES; face++)
        for (unsigned i = 0; i < GL_LEVELS; i++)
            clear_level(texture, &texture->level[face][i]);
    texture->checked = false;
    texture->loose = true;
    if (!held)
        return;
    texture->level[0][0] = (struct gl_level){.texel = held->texel,
                                             .internal_format = held->texel->format,
                                             .width = held->width,
                                             .height = held->height,
                                             .image = held};
    texture->images = 1;
}

bool gl_texture_generate(struct gl_context *context, struct gl_texture *texture)
{
    const struct gl_level first = texture->level[0][0];
    unsigned levels = levels_of(first.width, first.height);
    for (unsigned face = 0; face < gl_texture_faces(texture); face++)
        for (unsigned i = 1; i < levels; i++)
            gl_texture_define(context, texture, face, i, first.texel, first.internal_format,
                              side_at(first.width, i), side_at(first.height, i));
    return ensure(context, texture, &first, levels) &&
           triptych_texture_generate_mips(context->renderer, texture->renderer) == TRIPTYCH_OK;
}

void gl_texture_free(struct gl_texture *texture)
{
    gl_depth_part(texture->object.share, &texture->depth);
    for (unsigned face = 0; face < GL_FACES; face++)
        for (unsigned i = 0; i < GL_LEVELS; i++)
            clear_level(texture, &texture->level[face][i]);
    triptych_texture_destroy(texture->object.share->renderer, texture->renderer);
}
