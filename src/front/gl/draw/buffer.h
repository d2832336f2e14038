/* Buffer objects. */
#ifndef FRONT_GL_DRAW_BUFFER_H
#define FRONT_GL_DRAW_BUFFER_H

#include "front/gl/object.h"

/* The contents are in `memory`. The renderer's buffer has them except for bytes `first` to `last`. */
struct gl_buffer {
    struct gl_object object;
    GLenum usage;
    uint8_t *memory; /* null if it is empty */
    size_t bytes;
    triptych_buffer *renderer; /* null until a draw reads it */
    size_t first, last;        /* last 0: nothing has changed */
    bool mapped;
    size_t map_offset, map_bytes;
    GLbitfield access; /* GL_MAP_..._BIT_EXT of the mapping */
};

/* The renderer's buffer with the current contents; null if it is empty or without memory. */
triptych_buffer *gl_buffer_use(struct gl_context *, struct gl_buffer *);

#endif
