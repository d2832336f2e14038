/* Lab 12: states of a small pixel pipeline, the keys of its routines, and a cache of routines. */
#ifndef STATE_H
#define STATE_H

#include <stddef.h>
#include <stdint.h>

/* --- The state: what an application can set ---
 *
 * FIELD(name, values): the field has a value from 0 to values - 1. */
#define STATE_FIELDS                                                                                         \
    FIELD(texture, 2)                                                                                        \
    FIELD(filter, 6)                                                                                         \
    FIELD(address, 6)                                                                                        \
    FIELD(stage, 6)                                                                                          \
    FIELD(alpha_test, 6)                                                                                     \
    FIELD(alpha_reference, 256)                                                                              \
    FIELD(blend, 2)                                                                                          \
    FIELD(source_factor, 4)                                                                                  \
    FIELD(destination_factor, 4)                                                                             \
    FIELD(fog, 2)                                                                                            \
    FIELD(fog_density, 256)

struct state {
#define FIELD(name, values) unsigned name;
    STATE_FIELDS
#undef FIELD
};

/* A pixel before the pipeline. All numbers are 0 to 255. */
struct pixel {
    unsigned diffuse, u, depth, target;
};

/* given/shade.c: the pipeline. Returns the new value of the target. Read it: its decisions decide what
 * belongs in a key. */
unsigned shade(const struct state *state, const struct pixel *pixel);

/* --- key.c ---
 *
 * A generated routine decides everything of `shade` that depends on values of few possibilities, and reads
 * the others, alpha_reference and fog_density, when it runs. Its key distinguishes routines. */

enum { KEY_BYTES = 2 };

struct key {
    uint8_t bytes[KEY_BYTES];
};

/* The key of the routine for a state. Two states have equal keys if, and only if, one routine can draw
 * both. */
struct key key_of(const struct state *state);

/* --- cache.c ---
 *
 * Plays a list of draws with a cache that has room for `room` routines, 1 to 64. Returns the number of
 * misses: draws whose routine is not in the cache, so that it must be generated. A miss replaces a routine if
 * the cache is full: */
size_t misses_fifo(const struct key *draws, size_t count, size_t room); /* the one that was generated first */
size_t misses_lru(const struct key *draws, size_t count,
                  size_t room); /* the one whose last use is longest ago */

#endif
