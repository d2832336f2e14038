/* A picture of a few pixels, drawn in any of VARIED_STATES different states, for tests that need many or
 * small routines. */
#ifndef TESTS_SUPPORT_PICTURE_VARIED_H
#define TESTS_SUPPORT_PICTURE_VARIED_H

#include "render/device/device.h"

enum { VARIED_SIZE = 12, VARIED_STATES = 9 * 9 * 8 * 8 };

struct varied_image {
    uint32_t color[VARIED_SIZE * VARIED_SIZE];
    float depth[VARIED_SIZE * VARIED_SIZE];
};

/* Sets the target and the state that all draws have in common. Fails the test if a call fails. */
void varied_begin(triptych_device *device);

/* Draws in state n without a clear. */
void varied_draw(triptych_device *device, unsigned n);

void varied_read(triptych_device *device, struct varied_image *image);

/* Draws in `count` states from n on, with a new device of the engine. */
void varied_render(const struct engine *engine, const struct device_options *options, unsigned n,
                   unsigned count, struct varied_image *image);

#endif
