#include "capture/codec.h"
#include "capture/resource.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void codec_fail(struct codec *codec, const char *format, ...)
{
    char text[ERROR_CAPACITY];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    error_set(&codec->error, "%s", text);
    codec->failed = true;
}

static void append(struct codec *codec, const void *bytes, size_t count)
{
    if (codec->failed || !count)
        return;
    if (count > codec->capacity - codec->bytes) {
        size_t capacity = 2 * codec->capacity + count;
        uint8_t *larger = realloc(codec->data, capacity);
        if (!larger) {
            codec_fail(codec, "not enough memory");
            return;
        }
        codec->data = larger;
        codec->capacity = capacity;
    }
    memcpy(codec->data + codec->bytes, bytes, count);
    codec->bytes += count;
}

/* Any bytes, as they are. */
static void codec_bytes(struct codec *codec, void *bytes, size_t count)
{
    if (!codec->reading) {
        append(codec, bytes, count);
        return;
    }
    if (!codec->failed && count > codec->bytes - codec->at)
        codec_fail(codec, "found the chunk's end, expected %zu bytes more",
                   count - (codec->bytes - codec->at));
    if (codec->failed) {
        memset(bytes, 0, count);
        return;
    }
    memcpy(bytes, codec->data + codec->at, count);
    codec->at += count;
}

/* A number of `size` bytes, 1 to 8. */
static uint64_t code_number(struct codec *codec, uint64_t value, size_t size)
{
    uint8_t bytes[8];
    for (size_t i = 0; i < size; i++)
        bytes[i] = (uint8_t)(value >> 8 * i);
    codec_bytes(codec, bytes, size);
    value = 0;
    for (size_t i = 0; i < size; i++)
        value |= (uint64_t)bytes[i] << 8 * i;
    return value;
}

uint64_t codec_u64(struct codec *codec, uint64_t value, uint64_t most, const char *what)
{
    value = code_number(codec, value, 8);
    if (!codec->reading || value <= most)
        return value;
    codec_fail(codec, "found %s %" PRIu64 ", expected at most %" PRIu64, what, value, most);
    return 0;
}

static uint32_t code_small(struct codec *codec, uint32_t value, size_t size, uint32_t most, const char *what)
{
    value = (uint32_t)code_number(codec, value, size);
    if (!codec->reading || value <= most)
        return value;
    codec_fail(codec, "found %s %" PRIu32 ", expected at most %" PRIu32, what, value, most);
    return 0;
}

uint32_t codec_u8(struct codec *codec, uint32_t value, uint32_t most, const char *what)
{
    return code_small(codec, value, 1, most, what);
}

uint32_t codec_u16(struct codec *codec, uint32_t value, uint32_t most, const char *what)
{
    return code_small(codec, value, 2, most, what);
}

uint32_t codec_u32(struct codec *codec, uint32_t value, uint32_t most, const char *what)
{
    return code_small(codec, value, 4, most, what);
}

void codec_resource(struct codec *codec, uint32_t *number)
{
    *number = codec_u32(codec, *number, NO_RESOURCE, "resource");
}

/* Bits are copied unchanged, also those of NaN. */
void codec_floats(struct codec *codec, float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, values + i, sizeof bits);
        bits = (uint32_t)code_number(codec, bits, 4);
        memcpy(values + i, &bits, sizeof bits);
    }
}

void codec_integers(struct codec *codec, int32_t *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        values[i] = (int32_t)(uint32_t)code_number(codec, (uint32_t)values[i], 4);
}

static char *read_string(struct codec *codec, uint32_t length, const char *what)
{
    char *string = calloc((size_t)length + 1, 1);
    if (!string) {
        codec_fail(codec, "not enough memory");
        return NULL;
    }
    codec_bytes(codec, string, length);
    for (uint32_t i = 0; i < length && !codec->failed; i++)
        if ((unsigned char)string[i] < ' ' || string[i] == 0x7f)
            codec_fail(codec, "found %s with a control character, expected none", what);
    return string;
}

void codec_string(struct codec *codec, char **string, size_t most, const char *what)
{
    uint32_t length = codec->reading || !*string ? 0 : (uint32_t)strlen(*string);
    length = codec_u16(codec, length, (uint32_t)most, what);
    if (!codec->reading)
        append(codec, *string, length);
    else
        *string = codec->failed || !length ? NULL : read_string(codec, length, what);
}
