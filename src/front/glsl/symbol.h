/* Names and their scopes (section 4.2). Functions, variables and structures share one space of names. */
#ifndef FRONT_GLSL_SYMBOL_H
#define FRONT_GLSL_SYMBOL_H

#include "front/glsl/node.h"

enum { GLSL_SYMBOL_SLOTS = 256, GLSL_SCOPES = 256 };

enum glsl_symbol_kind { GLSL_VARIABLE_SYMBOL, GLSL_FUNCTION_SYMBOL, GLSL_RECORD_SYMBOL };

struct glsl_symbol {
    uint8_t kind;   /* enum glsl_symbol_kind */
    uint16_t depth; /* 0: of the language; 1: global */
    const char *name;
    struct glsl_symbol *hidden; /* the next one in its slot; an inner one of the same name comes before */
    struct glsl_symbol *older;  /* the one before in its scope */
    struct glsl_variable *variable;
    struct glsl_function *function; /* the first of its overloads in this scope */
    const struct glsl_record *record;
};

struct glsl_scope {
    struct glsl_symbol *newest;
    uint8_t precision[GLSL_SAMPLER_CUBE + 1]; /* the default of each base type */
};

struct glsl_scopes {
    struct glsl_symbol *slot[GLSL_SYMBOL_SLOTS];
    struct glsl_scope scope[GLSL_SCOPES];
    unsigned depth; /* of the innermost */
};

struct glsl_context;

/* Opens the scope of the language and that of global names. */
void glsl_scopes_begin(struct glsl_context *context);
void glsl_scope_open(struct glsl_context *context, struct glsl_place place);
void glsl_scope_close(struct glsl_context *context);

/* The innermost symbol of that name; null if there is none. */
struct glsl_symbol *glsl_symbol_find(struct glsl_context *context, const char *name);

/* Adds a symbol to the innermost scope. Reports a name that is already there, or reserved, and returns
 * null. */
struct glsl_symbol *glsl_symbol_add(struct glsl_context *context, enum glsl_symbol_kind kind,
                                    const char *name, struct glsl_place place);

/* Adds one to the scope of the language. */
struct glsl_symbol *glsl_symbol_predefine(struct glsl_context *context, enum glsl_symbol_kind kind,
                                          const char *name);

#endif
