/* The optimiser: the passes in order, to a fixpoint (thesis, section 3.4).
 *
 * A pass runs again only if another, or it itself, has changed something since that it may have been waiting for; that
 * is what most of a fixpoint's last rounds would find out by looking at everything. Behind each round what is gone is
 * closed up, so that later ones see less. */
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

#define BIT(name) (1u << PASS_##name)

/* Whom a pass's changes may give work: all of them simplify from front to back, what becomes of an operand is seen in
 * the same walk, and what nobody needs has no part in anything. */
static const uint32_t gives_work[PASS_COUNT] = {
    [PASS_phi] = BIT(copy) | BIT(fold) | BIT(reduce) | BIT(common) | BIT(dead),
    [PASS_copy] = BIT(phi) | BIT(fold) | BIT(reduce) | BIT(common) | BIT(dead),
    [PASS_fold] = BIT(phi) | BIT(copy) | BIT(fold) | BIT(reduce) | BIT(common) | BIT(dead),
    [PASS_reduce] = BIT(phi) | BIT(copy) | BIT(fold) | BIT(reduce) | BIT(common) | BIT(dead),
    [PASS_common] = BIT(phi) | BIT(copy) | BIT(fold) | BIT(reduce) | BIT(dead),
    [PASS_dead] = 0,
};

unsigned optimize(struct ir *ir, struct pass_memory *memory, enum profile profile, uint32_t disabled,
                  pass_observer *observer, void *context)
{
    unsigned rounds = 0;
    uint32_t repeated = 0;
    for (unsigned p = 0; p < PASS_COUNT; p++)
        repeated |= (uint32_t)(passes[p].group != ONCE && enabled(p, profile, disabled)) << p;
    for (uint32_t waiting = repeated; waiting; rounds++) {
        for (unsigned p = 0; p < PASS_COUNT; p++) {
            if (!(waiting >> p & 1))
                continue;
            waiting &= ~(1u << p);
            if (!passes[p].run(ir, memory))
                continue;
            waiting |= gives_work[p] & repeated;
            if (observer)
                observer(context, p, ir);
        }
    }
    for (unsigned p = 0; p < PASS_COUNT; p++)
        if (passes[p].group == ONCE && enabled(p, profile, disabled) && passes[p].run(ir, memory) && observer)
            observer(context, p, ir);
    ir_compact(ir, memory->map);
    return rounds;
}
