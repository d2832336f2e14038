/* Generated shaders, for the tests of src/shader. */
#ifndef TESTS_SUPPORT_SHADER_SHADERS_H
#define TESTS_SUPPORT_SHADER_SHADERS_H

#include "shader/shader.h"

/* A model with nothing in it. */
struct shader *shader_blank(const struct shader_model *model);

/* Adds an instruction of the row with random operands that the model's readers take: right kinds of
 * registers, any numbers, masks, swizzles and modifiers; `random` is the generator's state, not zero. The row
 * must be in the model's column. */
void shader_add_random(struct shader *shader, enum shader_opcode opcode, uint64_t *random);

/* Changes an operand, copies an instruction over another, or cuts the end off: most rules are one step away.
 */
void shader_damage(struct shader *shader, uint64_t *random);

/* A number below `below` (xorshift64*). */
uint32_t shader_random(uint64_t *random, uint32_t below);

#endif
