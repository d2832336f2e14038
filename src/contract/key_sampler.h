/* Values of the keys' fields about textures: kinds, filters, addressing. */
#ifndef CONTRACT_KEY_SAMPLER_H
#define CONTRACT_KEY_SAMPLER_H

#include <stdint.h>

/* The samplers of pixels, the first of them those of the texture stages; then the samplers of vertices. */
enum { PIXEL_SAMPLERS = 16, VERTEX_SAMPLERS = 4, SAMPLERS = PIXEL_SAMPLERS + VERTEX_SAMPLERS };

enum texture_kind { TEXTURE_NONE, TEXTURE_2D, TEXTURE_CUBE, TEXTURE_VOLUME, TEXTURE_KINDS };

/* Texels are bytes, bytes whose colours are sRGB, binary32, or depth that a coordinate is compared with. */
enum texel { TEXEL_BYTES, TEXEL_SRGB, TEXEL_FLOATS, TEXEL_COMPARE, TEXEL_COUNT };

/* How texels of at most two bytes are stored: the rows of def/state/compact.def. Others have a word or four
 * numbers. */
enum compact {
    COMPACT_NONE,
#define COMPACT(name, bytes, first, second, constant) COMPACT_##name,
#include "def/state/compact.def"
#undef COMPACT
    COMPACT_COUNT
};

struct compact_form {
    uint8_t bytes; /* of a texel */
    uint32_t first, second, constant;
};

extern const struct compact_form storage_compact[COMPACT_COUNT];

enum filter { FILTER_POINT, FILTER_LINEAR, FILTER_COUNT };
/* The filter beyond the level of detail 0; LATER: the other one beyond 1/2. Vertices have no ANISOTROPIC. */
enum minify { MINIFY_SAME, MINIFY_OTHER, MINIFY_LATER, MINIFY_ANISOTROPIC, MINIFY_COUNT };
enum mip { MIP_NONE, MIP_POINT, MIP_LINEAR, MIP_COUNT };
enum { ANISOTROPY_MAXIMUM = 16 };

/* WRAP_POWER and MIRROR_POWER are for an axis whose size is a power of two: a mask replaces the floor. */
enum address_mode {
    ADDRESS_WRAP,
    ADDRESS_WRAP_POWER,
    ADDRESS_CLAMP,
    ADDRESS_MIRROR,
    ADDRESS_MIRROR_POWER,
    ADDRESS_MIRROR_ONCE,
    ADDRESS_BORDER,
    ADDRESS_COUNT
};

/* One sampler of a key. */
struct sampler_key {
    uint8_t number;              /* 0 to SAMPLERS - 1 */
    uint8_t kind, texel;         /* enum texture_kind, enum texel */
    uint8_t compact;             /* enum compact */
    uint8_t tiled;               /* texels are in tiles: render/texture/order.h */
    uint8_t filter, minify, mip; /* enum filter, enum minify, enum mip */
    uint8_t anisotropy;          /* the largest number of taps; 0: one tap */
    uint8_t address[3];          /* enum address_mode, of u, v and w */
};

#endif
