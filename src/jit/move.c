/* Where control joins: the moves from values to the phis and joins that they become, for those that
 * allocation gave places of their own (coalesce.c).
 *
 * All moves of one edge happen at once; sources are where they are before, destinations where they are
 * behind it. They are written one by one, a move when nobody needs its destination any more; when all wait
 * for each other, one source is put aside. A destination that leaves its register later is stored, too, as
 * every definition is. */
#include "jit/emit.h"

static struct place place_at(struct emitter *m, unsigned value, uint32_t position)
{
    uint32_t here = m->position;
    m->position = position;
    struct place place = place_of(m, value);
    m->position = here;
    return place;
}

/* Notes a move of `source` at one position to `target` at another, unless they are in one place anyway. */
static void add_move(struct emitter *m, unsigned target, uint32_t behind, unsigned source, uint32_t before)
{
    const struct allocation *a = m->allocation;
    unsigned web = allocate_web(a, target);
    if (a->residence[target] != RESIDENCE_REGISTER || web == allocate_web(a, source))
        return;
    m->move[m->moves++] = (struct move){.from = place_at(m, source, before),
                                        .to = behind <= a->split[web] ? a->reg[web] : NO_REGISTER,
                                        .mask = (uint8_t)allocate_is_mask(a, &m->ir->instruction[web]),
                                        .slot = a->slot[web]};
}

void note_next_moves(struct emitter *m)
{
    m->moves = 0;
    for (uint32_t n = m->position - 1; m->ir->instruction[n].op == IR_next; n--)
        add_move(m, m->ir->instruction[n].operand[0], m->position, m->ir->instruction[n].operand[1],
                 m->position);
}

void note_join_moves(struct emitter *m, uint32_t end, int operand)
{
    uint32_t last = end;
    m->moves = 0;
    while (last + 1 < m->ir->count && m->ir->instruction[last + 1].op == IR_join)
        last++;
    /* A join may have been evicted for a later one of the group. */
    for (uint32_t n = end + 1; n <= last; n++)
        add_move(m, n, last + 1, m->ir->instruction[n].operand[operand], m->position);
}

static int reads(const struct emitter *m, const struct move *move, const struct move *destination)
{
    if (move->from.reg != NO_REGISTER)
        return move->from.reg == destination->to;
    if (destination->slot == NO_SLOT || move->from.address.base != X86_RSP)
        return 0;
    return move->from.address.displacement == slot_address(m, destination->slot).displacement;
}

static void write_move(struct emitter *m, const struct move *move)
{
    unsigned reg = move->to;
    if (reg == NO_REGISTER)
        reg = move->mask ? MASKS + need_mask(m, &move->from, MASK_SCRATCH)
                         : need_register(m, &move->from, SCRATCH_FIRST);
    else
        bring(m, reg, &move->from);
    if (move->slot != NO_SLOT)
        store_register(m, slot_address(m, move->slot), reg);
}

/* A move's source is read: whoever waited for its place waits no more. */
static void release_source(struct emitter *m, const struct move *move)
{
    for (uint32_t n = 0; n < m->moves; n++)
        m->move[n].waits -= &m->move[n] != move && reads(m, move, &m->move[n]);
}

static void count_waits(struct emitter *m)
{
    for (uint32_t n = 0; n < m->moves; n++) {
        m->move[n].waits = 0;
        for (uint32_t other = 0; other < m->moves; other++)
            m->move[n].waits += n != other && reads(m, &m->move[other], &m->move[n]);
    }
}

void write_moves(struct emitter *m)
{
    count_waits(m);
    while (m->moves) {
        uint32_t ready = 0;
        while (ready < m->moves && m->move[ready].waits)
            ready++;
        struct move move = m->move[ready < m->moves ? ready : 0];
        if (ready < m->moves) {
            write_move(m, &move);
            m->move[ready] = m->move[--m->moves];
            release_source(m, &move);
        } else {
            uint8_t aside = move.mask ? MASK_RESULT : SCRATCH_RESULT;
            bring(m, aside, &move.from);
            release_source(m, &m->move[0]);
            m->move[0].from = (struct place){.value = move.from.value, .reg = aside};
        }
    }
}
