/* Hoists words of the job and constants of shaders out of the routine's loop over its elements: a uniform
 * read becomes a slot of the routine's constant table. The table is in the stack frame, is filled once before
 * the loop, and its slots are memory operands of the instructions that use them. The pass runs after the
 * repeated ones, since it leads to no further simplification.
 *
 * A word that only the preamble reads (preamble.c) is read once anyway, and gets no slot.
 *
 * Requires that the pass `common` has merged equal reads; otherwise each takes a slot, until the table is
 * full. */
#include "base/hash.h"
#include "engines/specialize/passes/pass.h"

#include <string.h>

enum { SLOTS = 2 * IR_CONSTANTS };

struct hoist_memory {
    uint16_t slots[SLOTS];        /* a hash table of constants */
    uint8_t repeats[IR_CAPACITY]; /* of each value: an instruction after the preamble uses it */
};

static_assert(sizeof(struct hoist_memory) <= PASS_SCRATCH, "scratch memory is large enough");

/* Returns the number of the first instruction after the preamble. */
static uint32_t find_repeated(const struct ir *ir, struct hoist_memory *m)
{
    uint32_t section = ir_find_body(ir);
    if (section == 1)
        return section;
    memset(m->repeats, 0, section);
    for (uint32_t number = section; number < ir->count; number++)
        for (unsigned o = 0; o < ir_operands(&ir->instruction[number]); o++)
            m->repeats[ir->instruction[number].operand[o]] = 1;
    return section;
}

struct wanted_word {
    const struct ir *ir;
    struct ir_constant word;
};

static uint32_t hash_word(const struct ir_constant *word)
{
    return (uint32_t)word->offset / 4 + word->base * 0x9e3779b1u;
}

static bool is_word(const void *context, uint32_t number)
{
    const struct wanted_word *wanted = context;
    const struct ir_constant *word = &wanted->ir->constant[number - 1];
    return word->base == wanted->word.base && word->offset == wanted->word.offset;
}

static struct hash_table begin_table(const struct ir *ir, struct hoist_memory *m)
{
    const struct hash_table table = {m->slots, SLOTS - 1, false};
    memset(m->slots, 0, sizeof m->slots);
    for (uint32_t c = 0; c < ir->constant_count; c++) {
        const struct wanted_word wanted = {ir, ir->constant[c]};
        hash_set(table, hash_find(table, hash_word(&wanted.word), is_word, &wanted), c + 1);
    }
    return table;
}

/* Returns the slot of the word, or -1 if the table is full. */
static int find_constant(struct ir *ir, struct hash_table table, const struct ir_instruction *i)
{
    const struct wanted_word wanted = {ir, {i->base, i->k}};
    uint32_t slot = hash_find(table, hash_word(&wanted.word), is_word, &wanted);
    if (hash_get(table, slot))
        return (int)hash_get(table, slot) - 1;
    if (ir->constant_count == IR_CONSTANTS)
        return -1;
    ir->constant[ir->constant_count] = wanted.word;
    hash_set(table, slot, ++ir->constant_count);
    return (int)ir->constant_count - 1;
}

unsigned pass_hoist(struct ir *ir, struct pass_memory *memory)
{
    struct hoist_memory *m = pass_scratch(memory, sizeof *m);
    const uint32_t body = find_repeated(ir, m);
    const struct hash_table table = begin_table(ir, m);
    unsigned changes = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        if (i->op != IR_uniform || (i->base != BASE_JOB && i->base != BASE_CONSTANT) ||
            (number < body && !m->repeats[number]))
            continue;
        int slot = find_constant(ir, table, i);
        if (slot < 0)
            break;
        i->op = IR_constant;
        i->k = slot;
        changes++;
    }
    return changes;
}
