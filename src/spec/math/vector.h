/* A vector of four components. */
#ifndef SPEC_MATH_VECTOR_H
#define SPEC_MATH_VECTOR_H

#include "contract/language.h"

struct vector4 {
    flt v[4];
};

#endif
