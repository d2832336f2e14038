/* Animated PNG: libpng encodes each frame as a picture, and its chunks are copied. Chunks of the animation
 * are added: acTL once, fcTL before each frame, and fdAT instead of IDAT in all frames but the first. Readers
 * without support for animations show the first frame. */
#include "image/animation_part.h"
#include "image/png.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { SIGNATURE = 8, LENGTH = 4, TYPE = 4, CHECK = 4, ACTL_BYTES = 8, FCTL_BYTES = 26 };

static void put16(uint8_t *out, unsigned value)
{
    out[0] = (uint8_t)(value >> 8);
    out[1] = (uint8_t)value;
}

static void put32(uint8_t *out, uint32_t value)
{
    put16(out, value >> 16);
    put16(out + 2, value & 0xffff);
}

static uint32_t get32(const uint8_t *in)
{
    return (uint32_t)in[0] << 24 | (uint32_t)in[1] << 16 | (uint32_t)in[2] << 8 | in[3];
}

/* --- Chunks --- */

/* The cyclic redundancy check of PNG's annex D, without the first and last inversion. */
static uint32_t check(uint32_t crc, const void *data, size_t bytes)
{
    const uint8_t *in = data;
    for (size_t i = 0; i < bytes; i++) {
        crc ^= in[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return crc;
}

/* Writes a chunk whose contents have two parts. */
static int put_chunk(struct animation *animation, const char *type, const void *first, size_t first_bytes,
                     const void *rest, size_t rest_bytes, struct error *error)
{
    uint8_t head[LENGTH + TYPE], tail[CHECK];
    put32(head, (uint32_t)(first_bytes + rest_bytes));
    memcpy(head + LENGTH, type, TYPE);
    put32(tail, ~check(check(check(UINT32_MAX, type, TYPE), first, first_bytes), rest, rest_bytes));
    return file_append(&animation->output, head, sizeof head, error) ||
           file_append(&animation->output, first, first_bytes, error) ||
           file_append(&animation->output, rest, rest_bytes, error) ||
           file_append(&animation->output, tail, sizeof tail, error);
}

/* The number of frames, and that of repetitions: 0 is endless. */
static int put_animation(struct animation *animation, struct error *error)
{
    uint8_t contents[ACTL_BYTES] = {0};
    put32(contents, animation->frames);
    return put_chunk(animation, "acTL", contents, sizeof contents, "", 0, error);
}

/* The frame's size, place and time. The last two bytes mean that it replaces the picture before it. */
static int put_frame(struct animation *animation, struct error *error)
{
    uint8_t contents[FCTL_BYTES] = {0};
    put32(contents, animation->sequence++);
    put32(contents + 4, animation->width);
    put32(contents + 8, animation->height);
    put16(contents + 20, 1);
    put16(contents + 22, animation->rate);
    return put_chunk(animation, "fcTL", contents, sizeof contents, "", 0, error);
}

static int put_data(struct animation *animation, const uint8_t *data, size_t bytes, struct error *error)
{
    uint8_t sequence[4];
    if (!animation->added)
        return put_chunk(animation, "IDAT", data, bytes, "", 0, error);
    put32(sequence, animation->sequence++);
    return put_chunk(animation, "fdAT", sequence, sizeof sequence, data, bytes, error);
}

/* --- Frames --- */

/* Copies all chunks of data. `at` follows the header of the picture. */
static int copy_data(struct animation *animation, const uint8_t *at, const uint8_t *end, struct error *error)
{
    while (end - at >= LENGTH + TYPE + CHECK) {
        size_t bytes = get32(at);
        if (!memcmp(at + LENGTH, "IDAT", TYPE) && put_data(animation, at + LENGTH + TYPE, bytes, error))
            return -1;
        at += LENGTH + TYPE + bytes + CHECK;
    }
    return 0;
}

int apng_frame(struct animation *animation, const uint32_t *rgba, struct error *error)
{
    enum { HEADER = SIGNATURE + LENGTH + TYPE + 13 + CHECK };
    void *encoded;
    size_t bytes;
    if (png_encode(animation->path, animation->width, animation->height, rgba, animation->level, &encoded,
                   &bytes, error))
        return -1;
    const uint8_t *png = encoded;
    int bad = 0;
    if (!animation->added)
        bad = file_append(&animation->output, png, HEADER, error) || put_animation(animation, error);
    bad = bad || put_frame(animation, error) || copy_data(animation, png + HEADER, png + bytes, error);
    free(encoded);
    return bad ? -1 : 0;
}

int apng_end(struct animation *animation, struct error *error)
{
    return put_chunk(animation, "IEND", "", 0, "", 0, error) ? -1 : 0;
}
