/* The vertex declaration and its streams: which declarations are valid, and where each attribute then lies.
 *
 * The state has one element for each attribute, a list of elements with other usages, which only shaders
 * read, and one binding for each stream. A declaration sets all elements. An attribute that is set by
 * itself has a stream of its own, after those that declarations name, so later code treats both alike. The
 * extent of buffers is checked when something is drawn (render/device/draw.c). */
#include "contract/key.h"
#include "render/state/state.h"

#include <string.h>

const char *const state_attribute_name[TRIPTYCH_ATTRIBUTE_COUNT] = {
#define ATTRIBUTE(name, word, usage, index, meaning) #word,
#include "def/state/attribute.def"
#undef ATTRIBUTE
};

static const struct {
    uint8_t usage, index;
} attribute_usage[TRIPTYCH_ATTRIBUTE_COUNT] = {
#define ATTRIBUTE(name, word, usage, index, meaning) {TRIPTYCH_USAGE_##usage, index},
#include "def/state/attribute.def"
#undef ATTRIBUTE
};

enum { OFFSET_MAXIMUM = 65535, STRIDE_MAXIMUM = 65536, FREQUENCY_MAXIMUM = (1 << 30) - 1 };

/* --- Declarations --- */

static int check_element(const struct triptych_declaration_element *element, unsigned i, struct error *error)
{
    if (element->stream >= TRIPTYCH_STREAMS)
        return error_set(error, "element %u: stream %u, expected 0 to %u", i, element->stream,
                         TRIPTYCH_STREAMS - 1);
    if (element->offset > OFFSET_MAXIMUM)
        return error_set(error, "element %u: offset %zu, expected 0 to %d", i, element->offset,
                         OFFSET_MAXIMUM);
    if ((unsigned)element->format >= TRIPTYCH_FORMAT_COUNT || !element->format)
        return error_set(error, "element %u: format %u, expected 1 to %u", i, (unsigned)element->format,
                         TRIPTYCH_FORMAT_COUNT - 1);
    if ((unsigned)element->usage >= TRIPTYCH_USAGE_COUNT)
        return error_set(error, "element %u: usage %u, expected 0 to %u", i, (unsigned)element->usage,
                         TRIPTYCH_USAGE_COUNT - 1);
    if (element->usage_index >= TRIPTYCH_USAGE_INDICES)
        return error_set(error, "element %u: usage index %u, expected 0 to %u", i, element->usage_index,
                         TRIPTYCH_USAGE_INDICES - 1);
    return 0;
}

static int check_declaration(const struct triptych_declaration_element *elements, unsigned count,
                             struct error *error)
{
    uint8_t used[TRIPTYCH_USAGE_COUNT][TRIPTYCH_USAGE_INDICES] = {{0}};
    if (count > TRIPTYCH_DECLARATION_ELEMENTS)
        return error_set(error, "declaration of %u elements: expected at most %u", count,
                         TRIPTYCH_DECLARATION_ELEMENTS);
    for (unsigned i = 0; i < count; i++) {
        if (check_element(elements + i, i, error))
            return -1;
        if (used[elements[i].usage][elements[i].usage_index]++)
            return error_set(error, "element %u: usage %u with index %u again, expected it once", i,
                             (unsigned)elements[i].usage, elements[i].usage_index);
    }
    return 0;
}

/* Returns -1 if no attribute corresponds to it. */
static int find_attribute(unsigned usage, unsigned usage_index)
{
    for (int a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT; a++)
        if (attribute_usage[a].usage == usage && attribute_usage[a].index == usage_index)
            return a;
    return -1;
}

enum triptych_result state_set_declaration(struct state *state,
                                           const struct triptych_declaration_element *elements,
                                           unsigned count, struct error *error)
{
    if (check_declaration(elements, count, error))
        return TRIPTYCH_BAD_ARGUMENT;
    memset(state->element, 0, sizeof state->element);
    state->others = 0;
    for (unsigned i = 0; i < count; i++) {
        struct state_element element = {elements[i].format, elements[i].stream, elements[i].offset};
        int attribute = find_attribute(elements[i].usage, elements[i].usage_index);
        if (attribute >= 0)
            state->element[attribute] = element;
        else
            state->other[state->others++] =
                (struct state_other){(uint8_t)elements[i].usage, (uint8_t)elements[i].usage_index, element};
    }
    return TRIPTYCH_OK;
}

static struct triptych_declaration_element declared(const struct state_element *element, unsigned usage,
                                                    unsigned usage_index)
{
    return (struct triptych_declaration_element){element->stream, element->offset, element->format,
                                                 (enum triptych_usage)usage, usage_index};
}

unsigned state_declaration(const struct state *state, struct triptych_declaration_element *elements)
{
    unsigned count = 0;
    for (int a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT; a++)
        if (state->element[a].format && state->element[a].stream < TRIPTYCH_STREAMS)
            elements[count++] =
                declared(&state->element[a], attribute_usage[a].usage, attribute_usage[a].index);
    for (unsigned i = 0; i < state->others; i++)
        elements[count++] =
            declared(&state->other[i].element, state->other[i].usage, state->other[i].usage_index);
    return count;
}

const struct state_element *state_find_element(const struct state *state, unsigned usage,
                                               unsigned usage_index)
{
    int attribute = find_attribute(usage, usage_index);
    if (attribute >= 0)
        return state->element[attribute].format ? state->element + attribute : NULL;
    for (unsigned i = 0; i < state->others; i++)
        if (state->other[i].usage == usage && state->other[i].usage_index == usage_index)
            return &state->other[i].element;
    return NULL;
}

/* --- Flexible vertex formats --- */

/* Parts of a code that are looked at by name; def/state/fvf.def has them all. */
enum {
    FVF_POSITION = 0x400e,
    FVF_XYZRHW = 0x004,
    FVF_XYZB1 = 0x006,
    FVF_XYZB2 = 0x008,
    FVF_XYZB5 = 0x00e,
    FVF_XYZW = 0x4002,
    FVF_NORMAL = 0x010,
    FVF_PSIZE = 0x020,
    FVF_DIFFUSE = 0x040,
    FVF_SPECULAR = 0x080,
    FVF_SETS_SHIFT = 8,
    FVF_SETS = 0xf,
    FVF_LAST_UBYTE4 = 0x1000,
    FVF_LAST_COLOR = 0x8000,
    FVF_SIZE_SHIFT = 16
};

static uint32_t known_bits(void)
{
    uint32_t known = 0;
#define FVF(word, mask, value, meaning) known |= value;
#include "def/state/fvf.def"
#undef FVF
    return known;
}

static int check_fvf(uint32_t fvf, struct error *error)
{
    uint32_t sets = fvf >> FVF_SETS_SHIFT & FVF_SETS, position = fvf & FVF_POSITION;
    if (fvf & ~known_bits())
        return error_set(error, "vertex format 0x%x: the bits 0x%x have no meaning", (unsigned)fvf,
                         (unsigned)(fvf & ~known_bits()));
    if (!position || (position > FVF_XYZB5 && position != FVF_XYZW))
        return error_set(error, "vertex format 0x%x: expected one kind of position", (unsigned)fvf);
    if (sets > 8)
        return error_set(error, "vertex format 0x%x: %u sets of texture coordinates, expected at most 8",
                         (unsigned)fvf, (unsigned)sets);
    if (sets < 8 && fvf >> (FVF_SIZE_SHIFT + 2 * sets))
        return error_set(error, "vertex format 0x%x: sizes of more sets of texture coordinates than %u",
                         (unsigned)fvf, (unsigned)sets);
    if ((fvf & FVF_LAST_UBYTE4) && (fvf & FVF_LAST_COLOR))
        return error_set(error, "vertex format 0x%x: two kinds of indices, expected at most one",
                         (unsigned)fvf);
    return 0;
}

/* A declaration to which elements are added one after the other in stream 0. */
struct sequence {
    struct triptych_declaration_element element[TRIPTYCH_ATTRIBUTE_COUNT];
    unsigned count;
    size_t offset;
};

static void add(struct sequence *s, enum triptych_attribute attribute, enum triptych_format format)
{
    s->element[s->count++] = (struct triptych_declaration_element){
        0, s->offset, format, attribute_usage[attribute].usage, attribute_usage[attribute].index};
    s->offset += key_vertex_types[format].bytes;
}

static enum triptych_format floats(uint32_t count)
{
    return (enum triptych_format)(TRIPTYCH_FORMAT_FLOAT1 + count - 1);
}

/* With indices the last of the weights holds them. XYZB5 always has them, as one float by default. */
static void add_position(struct sequence *s, uint32_t fvf)
{
    uint32_t position = fvf & FVF_POSITION, weights = 0;
    uint32_t packed = fvf & (FVF_LAST_UBYTE4 | FVF_LAST_COLOR);
    if (position == FVF_XYZRHW) {
        add(s, TRIPTYCH_POSITIONT, TRIPTYCH_FORMAT_FLOAT4);
        return;
    }
    add(s, TRIPTYCH_POSITION, position == FVF_XYZW ? TRIPTYCH_FORMAT_FLOAT4 : TRIPTYCH_FORMAT_FLOAT3);
    if (position < FVF_XYZB1 || position > FVF_XYZB5)
        return;
    weights = (position - FVF_XYZB1) / 2 + 1;
    bool indexed = packed || position == FVF_XYZB5;
    if (indexed)
        weights--;
    if (weights)
        add(s, TRIPTYCH_WEIGHTS, floats(weights));
    if (indexed)
        add(s, TRIPTYCH_INDICES,
            packed == FVF_LAST_UBYTE4  ? TRIPTYCH_FORMAT_UBYTE4
            : packed == FVF_LAST_COLOR ? TRIPTYCH_FORMAT_COLOR
                                       : TRIPTYCH_FORMAT_FLOAT1);
}

enum triptych_result state_set_fvf(struct state *state, uint32_t fvf, struct error *error)
{
    static const uint8_t set_size[4] = {2, 3, 4, 1};
    struct sequence s = {.count = 0};
    if (check_fvf(fvf, error))
        return TRIPTYCH_BAD_ARGUMENT;
    add_position(&s, fvf);
    if (fvf & FVF_NORMAL)
        add(&s, TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3);
    if (fvf & FVF_PSIZE)
        add(&s, TRIPTYCH_POINT_SIZE, TRIPTYCH_FORMAT_FLOAT1);
    if (fvf & FVF_DIFFUSE)
        add(&s, TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR);
    if (fvf & FVF_SPECULAR)
        add(&s, TRIPTYCH_SPECULAR, TRIPTYCH_FORMAT_COLOR);
    for (uint32_t i = 0; i < (fvf >> FVF_SETS_SHIFT & FVF_SETS); i++)
        add(&s, (enum triptych_attribute)(TRIPTYCH_TEXCOORD + i),
            floats(set_size[fvf >> (FVF_SIZE_SHIFT + 2 * i) & 3]));
    return state_set_declaration(state, s.element, s.count, error);
}

/* --- Streams --- */

static int check_stream(unsigned stream, struct error *error)
{
    if (stream >= TRIPTYCH_STREAMS)
        return error_set(error, "stream %u: expected 0 to %u", stream, TRIPTYCH_STREAMS - 1);
    return 0;
}

enum triptych_result state_set_stream(struct state *state, unsigned stream, struct triptych_buffer *buffer,
                                      size_t offset, size_t stride, struct error *error)
{
    if (check_stream(stream, error))
        return TRIPTYCH_BAD_ARGUMENT;
    struct state_stream *s = state->stream + stream;
    if (buffer && stride > STRIDE_MAXIMUM) {
        error_set(error, "stream %u: stride %zu, expected 0 to %d", stream, stride, STRIDE_MAXIMUM);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (buffer && offset >= buffer->bytes) {
        error_set(error, "stream %u: offset %zu, expected one inside the buffer of %zu bytes", stream, offset,
                  buffer->bytes);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    s->buffer = buffer;
    s->offset = buffer ? offset : 0;
    s->stride = buffer ? stride : 0;
    return TRIPTYCH_OK;
}

bool state_has_stream(const struct state *state, unsigned stream, const struct triptych_buffer *buffer,
                      size_t offset, size_t stride)
{
    if (stream >= TRIPTYCH_STREAMS)
        return false;
    const struct state_stream *s = state->stream + stream;
    return s->buffer == buffer && s->offset == offset && s->stride == stride;
}

enum triptych_result state_set_frequency(struct state *state, unsigned stream,
                                         enum triptych_frequency frequency, uint32_t count,
                                         struct error *error)
{
    if (check_stream(stream, error))
        return TRIPTYCH_BAD_ARGUMENT;
    if ((unsigned)frequency >= TRIPTYCH_FREQUENCY_COUNT) {
        error_set(error, "stream %u: frequency %u, expected 0 to %u", stream, (unsigned)frequency,
                  TRIPTYCH_FREQUENCY_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    uint32_t most = frequency == TRIPTYCH_FREQUENCY_VERTEX ? 1 : FREQUENCY_MAXIMUM;
    if (!count || count > most) {
        error_set(error, "stream %u: frequency with count %u, expected 1 to %u", stream, (unsigned)count,
                  (unsigned)most);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!stream && frequency == TRIPTYCH_FREQUENCY_INSTANCE) {
        error_set(error, "stream 0: frequency by instance, expected it of streams 1 to %u",
                  TRIPTYCH_STREAMS - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    state->stream[stream].frequency = frequency;
    state->stream[stream].count = count;
    return TRIPTYCH_OK;
}

uint64_t state_last_vertex(const struct state *state, const struct state_element *element)
{
    const struct state_stream *stream = state_source(state, element);
    size_t taken = stream->offset + element->offset + key_vertex_types[element->format].bytes;
    if (!stream->stride)
        return UINT64_MAX;
    return (stream->buffer->bytes - taken) / stream->stride;
}

/* --- Attributes by themselves --- */

static int check_place(const struct triptych_element *element, const char *name, struct error *error)
{
    size_t bytes = key_vertex_types[element->format].bytes;
    if (!element->buffer)
        return error_set(error, "element %s: no buffer, expected one with this format", name);
    if (element->stride > STRIDE_MAXIMUM)
        return error_set(error, "element %s: stride %zu, expected 0 to %d", name, element->stride,
                         STRIDE_MAXIMUM);
    if (element->buffer->bytes < bytes || element->offset > element->buffer->bytes - bytes)
        return error_set(error,
                         "element %s: %zu bytes at offset %zu, expected them inside the buffer of %zu bytes",
                         name, bytes, element->offset, element->buffer->bytes);
    return 0;
}

enum triptych_result state_set_element(struct state *state, enum triptych_attribute attribute,
                                       const struct triptych_element *element, struct error *error)
{
    if ((unsigned)attribute >= TRIPTYCH_ATTRIBUTE_COUNT) {
        error_set(error, "attribute %u: expected 0 to %u", (unsigned)attribute, TRIPTYCH_ATTRIBUTE_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if ((unsigned)element->format >= TRIPTYCH_FORMAT_COUNT) {
        error_set(error, "element %s: format %u, expected 0 to %u", state_attribute_name[attribute],
                  (unsigned)element->format, TRIPTYCH_FORMAT_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    unsigned own = TRIPTYCH_STREAMS + attribute;
    if (element->format && check_place(element, state_attribute_name[attribute], error))
        return TRIPTYCH_BAD_ARGUMENT;
    struct state_stream stream = {
        .buffer = element->buffer, .offset = element->offset, .stride = element->stride};
    state->stream[own] = element->format ? stream : (struct state_stream){.buffer = NULL};
    state->element[attribute] = (struct state_element){element->format, element->format ? own : 0, 0};
    return TRIPTYCH_OK;
}
