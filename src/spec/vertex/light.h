/* Fixed-function lighting in camera space (Direct3D 9, "Mathematics of Lighting").
 *
 *   diffuse  = emissive + Ma * (scene + sum of A * La) + Md * sum of A * Ld * max(0, N . L)
 *   specular = Ms * sum of A * Ls * (N . H)^power where N . L and N . H are positive
 *
 * The sums are over the lights. N is the normal, L the unit vector to the light, H the unit vector half way
 * between L and the vector to the camera (LOCALVIEWER: from the vertex; else 0 0 -1). The attenuation A is 1
 * for a directional light. For the others it is 0 beyond the range, else 1 / (a0 + d * (a1 + d * a2)) with a0
 * at least 2^-126. For a spot it is also multiplied by a factor from 0 at the outer cone to 1 at the inner
 * cone, to the power of the falloff.
 *
 * Each reflectance M is the material's or one of the vertex's colours. The material's are multiplied into the
 * job's lights beforehand (render/derive/derive_light.c). If diffuse, ambient and emissive all are the
 * material's, there is only one sum, which begins with base_color; base_color includes the ambient parts of
 * directional lights. Alpha is that of the diffuse reflectance, and of the specular one. */
#ifndef SPEC_VERTEX_LIGHT_H
#define SPEC_VERTEX_LIGHT_H

#include "contract/language.h"
#include "spec/math/transcendental.h"
#include "spec/math/vector.h"
#include "spec/vertex/camera.h"
#include "spec/vertex/fetch.h"
#include "spec/vertex/transform.h"

struct light_sums {
    flt diffuse[3]; /* the only sum if nothing comes from the vertex */
    flt ambient[3];
    flt specular[3];
    flt to_camera[3];
};

static inline int light_field(int light, size_t field)
{
    return (int)(offsetof(struct job, light) + (size_t)light * sizeof(struct light_job) + field);
}

static inline flt light_value(struct env *e, int light, size_t field)
{
    return uniform_f(E, BASE_JOB, light_field(light, field));
}

/* Returns true if any part of the diffuse result comes from the vertex, so that the two sums are separate. */
static inline bool light_separates(const struct vertex_key *k)
{
    return k->reflectance[REFLECTANCE_DIFFUSE] || k->reflectance[REFLECTANCE_AMBIENT] ||
           k->reflectance[REFLECTANCE_EMISSIVE];
}

static inline flt light_facing(struct env *e, const flt normal[3], const flt to_light[3])
{
    flt cosine = dot3(E, normal, to_light);
    return max_f(E, cosine, lit_f(E, 0.0f));
}

/* The share of a light's specular colour, before attenuation. */
static inline flt light_highlight(struct env *e, const struct vertex_key *k, const flt normal[3],
                                  const flt to_light[3], flt facing, const struct light_sums *sums)
{
    flt half[3];
    for (int c = 0; c < 3; c++)
        half[c] = add_f(E, to_light[c], sums->to_camera[c]);
    flt squared = dot3(E, half, half);
    flt inverse = reciprocal_length(E, squared);
    flt along = dot3(E, normal, half);
    flt cosine = mul_f(E, along, inverse);
    flt shine = cosine;
    if (k->highlight == HIGHLIGHT_FLAT)
        shine = lit_f(E, 1.0f);
    else if (k->highlight == HIGHLIGHT_POWER) {
        flt exponent = uniform_f(E, BASE_JOB, (int)offsetof(struct job, power));
        shine = power(E, cosine, exponent);
    }
    msk turned_to_light = lt_f(E, lit_f(E, 0.0f), facing);
    msk turned_half_way = lt_f(E, lit_f(E, 0.0f), cosine);
    msk seen = and_m(E, turned_to_light, turned_half_way);
    return select_f(E, seen, shine, lit_f(E, 0.0f));
}

static inline void light_specular(struct env *e, int light, flt share, struct light_sums *sums)
{
    for (int c = 0; c < 3; c++) {
        flt specular = light_value(E, light, offsetof(struct light_job, specular) + 4 * (size_t)c);
        sums->specular[c] = mad_f(E, share, specular, sums->specular[c]);
    }
}

static inline void light_directional(struct env *e, const struct vertex_key *k, int light,
                                     const flt normal[3], struct light_sums *sums)
{
    flt to_light[3];
    for (int c = 0; c < 3; c++)
        to_light[c] = light_value(E, light, offsetof(struct light_job, position) + 4 * (size_t)c);
    flt facing = light_facing(E, normal, to_light);
    for (int c = 0; c < 3; c++) {
        flt diffuse = light_value(E, light, offsetof(struct light_job, diffuse) + 4 * (size_t)c);
        sums->diffuse[c] = mad_f(E, facing, diffuse, sums->diffuse[c]);
    }
    if (k->highlight != HIGHLIGHT_NONE) {
        flt share = light_highlight(E, k, normal, to_light, facing, sums);
        light_specular(E, light, share, sums);
    }
}

static inline flt light_attenuation(struct env *e, int light, flt distance)
{
    flt a0 = light_value(E, light, offsetof(struct light_job, attenuation0));
    flt a1 = light_value(E, light, offsetof(struct light_job, attenuation1));
    flt a2 = light_value(E, light, offsetof(struct light_job, attenuation2));
    flt range = light_value(E, light, offsetof(struct light_job, range));
    flt inner = mad_f(E, distance, a2, a1);
    flt denominator = mad_f(E, distance, inner, a0);
    flt attenuation = div_f(E, lit_f(E, 1.0f), denominator);
    msk reached = le_f(E, distance, range);
    return select_f(E, reached, attenuation, lit_f(E, 0.0f));
}

/* 0 at the outer cone and beyond, 1 at the inner cone and within. */
static inline flt light_spot(struct env *e, int type, int light, const flt to_light[3])
{
    flt axis[3];
    for (int c = 0; c < 3; c++)
        axis[c] = light_value(E, light, offsetof(struct light_job, axis) + 4 * (size_t)c);
    flt cosine = dot3(E, axis, to_light);
    flt outer = light_value(E, light, offsetof(struct light_job, outer_cosine));
    flt scale = light_value(E, light, offsetof(struct light_job, cone_scale));
    flt beyond = sub_f(E, cosine, outer);
    flt scaled = mul_f(E, beyond, scale);
    flt low = max_f(E, scaled, lit_f(E, 0.0f));
    flt within = min_f(E, low, lit_f(E, 1.0f));
    if (type == LIGHT_SPOT)
        return within;
    flt falloff = light_value(E, light, offsetof(struct light_job, falloff));
    flt bent = power(E, within, falloff);
    msk inside = lt_f(E, lit_f(E, 0.0f), within);
    return select_f(E, inside, bent, lit_f(E, 0.0f));
}

/* Adds a light of colours La and Ld with attenuation to one sum or both. */
static inline void light_attenuated(struct env *e, const struct vertex_key *k, int light, flt attenuation,
                                    flt facing, struct light_sums *sums)
{
    for (int c = 0; c < 3; c++) {
        flt diffuse = light_value(E, light, offsetof(struct light_job, diffuse) + 4 * (size_t)c);
        flt ambient = light_value(E, light, offsetof(struct light_job, ambient) + 4 * (size_t)c);
        if (light_separates(k)) {
            flt lit = mul_f(E, facing, diffuse);
            sums->diffuse[c] = mad_f(E, attenuation, lit, sums->diffuse[c]);
            sums->ambient[c] = mad_f(E, attenuation, ambient, sums->ambient[c]);
        } else {
            flt lit = mad_f(E, facing, diffuse, ambient);
            sums->diffuse[c] = mad_f(E, attenuation, lit, sums->diffuse[c]);
        }
    }
}

static inline void light_positioned(struct env *e, const struct vertex_key *k, int light,
                                    const struct camera *camera, struct light_sums *sums)
{
    flt to_light[3];
    for (int c = 0; c < 3; c++) {
        flt at = light_value(E, light, offsetof(struct light_job, position) + 4 * (size_t)c);
        to_light[c] = sub_f(E, at, camera->position[c]);
    }
    flt squared = dot3(E, to_light, to_light);
    flt inverse = reciprocal_length(E, squared);
    flt distance = mul_f(E, squared, inverse);
    for (int c = 0; c < 3; c++)
        to_light[c] = mul_f(E, to_light[c], inverse);
    flt attenuation = light_attenuation(E, light, distance);
    if (k->light[light] != LIGHT_POINT) {
        flt spot = light_spot(E, k->light[light], light, to_light);
        attenuation = mul_f(E, attenuation, spot);
    }
    flt facing = light_facing(E, camera->normal, to_light);
    light_attenuated(E, k, light, attenuation, facing, sums);
    if (k->highlight != HIGHLIGHT_NONE) {
        flt shine = light_highlight(E, k, camera->normal, to_light, facing, sums);
        flt share = mul_f(E, shine, attenuation);
        light_specular(E, light, share, sums);
    }
}

static inline void light_to_camera(struct env *e, const struct vertex_key *k, const struct camera *camera,
                                   struct light_sums *sums)
{
    if (!k->local_viewer) {
        for (int c = 0; c < 3; c++)
            sums->to_camera[c] = lit_f(E, c == 2 ? -1.0f : 0.0f);
        return;
    }
    flt squared = dot3(E, camera->position, camera->position);
    flt inverse = reciprocal_length(E, squared);
    flt away = neg_f(E, inverse);
    for (int c = 0; c < 3; c++)
        sums->to_camera[c] = mul_f(E, camera->position[c], away);
}

/* One of the vertex's colours, as a reflectance. */
static inline struct vector4 light_vertex_color(struct env *e, const struct vertex_key *k, int which)
{
    bool second = k->reflectance[which] == REFLECTANCE_SPECULAR_COLOR;
    return fetch(E, k, second ? ATTRIBUTE_SPECULAR : ATTRIBUTE_DIFFUSE, second ? 0.0f : 1.0f);
}

/* Adds sum * reflectance to a colour. The sum already includes the reflectance if it is the material's. */
static inline void light_reflect(struct env *e, const struct vertex_key *k, int which, const flt sum[3],
                                 struct vector4 *color)
{
    struct vector4 reflectance;
    if (k->reflectance[which])
        reflectance = light_vertex_color(E, k, which);
    for (int c = 0; c < 3; c++)
        color->v[c] = k->reflectance[which] ? mad_f(E, sum[c], reflectance.v[c], color->v[c])
                                            : add_f(E, sum[c], color->v[c]);
}

/* Emissive light and alpha, from the vertex where the key specifies it. */
static inline void light_emit(struct env *e, const struct vertex_key *k, struct vector4 *color)
{
    if (k->reflectance[REFLECTANCE_EMISSIVE]) {
        struct vector4 emissive = light_vertex_color(E, k, REFLECTANCE_EMISSIVE);
        for (int c = 0; c < 3; c++)
            color->v[c] = emissive.v[c];
    }
    if (k->reflectance[REFLECTANCE_DIFFUSE]) {
        struct vector4 diffuse = light_vertex_color(E, k, REFLECTANCE_DIFFUSE);
        color->v[3] = diffuse.v[3];
    }
}

static inline void light_all(struct env *e, const struct vertex_key *k, const struct camera *camera,
                             struct light_sums *sums)
{
    for (int i = 0; i < LIGHT_COUNT; i++)
        switch ((enum light_type)k->light[i]) {
        case LIGHT_TYPE_COUNT:
        case LIGHT_NONE: break;
        case LIGHT_DIRECTIONAL: light_directional(E, k, i, camera->normal, sums); break;
        case LIGHT_POINT:
        case LIGHT_SPOT:
        case LIGHT_SPOT_POWER: light_positioned(E, k, i, camera, sums); break;
        }
}

static inline struct vector4 light_specular_color(struct env *e, const struct vertex_key *k,
                                                  const struct light_sums *sums)
{
    struct vector4 color;
    for (int c = 0; c < 4; c++)
        color.v[c] = lit_f(E, 0.0f);
    if (k->highlight == HIGHLIGHT_NONE)
        return color;
    light_reflect(E, k, REFLECTANCE_SPECULAR, sums->specular, &color);
    color.v[3] = uniform_f(E, BASE_JOB, (int)offsetof(struct job, specular_alpha));
    if (k->reflectance[REFLECTANCE_SPECULAR]) {
        struct vector4 specular = light_vertex_color(E, k, REFLECTANCE_SPECULAR);
        color.v[3] = specular.v[3];
    }
    return color;
}

/* Diffuse and specular colour, unclamped. */
static inline void light_vertex(struct env *e, const struct vertex_key *k, const struct camera *camera,
                                struct vector4 *diffuse, struct vector4 *specular)
{
    struct light_sums sums;
    struct vector4 color;
    int separate = light_separates(k);
    for (int c = 0; c < 4; c++)
        color.v[c] = uniform_f(E, BASE_JOB, (int)offsetof(struct job, base_color) + 4 * c);
    for (int c = 0; c < 3; c++) {
        sums.diffuse[c] = separate ? lit_f(E, 0.0f) : color.v[c];
        if (separate)
            sums.ambient[c] = uniform_f(E, BASE_JOB, (int)offsetof(struct job, ambient_light) + 4 * c);
        if (k->highlight != HIGHLIGHT_NONE)
            sums.specular[c] = lit_f(E, 0.0f);
    }
    if (k->highlight != HIGHLIGHT_NONE)
        light_to_camera(E, k, camera, &sums);
    light_all(E, k, camera, &sums);
    if (separate) {
        light_emit(E, k, &color);
        light_reflect(E, k, REFLECTANCE_AMBIENT, sums.ambient, &color);
        light_reflect(E, k, REFLECTANCE_DIFFUSE, sums.diffuse, &color);
    } else {
        for (int c = 0; c < 3; c++)
            color.v[c] = sums.diffuse[c];
    }
    *diffuse = color;
    *specular = light_specular_color(E, k, &sums);
}

#endif
