/* Follows the executed calls of a stream with the device's own state (render/state/state.h), so that one
 * module decides which values a state, a light or a viewport may have. A reason begins with the position of
 * the call that cannot be executed, also if a sequence plays it. */
#include "capture/layout.h"
#include "command/stream/follow_part.h"
#include "command/stream/functions.h"
#include "command/stream/expand.h"

#include <stdlib.h>
#include <string.h>

/* --- States --------------------------------------------------------------------------------------------- */

void follower_draw_to(struct follower *follower, const struct triptych_target_description *target)
{
    follower->drawn = *target;
    follower->width = target->width;
    follower->height = target->height;
    state_set_target(&follower->state, target);
}

int follow_target(struct follower *follower, const struct call *call, struct error *error)
{
    (void)error;
    follower->target = call->target;
    memset(follower->attached, 0xff, sizeof follower->attached);
    follower_draw_to(follower, &call->target);
    return 0;
}

int follow_viewport(struct follower *follower, const struct call *call, struct error *error)
{
    return state_set_viewport(&follower->state, &call->viewport, error) ? -1 : 0;
}

int follow_scissor(struct follower *follower, const struct call *call, struct error *error)
{
    const struct scissor scissor = {call->scissor.x, call->scissor.y, call->scissor.width,
                                    call->scissor.height};
    (void)error;
    state_set_scissor(&follower->state, scissor);
    return 0;
}

int follow_set(struct follower *follower, const struct call *call, struct error *error)
{
    return state_set_value(&follower->state, call->set.table, call->set.i, call->set.row, call->set.value,
                           error)
               ? -1
               : 0;
}

int follow_convention(struct follower *follower, const struct call *call, struct error *error)
{
    return state_set_convention(&follower->state, call->convention.which, call->convention.value, error) ? -1
                                                                                                         : 0;
}

int follow_clip_plane(struct follower *follower, const struct call *call, struct error *error)
{
    return state_set_clip_plane(&follower->state, call->clip_plane.index, call->clip_plane.plane, error) ? -1
                                                                                                         : 0;
}

int follow_transform(struct follower *follower, const struct call *call, struct error *error)
{
    return state_set_transform(&follower->state, call->transform.which, call->transform.matrix, error) ? -1
                                                                                                       : 0;
}

int follow_material(struct follower *follower, const struct call *call, struct error *error)
{
    return state_set_material(&follower->state, &call->material, error) ? -1 : 0;
}

int follow_light(struct follower *follower, const struct call *call, struct error *error)
{
    return state_set_light(&follower->state, call->light.index, &call->light.value, error) ? -1 : 0;
}

int follow_bind_texture(struct follower *follower, const struct call *call, struct error *error)
{
    (void)error;
    follower->texture[call->bind_texture.sampler] = call->resource;
    return 0;
}

int follow_clip_mask(struct follower *follower, const struct call *call, struct error *error)
{
    (void)error;
    follower->clip_mask = call->resource;
    return 0;
}

int follow_shader(struct follower *follower, const struct call *call, struct error *error)
{
    (void)error;
    follower->state.program[call->shader.stage] =
        call->resource == NO_RESOURCE ? NULL : follower->stream->resources[call->resource].program;
    follower->shader[call->shader.stage] = call->resource;
    follower->integers_checked = false;
    return 0;
}

/* Floats can have any value. */
int follow_constants(struct follower *follower, const struct call *call, struct error *error)
{
    struct shader_registers *registers = follower->state.registers[call->constants.stage];
    (void)error;
    if (call->constants.type != CONSTANTS_INTEGER)
        return 0;
    memcpy(registers->integers[call->constants.first], call->constants.integers,
           call->constants.count * sizeof *registers->integers);
    follower->integers_checked = false;
    return 0;
}

int follow_constant_matrix(struct follower *follower, const struct call *call, struct error *error)
{
    float constants[CONSTANTS_PER_CALL][4];
    if (stream_constants(call, (const float(*)[4][4])follower->state.transform, constants))
        return error_set(error, "found constants that are not finite, expected transforms%s",
                         call->constant_matrix.inverse ? " with an inverse" : " with finite values");
    return 0;
}

/* Checks the size of a buffer. */
static int check_bytes(const struct follower *follower, uint32_t source, size_t expected, struct error *error)
{
    const struct resource *resource = &follower->stream->resources[source];
    size_t bytes;
    resource_data(resource, &bytes);
    return bytes == expected
               ? 0
               : error_set(error, "found %zu bytes in %s, expected %zu", bytes, resource->name, expected);
}

int follow_texels(struct follower *follower, const struct call *call, struct error *error)
{
    size_t expected = resource_texels(&follower->stream->resources[call->resource]);
    return check_bytes(follower, call->texels.source, expected, error);
}

int follow_contents(struct follower *follower, const struct call *call, struct error *error)
{
    return check_bytes(follower, call->resource, target_contents_bytes(&follower->drawn), error);
}

int follow_clear(struct follower *follower, const struct call *call, struct error *error)
{
    const struct call_clear *clear = call_clear_values(call);
    struct triptych_clear_values values = {.flags = clear->flags, .depth = clear->depth};
    memcpy(values.color, clear->color, sizeof values.color);
    return state_check_clear(follower->state.depth_format, &values, error) ? -1 : 0;
}

/* --- Calls ---------------------------------------------------------------------------------------------- */

static int check_released(struct follower *follower, const struct call *call, struct error *error)
{
    struct call copy = *call;
    for (const struct call_field *f = call_row(call->type)->fields; (f = call_next_resource(f)); f++) {
        uint32_t number = *call_resource(&copy, f);
        if (number < follower->resource_count && follower->resources[number].released)
            return error_set(error, "found '%s', which was released, expected another",
                             follower->stream->resources[number].name);
    }
    return 0;
}

int follower_call(struct follower *follower, const struct call *call, struct error *error)
{
    struct error reason = {{0}};
    if (call_row(call->type)->traits & CALL_NEEDS_TARGET && !follower->width)
        return stream_fail(follower->stream, call, "found no target, expected target WIDTH HEIGHT before it",
                           error);
    if (check_released(follower, call, &reason) ||
        (calls_functions[call->type].follow && calls_functions[call->type].follow(follower, call, &reason)))
        return stream_fail(follower->stream, call, reason.text, error);
    return 0;
}

struct follower *follower_create(const struct stream *stream)
{
    struct follower *follower = calloc(1, sizeof *follower);
    if (!follower)
        return NULL;
    follower->stream = stream;
    follower->indices = follower->clip_mask = NO_RESOURCE;
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
        follower_free_buffer(&follower->resources[i]);
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

int follower_check(const struct stream *stream, struct error *error)
{
    struct follower *follower = follower_create(stream);
    int result =
        follower ? follow_all(follower, error) : error_set(error, "%s: not enough memory", stream->path);
    follower_free(follower);
    return result;
}
