/* Cube maps: the face that a vector from the centre meets, and the position on it.
 *
 * The component of largest magnitude is the major one, x before y before z where they are equal. Its sign
 * selects one of the axis's two faces. With m its magnitude, u = (s / m + 1) / 2 and v = (t / m + 1) / 2 of
 *
 *   face   +x   -x   +y   -y   +z   -z
 *   s      -z   +z   +x   +x   +x   -x
 *   t      -y   -y   +z   -z   -y   -y
 *
 * as in Direct3D 9 and OpenGL. Each face is filtered by itself: coordinates are clamped at its edges, or
 * addressed as those of a plane. The vector of zeros gives some texel. */
#ifndef SPEC_TEXTURE_CUBE_H
#define SPEC_TEXTURE_CUBE_H

#include "contract/language.h"
#include "spec/math/vector.h"

struct cube_face {
    msk x, y, negative; /* the major axis is x; is y; its component is negative */
    itg number;
};

/* A vector in the coordinates of a face: the table's s and t, and m. It is linear, so it also maps
 * differences. */
struct cube_vector {
    flt s, t, m;
};

static inline struct cube_face cube_face(struct env *e, const flt v[3])
{
    struct cube_face r;
    flt x = magnitude(E, v[0]);
    flt y = magnitude(E, v[1]);
    flt z = magnitude(E, v[2]);
    msk beyond_y = le_f(E, y, x);
    msk beyond_z = le_f(E, z, x);
    r.x = and_m(E, beyond_y, beyond_z);
    msk y_beyond_z = le_f(E, z, y);
    r.y = andn_m(E, y_beyond_z, r.x);
    flt minor = select_f(E, r.y, v[1], v[2]);
    flt major = select_f(E, r.x, v[0], minor);
    r.negative = lt_f(E, major, lit_f(E, 0.0f));
    itg number = select_i(E, r.y, lit_i(E, 2), lit_i(E, 4));
    number = select_i(E, r.x, lit_i(E, 0), number);
    itg one = mask_i(E, r.negative);
    r.number = sub_i(E, number, one);
    return r;
}

static inline struct cube_vector cube_turn(struct env *e, const struct cube_face *face, const flt v[3])
{
    struct cube_vector r;
    flt opposite_x = neg_f(E, v[0]);
    flt opposite_y = neg_f(E, v[1]);
    flt opposite_z = neg_f(E, v[2]);
    flt s_on_x = select_f(E, face->negative, v[2], opposite_z);
    flt s_on_z = select_f(E, face->negative, opposite_x, v[0]);
    flt s = select_f(E, face->y, v[0], s_on_z);
    r.s = select_f(E, face->x, s_on_x, s);
    flt t_on_y = select_f(E, face->negative, opposite_z, v[2]);
    r.t = select_f(E, face->y, t_on_y, opposite_y);
    flt minor = select_f(E, face->y, v[1], v[2]);
    flt major = select_f(E, face->x, v[0], minor);
    flt opposite = neg_f(E, major);
    r.m = select_f(E, face->negative, opposite, major);
    return r;
}

static inline flt cube_coordinate(struct env *e, flt ratio)
{
    return mad_f(E, ratio, lit_f(E, 0.5f), lit_f(E, 0.5f));
}

/* The change of (s / m + 1) / 2 with that of s and m: (ds - (s / m) dm) / 2m. */
static inline flt cube_difference(struct env *e, flt ratio, flt ds, flt dm, flt m)
{
    flt product = mul_f(E, ratio, dm);
    flt change = sub_f(E, ds, product);
    flt whole = div_f(E, change, m);
    return mul_f(E, whole, lit_f(E, 0.5f));
}

#endif
