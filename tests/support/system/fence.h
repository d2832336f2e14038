/* Memory that ends where an unreadable page begins: generated code that reads past the end crashes there. */
#ifndef TESTS_SUPPORT_SYSTEM_FENCE_H
#define TESTS_SUPPORT_SYSTEM_FENCE_H

#include <stddef.h>
#include <stdint.h>

/* `bytes` of zeros, the last of them before the fence; null when the system refuses. */
uint8_t *fence(size_t bytes);

/* Gives them back; null is allowed. */
void unfence(uint8_t *memory, size_t bytes);

#endif
