/* Calls as records: which fields each type has, in which order and in how many bytes. Said once for both directions. */
#include "container/call.h"
#include "container/codec.h"

#include <string.h>

const struct triptych_material stream_default_material = {.diffuse = {1, 1, 1, 1}};
const struct triptych_light stream_default_light = {
    .theta = 0.5f,
    .phi = 1,
    .falloff = 1,
    .type = TRIPTYCH_LIGHT_DIRECTIONAL,
    .diffuse = {1, 1, 1, 1},
    .direction = {0, 0, 1},
    .range = 0x1.fffffep+63f, /* the square root of FLT_MAX, rounded down */
    .attenuation = {1, 0, 0},
};

const char *call_word(unsigned type)
{
    static const char *const word[] = {
#define CALL(name, number, word) [number] = word,
#include "container/call.def"
#undef CALL
    };
    return type < sizeof word / sizeof *word ? word[type] : NULL;
}

/* --- Resources --------------------------------------------------------------------------------------------
 */

enum {
    TEXTURES = 1 << RESOURCE_TEXTURE,
    BUFFERS = 1 << RESOURCE_BUFFER,
    MESHES = 1 << RESOURCE_MESH,
    DRAWABLES = 1 << RESOURCE_VERTICES | MESHES,
    INDICES = 1 << RESOURCE_INDICES | BUFFERS | MESHES,
    ELEMENTS = 1 << RESOURCE_VERTICES | BUFFERS | MESHES,
    HELD = TEXTURES | DRAWABLES | INDICES | ELEMENTS | 1 << RESOURCE_SHADER | 1 << RESOURCE_QUERY
};

/* What the call's own number may name; 0: nothing. */
static unsigned own_types(enum call_type type, bool *optional)
{
    *optional = type == CALL_BIND_TEXTURE || type == CALL_BIND_INDICES || type == CALL_BIND_ELEMENT ||
                type == CALL_BIND_STREAM || type == CALL_SHADER;
    switch (type) {
    case CALL_BIND_TEXTURE:
    case CALL_UPDATE:
    case CALL_MIPS:
    case CALL_TEXELS: return TEXTURES;
    case CALL_BIND_VERTICES: return DRAWABLES;
    case CALL_BIND_INDICES: return INDICES;
    case CALL_BIND_ELEMENT:
    case CALL_BIND_STREAM: return ELEMENTS;
    case CALL_SHADER: return 1 << RESOURCE_SHADER;
    case CALL_CONTENTS: return BUFFERS;
    case CALL_DRAW_MESH: return MESHES;
    case CALL_BEGIN_QUERY:
    case CALL_END_QUERY: return 1 << RESOURCE_QUERY;
    case CALL_RELEASE: return HELD;
    case CALL_PLAY:
    case CALL_SEQUENCE: return 1 << RESOURCE_SEQUENCE;
    default: return 0;
    }
}

static unsigned surfaces(struct call *call, struct call_resource *resources)
{
    unsigned count = 0;
    if (call->type == CALL_ATTACH)
        for (int t = 0; t < TRIPTYCH_TARGETS; t++)
            resources[count++] = (struct call_resource){&call->attach.color[t].resource, TEXTURES, true};
    if (call->type == CALL_ATTACH)
        resources[count++] = (struct call_resource){&call->attach.depth.resource, TEXTURES, true};
    for (int i = 0; i < 2 && call->type == CALL_COPY; i++)
        resources[count++] = (struct call_resource){&call->copy.surface[i].resource, TEXTURES, true};
    return count;
}

unsigned call_resources(struct call *call, struct call_resource resources[CALL_RESOURCES])
{
    bool optional;
    unsigned types = own_types(call->type, &optional), count = surfaces(call, resources);
    if (types)
        resources[count++] = (struct call_resource){&call->resource, types, optional};
    if (call->type == CALL_UPDATE)
        resources[count++] = (struct call_resource){&call->update.source, BUFFERS, false};
    if (call->type == CALL_TEXELS)
        resources[count++] = (struct call_resource){&call->texels.source, BUFFERS, false};
    return count;
}

/* --- Fields -----------------------------------------------------------------------------------------------
 */

static void code_resource(struct codec *codec, uint32_t *number)
{
    *number = code_u32(codec, *number, NO_RESOURCE, "resource");
}

static void code_target(struct codec *codec, struct triptych_target_description *target)
{
    target->width = code_u16(codec, target->width, TRIPTYCH_TARGET_MAXIMUM, "target width");
    target->height = code_u16(codec, target->height, TRIPTYCH_TARGET_MAXIMUM, "target height");
    target->depth_format = code_u8(codec, target->depth_format, TRIPTYCH_DEPTH_COUNT - 1, "depth format");
    target->samples = code_u8(codec, target->samples, 8, "samples per pixel");
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        target->color_format[t] = code_u32(codec, target->color_format[t], UINT32_MAX, "format");
}

static void code_viewport(struct codec *codec, struct triptych_viewport *viewport)
{
    float *const v[] = {&viewport->x,      &viewport->y,          &viewport->width,
                        &viewport->height, &viewport->depth_near, &viewport->depth_far};
    for (int i = 0; i < 6; i++)
        code_floats(codec, v[i], 1);
}

static void code_scissor(struct codec *codec, struct call *call)
{
    call->scissor.x = code_u16(codec, call->scissor.x, TRIPTYCH_TARGET_MAXIMUM, "scissor x");
    call->scissor.y = code_u16(codec, call->scissor.y, TRIPTYCH_TARGET_MAXIMUM, "scissor y");
    call->scissor.width = code_u16(codec, call->scissor.width, TRIPTYCH_TARGET_MAXIMUM, "scissor width");
    call->scissor.height = code_u16(codec, call->scissor.height, TRIPTYCH_TARGET_MAXIMUM, "scissor height");
}

/* Direct3D 9's number of a state, so that new rows of the tables change nothing. */
static void code_set(struct codec *codec, struct call *call)
{
    const struct triptych_state_row *state;
    uint32_t number = 0, row = 0;
    call->set.table = code_u8(codec, call->set.table, TRIPTYCH_STATE_TABLE_COUNT - 1, "table of states");
    call->set.i = code_u8(codec, call->set.i, triptych_table_size(call->set.table) - 1,
                          triptych_table_name(call->set.table));
    if (!codec->reading)
        number = triptych_state_at(call->set.table, call->set.row)->number;
    number = code_u16(codec, number, UINT16_MAX, "state");
    call->set.value = code_u32(codec, call->set.value, UINT32_MAX, "value");
    if (!codec->reading)
        return;
    while ((state = triptych_state_at(call->set.table, row)) && state->number != number)
        row++;
    call->set.row = state ? row : 0;
    if (!state)
        codec_fail(codec, "found %s state %u, expected one of Direct3D 9's",
                   triptych_table_name(call->set.table), number);
}

static void code_material(struct codec *codec, struct triptych_material *material)
{
    code_floats(codec, material->diffuse, 4);
    code_floats(codec, material->ambient, 4);
    code_floats(codec, material->emissive, 4);
    code_floats(codec, material->specular, 4);
    code_floats(codec, &material->power, 1);
}

/* What a type of lights does not have is not coded: it is the default's when it is read. */
static void code_light(struct codec *codec, struct triptych_light *light)
{
    if (codec->reading)
        *light = stream_default_light;
    light->type = code_u8(codec, light->type, TRIPTYCH_LIGHT_SPOT, "type of light");
    code_floats(codec, light->diffuse, 4);
    code_floats(codec, light->ambient, 4);
    code_floats(codec, light->specular, 4);
    if (light->type != TRIPTYCH_LIGHT_POINT)
        code_floats(codec, light->direction, 3);
    if (light->type == TRIPTYCH_LIGHT_DIRECTIONAL)
        return;
    code_floats(codec, light->position, 3);
    code_floats(codec, &light->range, 1);
    code_floats(codec, light->attenuation, 3);
    if (light->type == TRIPTYCH_LIGHT_POINT)
        return;
    code_floats(codec, &light->theta, 1);
    code_floats(codec, &light->phi, 1);
    code_floats(codec, &light->falloff, 1);
}

static void code_element(struct codec *codec, struct call *call)
{
    call->element.attribute =
        code_u8(codec, call->element.attribute, TRIPTYCH_ATTRIBUTE_COUNT - 1, "attribute");
    call->element.format = code_u8(codec, call->element.format, TRIPTYCH_FORMAT_COUNT - 1, "vertex format");
    if (call->element.format == TRIPTYCH_FORMAT_NONE) {
        call->resource = NO_RESOURCE;
        return;
    }
    code_resource(codec, &call->resource);
    call->element.offset = code_u32(codec, call->element.offset, INT32_MAX, "offset");
    call->element.stride = code_u32(codec, call->element.stride, 65536, "stride");
    if (codec->reading && call->resource == NO_RESOURCE)
        codec_fail(codec, "found an element in no resource, expected one");
}

static void code_bind_stream(struct codec *codec, struct call *call)
{
    call->bind_stream.number = code_u8(codec, call->bind_stream.number, TRIPTYCH_STREAMS - 1, "stream");
    code_resource(codec, &call->resource);
    if (call->resource == NO_RESOURCE)
        return;
    call->bind_stream.offset = code_u32(codec, call->bind_stream.offset, INT32_MAX, "offset");
    call->bind_stream.stride = code_u32(codec, call->bind_stream.stride, 65536, "stride");
}

static void code_declare(struct codec *codec, struct call *call)
{
    call->declare.count =
        code_u8(codec, call->declare.count, TRIPTYCH_DECLARATION_ELEMENTS, "count of elements");
    for (uint32_t i = 0; i < call->declare.count; i++) {
        struct declared *e = &call->declare.element[i];
        e->usage = code_u8(codec, e->usage, TRIPTYCH_USAGE_COUNT - 1, "usage");
        e->usage_index = code_u8(codec, e->usage_index, TRIPTYCH_USAGE_INDICES - 1, "usage index");
        e->format = code_u8(codec, e->format, TRIPTYCH_FORMAT_COUNT - 1, "vertex format");
        e->stream = code_u8(codec, e->stream, TRIPTYCH_STREAMS - 1, "stream");
        e->words = code_u16(codec, e->words, 65532 / 4, "offset in words");
    }
}

static void code_integer_constants(struct codec *codec, struct call *call)
{
    call->constants.first = code_u16(codec, call->constants.first, TRIPTYCH_SHADER_INTEGERS - 1, "constant");
    code_integers(codec, call->constants.integers[0], 4);
    call->constants.count = 1;
}

static void code_boolean_constants(struct codec *codec, struct call *call)
{
    call->constants.first = code_u8(codec, call->constants.first, TRIPTYCH_SHADER_BOOLEANS - 1, "constant");
    call->constants.count = code_u8(codec, call->constants.count,
                                    TRIPTYCH_SHADER_BOOLEANS - call->constants.first, "count of constants");
    for (uint32_t i = 0; i < call->constants.count; i++)
        call->constants.booleans[i] = code_u8(codec, call->constants.booleans[i], 1, "Boolean");
}

static void code_float_constants(struct codec *codec, struct call *call)
{
    call->constants.first = code_u16(codec, call->constants.first, TRIPTYCH_SHADER_FLOATS - 1, "constant");
    uint32_t room = TRIPTYCH_SHADER_FLOATS - call->constants.first;
    call->constants.count =
        code_u8(codec, call->constants.count, room < CONSTANTS_PER_CALL ? room : CONSTANTS_PER_CALL,
                "count of constants");
    code_floats(codec, call->constants.floats[0], 4 * (size_t)call->constants.count);
}

static void code_constants(struct codec *codec, struct call *call)
{
    call->constants.stage =
        code_u8(codec, call->constants.stage, TRIPTYCH_SHADER_STAGE_COUNT - 1, "shader stage");
    call->constants.type = code_u8(codec, call->constants.type, CONSTANTS_BOOLEAN, "type of constants");
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
        code_u8(codec, call->constant_matrix.stage, TRIPTYCH_SHADER_STAGE_COUNT - 1, "shader stage");
    call->constant_matrix.first =
        code_u16(codec, call->constant_matrix.first, TRIPTYCH_SHADER_FLOATS - 1, "constant");
    uint32_t room = TRIPTYCH_SHADER_FLOATS - call->constant_matrix.first;
    call->constant_matrix.count =
        code_u8(codec, call->constant_matrix.count, room < CONSTANTS_PER_CALL ? room : CONSTANTS_PER_CALL,
                "count of constants");
    call->constant_matrix.factors =
        code_u8(codec, call->constant_matrix.factors, MATRICES_PER_CALL, "count of transforms");
    for (uint32_t i = 0; i < call->constant_matrix.factors; i++)
        call->constant_matrix.factor[i] =
            code_u16(codec, call->constant_matrix.factor[i], TRIPTYCH_TRANSFORM_COUNT - 1, "transform");
    call->constant_matrix.inverse = code_u8(codec, call->constant_matrix.inverse, 1, "inverse");
    call->constant_matrix.transposed = code_u8(codec, call->constant_matrix.transposed, 1, "transposed");
    if (codec->reading && (!call->constant_matrix.count || !call->constant_matrix.factors))
        codec_fail(codec, "found constants of no transform, expected at least one of one");
}

static void code_update(struct codec *codec, struct call *call)
{
    struct triptych_box *box = &call->update.box;
    unsigned *const fields[] = {&box->x, &box->y, &box->z, &box->width, &box->height, &box->depth};
    code_resource(codec, &call->resource);
    call->update.face = code_u8(codec, call->update.face, 5, "face");
    call->update.level = code_u8(codec, call->update.level, 31, "level");
    for (int i = 0; i < 6; i++)
        *fields[i] = code_u16(codec, *fields[i], TRIPTYCH_TEXTURE_MAXIMUM, "box");
    code_resource(codec, &call->update.source);
}

static void code_surface(struct codec *codec, struct stream_surface *surface)
{
    code_resource(codec, &surface->resource);
    surface->level = code_u8(codec, surface->level, 31, "level");
    surface->slice = code_u16(codec, surface->slice, TRIPTYCH_TEXTURE_MAXIMUM, "slice");
}

static void code_attach(struct codec *codec, struct call *call)
{
    call->attach.some = code_u8(codec, call->attach.some, 1, "attach");
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        code_surface(codec, &call->attach.color[t]);
    code_surface(codec, &call->attach.depth);
    call->attach.depth_format =
        code_u8(codec, call->attach.depth_format, TRIPTYCH_DEPTH_COUNT - 1, "depth format");
}

static void code_copy(struct codec *codec, struct call *call)
{
    for (int i = 0; i < 2; i++) {
        struct triptych_rectangle *part = &call->copy.part[i];
        unsigned *const fields[] = {&part->x, &part->y, &part->width, &part->height};
        code_surface(codec, &call->copy.surface[i]);
        for (int f = 0; f < 4; f++)
            *fields[f] = code_u16(codec, *fields[f], TRIPTYCH_TARGET_MAXIMUM, "part");
    }
    call->copy.filter = code_u8(codec, call->copy.filter, TRIPTYCH_COPY_COUNT - 1, "filter");
}

static void code_clear(struct codec *codec, struct call *call)
{
    call->clear.flags = code_u8(codec, call->clear.flags, 7, "what is cleared");
    if (call->clear.flags & TRIPTYCH_CLEAR_COLOR)
        code_floats(codec, call->clear.color, 4);
    if (call->clear.flags & TRIPTYCH_CLEAR_DEPTH)
        code_floats(codec, &call->clear.depth, 1);
    if (call->clear.flags & TRIPTYCH_CLEAR_STENCIL)
        call->clear.stencil = code_u8(codec, call->clear.stencil, 255, "stencil");
    if (codec->reading && !call->clear.flags)
        codec_fail(codec, "found a clear of nothing, expected color, depth or stencil");
}

static void code_draw(struct codec *codec, struct call *call)
{
    call->draw.primitive = code_u8(codec, call->draw.primitive, TRIPTYCH_PRIMITIVE_COUNT - 1, "primitive");
    if (call->type == CALL_DRAW_INDEXED)
        code_integers(codec, &call->draw.base, 1);
    call->draw.first = code_u32(codec, call->draw.first, UINT32_MAX, "first");
    call->draw.count = code_u32(codec, call->draw.count, UINT32_MAX, "count of primitives");
}

static void code_convention(struct codec *codec, struct call *call)
{
    call->convention.which =
        code_u8(codec, call->convention.which, TRIPTYCH_CONVENTION_COUNT - 1, "convention");
    call->convention.value = code_u8(codec, call->convention.value, 1, "convention's value");
}

static void code_bind_indices(struct codec *codec, struct call *call)
{
    code_resource(codec, &call->resource);
    call->index_bits = code_u8(codec, call->index_bits, 32, "bits of indices");
    if (codec->reading && call->index_bits != 0 && call->index_bits != 16 && call->index_bits != 32)
        codec_fail(codec, "found indices of %u bits, expected 16 or 32", call->index_bits);
}

void call_code(struct codec *codec, struct call *call)
{
    if (codec->reading) {
        enum call_type type = call->type;
        *call =
            (struct call){.type = type, .line = call->line, .column = call->column, .resource = NO_RESOURCE};
    }
    switch (call->type) {
    case CALL_TARGET: code_target(codec, &call->target); break;
    case CALL_VIEWPORT: code_viewport(codec, &call->viewport); break;
    case CALL_SCISSOR: code_scissor(codec, call); break;
    case CALL_SET: code_set(codec, call); break;
    case CALL_CONVENTION: code_convention(codec, call); break;
    case CALL_CLIP_PLANE:
        call->clip_plane.index =
            code_u8(codec, call->clip_plane.index, TRIPTYCH_CLIP_PLANES - 1, "clip plane");
        code_floats(codec, call->clip_plane.plane, 4);
        break;
    case CALL_TRANSFORM:
        call->transform.which =
            code_u16(codec, call->transform.which, TRIPTYCH_TRANSFORM_COUNT - 1, "transform");
        code_floats(codec, call->transform.matrix[0], 16);
        break;
    case CALL_MATERIAL: code_material(codec, &call->material); break;
    case CALL_LIGHT:
        call->light.index = code_u8(codec, call->light.index, TRIPTYCH_LIGHTS - 1, "light");
        code_light(codec, &call->light.value);
        break;
    case CALL_ENABLE_LIGHT:
        call->light.index = code_u8(codec, call->light.index, TRIPTYCH_LIGHTS - 1, "light");
        call->light.on = code_u8(codec, call->light.on, 1, "on");
        break;
    case CALL_BIND_TEXTURE:
        call->sampler = code_u8(codec, call->sampler, TRIPTYCH_SAMPLERS - 1, "sampler");
        code_resource(codec, &call->resource);
        break;
    case CALL_BIND_INDICES: code_bind_indices(codec, call); break;
    case CALL_BIND_ELEMENT: code_element(codec, call); break;
    case CALL_BIND_STREAM: code_bind_stream(codec, call); break;
    case CALL_DECLARE: code_declare(codec, call); break;
    case CALL_FVF: call->fvf = code_u32(codec, call->fvf, UINT32_MAX, "vertex format"); break;
    case CALL_FREQUENCY:
        call->frequency.stream = code_u8(codec, call->frequency.stream, TRIPTYCH_STREAMS - 1, "stream");
        call->frequency.frequency =
            code_u8(codec, call->frequency.frequency, TRIPTYCH_FREQUENCY_COUNT - 1, "frequency");
        call->frequency.count = code_u32(codec, call->frequency.count, UINT32_MAX, "count");
        break;
    case CALL_SHADER:
        call->shader = code_u8(codec, call->shader, TRIPTYCH_SHADER_STAGE_COUNT - 1, "shader stage");
        code_resource(codec, &call->resource);
        break;
    case CALL_CONSTANTS: code_constants(codec, call); break;
    case CALL_CONSTANT_MATRIX: code_constant_matrix(codec, call); break;
    case CALL_UPDATE: code_update(codec, call); break;
    case CALL_TEXELS:
        code_resource(codec, &call->resource);
        code_resource(codec, &call->texels.source);
        break;
    case CALL_ATTACH: code_attach(codec, call); break;
    case CALL_COPY: code_copy(codec, call); break;
    case CALL_CLEAR: code_clear(codec, call); break;
    case CALL_DRAW:
    case CALL_DRAW_INDEXED: code_draw(codec, call); break;
    case CALL_BIND_VERTICES:
    case CALL_MIPS:
    case CALL_CONTENTS:
    case CALL_DRAW_MESH:
    case CALL_BEGIN_QUERY:
    case CALL_END_QUERY:
    case CALL_RELEASE:
    case CALL_PLAY:
    case CALL_SEQUENCE: code_resource(codec, &call->resource); break;
    case CALL_FRAME: break;
    }
}
