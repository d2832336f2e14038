/* The pixel key: which tests, values and channels the pixel routine has, in the order that lets each rule out
 * what follows. */
#include "draw/derive_part.h"

#include <string.h>

/* EQUAL never changes the stored depth: both are clamped to 0..1 without denormals or -0, so equal means the
 * same bits. NEVER changes nothing at all. */
void derive_depth(const struct state *state, struct pixel_key *key)
{
    key->depth_function = COMPARE_ALWAYS;
    if (!GET(zenable))
        return;
    key->depth_function = (uint8_t)(GET(zfunc) - COMPARE_never);
    key->depth_write = GET(zwriteenable) && key->depth_function != COMPARE_EQUAL;
}

/* What the test discards is the opposite of what it keeps. */
static uint8_t derive_alpha_discard(const struct state *state)
{
    return GET(alphatestenable) ? (uint8_t)(COMPARE_always - GET(alphafunc)) : COMPARE_NEVER;
}

void derive_pixel(const struct state *state, struct pixel_key *key)
{
    derive_depth(state, key);
    key->write_mask = (uint8_t)GET(colorwriteenable);
    key->alpha_discard = derive_alpha_discard(state);
    derive_blend(state, key);
    if (key->depth_function == COMPARE_NEVER || key->alpha_discard == COMPARE_ALWAYS)
        key->depth_write = key->write_mask = 0;
    if (!derive_effective(key)) { /* one key for all that draw nothing */
        key->depth_function = COMPARE_ALWAYS;
        key->alpha_discard = COMPARE_NEVER;
    }
    if (!key->write_mask)
        derive_no_blend(key);
    if (!pixel_shades(key))
        return;
    derive_stage(state, key);
    if (!key->write_mask && key->color_stage != STAGE_DOT) { /* alpha alone is looked at */
        key->color_stage = key->alpha_stage;
        memcpy(key->color_argument, key->alpha_argument, sizeof key->color_argument);
    }
    derive_texture(state, key);
    if (key->texture)
        key->varying[VARYING_texcoord] = INTERPOLATION_SMOOTH;
    if (stage_reads(key, SOURCE_DIFFUSE))
        key->varying[VARYING_diffuse] =
            GET(shademode) == SHADEMODE_flat ? INTERPOLATION_FLAT : INTERPOLATION_SMOOTH;
}
