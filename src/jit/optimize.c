/* The optimiser: the passes in order, to a fixpoint (thesis, section 3.4). */
#include "jit/jit.h"
#include "jit/pass.h"

enum { THESIS, FULL, ONCE };

static const struct {
    const char *name;
    pass_function *run;
    int group;
    const char *meaning;
} passes[PASS_COUNT] = {
#define PASS(name, profile, meaning) {#name, pass_##name, profile, meaning},
#include "def/pass.def"
#undef PASS
};

const char *jit_pass_name(unsigned i)
{
    return i < PASS_COUNT ? passes[i].name : NULL;
}

const char *jit_pass_description(unsigned i)
{
    return i < PASS_COUNT ? passes[i].meaning : NULL;
}

static int enabled(unsigned pass, enum profile profile, uint32_t disabled)
{
    return !(disabled >> pass & 1) && (passes[pass].group == THESIS || profile == PROFILE_FULL);
}

unsigned optimize(struct ir *ir, struct pass_memory *memory, enum profile profile, uint32_t disabled,
                  pass_observer *observer, void *context)
{
    unsigned rounds = 0, changed;
    do {
        changed = 0;
        for (unsigned p = 0; p < PASS_COUNT; p++) {
            if (passes[p].group == ONCE || !enabled(p, profile, disabled))
                continue;
            unsigned changes = passes[p].run(ir, memory);
            changed += changes;
            if (changes && observer)
                observer(context, p, ir);
        }
        rounds++;
    } while (changed);
    for (unsigned p = 0; p < PASS_COUNT; p++)
        if (passes[p].group == ONCE && enabled(p, profile, disabled) && passes[p].run(ir, memory) && observer)
            observer(context, p, ir);
    ir_compact(ir, memory->map);
    return rounds;
}
