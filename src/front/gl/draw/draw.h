/* Draws: the vertices and indices of a draw in the renderer's buffers. */
#ifndef FRONT_GL_DRAW_DRAW_H
#define FRONT_GL_DRAW_DRAW_H

#include "front/gl/draw/vertex_array.h"

/* The input of a draw. Streams begin at vertex `origin`: that of glDrawArrays, or the least index if an array
 * is in the memory of the program, else 0. */
struct gl_draw {
    enum triptych_primitive primitive;
    uint32_t primitives;
    uint32_t origin, vertices;  /* `vertices`: from the origin on; of indexed draws only if that is needed */
    const void *indices;        /* in memory; null: not indexed */
    struct gl_buffer *elements; /* that contains them; null: the program's memory does */
    uint32_t count;             /* indices */
    unsigned bits;              /* of an index */
};

/* Returns true if the program reads an array that is in memory, not in a buffer. */
bool gl_stream_reads_memory(const struct gl_context *);
/* Binds a stream for each attribute of the program, and indices. `*first` is the first index. Returns false
 * if the draw cannot read them: then it is left out, with an error if memory is refused. */
bool gl_stream_bind(struct gl_context *, const struct gl_draw *, uint32_t *first);

#endif
