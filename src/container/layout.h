/* Sizes and places of attributes within interleaved vertices. */
#ifndef CONTAINER_LAYOUT_H
#define CONTAINER_LAYOUT_H

#include "draw/key.h"
#include "container/call.h"

/* Values that a format has in the text: its components, or one colour. */
static inline uint32_t format_values(enum triptych_format format)
{
    return format == TRIPTYCH_FORMAT_COLOR ? 1 : vertex_types[format].components;
}

static inline uint32_t value_bytes(enum value_type type)
{
    return type == VALUE_BYTES ? 1 : type == VALUE_U16 ? 2 : 4;
}

static inline void layout_add(struct layout *layout, unsigned element, enum triptych_format format)
{
    layout->format[element] = format;
    layout->offset[element] = layout->stride;
    layout->stride += vertex_types[format].bytes;
}

/* The elements in the order in which they lie in a vertex; returns how many. */
unsigned layout_order(const struct layout *layout, unsigned order[STREAM_ELEMENTS]);

#endif
