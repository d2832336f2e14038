/* Peephole rules: which of them a build applies, and how often each did (def/engine/peephole.def). */
#ifndef ENGINES_SPECIALIZE_PEEPHOLE_PEEPHOLE_H
#define ENGINES_SPECIALIZE_PEEPHOLE_PEEPHOLE_H

#include <stdbool.h>
#include <stdint.h>

enum peephole {
#define PEEPHOLE(name, ...) PEEPHOLE_##name,
#include "def/engine/peephole.def"
#undef PEEPHOLE
    PEEPHOLES
};

/* All zero: every rule applies, and none has applied yet. */
struct peepholes {
    uint64_t without;          /* bit r: rule r is left out */
    uint32_t fired[PEEPHOLES]; /* the number of times that each has applied */
};

/* Returns true, and counts it, unless the rule is left out. It is the last condition of a rule. */
static inline bool peephole_applies(struct peepholes *rules, enum peephole rule)
{
    if (rules->without >> rule & 1)
        return false;
    rules->fired[rule]++;
    return true;
}

/* The name of rule i and one line about it; null past the last. */
const char *peephole_name(unsigned i);
const char *peephole_meaning(unsigned i);

/* Returns true if the pass `reduce` applies the rule, false if it is a part of selection. */
bool peephole_reduces(unsigned i);

#endif
