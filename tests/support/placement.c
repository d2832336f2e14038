#include "placement.h"

#include <Zydis/Zydis.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VECTORS = 16, LANES = VECTORS, SLOTS, SET = VARIABLES + 16, DEPTH = 64 };

enum origin {
    FROM_NOTHING,
    FROM_LITERAL,
    FROM_CONSTANT,
    FROM_WORD,
    FROM_LANES,
    FROM_VARIABLE,
    FROM_ELSEWHERE
};

/* What a register or a slot holds. */
struct content {
    uint64_t made_in; /* the operation, by visit, that it is an intermediate result of */
    uint8_t origin;
    uint8_t base;   /* FROM_WORD, FROM_LANES: a general-purpose register */
    uint16_t count; /* of the values that it is */
    int32_t number; /* bits of the literal, of the constant, of the variable; displacement */
    uint16_t value[SET];
};

/* Registers, the frame's room for lanes, slots. */
struct places {
    bool reached;
    struct content *at;
};

struct loop_state {
    uint32_t number; /* of the loop */
    size_t offset;   /* of its head */
    struct places head;
};

struct check {
    const struct builder *b;
    const struct ir *ir;
    const struct emitter *m;
    ZydisDecoder decoder;
    unsigned places; /* in all */
    uint64_t visit;
    uint32_t number; /* of the operation */
    uint32_t line;
    size_t offset;
    struct places now;
    unsigned regions, loops;
    struct places skipped[REGION_DEPTH]; /* by open region: state on the way around it */
    size_t skipped_to[REGION_DEPTH];
    struct loop_state loop[DEPTH];
    struct places local; /* behind a jump within an operation's code */
    size_t local_to;
    unsigned stores;
    unsigned read; /* a bit for each operand that was read */
    bool coded;    /* the operation has code */
    bool again;    /* the loop is to be walked once more */
    ZydisDecodedInstruction instruction;
    ZydisDecodedOperand operand[ZYDIS_MAX_OPERAND_COUNT];
    bool wrong;
    char text[256];
};

__attribute__((format(printf, 2, 3))) static void wrong(struct check *c, const char *format, ...)
{
    if (c->wrong)
        return;
    c->wrong = true;
    int length = snprintf(c->text, sizeof c->text, "%%%u %s, code at 0x%zx: ", (unsigned)c->number,
                          ir_op_information[c->ir->instruction[c->number].op].name, c->offset);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(c->text + length, sizeof c->text - (size_t)length, format, arguments);
    va_end(arguments);
}

static const struct ir_instruction *operation(const struct check *c, unsigned number)
{
    return &c->ir->instruction[number];
}

/* --- What a place holds ------------------------------------------------------------------------------------ */

static bool contains(const struct content *p, unsigned value)
{
    for (unsigned n = 0; n < p->count; n++)
        if (p->value[n] == value)
            return true;
    return false;
}

/* All variables may begin as one value. A set that is full forgets the oldest: it is the latest that is needed. */
static void add(struct content *p, unsigned value)
{
    if (contains(p, value))
        return;
    if (p->count == SET)
        memmove(p->value, p->value + 1, --p->count * sizeof p->value[0]);
    p->value[p->count++] = (uint16_t)value;
}

/* What is used of it: most sets are small. */
static void assign(struct content *to, const struct content *from)
{
    memcpy(to, from, offsetof(struct content, value) + from->count * sizeof from->value[0]);
}

static void remove_value(struct content *p, unsigned value)
{
    for (unsigned n = 0; n < p->count; n++)
        if (p->value[n] == value)
            p->value[n--] = p->value[--p->count];
}

/* Whether a place that was filled from there holds a value that can be read there. */
static bool comes_from(const struct check *c, const struct content *p, const struct ir_instruction *i)
{
    switch (p->origin) {
    case FROM_LITERAL: return i->op == IR_literal && i->k == p->number;
    case FROM_CONSTANT: return i->op == IR_constant && i->k == p->number;
    case FROM_WORD: return i->op == IR_uniform && base_register[i->base] == p->base && i->k == p->number;
    case FROM_LANES: return i->op == IR_load && base_register[i->base] == p->base && i->k == p->number;
    case FROM_VARIABLE: return i->op == IR_get && i->k == p->number && i == operation(c, c->number);
    }
    return false;
}

/* Whether it can be read again: of what routines write, only the operation itself knows when. */
static bool lasts(const struct ir_instruction *i)
{
    return allocate_is_constant(i) || ir_is_invariant_read(i);
}

static bool holds(const struct check *c, const struct content *p, unsigned value)
{
    const struct ir_instruction *i = operation(c, value);
    if (contains(p, value))
        return true;
    if (i->op == IR_copy && allocate_is_constant(operation(c, i->operand[0])))
        i = operation(c, i->operand[0]);
    return (lasts(i) || value == c->number) && comes_from(c, p, i);
}

/* Notes which of the operation's operands are read here. Returns whether any is. */
static bool note_operands(struct check *c, const struct content *p)
{
    const struct ir_instruction *i = operation(c, c->number);
    bool any = false;
    for (int o = 0; o < ir_op_information[i->op].operands; o++)
        if (holds(c, p, i->operand[o])) {
            c->read |= 1u << o;
            any = true;
        }
    return any;
}

static void expect_acceptable(struct check *c, const struct content *p, const char *where, long number)
{
    const struct ir_instruction *i = operation(c, c->number);
    bool sign = i->op == IR_neg_f && p->origin == FROM_LITERAL && p->number == INT32_MIN;
    if (note_operands(c, p) || sign || p->made_in == c->visit)
        return;
    if (p->count)
        wrong(c, "reads %s %ld, which holds %%%u", where, number, p->value[p->count - 1]);
    else
        wrong(c, "reads %s %ld, which holds no operand", where, number);
}

/* --- States ------------------------------------------------------------------------------------------------- */

static void copy_places(const struct check *c, struct places *to, const struct places *from)
{
    if (!to->at)
        to->at = malloc(c->places * sizeof *to->at);
    if (!to->at)
        abort();
    to->reached = from->reached;
    for (unsigned p = 0; p < c->places; p++)
        assign(&to->at[p], &from->at[p]);
}

/* Keeps what both hold. Returns whether anything had to go. */
static bool intersect(struct content *p, const struct content *other)
{
    unsigned kept = 0;
    bool changed =
        p->origin && (p->origin != other->origin || p->base != other->base || p->number != other->number);
    if (changed)
        p->origin = FROM_NOTHING;
    for (unsigned n = 0; n < p->count; n++)
        if (contains(other, p->value[n]))
            p->value[kept++] = p->value[n];
    changed |= kept != p->count;
    p->count = (uint16_t)kept;
    p->made_in = p->made_in == other->made_in ? p->made_in : 0;
    return changed;
}

static bool merge(const struct check *c, struct places *to, const struct places *from)
{
    bool changed = false;
    if (!from->reached)
        return false;
    if (!to->reached) {
        copy_places(c, to, from);
        return true;
    }
    for (unsigned p = 0; p < c->places; p++)
        changed |= intersect(&to->at[p], &from->at[p]);
    return changed;
}

/* Everywhere, from now on, what holds `source` also holds `name`. */
static void rename_value(struct check *c, struct places *s, unsigned name, unsigned source)
{
    for (unsigned p = 0; p < c->places; p++)
        if (holds(c, &s->at[p], source))
            add(&s->at[p], name);
}

static void name_joins(struct check *c, struct places *s, uint32_t end, int operand)
{
    for (uint32_t n = end + 1; n < c->ir->count && operation(c, n)->op == IR_join; n++)
        rename_value(c, s, n, operation(c, n)->operand[operand]);
}

/* All phis of the loop that ends here become their next values at once. */
static void name_next(struct check *c, struct places *s)
{
    for (unsigned p = 0; p < c->places; p++) {
        struct content before, *after = &s->at[p];
        assign(&before, after);
        for (uint32_t n = c->number - 1; operation(c, n)->op == IR_next; n--)
            remove_value(after, operation(c, n)->operand[0]);
        for (uint32_t n = c->number - 1; operation(c, n)->op == IR_next; n--)
            if (holds(c, &before, operation(c, n)->operand[1]))
                add(after, operation(c, n)->operand[0]);
    }
}

/* --- Memory ------------------------------------------------------------------------------------------------- */

static int lane_bytes(const struct check *c)
{
    return (int)c->m->width * 4;
}

/* The literal whose lanes lie at an offset of the code. */
static struct content literal_at(struct check *c, int64_t offset)
{
    for (uint32_t n = 0; n < c->m->literals; n++)
        if (c->m->labels[c->m->literal_label[n]] == offset)
            return (struct content){.origin = FROM_LITERAL, .number = c->m->literal_bits[n]};
    wrong(c, "reads 0x%llx, where no literal begins", (long long)offset);
    return (struct content){.origin = FROM_ELSEWHERE};
}

/* The place of a slot or of the room for lanes, -1: something else in the frame. */
static int place_in_frame(struct check *c, int64_t displacement)
{
    int64_t slot = displacement - c->m->frame_slots;
    if (displacement >= FRAME_LANES && displacement < FRAME_HEAD)
        return LANES;
    if (slot < 0 || displacement >= c->m->frame_variables)
        return -1;
    if (slot % lane_bytes(c))
        wrong(c, "a slot is reached in its middle, at %lld", (long long)displacement);
    return SLOTS + (int)(slot / lane_bytes(c));
}

static struct content read_frame(struct check *c, int64_t displacement)
{
    int place = place_in_frame(c, displacement);
    int64_t from = displacement - c->m->frame_constants;
    if (place >= 0)
        return c->now.at[place];
    if (displacement >= c->m->frame_variables)
        return (struct content){.origin = FROM_VARIABLE,
                                .number = (int32_t)((displacement - c->m->frame_variables) / lane_bytes(c))};
    if (from < 0 || from % lane_bytes(c))
        wrong(c, "reads the frame at %lld", (long long)displacement);
    return (struct content){.origin = FROM_CONSTANT, .number = (int32_t)(from / lane_bytes(c))};
}

static int general_number(ZydisRegister r)
{
    return r >= ZYDIS_REGISTER_RAX && r <= ZYDIS_REGISTER_R15 ? (int)(r - ZYDIS_REGISTER_RAX) : -1;
}

/* Of a whole row of lanes, or of one word that is broadcast. */
static struct content read_memory(struct check *c, const ZydisDecodedOperand *o, enum origin origin)
{
    const struct ir_instruction *i = operation(c, c->number);
    int base = general_number(o->mem.base);
    if (o->mem.base == ZYDIS_REGISTER_RIP)
        return literal_at(c, (int64_t)c->offset + c->instruction.length + o->mem.disp.value);
    if (base == X86_RSP)
        return read_frame(c, o->mem.disp.value);
    if (o->mem.index != ZYDIS_REGISTER_NONE || base == X86_RAX) {
        if (i->op != IR_gather)
            wrong(c, "gathers");
        return (struct content){.origin = FROM_ELSEWHERE, .made_in = c->visit};
    }
    return (struct content){
        .origin = (uint8_t)origin, .base = (uint8_t)base, .number = (int32_t)o->mem.disp.value};
}

/* A store of lanes to where the operation says, or of a value to the frame. */
static void write_memory(struct check *c, const ZydisDecodedOperand *o, const struct content *p)
{
    const struct ir_instruction *i = operation(c, c->number);
    int base = general_number(o->mem.base);
    int64_t at = o->mem.disp.value;
    if (base == X86_RSP) {
        int place = place_in_frame(c, at);
        if (place >= 0)
            assign(&c->now.at[place], p);
        else if (i->op != IR_set || at != c->m->frame_variables + i->k * lane_bytes(c))
            wrong(c, "writes to the frame at %lld", (long long)at);
        else {
            expect_acceptable(c, p, "for variable", i->k);
            c->stores++;
        }
        return;
    }
    bool meant = i->op == IR_store
                     ? at == i->k
                     : i->op == IR_scatter && (!i->field ? at == i->k : (at - i->k) % i->field == 0);
    if (!meant || base != base_register[i->base] || o->mem.index != ZYDIS_REGISTER_NONE)
        wrong(c, "stores to %lld", (long long)at);
    expect_acceptable(c, p, "to store at", (long)at);
    c->stores++;
}

/* --- Instructions ------------------------------------------------------------------------------------------- */

static int vector_number(ZydisRegister r)
{
    if (r >= ZYDIS_REGISTER_XMM0 && r <= ZYDIS_REGISTER_XMM15)
        return (int)(r - ZYDIS_REGISTER_XMM0);
    return r >= ZYDIS_REGISTER_YMM0 && r <= ZYDIS_REGISTER_YMM15 ? (int)(r - ZYDIS_REGISTER_YMM0) : -1;
}

static int operand_vector(const ZydisDecodedOperand *o)
{
    return o->type == ZYDIS_OPERAND_TYPE_REGISTER ? vector_number(o->reg.value) : -1;
}

/* The next operations that one selection covers: gathers by rows. */
static uint32_t selected_end(const struct check *c)
{
    uint32_t end = c->number + 1, next = c->line + 1 < c->m->lines ? c->m->line[c->line + 1].instruction : 0;
    while (operation(c, c->number)->op == IR_gather && end < c->ir->count && end != next &&
           operation(c, end)->op == IR_gather)
        end++;
    return end;
}

/* A register gets an intermediate result, or the value whose register it is. */
static void write_register(struct check *c, unsigned reg, const struct content *p)
{
    assign(&c->now.at[reg], p);
    for (uint32_t n = c->number; n < selected_end(c); n++)
        if (c->b->allocation.residence[n] == RESIDENCE_REGISTER && c->b->allocation.reg[n] == reg &&
            (p->made_in == c->visit || holds(c, p, n))) {
            add(&c->now.at[reg], n);
            if (!lasts(operation(c, n)))
                c->now.at[reg].origin = FROM_NOTHING;
        }
}

static bool is_full(const struct check *c, const ZydisDecodedOperand *o)
{
    return o->size == c->m->width * 32;
}

/* Whole registers from one place to another. */
static bool is_copy(const struct check *c)
{
    ZydisMnemonic m = c->instruction.mnemonic;
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
    note_operands(c, &p);
    if (operand_vector(to) >= 0)
        write_register(c, (unsigned)operand_vector(to), &p);
    else
        write_memory(c, to, &p);
}

/* All bits zero or one, whatever was there. */
static bool makes_constant(const struct check *c)
{
    ZydisMnemonic m = c->instruction.mnemonic;
    if (m != ZYDIS_MNEMONIC_VXORPS && m != ZYDIS_MNEMONIC_VPCMPEQD)
        return false;
    int reg = operand_vector(&c->operand[0]);
    return reg >= 0 && operand_vector(&c->operand[1]) == reg && operand_vector(&c->operand[2]) == reg;
}

static void run_constant(struct check *c)
{
    const struct content *before = &c->now.at[operand_vector(&c->operand[1])];
    bool zero = c->instruction.mnemonic == ZYDIS_MNEMONIC_VXORPS;
    struct content p = {.origin = FROM_LITERAL, .number = zero ? 0 : -1};
    /* A gather's mask and what it merges into; an operation on one register twice. */
    if (operation(c, c->number)->op == IR_gather || (!zero && note_operands(c, before)))
        p.made_in = c->visit;
    write_register(c, (unsigned)operand_vector(&c->operand[0]), &p);
}

static void read_operand(struct check *c, const ZydisDecodedOperand *o)
{
    const struct ir_instruction *i = operation(c, c->number);
    if (operand_vector(o) >= 0)
        expect_acceptable(c, &c->now.at[operand_vector(o)], "register", operand_vector(o));
    if (o->type != ZYDIS_OPERAND_TYPE_MEMORY || o->mem.type == ZYDIS_MEMOP_TYPE_AGEN)
        return;
    if (vector_number(o->mem.index) >= 0)
        expect_acceptable(c, &c->now.at[vector_number(o->mem.index)], "index", vector_number(o->mem.index));
    struct content p = read_memory(c, o, FROM_LANES);
    if (i->op == IR_gather && p.origin == FROM_LANES) { /* its pointer, or the word of one lane */
        const struct ir_instruction *index = operation(c, i->operand[0]);
        int64_t lane = p.number - index->k;
        if (p.base == base_register[i->base] && p.number == i->field)
            return;
        if (index->op == IR_load && p.base == base_register[index->base] && lane >= 0 &&
            lane < lane_bytes(c)) {
            c->read |= 1;
            return;
        }
    }
    expect_acceptable(c, &p, "memory at", (long)o->mem.disp.value);
}

/* Reads what it says, and leaves intermediate results. */
static void run_other(struct check *c)
{
    for (unsigned n = 0; n < c->instruction.operand_count; n++)
        if (c->operand[n].actions & ZYDIS_OPERAND_ACTION_MASK_READ)
            read_operand(c, &c->operand[n]);
    for (unsigned n = 0; n < c->instruction.operand_count; n++) {
        const ZydisDecodedOperand *o = &c->operand[n];
        struct content p = {.made_in = c->visit};
        if (!(o->actions & ZYDIS_OPERAND_ACTION_MASK_WRITE))
            continue;
        if (operand_vector(o) >= 0)
            write_register(c, (unsigned)operand_vector(o), &p);
        else if (o->type == ZYDIS_OPERAND_TYPE_MEMORY)
            write_memory(c, o, &p);
    }
}

/* --- Control ------------------------------------------------------------------------------------------------ */

/* Around a region, to the moves of the way into it, back to a loop's head, or out of the loop. */
static void run_jump(struct check *c)
{
    const struct ir_instruction *i = operation(c, c->number);
    size_t to = c->offset + c->instruction.length + (size_t)c->operand[0].imm.value.s;
    bool always = c->instruction.mnemonic == ZYDIS_MNEMONIC_JMP,
         zero = c->instruction.mnemonic == ZYDIS_MNEMONIC_JZ;
    if (i->op == IR_when && (always || zero)) {
        unsigned region = c->regions; /* opened behind this operation's code */
        copy_places(c, &c->skipped[region], &c->now);
        c->skipped_to[region] = to;
    } else if (i->op == IR_when || zero) {
        copy_places(c, &c->local, &c->now);
        c->local_to = to;
    } else if (i->op == IR_again) {
        struct loop_state *loop = &c->loop[c->loops - 1];
        struct places around = {0};
        if (to != loop->offset)
            wrong(c, "goes back to 0x%zx, but the loop's head is at 0x%zx", to, loop->offset);
        copy_places(c, &around, &c->now);
        name_next(c, &around);
        c->again |= merge(c, &loop->head, &around);
        free(around.at);
    } else
        wrong(c, "jumps");
    if (always)
        c->now.reached = false;
}

static void run_instruction(struct check *c)
{
    ZydisInstructionCategory category = c->instruction.meta.category;
    if (c->instruction.mnemonic == ZYDIS_MNEMONIC_NOP)
        return;
    if (category == ZYDIS_CATEGORY_COND_BR || category == ZYDIS_CATEGORY_UNCOND_BR)
        run_jump(c);
    else if (is_copy(c))
        run_copy(c);
    else if (makes_constant(c))
        run_constant(c);
    else
        run_other(c);
}

static void arrive(struct check *c)
{
    if (!c->local.reached || c->local_to != c->offset)
        return;
    merge(c, &c->now, &c->local);
    c->local.reached = false;
}

/* The code that was selected for the current operation, if any was. */
static void run_code(struct check *c)
{
    c->visit++;
    c->coded = false;
    c->read = c->stores = 0;
    while (c->line < c->m->lines && c->m->line[c->line].instruction < c->number)
        c->line++;
    if (c->line + 1 >= c->m->lines || c->m->line[c->line].instruction != c->number)
        return;
    size_t end = c->m->line[c->line + 1].offset;
    c->coded = true;
    for (c->offset = c->m->line[c->line].offset; c->offset < end && !c->wrong;
         c->offset += c->instruction.length) {
        arrive(c);
        if (!ZYAN_SUCCESS(ZydisDecoderDecodeFull(&c->decoder, c->m->code + c->offset, end - c->offset,
                                                 &c->instruction, c->operand))) {
            wrong(c, "is no instruction");
            return;
        }
        if (c->now.reached)
            run_instruction(c);
        else
            wrong(c, "cannot be reached");
    }
    arrive(c);
    if (c->local.reached)
        wrong(c, "jumps out of its code");
}

static void expect_result(struct check *c)
{
    const struct allocation *a = &c->b->allocation;
    const struct ir_instruction *self = operation(c, c->number);
    if (self->op == IR_copy || self->op == IR_phi)
        rename_value(c, &c->now, c->number, self->operand[0]);
    for (uint32_t n = c->number; c->coded && n < selected_end(c); n++) {
        const struct ir_instruction *i = operation(c, n);
        if (ir_op_information[i->op].properties & IR_EFFECT || a->residence[n] != RESIDENCE_REGISTER ||
            i->op == IR_join)
            continue;
        if (!holds(c, &c->now.at[a->reg[n]], n))
            wrong(c, "%%%u is not in register %u", (unsigned)n, a->reg[n]);
    }
}

/* A literal may be in the choice of the instruction, and copying is done where it changes nothing. */
static void expect_operands(struct check *c)
{
    const struct ir_instruction *i = operation(c, c->number);
    bool copies = i->op == IR_copy || i->op == IR_phi || i->op == IR_next;
    for (int o = 0; c->coded && !copies && o < ir_op_information[i->op].operands; o++)
        if (!(c->read >> o & 1) && operation(c, i->operand[o])->op != IR_literal)
            wrong(c, "does not read %%%u", i->operand[o]);
    unsigned stores = i->op == IR_scatter ? c->m->width : i->op == IR_store || i->op == IR_set;
    if (c->stores != stores)
        wrong(c, "stores %u times", c->stores);
}

static void open_when(struct check *c)
{
    if (!c->skipped[c->regions].reached)
        wrong(c, "is entered without asking");
    c->regions++;
}

static void close_when(struct check *c)
{
    struct places *skipped = &c->skipped[--c->regions];
    name_joins(c, &c->now, c->number, 1);
    name_joins(c, skipped, c->number, 0);
    if (c->skipped_to[c->regions] != c->offset)
        wrong(c, "is skipped to 0x%zx", c->skipped_to[c->regions]);
    merge(c, &c->now, skipped);
    skipped->reached = false;
}

static void open_loop(struct check *c)
{
    struct loop_state *loop = &c->loop[c->loops++];
    loop->number = c->number;
    loop->offset = c->offset;
    copy_places(c, &loop->head, &c->now);
}

/* Walks the loop once more from a state of which less is known, or leaves it. */
static void close_loop(struct check *c)
{
    struct loop_state *loop = &c->loop[c->loops - 1];
    if (!c->again) {
        c->loops--;
        return;
    }
    c->again = false;
    copy_places(c, &c->now, &loop->head);
    c->number = loop->number;
    c->line = 0;
}

/* What the operation is without its code. */
static void run_meaning(struct check *c)
{
    const struct ir_instruction *i = operation(c, c->number);
    switch (i->op) {
    case IR_when: open_when(c); break;
    case IR_end: close_when(c); break;
    case IR_loop: open_loop(c); break;
    case IR_again: close_loop(c); break;
    }
}

static void start(struct check *c, const struct builder *b)
{
    c->b = b;
    c->ir = &b->ir;
    c->m = &b->emitter;
    c->places = SLOTS + b->allocation.slots;
    c->visit = c->line = c->regions = c->loops = c->offset = 0;
    c->wrong = c->again = c->local.reached = false;
    ZydisDecoderInit(&c->decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    c->now.at = calloc(c->places, sizeof *c->now.at);
    if (!c->now.at)
        abort();
    c->now.reached = true;
}

static void finish(struct check *c)
{
    struct places none = {0};
    free(c->now.at);
    free(c->local.at);
    c->now = c->local = none;
    for (unsigned n = 0; n < REGION_DEPTH; n++) {
        free(c->skipped[n].at);
        c->skipped[n] = none;
    }
    for (unsigned n = 0; n < DEPTH; n++) {
        free(c->loop[n].head.at);
        c->loop[n].head = none;
    }
}

const char *placement_check(const struct builder *builder)
{
    static struct check c;
    start(&c, builder);
    for (c.number = 1; c.number < c.ir->count && !c.wrong; c.number++) {
        run_code(&c);
        expect_operands(&c);
        expect_result(&c);
        if (!c.wrong)
            run_meaning(&c);
    }
    finish(&c);
    return c.wrong ? c.text : NULL;
}
