/* Draw streams: calls of the interface (triptych.h) as data, read from text, played on any device, written
 * back.
 *
 *   text --stream_read--> struct stream --stream_prepare--> struct player --player_frame--> pictures
 *
 * A stream that has been read is whole and checked: its assets are loaded, its sequences expanded, every draw
 * lies inside what is bound. Reading has no effect on any device. docs/streams.md is the reference of the
 * text.
 *
 * Layout: `resources` and `calls` stand in the order of the text; a sequence is a CALL_SEQUENCE followed by
 * its calls. `executed` lists the calls' numbers in the order in which they are executed, with the plays
 * replaced by what they play and without frames and sequences themselves; frame f is executed[frames[f]] to
 * executed[frames[f + 1] - 1].
 *
 * Functions that return int return 0, or -1 with one line of reason in `error`. */
#ifndef STREAM_STREAM_H
#define STREAM_STREAM_H

#include "base/error.h"
#include "triptych.h"

#include <stddef.h>
#include <stdint.h>

struct player;
struct program;
struct skeleton;

enum stream_limit {
#define LIMIT(name, value, what) LIMIT_##name = value,
#include "stream/limit.def"
#undef LIMIT
};

enum value_type { VALUE_FLOAT, VALUE_U16, VALUE_U32, VALUE_COLOR };
enum normals { NORMALS_SMOOTH, NORMALS_FLAT };
enum texcoords { TEXCOORDS_KEEP, TEXCOORDS_PLANAR, TEXCOORDS_SPHERICAL, TEXCOORDS_CYLINDRICAL };
enum mesh_source {
    MESH_FILE,
    MESH_BEZIER,
    MESH_BOX,
    MESH_GRID,
    MESH_SPHERE,
    MESH_CYLINDER,
    MESH_TORUS,
    MESH_SHADOW
};

/* How a mesh is made of its file. */
struct mesh_options {
    enum mesh_source source;
    enum normals normals;
    enum texcoords texcoords;
    unsigned subdivisions; /* MESH_BEZIER */
    int center;
    float fit;         /* the longest side of the bounding box; 0: as it is */
    float repeat[2];   /* texture coordinates are multiplied by it */
    uint32_t cells[2]; /* MESH_GRID to MESH_TORUS: across, down */
    float tube;        /* MESH_TORUS: its radius */
    int bones;         /* MESH_FILE: vertices have weights and indices, and the mesh a skeleton */
    uint32_t caster;   /* MESH_SHADOW: the number of the mesh whose shadow it is */
    int light_is_point;
    float light[3], length; /* its position, or the direction of light; how far the shadow reaches */
};

/* Where a texture's texels come from. Those of files and blocks are in the text or its files; the others are
 * made. */
enum texture_source {
    TEXTURE_IMAGE,    /* WIDTH HEIGHT { color... }, or a PNG */
    TEXTURE_DDS,      /* a DDS file, which says what texture it is */
    TEXTURE_EMPTY,    /* what zeros in the format mean */
    TEXTURE_BYTES,    /* bytes as they lie in memory */
    TEXTURE_COLORS,   /* a color a texel */
    TEXTURE_FILL,     /* a color a level */
    TEXTURE_CHECKER,  /* squares of two colors */
    TEXTURE_GRADIENT, /* red across, green down, blue through slices or faces */
    TEXTURE_FILES     /* a PNG a face */
};

/* What a vertex can have: the attributes, by their numbers, then what only shaders read. */
enum stream_element {
    ELEMENT_ATTRIBUTES = TRIPTYCH_ATTRIBUTE_COUNT - 1,
#define ELEMENT(word, usage, index) ELEMENT_##word,
#include "stream/element.def"
#undef ELEMENT
    STREAM_ELEMENTS
};

/* Interleaved vertices: where each element lies within `stride` bytes. */
struct layout {
    enum triptych_format format[STREAM_ELEMENTS];
    uint32_t offset[STREAM_ELEMENTS];
    uint32_t stride;
};

enum resource_type {
    RESOURCE_TEXTURE,
    RESOURCE_VERTICES,
    RESOURCE_INDICES,
    RESOURCE_BUFFER,
    RESOURCE_MESH,
    RESOURCE_SHADER,
    RESOURCE_QUERY,
    RESOURCE_SEQUENCE
};

struct resource {
    enum resource_type type;
    char *name;
    char *path; /* as written; null: the data are in the text */

    /* Texture: its contents in its format, face by face, each with all its levels, or with `mips` the first
     * one. */
    struct triptych_texture_description texture;
    enum texture_source source;
    uint8_t *texels;
    size_t texel_bytes;
    int mips;         /* the levels below the first are made of it */
    int changes;      /* some call of the stream changes it */
    uint32_t *colors; /* of the source, as it was written */
    uint32_t color_count, cell;
    char *face_path[6]; /* TEXTURE_FILES */

    enum value_type value_type; /* buffer */
    struct layout layout;       /* vertices, mesh */
    uint8_t *vertices;          /* vertices, mesh; buffer of floats or colours: its values */
    size_t vertex_bytes;
    uint32_t vertex_count;
    void *indices; /* indices, mesh, buffer of integers: index_count words of index_bits */
    uint32_t index_bits, index_count;
    uint32_t index_least, index_most;
    struct mesh_options options; /* mesh */
    struct skeleton *skeleton;   /* of a mesh with bones */

    char *code; /* shader: its canonical text */
    size_t code_bytes;
    const struct program *program; /* what it is */

    uint32_t call;     /* sequence: the number of its CALL_SEQUENCE */
    uint32_t depth;    /* sequence: 1 + that of the deepest sequence it plays */
    uint32_t executed; /* sequence: calls and plays that one play of it executes */
};

enum call_type {
    CALL_TARGET,
    CALL_VIEWPORT,
    CALL_SCISSOR,
    CALL_SET,
    CALL_CONVENTION,
    CALL_CLIP_PLANE,
    CALL_TRANSFORM,
    CALL_MATERIAL,
    CALL_LIGHT,
    CALL_ENABLE_LIGHT,
    CALL_BIND_TEXTURE,
    CALL_BIND_VERTICES,
    CALL_BIND_INDICES,
    CALL_BIND_ELEMENT,
    CALL_BIND_STREAM,
    CALL_DECLARE,
    CALL_FVF,
    CALL_FREQUENCY,
    CALL_SHADER,
    CALL_CONSTANTS,
    CALL_CONSTANT_MATRIX, /* constants from the transforms as they are then */
    CALL_UPDATE,
    CALL_MIPS,
    CALL_ATTACH,
    CALL_COPY,
    CALL_CLEAR,
    CALL_DRAW,
    CALL_DRAW_INDEXED,
    CALL_DRAW_MESH,
    CALL_BEGIN_QUERY,
    CALL_END_QUERY,
    CALL_FRAME,
    CALL_PLAY,
    CALL_SEQUENCE /* its `count` calls follow; reaching it executes nothing */
};

/* Constants of shaders; longer lists become several calls. */
enum constant_type { CONSTANTS_FLOAT, CONSTANTS_INTEGER, CONSTANTS_BOOLEAN };
enum { CONSTANTS_PER_CALL = 4, MATRICES_PER_CALL = 4 };

enum { NO_RESOURCE = 65536 }; /* past the last number: LIMIT_NAMES */

/* A surface of a texture, or of the target. */
struct stream_surface {
    uint32_t resource; /* NO_RESOURCE: the target; none where it may be missing */
    uint32_t level, slice;
};

struct call {
    enum call_type type;
    uint32_t line, column; /* of the call's first word */
    uint32_t resource;     /* its number, or NO_RESOURCE; bind, draw mesh, queries, play, sequence */
    union {
        struct triptych_target_description target;
        struct triptych_viewport viewport;
        struct {
            enum triptych_convention which;
            uint32_t value;
        } convention;
        struct {
            uint32_t index;
            float plane[4];
        } clip_plane;
        struct {
            uint32_t x, y, width, height;
        } scissor;
        struct {
            enum triptych_state_table table;
            uint32_t i, row; /* of the sampler or stage (0 for render states), of the table */
            uint32_t value;
        } set;
        struct {
            enum triptych_transform which;
            float matrix[4][4];
        } transform;
        struct triptych_material material;
        uint32_t sampler; /* CALL_BIND_TEXTURE */
        struct {
            uint32_t index;
            int on;                      /* CALL_ENABLE_LIGHT */
            struct triptych_light value; /* CALL_LIGHT */
        } light;
        struct {
            enum triptych_attribute attribute;
            enum triptych_format format; /* TRIPTYCH_FORMAT_NONE unbinds */
            uint32_t offset, stride;
        } element;
        struct {
            uint32_t number, offset, stride;
        } bind_stream; /* no resource: unbinds */
        struct {
            uint32_t count;
            struct declared {
                uint8_t element, format, stream;
                uint16_t offset;
            } element[STREAM_ELEMENTS];
        } declare;
        uint32_t fvf;
        struct {
            int some; /* 0: back to the target */
            struct stream_surface color[TRIPTYCH_TARGETS], depth;
            enum triptych_depth_format depth_format;
        } attach;
        struct {
            struct stream_surface surface[2];
            struct triptych_rectangle part[2]; /* of width 0: all */
            enum triptych_copy_filter filter;
        } copy;
        struct {
            uint32_t stream;
            enum triptych_frequency frequency;
            uint32_t count;
        } frequency;
        enum triptych_shader_stage shader; /* CALL_SHADER; no resource: the fixed function */
        struct {
            enum triptych_shader_stage stage;
            enum constant_type type;
            uint32_t first, count;
            union {
                float floats[CONSTANTS_PER_CALL][4];
                int32_t integers[CONSTANTS_PER_CALL][4];
                int32_t booleans[TRIPTYCH_SHADER_BOOLEANS];
            };
        } constants;
        struct {
            enum triptych_shader_stage stage;
            uint32_t first, count;              /* columns */
            uint32_t factors;                   /* matrices that are multiplied */
            uint16_t factor[MATRICES_PER_CALL]; /* transforms as they are then */
            uint8_t inverse, transposed;
        } constant_matrix;
        struct {
            uint32_t face, level;
            struct triptych_box box; /* of width 0: the whole level */
            uint32_t source;         /* the number of the resource whose bytes these are */
        } update;
        struct {
            unsigned flags; /* TRIPTYCH_CLEAR_... */
            float color[4], depth;
            uint32_t stencil;
        } clear;
        struct {
            enum triptych_primitive primitive;
            int32_t base; /* indexed */
            uint32_t first, count;
        } draw;
        struct {
            uint32_t count;
        } sequence;
    };
};

struct stream {
    char *path; /* of the file; empty when parsed from memory without one */
    struct resource *resources;
    uint32_t resource_count;
    struct call *calls;
    uint32_t call_count;
    uint32_t *executed;
    uint32_t executed_count;
    uint32_t *frames; /* frame_count + 1 positions in `executed` */
    uint32_t frame_count;
};

/* What a material and lights are before they are set, and what a call leaves out. */
extern const struct triptych_material stream_default_material;
extern const struct triptych_light stream_default_light;

/* The declaration that a CALL_DECLARE makes; returns how many elements. */
unsigned stream_declaration(const struct call *call,
                            struct triptych_declaration_element elements[STREAM_ELEMENTS]);

/* What declares elements of vertices that lie in stream 0; returns how many, or 0 if all of them are attributes, which
 * need no stream of that number. */
unsigned stream_declare_layout(const struct layout *layout,
                               struct triptych_declaration_element elements[STREAM_ELEMENTS]);

/* The word of the element with that usage. */
const char *stream_element_word(unsigned usage, unsigned usage_index);

/* The constants that a CALL_CONSTANT_MATRIX makes of the transforms, of which there are TRIPTYCH_TRANSFORM_COUNT.
 * Returns 0, or -1 if a number is not finite, as where there is no inverse. */
int stream_constants(const struct call *call, const float (*transforms)[4][4],
                     float constants[CONSTANTS_PER_CALL][4]);

/* The bytes that an attribute can lie in: those of the vertices, or of a buffer of any type. */
const void *resource_data(const struct resource *resource, size_t *bytes);

/* Reads a stream and the files it names. On failure *stream is null and the reason is FILE:LINE:COLUMN: what
 * was found, what was expected. */
int stream_read(const char *path, struct stream **stream, struct error *error);

/* The same of a text in memory; `path` is the name in reasons, and its folder is where asset paths begin. */
int stream_parse(const char *path, const char *text, size_t bytes, struct stream **stream,
                 struct error *error);

/* Null is allowed. */
void stream_free(struct stream *stream);

/* Canonical text, which reads as the same stream; the caller frees *text. `path` is the file it is meant for:
 * paths of assets are changed to begin at its folder. */
int stream_write(const struct stream *stream, const char *path, char **text, size_t *bytes,
                 struct error *error);

/* stream_write to the file, whole or not at all. */
int stream_save(const struct stream *stream, const char *path, struct error *error);

/* Creates the stream's resources on the device, which then should not be used otherwise until the player is
 * freed, except to read pictures and counters. The stream and the device must outlive the player. Calls
 * nothing else. */
int stream_prepare(const struct stream *stream, triptych_device *device, struct player **player,
                   struct error *error);

/* Null is allowed. Frees the stream's resources on the device too. */
void player_free(struct player *player);

/* Plays frame `frame` (0 to frame_count - 1) and finishes it (triptych_finish). After frame - 1 that executes
 * the frame's calls; otherwise the states, bindings and targets of all earlier frames are executed first,
 * from the defaults on, without their draws and clears. */
int player_frame(struct player *player, uint32_t frame, struct error *error);

/* What a query counted in the frame that was played last. */
struct query_count {
    const char *name; /* the stream's */
    uint64_t passed;
};

/* The i-th of the queries that ended in that frame, in the order of their definitions. Returns 0 past the
 * last. */
int player_query(struct player *player, uint32_t i, struct query_count *count);

/* Called after each frame; a result that is not 0 stops playing, and stream_play returns it. */
typedef int frame_callback(void *user, uint32_t frame, triptych_device *device, struct error *error);

/* Prepares and plays frames `first` to `last`. `callback` may be null. */
int stream_play(const struct stream *stream, triptych_device *device, uint32_t first, uint32_t last,
                frame_callback *callback, void *user, struct error *error);

#endif
