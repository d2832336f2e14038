/* For the rules of token.l: the growing list of tokens and the place in the strings. */
#ifndef FRONT_GLSL_SCAN_H
#define FRONT_GLSL_SCAN_H

#include "front/glsl/token.h"

#include <stddef.h>

struct glsl_scan {
    struct glsl_context *context;
    const char *text;        /* all strings, one after the other */
    const size_t *end;       /* the offset where each string ends */
    unsigned count;          /* strings */
    size_t line_start;       /* offset */
    struct glsl_place place; /* of the match */
    struct glsl_place comment;
    bool spaced;
    struct glsl_token *token;
    size_t tokens, capacity;
};

/* Computes the place of a match; `offset` is where it begins. */
void glsl_scan_match(struct glsl_scan *scan, size_t offset);

/* Adds the match as a token. */
void glsl_scan_add(struct glsl_scan *scan, enum glsl_token_kind kind, const char *text, size_t length);

/* A line ends before `offset`. */
void glsl_scan_line(struct glsl_scan *scan, size_t offset);

/* token.l: runs the scanner over text of `bytes`, after which two more bytes are 0. */
void glsl_scan_run(struct glsl_scan *scan, char *text, size_t bytes);

#endif
