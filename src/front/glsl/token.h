/* Preprocessing tokens: the source as Flex divides it, before directives and macros (section 3.2). */
#ifndef FRONT_GLSL_TOKEN_H
#define FRONT_GLSL_TOKEN_H

#include "front/glsl/log.h"

#include <stdbool.h>
#include <stdint.h>

struct glsl_context;

enum { GLSL_NAME_BYTES = 1024 };

enum glsl_token_kind {
    GLSL_END, /* of the source */
    GLSL_LINE_END,
    GLSL_NAME,
    GLSL_NUMBER, /* a preprocessing number, valid or not */
    GLSL_PUNCTUATOR,
    GLSL_STRAY /* a character or comment that no token has */
};

struct glsl_token {
    uint8_t kind;
    bool spaced;  /* white space is before it */
    bool painted; /* a macro name that is not expanded again, inside of its own expansion */
    uint16_t length;
    const char *text; /* in the source or the arena; not ended by a zero */
    struct glsl_place place;
};

/* The tokens of all strings, and after them one of kind GLSL_END. */
struct glsl_token *glsl_tokens(struct glsl_context *context, const char *const *strings, const int *lengths,
                               unsigned count);

static inline bool glsl_token_is(const struct glsl_token *token, const char *text)
{
    unsigned i = 0;
    while (i < token->length && text[i] == token->text[i])
        i++;
    return i == token->length && !text[i];
}

#endif
