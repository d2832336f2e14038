/* Which keys stage fragments cover (def/engine/cover.def): the choice of a routine's granularity. */
#ifndef ENGINES_STITCH_COVER_H
#define ENGINES_STITCH_COVER_H

#include "contract/key.h"

/* Returns null when stage fragments cover the key, else the reason of the first row that does not cover
 * it. */
const char *stages_lack(enum unit unit, const union key *key);

static inline bool stages_cover(enum unit unit, const union key *key)
{
    return !stages_lack(unit, key);
}

/* Makes a key covered: replaces every value that is not covered by 0. For tests: keys that the fragments of
 * stages cover. */
void stages_reduce(enum unit unit, union key *key);

#endif
