/* Locations of values, and the code that brings them to registers.
 *
 * A value is in its allocated register up to the position at which it is evicted. After it, and if it never
 * had a register, it is in memory: a literal after the code, a slot of the constant table, a spill slot, or
 * the word that it was loaded from. With 16 lanes a mask may be in a mask register, and a value that is the
 * same in all lanes is one word in memory. With one lane every value is one word, except literals: those have
 * 16 bytes, for instructions that read a whole register. */
#include "engines/specialize/emit/emit.h"

struct address emit_frame_address(const struct emitter *m, int32_t start, unsigned slot)
{
    return address_at(X86_RSP, m->frame_shift + start + (int32_t)(slot * m->width * 4));
}

struct address emit_slot_address(const struct emitter *m, unsigned slot)
{
    return emit_frame_address(m, m->frame_slots, slot);
}

/* A slot of the constant table; with 16 lanes or one, the word that the slot would be filled from. */
static struct address constant_address(const struct emitter *m, unsigned slot)
{
    const struct ir_constant *constant = &m->ir->constant[slot];
    if (emit_has_table(m))
        return emit_frame_address(m, m->frame_constants, slot);
    struct address address = address_at(emit_base_register[constant->base], constant->offset);
    address.broadcast = emit_is_wide(m);
    return address;
}

static struct location memory_location(struct emitter *m, unsigned value)
{
    const struct ir_instruction *i = &m->ir->instruction[value];
    if (i->op == IR_copy && allocate_is_constant(&m->ir->instruction[i->operand[0]]))
        i = &m->ir->instruction[value = i->operand[0]];
    unsigned slot = m->allocation->slot[allocate_web(m->allocation, value)];
    struct location p = {.value = value, .reg = NO_REGISTER, .addressable = true};
    if (i->op == IR_literal)
        p.address = emit_literal_address(m, i->k, emit_is_wide(m) ? LITERAL_ONCE : LITERAL_LANES);
    else if (i->op == IR_constant)
        p.address = constant_address(m, (unsigned)i->k);
    else if (slot != NO_SLOT) {
        p.address = emit_slot_address(m, slot);
        p.mask = allocate_is_mask(m->allocation, i);
        p.addressable = !p.mask;
    } else {
        p.address = emit_base_address(i->base, i->k);
        p.address.broadcast = i->op == IR_uniform && emit_is_wide(m);
        p.addressable = i->op == IR_load || !emit_has_table(m);
    }
    return p;
}

struct location emit_locate(struct emitter *m, unsigned value)
{
    const struct allocation *a = m->allocation;
    unsigned web = allocate_web(a, value);
    if (a->residence[value] == RESIDENCE_REGISTER && m->position <= a->split[web])
        return (struct location){.value = value, .reg = a->reg[web]};
    if (a->residence[value] == RESIDENCE_KEPT && m->position > a->section)
        return (struct location){.value = value, .reg = a->reg[value]};
    return memory_location(m, value);
}

void emit_load_kept(struct emitter *m)
{
    for (uint32_t n = 0; n < m->allocation->kept_count; n++) {
        const unsigned value = m->allocation->kept[n], to = m->allocation->reg[value];
        const struct ir_instruction *i = &m->ir->instruction[value];
        emit_note_line(m, value);
        if (i->op == IR_constant) {
            const struct ir_constant *word = &m->ir->constant[i->k];
            encode_rm(&m->encoder, X86_vbroadcastss, m->length, to,
                      address_at(emit_base_register[word->base], word->offset));
        } else {
            struct location p = memory_location(m, value);
            emit_bring(m, to, &p);
        }
    }
}

bool emit_is_zero(const struct emitter *m, unsigned value)
{
    return m->ir->instruction[value].op == IR_literal && !m->ir->instruction[value].k;
}

static void bring_mask(struct emitter *m, unsigned to, const struct location *p)
{
    struct encoder *e = &m->encoder;
    if (p->reg != NO_REGISTER && p->reg >= MASKS) {
        if (p->reg != to)
            encode_rr(e, X86_kmovw, X86_128, to - MASKS, p->reg - MASKS);
    } else if (p->reg == NO_REGISTER && p->mask)
        encode_rm(e, X86_kmovw, X86_128, to - MASKS, p->address);
    else
        encode_rr(e, X86_vpmovd2m, m->length, to - MASKS, emit_need_register(m, p, SCRATCH_FIRST));
}

static void bring_memory(struct emitter *m, unsigned to, const struct location *p)
{
    struct address from = p->address;
    enum x86_vector how = emit_is_scalar(m)                   ? X86_vmovss
                          : p->addressable && !from.broadcast ? X86_vmovups
                                                              : X86_vbroadcastss;
    from.broadcast = 0;
    if (emit_is_zero(m, p->value) && emit_applies(m, PEEPHOLE_zero))
        encode_rrr(&m->encoder, X86_vxorps, m->length, to, to, to);
    else
        encode_rm(&m->encoder, how, m->length, to, from);
}

/* Returns true if the register already holds the value, a literal. Notes what it holds from now on. */
static bool holds_already(struct emitter *m, unsigned to, const struct location *p)
{
    const struct ir_instruction *i = &m->ir->instruction[p->value];
    const bool literal = p->reg == NO_REGISTER && !p->mask && i->op == IR_literal;
    if (to != SCRATCH_FIRST)
        return false;
    if (literal && m->holds_literal && m->held_bits == i->k && emit_applies(m, PEEPHOLE_held))
        return true;
    m->holds_literal = literal && m->keeps_scratch;
    m->held_bits = i->k;
    return false;
}

void emit_bring(struct emitter *m, unsigned to, const struct location *p)
{
    if (holds_already(m, to, p))
        return;
    if (to >= MASKS)
        bring_mask(m, to, p);
    else if (p->mask || (p->reg >= MASKS && p->reg != NO_REGISTER))
        encode_rr(&m->encoder, X86_vpmovm2d, m->length, to, emit_need_mask(m, p, MASK_SCRATCH));
    else if (p->reg == NO_REGISTER)
        bring_memory(m, to, p);
    else if (p->reg != to)
        encode_copy(&m->encoder, m->length, to, p->reg);
}

unsigned emit_need_register(struct emitter *m, const struct location *p, unsigned scratch)
{
    if (p->reg < MASKS)
        return p->reg;
    emit_bring(m, scratch, p);
    return scratch;
}

unsigned emit_need_mask(struct emitter *m, const struct location *p, unsigned scratch)
{
    if (p->reg != NO_REGISTER && p->reg >= MASKS)
        return p->reg - MASKS;
    emit_bring(m, scratch, p);
    return scratch - MASKS;
}

void emit_store_register(struct emitter *m, struct address to, unsigned reg)
{
    if (reg >= MASKS)
        encode_mr(&m->encoder, X86_kmovw_store, X86_128, to, reg - MASKS);
    else
        encode_mr(&m->encoder, emit_is_scalar(m) ? X86_vmovss_store : X86_vmovaps_store, m->length, to, reg);
}

/* Returns true if the instruction has an encoding that reads the location. */
static bool reads(struct emitter *m, enum x86_vector instruction, struct location *p)
{
    if (p->reg != NO_REGISTER || !p->addressable)
        return false;
    if (emit_is_scalar(m) && !encode_reads_word(instruction))
        return m->ir->instruction[p->value].op == IR_literal;
    if (p->address.broadcast && !encode_broadcasts(instruction)) {
        const struct ir_instruction *i = &m->ir->instruction[p->value];
        if (i->op != IR_literal || m->rules.without >> PEEPHOLE_memory & 1)
            return false;
        p->address = emit_literal_address(m, i->k, LITERAL_LANES);
    }
    return true;
}

bool emit_folds(struct emitter *m, enum x86_vector instruction, struct location *p)
{
    return reads(m, instruction, p) && emit_applies(m, PEEPHOLE_memory);
}

unsigned emit_result_register(const struct emitter *m)
{
    return m->allocation->reg[m->position];
}
