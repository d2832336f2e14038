/* Keys of routines of all kinds for tests that need many: random keys; random keys with each shader of
 * tests/data/shaders and with random shaders; and the keys of every draw in the first frame of every
 * stream. Builds with sanitizers visit every fourth file. */
#ifndef TESTS_SUPPORT_ROUTINE_ROUTINES_H
#define TESTS_SUPPORT_ROUTINE_ROUTINES_H

#include "contract/key.h"

#include <stddef.h>

/* The key, and the program that it may name, exist until the visitor returns. A visit has no key twice. */
typedef void routine_visitor(void *context, enum unit unit, const union key *key);

/* Visits the units in turn. Returns the number of keys. */
size_t visit_random_keys(unsigned count, uint64_t seed, routine_visitor *visit, void *context);
size_t visit_shaders(uint64_t seed, routine_visitor *visit, void *context);
size_t visit_random_shaders(unsigned count, uint64_t seed, routine_visitor *visit, void *context);
size_t visit_streams(routine_visitor *visit, void *context);

/* For visitors that take long: builds with sanitizers visit every ninth file from now on. */
void visit_fewer(void);

#endif
