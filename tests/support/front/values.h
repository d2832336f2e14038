/* Random arguments of Direct3D 9's methods, valid and invalid, by their types and names in the table of
 * calls. A small number of values is likely, so that arguments of different calls fit each other. */
#ifndef TESTS_SUPPORT_FRONT_VALUES_H
#define TESTS_SUPPORT_FRONT_VALUES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Returns a number below `limit`, which is not 0. Advances the seed, which is not 0 (xorshift64*). */
uint32_t values_below(uint64_t *seed, uint32_t limit);
/* Returns true once in `chances` times. */
bool values_once_in(uint64_t *seed, uint32_t chances);

/* Before the arguments of a call: in most calls they are plain ones. */
void values_begin(uint64_t *seed);

/* The bits of a number, to be cut off to the size of its type. */
uint32_t values_number(uint64_t *seed, const char *type, const char *name);

/* Fills `count` elements of this type. Numbers of bytes are at most 65536. */
void values_fill(uint64_t *seed, const char *type, void *memory, size_t bytes);

/* Memory whose size follows from its contents; the caller frees it: tokens of a shader, the elements of a
 * vertex declaration, and a region. */
void *values_code(uint64_t *seed, bool pixel);
void *values_elements(uint64_t *seed);
void *values_region(uint64_t *seed);

#endif
