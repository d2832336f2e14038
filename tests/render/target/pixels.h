/* Pixels in tiles and in texels, with random values that a draw can write, for tests of rectangles and
 * copies. */
#ifndef TESTS_RENDER_TARGET_PIXELS_H
#define TESTS_RENDER_TARGET_PIXELS_H

#include "render/target/rectangle.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { WIDTH = 150, HEIGHT = 70 };

static struct error reason;
static struct pixels pixels, other;
static bool quad_rows; /* the order of surfaces that are made */

static inline void drop(struct pixels *dropped)
{
    attachment_release(dropped->tiles);
    if (!dropped->tiles)
        free(dropped->image.texels);
    *dropped = (struct pixels){0};
}

static uint64_t seed = 1;

static inline uint32_t random_word(void)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (uint32_t)(seed * 0x2545f4914f6cdd1dull >> 32);
}

/* A word that a target of the format can have. */
static inline uint32_t random_value(const struct format *format)
{
    if (!format || format->storage == STORAGE_RGBA8)
        return random_word();
    uint32_t bits;
    memcpy(&bits, &(float){(float)(random_word() % 1025) / 1024}, sizeof bits);
    return bits;
}

/* --- Surfaces --- */

static inline void make_color_of_size(struct pixels *made, enum triptych_surface_format number,
                                      uint32_t width, uint32_t height, uint32_t samples)
{
    drop(made);
    const struct format *format = format_find(number);
    *made = (struct pixels){.format = format, .width = width, .height = height, .quad_rows = quad_rows};
    made->tiles = attachment_create_color(format, width, height, samples, &reason);
    TEST_ASSERT_NOT_NULL_MESSAGE(made->tiles, reason.text);
}

static inline void make_color(struct pixels *made, enum triptych_surface_format number, uint32_t samples)
{
    make_color_of_size(made, number, WIDTH, HEIGHT, samples);
}

static inline void make_depth(struct pixels *made, enum triptych_depth_format format)
{
    drop(made);
    *made = (struct pixels){.depth_format = format, .width = WIDTH, .height = HEIGHT, .quad_rows = quad_rows};
    made->tiles = attachment_create_depth(format, WIDTH, HEIGHT, 1, &reason);
    TEST_ASSERT_NOT_NULL_MESSAGE(made->tiles, reason.text);
}

static inline void make_texels(struct pixels *made, enum triptych_surface_format number)
{
    drop(made);
    const struct format *format = format_find(number);
    *made = (struct pixels){.format = format, .width = WIDTH, .height = HEIGHT};
    made->image = (struct texture_image){.pitch = WIDTH + 1, .bytes = format_row_bytes(format)};
    made->image.texels = calloc(HEIGHT * (WIDTH + 1), made->image.bytes);
}

/* The same in rows of quads: quad x / 2 of row y / 2, of planes of the whole memory. */
static inline uint32_t *quad_row_word_at(const struct attachment *a, uint32_t x, uint32_t y, uint32_t plane)
{
    size_t quads = (size_t)a->memory->columns * 32, quad = y / 2 * quads + x / 2;
    size_t pixels = (size_t)a->memory->columns * a->memory->rows * 4096;
    return a->memory->words + plane * pixels + quad * 4 + y % 2 * 2 + x % 2;
}

/* A word of a sample of a pixel, by the layout of tiles (contract/layout.h) or of rows. */
static inline uint32_t *word_at(const struct pixels *p, uint32_t x, uint32_t y, uint32_t sample,
                                uint32_t plane)
{
    static const uint32_t lane[4][4] = {{0, 1, 4, 5}, {2, 3, 6, 7}, {8, 9, 12, 13}, {10, 11, 14, 15}};
    const struct attachment *a = p->tiles;
    uint32_t planes = pixels_words(p);
    if (!a)
        return (uint32_t *)texture_texel(&p->image, x, y) + plane;
    if (a->memory->quad_rows)
        return quad_row_word_at(a, x, y, sample * planes + plane);
    size_t tile = y / 64 * a->columns + x / 64;
    size_t block = y % 64 / 4 * 16 + x % 64 / 4;
    return a->memory->words + tile * a->memory->planes * 4096 + (sample * planes + plane) * 4096 +
           block * 16 + lane[y % 4][x % 4];
}

static inline void fill_random(struct pixels *p)
{
    uint32_t samples = p->tiles ? p->tiles->samples : 1, zero[4] = {0};
    TEST_ASSERT_EQUAL_INT(0, pixels_prepare(p, &reason));
    for (uint32_t y = 0; y < p->height; y++)
        for (uint32_t x = 0; x < p->width; x++) {
            pixels_write_row(p, x, y, 1, zero);
            for (uint32_t s = 0; s < samples; s++)
                for (uint32_t plane = 0; plane < pixels_words(p); plane++)
                    *word_at(p, x, y, s, plane) = random_value(p->format);
        }
}

static const enum triptych_surface_format drawn[] = {TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_R5G6B5,
                                                     TRIPTYCH_SURFACE_A16B16G16R16F, TRIPTYCH_SURFACE_G16R16};

static inline uint32_t averaged_byte_word(const struct pixels *p, uint32_t x, uint32_t y)
{
    uint32_t word = 0, samples = p->tiles->samples;
    for (int c = 0; c < 4; c++) {
        uint32_t sum = 0;
        for (uint32_t s = 0; s < samples; s++)
            sum += *word_at(p, x, y, s, 0) >> 8 * c & 255;
        word |= (sum + samples / 2) / samples << 8 * c;
    }
    return word;
}

#endif
