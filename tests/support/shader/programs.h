/* Programs of tests/support/shader/programs.def, made when they are first requested. */
#ifndef TESTS_SUPPORT_SHADER_PROGRAMS_H
#define TESTS_SUPPORT_SHADER_PROGRAMS_H

#include "contract/key.h"
#include "shader/program/program.h"

/* Returns a program by its number from 0, or null after the last one; or by its name, which must exist. */
const struct program *sample_program(unsigned i);
const struct program *sample_named(const char *name);

/* Returns the key of a routine with a program and little else. Of vertices: two inputs, and output 1 as the
 * diffuse colour. Of pixels: all varyings, no test, and one target. */
union key sample_key(enum unit unit, const char *name);

#endif
