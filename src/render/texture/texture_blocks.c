/* Reading texels in their own format, and the blocks of compressed textures.
 *
 * Decoding loses how a compressed block was coded, so a compressed texture also keeps the blocks of its
 * updates. Texels that came from elsewhere, such as computed levels, make the blocks of their level stale. A
 * stale level is compressed again when it is read, or when a part of it is updated. */
#include "render/texture/texture.h"

#include <stdlib.h>
#include <string.h>

static size_t face_block_bytes(const struct triptych_texture *texture)
{
    size_t bytes = 0;
    for (unsigned level = 0; level < texture->levels; level++)
        bytes += texture_level_bytes(texture, level);
    return bytes;
}

/* The first block of a face's level. */
static uint8_t *level_blocks(const struct triptych_texture *texture, unsigned face, unsigned level)
{
    size_t offset = face * face_block_bytes(texture);
    for (unsigned i = 0; i < level; i++)
        offset += texture_level_bytes(texture, i);
    return texture->blocks + offset;
}

int texture_blocks_create(struct triptych_texture *texture)
{
    texture->blocks = NULL;
    memset(texture->stale, 0, sizeof texture->stale);
    if (texture->format->side > 1)
        texture->blocks = calloc(texture->faces, face_block_bytes(texture));
    return texture->format->side > 1 && !texture->blocks ? -1 : 0;
}

void texture_blocks_all_stale(struct triptych_texture *texture, unsigned first_level)
{
    for (unsigned face = 0; face < texture->faces; face++)
        for (unsigned level = first_level; level < texture->levels; level++)
            texture->stale[face] |= (uint16_t)(1 << level);
}

/* Texels of a part of a level, converted to the format. */
static void encode_part(const struct triptych_texture *texture, unsigned face, unsigned level,
                        const struct triptych_box *box, uint8_t *data, size_t row_pitch, size_t slice_pitch)
{
    for (unsigned z = 0; z < box->depth; z++, data += slice_pitch) {
        struct texture_image image = texture_slice(texture, face, level, box->z + z);
        texture_encode_part(texture->format, &image, box, data, row_pitch);
    }
}

/* Rows of blocks of a part, `from` the application's memory or `to` it; the other one is null. `kept` are the
 * texture's blocks of the level. */
static void copy_blocks(const struct triptych_texture *texture, unsigned level,
                        const struct triptych_box *box, uint8_t *kept, const uint8_t *from, uint8_t *to,
                        size_t row_pitch, size_t slice_pitch)
{
    const struct texture_level *l = &texture->level[level];
    const struct format *format = texture->format;
    size_t pitch = texture_row_bytes(format, (uint32_t)l->width);
    size_t slice = pitch * format_blocks(format, (uint32_t)l->height);
    size_t bytes = texture_row_bytes(format, box->width), rows = format_blocks(format, box->height);
    kept += box->z * slice + box->y / format->side * pitch + box->x / format->side * (size_t)format->bytes;
    for (unsigned z = 0; z < box->depth; z++, kept += slice)
        for (size_t y = 0; y < rows; y++) {
            size_t place = z * slice_pitch + y * row_pitch;
            if (from)
                memcpy(kept + y * pitch, from + place, bytes);
            else
                memcpy(to + place, kept + y * pitch, bytes);
        }
}

static void refresh(struct triptych_texture *texture, unsigned face, unsigned level)
{
    struct triptych_box whole = texture_whole_level(texture, level);
    size_t row = texture_row_bytes(texture->format, whole.width);
    if (texture->stale[face] >> level & 1)
        encode_part(texture, face, level, &whole, level_blocks(texture, face, level), row,
                    row * format_blocks(texture->format, whole.height));
    texture->stale[face] &= (uint16_t) ~(1 << level);
}

static bool is_whole(const struct triptych_box *box, const struct triptych_box *whole)
{
    return box->width == whole->width && box->height == whole->height && box->depth == whole->depth;
}

void texture_blocks_update(struct triptych_texture *texture, unsigned face, unsigned level,
                           const struct triptych_box *box, const void *data, size_t row_pitch,
                           size_t slice_pitch)
{
    if (!texture->blocks)
        return;
    struct triptych_box whole = texture_whole_level(texture, level);
    if (is_whole(box, &whole))
        texture->stale[face] &= (uint16_t) ~(1 << level);
    refresh(texture, face, level);
    copy_blocks(texture, level, box, level_blocks(texture, face, level), data, NULL, row_pitch, slice_pitch);
}

void texture_compress(struct triptych_texture *texture, unsigned face, unsigned level,
                      const struct triptych_box *box)
{
    const struct texture_level *l = &texture->level[level];
    const struct format *format = texture->format;
    size_t pitch = texture_row_bytes(format, (uint32_t)l->width);
    size_t slice = pitch * format_blocks(format, (uint32_t)l->height);
    refresh(texture, face, level);
    uint8_t *blocks = level_blocks(texture, face, level) + box->z * slice + box->y / format->side * pitch +
                      box->x / format->side * (size_t)format->bytes;
    encode_part(texture, face, level, box, blocks, pitch, slice);
    for (unsigned z = 0; z < box->depth; z++, blocks += slice) {
        struct texture_image image = texture_slice(texture, face, level, box->z + z);
        texture_decode_part(format, blocks, pitch, box, &image);
    }
}

void texture_read(struct triptych_texture *texture, unsigned face, unsigned level,
                  const struct triptych_box *box, void *data, size_t row_pitch, size_t slice_pitch)
{
    struct triptych_box whole = texture_whole_level(texture, level);
    box = box ? box : &whole;
    if (!texture->blocks) {
        encode_part(texture, face, level, box, data, row_pitch, slice_pitch);
        return;
    }
    refresh(texture, face, level);
    copy_blocks(texture, level, box, level_blocks(texture, face, level), NULL, data, row_pitch, slice_pitch);
}
