/* How a failure travels: one line of text in a caller's buffer, and a result that says what kind it is.
 *
 * Library functions return `enum triptych_result` (triptych.h) and write the reason with `error_set`. The
 * line says what was found, where, and what was expected; it carries no trailing newline and no program name.
 * Only the command prints it and chooses the exit status.
 *
 * That memory was refused is told by errno, as malloc tells it: whoever has to know it from other reasons sets errno to 0
 * before and finds ENOMEM after. */
#ifndef BASE_ERROR_H
#define BASE_ERROR_H

enum { ERROR_CAPACITY = 512 };

struct error {
    char text[ERROR_CAPACITY];
};

/* Writes the formatted reason (truncated to ERROR_CAPACITY - 1 bytes); a null `error` is allowed and ignored.
 * The first reason wins: a later call keeps the text already there. Returns -1, so that `return
 * error_set(...)` reads well in functions whose success is 0. */
int error_set(struct error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Forgets the reason; of an error that is not initialised there is none then. */
static inline void error_clear(struct error *error)
{
    error->text[0] = '\0';
}

#endif
