/* Values of the vertex and setup keys' fields: attributes, lights, fog, points, primitives. */
#ifndef CONTRACT_KEY_VERTEX_H
#define CONTRACT_KEY_VERTEX_H

#include <stdbool.h>
#include <stdint.h>

enum attribute {
#define ATTRIBUTE(name, word, usage, index, meaning) ATTRIBUTE_##name,
#include "def/state/attribute.def"
#undef ATTRIBUTE
    ATTRIBUTE_COUNT
};

/* How an attribute lies in memory: the rows of def/state/vertex_type.def. */
enum attribute_format {
    ATTRIBUTE_FORMAT_NONE,
#define VERTEX_TYPE(name, word, components, encoding, bits, divisor, meaning) ATTRIBUTE_FORMAT_##name,
#include "def/state/vertex_type.def"
#undef VERTEX_TYPE
    ATTRIBUTE_FORMAT_COUNT
};

enum vertex_encoding {
    ENCODING_NONE,
    ENCODING_FLOAT,
    ENCODING_COLOR,
    ENCODING_UNSIGNED,
    ENCODING_SIGNED,
    ENCODING_HALF
};

/* A row of def/state/vertex_type.def. */
struct vertex_type {
    const char *word;
    uint8_t components;
    uint8_t encoding; /* enum vertex_encoding */
    uint8_t bits;     /* of a component */
    uint8_t bytes;    /* of all components */
    float scale;      /* an integer component is multiplied by this */
};

/* By enum attribute_format; the row of NONE is zero. */
extern const struct vertex_type key_vertex_types[ATTRIBUTE_FORMAT_COUNT];

enum { LIGHT_COUNT = 8 };
enum { TEXCOORD_SETS = 8 }; /* sets of texture coordinates in a vertex */
enum { BLEND_MATRICES = 4, WORLD_MATRICES = 256 };
enum { CLIP_PLANES_USER = 6 };
enum { INPUTS = 16 }; /* v# of a vertex shader */

/* LIGHT_SPOT has a falloff of 1, LIGHT_SPOT_POWER any. */
enum light_type {
    LIGHT_NONE,
    LIGHT_DIRECTIONAL,
    LIGHT_POINT,
    LIGHT_SPOT,
    LIGHT_SPOT_POWER,
    LIGHT_TYPE_COUNT
};

/* The material's power: any, 1, or 0. */
enum highlight { HIGHLIGHT_NONE, HIGHLIGHT_POWER, HIGHLIGHT_LINEAR, HIGHLIGHT_FLAT, HIGHLIGHT_COUNT };

/* The reflectances of a material. Each can also come from the vertex's first or second colour. */
enum reflectance {
    REFLECTANCE_DIFFUSE,
    REFLECTANCE_AMBIENT,
    REFLECTANCE_SPECULAR,
    REFLECTANCE_EMISSIVE,
    REFLECTANCE_COUNT
};
enum reflectance_source {
    REFLECTANCE_MATERIAL,
    REFLECTANCE_DIFFUSE_COLOR,
    REFLECTANCE_SPECULAR_COLOR,
    REFLECTANCE_SOURCE_COUNT
};

enum vertex_fog {
    VERTEX_FOG_SPECULAR_ALPHA,
    VERTEX_FOG_EXP,
    VERTEX_FOG_EXP2,
    VERTEX_FOG_LINEAR,
    VERTEX_FOG_COUNT
};

/* The size of points. CONSTANT: the job's, in pixels. VERTEX: the vertex's, or the state's if the vertex has
 * none. SCALED: the same in camera units, scaled with distance. */
enum point_size { POINT_SIZE_CONSTANT, POINT_SIZE_VERTEX, POINT_SIZE_SCALED, POINT_SIZE_COUNT };

/* Texture coordinates: below TEXCOORD_SETS, that set of the vertex; else generated from camera space. */
enum coordinate {
    COORDINATE_NORMAL = TEXCOORD_SETS,
    COORDINATE_POSITION,
    COORDINATE_REFLECTION,
    COORDINATE_SPHERE,
    COORDINATE_COUNT
};

/* A setup record is a triangle, line or point; or, for triangles in wireframe or drawn as points, an
 * edge or corner, whose triangle still decides culling and depth bias. */
enum primitive {
    PRIMITIVE_TRIANGLE,
    PRIMITIVE_LINE,
    PRIMITIVE_POINT,
    PRIMITIVE_EDGE,
    PRIMITIVE_CORNER,
    PRIMITIVE_COUNT
};

/* The constant is a depth, or a number of steps of binary32 or of DEPTH_FLOAT24 at the triangle's depth. */
enum depth_bias {
    DEPTH_BIAS_NONE,
    DEPTH_BIAS_CONSTANT,
    DEPTH_BIAS_SLOPE,
    DEPTH_BIAS_FLOAT,
    DEPTH_BIAS_FLOAT_SLOPE,
    DEPTH_BIAS_FLOAT24,
    DEPTH_BIAS_FLOAT24_SLOPE,
    DEPTH_BIAS_COUNT
};

static inline bool depth_bias_has_slope(int bias)
{
    return bias == DEPTH_BIAS_SLOPE || bias == DEPTH_BIAS_FLOAT_SLOPE || bias == DEPTH_BIAS_FLOAT24_SLOPE;
}

enum cull { CULL_NONE, CULL_CLOCKWISE, CULL_COUNTERCLOCKWISE, CULL_COUNT };

/* Returns true if records of the primitive are squares. Only a point sprite's texture coordinates vary on
 * them. */
static inline bool primitive_is_point(int primitive)
{
    return primitive == PRIMITIVE_POINT || primitive == PRIMITIVE_CORNER;
}

/* Returns true if the primitive is part of a triangle, which has a winding and a slope. */
static inline bool primitive_has_area(int primitive)
{
    return primitive != PRIMITIVE_LINE && primitive != PRIMITIVE_POINT;
}

#endif
