/* The memory of one compilation: blocks that grow and are freed together.
 *
 * glsl_take() does not return if memory is refused: it jumps to the place that arena->refused describes,
 * which glsl_compile() sets. No function of the compiler holds anything else that would have to be
 * released. */
#ifndef FRONT_GLSL_ARENA_H
#define FRONT_GLSL_ARENA_H

#include <setjmp.h>
#include <stddef.h>

struct glsl_block;

struct glsl_arena {
    struct glsl_block *block; /* the newest, from which memory is taken */
    size_t used;              /* bytes of it */
    jmp_buf refused;
};

/* Zeroed memory, aligned to 16 bytes. */
void *glsl_take(struct glsl_arena *arena, size_t bytes);

/* A copy of `length` bytes with a zero after them. */
char *glsl_copy(struct glsl_arena *arena, const char *text, size_t length);

/* A text from a format. */
char *glsl_format(struct glsl_arena *arena, const char *format, ...) __attribute__((format(printf, 2, 3)));

void glsl_arena_free(struct glsl_arena *arena);

#define GLSL_NEW(arena, type) ((type *)glsl_take((arena), sizeof(type)))

#endif
