#include "render/texture/order.h"

#include <string.h>

/* The texels from x on that follow each other in memory, at most `count`. */
static size_t run_length(const struct texture_image *image, size_t x, size_t count)
{
    size_t run = TEXTURE_TILE - x % TEXTURE_TILE;
    return image->tiled && run < count ? run : count;
}

/* --- Compact texels --- */

static void expand(const struct compact_form *form, const uint8_t *texels, size_t count, uint32_t *words)
{
    if (form->bytes == 1)
        for (size_t i = 0; i < count; i++)
            words[i] = texels[i] * form->first + form->constant;
    else
        for (size_t i = 0; i < count; i++)
            words[i] = texels[2 * i] * form->first + texels[2 * i + 1] * form->second + form->constant;
}

static void reduce(const struct compact_form *form, const uint32_t *words, size_t count, uint8_t *texels)
{
    const int first = __builtin_ctz(form->first), second = form->second ? __builtin_ctz(form->second) : 0;
    if (form->bytes == 1)
        for (size_t i = 0; i < count; i++)
            texels[i] = (uint8_t)(words[i] >> first);
    else
        for (size_t i = 0; i < count; i++) {
            texels[2 * i] = (uint8_t)(words[i] >> first);
            texels[2 * i + 1] = (uint8_t)(words[i] >> second);
        }
}

/* --- Rows --- */

void texture_read_row(const struct texture_image *image, size_t x, size_t y, size_t count, void *row)
{
    uint8_t *to = row;
    for (size_t run; count; count -= run, x += run, to += run * texture_row_size(image)) {
        run = run_length(image, x, count);
        if (image->compact)
            expand(&storage_compact[image->compact], texture_texel(image, x, y), run, (uint32_t *)(void *)to);
        else
            memcpy(to, texture_texel(image, x, y), run * image->bytes);
    }
}

void texture_write_row(const struct texture_image *image, size_t x, size_t y, size_t count, const void *row)
{
    const uint8_t *from = row;
    for (size_t run; count; count -= run, x += run, from += run * texture_row_size(image)) {
        run = run_length(image, x, count);
        if (image->compact)
            reduce(&storage_compact[image->compact], (const uint32_t *)(const void *)from, run,
                   texture_texel(image, x, y));
        else
            memcpy(texture_texel(image, x, y), from, run * image->bytes);
    }
}

/* The bytes of compact texels are those of the format: a part of a row from the application's memory, and
 * to it. */
static void copy_compact(const struct texture_image *image, size_t x, size_t y, size_t count,
                         const uint8_t *from, uint8_t *to)
{
    for (size_t run, done = 0; count; count -= run, x += run, done += run * image->bytes) {
        run = run_length(image, x, count);
        if (from)
            memcpy(texture_texel(image, x, y), from + done, run * image->bytes);
        else
            memcpy(to + done, texture_texel(image, x, y), run * image->bytes);
    }
}

static void copy_compact_part(const struct texture_image *image, const struct triptych_box *box,
                              const uint8_t *from, uint8_t *to, size_t pitch)
{
    for (size_t y = 0; y < box->height; y++)
        copy_compact(image, box->x, box->y + y, box->width, from ? from + y * pitch : NULL,
                     to ? to + y * pitch : NULL);
}

/* A column of tiles, or a strip of them, in rows: what is converted together. The widths of strips are whole
 * blocks of every format. */
enum { STRIP = 64 };

struct strip {
    uint32_t x, y, width, height;
    uint32_t texels[STRIP * TEXTURE_TILE * 4];
};

/* The strip that begins x texels across and y texels down the box. */
static void begin_strip(const struct triptych_box *box, uint32_t x, uint32_t y, struct strip *strip)
{
    strip->x = box->x + x;
    strip->y = box->y + y;
    strip->width = box->width - x < STRIP ? box->width - x : STRIP;
    strip->height = box->height - y < TEXTURE_TILE ? box->height - y : TEXTURE_TILE;
}

static uint8_t *strip_row(struct strip *strip, const struct texture_image *image, uint32_t y)
{
    return (uint8_t *)strip->texels + (size_t)y * strip->width * texture_row_size(image);
}

/* The first block of the strip in memory. */
static size_t block_offset(const struct format *format, uint32_t x, uint32_t y, size_t pitch)
{
    return y / format->side * pitch + (size_t)(x / format->side) * format->bytes;
}

static void decode_strip(const struct format *format, const uint8_t *blocks, size_t pitch,
                         struct strip *strip, const struct texture_image *image)
{
    format_decode(format, blocks, pitch, strip->width, strip->height, strip->texels, strip->width);
    for (uint32_t y = 0; y < strip->height; y++)
        texture_write_row(image, strip->x, strip->y + y, strip->width, strip_row(strip, image, y));
}

static void encode_strip(const struct format *format, const struct texture_image *image, struct strip *strip,
                         uint8_t *blocks, size_t pitch)
{
    for (uint32_t y = 0; y < strip->height; y++)
        texture_read_row(image, strip->x, strip->y + y, strip->width, strip_row(strip, image, y));
    format_encode(format, strip->texels, strip->width, strip->width, strip->height, blocks, pitch);
}

void texture_decode_part(const struct format *format, const void *data, size_t pitch,
                         const struct triptych_box *box, const struct texture_image *image)
{
    if (image->compact) {
        copy_compact_part(image, box, data, NULL, pitch);
        return;
    }
    if (!image->tiled) {
        format_decode(format, data, pitch, box->width, box->height, texture_texel(image, box->x, box->y),
                      image->pitch);
        return;
    }
    struct strip strip;
    for (uint32_t y = 0; y < box->height; y += TEXTURE_TILE)
        for (uint32_t x = 0; x < box->width; x += STRIP) {
            begin_strip(box, x, y, &strip);
            decode_strip(format, (const uint8_t *)data + block_offset(format, x, y, pitch), pitch, &strip,
                         image);
        }
}

void texture_encode_part(const struct format *format, const struct texture_image *image,
                         const struct triptych_box *box, void *data, size_t pitch)
{
    if (image->compact) {
        copy_compact_part(image, box, NULL, data, pitch);
        return;
    }
    if (!image->tiled) {
        format_encode(format, texture_texel(image, box->x, box->y), image->pitch, box->width, box->height,
                      data, pitch);
        return;
    }
    struct strip strip;
    for (uint32_t y = 0; y < box->height; y += TEXTURE_TILE)
        for (uint32_t x = 0; x < box->width; x += STRIP) {
            begin_strip(box, x, y, &strip);
            encode_strip(format, image, &strip, (uint8_t *)data + block_offset(format, x, y, pitch), pitch);
        }
}
