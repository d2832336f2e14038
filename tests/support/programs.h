/* Programs of tests/support/programs.def, made when they are first asked for. */
#ifndef TESTS_PROGRAMS_H
#define TESTS_PROGRAMS_H

#include "shader/program.h"

/* By number from 0, or null behind the last; and by name, which must be one of them. */
const struct program *sample_program(unsigned i);
const struct program *sample_named(const char *name);

#endif
