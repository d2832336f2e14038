#include "render/derive/change.h"

#define CHANGE(number, name, kind, initial, units, change, ...) CHANGE_##change,

static const uint32_t render_change[] = {
#define STATE CHANGE
#include "def/state/state.def"
#undef STATE
};

static const uint32_t sampler_change[] = {
#define SAMPLER_STATE CHANGE
#include "def/state/sampler_state.def"
#undef SAMPLER_STATE
};

static const uint32_t stage_change[] = {
#define STAGE_STATE CHANGE
#include "def/state/stage_state.def"
#undef STAGE_STATE
};

#define MASK(number, name, kind, initial, units, change, ...) CHANGE_##change &PARTS(KEYS) ? UINT32_MAX : 0,

const uint32_t change_value_mask[TRIPTYCH_STATE_COUNT] = {
#define STATE MASK
#include "def/state/state.def"
#undef STATE
};

const uint32_t change_sampler_mask[TRIPTYCH_SAMPLER_STATE_COUNT] = {
#define SAMPLER_STATE MASK
#include "def/state/sampler_state.def"
#undef SAMPLER_STATE
};

const uint32_t change_stage_mask[TRIPTYCH_STAGE_STATE_COUNT] = {
#define STAGE_STATE MASK
#include "def/state/stage_state.def"
#undef STAGE_STATE
};

#undef MASK

unsigned change_of_value(enum triptych_state_table table, unsigned row)
{
    switch (table) {
    case TRIPTYCH_RENDER_STATES: return render_change[row];
    case TRIPTYCH_SAMPLER_STATES: return sampler_change[row];
    case TRIPTYCH_STAGE_STATES: return stage_change[row];
    case TRIPTYCH_STATE_TABLE_COUNT: break;
    }
    return PARTS_ALL;
}

/* The projection determines whether fog depends on w. */
unsigned change_of_transform(enum triptych_transform which)
{
    switch (which) {
    case TRIPTYCH_TRANSFORM_PROJECTION:
        return PARTS(TRANSFORM) | PARTS(BLEND) | PARTS(CLIP_PLANES) | PARTS(DEPTH) | PARTS(KEYS);
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
    return PARTS(LIGHTS) | (from->power != to->power ? PARTS(KEYS) : 0);
}

unsigned change_of_light(const struct triptych_light *from, const struct triptych_light *to)
{
    return PARTS(LIGHTS) | (from->type != to->type || from->falloff != to->falloff ? PARTS(KEYS) : 0);
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
                 from->tiled == to->tiled && from->levels == to->levels &&
                 same_side(from->width, to->width) && same_side(from->height, to->height) &&
                 same_side(from->depth, to->depth);
    return PARTS(TEXTURES) | (alike ? 0 : PARTS(KEYS));
}
