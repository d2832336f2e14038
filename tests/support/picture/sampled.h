/* Pictures of a sampled texture, computed a second time in doubles and integers, from coordinates that are
 * exact in binary; where a cube's are not, pixels too near to the next texel are left out. */
#ifndef TESTS_SUPPORT_PICTURE_SAMPLED_H
#define TESTS_SUPPORT_PICTURE_SAMPLED_H

#include "canvas.h"

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

/* A texture as it is bound, and how it is sampled. */
struct sampled {
    enum triptych_texture_type type;
    int size[3], levels, faces;
    int address[3];
    int mag, min, mip, first, taps;
    double bias;
};
extern struct sampled sampled;

/* Coordinates at the centre of the target, and their changes across and down the whole of it. */
struct sampled_coordinates {
    double centre[3], across[3], down[3];
};

/* Texels larger than pixels, and smaller ones, in directions of their own. */
extern const struct sampled_coordinates sampled_magnified, sampled_minified;

/* Defines and binds a texture of random texels; all else of `sampled` is 0. */
void sampled_define(enum triptych_texture_type type, int width, int height, int depth, int levels);

/* The texel's word. */
uint32_t sampled_word(int face, int level, int index);

/* Draws with the sampling of `sampled`, and reads the picture. */
void sampled_show(const struct sampled_coordinates *c);

/* The same; fails unless each pixel that is not left out is the expected one. */
void sampled_check(const struct sampled_coordinates *c);

/* Fails if more than the share of the pixels since the last call was left out. */
void sampled_expect_few_left_out(double share);

#endif
