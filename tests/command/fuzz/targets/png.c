/* PNG pictures. Wrong checksums make the reader refuse most damaged files, so a copy with correct checksums
 * is read too. */
#include "image/png.h"
#include "tests/command/fuzz/targets/target.h"

#include <string.h>

enum { SIGNATURE = 8, CHUNK = 12, PIXELS = 1 << 20 };

static uint32_t word(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* Computes the CRC of PNG bit by bit. */
static uint32_t checksum(const uint8_t *data, size_t bytes)
{
    uint32_t sum = 0xffffffff;
    for (size_t i = 0; i < bytes; i++) {
        sum ^= data[i];
        for (int bit = 0; bit < 8; bit++)
            sum = sum >> 1 ^ (sum & 1 ? 0xedb88320 : 0);
    }
    return ~sum;
}

static void mend_checksums(uint8_t *data, size_t bytes)
{
    for (size_t at = SIGNATURE; bytes - at >= CHUNK; at += CHUNK + word(data + at)) {
        size_t length = word(data + at);
        if (length > bytes - at - CHUNK)
            return;
        uint32_t sum = checksum(data + at + 4, length + 4);
        for (int i = 0; i < 4; i++)
            data[at + 8 + length + (size_t)i] = (uint8_t)(sum >> (24 - 8 * i));
    }
}

/* Decodes the picture and checks that it has all pixels. */
static void decode(const uint8_t *data, size_t bytes)
{
    struct error error = {{0}};
    unsigned width = 0, height = 0;
    uint32_t *rgba, sum = 0;
    if (png_decode("fuzz.png", data, bytes, &width, &height, &rgba, &error)) {
        expect(!rgba, "pixels of a refused picture");
        expect_refusal(&error, "fuzz.png");
        return;
    }
    fuzz_note(data[SIGNATURE + 16] | data[SIGNATURE + 17] << 8 | data[SIGNATURE + 20] << 16);
    expect(rgba && !error.text[0], "%s", error.text);
    expect(width && height && width <= PNG_SIDE_MAXIMUM && height <= PNG_SIDE_MAXIMUM, "%u x %u", width,
           height);
    for (size_t i = 0; i < (size_t)width * height; i++)
        sum += rgba[i];
    *(volatile uint32_t *)rgba = sum;
    free(rgba);
}

/* Returns 1 if the picture is small. Large pictures need a second each and reach no other code. */
static int is_small(const uint8_t *data, size_t bytes)
{
    return bytes < SIGNATURE + CHUNK + 13 ||
           (uint64_t)word(data + SIGNATURE + 8) * word(data + SIGNATURE + 12) <= PIXELS ||
           word(data + SIGNATURE + 8) > PNG_SIDE_MAXIMUM || word(data + SIGNATURE + 12) > PNG_SIDE_MAXIMUM;
}

static void run(const uint8_t *data, size_t bytes)
{
    uint8_t *copy = malloc(bytes + 1);
    if (copy && is_small(data, bytes)) {
        decode(data, bytes);
        if (bytes > SIGNATURE) {
            memcpy(copy, data, bytes);
            mend_checksums(copy, bytes);
            decode(copy, bytes);
        }
    }
    free(copy);
}

const struct fuzz_target fuzz_png = {"png", run};
