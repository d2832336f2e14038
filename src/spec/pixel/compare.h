/* Comparison of integers: the lanes of `live` where `a FUNCTION b`.
 *
 * Three orders are not operations themselves; they remove the lanes where the opposite order holds. */
#ifndef SPEC_PIXEL_COMPARE_H
#define SPEC_PIXEL_COMPARE_H

#include "contract/language.h"

static inline msk keep_compared(struct env *e, int function, itg a, itg b, msk live)
{
    msk found;
    switch ((enum compare)function) {
    case COMPARE_NEVER: return lit_m(E, 0);
    case COMPARE_LESS: found = gt_i(E, b, a); return and_m(E, live, found);
    case COMPARE_EQUAL: found = eq_i(E, a, b); return and_m(E, live, found);
    case COMPARE_LESS_EQUAL: found = gt_i(E, a, b); return andn_m(E, live, found);
    case COMPARE_GREATER: found = gt_i(E, a, b); return and_m(E, live, found);
    case COMPARE_NOT_EQUAL: found = eq_i(E, a, b); return andn_m(E, live, found);
    case COMPARE_GREATER_EQUAL: found = gt_i(E, b, a); return andn_m(E, live, found);
    case COMPARE_ALWAYS:
    case COMPARE_COUNT: break;
    }
    return live;
}

#endif
