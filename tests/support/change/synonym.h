/* Words of a state that have the same meaning. */
#ifndef TESTS_SUPPORT_CHANGE_SYNONYM_H
#define TESTS_SUPPORT_CHANGE_SYNONYM_H

#include <stdbool.h>

/* Returns true if two words of the state are a row of the table, and marks the row as needed. */
bool synonym_are(const char *state, const char *a, const char *b);

/* Returns the reason of the first row that no two words needed, or null. */
const char *synonym_unneeded(void);

#endif
