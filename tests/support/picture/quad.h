/* One quad of pixels, or four vertices, shaded by the shader part of the specification under the emulator's
 * binding. The test sets the input registers directly and reads the output registers before any later step.
 * Textures, samplers and bump matrices are those of a device. */
#ifndef TESTS_SUPPORT_PICTURE_QUAD_H
#define TESTS_SUPPORT_PICTURE_QUAD_H

#include "triptych.h"

#include <stdint.h>

enum { QUAD_LANES = 4, QUAD_REGISTERS = 8, QUAD_CONSTANTS = 32 };

/* Registers by number, component and lane. Lanes are the quad's pixels by rows. */
struct quad {
    float v[QUAD_REGISTERS][4][QUAD_LANES]; /* both v# and t# */
    float constant[QUAD_CONSTANTS][4];
    uint8_t projected[4]; /* PROJECTED_*, by stage */
};

struct quad_result {
    float color[4][QUAD_LANES]; /* oC0, r0 in ps_1_x, o1 in vs_3_0: by component */
    float depth[QUAD_LANES];
    int32_t killed[QUAD_LANES];
};

void quad_shade(const triptych_device *device, const char *text, const struct quad *quad,
                struct quad_result *result);

/* Sets a component, or all four, in every lane. */
void quad_set_lanes(struct quad *quad, int r, int c, float value);
void quad_set(struct quad *quad, int r, float x, float y, float z, float w);

/* Fail unless the colour of the lane, or of every lane, is the expected one. Any NaN equals any other. */
void quad_expect(const struct quad_result *result, int lane, const float expected[4], const char *what);
void quad_expect_all(const struct quad_result *result, const float expected[4], const char *what);

#endif
