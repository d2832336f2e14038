/* Keys of routines, many and of all kinds, for tests that want to see them all: random ones; random ones around each shader
 * of tests/shaders and around random shaders; and those of every draw in the first frame of every stream. */
#ifndef TESTS_ROUTINES_H
#define TESTS_ROUTINES_H

#include "draw/key.h"

#include <stddef.h>

/* The key, and the program that it may name, are there until the visitor returns. No key comes twice in a visit. */
typedef void routine_visitor(void *context, enum unit unit, const union key *key);

/* The units in turn. Return how many there were. */
size_t visit_random_keys(unsigned count, uint64_t seed, routine_visitor *visit, void *context);
size_t visit_shaders(uint64_t seed, routine_visitor *visit, void *context);
size_t visit_random_shaders(unsigned count, uint64_t seed, routine_visitor *visit, void *context);
size_t visit_streams(routine_visitor *visit, void *context);

#endif
