/* The reasons why different keys may have the same code. */
#ifndef TESTS_SUPPORT_CHANGE_ALIKE_H
#define TESTS_SUPPORT_CHANGE_ALIKE_H

#include "contract/key_query.h"

/* Returns true if a reason applies, and marks the reason as needed. */
bool alike_keys(enum unit unit, const union key *a, const union key *b);

/* Returns the first reason that no two keys needed, or null. */
const char *alike_unneeded(void);

#endif
