/* Generated contents of textures: one colour per texel or per level, squares, gradients, or an image.
 *
 * They are painted as RGBA8 words and then encoded in the texture's format, so formats with fewer bits lose
 * precision as usual. */
#ifndef COMMAND_ASSETS_PAINT_H
#define COMMAND_ASSETS_PAINT_H

#include "render/texture/texture.h"
#include "command/stream/stream.h"

/* Describes the texture of an image of that size. */
void paint_describe_image(struct resource *resource, uint32_t width, uint32_t height);

/* Converts 0xAARRGGBB, as in texts, to an RGBA8 word with red in the lowest byte, and back. */
uint32_t paint_swap(uint32_t color);

/* The number of levels with contents of their own; with generated mips, only the first. */
unsigned paint_given_levels(const struct resource *resource, const struct triptych_texture *shape);

/* Makes the texels of a texture whose source is a list of colours; memory for them exists. For TEXTURE_FILES,
 * all faces of the shape get the image in `colors`, of RGBA8 words. */
int paint_texture(struct resource *resource, const struct triptych_texture *shape, struct error *error);

#endif
