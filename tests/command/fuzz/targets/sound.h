/* The checks of the targets of shaders on a shader that a reader accepted (sound.c). */
#ifndef TESTS_COMMAND_FUZZ_TARGETS_SOUND_H
#define TESTS_COMMAND_FUZZ_TARGETS_SOUND_H

#include "shader/shader.h"

/* The shader goes to tokens and text and back and stays what it is, the validator has one opinion on it,
 * and a valid one becomes a program or is refused with a line. */
void expect_sound(const struct shader *shader);

#endif
