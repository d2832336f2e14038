/* The parts of the bytecode's reader: tokens (read.c) and the constant table in a comment (names.c). */
#ifndef SHADER_CODE_READ_H
#define SHADER_CODE_READ_H

#include "shader/shader.h"

/* Adds the names in the comment if it is a constant table; other comments are ignored. `token` is the number
 * of its first token, for the reason. Returns -1 if the table is broken. */
int shader_read_names(struct shader *shader, const unsigned char *comment, size_t bytes, uint32_t token,
                      struct error *error);

#endif
