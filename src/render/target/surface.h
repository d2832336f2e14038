/* Surfaces: single images of textures that are drawn to, read and copied.
 *
 * A texture's texels and a target's pixels hold the same values: words where the format has 8 bits a
 * channel, four numbers otherwise (render/texture/format.h, def/state/target.def). So drawing to a texture
 * is drawing to tiles that begin with its texels and end as them. Depth is the same number in all four
 * channels of a texel; stencil has no place there and begins as zero. */
#ifndef RENDER_TARGET_SURFACE_H
#define RENDER_TARGET_SURFACE_H

#include "render/target/target.h"
#include "render/texture/texture.h"

/* Describes a target that draws to the surfaces. Checks formats and sizes, and that there is at least one
 * surface. */
enum triptych_result surfaces_describe(const struct triptych_target_textures *textures,
                                       struct triptych_target_description *description, struct error *error);

/* Returns true if one of the surfaces belongs to the texture. */
bool surfaces_include(const struct triptych_target_textures *textures,
                      const struct triptych_texture *texture);

/* All texels of the surfaces to the target's tiles, and back. */
void surfaces_load(const struct triptych_target_textures *textures, struct target *target);
void surfaces_store(const struct triptych_target_textures *textures, const struct target *target);

/* A copy from the first surface to the second one; parts of width 0 are all of them. */
struct surface_copy {
    const struct triptych_surface *surface[2];
    struct triptych_rectangle part[2];
    enum triptych_copy_filter filter;
};

/* The size of a surface, be it of a texture or a colour of the target. */
enum triptych_result surface_size(const struct triptych_surface *surface, const char *what,
                                  const struct triptych_target_description *target, uint32_t size[2],
                                  struct error *error);
enum triptych_result surface_check_copy(const struct surface_copy *copy,
                                        const struct triptych_target_description *target,
                                        struct error *error);

/* Numbers of texels: all of a surface read; a part written, converted to the format. The writer is called in
 * the contract's floating-point environment. */
void surface_read_numbers(const struct triptych_surface *surface, float *image);
void surface_write_numbers(const struct triptych_surface *surface, const struct triptych_rectangle *part,
                           const float *image);

#endif
