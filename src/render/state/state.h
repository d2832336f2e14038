/* The state: everything the application sets, as it set it, and what may be set.
 *
 * The states by number are the rows of def/state/state.def, def/state/sampler_state.def and
 * def/state/stage_state.def (state_table.c). Nothing here derives anything: render/derive/derive.h does,
 * when a draw is recorded. */
#ifndef RENDER_STATE_STATE_H
#define RENDER_STATE_STATE_H

#include "contract/key.h"
#include "render/state/resource.h"
#include "render/texture/texture.h"

#include <stdbool.h>

struct program;

/* The rows of the three tables, by the names of the states. The public enumerations have the same rows with
 * names in capitals. */
enum {
#define STATE(number, name, ...) STATE_##name,
#include "def/state/state.def"
#undef STATE
    STATE_ROWS
};
enum {
#define SAMPLER_STATE(number, name, ...) SAMPLER_##name,
#include "def/state/sampler_state.def"
#undef SAMPLER_STATE
    SAMPLER_STATE_ROWS
};
enum {
#define STAGE_STATE(number, name, ...) STAGE_##name,
#include "def/state/stage_state.def"
#undef STAGE_STATE
    STAGE_STATE_ROWS
};

/* The streams of a declaration, then one for each attribute that is set by itself. */
enum { STREAM_COUNT = TRIPTYCH_STREAMS + TRIPTYCH_ATTRIBUTE_COUNT };

/* Where an attribute lies: in vertex i of a stream, `offset` bytes from its start. */
struct state_element {
    enum triptych_format format; /* NONE: not declared */
    unsigned stream;
    size_t offset;
};

/* An element that does not correspond to an attribute; shaders can read it by its usage. */
struct state_other {
    uint8_t usage, usage_index;
    struct state_element element;
};

/* Vertex i begins at offset + i * stride of the buffer. */
struct state_stream {
    struct triptych_buffer *buffer; /* null: not bound */
    size_t offset, stride;
    enum triptych_frequency frequency;
    uint32_t count; /* of the frequency; 0 is 1 */
};

/* A colour target: how it stores its pixels, and which channels it has (bits as in a write mask; none: no
 * target). */
struct target_channels {
    uint8_t storage; /* enum target_storage */
    uint8_t channels;
};

/* The constant registers of a stage. */
struct shader_registers {
    float floats[TRIPTYCH_SHADER_FLOATS][4];
    int32_t integers[TRIPTYCH_SHADER_INTEGERS][4];
};

enum { SHADER_STAGES = 2 }; /* arrays over stages are indexed by enum shader_stage */

enum constant_file { CONSTANT_FLOAT, CONSTANT_INTEGER, CONSTANT_BOOLEAN };

struct state {
    uint32_t value[TRIPTYCH_STATE_COUNT];
    uint32_t sampler[TRIPTYCH_SAMPLERS][TRIPTYCH_SAMPLER_STATE_COUNT];
    uint32_t stage[TRIPTYCH_STAGES][TRIPTYCH_STAGE_STATE_COUNT];
    float transform[TRIPTYCH_TRANSFORM_COUNT][4][4];
    struct triptych_viewport viewport;
    struct scissor {
        uint32_t x, y, width, height; /* pixels */
    } scissor;
    struct triptych_clip_mask clip_mask; /* without a texture or with an empty box: none */
    float clip_plane[TRIPTYCH_CLIP_PLANES][4];
    uint8_t convention[TRIPTYCH_CONVENTION_COUNT];
    struct triptych_material material;
    struct triptych_light light[TRIPTYCH_LIGHTS];
    uint8_t light_enabled[TRIPTYCH_LIGHTS];
    struct triptych_texture *texture[TRIPTYCH_SAMPLERS];
    struct state_element element[TRIPTYCH_ATTRIBUTE_COUNT];
    struct state_other other[TRIPTYCH_DECLARATION_ELEMENTS];
    unsigned others;
    struct state_stream stream[STREAM_COUNT];
    bool immediate; /* draws read immediate_stream instead of stream 0 */
    struct state_stream immediate_stream;
    struct triptych_buffer *indices;
    uint32_t index_bits;    /* 8, 16 or 32 while indices are bound */
    uint32_t width, height; /* of the target, in pixels */
    struct target_channels target[TARGETS];
    enum triptych_depth_format depth_format;           /* of the target */
    uint8_t samples;                                   /* 2^samples per pixel of the target */
    uint8_t counting;                                  /* an occlusion query counts what passes */
    uint8_t late_tests;                                /* the setting `depth` is `late` */
    const struct program *program[SHADER_STAGES];      /* null: fixed function */
    struct shader_registers *registers[SHADER_STAGES]; /* the state's owner's */
    uint16_t booleans[SHADER_STAGES];                  /* constants: a bit each */
};

extern const char *const state_attribute_name[TRIPTYCH_ATTRIBUTE_COUNT];

/* Direct3D 9's defaults; identity transforms, nothing bound, an empty viewport and scissor rectangle. */
void state_initialize(struct state *state);

/* Sets the state that a new target determines: its size and formats, and viewport and scissor rectangle that
 * cover all of it. */
void state_set_target(struct state *state, const struct triptych_target_description *description);

/* Fails if a target with that depth format cannot be cleared to these values (triptych_clear_rectangles). */
enum triptych_result state_check_clear(enum triptych_depth_format format,
                                       const struct triptych_clear_values *values, struct error *error);

/* Each function checks its argument and sets it, or leaves the state unchanged and gives the reason.
 * state_set_value takes sampler or stage `i` (0 for render states) and the row's number in the table. */
enum triptych_result state_set_value(struct state *state, enum triptych_state_table table, unsigned i,
                                     unsigned row, uint32_t value, struct error *error);
/* Returns true if the state exists and already has that value. */
bool state_has_value(const struct state *state, enum triptych_state_table table, unsigned i, unsigned row,
                     uint32_t value);
enum triptych_result state_set_transform(struct state *state, enum triptych_transform which,
                                         const float matrix[4][4], struct error *error);
enum triptych_result state_set_viewport(struct state *state, const struct triptych_viewport *viewport,
                                        struct error *error);
void state_set_scissor(struct state *state, struct scissor scissor);
enum triptych_result state_set_clip_mask(struct state *state, const struct triptych_clip_mask *mask,
                                         struct error *error);
enum triptych_result state_set_clip_plane(struct state *state, unsigned i, const float plane[4],
                                          struct error *error);
enum triptych_result state_set_convention(struct state *state, enum triptych_convention which, unsigned value,
                                          struct error *error);
enum triptych_result state_set_material(struct state *state, const struct triptych_material *material,
                                        struct error *error);
enum triptych_result state_set_light(struct state *state, unsigned index, const struct triptych_light *light,
                                     struct error *error);

/* The first fails if a stage does not have these constants (triptych_set_shader_floats and so on), the
 * second if the shaders must not run with the integers that they read. */
enum triptych_result state_check_constants(enum constant_file file, enum triptych_shader_stage stage,
                                           unsigned first, unsigned count, struct error *error);
enum triptych_result state_check_integers(const struct state *state, struct error *error);

/* In render/state/declare.c. */
enum triptych_result state_set_declaration(struct state *state,
                                           const struct triptych_declaration_element *elements,
                                           unsigned count, struct error *error);
enum triptych_result state_set_fvf(struct state *state, uint32_t fvf, struct error *error);
/* Writes the elements that a declaration has set, at most TRIPTYCH_DECLARATION_ELEMENTS: attributes, then
 * others. Returns their number. */
unsigned state_declaration(const struct state *state, struct triptych_declaration_element *elements);
enum triptych_result state_set_stream(struct state *state, unsigned stream, struct triptych_buffer *buffer,
                                      size_t offset, size_t stride, struct error *error);
/* Returns true if the stream has these values already. */
bool state_has_stream(const struct state *state, unsigned stream, const struct triptych_buffer *buffer,
                      size_t offset, size_t stride);
enum triptych_result state_set_frequency(struct state *state, unsigned stream,
                                         enum triptych_frequency frequency, uint32_t count,
                                         struct error *error);
enum triptych_result state_set_element(struct state *state, enum triptych_attribute attribute,
                                       const struct triptych_element *element, struct error *error);

/* The element that is declared with that usage, or null. */
const struct state_element *state_find_element(const struct state *state, unsigned usage,
                                               unsigned usage_index);

/* The stream that an attribute comes from. */
static inline const struct state_stream *state_stream_of(const struct state *state,
                                                         enum triptych_attribute attribute)
{
    return state->stream + state->element[attribute].stream;
}

/* The stream that draws read for an element. */
static inline const struct state_stream *state_source(const struct state *state,
                                                      const struct state_element *element)
{
    bool immediate = state->immediate && !element->stream;
    return immediate ? &state->immediate_stream : state->stream + element->stream;
}

/* How often an indexed draw is drawn. */
static inline uint32_t state_instances(const struct state *state)
{
    const struct state_stream *first = state->stream;
    return first->frequency == TRIPTYCH_FREQUENCY_INDEXED ? first->count : 1;
}

/* The last vertex of its stream that has an element, or UINT64_MAX where the stride is 0. The stream is
 * bound. */
uint64_t state_last_vertex(const struct state *state, const struct state_element *element);

#endif
