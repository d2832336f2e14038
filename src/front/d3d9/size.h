/* How much memory an argument refers to: the counts of elements in the folder calls, where they do not follow
 * from one number of the call. Pointers may be null; the answer then is 0. */
#ifndef D3D9_SIZE_H
#define D3D9_SIZE_H

#include "types.h"

/* Numbers of D3DPRIMITIVETYPE and D3DFORMAT. */
enum {
    D3D9_SIZE_POINTS = 1,
    D3D9_SIZE_LINES,
    D3D9_SIZE_LINE_STRIP,
    D3D9_SIZE_TRIANGLES,
    D3D9_SIZE_STRIP,
    D3D9_SIZE_FAN
};
enum { D3D9_SIZE_INDEX32 = 102 };

/* MaxPrimitiveCount of the capabilities. Draws of more primitives fail. */
enum { D3D9_MOST_PRIMITIVES = 0x555555 };

/* A number that the program has put where the actual one is written. */
static inline uint64_t d3d9_size_given(const uint32_t *count)
{
    return count ? *count : 0;
}

/* Vertices, or indices, of `count` primitives. A type that does not exist has none. */
static inline uint64_t d3d9_size_primitives(uint32_t type, uint32_t count)
{
    if (!count)
        return 0;
    switch (type) {
    case D3D9_SIZE_POINTS: return count;
    case D3D9_SIZE_LINES: return 2 * (uint64_t)count;
    case D3D9_SIZE_LINE_STRIP: return (uint64_t)count + 1;
    case D3D9_SIZE_TRIANGLES: return 3 * (uint64_t)count;
    case D3D9_SIZE_STRIP:
    case D3D9_SIZE_FAN: return (uint64_t)count + 2;
    default: return 0;
    }
}

/* Bytes of an index. */
static inline uint64_t d3d9_size_index(uint32_t format)
{
    return format == D3D9_SIZE_INDEX32 ? 4 : 2;
}

/* Elements of a vertex declaration, with its end (stream 0xff); at most D3D9_SIZE_ELEMENTS. */
enum { D3D9_SIZE_ELEMENTS = 65 };
uint64_t d3d9_size_elements(const struct d3d9_vertex_element *elements);

/* Tokens of a shader's bytecode, with its end. Without an end it is cut off at a limit above that of any
 * model. */
uint64_t d3d9_size_code(const uint32_t *code);

/* Bytes of a region. */
uint64_t d3d9_size_region(const struct d3d9_region *region);

#endif
