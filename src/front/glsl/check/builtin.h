/* The functions and variables of the language (builtin.def). */
#ifndef FRONT_GLSL_BUILTIN_H
#define FRONT_GLSL_BUILTIN_H

#include "front/glsl/check/check.h"

enum glsl_meaning {
#define GLSL_FUNCTION(id, kind, evaluate) GLSL_CALL_##id,
#include "front/glsl/check/function.def"
#undef GLSL_FUNCTION
};

enum glsl_builtin_variable {
#define GLSL_BUILTIN_VARIABLE(id, name, base, rows, array, storage, stages, extension) GLSL_##id,
#include "front/glsl/check/builtin.def"
#undef GLSL_BUILTIN_VARIABLE
    GLSL_BUILTIN_VARIABLES
};

/* Adds the variables and constants of the stage to the scope of the language. */
void glsl_builtin_begin(struct glsl_context *context);

/* Returns true if a function of the language has that name in this stage. */
bool glsl_builtin_has(const struct glsl_context *context, const char *name);

/* Finds the function with these types of arguments: its meaning and the type of its result. Returns false
 * if there is none. Reports a function whose extension is not enabled. */
bool glsl_builtin_find(struct glsl_context *context, struct glsl_place place, const char *name,
                       const struct glsl_expressions *arguments, enum glsl_meaning *meaning,
                       struct glsl_type *result);

/* The same for the types of parameters, without reports. */
bool glsl_builtin_has_parameters(const struct glsl_context *context, const char *name,
                                 const struct glsl_variable *parameters);

/* Reports the use of a constant of the language whose extension is not enabled. */
void glsl_builtin_use_constant(struct glsl_context *context, const struct glsl_expression *x);

/* Notes the use of a variable of the language. Reports one whose extension is not enabled. Without
 * GL_EXT_draw_buffers and GL_NV_draw_buffers, gl_FragData has one element. */
void glsl_builtin_use(struct glsl_context *context, struct glsl_expression *x);

#endif
