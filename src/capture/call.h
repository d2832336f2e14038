/* Calls of the public interface (triptych.h) as data. A draw stream consists of calls, whether they are read
 * from text, read from a container, or captured from a running program (record.h).
 *
 * call.def is the table of all calls. A call names resources by number. Its reader checks enumerations and
 * numbers: the grammar of the text, or call_code() and valid_call() for a container. The code that executes a
 * call checks the rest. */
#ifndef CAPTURE_CALL_H
#define CAPTURE_CALL_H

#include "capture/resource.h"
#include "capture/word.h"

enum call_type {
#define CALL(name, number, word, traits, member, function, fields) CALL_##name = number,
#define CALL_OF(name, number, word, traits, type, member, fields)  CALL_##name = number,
#define CALL_BARE(name, number, word, traits, fields)              CALL_##name = number,
#include "capture/call.def"
#undef CALL
#undef CALL_OF
#undef CALL_BARE
    CALL_TYPES = 64 /* above all numbers, which begin at 1 */
};

enum call_trait {
    CALL_NEEDS_TARGET = 1 << 0, /* the current target must have been set */
    CALL_USES_TARGET = 1 << 1,  /* it reads, changes or replaces the target or its viewport */
    CALL_PIXELS = 1 << 2,       /* a regular call that is skipped while frames are skipped */
    CALL_DRAWS = 1 << 3,        /* it begins a frame that a recording has to end */
    CALL_OUTSIDE = 1 << 4,      /* it must not be in a sequence */
    CALL_CHANGES = 1 << 6,      /* it may change `resource` and the textures that it names */
    CALL_SHARES_LINE = 1 << 5   /* its lines in the text begin like those of another call, which reads them */
};

/* --- Members -------------------------------------------------------------------------------------------- */

/* Constants of shaders. A longer list becomes several calls. */
enum call_constant_type { CONSTANTS_FLOAT, CONSTANTS_INTEGER, CONSTANTS_BOOLEAN };
enum { CONSTANTS_PER_CALL = 4, MATRICES_PER_CALL = 4, PARTS_PER_CALL = 24 };

struct call_set {
    enum triptych_state_table table;
    uint32_t i, row; /* the sampler or stage, 0 for render states; the row of the table */
    uint32_t value;
};

struct call_transform {
    enum triptych_transform which;
    float matrix[4][4];
};

struct call_light {
    uint32_t index;
    struct triptych_light value;
};

/* 8, 16 or 32 for a buffer of bytes; 0: the resource's own. */
struct call_bind_indices {
    uint32_t bits;
};

struct call_element {
    enum triptych_attribute attribute;
    enum triptych_format format; /* TRIPTYCH_FORMAT_NONE unbinds */
    uint32_t offset, stride;
};

/* Without a resource it unbinds. */
struct call_bind_stream {
    uint32_t number, offset, stride;
};

struct call_declared {
    uint8_t usage, usage_index, format, stream;
    uint16_t offset; /* bytes */
};

struct call_declare {
    uint32_t count;
    struct call_declared element[TRIPTYCH_DECLARATION_ELEMENTS];
};

/* Without a resource it sets the fixed function. */
struct call_shader {
    enum triptych_shader_stage stage;
};

struct call_constants {
    enum triptych_shader_stage stage;
    enum call_constant_type type;
    uint32_t first, count;
    union {
        float floats[CONSTANTS_PER_CALL][4];
        int32_t integers[CONSTANTS_PER_CALL][4];
        int32_t booleans[TRIPTYCH_SHADER_BOOLEANS];
    };
};

/* Constants that are computed from transforms when the call is executed. */
struct call_constant_matrix {
    enum triptych_shader_stage stage;
    uint32_t first, count;              /* columns */
    uint32_t factors;                   /* matrices that are multiplied */
    uint16_t factor[MATRICES_PER_CALL]; /* enum triptych_transform */
    bool inverse, transposed;
};

struct call_update {
    uint32_t face, level;
    struct triptych_box box; /* width 0: the whole level */
    uint32_t source;         /* the resource with the bytes */
};

struct call_texels {
    uint32_t source; /* a buffer of bytes */
};

/* A surface of a texture, or with NO_RESOURCE the target (copy) or no surface (attach). */
struct call_surface {
    uint32_t resource;
    uint32_t level, slice;
};

struct call_attach {
    bool some; /* false: back to the target */
    struct call_surface color[TRIPTYCH_TARGETS], depth;
    enum triptych_depth_format depth_format;
};

struct call_copy {
    struct call_surface surface[2];    /* from, to */
    struct triptych_rectangle part[2]; /* width 0: the whole surface */
    enum triptych_copy_filter filter;
};

/* Pixels of a part of a surface, in a format (0: its own) without gaps between rows. */
struct call_set_pixels {
    struct call_surface surface;
    struct triptych_rectangle part; /* not empty */
    enum triptych_surface_format format;
    uint32_t source; /* a buffer */
};

struct call_fill {
    struct call_surface surface;
    struct triptych_rectangle part; /* width 0: the whole surface */
    float color[4];
};

struct call_clear {
    unsigned flags; /* TRIPTYCH_CLEAR_... */
    float color[4], depth;
    uint32_t stencil;
};

/* A rectangle inside the largest target. */
struct call_part {
    uint16_t x, y, width, height;
};

/* A clear with masks, of rectangles or with a count of 0 of everything. */
struct call_clear_parts {
    struct call_clear clear;
    uint32_t color_mask, stencil_mask;
    bool everywhere; /* the viewport does not limit it */
    uint32_t count;
    struct call_part part[PARTS_PER_CALL];
};

struct call_write {
    uint32_t offset; /* bytes */
    uint32_t source; /* the resource with the bytes */
};

/* `resource` has the vertices. */
struct call_draw_user {
    uint32_t primitive, count;
    uint32_t stride; /* bytes of a vertex */
};

struct call_draw_indexed_user {
    uint32_t primitive, count, stride;
    uint32_t indices; /* a resource */
    uint32_t bits;    /* of an index: 8, 16 or 32 */
};

struct call_sequence {
    uint32_t count;
};

/* --- Calls ---------------------------------------------------------------------------------------------- */

/* The position of a call in the file that it was read from. */
struct call_position {
    enum { POSITION_TEXT, POSITION_CONTAINER } kind;
    union {
        struct {
            uint32_t line, column; /* of the call's first word, from 1 */
        } text;
        struct {
            uint64_t offset; /* of the chunk in the file */
            uint32_t byte;   /* of the call in the chunk's contents */
        } container;
    };
};

struct call {
    enum call_type type;
    uint32_t resource; /* the number that RESOURCE(resource, ...) in call.def describes, or NO_RESOURCE */
    struct call_position position;
    union {
#define U8(member, name, most, what)         uint32_t name;
#define U16(member, name, most, what)        uint32_t name;
#define U32(member, name, most, what)        uint32_t name;
#define S32(member, name, what)              int32_t name;
#define BOOL(member, name, what)             bool name;
#define WORD(member, name, list, most, what) uint32_t name;
#define FLOATS(member, name, count, what)    float name[count];
#define RESOURCE(path, types, or_none, kind, what)
#define CALL(name, number, word, traits, member, function, fields)                                           \
    struct {                                                                                                 \
        fields                                                                                               \
    } member;
#define CALL_OF(name, number, word, traits, type, member, fields) type member;
#define CALL_BARE(name, number, word, traits, fields)
#include "capture/call.def"
#include "capture/call_undefine.h"
    };
};

/* The type of a call that has the declaration, in `declare`: CALL_DECLARE if all offsets are whole words. */
static inline enum call_type call_declare_type(const struct call_declare *declare)
{
    uint32_t offsets = 0;
    for (uint32_t i = 0; i < declare->count; i++)
        offsets |= declare->element[i].offset;
    return offsets % 4 ? CALL_DECLARE_BYTES : CALL_DECLARE;
}

/* The values of a clear of either kind; null: it is another call. */
static inline const struct call_clear *call_clear_values(const struct call *call)
{
    if (call->type == CALL_CLEAR_PARTS)
        return &call->clear_parts.clear;
    return call->type == CALL_CLEAR ? &call->clear : NULL;
}

/* --- Rows ----------------------------------------------------------------------------------------------- */

enum call_field_kind { FIELD_END, FIELD_INTEGER, FIELD_SIGNED, FIELD_WORD, FIELD_FLOATS, FIELD_RESOURCE };

struct call_field {
    enum call_field_kind kind;
    uint16_t offset;      /* in struct call */
    uint8_t size, bytes;  /* of an integer in struct call; in a container */
    uint8_t count;        /* FIELD_FLOATS */
    bool or_none;         /* FIELD_RESOURCE: NO_RESOURCE is valid */
    enum word_list words; /* FIELD_WORD */
    uint32_t types;       /* FIELD_RESOURCE: a mask of 1 << type */
    uint32_t most;        /* FIELD_INTEGER, FIELD_WORD */
    const char *what;
};

/* The fields end with FIELD_END. */
struct call_row {
    const char *word;
    unsigned traits;
    const struct call_field *fields;
};

/* The row of a type of calls; null if no call has the number. */
const struct call_row *call_row(unsigned type);

/* An integer or word field of the call. */
uint32_t call_get(const struct call *call, const struct call_field *field);
void call_put(struct call *call, const struct call_field *field, uint32_t value);

/* A FIELD_FLOATS, FIELD_SIGNED or FIELD_RESOURCE field of the call. */
float *call_floats(struct call *call, const struct call_field *field);
int32_t *call_signed(struct call *call, const struct call_field *field);
uint32_t *call_resource(struct call *call, const struct call_field *field);

/* Types of resources that calls accept: masks of 1 << type. */
enum {
    CALL_TEXTURES = 1 << RESOURCE_TEXTURE,
    CALL_BUFFERS = 1 << RESOURCE_BUFFER,
    CALL_MESHES = 1 << RESOURCE_MESH,
    CALL_DRAWABLES = 1 << RESOURCE_VERTICES | CALL_MESHES,
    CALL_INDICES = 1 << RESOURCE_INDICES | CALL_BUFFERS | CALL_MESHES,
    CALL_ELEMENTS = 1 << RESOURCE_VERTICES | CALL_BUFFERS | CALL_MESHES,
    CALL_SURFACES = CALL_TEXTURES | 1 << RESOURCE_IMAGE,
    CALL_WRITABLE = 1 << RESOURCE_VERTICES | 1 << RESOURCE_INDICES | CALL_BUFFERS,
    CALL_INDICES_ALONE = 1 << RESOURCE_INDICES | CALL_BUFFERS,
    CALL_RELEASABLE = ((1 << RESOURCE_TYPES) - 1) & ~(1 << RESOURCE_SEQUENCE)
};

/* The next field of the call, from `field` on, that names a resource; null if there is none. */
const struct call_field *call_next_resource(const struct call_field *field);

/* The material and the lights before a call sets them, and what a call leaves out. */
extern const struct triptych_material call_default_material;
extern const struct triptych_light call_default_light;

/* --- Binary form ---------------------------------------------------------------------------------------- */

/* Records other than calls: the definition of a resource, the end of a sequence. */
enum { RECORD_DEFINE = 64, RECORD_END = 65 };

/* Writes or reads all of a call but its type, which is set, and its position. A call that was read has known
 * enumerations and valid array indices. A sequence's count is not coded. */
void call_code(struct codec *codec, struct call *call);

/* Writes or reads the fields of the call's row. */
void call_code_fields(struct codec *codec, struct call *call);

#endif
