/* Random keys that resemble those of draws more often than uniformly random ones. */
#include "tests/support/differential/differential.h"
#include "tests/support/shader/random_key.h"

#include "tests/support/shader/programs.h"

/* Blendings that renderers use are rare among all pairs: alpha blended as colour, complementary factors,
 * and those with fragments of their own in the stitcher. */
static void blend_usually(uint64_t chance, struct pixel_key *key)
{
    static const uint8_t usual[][2] = {{FACTOR_SOURCE_ALPHA, FACTOR_INVERSE_SOURCE_ALPHA},
                                       {FACTOR_ONE, FACTOR_INVERSE_SOURCE_ALPHA},
                                       {FACTOR_SOURCE_ALPHA, FACTOR_ZERO}};
    unsigned choice = chance >> 33 & 7;
    if (choice < 4) {
        key->blend[BLEND_ALPHA] = key->blend[BLEND_COLOR];
        key->source_factor[BLEND_ALPHA] = key->source_factor[BLEND_COLOR];
        key->target_factor[BLEND_ALPHA] = key->target_factor[BLEND_COLOR];
    }
    for (int c = 0; c < BLEND_CHANNELS; c++)
        if (choice < 2) {
            key->blend[c] = BLEND_ADD;
            key->source_factor[c] = usual[(chance >> 36) % 3][0];
            key->target_factor[c] = usual[(chance >> 36) % 3][1];
        } else if ((choice == 2 || choice == 7) && key->source_factor[c] < FACTOR_SATURATED_ALPHA) {
            key->blend[c] = BLEND_ADD;
            key->target_factor[c] = key->source_factor[c] ^ 1;
        }
}

/* Few of all keys have transformed positions of the usual types, or one matrix. */
static void declare_usually(uint64_t chance, struct vertex_key *key)
{
    if (chance >> 33 & 3)
        key->attribute[ATTRIBUTE_POSITIONT] = ATTRIBUTE_FORMAT_NONE;
    if (chance >> 36 & 1)
        key->matrices = key->tween = 0;
    if (chance >> 35 & 1)
        for (int a = 0; a < ATTRIBUTE_COUNT; a++)
            key->attribute[a] %= ATTRIBUTE_FORMAT_COLOR + 1;
}

/* Few stages; half of the cases have the sources that draws use. Sometimes all stages. */
static void stage_usually(uint64_t chance, struct pixel_key *key)
{
    static const uint8_t usual[] = {SOURCE_TEXTURE, SOURCE_CURRENT, SOURCE_FACTOR, SOURCE_CONSTANT};
    if (chance >> 20 & 15)
        key->stages = (uint8_t)((chance >> 24) % 4);
    for (int i = 0; i < TEXTURE_STAGES * STAGE_ARGUMENTS && chance >> 40 & 1; i++) {
        key->color_argument[i] = usual[key->color_argument[i] % 4];
        key->alpha_argument[i] = usual[key->alpha_argument[i] % 4];
    }
    for (int i = 0; i < PIXEL_SAMPLERS && chance >> 42 & 7; i++)
        key->texture[i] = key->texture[i] != TEXTURE_NONE,
        key->mip[i] = key->minify[i] = key->texel[i] = key->compact[i] = key->tiled[i] = 0;
    for (int i = 0; i < PIXEL_SAMPLERS; i++) /* a stage with many taps takes longer than everything else */
        key->anisotropy[i] %= 4;
    for (int i = 0; i < TEXTURE_STAGES && chance >> 41 & 1; i++)
        key->alpha_stage[i] = key->color_stage[i] == STAGE_DOT ? STAGE_SELECT : key->color_stage[i];
}

/* Most targets have one sample. Keys with several samples have one target. */
static void sample_usually(uint64_t chance, struct pixel_key *key)
{
    if (chance >> 40 & 3)
        key->samples = key->sample_centers = key->alpha_coverage = 0;
    for (int t = 1; t < TARGETS && key->samples; t++)
        key->write_mask[t] = key->target[t] = 0;
}

/* A quarter of the routines have a shader. */
static void shade_usually(uint64_t chance, enum unit unit, union key *key)
{
    const struct program *program[16];
    uint8_t *shader = unit == UNIT_VERTEX ? key->vertex.shader : key->pixel.shader;
    enum shader_stage stage = unit == UNIT_VERTEX ? STAGE_VERTEX : STAGE_PIXEL;
    unsigned count = 0;
    for (unsigned i = 0; sample_program(i); i++)
        if (sample_program(i)->model->stage == stage)
            program[count++] = sample_program(i);
    key_set_program(shader, (chance >> 44) % 4 ? 0 : program[(chance >> 48) % count]->number);
    if (unit == UNIT_PIXEL && !key_program(shader))
        key->pixel.kills = key->pixel.depth_output = 0;
}

void differential_key(enum unit unit, uint64_t *seed, union key *key)
{
    key_random(unit, seed, key);
    if (unit == UNIT_PIXEL)
        blend_usually(*seed, &key->pixel), stage_usually(*seed, &key->pixel),
            sample_usually(*seed, &key->pixel);
    if (unit == UNIT_VERTEX)
        declare_usually(*seed, &key->vertex);
    if (unit != UNIT_SETUP)
        shade_usually(*seed, unit, key);
}
