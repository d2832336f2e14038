/* Varyings: the values that vertices hand to pixels, interpolated; and how shaders' inputs and outputs map to
 * them. */
#ifndef CONTRACT_VARYING_H
#define CONTRACT_VARYING_H

#include <stdbool.h>
#include <stdint.h>

/* Texture stages. Each has a channel: one set of texture coordinates that travels from vertex to pixel. */
enum { TEXTURE_STAGES = 8 };

enum varying {
#define VARYING(name, components, text) VARYING_##name,
#include "def/state/varying.def"
#undef VARYING
    VARYING_COUNT
};

enum interpolation { INTERPOLATION_NONE, INTERPOLATION_SMOOTH, INTERPOLATION_FLAT, INTERPOLATION_COUNT };

/* The components of each varying (def/state/varying.def), and its first slot in a vertex batch (layout.h). */
extern const uint8_t varying_components[VARYING_COUNT];
extern const uint8_t varying_slot[VARYING_COUNT];

/* A channel's varyings: two texture coordinates, the third coordinate, and the divisor. */
enum { VARYING_CHANNEL = VARYING_texcoord1 - VARYING_texcoord0 };
static inline int varying_texcoord(int channel)
{
    return VARYING_texcoord0 + VARYING_CHANNEL * channel;
}
static inline int varying_third(int channel)
{
    return VARYING_third0 + VARYING_CHANNEL * channel;
}
static inline int varying_divisor(int channel)
{
    return VARYING_divisor0 + VARYING_CHANNEL * channel;
}

/* Returns true if it is any of a channel's three. */
static inline bool varying_is_coordinate(int varying)
{
    return varying >= VARYING_texcoord0 && varying < VARYING_specular;
}

static inline bool varying_is_texcoord(int varying)
{
    return varying_is_coordinate(varying) && !((varying - VARYING_texcoord0) % VARYING_CHANNEL);
}

static inline bool varying_is_divisor(int varying)
{
    return varying >= VARYING_divisor0 && varying < VARYING_specular &&
           !((varying - VARYING_divisor0) % VARYING_CHANNEL);
}

/* The varying `blending`: a number, then a colour. Other numbers mean blending by the states. */
enum { BLENDING_NUMBER, BLENDING_COLOR, BLENDING_COMPONENTS = BLENDING_COLOR + 4 };
enum { BLENDING_SHADOW = 1, BLENDING_SUBPIXEL };

/* The axes of the target along which a plane may vary. */
enum axes { AXES_NONE = 0, AXES_X = 1, AXES_Y = 2, AXES_BOTH = AXES_X | AXES_Y };

/* The span classes of triangles (docs/spans.md). Each has a span reading of a pixel routine. In its blocks u
 * varies along x only, v along y only, and other varyings and 1/w are constant. 1/w is 1 in all of them but
 * SPAN_LEVEL. In SPAN_WHITE the diffuse colour is 1 in all components. In SPAN_GRADIENT and SPAN_FADE its
 * red, green and blue, or also its alpha, vary along both axes. Rounded to 0 to 255 these need no limits. */
enum span { SPAN_NONE, SPAN_WHITE, SPAN_LEVEL, SPAN_GRADIENT, SPAN_FADE, SPAN_COUNT };

/* Returns true if 1/w is 1 in blocks of the class. */
static inline bool span_has_unit_w(enum span span)
{
    return span != SPAN_NONE && span != SPAN_LEVEL;
}

/* Returns true if the varying's components are 1 in blocks of the class. */
static inline bool span_has_ones(enum span span, int varying)
{
    return span == SPAN_WHITE && varying == VARYING_diffuse;
}

/* The axes along which component c of a varying may vary in blocks of the class. */
static inline enum axes varying_span_axes(enum span span, int varying, int c)
{
    enum { ALPHA = 3 };
    if (varying_is_texcoord(varying))
        return c ? AXES_Y : AXES_X;
    return varying == VARYING_diffuse && span >= (c == ALPHA ? SPAN_FADE : SPAN_GRADIENT) ? AXES_BOTH
                                                                                          : AXES_NONE;
}

/* Ports: the varyings as shaders see them, of four components each. A channel's third coordinate and divisor
 * are the third and the fourth component of its port; shaders divide by themselves. */
enum { PORT_DIFFUSE, PORT_SPECULAR, PORT_CHANNEL, PORTS = PORT_CHANNEL + TEXTURE_STAGES };

/* The varying that holds component c of a port, and the component of that varying. */
static inline int port_varying(int port, int c)
{
    int channel = port - PORT_CHANNEL;
    if (port < PORT_CHANNEL)
        return port == PORT_DIFFUSE ? (int)VARYING_diffuse : (int)VARYING_specular;
    return c < 2 ? varying_texcoord(channel) : c == 2 ? varying_third(channel) : varying_divisor(channel);
}
static inline int port_component(int port, int c)
{
    return port < PORT_CHANNEL || c < 2 ? c : 0;
}

/* The source of a port's component: the fixed function; none, so that it has its default, 0 or 1; or
 * component c of the vertex shader's output o, as LINK_OUTPUT + 4 * o + c. */
enum { OUTPUTS = 16 };
enum { LINK_FIXED, LINK_ZERO, LINK_ONE, LINK_OUTPUT, LINK_COUNT = LINK_OUTPUT + 4 * OUTPUTS };

#endif
