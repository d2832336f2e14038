/* Vertex and index buffers.
 *
 * The program writes to the front end's memory, which Lock returns. Bytes that are newer there reach the
 * renderer before the next draw that reads the buffer, or before the next lock that must keep earlier draws
 * from changes. The renderer's buffer is longer than the program's: vertices that begin inside of it can be
 * read, with zeros for what is outside. */
#ifndef D3D9_DRAW_BUFFER_H
#define D3D9_DRAW_BUFFER_H

#include "front/d3d9/resource.h"
#include "triptych.h"

/* Writes since the renderer has got the bytes; a larger one includes the smaller ones. */
enum d3d9_buffer_change {
    D3D9_BUFFER_UNCHANGED,
    D3D9_BUFFER_APPENDED, /* bytes that no earlier draw reads */
    D3D9_BUFFER_CHANGED,
    D3D9_BUFFER_DISCARDED /* the bytes outside of the range are undefined */
};

struct d3d9_buffer {
    struct d3d9_resource resource;
    triptych_buffer *renderer; /* null: not made yet */
    uint8_t *memory;
    uint32_t bytes;
    uint32_t format; /* D3DFORMAT: vertex data, or of indices */
    uint32_t fvf;
    uint32_t locks;                 /* that have not been unlocked */
    enum d3d9_buffer_change change; /* of bytes first to last - 1 */
    uint32_t first, last;
};

/* The types of the two interfaces. */
struct d3d9_vertex_buffer {
    struct d3d9_buffer buffer;
};
struct d3d9_index_buffer {
    struct d3d9_buffer buffer;
};

/* Gives the renderer what has changed. Returns the renderer's buffer; null without memory. */
triptych_buffer *d3d9_buffer_use(struct d3d9_buffer *);
/* Creates a buffer of the renderer with these bytes and zeros after them. */
enum triptych_result d3d9_buffer_copy(triptych_device *, const void *data, size_t bytes,
                                      triptych_buffer **buffer);
/* Bytes that the front end itself has written. */
void d3d9_buffer_written(struct d3d9_buffer *, uint32_t first, uint32_t last);

#endif
