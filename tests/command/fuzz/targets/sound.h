/* Checks of a shader that a reader accepted, for the fuzz targets of shaders (sound.c). */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_SOUND_H
#define TESTS_COMMAND_FUZZ_TARGETS_SOUND_H

#include "shader/shader.h"

/* Converts the shader to tokens and to text and back, which must not change it. The validator must give the
 * same result for each form. A valid shader must become a program or be refused with one line. */
void expect_sound(const struct shader *shader);

#endif
