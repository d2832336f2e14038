/* PNG pictures as rows of RGBA8 words from the top: red in the lowest byte, colours not multiplied by alpha.
 */
#ifndef IMAGE_PNG_H
#define IMAGE_PNG_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

enum { PNG_SIDE_MAXIMUM = 8192 };

/* Levels of compression are zlib's: 0 stores the rows, 1 is fast, 9 is small. Levels from 6 on also choose a
 * filter for each row. That takes about five times as long as level 1, for files three quarters the size. */
enum { PNG_LEVEL_DEFAULT = 1, PNG_LEVEL_MAXIMUM = 9 };

/* Reads any PNG: palettes, grey, 16 bits a channel (rounded to 8), transparency, interlacing. No gamma or
 * colour profile is applied. The caller frees *rgba, which is null on failure. Fails if the file is not a
 * PNG, is damaged or cut off, or has more than PNG_SIDE_MAXIMUM pixels a side. Returns 0, or -1 with a reason
 * that begins with the path. */
int png_load(const char *path, unsigned *width, unsigned *height, uint32_t **rgba, struct error *error);

/* The same for a file of one picture: an animation (APNG) of several is refused. png_load reads its first.
 */
int png_load_single(const char *path, unsigned *width, unsigned *height, uint32_t **rgba,
                    struct error *error);

/* The same as png_load for a file in memory; `path` begins the reason. */
int png_decode(const char *path, const void *data, size_t bytes, unsigned *width, unsigned *height,
               uint32_t **rgba, struct error *error);

/* Encodes an RGBA8 PNG of a level in memory, which the caller frees; `path` begins the reason. All of its
 * chunks of data are IDAT, and the first is IHDR. Returns 0, or -1 with the reason and *data null. */
int png_encode(const char *path, unsigned width, unsigned height, const uint32_t *rgba, unsigned level,
               void **data, size_t *bytes, struct error *error);

/* Writes an RGBA8 PNG of the default level, atomically (base/file.h). Returns 0, or -1 with the reason. */
int png_save(const char *path, unsigned width, unsigned height, const uint32_t *rgba, struct error *error);

/* The same with a level from 0 to PNG_LEVEL_MAXIMUM. */
int png_save_level(const char *path, unsigned width, unsigned height, const uint32_t *rgba, unsigned level,
                   struct error *error);

#endif
