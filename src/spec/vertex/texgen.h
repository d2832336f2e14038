/* Texture coordinates of a channel: one of the vertex's sets, or generated from camera space, times a matrix
 * (Direct3D 9, D3DTSS_TEXCOORDINDEX and D3DTSS_TEXTURETRANSFORMFLAGS). Only the coordinates that the pixel
 * routine reads are computed.
 *
 *   normal, position   in camera space, 1
 *   reflection         p - 2 (p . n) n of the unit vector p from the camera to the vertex, 1
 *   sphere             r / m + 1/2 of the reflection r, x and y, with m = 2 |r + (0 0 1)|; 0, 1
 *
 * Before the matrix, a set of fewer than four components is followed by a 1 and then by zeros: u v 1 0. A set
 * that vertices do not have is 0 0 0 1. The matrix gives `count` coordinates; those after them are 0. The
 * divisor is the last coordinate: the third of three, which are the matrix's, or the vertex's if there is no
 * count; else the fourth. Vertices in the window have neither generators nor matrices. */
#ifndef SPEC_VERTEX_TEXGEN_H
#define SPEC_VERTEX_TEXGEN_H

#include "contract/language.h"
#include "spec/math/vector.h"
#include "spec/vertex/camera.h"
#include "spec/vertex/fetch.h"
#include "spec/vertex/transform.h"

struct coordinates {
    struct vector4 of;
    int components; /* components that the vertex has */
};

static inline void texgen_reflection(struct env *e, const struct camera *camera, flt reflection[3])
{
    flt along[3];
    flt squared = dot3(E, camera->position, camera->position);
    flt inverse = reciprocal_length(E, squared);
    for (int c = 0; c < 3; c++)
        along[c] = mul_f(E, camera->position[c], inverse);
    flt cosine = dot3(E, along, camera->normal);
    flt twice = mul_f(E, cosine, lit_f(E, -2.0f));
    for (int c = 0; c < 3; c++)
        reflection[c] = mad_f(E, twice, camera->normal[c], along[c]);
}

static inline void texgen_sphere(struct env *e, const struct camera *camera, struct vector4 *r)
{
    flt reflection[3], half[3];
    texgen_reflection(E, camera, reflection);
    half[0] = reflection[0];
    half[1] = reflection[1];
    half[2] = add_f(E, reflection[2], lit_f(E, 1.0f));
    flt squared = dot3(E, half, half);
    flt inverse = reciprocal_length(E, squared);
    flt scale = mul_f(E, inverse, lit_f(E, 0.5f));
    for (int c = 0; c < 2; c++)
        r->v[c] = mad_f(E, reflection[c], scale, lit_f(E, 0.5f));
    r->v[2] = lit_f(E, 0.0f);
}

static inline struct coordinates texgen_generate(struct env *e, int generator, const struct camera *camera)
{
    struct coordinates r = {.components = 3};
    r.of.v[3] = lit_f(E, 1.0f);
    if (generator == COORDINATE_SPHERE)
        texgen_sphere(E, camera, &r.of);
    else if (generator == COORDINATE_REFLECTION)
        texgen_reflection(E, camera, r.of.v);
    else
        for (int c = 0; c < 3; c++)
            r.of.v[c] = generator == COORDINATE_NORMAL ? camera->normal[c] : camera->position[c];
    return r;
}

/* A missing set is 0 0 0 1. */
static inline struct coordinates texgen_set(struct env *e, const struct vertex_key *k, int set)
{
    struct coordinates r;
    int attribute = ATTRIBUTE_TEXCOORD + set;
    r.of = fetch(E, k, attribute, 0.0f);
    r.components = key_vertex_types[k->attribute[attribute]].components;
    if (!r.components)
        r.of.v[3] = lit_f(E, 1.0f);
    return r;
}

/* Coordinate c of the product. The 1 multiplies the row after the last component. */
static inline flt texgen_transform(struct env *e, int channel, const struct coordinates *from, int c)
{
    int matrix = (int)(offsetof(struct job, texture_matrix) + 64 * (size_t)channel);
    int last = from->components ? from->components : 3;
    flt sum = last == 4 ? lit_f(E, 0.0f) : matrix_element(E, matrix, last, c);
    for (int row = last - 1; row >= 0; row--) {
        flt m = matrix_element(E, matrix, row, c);
        sum = row == 3 ? mul_f(E, from->of.v[row], m) : mad_f(E, from->of.v[row], m, sum);
    }
    return sum;
}

static inline struct vector4 texgen(struct env *e, const struct vertex_key *k, int channel,
                                    const struct camera *camera)
{
    struct coordinates from;
    struct vector4 r;
    int window = k->attribute[ATTRIBUTE_POSITIONT] != ATTRIBUTE_FORMAT_NONE,
        count = k->texture_matrix[channel];
    if (k->texcoord[channel] < TEXCOORD_SETS || window)
        from = texgen_set(E, k, k->texcoord[channel] % TEXCOORD_SETS);
    else
        from = texgen_generate(E, k->texcoord[channel], camera);
    if (!count || window)
        return from.of;
    for (int c = 0; c < 4; c++)
        r.v[c] = c < count ? texgen_transform(E, channel, &from, c) : lit_f(E, 0.0f);
    return r;
}

#endif
