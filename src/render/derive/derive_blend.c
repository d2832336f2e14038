/* Blending, by primitive too, and logic operations: reduced to the fewest that draw the same. */
#include "render/derive/derive_part.h"
#include "contract/key_query.h"
#include "shader/program/program.h"

/* One channel's blending, as the key has it. */
struct blending {
    uint8_t blend, source, target;
};

/* Properties that the written targets share: they store negative values; they store alpha. And of the pixel:
 * its shader gives a second colour. */
struct room {
    bool below_zero, alpha, second;
};

/* A difference with a zero term is a sum or, where targets do not store negative values, zero. A sum of
 * only the new colour is a copy. */
static struct blending reduce_blending(struct blending b, struct room room)
{
    if (b.blend == BLEND_MINIMUM || b.blend == BLEND_MAXIMUM || blend_is_advanced(b.blend))
        return (struct blending){.blend = b.blend};
    if (b.blend == BLEND_SUBTRACT && b.source == FACTOR_ZERO && !room.below_zero)
        b.target = FACTOR_ZERO;
    if (b.blend == BLEND_REVERSE_SUBTRACT && b.target == FACTOR_ZERO && !room.below_zero)
        b.source = FACTOR_ZERO;
    if ((b.blend == BLEND_SUBTRACT && b.target == FACTOR_ZERO) ||
        (b.blend == BLEND_REVERSE_SUBTRACT && b.source == FACTOR_ZERO))
        b.blend = BLEND_ADD;
    if (b.blend == BLEND_ADD && b.source == FACTOR_ONE && b.target == FACTOR_ZERO)
        return (struct blending){BLEND_COPY, 0, 0};
    return b;
}

/* The target's alpha is 1 where there is none. Without a second colour, the first is meant. */
static uint8_t known_factor(uint8_t factor, struct room room)
{
    if (factor_is_second(factor) && !room.second)
        factor = (uint8_t)(factor - FACTOR_SECOND_COLOR + FACTOR_SOURCE_COLOR);
    if (room.alpha)
        return factor;
    switch (factor) {
    case FACTOR_TARGET_ALPHA: return FACTOR_ONE;
    case FACTOR_INVERSE_TARGET_ALPHA: return FACTOR_ZERO;
    case FACTOR_SATURATED_ALPHA: return room.below_zero ? factor : FACTOR_ZERO;
    default: return factor;
    }
}

/* The BOTH factors override the target's (Direct3D 9, D3DBLEND). */
static struct blending make_blending(uint32_t operation, uint32_t source, uint32_t target, struct room room)
{
    if (source == SRCBLEND_bothsrcalpha || source == SRCBLEND_bothinvsrcalpha) {
        bool inverse = source == SRCBLEND_bothinvsrcalpha;
        source = inverse ? SRCBLEND_invsrcalpha : SRCBLEND_srcalpha;
        target = inverse ? SRCBLEND_srcalpha : SRCBLEND_invsrcalpha;
    }
    struct blending b = {derive_blend_operation(operation), known_factor(derive_factor(source), room),
                         known_factor(derive_factor(target), room)};
    return reduce_blending(b, room);
}

/* The factor that is the same for alpha: its colour is itself. */
static uint8_t alpha_factor(uint8_t factor)
{
    if (factor == FACTOR_SOURCE_COLOR || factor == FACTOR_INVERSE_SOURCE_COLOR)
        return factor - FACTOR_SOURCE_COLOR + FACTOR_SOURCE_ALPHA;
    if (factor == FACTOR_TARGET_COLOR || factor == FACTOR_INVERSE_TARGET_COLOR)
        return factor - FACTOR_TARGET_COLOR + FACTOR_TARGET_ALPHA;
    if (factor == FACTOR_SECOND_COLOR || factor == FACTOR_INVERSE_SECOND_COLOR)
        return factor - FACTOR_SECOND_COLOR + FACTOR_SECOND_ALPHA;
    if (factor == FACTOR_CONSTANT_ALPHA || factor == FACTOR_INVERSE_CONSTANT_ALPHA)
        return factor - FACTOR_CONSTANT_ALPHA + FACTOR_CONSTANT;
    return factor == FACTOR_SATURATED_ALPHA ? FACTOR_ONE : factor;
}

/* The blending that is the same for alpha, unless it would be rounded otherwise. */
static struct blending alpha_blending(struct blending b, struct room room)
{
    struct blending r = {b.blend, alpha_factor(b.source), alpha_factor(b.target)};
    bool same = blend_is_lerp(r.blend, r.source, r.target) == blend_is_lerp(b.blend, b.source, b.target);
    return b.blend == BLEND_COPY || !same ? b : reduce_blending(r, room);
}

/* All advanced blendings have the same alpha. */
static struct blending only_alpha(struct blending b)
{
    return blend_is_advanced(b.blend) ? (struct blending){.blend = BLEND_ADVANCED} : b;
}

static bool same_blending(struct blending a, struct blending b)
{
    return a.blend == b.blend && a.source == b.source && a.target == b.target;
}

static bool keeps_target(struct blending b)
{
    return b.blend == BLEND_ADD && b.source == FACTOR_ZERO && b.target == FACTOR_ONE;
}

static void store_blending(struct pixel_key *key, int channel, struct blending b)
{
    key->blend[channel] = b.blend;
    key->source_factor[channel] = b.source;
    key->target_factor[channel] = b.target;
}

/* Of the targets that the masks, as they are, have. */
static struct room targets_room(const struct state *state, const struct pixel_key *key)
{
    const struct program *program = derive_pixel_program(state);
    struct room room = {.second = program && program->interface.targets & 2};
    for (int t = 0; t < TARGETS; t++)
        if (key->write_mask[t]) {
            room.below_zero |= !storage_bits[key->target[t]][0];
            room.alpha |= (state->target[t].channels & MASK_ALPHA) != 0;
        }
    return room;
}

static void keep_channels(struct pixel_key *key, int channels)
{
    for (int t = 0; t < TARGETS; t++)
        key->write_mask[t] &= channels;
}

/* Returns true if a logic operation changes the bits of a target that is written: not floating point, not
 * sRGB. */
static bool has_codes(const struct state *state, const struct pixel_key *key, int t)
{
    int storage = key->target[t];
    bool encoded = storage == TARGET_8888 && GET(state, srgbwriteenable);
    return key->write_mask[t] && storage_bits[storage][0] && !encoded;
}

/* Targets that keep their bits are not written. */
void derive_logic(const struct state *state, struct pixel_key *key)
{
    bool keeps = GET(state, logicop) == TRIPTYCH_LOGICOP_NOOP;
    for (int t = 0; t < TARGETS; t++)
        if (has_codes(state, key, t)) {
            key->logic = derive_logic_operation(GET(state, logicop));
            if (keeps)
                key->write_mask[t] = 0;
        }
}

static bool reads_second(struct blending b)
{
    return factor_is_second(b.source) || factor_is_second(b.target);
}

/* The second colour is that of the second target, so only the first target is written. */
static void keep_first_target(struct pixel_key *key)
{
    for (int t = 1; t < TARGETS; t++)
        key->write_mask[t] = 0;
}

/* Channels that stay as they are need not be written; those that are not written are blended like the others.
 */
void derive_blend(const struct state *state, struct pixel_key *key)
{
    struct blending color = {BLEND_COPY, 0, 0}, alpha;
    struct room room = targets_room(state, key);
    bool enabled = GET(state, alphablendenable) && GET(state, logicop) == TRIPTYCH_LOGICOP_NONE;
    if (enabled)
        color = make_blending(GET(state, blendop), GET(state, srcblend), GET(state, destblend), room);
    alpha = color;
    if (enabled && GET(state, separatealphablendenable) && !blend_is_advanced(color.blend))
        alpha = alpha_blending(make_blending(GET(state, blendopalpha), GET(state, srcblendalpha),
                                             GET(state, destblendalpha), room),
                               room);
    if (reads_second(color) || reads_second(alpha))
        keep_first_target(key);
    bool own = derive_blends_by_primitive(state);
    if (own)
        key->varying[VARYING_blending] = INTERPOLATION_FLAT;
    if (keeps_target(color) && !own)
        keep_channels(key, MASK_ALPHA);
    if (keeps_target(alpha) && !own)
        keep_channels(key, MASK_COLOR);
    int written = pixel_write_mask(key);
    if (!(written & MASK_ALPHA) || same_blending(alpha, alpha_blending(color, room)))
        alpha = color;
    if (!(written & MASK_COLOR))
        color = alpha = only_alpha(alpha);
    store_blending(key, BLEND_COLOR, color);
    store_blending(key, BLEND_ALPHA, alpha);
}

void derive_no_blend(struct pixel_key *key)
{
    key->logic = LOGIC_COPY;
    key->varying[VARYING_blending] = INTERPOLATION_NONE;
    store_blending(key, BLEND_COLOR, (struct blending){BLEND_COPY, 0, 0});
    store_blending(key, BLEND_ALPHA, (struct blending){BLEND_COPY, 0, 0});
}
