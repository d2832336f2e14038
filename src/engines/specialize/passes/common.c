/* Common subexpressions, by hash-consing from front to back.
 *
 * An earlier instruction replaces a later equal one if its region is still open there. A read takes part only
 * if no routine writes that memory (ir_is_invariant_read). Operands are replaced before an instruction is
 * looked up, so one run finds whole common expressions. Variables and phis do not take part: their value
 * depends on the position. */
#include "base/hash.h"
#include "engines/specialize/passes/pass.h"

#include <string.h>

enum { TABLE_CAPACITY = 2 * (IR_CAPACITY + 1) }; /* what hash_slots returns at most */

/* Arrays are indexed by instruction, `table` by hash. A region is named by its `when`; 0 is the routine. */
struct common_memory {
    uint16_t replacement[IR_CAPACITY]; /* of each value, itself if there is none */
    uint16_t region[IR_CAPACITY];      /* of each value in the table */
    uint16_t outer[IR_CAPACITY];       /* of each region: the region around it */
    uint8_t open[IR_CAPACITY];         /* of each region */
    uint16_t table[TABLE_CAPACITY];    /* values; 0: an empty slot */
};

static_assert(sizeof(struct common_memory) <= PASS_SCRATCH, "scratch memory is large enough");

/* Returns the innermost region after the instruction. */
static uint16_t cross(struct common_memory *m, const struct ir_instruction *i, uint32_t number,
                      uint16_t region)
{
    if (i->op == IR_when) {
        m->outer[number] = region;
        m->open[number] = 1;
        return (uint16_t)number;
    }
    if (i->op != IR_end)
        return region;
    m->open[region] = 0;
    return m->outer[region];
}

static bool may_share(const struct ir_instruction *i)
{
    unsigned properties = ir_properties(i);
    if (i->op == IR_nop || i->op == IR_copy || properties & (IR_EFFECT | IR_PLACED))
        return false;
    return !(properties & IR_READS) || ir_is_invariant_read(i);
}

static void order_operands(struct ir_instruction *i)
{
    if (ir_properties(i) & IR_COMMUTES && i->operand[0] > i->operand[1]) {
        uint16_t first = i->operand[0];
        i->operand[0] = i->operand[1];
        i->operand[1] = first;
    }
}

static uint32_t hash(const struct ir_instruction *i)
{
    uint64_t h = i->op | (uint64_t)i->base << 8 | (uint64_t)i->operand[0] << 16 |
                 (uint64_t)i->operand[1] << 32 | (uint64_t)i->operand[2] << 48;
    h = (h ^ (uint64_t)(uint32_t)i->k << 7 ^ (uint64_t)(uint32_t)i->field << 29) * 0x9e3779b97f4a7c15ull;
    return (uint32_t)(h >> 40);
}

struct candidate {
    const struct ir *ir;
    const struct ir_instruction *instruction;
};

static bool is_same(const void *context, uint32_t number)
{
    const struct candidate *candidate = context;
    const struct ir_instruction *x = &candidate->ir->instruction[number], *y = candidate->instruction;
    return x->op == y->op && x->base == y->base && x->scale == y->scale && x->k == y->k &&
           x->field == y->field && !memcmp(x->operand, y->operand, sizeof x->operand);
}

unsigned pass_common(struct ir *ir, struct pass_memory *memory)
{
    struct common_memory *m = pass_scratch(memory, sizeof *m);
    /* A table no larger than the routine needs: clearing it is most of the pass's cost. */
    const uint32_t slots = hash_slots(ir->count, 64);
    const struct hash_table table = {m->table, slots - 1, false};
    uint16_t region = 0;
    unsigned changes = 0;
    memset(m->table, 0, slots * sizeof m->table[0]);
    m->open[0] = 1;
    m->replacement[0] = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        region = cross(m, i, number, region);
        m->replacement[number] = (uint16_t)number;
        for (int o = 0; o < 3; o++)
            i->operand[o] = m->replacement[i->operand[o]];
        if (!may_share(i))
            continue;
        order_operands(i);
        const struct candidate candidate = {ir, i};
        uint32_t slot = hash_find(table, hash(i), is_same, &candidate);
        uint16_t earlier = (uint16_t)hash_get(table, slot);
        /* A value whose region is closed gives up its slot: no region opens again. */
        if (earlier && m->open[m->region[earlier]]) {
            m->replacement[number] = earlier;
            ir->typed &= i->type == ir->instruction[earlier].type;
            *i = (struct ir_instruction){.op = IR_copy,
                                         .type = i->type,
                                         .operand = {earlier},
                                         .line = i->line,
                                         .file = i->file,
                                         .origin = i->origin};
            changes++;
        } else {
            hash_set(table, slot, number);
            m->region[number] = region;
        }
    }
    return changes;
}
