/* Registers generated code with listeners: GDB, the process's unwinder, perf (def/debug.def). Each has to be
 * enabled.
 *
 * Registrations belong to the process, not to a device: there is one list for GDB and one file for perf,
 * however many devices there are. Errors never fail a draw: code that cannot be registered is omitted, and
 * the caller keeps the first reason. All functions are thread-safe. */
#ifndef DEBUG_DEBUG_H
#define DEBUG_DEBUG_H

#include "base/error.h"
#include "debug/code.h"

enum debug_listener {
#define DEBUG(name, meaning) DEBUG_##name,
#include "def/debug.def"
#undef DEBUG
    DEBUG_LISTENERS
};

/* A listener. Each device calls `open` before it adds code; the result is 0, or -1 with the reason. `add`
 * registers code and returns a record for `remove`, or null if the code need not be removed. */
struct debug_interface {
    int (*open)(struct error *error);
    int (*add)(const struct debug_code *code, void **record, struct error *error);
    void (*remove)(void *record);
};

#define DEBUG(name, meaning) extern const struct debug_interface debug_to_##name;
#include "def/debug.def"
#undef DEBUG

/* Parses a comma-separated list of words to a set of bits 1 << DEBUG_name; a null list is empty. Returns 0,
 * or -1 with the reason. */
int debug_read(const char *words, unsigned *listeners, struct error *error);

/* Opens listeners. Returns 0, or -1 with the first reason if some cannot be opened. */
int debug_open(unsigned listeners, struct error *error);

/* The registrations of one routine. */
struct debug_record;

/* Registers code. Returns null, with the reason if there is one, when nothing has to be removed. */
struct debug_record *debug_add(unsigned listeners, const struct debug_code *code, struct error *error);

/* Removes the registrations of code before it is freed. `record` may be null. */
void debug_remove(struct debug_record *record);

#endif
