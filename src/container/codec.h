/* Bytes of a container's records, written and read by the same functions, so that both directions cannot disagree.
 *
 * A codec that writes appends to memory that grows; one that reads goes through memory with an end. Everything is
 * little-endian. The first thing that is wrong stays: it sets `failed` and the reason, and everything that is coded
 * behind it is zero when it is read, and left out when it is written. */
#ifndef CONTAINER_CODEC_H
#define CONTAINER_CODEC_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct codec {
    uint8_t *data;
    size_t bytes;    /* written so far, or in all */
    size_t at;       /* reading: the next one */
    size_t capacity; /* writing */
    bool reading, failed;
    struct error error;
};

/* Sets the reason, once. */
void codec_fail(struct codec *codec, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Any bytes, as they are. */
void code_bytes(struct codec *codec, void *bytes, size_t count);

/* Numbers of as many bits: write the value, or read one; either way the result is what it is now. One that is read and
 * larger than `most` is refused, and 0: `what` names it. */
uint32_t code_u8(struct codec *codec, uint32_t value, uint32_t most, const char *what);
uint32_t code_u16(struct codec *codec, uint32_t value, uint32_t most, const char *what);
uint32_t code_u32(struct codec *codec, uint32_t value, uint32_t most, const char *what);
uint64_t code_u64(struct codec *codec, uint64_t value, uint64_t most, const char *what);
void code_floats(struct codec *codec, float *values, size_t count);
void code_integers(struct codec *codec, int32_t *values, size_t count);

/* A string of at most `most` bytes without zeros, which the caller frees when it was read; null is written as an empty
 * one, and read again. */
void code_string(struct codec *codec, char **string, size_t most, const char *what);

#endif
