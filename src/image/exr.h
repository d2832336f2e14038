/* OpenEXR pictures, written through OpenEXR's C library, OpenEXRCore. */
#ifndef IMAGE_EXR_H
#define IMAGE_EXR_H

#include "base/error.h"

#include <stddef.h>

enum exr_depth { EXR_FLOAT, EXR_HALF }; /* binary32, binary16 (rounded to nearest even) */

/* A channel, such as "R" or "Z". The value of pixel (x, y), y down from the top, is values[(y * width + x) *
 * step]. */
struct exr_channel {
    const char *name;
    const float *values;
    size_t step;
    enum exr_depth depth;
};

/* Writes an image of 1 to 8192 pixels a side in scan lines with ZIP compression, atomically (base/file.h).
 * Returns 0, or -1 with a reason that begins with the path. */
int exr_save(const char *path, unsigned width, unsigned height, const struct exr_channel *channels,
             size_t count, struct error *error);

#endif
