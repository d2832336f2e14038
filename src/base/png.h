/* PNG pictures as rows from the top of RGBA8 words, red in the lowest byte, alpha not multiplied in. */
#ifndef BASE_PNG_H
#define BASE_PNG_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

enum { PNG_SIDE_MAXIMUM = 8192 };

/* Reads any PNG: palettes, grey, 16 bits a channel (rounded to 8), transparency, interlacing. Sample values
 * are taken as they are: no gamma or colour profile is applied. *rgba is the caller's to free; null on
 * failure. Refused: what is no PNG, damaged or cut off, or has more than PNG_SIDE_MAXIMUM pixels on a side.
 * Returns 0, or -1 with the reason, which begins with the path. */
int png_load(const char *path, unsigned *width, unsigned *height, uint32_t **rgba, struct error *error);

/* The same of a file in memory; `path` begins the reason. */
int png_decode(const char *path, const void *data, size_t bytes, unsigned *width, unsigned *height,
               uint32_t **rgba, struct error *error);

/* Writes an RGBA8 PNG, whole or not at all (base/file.h). Returns 0, or -1 with the reason. */
int png_save(const char *path, unsigned width, unsigned height, const uint32_t *rgba, struct error *error);

#endif
