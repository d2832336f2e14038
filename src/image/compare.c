#include "image/compare.h"
#include "base/minmax.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

static bool depths_differ(const struct picture *first, const struct picture *second, size_t i)
{
    return first->depth && memcmp(first->depth + i, second->depth + i, sizeof *first->depth);
}

static bool stencils_differ(const struct picture *first, const struct picture *second, size_t i)
{
    return first->stencil && first->stencil[i] != second->stencil[i];
}

static bool numbers_differ(const struct picture *first, const struct picture *second, size_t i)
{
    size_t each = first->numbers_each;
    return first->numbers &&
           memcmp(first->numbers + i * each, second->numbers + i * each, each * sizeof *first->numbers);
}

static void note_number(const struct picture *first, const struct picture *second, size_t i,
                        struct difference *difference)
{
    const float *a = first->numbers + i * first->numbers_each, *b = second->numbers + i * first->numbers_each;
    unsigned place = 0;
    while (!memcmp(a + place, b + place, sizeof *a))
        place++;
    difference->number_place = place;
    difference->number[0] = a[place];
    difference->number[1] = b[place];
}

/* The largest difference among the four channels. */
static uint32_t distance(uint32_t a, uint32_t b)
{
    uint32_t largest = 0;
    for (int shift = 0; shift < 32; shift += 8) {
        int channel = (int)(a >> shift & 255) - (int)(b >> shift & 255);
        uint32_t size = (uint32_t)(channel < 0 ? -channel : channel);
        largest = size > largest ? size : largest;
    }
    return largest;
}

static void note_first(const struct picture *first, const struct picture *second, size_t i,
                       struct difference *difference)
{
    difference->x = (unsigned)(i % first->width);
    difference->y = (unsigned)(i / first->width);
    difference->color[0] = first->color[i];
    difference->color[1] = second->color[i];
    if (first->depth) {
        difference->depth[0] = first->depth[i];
        difference->depth[1] = second->depth[i];
    }
    if (first->stencil) {
        difference->stencil[0] = first->stencil[i];
        difference->stencil[1] = second->stencil[i];
    }
    if (numbers_differ(first, second, i))
        note_number(first, second, i, difference);
}

bool compare_pictures(const struct picture *first, const struct picture *second,
                      struct difference *difference)
{
    memset(difference, 0, sizeof *difference);
    size_t count = (size_t)first->width * first->height;
    if (!memcmp(first->color, second->color, count * sizeof *first->color) &&
        (!first->depth || !memcmp(first->depth, second->depth, count * sizeof *first->depth)) &&
        (!first->stencil || !memcmp(first->stencil, second->stencil, count)) &&
        (!first->numbers ||
         !memcmp(first->numbers, second->numbers, count * first->numbers_each * sizeof *first->numbers)))
        return false;
    bool noted = false;
    for (size_t i = 0; i < count; i++) {
        uint32_t apart = distance(first->color[i], second->color[i]);
        bool deep = depths_differ(first, second, i), marked = stencils_differ(first, second, i);
        bool numbered = numbers_differ(first, second, i);
        if ((apart || deep || marked || numbered) && !noted)
            note_first(first, second, i, difference);
        noted |= apart || deep || marked || numbered;
        difference->number_pixels += numbered;
        difference->stencil_pixels += marked;
        difference->color_pixels += apart != 0;
        difference->depth_pixels += deep;
        if (apart > difference->color_distance)
            difference->color_distance = apart;
    }
    return true;
}

static uint32_t square_sum(uint32_t a, uint32_t b)
{
    uint32_t sum = 0;
    for (int shift = 0; shift < 32; shift += 8) {
        int channel = (int)(a >> shift & 255) - (int)(b >> shift & 255);
        sum += (uint32_t)(channel * channel);
    }
    return sum;
}

struct compare_distance compare_distance(const struct picture *first, const struct picture *second,
                                         uint32_t tolerance)
{
    struct compare_distance result = {0};
    const size_t count = (size_t)first->width * first->height;
    uint64_t squares = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t apart = distance(first->color[i], second->color[i]);
        result.pixels += apart > tolerance;
        result.largest = max_u32(result.largest, apart);
        squares += square_sum(first->color[i], second->color[i]);
    }
    result.mean_square = count ? (double)squares / (4 * (double)count) : 0;
    return result;
}

double compare_psnr(const struct compare_distance *distance)
{
    return 10 * log10(255.0 * 255 / distance->mean_square);
}

enum { DARKENING = 4, FAINTEST_DIFFERENCE = 96 };

static const uint32_t opaque = 0xff000000, pure_blue = 0x00ff0000;

static uint32_t grey(uint32_t rgba)
{
    uint32_t brightness = ((rgba & 255) * 2 + (rgba >> 8 & 255) * 5 + (rgba >> 16 & 255)) / 8 / DARKENING;
    return brightness * 0x010101;
}

void compare_paint(const struct picture *first, const struct picture *second, uint32_t *painting)
{
    size_t count = (size_t)first->width * first->height;
    for (size_t i = 0; i < count; i++) {
        uint32_t apart = distance(first->color[i], second->color[i]);
        uint32_t color = grey(first->color[i]);
        if (apart)
            color = FAINTEST_DIFFERENCE + apart * (255 - FAINTEST_DIFFERENCE) / 255;
        else if (depths_differ(first, second, i) || stencils_differ(first, second, i) ||
                 numbers_differ(first, second, i))
            color = pure_blue;
        painting[i] = color | opaque;
    }
}
