/* Vertex fog (Direct3D 9, "Fog Formulas"): the factor of the vertex's own colour, 1 without fog, 0 in full
 * fog.
 *
 *   linear  (end - d) / (end - start)
 *   exp     1 / e^(d * density)
 *   exp2    1 / e^((d * density)^2)
 *
 * d is the absolute depth in camera space, or the distance from the camera (RANGEFOGENABLE); the constants
 * are those of spec/pixel/fog.h. Without a formula, and for vertices that are in the window already, the
 * factor is the alpha of the vertex's specular colour. */
#ifndef SPEC_VERTEX_VERTEX_FOG_H
#define SPEC_VERTEX_VERTEX_FOG_H

#include "contract/language.h"
#include "spec/math/transcendental.h"
#include "spec/math/vector.h"
#include "spec/vertex/camera.h"
#include "spec/vertex/fetch.h"
#include "spec/vertex/transform.h"

static inline flt vertex_fog_distance(struct env *e, const struct vertex_key *k, const struct camera *camera)
{
    if (k->fog_range) {
        flt squared = dot3(E, camera->position, camera->position);
        return sqrt_f(E, squared);
    }
    flt minus = neg_f(E, camera->position[2]);
    return max_f(E, camera->position[2], minus);
}

static inline flt vertex_fog(struct env *e, const struct vertex_key *k, const struct camera *camera)
{
    if (k->fog == VERTEX_FOG_SPECULAR_ALPHA || k->attribute[ATTRIBUTE_POSITIONT] != ATTRIBUTE_FORMAT_NONE) {
        struct vector4 specular = fetch(E, k, ATTRIBUTE_SPECULAR, 0.0f);
        return specular.v[3];
    }
    flt distance = vertex_fog_distance(E, k, camera);
    flt scale = uniform_f(E, BASE_JOB, (int)offsetof(struct job, fog_scale));
    if (k->fog == VERTEX_FOG_LINEAR) {
        flt offset = uniform_f(E, BASE_JOB, (int)offsetof(struct job, fog_offset));
        return mad_f(E, distance, scale, offset);
    }
    flt exponent = mul_f(E, distance, scale);
    if (k->fog == VERTEX_FOG_EXP2) {
        flt minus = neg_f(E, exponent);
        exponent = mul_f(E, exponent, minus);
    }
    return exponential2(E, exponent);
}

#endif
