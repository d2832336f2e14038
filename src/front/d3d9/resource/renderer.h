/* The renderer's calls that move texels, with Direct3D's results. */
#ifndef D3D9_RENDERER_H
#define D3D9_RENDERER_H

#include "front/d3d9/adapter/format.h"
#include "triptych.h"

/* D3D9_OK, or Direct3D's result for a failure of the renderer. */
int32_t d3d9_renderer_result(enum triptych_result);

/* Creates a surface that is drawn to or copied: an image. `samples` is 1 or more. Contents are undefined
 * for the program. */
int32_t d3d9_renderer_create_image(triptych_device *, const struct d3d9_format *, uint32_t width,
                                   uint32_t height, uint32_t samples, struct triptych_surface *surface);
/* Frees the image of a surface. Nothing without one. */
void d3d9_renderer_destroy_image(triptych_device *, struct triptych_surface *);

/* Copy a rectangle between a surface and memory with the format of the surface. The memory's first texel is
 * that of the rectangle. */
int32_t d3d9_renderer_read(triptych_device *, const struct triptych_surface *, const struct d3d9_format *,
                           const struct triptych_rectangle *, void *data, size_t pitch);
int32_t d3d9_renderer_write(triptych_device *, const struct triptych_surface *, const struct d3d9_format *,
                            const struct triptych_rectangle *, const void *data, size_t pitch);
/* Gives all pixels of a rectangle one colour. */
int32_t d3d9_renderer_fill(triptych_device *, const struct triptych_surface *,
                           const struct triptych_rectangle *, const float color[4]);

#endif
