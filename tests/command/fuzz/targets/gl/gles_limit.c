/* Calls that a fuzzer leaves out: those that need more time or memory than it has, and those that a program
 * must not make, because they read memory that does not exist. */
#include "front/gl/draw/vertex_array.h"
#include "tests/command/fuzz/targets/gl/gles_call.h"

#include <string.h>

enum { SIDE = 8192 };

/* An image that is too large to be valid is an error, and costs nothing. */
static bool is_image_small(GLint width, GLint height)
{
    return width < 0 || height < 0 || width > SIDE || height > SIDE || width * height <= GLES_TEXELS;
}

/* --- Draws --- */

static bool is_array_readable(const struct gles_input *input, const struct gl_array *array, uint64_t last)
{
    const uint8_t *pointer = array->pointer;
    if (!array->enabled || array->buffer || !pointer)
        return true;
    const uint8_t *end = input->client + GLES_CLIENT;
    return pointer >= input->client && pointer < end &&
           last * gl_array_stride(array) + gl_array_bytes(array) <= (uint64_t)(end - pointer);
}

bool gles_arrays_exist(const struct gles_input *input, uint64_t last)
{
    const struct gl_array *array = input->context->vertex_array->array;
    for (unsigned i = 0; i < GL_ATTRIBUTES; i++)
        if (!is_array_readable(input, array + i, last))
            return false;
    return true;
}

/* --- Commands --- */

#define LIMIT(name) static bool limit_##name(const struct gles_input *input, const struct gles_##name *a)

LIMIT(DrawArrays)
{
    if (a->count <= 0 || a->first < 0)
        return true;
    return a->count + input->vertices <= GLES_VERTICES &&
           gles_arrays_exist(input, (uint64_t)a->first + (uint64_t)a->count - 1);
}

LIMIT(TexImage2D)
{
    (void)input;
    return is_image_small(a->width, a->height);
}

LIMIT(CopyTexImage2D)
{
    (void)input;
    return is_image_small(a->width, a->height);
}

LIMIT(CompressedTexImage2D)
{
    (void)input;
    return is_image_small(a->width, a->height);
}

LIMIT(RenderbufferStorage)
{
    (void)input;
    return is_image_small(a->width, a->height);
}

/* A size of more than 31 bits is refused. */
LIMIT(BufferData)
{
    (void)input;
    return a->size <= GLES_PATIENCE || a->size > INT32_MAX;
}

static const struct {
    const char *name;
    bool (*limit)(const struct gles_input *, const void *);
} limits[] = {
#define ROW(name)                                                                                            \
    {                                                                                                        \
#name, (bool (*)(const struct gles_input *, const void *))limit_##name                               \
    }
    ROW(DrawArrays),           ROW(TexImage2D),          ROW(CopyTexImage2D),
    ROW(CompressedTexImage2D), ROW(RenderbufferStorage), ROW(BufferData),
#undef ROW
};

bool gles_limit(struct gles_input *input, const struct gles_command *command, const void *arguments)
{
    for (unsigned i = 0; i < sizeof limits / sizeof *limits; i++)
        if (!strcmp(limits[i].name, command->name))
            return limits[i].limit(input, arguments);
    return true;
}
