/* Direct3D 9's formats as the front end needs them, read from the tables of the renderer. Formats have
 * D3DFORMAT numbers. */
#ifndef D3D9_FORMAT_H
#define D3D9_FORMAT_H

#include "triptych.h"
#include <stdbool.h>
#include <stdint.h>

enum d3d9_drawn {
    D3D9_DRAWN_NOTHING, /* not valid for targets */
    D3D9_DRAWN_COLOR,
    D3D9_DRAWN_DEPTH
};

enum d3d9_channel_kind {
    D3D9_CHANNEL_ZERO, /* not stored; the value is 0 */
    D3D9_CHANNEL_ONE,  /* not stored; the value is 1 */
    D3D9_CHANNEL_UNSIGNED,
    D3D9_CHANNEL_SIGNED,
    D3D9_CHANNEL_FLOAT
};

/* Where a channel is in a texel, in bits from the lowest. */
struct d3d9_channel {
    uint8_t kind, shift, bits;
};

struct d3d9_format {
    const char *name;
    uint32_t number;
    uint8_t bytes;  /* of a block */
    uint8_t side;   /* height of a block, in texels: 1 or 4 */
    uint8_t across; /* width of a block, in texels: 1, 2 or 4 */
    bool sampled;
    bool floats; /* more than 8 bits a channel, signed or floating point */
    bool packed; /* the channels define the texel */
    uint8_t drawn;
    uint8_t target;       /* of a colour: enum d3d9_target */
    uint8_t depth_format; /* of a depth: enum triptych_depth_format */
    struct d3d9_channel channel[4];
};

/* The precisions of colour targets. */
enum d3d9_target {
#define TARGET(name, ...) D3D9_TARGET_##name,
#include "def/state/target.def"
#undef TARGET
    D3D9_TARGET_COUNT
};

enum {
    D3D9_FORMAT_UNKNOWN = 0,
    D3D9_FORMAT_VERTEX_DATA = 100,
    D3D9_FORMAT_INDEX16 = 101,
    D3D9_FORMAT_INDEX32 = 102
};

/* Returns null if the table has no such format. */
const struct d3d9_format *d3d9_format_find(uint32_t number);
/* For tests: format `i` of the table, so that all are tried; null past the last. */
const struct d3d9_format *d3d9_format_at(unsigned i);

/* Returns true if a display can have the format: 16 or 32 bits without alpha. */
bool d3d9_format_is_display(uint32_t number);
/* Returns true if the texels are depth values, whether or not the renderer supports the format. */
bool d3d9_format_is_depth(const struct d3d9_format *);
/* The bytes of a row of blocks without padding, and the rows of blocks of an image. */
uint32_t d3d9_format_row_bytes(const struct d3d9_format *, uint32_t width);
uint32_t d3d9_format_rows(const struct d3d9_format *, uint32_t height);

#endif
