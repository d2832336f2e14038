#include "engines/specialize/peephole/peephole.h"

#include <assert.h>
#include <stddef.h>

static_assert((int)PEEPHOLES <= 64, "a set of rules is one word of 64 bits");

enum where { REDUCE, SELECT };

static const struct {
    const char *name, *meaning;
    enum where where;
} rules[PEEPHOLES] = {
#define PEEPHOLE(name, where, meaning) {#name, meaning, where},
#include "def/engine/peephole.def"
#undef PEEPHOLE
};

const char *peephole_name(unsigned i)
{
    return i < PEEPHOLES ? rules[i].name : NULL;
}

const char *peephole_meaning(unsigned i)
{
    return i < PEEPHOLES ? rules[i].meaning : NULL;
}

bool peephole_reduces(unsigned i)
{
    return rules[i].where == REDUCE;
}
