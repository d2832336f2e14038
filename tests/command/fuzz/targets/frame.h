/* Builds containers around any bytes. Compression and checksums make readers refuse most damaged containers
 * early, so fuzzers would not reach the code after these checks (frame.c). */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_FRAME_H
#define TESTS_COMMAND_FUZZ_TARGETS_FRAME_H

#include <stddef.h>
#include <stdint.h>

/* Returns a container with one uncompressed chunk of these contents, and an end that records one frame. If
 * the bytes begin like a container, returns a copy with all checksums corrected. The caller frees the
 * result. */
uint8_t *frame_container(const uint8_t *data, size_t bytes, int recording, size_t *framed);

#endif
