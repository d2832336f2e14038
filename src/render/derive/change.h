/* Sets of the parts that a change of the state may affect (render/derive/derive.h).
 *
 * For the value of a state the set is a column of its table (def/state/state.def).
 * tests/render/derive/change.c compares what each setter derives with a derivation from scratch. */
#ifndef RENDER_DERIVE_CHANGE_H
#define RENDER_DERIVE_CHANGE_H

#include "render/derive/derive.h"

/* The words of the column `change` of the tables of states. A change that only affects keys affects the rest
 * through them. A state with NONE never changes. */
enum {
    CHANGE_NONE = 0,
#define JOB_PART(name, keys, first, last, meaning) CHANGE_##name = PARTS(name),
#include "def/job_part.def"
#undef JOB_PART
    CHANGE_AREA = PARTS(AREA),
    CHANGE_KEYS = PARTS(KEYS),
    CHANGE_SETTING = PARTS(KEYS),
    CHANGE_ALL = PARTS_ALL
};

#define CHANGE_KEYS_AND(part) (CHANGE_KEYS | CHANGE_##part)

/* Of value `row` of a table, to another one. */
unsigned change_of_value(enum triptych_state_table table, unsigned row);
/* By row of each table: all bits if a key may depend on the value, else none. */
extern const uint32_t change_value_mask[TRIPTYCH_STATE_COUNT],
    change_sampler_mask[TRIPTYCH_SAMPLER_STATE_COUNT], change_stage_mask[TRIPTYCH_STAGE_STATE_COUNT];
unsigned change_of_transform(enum triptych_transform which);

/* From one to the other; a texture may be null. */
unsigned change_of_material(const struct triptych_material *from, const struct triptych_material *to);
unsigned change_of_light(const struct triptych_light *from, const struct triptych_light *to);
enum { CHANGE_OF_LIGHTS = PARTS(LIGHTS) | PARTS(KEYS) }; /* one is enabled or not */
unsigned change_of_texture(const struct triptych_texture *from, const struct triptych_texture *to);

enum {
    CHANGE_OF_VIEWPORT = PARTS(VIEWPORT) | PARTS(DEPTH) | PARTS(SETUP) | PARTS(AREA),
    CHANGE_OF_SCISSOR = PARTS(AREA),
    CHANGE_OF_CLIP_MASK = PARTS(TEXTURES) | PARTS(AREA) | PARTS(KEYS),
    CHANGE_OF_CLIP_PLANE = PARTS(CLIP_PLANES),
    CHANGE_OF_STREAM = PARTS(ATTRIBUTES) | PARTS(VERTICES),
    CHANGE_OF_ELEMENTS = CHANGE_OF_STREAM | PARTS(KEYS),
    CHANGE_OF_SHADER = PARTS(KEYS), /* and of the constants that select code */
    CHANGE_OF_COUNTING = PARTS(KEYS)
};

#endif
