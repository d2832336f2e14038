/* The compiler of the OpenGL ES Shading Language 1.00: source text to a checked program in memory.
 *
 * The steps, each with a folder of its own:
 *
 *   preprocess/  strings to tokens with places (Flex); directives and macros, section 3.4
 *   compile/     the grammar of chapter 9 (Bison), whose actions make nodes (node.h)
 *   check/       types, names, qualifiers and constant expressions: chapters 4 to 6 and 8
 *   lower/       a checked program to the text of vs_gl or ps_gl
 *   link/        two stages to a program (program.h)
 *
 * All memory of a compilation is in its arena (arena.h), so nothing is freed singly and a failure cannot
 * leak.
 *
 * Source: "The OpenGL ES Shading Language", version 1.00, revision 17 (Khronos, 2009). Its sections are
 * named in comments as 4.3.2. */
#ifndef FRONT_GLSL_GLSL_H
#define FRONT_GLSL_GLSL_H

#include <stdbool.h>
#include <stddef.h>

enum glsl_stage { GLSL_VERTEX, GLSL_FRAGMENT };

/* Limits, which a program can read as constants. */
struct glsl_limits {
    int vertex_attributes, vertex_uniform_vectors, varying_vectors, vertex_samplers, samplers, pixel_samplers,
        pixel_uniform_vectors, draw_buffers, dual_source_draw_buffers;
};

enum { GLSL_SOURCE_BYTES = 4 << 20, GLSL_LOG_BYTES = 16384, GLSL_ERRORS = 32 };

struct glsl_unit; /* node.h */

/* Compiles the strings as one source; lengths may be null, and a negative length means a string that ends
 * with a zero. `limits` null: those of the renderer. Returns null if there are errors; then `log` has a
 * line for each:
 *
 *   ERROR: STRING:LINE:COLUMN: found 'x', expected ...
 *
 * Warnings begin with WARNING and are in the log of a unit too. The caller frees *log. Returns null with a
 * null log, and errno is ENOMEM, if memory is refused. Thread-safe. */
struct glsl_unit *glsl_compile(enum glsl_stage stage, const char *const *strings, const int *lengths,
                               unsigned count, const struct glsl_limits *limits, char **log);

/* Null is allowed. */
void glsl_unit_free(struct glsl_unit *unit);

#endif
