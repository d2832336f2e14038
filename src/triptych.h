/* Triptych: a software renderer of the Direct3D 9 class whose pipeline runs on interchangeable engines.
 *
 * A device records state and draws, and renders them with the engine it was created with. Every engine gives
 * the same bytes. Calls on one device are made by one thread at a time; rendering itself uses the device's
 * threads.
 *
 * Conventions: row vectors (p' = p * M, matrices are m[row][column]); clip depth 0 to w; window y down, pixel
 * centres at half-integers (both unless triptych_set_convention says otherwise), top-left fill rule; colours
 * are red, green, blue, alpha from 0 to 1, or packed 0xAARRGGBB where said; images are rows from the top of
 * RGBA8 words, red in the lowest byte.
 *
 * Errors: a call that fails returns something else than TRIPTYCH_OK, changes nothing, and triptych_error()
 * gives one line that says what was wrong and what was expected. */
#ifndef TRIPTYCH_H
#define TRIPTYCH_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define TRIPTYCH_API __attribute__((visibility("default")))
#else
#define TRIPTYCH_API
#endif

#define TRIPTYCH_VERSION "0.1.0"

enum triptych_result {
    TRIPTYCH_OK = 0,
    TRIPTYCH_BAD_ARGUMENT, /* out of range, not finite, unknown */
    TRIPTYCH_BAD_CALL,     /* not possible in this state: no target, index past the buffer, ... */
    TRIPTYCH_UNSUPPORTED,  /* a state or value that Direct3D 9 has and this version does not */
    TRIPTYCH_NO_MEMORY,
    TRIPTYCH_ENGINE_FAILED, /* the engine cannot run here or could not build a routine */
    TRIPTYCH_FILE_FAILED    /* a recording could not be written */
};

typedef struct triptych_device triptych_device;
typedef struct triptych_buffer triptych_buffer;   /* vertices or indices */
typedef struct triptych_texture triptych_texture; /* 2D, cube or volume, with levels */
typedef struct triptych_shader triptych_shader;   /* of vertices or pixels */
typedef struct triptych_query triptych_query;     /* what the device finds out while it renders */

/* States, in three tables: of the device, of each sampler, of each texture stage. */
enum triptych_state {
#define STATE(number, name, kind, initial, units, support, test, meaning) TRIPTYCH_STATE_##name,
#include "def/state.def"
#undef STATE
    TRIPTYCH_STATE_COUNT
};

enum triptych_sampler_state {
#define SAMPLER_STATE(number, name, kind, initial, units, support, test, meaning) TRIPTYCH_SAMPLER_##name,
#include "def/sampler_state.def"
#undef SAMPLER_STATE
    TRIPTYCH_SAMPLER_STATE_COUNT
};

enum triptych_stage_state {
#define STAGE_STATE(number, name, kind, initial, units, support, test, meaning) TRIPTYCH_STAGE_##name,
#include "def/stage_state.def"
#undef STAGE_STATE
    TRIPTYCH_STAGE_STATE_COUNT
};

enum triptych_state_table {
    TRIPTYCH_RENDER_STATES,
    TRIPTYCH_SAMPLER_STATES,
    TRIPTYCH_STAGE_STATES,
    TRIPTYCH_STATE_TABLE_COUNT
};

/* Samplers 0 to 15 are those of pixels, the last four of vertex shaders (s0 to s3). */
enum { TRIPTYCH_VERTEX_SAMPLER = 16, TRIPTYCH_SAMPLERS = 20, TRIPTYCH_STAGES = 8 };

enum triptych_transform {
    TRIPTYCH_TRANSFORM_WORLD,
    TRIPTYCH_TRANSFORM_VIEW,
    TRIPTYCH_TRANSFORM_PROJECTION,
    TRIPTYCH_TRANSFORM_TEXTURE0,                                 /* and 7 more */
    TRIPTYCH_TRANSFORM_WORLD1 = TRIPTYCH_TRANSFORM_TEXTURE0 + 8, /* the second of 256 world matrices */
    TRIPTYCH_TRANSFORM_COUNT = TRIPTYCH_TRANSFORM_WORLD1 + 255
};

/* What the fixed-function pipeline reads of a vertex. */
enum triptych_attribute {
#define ATTRIBUTE(name, word, usage, index, meaning) TRIPTYCH_##name,
#include "def/attribute.def"
#undef ATTRIBUTE
    TRIPTYCH_ATTRIBUTE_COUNT
};

/* How an attribute lies in memory: Direct3D 9's D3DDECLTYPE, plus 1. */
enum triptych_format {
    TRIPTYCH_FORMAT_NONE, /* attribute not given */
#define VERTEX_TYPE(name, word, components, encoding, bits, divisor, meaning) TRIPTYCH_FORMAT_##name,
#include "def/vertex_type.def"
#undef VERTEX_TYPE
    TRIPTYCH_FORMAT_COUNT
};

/* Direct3D 9's D3DDECLUSAGE. */
enum triptych_usage {
    TRIPTYCH_USAGE_POSITION,
    TRIPTYCH_USAGE_BLENDWEIGHT,
    TRIPTYCH_USAGE_BLENDINDICES,
    TRIPTYCH_USAGE_NORMAL,
    TRIPTYCH_USAGE_PSIZE,
    TRIPTYCH_USAGE_TEXCOORD,
    TRIPTYCH_USAGE_TANGENT,
    TRIPTYCH_USAGE_BINORMAL,
    TRIPTYCH_USAGE_TESSFACTOR,
    TRIPTYCH_USAGE_POSITIONT,
    TRIPTYCH_USAGE_COLOR,
    TRIPTYCH_USAGE_FOG,
    TRIPTYCH_USAGE_DEPTH,
    TRIPTYCH_USAGE_SAMPLE,
    TRIPTYCH_USAGE_COUNT
};

/* How indexed draws step through a stream (Direct3D 9's stream frequency). */
enum triptych_frequency {
    TRIPTYCH_FREQUENCY_VERTEX,   /* with the vertex */
    TRIPTYCH_FREQUENCY_INDEXED,  /* with the vertex; stream 0: everything is drawn `count` times */
    TRIPTYCH_FREQUENCY_INSTANCE, /* with the instance: the next vertex after each `count` instances */
    TRIPTYCH_FREQUENCY_COUNT
};

/* Formats of textures and targets, by Direct3D 9's numbers; def/format.def says what each is. */
enum triptych_surface_format {
#define FORMAT(name, number, bytes, side, storage, roles, coding, red, green, blue, alpha)                   \
    TRIPTYCH_SURFACE_##name = number,
#include "def/format.def"
#undef FORMAT
};

enum triptych_texture_type {
    TRIPTYCH_TEXTURE_2D,
    TRIPTYCH_TEXTURE_CUBE,
    TRIPTYCH_TEXTURE_VOLUME,
    TRIPTYCH_TEXTURE_TYPE_COUNT
};

/* Faces of a cube texture, in Direct3D 9's order. */
enum triptych_face {
    TRIPTYCH_FACE_POSITIVE_X,
    TRIPTYCH_FACE_NEGATIVE_X,
    TRIPTYCH_FACE_POSITIVE_Y,
    TRIPTYCH_FACE_NEGATIVE_Y,
    TRIPTYCH_FACE_POSITIVE_Z,
    TRIPTYCH_FACE_NEGATIVE_Z
};

/* Formats of the depth surface (def/depth_format.def); TRIPTYCH_DEPTH_none is no surface. */
enum triptych_depth_format {
#define DEPTH_FORMAT(name, storage, depth_bits, stencil_bits, meaning) TRIPTYCH_DEPTH_##name,
#include "def/depth_format.def"
#undef DEPTH_FORMAT
    TRIPTYCH_DEPTH_COUNT
};

/* What triptych_clear_buffers sets. */
enum { TRIPTYCH_CLEAR_COLOR = 1, TRIPTYCH_CLEAR_DEPTH = 2, TRIPTYCH_CLEAR_STENCIL = 4 };

enum triptych_query_type {
    TRIPTYCH_QUERY_OCCLUSION, /* samples that passed alpha, stencil and depth test between begin and end */
    TRIPTYCH_QUERY_EVENT,     /* 1 once everything before its end is rendered */
    TRIPTYCH_QUERY_TIMESTAMP, /* nanoseconds of a monotonic clock when everything before its end was rendered
                               */
    TRIPTYCH_QUERY_COUNT
};

enum triptych_primitive {
    TRIPTYCH_TRIANGLE_LIST,
    TRIPTYCH_TRIANGLE_STRIP,
    TRIPTYCH_TRIANGLE_FAN,
    TRIPTYCH_POINT_LIST,
    TRIPTYCH_LINE_LIST,
    TRIPTYCH_LINE_STRIP,
    TRIPTYCH_PRIMITIVE_COUNT
};

/* Where interfaces differ: the first value of each is what a device begins with. */
enum triptych_convention {
    TRIPTYCH_PIXEL_CENTER,
    TRIPTYCH_DEPTH_RANGE,
    TRIPTYCH_MULTIPLY,
    TRIPTYCH_CONVENTION_COUNT
};
enum triptych_pixel_center {
    TRIPTYCH_PIXEL_CENTER_HALF,   /* pixel 0's centre is at 0.5, as in Direct3D 10 and OpenGL */
    TRIPTYCH_PIXEL_CENTER_INTEGER /* at 0, as in Direct3D 9 */
};
enum triptych_depth_range {
    TRIPTYCH_DEPTH_RANGE_ZERO, /* clip depth from 0 to w, as in Direct3D */
    TRIPTYCH_DEPTH_RANGE_MINUS /* from -w to w, as in OpenGL */
};
enum triptych_multiply {
    TRIPTYCH_MULTIPLY_IEEE,  /* shaders multiply as IEEE 754 says */
    TRIPTYCH_MULTIPLY_LEGACY /* 0 times anything is 0 in shaders, also infinity and NaN */
};

enum triptych_light_type { TRIPTYCH_LIGHT_DIRECTIONAL, TRIPTYCH_LIGHT_POINT, TRIPTYCH_LIGHT_SPOT };

enum {
    TRIPTYCH_LIGHTS = 8,
    TRIPTYCH_CLIP_PLANES = 6,
    TRIPTYCH_TARGETS = 4,
    TRIPTYCH_TARGET_MAXIMUM = 8192,
    TRIPTYCH_TEXTURE_MAXIMUM = 8192,
    TRIPTYCH_VOLUME_MAXIMUM = 2048
};
enum { TRIPTYCH_STREAMS = 16, TRIPTYCH_DECLARATION_ELEMENTS = 64, TRIPTYCH_USAGE_INDICES = 16 };

/* What a shader shades. */
enum triptych_shader_stage { TRIPTYCH_SHADER_VERTEX, TRIPTYCH_SHADER_PIXEL, TRIPTYCH_SHADER_STAGE_COUNT };

/* Registers of shader constants, of each stage. Shaders can read the first 256 floats (pixel shaders 224, in models
 * below 3.0 fewer) and 16 integers, those of the models for software (vs_2_sw, ps_3_sw) all of them. */
enum { TRIPTYCH_SHADER_FLOATS = 8192, TRIPTYCH_SHADER_INTEGERS = 2048, TRIPTYCH_SHADER_BOOLEANS = 16 };

struct triptych_options {
    const char *engine; /* name as listed by triptych_engine_name(); null: "specialize" */
    unsigned threads;   /* rendering threads, the caller's included; 0: as many as the process may run on */
    size_t cache_bytes; /* budget of the routine cache: beyond it, what is not in use leaves; 0: 16 MiB */
    int measure;        /* nonzero: time the calls of each routine (triptych_get_routine) */
    const char
        *debug; /* who is told of generated code: words of def/debug.def, comma-separated; null: those of the
                         * environment's TRIPTYCH_DEBUG */
};

/* A render target: one to four colours, each of a format that can be a target (def/format.def), and depth.
 * Zero in a field means what triptych_set_target gives: one colour, A8R8G8B8. What is drawn goes to all of
 * them. */
struct triptych_target_description {
    unsigned width, height; /* pixels, 1 to 8192 */
    enum triptych_depth_format depth_format;
    enum triptych_surface_format color_format[TRIPTYCH_TARGETS];
    unsigned samples; /* per pixel: 1 (or 0), or with one colour target 2, 4 or 8 */
};

/* One image of a texture: a level, of the face of a cube or the slice of a volume that `slice` numbers.
 * Without a texture it is colour target number `slice` of the target that triptych_set_target made, where
 * that is allowed, and no surface elsewhere. */
struct triptych_surface {
    triptych_texture *texture;
    unsigned level, slice;
};

/* Surfaces to draw to, all of one size, none of them twice. Without a depth texture the target has depth of
 * its own, which begins anew; a texture of a depth format brings its contents, stencil 0. */
struct triptych_target_textures {
    struct triptych_surface color[TRIPTYCH_TARGETS];
    struct triptych_surface depth;
    enum triptych_depth_format depth_format; /* without a depth texture */
};

/* Part of an image, in pixels. */
struct triptych_rectangle {
    unsigned x, y, width, height;
};

enum triptych_copy_filter { TRIPTYCH_COPY_POINT, TRIPTYCH_COPY_LINEAR, TRIPTYCH_COPY_COUNT };

/* One element of a vertex declaration. */
struct triptych_declaration_element {
    unsigned stream; /* 0 to 15 */
    size_t offset;   /* bytes from the vertex's start in its stream, a multiple of 4, at most 65532 */
    enum triptych_format format;
    enum triptych_usage usage;
    unsigned usage_index; /* 0 to 15 */
};

/* An attribute in a place of its own: where it lies within a vertex of its buffer. */
struct triptych_element {
    enum triptych_format format;
    triptych_buffer *buffer; /* null with FORMAT_NONE */
    size_t offset;           /* bytes of vertex 0's attribute from the buffer's start */
    size_t stride;           /* bytes from a vertex to the next, 0 to 65536 */
};

/* A texture to be created. Sides are 1 to 8192 texels, of a volume 1 to 2048; a cube is square. */
struct triptych_texture_description {
    enum triptych_texture_type type;
    enum triptych_surface_format format;
    unsigned width, height;
    unsigned depth;  /* of a volume; 1 otherwise */
    unsigned levels; /* each half the size of the one before; 0: down to a single texel */
};

/* Texels of a level: a rectangle of depth 1, or a box of a volume. */
struct triptych_box {
    unsigned x, y, z;
    unsigned width, height, depth;
};

struct triptych_viewport {
    float x, y, width, height;   /* pixels, inside the target */
    float depth_near, depth_far; /* 0 to 1 */
};

struct triptych_material {
    float diffuse[4];
    float ambient[4];
    float emissive[4];
    float specular[4];
    float power; /* of highlights, 0 or more */
};

/* World space. `direction` is the way the light travels (directional, spot); `position`, `range` and
 * `attenuation` are those of lights that have a place. A spot is full within the cone of angle `theta` (0 to
 * phi) and dark outside of that of `phi` (up to pi, radians, whole angles); between them the falloff-th
 * power. */
struct triptych_light {
    enum triptych_light_type type;
    float diffuse[4];
    float ambient[4];
    float position[3];
    float direction[3];
    float range;
    float attenuation[3];
    float specular[4];
    float theta, phi;
    float falloff;
};

enum triptych_support {
    TRIPTYCH_SUPPORT_YES,
    TRIPTYCH_SUPPORT_LATER, /* Direct3D 9 has it and this version does not */
    TRIPTYCH_SUPPORT_NEVER  /* nor will any other */
};

enum triptych_notation {
    TRIPTYCH_NOTATION_WORDS,       /* the values that triptych_value_at() gives, and no others */
    TRIPTYCH_NOTATION_NUMBER,      /* decimal */
    TRIPTYCH_NOTATION_HEXADECIMAL, /* colours 0xAARRGGBB, bits */
    TRIPTYCH_NOTATION_REAL         /* the bits of a finite float: triptych_float_bits() */
};

/* What values a state can have. */
struct triptych_kind {
    const char *name;
    enum triptych_notation notation;
    double first, last; /* unless WORDS: the range */
};

struct triptych_value {
    const struct triptych_kind *kind;
    const char *word;
    uint32_t number; /* Direct3D 9's */
    enum triptych_support support;
};

/* A row of a table of states. States that are not supported can only be set to their default. */
struct triptych_state_row {
    unsigned number; /* Direct3D 9's */
    const char *name;
    const struct triptych_kind *kind;
    const char
        *units; /* keys it enters: letters of V vertex, S setup, P pixel; "job" if none, "-" if ignored */
    enum triptych_support support;
    const char *test; /* file that shows that it works, from the folder tests; "" if none does */
    const char *meaning;
};

/* Counters since the device was created. Draws, their primitives and the cache count when a draw is recorded,
 * all else when it is rendered. Lines and points count as triangles. */
struct triptych_statistics {
    uint64_t draws, triangles;
    uint64_t vertices_shaded, triangles_set_up, triangles_visible;
    uint64_t pixels_shaded;                             /* pixels covered, hidden ones included */
    uint64_t cache_hits, cache_misses, cache_evictions; /* of vertex, setup and pixel routines */
    /* Monotonic clock, summed over threads. */
    uint64_t vertex_ns; /* geometry phase: vertex, clip, setup, bin */
    uint64_t pixel_ns;  /* tile phase: rasterize, pixel */
};

/* A routine the device has built, as triptych_routine() reports it. Strings live until the next call. */
struct triptych_routine_info {
    uint32_t number;  /* identity in dumps, from 1 */
    const char *unit; /* "vertex", "setup", "pixel" */
    const char *key;  /* key text */
    uint64_t build_ns;
    uint64_t hits;
    uint32_t code_bytes;
    uint32_t parts; /* instructions or fragments */
    uint32_t spills;
    uint32_t fused;    /* of a routine's operation fragments, those that are two operations or more */
    uint32_t carried;  /* operands that its fragments found in registers */
    uint64_t run_ns;   /* of all calls, and the vertices, triangles or covered pixels that they were for, */
    uint64_t elements; /* if the device measures them */
    uint32_t shader;   /* number of the shader that it runs; 0: none */
    const char *granularity; /* of a stitched routine's fragments: "stage" or "operation"; null of others */
};

/* Creates a device. On failure *device is null and the reason is in `reason` (of `size` bytes, may be null).
 */
TRIPTYCH_API enum triptych_result triptych_device_create(const struct triptych_options *options,
                                                         triptych_device **device, char *reason, size_t size);
/* Frees the device and everything made with it. Null is allowed. */
TRIPTYCH_API void triptych_device_destroy(triptych_device *device);
/* The reason of the last failed call; an empty string when none failed. */
TRIPTYCH_API const char *triptych_error(const triptych_device *device);

/* The first reason why something that options.debug asks for is not done, such as a file that cannot be written; an empty
 * string while all is. Never a reason for anything else to fail. Valid until asked again. */
TRIPTYCH_API const char *triptych_debug_error(triptych_device *device);

/* The i-th engine's name, description, lanes (0: chosen for each routine) and why it cannot run here (null: it can); null past the last.
 * The reason is the calling thread's until it asks again. */
TRIPTYCH_API const char *triptych_engine_name(unsigned i);
TRIPTYCH_API const char *triptych_engine_description(unsigned i);
TRIPTYCH_API unsigned triptych_engine_width(unsigned i);
TRIPTYCH_API const char *triptych_engine_unavailable(unsigned i);

/* The render target, colour RGBA8 and depth binary32, 1 to 8192 pixels a side; contents start as zero and
 * depth 1. Sets the viewport to the whole target with depth 0 to 1, and the scissor rectangle to the whole
 * target. */
TRIPTYCH_API enum triptych_result triptych_set_target(triptych_device *, unsigned width, unsigned height);
/* The same with formats of choice. */
TRIPTYCH_API enum triptych_result triptych_set_target_description(triptych_device *,
                                                                  const struct triptych_target_description *);

/* Draws to textures from here on, and back to the target that was set before, contents unchanged, when it is
 * null. Either sets viewport and scissor rectangle as triptych_set_target does, which ends drawing to
 * textures too. A texture that is drawn to cannot be sampled at the same time. */
TRIPTYCH_API enum triptych_result triptych_set_target_textures(triptych_device *,
                                                               const struct triptych_target_textures *);

/* Copies a part of a surface to a part of another one (null, or of width 0: all of it), scaled if their sizes
 * differ, and converted to the other's format, which must be one that can be drawn to; formats of depth
 * cannot be copied. */
TRIPTYCH_API enum triptych_result triptych_copy(triptych_device *, const struct triptych_surface *source,
                                                const struct triptych_rectangle *source_part,
                                                const struct triptych_surface *target,
                                                const struct triptych_rectangle *target_part,
                                                enum triptych_copy_filter filter);

/* A surface's texels, as RGBA8 words or as four numbers each, like triptych_read_target. */
TRIPTYCH_API enum triptych_result triptych_read_surface(triptych_device *, const struct triptych_surface *,
                                                        uint32_t *rgba);
TRIPTYCH_API enum triptych_result triptych_read_surface_numbers(triptych_device *,
                                                                const struct triptych_surface *, float *rgba);

/* Copies `bytes` (1 to 2^31 - 1) of data; the contents never change. */
TRIPTYCH_API enum triptych_result triptych_buffer_create(triptych_device *, const void *data, size_t bytes,
                                                         triptych_buffer **buffer);
/* Frees a buffer, after rendering what is recorded; where it was bound nothing is. Null is allowed. */
TRIPTYCH_API enum triptych_result triptych_buffer_destroy(triptych_device *, triptych_buffer *);
/* Copies an image of width x height (1 to 8192) RGBA8 texels. */
TRIPTYCH_API enum triptych_result triptych_texture_create(triptych_device *, const void *rgba, unsigned width,
                                                          unsigned height, triptych_texture **texture);

/* A texture whose texels are all what zeros in its format mean. */
TRIPTYCH_API enum triptych_result
triptych_texture_define(triptych_device *, const struct triptych_texture_description *description,
                        triptych_texture **texture);
/* Copies texels in the texture's format to a part of a level (null: all of it). `face` is 0 but for cubes. A
 * compressed format's part begins at multiples of 4 texels and ends at them or with the level. Rows of texels
 * or blocks lie `row_pitch` bytes apart, slices of a volume `slice_pitch`. Draws recorded before read what
 * was there before; that may mean rendering them first. */
TRIPTYCH_API enum triptych_result triptych_texture_update(triptych_device *, triptych_texture *texture,
                                                          unsigned face, unsigned level,
                                                          const struct triptych_box *box, const void *data,
                                                          size_t row_pitch, size_t slice_pitch);
/* Makes every level but the first from the one before it: a texel is the mean of those it covers, in formats of
 * more than 8 bits a channel to the precision of binary32. */
TRIPTYCH_API enum triptych_result triptych_texture_generate_mips(triptych_device *,
                                                                 triptych_texture *texture);
/* Frees a texture, after rendering what is recorded; where it was set there is none, and if it is drawn to, drawing goes
 * back to the target. Null is allowed. */
TRIPTYCH_API enum triptych_result triptych_texture_destroy(triptych_device *, triptych_texture *);

/* Shaders, of the models 1.1 to 3.0 (docs/shaders.md). From bytecode: tokens as they lie in memory, from the version
 * token to the end token, or from assembly text. Either is copied. `name` begins the reasons of a shader that is
 * refused: "NAME: token N: ...", "NAME:LINE:COLUMN: ..."; null: "shader". */
TRIPTYCH_API enum triptych_result triptych_shader_create(triptych_device *, const char *name,
                                                         const void *code, size_t bytes,
                                                         triptych_shader **shader);
TRIPTYCH_API enum triptych_result triptych_shader_assemble(triptych_device *, const char *name,
                                                           const char *text, size_t bytes,
                                                           triptych_shader **shader);
/* Frees a shader, after rendering what is recorded; where it was set the pipeline becomes the fixed one. Null is
 * allowed. */
TRIPTYCH_API enum triptych_result triptych_shader_destroy(triptych_device *, triptych_shader *);
/* Which of them it is, and the name of its model ("vs_2_0"). */
TRIPTYCH_API enum triptych_shader_stage triptych_shader_get_stage(const triptych_shader *);
TRIPTYCH_API const char *triptych_shader_get_model(const triptych_shader *);

TRIPTYCH_API enum triptych_result triptych_set_state(triptych_device *, enum triptych_state, uint32_t value);
TRIPTYCH_API enum triptych_result triptych_set_sampler_state(triptych_device *, unsigned sampler,
                                                             enum triptych_sampler_state, uint32_t value);
TRIPTYCH_API enum triptych_result triptych_set_stage_state(triptych_device *, unsigned stage,
                                                           enum triptych_stage_state, uint32_t value);
/* The value that states of notation REAL take for a number. */
static inline uint32_t triptych_float_bits(float number)
{
    union {
        float number;
        uint32_t bits;
    } both = {number};
    return both.bits;
}
TRIPTYCH_API enum triptych_result triptych_set_transform(triptych_device *, enum triptych_transform,
                                                         const float matrix[4][4]);
TRIPTYCH_API enum triptych_result triptych_set_viewport(triptych_device *, const struct triptych_viewport *);
/* The rectangle, in pixels inside the target, that draws and clears stay in while the state scissortestenable
 * is on; an empty one lets nothing through. The whole target after set_target. */
TRIPTYCH_API enum triptych_result triptych_set_scissor(triptych_device *, unsigned x, unsigned y,
                                                       unsigned width, unsigned height);
/* Plane `i` (0 to 5) of world space: with bit i of the state clipplaneenable on, what is drawn is cut to
 * x a + y b + z c + d >= 0. Zero at first: everything is inside. */
TRIPTYCH_API enum triptych_result triptych_set_clip_plane(triptych_device *, unsigned i,
                                                          const float plane[4]);
/* Value: a number of enum triptych_pixel_center, triptych_depth_range or triptych_multiply. */
TRIPTYCH_API enum triptych_result triptych_set_convention(triptych_device *, enum triptych_convention,
                                                          unsigned value);
TRIPTYCH_API enum triptych_result triptych_set_material(triptych_device *, const struct triptych_material *);
TRIPTYCH_API enum triptych_result triptych_set_light(triptych_device *, unsigned index,
                                                     const struct triptych_light *);
TRIPTYCH_API enum triptych_result triptych_enable_light(triptych_device *, unsigned index, int enable);
/* Sampler i is texture stage i's and s# of a pixel shader; TRIPTYCH_VERTEX_SAMPLER + i is s# of a vertex
 * shader. Null unbinds: what of a stage reads the texture then passes the current colour, and shaders sample
 * (0, 0, 0, 1). */
TRIPTYCH_API enum triptych_result triptych_set_texture(triptych_device *, unsigned sampler,
                                                       triptych_texture *);

/* What draws are shaded by; null: the fixed-function pipeline. */
TRIPTYCH_API enum triptych_result triptych_set_vertex_shader(triptych_device *, triptych_shader *);
TRIPTYCH_API enum triptych_result triptych_set_pixel_shader(triptych_device *, triptych_shader *);

/* Constants of a stage's shaders: `count` registers from `first` on, of four floats, four integers (those of a loop:
 * count, start, step, unused; of a rep: count) or one Boolean each. All are zero at first, and stay when another
 * shader is set. What a shader defines itself goes before them, in that shader. Draws recorded before keep what was
 * set then. */
TRIPTYCH_API enum triptych_result triptych_set_shader_floats(triptych_device *, enum triptych_shader_stage,
                                                             unsigned first, const float *values,
                                                             unsigned count);
TRIPTYCH_API enum triptych_result triptych_set_shader_integers(triptych_device *, enum triptych_shader_stage,
                                                               unsigned first, const int32_t *values,
                                                               unsigned count);
TRIPTYCH_API enum triptych_result triptych_set_shader_booleans(triptych_device *, enum triptych_shader_stage,
                                                               unsigned first, const int32_t *values,
                                                               unsigned count);

/* Says where in its stream each attribute lies: count (0 to 64) elements, none of them twice the same usage
 * and index. Attributes that it does not mention are not given. A vertex with POSITIONT is drawn where it
 * says. */
TRIPTYCH_API enum triptych_result
triptych_set_declaration(triptych_device *, const struct triptych_declaration_element *elements,
                         unsigned count);
/* Sets the declaration that a code of Direct3D 9's D3DFVF values means: all of it in stream 0. */
TRIPTYCH_API enum triptych_result triptych_set_fvf(triptych_device *, uint32_t fvf);
/* Stream 0 to 15: vertices of `stride` bytes (0 to 65536; 0: all the same) from `offset` on, multiples of 4.
 * Null unbinds. */
TRIPTYCH_API enum triptych_result triptych_set_stream(triptych_device *, unsigned stream, triptych_buffer *,
                                                      size_t offset, size_t stride);
/* count is 1 with FREQUENCY_VERTEX, else 1 to 2^30 - 1. Stream 0 cannot have FREQUENCY_INSTANCE. */
TRIPTYCH_API enum triptych_result triptych_set_stream_frequency(triptych_device *, unsigned stream,
                                                                enum triptych_frequency, uint32_t count);
/* Declares one attribute and gives it a stream that no other has. */
TRIPTYCH_API enum triptych_result triptych_set_element(triptych_device *, enum triptych_attribute,
                                                       const struct triptych_element *);
/* bits is 16 or 32; null unbinds. */
TRIPTYCH_API enum triptych_result triptych_set_indices(triptych_device *, triptych_buffer *, unsigned bits);

/* Draws `count` primitives (triangles, lines, points) from vertex `first` on. */
TRIPTYCH_API enum triptych_result triptych_draw(triptych_device *, enum triptych_primitive, uint32_t first,
                                                uint32_t count);
/* Draws `count` primitives whose vertices are base + indices from `first` on. */
TRIPTYCH_API enum triptych_result triptych_draw_indexed(triptych_device *, enum triptych_primitive,
                                                        int32_t base, uint32_t first, uint32_t count);

/* Clears the viewport's pixels, within the scissor rectangle if its test is on: colour (unless null) and
 * depth (0 to 1, unless negative). */
TRIPTYCH_API enum triptych_result triptych_clear(triptych_device *, const float color[4], float depth);

/* The same for any of the three surfaces (a sum of TRIPTYCH_CLEAR_...). The stencil's value is cut to its
 * bits; colour, depth and stencil are looked at only if they are cleared. Depth and stencil must exist. */
TRIPTYCH_API enum triptych_result triptych_clear_buffers(triptych_device *, unsigned flags,
                                                         const float color[4], float depth, unsigned stencil);

/* Queries. Begin and end may come again; an end without a begin fails, but for an event and a timestamp,
 * which have none. */
TRIPTYCH_API enum triptych_result triptych_query_create(triptych_device *, enum triptych_query_type,
                                                        triptych_query **query);
TRIPTYCH_API enum triptych_result triptych_query_begin(triptych_device *, triptych_query *);
TRIPTYCH_API enum triptych_result triptych_query_end(triptych_device *, triptych_query *);
/* The result of a query that has ended, after finishing. */
TRIPTYCH_API enum triptych_result triptych_query_result(triptych_device *, triptych_query *,
                                                        uint64_t *result);
/* Frees a query, also one that has begun. Null is allowed. */
TRIPTYCH_API enum triptych_result triptych_query_destroy(triptych_device *, triptych_query *);

/* Recording of calls, into a container of draws (docs/container.md), while they run: everything that pictures depend on,
 * with the memory that it reads. What lives on the device when it starts is written first, so that it may start at any
 * time. triptych_finish ends a frame of the recording. Failures to write are told when it stops, and then there is no file;
 * until it stops there is none of that name either. A device that is destroyed stops its recording.
 *
 * With TRIPTYCH_RECORD=PATH in the environment, every device that a process creates is recorded from its creation on; all
 * but the first have a number in front of the path's extension. */
TRIPTYCH_API enum triptych_result triptych_record_start(triptych_device *, const char *path);
TRIPTYCH_API enum triptych_result triptych_record_stop(triptych_device *);

/* Renders everything recorded so far. */
TRIPTYCH_API enum triptych_result triptych_finish(triptych_device *);

/* Finishes and copies the target: width * height RGBA8 words, depth values from 0 to 1, or stencil values. */
TRIPTYCH_API enum triptych_result triptych_read_color(triptych_device *, uint32_t *rgba);
TRIPTYCH_API enum triptych_result triptych_read_depth(triptych_device *, float *depth);
TRIPTYCH_API enum triptych_result triptych_read_stencil(triptych_device *, uint8_t *stencil);
/* Colour target t, from 0, as RGBA8 words (what has more than that is clamped to 0..1 and rounded), or as
 * four numbers a pixel, exactly. */
TRIPTYCH_API enum triptych_result triptych_read_target(triptych_device *, unsigned t, uint32_t *rgba);
TRIPTYCH_API enum triptych_result triptych_read_target_numbers(triptych_device *, unsigned t, float *rgba);
/* The same of one sample of each pixel, as it is, of colour target 0; what is null is not copied. The calls
 * above give the average of all samples' colours (of bytes rounded to nearest, halves up) and sample 0's
 * depth and stencil. */
TRIPTYCH_API enum triptych_result triptych_read_sample(triptych_device *, unsigned sample, uint32_t *rgba,
                                                       float *depth, uint8_t *stencil);
/* All that is drawn to as it is stored, every sample, depth and stencil included, which can be written back where the
 * target is described the same; none without a target. */
TRIPTYCH_API size_t triptych_contents_bytes(const triptych_device *);
TRIPTYCH_API enum triptych_result triptych_read_contents(triptych_device *, void *data);
TRIPTYCH_API enum triptych_result triptych_write_contents(triptych_device *, const void *data, size_t bytes);
/* The same of all texels of a texture: face by face, level by level, RGBA8 words or four binary32 a texel. */
TRIPTYCH_API size_t triptych_texture_texel_bytes(const triptych_texture *);
TRIPTYCH_API enum triptych_result triptych_texture_read_texels(triptych_device *, triptych_texture *,
                                                               void *data);
TRIPTYCH_API enum triptych_result triptych_texture_write_texels(triptych_device *, triptych_texture *,
                                                                const void *data, size_t bytes);
/* The target's description, its first colour's format included; all zero without one. */
TRIPTYCH_API void triptych_get_target(const triptych_device *, struct triptych_target_description *);
/* Whether 8 unsigned bits a channel hold all that a surface of the format can. */
TRIPTYCH_API int triptych_format_is_bytes(enum triptych_surface_format);
/* The bits of depth and of stencil of a format; its name, null when there is none. */
TRIPTYCH_API unsigned triptych_depth_bits(enum triptych_depth_format);
TRIPTYCH_API unsigned triptych_stencil_bits(enum triptych_depth_format);
TRIPTYCH_API const char *triptych_depth_format_name(enum triptych_depth_format);
TRIPTYCH_API void triptych_target_size(const triptych_device *, unsigned *width, unsigned *height);

TRIPTYCH_API void triptych_get_statistics(const triptych_device *, struct triptych_statistics *);
/* The i-th routine in the cache, in order of number; returns 0 past the last. */
TRIPTYCH_API int triptych_get_routine(triptych_device *, unsigned i, struct triptych_routine_info *);

/* The tables of states: a table's name ("state", "sampler", "stage") and how many of each of its states a
 * device has (1, TRIPTYCH_SAMPLERS, TRIPTYCH_STAGES); a table's rows, whose numbers are the enumerators of
 * the table's states (null past the last); the default of row `row` of sampler or stage `i`. */
TRIPTYCH_API const char *triptych_table_name(enum triptych_state_table);
TRIPTYCH_API unsigned triptych_table_size(enum triptych_state_table);
TRIPTYCH_API const struct triptych_state_row *triptych_state_at(enum triptych_state_table, unsigned row);
TRIPTYCH_API uint32_t triptych_state_default(enum triptych_state_table, unsigned row, unsigned i);

/* Kinds, and the values of a kind with words, null past the last; the value with a number and its word (null
 * if there is none); a word's number (returns nonzero if there is none). */
TRIPTYCH_API const struct triptych_kind *triptych_kind_at(unsigned i);
TRIPTYCH_API const struct triptych_value *triptych_value_at(const struct triptych_kind *, unsigned i);
TRIPTYCH_API const struct triptych_value *triptych_value_find(const struct triptych_kind *, uint32_t number);
TRIPTYCH_API const char *triptych_value_word(const struct triptych_kind *, uint32_t number);
TRIPTYCH_API int triptych_value_number(const struct triptych_kind *, const char *word, uint32_t *number);

#ifdef __cplusplus
}
#endif

#endif
