/* State blocks: recorded, or made of the values of a type; Capture and Apply. */
#include "front/d3d9/state/block.h"
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "front/d3d9/state/group.h"

#include <string.h>

/* D3DSTATEBLOCKTYPE. */
enum { BLOCK_ALL = 1, BLOCK_PIXEL, BLOCK_VERTEX };

static void destroy_block(struct d3d9_object *object)
{
    struct d3d9_state_block *block = (struct d3d9_state_block *)object;
    d3d9_state_free(block->state);
    d3d9_lights_free(&block->lights);
}

static struct d3d9_state_block *make_block(struct d3d9_device *device)
{
    struct d3d9_state_block *block =
        d3d9_object_make(sizeof *block, D3D9_INTERFACE_STATE_BLOCK, &device->object, destroy_block);
    if (!block)
        return NULL;
    block->device = device;
    block->state = d3d9_state_make(device->vertex_floats);
    if (block->state)
        return block;
    d3d9_object_release(&block->object);
    return NULL;
}

/* --- Which values belong to a type --- */

static void add_group(struct d3d9_state_block *block, enum d3d9_group group)
{
    const struct d3d9_state_group *g = d3d9_state_group + group;
    unsigned count = group == D3D9_GROUP_VERTEX_FLOAT ? block->device->vertex_floats : g->count;
    for (unsigned i = 0; i < count; i++)
        d3d9_mask_add(&block->mask, g->first + i);
}

/* Direct3D does not save the token of the debug monitor. */
static void add_all(struct d3d9_state_block *block)
{
    for (unsigned g = 0; g < D3D9_GROUPS; g++)
        if (g != D3D9_GROUP_RENDER)
            add_group(block, (enum d3d9_group)g);
    for (unsigned n = 0; n < D3D9_RENDER_STATES; n++) {
        int row = d3d9_state_render_row(n);
        if (row >= 0 && row != TRIPTYCH_STATE_DEBUGMONITORTOKEN)
            d3d9_mask_add(&block->mask, D3D9_CELL_RENDER + n);
    }
}

static bool is_member(enum triptych_state_table table, int row, bool vertex)
{
    static const uint8_t render[TRIPTYCH_STATE_COUNT] = {
#define RENDER_MEMBER(state, vertex, pixel) [STATE_ROW_##state] = (vertex) | (pixel) << 1,
#define SAMPLER_MEMBER(...)
#define STAGE_MEMBER(...)
#include "member.def"
#undef RENDER_MEMBER
#undef SAMPLER_MEMBER
#undef STAGE_MEMBER
    };
    static const uint8_t sampler[TRIPTYCH_SAMPLER_STATE_COUNT] = {
#define RENDER_MEMBER(...)
#define SAMPLER_MEMBER(state, vertex, pixel) [SAMPLER_ROW_##state] = (vertex) | (pixel) << 1,
#define STAGE_MEMBER(...)
#include "member.def"
#undef RENDER_MEMBER
#undef SAMPLER_MEMBER
#undef STAGE_MEMBER
    };
    static const uint8_t stage[TRIPTYCH_STAGE_STATE_COUNT] = {
#define RENDER_MEMBER(...)
#define SAMPLER_MEMBER(...)
#define STAGE_MEMBER(state, vertex, pixel) [STAGE_ROW_##state] = (vertex) | (pixel) << 1,
#include "member.def"
#undef RENDER_MEMBER
#undef SAMPLER_MEMBER
#undef STAGE_MEMBER
    };
    const uint8_t *members = table == TRIPTYCH_RENDER_STATES    ? render
                             : table == TRIPTYCH_SAMPLER_STATES ? sampler
                                                                : stage;
    return row >= 0 && members[row] & (vertex ? 1 : 2);
}

static void add_states(struct d3d9_state_block *block, bool vertex)
{
    for (unsigned n = 0; n < D3D9_RENDER_STATES; n++)
        if (is_member(TRIPTYCH_RENDER_STATES, d3d9_state_render_row(n), vertex))
            d3d9_mask_add(&block->mask, D3D9_CELL_RENDER + n);
    for (unsigned n = 0; n < D3D9_SAMPLERS * D3D9_SAMPLER_STATES; n++)
        if (is_member(TRIPTYCH_SAMPLER_STATES, d3d9_state_sampler_row(n % D3D9_SAMPLER_STATES), vertex))
            d3d9_mask_add(&block->mask, D3D9_CELL_SAMPLER + n);
    for (unsigned n = 0; n < TRIPTYCH_STAGES * D3D9_STAGE_STATES; n++)
        if (is_member(TRIPTYCH_STAGE_STATES, d3d9_state_stage_row(n % D3D9_STAGE_STATES), vertex))
            d3d9_mask_add(&block->mask, D3D9_CELL_STAGE + n);
}

static void add_vertex(struct d3d9_state_block *block)
{
    static const enum d3d9_group groups[] = {D3D9_GROUP_PATCHES,        D3D9_GROUP_DECLARATION,
                                             D3D9_GROUP_VERTEX_SHADER,  D3D9_GROUP_VERTEX_FLOAT,
                                             D3D9_GROUP_VERTEX_INTEGER, D3D9_GROUP_VERTEX_BOOLEAN};
    add_states(block, true);
    for (unsigned i = 0; i < sizeof groups / sizeof *groups; i++)
        add_group(block, groups[i]);
}

static void add_pixel(struct d3d9_state_block *block)
{
    static const enum d3d9_group groups[] = {D3D9_GROUP_PIXEL_SHADER, D3D9_GROUP_PIXEL_FLOAT,
                                             D3D9_GROUP_PIXEL_INTEGER, D3D9_GROUP_PIXEL_BOOLEAN};
    add_states(block, false);
    for (unsigned i = 0; i < sizeof groups / sizeof *groups; i++)
        add_group(block, groups[i]);
}

/* --- Lights --- */

/* Copies the halves of the light `from` that `parts` has. */
static bool copy_light(struct d3d9_lights *to, const struct d3d9_light_entry *from,
                       const struct d3d9_light_entry *parts)
{
    struct d3d9_light_entry *entry = d3d9_lights_get(to, parts->index);
    if (!entry)
        return false;
    if (parts->has_light)
        entry->light = from->light;
    if (parts->has_enabled)
        d3d9_lights_enable(to, entry, from->enabled);
    return true;
}

/* A block that is not recorded has the lights that exist when it is made. */
static bool take_lights(struct d3d9_state_block *block)
{
    const struct d3d9_lights *from = &block->device->lights;
    for (uint32_t i = 0; i < from->count; i++) {
        struct d3d9_light_entry *entry = d3d9_lights_get(&block->lights, from->entry[i].index);
        if (!entry)
            return false;
        *entry = from->entry[i];
        entry->has_light = entry->has_enabled = true;
    }
    block->lights.orders = from->orders;
    return true;
}

static bool capture_lights(struct d3d9_state_block *block)
{
    bool complete = true;
    for (uint32_t i = 0; i < block->lights.count; i++) {
        struct d3d9_light_entry *entry = block->lights.entry + i;
        const struct d3d9_light_entry *from = d3d9_lights_find(&block->device->lights, entry->index);
        complete &= !from || copy_light(&block->lights, from, entry);
    }
    return complete;
}

static bool apply_lights(struct d3d9_state_block *block)
{
    bool complete = true;
    for (uint32_t i = 0; i < block->lights.count; i++)
        complete &= copy_light(&block->device->lights, block->lights.entry + i, block->lights.entry + i);
    if (block->lights.count)
        block->device->late |= D3D9_LATE_LIGHTS;
    return complete;
}

/* --- Methods --- */

static void capture_values(struct d3d9_state_block *block)
{
    for (unsigned cell = d3d9_mask_next(&block->mask, 0); cell < D3D9_CELLS;
         cell = d3d9_mask_next(&block->mask, cell + 1))
        d3d9_state_copy(block->state, block->device->state, cell);
}

int32_t d3d9_device_create_state_block(struct d3d9_device *device, uint32_t type,
                                       struct d3d9_state_block **out)
{
    if (!out || type < BLOCK_ALL || type > BLOCK_VERTEX || device->recording)
        return D3D9_INVALID_CALL;
    struct d3d9_state_block *block = make_block(device);
    if (!block)
        return D3D9_OUT_OF_MEMORY;
    if (type == BLOCK_ALL)
        add_all(block);
    else if (type == BLOCK_VERTEX)
        add_vertex(block);
    else
        add_pixel(block);
    capture_values(block);
    if (type != BLOCK_PIXEL && !take_lights(block)) {
        d3d9_object_release(&block->object);
        return D3D9_OUT_OF_MEMORY;
    }
    *out = block;
    return D3D9_OK;
}

int32_t d3d9_device_begin_state_block(struct d3d9_device *device)
{
    if (device->recording)
        return D3D9_INVALID_CALL;
    struct d3d9_state_block *block = make_block(device);
    if (!block)
        return D3D9_OUT_OF_MEMORY;
    block->recorded = true;
    device->recording = block;
    /* The program does not have it yet, so it must not keep the device. */
    d3d9_object_hold(&block->object);
    d3d9_object_release(&block->object);
    return D3D9_OK;
}

int32_t d3d9_device_end_state_block(struct d3d9_device *device, struct d3d9_state_block **out)
{
    struct d3d9_state_block *block = device->recording;
    if (!out || !block)
        return D3D9_INVALID_CALL;
    device->recording = NULL;
    d3d9_object_add_ref(&block->object);
    d3d9_object_drop(&block->object);
    *out = block;
    return D3D9_OK;
}

/* The offsets of streams keep the values of the block's creation, unless the block was recorded. */
int32_t d3d9_state_block_capture(struct d3d9_state_block *block)
{
    uint32_t offset[TRIPTYCH_STREAMS];
    if (block->device->recording)
        return D3D9_INVALID_CALL;
    for (unsigned i = 0; i < TRIPTYCH_STREAMS; i++)
        offset[i] = block->state->stream[i].offset;
    capture_values(block);
    for (unsigned i = 0; i < TRIPTYCH_STREAMS && !block->recorded; i++)
        block->state->stream[i].offset = offset[i];
    return capture_lights(block) ? D3D9_OK : D3D9_OUT_OF_MEMORY;
}

/* A block does not unset the declaration. */
int32_t d3d9_state_block_apply(struct d3d9_state_block *block)
{
    struct d3d9_device *device = block->device;
    if (device->recording)
        return D3D9_INVALID_CALL;
    for (unsigned cell = d3d9_mask_next(&block->mask, 0); cell < D3D9_CELLS;
         cell = d3d9_mask_next(&block->mask, cell + 1)) {
        enum d3d9_group group = d3d9_state_group_of(cell);
        if (group == D3D9_GROUP_DECLARATION && !block->state->declaration[0])
            continue;
        if (d3d9_state_copy(device->state, block->state, cell))
            d3d9_state_forward(device, group, cell - d3d9_state_group[group].first);
    }
    return apply_lights(block) ? D3D9_OK : D3D9_OUT_OF_MEMORY;
}
