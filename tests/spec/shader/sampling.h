/* A part of the target for shaders that sample. */
#ifndef TESTS_SPEC_SHADER_SAMPLING_H
#define TESTS_SPEC_SHADER_SAMPLING_H

#include "tests/support/picture/drawn.h"
#include "tests/support/picture/texture_model.h"

enum { PART = 16 }; /* the part has PART x PART pixels, at the upper left */

static struct model_texture texture;

/* Sets a small part of a binary32 target, because engines without generated code are slow. */
static inline void begin_part(void)
{
    use_float_target();
    for (int i = 0; i < 4; i++) {
        drawn_position[i][0] = i % 2 ? -1 + 2.0f * PART / SIZE : -1;
        drawn_position[i][1] = i / 2 ? 1 - 2.0f * PART / SIZE : 1;
    }
}

#endif
