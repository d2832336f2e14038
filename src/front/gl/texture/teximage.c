/* Images of textures: chapters 3.7.1 to 3.7.3. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/texture/paletted.h"
#include "front/gl/texture/read.h"
#include "front/gl/state.h"
#include "front/gl/texture/texture.h"

#include <stdlib.h>

/* An image of a texture, as commands name it. */
struct place {
    struct gl_texture *texture;
    unsigned face, level;
};

static bool find_place(struct gl_context *context, GLenum target, GLint level, struct place *place)
{
    place->texture = gl_texture_of_image(context, target, &place->face);
    place->level = (unsigned)level;
    if (place->texture && (level < 0 || level >= GL_LEVELS)) {
        gl_error(context, GL_INVALID_VALUE, "found level %d, expected 0 to %d", level, GL_LEVELS - 1);
        return false;
    }
    return place->texture;
}

static bool check_size(struct gl_context *context, const struct place *place, GLsizei width, GLsizei height,
                       GLint border)
{
    GLsizei most = GL_SIDE >> place->level;
    if (width < 0 || height < 0 || width > most || height > most)
        gl_error(context, GL_INVALID_VALUE, "found a size of %d x %d, expected sides of 0 to %d", width,
                 height, most);
    else if (place->texture->target == GL_TEXTURE_CUBE_MAP && width != height)
        gl_error(context, GL_INVALID_VALUE, "found a face of %d x %d, expected a square", width, height);
    else if (border)
        gl_error(context, GL_INVALID_VALUE, "found a border of %d, expected 0", border);
    else
        return true;
    return false;
}

/* A part of an image that exists. */
static bool check_part(struct gl_context *context, const struct place *place, GLint x, GLint y, GLsizei width,
                       GLsizei height)
{
    const struct gl_level *level = &place->texture->level[place->face][place->level];
    if (!level->texel)
        gl_error(context, GL_INVALID_OPERATION, "found no image at level %u", place->level);
    else if (x < 0 || y < 0 || width < 0 || height < 0 || (int64_t)x + width > level->width ||
             (int64_t)y + height > level->height)
        gl_error(context, GL_INVALID_VALUE,
                 "found the part %d x %d at %d, %d, expected one of %u x %u texels", width, height, x, y,
                 level->width, level->height);
    else
        return true;
    return false;
}

static const struct gl_texel *find_texel(struct gl_context *context, GLenum format, GLenum type)
{
    const struct gl_texel *texel = gl_texel_find(format, type);
    if (!gl_texel_has_format(format) || !gl_texel_has_type(type))
        gl_error(context, GL_INVALID_ENUM,
                 "found the format 0x%04x of type 0x%04x, expected one of OpenGL ES", format, type);
    else if (!texel)
        gl_error(context, GL_INVALID_OPERATION, "found the format %s, which does not have the type 0x%04x",
                 gl_constant_name(format), type);
    return texel;
}

static void refuse_memory(struct gl_context *context)
{
    gl_error(context, GL_OUT_OF_MEMORY, "no memory for texels");
}

/* --- From the memory of the program --- */

/* The first texel of the program's rows, and the bytes between two of them: glPixelStorei. */
static const uint8_t *unpack(const struct gl_context *context, const struct gl_texel *texel,
                             const struct triptych_rectangle *part, const void *data, size_t *from)
{
    const struct gl_values *values = &context->values;
    unsigned length = values->unpack_row_length[0] ? (unsigned)values->unpack_row_length[0] : part->width;
    *from = gl_texel_pitch(length, texel->bytes, (unsigned)values->unpack_alignment[0]);
    if (!part->width || !part->height)
        return data;
    return (const uint8_t *)data + (size_t)values->unpack_skip_rows[0] * *from +
           (size_t)values->unpack_skip_pixels[0] * texel->bytes;
}

static bool write_part(struct gl_context *context, const struct place *place, const struct gl_texel *texel,
                       const struct triptych_rectangle *part, const void *data)
{
    size_t from, pitch = (size_t)part->width * texel->storage_bytes;
    const uint8_t *first = unpack(context, texel, part, data, &from);
    void *converted = malloc(pitch * part->height + 1);
    if (!converted)
        return false;
    gl_texel_convert(texel, part->width, part->height, first, from, converted, pitch);
    bool written =
        gl_texture_write(context, place->texture, place->face, place->level, texel, part, converted, pitch);
    free(converted);
    return written;
}

/* The texels of an image with an internal format. */
static const struct gl_texel *find_image(struct gl_context *context, GLenum internal_format, GLenum format,
                                         GLenum type)
{
    const struct gl_texel *texel = find_texel(context, format, type);
    if (!texel)
        return NULL;
    if (gl_texel_base(internal_format, type) == format)
        return texel;
    if (!gl_texel_base(internal_format, 0))
        gl_error(context, GL_INVALID_VALUE, "found the internal format 0x%04x", internal_format);
    else
        gl_error(context, GL_INVALID_OPERATION,
                 "found the internal format %s, expected one of the texels, %s",
                 gl_constant_name(internal_format), gl_constant_name(format));
    return NULL;
}

void gl_TexImage2D(struct gl_context *context, GLenum target, GLint level, GLint internal_format,
                   GLsizei width, GLsizei height, GLint border, GLenum format, GLenum type, const void *data)
{
    struct place place;
    if (!find_place(context, target, level, &place))
        return;
    const struct gl_texel *texel = find_image(context, (GLenum)internal_format, format, type);
    if (!texel || !check_size(context, &place, width, height, border))
        return;
    if (texel->depth && target != GL_TEXTURE_2D) {
        gl_error(context, GL_INVALID_OPERATION, "found %s, expected GL_TEXTURE_2D for a texture of depth",
                 gl_constant_name(target));
        return;
    }
    struct triptych_rectangle part = {0, 0, (unsigned)width, (unsigned)height};
    gl_texture_define(context, place.texture, place.face, place.level, texel, (GLenum)internal_format,
                      part.width, part.height);
    if (data && !write_part(context, &place, texel, &part, data))
        refuse_memory(context);
    gl_texture_wrote(context, place.texture, place.level);
}

void gl_TexSubImage2D(struct gl_context *context, GLenum target, GLint level, GLint x, GLint y, GLsizei width,
                      GLsizei height, GLenum format, GLenum type, const void *data)
{
    struct place place;
    if (!find_place(context, target, level, &place))
        return;
    const struct gl_texel *texel = find_texel(context, format, type);
    if (!texel || !check_part(context, &place, x, y, width, height))
        return;
    const struct gl_level *image = &place.texture->level[place.face][place.level];
    struct triptych_rectangle part = {(unsigned)x, (unsigned)y, (unsigned)width, (unsigned)height};
    if (image->texel->format != format || !image->texel->type || image->texel->depth != texel->depth)
        gl_error(context, GL_INVALID_OPERATION, "found texels of %s, expected those of the image, %s",
                 gl_constant_name(format), gl_constant_name(image->texel->format));
    else if (data && !write_part(context, &place, texel, &part, data))
        refuse_memory(context);
    else
        gl_texture_wrote(context, place.texture, place.level);
}

/* --- Compressed --- */

static bool write_compressed(struct gl_context *context, const struct place *place,
                             const struct gl_texel *texel, const struct triptych_rectangle *part,
                             const void *data)
{
    size_t pitch = (size_t)part->width * texel->storage_bytes;
    void *texels = malloc(pitch * part->height + 1);
    if (!texels)
        return false;
    gl_texel_decompress(texel, part->width, part->height, data, texels, pitch);
    bool written =
        gl_texture_write(context, place->texture, place->face, place->level, texel, part, texels, pitch);
    free(texels);
    return written;
}

static const struct gl_texel *find_compressed(struct gl_context *context, GLenum format, GLsizei width,
                                              GLsizei height, GLsizei bytes)
{
    const struct gl_texel *texel = gl_texel_find(format, 0);
    if (context->fixed && gl_paletted_has(format)) /* of a part */
        gl_error(context, GL_INVALID_OPERATION, "found %s, which has whole images only",
                 gl_constant_name(format));
    else if (!texel)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a compressed format",
                 gl_constant_name(format));
    else if (width >= 0 && height >= 0 && width <= GL_SIDE && height <= GL_SIDE &&
             (bytes < 0 ||
              (size_t)bytes != gl_texel_compressed_bytes(texel, (unsigned)width, (unsigned)height)))
        gl_error(context, GL_INVALID_VALUE, "found %d bytes, expected %zu", bytes,
                 gl_texel_compressed_bytes(texel, (unsigned)width, (unsigned)height));
    else
        return texel;
    return NULL;
}

void gl_CompressedTexImage2D(struct gl_context *context, GLenum target, GLint level, GLenum format,
                             GLsizei width, GLsizei height, GLint border, GLsizei bytes, const void *data)
{
    struct place place;
    if (context->fixed && gl_paletted_has(format)) {
        gl_paletted_image(context, target, level, format, width, height, border, bytes, data);
        return;
    }
    if (!find_place(context, target, level, &place))
        return;
    const struct gl_texel *texel = find_compressed(context, format, width, height, bytes);
    if (!texel || !check_size(context, &place, width, height, border))
        return;
    struct triptych_rectangle part = {0, 0, (unsigned)width, (unsigned)height};
    gl_texture_define(context, place.texture, place.face, place.level, texel, format, part.width,
                      part.height);
    if (data && !write_compressed(context, &place, texel, &part, data))
        refuse_memory(context);
}

/* A part of blocks: it begins at multiples of 4 texels, and ends there or with the image. */
static bool is_blocks(const struct gl_level *level, GLint x, GLint y, GLsizei width, GLsizei height)
{
    return x % 4 == 0 && y % 4 == 0 && (width % 4 == 0 || (unsigned)(x + width) == level->width) &&
           (height % 4 == 0 || (unsigned)(y + height) == level->height);
}

void gl_CompressedTexSubImage2D(struct gl_context *context, GLenum target, GLint level, GLint x, GLint y,
                                GLsizei width, GLsizei height, GLenum format, GLsizei bytes, const void *data)
{
    struct place place;
    if (!find_place(context, target, level, &place))
        return;
    const struct gl_texel *texel = find_compressed(context, format, width, height, bytes);
    if (!texel || !check_part(context, &place, x, y, width, height))
        return;
    const struct gl_level *image = &place.texture->level[place.face][place.level];
    struct triptych_rectangle part = {(unsigned)x, (unsigned)y, (unsigned)width, (unsigned)height};
    if (image->texel != texel || format == GL_ETC1_RGB8_OES || !is_blocks(image, x, y, width, height))
        gl_error(context, GL_INVALID_OPERATION, "found %s, expected whole blocks of the image's format, DXT1",
                 gl_constant_name(format));
    else if (data && !write_compressed(context, &place, texel, &part, data))
        refuse_memory(context);
}

/* --- From the framebuffer --- */

/* Returns false, with an error, if the framebuffer does not have all channels of the texels. `texel` is null
 * if there are none of the format. */
static bool check_copied(struct gl_context *context, const struct gl_target *target,
                         const struct gl_texel *texel, GLenum format)
{
    if (!texel || texel->depth) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a format of copies", gl_constant_name(format));
        return false;
    }
    bool luminance = texel->format == GL_LUMINANCE || texel->format == GL_LUMINANCE_ALPHA;
    bool green = !texel->green || luminance || target->green;
    bool blue = !texel->blue || luminance || target->blue;
    if (target->has_read && (!texel->red || target->red) && green && blue && (!texel->alpha || target->alpha))
        return true;
    gl_error(context, GL_INVALID_OPERATION, "found %s, expected channels that the framebuffer has",
             gl_constant_name(format));
    return false;
}

/* Texels outside of the framebuffer are 0. Those of ten bits without alpha have a storage with it. */
static bool copy(struct gl_context *context, const struct place *place, const struct gl_texel *texel,
                 const struct gl_target *target, const struct gl_area *area,
                 const struct triptych_rectangle *part)
{
    size_t pitch = (size_t)part->width * texel->storage_bytes;
    void *texels = calloc(1, pitch * part->height + 1);
    bool read =
        texels && gl_read_area(context, target, area, texel->storage, texel->storage_bytes, texels, pitch);
    if (read && texel->format == GL_RGB && texel->type == GL_UNSIGNED_INT_2_10_10_10_REV_EXT)
        gl_texel_convert(texel, part->width, part->height, texels, pitch, texels, pitch);
    bool written = read && gl_texture_write(context, place->texture, place->face, place->level, texel, part,
                                            texels, pitch);
    free(texels);
    return written;
}

void gl_CopyTexImage2D(struct gl_context *context, GLenum target, GLint level, GLenum internal_format,
                       GLint x, GLint y, GLsizei width, GLsizei height, GLint border)
{
    struct place place;
    struct gl_target from;
    struct gl_area area = {x, y, width, height};
    if (!find_place(context, target, level, &place) || !check_size(context, &place, width, height, border) ||
        !gl_framebuffer_check(context, true, &from))
        return;
    const struct gl_texel *texel = gl_texel_of_copy(internal_format);
    if (!check_copied(context, &from, texel, internal_format))
        return;
    struct triptych_rectangle part = {0, 0, (unsigned)width, (unsigned)height};
    struct gl_level before = place.texture->level[place.face][place.level];
    if (before.image || before.texel != texel || before.internal_format != internal_format ||
        before.width != part.width || before.height != part.height)
        gl_texture_define(context, place.texture, place.face, place.level, texel, internal_format, part.width,
                          part.height);
    if (!copy(context, &place, texel, &from, &area, &part))
        refuse_memory(context);
    gl_texture_wrote(context, place.texture, place.level);
}

void gl_CopyTexSubImage2D(struct gl_context *context, GLenum target, GLint level, GLint x, GLint y,
                          GLint from_x, GLint from_y, GLsizei width, GLsizei height)
{
    struct place place;
    struct gl_target from;
    struct gl_area area = {from_x, from_y, width, height};
    if (!find_place(context, target, level, &place) || !check_part(context, &place, x, y, width, height) ||
        !gl_framebuffer_check(context, true, &from))
        return;
    const struct gl_level *image = &place.texture->level[place.face][place.level];
    if (!image->texel->type || image->texel->depth) {
        gl_error(context, GL_INVALID_OPERATION, "found an image of %s, expected colours without compression",
                 gl_constant_name(image->texel->format));
        return;
    }
    struct triptych_rectangle part = {(unsigned)x, (unsigned)y, (unsigned)width, (unsigned)height};
    if (!check_copied(context, &from, image->texel, image->texel->format))
        return;
    if (!copy(context, &place, image->texel, &from, &area, &part))
        refuse_memory(context);
    gl_texture_wrote(context, place.texture, place.level);
}
