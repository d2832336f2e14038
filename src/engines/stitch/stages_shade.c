/* Pixel stages, the colour: diffuse, texture samples, texture stages. */
#include "engines/stitch/stages.h"

static void plan_diffuse(struct plan *plan, const struct pixel_key *key, const struct triangle_layout *layout)
{
    static const struct fragment *const diffuse[INTERPOLATION_COUNT] = {
        &fragment_diffuse_white, &fragment_diffuse_smooth, &fragment_diffuse_flat};
    plan_append(plan, diffuse[key->varying[VARYING_diffuse]],
                (union arguments){.diffuse_smooth = {.planes = layout->varying[VARYING_diffuse]}});
}

#define TEXTURE(field) (int32_t) offsetof(struct texture_job, field)
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

/* `texture` is the texture's offset in the job. */
static void plan_across(struct plan *plan, int32_t texture, const struct fragment *fragment)
{
    int32_t last = fragment == &fragment_across_clamp_pair ? TEXTURE(last_u_256) : TEXTURE(last_u);
    plan_append(plan, fragment,
                (union arguments){.across_wrap_point = {.size_256 = texture + TEXTURE(width_256),
                                                        .last = texture + last,
                                                        .size = texture + TEXTURE(width)}});
}

static void plan_down(struct plan *plan, int32_t texture, const struct fragment *fragment)
{
    plan_append(plan, fragment,
                (union arguments){.down_wrap_point = {.size_256 = texture + TEXTURE(height_256),
                                                      .last = texture + TEXTURE(last_v),
                                                      .size = texture + TEXTURE(height)}});
}

/* The first columns of pairs where linear filtering can load both columns of a row together; else null. */
static const struct fragment *pair_columns(const struct pixel_key *key, int stage)
{
    if (key->filter[stage] != FILTER_LINEAR || key->address_v[stage] == ADDRESS_BORDER)
        return NULL;
    switch (key->address_u[stage]) {
    case ADDRESS_CLAMP: return &fragment_across_clamp_pair;
    case ADDRESS_WRAP_POWER: return &fragment_across_power_pair;
    default: return NULL;
    }
}

static void plan_sample(struct plan *plan, const struct pixel_key *key, int stage)
{
    static const struct fragment *const sample[2][FILTER_COUNT] = {
        {&fragment_sample_point, &fragment_sample_bilinear},
        {&fragment_sample_point_border, &fragment_sample_bilinear_border}};
    const int32_t texture = JOB(texture) + stage * (int32_t)sizeof(struct texture_job);
    const int u = key->address_u[stage], v = key->address_v[stage], filter = key->filter[stage];
    const bool border = u == ADDRESS_BORDER || v == ADDRESS_BORDER;
    const struct fragment *pair = pair_columns(key, stage);
    plan_across(plan, texture, pair ? pair : across[u][filter]);
    plan_down(plan, texture, down[v][filter]);
    plan_append(plan, pair ? &fragment_sample_bilinear_pair : sample[border][filter],
                (union arguments){.sample_point_border = {.texels = texture + TEXTURE(texels),
                                                          .pitch = texture + TEXTURE(pitch),
                                                          .last_u = texture + TEXTURE(last_u),
                                                          .last_v = texture + TEXTURE(last_v),
                                                          .border = texture + TEXTURE(border)}});
}

/* Texture coordinates that the setup routine does not write are read as planes at the start of the record,
 * as in the specification. */
static void plan_texture(struct plan *plan, const struct pixel_key *key, int stage,
                         const struct triangle_layout *layout)
{
    int texcoord = varying_texcoord(key->coordinates[stage]);
    if (!key->texture[stage]) {
        plan_append_plain(plan, &fragment_texture_white);
        return;
    }
    bool flat = key->varying[texcoord] == INTERPOLATION_FLAT;
    plan_append(plan, flat ? &fragment_texcoord_flat : &fragment_texcoord_smooth,
                (union arguments){.texcoord_smooth = {.planes = layout->varying[texcoord]}});
    plan_sample(plan, key, stage);
}

/* The location of a source: registers, or a field of the job. Diffuse and current share registers, because
 * only the first stage may read diffuse. */
enum origin { ORIGIN_CURRENT, ORIGIN_TEXTURE, ORIGIN_FIELD, ORIGIN_COUNT };

static enum origin origin_of(unsigned argument)
{
    switch (argument % SOURCE_COUNT) {
    case SOURCE_DIFFUSE:
    case SOURCE_CURRENT: return ORIGIN_CURRENT;
    case SOURCE_TEXTURE: return ORIGIN_TEXTURE;
    default: return ORIGIN_FIELD;
    }
}

static void plan_argument(struct plan *plan, int stage, int which, unsigned argument)
{
#define FORMS(which)                                                                                         \
    {                                                                                                        \
        &fragment_##which##_diffuse, &fragment_##which##_texture, &fragment_##which##_factor,                \
            &fragment_##which##_replicate, &fragment_##which##_complement                                    \
    }
    static const struct fragment *const form[STAGE_ARGUMENTS][ORIGIN_COUNT + 2] = {
        FORMS(first), FORMS(second), FORMS(third)};
#undef FORMS
    int32_t constant = JOB(stage_constant) + stage * (int32_t)sizeof(uint32_t);
    plan_append(
        plan, form[which][origin_of(argument)],
        (union arguments){.first_factor = {.texture_factor = argument % SOURCE_COUNT == SOURCE_CONSTANT
                                                                 ? constant
                                                                 : JOB(texture_factor)}});
    if (argument / ARGUMENT_REPLICATE & 1)
        plan_append_plain(plan, form[which][ORIGIN_COUNT]);
    if (argument / ARGUMENT_COMPLEMENT)
        plan_append_plain(plan, form[which][ORIGIN_COUNT + 1]);
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
        plan_append_plain(plan, combine[operation]);
}

static bool argument_is(unsigned argument, enum origin origin)
{
    return argument < ARGUMENT_REPLICATE && origin_of(argument) == origin;
}

/* The fragment for a frequent operation on all four channels, or null. */
static const struct fragment *common_stage(const struct pixel_key *key, int stage)
{
    const uint8_t *argument = color_arguments(key, stage);
    bool both = (argument_is(argument[0], ORIGIN_TEXTURE) && argument_is(argument[1], ORIGIN_CURRENT)) ||
                (argument_is(argument[0], ORIGIN_CURRENT) && argument_is(argument[1], ORIGIN_TEXTURE));
    if (key->color_stage[stage] == STAGE_SELECT && argument_is(argument[0], ORIGIN_TEXTURE))
        return &fragment_stage_replace;
    if (key->color_stage[stage] == STAGE_MODULATE && both)
        return &fragment_stage_modulate;
    return key->color_stage[stage] == STAGE_ADD && both ? &fragment_stage_add : NULL;
}

static void plan_stage(struct plan *plan, const struct pixel_key *key, int stage)
{
    bool joint = stage_is_joint(key, stage);
    const uint8_t *color = color_arguments(key, stage), *alpha = alpha_arguments(key, stage);
    const struct fragment *common = joint ? common_stage(key, stage) : NULL;
    if (common) {
        plan_append_plain(plan, common);
        return;
    }
    if (joint && key->color_stage[stage] == STAGE_SELECT && argument_is(color[0], ORIGIN_CURRENT))
        return;
    plan_half_stage(plan, stage, key->color_stage[stage], color);
    if (joint) {
        plan_append_plain(plan, &fragment_stage_result);
        return;
    }
    plan_append_plain(plan, &fragment_stage_keep_color);
    plan_half_stage(plan, stage, key->alpha_stage[stage], alpha);
    plan_append_plain(plan, &fragment_stage_join_alpha);
}

/* Computes position and w again for the second and later textures, because stages overwrite their
 * registers. */
static void plan_stage_texture(struct plan *plan, const struct pixel_key *key, int stage,
                               const struct triangle_layout *layout)
{
    int texcoord = varying_texcoord(key->coordinates[stage]);
    if (stage && key->texture[stage]) {
        stages_position(plan);
        if (layout->smooth)
            plan_append(plan, &fragment_pixel_w,
                        (union arguments){.pixel_w = {.plane = layout->reciprocal_w}});
    }
    if (!layout->smooth && key->texture[stage] && key->varying[texcoord] == INTERPOLATION_NONE)
        plan_append_plain(plan, &fragment_pixel_w_one);
    plan_texture(plan, key, stage, layout);
}

void stages_shade(struct plan *plan, const struct pixel_key *key, const struct triangle_layout *layout)
{
    if (layout->smooth)
        plan_append(plan, &fragment_pixel_w, (union arguments){.pixel_w = {.plane = layout->reciprocal_w}});
    if (!key->stages || stage_reads(key, 0, SOURCE_DIFFUSE) || stage_reads(key, 0, SOURCE_CURRENT))
        plan_diffuse(plan, key, layout);
    for (int i = 0; i < key->stages; i++) {
        if (stage_reads(key, i, SOURCE_TEXTURE))
            plan_stage_texture(plan, key, i, layout);
        plan_stage(plan, key, i);
    }
}
