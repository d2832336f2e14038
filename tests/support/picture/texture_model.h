/* A second implementation of samplers, in integers and binary64, with which tests compare the results of
 * lookups. It follows the definition in docs/shader-semantics.md; the headers of spec/texture/address.h,
 * sample.h, sample_float.h and detail.h define the filters.
 *
 * Textures are square, 8 texels a side, with all four levels. Their texels are random bytes, or multiples of
 * 1/64. Addresses wrap; on cubes they are clamped. Coordinates must be multiples of small powers of two, so
 * that products with sizes are exact. */
#ifndef TESTS_SUPPORT_PICTURE_TEXTURE_MODEL_H
#define TESTS_SUPPORT_PICTURE_TEXTURE_MODEL_H

#include "triptych.h"

enum { MODEL_SIDE = 8, MODEL_LEVELS = 4, MODEL_SLICES = 8 };

struct model_texture {
    enum triptych_texture_type type;
    int floats;
    float texel[MODEL_LEVELS][MODEL_SLICES][MODEL_SIDE][MODEL_SIDE]
               [4]; /* by level, slice or face, row and column; bytes are 0 to 255 */
    triptych_texture *texture;
};

enum { MODEL_MIP_NONE, MODEL_MIP_POINT, MODEL_MIP_LINEAR };

struct model_sampler {
    int mag, min; /* 1: linear */
    int mip;
    int first; /* maxmiplevel */
    double bias;
};

/* Makes the texture on the device, and binds it. */
void model_make(struct model_texture *texture, triptych_device *device, unsigned sampler,
                enum triptych_texture_type type, int floats);

/* Sets the sampler's states. */
void model_set(triptych_device *device, unsigned number, const struct model_sampler *sampler);

/* Returns 256 times the level of detail, computed from the changes of the coordinates to the next pixel in x
 * and in y. On cubes these are coordinates of the face. `more` is added to the level. Returns INT32_MIN if
 * the level is so near to a boundary that rounding decides. */
int model_lambda(const struct model_texture *texture, const struct model_sampler *sampler,
                 const double across[3], const double down[3], double more);

/* Returns the face's number for a vector, and the coordinates on the face in `place`. The major component
 * must be a power of two. */
int model_face(const double vector[3], double place[2]);

/* Samples at `v`, the coordinates in the shader; on cubes they are a vector. */
void model_sample(const struct model_texture *texture, const struct model_sampler *sampler, const double v[3],
                  int lambda_256, float result[4]);

#endif
