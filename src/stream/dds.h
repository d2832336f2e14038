/* DDS files: what texture one describes, and where its texels are. The layout is that of Microsoft's
 * "Programming Guide for DDS": a header of 128 bytes, then face by face all levels, rows without gaps. */
#ifndef STREAM_DDS_H
#define STREAM_DDS_H

#include "base/error.h"
#include "triptych.h"

/* Whether the file begins like a DDS file. */
int dds_is(const void *data, size_t bytes);

/* Reads the header: 2D, cube (with all faces) and volume textures of the supported formats of textures. The
 * texels are all that follows it: *offset to `bytes`. Returns 0, or -1 with the reason, which begins with the
 * path. */
int dds_read(const char *path, const void *data, size_t bytes, struct triptych_texture_description *texture,
             size_t *offset, struct error *error);

#endif
