/* Pixel stages: position, coverage, depth, the alpha test, and the order of all stages. */
#include "engines/stitch/stages.h"

void stages_position(struct plan *plan)
{
    const union arguments arguments = {.position = {.entry_x = offsetof(struct entry, x),
                                                    .entry_y = offsetof(struct entry, y),
                                                    .origin_x = offsetof(struct triangle_head, origin_x),
                                                    .origin_y = offsetof(struct triangle_head, origin_y),
                                                    .lane_x = offsetof(struct lane_table, x),
                                                    .lane_y = offsetof(struct lane_table, y)}};
    plan_append(plan, &fragment_position, arguments);
}

static void plan_coverage(struct plan *plan)
{
    plan_append(plan, &fragment_coverage,
                (union arguments){.coverage = {.coverage = offsetof(struct entry, coverage),
                                               .bit = offsetof(struct lane_table, bit)}});
}

static void plan_new_depth(struct plan *plan, const struct pixel_key *key,
                           const struct triangle_layout *layout)
{
    if (key->depth_format == DEPTH_UNORM)
        plan_append(plan, &fragment_depth_new_unorm,
                    (union arguments){
                        .depth_new_unorm = {.plane = layout->depth, .depth_maximum = JOB(depth_maximum)}});
    else
        plan_append(plan, &fragment_depth_new, (union arguments){.depth_new = {.plane = layout->depth}});
}

static void plan_depth_compare(struct plan *plan, const struct pixel_key *key)
{
    /* VCMPPS predicates: quiet, and ordered except for "not equal". */
    static const uint8_t predicate[COMPARE_COUNT] = {
        [COMPARE_NEVER] = 0x0b,        [COMPARE_LESS] = 0x11,    [COMPARE_EQUAL] = 0x00,
        [COMPARE_LESS_EQUAL] = 0x12,   [COMPARE_GREATER] = 0x1e, [COMPARE_NOT_EQUAL] = 0x04,
        [COMPARE_GREATER_EQUAL] = 0x1d};
    static const struct fragment *const integer[COMPARE_COUNT] = {
        [COMPARE_NEVER] = &fragment_alpha_never,
        [COMPARE_LESS] = &fragment_depth_less_unorm,
        [COMPARE_EQUAL] = &fragment_depth_equal_unorm,
        [COMPARE_LESS_EQUAL] = &fragment_depth_less_equal_unorm,
        [COMPARE_GREATER] = &fragment_depth_greater_unorm,
        [COMPARE_NOT_EQUAL] = &fragment_depth_not_equal_unorm,
        [COMPARE_GREATER_EQUAL] = &fragment_depth_greater_equal_unorm};
    if (key->depth_format == DEPTH_UNORM)
        plan_append_plain(plan, integer[key->depth_function]);
    else
        plan_append(plan, &fragment_depth_compare,
                    (union arguments){.depth_compare = {.predicate = predicate[key->depth_function]}});
}

static void plan_depth_write(struct plan *plan, const struct pixel_key *key)
{
    bool integer = key->depth_format == DEPTH_UNORM;
    plan_append_plain(plan, integer ? &fragment_depth_write_unorm : &fragment_depth_write);
}

/* Returns the part that skips to the end of the chunk, or 0. */
static unsigned plan_depth(struct plan *plan, const struct pixel_key *key,
                           const struct triangle_layout *layout)
{
    unsigned skip = 0;
    bool writes = key->depth_write && !key->alpha_discard;
    if (key->depth_function == COMPARE_ALWAYS && !writes)
        return 0;
    plan_new_depth(plan, key, layout);
    if (key->depth_function != COMPARE_ALWAYS) {
        plan_depth_compare(plan, key);
        skip = plan_append_plain(plan, &fragment_live_skip);
    }
    if (writes)
        plan_depth_write(plan, key);
    return skip;
}

/* The alpha test and the depth write after it. Returns the same as plan_depth(). Position and depth are
 * computed again, because shading uses their registers. */
static unsigned plan_alpha_test(struct plan *plan, const struct pixel_key *key,
                                const struct triangle_layout *layout)
{
    static const struct fragment *const discard[COMPARE_COUNT] = {
        [COMPARE_LESS] = &fragment_alpha_greater_equal, [COMPARE_EQUAL] = &fragment_alpha_not_equal,
        [COMPARE_LESS_EQUAL] = &fragment_alpha_greater, [COMPARE_GREATER] = &fragment_alpha_less_equal,
        [COMPARE_NOT_EQUAL] = &fragment_alpha_equal,    [COMPARE_GREATER_EQUAL] = &fragment_alpha_less,
        [COMPARE_ALWAYS] = &fragment_alpha_never};
    if (!key->alpha_discard)
        return 0;
    plan_append(plan, discard[key->alpha_discard],
                (union arguments){.alpha_less = {.reference = JOB(alpha_reference)}});
    unsigned skip = plan_append_plain(plan, &fragment_live_skip);
    if (key->depth_write) {
        stages_position(plan);
        plan_new_depth(plan, key, layout);
        plan_depth_write(plan, key);
    }
    return skip;
}

void stages_pixel(struct plan *plan, const union key *all)
{
    const struct pixel_key *key = &all->pixel;
    struct triangle_layout layout = layout_of_pixel(key);
    plan_enter(plan);
    plan_append_plain(plan, &fragment_pixel_constants);
    struct loop loop = plan_begin(plan, UNIT_PIXEL);
    stages_position(plan);
    plan_coverage(plan);
    unsigned skip[2] = {plan_depth(plan, key, &layout)};
    if (pixel_shades(key)) {
        stages_shade(plan, key, &layout);
        skip[1] = plan_alpha_test(plan, key, &layout);
    }
    if (key->write_mask[0])
        stages_target(plan, key);
    for (int i = 0; i < 2; i++)
        if (skip[i])
            plan_land(plan, skip[i], ARGUMENT(live_skip, to_next));
    plan_leave(plan, UNIT_PIXEL, all, &loop, 0);
}
