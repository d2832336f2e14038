/* The values that a program sets on a device, as it set them. A device has one set of values, and each state
 * block has one of its own with a mask of the values that belong to it.
 *
 * Values are cells in groups (group.def). A group is an array in struct d3d9_state; a cell is one of its
 * elements. Cells are numbered across all groups: D3D9_CELL_GROUP + index. Lights are not cells, because
 * there can be any number of them (light.h). */
#ifndef D3D9_STATE_H
#define D3D9_STATE_H

#include "object.h"
#include "types.h"
#include "triptych.h"

struct d3d9_base_texture;
struct d3d9_declaration;
struct d3d9_device;
struct d3d9_buffer;
struct d3d9_shader;

enum {
    D3D9_RENDER_STATES = 256, /* numbers of D3DRENDERSTATETYPE and some that do not exist */
    D3D9_SAMPLER_STATES = 14, /* of D3DSAMPLERSTATETYPE, from 0 */
    D3D9_STAGE_STATES = 33,   /* of D3DTEXTURESTAGESTATETYPE, from 0 */
    D3D9_SAMPLERS = TRIPTYCH_SAMPLERS + 1,
    D3D9_DISPLACEMENT_SAMPLER = TRIPTYCH_SAMPLERS, /* the last one: nothing reads it */
    D3D9_VERTEX_FLOATS = 256,                      /* constants of vertex shaders */
    D3D9_SOFTWARE_FLOATS = 8192,                   /* the same with software vertex processing */
    D3D9_PIXEL_FLOATS = 224,
    D3D9_INTEGERS = 16,
    D3D9_BOOLEANS = 16
};

struct d3d9_stream {
    struct d3d9_buffer *buffer; /* held; null: none */
    uint32_t offset, stride;    /* they outlive the buffer */
};

struct d3d9_state {
    uint32_t render[D3D9_RENDER_STATES];
    uint32_t sampler[D3D9_SAMPLERS * D3D9_SAMPLER_STATES];
    uint32_t stage[TRIPTYCH_STAGES * D3D9_STAGE_STATES];
    struct d3d9_matrix transform[TRIPTYCH_TRANSFORM_COUNT]; /* by enum triptych_transform */
    struct d3d9_material material[1];
    struct d3d9_viewport viewport[1];
    struct d3d9_rect scissor[1];
    float clip_plane[TRIPTYCH_CLIP_PLANES][4];
    float patches[1]; /* of N-patches */
    struct d3d9_base_texture *texture[D3D9_SAMPLERS];
    struct d3d9_stream stream[TRIPTYCH_STREAMS];
    uint32_t frequency[TRIPTYCH_STREAMS];
    struct d3d9_buffer *indices[1];
    struct d3d9_declaration *declaration[1];
    struct d3d9_shader *vertex_shader[1];
    struct d3d9_shader *pixel_shader[1];
    int32_t vertex_integer[D3D9_INTEGERS][4];
    int32_t vertex_boolean[D3D9_BOOLEANS];
    float pixel_float[D3D9_PIXEL_FLOATS][4];
    int32_t pixel_integer[D3D9_INTEGERS][4];
    int32_t pixel_boolean[D3D9_BOOLEANS];
    float vertex_float[][4]; /* the number is that of the device */
};

enum d3d9_group {
#define GROUP(NAME, ...) D3D9_GROUP_##NAME,
#include "group.def"
#undef GROUP
    D3D9_GROUPS
};

/* The cells of each group follow those of the previous group. */
enum {
#define GROUP(NAME, member, count, ...)                                                                      \
    D3D9_CELL_##NAME, D3D9_CELL_##NAME##_LAST = D3D9_CELL_##NAME + (count)-1,
#include "group.def"
#undef GROUP
    D3D9_CELLS
};

struct d3d9_mask {
    uint64_t bits[(D3D9_CELLS + 63) / 64];
};

static inline void d3d9_mask_add(struct d3d9_mask *mask, unsigned cell)
{
    mask->bits[cell / 64] |= UINT64_C(1) << cell % 64;
}

static inline bool d3d9_mask_has(const struct d3d9_mask *mask, unsigned cell)
{
    return mask->bits[cell / 64] >> cell % 64 & 1;
}

/* Returns the first cell of the mask that is not below `from`, or D3D9_CELLS. */
unsigned d3d9_mask_next(const struct d3d9_mask *mask, unsigned from);

/* Returns a set of values with that number of floats of vertex shaders: all 0, nothing bound. Null without
 * memory. */
struct d3d9_state *d3d9_state_make(unsigned vertex_floats);
/* Drops what is bound, and frees the set. Null is allowed. */
void d3d9_state_free(struct d3d9_state *);
/* Drops what is bound, and gives all values Direct3D's defaults for a device with or without its own depth
 * surface. The viewport and the scissor rectangle become empty. */
void d3d9_state_initialize(struct d3d9_state *, unsigned vertex_floats, bool depth);

/* Copies one cell. Objects are held by the set that they are copied to. Returns true if the value changes. */
bool d3d9_state_copy(struct d3d9_state *to, const struct d3d9_state *from, unsigned cell);

/* Sets element `index` of a group: in the block that the device records, or on the device and, if it has
 * changed, in the renderer. `value` is an element of the group's array. */
void d3d9_state_set(struct d3d9_device *, enum d3d9_group group, unsigned index, const void *value);
/* The same, never recorded. */
void d3d9_state_set_now(struct d3d9_device *, enum d3d9_group group, unsigned index, const void *value);

/* Returns the index in TRIPTYCH_RENDER_STATES of a state with Direct3D's number, or -1; the
 * other two are for the tables of their names. */
int d3d9_state_render_row(uint32_t number);
int d3d9_state_sampler_row(uint32_t number);
int d3d9_state_stage_row(uint32_t number);
/* Returns the index of a sampler with Direct3D's number, or -1. */
int d3d9_state_sampler(uint32_t number);
/* Returns the enum triptych_transform of a D3DTRANSFORMSTATETYPE, or -1. */
int d3d9_state_transform(uint32_t number);

/* --- How values reach the renderer (state/forward.c) --- */

/* Passes on a cell of the device that has changed, or remembers to do so before the next draw. */
void d3d9_state_forward(struct d3d9_device *, enum d3d9_group group, unsigned index);
/* Passes on all values, after the renderer's device was made or all values were initialized. */
void d3d9_state_forward_all(struct d3d9_device *);
/* A value of a state that the renderer accepts, for any value that a program sets. */
uint32_t d3d9_state_sanitize(enum triptych_state_table table, unsigned row, unsigned i, uint32_t value);
/* A finite number: NaN is 0, infinities are the largest numbers. */
float d3d9_state_finite(float number);

/* --- Lights (state/light.c) --- */

/* A light that the program has defined. In a state block: which of the two halves belong to it. */
struct d3d9_light_entry {
    uint32_t index;
    bool enabled, has_light, has_enabled;
    uint32_t order; /* of its enabling: lower is earlier */
    struct d3d9_light light;
};

/* Sorted by index. */
struct d3d9_lights {
    struct d3d9_light_entry *entry;
    uint32_t count, room, orders;
};

void d3d9_lights_free(struct d3d9_lights *);
/* Null if there is none. */
struct d3d9_light_entry *d3d9_lights_find(const struct d3d9_lights *, uint32_t index);
/* Returns the entry, made with Direct3D's default light if there is none; null without memory. */
struct d3d9_light_entry *d3d9_lights_get(struct d3d9_lights *, uint32_t index);
void d3d9_lights_enable(struct d3d9_lights *, struct d3d9_light_entry *, bool enabled);
/* Gives the renderer the first 8 enabled lights. */
void d3d9_lights_forward(struct d3d9_device *);

#endif
