/* A sampler written a second time, in integers and binary64, straight from the definition
 * (docs/shader-semantics.md, and spec/texture/address.h, sample.h, sample_float.h and detail.h for what
 * filters do): what lookups are held against.
 *
 * Textures are square, 8 texels a side, with all four levels; their texels are random bytes, or multiples of
 * 1/64. Addresses wrap, on cubes they are clamped. Coordinates are to be multiples of small powers of two, so
 * that products with sizes are exact. */
#ifndef TESTS_SUPPORT_PICTURE_TEXTURE_MODEL_H
#define TESTS_SUPPORT_PICTURE_TEXTURE_MODEL_H

#include "triptych.h"

enum { MODEL_SIDE = 8, MODEL_LEVELS = 4, MODEL_SLICES = 8 };

struct model_texture {
    enum triptych_texture_type type;
    int floats;
    float texel[MODEL_LEVELS][MODEL_SLICES][MODEL_SIDE][MODEL_SIDE]
               [4]; /* bytes as 0 to 255; slices, or faces */
    triptych_texture *texture;
};

enum { MODEL_MIP_NONE, MODEL_MIP_POINT, MODEL_MIP_LINEAR };

struct model_sampler {
    int mag, min; /* linear */
    int mip;
    int first; /* maxmiplevel */
    double bias;
};

/* Makes the texture on the device, and binds it. */
void model_make(struct model_texture *texture, triptych_device *device, unsigned sampler,
                enum triptych_texture_type type, int floats);

/* Sets the sampler's states. */
void model_set(triptych_device *device, unsigned number, const struct model_sampler *sampler);

/* 256 times the level for changes of the coordinates, in coordinates; INT32_MIN where rounding is too close a
 * call. `more` is added to the level. On cubes, of the place on the face. */
int model_lambda(const struct model_texture *texture, const struct model_sampler *sampler,
                 const double across[3], const double down[3], double more);

/* The place on the face that the vector meets, and the face's number. The major component is to be a power of
 * two. */
int model_face(const double vector[3], double place[2]);

/* The texel there. `v` as the shader gives it: on cubes a vector. */
void model_sample(const struct model_texture *texture, const struct model_sampler *sampler, const double v[3],
                  int lambda_256, float result[4]);

#endif
