/* A growing text, for the writers of random cases. A refused allocation sets `failed`, which is checked once
 * at the end; later additions are lost. Zero is an empty text. */
#ifndef COMMAND_FUZZ_CASE_TEXT_H
#define COMMAND_FUZZ_CASE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

struct text {
    char *data; /* a zero byte follows; null while nothing has been added */
    size_t length, capacity;
    bool failed;
};

void text_add(struct text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_add_bytes(struct text *text, const char *bytes, size_t count);

/* Shortens the text to what it was when it had that length; keeps the memory. */
void text_cut(struct text *text, size_t length);

void text_free(struct text *text);

#endif
