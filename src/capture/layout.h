/* Sizes and offsets of attributes in interleaved vertices. */
#ifndef CAPTURE_LAYOUT_H
#define CAPTURE_LAYOUT_H

#include "contract/key.h"
#include "capture/call.h"

/* Returns the number of values that a vertex format has in the text: its components, or one colour. */
static inline uint32_t format_values(enum triptych_format format)
{
    return format == TRIPTYCH_FORMAT_COLOR ? 1 : key_vertex_types[format].components;
}

static inline uint32_t value_bytes(enum value_type type)
{
    return type == VALUE_BYTES ? 1 : type == VALUE_U16 ? 2 : 4;
}

static inline void layout_add(struct layout *layout, unsigned element, enum triptych_format format)
{
    layout->format[element] = format;
    layout->offset[element] = layout->stride;
    layout->stride += key_vertex_types[format].bytes;
}

/* Lists the elements by their offsets in a vertex. Returns their number. */
unsigned layout_order(const struct layout *layout, unsigned order[STREAM_ELEMENTS]);

#endif
