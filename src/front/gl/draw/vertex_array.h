/* Vertex array objects: arrays of attributes, and the buffer of indices. */
#ifndef FRONT_GL_DRAW_VERTEX_ARRAY_H
#define FRONT_GL_DRAW_VERTEX_ARRAY_H

#include "front/gl/draw/buffer.h"

struct gl_array {
    bool enabled;
    GLboolean normalized;
    GLint size; /* components */
    GLenum type;
    GLsizei stride;           /* as the program gave it; 0: vertices follow each other */
    const void *pointer;      /* in the buffer: the offset */
    struct gl_buffer *buffer; /* held; null: in the memory of the program */
    GLuint divisor;           /* 0: an element per vertex; n: per n instances */
};

struct gl_vertex_array {
    struct gl_object object;
    struct gl_array array[GL_ATTRIBUTES];
    struct gl_buffer *elements; /* held; null: indices are in the memory of the program */
};

struct gl_object *gl_vertex_array_make(struct gl_context *, GLuint name);
/* Removes a buffer that is deleted from the bound vertex array. */
void gl_vertex_array_detach(struct gl_context *, struct gl_object *buffer);

/* The bytes of an element, and those between two of them. */
unsigned gl_array_bytes(const struct gl_array *);
size_t gl_array_stride(const struct gl_array *);
/* The renderer's type of an element; TRIPTYCH_FORMAT_NONE if it has none. */
enum triptych_format gl_array_format(const struct gl_array *);

#endif
