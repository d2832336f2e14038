/* Contents of textures that are made: from a color a texel or a level, in squares, as a gradient, of an image.
 *
 * They are painted as RGBA8 words, then encoded in the texture's format, so that formats with fewer bits show what is
 * left of them. */
#ifndef STREAM_PAINT_H
#define STREAM_PAINT_H

#include "draw/texture.h"
#include "stream/stream.h"

/* What an image of that size is as a texture. */
void paint_describe_image(struct resource *resource, uint32_t width, uint32_t height);

/* 0xAARRGGBB of the text to the RGBA8 word with red in the lowest byte, and back. */
uint32_t paint_swap(uint32_t color);

/* How many levels have contents of their own: with mips the first. */
unsigned paint_given_levels(const struct resource *resource, const struct triptych_texture *shape);

/* Makes the texels, for which there is room, of a texture whose source is one of colors; of TEXTURE_FILES all faces
 * that the shape has become the image in `colors`, of RGBA8 words. */
int paint_texture(struct resource *resource, const struct triptych_texture *shape, struct error *error);

#endif
