/* Lights: any number can be defined; the renderer has eight. */
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "front/d3d9/state/block.h"

#include <math.h>
#include <string.h>

/* D3DLIGHTTYPE. */
enum { LIGHT_POINT = 1, LIGHT_SPOT, LIGHT_DIRECTIONAL };

static const struct d3d9_light default_light = {
    .type = LIGHT_DIRECTIONAL, .diffuse = {1, 1, 1, 0}, .direction = {0, 0, 1}};

/* The place of the entry, or where it belongs. */
static uint32_t place_of(const struct d3d9_lights *lights, uint32_t index)
{
    uint32_t low = 0, high = lights->count;
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (lights->entry[middle].index < index)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

struct d3d9_light_entry *d3d9_lights_find(const struct d3d9_lights *lights, uint32_t index)
{
    uint32_t place = place_of(lights, index);
    return place < lights->count && lights->entry[place].index == index ? lights->entry + place : NULL;
}

static bool make_room(struct d3d9_lights *lights)
{
    if (lights->count < lights->room)
        return true;
    uint32_t room = lights->room ? 2 * lights->room : 8;
    struct d3d9_light_entry *entry = d3d9_memory_allocate(room * sizeof *entry);
    if (!entry)
        return false;
    if (lights->count)
        memcpy(entry, lights->entry, lights->count * sizeof *entry);
    d3d9_memory_free(lights->entry);
    lights->entry = entry;
    lights->room = room;
    return true;
}

struct d3d9_light_entry *d3d9_lights_get(struct d3d9_lights *lights, uint32_t index)
{
    struct d3d9_light_entry *found = d3d9_lights_find(lights, index);
    if (found || !make_room(lights))
        return found;
    uint32_t place = place_of(lights, index);
    memmove(lights->entry + place + 1, lights->entry + place,
            (lights->count++ - place) * sizeof *lights->entry);
    lights->entry[place] = (struct d3d9_light_entry){.index = index, .light = default_light};
    return lights->entry + place;
}

void d3d9_lights_free(struct d3d9_lights *lights)
{
    d3d9_memory_free(lights->entry);
    *lights = (struct d3d9_lights){.entry = NULL};
}

void d3d9_lights_enable(struct d3d9_lights *lights, struct d3d9_light_entry *entry, bool enabled)
{
    if (enabled && !entry->enabled)
        entry->order = lights->orders++;
    entry->enabled = enabled;
}

/* --- The renderer's lights --- */

static float positive(float number)
{
    return number > 0 ? d3d9_state_finite(number) : 0;
}

static void copy_vector(float vector[3], const struct d3d9_vector *from)
{
    vector[0] = d3d9_state_finite(from->x);
    vector[1] = d3d9_state_finite(from->y);
    vector[2] = d3d9_state_finite(from->z);
}

static void copy_color(float color[4], const struct d3d9_color_value *from)
{
    color[0] = d3d9_state_finite(from->r);
    color[1] = d3d9_state_finite(from->g);
    color[2] = d3d9_state_finite(from->b);
    color[3] = d3d9_state_finite(from->a);
}

static struct triptych_light translate(const struct d3d9_light *from)
{
    struct triptych_light light = {.type = from->type == LIGHT_POINT  ? TRIPTYCH_LIGHT_POINT
                                           : from->type == LIGHT_SPOT ? TRIPTYCH_LIGHT_SPOT
                                                                      : TRIPTYCH_LIGHT_DIRECTIONAL,
                                   .range = positive(from->range),
                                   .attenuation = {positive(from->attenuation0), positive(from->attenuation1),
                                                   positive(from->attenuation2)},
                                   .phi = fminf(positive(from->phi), (float)M_PI),
                                   .falloff = positive(from->falloff)};
    copy_color(light.diffuse, &from->diffuse);
    copy_color(light.ambient, &from->ambient);
    copy_color(light.specular, &from->specular);
    copy_vector(light.position, &from->position);
    copy_vector(light.direction, &from->direction);
    if (light.direction[0] == 0 && light.direction[1] == 0 && light.direction[2] == 0)
        light.direction[2] = 1;
    light.theta = fminf(positive(from->theta), light.phi);
    return light;
}

void d3d9_lights_forward(struct d3d9_device *device)
{
    const struct d3d9_light_entry *active[TRIPTYCH_LIGHTS];
    unsigned count = 0;
    for (uint32_t i = 0; i < device->lights.count; i++) {
        const struct d3d9_light_entry *entry = device->lights.entry + i;
        unsigned place = count;
        if (!entry->enabled)
            continue;
        while (place && active[place - 1]->order > entry->order)
            place--;
        if (place == TRIPTYCH_LIGHTS)
            continue;
        count = count < TRIPTYCH_LIGHTS ? count + 1 : count;
        memmove(active + place + 1, active + place, (count - place - 1) * sizeof *active);
        active[place] = entry;
    }
    for (unsigned i = 0; i < TRIPTYCH_LIGHTS; i++) {
        if (i < count) {
            struct triptych_light light = translate(&active[i]->light);
            triptych_set_light(device->renderer, i, &light);
        }
        triptych_enable_light(device->renderer, i, i < count);
    }
}

/* --- Methods --- */

/* The lights that a method changes: those of the block that is being recorded, or of the device. */
static struct d3d9_lights *lights_to_change(struct d3d9_device *device)
{
    if (device->recording)
        return &device->recording->lights;
    device->late |= D3D9_LATE_LIGHTS;
    return &device->lights;
}

int32_t d3d9_device_set_light(struct d3d9_device *device, uint32_t index, const struct d3d9_light *light)
{
    if (!light || light->type < LIGHT_POINT || light->type > LIGHT_DIRECTIONAL)
        return D3D9_INVALID_CALL;
    struct d3d9_light_entry *entry = d3d9_lights_get(lights_to_change(device), index);
    if (!entry)
        return D3D9_OUT_OF_MEMORY;
    entry->light = *light;
    entry->has_light = true;
    return D3D9_OK;
}

int32_t d3d9_device_get_light(struct d3d9_device *device, uint32_t index, struct d3d9_light *light)
{
    const struct d3d9_light_entry *entry = d3d9_lights_find(&device->lights, index);
    if (!entry || !light)
        return D3D9_INVALID_CALL;
    *light = entry->light;
    return D3D9_OK;
}

int32_t d3d9_device_light_enable(struct d3d9_device *device, uint32_t index, int32_t enable)
{
    struct d3d9_lights *lights = lights_to_change(device);
    struct d3d9_light_entry *entry = d3d9_lights_get(lights, index);
    if (!entry)
        return D3D9_OUT_OF_MEMORY;
    d3d9_lights_enable(lights, entry, enable != 0);
    entry->has_enabled = true;
    return D3D9_OK;
}

int32_t d3d9_device_get_light_enable(struct d3d9_device *device, uint32_t index, int32_t *enable)
{
    enum { ENABLED = 128 }; /* what Direct3D 9 returns for an enabled light */
    const struct d3d9_light_entry *entry = d3d9_lights_find(&device->lights, index);
    if (!entry || !enable)
        return D3D9_INVALID_CALL;
    *enable = entry->enabled ? ENABLED : 0;
    return D3D9_OK;
}
