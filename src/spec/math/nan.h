/* The only NaN that targets have: two NaNs can differ in their payload, which the specification does not
 * define. */
#ifndef SPEC_MATH_NAN_H
#define SPEC_MATH_NAN_H

#include "contract/language.h"

static inline flt one_nan(struct env *e, flt value)
{
    msk nan = ne_f(E, value, value);
    flt only = bits_f(E, lit_i(E, 0x7fc00000));
    return select_f(E, nan, only, value);
}

#endif
