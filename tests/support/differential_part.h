/* What the parts of the comparison share: memory for inputs and outputs. */
#ifndef TESTS_DIFFERENTIAL_PART_H
#define TESTS_DIFFERENTIAL_PART_H

#include "differential.h"

#include "triptych.h"

enum {
    STRIDE_MAXIMUM = 44, /* bytes between two vertices of a stream */
    FETCH_MAXIMUM = 16,
    CONSTANT_FLOATS = TRIPTYCH_SHADER_FLOATS,
    CONSTANT_INTEGERS = TRIPTYCH_SHADER_INTEGERS,
    CONSTANT_BYTES = 16 * (CONSTANT_FLOATS + 1 + CONSTANT_INTEGERS),
    STREAM_BYTES = VERTEX_CAPACITY * STRIDE_MAXIMUM + FETCH_MAXIMUM + 4,
    TEXTURE_SIDE = 64,
    SMALL_SIDE = 16,
    LEVELS = 7,
    TEXTURE_BYTES = TEXTURE_SIDE * TEXTURE_SIDE * 4 * 6 * 2, /* a cube with its levels */
    PALETTE_BYTES = WORLD_MATRICES * sizeof(struct palette_entry),
    RECORD_MAXIMUM = 256,
    TRIANGLES = 32,
    ENTRIES = 48,
    TARGET_PLANES = 4 * SAMPLES_MAXIMUM, /* of one target with samples, or of all without */
    UNTOUCHED = 0x5a
};

/* What a routine may write, and what it must not: all of it is compared. */
struct outputs {
    alignas(64) uint8_t before[64];
    alignas(64) float vertices[SLOT_COUNT * VERTEX_CAPACITY];
    alignas(64) uint8_t records[SETUP_CAPACITY * RECORD_MAXIMUM];
    alignas(64) uint32_t color[TARGET_PLANES * TILE_PIXELS];
    alignas(64) uint32_t depth[SAMPLES_MAXIMUM * TILE_PIXELS];
    alignas(64) uint8_t lanes[4 + sizeof(struct lane_table)];
    alignas(64) uint8_t behind[64];
};

struct differential {
    struct code_arena *arena;
    uint64_t seed;
    int wild;
    uint32_t count;  /* of the call */
    uint64_t inputs; /* hashed */
    struct triangle_layout layout;
    struct job job;
    uint8_t *stream[ATTRIBUTE_COUNT]; /* fenced */
    uint8_t *texels;                  /* fenced */
    struct texture_level levels[SAMPLERS][LEVELS];
    uint8_t *palette;      /* fenced */
    uint8_t *constants;    /* fenced */
    size_t constant_bytes; /* so many of them, the last */
    alignas(64) uint32_t index_words[1 + SETUP_INDEX_ROWS * SETUP_CAPACITY];
    struct entry_list entries;
    alignas(64) uint8_t triangles[TRIANGLES * RECORD_MAXIMUM];
    struct outputs initial, result[2], scratch;
    char message[KEY_TEXT_CAPACITY + 256];
};

/* Fills everything that the call reads, and the outputs before it (differential_inputs.c). */
void differential_fill(struct differential *d, enum unit unit, const union key *key, uint64_t seed);

/* Of all that a routine may read. */
uint64_t differential_hash(const struct differential *d);

uint32_t differential_word(struct differential *d);

/* Indices come from anywhere: of words, but not of vectors. */
static inline uint32_t *differential_indices(struct differential *d)
{
    return d->index_words + 1;
}

#endif
