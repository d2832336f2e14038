/* The forms of animations, for animation.c. */
#ifndef IMAGE_ANIMATION_PART_H
#define IMAGE_ANIMATION_PART_H

#include "image/animation.h"

/* Write the frame animation->added, whose size is that of the animation, with what comes before it. */
int apng_frame(struct animation *animation, const uint32_t *rgba, struct error *error);
int y4m_frame(struct animation *animation, const uint32_t *rgba, struct error *error);

/* Writes what comes after all frames. */
int apng_end(struct animation *animation, struct error *error);

#endif
