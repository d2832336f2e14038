/* Smooth edges: the edges of a draw's triangles that the state edgeantialias and masks of vertices have. */
#ifndef RENDER_GEOMETRY_EDGES_H
#define RENDER_GEOMETRY_EDGES_H

#include "render/draw/command.h"

/* The smooth edges of a part (def/state/primitive.def), whose first corner is `vertex`: bit i from corner i
 * to the next. */
uint32_t edges_of_part(const struct draw *draw, uint32_t part, uint32_t vertex);

#endif
