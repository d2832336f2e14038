#include "tests/command/fuzz/targets/frame.h"

#include "capture/chunk.h"
#include "tests/command/fuzz/targets/target.h"

#include <string.h>
#include <xxhash.h>

static void put32(uint8_t *at, uint32_t value)
{
    memcpy(at, &value, sizeof value);
}

static uint32_t get32(const uint8_t *at)
{
    uint32_t value;
    memcpy(&value, at, sizeof value);
    return value;
}

static void put_checksum(uint8_t *chunk, size_t stored)
{
    uint64_t sum = XXH3_64bits(chunk + 8, CHUNK_HEADER - 8 + stored);
    memcpy(chunk, &sum, sizeof sum);
}

static void mend_checksums(uint8_t *data, size_t bytes)
{
    for (size_t at = CHUNK_FILE_HEADER; at <= bytes && bytes - at >= CHUNK_HEADER;) {
        size_t stored = get32(data + at + 16);
        if (stored > bytes - at - CHUNK_HEADER)
            return;
        put_checksum(data + at, stored);
        at += CHUNK_HEADER + stored;
    }
}

static size_t put_chunk(uint8_t *at, const char type[4], uint32_t number, const void *contents, size_t bytes,
                        int recording)
{
    memcpy(at + 8, type, 4);
    put32(at + 12, number);
    put32(at + 16, (uint32_t)bytes);
    put32(at + 20, (uint32_t)bytes);
    put32(at + 24, number == 0);
    put32(at + 28, (uint32_t)recording);
    memcpy(at + CHUNK_HEADER, contents, bytes);
    put_checksum(at, bytes);
    return CHUNK_HEADER + bytes;
}

uint8_t *frame_container(const uint8_t *data, size_t bytes, int recording, size_t *framed)
{
    static const uint8_t magic[8] = {0x8d, 'T', 'R', 'I', 'B', '\r', '\n', 0x1a};
    const uint64_t end[2] = {1, 0};
    uint8_t *file = calloc(1, CHUNK_FILE_HEADER + 2 * CHUNK_HEADER + CHUNK_END + bytes);
    expect(file, "memory");
    if (chunk_is_container(data, bytes)) {
        memcpy(file, data, *framed = bytes);
        mend_checksums(file, bytes);
        return file;
    }
    memcpy(file, magic, sizeof magic);
    put32(file + 8, CONTAINER_VERSION);
    put32(file + 12, (uint32_t)recording);
    uint8_t *at = file + CHUNK_FILE_HEADER;
    at += put_chunk(at, "BODY", 0, data, bytes < CHUNK_BYTES ? bytes : CHUNK_BYTES, recording);
    at += put_chunk(at, "END ", 1, end, CHUNK_END, recording);
    *framed = (size_t)(at - file);
    return file;
}
