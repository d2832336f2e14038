/* The values that the renderer gets before a draw or a clear. */
#ifndef FRONT_GL_DRAW_PREPARE_H
#define FRONT_GL_DRAW_PREPARE_H

#include "front/gl/texture/framebuffer.h"

/* Passes on surfaces, viewport, scissor rectangle and its switch. Returns false with an error if the renderer
 * refuses. */
bool gl_prepare_target(struct gl_context *, const struct gl_target *);
/* Passes on everything else that a draw with the current program uses: states, samplers, textures, shaders,
 * uniforms. */
bool gl_prepare_draw(struct gl_context *, struct gl_target *);
/* The states of the renderer that follow from the context's values. */
void gl_prepare_raster(struct gl_context *, const struct gl_target *);

#endif
