/* The vertex routine: fetch, blend, transform, clip code, light, fog; or a shader (vertex_shader.h). A lane
 * is a vertex (contract/arguments.h, struct vertex_arguments).
 *
 * Bases: JOB; INPUT is the lanes' vertex indices; OUTPUT the lanes' words in the vertex batch. Outputs that
 * the pixel routine does not read are missing in the key's varyings, and nothing is computed for them. A
 * vertex that is in the window already has neither camera space nor lighting. */
#ifndef SPEC_VERTEX_VERTEX_H
#define SPEC_VERTEX_VERTEX_H

#include "contract/language.h"
#include "spec/math/vector.h"
#include "spec/vertex/camera.h"
#include "spec/vertex/fetch.h"
#include "spec/vertex/light.h"
#include "spec/vertex/point_size.h"
#include "spec/vertex/skin.h"
#include "spec/vertex/store.h"
#include "spec/vertex/texgen.h"
#include "spec/vertex/transform.h"
#include "spec/vertex/vertex_fog.h"
#include "spec/vertex/vertex_shader.h"

/* A 1/w of 0 is 1: such vertices are interpolated without perspective. */
static inline void window_position_of(struct env *e, const struct vertex_key *k)
{
    struct vector4 position = fetch(E, k, ATTRIBUTE_POSITIONT, 0.0f);
    msk given = ne_f(E, position.v[3], lit_f(E, 0.0f));
    position.v[3] = select_f(E, given, position.v[3], lit_f(E, 1.0f));
    for (int c = 0; c < 4; c++)
        store_slot(E, SLOT_X + c, position.v[c]);
    store_position(E, k, position.v);
}

/* The position in clip space, directly or from the blended camera space. */
static inline void clip_position_of(struct env *e, const struct vertex_key *k, struct body *body)
{
    flt clip[4];
    struct vector4 blended;
    body->position = tween(E, k, ATTRIBUTE_POSITION, ATTRIBUTE_POSITION1, 4);
    body->one = !has_fourth(k, ATTRIBUTE_POSITION) && !(k->tween && has_fourth(k, ATTRIBUTE_POSITION1));
    if (k->matrices) {
        body->skin = skin_begin(E, k);
        for (int c = 0; c < 4; c++)
            blended.v[c] = body->blended[c] = skin_position(E, k, &body->skin, &body->position, body->one, c);
    }
    for (int c = 0; c < 4; c++) {
        clip[c] = k->matrices ? transform_component(E, &blended, 0, (int)offsetof(struct job, projection), c)
                              : transform_component(E, &body->position, body->one,
                                                    (int)offsetof(struct job, world_view_projection), c);
        store_slot(E, SLOT_X + c, clip[c]);
    }
    store_position(E, k, clip);
}

static inline void vertex_colors(struct env *e, const struct vertex_key *k, const struct camera *camera)
{
    struct vector4 diffuse, specular;
    if (k->lighting && !in_window(k))
        light_vertex(E, k, camera, &diffuse, &specular);
    else {
        diffuse = fetch(E, k, ATTRIBUTE_DIFFUSE, 1.0f);
        specular = fetch(E, k, ATTRIBUTE_SPECULAR, 0.0f);
    }
    if (k->varying[VARYING_diffuse])
        store_color(E, SLOT_diffuse, &diffuse);
    if (k->varying[VARYING_specular])
        store_color(E, SLOT_specular, &specular);
}

/* Blending by primitive has two elements, as inputs 0 and 1. */
static inline void vertex_blending(struct env *e, const struct vertex_key *k)
{
    struct vector4 number = vertex_input(E, k, 0);
    struct vector4 color = vertex_input(E, k, 1);
    store_slot(E, SLOT_blending + BLENDING_NUMBER, number.v[0]);
    for (int c = 0; c < 4; c++)
        store_slot(E, SLOT_blending + BLENDING_COLOR + c, color.v[c]);
}

static inline void vertex_coordinates(struct env *e, const struct vertex_key *k, int channel,
                                      const struct camera *camera)
{
    struct vector4 coordinates = texgen(E, k, channel, camera);
    int divisor = k->third_divides[channel] ? 2 : 3;
    for (int c = 0; c < 2; c++)
        if (k->varying[varying_texcoord(channel)])
            store_slot(E, varying_slot[varying_texcoord(channel)] + c, coordinates.v[c]);
    if (k->varying[varying_third(channel)])
        store_slot(E, varying_slot[varying_third(channel)], coordinates.v[2]);
    if (k->varying[varying_divisor(channel)])
        store_slot(E, varying_slot[varying_divisor(channel)], coordinates.v[divisor]);
}

/* Components that a pixel shader reads and that no fixed function computes. */
static inline void vertex_defaults(struct env *e, const struct vertex_key *k)
{
    for (int i = 0; i < 4 * PORTS; i++) {
        int varying = port_varying(i / 4, i % 4);
        if (!k->varying[varying] || k->link[i] == LINK_FIXED)
            continue;
        flt value = unlinked(E, k->link[i]);
        store_slot(E, varying_slot[varying] + port_component(i / 4, i % 4), value);
    }
}

static inline void spec_vertex(struct env *e, const struct vertex_key *k)
{
    struct body body;
    struct camera camera;
    if (e->program) {
        vertex_by_shader(E, k);
        return;
    }
    if (in_window(k))
        window_position_of(E, k);
    else {
        clip_position_of(E, k, &body);
        camera_space(E, k, &body, &camera);
    }
    if (k->varying[VARYING_diffuse] || k->varying[VARYING_specular])
        vertex_colors(E, k, &camera);
    if (k->varying[VARYING_fog]) {
        flt fog = vertex_fog(E, k, &camera);
        flt clamped = clamp_unit(E, fog);
        store_slot(E, SLOT_fog, clamped);
    }
    if (k->varying[VARYING_blending])
        vertex_blending(E, k);
    if (k->point_size != POINT_SIZE_CONSTANT) {
        flt size = point_size(E, k, &camera);
        store_slot(E, SLOT_POINT_SIZE, size);
    }
    for (int channel = 0; channel < TEXTURE_STAGES; channel++)
        if (reads_channel(k, channel))
            vertex_coordinates(E, k, channel, &camera);
    vertex_defaults(E, k);
}

#endif
