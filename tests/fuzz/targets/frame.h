/* Containers around bytes that are not one: compression and checksums stop most damage at the door (frame.c). */
#ifndef FUZZ_FRAME_H
#define FUZZ_FRAME_H

#include <stddef.h>
#include <stdint.h>

/* A container with one chunk of these contents, uncompressed, and an end that says that it has a frame; or, of bytes that
 * begin like one, a copy with all checksums put right. The caller frees it. */
uint8_t *frame_container(const uint8_t *data, size_t bytes, int recording, size_t *framed);

#endif
