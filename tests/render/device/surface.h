/* Surfaces of SIZE x SIZE pixels, and a random picture that is written to them. */
#ifndef TESTS_RENDER_DEVICE_SURFACE_H
#define TESTS_RENDER_DEVICE_SURFACE_H

#include "tests/support/picture/canvas.h"

#include <string.h>

static uint8_t memory[SIZE * SIZE * 16], back[SIZE * SIZE * 16];

static inline triptych_texture *make(enum triptych_surface_format format)
{
    struct triptych_texture_description description = {TRIPTYCH_TEXTURE_2D, format, SIZE, SIZE, 1, 1};
    triptych_texture *texture;
    OK(triptych_texture_define(device, &description, &texture));
    return texture;
}

static inline triptych_image *make_image(enum triptych_surface_format format,
                                         enum triptych_depth_format depth, unsigned samples)
{
    struct triptych_image_description description = {format, depth, SIZE, SIZE, samples};
    triptych_image *made;
    OK(triptych_image_create(device, &description, &made));
    return made;
}

static inline struct triptych_surface of_texture(triptych_texture *texture)
{
    return (struct triptych_surface){.texture = texture};
}

static inline struct triptych_surface of_image(triptych_image *made)
{
    return (struct triptych_surface){.image = made};
}

/* The colour of a random picture at x, y, as 0xAARRGGBB. */
static inline uint32_t color_at(unsigned x, unsigned y)
{
    return ((x * 2654435761u) ^ (y * 40503u * 65537u)) | 0xff000000;
}

static inline void fill_memory(void)
{
    for (unsigned y = 0; y < SIZE; y++)
        for (unsigned x = 0; x < SIZE; x++) {
            uint32_t word = color_at(x, y);
            memcpy(memory + 4 * (y * SIZE + x), &word, 4);
        }
}

static inline void write_picture(struct triptych_surface surface)
{
    fill_memory();
    OK(triptych_write_rectangle(device, &surface, NULL, TRIPTYCH_SURFACE_A8R8G8B8, memory, 4 * SIZE));
}

static inline uint32_t read_at(struct triptych_surface surface, unsigned x, unsigned y)
{
    const struct triptych_rectangle part = {x, y, 1, 1};
    uint32_t word = 0;
    OK(triptych_read_rectangle(device, &surface, &part, TRIPTYCH_SURFACE_A8R8G8B8, &word, 4));
    return word;
}

#endif
