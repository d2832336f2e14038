/* The words of one pixel of a target, as they are stored. */
#ifndef COMMAND_INSPECT_PIXEL_H
#define COMMAND_INSPECT_PIXEL_H

#include "render/target/target.h"

struct pixel_words {
    uint32_t color[SAMPLES_MAXIMUM][TARGET_PLANES]; /* of each sample, the planes of all targets in turn */
    uint32_t depth[SAMPLES_MAXIMUM];                /* 0 if the target has no depth */
};

/* Reads the words of a pixel of the target, whose queued draws are rendered. */
void pixel_read(struct target *target, uint32_t x, uint32_t y, struct pixel_words *words);

#endif
