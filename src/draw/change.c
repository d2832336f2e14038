#include "draw/change.h"

/* What says nothing to anybody but by keys; what depends on keys follows from there. */
enum { BY_KEYS = PARTS(KEYS) | PARTS(SETTING) };

/* Values that are in no key, and those that are nowhere else. The others are 0 here: everything. */
static const uint32_t render_change[TRIPTYCH_STATE_COUNT] = {
    [TRIPTYCH_STATE_texturefactor] = PARTS(STAGES),
    [TRIPTYCH_STATE_fogcolor] = PARTS(FOG),
    [TRIPTYCH_STATE_fogstart] = PARTS(FOG),
    [TRIPTYCH_STATE_fogend] = PARTS(FOG),
    [TRIPTYCH_STATE_fogdensity] = PARTS(FOG),
    [TRIPTYCH_STATE_ambient] = PARTS(LIGHTS),
    [TRIPTYCH_STATE_stencilref] = PARTS(DEPTH),
    [TRIPTYCH_STATE_alpharef] = PARTS(REFERENCES),
    [TRIPTYCH_STATE_blendfactor] = PARTS(REFERENCES),
    [TRIPTYCH_STATE_tweenfactor] = PARTS(REFERENCES),
    [TRIPTYCH_STATE_pointsize] = PARTS(SETUP),
    [TRIPTYCH_STATE_pointsize_min] = PARTS(SETUP),
    [TRIPTYCH_STATE_pointsize_max] = PARTS(SETUP),
    [TRIPTYCH_STATE_pointscale_a] = PARTS(SETUP),
    [TRIPTYCH_STATE_lastpixel] = PARTS(SETTING),
    [TRIPTYCH_STATE_scissortestenable] = PARTS(SETTING),
    [TRIPTYCH_STATE_multisamplemask] = PARTS(SETTING),
    [TRIPTYCH_STATE_wrap0] = PARTS(SETTING),
    [TRIPTYCH_STATE_wrap1] = PARTS(SETTING),
    [TRIPTYCH_STATE_wrap2] = PARTS(SETTING),
    [TRIPTYCH_STATE_wrap3] = PARTS(SETTING),
    [TRIPTYCH_STATE_wrap4] = PARTS(SETTING),
    [TRIPTYCH_STATE_wrap5] = PARTS(SETTING),
    [TRIPTYCH_STATE_wrap6] = PARTS(SETTING),
    [TRIPTYCH_STATE_wrap7] = PARTS(SETTING),
    [TRIPTYCH_STATE_pointscale_b] = PARTS(SETUP),
    [TRIPTYCH_STATE_pointscale_c] = PARTS(SETUP),
    [TRIPTYCH_STATE_alphablendenable] = BY_KEYS,
    [TRIPTYCH_STATE_srcblend] = BY_KEYS,
    [TRIPTYCH_STATE_destblend] = BY_KEYS,
    [TRIPTYCH_STATE_blendop] = BY_KEYS,
    [TRIPTYCH_STATE_separatealphablendenable] = BY_KEYS,
    [TRIPTYCH_STATE_srcblendalpha] = BY_KEYS,
    [TRIPTYCH_STATE_destblendalpha] = BY_KEYS,
    [TRIPTYCH_STATE_blendopalpha] = BY_KEYS,
    [TRIPTYCH_STATE_colorwriteenable] = BY_KEYS,
    [TRIPTYCH_STATE_colorwriteenable1] = BY_KEYS,
    [TRIPTYCH_STATE_colorwriteenable2] = BY_KEYS,
    [TRIPTYCH_STATE_colorwriteenable3] = BY_KEYS,
    [TRIPTYCH_STATE_zenable] = BY_KEYS,
    [TRIPTYCH_STATE_zfunc] = BY_KEYS,
    [TRIPTYCH_STATE_zwriteenable] = BY_KEYS,
    [TRIPTYCH_STATE_alphatestenable] = BY_KEYS,
    [TRIPTYCH_STATE_alphafunc] = BY_KEYS,
    [TRIPTYCH_STATE_cullmode] = BY_KEYS,
    [TRIPTYCH_STATE_stencilenable] = BY_KEYS,
    [TRIPTYCH_STATE_stencilfunc] = BY_KEYS,
    [TRIPTYCH_STATE_stencilfail] = BY_KEYS,
    [TRIPTYCH_STATE_stencilzfail] = BY_KEYS,
    [TRIPTYCH_STATE_stencilpass] = BY_KEYS,
    [TRIPTYCH_STATE_ccw_stencilfunc] = BY_KEYS,
    [TRIPTYCH_STATE_ccw_stencilfail] = BY_KEYS,
    [TRIPTYCH_STATE_ccw_stencilzfail] = BY_KEYS,
    [TRIPTYCH_STATE_ccw_stencilpass] = BY_KEYS,
    [TRIPTYCH_STATE_twosidedstencilmode] = BY_KEYS,
    [TRIPTYCH_STATE_shademode] = BY_KEYS,
    [TRIPTYCH_STATE_specularenable] = BY_KEYS,
    [TRIPTYCH_STATE_lighting] = BY_KEYS,
    [TRIPTYCH_STATE_fogenable] = BY_KEYS,
    [TRIPTYCH_STATE_ditherenable] = BY_KEYS,
    [TRIPTYCH_STATE_srgbwriteenable] = BY_KEYS,
    [TRIPTYCH_STATE_normalizenormals] = BY_KEYS,
    [TRIPTYCH_STATE_localviewer] = BY_KEYS,
    [TRIPTYCH_STATE_colorvertex] = BY_KEYS,
    [TRIPTYCH_STATE_diffusematerialsource] = BY_KEYS,
    [TRIPTYCH_STATE_ambientmaterialsource] = BY_KEYS,
    [TRIPTYCH_STATE_emissivematerialsource] = BY_KEYS,
    [TRIPTYCH_STATE_specularmaterialsource] = BY_KEYS,
};

static const uint32_t sampler_change[TRIPTYCH_SAMPLER_STATE_COUNT] = {
    [TRIPTYCH_SAMPLER_bordercolor] = PARTS(TEXTURES),
    [TRIPTYCH_SAMPLER_mipmaplodbias] = PARTS(TEXTURES),
    [TRIPTYCH_SAMPLER_addressu] = BY_KEYS,
    [TRIPTYCH_SAMPLER_addressv] = BY_KEYS,
    [TRIPTYCH_SAMPLER_addressw] = BY_KEYS,
    [TRIPTYCH_SAMPLER_magfilter] = BY_KEYS,
    [TRIPTYCH_SAMPLER_minfilter] = BY_KEYS,
    [TRIPTYCH_SAMPLER_maxanisotropy] = BY_KEYS,
    [TRIPTYCH_SAMPLER_srgbtexture] = BY_KEYS,
};

static const uint32_t stage_change[TRIPTYCH_STAGE_STATE_COUNT] = {
    [TRIPTYCH_STAGE_constant] = PARTS(STAGES),
    [TRIPTYCH_STAGE_bumpenvmat00] = PARTS(STAGES),
    [TRIPTYCH_STAGE_bumpenvmat01] = PARTS(STAGES),
    [TRIPTYCH_STAGE_bumpenvmat10] = PARTS(STAGES),
    [TRIPTYCH_STAGE_bumpenvmat11] = PARTS(STAGES),
    [TRIPTYCH_STAGE_bumpenvlscale] = PARTS(STAGES),
    [TRIPTYCH_STAGE_bumpenvloffset] = PARTS(STAGES),
    [TRIPTYCH_STAGE_colorop] = BY_KEYS,
    [TRIPTYCH_STAGE_colorarg1] = BY_KEYS,
    [TRIPTYCH_STAGE_colorarg2] = BY_KEYS,
    [TRIPTYCH_STAGE_colorarg0] = BY_KEYS,
    [TRIPTYCH_STAGE_alphaop] = BY_KEYS,
    [TRIPTYCH_STAGE_alphaarg1] = BY_KEYS,
    [TRIPTYCH_STAGE_alphaarg2] = BY_KEYS,
    [TRIPTYCH_STAGE_alphaarg0] = BY_KEYS,
    [TRIPTYCH_STAGE_resultarg] = BY_KEYS,
};

unsigned change_of_value(enum triptych_state_table table, unsigned row)
{
    unsigned change = table == TRIPTYCH_SAMPLER_STATES ? sampler_change[row]
                      : table == TRIPTYCH_STAGE_STATES ? stage_change[row]
                                                       : render_change[row];
    return change ? change : PARTS_ALL;
}

/* The projection says whether fog goes by w. */
unsigned change_of_transform(enum triptych_transform which)
{
    switch (which) {
    case TRIPTYCH_TRANSFORM_PROJECTION: return PARTS_ALL;
    case TRIPTYCH_TRANSFORM_WORLD: return PARTS(TRANSFORM) | PARTS(BLEND) | PARTS(PALETTE);
    case TRIPTYCH_TRANSFORM_VIEW:
        return PARTS(TRANSFORM) | PARTS(LIGHTS) | PARTS(BLEND) | PARTS(CLIP_PLANES) | PARTS(PALETTE);
    default: break;
    }
    return which >= TRIPTYCH_TRANSFORM_WORLD1 ? PARTS(BLEND) | PARTS(PALETTE) : PARTS(TEXTURE_MATRICES);
}

/* Highlights of powers 0 and 1 are routines of their own. */
unsigned change_of_material(const struct triptych_material *from, const struct triptych_material *to)
{
    return from->power != to->power ? PARTS_ALL : PARTS(LIGHTS);
}

unsigned change_of_light(const struct triptych_light *from, const struct triptych_light *to)
{
    return from->type != to->type || from->falloff != to->falloff ? PARTS_ALL : PARTS(LIGHTS);
}

static bool is_power(uint32_t size)
{
    return !(size & (size - 1));
}

/* Levels of a size that is a power of two are such sizes themselves. */
static bool same_side(uint32_t from, uint32_t to)
{
    return from == to || (is_power(from) && is_power(to));
}

unsigned change_of_texture(const struct triptych_texture *from, const struct triptych_texture *to)
{
    bool alike = from && to && from->type == to->type && from->format == to->format &&
                 from->levels == to->levels && same_side(from->width, to->width) &&
                 same_side(from->height, to->height) && same_side(from->depth, to->depth);
    return alike ? PARTS(TEXTURES) : PARTS_ALL;
}
