/* Colour as a target stores it (def/state/target.def): a word of bytes, or a binary32 for each channel.
 *
 * The conversions are those of spec/pixel/target.h, where they are defined, for the values of clears and for
 * reading. All are called in the contract's floating-point environment. */
#ifndef RENDER_TARGET_COLOR_H
#define RENDER_TARGET_COLOR_H

#include "render/texture/format.h"
#include "contract/key.h"

/* The channels that targets of a format have, bits as in a write mask. Channels that are not stored are 1
 * or 0. */
uint8_t color_channels(const struct format *format);

/* The words, one for each plane, of a colour; channels that the format lacks are 1 or 0. */
void color_encode(const struct format *format, const float color[4], uint32_t words[4]);

/* Words of planes as RGBA8, clamped to 0..1 and rounded, and as numbers; sRGB is not decoded. */
uint32_t color_bytes(enum target_storage storage, const uint32_t words[4]);
void color_numbers(enum target_storage storage, const uint32_t words[4], float color[4]);

#endif
