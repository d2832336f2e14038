/* What a change of the state may change of what is derived from it (draw/derive.h): sets of parts.
 *
 * Everything, unless it is known to be less: values that no key depends on name their parts here, and a change that
 * leaves the keys alone costs these parts and no more. tests/draw/change.c holds every setter against a derivation
 * from scratch. */
#ifndef DRAW_CHANGE_H
#define DRAW_CHANGE_H

#include "draw/derive.h"

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
