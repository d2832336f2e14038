/* Reading one character of an expression: a literal, an escape, a dot, a class in brackets. */
#ifndef CLIENTS_MATCHER_CLASS_H
#define CLIENTS_MATCHER_CLASS_H

#include "bench/clients/matcher/automaton.h"

struct class_reader {
    const char *at, *start;
    int depth;        /* of parentheses */
    int alternatives; /* outside of parentheses */
    bool failed;
    struct error *error;
};

/* Notes the first error, with its place in the expression. */
void class_fail(struct class_reader *reader, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Reads a character and advances. The set never contains the newline. */
void class_read(struct class_reader *reader, struct byte_set *set);

/* Returns true if the set contains every byte except the newline. */
bool class_is_all(const struct byte_set *set);

#endif
