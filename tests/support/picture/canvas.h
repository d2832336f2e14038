/* A target of SIZE x SIZE pixels on each engine in turn, for tests that compute every pixel of a picture. */
#ifndef TESTS_SUPPORT_PICTURE_CANVAS_H
#define TESTS_SUPPORT_PICTURE_CANVAS_H

#include "triptych.h"

#include <unity.h>

enum { SIZE = 64 };

extern triptych_device *device;
extern uint32_t image[SIZE * SIZE]; /* the target's pixels, after a test has read them */
extern uint32_t texel[SIZE * SIZE]; /* the texels of the texture of bind_random_texture */
extern float extent; /* of the square in the world, at first 1; the projection maps it to the whole target */

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

/* Runs a test once for every engine that this machine can execute. The test's `device` has lighting, culling
 * and the depth test disabled. */
void on_every_engine(void (*test)(void));

/* Destroys the device if a test failed. tearDown calls this function. */
void close_canvas(void);

/* A random sequence that is the same on every engine. random_begin() restarts it. */
void random_begin(void);
uint32_t random_word(void);
double random_between(double low, double high);
/* A random multiple of 1/1024. */
double dyadic(double low, double high);

void set(enum triptych_state state, const char *word);
void set_sampler(unsigned sampler, enum triptych_sampler_state state, const char *word);
void set_stage(unsigned stage, enum triptych_stage_state state, const char *word);

/* Draws a strip over the whole target at depth z. Texture coordinates go from u0, v0 at the upper left to u1,
 * v1 at the lower right. */
void draw_square(float z, uint32_t color, const float normal[3], float u0, float v0, float u1, float v1);

/* Converts a packed colour, with blue in the low byte, to a word of an image, with red in the low byte. */
uint32_t image_word(uint32_t color);
unsigned channel(uint32_t word, int c);

void clear_to(uint32_t word);

/* Binds a texture of random words and sets stage 0 to replace the diffuse colour by its texels. */
void bind_random_texture(unsigned width, unsigned height);

/* Returns the distance of the pixels that a test computes. A build with sanitizers draws all pixels, and
 * computes some of each column. */
int pixel_stride(void);

/* Fails unless the pixel of `image` is the expected word. */
void expect_pixel(int x, int y, uint32_t expected, const char *what);

#endif
