/* The job's lights, and the colours that do not depend on the vertex. Reflectances of the material are
 * multiplied in here, in double; those of the vertex are 1 here. */
#include "render/derive/derive_part.h"
#include "render/derive/matrix.h"

#include <float.h>
#include <math.h>

/* The factors of a light's colours. */
struct reflectances {
    double diffuse[3], ambient[3], specular[3];
};

static void fill_reflectance(int source, const float material[4], double reflectance[3])
{
    for (int c = 0; c < 3; c++)
        reflectance[c] = source == REFLECTANCE_MATERIAL ? (double)material[c] : 1;
}

static void fill_direction(const struct triptych_light *light, const struct matrix *view, float target[3])
{
    double d[3];
    matrix_transform(light->direction, 0, view, d);
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int c = 0; c < 3; c++)
        target[c] = length > 0 ? (float)(-d[c] / length) : 0;
}

/* The first attenuation is more than zero, so that no light is infinite: infinity times an unlit side is not
 * a number, and would take the other lights with it. */
static void fill_position(const struct triptych_light *light, const struct matrix *view,
                          struct light_job *job)
{
    double p[3];
    matrix_transform(light->position, 1, view, p);
    for (int c = 0; c < 3; c++)
        job->position[c] = derive_narrow(p[c]);
    job->range = light->range;
    job->attenuation0 = fmaxf(light->attenuation[0], FLT_MIN);
    job->attenuation1 = light->attenuation[1];
    job->attenuation2 = light->attenuation[2];
}

/* Cones of the same angle have a sharp edge: everything within is 1. */
static void fill_spot(const struct triptych_light *light, const struct matrix *view, struct light_job *job)
{
    double inner = cos((double)light->theta / 2), outer = cos((double)light->phi / 2);
    fill_direction(light, view, job->axis);
    job->outer_cosine = (float)outer;
    job->cone_scale = inner > outer ? derive_narrow(1 / (inner - outer)) : FLT_MAX;
    job->falloff = light->falloff;
}

static void fill_light(const struct triptych_light *light, const struct reflectances *reflectances,
                       const struct matrix *view, struct light_job *job)
{
    bool directional = light->type == TRIPTYCH_LIGHT_DIRECTIONAL;
    for (int c = 0; c < 3; c++) {
        job->diffuse[c] = derive_narrow((double)light->diffuse[c] * reflectances->diffuse[c]);
        job->specular[c] = derive_narrow((double)light->specular[c] * reflectances->specular[c]);
        if (!directional)
            job->ambient[c] = derive_narrow((double)light->ambient[c] * reflectances->ambient[c]);
    }
    if (directional)
        fill_direction(light, view, job->position);
    else
        fill_position(light, view, job);
    if (light->type == TRIPTYCH_LIGHT_SPOT)
        fill_spot(light, view, job);
}

/* Ambient and emissive light: one sum, or two if any reflectance is the vertex's. */
static void fill_base(const struct state *state, const struct vertex_key *key, const double ambient[3],
                      const double reflectance[3], struct job *job)
{
    const struct triptych_material *material = &state->material;
    const uint8_t *source = key->reflectance;
    bool separate =
        source[REFLECTANCE_DIFFUSE] || source[REFLECTANCE_AMBIENT] || source[REFLECTANCE_EMISSIVE];
    for (int c = 0; c < 3; c++) {
        double emissive = source[REFLECTANCE_EMISSIVE] ? 0 : (double)material->emissive[c];
        double reflected = reflectance[c] * ambient[c];
        job->base_color[c] = derive_narrow(separate ? emissive : emissive + reflected);
        if (separate)
            job->ambient_light[c] = derive_narrow(reflected);
    }
    job->base_color[3] = material->diffuse[3];
    job->power = material->power;
    job->specular_alpha = material->specular[3];
}

/* The lights are packed to the front like the key's. */
void derive_lights(const struct state *state, const struct vertex_key *key, const struct matrix *view,
                   struct job *job)
{
    const struct triptych_material *material = &state->material;
    struct reflectances r;
    double ambient[3];
    fill_reflectance(key->reflectance[REFLECTANCE_DIFFUSE], material->diffuse, r.diffuse);
    fill_reflectance(key->reflectance[REFLECTANCE_AMBIENT], material->ambient, r.ambient);
    fill_reflectance(key->reflectance[REFLECTANCE_SPECULAR], material->specular, r.specular);
    for (int c = 0; c < 3; c++)
        ambient[c] = (GET(state, ambient) >> (16 - 8 * c) & 255) / 255.0;
    struct light_job *to = job->light;
    for (int i = 0; i < LIGHT_COUNT; i++) {
        const struct triptych_light *light = state->light + i;
        if (!state->light_enabled[i])
            continue;
        fill_light(light, &r, view, to++);
        for (int c = 0; c < 3 && light->type == TRIPTYCH_LIGHT_DIRECTIONAL; c++)
            ambient[c] += (double)light->ambient[c];
    }
    fill_base(state, key, ambient, r.ambient, job);
}
