/* Sets of the parts that a change of the state may affect (render/derive/derive.h).
 *
 * For the value of a state the set is a column of its table (def/state/state.def).
 * tests/render/derive/change.c compares what each setter derives with a derivation from scratch. */
#ifndef RENDER_DERIVE_CHANGE_H
#define RENDER_DERIVE_CHANGE_H

#include "render/derive/derive.h"

/* Of value `row` of a table, to another one. */
unsigned change_of_value(enum triptych_state_table table, unsigned row);
unsigned change_of_transform(enum triptych_transform which);

/* From one to the other; a texture may be null. */
unsigned change_of_material(const struct triptych_material *from, const struct triptych_material *to);
unsigned change_of_light(const struct triptych_light *from, const struct triptych_light *to);
unsigned change_of_texture(const struct triptych_texture *from, const struct triptych_texture *to);

enum {
    CHANGE_OF_VIEWPORT = PARTS(VIEWPORT) | PARTS(DEPTH) | PARTS(SETUP) | PARTS(SETTING),
    CHANGE_OF_SCISSOR = PARTS(SETTING),
    CHANGE_OF_CLIP_PLANE = PARTS(CLIP_PLANES),
    CHANGE_OF_STREAM = PARTS(ATTRIBUTES) | PARTS(VERTICES)
};

#endif
