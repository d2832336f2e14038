/* Memory that ends at an unreadable page, so that generated code that reads past the end crashes. */
#ifndef TESTS_SUPPORT_SYSTEM_FENCE_H
#define TESTS_SUPPORT_SYSTEM_FENCE_H

#include <stddef.h>
#include <stdint.h>

/* Allocates `bytes` zeros whose last byte is next to the unreadable page. Returns null if the system
 * refuses. */
uint8_t *fence(size_t bytes);

/* Frees memory of fence() with the same `bytes`; `memory` may be null. */
void unfence(uint8_t *memory, size_t bytes);

#endif
