/* Properties of calls that do not depend on a device: positions, declarations, constants that are computed
 * from transforms. */
#include "command/stream/stream.h"
#include "command/stream/transform.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

int stream_fail(const struct stream *stream, const struct call *call, const char *reason, struct error *error)
{
    const struct call_position *position = &call->position;
    if (position->kind == POSITION_CONTAINER)
        return error_set(error, "%s: offset %" PRIu64 " (byte %" PRIu32 ", %s): %s", stream->path,
                         position->container.offset, position->container.byte, call_row(call->type)->word,
                         reason);
    return error_set(error, "%s:%" PRIu32 ":%" PRIu32 ": %s", stream->path, position->text.line,
                     position->text.column, reason);
}

/* --- Declarations --------------------------------------------------------------------------------------- */

unsigned stream_declaration(const struct call *call,
                            struct triptych_declaration_element elements[TRIPTYCH_DECLARATION_ELEMENTS])
{
    for (uint32_t i = 0; i < call->declare.count; i++) {
        const struct call_declared *from = &call->declare.element[i];
        elements[i] = (struct triptych_declaration_element){from->stream, from->offset, from->format,
                                                            from->usage, from->usage_index};
    }
    return call->declare.count;
}

unsigned stream_declare_layout(const struct layout *layout,
                               struct triptych_declaration_element elements[STREAM_ELEMENTS])
{
    unsigned count = 0, index;
    int others = 0;
    for (unsigned e = 0; e < STREAM_ELEMENTS; e++) {
        if (layout->format[e] == TRIPTYCH_FORMAT_NONE)
            continue;
        enum triptych_usage usage = resource_element_usage(e, &index);
        elements[count++] =
            (struct triptych_declaration_element){0, layout->offset[e], layout->format[e], usage, index};
        others |= e >= TRIPTYCH_ATTRIBUTE_COUNT;
    }
    return others ? count : 0;
}

const char *stream_element_word(unsigned usage, unsigned usage_index)
{
    static _Thread_local char text[32];
    int element = resource_find_element(usage, usage_index);
    if (element >= 0)
        return word_text(WORDS_ATTRIBUTE, (unsigned)element);
    snprintf(text, sizeof text, "%s.%u", word_text(WORDS_USAGE, usage), usage_index);
    return text;
}

/* --- Constants ------------------------------------------------------------------------------------------ */

int stream_store_columns(double matrix[4][4], bool inverse, bool transposed,
                         float constants[CONSTANTS_PER_CALL][4])
{
    bool finite = true;
    if (inverse)
        transform_invert(matrix);
    if (!transposed)
        transform_transpose(matrix);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            constants[i][j] = (float)matrix[i][j];
            finite &= isfinite(constants[i][j]) != 0;
        }
    return finite ? 0 : -1;
}

static void widen(const float from[4][4], double to[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            to[i][j] = (double)from[i][j];
}

int stream_constants(const struct call *call, const float (*transforms)[4][4],
                     float constants[CONSTANTS_PER_CALL][4])
{
    double product[4][4], next[4][4];
    widen(transforms[call->constant_matrix.factor[0]], product);
    for (uint32_t i = 1; i < call->constant_matrix.factors; i++) {
        widen(transforms[call->constant_matrix.factor[i]], next);
        transform_multiply(product, next, product);
    }
    return stream_store_columns(product, call->constant_matrix.inverse, call->constant_matrix.transposed,
                                constants);
}
