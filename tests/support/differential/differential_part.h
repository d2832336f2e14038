/* Shared by the parts of the comparison: the memory of inputs and outputs. */
#ifndef TESTS_SUPPORT_ROUTINE_DIFFERENTIAL_PART_H
#define TESTS_SUPPORT_ROUTINE_DIFFERENTIAL_PART_H

#include "tests/support/differential/differential.h"

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
    RECORD_MAXIMUM = 704, /* depth, 1/w and every varying have planes, and triangles smooth edges */
    TRIANGLES = 32,
    ENTRIES = 48,
    TARGET_PLANES =
        4 * SAMPLES_MAXIMUM, /* the planes of one target with samples, or of all targets without */
    BLIT_INPUT_BYTES = 4 * SAMPLES_MAXIMUM * TILE_PLANE_BYTES,
    BLIT_ROW_TEXELS = 128, /* the widest row that a blit reads */
    BLIT_ROWS_BYTES = 4 * 4 * BLIT_ROWS * BLIT_ROW_TEXELS,
    UNTOUCHED = 0x5a
};

/* The memory that a routine may write, with the bytes around it that it must not write. All of it is
 * compared. */
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
    size_t constant_bytes; /* the bytes in use, at the end */
    alignas(64) uint32_t index_words[1 + SETUP_INDEX_ROWS * SETUP_CAPACITY];
    struct entry_list entries;
    alignas(64) uint8_t triangles[TRIANGLES * RECORD_MAXIMUM];
    struct blit_job blit;
    uint8_t *blit_input, *blit_rows;          /* both fenced */
    size_t blit_input_bytes, blit_rows_bytes; /* the bytes in use, at their ends */
    struct outputs initial, result[2], scratch;
    char message[KEY_TEXT_CAPACITY + 256];
};

/* Fills everything that the call reads, and the outputs before the call (differential_inputs.c). */
void differential_fill(struct differential *d, enum unit unit, const union key *key, uint64_t seed);

/* The arguments of a call for each unit, with these outputs. */
struct differential_arguments {
    struct vertex_arguments vertex;
    struct setup_arguments setup;
    struct pixel_arguments pixel;
    struct blit_arguments blit;
};
struct differential_arguments differential_arguments(struct differential *d, struct outputs *o);

/* Compares the two results. Returns null if they agree, else a message. */
const char *differential_results(struct differential *d, const struct engine *a, const struct engine *b,
                                 enum unit unit, const union key *key);

/* Random bytes for all memory that a routine may read. */
uint64_t differential_hash(const struct differential *d);

uint32_t differential_word(struct differential *d);

uint32_t differential_below(struct differential *d, uint32_t limit);

float differential_between(struct differential *d, float low, float high);

/* A plausible value; in wild inputs, one in eight is anything. */
float differential_number(struct differential *d, float low, float high);

void differential_fill_numbers(struct differential *d, void *memory, size_t bytes, float low, float high);

void differential_fill_words(struct differential *d, void *memory, size_t bytes);

/* The inputs of pixel routines, and the textures of vertex routines (differential_pixels.c). */
void differential_pixel_inputs(struct differential *d, const struct pixel_key *key);

void differential_vertex_textures(struct differential *d, const struct vertex_key *key);

/* The inputs of blits (differential_blits.c). */
void differential_blit_inputs(struct differential *d, const struct blit_key *key);

/* Planes of words that a blit writes, BLIT_BLEND_PIXELS apart. */
static inline uint32_t differential_blit_planes(const struct blit_key *key)
{
    return key->number_results ? 4 : 1;
}

/* Indices are aligned to words, not to vectors. */
static inline uint32_t *differential_indices(struct differential *d)
{
    return d->index_words + 1;
}

#endif
