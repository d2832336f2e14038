/* The alpha test: the colour's alpha and the draw's reference, both 0 to 255, are compared as integers. Alpha
 * in binary32 is rounded to an integer first.
 *
 * The key has the comparison that discards. Its opposite keeps pixels. COMPARE_NEVER keeps all, so
 * there is no test. */
#ifndef SPEC_PIXEL_ALPHA_H
#define SPEC_PIXEL_ALPHA_H

#include "contract/language.h"
#include "spec/pixel/compare.h"

static inline msk alpha_test(struct env *e, int discard, itg alpha, msk live)
{
    itg reference = uniform_i(E, BASE_JOB, (int)offsetof(struct job, alpha_reference));
    msk passed = keep_compared(E, COMPARE_ALWAYS - discard, alpha, reference, live);
    OBSERVE(E, alpha_value, 0, alpha);
    OBSERVE(E, alpha, 0, passed);
    return passed;
}

#endif
