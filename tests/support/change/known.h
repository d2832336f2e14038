/* The set of all keys that were derived so far. */
#ifndef TESTS_SUPPORT_CHANGE_KNOWN_H
#define TESTS_SUPPORT_CHANGE_KNOWN_H

#include "derived.h"

struct known {
    struct packed_key packed;
    union key key;
    uint64_t recorded, code, plan;
    enum unit unit;
};

extern struct known *known_keys;

extern size_t known_count;

void known_remember(const struct derived *d);

void known_free(void);

#endif
