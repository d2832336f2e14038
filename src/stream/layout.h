/* Sizes and places of attributes within interleaved vertices. */
#ifndef STREAM_LAYOUT_H
#define STREAM_LAYOUT_H

#include "stream/stream.h"

/* Words of four bytes that an attribute of this format takes. */
static inline uint32_t format_words(enum triptych_format format)
{
    if (format == TRIPTYCH_FORMAT_COLOR)
        return 1;
    return (uint32_t)(format - TRIPTYCH_FORMAT_NONE);
}

static inline uint32_t value_bytes(enum value_type type)
{
    return type == VALUE_U16 ? 2 : 4;
}

static inline void layout_add(struct layout *layout, enum triptych_attribute attribute,
                              enum triptych_format format)
{
    layout->format[attribute] = format;
    layout->offset[attribute] = layout->stride;
    layout->stride += 4 * format_words(format);
}

#endif
