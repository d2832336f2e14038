/* Calls of the interface (triptych.h) and the resources that they name, as data: what a draw stream consists of,
 * whether it was read from text (stream/), from a container, or is being recorded from a running program (record.h).
 *
 * A call names resources by number. What a call means is decided where it is executed; that its enumerations and
 * numbers are ones that exist is the business of whoever makes it: the text's grammar, or call_code() and
 * stream/valid.c for what comes from a file. */
#ifndef CONTAINER_CALL_H
#define CONTAINER_CALL_H

#include "triptych.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct codec;
struct program;
struct skeleton;

enum value_type { VALUE_FLOAT, VALUE_U16, VALUE_U32, VALUE_COLOR, VALUE_BYTES };
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
    MESH_SHADOW,
    MESH_DATA /* its vertices and indices are given */
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
#include "container/element.def"
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
    char *path;   /* as written; null: the data are in the text */
    int embedded; /* the data are those of a container: whether the path's file has the same is not known */

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
#define CALL(name, number, word) CALL_##name = number,
#include "container/call.def"
#undef CALL
};

/* Constants of shaders; longer lists become several calls. */
enum constant_type { CONSTANTS_FLOAT, CONSTANTS_INTEGER, CONSTANTS_BOOLEAN };
enum { CONSTANTS_PER_CALL = 4, MATRICES_PER_CALL = 4 };

enum { NO_RESOURCE = 65536 }; /* past the last number */

/* A surface of a texture, or of the target. */
struct stream_surface {
    uint32_t resource; /* NO_RESOURCE: the target; none where it may be missing */
    uint32_t level, slice;
};

struct call {
    enum call_type type;
    uint32_t line, column; /* of the call's first word; of a container: call_place() */
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
        uint32_t sampler;    /* CALL_BIND_TEXTURE */
        uint32_t index_bits; /* CALL_BIND_INDICES: 16 or 32 of a buffer of bytes; 0: those that it has */
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
                uint32_t usage : 4, usage_index : 4, format : 5, stream : 4,
                    words : 14; /* its offset in them */
            } element[TRIPTYCH_DECLARATION_ELEMENTS];
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
            uint32_t source; /* the number of a buffer of bytes */
        } texels;            /* CALL_TEXELS; of CALL_CONTENTS that is the call's resource */
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

/* What a material and lights are before they are set, and what a call leaves out. */
extern const struct triptych_material stream_default_material;
extern const struct triptych_light stream_default_light;

/* The word of a type of calls; null if there is none of that number. */
const char *call_word(unsigned type);

/* Records that are no calls: the definition of a resource, the end of a sequence. */
enum { RECORD_DEFINE = 64, RECORD_END = 65 };

/* Where a call stands in a container: its chunk begins at `offset` of the file, the call at `byte` of its contents. */
static inline void call_set_place(struct call *call, uint64_t offset, uint32_t byte)
{
    call->line = (uint32_t)(offset >> 12);
    call->column = (uint32_t)offset << 20 | byte;
}

static inline uint64_t call_offset(const struct call *call)
{
    return (uint64_t)call->line << 12 | call->column >> 20;
}

static inline uint32_t call_byte(const struct call *call)
{
    return call->column & 0xfffff;
}

/* A resource that a call names, and what it may be: a mask of 1 << type. */
struct call_resource {
    uint32_t *number;
    unsigned types;
    bool optional; /* or NO_RESOURCE */
};

enum { CALL_RESOURCES = TRIPTYCH_TARGETS + 1 };

/* The resources that a call of its type has places for; returns how many. */
unsigned call_resources(struct call *call, struct call_resource resources[CALL_RESOURCES]);

/* Writes or reads all of a call but its type (codec.h), which is set, and its place. What is read is within what its
 * type can hold: enumerations are known ones, indices those of arrays. A sequence's count is not coded. */
void call_code(struct codec *codec, struct call *call);

/* Everything of a resource but its data, which follow. Its type is set. When it is read, names and paths are the
 * caller's to free, also after a failure. */
void resource_code(struct codec *codec, struct resource *resource);

/* The data of a resource that a container has, in this order. One that was just read has the sizes and null pointers. */
struct resource_part {
    void *data;
    size_t bytes;
};

enum { RESOURCE_PARTS = 2 };

unsigned resource_parts(const struct resource *resource, struct resource_part parts[RESOURCE_PARTS]);

/* Gives the resource data of a part's size, allocated with malloc. */
void resource_set_part(struct resource *resource, unsigned part, void *data);

/* Bytes that a device takes for the resource, for limits. */
size_t resource_cost(const struct resource *resource);

/* Bytes of a texture's texels as calls set them: in the storage of its format, without gaps. */
size_t resource_texels(const struct resource *resource);

/* The number in a layout of what is used so (enum stream_element); -1: there is none. And back. */
int element_find(unsigned usage, unsigned usage_index);
enum triptych_usage element_usage(unsigned element, unsigned *usage_index);

#endif
