/* DDS files: the description of the texture, and the offset of its texels. Layout by Microsoft's "Programming
 * Guide for DDS": a header of 128 bytes, then all levels face by face, rows without gaps. */
#ifndef COMMAND_ASSETS_DDS_H
#define COMMAND_ASSETS_DDS_H

#include "base/error.h"
#include "triptych.h"

#include <stdbool.h>

/* Returns true if the data begins like a DDS file. */
bool dds_is(const void *data, size_t bytes);

/* Reads the header of a 2D, cube (with all faces) or volume texture in a supported format. The texels are the
 * bytes from *offset to `bytes`. Returns 0, or -1 with a reason that begins with the path. */
int dds_read(const char *path, const void *data, size_t bytes, struct triptych_texture_description *texture,
             size_t *offset, struct error *error);

#endif
