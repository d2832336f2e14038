/* Pixel stages, the target: blending and the write. */
#include "engines/stitch/stages.h"

/* The fragment that does the whole blending, or null. */
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
    const union arguments constant = {.source_constant = {.constant = JOB(blend_constant)}};
    if (source > FACTOR_ONE)
        plan_append(plan, sources[source], constant);
    if (target > FACTOR_ONE)
        plan_append(plan, targets[target], constant);
    if (source == FACTOR_ZERO)
        plan_append_plain(plan, sources[source]);
    if (target == FACTOR_ZERO)
        plan_append_plain(plan, targets[target]);
}

/* Blends all channels with the factors and the operation of colour or of alpha. */
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
        plan_append_plain(plan, &fragment_blend_lerp);
        return;
    }
    if (source > FACTOR_ONE)
        plan_append_plain(plan, &fragment_source_product);
    if (target > FACTOR_ONE)
        plan_append_plain(plan, &fragment_target_product);
    plan_append_plain(plan, operation[blend]);
}

static void plan_blend(struct plan *plan, const struct pixel_key *key)
{
    const struct fragment *special = special_blend(key);
    bool separate = blend_is_separate(key);
    if (special) {
        plan_append_plain(plan, special);
        return;
    }
    if (key->blend[BLEND_COLOR] == BLEND_COPY && !separate)
        return;
    plan_append_plain(plan, &fragment_blend_stored);
    if (separate)
        plan_append_plain(plan, &fragment_alpha_keep);
    plan_blend_channels(plan, key, BLEND_COLOR);
    if (!separate)
        return;
    plan_append_plain(plan, &fragment_alpha_again);
    plan_blend_channels(plan, key, BLEND_ALPHA);
    plan_append_plain(plan, &fragment_alpha_merge);
}

void stages_target(struct plan *plan, const struct pixel_key *key)
{
    plan_append_plain(plan, &fragment_stored_color);
    plan_blend(plan, key);
    if (key->write_mask[0] == 15) {
        plan_append_plain(plan, &fragment_write_all);
        return;
    }
    uint32_t word = 0;
    for (int channel = 0; channel < 4; channel++)
        word |= (key->write_mask[0] >> channel & 1) * (255u << 8 * channel);
    plan_append(plan, &fragment_write_masked, (union arguments){.write_masked = {.value = (int32_t)word}});
}
