/* Stencil: an integer of 1 to 8 bits stored with the depth. It is tested before depth and changed after both
 * tests.
 *
 *   test       (reference & mask) FUNCTION (stored & mask)
 *   result     stencil fails: FAIL of the stored value; passes, depth fails: DEPTH_FAIL; both pass: PASS
 *   written    (stored & ~write mask) | (result & write mask)
 *
 *   KEEP, ZERO, REPLACE (the reference), INVERT (maximum - stored), INCREMENT and DECREMENT modulo
 *   maximum + 1, the SATURATED ones stopping at maximum and 0; maximum = 2^bits - 1.
 *
 * With two tests, triangles that are clockwise on the screen use the first, the others the second. Each test
 * can have a reference and masks of its own. */
#ifndef SPEC_PIXEL_STENCIL_H
#define SPEC_PIXEL_STENCIL_H

#include "contract/language.h"
#include "spec/pixel/compare.h"
#include "spec/pixel/depth.h"

/* Returns true if a side has the reference and masks of counter-clockwise triangles. */
static inline bool stencil_is_second(const struct pixel_key *k, int side)
{
    return k->stencil_values == STENCIL_VALUES_EACH ? side == SIDE_COUNTERCLOCKWISE
                                                    : k->stencil_values == STENCIL_VALUES_SECOND;
}

static inline itg stencil_reference(struct env *e, const struct pixel_key *k, int side)
{
    bool second = stencil_is_second(k, side);
    return uniform_i(E, BASE_JOB,
                     second ? (int)offsetof(struct job, ccw_stencil_reference)
                            : (int)offsetof(struct job, stencil_reference));
}

static inline itg stencil_compare_mask(struct env *e, const struct pixel_key *k, int side)
{
    bool second = stencil_is_second(k, side);
    return uniform_i(E, BASE_JOB,
                     second ? (int)offsetof(struct job, ccw_stencil_mask)
                            : (int)offsetof(struct job, stencil_mask));
}

static inline itg stencil_side_write_mask(struct env *e, const struct pixel_key *k, int side)
{
    bool second = stencil_is_second(k, side);
    return uniform_i(E, BASE_JOB,
                     second ? (int)offsetof(struct job, ccw_stencil_write_mask)
                            : (int)offsetof(struct job, stencil_write_mask));
}

static inline itg stencil_result(struct env *e, const struct pixel_key *k, int side, int operation,
                                 itg stored)
{
    itg maximum = uniform_i(E, BASE_JOB, (int)offsetof(struct job, stencil_maximum)), r;
    switch ((enum stencil_operation)operation) {
    case STENCIL_ZERO: return lit_i(E, 0);
    case STENCIL_REPLACE: return stencil_reference(E, k, side);
    case STENCIL_INCREMENT_SATURATED: r = add_i(E, stored, lit_i(E, 1)); return min_i(E, r, maximum);
    case STENCIL_DECREMENT_SATURATED: r = sub_i(E, stored, lit_i(E, 1)); return max_i(E, r, lit_i(E, 0));
    case STENCIL_INVERT: return xor_i(E, stored, maximum);
    case STENCIL_INCREMENT: r = add_i(E, stored, lit_i(E, 1)); return and_i(E, r, maximum);
    case STENCIL_DECREMENT: r = sub_i(E, stored, lit_i(E, 1)); return and_i(E, r, maximum);
    case STENCIL_KEEP:
    case STENCIL_OPERATION_COUNT: break;
    }
    return stored;
}

static inline msk stencil_pass(struct env *e, const struct pixel_key *k, int side, itg stored, msk live)
{
    int function = k->stencil_function[side];
    itg mask = stencil_compare_mask(E, k, side);
    itg reference = stencil_reference(E, k, side);
    itg left = and_i(E, reference, mask);
    itg right = and_i(E, stored, mask);
    return keep_compared(E, function, left, right, live);
}

/* The result of one side: `passed` are the lanes that pass the stencil test, `both` those that pass depth as
 * well. */
static inline itg stencil_change(struct env *e, const struct pixel_key *k, int side, itg stored, msk passed,
                                 msk both)
{
    int pass = k->stencil_pass[side], depth_fail = k->stencil_depth_fail[side];
    int fail = k->stencil_fail[side];
    itg r = stencil_result(E, k, side, pass, stored);
    if (depth_fail != pass) {
        itg other = stencil_result(E, k, side, depth_fail, stored);
        r = select_i(E, both, r, other);
    }
    if (k->stencil_function[side] == COMPARE_ALWAYS || (fail == pass && fail == depth_fail))
        return r;
    itg failed = stencil_result(E, k, side, fail, stored);
    return select_i(E, passed, r, failed);
}

/* A mask that is the same in all lanes: the triangle is clockwise. */
static inline msk triangle_clockwise(struct env *e)
{
    itg visible = uniform_i(E, BASE_TRIANGLE, (int)offsetof(struct triangle_head, visible));
    return gt_i(E, lit_i(E, 0), visible);
}

/* Lanes of `live` whose stencil passes. */
static inline msk stencil_test(struct env *e, const struct pixel_key *k, itg stored, msk live)
{
    msk first = stencil_pass(E, k, SIDE_CLOCKWISE, stored, live);
    if (k->stencil != STENCIL_TWO)
        return first;
    msk second = stencil_pass(E, k, SIDE_COUNTERCLOCKWISE, stored, live);
    msk clockwise = triangle_clockwise(E);
    msk one = and_m(E, first, clockwise);
    msk other = andn_m(E, second, clockwise);
    return or_m(E, one, other);
}

/* The bits that are written. A side that keeps the stencil has none of its own. */
static inline itg stencil_write_mask(struct env *e, const struct pixel_key *k)
{
    if (k->stencil_values != STENCIL_VALUES_EACH || !stencil_side_changes(k, SIDE_COUNTERCLOCKWISE))
        return stencil_side_write_mask(E, k, SIDE_CLOCKWISE);
    itg second = stencil_side_write_mask(E, k, SIDE_COUNTERCLOCKWISE);
    if (!stencil_side_changes(k, SIDE_CLOCKWISE))
        return second;
    itg first = stencil_side_write_mask(E, k, SIDE_CLOCKWISE);
    msk clockwise = triangle_clockwise(E);
    return select_i(E, clockwise, first, second);
}

/* The word's new stencil bits. */
static inline itg stencil_update(struct env *e, const struct pixel_key *k, itg stored, msk passed, msk both)
{
    itg r = stencil_change(E, k, SIDE_CLOCKWISE, stored, passed, both);
    if (k->stencil == STENCIL_TWO) {
        itg other = stencil_change(E, k, SIDE_COUNTERCLOCKWISE, stored, passed, both);
        msk clockwise = triangle_clockwise(E);
        r = select_i(E, clockwise, r, other);
    }
    itg write_mask = stencil_write_mask(E, k);
    itg changed = xor_i(E, stored, r);
    itg written = and_i(E, changed, write_mask);
    return xor_i(E, stored, written);
}

/* Tests stencil and depth together if the stencil is written: one word is loaded and stored. */
static inline msk stencil_depth_write(struct env *e, const struct pixel_key *k,
                                      const struct pixel_position *at, const struct triangle_layout *layout,
                                      msk live)
{
    struct depth depth;
    itg word = load_i(E, BASE_DEPTH, sample_word(at));
    itg stored = and_i(E, word, lit_i(E, 255));
    msk passed = stencil_test(E, k, stored, live);
    msk both = passed;
    OBSERVE(E, stencil, at->sample, passed);
    if (pixel_tests_depth(k)) {
        depth = depth_pair(E, k, at, layout);
        both = depth_pass(E, k, &depth, passed);
        OBSERVE(E, depth, at->sample, both);
    }
    itg new = stencil_update(E, k, stored, passed, both);
    itg high = and_i(E, word, lit_i(E, -256));
    if (k->depth_write) {
        itg new_high = shl_i(E, depth.code, 8);
        high = select_i(E, both, new_high, high);
    }
    itg changed = or_i(E, high, new);
    itg merged = select_i(E, live, changed, word);
    store_i(E, BASE_DEPTH, sample_word(at), merged);
    return both;
}

/* Both tests if the stencil is not written. */
static inline msk stencil_depth_test(struct env *e, const struct pixel_key *k,
                                     const struct pixel_position *at, const struct triangle_layout *layout,
                                     int writes, msk live)
{
    if (pixel_stencil(k)) {
        itg word = load_i(E, BASE_DEPTH, sample_word(at));
        itg stored = and_i(E, word, lit_i(E, 255));
        live = stencil_test(E, k, stored, live);
        OBSERVE(E, stencil, at->sample, live);
    }
    return depth_test(E, k, at, layout, writes, live);
}

/* The tests before shading. They write their results unless the tests must wait for shading. Returns the
 * lanes that are still live. */
static inline msk early_tests(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                              const struct triangle_layout *layout, msk live)
{
    if (k->depth_output || k->late || (pixel_writes_stencil(k) && pixel_waits(k)))
        return live;
    if (pixel_writes_stencil(k))
        return stencil_depth_write(E, k, at, layout, live);
    return stencil_depth_test(E, k, at, layout, k->depth_write && !pixel_waits(k), live);
}

/* The tests after shading. A pixel that shading discards changes no stencil, so if the stencil is written,
 * all tests wait for shading. They also wait if the key specifies it, for measurements. */
static inline msk late_tests(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                             const struct triangle_layout *layout, msk kept)
{
    if (pixel_writes_stencil(k))
        return stencil_depth_write(E, k, at, layout, kept);
    if (k->depth_output || k->late)
        return stencil_depth_test(E, k, at, layout, k->depth_write, kept);
    if (k->depth_write)
        depth_write_late(E, k, at, layout, kept);
    return kept;
}

#endif
