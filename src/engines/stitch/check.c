/* The contract check: the registers with a valid value before each part.
 *
 * A part needs valid inputs. After it, the registers that it destroys are invalid and its outputs are
 * valid. Where paths join, a register is valid if it is valid on every path. The check begins with all
 * registers valid and removes registers until nothing changes. This reaches the greatest solution, also
 * for loops. */
#include "engines/stitch/plan.h"

#include <stdlib.h>

enum { VALID_AT_CALL = 1 << REGISTER_FRAME | 1 << REGISTER_FRAME_END | 1 << REGISTER_CALL };

static uint32_t after(const struct part *part, uint32_t valid)
{
    return (valid & ~part_changes(part)) | part_gives(part);
}

/* Removes registers at `to` that are not valid on the way there. Returns true if that changed anything. */
static bool meet(uint32_t *valid, unsigned to, uint32_t arriving)
{
    uint32_t met = valid[to] & arriving;
    bool changed = met != valid[to];
    valid[to] = met;
    return changed;
}

static bool pass(const struct plan *plan, uint32_t *valid)
{
    bool changed = false;
    for (unsigned i = 0; i < plan->count; i++) {
        const struct part *part = plan->part + i;
        uint32_t leaving = after(part, valid[i]);
        if (i + 1 < plan->count)
            changed |= meet(valid, i + 1, leaving);
        for (unsigned h = 0; h < part->fragment->holes; h++) {
            const struct hole *hole = part->fragment->hole + h;
            if (hole->kind == HOLE_JUMP)
                changed |= meet(valid, (unsigned)part->arguments.value[hole->argument], leaving);
        }
    }
    return changed;
}

const char *stitch_register_name(unsigned bit)
{
    static const char name[][6] = {"rax",  "rcx",  "rdx",   "rbx",   "rsp",   "rbp",   "rsi",   "rdi",
                                   "r8",   "r9",   "r10",   "r11",   "r12",   "r13",   "r14",   "r15",
                                   "ymm0", "ymm1", "ymm2",  "ymm3",  "ymm4",  "ymm5",  "ymm6",  "ymm7",
                                   "ymm8", "ymm9", "ymm10", "ymm11", "ymm12", "ymm13", "ymm14", "ymm15"};
    return name[bit];
}

static int check_jumps(const struct plan *plan, unsigned i, struct error *error)
{
    const struct part *part = plan->part + i;
    for (unsigned h = 0; h < part->fragment->holes; h++) {
        const struct hole *hole = part->fragment->hole + h;
        if (hole->kind != HOLE_JUMP)
            continue;
        unsigned to = (unsigned)part->arguments.value[hole->argument];
        if (to >= plan->count)
            return error_set(error, "part %u, %s: jumps to part %u of %u", i, part->fragment->name, to,
                             plan->count);
    }
    return 0;
}

static int check_inputs(const struct plan *plan, uint32_t *valid, struct error *error)
{
    for (unsigned i = 0; i < plan->count; i++) {
        valid[i] = i ? ~0u : (uint32_t)VALID_AT_CALL;
        if (check_jumps(plan, i, error))
            return -1;
    }
    while (pass(plan, valid))
        ;
    for (unsigned i = 0; i < plan->count; i++) {
        const struct fragment *fragment = plan->part[i].fragment;
        uint32_t missing = part_reads(&plan->part[i]) & ~valid[i];
        if (missing)
            return error_set(error, "part %u, %s: reads %s, which no earlier part gives", i, fragment->name,
                             stitch_register_name((unsigned)__builtin_ctz(missing)));
    }
    return 0;
}

int plan_check(const struct plan *plan, struct error *error)
{
    if (plan_complete(plan, error))
        return -1;
    uint32_t *valid = malloc(plan->count * sizeof *valid);
    if (!valid)
        return error_set(error, "out of memory for checking a plan of %u parts", plan->count);
    int result = check_inputs(plan, valid, error);
    free(valid);
    return result;
}
