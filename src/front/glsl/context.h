/* The state of one compilation, which all steps share. */
#ifndef FRONT_GLSL_CONTEXT_H
#define FRONT_GLSL_CONTEXT_H

#include "front/glsl/arena.h"
#include "front/glsl/glsl.h"
#include "front/glsl/log.h"
#include "front/glsl/symbol.h"
#include "front/glsl/token.h"

#include <stdbool.h>

/* The state of an extension, by #extension. */
enum glsl_behavior { GLSL_DISABLED, GLSL_WARNED, GLSL_ENABLED };

enum glsl_extension {
#define GLSL_EXTENSION(id, name) GLSL_##id,
#include "front/glsl/extension.def"
#undef GLSL_EXTENSION
    GLSL_EXTENSIONS
};

struct glsl_preprocessor;

/* A type with qualifiers, as declarations begin with. */
struct glsl_specifier {
    struct glsl_type type;
    uint8_t storage; /* enum glsl_storage; GLSL_LOCAL without a qualifier */
    bool invariant, qualified;
    bool defines_record; /* it is the definition of a structure */
    struct glsl_place place;
};

struct glsl_context {
    struct glsl_arena arena;
    struct glsl_log log;
    enum glsl_stage stage;
    struct glsl_limits limits;
    uint8_t behavior[GLSL_EXTENSIONS]; /* enum glsl_behavior */
    struct glsl_preprocessor *preprocessor;
    struct glsl_scopes scopes;
    struct glsl_unit *unit;
    struct glsl_function *function;   /* whose body is read; null outside */
    unsigned loops;                   /* loops around the statement */
    struct glsl_specifier declared;   /* of the names that follow */
    struct glsl_type field_type;      /* the same, of fields */
    bool defines_record;              /* the type just read is the definition of a structure */
    struct glsl_statement *body;      /* the statement just read */
    struct glsl_statement *condition; /* the condition just read: a declaration */
    struct glsl_expression *tested;   /* or an expression */
    struct glsl_token found;          /* the token just read, for messages */
    bool after_type;                  /* it was a type, so a name is not a type */
    bool after_point;                 /* it was a point, so a name is a field */
    bool version_read;                /* a token or #version was before, so #version is an error */
};

extern const char *const glsl_extensions[]; /* names */

/* Returns true if the extension is enabled; warns at its use if the source has requested it. */
bool glsl_extension_enabled(struct glsl_context *context, enum glsl_extension extension,
                            struct glsl_place place);

#endif
