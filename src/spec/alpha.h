/* The alpha test: the colour's alpha and the draw's reference, both 0 to 255, compared as integers. Alpha in
 * binary32 is rounded to them for this.
 *
 * The key has the comparison that discards, so lanes are taken away and a test that is off takes away none.
 */

static inline msk alpha_test(struct env *e, int discard, itg alpha, msk live)
{
    itg reference = uniform_i(E, BASE_JOB, (int)offsetof(struct job, alpha_reference));
    msk found;
    switch (discard) {
    case COMPARE_LESS: found = gt_i(E, reference, alpha); return andn_m(E, live, found);
    case COMPARE_EQUAL: found = eq_i(E, alpha, reference); return andn_m(E, live, found);
    case COMPARE_LESS_EQUAL: found = gt_i(E, alpha, reference); return and_m(E, live, found);
    case COMPARE_GREATER: found = gt_i(E, alpha, reference); return andn_m(E, live, found);
    case COMPARE_NOT_EQUAL: found = eq_i(E, alpha, reference); return and_m(E, live, found);
    case COMPARE_GREATER_EQUAL: found = gt_i(E, reference, alpha); return and_m(E, live, found);
    case COMPARE_ALWAYS: return lit_m(E, 0);
    default: return live;
    }
}
