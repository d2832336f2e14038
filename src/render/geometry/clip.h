/* The clipper: one triangle or line of a vertex batch against the planes that its vertices' clip codes
 * name (CLIP_NEEDED in contract/layout.h: eye, near, far, guard band and user planes; the sides of the
 * frustum are the rasterizer's). */
#ifndef RENDER_GEOMETRY_CLIP_H
#define RENDER_GEOMETRY_CLIP_H

#include "contract/arguments.h"

enum {
    CLIP_PLANES = 7 + CLIP_PLANES_USER,
    CLIP_VERTICES_MAXIMUM =
        3 + CLIP_PLANES, /* of the clipped polygon, and so of new lanes for one triangle */
    CLIP_TRIANGLES_MAXIMUM = CLIP_VERTICES_MAXIMUM - 2
};

/* Where the clipper works. Several may be used on one batch in turn if `next` is carried along. */
struct clipper {
    float *vertices;  /* the batch: SLOT_COUNT * VERTEX_CAPACITY words (contract/layout.h) */
    uint32_t next;    /* first free lane; advances by the lanes that each triangle takes */
    uint64_t smooth;  /* bit s: slot s is interpolated */
    uint64_t flat;    /* bit s: slot s is copied from the triangle's vertex 0 */
    uint64_t wrapped; /* bit s: slot s takes the shorter way around (render/draw/command.h) */
    uint32_t ignored; /* bits of clip codes whose planes do not clip */
    uint32_t points;  /* bit i: corner i of a triangle is drawn as a point, */
    uint32_t edges;   /* and the edge from corner i to the next as a line */
    const struct job *job;
    bool window; /* vertices are in the window: x, y, depth, 1/w */
};

/* The rest of a triangle: a convex polygon with the triangle's winding. */
struct clipped {
    int count; /* of vertices: 0, or 3 to CLIP_VERTICES_MAXIMUM */
    uint32_t lane[CLIP_VERTICES_MAXIMUM];
    uint32_t corners; /* bit i: vertex i is one of the triangle's */
    uint32_t points;  /* bit i: that corner is drawn as a point */
    uint32_t
        edges; /* bit i: the edge from vertex i to the next lies on one of the triangle's that are drawn */
};

/* A clipper for the batch of one draw, whose job it keeps. `varying` holds an enum interpolation for each
 * varying: those of the setup key. Position and clip code are always written; slots of varyings that are
 * INTERPOLATION_NONE never. The caller sets `window`, `ignored` and `wrapped`: with wrapped slots every
 * triangle and line has to come here, be it cut or not. */
struct clipper clipper_create(const struct job *job, const uint8_t varying[VARYING_COUNT], float *vertices,
                              uint32_t next);

/* Clips the triangle of lanes lane[0], lane[1], lane[2], none of whose codes has CLIP_INVALID. Writes the
 * lanes of the triangles that are left, a fan with the winding and the flat values of the original, and
 * returns how many, 0 to CLIP_TRIANGLES_MAXIMUM; all their codes are free of CLIP_NEEDED bits. Lanes below
 * `next` are never written. Returns -1 when the batch has too few free lanes: nothing has changed then, and
 * after the batch is set up and `next` taken back, CLIP_VERTICES_MAXIMUM free lanes are always enough. */
int clip_triangle(struct clipper *clipper, const uint32_t lane[3],
                  uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3]);

/* The same, but gives the polygon. Returns 0 with *clipped filled in, or -1. */
int clip_polygon(struct clipper *clipper, const uint32_t lane[3], struct clipped *clipped);

/* Clips the line from lane[0] to lane[1]. Returns 1 with the lanes of what is left, which has the flat values
 * of the original, in `left`; 0 when nothing is; -1 as clip_triangle does. */
int clip_line(struct clipper *clipper, const uint32_t lane[2], uint32_t left[2]);

#endif
