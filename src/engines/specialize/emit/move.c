/* Parallel moves: where control flow joins, from values to the phis and joins of other webs
 * (allocate/coalesce.c).
 *
 * The moves of one edge are simultaneous: sources are located before the edge, destinations after it. They
 * are written one by one, each when no other move still reads its destination. If every move waits for
 * another, the source of one is first copied to a scratch register. A destination with a spill slot is stored
 * too, as every definition is. */
#include "engines/specialize/emit/emit.h"

static struct location locate_at(struct emitter *m, unsigned value, uint32_t position)
{
    uint32_t here = m->position;
    m->position = position;
    struct location location = emit_locate(m, value);
    m->position = here;
    return location;
}

/* Notes a move of `source` at position `before` to `target` at position `after`, unless they are of one web.
 */
static void add_move(struct emitter *m, unsigned target, uint32_t after, unsigned source, uint32_t before)
{
    const struct allocation *a = m->allocation;
    unsigned web = allocate_web(a, target);
    if (a->residence[target] != RESIDENCE_REGISTER || web == allocate_web(a, source))
        return;
    m->move[m->moves++] = (struct move){.from = locate_at(m, source, before),
                                        .to = after <= a->split[web] ? a->reg[web] : NO_REGISTER,
                                        .mask = allocate_is_mask(a, &m->ir->instruction[web]),
                                        .slot = a->slot[web]};
}

void emit_note_next_moves(struct emitter *m)
{
    m->moves = 0;
    for (uint32_t n = m->position - 1; m->ir->instruction[n].op == IR_next; n--)
        add_move(m, m->ir->instruction[n].operand[0], m->position, m->ir->instruction[n].operand[1],
                 m->position);
}

void emit_note_join_moves(struct emitter *m, uint32_t end, int operand)
{
    uint32_t last = end;
    m->moves = 0;
    while (last + 1 < m->ir->count && m->ir->instruction[last + 1].op == IR_join)
        last++;
    /* The positions after the last join: a join may have been evicted for a later one of the group. */
    for (uint32_t n = end + 1; n <= last; n++)
        add_move(m, n, last + 1, m->ir->instruction[n].operand[operand], m->position);
}

/* Returns true if a move reads the destination of another. */
static bool reads(const struct emitter *m, const struct move *move, const struct move *destination)
{
    if (move->from.reg != NO_REGISTER)
        return move->from.reg == destination->to;
    if (destination->slot == NO_SLOT || move->from.address.base != X86_RSP)
        return false;
    return move->from.address.displacement == emit_slot_address(m, destination->slot).displacement;
}

static void write_move(struct emitter *m, const struct move *move)
{
    unsigned reg = move->to;
    if (reg == NO_REGISTER)
        reg = move->mask ? MASKS + emit_need_mask(m, &move->from, MASK_SCRATCH)
                         : emit_need_register(m, &move->from, SCRATCH_FIRST);
    else
        emit_bring(m, reg, &move->from);
    if (move->slot != NO_SLOT)
        emit_store_register(m, emit_slot_address(m, move->slot), reg);
}

/* Once a move has read its source, moves to that register or slot need not wait for it. */
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

void emit_write_moves(struct emitter *m)
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
            emit_bring(m, aside, &move.from);
            release_source(m, &m->move[0]);
            m->move[0].from = (struct location){.value = move.from.value, .reg = aside};
        }
    }
}
