/* Pictures of a sampled texture, computed a second time in doubles and integers. The coordinates are exact in
 * binary, except on cubes. There, pixels are left out if rounding decides which texel they have. */
#ifndef TESTS_SUPPORT_PICTURE_SAMPLED_H
#define TESTS_SUPPORT_PICTURE_SAMPLED_H

#include "canvas.h"

#include <stdbool.h>

enum { SAMPLED_POINT, SAMPLED_LINEAR, SAMPLED_ANISOTROPIC };
enum {
    SAMPLED_WRAP,
    SAMPLED_MIRROR,
    SAMPLED_CLAMP,
    SAMPLED_BORDER,
    SAMPLED_MIRROR_ONCE,
    SAMPLED_ADDRESSINGS
};
enum { SAMPLED_MIP_NO, SAMPLED_MIP_NEAREST, SAMPLED_MIP_BOTH };

/* The bound texture, and the states of its sampler. */
struct sampled {
    enum triptych_texture_type type;
    int size[3], levels, faces;
    int address[3];
    int mag, min, mip, first, taps;
    double bias;
    bool late; /* textures are magnified up to the level 1/2 where that is a question of convention */
    bool wrapped; /* faces of cubes have the addresses, too */
};
extern struct sampled sampled;

/* Coordinates at the centre of the target, and their changes over its whole width and height. */
struct sampled_coordinates {
    double centre[3], across[3], down[3];
};

/* Coordinates that make texels larger than pixels, and smaller ones. No axis is parallel to those of
 * pixels. */
extern const struct sampled_coordinates sampled_magnified, sampled_minified;

/* Defines and binds a texture of random texels, and sets the other members of `sampled` to 0. */
void sampled_define(enum triptych_texture_type type, int width, int height, int depth, int levels);

/* Returns the word of a texel. */
uint32_t sampled_word(int face, int level, int index);

/* Draws with the sampling of `sampled`, and reads the picture. */
void sampled_show(const struct sampled_coordinates *c);

/* The same. Fails unless each pixel has the expected word, except pixels that are left out. */
void sampled_check(const struct sampled_coordinates *c);

/* Fails if more than this share of the pixels was left out since the last call. */
void sampled_expect_few_left_out(double share);

#endif
