/* Positions and normals from several matrices or several positions (Direct3D 9, "Indexed Vertex Blending",
 * "Using Vertex Tweening").
 *
 * Blending: the sum over `matrices` of weight times the position in the camera space of that matrix. The last
 * weight is 1 minus the others. Matrix i is world matrix i, or the one with the vertex's i-th index; indices
 * are rounded and limited to the palette. Tweening: position * (1 - t) + second position * t in model space,
 * and the same of normals. */
#ifndef SPEC_VERTEX_SKIN_H
#define SPEC_VERTEX_SKIN_H

#include "contract/language.h"
#include "spec/math/vector.h"
#include "spec/vertex/fetch.h"

struct skin {
    flt weight[BLEND_MATRICES];
    itg matrix[BLEND_MATRICES]; /* byte offsets in the palette, with indices */
};

static inline void skin_weights(struct env *e, const struct vertex_key *k, struct skin *skin)
{
    int last = k->matrices - 1;
    flt left = lit_f(E, 1.0f);
    if (last) {
        struct vector4 weights = fetch(E, k, ATTRIBUTE_WEIGHTS, 0.0f);
        for (int i = 0; i < last; i++) {
            skin->weight[i] = weights.v[i];
            left = sub_f(E, left, weights.v[i]);
        }
    }
    skin->weight[last] = left;
}

/* A packed colour has its bytes as components: index 0 is its red. */
static inline void skin_indices(struct env *e, const struct vertex_key *k, struct skin *skin)
{
    struct vector4 indices = fetch(E, k, ATTRIBUTE_INDICES, 0.0f);
    bool bytes = k->attribute[ATTRIBUTE_INDICES] == ATTRIBUTE_FORMAT_COLOR;
    for (int i = 0; i < k->matrices; i++) {
        flt index = bytes ? mul_f(E, indices.v[i], lit_f(E, 255.0f)) : indices.v[i];
        flt low = max_f(E, index, lit_f(E, 0.0f));
        flt limited = min_f(E, low, lit_f(E, WORLD_MATRICES - 1));
        itg number = round_i(E, limited);
        skin->matrix[i] = mul_i(E, number, lit_i(E, (int32_t)sizeof(struct palette_entry)));
    }
}

static inline struct skin skin_begin(struct env *e, const struct vertex_key *k)
{
    struct skin skin;
    skin_weights(E, k, &skin);
    if (k->indexed_matrices)
        skin_indices(E, k, &skin);
    return skin;
}

/* An element of matrix i; `field` is its offset in struct palette_entry. */
static inline flt skin_element(struct env *e, const struct vertex_key *k, const struct skin *skin, int i,
                               size_t field)
{
    if (k->indexed_matrices)
        return gather_f(E, BASE_JOB, (int)offsetof(struct job, palette), skin->matrix[i], 1, (int)field);
    size_t entry = offsetof(struct job, blend) + (size_t)i * sizeof(struct palette_entry);
    return uniform_f(E, BASE_JOB, (int)(entry + field));
}

/* Component c of the blended position in camera space. */
static inline flt skin_position(struct env *e, const struct vertex_key *k, const struct skin *skin,
                                const struct vector4 *p, int one, int c)
{
    size_t column = offsetof(struct palette_entry, world_view) + 4 * (size_t)c;
    flt total = lit_f(E, 0.0f);
    for (int i = 0; i < k->matrices; i++) {
        flt m3 = skin_element(E, k, skin, i, column + 48);
        flt sum = one ? m3 : mul_f(E, p->v[3], m3);
        for (int row = 2; row >= 0; row--) {
            flt m = skin_element(E, k, skin, i, column + 16 * (size_t)row);
            sum = mad_f(E, p->v[row], m, sum);
        }
        total = i ? mad_f(E, skin->weight[i], sum, total) : mul_f(E, skin->weight[i], sum);
    }
    return total;
}

static inline flt skin_normal(struct env *e, const struct vertex_key *k, const struct skin *skin,
                              const flt n[3], int c)
{
    size_t column = offsetof(struct palette_entry, normal) + 4 * (size_t)c;
    flt total = lit_f(E, 0.0f);
    for (int i = 0; i < k->matrices; i++) {
        flt m2 = skin_element(E, k, skin, i, column + 32);
        flt sum = mul_f(E, n[2], m2);
        for (int row = 1; row >= 0; row--) {
            flt m = skin_element(E, k, skin, i, column + 16 * (size_t)row);
            sum = mad_f(E, n[row], m, sum);
        }
        total = i ? mad_f(E, skin->weight[i], sum, total) : mul_f(E, skin->weight[i], sum);
    }
    return total;
}

/* An attribute, interpolated with its second value. */
static inline struct vector4 tween(struct env *e, const struct vertex_key *k, int attribute, int second,
                                   int components)
{
    struct vector4 first = fetch(E, k, attribute, 0.0f);
    if (!k->tween)
        return first;
    struct vector4 other = fetch(E, k, second, 0.0f);
    flt t = uniform_f(E, BASE_JOB, (int)offsetof(struct job, tween_factor));
    flt rest = sub_f(E, lit_f(E, 1.0f), t);
    for (int c = 0; c < components; c++) {
        flt far = mul_f(E, other.v[c], t);
        first.v[c] = mad_f(E, first.v[c], rest, far);
    }
    return first;
}

#endif
