/* The clip mask: a texture of bytes, one for each pixel of a part of the target. A colour that passed all
 * tests is multiplied by its pixel's byte / 255, alpha too, before it is blended. Each product of bytes is
 * round(c * mask / 255); in binary32 mask / 255 is rounded, then the product. All samples of a pixel have the
 * same byte. The draw's rectangle excludes pixels that the mask does not have (render/derive/derive.c). Lanes
 * outside of it read a byte at the mask's edge. */
#ifndef SPEC_PIXEL_CLIP_MASK_H
#define SPEC_PIXEL_CLIP_MASK_H

#include "contract/language.h"
#include "spec/math/color.h"
#include "spec/math/float_color.h"

#define CLIP_MASK_FIELD(field) (int)(offsetof(struct job, clip_mask) + offsetof(struct clip_mask_job, field))

/* The mask's texel along an axis, 0 to `last`: the pixel's distance from the place of the mask. */
static inline itg clip_mask_axis(struct env *e, int entry, int lane, int place, int last)
{
    flt block = uniform_f(E, BASE_ENTRY, entry);
    flt offset = load_f(E, BASE_LANES, lane);
    flt centre = add_f(E, block, offset);
    itg pixel = trunc_i(E, centre);
    itg first = uniform_i(E, BASE_JOB, place);
    itg texel = sub_i(E, pixel, first);
    itg low = max_i(E, texel, lit_i(E, 0));
    itg most = uniform_i(E, BASE_JOB, last);
    return min_i(E, low, most);
}

/* The number of the texel, in rows or in tiles (render/texture/order.h). */
static inline itg clip_mask_index(struct env *e, int form, itg u, itg v)
{
    itg pitch = uniform_i(E, BASE_JOB, CLIP_MASK_FIELD(pitch));
    if (form == CLIP_MASK_ROWS) {
        itg row = dot_i(E, v, pitch);
        return add_i(E, row, u);
    }
    itg above = and_i(E, v, lit_i(E, ~3));
    itg rows = dot_i(E, above, pitch);
    itg before = and_i(E, u, lit_i(E, ~3));
    itg down = and_i(E, v, lit_i(E, 3));
    itg quads = add_i(E, before, down);
    itg tile = shl_i(E, quads, 2);
    itg across = and_i(E, u, lit_i(E, 3));
    itg start = add_i(E, rows, tile);
    return add_i(E, start, across);
}

/* The pixel's byte. */
static inline itg clip_mask_byte(struct env *e, int form)
{
    itg u = clip_mask_axis(E, (int)offsetof(struct entry, x), (int)offsetof(struct lane_table, x),
                           CLIP_MASK_FIELD(x), CLIP_MASK_FIELD(last_u));
    itg v = clip_mask_axis(E, (int)offsetof(struct entry, y), (int)offsetof(struct lane_table, y),
                           CLIP_MASK_FIELD(y), CLIP_MASK_FIELD(last_v));
    itg index = clip_mask_index(E, form, u, v);
    itg word = gather_i(E, BASE_JOB, CLIP_MASK_FIELD(texels), index, 1, 0);
    return and_i(E, word, lit_i(E, 0xff));
}

static inline struct color clip_mask_color(struct env *e, fix mask, struct color color)
{
    color.rb = modulate(E, color.rb, mask);
    color.ga = modulate(E, color.ga, mask);
    return color;
}

static inline flt clip_mask_share(struct env *e, int form)
{
    itg byte = clip_mask_byte(E, form);
    flt number = float_f(E, byte);
    return div_f(E, number, lit_f(E, 255.0f));
}

static inline struct float_color clip_mask_numbers(struct env *e, flt share, struct float_color color)
{
    for (int c = 0; c < 4; c++)
        color.channel[c] = mul_f(E, color.channel[c], share);
    return color;
}

#endif
