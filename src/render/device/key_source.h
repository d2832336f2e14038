/* The source of keys: everything in the state that may change a key, or of a draw what no part of
 * render/derive/derive.h has (struct draw: how it is covered and clipped).
 *
 * Two states with the same source have the same keys, whatever else differs: matrices, colours, addresses,
 * and which of several alike textures are bound. A source is compared as a whole, so what was derived for one
 * may be used again for an equal one. tests/render/derive/change.c changes every state between two
 * sources. */
#ifndef RENDER_DEVICE_KEY_SOURCE_H
#define RENDER_DEVICE_KEY_SOURCE_H

#include "render/derive/derive.h"

/* Of a texture: what keys depend on. Of sides that are powers of two they depend on nothing else. */
struct key_source_texture {
    const struct format *format;
    uint32_t side[3]; /* 0: a power of two */
    uint8_t type, tiled, levels, sampler;
};

/* An element that is not an attribute. */
struct key_source_other {
    uint8_t usage, usage_index, format;
};

/* Everything but the values of the three tables, in as few bytes as possible. Bytes between fields are
 * zero. */
struct key_source_rest {
    uint32_t program[SHADER_STAGES];  /* numbers; 0: none */
    uint32_t bound;                   /* a bit for each sampler with a texture */
    uint16_t booleans[SHADER_STAGES]; /* that the programs read */
    uint8_t primitive, power, fog_by_w, samples, counting, late_tests, depth_format, clip_mask, others;
    uint8_t convention[TRIPTYCH_CONVENTION_COUNT];
    uint8_t light[TRIPTYCH_LIGHTS]; /* 0: off */
    struct target_channels target[TARGETS];
    uint8_t format[TRIPTYCH_ATTRIBUTE_COUNT];
    struct key_source_texture texture[TRIPTYCH_SAMPLERS];         /* of the bound ones, in order */
    struct key_source_other other[TRIPTYCH_DECLARATION_ELEMENTS]; /* the first `others` */
};

struct key_source {
    struct key_source_rest rest;
    uint32_t value[TRIPTYCH_STATE_COUNT];
    uint32_t stage[TRIPTYCH_STAGES][TRIPTYCH_STAGE_STATE_COUNT];
    uint32_t sampler[TRIPTYCH_SAMPLERS][TRIPTYCH_SAMPLER_STATE_COUNT];
};

/* Takes the rest of a state's source, for draws of a primitive. Elements of arrays that do not count are not
 * written. */
void device_source_take_rest(const struct state *state, enum primitive primitive,
                             struct key_source_rest *rest);

/* A number that is the same for equal sources, and seldom for others. */
uint32_t device_source_hash(const struct state *state, const struct key_source_rest *rest);

/* Makes it the source of the state with that rest. */
void device_source_take(const struct state *state, const struct key_source_rest *rest,
                        struct key_source *source);

/* Returns true if it is the source of the state with that rest. */
bool device_source_is(const struct key_source *source, const struct state *state,
                      const struct key_source_rest *rest);

#endif
