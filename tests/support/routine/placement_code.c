#include "placement_part.h"

#include <stdlib.h>
#include <string.h>

/* --- Memory ------------------------------------------------------------------------------------------ */

/* The largest number of operands of a window: its own, and those of two rows, two indices and four gathers;
 * of a hint those of eight sums. */
enum { WINDOW_OPERANDS = 3 + 4 + 4 + 4 + 1 };

static bool gathers(const struct ir_instruction *i)
{
    return i->op == IR_gather || placement_covers(i) || i->op == IR_near_row || i->op == IR_stretch;
}

static int lane_bytes(const struct check *c)
{
    return (int)c->m->width * 4;
}

/* Returns true if one element is read for all lanes. */
static bool is_broadcast(const struct check *c)
{
    return c->instruction.avx.broadcast.mode != ZYDIS_BROADCAST_MODE_INVALID;
}

/* Returns true if the bits of a mask are compared in memory. */
static bool compares_mask(const struct check *c)
{
    return c->instruction.mnemonic == ZYDIS_MNEMONIC_CMP;
}

/* The literal at an offset of the code, stored for each lane or as one word for all. */
static struct content literal_at(struct check *c, int64_t offset)
{
    for (uint32_t n = 0; n < c->m->literals; n++)
        if (c->m->labels[c->m->literal_label[n]] == offset &&
            (is_broadcast(c) || compares_mask(c) || c->m->literal_lanes[n]))
            return (struct content){.origin = FROM_LITERAL, .number = c->m->literal_bits[n]};
    placement_wrong(c, "reads 0x%llx, where no literal begins", (long long)offset);
    return (struct content){.origin = FROM_ELSEWHERE};
}

int placement_place_in_frame(struct check *c, int64_t displacement)
{
    int64_t slot = displacement - c->m->frame_slots, saved = displacement - c->m->frame_saved;
    if (displacement >= FRAME_LANES && displacement < FRAME_HEAD)
        return LANES;
    if (saved >= 0 && saved < REGISTERS * lane_bytes(c) && saved % lane_bytes(c) == 0)
        return SLOTS + (int)(c->b->allocation.slots + saved / lane_bytes(c));
    if (slot < 0 || displacement >= c->m->frame_variables)
        return -1; /* a variable */
    if (slot % lane_bytes(c))
        placement_wrong(c, "a slot is reached in its middle, at %lld", (long long)displacement);
    return SLOTS + (int)(slot / lane_bytes(c));
}

/* Returns true for the notes of the passes near and stretch: they follow the values in the entry of a row or
 * a column. */
static bool is_note(const struct check *c, int base, int64_t displacement)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
    bool row =
        base == emit_base_register[BASE_ROW] && displacement >= (int64_t)c->ir->row_words * lane_bytes(c);
    bool column =
        base == emit_base_register[BASE_COLUMN] && displacement >= (int64_t)c->ir->near_words * lane_bytes(c);
    return (row && (i->op == IR_near || i->op == IR_near_row)) ||
           (column && (i->op == IR_near || i->op == IR_near_column || i->op == IR_stretch));
}

static struct content read_frame(struct check *c, int64_t displacement)
{
    int place = placement_place_in_frame(c, displacement);
    int64_t from = displacement - c->m->frame_constants;
    if (place >= 0)
        return c->now.at[place];
    if (displacement >= c->m->frame_variables)
        return (struct content){.origin = FROM_VARIABLE,
                                .number = (int32_t)((displacement - c->m->frame_variables) / lane_bytes(c))};
    if (from < 0 || from % lane_bytes(c) || !emit_has_table(c->m))
        placement_wrong(c, "reads the frame at %lld", (long long)displacement);
    return (struct content){.origin = FROM_CONSTANT, .number = (int32_t)(from / lane_bytes(c))};
}

static int general_number(ZydisRegister r)
{
    return r >= ZYDIS_REGISTER_RAX && r <= ZYDIS_REGISTER_R15 ? (int)(r - ZYDIS_REGISTER_RAX) : -1;
}

/* With 16 lanes or one, constants are read from their source. */
static bool find_constant(const struct check *c, int base, int64_t displacement, struct content *p)
{
    for (uint32_t n = 0; !emit_has_table(c->m) && n < c->ir->constant_count; n++)
        if (emit_base_register[c->ir->constant[n].base] == base &&
            c->ir->constant[n].offset == displacement) {
            *p = (struct content){.origin = FROM_CONSTANT, .number = (int32_t)n};
            return true;
        }
    return false;
}

/* Returns true if one word is read for the only lane, not a pointer. */
static bool is_only_word(const struct check *c)
{
    return emit_is_scalar(c->m) &&
           !(c->instruction.mnemonic == ZYDIS_MNEMONIC_MOV && c->operand[0].size == 64);
}

/* A whole row of lanes, or one word that is broadcast. */
static struct content read_memory(struct check *c, const ZydisDecodedOperand *o, enum origin origin)
{
    struct content constant;
    const struct ir_instruction *i = placement_operation(c, c->number);
    int base = general_number(o->mem.base);
    if (o->mem.base == ZYDIS_REGISTER_RIP)
        return literal_at(c, (int64_t)c->offset + c->instruction.length + o->mem.disp.value);
    if (is_note(c, base, o->mem.disp.value) && o->mem.index == ZYDIS_REGISTER_NONE)
        return (struct content){.origin = FROM_ELSEWHERE, .made_in = c->visit};
    if (base == X86_RSP)
        return read_frame(c, o->mem.disp.value - placement_shift(c));
    if (o->mem.index != ZYDIS_REGISTER_NONE || base == X86_RAX) {
        if (i->op == IR_stretched)
            placement_expect_stretched(c, o);
        else if (!gathers(i))
            placement_wrong(c, "gathers");
        return (struct content){.origin = FROM_ELSEWHERE, .made_in = c->visit};
    }
    if (is_only_word(c) && o->size > 32)
        placement_wrong(c, "reads %u bits of memory", (unsigned)o->size);
    if (is_broadcast(c) || is_only_word(c))
        origin = FROM_WORD;
    if (origin == FROM_WORD && find_constant(c, base, o->mem.disp.value, &constant))
        return constant;
    return (struct content){
        .origin = (uint8_t)origin, .base = (uint8_t)base, .number = (int32_t)o->mem.disp.value};
}

static bool sets(const struct ir_instruction *i)
{
    return i->op == IR_set || i->op == IR_put;
}

/* A store of lanes to the address of the operation, or of a value to the stack frame. */
static void write_memory(struct check *c, const ZydisDecodedOperand *o, const struct content *p)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
    int base = general_number(o->mem.base);
    int64_t at = o->mem.disp.value;
    if (is_note(c, base, at) && i->op != IR_near)
        return;
    if (base == X86_RSP) {
        at -= placement_shift(c);
        int place = placement_place_in_frame(c, at);
        if (place >= 0)
            place_assign(&c->now.at[place], p);
        else if (!sets(i) || at != c->m->frame_variables + placement_variable(c, i) * lane_bytes(c))
            placement_wrong(c, "writes to the frame at %lld", (long long)at);
        else {
            place_expect(c, p, "for variable", i->k);
            c->stores++;
        }
        return;
    }
    bool meant = i->op == IR_store || i->op == IR_store_where
                     ? at == i->k
                     : i->op == IR_scatter && (!i->field ? at == i->k : (at - i->k) % i->field == 0);
    if (!meant || base != emit_base_register[i->base] || o->mem.index != ZYDIS_REGISTER_NONE)
        placement_wrong(c, "stores to %lld", (long long)at);
    place_expect(c, p, "to store at", (long)at);
    c->stores++;
}

/* --- Instructions ------------------------------------------------------------------------------------ */

int placement_vector_number(ZydisRegister r)
{
    if (r >= ZYDIS_REGISTER_XMM0 && r <= ZYDIS_REGISTER_XMM31)
        return (int)(r - ZYDIS_REGISTER_XMM0);
    if (r >= ZYDIS_REGISTER_YMM0 && r <= ZYDIS_REGISTER_YMM31)
        return (int)(r - ZYDIS_REGISTER_YMM0);
    if (r >= ZYDIS_REGISTER_K0 && r <= ZYDIS_REGISTER_K7)
        return (int)(r - ZYDIS_REGISTER_K0) + MASKS;
    return r >= ZYDIS_REGISTER_ZMM0 && r <= ZYDIS_REGISTER_ZMM31 ? (int)(r - ZYDIS_REGISTER_ZMM0) : -1;
}

static int operand_vector(const ZydisDecodedOperand *o)
{
    return o->type == ZYDIS_OPERAND_TYPE_REGISTER ? placement_vector_number(o->reg.value) : -1;
}

/* Returns true for operations whose selection may cover the next ones of their kind, and reads an operand of
 * each. */
static bool joins(unsigned op)
{
    return op == IR_scatter || op == IR_near_row;
}

/* Returns true for operations whose selection may cover the next ones of their kind, each with a result. */
static bool follows(unsigned op)
{
    return op == IR_gather || op == IR_stretch || op == IR_stretched;
}

/* The next operations that one selection covers: gathers and scatters by rows, notes of two rows, texels and
 * lanes of stretched rows, and the operations after a window. */
uint32_t placement_selected_end(const struct check *c)
{
    uint32_t end = c->number + 1, next = c->line + 1 < c->m->lines ? c->m->line[c->line + 1].instruction : 0;
    unsigned op = placement_operation(c, c->number)->op;
    if (placement_covers(placement_operation(c, c->number)))
        return end + (c->coded ? placement_operation(c, c->number)->scale : 0);
    while ((follows(op) || joins(op)) && end < c->ir->count && end != next &&
           placement_operation(c, end)->op == op)
        end++;
    return end;
}

/* The operands of a window are its own and those of the operations that it covers, except values that they
 * compute themselves. */
static int window_operands(const struct check *c, unsigned operand[WINDOW_OPERANDS])
{
    int count = 0;
    for (uint32_t n = c->number; n < placement_selected_end(c); n++)
        for (int o = 0; o < ir_op_information[placement_operation(c, n)->op].operands; o++) {
            unsigned value = placement_operation(c, n)->operand[o];
            if (value < c->number)
                operand[count++] = value;
        }
    return count;
}

int placement_operands(const struct check *c)
{
    unsigned op = placement_operation(c, c->number)->op, operand[WINDOW_OPERANDS];
    if (placement_covers(placement_operation(c, c->number)))
        return window_operands(c, operand);
    return joins(op) && c->coded ? (int)(placement_selected_end(c) - c->number)
                                 : ir_op_information[op].operands;
}

unsigned placement_operand(const struct check *c, int o)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
    unsigned operand[WINDOW_OPERANDS];
    if (placement_covers(i))
        return window_operands(c, operand), operand[o];
    return joins(i->op) ? i[o].operand[0] : i->operand[o];
}

static bool has_register(const struct check *c, uint32_t value)
{
    const uint8_t residence = c->b->allocation.residence[value];
    return residence == RESIDENCE_REGISTER || residence == RESIDENCE_KEPT;
}

/* A register receives an intermediate result, or the value that is allocated to it. */
static void write_register(struct check *c, unsigned reg, const struct content *p)
{
    const bool together = follows(placement_operation(c, c->number)->op);
    unsigned results = 0;
    place_assign(&c->now.at[reg], p);
    for (uint32_t n = c->number; n < placement_selected_end(c); n++)
        if (has_register(c, n) && c->b->allocation.reg[n] == reg &&
            (p->made_in == c->visit || place_holds(c, p, n))) {
            if (together && results++)
                placement_wrong(c, "is written together with %%%u, which has the same register", (unsigned)n);
            place_add(&c->now.at[reg], n);
            if (!place_lasts(placement_operation(c, n)))
                c->now.at[reg].origin = FROM_NOTHING;
        }
}

static bool is_full(const struct check *c, const ZydisDecodedOperand *o)
{
    return o->size == (emit_is_scalar(c->m) ? 128 : c->m->width * 32);
}

/* Moves of masks between locations, or to lanes and back. */
static bool copies_mask(const struct check *c)
{
    ZydisMnemonic m = c->instruction.mnemonic;
    return m == ZYDIS_MNEMONIC_KMOVW || m == ZYDIS_MNEMONIC_VPMOVM2D || m == ZYDIS_MNEMONIC_VPMOVD2M;
}

/* Moves of whole registers between locations. */
static bool is_copy(const struct check *c)
{
    ZydisMnemonic m = c->instruction.mnemonic;
    if (c->mask)
        return false;
    if (copies_mask(c))
        return true;
    if (m == ZYDIS_MNEMONIC_VMOVSS && emit_is_scalar(c->m))
        return true;
    if (m == ZYDIS_MNEMONIC_VBROADCASTSS)
        return is_full(c, &c->operand[0]) && c->operand[1].type == ZYDIS_OPERAND_TYPE_MEMORY;
    return (m == ZYDIS_MNEMONIC_VMOVAPS || m == ZYDIS_MNEMONIC_VMOVUPS) && is_full(c, &c->operand[0]) &&
           is_full(c, &c->operand[1]);
}

static void run_copy(struct check *c)
{
    const ZydisDecodedOperand *to = &c->operand[0], *from = &c->operand[1];
    bool broadcast = c->instruction.mnemonic == ZYDIS_MNEMONIC_VBROADCASTSS;
    struct content p = operand_vector(from) >= 0 ? c->now.at[operand_vector(from)]
                                                 : read_memory(c, from, broadcast ? FROM_WORD : FROM_LANES);
    bool masks = c->instruction.mnemonic == ZYDIS_MNEMONIC_KMOVW;
    if (placement_operation(c, c->number)->op == IR_coverage && operand_vector(from) < 0)
        p = (struct content){.made_in = c->visit, .bits = masks};
    else if (operand_vector(from) < 0 && p.bits != masks && p.origin != FROM_VARIABLE)
        placement_wrong(c, masks ? "reads lanes as a mask" : "reads a mask as lanes");
    place_note_operands(c, &p);
    if (placement_operation(c, c->number)->op == IR_reciprocal && p.origin == FROM_LITERAL)
        p = (struct content){.made_in = c->visit}; /* its result, where it need not divide */
    p.bits = masks || c->instruction.mnemonic == ZYDIS_MNEMONIC_VPMOVD2M;
    if (operand_vector(to) >= 0)
        write_register(c, (unsigned)operand_vector(to), &p);
    else
        write_memory(c, to, &p);
}

/* Instructions that set all bits to zero or one, whatever the operands are. */
static bool makes_constant(const struct check *c)
{
    ZydisMnemonic m = c->instruction.mnemonic;
    if ((m != ZYDIS_MNEMONIC_VXORPS && m != ZYDIS_MNEMONIC_VPCMPEQD) || c->mask)
        return false;
    int reg = operand_vector(&c->operand[0]);
    return reg >= 0 && operand_vector(&c->operand[1]) == reg && operand_vector(&c->operand[2]) == reg;
}

static void run_constant(struct check *c)
{
    const struct content *before = &c->now.at[operand_vector(&c->operand[1])];
    bool zero = c->instruction.mnemonic == ZYDIS_MNEMONIC_VXORPS;
    struct content p = {.origin = FROM_LITERAL, .number = zero ? 0 : -1};
    /* A gather's mask and the register that it merges into; an operation with the same register twice. */
    if (gathers(placement_operation(c, c->number)) || (!zero && place_note_operands(c, before)))
        p.made_in = c->visit;
    write_register(c, (unsigned)operand_vector(&c->operand[0]), &p);
}

static void read_operand(struct check *c, const ZydisDecodedOperand *o)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
    if (operand_vector(o) >= 0)
        place_expect(c, &c->now.at[operand_vector(o)], "register", operand_vector(o));
    if (o->type != ZYDIS_OPERAND_TYPE_MEMORY || o->mem.type == ZYDIS_MEMOP_TYPE_AGEN)
        return;
    if (placement_vector_number(o->mem.index) >= 0)
        place_expect(c, &c->now.at[placement_vector_number(o->mem.index)], "index",
                     placement_vector_number(o->mem.index));
    struct content p = read_memory(c, o, FROM_LANES);
    if (p.bits && i->op != IR_when)
        placement_wrong(c, "reads a mask as lanes");
    if (gathers(i) && p.origin == FROM_LANES) { /* its pointer, a window's pitch, or the word of one lane */
        const struct ir_instruction *index = placement_operation(c, i->operand[0]);
        int64_t lane = p.number - index->k;
        if (p.base == emit_base_register[i->base] &&
            (p.number == i->field || (i->op == IR_window && p.number == i->k)))
            return;
        if (index->op == IR_load && p.base == emit_base_register[index->base] && lane >= 0 &&
            lane < lane_bytes(c)) {
            c->read |= 1;
            return;
        }
    }
    place_expect(c, &p, "memory at", (long)o->mem.disp.value);
}

/* Reads the operands of the instruction, and records intermediate results. */
static void run_other(struct check *c)
{
    for (unsigned n = 0; n < c->instruction.operand_count; n++)
        if (c->operand[n].actions & ZYDIS_OPERAND_ACTION_MASK_READ)
            read_operand(c, &c->operand[n]);
    for (unsigned n = 0; n < c->instruction.operand_count; n++) {
        const ZydisDecodedOperand *o = &c->operand[n];
        struct content p = {.made_in = c->visit, .bits = operand_vector(o) >= MASKS};
        if (!(o->actions & ZYDIS_OPERAND_ACTION_MASK_WRITE))
            continue;
        placement_keep_general(c, o);
        if (operand_vector(o) >= 0)
            write_register(c, (unsigned)operand_vector(o), &p);
        else if (o->type == ZYDIS_OPERAND_TYPE_MEMORY)
            write_memory(c, o, &p);
    }
}

/* The mask of an instruction is listed after its destination; k0 means no mask. */
static void take_mask(struct check *c)
{
    c->mask = 0;
    if (c->instruction.encoding != ZYDIS_INSTRUCTION_ENCODING_EVEX || c->instruction.operand_count < 2 ||
        c->operand[1].encoding != ZYDIS_OPERAND_ENCODING_MASK)
        return;
    c->mask = (unsigned)(c->operand[1].reg.value - ZYDIS_REGISTER_K0);
    c->instruction.operand_count--;
    memmove(c->operand + 1, c->operand + 2, (c->instruction.operand_count - 1u) * sizeof c->operand[0]);
    if (c->mask)
        place_expect(c, &c->now.at[MASKS + c->mask], "mask", c->mask);
}

/* A pointer that is a literal must be the one that the gather starts from, and be listed with its offset. */
static void check_pointer(struct check *c)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
    uint32_t at = (uint32_t)c->offset + c->instruction.length - (uint32_t)sizeof(uint64_t);
    for (uint32_t n = 0; n < c->m->pointers; n++)
        if (c->m->pointer[n].offset == at && i->base == BASE_JOB && c->m->pointer[n].field == i->field)
            return;
    placement_wrong(c, "has a pointer that is not that of its operation");
}

static bool moves_pointer(const struct check *c)
{
    return c->instruction.mnemonic == ZYDIS_MNEMONIC_MOV &&
           c->operand[1].type == ZYDIS_OPERAND_TYPE_IMMEDIATE && c->operand[1].size == 64;
}

void placement_run_instruction(struct check *c)
{
    ZydisInstructionCategory category = c->instruction.meta.category;
    take_mask(c);
    if (c->instruction.mnemonic == ZYDIS_MNEMONIC_NOP)
        return;
    if (category == ZYDIS_CATEGORY_CALL)
        placement_run_call(c);
    else if (category == ZYDIS_CATEGORY_RET) {
        if (placement_operation(c, c->number)->op != IR_leave)
            placement_wrong(c, "returns");
    } else if (placement_operation(c, c->number)->op == IR_call &&
               c->operand[0].type == ZYDIS_OPERAND_TYPE_REGISTER &&
               general_number(c->operand[0].reg.value) >= 0)
        placement_move_job(c);
    else if (moves_pointer(c))
        check_pointer(c);
    else if (category == ZYDIS_CATEGORY_COND_BR || category == ZYDIS_CATEGORY_UNCOND_BR)
        placement_run_jump(c);
    else if (is_copy(c))
        run_copy(c);
    else if (makes_constant(c))
        run_constant(c);
    else
        run_other(c);
}
