/* Copies between images of four numbers a pixel, scaled to another size.
 *
 * A pixel's centre lies in the source where its own lies in the part that is copied to: at ((x + 1/2) *
 * source width / width, ...). Point takes the pixel around that place; linear blends the four around it, none
 * from outside of the part, weighted in binary32 by their distances, horizontally then vertically. */
#ifndef RENDER_TARGET_COPY_H
#define RENDER_TARGET_COPY_H

#include "triptych.h"

/* From a part of a source of `width` pixels a row to `rows` of the target part's size. */
void copy_scaled(const float *source, uint32_t width, const struct triptych_rectangle *from,
                 const struct triptych_rectangle *to, enum triptych_copy_filter filter, float *rows);

#endif
