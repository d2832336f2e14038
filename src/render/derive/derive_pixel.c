/* The pixel key: which tests, values and channels the pixel routine has, in the order that lets each rule out
 * what follows. */
#include "render/derive/derive_part.h"
#include "contract/key_query.h"
#include "shader/program/program.h"

#include <string.h>

/* The test discards the opposite of what it keeps. */
static uint8_t derive_alpha_discard(const struct state *state)
{
    if (!GET(state, alphatestenable))
        return COMPARE_NEVER;
    return (uint8_t)(COMPARE_ALWAYS - derive_compare(GET(state, alphafunc)));
}

/* The vendors' extension, which needs the alpha test and several samples. */
static bool derive_alpha_coverage(const struct state *state)
{
    return state->samples && GET(state, alphatestenable) && GET(state, adaptivetess_y) == TESSELLATION_atoc;
}

/* Diffuse is read as such, as the current colour that no stage has written yet, or as the result. */
static bool reads_diffuse(const struct pixel_key *key)
{
    bool written = false;
    for (int i = 0; i < key->stages; i++) {
        if (stage_reads(key, i, SOURCE_DIFFUSE) ||
            (!written && !derive_stage_passes(key, i) && stage_reads(key, i, SOURCE_CURRENT)))
            return true;
        written |= !key->temporary[i] && !derive_stage_passes(key, i);
    }
    return !written;
}

static bool reads_specular(const struct pixel_key *key)
{
    for (int i = 0; i < key->stages; i++)
        if (stage_reads(key, i, SOURCE_SPECULAR))
            return true;
    return key->specular;
}

/* Nothing varies over a point but a sprite's texture coordinates: what is flat is exact, and costs less. */
static void flatten(const struct state *state, struct pixel_key *key)
{
    for (int v = 0; v < VARYING_COUNT; v++)
        if (key->varying[v] && !(varying_is_coordinate(v) && GET(state, pointspriteenable)))
            key->varying[v] = INTERPOLATION_FLAT;
}

static void derive_stages(const struct state *state, enum primitive primitive, struct pixel_key *key)
{
    derive_stage(state, key);
    derive_texture(state, key);
    if (pixel_write_mask(key) & MASK_COLOR) {
        key->specular = GET(state, specularenable) != 0;
        derive_fog(state, key);
    }
    uint8_t shading = derive_flat(state) ? INTERPOLATION_FLAT : INTERPOLATION_SMOOTH;
    if (reads_diffuse(key))
        key->varying[VARYING_diffuse] = shading;
    if (reads_specular(key))
        key->varying[VARYING_specular] = shading;
    if (primitive_is_point(primitive))
        flatten(state, key);
}

/* Returns true if the instruction has a function of the state `precision`. */
static bool is_function(unsigned opcode)
{
    switch (opcode) {
    case SHADER_RCP:
    case SHADER_RSQ:
    case SHADER_EXP:
    case SHADER_EXPP:
    case SHADER_LOG:
    case SHADER_LOGP:
    case SHADER_POW:
    case SHADER_NRM:
    case SHADER_LIT: return true;
    default: return false;
    }
}

/* Returns true if colours depend on such a function: on w, on fog by an exponential, or in the shader. */
static bool uses_functions(const struct program *program, const struct pixel_key *key)
{
    bool uses = key->fog != FOG_NONE && key->fog != FOG_VARYING && key->fog != FOG_LINEAR_Z;
    for (int v = 0; v < VARYING_COUNT; v++)
        uses |= key->varying[v] == INTERPOLATION_SMOOTH;
    for (uint32_t i = 0; program && i < program->steps; i++)
        uses |= is_function(program->step[i].instruction.opcode);
    return uses;
}

/* Coverage is a part of the layout of records, too. It does not matter if nothing but the head is read. */
static void derive_coverage(const struct state *state, enum primitive primitive, struct pixel_key *key)
{
    const struct setup_key setup = {.primitive = (uint8_t)primitive,
                                    .smooth = derive_smooth(state, primitive)};
    bool colors = pixel_shades(key) && pixel_reads_color(key);
    if (!colors && !pixel_tests_depth(key))
        return;
    key->coverage = (uint8_t)setup_coverage(&setup);
    key->coverage_color = key->coverage && colors && GET(state, coveragetarget) == COVERAGETARGET_color;
}

void derive_pixel(const struct state *state, enum primitive primitive, struct pixel_key *key)
{
    const struct program *program = derive_pixel_program(state);
    derive_depth(state, primitive, key);
    derive_targets(state, key);
    key->alpha_discard = derive_alpha_discard(state);
    key->alpha_coverage = derive_alpha_coverage(state);
    key->kills = program && program->interface.kills;
    key->count = state->counting;
    derive_logic(state, key);
    derive_blend(state, key);
    if (!derive_passes(key)) {
        key->depth_write = key->count = 0;
        memset(key->write_mask, 0, sizeof key->write_mask);
    }
    if (key->alpha_discard == COMPARE_ALWAYS)
        derive_no_stencil(key);
    if (!derive_effective(key)) { /* one key for all that draw nothing */
        derive_no_stencil(key);
        key->depth_function = COMPARE_ALWAYS;
        key->alpha_discard = COMPARE_NEVER;
        key->alpha_coverage = key->kills = 0;
    }
    derive_depth_format(state, key);
    key->depth_output = program && program->interface.depth && pixel_tests_depth(key);
    key->depth_w &= !key->depth_output;
    key->late = state->late_tests && !key->depth_output && pixel_write_mask(key) &&
                (pixel_tests_depth(key) || pixel_stencil(key));
    derive_storage(state, key);
    if (pixel_write_mask(key) && derive_has_clip_mask(state))
        key->clip_mask = state->clip_mask.texture->tiled ? CLIP_MASK_TILES : CLIP_MASK_ROWS;
    if (!pixel_write_mask(key))
        derive_no_blend(key);
    derive_coverage(state, primitive, key);
    if (!pixel_shades(key) || !pixel_reads_color(key))
        return;
    if (program)
        derive_pixel_shader(state, program, primitive, key);
    else
        derive_stages(state, primitive, key);
    if (uses_functions(program, key))
        key->precision = (uint8_t)GET(state, precision);
}
