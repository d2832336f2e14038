/* Containers around bytes that are not one: compression and checksums stop most damage at the door
 * (frame.c). */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_FRAME_H
#define TESTS_COMMAND_FUZZ_TARGETS_FRAME_H

#include <stddef.h>
#include <stdint.h>

/* A container with one chunk of these contents, uncompressed, and an end that records one frame. If the bytes
 * begin like a container: a copy with all checksums corrected. The caller frees it. */
uint8_t *frame_container(const uint8_t *data, size_t bytes, int recording, size_t *framed);

#endif
