/* Situations: states in which a draw can happen. A short text describes each, and no device is needed.
 *
 * A description is a row of statements:
 *   state NAME VALUE               VALUE is one of the state's words, or a number
 *   sampler I NAME VALUE
 *   stage I NAME VALUE
 *   texture I TYPE FORMAT SIZE     2d, cube or volume; `texture I none` unbinds
 *   light I TYPE                   directional or point
 *   attribute NAME FORMAT          a row of def/state/attribute.def, of def/state/vertex_type.def or none
 *   blending FORMAT FORMAT         of indices1 and color2, or none: blending by primitive
 *   target I STORAGE CHANNELS      a row of def/state/target.def, bits as in a write mask
 *   depth FORMAT                   a row of def/state/depth_format.def
 *   samples N                      2^N per pixel
 *   projection NAME                perspective, as it is at first, or parallel
 *   draw PRIMITIVE                 triangles, as it is at first, lines or points
 *   vertex NAME, pixel NAME        a shader, a row of tests/support/shader/programs.def; none: the fixed
 *                                  function
 *   booleans STAGE BITS            constants: 0 of vertices, 1 of pixels
 * At first, a situation has every attribute that does not change the purpose of other attributes. Everything
 * that is not a numbered state has distinct values: materials, matrices, clip planes, and a scissor rectangle
 * inside the viewport. */
#ifndef TESTS_SUPPORT_PICTURE_SITUATION_H
#define TESTS_SUPPORT_PICTURE_SITUATION_H

#include "render/derive/derive.h"

struct situation {
    struct state state;
    enum triptych_primitive drawn;
};

/* Sets the situation to this first state. */
void situation_start(struct situation *situation);

/* Executes a description. Returns null, or the reason if it needs a feature that is not supported. Any other
 * error in the description fails the test. */
const char *situation_add(struct situation *situation, const char *description);

#endif
