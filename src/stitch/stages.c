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
}

static void plan_coverage(struct plan *plan)
{
    plan_append(plan, &fragment_coverage,
                ARGUMENTS(offsetof(struct entry, coverage), offsetof(struct lane_table, bit)));
}

static void plan_new_depth(struct plan *plan, const struct pixel_key *key,
                           const struct triangle_layout *layout)
{
    if (key->depth_format == DEPTH_UNORM)
        plan_append(plan, &fragment_depth_new_unorm, ARGUMENTS(layout->depth, JOB(depth_maximum)));
    else
        plan_append(plan, &fragment_depth_new, ARGUMENTS(layout->depth));
}

static void plan_depth_compare(struct plan *plan, const struct pixel_key *key)
{
    /* VCMPPS predicates, quiet; ordered but for the complement of equal. */
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
        plan_append(plan, integer[key->depth_function], NONE);
    else
        plan_append(plan, &fragment_depth_compare, ARGUMENTS(predicate[key->depth_function]));
}

static void plan_depth_write(struct plan *plan, const struct pixel_key *key)
{
    int integer = key->depth_format == DEPTH_UNORM;
    plan_append(plan, integer ? &fragment_depth_write_unorm : &fragment_depth_write, NONE);
}

/* Returns the part that skips to the chunk's end, 0 if there is none. */
static unsigned plan_depth(struct plan *plan, const struct pixel_key *key,
                           const struct triangle_layout *layout)
{
    unsigned skip = 0;
    int writes = key->depth_write && !key->alpha_discard;
    if (key->depth_function == COMPARE_ALWAYS && !writes)
        return 0;
    plan_new_depth(plan, key, layout);
    if (key->depth_function != COMPARE_ALWAYS) {
        plan_depth_compare(plan, key);
        skip = plan_append(plan, &fragment_live_skip, NONE);
    }
    if (writes)
        plan_depth_write(plan, key);
    return skip;
}

/* The test, and the depth write that waited for it; returns as plan_depth does. Position and
 * depth are computed again: no register keeps them through shading. */
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
    plan_append(plan, discard[key->alpha_discard], ARGUMENTS(JOB(alpha_reference)));
    unsigned skip = plan_append(plan, &fragment_live_skip, NONE);
    if (key->depth_write) {
        plan_position(plan);
        plan_new_depth(plan, key, layout);
        plan_depth_write(plan, key);
    }
    return skip;
}

static void plan_diffuse(struct plan *plan, const struct pixel_key *key, const struct triangle_layout *layout)
{
    static const struct fragment *const diffuse[INTERPOLATION_COUNT] = {
        &fragment_diffuse_white, &fragment_diffuse_smooth, &fragment_diffuse_flat};
    plan_append(plan, diffuse[key->varying[VARYING_diffuse]], ARGUMENTS(layout->varying[VARYING_diffuse]));
}

static void plan_sample(struct plan *plan, const struct pixel_key *key, int stage)
{
#define TEXTURE(field)                                                                                       \
    (JOB(texture) + stage * (int32_t)sizeof(struct texture_job) +                                            \
     (int32_t)offsetof(struct texture_job, field))
#define MODES(axis)                                                                                          \
    {                                                                                                        \
        [ADDRESS_WRAP] = {&fragment_##axis##_wrap_point, &fragment_##axis##_wrap_linear},                    \
        [ADDRESS_WRAP_POWER] = {&fragment_##axis##_power_point, &fragment_##axis##_power_linear},            \
        [ADDRESS_CLAMP] = {&fragment_##axis##_clamp_point, &fragment_##axis##_clamp_linear},                 \
        [ADDRESS_MIRROR] = {&fragment_##axis##_mirror_point, &fragment_##axis##_mirror_linear},              \
        [ADDRESS_MIRROR_POWER] = {&fragment_##axis##_mirror_power_point,                                     \
                                  &fragment_##axis##_mirror_power_linear},                                   \
        [ADDRESS_MIRROR_ONCE] = {&fragment_##axis##_mirror_once_point,                                       \
                                 &fragment_##axis##_mirror_once_linear},                                     \
        [ADDRESS_BORDER] = {&fragment_##axis##_border_point, &fragment_##axis##_border_linear},              \
    }
    static const struct fragment *const across[ADDRESS_COUNT][FILTER_COUNT] = MODES(across);
    static const struct fragment *const down[ADDRESS_COUNT][FILTER_COUNT] = MODES(down);
#undef MODES
    static const struct fragment *const sample[2][FILTER_COUNT] = {
        {&fragment_sample_point, &fragment_sample_bilinear},
        {&fragment_sample_point_border, &fragment_sample_bilinear_border}};
    int border = key->address_u[stage] == ADDRESS_BORDER || key->address_v[stage] == ADDRESS_BORDER;
    int linear = key->filter[stage] == FILTER_LINEAR, u = key->address_u[stage];
    const struct fragment *taps = sample[border][key->filter[stage]];
    if (linear && !border && (u == ADDRESS_CLAMP || u == ADDRESS_WRAP_POWER)) {
        taps = &fragment_sample_bilinear_pair;
        if (u == ADDRESS_CLAMP)
            plan_append(plan, &fragment_across_clamp_pair,
                        ARGUMENTS(TEXTURE(width_256), TEXTURE(last_u_256)));
        else
            plan_append(plan, &fragment_across_power_pair, ARGUMENTS(TEXTURE(width_256), TEXTURE(last_u)));
    } else {
        plan_append(plan, across[u][key->filter[stage]],
                    ARGUMENTS(TEXTURE(width_256), TEXTURE(last_u), TEXTURE(width)));
    }
    plan_append(plan, down[key->address_v[stage]][key->filter[stage]],
                ARGUMENTS(TEXTURE(height_256), TEXTURE(last_v), TEXTURE(height)));
    plan_append(
        plan, taps,
        ARGUMENTS(TEXTURE(texels), TEXTURE(pitch), TEXTURE(last_u), TEXTURE(last_v), TEXTURE(border)));
#undef TEXTURE
}

/* Texture coordinates that no setup routine provides are read as planes at the record's start, as the spec
 * does. */
static void plan_texture(struct plan *plan, const struct pixel_key *key, int stage,
                         const struct triangle_layout *layout)
{
    int texcoord = varying_texcoord(key->coordinates[stage]);
    if (!key->texture[stage]) {
        plan_append(plan, &fragment_texture_white, NONE);
        return;
    }
    int flat = key->varying[texcoord] == INTERPOLATION_FLAT;
    plan_append(plan, flat ? &fragment_texcoord_flat : &fragment_texcoord_smooth,
                ARGUMENTS(layout->varying[texcoord]));
    plan_sample(plan, key, stage);
}

/* The registers or the job's field that a source is read from: diffuse and current share theirs, for only the
 * first stage may read diffuse. */
enum place { PLACE_CURRENT, PLACE_TEXTURE, PLACE_FIELD, PLACE_COUNT };

static enum place place_of(unsigned argument)
{
    switch (argument % SOURCE_COUNT) {
    case SOURCE_DIFFUSE:
    case SOURCE_CURRENT: return PLACE_CURRENT;
    case SOURCE_TEXTURE: return PLACE_TEXTURE;
    default: return PLACE_FIELD;
    }
}

static void plan_argument(struct plan *plan, int stage, int which, unsigned argument)
{
#define FORMS(which)                                                                                         \
    {                                                                                                        \
        &fragment_##which##_diffuse, &fragment_##which##_texture, &fragment_##which##_factor,                \
            &fragment_##which##_replicate, &fragment_##which##_complement                                    \
    }
    static const struct fragment *const form[STAGE_ARGUMENTS][PLACE_COUNT + 2] = {FORMS(first), FORMS(second),
                                                                                  FORMS(third)};
#undef FORMS
    int32_t constant = JOB(stage_constant) + stage * (int32_t)sizeof(uint32_t);
    plan_append(plan, form[which][place_of(argument)],
                ARGUMENTS(argument % SOURCE_COUNT == SOURCE_CONSTANT ? constant : JOB(texture_factor)));
    if (argument / ARGUMENT_REPLICATE & 1)
        plan_append(plan, form[which][PLACE_COUNT], NONE);
    if (argument / ARGUMENT_COMPLEMENT)
        plan_append(plan, form[which][PLACE_COUNT + 1], NONE);
}

static void plan_half_stage(struct plan *plan, int stage, enum stage operation,
                            const uint8_t argument[STAGE_ARGUMENTS])
{
    static const struct fragment *const combine[STAGE_COUNT] = {
        [STAGE_MODULATE] = &fragment_stage_two_modulate,
        [STAGE_MODULATE_2X] = &fragment_stage_two_modulate_2x,
        [STAGE_MODULATE_4X] = &fragment_stage_two_modulate_4x,
        [STAGE_ADD] = &fragment_stage_two_add,
        [STAGE_ADD_SIGNED] = &fragment_stage_two_add_signed,
        [STAGE_ADD_SIGNED_2X] = &fragment_stage_two_add_signed_2x,
        [STAGE_SUBTRACT] = &fragment_stage_two_subtract,
        [STAGE_MULTIPLY_ADD] = &fragment_stage_multiply_add,
        [STAGE_LERP] = &fragment_stage_lerp,
        [STAGE_DOT] = &fragment_stage_dot};
    for (int i = 0; i < stage_arguments[operation]; i++)
        plan_argument(plan, stage, i, argument[i]);
    if (operation != STAGE_SELECT)
        plan_append(plan, combine[operation], NONE);
}

static int argument_is(unsigned argument, enum place place)
{
    return argument < ARGUMENT_REPLICATE && place_of(argument) == place;
}

/* The fragment for all four channels at once of what most draws do; null if there is none. */
static const struct fragment *common_stage(const struct pixel_key *key, int stage)
{
    const uint8_t *argument = color_arguments(key, stage);
    int both = (argument_is(argument[0], PLACE_TEXTURE) && argument_is(argument[1], PLACE_CURRENT)) ||
               (argument_is(argument[0], PLACE_CURRENT) && argument_is(argument[1], PLACE_TEXTURE));
    if (key->color_stage[stage] == STAGE_SELECT && argument_is(argument[0], PLACE_TEXTURE))
        return &fragment_stage_replace;
    if (key->color_stage[stage] == STAGE_MODULATE && both)
        return &fragment_stage_modulate;
    return key->color_stage[stage] == STAGE_ADD && both ? &fragment_stage_add : NULL;
}

static void plan_stage(struct plan *plan, const struct pixel_key *key, int stage)
{
    int joint = stage_is_joint(key, stage);
    const uint8_t *color = color_arguments(key, stage), *alpha = alpha_arguments(key, stage);
    const struct fragment *common = joint ? common_stage(key, stage) : NULL;
    if (common) {
        plan_append(plan, common, NONE);
        return;
    }
    if (joint && key->color_stage[stage] == STAGE_SELECT && argument_is(color[0], PLACE_CURRENT))
        return;
    plan_half_stage(plan, stage, key->color_stage[stage], color);
    if (joint) {
        plan_append(plan, &fragment_stage_result, NONE);
        return;
    }
    plan_append(plan, &fragment_stage_keep_color, NONE);
    plan_half_stage(plan, stage, key->alpha_stage[stage], alpha);
    plan_append(plan, &fragment_stage_join_alpha, NONE);
}

/* Position and w for the second texture and later ones: the stage before has used their registers. */
static void plan_stage_texture(struct plan *plan, const struct pixel_key *key, int stage,
                               const struct triangle_layout *layout)
{
    int texcoord = varying_texcoord(key->coordinates[stage]);
    if (stage && key->texture[stage]) {
        plan_position(plan);
        if (layout->smooth)
            plan_append(plan, &fragment_pixel_w, ARGUMENTS(layout->reciprocal_w));
    }
    if (!layout->smooth && key->texture[stage] && key->varying[texcoord] == INTERPOLATION_NONE)
        plan_append(plan, &fragment_pixel_w_one, NONE);
    plan_texture(plan, key, stage, layout);
}

static void plan_shade(struct plan *plan, const struct pixel_key *key, const struct triangle_layout *layout)
{
    if (layout->smooth)
        plan_append(plan, &fragment_pixel_w, ARGUMENTS(layout->reciprocal_w));
    if (!key->stages || stage_reads(key, 0, SOURCE_DIFFUSE) || stage_reads(key, 0, SOURCE_CURRENT))
        plan_diffuse(plan, key, layout);
    for (int i = 0; i < key->stages; i++) {
        if (stage_reads(key, i, SOURCE_TEXTURE))
            plan_stage_texture(plan, key, i, layout);
        plan_stage(plan, key, i);
    }
}

/* The blending that has a fragment of its own; null if it has none. */
static const struct fragment *special_blend(const struct pixel_key *key)
{
    static const struct {
        uint8_t source, target;
        const struct fragment *fragment;
    } special[] = {
        {FACTOR_SOURCE_ALPHA, FACTOR_INVERSE_SOURCE_ALPHA, &fragment_blend_over},
        {FACTOR_ONE, FACTOR_INVERSE_SOURCE_ALPHA, &fragment_blend_premultiplied},
        {FACTOR_SOURCE_ALPHA, FACTOR_ZERO, &fragment_blend_source},
    };
    if (key->blend[BLEND_COLOR] != BLEND_ADD || blend_is_separate(key))
        return NULL;
    for (size_t i = 0; i < sizeof special / sizeof *special; i++)
        if (special[i].source == key->source_factor[BLEND_COLOR] &&
            special[i].target == key->target_factor[BLEND_COLOR])
            return special[i].fragment;
    return NULL;
}

static void plan_factors(struct plan *plan, int source, int target)
{
#define FACTORS(side)                                                                                        \
    {                                                                                                        \
        [FACTOR_ZERO] = &fragment_##side##_zero, [FACTOR_SOURCE_COLOR] = &fragment_##side##_source_color,    \
        [FACTOR_INVERSE_SOURCE_COLOR] = &fragment_##side##_inverse_source_color,                             \
        [FACTOR_SOURCE_ALPHA] = &fragment_##side##_source_alpha,                                             \
        [FACTOR_INVERSE_SOURCE_ALPHA] = &fragment_##side##_inverse_source_alpha,                             \
        [FACTOR_TARGET_ALPHA] = &fragment_##side##_target_alpha,                                             \
        [FACTOR_INVERSE_TARGET_ALPHA] = &fragment_##side##_inverse_target_alpha,                             \
        [FACTOR_TARGET_COLOR] = &fragment_##side##_target_color,                                             \
        [FACTOR_INVERSE_TARGET_COLOR] = &fragment_##side##_inverse_target_color,                             \
        [FACTOR_CONSTANT] = &fragment_##side##_constant,                                                     \
        [FACTOR_INVERSE_CONSTANT] = &fragment_##side##_inverse_constant,                                     \
        [FACTOR_SATURATED_ALPHA] = &fragment_##side##_saturated_alpha                                        \
    }
    static const struct fragment *const sources[FACTOR_COUNT] = FACTORS(source),
                                        *const targets[FACTOR_COUNT] = FACTORS(target);
#undef FACTORS
    if (source > FACTOR_ONE)
        plan_append(plan, sources[source], ARGUMENTS(JOB(blend_constant)));
    if (target > FACTOR_ONE)
        plan_append(plan, targets[target], ARGUMENTS(JOB(blend_constant)));
    if (source == FACTOR_ZERO)
        plan_append(plan, sources[source], NONE);
    if (target == FACTOR_ZERO)
        plan_append(plan, targets[target], NONE);
}

/* All channels by the factors and the operation that the key has for one kind. */
static void plan_blend_channels(struct plan *plan, const struct pixel_key *key, int kind)
{
    static const struct fragment *const operation[BLEND_COUNT] = {[BLEND_ADD] = &fragment_blend_add,
                                                                  [BLEND_SUBTRACT] = &fragment_blend_subtract,
                                                                  [BLEND_REVERSE_SUBTRACT] =
                                                                      &fragment_blend_reverse_subtract,
                                                                  [BLEND_MINIMUM] = &fragment_blend_minimum,
                                                                  [BLEND_MAXIMUM] = &fragment_blend_maximum};
    int blend = key->blend[kind], source = key->source_factor[kind], target = key->target_factor[kind];
    if (blend == BLEND_COPY)
        return;
    if (blend == BLEND_MINIMUM || blend == BLEND_MAXIMUM)
        source = target = FACTOR_ONE;
    plan_factors(plan, source, target);
    if (blend_is_lerp(blend, source, target)) {
        plan_append(plan, &fragment_blend_lerp, NONE);
        return;
    }
    if (source > FACTOR_ONE)
        plan_append(plan, &fragment_source_product, NONE);
    if (target > FACTOR_ONE)
        plan_append(plan, &fragment_target_product, NONE);
    plan_append(plan, operation[blend], NONE);
}

static void plan_blend(struct plan *plan, const struct pixel_key *key)
{
    const struct fragment *special = special_blend(key);
    int separate = blend_is_separate(key);
    if (special) {
        plan_append(plan, special, NONE);
        return;
    }
    if (key->blend[BLEND_COLOR] == BLEND_COPY && !separate)
        return;
    plan_append(plan, &fragment_blend_stored, NONE);
    if (separate)
        plan_append(plan, &fragment_alpha_keep, NONE);
    plan_blend_channels(plan, key, BLEND_COLOR);
    if (!separate)
        return;
    plan_append(plan, &fragment_alpha_again, NONE);
    plan_blend_channels(plan, key, BLEND_ALPHA);
    plan_append(plan, &fragment_alpha_merge, NONE);
}

static void plan_target(struct plan *plan, const struct pixel_key *key)
{
    plan_append(plan, &fragment_stored_color, NONE);
    plan_blend(plan, key);
    if (key->write_mask[0] == 15) {
        plan_append(plan, &fragment_write_all, NONE);
        return;
    }
    uint32_t word = 0;
    for (int channel = 0; channel < 4; channel++)
        word |= (key->write_mask[0] >> channel & 1) * (255u << 8 * channel);
    plan_append(plan, &fragment_write_masked, ARGUMENTS((int32_t)word));
}

static void plan_pixel(struct plan *plan, const union key *all)
{
    const struct pixel_key *key = &all->pixel;
    struct triangle_layout layout = pixel_layout(key);
    plan_enter(plan);
    plan_append(plan, &fragment_pixel_constants, NONE);
    struct loop loop = plan_begin(plan, UNIT_PIXEL);
    plan_position(plan);
    plan_coverage(plan);
    unsigned skip[2] = {plan_depth(plan, key, &layout)};
    if (pixel_shades(key)) {
        plan_shade(plan, key, &layout);
        skip[1] = plan_alpha_test(plan, key, &layout);
    }
    if (key->write_mask[0])
        plan_target(plan, key);
    for (int i = 0; i < 2; i++)
        if (skip[i])
            plan_land(plan, skip[i], 0);
    plan_leave(plan, UNIT_PIXEL, all, &loop, 0);
}

/* ---- setup */

/* Bytes of the frame that one corner takes; asm/setup.asm. */
extern const uint32_t stitch_corner_bytes __attribute__((visibility("hidden")));

static_assert(JOB(offset_x) == JOB(scale_x) + 4 && JOB(scale_y) == JOB(scale_x) + 8 &&
                  JOB(offset_y) == JOB(scale_x) + 12 && JOB(depth_offset) == JOB(depth_scale) + 4,
              "the fragments' viewport");
static_assert(offsetof(struct triangle_head, visible) == 0 && offsetof(struct triangle_head, x) == 4 &&
                  offsetof(struct triangle_head, y) == 16 && offsetof(struct triangle_head, origin_x) == 28 &&
                  offsetof(struct triangle_head, origin_y) == 32,
              "the fragments' triangle head");

#define SLOT(name) (SLOT_##name * VERTEX_SLOT_BYTES)

static void plan_corner(struct plan *plan, const struct setup_key *key, int i)
{
    int32_t corner = i * (int32_t)stitch_corner_bytes;
    plan_append(plan, &fragment_project,
                ARGUMENTS(i * SETUP_INDEX_BYTES, corner, SLOT(X), SLOT(Y), SLOT(W), JOB(scale_x)));
    if (key->depth)
        plan_append(plan, &fragment_project_depth, ARGUMENTS(SLOT(Z), corner, JOB(depth_scale)));
}

static void plan_planes(struct plan *plan, const struct setup_key *key, const struct triangle_layout *layout)
{
    static const struct fragment *const depth_plane[DEPTH_BIAS_COUNT] = {
        &fragment_depth_plane, &fragment_depth_plane_bias, &fragment_depth_plane_slope};
    if (key->depth)
        plan_append(plan, depth_plane[key->depth_bias],
                    ARGUMENTS(layout->depth, JOB(depth_bias), JOB(depth_bias_slope)));
    if (layout->smooth)
        plan_append(plan, &fragment_reciprocal_w_plane, ARGUMENTS(layout->reciprocal_w));
    for (int v = 0; v < VARYING_COUNT; v++)
        for (int c = 0; c < varying_components[v] && key->varying[v] != INTERPOLATION_NONE; c++) {
            int flat = key->varying[v] == INTERPOLATION_FLAT;
            int32_t bytes = flat ? (int32_t)sizeof(float) : (int32_t)sizeof(struct plane);
            plan_append(plan, flat ? &fragment_flat_word : &fragment_smooth_plane,
                        ARGUMENTS((varying_slot[v] + c) * VERTEX_SLOT_BYTES, layout->varying[v] + c * bytes));
        }
}

static void plan_setup(struct plan *plan, const union key *all)
{
    /* VCMPPS predicates of area against 0: not equal, less, greater. */
    static const uint8_t predicate[CULL_COUNT] = {
        [CULL_NONE] = 0x04, [CULL_CLOCKWISE] = 0x11, [CULL_COUNTERCLOCKWISE] = 0x1e};
    const struct setup_key *key = &all->setup;
    struct triangle_layout layout = setup_layout(key);
    plan_enter(plan);
    plan_append(plan, &fragment_record_stride, ARGUMENTS(layout.stride));
    struct loop loop = plan_begin(plan, UNIT_SETUP);
    for (int i = 0; i < 3; i++)
        plan_corner(plan, key, i);
    plan_append(plan, &fragment_area, NONE);
    plan_append(plan, &fragment_visible, ARGUMENTS(predicate[key->cull]));
    plan_append(plan, &fragment_record_head, NONE);
    unsigned skip = plan_append(plan, &fragment_visible_skip, NONE);
    plan_append(plan, &fragment_gradients, NONE);
    plan_planes(plan, key, &layout);
    plan_land(plan, skip, 0);
    plan_leave(plan, UNIT_SETUP, all, &loop, 3 * (int)stitch_corner_bytes);
}

/* ---- vertex */

static void plan_fetch(struct plan *plan, const struct vertex_key *key, enum attribute attribute)
{
#define FORMATS(name)                                                                                        \
    {                                                                                                        \
        &fragment_##name##_none, &fragment_##name##_float1, &fragment_##name##_float2,                       \
            &fragment_##name##_float3, &fragment_##name##_float4, &fragment_##name##_color                   \
    }
    static const struct fragment *const fetch[ATTRIBUTE_COUNT][ATTRIBUTE_FORMAT_COUNT] = {
        [ATTRIBUTE_POSITION] = FORMATS(position),
        [ATTRIBUTE_NORMAL] = FORMATS(normal),
        [ATTRIBUTE_DIFFUSE] = FORMATS(diffuse),
        [ATTRIBUTE_TEXCOORD] = FORMATS(texcoord)};
#undef FORMATS
    int32_t job = JOB(attribute) + (int32_t)attribute * (int32_t)sizeof(struct attribute_job);
    plan_append(plan, fetch[attribute][key->attribute[attribute]],
                ARGUMENTS(job + (int32_t)offsetof(struct attribute_job, stride),
                          job + (int32_t)offsetof(struct attribute_job, data)));
}

static void plan_light(struct plan *plan, enum light_type type, int i)
{
#define LIGHT(field) (light + (int32_t)offsetof(struct light_job, field))
    int32_t light = JOB(light) + i * (int32_t)sizeof(struct light_job);
    if (type == LIGHT_DIRECTIONAL)
        plan_append(plan, &fragment_light_directional, ARGUMENTS(LIGHT(position), LIGHT(diffuse)));
    if (type == LIGHT_POINT)
        plan_append(plan, &fragment_light_point,
                    ARGUMENTS(LIGHT(position), LIGHT(diffuse), LIGHT(ambient), LIGHT(attenuation0),
                              LIGHT(attenuation1), LIGHT(attenuation2), LIGHT(range)));
#undef LIGHT
}

static int has_light(const struct vertex_key *key, enum light_type type)
{
    for (int i = 0; i < LIGHT_COUNT; i++)
        if (key->light[i] == type)
            return 1;
    return 0;
}

static void plan_lighting(struct plan *plan, const struct vertex_key *key)
{
    int with_w = vertex_types[key->attribute[ATTRIBUTE_POSITION]].components == 4;
    int point = has_light(key, LIGHT_POINT);
    if (point)
        plan_append(plan, with_w ? &fragment_camera_position_w : &fragment_camera_position,
                    ARGUMENTS(JOB(world_view)));
    if (point || has_light(key, LIGHT_DIRECTIONAL)) {
        plan_fetch(plan, key, ATTRIBUTE_NORMAL);
        plan_append(plan, &fragment_camera_normal, ARGUMENTS(JOB(normal)));
        if (key->normalize)
            plan_append(plan, &fragment_normalize, NONE);
    }
    plan_append(plan, &fragment_base_color, ARGUMENTS(JOB(base_color)));
    for (int i = 0; i < LIGHT_COUNT; i++)
        plan_light(plan, key->light[i], i);
}

static void plan_transform(struct plan *plan, const struct vertex_key *key)
{
    int with_w = vertex_types[key->attribute[ATTRIBUTE_POSITION]].components == 4;
    plan_fetch(plan, key, ATTRIBUTE_POSITION);
    plan_append(plan, with_w ? &fragment_clip_position_w : &fragment_clip_position,
                ARGUMENTS(JOB(world_view_projection), SLOT(X), SLOT(Y), SLOT(Z), SLOT(W)));
    plan_append(plan, &fragment_clip_code, ARGUMENTS(JOB(guard_x), JOB(guard_y), SLOT(CODE)));
    for (int i = 0; i < key->clip_planes; i++)
        plan_append(plan, &fragment_clip_plane,
                    ARGUMENTS(JOB(clip_plane) + i * (int32_t)sizeof(float[4]), __builtin_ctz(CLIP_USER) + i,
                              SLOT(CODE)));
}

static void plan_vertex(struct plan *plan, const union key *all)
{
    const struct vertex_key *key = &all->vertex;
    const int32_t diffuse = SLOT(diffuse), next = VERTEX_SLOT_BYTES;
    plan_enter(plan);
    struct loop loop = plan_begin(plan, UNIT_VERTEX);
    plan_transform(plan, key);
    if (key->varying[VARYING_diffuse]) {
        if (key->lighting)
            plan_lighting(plan, key);
        else
            plan_fetch(plan, key, ATTRIBUTE_DIFFUSE);
        plan_append(plan, &fragment_store_diffuse,
                    ARGUMENTS(diffuse, diffuse + next, diffuse + 2 * next, diffuse + 3 * next));
    }
    for (int channel = 0; channel < TEXTURE_STAGES; channel++)
        if (key->varying[varying_texcoord(channel)]) {
            int32_t texcoord = varying_slot[varying_texcoord(channel)] * VERTEX_SLOT_BYTES;
            plan_fetch(plan, key, ATTRIBUTE_TEXCOORD);
            plan_append(plan, &fragment_store_texcoord, ARGUMENTS(texcoord, texcoord + next));
        }
    plan_leave(plan, UNIT_VERTEX, all, &loop, 0);
}

void plan_stages(struct plan *plan, enum unit unit, const union key *key)
{
    static void (*const plan_unit[UNIT_COUNT])(struct plan *, const union key *) = {plan_vertex, plan_setup,
                                                                                    plan_pixel};
    plan_unit[unit](plan, key);
}
