/* The contents of a target as they are stored, for captures that begin late. Nothing is rounded, resolved or
 * lost, in any format and with any number of samples.
 *
 * Contents are pixels row by row; of each pixel its samples; of each sample the words of all colours, then
 * the word of depth and stencil. Words that no drawing can write are replaced by words that drawing can
 * write. */
#include "machine/mxcsr.h"
#include "render/target/target.h"

#include <string.h>

static uint32_t colour_planes(const struct triptych_target_description *description)
{
    uint32_t planes = 0;
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct format *format = target_format(description, t);
        planes += format ? storage_planes[format->target] : 0;
    }
    return planes;
}

size_t target_contents_bytes(const struct triptych_target_description *description)
{
    enum triptych_depth_format depth = description->depth_format;
    uint32_t samples = description->samples ? description->samples : 1;
    uint32_t words = colour_planes(description) + (depth_mask(depth) || stencil_mask(depth));
    return (size_t)description->width * description->height * samples * words * sizeof(uint32_t);
}

/* The words of a pixel in a tile: a colour's first plane and depth's, each once for every sample; null if
 * they are not stored. */
struct pixel {
    uint32_t *color[TARGETS], *depth;
};

static struct pixel find_pixel(struct target *target, uint32_t x, uint32_t y)
{
    uint32_t tile = y / TILE_SIZE * target->columns + x / TILE_SIZE;
    struct pixel pixel = {{NULL}, NULL};
    uint32_t *color = NULL;
    x %= TILE_SIZE, y %= TILE_SIZE;
    if (target->depth)
        pixel.depth = target_fill_depth(target, tile) + tile_order_word(&target->depth_order, x, y);
    if (target->color)
        color = target_fill_color(target, tile) + tile_order_word(&target->color_order, x, y);
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].attachment)
            pixel.color[t] = color + target->colors[t].plane * target->color_order.plane;
    return pixel;
}

/* Words of colours that are not stored have all bits set. */
static void write_color(const struct target *target, unsigned t, uint32_t *words, const uint8_t **data)
{
    const struct format *format = target->colors[t].format;
    int planes = format ? storage_planes[target->colors[t].storage] : 0;
    for (int plane = 0; plane < planes; plane++, *data += sizeof(uint32_t)) {
        uint32_t word;
        memcpy(&word, *data, sizeof word);
        if (words)
            words[(size_t)plane * target->color_order.plane] = format_valid_word(format, word);
    }
}

static void write_pixel(struct target *target, uint32_t x, uint32_t y, const uint8_t **data)
{
    struct pixel pixel = find_pixel(target, x, y);
    if (pixel.depth)
        target_forget_depth(target, y / TILE_SIZE * target->columns + x / TILE_SIZE);
    for (uint32_t sample = 0; sample < target->samples; sample++) {
        size_t next = (size_t)sample * target->planes * target->color_order.plane;
        for (unsigned t = 0; t < TARGETS; t++)
            write_color(target, t, pixel.color[t] ? pixel.color[t] + next : NULL, data);
        if (!pixel.depth)
            continue;
        uint32_t word;
        memcpy(&word, *data, sizeof word);
        pixel.depth[sample * target->depth_order.plane] = depth_valid(target->depth_format, word);
        *data += sizeof word;
    }
}

/* Not inlined: the compiler may move arithmetic over a change of MXCSR, but not a call. */
__attribute__((noinline)) static void write_pixels(struct target *target, const uint8_t *data)
{
    for (uint32_t y = 0; y < target->height; y++)
        for (uint32_t x = 0; x < target->width; x++)
            write_pixel(target, x, y, &data);
}

static void read_color(const struct target *target, unsigned t, const uint32_t *words, uint8_t **data)
{
    static const uint32_t ones = UINT32_MAX;
    int planes = target->colors[t].format ? storage_planes[target->colors[t].storage] : 0;
    for (int plane = 0; plane < planes; plane++, *data += sizeof(uint32_t))
        memcpy(*data, words ? words + (size_t)plane * target->color_order.plane : &ones, sizeof(uint32_t));
}

static void read_pixel(struct target *target, uint32_t x, uint32_t y, uint8_t **data)
{
    struct pixel pixel = find_pixel(target, x, y);
    for (uint32_t sample = 0; sample < target->samples; sample++) {
        size_t next = (size_t)sample * target->planes * target->color_order.plane;
        for (unsigned t = 0; t < TARGETS; t++)
            read_color(target, t, pixel.color[t] ? pixel.color[t] + next : NULL, data);
        if (!pixel.depth)
            continue;
        memcpy(*data, pixel.depth + sample * target->depth_order.plane, sizeof(uint32_t));
        *data += sizeof(uint32_t);
    }
}

void target_read_contents(struct target *target, void *data)
{
    uint8_t *at = data;
    for (uint32_t y = 0; y < target->height; y++)
        for (uint32_t x = 0; x < target->width; x++)
            read_pixel(target, x, y, &at);
}

void target_write_contents(struct target *target, const void *data)
{
    unsigned saved = mxcsr_enter();
    write_pixels(target, data);
    mxcsr_leave(saved);
}
