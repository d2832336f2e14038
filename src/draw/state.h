/* The state: everything the application sets, as it set it, and what may be set.
 *
 * The states by number are the rows of def/state.def, def/sampler_state.def and def/stage_state.def
 * (state_table.c). Nothing here derives anything: draw/derive.h does, when a draw is recorded. */
#ifndef DRAW_STATE_H
#define DRAW_STATE_H

#include "draw/resource.h"
#include "draw/texture.h"

struct state {
    uint32_t value[TRIPTYCH_STATE_COUNT];
    uint32_t sampler[TRIPTYCH_SAMPLERS][TRIPTYCH_SAMPLER_STATE_COUNT];
    uint32_t stage[TRIPTYCH_STAGES][TRIPTYCH_STAGE_STATE_COUNT];
    float transform[TRIPTYCH_TRANSFORM_COUNT][4][4];
    struct triptych_viewport viewport;
    struct scissor {
        uint32_t x, y, width, height; /* pixels */
    } scissor;
    struct triptych_material material;
    struct triptych_light light[TRIPTYCH_LIGHTS];
    uint8_t light_enabled[TRIPTYCH_LIGHTS];
    struct triptych_texture *texture;
    struct triptych_element element[TRIPTYCH_ATTRIBUTE_COUNT];
    struct triptych_buffer *indices;
    uint32_t index_bits; /* 16 or 32 while indices are bound */
};

/* Bytes of an attribute in memory, by format. */
extern const uint8_t format_bytes[TRIPTYCH_FORMAT_COUNT];
extern const char *const attribute_name[TRIPTYCH_ATTRIBUTE_COUNT];

/* Direct3D 9's defaults; identity transforms, nothing bound, an empty viewport and scissor rectangle. */
void state_initialize(struct state *state);

/* Each checks its argument and sets it, or leaves the state alone and gives the reason. state_set_value takes
 * sampler or stage `i` (0 for render states) and the row's number in the table. */
enum triptych_result state_set_value(struct state *state, enum triptych_state_table table, unsigned i,
                                     unsigned row, uint32_t value, struct error *error);
enum triptych_result state_set_transform(struct state *state, enum triptych_transform which,
                                         const float matrix[4][4], struct error *error);
enum triptych_result state_set_viewport(struct state *state, const struct triptych_viewport *viewport,
                                        uint32_t target_width, uint32_t target_height, struct error *error);
enum triptych_result state_set_scissor(struct state *state, struct scissor scissor, uint32_t target_width,
                                       uint32_t target_height, struct error *error);
enum triptych_result state_set_material(struct state *state, const struct triptych_material *material,
                                        struct error *error);
enum triptych_result state_set_light(struct state *state, unsigned index, const struct triptych_light *light,
                                     struct error *error);
enum triptych_result state_set_texture(struct state *state, struct triptych_texture *texture,
                                       struct error *error);
enum triptych_result state_set_element(struct state *state, enum triptych_attribute attribute,
                                       const struct triptych_element *element, struct error *error);

#endif
