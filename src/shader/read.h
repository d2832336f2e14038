/* The parts of the bytecode's reader: tokens (read.c) and the constant table in a comment (names.c). */
#ifndef SHADER_READ_H
#define SHADER_READ_H

#include "shader/shader.h"

/* Adds the names that the comment holds if it is a constant table; another comment is left alone. `token` is
 * the number of its first token, for the reason. Returns -1 if the table is broken. */
int read_names(struct shader *shader, const unsigned char *comment, size_t bytes, uint32_t token,
               struct error *error);

#endif
