#include "front/glsl/arena.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 16, BLOCK_BYTES = 32 << 10 };

struct glsl_block {
    struct glsl_block *previous;
    size_t bytes; /* of data */
    _Alignas(ALIGNMENT) char data[];
};

static void add_block(struct glsl_arena *arena, size_t bytes)
{
    size_t room = bytes > BLOCK_BYTES ? bytes : BLOCK_BYTES;
    struct glsl_block *block = room < bytes ? NULL : malloc(sizeof *block + room);
    if (!block)
        longjmp(arena->refused, 1);
    block->previous = arena->block;
    block->bytes = room;
    arena->block = block;
    arena->used = 0;
}

void *glsl_take(struct glsl_arena *arena, size_t bytes)
{
    size_t rounded = (bytes + ALIGNMENT - 1) & ~(size_t)(ALIGNMENT - 1);
    if (rounded < bytes)
        longjmp(arena->refused, 1);
    if (!arena->block || arena->block->bytes - arena->used < rounded)
        add_block(arena, rounded);
    void *taken = arena->block->data + arena->used;
    arena->used += rounded;
    return memset(taken, 0, rounded);
}

char *glsl_copy(struct glsl_arena *arena, const char *text, size_t length)
{
    char *copy = glsl_take(arena, length + 1);
    memcpy(copy, text, length);
    return copy;
}

char *glsl_format(struct glsl_arena *arena, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    char *text = glsl_take(arena, (size_t)length + 1);
    vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    va_end(arguments);
    return text;
}

void glsl_arena_free(struct glsl_arena *arena)
{
    while (arena->block) {
        struct glsl_block *previous = arena->block->previous;
        free(arena->block);
        arena->block = previous;
    }
    arena->used = 0;
}
