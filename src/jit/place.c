/* Where values are while code is selected, and how they come from there to where an instruction takes them.
 *
 * A value is in the register that it was allocated, up to the position at which it is evicted; behind it, and where it was
 * never given one, in memory: a literal of the constant pool, a frame constant, a spill slot, or where it was read from. With
 * 16 lanes a mask may be in a register of its own kind, and what is the same for all lanes is one word. */
#include "jit/emit.h"

struct address frame_address(const struct emitter *m, int32_t start, unsigned slot)
{
    return address_at(X86_RSP, start + (int32_t)(slot * m->width * 4));
}

struct address slot_address(const struct emitter *m, unsigned slot)
{
    return frame_address(m, m->frame_slots, slot);
}

/* A frame constant, or with 16 lanes the word that it would be made of. */
static struct address constant_address(const struct emitter *m, unsigned slot)
{
    const struct ir_constant *constant = &m->ir->constant[slot];
    if (!is_wide(m))
        return frame_address(m, m->frame_constants, slot);
    struct address address = address_at(base_register[constant->base], constant->offset);
    address.broadcast = 1;
    return address;
}

static struct place memory_place(struct emitter *m, unsigned value)
{
    const struct ir_instruction *i = &m->ir->instruction[value];
    if (i->op == IR_copy && allocate_is_constant(&m->ir->instruction[i->operand[0]]))
        i = &m->ir->instruction[value = i->operand[0]];
    unsigned slot = m->allocation->slot[allocate_web(m->allocation, value)];
    struct place p = {.value = value, .reg = NO_REGISTER, .addressable = 1};
    if (i->op == IR_literal)
        p.address = literal_address(m, i->k, is_wide(m) ? LITERAL_ONCE : LITERAL_LANES);
    else if (i->op == IR_constant)
        p.address = constant_address(m, (unsigned)i->k);
    else if (slot != NO_SLOT) {
        p.address = slot_address(m, slot);
        p.mask = (uint8_t)allocate_is_mask(m->allocation, i);
        p.addressable = !p.mask;
    } else {
        p.address = address_at(base_register[i->base], i->k);
        p.address.broadcast = i->op == IR_uniform && is_wide(m);
        p.addressable = i->op == IR_load || is_wide(m);
    }
    return p;
}

struct place place_of(struct emitter *m, unsigned value)
{
    const struct allocation *a = m->allocation;
    unsigned web = allocate_web(a, value);
    if (a->residence[value] == RESIDENCE_REGISTER && m->position <= a->split[web])
        return (struct place){.value = value, .reg = a->reg[web]};
    return memory_place(m, value);
}

int is_zero(const struct emitter *m, unsigned value)
{
    return m->ir->instruction[value].op == IR_literal && !m->ir->instruction[value].k;
}

static void bring_mask(struct emitter *m, unsigned to, const struct place *p)
{
    struct encoder *e = &m->encoder;
    if (p->reg != NO_REGISTER && p->reg >= MASKS) {
        if (p->reg != to)
            vector_rr(e, X86_kmovw, X86_128, to - MASKS, p->reg - MASKS);
    } else if (p->reg == NO_REGISTER && p->mask)
        vector_rm(e, X86_kmovw, X86_128, to - MASKS, p->address);
    else
        vector_rr(e, X86_vpmovd2m, m->length, to - MASKS, need_register(m, p, SCRATCH_FIRST));
}

static void bring_memory(struct emitter *m, unsigned to, const struct place *p)
{
    struct address from = p->address;
    enum x86_vector how = p->addressable && !from.broadcast ? X86_vmovups : X86_vbroadcastss;
    from.broadcast = 0;
    if (is_zero(m, p->value))
        vector_rrr(&m->encoder, X86_vxorps, m->length, to, to, to);
    else
        vector_rm(&m->encoder, how, m->length, to, from);
}

void bring(struct emitter *m, unsigned to, const struct place *p)
{
    if (to >= MASKS)
        bring_mask(m, to, p);
    else if (p->mask || (p->reg >= MASKS && p->reg != NO_REGISTER))
        vector_rr(&m->encoder, X86_vpmovm2d, m->length, to, need_mask(m, p, MASK_SCRATCH));
    else if (p->reg == NO_REGISTER)
        bring_memory(m, to, p);
    else if (p->reg != to)
        vector_copy(&m->encoder, m->length, to, p->reg);
}

unsigned need_register(struct emitter *m, const struct place *p, unsigned scratch)
{
    if (p->reg < MASKS)
        return p->reg;
    bring(m, scratch, p);
    return scratch;
}

unsigned need_mask(struct emitter *m, const struct place *p, unsigned scratch)
{
    if (p->reg != NO_REGISTER && p->reg >= MASKS)
        return p->reg - MASKS;
    bring(m, scratch, p);
    return scratch - MASKS;
}

void store_register(struct emitter *m, struct address to, unsigned reg)
{
    if (reg >= MASKS)
        vector_mr(&m->encoder, X86_kmovw_store, X86_128, to, reg - MASKS);
    else
        vector_mr(&m->encoder, X86_vmovaps_store, m->length, to, reg);
}

int folds(struct emitter *m, enum x86_vector instruction, struct place *p)
{
    if (p->reg != NO_REGISTER || !p->addressable)
        return 0;
    if (p->address.broadcast && !vector_broadcasts(instruction)) {
        const struct ir_instruction *i = &m->ir->instruction[p->value];
        if (i->op != IR_literal)
            return 0;
        p->address = literal_address(m, i->k, LITERAL_LANES);
    }
    return 1;
}

unsigned result_register(const struct emitter *m)
{
    return m->allocation->reg[m->position];
}
