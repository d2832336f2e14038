/* Lanes of random vertices with their clip codes, and a clipper for them. */
#ifndef TESTS_SUPPORT_GEOMETRY_CLIPPING_H
#define TESTS_SUPPORT_GEOMETRY_CLIPPING_H

#include "render/geometry/clip.h"

#include <stdint.h>

enum {
    CLIPPING_SEED = 20240118,
    CLIPPING_LANES = VERTEX_CAPACITY,
    CLIPPING_FIRST_FREE = 16,
    CLIPPING_FIRST_USER = CLIP_PLANES - CLIP_PLANES_USER
};

extern _Alignas(64) float clipping_batch[SLOT_COUNT * CLIPPING_LANES];

extern struct job clipping_job;

extern int clipping_user_planes;

void clipping_begin(void);

void clipping_end(void);

uint32_t clipping_draw(void);

float clipping_uniform(float low, float high);

float *clipping_word(int slot, uint32_t lane);

/* Returns the clip code, computed in float as in spec/vertex/clip.h: a bit is set unless the test for
 * "inside" succeeds. */
uint32_t clipping_code_of(float x, float y, float z, float w);

uint32_t clipping_code(uint32_t lane);

void clipping_put(uint32_t lane, float x, float y, float z, float w);

float clipping_power(int low, int high);

enum clipping_spread {
    CLIPPING_MODERATE,
    CLIPPING_WIDE,
    CLIPPING_EXTREME,
    CLIPPING_DEEP,
    CLIPPING_ON_PLANES,
    CLIPPING_SPREADS
};

void clipping_put_random(uint32_t lane, enum clipping_spread spread);

extern const uint8_t clipping_smooth[VARYING_COUNT];

struct clipper clipping_clipper(void);

void clipping_set_user_planes(int count);

#endif
