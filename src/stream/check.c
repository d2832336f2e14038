/* The stream as a whole: its executed calls and frames, and whether they can be executed.
 *
 * The check follows the calls with the device's own state (draw/state.h), so that what a state, a light or a
 * viewport may be is decided in one place. Draws are checked against everything that is bound, whether the
 * pipeline would read it or not. A reason stands at the call that cannot be executed, also when it is played
 * in a sequence. */
#include "stream/layout.h"
#include "stream/parse.h"

#include "draw/device.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static int fail_at(struct parser *parser, const struct call *call, const char *reason)
{
    struct token place = {.line = call->line, .column = call->column};
    return lex_fail(&parser->lex, &place, "%s", reason);
}

/* --- Expansion --------------------------------------------------------------------------------------------
 */

struct expansion {
    struct parser *parser;
    uint32_t frame_capacity;
};

static int add_frame(struct expansion *expansion, const struct call *call)
{
    struct stream *stream = expansion->parser->stream;
    if (stream->frame_count == LIMIT_FRAMES) {
        struct error reason = {{0}};
        error_set(&reason, "found one more frame, expected at most %d", LIMIT_FRAMES);
        return fail_at(expansion->parser, call, reason.text);
    }
    if (stream->frame_count + 2 > expansion->frame_capacity) {
        uint32_t capacity = 2 * expansion->frame_capacity + 16;
        uint32_t *larger = realloc(stream->frames, capacity * sizeof *larger);
        if (!larger)
            return fail_at(expansion->parser, call, "not enough memory");
        stream->frames = larger;
        expansion->frame_capacity = capacity;
    }
    stream->frames[stream->frame_count++] = stream->executed_count;
    return 0;
}

/* Executes calls first to last - 1. frames[f] is where frame f ends until all is expanded. */
static int expand(struct expansion *expansion, uint32_t first, uint32_t last)
{
    struct stream *stream = expansion->parser->stream;
    for (uint32_t i = first; i < last; i++) {
        const struct call *call = &stream->calls[i];
        if (call->type == CALL_SEQUENCE) {
            i += call->sequence.count;
        } else if (call->type == CALL_FRAME) {
            if (add_frame(expansion, call))
                return -1;
        } else if (call->type == CALL_PLAY) {
            uint32_t sequence = stream->resources[call->resource].call;
            if (expand(expansion, sequence + 1, sequence + 1 + stream->calls[sequence].sequence.count))
                return -1;
        } else {
            stream->executed[stream->executed_count++] = i;
        }
    }
    return 0;
}

int stream_expand(struct parser *parser)
{
    struct stream *stream = parser->stream;
    struct expansion expansion = {.parser = parser};
    if (!parser->executed)
        return lex_expected(&parser->lex, "at least one call");
    /* Counts plays and frames too: at least enough. */
    stream->executed = malloc(parser->executed * sizeof *stream->executed);
    if (!stream->executed)
        return lex_fail(&parser->lex, &parser->lex.token, "not enough memory");
    if (expand(&expansion, 0, stream->call_count))
        return -1;
    uint32_t ended = stream->frame_count ? stream->frames[stream->frame_count - 1] : 0;
    if (stream->executed_count > ended && add_frame(&expansion, &stream->calls[stream->call_count - 1]))
        return -1;
    if (!stream->frame_count)
        return lex_expected(&parser->lex, "at least one call that is executed");
    memmove(stream->frames + 1, stream->frames, stream->frame_count * sizeof *stream->frames);
    stream->frames[0] = 0;
    return 0;
}

/* --- Following --------------------------------------------------------------------------------------------
 */

struct follower {
    struct parser *parser;
    const struct stream *stream;
    struct state state;
    uint32_t width, height;                    /* of what is drawn to; 0: none yet */
    struct triptych_target_description target; /* set last */
    struct triptych_buffer *stand_ins;         /* one per resource: their sizes are all that is looked at */
    uint32_t indices;
    const struct call **begun; /* by resource: the call that began the query, null outside */
    bool integers_checked;     /* those of the shaders that are set: nothing is wrong with them */
};

static struct triptych_buffer *stand_in(struct follower *follower, uint32_t resource)
{
    struct triptych_buffer *buffer = &follower->stand_ins[resource];
    resource_data(&follower->stream->resources[resource], &buffer->bytes);
    return buffer;
}

static int bind_element(struct follower *follower, enum triptych_attribute attribute, uint32_t resource,
                        enum triptych_format format, uint32_t offset, uint32_t stride, struct error *error)
{
    struct triptych_element element = {.format = format, .offset = offset, .stride = stride};
    if (format != TRIPTYCH_FORMAT_NONE)
        element.buffer = stand_in(follower, resource);
    return state_set_element(&follower->state, attribute, &element, error) ? -1 : 0;
}

static int bind_stream(struct follower *follower, const struct call *call, struct error *error)
{
    struct triptych_buffer *buffer =
        call->resource == NO_RESOURCE ? NULL : stand_in(follower, call->resource);
    return state_set_stream(&follower->state, call->bind_stream.number, buffer, call->bind_stream.offset,
                            call->bind_stream.stride, error);
}

static int declare(struct follower *follower, const struct call *call, struct error *error)
{
    struct triptych_declaration_element elements[STREAM_ELEMENTS];
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
    if (count)
        return state_set_stream(&follower->state, 0, stand_in(follower, resource), 0, layout->stride, error);
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
    const char *name = follower->stream->resources[stream->buffer - follower->stand_ins].name;
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

static void index_extremes(const struct resource *resource, uint64_t first, uint64_t count, uint32_t *least,
                           uint32_t *most)
{
    const uint16_t *narrow = resource->indices;
    const uint32_t *wide = resource->indices;
    *least = UINT32_MAX;
    *most = 0;
    for (uint64_t i = first; i < first + count; i++) {
        uint32_t index = resource->index_bits == 16 ? narrow[i] : wide[i];
        *least = index < *least ? index : *least;
        *most = index > *most ? index : *most;
    }
}

/* The extremes of all indices do for most draws; only where they would not are those of the range looked at.
 */
static int check_indices(const struct follower *follower, int32_t base, uint64_t first, uint64_t count,
                         struct error *error)
{
    if (follower->indices == NO_RESOURCE)
        return error_set(error, "found no indices bound, expected bind indices before it");
    const struct resource *resource = &follower->stream->resources[follower->indices];
    uint32_t least = resource->index_least, most = resource->index_most;
    if (first + count > resource->index_count)
        return error_set(error, "found index %" PRIu64 " drawn, expected at most %u, the last in %s",
                         first + count - 1, resource->index_count - 1, resource->name);
    struct error ignored = {{0}};
    if ((int64_t)base + least < 0 || check_vertices(follower, (uint64_t)((int64_t)base + most), &ignored))
        index_extremes(resource, first, count, &least, &most);
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
    return 0;
}

/* Queries begin and end within one frame, so that each frame has results of its own. */
static int follow_query(struct follower *follower, const struct call *call, struct error *error)
{
    const char *name = follower->stream->resources[call->resource].name;
    const struct call **begun = &follower->begun[call->resource];
    if (call->type == CALL_BEGIN_QUERY && *begun)
        return error_set(error, "found query %s begun again, expected end-query %s before it", name, name);
    if (call->type == CALL_END_QUERY && !*begun)
        return error_set(error, "found query %s not begun, expected begin-query %s before it", name, name);
    *begun = call->type == CALL_BEGIN_QUERY ? call : NULL;
    return 0;
}

static int check_queries_ended(const struct follower *follower)
{
    for (uint32_t i = 0; i < follower->stream->resource_count; i++)
        if (follower->begun[i]) {
            struct error reason = {{0}};
            const char *name = follower->stream->resources[i].name;
            error_set(&reason, "found query %s begun and not ended, expected end-query %s in its frame", name,
                      name);
            return fail_at(follower->parser, follower->begun[i], reason.text);
        }
    return 0;
}

static void set_shader(struct follower *follower, const struct call *call)
{
    follower->state.program[call->shader] =
        call->resource == NO_RESOURCE ? NULL : follower->stream->resources[call->resource].program;
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

static int follow(struct follower *follower, const struct call *call, struct error *error)
{
    struct state *state = &follower->state;
    switch (call->type) {
    case CALL_TARGET:
        follower->target = call->target;
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
    case CALL_CLIP_PLANE: return 0;
    case CALL_TRANSFORM:
        return state_set_transform(state, call->transform.which, call->transform.matrix, error);
    case CALL_MATERIAL: return state_set_material(state, &call->material, error);
    case CALL_LIGHT: return state_set_light(state, call->light.index, &call->light.value, error);
    case CALL_ENABLE_LIGHT: return 0;
    case CALL_BIND_TEXTURE: return 0;
    case CALL_BIND_VERTICES: return bind_vertices(follower, call->resource, error);
    case CALL_BIND_INDICES: follower->indices = call->resource; return 0;
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
    case CALL_CLEAR:
        return state_check_clear(state->depth_format, call->clear.flags, call->clear.color, call->clear.depth,
                                 error);
    case CALL_DRAW:
    case CALL_DRAW_INDEXED: return check_draw(follower, call, error);
    case CALL_DRAW_MESH:
        follower->indices = call->resource;
        return bind_vertices(follower, call->resource, error);
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
    return type == CALL_VIEWPORT || type == CALL_SCISSOR || type == CALL_CLEAR || type == CALL_DRAW ||
           type == CALL_DRAW_INDEXED || type == CALL_DRAW_MESH;
}

static int follow_all(struct follower *follower)
{
    const struct stream *stream = follower->stream;
    uint32_t frame = 0;
    for (uint32_t i = 0; i < stream->executed_count; i++) {
        for (; frame < stream->frame_count && stream->frames[frame + 1] <= i; frame++)
            if (check_queries_ended(follower))
                return -1;
        const struct call *call = &stream->calls[stream->executed[i]];
        struct error reason = {{0}};
        if (needs_target(call->type) && !follower->width)
            return fail_at(follower->parser, call, "found no target, expected target WIDTH HEIGHT before it");
        if (follow(follower, call, &reason))
            return fail_at(follower->parser, call, reason.text);
    }
    return check_queries_ended(follower);
}

int stream_check(struct parser *parser)
{
    const struct stream *stream = parser->stream;
    struct follower follower = {.parser = parser, .stream = stream, .indices = NO_RESOURCE};
    follower.stand_ins = calloc(stream->resource_count + 1, sizeof *follower.stand_ins);
    follower.begun = calloc(stream->resource_count + 1, sizeof *follower.begun);
    struct shader_registers *registers = calloc(SHADER_STAGES, sizeof *registers);
    int result = -1;
    if (follower.stand_ins && follower.begun && registers) {
        state_initialize(&follower.state);
        for (int stage = 0; stage < SHADER_STAGES; stage++)
            follower.state.registers[stage] = &registers[stage];
        result = follow_all(&follower);
    } else {
        lex_fail(&parser->lex, &parser->lex.token, "not enough memory");
    }
    free(follower.stand_ins);
    free(follower.begun);
    free(registers);
    return result;
}
