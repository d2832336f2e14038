/* How a failure is reported: one line of text in the caller's buffer, and a result that is the kind of
 * failure it is.
 *
 * Library functions return `enum triptych_result` (triptych.h) and write the reason with error_set. The line
 * names what was found, where, and what was expected. It has no trailing newline and no program name. Only
 * the command prints it and chooses the exit status.
 *
 * When memory is refused, errno is ENOMEM, as after malloc. A caller that must distinguish this reason from
 * others sets errno to 0 before the call. */
#ifndef BASE_ERROR_H
#define BASE_ERROR_H

enum { ERROR_CAPACITY = 512 };

struct error {
    char text[ERROR_CAPACITY];
};

/* Writes the formatted reason, truncated to ERROR_CAPACITY - 1 bytes. `error` may be null. The first reason
 * is kept: later calls do not change it. Always returns -1, for functions that return 0 on success: `return
 * error_set(...)`. */
int error_set(struct error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Removes the reason. Also initialises an error. */
static inline void error_clear(struct error *error)
{
    error->text[0] = '\0';
}

#endif
