/* Whether the executed calls of a stream can be executed.
 *
 * The check follows the calls with the device's own state (draw/state.h), so that what a state, a light or a
 * viewport may be is decided in one place. Draws are checked against everything that is bound, whether the
 * pipeline would read it or not. A reason stands at the call that cannot be executed, also when it is played
 * in a sequence. */
#include "stream/check.h"
#include "container/layout.h"
#include "stream/words.h"

#include "draw/device.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* --- Following --------------------------------------------------------------------------------------------
 */

/* A resource as the state sees it: its size is all that is looked at, and of indices their values. */
struct stand_in {
    struct triptych_buffer buffer; /* the first: what the state has is one of these */
    uint32_t resource;
};

struct followed {
    struct stand_in *stand_in; /* once it is bound */
    bool begun, released;      /* a query; anything */
    uint32_t line, column;     /* of the call that began the query */
};

struct follower {
    const struct stream *stream;
    struct state state;
    struct shader_registers registers[SHADER_STAGES];
    uint32_t width, height;                    /* of what is drawn to; 0: none yet */
    struct triptych_target_description target; /* set last */
    struct triptych_target_description drawn;  /* that, or what textures make */
    struct followed *resources;                /* by number, as many as have been asked for */
    uint32_t resource_count, begun;            /* queries that have begun */
    uint32_t indices, index_bits;
    uint32_t texture[TRIPTYCH_SAMPLERS], shader[SHADER_STAGES], attached[TRIPTYCH_TARGETS + 1];
    bool integers_checked; /* those of the shaders that are set: nothing is wrong with them */
};

static struct followed *followed(struct follower *follower, uint32_t number)
{
    if (number >= follower->resource_count) {
        uint32_t most = follower->stream->resource_count, twice = 2 * follower->resource_count;
        uint32_t count = most > twice ? most : twice;
        struct followed *larger = realloc(follower->resources, count * sizeof *larger);
        if (!larger)
            return NULL;
        memset(larger + follower->resource_count, 0, (count - follower->resource_count) * sizeof *larger);
        follower->resources = larger;
        follower->resource_count = count;
    }
    return &follower->resources[number];
}

static struct triptych_buffer *stand_in(struct follower *follower, uint32_t resource, struct error *error)
{
    struct followed *entry = followed(follower, resource);
    const struct resource *data = &follower->stream->resources[resource];
    if (entry && !entry->stand_in) {
        entry->stand_in = calloc(1, sizeof *entry->stand_in);
        if (entry->stand_in) {
            entry->stand_in->resource = resource;
            entry->stand_in->buffer.data =
                (uint8_t *)(uintptr_t)resource_data(data, &entry->stand_in->buffer.bytes);
        }
    }
    if (entry && entry->stand_in)
        return &entry->stand_in->buffer;
    error_set(error, "not enough memory");
    return NULL;
}

static const char *buffer_name(const struct follower *follower, const struct triptych_buffer *buffer)
{
    return follower->stream->resources[((const struct stand_in *)(const void *)buffer)->resource].name;
}

static int bind_element(struct follower *follower, enum triptych_attribute attribute, uint32_t resource,
                        enum triptych_format format, uint32_t offset, uint32_t stride, struct error *error)
{
    struct triptych_element element = {.format = format, .offset = offset, .stride = stride};
    if (format != TRIPTYCH_FORMAT_NONE && !(element.buffer = stand_in(follower, resource, error)))
        return -1;
    return state_set_element(&follower->state, attribute, &element, error) ? -1 : 0;
}

static int bind_stream(struct follower *follower, const struct call *call, struct error *error)
{
    struct triptych_buffer *buffer = NULL;
    if (call->resource != NO_RESOURCE && !(buffer = stand_in(follower, call->resource, error)))
        return -1;
    return state_set_stream(&follower->state, call->bind_stream.number, buffer, call->bind_stream.offset,
                            call->bind_stream.stride, error);
}

static int declare(struct follower *follower, const struct call *call, struct error *error)
{
    struct triptych_declaration_element elements[TRIPTYCH_DECLARATION_ELEMENTS];
    unsigned count = stream_declaration(call, elements);
    return state_set_declaration(&follower->state, elements, count, error);
}

static int bind_vertices(struct follower *follower, uint32_t resource, struct error *error)
{
    const struct layout *layout = &follower->stream->resources[resource].layout;
    struct triptych_declaration_element elements[STREAM_ELEMENTS];
    unsigned count = stream_declare_layout(layout, elements);
    if (state_set_declaration(&follower->state, elements, count, error))
        return -1;
    if (count) {
        struct triptych_buffer *buffer = stand_in(follower, resource, error);
        return buffer ? (int)state_set_stream(&follower->state, 0, buffer, 0, layout->stride, error) : -1;
    }
    for (unsigned a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT; a++)
        if (layout->format[a] != TRIPTYCH_FORMAT_NONE &&
            bind_element(follower, (enum triptych_attribute)a, resource, layout->format[a], layout->offset[a],
                         layout->stride, error))
            return -1;
    return 0;
}

/* Whether vertices up to `last`, or as many as the instances need, have the element. */
static int check_element(const struct follower *follower, const struct state_element *element,
                         const char *word, uint64_t last, struct error *error)
{
    const struct state_stream *stream = &follower->state.stream[element->stream];
    if (stream->frequency == TRIPTYCH_FREQUENCY_INSTANCE)
        last = (state_instances(&follower->state) - 1) / stream->count;
    if (!stream->buffer)
        return error_set(error, "found %s in stream %u with nothing bound, expected bind stream before it",
                         word, element->stream);
    const char *name = buffer_name(follower, stream->buffer);
    size_t end = stream->offset + element->offset + vertex_types[element->format].bytes;
    if (end > stream->buffer->bytes)
        return error_set(error, "found %s at bytes up to %zu, expected at most %zu, those of %s", word, end,
                         stream->buffer->bytes, name);
    uint64_t most = state_last_vertex(&follower->state, element);
    if (last > most)
        return error_set(error,
                         "found vertex %" PRIu64 " drawn, expected at most %" PRIu64 ", the last %s in %s",
                         last, most, word, name);
    return 0;
}

/* Whether vertices up to `last` lie in everything that is bound. */
static int check_vertices(const struct follower *follower, uint64_t last, struct error *error)
{
    const struct state *state = &follower->state;
    for (unsigned a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT; a++)
        if (state->element[a].format != TRIPTYCH_FORMAT_NONE &&
            check_element(follower, &state->element[a], word_text(WORDS_ATTRIBUTE, a), last, error))
            return -1;
    for (unsigned i = 0; i < state->others; i++) {
        const struct state_other *other = &state->other[i];
        if (check_element(follower, &other->element, stream_element_word(other->usage, other->usage_index),
                          last, error))
            return -1;
    }
    return 0;
}

static int check_no_instances(const struct follower *follower, struct error *error)
{
    for (unsigned i = 0; i < TRIPTYCH_STREAMS; i++)
        if (follower->state.stream[i].frequency != TRIPTYCH_FREQUENCY_VERTEX)
            return error_set(error,
                             "found stream %u stepping by instance, expected frequency %u vertex 1 "
                             "or an indexed draw",
                             i, i);
    return 0;
}

/* Of a range of them. The stand-in remembers what it was asked. */
static int index_extremes(struct follower *follower, uint64_t first, uint64_t count, uint32_t *least,
                          uint32_t *most, struct error *error)
{
    struct triptych_buffer *buffer = stand_in(follower, follower->indices, error);
    if (!buffer)
        return -1;
    const struct index_range *range =
        buffer_index_range(buffer, follower->index_bits, (uint32_t)first, (uint32_t)count);
    *least = range->minimum;
    *most = range->maximum;
    return 0;
}

/* The extremes of all indices do for most draws; only where they would not are those of the range looked at.
 */
static int check_indices(struct follower *follower, int32_t base, uint64_t first, uint64_t count,
                         struct error *error)
{
    const struct resource *resource = &follower->stream->resources[follower->indices];
    uint32_t least = resource->index_least, most = resource->index_most;
    size_t bytes;
    resource_data(resource, &bytes);
    uint64_t room = bytes / (follower->index_bits / 8);
    if (first + count > room)
        return error_set(error, "found index %" PRIu64 " drawn, expected at most %" PRIu64 ", the last in %s",
                         first + count - 1, room - 1, resource->name);
    struct error ignored = {{0}};
    if (!resource->indices || (int64_t)base + least < 0 ||
        check_vertices(follower, (uint64_t)((int64_t)base + most), &ignored))
        if (index_extremes(follower, first, count, &least, &most, error))
            return -1;
    if ((int64_t)base + least < 0)
        return error_set(error, "found vertex %" PRId64 " drawn, expected 0 or more", (int64_t)base + least);
    if ((int64_t)base + most > UINT32_MAX)
        return error_set(error, "found vertex %" PRId64 " drawn, expected less than 2^32",
                         (int64_t)base + most);
    return check_vertices(follower, (uint64_t)((int64_t)base + most), error);
}

static int check_draw(struct follower *follower, const struct call *call, struct error *error)
{
    uint64_t first = call->draw.first, count = call->draw.count;
    int indexed = call->type == CALL_DRAW_INDEXED;
    if (!follower->integers_checked && state_check_integers(&follower->state, error))
        return -1;
    follower->integers_checked = true;
    if (!follower->state.program[STAGE_VERTEX] && !follower->state.element[TRIPTYCH_POSITION].format &&
        !follower->state.element[TRIPTYCH_POSITIONT].format)
        return error_set(error, "found no position bound, expected bind vertices before it");
    if (indexed && follower->indices == NO_RESOURCE)
        return error_set(error, "found no indices bound, expected bind indices before it");
    if (!indexed && check_no_instances(follower, error))
        return -1;
    if (!count)
        return 0;
    count = primitive_corners(call->draw.primitive, call->draw.count);
    if (indexed)
        return check_indices(follower, call->draw.base, first, count, error);
    if (first + count - 1 > UINT32_MAX)
        return error_set(error, "found vertex %" PRIu64 " drawn, expected less than 2^32", first + count - 1);
    return check_vertices(follower, first + count - 1, error);
}

static void draw_to(struct follower *follower, const struct triptych_target_description *target)
{
    follower->drawn = *target;
    follower->width = target->width;
    follower->height = target->height;
    state_set_target(&follower->state, target);
}

static int attach(struct follower *follower, const struct call *call, struct error *error)
{
    struct triptych_target_description description = follower->target;
    if (call->attach.some && check_attach(follower->stream, call, &description, error))
        return -1;
    draw_to(follower, &description);
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        follower->attached[t] = call->attach.some ? call->attach.color[t].resource : NO_RESOURCE;
    follower->attached[TRIPTYCH_TARGETS] = call->attach.some ? call->attach.depth.resource : NO_RESOURCE;
    return 0;
}

/* Queries begin and end within one frame, so that each frame has results of its own. */
static int follow_query(struct follower *follower, const struct call *call, struct error *error)
{
    const char *name = follower->stream->resources[call->resource].name;
    struct followed *query = followed(follower, call->resource);
    if (!query)
        return error_set(error, "not enough memory");
    if (call->type == CALL_BEGIN_QUERY && query->begun)
        return error_set(error, "found query %s begun again, expected end-query %s before it", name, name);
    if (call->type == CALL_END_QUERY && !query->begun)
        return error_set(error, "found query %s not begun, expected begin-query %s before it", name, name);
    query->begun = call->type == CALL_BEGIN_QUERY;
    query->line = call->line;
    query->column = call->column;
    follower->begun += query->begun ? 1 : UINT32_MAX;
    return 0;
}

int follower_frame(struct follower *follower, struct error *error)
{
    for (uint32_t i = 0; i < follower->resource_count && follower->begun; i++)
        if (follower->resources[i].begun) {
            struct error reason = {{0}};
            const char *name = follower->stream->resources[i].name;
            error_set(&reason, "found query %s begun and not ended, expected end-query %s in its frame", name,
                      name);
            const struct call begin = {.type = CALL_BEGIN_QUERY,
                                       .line = follower->resources[i].line,
                                       .column = follower->resources[i].column};
            return stream_fail(follower->stream, &begin, reason.text, error);
        }
    return 0;
}

/* --- Releases ---------------------------------------------------------------------------------------------
 */

/* What still has the resource, or null. */
static const char *holder(const struct follower *follower, uint32_t number)
{
    const struct state *state = &follower->state;
    const struct followed *entry = &follower->resources[number];
    for (unsigned i = 0; i < STREAM_COUNT && entry->stand_in; i++)
        if (state->stream[i].buffer == &entry->stand_in->buffer)
            return "bound as vertices";
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        if (follower->texture[i] == number)
            return "bound as a texture";
    for (unsigned i = 0; i < SHADER_STAGES; i++)
        if (follower->shader[i] == number)
            return "set as a shader";
    for (unsigned i = 0; i <= TRIPTYCH_TARGETS; i++)
        if (follower->attached[i] == number)
            return "attached";
    if (follower->indices == number)
        return "bound as indices";
    return entry->begun ? "begun" : NULL;
}

static int follow_release(struct follower *follower, const struct call *call, struct error *error)
{
    struct followed *entry = followed(follower, call->resource);
    if (!entry)
        return error_set(error, "not enough memory");
    const char *held = holder(follower, call->resource);
    if (held)
        return error_set(error, "found '%s' %s, expected a resource that nothing uses",
                         follower->stream->resources[call->resource].name, held);
    free(entry->stand_in);
    *entry = (struct followed){.released = true};
    return 0;
}

static int check_released(struct follower *follower, const struct call *call, struct error *error)
{
    struct call_resource resources[CALL_RESOURCES];
    struct call copy = *call;
    unsigned count = call_resources(&copy, resources);
    for (unsigned i = 0; i < count; i++) {
        uint32_t number = *resources[i].number;
        if (number < follower->resource_count && follower->resources[number].released)
            return error_set(error, "found '%s', which was released, expected another",
                             follower->stream->resources[number].name);
    }
    return 0;
}

void follower_define(struct follower *follower, uint32_t number)
{
    if (number < follower->resource_count)
        follower->resources[number] = (struct followed){.released = false};
}

/* --- Calls ------------------------------------------------------------------------------------------------
 */

static void set_shader(struct follower *follower, const struct call *call)
{
    follower->state.program[call->shader] =
        call->resource == NO_RESOURCE ? NULL : follower->stream->resources[call->resource].program;
    follower->shader[call->shader] = call->resource;
    follower->integers_checked = false;
}

/* Floats can be anything. */
static void set_constants(struct follower *follower, const struct call *call)
{
    struct shader_registers *registers = follower->state.registers[call->constants.stage];
    if (call->constants.type != CONSTANTS_INTEGER)
        return;
    memcpy(registers->integers[call->constants.first], call->constants.integers,
           call->constants.count * sizeof *registers->integers);
    follower->integers_checked = false;
}

static int check_constant_matrix(const struct follower *follower, const struct call *call,
                                 struct error *error)
{
    float constants[CONSTANTS_PER_CALL][4];
    if (stream_constants(call, (const float(*)[4][4])follower->state.transform, constants))
        return error_set(error, "found constants that are not finite, expected transforms%s",
                         call->constant_matrix.inverse ? " with an inverse" : " with finite values");
    return 0;
}

static int bind_indices(struct follower *follower, const struct call *call)
{
    follower->indices = call->resource;
    if (call->resource != NO_RESOURCE)
        follower->index_bits =
            call->index_bits ? call->index_bits : follower->stream->resources[call->resource].index_bits;
    return 0;
}

/* Whether a buffer has as many bytes as what it is for. */
static int check_bytes(const struct follower *follower, uint32_t source, size_t expected, struct error *error)
{
    const struct resource *resource = &follower->stream->resources[source];
    size_t bytes;
    resource_data(resource, &bytes);
    return bytes == expected
               ? 0
               : error_set(error, "found %zu bytes in %s, expected %zu", bytes, resource->name, expected);
}

static int follow(struct follower *follower, const struct call *call, struct error *error)
{
    struct state *state = &follower->state;
    switch (call->type) {
    case CALL_TARGET:
        follower->target = call->target;
        memset(follower->attached, 0xff, sizeof follower->attached);
        draw_to(follower, &call->target);
        return 0;
    case CALL_ATTACH: return attach(follower, call, error);
    case CALL_COPY: return check_copy(follower->stream, call, &follower->target, error);
    case CALL_VIEWPORT:
        return state_set_viewport(state, &call->viewport, follower->width, follower->height, error);
    case CALL_SCISSOR: {
        struct scissor scissor = {call->scissor.x, call->scissor.y, call->scissor.width,
                                  call->scissor.height};
        return state_set_scissor(state, scissor, follower->width, follower->height, error);
    }
    case CALL_SET:
        return state_set_value(state, call->set.table, call->set.i, call->set.row, call->set.value, error);
    case CALL_CONVENTION:
        return state_set_convention(state, call->convention.which, call->convention.value, error);
    case CALL_CLIP_PLANE:
        return state_set_clip_plane(state, call->clip_plane.index, call->clip_plane.plane, error);
    case CALL_TRANSFORM:
        return state_set_transform(state, call->transform.which, call->transform.matrix, error);
    case CALL_MATERIAL: return state_set_material(state, &call->material, error);
    case CALL_LIGHT: return state_set_light(state, call->light.index, &call->light.value, error);
    case CALL_ENABLE_LIGHT: return 0;
    case CALL_BIND_TEXTURE: follower->texture[call->sampler] = call->resource; return 0;
    case CALL_BIND_VERTICES: return bind_vertices(follower, call->resource, error);
    case CALL_BIND_INDICES: return bind_indices(follower, call);
    case CALL_BIND_ELEMENT:
        return bind_element(follower, call->element.attribute, call->resource, call->element.format,
                            call->element.offset, call->element.stride, error);
    case CALL_BIND_STREAM: return bind_stream(follower, call, error);
    case CALL_DECLARE: return declare(follower, call, error);
    case CALL_FVF: return state_set_fvf(state, call->fvf, error);
    case CALL_FREQUENCY:
        return state_set_frequency(state, call->frequency.stream, call->frequency.frequency,
                                   call->frequency.count, error);
    case CALL_SHADER: set_shader(follower, call); return 0;
    case CALL_CONSTANTS: set_constants(follower, call); return 0;
    case CALL_CONSTANT_MATRIX: return check_constant_matrix(follower, call, error);
    case CALL_UPDATE:
    case CALL_MIPS: return 0;
    case CALL_TEXELS:
        return check_bytes(follower, call->texels.source,
                           resource_texels(&follower->stream->resources[call->resource]), error);
    case CALL_CONTENTS:
        return check_bytes(follower, call->resource, target_contents_bytes(&follower->drawn), error);
    case CALL_RELEASE: return follow_release(follower, call, error);
    case CALL_CLEAR:
        return state_check_clear(state->depth_format, call->clear.flags, call->clear.color, call->clear.depth,
                                 error);
    case CALL_DRAW:
    case CALL_DRAW_INDEXED: return check_draw(follower, call, error);
    case CALL_DRAW_MESH: bind_indices(follower, call); return bind_vertices(follower, call->resource, error);
    case CALL_BEGIN_QUERY:
    case CALL_END_QUERY: return follow_query(follower, call, error);
    case CALL_FRAME:
    case CALL_PLAY:
    case CALL_SEQUENCE: return 0;
    }
    return 0;
}

static int needs_target(enum call_type type)
{
    return type == CALL_VIEWPORT || type == CALL_SCISSOR || type == CALL_CLEAR || type == CALL_CONTENTS ||
           type == CALL_DRAW || type == CALL_DRAW_INDEXED || type == CALL_DRAW_MESH;
}

int follower_call(struct follower *follower, const struct call *call, struct error *error)
{
    struct error reason = {{0}};
    if (needs_target(call->type) && !follower->width)
        return stream_fail(follower->stream, call, "found no target, expected target WIDTH HEIGHT before it",
                           error);
    if (check_released(follower, call, &reason) || follow(follower, call, &reason))
        return stream_fail(follower->stream, call, reason.text, error);
    return 0;
}

struct follower *follower_create(const struct stream *stream)
{
    struct follower *follower = calloc(1, sizeof *follower);
    if (!follower)
        return NULL;
    follower->stream = stream;
    follower->indices = NO_RESOURCE;
    memset(follower->texture, 0xff, sizeof follower->texture);
    memset(follower->shader, 0xff, sizeof follower->shader);
    memset(follower->attached, 0xff, sizeof follower->attached);
    state_initialize(&follower->state);
    for (int stage = 0; stage < SHADER_STAGES; stage++)
        follower->state.registers[stage] = &follower->registers[stage];
    return follower;
}

void follower_free(struct follower *follower)
{
    for (uint32_t i = 0; follower && i < follower->resource_count; i++)
        free(follower->resources[i].stand_in);
    if (follower)
        free(follower->resources);
    free(follower);
}

static int follow_all(struct follower *follower, struct error *error)
{
    const struct stream *stream = follower->stream;
    uint32_t frame = 0;
    for (uint32_t i = 0; i < stream->executed_count; i++) {
        for (; frame < stream->frame_count && stream->frames[frame + 1] <= i; frame++)
            if (follower_frame(follower, error))
                return -1;
        if (follower_call(follower, &stream->calls[stream->executed[i]], error))
            return -1;
    }
    return follower_frame(follower, error);
}

int stream_check(const struct stream *stream, struct error *error)
{
    struct follower *follower = follower_create(stream);
    int result =
        follower ? follow_all(follower, error) : error_set(error, "%s: not enough memory", stream->path);
    follower_free(follower);
    return result;
}
