/* The size of a point in pixels (Direct3D 9, "Point Sprites"): the vertex's, or POINTSIZE if it has none.
 * With POINTSCALEENABLE, unless the vertex is in the window, it is multiplied by the viewport's height and
 *
 *   sqrt(1 / (a + d * (b + d * c)))     d the distance from the camera
 *
 * The result is at least the minimum and at most the maximum; where these contradict, the maximum. */
#ifndef SPEC_VERTEX_POINT_SIZE_H
#define SPEC_VERTEX_POINT_SIZE_H

#include "contract/language.h"
#include "spec/math/vector.h"
#include "spec/vertex/camera.h"
#include "spec/vertex/fetch.h"
#include "spec/vertex/transform.h"

static inline flt limit_point_size(struct env *e, flt size)
{
    flt least = uniform_f(E, BASE_JOB, (int)offsetof(struct job, point_least));
    flt most = uniform_f(E, BASE_JOB, (int)offsetof(struct job, point_most));
    msk large = lt_f(E, most, size);
    flt raised = max_f(E, size, least);
    return select_f(E, large, most, raised);
}

static inline flt point_size(struct env *e, const struct vertex_key *k, const struct camera *camera)
{
    flt size = uniform_f(E, BASE_JOB, (int)offsetof(struct job, point_size));
    if (k->attribute[ATTRIBUTE_POINT_SIZE] != ATTRIBUTE_FORMAT_NONE) {
        struct vector4 given = fetch(E, k, ATTRIBUTE_POINT_SIZE, 0.0f);
        size = given.v[0];
    }
    if (k->point_size == POINT_SIZE_SCALED && k->attribute[ATTRIBUTE_POSITIONT] == ATTRIBUTE_FORMAT_NONE) {
        flt term[3];
        for (int i = 0; i < 3; i++)
            term[i] = uniform_f(E, BASE_JOB, (int)offsetof(struct job, point_scale) + 4 * i);
        flt height = uniform_f(E, BASE_JOB, (int)offsetof(struct job, viewport_height));
        flt squared = dot3(E, camera->position, camera->position);
        flt distance = sqrt_f(E, squared);
        flt inner = mad_f(E, distance, term[2], term[1]);
        flt sum = mad_f(E, distance, inner, term[0]);
        flt shrinking = div_f(E, lit_f(E, 1.0f), sum);
        flt scale = sqrt_f(E, shrinking);
        flt in_pixels = mul_f(E, size, height);
        size = mul_f(E, in_pixels, scale);
    }
    return limit_point_size(E, size);
}

#endif
