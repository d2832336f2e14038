/* Which keys stage fragments cover (def/cover.def): the choice of a routine's granularity. */
#ifndef STITCH_COVER_H
#define STITCH_COVER_H

#include "draw/key.h"

/* Null when stage fragments cover the key, else what they lack: the reason of the first row that says so. */
const char *stages_lack(enum unit unit, const union key *key);

static inline int stages_cover(enum unit unit, const union key *key)
{
    return !stages_lack(unit, key);
}

/* Makes a key covered: every value that is not becomes 0. */
void stages_reduce(enum unit unit, union key *key);

#endif
