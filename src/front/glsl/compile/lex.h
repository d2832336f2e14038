/* Between the preprocessor and the grammar: tokens become keywords, names, numbers and operators. */
#ifndef FRONT_GLSL_LEX_H
#define FRONT_GLSL_LEX_H

#include "front/glsl/context.h"

union GLSL_GRAMMAR_STYPE;

/* The next token of grammar.y, with its value and place. */
int glsl_grammar_lex(union GLSL_GRAMMAR_STYPE *value, struct glsl_place *place, struct glsl_context *context);

/* The token just read, for messages: 'x', or the end of the source. */
const char *glsl_lex_found(struct glsl_context *context);

/* The structure that a TYPE_NAME names. */
struct glsl_type glsl_lex_record(const char *name, struct glsl_context *context);

#endif
