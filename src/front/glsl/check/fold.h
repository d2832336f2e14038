/* Values of constant expressions (5.10), computed while nodes are made. */
#ifndef FRONT_GLSL_FOLD_H
#define FRONT_GLSL_FOLD_H

#include "front/glsl/check/check.h"

/* Sets x->value if all operands and arguments have values and the operation is that of a constant
 * expression. The node keeps its operation. Sets x->impure if a part is impure. Returns x. */
struct glsl_expression *glsl_fold(struct glsl_context *context, struct glsl_expression *x);

/* fold_call.c: the value of a function of the language with constant arguments; returns false if it has
 * none. */
bool glsl_fold_call(const struct glsl_expression *call, union glsl_scalar *value);

#endif
