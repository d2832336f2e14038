#include "base/bits.h"
#include "base/minmax.h"
#include "render/target/rectangle.h"

#include <assert.h>
#include <math.h>
#include <stdalign.h>
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

/* --- Blends --- */

/* Rows of elements, as spec/blit/blend.h reads them. */
struct elements {
    alignas(64) uint32_t left[PIXELS_ROW], right[PIXELS_ROW], weight[PIXELS_ROW];
    uint32_t count;
};

static_assert((int)PIXELS_ROW == (int)BLIT_BLEND_PIXELS, "a call has a row of pixels");

static void find_elements(const struct piece *piece, struct elements *elements)
{
    elements->count = (piece->width + LANES_MAXIMUM - 1) / LANES_MAXIMUM * LANES_MAXIMUM;
    for (uint32_t i = 0; i < elements->count; i++) {
        const struct tap *tap = &piece->tap[i < piece->width ? i : piece->width - 1];
        elements->left[i] = tap->index[0] - piece->first;
        elements->right[i] = tap->index[1] - piece->first;
        elements->weight[i] = bits_of_float(tap->weight);
    }
}

/* The routine's results as a row of the format. */
static void finish_row(const struct pixels_copy *copy, const uint32_t *blended, uint32_t count,
                       uint32_t *result)
{
    float numbers[4 * PIXELS_ROW];
    if (!copy->blend->key.blit.number_results) {
        memcpy(result, blended, count * sizeof *result);
        return;
    }
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < 4; c++)
            numbers[4 * i + c] = bits_to_float(blended[c * BLIT_BLEND_PIXELS + i]);
    pixels_convert_numbers(copy->to.format, numbers, count, result);
}

static void copy_blended(const struct pixels_copy *copy, const struct piece *piece,
                         const struct elements *elements, uint32_t y, uint32_t *result)
{
    uint32_t upper[4 * SPAN], lower[4 * SPAN];
    alignas(64) uint32_t blended[4 * BLIT_BLEND_PIXELS];
    struct tap v =
        find_tap(y - copy->target.y, copy->target.height, copy->source.y, copy->source.height, true);
    const struct blit_job job = {
        .row = {upper, lower}, .weight = v.weight, .missing = pixels_missing_bits(copy->to.format)};
    read_span(&copy->from, piece->first, v.index[0], piece->count, upper);
    read_span(&copy->from, piece->first, v.index[1], piece->count, lower);
    blit_run(copy->blend, &job, elements->left, blended, elements->count);
    finish_row(copy, blended, piece->width, result);
}

/* --- Parts --- */

static bool is_scaled(const struct pixels_copy *copy)
{
    return copy->source.width != copy->target.width || copy->source.height != copy->target.height;
}

/* Equal sizes take each pixel itself. */
int pixels_acquire_copy(struct pixels_copy *copy, const struct blits *blits, struct error *error)
{
    copy->blend = NULL;
    if (!copy->linear || !is_scaled(copy))
        return 0;
    const struct blit_key key = {.operation = BLIT_BLEND,
                                 .numbers = pixels_words(&copy->from) > 1,
                                 .number_results = !pixels_are_plain_words(copy->to.format)};
    copy->blend = blit_acquire(blits, key, error);
    return copy->blend ? 0 : -1;
}

/* At most `width` pixels from x on, of all rows of a part. Returns their number. */
static uint32_t copy_piece(const struct pixels_copy *copy, const struct triptych_rectangle *part, uint32_t x,
                           uint32_t width)
{
    uint32_t result[4 * PIXELS_ROW];
    struct piece piece;
    struct elements elements;
    find_piece(copy, x, width, &piece);
    if (copy->blend)
        find_elements(&piece, &elements);
    for (uint32_t y = part->y; y < part->y + part->height; y++) {
        if (copy->blend)
            copy_blended(copy, &piece, &elements, y, result);
        else
            copy_points(copy, &piece, y, result);
        pixels_write_row(&copy->to, x, y, piece.width, result);
    }
    return piece.width;
}

void pixels_copy_part(const struct pixels_copy *copy, uint32_t i)
{
    struct triptych_rectangle part = pixels_part(&copy->target, i);
    uint32_t from_x = copy->source.x + part.x - copy->target.x;
    uint32_t from_y = copy->source.y + part.y - copy->target.y;
    if (!is_scaled(copy) && pixels_copy_tile(&copy->from, from_x, from_y, &copy->to, &part))
        return;
    for (uint32_t done = 0; done < part.width;)
        done += copy_piece(copy, &part, part.x + done, part.width - done);
}
