#include "base/minmax.h"
#include "render/target/rectangle.h"
#include "render/texture/convert.h"

#include <math.h>
#include <string.h>

/* Source pixels that are read together. */
enum { SPAN = 1024 };

/* The two neighbours of one axis, and the second one's weight. */
struct tap {
    uint32_t index[2];
    float weight;
};

/* Of pixel i of `size` ones, in a source of `source_size` pixels from `first` on. */
static struct tap find_tap(uint32_t i, uint32_t size, uint32_t first, uint32_t source_size, bool linear)
{
    double place = ((double)i + 0.5) * (double)source_size / (double)size;
    uint32_t last = first + source_size - 1;
    if (!linear || source_size == size) {
        uint32_t index = min_u32(first + (uint32_t)place, last);
        return (struct tap){{index, index}, 0};
    }
    double low = floor(place - 0.5);
    struct tap tap = {.weight = (float)(place - 0.5 - low)};
    for (int n = 0; n < 2; n++) {
        double index = fmax(0, fmin(low + n, (double)source_size - 1));
        tap.index[n] = first + (uint32_t)index;
    }
    return tap;
}

static float blend(float a, float b, float weight)
{
    return weight > 0 ? a * (1 - weight) + b * weight : a;
}

/* Pixels of a row of the source, which may be in several columns of tiles. */
static void read_span(const struct pixels *pixels, uint32_t x, uint32_t y, uint32_t count, uint32_t *row)
{
    uint32_t words = pixels_words(pixels);
    while (count) {
        uint32_t part = min_u32(count, TILE_SIZE - x % TILE_SIZE);
        pixels_read_row(pixels, x, y, part, row);
        x += part;
        count -= part;
        row += part * words;
    }
}

static void read_numbers(const struct pixels *pixels, uint32_t x, uint32_t y, uint32_t count, float *numbers)
{
    uint32_t row[4 * SPAN];
    read_span(pixels, x, y, count, row);
    if (pixels_storage(pixels) == STORAGE_RGBA8)
        format_numbers_of_bytes(row, count, numbers);
    else
        memcpy(numbers, row, count * sizeof(float[4]));
}

/* A piece of a row: the taps of its pixels, whose source pixels are first to first + count - 1. */
struct piece {
    struct tap tap[PIXELS_ROW];
    uint32_t width; /* pixels */
    uint32_t first, count;
};

/* At most `width` pixels from x on, fewer if their source is too long to be read together. */
static void find_piece(const struct pixels_copy *copy, uint32_t x, uint32_t width, struct piece *piece)
{
    *piece = (struct piece){.width = 0};
    for (uint32_t i = 0; i < width; i++) {
        struct tap tap = find_tap(x + i - copy->target.x, copy->target.width, copy->source.x,
                                  copy->source.width, copy->linear);
        if (!i)
            piece->first = tap.index[0];
        if (tap.index[1] - piece->first >= SPAN)
            return;
        piece->count = tap.index[1] - piece->first + 1;
        piece->tap[piece->width++] = tap;
    }
}

static void convert(const struct pixels_copy *copy, const uint32_t *row, uint32_t count, uint32_t *result)
{
    if (copy->to.format)
        pixels_convert_row(copy->from.format, copy->to.format, row, count, result);
    else
        memcpy(result, row, count * sizeof *row);
}

static void copy_points(const struct pixels_copy *copy, const struct piece *piece, uint32_t y,
                        uint32_t *result)
{
    uint32_t words = pixels_words(&copy->from), span[4 * SPAN], row[4 * PIXELS_ROW];
    struct tap v =
        find_tap(y - copy->target.y, copy->target.height, copy->source.y, copy->source.height, false);
    read_span(&copy->from, piece->first, v.index[0], piece->count, span);
    if (piece->count == piece->width) { /* then each pixel follows the one before it */
        convert(copy, span, piece->width, result);
        return;
    }
    for (uint32_t i = 0; i < piece->width; i++)
        memcpy(row + i * words, span + (piece->tap[i].index[0] - piece->first) * words, words * sizeof *row);
    convert(copy, row, piece->width, result);
}

static void copy_linear(const struct pixels_copy *copy, const struct piece *piece, uint32_t y,
                        uint32_t *result)
{
    float upper[4 * SPAN], lower[4 * SPAN], numbers[4 * PIXELS_ROW], *number = numbers;
    struct tap v =
        find_tap(y - copy->target.y, copy->target.height, copy->source.y, copy->source.height, true);
    read_numbers(&copy->from, piece->first, v.index[0], piece->count, upper);
    read_numbers(&copy->from, piece->first, v.index[1], piece->count, lower);
    for (uint32_t i = 0; i < piece->width; i++) {
        const struct tap *u = &piece->tap[i];
        size_t left = 4 * (size_t)(u->index[0] - piece->first),
               right = 4 * (size_t)(u->index[1] - piece->first);
        for (size_t c = 0; c < 4; c++) {
            float above = blend(upper[left + c], upper[right + c], u->weight);
            float below = blend(lower[left + c], lower[right + c], u->weight);
            *number++ = blend(above, below, v.weight);
        }
    }
    pixels_convert_numbers(copy->to.format, numbers, piece->width, result);
}

static bool is_scaled(const struct pixels_copy *copy)
{
    return copy->source.width != copy->target.width || copy->source.height != copy->target.height;
}

/* Returns true if pixels are blended: equal sizes take each pixel itself. */
static bool blends(const struct pixels_copy *copy)
{
    return copy->linear && is_scaled(copy);
}

void pixels_copy_part(const struct pixels_copy *copy, uint32_t i)
{
    struct triptych_rectangle part = pixels_part(&copy->target, i);
    uint32_t result[4 * PIXELS_ROW];
    uint32_t from_x = copy->source.x + part.x - copy->target.x;
    uint32_t from_y = copy->source.y + part.y - copy->target.y;
    if (!is_scaled(copy) && pixels_copy_tile(&copy->from, from_x, from_y, &copy->to, &part))
        return;
    for (uint32_t done = 0; done < part.width;) {
        struct piece piece;
        find_piece(copy, part.x + done, part.width - done, &piece);
        for (uint32_t y = part.y; y < part.y + part.height; y++) {
            if (blends(copy))
                copy_linear(copy, &piece, y, result);
            else
                copy_points(copy, &piece, y, result);
            pixels_write_row(&copy->to, part.x + done, y, piece.width, result);
        }
        done += piece.width;
    }
}
