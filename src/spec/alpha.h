/* The alpha test: the colour's alpha and the draw's reference, both 0 to 255, compared as integers. Alpha in
 * binary32 is rounded to them for this.
 *
 * The key has the comparison that discards: what is kept is its opposite, and a test that is off keeps all.
 */

static inline msk alpha_test(struct env *e, int discard, itg alpha, msk live)
{
    itg reference = uniform_i(E, BASE_JOB, (int)offsetof(struct job, alpha_reference));
    return keep_compared(E, COMPARE_ALWAYS - discard, alpha, reference, live);
}
