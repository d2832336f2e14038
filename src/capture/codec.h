/* Bytes of a container's records. The same functions write and read them, so both directions agree.
 *
 * A writing codec appends to growing memory. A reading codec reads memory of a fixed size. All numbers are
 * little-endian. The first failure sets `failed` and the reason. Afterwards reads return zeros, and writes
 * are ignored. */
#ifndef CAPTURE_CODEC_H
#define CAPTURE_CODEC_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct codec {
    uint8_t *data;
    size_t bytes;    /* written so far, or to be read */
    size_t at;       /* reading: position of the next byte */
    size_t capacity; /* writing */
    bool reading, failed;
    struct error error;
};

/* Sets the reason, once. */
void codec_fail(struct codec *codec, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Numbers of a width in bits. They write `value`, or read a number, and return it. A number that is read and
 * exceeds `most` is a failure that names `what`; the result is then 0. */
uint32_t codec_u8(struct codec *codec, uint32_t value, uint32_t most, const char *what);
uint32_t codec_u16(struct codec *codec, uint32_t value, uint32_t most, const char *what);
uint32_t codec_u32(struct codec *codec, uint32_t value, uint32_t most, const char *what);
uint64_t codec_u64(struct codec *codec, uint64_t value, uint64_t most, const char *what);
/* The number of a resource, or NO_RESOURCE. */
void codec_resource(struct codec *codec, uint32_t *number);
void codec_floats(struct codec *codec, float *values, size_t count);
void codec_integers(struct codec *codec, int32_t *values, size_t count);

/* A string of at most `most` bytes without control characters. Null is written as an empty string, and an
 * empty string is read as null. The caller frees a string that was read. */
void codec_string(struct codec *codec, char **string, size_t most, const char *what);

#endif
