/* A vector of four components, and magnitudes of components. */
#ifndef SPEC_MATH_VECTOR_H
#define SPEC_MATH_VECTOR_H

#include "contract/language.h"

struct vector4 {
    flt v[4];
};

static inline flt magnitude(struct env *e, flt value)
{
    itg bits = bits_i(E, value);
    itg positive = and_i(E, bits, lit_i(E, 0x7fffffff));
    return bits_f(E, positive);
}

#endif
