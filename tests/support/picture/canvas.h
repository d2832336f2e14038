/* A target of SIZE x SIZE pixels on each engine in turn, for pictures whose every pixel the test works out
 * itself. */
#ifndef TESTS_SUPPORT_PICTURE_CANVAS_H
#define TESTS_SUPPORT_PICTURE_CANVAS_H

#include "triptych.h"

#include <unity.h>

enum { SIZE = 64 };

extern triptych_device *device;
extern uint32_t image[SIZE * SIZE]; /* where tests read the target to */
extern uint32_t texel[SIZE * SIZE]; /* of the texture that bind_random_texture made */
extern float extent; /* of the square in the world, 1 at first; the projection makes it the whole target */

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

/* Runs a test once for every engine that can run here, with a device whose lighting, culling and depth are
 * off. */
void on_every_engine(void (*test)(void));

/* Destroys the device of a test that failed: for tearDown. */
void close_canvas(void);

/* The same sequence on every engine; from its beginning with random_begin. */
void random_begin(void);
uint32_t random_word(void);
double random_between(double low, double high);

void set(enum triptych_state state, const char *word);
void set_sampler(unsigned sampler, enum triptych_sampler_state state, const char *word);
void set_stage(unsigned stage, enum triptych_stage_state state, const char *word);

/* The whole target as a strip at depth z; texture coordinates run from u0, v0 at the upper left to u1, v1. */
void draw_square(float z, uint32_t color, const float normal[3], float u0, float v0, float u1, float v1);

/* A word with red in the low byte, as images have it, from a packed colour with blue there. */
uint32_t image_word(uint32_t color);
unsigned channel(uint32_t word, int c);

void clear_to(uint32_t word);

/* Binds a texture of random words, which replaces the diffuse colour. */
void bind_random_texture(unsigned width, unsigned height);

/* Fails unless the pixel of `image` is the expected word. */
void expect_pixel(int x, int y, uint32_t expected, const char *what);

#endif
