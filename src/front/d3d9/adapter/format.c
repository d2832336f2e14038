#include "format.h"
#include <stddef.h>

enum { DEPTH_FORMAT_NOT_DRAWN = TRIPTYCH_DEPTH_NONE };

#define U(shift, bits)                                                                                       \
    {                                                                                                        \
        D3D9_CHANNEL_UNSIGNED, shift, bits                                                                   \
    }
#define S(shift, bits)                                                                                       \
    {                                                                                                        \
        D3D9_CHANNEL_SIGNED, shift, bits                                                                     \
    }
#define F(shift, bits)                                                                                       \
    {                                                                                                        \
        D3D9_CHANNEL_FLOAT, shift, bits                                                                      \
    }
#define ZERO                                                                                                 \
    {                                                                                                        \
        D3D9_CHANNEL_ZERO, 0, 0                                                                              \
    }
#define ONE                                                                                                  \
    {                                                                                                        \
        D3D9_CHANNEL_ONE, 0, 0                                                                               \
    }
#define TEXTURE       1
#define COMPARE       1
#define RGBA8         0
#define A8            0
#define L8            0
#define R8            0
#define A8L8          0
#define R8G8          0
#define FLOAT4        1
#define NOTHING       D3D9_DRAWN_NOTHING, 0, DEPTH_FORMAT_NOT_DRAWN
#define COLOR(target) D3D9_DRAWN_COLOR, D3D9_TARGET_##target, DEPTH_FORMAT_NOT_DRAWN
#define DEPTH(format) D3D9_DRAWN_DEPTH, 0, TRIPTYCH_DEPTH_##format
#define PACKED        1
#define NORMAL        0
#define DXT1          0
#define DXT3          0
#define DXT5          0
#define ATI1          0
#define ATI2          0

/* Formats that share colours between two texels have blocks of 2 x 1 texels. The renderer has none. */
#define ACROSS(number, side)                                                                                 \
    ((number) == TRIPTYCH_SURFACE_UYVY || (number) == TRIPTYCH_SURFACE_YUY2 ||                               \
             (number) == TRIPTYCH_SURFACE_R8G8_B8G8 || (number) == TRIPTYCH_SURFACE_G8R8_G8B8                \
         ? 2                                                                                                 \
         : (side))

/* `drawn` expands to three values. */
#define FORMAT(name, number, bytes, side, storage, sampled, drawn, coding, red, green, blue, alpha)          \
    {#name,   number,  bytes,  side,  ACROSS(number, side),                                                  \
     sampled, storage, coding, drawn, {red, green, blue, alpha}},

static const struct d3d9_format formats[] = {
#include "def/state/format.def"
};

enum { FORMATS = sizeof formats / sizeof *formats };

const struct d3d9_format *d3d9_format_find(uint32_t number)
{
    for (unsigned i = 0; i < FORMATS; i++)
        if (formats[i].number == number)
            return &formats[i];
    return NULL;
}

const struct d3d9_format *d3d9_format_at(unsigned i)
{
    return i < FORMATS ? &formats[i] : NULL;
}

bool d3d9_format_is_display(uint32_t number)
{
    return number == TRIPTYCH_SURFACE_X8R8G8B8 || number == TRIPTYCH_SURFACE_R5G6B5 ||
           number == TRIPTYCH_SURFACE_X1R5G5B5;
}

bool d3d9_format_is_depth(const struct d3d9_format *format)
{
    const struct d3d9_channel *red = &format->channel[0], *alpha = &format->channel[3];
    return format->drawn == D3D9_DRAWN_DEPTH || format->number == TRIPTYCH_SURFACE_D24FS8 ||
           (red->bits && alpha->bits && red->shift == alpha->shift);
}

uint32_t d3d9_format_row_bytes(const struct d3d9_format *format, uint32_t width)
{
    return (width + format->across - 1) / format->across * format->bytes;
}

uint32_t d3d9_format_rows(const struct d3d9_format *format, uint32_t height)
{
    return (height + format->side - 1) / format->side;
}
