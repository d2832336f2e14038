/* Situations: states in which a draw can happen, described in a few words, without a device.
 *
 * A description is a row of statements:
 *   state NAME VALUE               VALUE is one of the state's words, or a number
 *   sampler I NAME VALUE
 *   stage I NAME VALUE
 *   texture I TYPE FORMAT SIZE     2d, cube or volume; `texture I none` unbinds
 *   light I TYPE                   directional or point
 *   attribute NAME FORMAT          a row of def/attribute.def, of def/vertex_type.def or none
 *   target I STORAGE CHANNELS      a row of def/target.def, bits as in a write mask
 *   depth FORMAT                   a row of def/depth_format.def
 *   samples N                      2^N per pixel
 *   projection NAME                perspective, as it is at first, or parallel
 *   draw PRIMITIVE                 triangles, as it is at first, lines or points
 *   vertex NAME, pixel NAME        a shader, a row of tests/support/programs.def; none: the fixed function
 *   booleans STAGE BITS            constants: 0 of vertices, 1 of pixels
 * At first every attribute is given that does not change what the others are for, and all else that is no
 * state by number has values that show where they go: materials, matrices, clip planes, a scissor rectangle
 * inside the viewport. */
#ifndef TESTS_SITUATION_H
#define TESTS_SITUATION_H

#include "draw/derive.h"

struct situation {
    struct state state;
    enum triptych_primitive drawn;
};

/* Starts with nothing but what is said above. */
void situation_start(struct situation *situation);

/* Follows a description. Returns null; or, when it asks for what is not supported yet, why. Anything else
 * that is wrong in it ends the test. */
const char *situation_add(struct situation *situation, const char *description);

#endif
