/* Generated shaders, for the tests of src/shader. */
#ifndef TESTS_SUPPORT_SHADER_SHADERS_H
#define TESTS_SUPPORT_SHADER_SHADERS_H

#include "shader/shader.h"

/* Returns a shader of the model without instructions. */
struct shader *shader_blank(const struct shader_model *model);

/* Adds an instruction with random operands that the model's readers accept. Registers have the right kinds;
 * numbers, masks, swizzles and modifiers are arbitrary. `random` is the generator's state, not zero. The
 * model must have the instruction. */
void shader_add_random(struct shader *shader, enum shader_opcode opcode, uint64_t *random);

/* Changes an operand, copies an instruction over another, or removes the last instructions. One such change
 * is enough to break most rules of a model. */
void shader_damage(struct shader *shader, uint64_t *random);

/* Returns a random number less than `below` (xorshift64*). */
uint32_t shader_random(uint64_t *random, uint32_t below);

#endif
