/* Rectangles of pixels: to and from the application's memory, and from one surface to another.
 *
 * A row of pixels is converted while it is in the first cache; there is no copy of a whole image, except for
 * copies within one surface. Work is split along the tiles of the surface that is written, or that is read
 * into memory, so that several threads can share it.
 *
 * Conversion. Between bytes, a value is rounded to the nearest one that the format has, halves up. A byte b
 * is the number b / 255. Numbers are written to a format of targets as a draw writes them
 * (render/target/color.h), and to another format as render/texture/format.h defines it. sRGB is not decoded.
 *
 * Words of depth surfaces in memory are little-endian and have the form that Direct3D 9 documents: depth in
 * the high bits, stencil in the low ones, in two bytes for D16 and D15S1 and four for the others. */
#ifndef RENDER_TARGET_RECTANGLE_H
#define RENDER_TARGET_RECTANGLE_H

#include "render/blit/blit.h"
#include "render/target/pixels.h"
#include "triptych.h"

/* Returns true if memory can have the format: an uncompressed one of colours. */
bool pixels_is_memory_format(const struct format *format);

/* Bytes of a pixel in memory. A null format: those of a depth surface. */
size_t pixels_memory_bytes(const struct pixels *pixels, const struct format *format);

/* A row of one colour format as a row of another one; the same conversion of numbers. At most PIXELS_ROW
 * pixels. */
void pixels_convert_row(const struct format *from, const struct format *to, const uint32_t *row,
                        uint32_t count, uint32_t *result);

/* A row of pixels as four numbers each; depth is the same number in all of them. At most PIXELS_ROW pixels.
 */
void pixels_row_numbers(const struct pixels *pixels, const uint32_t *row, uint32_t count, float *numbers);

/* Parts of a rectangle along the grid of tiles: their number, and part i. */
uint32_t pixels_parts(const struct triptych_rectangle *rectangle);
struct triptych_rectangle pixels_part(const struct triptych_rectangle *rectangle, uint32_t i);

/* A rectangle and its pixels in memory. `format` is null for depth. */
struct pixels_memory {
    struct pixels pixels;
    struct triptych_rectangle rectangle;
    const struct format *format;
    uint8_t *data;   /* of the rectangle's first pixel; only read by pixels_write_part */
    ptrdiff_t pitch; /* bytes from a row to the next; negative: rows are upside down */
};
void pixels_read_part(const struct pixels_memory *memory, uint32_t i);
void pixels_write_part(const struct pixels_memory *memory, uint32_t i);

/* A copy of a rectangle, scaled to the size of the other one (render/target/copy.c). A pixel's centre lies in
 * the source where its own lies in the rectangle that is copied to: at ((x + 1/2) * source width / width,
 * ...). Point takes the pixel around that place; linear blends the four around it, none from outside of the
 * source rectangle (spec/blit/blend.h). Depth has the same format in both, and is copied by point. The pixels
 * do not overlap. Part i is one of the rectangle that is written. */
struct pixels_copy {
    struct pixels from, to;
    struct triptych_rectangle source, target;
    bool linear;
    const struct routine *blend; /* null: no pixels are blended */
};

/* Finds the routine of a copy, to be released with blit_release. Returns 0, or -1 with the reason. */
int pixels_acquire_copy(struct pixels_copy *copy, const struct blits *blits, struct error *error);

void pixels_copy_part(const struct pixels_copy *copy, uint32_t i);

/* Returns true if a row of the format is words of bytes whose channels have 8 bits each or are 1. The bits of
 * those that are 1. */
bool pixels_are_plain_words(const struct format *format);
uint32_t pixels_missing_bits(const struct format *format);

/* A row of numbers as a row of a format. At most PIXELS_ROW pixels. */
void pixels_convert_numbers(const struct format *to, const float *numbers, uint32_t count, uint32_t *result);

#endif
