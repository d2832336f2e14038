/* Setup stages: corners, area and culling, triangle records. */
#include "engines/stitch/stages.h"

/* asm/stitch/interpolate.asm and asm/stitch/setup.asm rely on this order of the words of a plane. */
static_assert(offsetof(struct plane, value) == 0 && offsetof(struct plane, dx) == 4 &&
                  offsetof(struct plane, dy) == 8 && sizeof(struct plane) == 12,
              "the fragments' plane");

/* The bytes of one corner in the stack frame (asm/stitch/setup.asm). */
extern const uint32_t stitch_corner_bytes __attribute__((visibility("hidden")));

static_assert(JOB(offset_x) == JOB(scale_x) + 4 && JOB(scale_y) == JOB(scale_x) + 8 &&
                  JOB(offset_y) == JOB(scale_x) + 12 && JOB(depth_offset) == JOB(depth_scale) + 4,
              "the fragments' viewport");
static_assert(offsetof(struct triangle_head, visible) == 0 && offsetof(struct triangle_head, x) == 4 &&
                  offsetof(struct triangle_head, y) == 16 && offsetof(struct triangle_head, origin_x) == 28 &&
                  offsetof(struct triangle_head, origin_y) == 32,
              "the fragments' triangle head");

static void plan_corner(struct plan *plan, const struct setup_key *key, int i)
{
    int32_t corner = i * (int32_t)stitch_corner_bytes;
    plan_append(plan, &fragment_project,
                (union arguments){.project = {.row = i * SETUP_INDEX_BYTES,
                                              .corner = corner,
                                              .x = SLOT(X),
                                              .y = SLOT(Y),
                                              .w = SLOT(W),
                                              .viewport = JOB(scale_x)}});
    if (key->depth)
        plan_append(plan, &fragment_project_depth,
                    (union arguments){
                        .project_depth = {.z = SLOT(Z), .corner = corner, .depth_scale = JOB(depth_scale)}});
}

static void plan_planes(struct plan *plan, const struct setup_key *key, const struct triangle_layout *layout)
{
    static const struct fragment *const depth_plane[DEPTH_BIAS_COUNT] = {
        &fragment_depth_plane, &fragment_depth_plane_bias, &fragment_depth_plane_slope};
    if (key->depth)
        plan_append(plan, depth_plane[key->depth_bias],
                    (union arguments){.depth_plane_slope = {.plane = layout->depth,
                                                            .bias = JOB(depth_bias),
                                                            .slope = JOB(depth_bias_slope)}});
    if (layout->smooth)
        plan_append(plan, &fragment_reciprocal_w_plane,
                    (union arguments){.pixel_w = {.plane = layout->reciprocal_w}});
    for (int v = 0; v < VARYING_COUNT; v++)
        for (int c = 0; c < varying_components[v] && key->varying[v] != INTERPOLATION_NONE; c++) {
            bool flat = key->varying[v] == INTERPOLATION_FLAT;
            int32_t bytes = flat ? (int32_t)sizeof(float) : (int32_t)sizeof(struct plane);
            plan_append(plan, flat ? &fragment_flat_word : &fragment_smooth_plane,
                        (union arguments){.smooth_plane = {.slot = (varying_slot[v] + c) * VERTEX_SLOT_BYTES,
                                                           .plane = layout->varying[v] + c * bytes}});
        }
}

void stages_setup(struct plan *plan, const union key *all)
{
    /* VCMPPS predicates of area against 0: not equal, less, greater. */
    static const uint8_t predicate[CULL_COUNT] = {
        [CULL_NONE] = 0x04, [CULL_CLOCKWISE] = 0x11, [CULL_COUNTERCLOCKWISE] = 0x1e};
    const struct setup_key *key = &all->setup;
    struct triangle_layout layout = layout_of_setup(key);
    plan_enter(plan);
    plan_append(plan, &fragment_record_stride, (union arguments){.record_stride = {.bytes = layout.stride}});
    struct loop loop = plan_begin(plan, UNIT_SETUP);
    for (int i = 0; i < 3; i++)
        plan_corner(plan, key, i);
    plan_append_plain(plan, &fragment_area);
    plan_append(plan, &fragment_visible, (union arguments){.visible = {.predicate = predicate[key->cull]}});
    plan_append_plain(plan, &fragment_record_head);
    unsigned skip = plan_append_plain(plan, &fragment_visible_skip);
    plan_append_plain(plan, &fragment_gradients);
    plan_planes(plan, key, &layout);
    plan_land(plan, skip, ARGUMENT(visible_skip, to_next));
    plan_leave(plan, UNIT_SETUP, all, &loop, 3 * (int)stitch_corner_bytes);
}
