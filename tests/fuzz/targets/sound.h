/* What the targets of shaders promise of what a reader let through (sound.c). */
#ifndef FUZZ_SOUND_H
#define FUZZ_SOUND_H

#include "shader/shader.h"

/* The shader goes to tokens and text and back and stays what it is, the validator has one opinion on it, and a valid
 * one becomes a program or is refused with a line. */
void expect_sound(const struct shader *shader);

#endif
