/* Texture stages: Direct3D 9's 26 operations are reduced to those of def/stage.def, and the stages
 * to those that affect the result. */
#include "render/derive/derive_part.h"
#include "contract/key_query.h"

#include <string.h>

/* One half of a stage as the state has it: an operation of Direct3D 9 and arguments 1, 2 and 0. */
struct half_stage {
    uint32_t operation;
    uint32_t argument[STAGE_ARGUMENTS];
};

enum {
    COMPLEMENT = ARGUMENT_diffuse_complement,
    REPLICATE = ARGUMENT_diffuse_alphareplicate,
    SELECTED = COMPLEMENT - 1 /* the bits that name the source */
};

static uint8_t derive_argument(uint32_t argument)
{
    static const uint8_t source[SELECTED + 1] = {
        [ARGUMENT_diffuse] = SOURCE_DIFFUSE + 1,   [ARGUMENT_current] = SOURCE_CURRENT + 1,
        [ARGUMENT_texture] = SOURCE_TEXTURE + 1,   [ARGUMENT_tfactor] = SOURCE_FACTOR + 1,
        [ARGUMENT_specular] = SOURCE_SPECULAR + 1, [ARGUMENT_temp] = SOURCE_TEMPORARY + 1,
        [ARGUMENT_constant] = SOURCE_CONSTANT + 1};
    unsigned flags =
        (argument & COMPLEMENT ? ARGUMENT_COMPLEMENT : 0) + (argument & REPLICATE ? ARGUMENT_REPLICATE : 0);
    if (!source[argument & SELECTED])
        derive_impossible("argument of a texture stage", argument);
    return (uint8_t)(source[argument & SELECTED] - 1 + flags);
}

/* Where an argument of a reduced operation comes from: argument 1, 2 or 0 of the state, or a source; with
 * REPLICATE to be set, COMPLEMENT to be turned. */
enum { FIRST, SECOND, THIRD, DIFFUSE, CURRENT, TEXTURE, FACTOR, ORIGIN = 7 };

/* Operations that are others with particular arguments: blends are interpolations by an alpha, and all that
 * end in an addition of a product are one. ADDSMOOTH, a + b - a * b, is a + (1 - a) * b, and rounds alike. */
struct reduction {
    uint8_t stage;
    uint8_t argument[STAGE_ARGUMENTS];
};

/* The stage in the lowest byte, then the arguments. The compiler makes a table of such constants, which is
 * faster than the jumps that it makes for structures. There is no default, so an operation without a row does
 * not compile. Other numbers cannot be set. */
static uint32_t packed_reduction(uint32_t operation)
{
#define CASE(operation, stage, ...)                                                                          \
    case TRIPTYCH_TEXTUREOP_##operation:                                                                     \
        return PACK(stage, __VA_ARGS__, 0, 0, );
#define PACK(stage, first, second, third, ...)                                                               \
    ((uint32_t)(stage) | (uint32_t)(first) << 8 | (uint32_t)(second) << 16 | (uint32_t)(third) << 24)
    switch ((enum triptych_textureop)operation) {
        CASE(DISABLE, STAGE_SELECT, CURRENT)
        CASE(SELECTARG1, STAGE_SELECT, FIRST)
        CASE(SELECTARG2, STAGE_SELECT, SECOND)
        CASE(PREMODULATE, STAGE_SELECT, FIRST)
        CASE(MODULATE, STAGE_MODULATE, FIRST, SECOND)
        CASE(MODULATE2X, STAGE_MODULATE_2X, FIRST, SECOND)
        CASE(MODULATE4X, STAGE_MODULATE_4X, FIRST, SECOND)
        CASE(ADD, STAGE_ADD, FIRST, SECOND)
        CASE(ADDSIGNED, STAGE_ADD_SIGNED, FIRST, SECOND)
        CASE(ADDSIGNED2X, STAGE_ADD_SIGNED_2X, FIRST, SECOND)
        CASE(SUBTRACT, STAGE_SUBTRACT, FIRST, SECOND)
        CASE(ADDSMOOTH, STAGE_MULTIPLY_ADD, FIRST | COMPLEMENT, SECOND, FIRST)
        CASE(BLENDDIFFUSEALPHA, STAGE_LERP, FIRST, SECOND, DIFFUSE | REPLICATE)
        CASE(BLENDTEXTUREALPHA, STAGE_LERP, FIRST, SECOND, TEXTURE | REPLICATE)
        CASE(BLENDFACTORALPHA, STAGE_LERP, FIRST, SECOND, FACTOR | REPLICATE)
        CASE(BLENDCURRENTALPHA, STAGE_LERP, FIRST, SECOND, CURRENT | REPLICATE)
        CASE(BLENDTEXTUREALPHAPM, STAGE_MULTIPLY_ADD, TEXTURE | COMPLEMENT | REPLICATE, SECOND, FIRST)
        CASE(MODULATEALPHA_ADDCOLOR, STAGE_MULTIPLY_ADD, FIRST | REPLICATE, SECOND, FIRST)
        CASE(MODULATECOLOR_ADDALPHA, STAGE_MULTIPLY_ADD, FIRST, SECOND, FIRST | REPLICATE)
        CASE(MODULATEINVALPHA_ADDCOLOR, STAGE_MULTIPLY_ADD, FIRST | COMPLEMENT | REPLICATE, SECOND, FIRST)
        CASE(MODULATEINVCOLOR_ADDALPHA, STAGE_MULTIPLY_ADD, FIRST | COMPLEMENT, SECOND, FIRST | REPLICATE)
        CASE(BUMPENVMAP, STAGE_SELECT, CURRENT) /* it affects only the next stage */
        CASE(BUMPENVMAPLUMINANCE, STAGE_SELECT, CURRENT)
        CASE(DOTPRODUCT3, STAGE_DOT, FIRST, SECOND)
        CASE(MULTIPLYADD, STAGE_MULTIPLY_ADD, FIRST, SECOND, THIRD)
        CASE(LERP, STAGE_LERP, FIRST, SECOND, THIRD)
    }
#undef CASE
#undef PACK
    derive_impossible("texture operation", operation);
}

static struct reduction reduction_of(uint32_t operation)
{
    uint32_t packed = packed_reduction(operation);
    return (struct reduction){(uint8_t)packed,
                              {(uint8_t)(packed >> 8), (uint8_t)(packed >> 16), (uint8_t)(packed >> 24)}};
}

static uint32_t reduced_argument(const struct half_stage *half, unsigned which)
{
    unsigned origin = which & ORIGIN;
    uint32_t argument = origin < DIFFUSE ? half->argument[origin] : ARGUMENT_diffuse + origin - DIFFUSE;
    return (argument | (which & REPLICATE)) ^ (which & COMPLEMENT);
}

/* Returns true if the operation reads a texture that is not bound. Such a half of a stage passes the
 * current colour, as drivers do; Direct3D 9 leaves it undefined. */
static bool lacks_texture(const struct half_stage *half, bool bound)
{
    const struct reduction reduction = reduction_of(half->operation);
    for (int i = 0; i < stage_arguments[reduction.stage] && !bound; i++)
        if ((reduced_argument(half, reduction.argument[i]) & SELECTED) == ARGUMENT_texture)
            return true;
    return false;
}

/* `flags` are those that mean something: alpha replicated is alpha. */
static uint8_t derive_half(const struct half_stage *half, uint32_t flags, uint8_t argument[STAGE_ARGUMENTS])
{
    const struct reduction reduction = reduction_of(half->operation);
    for (int i = 0; i < stage_arguments[reduction.stage]; i++) {
        uint32_t reduced = reduced_argument(half, reduction.argument[i]);
        argument[i] = derive_argument(reduced & (SELECTED | flags));
    }
    return reduction.stage;
}

/* The two halves of a stage. */
struct whole_stage {
    struct half_stage color, alpha;
};

static struct whole_stage stage_states(const struct state *state, int i)
{
    struct whole_stage r = {
        {STAGE(state, i, colorop),
         {STAGE(state, i, colorarg1), STAGE(state, i, colorarg2), STAGE(state, i, colorarg0)}},
        {STAGE(state, i, alphaop),
         {STAGE(state, i, alphaarg1), STAGE(state, i, alphaarg2), STAGE(state, i, alphaarg0)}}};
    bool bound = state->texture[i] != NULL;
    if (lacks_texture(&r.color, bound))
        r.color.operation = TEXTUREOP_disable;
    if (lacks_texture(&r.alpha, bound))
        r.alpha.operation = TEXTUREOP_disable;
    return r;
}

/* The displacement that a stage applies to the next stage's texture coordinates. */
static uint8_t derive_bump(const struct state *state, int i)
{
    uint32_t operation = STAGE(state, i, colorop);
    if (!state->texture[i])
        return BUMP_NONE;
    return operation == TEXTUREOP_bumpenvmap            ? BUMP_DISPLACED
           : operation == TEXTUREOP_bumpenvmapluminance ? BUMP_LUMINANCE
                                                        : BUMP_NONE;
}

static bool is_bump(const struct whole_stage *stage)
{
    return stage->color.operation == TEXTUREOP_bumpenvmap ||
           stage->color.operation == TEXTUREOP_bumpenvmapluminance;
}

static void derive_one(const struct state *state, int i, struct pixel_key *key)
{
    struct whole_stage stage = stage_states(state, i);
    if (is_bump(&stage))
        stage.alpha.operation = TEXTUREOP_disable;
    uint8_t *color = key->color_argument + STAGE_ARGUMENTS * i,
            *alpha = key->alpha_argument + STAGE_ARGUMENTS * i;
    key->color_stage[i] = derive_half(&stage.color, COMPLEMENT | REPLICATE, color);
    if (key->color_stage[i] != STAGE_DOT)
        key->alpha_stage[i] = derive_half(&stage.alpha, COMPLEMENT, alpha);
    key->temporary[i] = STAGE(state, i, resultarg) == ARGUMENT_temp && !is_bump(&stage);
    if (i + 1 == TEXTURE_STAGES || !state->texture[i + 1])
        return;
    key->bump[i + 1] = derive_bump(state, i);
    if (stage.color.operation == TEXTUREOP_premodulate)
        key->premodulate[i + 1] |= PREMODULATE_COLOR;
    if (stage.alpha.operation == TEXTUREOP_premodulate && key->color_stage[i] != STAGE_DOT)
        key->premodulate[i + 1] |= PREMODULATE_ALPHA;
}

static void clear_stage(struct pixel_key *key, int i)
{
    key->color_stage[i] = key->alpha_stage[i] = STAGE_SELECT;
    memset(key->color_argument + STAGE_ARGUMENTS * i, 0, STAGE_ARGUMENTS);
    memset(key->alpha_argument + STAGE_ARGUMENTS * i, 0, STAGE_ARGUMENTS);
    key->temporary[i] = key->premodulate[i] = key->bump[i] = 0;
}

/* Makes a stage one that leaves everything as it is. */
static void pass_stage(struct pixel_key *key, int i)
{
    clear_stage(key, i);
    key->color_argument[STAGE_ARGUMENTS * i] = key->alpha_argument[STAGE_ARGUMENTS * i] = SOURCE_CURRENT;
}

bool derive_stage_passes(const struct pixel_key *key, int i)
{
    return key->color_stage[i] == STAGE_SELECT && stage_is_joint(key, i) && !key->temporary[i] &&
           !key->premodulate[i] && key->color_argument[STAGE_ARGUMENTS * i] == SOURCE_CURRENT;
}

/* Stages whose results are not read pass their input through. */
static void drop_dead_stages(struct pixel_key *key)
{
    bool current = true, temporary = false;
    for (int i = key->stages - 1; i >= 0; i--) {
        bool *result = key->temporary[i] ? &temporary : &current;
        if (!*result) {
            pass_stage(key, i);
            continue;
        }
        *result = false;
        current |= stage_reads(key, i, SOURCE_CURRENT);
        temporary |= stage_reads(key, i, SOURCE_TEMPORARY);
    }
}

/* Before a stage has written the current colour, it is diffuse. Premodulation is removed if no stage reads
 * its result. */
static void name_diffuse(struct pixel_key *key)
{
    bool written = false;
    for (int i = 0; i < key->stages; i++) {
        if (!stage_reads(key, i, SOURCE_CURRENT))
            key->premodulate[i] = 0;
        if (derive_stage_passes(key, i))
            continue;
        for (int j = 0; j < STAGE_ARGUMENTS && !written && !key->premodulate[i]; j++) {
            uint8_t *color = key->color_argument + STAGE_ARGUMENTS * i + j,
                    *alpha = key->alpha_argument + STAGE_ARGUMENTS * i + j;
            *color -= *color % SOURCE_COUNT == SOURCE_CURRENT ? SOURCE_CURRENT - SOURCE_DIFFUSE : 0;
            *alpha -= *alpha % SOURCE_COUNT == SOURCE_CURRENT ? SOURCE_CURRENT - SOURCE_DIFFUSE : 0;
        }
        written |= !key->temporary[i];
    }
}

/* Where only alpha is read, colour may be computed as alpha is. */
static void keep_alpha_only(struct pixel_key *key)
{
    for (int i = 0; i < key->stages; i++)
        if (key->color_stage[i] == STAGE_DOT)
            return;
    memcpy(key->color_stage, key->alpha_stage, sizeof key->color_stage);
    memcpy(key->color_argument, key->alpha_argument, sizeof key->color_argument);
    for (int i = 0; i < key->stages; i++)
        if (key->premodulate[i])
            key->premodulate[i] =
                key->premodulate[i] & PREMODULATE_ALPHA ? PREMODULATE_COLOR | PREMODULATE_ALPHA : 0;
}

/* The result of zero stages. */
static bool selects_diffuse(const struct pixel_key *key)
{
    return key->stages == 1 && key->color_stage[0] == STAGE_SELECT && stage_is_joint(key, 0) &&
           !key->temporary[0] && key->color_argument[0] == SOURCE_DIFFUSE;
}

void derive_stage(const struct state *state, struct pixel_key *key)
{
    while (key->stages < TEXTURE_STAGES && STAGE(state, key->stages, colorop) != TEXTUREOP_disable)
        derive_one(state, key->stages++, key);
    if (key->stages < TEXTURE_STAGES)
        key->premodulate[key->stages] = key->bump[key->stages] = 0;
    if (!pixel_write_mask(key))
        keep_alpha_only(key);
    drop_dead_stages(key);
    name_diffuse(key);
    while (key->stages && (derive_stage_passes(key, key->stages - 1) || selects_diffuse(key)))
        clear_stage(key, --key->stages);
}
