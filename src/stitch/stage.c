/* The planner of stage granularity: which hand-tuned fragments a key needs, in the order of the spec's parts.
 *
 * Values travel from fragment to fragment in the registers that the fragments' files describe; plan_check
 * proves that the order below respects that. Results that nothing reads are not planned: an overridden
 * diffuse colour, a camera-space position without point lights. No key falls back to operation fragments. */
#include "stitch/plan.h"

#include "def/binding.h"

#define NONE           ((struct arguments){{0}})
#define JOB(field)     ((int32_t)offsetof(struct job, field))
#define ARGUMENTS(...) ((struct arguments){{__VA_ARGS__}})

/* asm/interpolate.asm and asm/setup.asm count on planes of three words in this order. */
static_assert(offsetof(struct plane, value) == 0 && offsetof(struct plane, dx) == 4 &&
                  offsetof(struct plane, dy) == 8 && sizeof(struct plane) == 12,
              "the fragments' plane");

/* ---- pixel */

static void plan_position(struct plan *plan)
{
    plan_append(plan, &fragment_position,
                ARGUMENTS(offsetof(struct entry, x), offsetof(struct entry, y),
                          offsetof(struct triangle_head, origin_x), offsetof(struct triangle_head, origin_y),
                          offsetof(struct lane_table, x), offsetof(struct lane_table, y)));
    plan_append(plan, &fragment_coverage,
                ARGUMENTS(offsetof(struct entry, coverage), offsetof(struct lane_table, bit)));
}

/* Returns the part that skips to the chunk's end, 0 if there is none. */
static unsigned plan_depth(struct plan *plan, const struct pixel_key *key,
                           const struct triangle_layout *layout)
{
    /* VCMPPS predicates, quiet; ordered but for the complement of equal. */
    static const uint8_t predicate[COMPARE_COUNT] = {
        [COMPARE_NEVER] = 0x0b,        [COMPARE_LESS] = 0x11,    [COMPARE_EQUAL] = 0x00,
        [COMPARE_LESS_EQUAL] = 0x12,   [COMPARE_GREATER] = 0x1e, [COMPARE_NOT_EQUAL] = 0x04,
        [COMPARE_GREATER_EQUAL] = 0x1d};
    unsigned skip = 0;
    if (key->depth_function == COMPARE_ALWAYS && !key->depth_write)
        return 0;
    plan_append(plan, &fragment_depth_new, ARGUMENTS(layout->depth));
    if (key->depth_function != COMPARE_ALWAYS) {
        plan_append(plan, &fragment_depth_compare, ARGUMENTS(predicate[key->depth_function]));
        skip = plan_append(plan, &fragment_live_skip, NONE);
    }
    if (key->depth_write)
        plan_append(plan, &fragment_depth_write, NONE);
    return skip;
}

static void plan_diffuse(struct plan *plan, const struct pixel_key *key, const struct triangle_layout *layout)
{
    static const struct fragment *const diffuse[INTERPOLATION_COUNT] = {
        &fragment_diffuse_white, &fragment_diffuse_smooth, &fragment_diffuse_flat};
    plan_append(plan, diffuse[key->varying[VARYING_diffuse]], ARGUMENTS(layout->varying[VARYING_diffuse]));
}

static void plan_sample(struct plan *plan, const struct pixel_key *key)
{
    static const struct fragment *const across[ADDRESS_COUNT][FILTER_COUNT] = {
        {&fragment_across_wrap_point, &fragment_across_wrap_linear},
        {&fragment_across_power_point, &fragment_across_power_linear},
        {&fragment_across_clamp_point, &fragment_across_clamp_linear}};
    static const struct fragment *const down[ADDRESS_COUNT][FILTER_COUNT] = {
        {&fragment_down_wrap_point, &fragment_down_wrap_linear},
        {&fragment_down_power_point, &fragment_down_power_linear},
        {&fragment_down_clamp_point, &fragment_down_clamp_linear}};
    static const struct fragment *const sample[FILTER_COUNT] = {&fragment_sample_point,
                                                                &fragment_sample_bilinear};
    plan_append(plan, across[key->address_u][key->filter],
                ARGUMENTS(JOB(texture.width_256), JOB(texture.last_u), JOB(texture.width)));
    plan_append(plan, down[key->address_v][key->filter],
                ARGUMENTS(JOB(texture.height_256), JOB(texture.last_v), JOB(texture.height)));
    plan_append(plan, sample[key->filter], ARGUMENTS(JOB(texture.texels), JOB(texture.width)));
}

/* Texture coordinates that no setup routine provides are read as planes at the record's start, as the spec
 * does. */
static void plan_texture(struct plan *plan, const struct pixel_key *key, const struct triangle_layout *layout)
{
    if (!key->texture) {
        plan_append(plan, &fragment_texture_white, NONE);
        return;
    }
    int flat = key->varying[VARYING_texcoord] == INTERPOLATION_FLAT;
    plan_append(plan, flat ? &fragment_texcoord_flat : &fragment_texcoord_smooth,
                ARGUMENTS(layout->varying[VARYING_texcoord]));
    plan_sample(plan, key);
}

static void plan_shade(struct plan *plan, const struct pixel_key *key, const struct triangle_layout *layout)
{
    static const struct fragment *const stage[STAGE_COUNT] = {[STAGE_REPLACE] = &fragment_stage_replace,
                                                              [STAGE_MODULATE] = &fragment_stage_modulate,
                                                              [STAGE_ADD] = &fragment_stage_add};
    if (layout->smooth)
        plan_append(plan, &fragment_pixel_w, ARGUMENTS(layout->reciprocal_w));
    else if (key->texture && key->varying[VARYING_texcoord] == INTERPOLATION_NONE)
        plan_append(plan, &fragment_pixel_w_one, NONE);
    if (key->stage != STAGE_REPLACE)
        plan_diffuse(plan, key, layout);
    if (key->stage == STAGE_DIFFUSE)
        return;
    plan_texture(plan, key, layout);
    plan_append(plan, stage[key->stage], NONE);
}

static void plan_target(struct plan *plan, const struct pixel_key *key)
{
    static const struct fragment *const blend[BLEND_COUNT] = {[BLEND_OVER] = &fragment_blend_over,
                                                              [BLEND_PREMULTIPLIED] =
                                                                  &fragment_blend_premultiplied,
                                                              [BLEND_SOURCE] = &fragment_blend_source};
    plan_append(plan, &fragment_stored_color, NONE);
    if (key->blend != BLEND_COPY)
        plan_append(plan, blend[key->blend], NONE);
    if (key->write_mask == 15) {
        plan_append(plan, &fragment_write_all, NONE);
        return;
    }
    uint32_t word = 0;
    for (int channel = 0; channel < 4; channel++)
        word |= (key->write_mask >> channel & 1) * (255u << 8 * channel);
    plan_append(plan, &fragment_write_masked, ARGUMENTS((int32_t)word));
}

static void plan_pixel(struct plan *plan, const union key *all)
{
    const struct pixel_key *key = &all->pixel;
    int reads_depth = key->depth_function != COMPARE_ALWAYS || key->depth_write;
    struct triangle_layout layout = triangle_layout(reads_depth, key->varying);
    struct loop loop = plan_enter(plan, UNIT_PIXEL, &fragment_pixel_constants);
    plan_position(plan);
    unsigned skip = plan_depth(plan, key, &layout);
    if (key->write_mask) {
        plan_shade(plan, key, &layout);
        plan_target(plan, key);
    }
    if (skip)
        plan_land(plan, skip, 0);
    plan_leave(plan, UNIT_PIXEL, all, &loop, 0);
}

void plan_stages(struct plan *plan, enum unit unit, const union key *key)
{
    if (unit == UNIT_PIXEL)
        plan_pixel(plan, key);
    else
        plan_operations(plan, unit, key);
}
