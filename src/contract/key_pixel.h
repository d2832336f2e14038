/* Values of the pixel key's fields: tests, texture stages, fog, blending, targets. */
#ifndef CONTRACT_KEY_PIXEL_H
#define CONTRACT_KEY_PIXEL_H

#include <stdbool.h>
#include <stdint.h>

/* `new COMPARE stored`, `alpha COMPARE reference`. A comparison and its opposite add up to ALWAYS. */
enum compare {
    COMPARE_NEVER,
    COMPARE_LESS,
    COMPARE_EQUAL,
    COMPARE_LESS_EQUAL,
    COMPARE_GREATER,
    COMPARE_NOT_EQUAL,
    COMPARE_GREATER_EQUAL,
    COMPARE_ALWAYS,
    COMPARE_COUNT
};

/* How a pixel's word holds depth and stencil (render/target/depth.h). */
enum depth_storage { DEPTH_FLOAT, DEPTH_UNORM, DEPTH_FLOAT24, DEPTH_UNORM32, DEPTH_STORAGE_COUNT };

/* DEPTH_FLOAT24 has 20 bits of fraction and 4 of exponent, whose bias is 15, so that 1 is 0xf00000. Below
 * NORMAL, 2^-14, depth is a multiple of 2^-34; above, it is binary32 less BIAS, cut to 20 bits of fraction.
 */
#define DEPTH_FLOAT24_NORMAL 0x1p-14f
#define DEPTH_FLOAT24_UNITS  0x1p34f
enum { DEPTH_FLOAT24_BIAS = (127 - 15) << 23 };

/* The number of stencil tests: none, one for all triangles, or one for each winding. */
enum stencil { STENCIL_OFF, STENCIL_ONE, STENCIL_TWO, STENCIL_COUNT };
enum { SIDE_CLOCKWISE, SIDE_COUNTERCLOCKWISE, STENCIL_SIDES };

/* The reference and masks of the tests: the first ones, those of counter-clockwise triangles, or with two
 * tests each side's own. */
enum stencil_values {
    STENCIL_VALUES_FIRST,
    STENCIL_VALUES_SECOND,
    STENCIL_VALUES_EACH,
    STENCIL_VALUES_COUNT
};

/* Changes of the stored stencil, in Direct3D's order. */
enum stencil_operation {
    STENCIL_KEEP,
    STENCIL_ZERO,
    STENCIL_REPLACE,
    STENCIL_INCREMENT_SATURATED,
    STENCIL_DECREMENT_SATURATED,
    STENCIL_INVERT,
    STENCIL_INCREMENT,
    STENCIL_DECREMENT,
    STENCIL_OPERATION_COUNT
};

/* Samples per pixel are a power of two; the key has its exponent. */
enum { SAMPLES_RADIX = 4, SAMPLES_MAXIMUM = 1 << (SAMPLES_RADIX - 1) };

/* The precision of functions in pixel routines (spec/math/approximate.h). */
enum precision { PRECISION_EXACT, PRECISION_PARTIAL, PRECISION_APPROXIMATE, PRECISION_COUNT };

/* Operations of a texture stage. */
enum stage {
#define STAGE_OPERATION(name, arguments, meaning) STAGE_##name,
#include "def/stage.def"
#undef STAGE_OPERATION
    STAGE_COUNT
};

/* The number of arguments that an operation reads, from the first on. */
extern const uint8_t stage_arguments[STAGE_COUNT];

/* A stage's argument is a source, plus flags: its alpha replaces its colour; it is subtracted from 1. CURRENT
 * and TEMPORARY are the results of earlier stages, at first diffuse and 0. */
enum source {
    SOURCE_DIFFUSE,
    SOURCE_TEXTURE,
    SOURCE_FACTOR,
    SOURCE_CURRENT,
    SOURCE_SPECULAR,
    SOURCE_TEMPORARY,
    SOURCE_CONSTANT,
    SOURCE_COUNT
};
enum {
    ARGUMENT_REPLICATE = SOURCE_COUNT,
    ARGUMENT_COMPLEMENT = 2 * SOURCE_COUNT,
    STAGE_ARGUMENT_RADIX = 4 * SOURCE_COUNT,
    STAGE_ARGUMENTS = 3
};

/* Bits: the channels of `current` that are multiplied by the stage's texture before the stage reads them. */
enum { PREMODULATE_COLOR = 1, PREMODULATE_ALPHA = 2, PREMODULATE_COUNT = 4 };

/* The texture of the stage before does nothing to a stage's texture, displaces it, or displaces and darkens
 * it. */
enum { BUMP_NONE, BUMP_DISPLACED, BUMP_LUMINANCE, BUMP_COUNT };

/* Stages of ps_1_1 to ps_1_3, and the coordinate that divides the others. */
enum { PROJECTED_STAGES = 4 };
enum { PROJECTED_NONE, PROJECTED_THIRD, PROJECTED_FOURTH, PROJECTED_COUNT };

/* The parts that a shader reads of the pixel's place besides x and y: depth, and 1/w. */
enum { PLACE_DEPTH = 1, PLACE_W = 2, PLACE_COUNT = 4 };

/* The origin of the fog factor: the vertex routine, or the pixel's depth z or distance w (spec/pixel/fog.h).
 */
enum fog {
    FOG_NONE,
    FOG_VARYING,
    FOG_LINEAR_Z,
    FOG_EXP_Z,
    FOG_EXP2_Z,
    FOG_LINEAR_W,
    FOG_EXP_W,
    FOG_EXP2_W,
    FOG_COUNT
};

/* Colour and alpha have a blending each. */
enum { BLEND_COLOR, BLEND_ALPHA, BLEND_CHANNELS };

/* Advanced blending (spec/pixel/advanced_blend.h). Those from HUE on mix the channels. */
enum advanced {
    ADVANCED_MULTIPLY,
    ADVANCED_SCREEN,
    ADVANCED_OVERLAY,
    ADVANCED_DARKEN,
    ADVANCED_LIGHTEN,
    ADVANCED_COLOR_DODGE,
    ADVANCED_COLOR_BURN,
    ADVANCED_HARD_LIGHT,
    ADVANCED_SOFT_LIGHT,
    ADVANCED_DIFFERENCE,
    ADVANCED_EXCLUSION,
    ADVANCED_HUE,
    ADVANCED_SATURATION,
    ADVANCED_COLOR,
    ADVANCED_LUMINOSITY,
    ADVANCED_COUNT
};

/* COPY, MINIMUM, MAXIMUM and advanced blending have no factors. ADVANCED + n is number n of enum advanced,
 * the same for colour and alpha. */
enum blend {
    BLEND_COPY,
    BLEND_ADD,
    BLEND_SUBTRACT, /* new - stored */
    BLEND_REVERSE_SUBTRACT,
    BLEND_MINIMUM,
    BLEND_MAXIMUM,
    BLEND_ADVANCED,
    BLEND_COUNT = BLEND_ADVANCED + (int)ADVANCED_COUNT
};

static inline bool blend_is_advanced(int blend)
{
    return blend >= BLEND_ADVANCED;
}

/* An odd one is 1 minus the even one before it. */
enum factor {
    FACTOR_ZERO,
    FACTOR_ONE,
    FACTOR_SOURCE_COLOR,
    FACTOR_INVERSE_SOURCE_COLOR,
    FACTOR_SOURCE_ALPHA,
    FACTOR_INVERSE_SOURCE_ALPHA,
    FACTOR_TARGET_ALPHA,
    FACTOR_INVERSE_TARGET_ALPHA,
    FACTOR_TARGET_COLOR,
    FACTOR_INVERSE_TARGET_COLOR,
    FACTOR_CONSTANT,
    FACTOR_INVERSE_CONSTANT,
    FACTOR_CONSTANT_ALPHA,
    FACTOR_INVERSE_CONSTANT_ALPHA,
    FACTOR_SECOND_COLOR, /* of the pixel's second colour, a shader's oC1 */
    FACTOR_INVERSE_SECOND_COLOR,
    FACTOR_SECOND_ALPHA,
    FACTOR_INVERSE_SECOND_ALPHA,
    FACTOR_SATURATED_ALPHA, /* min(new alpha, 1 - stored alpha), 1 for alpha */
    FACTOR_COUNT
};

static inline bool factor_is_second(int factor)
{
    return factor >= FACTOR_SECOND_COLOR && factor <= FACTOR_INVERSE_SECOND_ALPHA;
}

/* Returns true if the factors are f and 1 - f for some f other than 0 and 1. The sum of both products is then
 * rounded once. */
static inline bool blend_is_lerp(int blend, int source_factor, int target_factor)
{
    return blend == BLEND_ADD && source_factor > FACTOR_ONE && source_factor < FACTOR_SATURATED_ALPHA &&
           (source_factor ^ 1) == target_factor;
}

/* Operations on stored bits (spec/pixel/logic.h). The one that keeps what is stored is a mask that writes
 * nothing. */
enum logic {
    LOGIC_COPY,
    LOGIC_CLEAR,
    LOGIC_AND,
    LOGIC_AND_REVERSE,
    LOGIC_AND_INVERTED,
    LOGIC_XOR,
    LOGIC_OR,
    LOGIC_NOR,
    LOGIC_EQUIV,
    LOGIC_INVERT,
    LOGIC_OR_REVERSE,
    LOGIC_COPY_INVERTED,
    LOGIC_OR_INVERTED,
    LOGIC_NAND,
    LOGIC_SET,
    LOGIC_COUNT
};

/* The clip mask (spec/pixel/clip_mask.h): none, or the order of its texels. */
enum clip_mask { CLIP_MASK_NONE, CLIP_MASK_ROWS, CLIP_MASK_TILES, CLIP_MASK_COUNT };

/* The part of a pixel that a smooth primitive covers (spec/pixel/coverage.h): what bounds the primitive. */
enum coverage_form { COVERAGE_NONE, COVERAGE_EDGES, COVERAGE_LINE, COVERAGE_POINT, COVERAGE_COUNT };

enum { TARGETS = 4 };

/* How a target stores colours: the rows of def/state/target.def. */
enum target_storage {
#define TARGET(name, planes, red, green, blue, alpha, meaning) TARGET_##name,
#include "def/state/target.def"
#undef TARGET
    TARGET_COUNT
};

/* The planes of a tile that a target takes, and the bits of its channels; 0: floating point. */
extern const uint8_t storage_planes[TARGET_COUNT];
extern const uint8_t storage_bits[TARGET_COUNT][4];

/* Returns true if red, green and blue have less than 8 bits. */
static inline bool storage_is_narrow(int target)
{
    return storage_bits[target][0] && storage_bits[target][0] < 8;
}

#endif
