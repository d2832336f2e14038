/* The binary form of the calls that a list of fields cannot describe, because fields depend on others. Each
 * function codes both directions. */
#include "capture/call.h"
#include "capture/codec.h"

/* States are coded by Direct3D 9's numbers, so that new rows of the tables do not change the form. */
static void code_set(struct codec *codec, struct call *call)
{
    const struct triptych_state_row *state;
    uint32_t number = 0, row = 0;
    call->set.table = codec_u8(codec, call->set.table, TRIPTYCH_STATE_TABLE_COUNT - 1, "table of states");
    call->set.i = codec_u8(codec, call->set.i, triptych_table_size(call->set.table) - 1,
                           triptych_table_name(call->set.table));
    if (!codec->reading)
        number = triptych_state_at(call->set.table, call->set.row)->number;
    number = codec_u16(codec, number, UINT16_MAX, "state");
    call->set.value = codec_u32(codec, call->set.value, UINT32_MAX, "value");
    if (!codec->reading)
        return;
    while ((state = triptych_state_at(call->set.table, row)) && state->number != number)
        row++;
    call->set.row = state ? row : 0;
    if (!state)
        codec_fail(codec, "found %s state %u, expected one of Direct3D 9's",
                   triptych_table_name(call->set.table), number);
}

/* Fields that the type of light does not use are not coded. They are read as the default's. */
static void code_light(struct codec *codec, struct call *call)
{
    struct triptych_light *light = &call->light.value;
    call->light.index = codec_u8(codec, call->light.index, TRIPTYCH_LIGHTS - 1, "light");
    if (codec->reading)
        *light = call_default_light;
    light->type = codec_u8(codec, light->type, TRIPTYCH_LIGHT_SPOT, "type of light");
    codec_floats(codec, light->diffuse, 4);
    codec_floats(codec, light->ambient, 4);
    codec_floats(codec, light->specular, 4);
    if (light->type != TRIPTYCH_LIGHT_POINT)
        codec_floats(codec, light->direction, 3);
    if (light->type == TRIPTYCH_LIGHT_DIRECTIONAL)
        return;
    codec_floats(codec, light->position, 3);
    codec_floats(codec, &light->range, 1);
    codec_floats(codec, light->attenuation, 3);
    if (light->type == TRIPTYCH_LIGHT_POINT)
        return;
    codec_floats(codec, &light->theta, 1);
    codec_floats(codec, &light->phi, 1);
    codec_floats(codec, &light->falloff, 1);
}

static void code_element(struct codec *codec, struct call *call)
{
    call->element.attribute =
        codec_u8(codec, call->element.attribute, TRIPTYCH_ATTRIBUTE_COUNT - 1, "attribute");
    call->element.format = codec_u8(codec, call->element.format, TRIPTYCH_FORMAT_COUNT - 1, "vertex format");
    if (call->element.format == TRIPTYCH_FORMAT_NONE) {
        call->resource = NO_RESOURCE;
        return;
    }
    codec_resource(codec, &call->resource);
    call->element.offset = codec_u32(codec, call->element.offset, INT32_MAX, "offset");
    call->element.stride = codec_u32(codec, call->element.stride, 65536, "stride");
    if (codec->reading && call->resource == NO_RESOURCE)
        codec_fail(codec, "found an element in no resource, expected one");
}

static void code_bind_stream(struct codec *codec, struct call *call)
{
    call->bind_stream.number = codec_u8(codec, call->bind_stream.number, TRIPTYCH_STREAMS - 1, "stream");
    codec_resource(codec, &call->resource);
    if (call->resource == NO_RESOURCE)
        return;
    call->bind_stream.offset = codec_u32(codec, call->bind_stream.offset, INT32_MAX, "offset");
    call->bind_stream.stride = codec_u32(codec, call->bind_stream.stride, 65536, "stride");
}

static void code_declare(struct codec *codec, struct call *call)
{
    call->declare.count =
        codec_u8(codec, call->declare.count, TRIPTYCH_DECLARATION_ELEMENTS, "count of elements");
    for (uint32_t i = 0; i < call->declare.count; i++) {
        struct call_declared *e = &call->declare.element[i];
        e->usage = (uint8_t)codec_u8(codec, e->usage, TRIPTYCH_USAGE_COUNT - 1, "usage");
        e->usage_index = (uint8_t)codec_u8(codec, e->usage_index, TRIPTYCH_USAGE_INDICES - 1, "usage index");
        e->format = (uint8_t)codec_u8(codec, e->format, TRIPTYCH_FORMAT_COUNT - 1, "vertex format");
        e->stream = (uint8_t)codec_u8(codec, e->stream, TRIPTYCH_STREAMS - 1, "stream");
        if (call->type == CALL_DECLARE)
            e->offset = (uint16_t)(4 * codec_u16(codec, e->offset / 4, UINT16_MAX / 4, "offset in words"));
        else
            e->offset = (uint16_t)codec_u16(codec, e->offset, UINT16_MAX, "offset");
    }
}

static void code_integer_constants(struct codec *codec, struct call *call)
{
    call->constants.first = codec_u16(codec, call->constants.first, TRIPTYCH_SHADER_INTEGERS - 1, "constant");
    codec_integers(codec, call->constants.integers[0], 4);
    call->constants.count = 1;
}

static void code_boolean_constants(struct codec *codec, struct call *call)
{
    call->constants.first = codec_u8(codec, call->constants.first, TRIPTYCH_SHADER_BOOLEANS - 1, "constant");
    call->constants.count = codec_u8(codec, call->constants.count,
                                     TRIPTYCH_SHADER_BOOLEANS - call->constants.first, "count of constants");
    for (uint32_t i = 0; i < call->constants.count; i++)
        call->constants.booleans[i] = codec_u8(codec, call->constants.booleans[i], 1, "Boolean");
}

static void code_float_constants(struct codec *codec, struct call *call)
{
    call->constants.first = codec_u16(codec, call->constants.first, TRIPTYCH_SHADER_FLOATS - 1, "constant");
    uint32_t room = TRIPTYCH_SHADER_FLOATS - call->constants.first;
    call->constants.count =
        codec_u8(codec, call->constants.count, room < CONSTANTS_PER_CALL ? room : CONSTANTS_PER_CALL,
                 "count of constants");
    codec_floats(codec, call->constants.floats[0], 4 * (size_t)call->constants.count);
}

static void code_constants(struct codec *codec, struct call *call)
{
    call->constants.stage =
        codec_u8(codec, call->constants.stage, TRIPTYCH_SHADER_STAGE_COUNT - 1, "shader stage");
    call->constants.type = codec_u8(codec, call->constants.type, CONSTANTS_BOOLEAN, "type of constants");
    if (call->constants.type == CONSTANTS_INTEGER)
        code_integer_constants(codec, call);
    else if (call->constants.type == CONSTANTS_BOOLEAN)
        code_boolean_constants(codec, call);
    else
        code_float_constants(codec, call);
    if (codec->reading && !call->constants.count)
        codec_fail(codec, "found no constants, expected at least one");
}

static void code_constant_matrix(struct codec *codec, struct call *call)
{
    call->constant_matrix.stage =
        codec_u8(codec, call->constant_matrix.stage, TRIPTYCH_SHADER_STAGE_COUNT - 1, "shader stage");
    call->constant_matrix.first =
        codec_u16(codec, call->constant_matrix.first, TRIPTYCH_SHADER_FLOATS - 1, "constant");
    uint32_t room = TRIPTYCH_SHADER_FLOATS - call->constant_matrix.first;
    call->constant_matrix.count =
        codec_u8(codec, call->constant_matrix.count, room < CONSTANTS_PER_CALL ? room : CONSTANTS_PER_CALL,
                 "count of constants");
    call->constant_matrix.factors =
        codec_u8(codec, call->constant_matrix.factors, MATRICES_PER_CALL, "count of transforms");
    for (uint32_t i = 0; i < call->constant_matrix.factors; i++)
        call->constant_matrix.factor[i] =
            codec_u16(codec, call->constant_matrix.factor[i], TRIPTYCH_TRANSFORM_COUNT - 1, "transform");
    call->constant_matrix.inverse = codec_u8(codec, call->constant_matrix.inverse, 1, "inverse");
    call->constant_matrix.transposed = codec_u8(codec, call->constant_matrix.transposed, 1, "transposed");
    if (codec->reading && (!call->constant_matrix.count || !call->constant_matrix.factors))
        codec_fail(codec, "found constants of no transform, expected at least one of one");
}

static void code_values(struct codec *codec, struct call_clear *clear)
{
    clear->flags = codec_u8(codec, clear->flags, 7, "what is cleared");
    if (clear->flags & TRIPTYCH_CLEAR_COLOR)
        codec_floats(codec, clear->color, 4);
    if (clear->flags & TRIPTYCH_CLEAR_DEPTH)
        codec_floats(codec, &clear->depth, 1);
    if (clear->flags & TRIPTYCH_CLEAR_STENCIL)
        clear->stencil = codec_u8(codec, clear->stencil, 255, "stencil");
    if (codec->reading && !clear->flags)
        codec_fail(codec, "found a clear of nothing, expected color, depth or stencil");
}

static void code_clear(struct codec *codec, struct call *call)
{
    code_values(codec, &call->clear);
}

static void code_clear_parts(struct codec *codec, struct call *call)
{
    struct call_clear_parts *parts = &call->clear_parts;
    code_values(codec, &parts->clear);
    parts->color_mask = codec_u8(codec, parts->color_mask, 15, "colour mask");
    parts->stencil_mask = codec_u8(codec, parts->stencil_mask, 255, "stencil mask");
    parts->everywhere = codec_u8(codec, parts->everywhere, 1, "everywhere");
    parts->count = codec_u8(codec, parts->count, PARTS_PER_CALL, "count of rectangles");
    for (uint32_t i = 0; i < parts->count; i++) {
        uint16_t *side[4] = {&parts->part[i].x, &parts->part[i].y, &parts->part[i].width,
                             &parts->part[i].height};
        for (int k = 0; k < 4; k++)
            *side[k] = (uint16_t)codec_u16(codec, *side[k], TRIPTYCH_TARGET_MAXIMUM, "rectangle");
    }
}

static void code_bind_indices(struct codec *codec, struct call *call)
{
    uint32_t bits;
    call_code_fields(codec, call);
    bits = call->bind_indices.bits;
    if (codec->reading && bits != 0 && bits != 8 && bits != 16 && bits != 32)
        codec_fail(codec, "found indices of %u bits, expected 8, 16 or 32", bits);
}

static void code_draw_indexed_user(struct codec *codec, struct call *call)
{
    call_code_fields(codec, call);
    uint32_t bits = call->draw_indexed_user.bits;
    if (codec->reading && bits != 8 && bits != 16 && bits != 32)
        codec_fail(codec, "found indices of %u bits, expected 8, 16 or 32", bits);
}

void call_code(struct codec *codec, struct call *call)
{
    static void (*const special[CALL_TYPES])(struct codec *, struct call *) = {
        [CALL_SET] = code_set,
        [CALL_LIGHT] = code_light,
        [CALL_BIND_INDICES] = code_bind_indices,
        [CALL_BIND_ELEMENT] = code_element,
        [CALL_BIND_STREAM] = code_bind_stream,
        [CALL_DECLARE] = code_declare,
        [CALL_DECLARE_BYTES] = code_declare,
        [CALL_CONSTANTS] = code_constants,
        [CALL_CONSTANT_MATRIX] = code_constant_matrix,
        [CALL_CLEAR] = code_clear,
        [CALL_DRAW_INDEXED_USER] = code_draw_indexed_user,
        [CALL_CLEAR_PARTS] = code_clear_parts,
    };
    if (codec->reading)
        *call = (struct call){.type = call->type, .resource = NO_RESOURCE, .position = call->position};
    if (special[call->type])
        special[call->type](codec, call);
    else
        call_code_fields(codec, call);
}
