/* Conversion of video to RGB as a kernel, and its plain C.
 *
 * A picture has a plane of luma Y and two planes of chroma U and V, bytes each, with one sample of chroma for
 * 1, 2 or 4 pixels. The choice decides the matrix, the range, the subsampling and the places of the channels
 * in the 32-bit pixels of the result. An element is four pixels of a row.
 *
 * Source: Rec. ITU-R BT.601-7, BT.709-6 and BT.2020-2. R = Y + 2(1 - Kr) V, B = Y + 2(1 - Kb) U, and
 * G = (Y - Kr R - Kb B) / (1 - Kr - Kb), with Y from 0 to 1 and U and V from -1/2 to 1/2. */
#ifndef CLIENTS_FILTER_CONVERT_H
#define CLIENTS_FILTER_CONVERT_H

#include "bench/clients/kernel.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum convert_matrix { CONVERT_BT601, CONVERT_BT709, CONVERT_BT2020, CONVERT_MATRICES };

struct convert_choice {
    enum convert_matrix matrix;
    bool full;    /* 0 to 255; else luma is 16 to 235 and chroma 16 to 240 */
    int across;   /* pixels of a row for each sample of chroma: 1, 2 or 4 */
    int down;     /* rows for each row of chroma: 1 or 2 */
    int place[4]; /* byte of the pixel for red, green, blue and alpha: 0 to 3 each once */
};

/* The planes have at least 3 readable bytes after the last sample. */
struct convert_picture {
    int width, height;
    const uint8_t *y, *u, *v;
    int y_pitch, u_pitch, v_pitch; /* bytes from one row to the next */
};

/* The row of a run. */
struct convert_job {
    const uint8_t *y, *u, *v;
};

/* The matrix in fixed point: a channel is (y * luma + u * u_factor + v * v_factor + offset) >> CONVERT_BITS,
 * clamped to bytes. Every factor fits in 16 bits. */
enum { CONVERT_BITS = 13 };
struct convert_factors {
    int luma;
    int u[3], v[3], offset[3]; /* of red, green, blue */
};
struct convert_factors convert_factors(const struct convert_choice *choice);

extern const struct kernel_text convert_kernel;
enum { CONVERT_STRIDE = 16 };

void convert_record(struct ir *ir, const void *choice);
void convert_execute(const void *choice, const struct kernel_arguments *call, unsigned stride);

/* Converts with a kernel to rows of `pitch` bytes. Returns 0, or -1 if memory is refused. */
int convert_kernel_picture(const struct kernel *kernel, const struct convert_choice *choice,
                           const struct convert_picture *picture, uint8_t *out, size_t pitch);

/* Converts with plain C. */
void convert_plain_picture(const struct convert_choice *choice, const struct convert_picture *picture,
                           uint8_t *out, size_t pitch);

#endif
