/* Rows of texels between the application's memory and the storage of textures and targets.
 *
 * The definitions are those of render/texture/format.h. Formats whose channels have at most 8 unsigned bits
 * are converted four texels at a time, by integer multiplication: round(v * 255 / (2^n - 1)) and its inverse
 * are (v * multiplier + addend) >> drop with constants for each n, which are exact for all v. */
#ifndef RENDER_TEXTURE_CONVERT_H
#define RENDER_TEXTURE_CONVERT_H

#include "render/texture/format.h"

/* `count` texels from the bytes of an uncompressed format to the format's storage. */
void format_decode_row(const struct format *format, const void *data, uint32_t count, void *texels);

/* `count` texels of a storage to the bytes of an uncompressed format. A byte b of STORAGE_RGBA8 is the number
 * b / 255. A number becomes the nearest value that the format has; bits that belong to no channel are 0. */
void format_encode_row(const struct format *format, enum storage storage, const void *texels, uint32_t count,
                       void *data);

/* Texels in memory that are words of STORAGE_RGBA8, or these with red and blue exchanged. */
struct format_words {
    bool exchanged;
    uint32_t kept; /* their bits that belong to a channel */
};

/* Returns true if the format has such texels. */
bool format_is_words(const struct format *format, struct format_words *words);

/* Bytes to numbers: b / 255 in binary32. */
void format_numbers_of_bytes(const uint32_t *words, uint32_t count, float *numbers);

#endif
