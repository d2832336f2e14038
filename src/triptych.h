/* Triptych: a software renderer of the Direct3D 9 class whose pipeline runs on interchangeable engines.
 *
 * A device stores state and draws, and renders them with the engine it was created with. All engines produce
 * the same bytes. Only one thread at a time may call functions of a device. Rendering uses the threads of the
 * device.
 *
 * Conventions:
 * - Vectors are rows: p' = p * M. Matrices are m[row][column].
 * - Clip depth is 0 to w, unless triptych_set_convention changes it.
 * - In the window y points down, and the fill rule is top-left. Pixel centres are at half-integers. For y and
 *   centres triptych_set_convention has other conventions.
 * - Colours are red, green, blue, alpha from 0 to 1. Packed colours are 0xAARRGGBB.
 * - Images are rows of RGBA8 words from the top, with red in the lowest byte.
 *
 * Errors: a call that fails returns a value other than TRIPTYCH_OK and changes nothing. triptych_error() then
 * returns one line with the cause and the expected input. */
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

/* The version of this header. triptych_version() returns that of the library in the same form. Versions with
 * the same major number are compatible, except that before 1.0.0 a new minor number may change anything. */
#define TRIPTYCH_VERSION_MAJOR 0
#define TRIPTYCH_VERSION_MINOR 2
#define TRIPTYCH_VERSION_PATCH 0
#define TRIPTYCH_VERSION       "0.2.0"

enum triptych_result {
    TRIPTYCH_OK = 0,
    TRIPTYCH_BAD_ARGUMENT, /* out of range, not finite, or unknown */
    TRIPTYCH_BAD_CALL,     /* invalid in the current state, such as a draw without a target */
    TRIPTYCH_UNSUPPORTED,  /* a state or value of Direct3D 9 that this version does not implement */
    TRIPTYCH_NO_MEMORY,
    TRIPTYCH_ENGINE_FAILED, /* the engine cannot run here or could not build a routine */
    TRIPTYCH_FILE_FAILED    /* a recording could not be written */
};

typedef struct triptych_device triptych_device;
typedef struct triptych_buffer triptych_buffer;   /* vertices or indices */
typedef struct triptych_texture triptych_texture; /* 2D, cube or volume, with levels */
typedef struct triptych_image triptych_image;     /* a surface that is drawn to and not sampled */
typedef struct triptych_shader triptych_shader;   /* of vertices or pixels */
typedef struct triptych_query triptych_query;     /* a measurement during rendering */

/* Enumerations that follow from tables: states and the words of their values, vertex attributes, and formats.
 * `make` writes them from src/def/state, and joins them with this file when it installs it. */
#include "triptych_words.h"

/* States, in three tables. */
enum triptych_state_table {
    TRIPTYCH_RENDER_STATES,
    TRIPTYCH_SAMPLER_STATES,
    TRIPTYCH_STAGE_STATES,
    TRIPTYCH_STATE_TABLE_COUNT
};

/* Samplers 0 to 15 belong to pixels. The last four are s0 to s3 of vertex shaders. */
enum { TRIPTYCH_VERTEX_SAMPLER = 16, TRIPTYCH_SAMPLERS = 20, TRIPTYCH_STAGES = 8 };

enum triptych_transform {
    TRIPTYCH_TRANSFORM_WORLD,
    TRIPTYCH_TRANSFORM_VIEW,
    TRIPTYCH_TRANSFORM_PROJECTION,
    TRIPTYCH_TRANSFORM_TEXTURE0,
    TRIPTYCH_TRANSFORM_TEXTURE1,
    TRIPTYCH_TRANSFORM_TEXTURE2,
    TRIPTYCH_TRANSFORM_TEXTURE3,
    TRIPTYCH_TRANSFORM_TEXTURE4,
    TRIPTYCH_TRANSFORM_TEXTURE5,
    TRIPTYCH_TRANSFORM_TEXTURE6,
    TRIPTYCH_TRANSFORM_TEXTURE7,
    TRIPTYCH_TRANSFORM_WORLD1, /* the second of 256 world matrices */
    TRIPTYCH_TRANSFORM_COUNT = TRIPTYCH_TRANSFORM_WORLD1 + 255
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
    TRIPTYCH_FREQUENCY_VERTEX,   /* once per vertex */
    TRIPTYCH_FREQUENCY_INDEXED,  /* once per vertex; on stream 0 also the number of instances, `count` */
    TRIPTYCH_FREQUENCY_INSTANCE, /* once per `count` instances */
    TRIPTYCH_FREQUENCY_COUNT
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

/* Flags of triptych_clear_buffers. */
enum { TRIPTYCH_CLEAR_COLOR = 1, TRIPTYCH_CLEAR_DEPTH = 2, TRIPTYCH_CLEAR_STENCIL = 4 };

enum triptych_query_type {
    /* samples that passed the alpha, stencil and depth tests between begin and end */
    TRIPTYCH_QUERY_OCCLUSION,
    TRIPTYCH_QUERY_EVENT, /* 1 after everything before the end of the query is rendered */
    /* time on a monotonic clock, in nanoseconds, when everything before its end was rendered */
    TRIPTYCH_QUERY_TIMESTAMP,
    TRIPTYCH_QUERY_COUNT
};

/* The use of mapped bytes of a buffer (triptych_buffer_map). */
enum triptych_map {
    TRIPTYCH_MAP_WRITE,        /* they are read and written; earlier draws read the old bytes */
    TRIPTYCH_MAP_DISCARD,      /* they are written, and may initially have any values; all others become 0 */
    TRIPTYCH_MAP_NO_OVERWRITE, /* they are read and written, but not those that earlier draws read */
    TRIPTYCH_MAP_READ,         /* they are read */
    TRIPTYCH_MAP_COUNT
};

/* Conventions that differ between graphics interfaces. The first value of each is the default. */
enum triptych_convention {
    TRIPTYCH_PIXEL_CENTER,
    TRIPTYCH_DEPTH_RANGE,
    TRIPTYCH_MULTIPLY,
    TRIPTYCH_WINDOW_ORIGIN,
    TRIPTYCH_POINT_CLIP,
    TRIPTYCH_DEPTH_BIAS_UNIT,
    TRIPTYCH_PROVOKING_VERTEX,
    TRIPTYCH_CUBE_ADDRESS,
    TRIPTYCH_MAGNIFY_LIMIT,
    TRIPTYCH_SPRITE_ORIGIN,
    TRIPTYCH_CONVENTION_COUNT
};
enum triptych_pixel_center {
    TRIPTYCH_PIXEL_CENTER_HALF,   /* the centre of pixel 0 is at 0.5, as in Direct3D 10 and OpenGL */
    TRIPTYCH_PIXEL_CENTER_INTEGER /* the centre of pixel 0 is at 0, as in Direct3D 9 */
};
enum triptych_depth_range {
    TRIPTYCH_DEPTH_RANGE_ZERO, /* clip depth from 0 to w, as in Direct3D */
    TRIPTYCH_DEPTH_RANGE_MINUS /* from -w to w, as in OpenGL */
};
enum triptych_multiply {
    TRIPTYCH_MULTIPLY_IEEE,  /* shaders multiply according to IEEE 754 */
    TRIPTYCH_MULTIPLY_LEGACY /* in shaders 0 times any value is 0, also infinity and NaN */
};
/* The side of the picture that row 0 is at. Rows of memory, viewports, scissors, positions in the window and
 * vPos do not depend on it: y is always the number of the row. It is the direction of clip space's y that
 * changes. Windings and the fill rule are those of rows: as if row 0 were at the top. So a triangle that is
 * counter-clockwise in OpenGL is clockwise here. */
enum triptych_window_origin {
    TRIPTYCH_WINDOW_ORIGIN_UPPER, /* at the top: clip space's y decreases with rows, as in Direct3D */
    TRIPTYCH_WINDOW_ORIGIN_LOWER  /* at the bottom: clip space's y increases with rows, as in OpenGL */
};

/* The limits of points. Only the centre of a point is clipped to user clip planes and to near and far. */
enum triptych_point_clip {
    /* Only their pixels in the viewport are drawn, as in Direct3D and OpenGL ES's conformance tests. */
    TRIPTYCH_POINT_CLIP_VIEWPORT,
    TRIPTYCH_POINT_CLIP_DEPTH, /* nothing else: they reach out of the viewport */
    TRIPTYCH_POINT_CLIP_CENTER /* the same, without those whose centre is beyond a side, as in OpenGL 1 */
};
/* The unit of the state depthbias. */
enum triptych_depth_bias_unit {
    TRIPTYCH_DEPTH_BIAS_UNIT_ONE, /* depth from 0 to 1, as in Direct3D 9 */
    /* The smallest difference of depth that the format can hold, as in OpenGL: 1 / (2^n - 1) for n bits,
     * 2^-24 for D32. With floating point it is the distance of numbers next to the triangle's greatest depth.
     */
    TRIPTYCH_DEPTH_BIAS_UNIT_SMALLEST
};
/* The vertex that gives a flat primitive its colours, of those of def/state/primitive.def. */
enum triptych_provoking_vertex {
    TRIPTYCH_PROVOKING_VERTEX_FIRST, /* as in Direct3D */
    TRIPTYCH_PROVOKING_VERTEX_LAST   /* as in OpenGL: the last one, of a polygon the first */
};
/* Texels beyond the edge of a cube's face, which linear filters reach. */
enum triptych_cube_address {
    TRIPTYCH_CUBE_ADDRESS_CLAMP,  /* those of the edge, as in Direct3D 9 */
    TRIPTYCH_CUBE_ADDRESS_SAMPLER /* by addressu and addressv, as in OpenGL ES 2.0 */
};
/* The level of detail up to which textures with levels are magnified if magfilter is linear and minfilter is
 * not. The limit of all others is 0. */
enum triptych_magnify_limit {
    TRIPTYCH_MAGNIFY_LIMIT_ZERO, /* as in Direct3D 9 */
    TRIPTYCH_MAGNIFY_LIMIT_HALF  /* 1/2, as in OpenGL */
};
/* The side of a point sprite where its second coordinate is 0. */
enum triptych_sprite_origin {
    TRIPTYCH_SPRITE_ORIGIN_UPPER, /* the upper one of the picture: of the first row, or of the last */
    TRIPTYCH_SPRITE_ORIGIN_LAST   /* that of the last row, wherever row 0 is */
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

/* Shader stages. */
enum triptych_shader_stage { TRIPTYCH_SHADER_VERTEX, TRIPTYCH_SHADER_PIXEL, TRIPTYCH_SHADER_STAGE_COUNT };

/* Constant registers of each stage. Vertex shaders can read the first 256 floats and 16 integers, pixel
 * shaders the first 224 floats and 16 integers, and fewer floats in models below 3.0. The software models
 * vs_2_sw and ps_3_sw can read all floats and integers. */
enum { TRIPTYCH_SHADER_FLOATS = 8192, TRIPTYCH_SHADER_INTEGERS = 2048, TRIPTYCH_SHADER_BOOLEANS = 16 };

enum triptych_log_level {
    TRIPTYCH_LOG_ERROR,  /* a call failed: the text is that of triptych_error() */
    TRIPTYCH_LOG_WARNING /* the call succeeded, and probably not with the intended effect */
};

/* Receives a line about an event of a device, without a newline. The text is valid during the call. The
 * function runs in the thread that called the device, and must not call functions of the device. */
typedef void triptych_log_function(void *user, enum triptych_log_level level, const char *text);

struct triptych_options {
    /* A name that triptych_engine_name() returns; null: "specialize". Some engines take options after a colon
     * each, as in "specialize-8:registers=6:without=fold" (docs/command.md). */
    const char *engine;
    unsigned threads;   /* rendering threads, including the caller's; 0: one per available processor */
    size_t cache_bytes; /* budget of the routine cache, beyond which unused routines are evicted; 0: 16 MiB */
    int measure;        /* nonzero: measure the time of each routine (triptych_get_routine) */
    /* Receivers of information about generated code: gdb, unwind, perf, jitdump, separated by commas. Null:
     * the value of the environment variable TRIPTYCH_DEBUG. */
    const char *debug;
    triptych_log_function *log; /* null: none */
    void *log_user;             /* its first argument */
    /* Settings of the renderer, which never change a picture: "order=stripes,geometry=serial" (`triptych list
     * settings`). Null: the value of the environment variable TRIPTYCH_SETTINGS. */
    const char *settings;
};

/* A render target: one to four colours and depth. Each colour format must be valid for targets
 * (`triptych list formats`). Draws write all colours. A field that is 0 has the value that
 * triptych_set_target uses: one colour, A8R8G8B8. */
struct triptych_target_description {
    unsigned width, height; /* pixels, 1 to 8192 */
    enum triptych_depth_format depth_format;
    enum triptych_surface_format color_format[TRIPTYCH_TARGETS];
    unsigned samples; /* samples per pixel: 0 or 1; with one colour also 2, 4 or 8 */
};

/* An image: a colour or depth that is drawn to, read and copied, but not sampled. */
struct triptych_image_description {
    enum triptych_surface_format format;     /* valid for targets (`triptych list formats`); 0: depth */
    enum triptych_depth_format depth_format; /* only of depth; not TRIPTYCH_DEPTH_NONE */
    unsigned width, height;                  /* pixels, 1 to 8192 */
    unsigned samples;                        /* samples per pixel: 0 or 1, 2, 4 or 8 */
};

/* An image, or one of a texture: a level and, for a cube or volume, the face or slice `slice`. At most one of
 * the pointers is set. Functions that accept the target take a surface without either as colour number
 * `slice` of the target that triptych_set_target made. For other functions it means no surface. */
struct triptych_surface {
    triptych_texture *texture;
    unsigned level, slice;
    triptych_image *image;
};

/* Surfaces to draw to: textures and images, with the same number of samples. All are different. Colours can
 * be absent. The target has the pixels that all colours have; depth must have at least these. Without a depth
 * surface the target has its own one of the depth format, which is cleared first. */
struct triptych_target_surfaces {
    struct triptych_surface color[TRIPTYCH_TARGETS];
    struct triptych_surface depth;
    enum triptych_depth_format depth_format; /* only without a depth surface */
};

/* A part of an image, in pixels. */
struct triptych_rectangle {
    unsigned x, y, width, height;
};

/* The values of a clear, for triptych_clear_rectangles. */
struct triptych_clear_values {
    unsigned flags; /* TRIPTYCH_CLEAR_...: the surfaces; values of others are ignored */
    float color[4];
    float depth;           /* 0 to 1 */
    unsigned stencil;      /* truncated to the bits of the surface */
    unsigned color_mask;   /* the channels that are written: 1 red, 2 green, 4 blue, 8 alpha; 15 for all */
    unsigned stencil_mask; /* the bits of the stencil that are written; 0xff for all */
    int everywhere;        /* nonzero: the viewport does not limit the clear */
};

/* A vertex after transformation and lighting or the vertex shader, before clipping. */
struct triptych_processed_vertex {
    float position[4];    /* x and y of the window in pixels, depth, 1/w: as `positiont` has them */
    float clip[4];        /* clip coordinates: z from 0 to w; of vertices that are in the window, the same */
    float color[2][4];    /* diffuse and specular */
    float texcoord[8][4]; /* of the stages: generated and transformed; u, v, third coordinate, divisor */
    float point_size;     /* pixels */
    float fog; /* the weight of the colour against the fog, 0 to 1; 1 without fog, 0 from a shader without */
};

enum triptych_copy_filter { TRIPTYCH_COPY_POINT, TRIPTYCH_COPY_LINEAR, TRIPTYCH_COPY_COUNT };

/* One element of a vertex declaration. */
struct triptych_declaration_element {
    unsigned stream; /* 0 to 15 */
    size_t offset;   /* bytes from the start of the vertex, 0 to 65535 */
    enum triptych_format format;
    enum triptych_usage usage;
    unsigned usage_index; /* 0 to 15 */
};

/* An attribute with its own stream: its location in the vertices of a buffer. */
struct triptych_element {
    enum triptych_format format;
    triptych_buffer *buffer; /* null with TRIPTYCH_FORMAT_NONE */
    size_t offset;           /* bytes from the start of the buffer to the attribute of vertex 0 */
    size_t stride;           /* bytes between vertices, 0 to 65536 */
};

/* Description of a new texture. Sides are 1 to 8192 texels, for a volume 1 to 2048. A cube's width and height
 * are equal. */
struct triptych_texture_description {
    enum triptych_texture_type type;
    enum triptych_surface_format format;
    unsigned width, height;
    unsigned depth;  /* slices of a volume; otherwise 1 */
    unsigned levels; /* each half the size of the previous one; 0: down to one texel */
};

/* A part of a level, in texels: a box of a volume, or a rectangle with depth 1. */
struct triptych_box {
    unsigned x, y, z;
    unsigned width, height, depth;
};

struct triptych_viewport {
    float x, y, width, height;   /* pixels: any finite numbers, the sides 0 or more */
    float depth_near, depth_far; /* 0 to 1, in any order */
};

struct triptych_material {
    float diffuse[4];
    float ambient[4];
    float emissive[4];
    float specular[4];
    float power; /* exponent of highlights, 0 or more */
};

/* A light in world space. `direction` is the direction in which the light of a directional light or a spot
 * travels. Only points and spots use `position`, `range` and `attenuation`. A spot has full intensity inside
 * the cone of angle `theta`, 0 to `phi`, and none outside the cone of angle `phi`, up to pi. Both are whole
 * cone angles in radians. Between the cones the intensity follows the power `falloff`. */
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
    TRIPTYCH_SUPPORT_LATER, /* part of Direct3D 9, but not of this version */
    TRIPTYCH_SUPPORT_NEVER  /* part of Direct3D 9, but not planned */
};

enum triptych_notation {
    TRIPTYCH_NOTATION_WORDS,       /* only the values that triptych_value_at() returns */
    TRIPTYCH_NOTATION_NUMBER,      /* decimal */
    TRIPTYCH_NOTATION_HEXADECIMAL, /* colours 0xAARRGGBB, bits */
    TRIPTYCH_NOTATION_REAL         /* the bits of a finite float: triptych_float_bits() */
};

/* The kind of a state's values. */
struct triptych_kind {
    const char *name;
    enum triptych_notation notation;
    double first, last; /* the range, unless the notation is WORDS */
    const char *prefix; /* of its words in this header, TRIPTYCH_PREFIX_WORD; "" without words */
};

struct triptych_value {
    const struct triptych_kind *kind;
    const char *word;
    uint32_t number; /* Direct3D 9's */
    enum triptych_support support;
};

/* A row of a table of states. A state that is not supported can only be set to its default. */
struct triptych_state_row {
    unsigned number; /* Direct3D 9's */
    const char *name;
    const struct triptych_kind *kind;
    /* The keys that contain it: letters of V vertex, S setup, P pixel. "job" if none does, "-" if it is
     * ignored. */
    const char *units;
    enum triptych_support support;
    const char *test; /* the test of the state, relative to the folder tests; "" if there is none */
    const char *meaning;
};

/* Counters since the creation of the device. Draws, triangles and the cache are counted when a draw is
 * submitted, everything else when it is rendered. Lines and points count as triangles. */
struct triptych_statistics {
    uint64_t draws, triangles;
    uint64_t vertices_shaded, triangles_set_up, triangles_visible;
    uint64_t pixels_shaded;                             /* covered pixels, including hidden ones */
    uint64_t cache_hits, cache_misses, cache_evictions; /* routines of all units */
    /* Times of a monotonic clock, summed over threads. */
    uint64_t vertex_ns; /* geometry phase: vertex routines, clipping, setup, binning */
    uint64_t pixel_ns;  /* tile phase: rasterization, pixel routines */
};

/* A routine of the device's cache (triptych_get_routine). Strings are valid until the next call. */
struct triptych_routine_info {
    uint32_t number;  /* number in dumps, from 1 */
    const char *unit; /* "vertex", "setup", "pixel" */
    const char *key;  /* the text of its key */
    uint64_t build_ns;
    uint64_t hits;
    uint32_t code_bytes;
    uint32_t parts; /* instructions or fragments */
    uint32_t spills;
    uint32_t fused;   /* fragments that combine two or more operations */
    uint32_t carried; /* operands that fragments received in registers */
    /* time in the routine, and processed vertices, triangles or covered pixels, if the device measures */
    uint64_t run_ns;
    uint64_t elements;       /* elements that were processed */
    uint32_t shader;         /* the number of its shader; 0: none */
    const char *granularity; /* the fragments of a stitched routine: "stage" or "operation"; otherwise null */
    uint32_t lanes;          /* elements per pass of its code */
    /* The instruction set of its code: "SSE2", "AVX2" or "AVX-512". It is "SSE2" if the code is not
     * generated. A tiered routine has the lanes and the instruction set of its first tier. */
    const char *instruction_set;
    /* Of a routine with addresses in its code (option `addresses`): how often they were written, how often a
     * thread waited for that, and the copies of its code. All are 0 for others. */
    uint64_t patches, waits;
    uint32_t copies;
};

/* Returns the version of the library: "MAJOR.MINOR.PATCH". */
TRIPTYCH_API const char *triptych_version(void);

/* Creates a device. On failure *device is null, and `reason`, which may be null, receives the reason in at
 * most `size` bytes; 512 are enough for any. */
TRIPTYCH_API enum triptych_result triptych_device_create(const struct triptych_options *options,
                                                         triptych_device **device, char *reason, size_t size);
/* Frees the device and all its objects. Null is allowed. */
TRIPTYCH_API void triptych_device_destroy(triptych_device *device);
/* Returns the reason of the last failed call; an empty string if none has failed. */
TRIPTYCH_API const char *triptych_error(const triptych_device *device);
/* Sets the function that receives the events of the device from now on; null: none. */
TRIPTYCH_API void triptych_set_log(triptych_device *device, triptych_log_function *log, void *user);

/* Returns the first failure of an output that options.debug enables, such as a file that cannot be written;
 * an empty string if there is none. Such a failure does not affect other calls. The string is valid until the
 * next call. */
TRIPTYCH_API const char *triptych_debug_error(triptych_device *device);

/* The name and description of engine `i`, and the reason why it cannot run on this machine, null if it can;
 * null past the last engine. Its lanes; 0 if they vary by routine. The reason is valid until the thread's
 * next call. */
TRIPTYCH_API const char *triptych_engine_name(unsigned i);
TRIPTYCH_API const char *triptych_engine_description(unsigned i);
TRIPTYCH_API unsigned triptych_engine_width(unsigned i);
TRIPTYCH_API const char *triptych_engine_unavailable(unsigned i);
/* The name of the engine of a device; null without device. */
TRIPTYCH_API const char *triptych_get_engine(const triptych_device *);

/* Sets the render target: colour RGBA8 and depth binary32, 1 to 8192 pixels per side. The contents start with
 * colour 0 and depth 1. The viewport becomes the whole target with depth 0 to 1, the scissor rectangle the
 * whole target. */
TRIPTYCH_API enum triptych_result triptych_set_target(triptych_device *, unsigned width, unsigned height);
/* Like triptych_set_target, with any formats. */
TRIPTYCH_API enum triptych_result triptych_set_target_description(triptych_device *,
                                                                  const struct triptych_target_description *);

/* Draws to textures and images instead of the target. Null returns to the target, whose contents have not
 * changed. Both set the viewport and the scissor rectangle like triptych_set_target, which also ends drawing
 * to surfaces. Surfaces keep their contents, depth and stencil too, while they are not drawn to. A change
 * neither waits nor copies pixels.
 *
 * A texture can be sampled while it is drawn to: each draw samples it as it was before this draw. That costs
 * a copy of the surface for each draw that samples it after another one has changed it. */
TRIPTYCH_API enum triptych_result triptych_set_target_surfaces(triptych_device *,
                                                               const struct triptych_target_surfaces *);

/* Creates an image: colour 0, depth 1, stencil 0. */
TRIPTYCH_API enum triptych_result
triptych_image_create(triptych_device *, const struct triptych_image_description *, triptych_image **image);
/* Frees an image. If it is a target, drawing returns to the target that triptych_set_target made. Null is
 * allowed. */
TRIPTYCH_API enum triptych_result triptych_image_destroy(triptych_device *, triptych_image *);

/* Copies a part of a surface to a part of another surface, or of the same one. A null part, or one of width
 * 0, is the whole surface. Scales if the sizes differ, averages samples, and converts to the format of the
 * destination: to a format of targets as a draw does, to another one to the nearest value. Compressed
 * destinations are compressed again. sRGB is not decoded. Depth and stencil are copied between surfaces of
 * one format, by points. Pending draws are rendered first. */
TRIPTYCH_API enum triptych_result triptych_copy(triptych_device *, const struct triptych_surface *source,
                                                const struct triptych_rectangle *source_part,
                                                const struct triptych_surface *target,
                                                const struct triptych_rectangle *target_part,
                                                enum triptych_copy_filter filter);

/* Fills a part of a surface of colours, as for triptych_copy. */
TRIPTYCH_API enum triptych_result triptych_fill(triptych_device *, const struct triptych_surface *,
                                                const struct triptych_rectangle *part, const float color[4]);

/* Read and write pixels of a part of a surface, as for triptych_copy, in memory. A row begins `pitch` bytes
 * after the one before. A negative pitch, to read pixels that are not compressed: before it, so that the
 * memory has the rows upside down; `data` is that of the part's first row in any case. The format is
 * uncompressed and one of colours. 0 is the surface's own format, which can also be compressed (then the
 * part is of whole blocks), and is the only one for depth: words as Direct3D 9 has them, in two bytes for
 * D16, D16_LOCKABLE and D15S1 and in four for the others, stencil in the low bits. Samples are averaged when
 * they are read, and all are written. Bits of no channel are 0. The luminance of colours is their red. Depth
 * outside of 0 to 1 is limited. Pending draws are rendered first. */
TRIPTYCH_API enum triptych_result triptych_read_rectangle(triptych_device *, const struct triptych_surface *,
                                                          const struct triptych_rectangle *part,
                                                          enum triptych_surface_format, void *data,
                                                          ptrdiff_t pitch);
TRIPTYCH_API enum triptych_result triptych_write_rectangle(triptych_device *, const struct triptych_surface *,
                                                           const struct triptych_rectangle *part,
                                                           enum triptych_surface_format, const void *data,
                                                           size_t pitch);

/* Reads the texels of a surface as RGBA8 words or as four numbers each, like triptych_read_target. */
TRIPTYCH_API enum triptych_result triptych_read_surface(triptych_device *, const struct triptych_surface *,
                                                        uint32_t *rgba, size_t bytes);
TRIPTYCH_API enum triptych_result
triptych_read_surface_numbers(triptych_device *, const struct triptych_surface *, float *rgba, size_t bytes);

/* Creates a buffer with a copy of `bytes` bytes, 1 to 2^31 - 1, or with zeros if `data` is null. */
TRIPTYCH_API enum triptych_result triptych_buffer_create(triptych_device *, const void *data, size_t bytes,
                                                         triptych_buffer **buffer);
/* Changes bytes of a buffer, which must not be mapped. Earlier draws read the old bytes; the call does not
 * wait for them. */
TRIPTYCH_API enum triptych_result triptych_buffer_update(triptych_device *, triptych_buffer *, size_t offset,
                                                         const void *data, size_t bytes);
/* Gives access to bytes of a buffer, at least one, until triptych_buffer_unmap. A buffer can be mapped once
 * at a time. Draws may read a mapped buffer: they read the bytes that were written before the draw, and bytes
 * that are written after it must not be those that it reads. Neither call waits for draws. */
TRIPTYCH_API enum triptych_result triptych_buffer_map(triptych_device *, triptych_buffer *, size_t offset,
                                                      size_t bytes, enum triptych_map, void **data);
TRIPTYCH_API enum triptych_result triptych_buffer_unmap(triptych_device *, triptych_buffer *);
/* Frees a buffer, also a mapped one. Earlier draws still read it; the call does not wait for them. Bindings
 * of the buffer become unbound. Null is allowed. */
TRIPTYCH_API enum triptych_result triptych_buffer_destroy(triptych_device *, triptych_buffer *);
/* Creates a 2D texture with a copy of width x height RGBA8 texels, 1 to 8192 per side. */
TRIPTYCH_API enum triptych_result triptych_texture_create(triptych_device *, const void *rgba, unsigned width,
                                                          unsigned height, triptych_texture **texture);

/* Creates a texture. All bits of its texels are 0. */
TRIPTYCH_API enum triptych_result
triptych_texture_define(triptych_device *, const struct triptych_texture_description *description,
                        triptych_texture **texture);
/* Copies texels in the format of the texture to a part of a level; null: the whole level. `face` is 0 except
 * for cubes. For compressed formats the part starts at multiples of 4 texels, and ends at multiples of 4 or
 * at the end of the level. Rows of texels or blocks are `row_pitch` bytes apart, slices of a volume
 * `slice_pitch` bytes. Earlier draws read the old texels. The call waits for them only if they draw to the
 * texture, or if it has more than 64 MiB. */
TRIPTYCH_API enum triptych_result triptych_texture_update(triptych_device *, triptych_texture *texture,
                                                          unsigned face, unsigned level,
                                                          const struct triptych_box *box, const void *data,
                                                          size_t row_pitch, size_t slice_pitch);
/* Copies a part of a level to texels in the format of the texture: the inverse of triptych_texture_update,
 * with the same arguments. The result are the bytes of the updates, compressed blocks included. Three things
 * differ: bits that belong to no channel are 0, a signed channel's second bit pattern for -1 becomes the
 * first one, and a depth format's stencil is 0. Texels of compressed formats that did not come from an
 * update, such as those of computed levels, are compressed. Renders pending draws to the texture first. */
TRIPTYCH_API enum triptych_result triptych_texture_read(triptych_device *, triptych_texture *texture,
                                                        unsigned face, unsigned level,
                                                        const struct triptych_box *box, void *data,
                                                        size_t row_pitch, size_t slice_pitch);
/* Computes every level but the first from the previous one. Each texel is the mean of the texels that it
 * covers. Formats with more than 8 bits per channel are averaged in binary32. */
TRIPTYCH_API enum triptych_result triptych_texture_generate_mips(triptych_device *,
                                                                 triptych_texture *texture);
/* Frees a texture. Earlier draws still read it. Samplers with this texture become unbound. If it is a
 * target, drawing returns to the target that triptych_set_target made. Null is allowed. */
TRIPTYCH_API enum triptych_result triptych_texture_destroy(triptych_device *, triptych_texture *);

/* Create shaders of the models 1.1 to 3.0 (docs/shaders.md): from bytecode, from the version token to the end
 * token, or from assembly text. The input is copied. The reason of a refusal begins with `name`: "NAME: token
 * N: ..." or "NAME:LINE:COLUMN: ...". A null name is "shader". */
TRIPTYCH_API enum triptych_result triptych_shader_create(triptych_device *, const char *name,
                                                         const void *code, size_t bytes,
                                                         triptych_shader **shader);
TRIPTYCH_API enum triptych_result triptych_shader_assemble(triptych_device *, const char *name,
                                                           const char *text, size_t bytes,
                                                           triptych_shader **shader);
/* Frees a shader. Pending draws are rendered first. A stage with this shader becomes the fixed function. Null
 * is allowed. */
TRIPTYCH_API enum triptych_result triptych_shader_destroy(triptych_device *, triptych_shader *);
/* The stage of a shader, and the name of its model, such as "vs_2_0". */
TRIPTYCH_API enum triptych_shader_stage triptych_shader_get_stage(const triptych_shader *);
TRIPTYCH_API const char *triptych_shader_get_model(const triptych_shader *);

TRIPTYCH_API enum triptych_result triptych_set_state(triptych_device *, enum triptych_state, uint32_t value);
TRIPTYCH_API enum triptych_result triptych_set_sampler_state(triptych_device *, unsigned sampler,
                                                             enum triptych_sampler_state, uint32_t value);
TRIPTYCH_API enum triptych_result triptych_set_stage_state(triptych_device *, unsigned stage,
                                                           enum triptych_stage_state, uint32_t value);
/* Returns the bits of a number, as states of the notation REAL take them. */
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
/* The clip mask: a 2D texture of A8, L8 or R8 with one texel of its first level for each pixel. Texel 0, 0 is
 * at pixel x, y. */
struct triptych_clip_mask {
    triptych_texture *texture; /* null: no mask */
    int x, y;
    struct triptych_rectangle box; /* pixels of the target; empty: no mask */
};

/* Sets the clip mask. Draws change only pixels of the box for which the mask has a texel. Their colours, and
 * alpha, are multiplied by the texel / 255 after the alpha test and before they are blended. Clears and
 * copies have no mask. The texture is unset when it is destroyed. */
TRIPTYCH_API enum triptych_result triptych_set_clip_mask(triptych_device *, triptych_texture *texture, int x,
                                                         int y, unsigned box_x, unsigned box_y,
                                                         unsigned box_width, unsigned box_height);

/* Sets the scissor rectangle, in pixels. It may lie outside of the target. While the state scissortestenable
 * is on, it limits draws and clears. An empty rectangle excludes everything. */
TRIPTYCH_API enum triptych_result triptych_set_scissor(triptych_device *, unsigned x, unsigned y,
                                                       unsigned width, unsigned height);
/* Sets plane `i`, 0 to 5, of world space. While bit i of the state clipplaneenable is on, primitives are
 * clipped to x a + y b + z c + d >= 0. The initial plane is 0, which clips nothing. */
TRIPTYCH_API enum triptych_result triptych_set_clip_plane(triptych_device *, unsigned i,
                                                          const float plane[4]);
/* `value` is of the enumeration of the convention: triptych_pixel_center, triptych_depth_range ... */
TRIPTYCH_API enum triptych_result triptych_set_convention(triptych_device *, enum triptych_convention,
                                                          unsigned value);
TRIPTYCH_API enum triptych_result triptych_set_material(triptych_device *, const struct triptych_material *);
TRIPTYCH_API enum triptych_result triptych_set_light(triptych_device *, unsigned index,
                                                     const struct triptych_light *);
TRIPTYCH_API enum triptych_result triptych_enable_light(triptych_device *, unsigned index, int enable);
/* Sets a texture. Sampler i belongs to texture stage i and to s# i of pixel shaders; sampler
 * TRIPTYCH_VERTEX_SAMPLER + i to s# i of vertex shaders. Null unbinds: a stage that reads the texture then
 * passes the current colour, and shaders sample (0, 0, 0, 1). */
TRIPTYCH_API enum triptych_result triptych_set_texture(triptych_device *, unsigned sampler,
                                                       triptych_texture *);

/* Sets the shader of a stage. Null selects the fixed-function pipeline. */
TRIPTYCH_API enum triptych_result triptych_set_vertex_shader(triptych_device *, triptych_shader *);
TRIPTYCH_API enum triptych_result triptych_set_pixel_shader(triptych_device *, triptych_shader *);

/* Set `count` constant registers of a stage from `first` on. A register has four floats, four integers or one
 * Boolean. The integers of a loop are count, start, step and one unused value; those of a rep are count and
 * three unused values. All are initially 0, and they keep their values when the shader changes. Constants
 * that a shader defines replace them in that shader. Earlier draws keep the earlier values. */
TRIPTYCH_API enum triptych_result triptych_set_shader_floats(triptych_device *, enum triptych_shader_stage,
                                                             unsigned first, const float *values,
                                                             unsigned count);
TRIPTYCH_API enum triptych_result triptych_set_shader_integers(triptych_device *, enum triptych_shader_stage,
                                                               unsigned first, const int32_t *values,
                                                               unsigned count);
TRIPTYCH_API enum triptych_result triptych_set_shader_booleans(triptych_device *, enum triptych_shader_stage,
                                                               unsigned first, const int32_t *values,
                                                               unsigned count);

/* Sets the vertex declaration: `count` elements, 0 to 64, each with a different usage and index. Attributes
 * that it does not list are absent. A vertex with POSITIONT is already transformed. */
TRIPTYCH_API enum triptych_result
triptych_set_declaration(triptych_device *, const struct triptych_declaration_element *elements,
                         unsigned count);
/* Sets the declaration of a code of Direct3D 9's D3DFVF values, with all elements in stream 0. */
TRIPTYCH_API enum triptych_result triptych_set_fvf(triptych_device *, uint32_t fvf);
/* Binds a buffer to a stream, 0 to 15. Its vertices of `stride` bytes start at `offset`, at any byte. The
 * stride is 0 to 65536; 0: all vertices are equal. Null unbinds. */
TRIPTYCH_API enum triptych_result triptych_set_stream(triptych_device *, unsigned stream, triptych_buffer *,
                                                      size_t offset, size_t stride);
/* `count` is 1 with TRIPTYCH_FREQUENCY_VERTEX, otherwise 1 to 2^30 - 1. Stream 0 cannot have
 * TRIPTYCH_FREQUENCY_INSTANCE. */
TRIPTYCH_API enum triptych_result triptych_set_stream_frequency(triptych_device *, unsigned stream,
                                                                enum triptych_frequency, uint32_t count);
/* Declares one attribute, with its own stream. */
TRIPTYCH_API enum triptych_result triptych_set_element(triptych_device *, enum triptych_attribute,
                                                       const struct triptych_element *);
/* Binds a buffer of indices. `bits` is 8, 16 or 32. Null unbinds. */
TRIPTYCH_API enum triptych_result triptych_set_indices(triptych_device *, triptych_buffer *, unsigned bits);

/* Draws `count` primitives from vertex `first` on. */
TRIPTYCH_API enum triptych_result triptych_draw(triptych_device *, enum triptych_primitive, uint32_t first,
                                                uint32_t count);
/* Draws `count` primitives from index `first` on. `base` is added to each index. */
TRIPTYCH_API enum triptych_result triptych_draw_indexed(triptych_device *, enum triptych_primitive,
                                                        int32_t base, uint32_t first, uint32_t count);

/* Draw vertices and indices that are in memory of the caller and are copied. Vertex i begins at i * `stride`
 * bytes, 1 to 65536. It replaces the vertex of stream 0 for this draw; bindings do not change. Other streams
 * are read as they are bound. Elements of stream 0 must end within the stride.
 * triptych_draw_indexed_user draws from the first index on. There are `vertex_count` vertices, and indices
 * are below this number. `bits` is 8, 16 or 32. */
TRIPTYCH_API enum triptych_result triptych_draw_user(triptych_device *, enum triptych_primitive,
                                                     uint32_t count, const void *vertices, size_t stride);
TRIPTYCH_API enum triptych_result triptych_draw_indexed_user(triptych_device *, enum triptych_primitive,
                                                             uint32_t count, const void *indices,
                                                             unsigned bits, uint32_t vertex_count,
                                                             const void *vertices, size_t stride);

/* Runs the vertex routine of the current state, fixed function or shader, for vertices `first` to first +
 * count - 1 of the streams, and returns its outputs: 0 0 0 1 where there are none, NaN as 7fc00000. Draws
 * nothing. A texture's fourth coordinate is the divisor: after a matrix of three columns, or of three numbers
 * that are projected without a count, it is the third. */
TRIPTYCH_API enum triptych_result triptych_process_vertices(triptych_device *, uint32_t first, uint32_t count,
                                                            struct triptych_processed_vertex *out);

/* Clears the pixels of the viewport, inside the scissor rectangle if its test is on. A null color and a
 * negative depth are not cleared. Depth is 0 to 1. */
TRIPTYCH_API enum triptych_result triptych_clear(triptych_device *, const float color[4], float depth);

/* Like triptych_clear, for the surfaces in `flags`, a sum of TRIPTYCH_CLEAR_... values. Arguments for other
 * surfaces are ignored. The value of the stencil is truncated to its bits. Depth and stencil must exist to be
 * cleared. */
TRIPTYCH_API enum triptych_result triptych_clear_buffers(triptych_device *, unsigned flags,
                                                         const float color[4], float depth, unsigned stencil);
/* Clears rectangles, or with a count of 0 everything, with masks: only pixels of the viewport, unless
 * values->everywhere is set, and of the scissor rectangle if its test is on. Rectangles may overlap, be
 * empty, and lie outside of the target. */
TRIPTYCH_API enum triptych_result triptych_clear_rectangles(triptych_device *,
                                                            const struct triptych_clear_values *values,
                                                            const struct triptych_rectangle *rectangles,
                                                            unsigned count);

/* Queries. A query can begin and end again. Events and timestamps have no begin. For other types an end
 * without a begin fails. */
TRIPTYCH_API enum triptych_result triptych_query_create(triptych_device *, enum triptych_query_type,
                                                        triptych_query **query);
TRIPTYCH_API enum triptych_result triptych_query_begin(triptych_device *, triptych_query *);
TRIPTYCH_API enum triptych_result triptych_query_end(triptych_device *, triptych_query *);
/* Returns the result of a query that has ended. Renders pending draws first. */
TRIPTYCH_API enum triptych_result triptych_query_result(triptych_device *, triptych_query *,
                                                        uint64_t *result);
/* The same without waiting: sets *ready to 0 if the end of the query is not rendered yet, and otherwise to 1
 * and *result to the result. Pending draws begin to be rendered, as by triptych_flush, so repeated calls find
 * the result in the end. */
TRIPTYCH_API enum triptych_result triptych_query_poll(triptych_device *, triptych_query *, int *ready,
                                                      uint64_t *result);
/* Frees a query, also between begin and end. Null is allowed. */
TRIPTYCH_API enum triptych_result triptych_query_destroy(triptych_device *, triptych_query *);

/* Recording: writes calls to a container (docs/container.md) while they are made, with the memory that they
 * read. A recording can start at any time, because it begins with the device's objects and state.
 * triptych_end_frame ends a frame of the recording. The file appears when the recording stops; a failure to
 * write is reported then, and there is no file. The destruction of the device stops its recording. A
 * recording without triptych_end_frame is one frame. If pixels were read or rendering was finished several
 * times, this is a warning (triptych_log_function).
 *
 * With the environment variable TRIPTYCH_RECORD=PATH, each device of the process is recorded from its
 * creation on. From the second device on, the file name has a number before the extension of the path. */
TRIPTYCH_API enum triptych_result triptych_record_start(triptych_device *, const char *path);
TRIPTYCH_API enum triptych_result triptych_record_stop(triptych_device *);

/* Begins to render pending draws and returns: threads of the device render them meanwhile. Does nothing while
 * these render earlier draws. A device with one thread renders the pending draws before it returns. */
TRIPTYCH_API enum triptych_result triptych_flush(triptych_device *);
/* Renders all pending draws. */
TRIPTYCH_API enum triptych_result triptych_finish(triptych_device *);
/* Ends a frame: renders all pending draws, and marks the end of the frame in a recording. A program that
 * shows pictures calls it once per picture. */
TRIPTYCH_API enum triptych_result triptych_end_frame(triptych_device *);

/* Reads. Each function below renders all pending draws, then copies to an array of `bytes` bytes. An array
 * that is too small is an error, and nothing is copied; the rest of a larger array is not changed.
 *
 * The target: width * height RGBA8 words, depth values from 0 to 1, or stencil values. */
TRIPTYCH_API enum triptych_result triptych_read_color(triptych_device *, uint32_t *rgba, size_t bytes);
TRIPTYCH_API enum triptych_result triptych_read_depth(triptych_device *, float *depth, size_t bytes);
TRIPTYCH_API enum triptych_result triptych_read_stencil(triptych_device *, uint8_t *stencil, size_t bytes);
/* Read colour target `t`, from 0, as RGBA8 words, with values clamped to 0..1 and rounded, or exactly, as
 * four numbers per pixel. */
TRIPTYCH_API enum triptych_result triptych_read_target(triptych_device *, unsigned t, uint32_t *rgba,
                                                       size_t bytes);
TRIPTYCH_API enum triptych_result triptych_read_target_numbers(triptych_device *, unsigned t, float *rgba,
                                                               size_t bytes);
/* Reads one sample of each pixel of colour target 0. A null pointer skips its surface. The functions above
 * return the average of all samples' colours, with bytes rounded to nearest, halves up, and the depth and
 * stencil of sample 0. */
TRIPTYCH_API enum triptych_result triptych_read_sample(triptych_device *, unsigned sample, uint32_t *rgba,
                                                       size_t rgba_bytes, float *depth, size_t depth_bytes,
                                                       uint8_t *stencil, size_t stencil_bytes);
/* Read and write the current target in its stored form, with every sample, depth and stencil. The size in
 * bytes is 0 without a target. Contents can be written to a target with the same description. */
TRIPTYCH_API size_t triptych_contents_bytes(const triptych_device *);
TRIPTYCH_API enum triptych_result triptych_read_contents(triptych_device *, void *data, size_t bytes);
TRIPTYCH_API enum triptych_result triptych_write_contents(triptych_device *, const void *data, size_t bytes);
/* Read and write all texels of a texture in their stored form: face by face, level by level, RGBA8 words or
 * four binary32 numbers per texel. Texels of one or two bytes (A8, L8, R8, A8L8, R8G8) are words here. */
TRIPTYCH_API size_t triptych_texture_texel_bytes(const triptych_texture *);
TRIPTYCH_API enum triptych_result triptych_texture_read_texels(triptych_device *, triptych_texture *,
                                                               void *data, size_t bytes);
TRIPTYCH_API enum triptych_result triptych_texture_write_texels(triptych_device *, triptych_texture *,
                                                                const void *data, size_t bytes);

/* --- Getters -------------------------------------------------------------------------------------------- */

/* Each function below returns what the function of the same name with `set` has set, or the initial value. It
 * fails like that function for an index or a name that does not exist, and changes nothing then. */
TRIPTYCH_API enum triptych_result triptych_get_state(triptych_device *, enum triptych_state, uint32_t *value);
TRIPTYCH_API enum triptych_result triptych_get_sampler_state(triptych_device *, unsigned sampler,
                                                             enum triptych_sampler_state, uint32_t *value);
TRIPTYCH_API enum triptych_result triptych_get_stage_state(triptych_device *, unsigned stage,
                                                           enum triptych_stage_state, uint32_t *value);
TRIPTYCH_API enum triptych_result triptych_get_transform(triptych_device *, enum triptych_transform,
                                                         float matrix[4][4]);
/* Without a target all numbers are 0. */
TRIPTYCH_API enum triptych_result triptych_get_viewport(triptych_device *, struct triptych_viewport *);
TRIPTYCH_API enum triptych_result triptych_get_scissor(triptych_device *, struct triptych_rectangle *);
TRIPTYCH_API enum triptych_result triptych_get_clip_mask(triptych_device *, struct triptych_clip_mask *);
TRIPTYCH_API enum triptych_result triptych_get_clip_plane(triptych_device *, unsigned i, float plane[4]);
TRIPTYCH_API enum triptych_result triptych_get_convention(triptych_device *, enum triptych_convention,
                                                          unsigned *value);
TRIPTYCH_API enum triptych_result triptych_get_material(triptych_device *, struct triptych_material *);
TRIPTYCH_API enum triptych_result triptych_get_light(triptych_device *, unsigned index,
                                                     struct triptych_light *);
TRIPTYCH_API enum triptych_result triptych_get_light_enable(triptych_device *, unsigned index, int *enable);
/* Objects: null if none is set. */
TRIPTYCH_API enum triptych_result triptych_get_texture(triptych_device *, unsigned sampler,
                                                       triptych_texture **texture);
TRIPTYCH_API enum triptych_result triptych_get_vertex_shader(triptych_device *, triptych_shader **shader);
TRIPTYCH_API enum triptych_result triptych_get_pixel_shader(triptych_device *, triptych_shader **shader);
/* `count` registers from `first` on, as the functions with `set` take them. */
TRIPTYCH_API enum triptych_result triptych_get_shader_floats(triptych_device *, enum triptych_shader_stage,
                                                             unsigned first, float *values, unsigned count);
TRIPTYCH_API enum triptych_result triptych_get_shader_integers(triptych_device *, enum triptych_shader_stage,
                                                               unsigned first, int32_t *values,
                                                               unsigned count);
TRIPTYCH_API enum triptych_result triptych_get_shader_booleans(triptych_device *, enum triptych_shader_stage,
                                                               unsigned first, int32_t *values,
                                                               unsigned count);
/* The elements of the declaration or of the vertex format code, attributes first, without those that
 * triptych_set_element has set. The array has room for `room` elements; fewer than there are is an error.
 * TRIPTYCH_DECLARATION_ELEMENTS is enough. */
TRIPTYCH_API enum triptych_result triptych_get_declaration(triptych_device *,
                                                           struct triptych_declaration_element *elements,
                                                           unsigned room, unsigned *count);
TRIPTYCH_API enum triptych_result triptych_get_stream(triptych_device *, unsigned stream,
                                                      triptych_buffer **buffer, size_t *offset,
                                                      size_t *stride);
TRIPTYCH_API enum triptych_result triptych_get_stream_frequency(triptych_device *, unsigned stream,
                                                                enum triptych_frequency *, uint32_t *count);
/* The format is TRIPTYCH_FORMAT_NONE if the attribute is absent or belongs to a declaration. */
TRIPTYCH_API enum triptych_result triptych_get_element(triptych_device *, enum triptych_attribute,
                                                       struct triptych_element *);
/* `bits` is 0 without a buffer. */
TRIPTYCH_API enum triptych_result triptych_get_indices(triptych_device *, triptych_buffer **buffer,
                                                       unsigned *bits);
/* All surfaces are absent while the target is that of triptych_set_target. */
TRIPTYCH_API enum triptych_result triptych_get_target_surfaces(triptych_device *,
                                                               struct triptych_target_surfaces *);
/* The bytes of a buffer, and the description of a texture or an image; 0 without an object. */
TRIPTYCH_API void triptych_image_get_description(const triptych_image *, struct triptych_image_description *);
TRIPTYCH_API size_t triptych_buffer_get_bytes(const triptych_buffer *);
TRIPTYCH_API void triptych_texture_get_description(const triptych_texture *,
                                                   struct triptych_texture_description *);
/* Returns the description of the target, including the format of its first colour; all 0 without a target. */
TRIPTYCH_API void triptych_get_target(const triptych_device *, struct triptych_target_description *);
/* Returns nonzero if 8 unsigned bits per channel can represent all values of the format. */
TRIPTYCH_API int triptych_format_is_bytes(enum triptych_surface_format);
/* The bits of depth and stencil of a format, and its name; null if the format is unknown. */
TRIPTYCH_API unsigned triptych_depth_bits(enum triptych_depth_format);
TRIPTYCH_API unsigned triptych_stencil_bits(enum triptych_depth_format);
TRIPTYCH_API const char *triptych_depth_format_name(enum triptych_depth_format);
TRIPTYCH_API void triptych_target_size(const triptych_device *, unsigned *width, unsigned *height);

TRIPTYCH_API void triptych_get_statistics(const triptych_device *, struct triptych_statistics *);
/* Reads routine `i` of the cache, by increasing number. Returns 0 past the last. */
TRIPTYCH_API int triptych_get_routine(triptych_device *, unsigned i, struct triptych_routine_info *);

/* The tables of states:
 * - a table's name: "state", "sampler" or "stage";
 * - its size, the number of copies of each state: 1, TRIPTYCH_SAMPLERS or TRIPTYCH_STAGES;
 * - its rows, numbered like the enumerators of its states; null past the last;
 * - the default of row `row` of sampler or stage `i`.
 * Rows and tables that do not exist give null or 0. */
TRIPTYCH_API const char *triptych_table_name(enum triptych_state_table);
TRIPTYCH_API unsigned triptych_table_size(enum triptych_state_table);
TRIPTYCH_API const struct triptych_state_row *triptych_state_at(enum triptych_state_table, unsigned row);
TRIPTYCH_API uint32_t triptych_state_default(enum triptych_state_table, unsigned row, unsigned i);

/* Kinds of values:
 * - kind `i`, and value `i` of a kind with words; null past the last;
 * - the value of a kind with a number, and its word; null if there is none;
 * - the number of a word; returns nonzero if there is none.
 * A null kind has no values. */
TRIPTYCH_API const struct triptych_kind *triptych_kind_at(unsigned i);
TRIPTYCH_API const struct triptych_value *triptych_value_at(const struct triptych_kind *, unsigned i);
TRIPTYCH_API const struct triptych_value *triptych_value_find(const struct triptych_kind *, uint32_t number);
TRIPTYCH_API const char *triptych_value_word(const struct triptych_kind *, uint32_t number);
TRIPTYCH_API int triptych_value_number(const struct triptych_kind *, const char *word, uint32_t *number);

#ifdef __cplusplus
}
#endif

#endif
