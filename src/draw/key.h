/* Keys: the part of the state that generated code depends on, one structure per unit, and their packed form.
 *
 * The fields are the rows of def/key.def, each a small integer. Packing is mixed radix (thesis, section 3.6):
 * the fields in table order are the digits of one big number, least significant first, kept in 64-bit words
 * so that no digit straddles two words. Two keys are equal exactly when their packed words are equal byte for
 * byte. Nothing that is a pointer or data is ever in a key. */
#ifndef DRAW_KEY_H
#define DRAW_KEY_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum unit { UNIT_VERTEX, UNIT_SETUP, UNIT_PIXEL, UNIT_COUNT };

enum attribute {
#define ATTRIBUTE(name, word, usage, index, meaning) ATTRIBUTE_##name,
#include "def/attribute.def"
#undef ATTRIBUTE
    ATTRIBUTE_COUNT
};

/* How an attribute lies in memory: the rows of def/vertex_type.def. */
enum attribute_format {
    ATTRIBUTE_FORMAT_NONE,
#define VERTEX_TYPE(name, word, components, encoding, bits, divisor, meaning) ATTRIBUTE_FORMAT_##name,
#include "def/vertex_type.def"
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

/* A row of def/vertex_type.def. */
struct vertex_type {
    const char *word;
    uint8_t components;
    uint8_t encoding; /* enum vertex_encoding */
    uint8_t bits;     /* of a component */
    uint8_t bytes;    /* of all, in whole 32-bit words */
    float scale;      /* what an integer is multiplied by */
};

/* By enum attribute_format; all zero for NONE. */
extern const struct vertex_type vertex_types[ATTRIBUTE_FORMAT_COUNT];

enum { LIGHT_COUNT = 8 };
/* Stages, channels of texture coordinates that travel to the pixel, and sets of them that vertices have. */
enum { TEXTURE_STAGES = 8, TEXCOORD_SETS = 8 };
/* Of pixels, the first of them the texture stages', and behind them those of vertices. */
enum { PIXEL_SAMPLERS = 16, VERTEX_SAMPLERS = 4, SAMPLERS = PIXEL_SAMPLERS + VERTEX_SAMPLERS };

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

/* What a material says, and where else it can come from: the vertex's first or second colour. */
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

/* The size of points: the job's; the vertex's, or its state; that in the camera's units, shrunk by distance.
 */
enum point_size { POINT_SIZE_CONSTANT, POINT_SIZE_VERTEX, POINT_SIZE_SCALED, POINT_SIZE_COUNT };

/* Texture coordinates: one of the vertex's sets, or what is generated from camera space. */
enum coordinate {
    COORDINATE_NORMAL = TEXCOORD_SETS,
    COORDINATE_POSITION,
    COORDINATE_REFLECTION,
    COORDINATE_SPHERE,
    COORDINATE_COUNT
};

enum { BLEND_MATRICES = 4, WORLD_MATRICES = 256 };

enum varying {
#define VARYING(name, components, text) VARYING_##name,
#include "def/varying.def"
#undef VARYING
    VARYING_COUNT
};

/* The varyings of a channel of texture coordinates. */
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

static inline int varying_is_texcoord(int varying)
{
    return varying >= VARYING_texcoord0 && varying < VARYING_specular &&
           !((varying - VARYING_texcoord0) % VARYING_CHANNEL);
}
/* Whether it is one of a channel's three. */
static inline int varying_is_coordinate(int varying)
{
    return varying >= VARYING_texcoord0 && varying < VARYING_specular;
}

static inline int varying_is_divisor(int varying)
{
    return varying >= VARYING_divisor0 && varying < VARYING_specular &&
           !((varying - VARYING_divisor0) % VARYING_CHANNEL);
}

/* Ports: what shaders see of the varyings, of four components each. A channel's third coordinate and its divisor are
 * the third and the fourth component; shaders divide by themselves. */
enum { PORT_DIFFUSE, PORT_SPECULAR, PORT_CHANNEL, PORTS = PORT_CHANNEL + TEXTURE_STAGES };

/* The varying that component c of a port is in, and which of its components that is. */
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

/* Where a component comes from: the fixed function; nowhere, so that it has its default; or component c of output o of
 * the vertex shader, LINK_OUTPUT + 4 * o + c. */
enum { INPUTS = 16, OUTPUTS = 16 };
enum { LINK_FIXED, LINK_NONE, LINK_OUTPUT, LINK_COUNT = LINK_OUTPUT + 4 * OUTPUTS };

/* Stages of ps_1_1 to ps_1_3, and which of their coordinates divides the others. */
enum { PROJECTED_STAGES = 4 };
enum { PROJECTED_NONE, PROJECTED_THIRD, PROJECTED_FOURTH, PROJECTED_COUNT };

enum interpolation { INTERPOLATION_NONE, INTERPOLATION_SMOOTH, INTERPOLATION_FLAT, INTERPOLATION_COUNT };

/* What setup makes of its vertices: a record for each triangle, line or point drawn, or for each edge or
 * corner of a triangle that is drawn in wireframe or as points, which then decides about culling and depth
 * bias. */
enum primitive {
    PRIMITIVE_TRIANGLE,
    PRIMITIVE_LINE,
    PRIMITIVE_POINT,
    PRIMITIVE_EDGE,
    PRIMITIVE_CORNER,
    PRIMITIVE_COUNT
};

enum depth_bias { DEPTH_BIAS_NONE, DEPTH_BIAS_CONSTANT, DEPTH_BIAS_SLOPE, DEPTH_BIAS_COUNT };

enum { CLIP_PLANES_USER = 6 };

enum cull { CULL_NONE, CULL_CLOCKWISE, CULL_COUNTERCLOCKWISE, CULL_COUNT };

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

/* How a pixel's word holds depth and stencil (draw/depth.h). */
enum depth_storage { DEPTH_FLOAT, DEPTH_UNORM, DEPTH_FLOAT24, DEPTH_UNORM32, DEPTH_STORAGE_COUNT };

/* DEPTH_FLOAT24 has 20 bits of fraction and 4 of exponent, whose bias is 15, so that 1 is 0xf00000. Below
 * NORMAL, 2^-14, depth is a multiple of 2^-34; above, it is binary32 less BIAS, cut to 20 bits of fraction.
 */
#define DEPTH_FLOAT24_NORMAL 0x1p-14f
#define DEPTH_FLOAT24_UNITS  0x1p34f
enum { DEPTH_FLOAT24_BIAS = (127 - 15) << 23 };

/* How many stencil tests there are: one for all triangles, or one for each winding. */
enum stencil { STENCIL_OFF, STENCIL_ONE, STENCIL_TWO, STENCIL_COUNT };
enum { SIDE_CLOCKWISE, SIDE_COUNTERCLOCKWISE, STENCIL_SIDES };

/* What becomes of the stored stencil, in Direct3D's order. */
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

enum texture_kind { TEXTURE_NONE, TEXTURE_2D, TEXTURE_CUBE, TEXTURE_VOLUME, TEXTURE_KINDS };
/* What texels are: bytes, bytes whose colours are sRGB, binary32, or depth that coordinates are compared
 * with. */
enum texel { TEXEL_BYTES, TEXEL_SRGB, TEXEL_FLOATS, TEXEL_COMPARE, TEXEL_COUNT };
/* Samples per pixel are a power of two; the key has its exponent. */
enum { SAMPLES_RADIX = 4, SAMPLES_MAXIMUM = 1 << (SAMPLES_RADIX - 1) };

enum filter { FILTER_POINT, FILTER_LINEAR, FILTER_COUNT };
enum minify { MINIFY_SAME, MINIFY_OTHER, MINIFY_ANISOTROPIC, MINIFY_COUNT };
enum mip { MIP_NONE, MIP_POINT, MIP_LINEAR, MIP_COUNT };
enum { ANISOTROPY_MAXIMUM = 16 };

/* WRAP_POWER and MIRROR_POWER are for an axis whose size is a power of two: a mask instead of a floor. */
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

/* Operations of a texture stage, the ones that Direct3D 9's reduce to (draw/derive.c); spec/stage.h defines
 * them. DOT gives all four channels. */
enum stage {
    STAGE_SELECT,
    STAGE_MODULATE,
    STAGE_MODULATE_2X,
    STAGE_MODULATE_4X,
    STAGE_ADD,
    STAGE_ADD_SIGNED,
    STAGE_ADD_SIGNED_2X,
    STAGE_SUBTRACT,
    STAGE_MULTIPLY_ADD,
    STAGE_LERP,
    STAGE_DOT,
    STAGE_COUNT
};

/* Arguments of a stage: a source, whether its alpha replaces its colour, and whether it is subtracted from 1.
 * CURRENT and TEMPORARY are what earlier stages left, at first diffuse and 0. */
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

/* Bits: which channels of `current` are multiplied by the stage's texture before the stage reads them. */
enum { PREMODULATE_COLOR = 1, PREMODULATE_ALPHA = 2, PREMODULATE_COUNT = 4 };

/* What the texture of the stage before does to a stage's: nothing, displace it, darken it as well. */
enum { BUMP_NONE, BUMP_DISPLACED, BUMP_LUMINANCE, BUMP_COUNT };

/* Where the fog factor comes from: the vertex routine, or the pixel's depth z or its distance w (spec/fog.h).
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

/* Colour and alpha are blended alike when their operations and factors are the same. */
enum { BLEND_COLOR, BLEND_ALPHA, BLEND_CHANNELS };

/* COPY, MINIMUM and MAXIMUM have no factors. */
enum blend {
    BLEND_COPY,
    BLEND_ADD,
    BLEND_SUBTRACT, /* new - stored */
    BLEND_REVERSE_SUBTRACT,
    BLEND_MINIMUM,
    BLEND_MAXIMUM,
    BLEND_COUNT
};

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
    FACTOR_SATURATED_ALPHA, /* min(new alpha, 1 - stored alpha), 1 for alpha */
    FACTOR_COUNT
};

/* How a target stores colours; def/target.def. */
enum target_storage {
#define TARGET(name, planes, red, green, blue, alpha, meaning) TARGET_##name,
#include "def/target.def"
#undef TARGET
    TARGET_COUNT
};

enum { TARGETS = 4 };

/* Planes of a tile that a target takes, and bits of its channels; 0: floating point. */
extern const uint8_t target_planes[TARGET_COUNT];
extern const uint8_t target_bits[TARGET_COUNT][4];

/* Whether red, green and blue have less than 8 bits. */
static inline int target_is_narrow(int target)
{
    return target_bits[target][0] && target_bits[target][0] < 8;
}

struct vertex_key {
#define KEY_vertex(field, count) uint8_t field count;
#define KEY_setup(field, count)
#define KEY_pixel(field, count)
#define KEY(unit, field, radix, meaning)         KEY_##unit(field, )
#define KEYS(unit, field, count, radix, meaning) KEY_##unit(field, [count])
#include "def/key.def"
#undef KEY_vertex
#undef KEY_setup
};

struct setup_key {
#define KEY_vertex(field, count)
#define KEY_setup(field, count) uint8_t field count;
#include "def/key.def"
#undef KEY_setup
#undef KEY_pixel
};

struct pixel_key {
#define KEY_setup(field, count)
#define KEY_pixel(field, count) uint8_t field count;
#include "def/key.def"
#undef KEY_vertex
#undef KEY_setup
#undef KEY_pixel
#undef KEY
#undef KEYS
};

/* What a key says of one sampler. */
struct sampler_key {
    uint8_t number;              /* 0 to SAMPLERS - 1 */
    uint8_t kind, texel;         /* enum texture_kind, enum texel */
    uint8_t filter, minify, mip; /* enum filter, enum minify, enum mip */
    uint8_t anisotropy;          /* the most taps; 0 if there is but one */
    uint8_t address[3];          /* enum address_mode, of u, v and w */
};

union key {
    struct vertex_key vertex;
    struct setup_key setup;
    struct pixel_key pixel;
};

/* Both are checked against def/key.def when key.c is compiled. */
enum { KEY_PACKED_WORDS = 40, KEY_TEXT_CAPACITY = 16384 };

/* The label of a routine: compared (key_equal) and hashed as bytes, never looked into. A unit's keys all have
 * the same number of words, those that its fields need; nothing is said of the words behind. */
struct packed_key {
    uint32_t words;
    uint64_t word[KEY_PACKED_WORDS];
};

/* One field of one unit's key, as the table describes it. */
struct key_field {
    const char *name;
    const char *meaning;
    uint16_t offset; /* bytes from the start of the unit's key */
    uint8_t count;   /* 1, or the length of an array */
    uint16_t radix;  /* values are 0 to radix - 1 */
};

/* The number of the program that a key's field says; 0: no shader. */
static inline uint32_t key_program(const uint8_t shader[4])
{
    return shader[0] | (uint32_t)shader[1] << 8 | (uint32_t)shader[2] << 16 | (uint32_t)shader[3] << 24;
}

static inline void key_set_program(uint8_t shader[4], uint32_t number)
{
    for (int i = 0; i < 4; i++)
        shader[i] = (uint8_t)(number >> 8 * i);
}

/* The program of a unit's key, or null if it has none. */
const struct program *key_shader(enum unit unit, const union key *key);

/* How many of its arguments an operation reads, from the first on. */
extern const uint8_t stage_arguments[STAGE_COUNT];

/* A stage's arguments: 1, 2 and 0. */
static inline const uint8_t *color_arguments(const struct pixel_key *key, int stage)
{
    return key->color_argument + STAGE_ARGUMENTS * stage;
}
static inline const uint8_t *alpha_arguments(const struct pixel_key *key, int stage)
{
    return key->alpha_argument + STAGE_ARGUMENTS * stage;
}

/* Whether a stage treats alpha like a fourth channel of colour, and whether it reads a source at all. */
int stage_is_joint(const struct pixel_key *key, int stage);
int stage_reads(const struct pixel_key *key, int stage, enum source source);

extern const char *const unit_name[UNIT_COUNT]; /* "vertex", "setup", "pixel" */

/* The fields of a unit's key in packing order; *count receives how many. */
const struct key_field *key_fields(enum unit unit, size_t *count);

/* Packs a key whose every field is below its radix; unpacking gives the same fields back. */
struct packed_key key_pack(enum unit unit, const union key *key);
void key_unpack(enum unit unit, const struct packed_key *packed, union key *key);

/* The first of `count` bytes of a key, or of an array in one, that is not 0, from number `at` on; `count` if
 * there is none. Most bytes of most keys are 0. */
static inline unsigned key_next(const uint8_t *bytes, unsigned at, unsigned count)
{
    for (uint64_t word; at + sizeof word <= count; at += sizeof word) {
        memcpy(&word, bytes + at, sizeof word);
        if (word)
            return at + (unsigned)__builtin_ctzll(word) / 8;
    }
    while (at < count && !bytes[at])
        at++;
    return at;
}

/* 64-bit hash of the unit and the packed words (xxHash). */
uint64_t key_hash(enum unit unit, const struct packed_key *packed);

/* Whether two packed keys of one unit are the same. */
int key_equal(const struct packed_key *a, const struct packed_key *b);

/* The channels that reach any target. */
static inline int pixel_write_mask(const struct pixel_key *key)
{
    int mask = 0;
    for (int t = 0; t < TARGETS; t++)
        mask |= key->write_mask[t];
    return mask;
}

/* Whether records of the primitive are squares, on which nothing but a point sprite's texture coordinates
 * varies. */
static inline int primitive_is_point(int primitive)
{
    return primitive == PRIMITIVE_POINT || primitive == PRIMITIVE_CORNER;
}

/* Whether it is part of a triangle, which has a winding and a slope. */
static inline int primitive_has_area(int primitive)
{
    return primitive != PRIMITIVE_LINE && primitive != PRIMITIVE_POINT;
}

/* Sampler i of pixels: texture stage i's, or s# of a pixel shader. */
static inline struct sampler_key pixel_sampler(const struct pixel_key *key, int i)
{
    return (struct sampler_key){
        .number = (uint8_t)i,
        .kind = key->texture[i],
        .texel = key->texel[i],
        .filter = key->filter[i],
        .minify = key->minify[i],
        .mip = key->mip[i],
        .anisotropy = key->anisotropy[i],
        .address = {key->address_u[i], key->address_v[i], key->address_w[i]},
    };
}

/* Sampler i of vertices: s# of a vertex shader. Vertices have no neighbours, so nothing is anisotropic. */
static inline struct sampler_key vertex_sampler(const struct vertex_key *key, int i)
{
    return (struct sampler_key){
        .number = (uint8_t)(PIXEL_SAMPLERS + i),
        .kind = key->texture[i],
        .texel = key->texel[i],
        .filter = key->filter[i],
        .minify = key->minify[i],
        .mip = key->mip[i],
        .address = {key->address_u[i], key->address_v[i], key->address_w[i]},
    };
}

/* Whether the pixel routine compares or writes depth. */
static inline int pixel_tests_depth(const struct pixel_key *key)
{
    return key->depth_function != COMPARE_ALWAYS || key->depth_write;
}

/* The stencil tests that the word has room for. */
static inline int pixel_stencil(const struct pixel_key *key)
{
    int room = key->depth_format == DEPTH_UNORM || key->depth_format == DEPTH_FLOAT24;
    return room ? key->stencil : STENCIL_OFF;
}

static inline int pixel_writes_stencil(const struct pixel_key *key)
{
    int writes = 0;
    for (int i = 0; i < pixel_stencil(key); i++)
        writes |= key->stencil_fail[i] | key->stencil_depth_fail[i] | key->stencil_pass[i];
    return writes;
}

/* Whether anything remains of what the pixel routine finds, other than colour. */
static inline int pixel_leaves_traces(const struct pixel_key *key)
{
    return key->depth_write || key->count || pixel_writes_stencil(key);
}

/* Whether shading decides which pixels are left, and whether tests wait for it. */
static inline int pixel_discards(const struct pixel_key *key)
{
    return key->alpha_discard || key->kills;
}
static inline int pixel_waits(const struct pixel_key *key)
{
    return pixel_discards(key) || key->depth_output;
}

/* Whether the pixel routine computes colours: to write them, or to find what is kept, or how deep it is. */
static inline int pixel_shades(const struct pixel_key *key)
{
    return pixel_write_mask(key) || (pixel_waits(key) && pixel_leaves_traces(key));
}

static inline int fog_reads_depth(int fog)
{
    return fog >= FOG_LINEAR_Z && fog <= FOG_EXP2_Z;
}

/* Whether the pixel routine looks at the triangle's depth, and at w other than to interpolate. */
static inline int pixel_reads_depth(const struct pixel_key *key)
{
    int tested = pixel_tests_depth(key) && !key->depth_w && !key->depth_output;
    return tested || (pixel_shades(key) && fog_reads_depth(key->fog));
}

static inline int pixel_reads_w(const struct pixel_key *key)
{
    int tested = pixel_tests_depth(key) && key->depth_w && !key->depth_output;
    return tested || (pixel_shades(key) && key->fog >= FOG_LINEAR_W);
}

/* Whether alpha is blended otherwise than colour. */
static inline int blend_is_separate(const struct pixel_key *key)
{
    return key->blend[BLEND_COLOR] != key->blend[BLEND_ALPHA] ||
           key->source_factor[BLEND_COLOR] != key->source_factor[BLEND_ALPHA] ||
           key->target_factor[BLEND_COLOR] != key->target_factor[BLEND_ALPHA];
}

/* Whether the factors are f and 1 - f for some f other than 0 and 1: the sum of both products is then rounded
 * once. */
static inline int blend_is_lerp(int blend, int source_factor, int target_factor)
{
    return blend == BLEND_ADD && source_factor > FACTOR_ONE && source_factor < FACTOR_SATURATED_ALPHA &&
           (source_factor ^ 1) == target_factor;
}

/* Writes `field=value field=v,v,v ...`, fields that are zero and zeros that end an array left out ("default"
 * when all are zero), and returns text. */
char *key_print(enum unit unit, const union key *key, char text[KEY_TEXT_CAPACITY]);

/* Reads what key_print writes. Returns 0, or -1 with *where at the offending character. */
int key_parse(enum unit unit, const char *text, union key *key, const char **where);

/* A key with every field drawn uniformly from its radix; *seed advances (xorshift64*, non-zero). */
void key_random(enum unit unit, uint64_t *seed, union key *key);

#endif
