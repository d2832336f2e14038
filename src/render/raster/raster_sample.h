/* Rasterization for targets with several samples per pixel.
 *
 * A sample at a distance from its pixel's centre is covered when the shape, moved by that distance the other
 * way, covers the pixel: the rules for edges, diamonds and squares hold at every sample as they do at
 * centres. */
#ifndef RENDER_RASTER_RASTER_SAMPLE_H
#define RENDER_RASTER_RASTER_SAMPLE_H

#include "render/raster/raster.h"

/* How a draw takes its samples; one sample is the pixel's centre. */
struct sampling {
    uint8_t samples; /* 2^samples per pixel */
    bool centers;    /* all have the centre's coverage */
    uint8_t mask;    /* bit i: sample i can be covered; all of them with one sample */
};

/* As the functions of struct rasterizer, for all samples together: what any of them may cover. */
bool raster_sampled_bounds(const struct sampling *sampling, enum raster_shape shape,
                           const struct triangle_head *head, const struct rectangle *limit,
                           struct rectangle *bounds);

/* The tiles of a range that a record may touch. */
struct sampled_raster {
    struct raster raster[SAMPLES_MAXIMUM];
    int count; /* of those that touch anything */
};

void raster_sampled_prepare(struct sampled_raster *raster, const struct sampling *sampling,
                            enum raster_shape shape, const struct triangle_head *head,
                            const struct rectangle *scissor);
bool raster_sampled_touches(const struct sampled_raster *raster, int column, int row);

/* Appends up to TILE_BLOCKS entries to the list from number `first` on; returns how many. */
uint32_t raster_sampled_tile(const struct sampling *sampling, enum raster_shape shape,
                             const struct triangle_head *head, const struct rectangle *scissor, int column,
                             int row, uint32_t record, struct entry_list *list, uint32_t first);

#endif
