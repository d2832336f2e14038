/* Vertex stages: fetch, transform, clip codes, lighting. */
#include "engines/stitch/stages.h"

static void plan_fetch(struct plan *plan, const struct vertex_key *key, enum attribute attribute)
{
#define FORMATS(name)                                                                                        \
    {                                                                                                        \
        &fragment_##name##_none, &fragment_##name##_float1, &fragment_##name##_float2,                       \
            &fragment_##name##_float3, &fragment_##name##_float4, &fragment_##name##_color                   \
    }
    static const struct fragment *const fetch[ATTRIBUTE_COUNT][ATTRIBUTE_FORMAT_COUNT] = {
        [ATTRIBUTE_POSITION] = FORMATS(position),
        [ATTRIBUTE_NORMAL] = FORMATS(normal),
        [ATTRIBUTE_DIFFUSE] = FORMATS(diffuse),
        [ATTRIBUTE_TEXCOORD] = FORMATS(texcoord)};
#undef FORMATS
    int32_t job = JOB(attribute) + (int32_t)attribute * (int32_t)sizeof(struct attribute_job);
    plan_append(
        plan, fetch[attribute][key->attribute[attribute]],
        (union arguments){.position_float1 = {.stride = job + (int32_t)offsetof(struct attribute_job, stride),
                                              .data = job + (int32_t)offsetof(struct attribute_job, data)}});
}

#define LIGHT(field) (int32_t) offsetof(struct light_job, field)

static void plan_light(struct plan *plan, enum light_type type, int i)
{
    const int32_t light = JOB(light) + i * (int32_t)sizeof(struct light_job);
    if (type == LIGHT_DIRECTIONAL)
        plan_append(plan, &fragment_light_directional,
                    (union arguments){.light_directional = {.direction = light + LIGHT(position),
                                                            .diffuse = light + LIGHT(diffuse)}});
    if (type == LIGHT_POINT)
        plan_append(plan, &fragment_light_point,
                    (union arguments){.light_point = {.position = light + LIGHT(position),
                                                      .diffuse = light + LIGHT(diffuse),
                                                      .ambient = light + LIGHT(ambient),
                                                      .attenuation0 = light + LIGHT(attenuation0),
                                                      .attenuation1 = light + LIGHT(attenuation1),
                                                      .attenuation2 = light + LIGHT(attenuation2),
                                                      .range = light + LIGHT(range)}});
}

static bool has_light(const struct vertex_key *key, enum light_type type)
{
    for (int i = 0; i < LIGHT_COUNT; i++)
        if (key->light[i] == type)
            return true;
    return false;
}

static void plan_lighting(struct plan *plan, const struct vertex_key *key)
{
    bool with_w = key_vertex_types[key->attribute[ATTRIBUTE_POSITION]].components == 4;
    bool point = has_light(key, LIGHT_POINT);
    if (point)
        plan_append(plan, with_w ? &fragment_camera_position_w : &fragment_camera_position,
                    (union arguments){.camera_position = {.matrix = JOB(world_view)}});
    if (point || has_light(key, LIGHT_DIRECTIONAL)) {
        plan_fetch(plan, key, ATTRIBUTE_NORMAL);
        plan_append(plan, &fragment_camera_normal,
                    (union arguments){.camera_normal = {.matrix = JOB(normal)}});
        if (key->normalize)
            plan_append_plain(plan, &fragment_normalize);
    }
    plan_append(plan, &fragment_base_color, (union arguments){.base_color = {.base_color = JOB(base_color)}});
    for (int i = 0; i < LIGHT_COUNT; i++)
        plan_light(plan, key->light[i], i);
}

static void plan_transform(struct plan *plan, const struct vertex_key *key)
{
    bool with_w = key_vertex_types[key->attribute[ATTRIBUTE_POSITION]].components == 4;
    plan_fetch(plan, key, ATTRIBUTE_POSITION);
    plan_append(plan, with_w ? &fragment_clip_position_w : &fragment_clip_position,
                (union arguments){.clip_position = {.matrix = JOB(world_view_projection),
                                                    .x = SLOT(X),
                                                    .y = SLOT(Y),
                                                    .z = SLOT(Z),
                                                    .w = SLOT(W)}});
    plan_append(plan, &fragment_clip_code,
                (union arguments){.clip_code = {.guard_left = JOB(guard_left),
                                                .guard_right = JOB(guard_right),
                                                .guard_bottom = JOB(guard_bottom),
                                                .guard_top = JOB(guard_top),
                                                .code = SLOT(CODE)}});
    for (int i = 0; i < key->clip_planes; i++)
        plan_append(plan, &fragment_clip_plane,
                    (union arguments){.clip_plane = {.plane = JOB(clip_plane) + i * (int32_t)sizeof(float[4]),
                                                     .bit = __builtin_ctz(CLIP_USER) + i,
                                                     .code = SLOT(CODE)}});
}

void stages_vertex(struct plan *plan, const union key *all)
{
    const struct vertex_key *key = &all->vertex;
    const int32_t diffuse = SLOT(diffuse), next = VERTEX_SLOT_BYTES;
    plan_enter(plan);
    struct loop loop = plan_begin(plan, UNIT_VERTEX);
    plan_transform(plan, key);
    if (key->varying[VARYING_diffuse]) {
        if (key->lighting)
            plan_lighting(plan, key);
        else
            plan_fetch(plan, key, ATTRIBUTE_DIFFUSE);
        plan_append(plan, &fragment_store_diffuse,
                    (union arguments){.store_diffuse = {.red = diffuse,
                                                        .green = diffuse + next,
                                                        .blue = diffuse + 2 * next,
                                                        .alpha = diffuse + 3 * next}});
    }
    for (int channel = 0; channel < TEXTURE_STAGES; channel++)
        if (key->varying[varying_texcoord(channel)]) {
            int32_t texcoord = varying_slot[varying_texcoord(channel)] * VERTEX_SLOT_BYTES;
            plan_fetch(plan, key, ATTRIBUTE_TEXCOORD);
            plan_append(plan, &fragment_store_texcoord,
                        (union arguments){.store_texcoord = {.u = texcoord, .v = texcoord + next}});
        }
    plan_leave(plan, UNIT_VERTEX, all, &loop, 0);
}
