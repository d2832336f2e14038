/* The resources that calls name, as data: textures, vertices, indices, buffers, meshes, shaders, queries,
 * sequences. */
#ifndef CAPTURE_RESOURCE_H
#define CAPTURE_RESOURCE_H

#include "triptych.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct codec;
struct program;
struct skeleton;
struct materials;

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
    MESH_DATA,   /* its vertices and indices are given */
    MESH_MODEL,  /* as MESH_FILE, its triangles by material */
    MESH_SOURCES /* their number */
};

/* Options of a mesh. */
struct mesh_options {
    enum mesh_source source;
    enum normals normals;
    enum texcoords texcoords;
    unsigned subdivisions; /* MESH_BEZIER */
    bool center;
    float fit;         /* the longest side of the bounding box after scaling; 0: no scaling */
    float repeat[2];   /* factors of texture coordinates */
    uint32_t cells[2]; /* MESH_GRID to MESH_TORUS: across, down */
    float tube;        /* MESH_TORUS: its radius */
    bool bones;        /* MESH_FILE: vertices have weights and indices, and the mesh has a skeleton */
    uint32_t caster;   /* MESH_SHADOW: the number of the mesh that casts the shadow */
    bool light_is_point;
    float light[3], length; /* its position, or the direction of light; the length of the shadow */
};

/* The source of a texture's texels. Texels of files and blocks are in the files or the text. The others are
 * generated. */
enum texture_source {
    TEXTURE_IMAGE,    /* WIDTH HEIGHT { color... }, or a PNG file */
    TEXTURE_DDS,      /* a DDS file, which determines the description */
    TEXTURE_EMPTY,    /* all bits 0 */
    TEXTURE_BYTES,    /* bytes in memory order */
    TEXTURE_COLORS,   /* one colour per texel */
    TEXTURE_FILL,     /* one colour per level */
    TEXTURE_CHECKER,  /* squares of two colors */
    TEXTURE_GRADIENT, /* red across, green down, blue through slices or faces */
    TEXTURE_FILES     /* one PNG file per face */
};

/* Elements of vertices: the attributes, by their numbers, then elements that only shaders read. */
enum stream_element {
    ELEMENT_ATTRIBUTES = TRIPTYCH_ATTRIBUTE_COUNT - 1,
#define ELEMENT(word, usage, index) ELEMENT_##word,
#include "capture/element.def"
#undef ELEMENT
    STREAM_ELEMENTS
};

/* The format and offset of each element in interleaved vertices of `stride` bytes. */
struct layout {
    enum triptych_format format[STREAM_ELEMENTS];
    uint32_t offset[STREAM_ELEMENTS];
    uint32_t stride;
};

enum { RESOURCE_TYPES = 9 };

enum resource_type {
    RESOURCE_TEXTURE,
    RESOURCE_VERTICES,
    RESOURCE_INDICES,
    RESOURCE_BUFFER,
    RESOURCE_MESH,
    RESOURCE_SHADER,
    RESOURCE_QUERY,
    RESOURCE_SEQUENCE,
    RESOURCE_IMAGE
};

/* The members that all types have, then those of the type. Queries have no more. */
struct resource {
    enum resource_type type;
    bool embedded; /* the data are from a container; the file may differ */
    bool changes;  /* a call of the stream changes it */
    char *name;
    char *path; /* as written; null if the data are in the text */
    union {
        /* Textures. The contents are in the format of the texture, face by face, each with all levels, or
         * with `mips` only the first level. */
        struct {
            struct triptych_texture_description texture;
            enum texture_source source;
            bool mips; /* the other levels are computed from the first */
            uint8_t *texels;
            size_t texel_bytes;
            uint32_t *colors; /* colours of the source, as written */
            uint32_t color_count, cell;
            char *face_path[6]; /* TEXTURE_FILES */
        };
        struct triptych_image_description image;
        /* Vertices, indices, buffers, meshes (resource_has_geometry). */
        struct {
            enum value_type value_type; /* buffer */
            struct layout layout;       /* vertices, mesh */
            uint8_t *vertices; /* vertices, mesh; or the values of a buffer of floats, colours or bytes */
            size_t vertex_bytes;
            uint32_t vertex_count;
            void *indices; /* indices, mesh, buffer of integers: index_count words of index_bits */
            uint32_t index_bits, index_count;
            uint32_t index_least, index_most;
            struct mesh_options options; /* mesh */
            struct skeleton *skeleton;   /* mesh with bones */
            struct materials *materials; /* mesh of a model, while its text is read; or null */
        };
        /* Shaders. */
        struct {
            char *code; /* canonical text */
            size_t code_bytes;
            const struct program *program; /* the program of the text */
            char *written;                 /* the text as it is in the stream's text; else null */
        };
        /* Sequences. */
        struct {
            uint32_t call;     /* the number of its CALL_SEQUENCE */
            uint32_t depth;    /* 1 + the depth of the deepest sequence that it plays */
            uint32_t executed; /* the calls and plays that one play of it executes */
            uint32_t frames;   /* the frames that one play of it ends */
        };
    };
};

static inline bool resource_has_geometry(const struct resource *resource)
{
    return resource->type >= RESOURCE_VERTICES && resource->type <= RESOURCE_MESH;
}

/* Returns the bytes of vertices, or of a buffer of any type. */
const void *resource_data(const struct resource *resource, size_t *bytes);

/* The number of no resource: one past the last number. */
enum { NO_RESOURCE = 65536 };

/* Writes or reads everything of a resource but its type, which is set, and its data, which follow. After a
 * read, also a failed one, the caller frees the name and the paths. */
void resource_code(struct codec *codec, struct resource *resource);

/* The data of a resource in a container, in this order. After resource_code has read a resource, its parts
 * have sizes and null pointers. */
struct resource_part {
    void *data;
    size_t bytes;
};

enum { RESOURCE_PARTS = 2 };

unsigned resource_parts(const struct resource *resource, struct resource_part parts[RESOURCE_PARTS]);

/* Gives the resource a part's data, which malloc has allocated. */
void resource_set_part(struct resource *resource, unsigned part, void *data);

/* Bytes that the resource takes on a device, for limits. */
size_t resource_cost(const struct resource *resource);

/* Bytes of a texture's texels as CALL_TEXELS has them: in the storage of its format, without padding. */
size_t resource_texels(const struct resource *resource);

/* The number (enum stream_element) of the element with this usage, or -1. */
int resource_find_element(unsigned usage, unsigned usage_index);

/* The usage of the element with this number. */
enum triptych_usage resource_element_usage(unsigned element, unsigned *usage_index);

#endif
