/* Telling others of generated code: GDB, the process's unwinder, perf (def/debug.def). All is opt-in.
 *
 * What is told is the process's, not a device's: one list for GDB, one file for perf, whatever the number of devices.
 * Nothing here fails a draw: what cannot be told is left out, and the first reason is kept by who asked. All functions
 * are thread-safe. */
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

/* One of them. `open` is called before anything is added, by each device: 0, or -1 with the reason. `add` tells of
 * code, and gives what `remove` wants when it is gone (null: nothing to do then). */
struct debug_interface {
    int (*open)(struct error *error);
    int (*add)(const struct debug_code *code, void **record, struct error *error);
    void (*remove)(void *record);
};

#define DEBUG(name, meaning) extern const struct debug_interface debug_to_##name;
#include "def/debug.def"
#undef DEBUG

/* Reads a list of words, comma-separated, into a set of bits 1 << DEBUG_name; null is none. Returns 0, or -1 with the
 * reason. */
int debug_read(const char *words, unsigned *listeners, struct error *error);

/* Makes ready those that can be; -1 with the first reason if some cannot. */
int debug_open(unsigned listeners, struct error *error);

/* What was told of one routine. */
struct debug_record;

/* Tells of code. Null, perhaps with a reason, when nobody has to know when it is gone. */
struct debug_record *debug_add(unsigned listeners, const struct debug_code *code, struct error *error);

/* The code is about to be gone; null is allowed. */
void debug_remove(struct debug_record *record);

#endif
