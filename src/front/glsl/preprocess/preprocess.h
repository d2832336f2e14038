/* The preprocessor: tokens after directives and macros (section 3.4).
 *
 * A reader is a stack of lists of tokens. The lowest list of the preprocessor's own reader is the source;
 * each expansion of a macro is a list above it. While a macro's list is on the stack, its name is not
 * expanded again. */
#ifndef FRONT_GLSL_PREPROCESS_H
#define FRONT_GLSL_PREPROCESS_H

#include "front/glsl/token.h"

#include <stddef.h>

/* Bounds that stop a source whose macros grow without end. */
enum { GLSL_EXPANSIONS = 1 << 20, GLSL_EXPANSION_DEPTH = 128, GLSL_CONDITIONS = 64 };

struct glsl_list {
    struct glsl_token *token;
    size_t count, capacity;
};

struct glsl_macro {
    const char *name;
    struct glsl_macro *next; /* in its slot of the table */
    bool defined;
    bool function;   /* name( was its definition */
    bool predefined; /* neither #define nor #undef may name it */
    bool active;     /* its expansion is being read */
    unsigned parameters;
    struct glsl_token *parameter;
    struct glsl_list body;
};

struct glsl_frame {
    struct glsl_frame *below;
    const struct glsl_token *at, *end;
    struct glsl_macro *macro; /* whose expansion it is; null for the source and for arguments */
    bool source;              /* its places are changed by #line */
};

struct glsl_reader {
    struct glsl_frame *top;
    bool condition; /* of #if: the name after `defined` is not expanded */
    bool defined;   /* `defined` was just read, perhaps with a parenthesis */
};

enum { GLSL_MACRO_SLOTS = 256 };

/* One #if to #endif. */
struct glsl_condition {
    struct glsl_place place;
    bool reading; /* its current part is read */
    bool taken;   /* a part has been read, so no later one is */
    bool last;    /* #else was there */
    bool outer;   /* what is around it is read */
};

struct glsl_preprocessor {
    struct glsl_reader reader;
    struct glsl_macro *slot[GLSL_MACRO_SLOTS];
    unsigned expansions, depth;
    struct glsl_condition condition[GLSL_CONDITIONS];
    unsigned conditions;
    bool line_begins;   /* only white space was before in the line */
    bool tokens_passed; /* #version and #extension come before all other tokens */
    long line_shift;    /* by #line: added to lines of the source */
    int string;         /* by #line: the number of the string; -1: that of the source */
};

/* Prepares to read the tokens. */
void glsl_preprocess_begin(struct glsl_context *context, const struct glsl_token *tokens);

/* The next token; of kind GLSL_END at the end, again and again. Never a line end. */
struct glsl_token glsl_preprocess_next(struct glsl_context *context);

/* Changes the place of a token of the source as #line requires. */
void glsl_preprocess_place(const struct glsl_preprocessor *p, struct glsl_token *token);

/* --- macro.c --- */

struct glsl_macro *glsl_macro_find(struct glsl_preprocessor *p, const struct glsl_token *name);

/* #define and #undef: the tokens of the line after the word. */
void glsl_macro_define(struct glsl_context *context, const struct glsl_token *line, size_t count);
void glsl_macro_undefine(struct glsl_context *context, const struct glsl_token *line, size_t count);

/* Defines a macro that is a number. */
void glsl_macro_predefine(struct glsl_context *context, const char *name, const char *number);

/* The next token of a reader, its macros expanded; false at its end. Line ends are passed on. */
bool glsl_expand_next(struct glsl_context *context, struct glsl_reader *reader, struct glsl_token *token);

/* All tokens of a list, expanded; of a condition, without the names after `defined`. */
struct glsl_list glsl_expand_all(struct glsl_context *context, const struct glsl_token *token, size_t count,
                                 bool condition);

void glsl_list_add(struct glsl_context *context, struct glsl_list *list, const struct glsl_token *token);

/* --- condition.c --- */

/* The value of the expression after #if and #elif; `place` is that of the directive. 0 after an error. */
long glsl_condition_value(struct glsl_context *context, struct glsl_place place,
                          const struct glsl_token *line, size_t count);

#endif
