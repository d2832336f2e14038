/* The literals of a routine: they follow its code, and instructions address them relative to rip. Equal ones
 * are stored once. */
#include "base/hash.h"
#include "engines/specialize/emit/emit.h"

static uint32_t hash_literal(int32_t bits, unsigned kind)
{
    return (((uint32_t)bits + kind) * 0x9e3779b1u) >> (32 - __builtin_ctz(LITERAL_TABLE));
}

static struct hash_table literal_table(struct emitter *m)
{
    return (struct hash_table){m->literal_table, LITERAL_TABLE - 1, false};
}

struct wanted_literal {
    const struct emitter *m;
    int32_t bits;
    unsigned kind;
};

static bool is_literal(const void *context, uint32_t number)
{
    const struct wanted_literal *wanted = context;
    return wanted->m->literal_bits[number - 1] == wanted->bits &&
           wanted->m->literal_lanes[number - 1] == wanted->kind;
}

/* Finds or adds a literal. Returns its number, from 1. */
static uint32_t find_literal(struct emitter *m, int32_t bits, enum literal_kind kind)
{
    const struct wanted_literal wanted = {m, bits, kind};
    uint32_t slot = hash_find(literal_table(m), hash_literal(bits, kind), is_literal, &wanted);
    uint32_t number = hash_get(literal_table(m), slot);
    if (number)
        return number;
    if (m->literals == LITERAL_CAPACITY) {
        emit_note_exceeded(m, "literals", LITERAL_CAPACITY);
        return 1;
    }
    m->literal_bits[m->literals] = bits;
    m->literal_lanes[m->literals] = (uint8_t)kind;
    m->literal_label[m->literals] = encode_add_label(&m->encoder);
    hash_set(literal_table(m), slot, ++m->literals);
    return m->literals;
}

struct address emit_literal_address(struct emitter *m, int32_t bits, enum literal_kind kind)
{
    struct address address = address_label(m->literal_label[find_literal(m, bits, kind) - 1], 0);
    address.broadcast = kind == LITERAL_ONCE;
    return address;
}

static int32_t literal_word(const struct emitter *m, uint32_t literal, unsigned lane)
{
    uint32_t bits = (uint32_t)m->literal_bits[literal];
    switch (m->literal_lanes[literal]) {
    case LITERAL_MULTIPLES: return (int32_t)(bits * lane);
    case LITERAL_PLACES: return (int32_t)(bits + lane % 4 * 0x04040404u);
    default: return (int32_t)bits;
    }
}

/* Writes the literals: first those with all lanes, which are aligned. Each has at least a register of 16
 * bytes. */
void emit_literals(struct emitter *m)
{
    int32_t lanes[LANES_MAXIMUM];
    unsigned count = m->width < 4 ? 4 : m->width;
    for (unsigned once = 0; once < 2; once++)
        for (uint32_t i = 0; i < m->literals; i++) {
            if ((m->literal_lanes[i] == LITERAL_ONCE) != once)
                continue;
            for (unsigned lane = 0; lane < count; lane++)
                lanes[lane] = literal_word(m, i, lane);
            encode_label(&m->encoder, m->literal_label[i]);
            encode_data(&m->encoder, lanes, (once ? 1 : count) * sizeof lanes[0]);
        }
}

/* Empties the hash table in the reverse order of insertion, so that each literal is still found where probing
 * put it. */
void emit_forget_literals(struct emitter *m)
{
    for (uint32_t i = m->literals; i > 0; i--) {
        const struct wanted_literal wanted = {m, m->literal_bits[i - 1], m->literal_lanes[i - 1]};
        uint32_t hash = hash_literal(wanted.bits, wanted.kind);
        hash_set(literal_table(m), hash_find(literal_table(m), hash, is_literal, &wanted), 0);
    }
}
