/* Stage granularity in parts: a planner for each unit. */
#ifndef ENGINES_STITCH_STAGES_H
#define ENGINES_STITCH_STAGES_H

#include "engines/stitch/plan.h"

/* The offset of a field in the job. */
#define JOB(field) ((int32_t)offsetof(struct job, field))

/* The offset of a slot in a vertex batch. */
#define SLOT(name) (SLOT_##name * VERTEX_SLOT_BYTES)

typedef void stages_planner(struct plan *plan, const union key *key);
stages_planner stages_vertex, stages_setup, stages_pixel;

/* The pixel's distance from the triangle's origin. */
void stages_position(struct plan *plan);

/* Diffuse colour, texture samples and texture stages. */
void stages_shade(struct plan *plan, const struct pixel_key *key, const struct triangle_layout *layout);

/* Blending and the write to the target. */
void stages_target(struct plan *plan, const struct pixel_key *key);

#endif
