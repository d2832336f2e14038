/* Texture stages: Direct3D 9's 26 operations reduced to the 11 of spec/stage.h. */
#include "draw/derive_part.h"

#include <string.h>

/* One half of stage 0 as the state has it: an operation of Direct3D 9 and arguments 1, 2 and 0. */
struct half_stage {
    uint32_t operation;
    uint32_t argument[STAGE_ARGUMENTS];
};

enum { COMPLEMENT = ARGUMENT_diffuse_complement, REPLICATE = ARGUMENT_diffuse_alphareplicate };

/* What current is in the first stage: diffuse. */
static uint8_t derive_argument(uint32_t argument)
{
    static const uint8_t source[4] = {[ARGUMENT_diffuse] = SOURCE_DIFFUSE,
                                      [ARGUMENT_current] = SOURCE_DIFFUSE,
                                      [ARGUMENT_texture] = SOURCE_TEXTURE,
                                      [ARGUMENT_tfactor] = SOURCE_FACTOR};
    unsigned flags =
        (argument & COMPLEMENT ? ARGUMENT_COMPLEMENT : 0) + (argument & REPLICATE ? ARGUMENT_REPLICATE : 0);
    return (uint8_t)(source[argument & ARGUMENT_tfactor] + flags);
}

/* Where an argument of a reduced operation comes from: argument 1, 2 or 0 of the state, or a source; with
 * REPLICATE to be set, COMPLEMENT to be turned. */
enum { FIRST, SECOND, THIRD, DIFFUSE, CURRENT, TEXTURE, FACTOR, ORIGIN = 7 };

/* Operations that are others with particular arguments: blends are interpolations by an alpha, and all that
 * end in an addition of a product are one. ADDSMOOTH, a + b - a * b, is a + (1 - a) * b, and rounds alike. */
static const struct reduction {
    uint8_t stage;
    uint8_t argument[STAGE_ARGUMENTS];
} reductions[] = {
    [TEXTUREOP_disable] = {STAGE_SELECT, {CURRENT}},
    [TEXTUREOP_selectarg1] = {STAGE_SELECT, {FIRST}},
    [TEXTUREOP_selectarg2] = {STAGE_SELECT, {SECOND}},
    [TEXTUREOP_modulate] = {STAGE_MODULATE, {FIRST, SECOND}},
    [TEXTUREOP_modulate2x] = {STAGE_MODULATE_2X, {FIRST, SECOND}},
    [TEXTUREOP_modulate4x] = {STAGE_MODULATE_4X, {FIRST, SECOND}},
    [TEXTUREOP_add] = {STAGE_ADD, {FIRST, SECOND}},
    [TEXTUREOP_addsigned] = {STAGE_ADD_SIGNED, {FIRST, SECOND}},
    [TEXTUREOP_addsigned2x] = {STAGE_ADD_SIGNED_2X, {FIRST, SECOND}},
    [TEXTUREOP_subtract] = {STAGE_SUBTRACT, {FIRST, SECOND}},
    [TEXTUREOP_addsmooth] = {STAGE_MULTIPLY_ADD, {FIRST | COMPLEMENT, SECOND, FIRST}},
    [TEXTUREOP_blenddiffusealpha] = {STAGE_LERP, {FIRST, SECOND, DIFFUSE | REPLICATE}},
    [TEXTUREOP_blendtexturealpha] = {STAGE_LERP, {FIRST, SECOND, TEXTURE | REPLICATE}},
    [TEXTUREOP_blendfactoralpha] = {STAGE_LERP, {FIRST, SECOND, FACTOR | REPLICATE}},
    [TEXTUREOP_blendcurrentalpha] = {STAGE_LERP, {FIRST, SECOND, CURRENT | REPLICATE}},
    [TEXTUREOP_blendtexturealphapm] = {STAGE_MULTIPLY_ADD, {TEXTURE | COMPLEMENT | REPLICATE, SECOND, FIRST}},
    [TEXTUREOP_modulatealpha_addcolor] = {STAGE_MULTIPLY_ADD, {FIRST | REPLICATE, SECOND, FIRST}},
    [TEXTUREOP_modulatecolor_addalpha] = {STAGE_MULTIPLY_ADD, {FIRST, SECOND, FIRST | REPLICATE}},
    [TEXTUREOP_modulateinvalpha_addcolor] = {STAGE_MULTIPLY_ADD,
                                             {FIRST | COMPLEMENT | REPLICATE, SECOND, FIRST}},
    [TEXTUREOP_modulateinvcolor_addalpha] = {STAGE_MULTIPLY_ADD,
                                             {FIRST | COMPLEMENT, SECOND, FIRST | REPLICATE}},
    [TEXTUREOP_dotproduct3] = {STAGE_DOT, {FIRST, SECOND}},
    [TEXTUREOP_multiplyadd] = {STAGE_MULTIPLY_ADD, {FIRST, SECOND, THIRD}},
    [TEXTUREOP_lerp] = {STAGE_LERP, {FIRST, SECOND, THIRD}},
};

static uint32_t reduced_argument(const struct half_stage *half, unsigned which)
{
    unsigned origin = which & ORIGIN;
    uint32_t argument = origin < DIFFUSE ? half->argument[origin] : ARGUMENT_diffuse + origin - DIFFUSE;
    return (argument | (which & REPLICATE)) ^ (which & COMPLEMENT);
}

/* `flags` are those that mean something: alpha replicated is alpha. */
static uint8_t derive_half(const struct half_stage *half, uint32_t flags, uint8_t argument[STAGE_ARGUMENTS])
{
    const struct reduction *reduction = &reductions[half->operation];
    for (int i = 0; i < stage_arguments[reduction->stage]; i++) {
        uint32_t reduced = reduced_argument(half, reduction->argument[i]);
        argument[i] = derive_argument(reduced & (ARGUMENT_tfactor | flags));
    }
    return reduction->stage;
}

void derive_stage(const struct state *state, struct pixel_key *key)
{
    struct half_stage color = {STAGE(0, colorop),
                               {STAGE(0, colorarg1), STAGE(0, colorarg2), STAGE(0, colorarg0)}};
    struct half_stage alpha = {STAGE(0, alphaop),
                               {STAGE(0, alphaarg1), STAGE(0, alphaarg2), STAGE(0, alphaarg0)}};
    if (color.operation == TEXTUREOP_disable)
        return;
    key->color_stage = derive_half(&color, COMPLEMENT | REPLICATE, key->color_argument);
    if (key->color_stage != STAGE_DOT)
        key->alpha_stage = derive_half(&alpha, COMPLEMENT, key->alpha_argument);
    if (state->texture || !stage_reads(key, SOURCE_TEXTURE))
        return;
    key->color_stage = key->alpha_stage = STAGE_SELECT; /* without its texture the stage is off */
    memset(key->color_argument, 0, sizeof key->color_argument);
    memset(key->alpha_argument, 0, sizeof key->alpha_argument);
}
