#include "placement_part.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

void placement_wrong(struct check *c, const char *format, ...)
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

/* The targets of jumps: around a region, to the moves on the way into it, to one of the paths of a window, of
 * a level's words or of texels, back to the head of a loop, or out of the loop. */
void placement_run_jump(struct check *c)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
    size_t to = c->offset + c->instruction.length + (size_t)c->operand[0].imm.value.s;
    bool always = c->instruction.mnemonic == ZYDIS_MNEMONIC_JMP,
         zero = c->instruction.mnemonic == ZYDIS_MNEMONIC_JZ;
    if (i->op == IR_when && (always || zero)) {
        unsigned region = c->regions; /* opened after this operation's code */
        places_copy(c, &c->skipped[region], &c->now);
        c->skipped_to[region] = to;
    } else if (i->op == IR_when || placement_covers(i) || i->op == IR_near_column || i->op == IR_reciprocal ||
               i->op == IR_gather || i->op == IR_stretch || zero) {
        unsigned n = 0;
        while (n < LOCAL_JUMPS - 1 && c->local[n].reached)
            n++;
        places_copy(c, &c->local[n], &c->now);
        c->local_to[n] = to;
    } else if (i->op == IR_again) {
        struct loop_state *loop = &c->loop[c->loops - 1];
        struct places around = {0};
        if (to != loop->offset)
            placement_wrong(c, "goes back to 0x%zx, but the loop's head is at 0x%zx", to, loop->offset);
        places_copy(c, &around, &c->now);
        places_name_next(c, &around);
        c->again |= places_merge(c, &loop->head, &around);
        free(around.at);
    } else
        placement_wrong(c, "jumps");
    if (always)
        c->now.reached = false;
}

static void expect_result(struct check *c)
{
    const struct allocation *a = &c->b->allocation;
    const struct ir_instruction *self = placement_operation(c, c->number);
    if (self->op == IR_copy || self->op == IR_phi)
        places_rename(c, &c->now, c->number, self->operand[0]);
    for (uint32_t n = c->number; c->coded && n < placement_selected_end(c); n++) {
        const struct ir_instruction *i = placement_operation(c, n);
        if (ir_op_information[i->op].properties & IR_EFFECT || a->residence[n] != RESIDENCE_REGISTER ||
            i->op == IR_join || (placement_covers(self) && i->op != IR_gather))
            continue;
        if (!place_holds(c, &c->now.at[a->reg[n]], n))
            placement_wrong(c, "%%%u is not in register %u", (unsigned)n, a->reg[n]);
    }
}

/* A literal may be part of the choice of an instruction, and copies of values do not change them. */
static void expect_operands(struct check *c)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
    bool copies = i->op == IR_copy || i->op == IR_phi || i->op == IR_next;
    for (int o = 0; c->coded && !copies && o < placement_operands(c); o++)
        if (!(c->read >> o & 1) && placement_operation(c, placement_operand(c, o))->op != IR_literal)
            placement_wrong(c, "does not read %%%u", placement_operand(c, o));
    unsigned stores = i->op == IR_scatter ? c->coded * c->m->width
                                          : i->op == IR_store || i->op == IR_store_where || i->op == IR_set ||
                                                i->op == IR_put;
    if (c->stores != stores)
        placement_wrong(c, "stores %u times", c->stores);
}

static void open_when(struct check *c)
{
    if (!c->skipped[c->regions].reached)
        placement_wrong(c, "is entered without a condition");
    c->regions++;
}

static void close_when(struct check *c)
{
    struct places *skipped = &c->skipped[--c->regions];
    places_name_joins(c, &c->now, c->number, 1);
    places_name_joins(c, skipped, c->number, 0);
    if (c->skipped_to[c->regions] != c->offset)
        placement_wrong(c, "is skipped to 0x%zx", c->skipped_to[c->regions]);
    places_merge(c, &c->now, skipped);
    skipped->reached = false;
}

static void open_loop(struct check *c)
{
    struct loop_state *loop = &c->loop[c->loops++];
    loop->number = c->number;
    loop->offset = c->offset;
    places_copy(c, &loop->head, &c->now);
}

/* The way back to the head of a loop of the span reading, which has no jump in the program. */
static void run_back(struct check *c)
{
    struct loop_state *loop = &c->loop[c->loops - 1];
    struct places around = {0};
    places_copy(c, &around, &c->now);
    places_name_next(c, &around);
    c->again |= places_merge(c, &loop->head, &around);
    free(around.at);
}

/* Walks the loop once more from a state with fewer known values, or leaves it. */
static void close_loop(struct check *c)
{
    struct loop_state *loop = &c->loop[c->loops - 1];
    if (placement_operation(c, c->number)->k != IR_LOOP_LANES)
        run_back(c);
    if (!c->again) {
        if (placement_may_skip(c, loop->number))
            places_merge(c, &c->now, &loop->head);
        c->loops--;
        return;
    }
    c->again = false;
    places_copy(c, &c->now, &loop->head);
    c->number = loop->number;
    c->line = 0;
}

/* The body leaves the registers of constants as they were. */
static void expect_kept(struct check *c)
{
    const struct allocation *a = &c->b->allocation;
    for (uint32_t n = 0; n < a->kept_count; n++)
        if (!place_holds(c, &c->now.at[a->reg[a->kept[n]]], a->kept[n]))
            placement_wrong(c, "register %u has lost the constant %%%u", a->reg[a->kept[n]],
                            (unsigned)a->kept[n]);
}

/* The body begins again with what both the preamble and the body leave. */
static void repeat_body(struct check *c)
{
    expect_kept(c);
    c->again |= places_merge(c, &c->loop[c->loops - 1].head, &c->now);
    close_loop(c);
}

/* Nothing is known of what the caller has left, except arguments. */
static void begin_subroutine(struct check *c)
{
    c->inside = true;
    for (unsigned p = 0; p < c->places; p++)
        c->now.at[p] = (struct content){.origin = FROM_NOTHING};
}

/* The effect of the operation itself, apart from its code. */
static void run_meaning(struct check *c)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
    switch (i->op) {
    case IR_when: open_when(c); break;
    case IR_end: close_when(c); break;
    case IR_section:
    case IR_loop: open_loop(c); break;
    case IR_repeat: repeat_body(c); break;
    case IR_again: close_loop(c); break;
    case IR_subroutine: begin_subroutine(c); break;
    }
}

/* --- Calls ---------------------------------------------------------------------------------------------- */

/* Registers that the code of a subroutine writes are lost for its caller. They are read from the machine code
 * of the subroutine, not from its allocation. */

/* The entry of the line table of an operation; c->m->lines: it has none. */
static uint32_t line_of(const struct check *c, uint32_t operation)
{
    uint32_t line = 0;
    while (line < c->m->lines && c->m->line[line].instruction != operation)
        line++;
    return line;
}

static uint32_t find_subroutine(const struct check *c, int32_t number)
{
    uint32_t n = 1;
    while (n < c->ir->count &&
           (placement_operation(c, n)->op != IR_subroutine || placement_operation(c, n)->k != number))
        n++;
    return n;
}

static uint32_t find_leave(const struct check *c, uint32_t from)
{
    while (from < c->ir->count && placement_operation(c, from)->op != IR_leave)
        from++;
    return from;
}

static void forget(struct check *c, unsigned place)
{
    c->now.at[place] = (struct content){.origin = FROM_ELSEWHERE};
}

/* General registers that hold a base keep it. Over whole blocks of eight lanes, windows count in rbx. */
static bool is_scratch(const struct check *c, ZydisRegister r)
{
    if (r == ZYDIS_REGISTER_RBX)
        return c->m->width == 8 && emit_lanes(c->m) == BLOCK_PIXELS;
    return r == ZYDIS_REGISTER_RAX || r == ZYDIS_REGISTER_R12 || r == ZYDIS_REGISTER_R13;
}

static bool is_general(ZydisRegister r)
{
    return r >= ZYDIS_REGISTER_RAX && r <= ZYDIS_REGISTER_R15;
}

/* Writes of the frame: slots, the room for lanes, variables. */
static void note_frame_write(struct check *c, const ZydisDecodedOperand *o)
{
    int64_t at = o->mem.disp.value - 8;
    if (o->mem.base != ZYDIS_REGISTER_RSP)
        return;
    if (at < FRAME_LANES || at >= c->m->frame_saved)
        placement_wrong(c, "calls code that writes to the frame at %lld", (long long)at);
    int place = placement_place_in_frame(c, at);
    if (place >= 0)
        forget(c, (unsigned)place);
}

static void note_write(struct check *c, const ZydisDecodedOperand *o)
{
    if (!(o->actions & ZYDIS_OPERAND_ACTION_MASK_WRITE))
        return;
    if (o->type == ZYDIS_OPERAND_TYPE_MEMORY) {
        note_frame_write(c, o);
        return;
    }
    if (o->type != ZYDIS_OPERAND_TYPE_REGISTER)
        return;
    ZydisRegister whole = ZydisRegisterGetLargestEnclosing(ZYDIS_MACHINE_MODE_LONG_64, o->reg.value);
    if (placement_vector_number(o->reg.value) >= 0)
        forget(c, (unsigned)placement_vector_number(o->reg.value));
    else if (is_general(whole) && !is_scratch(c, whole))
        placement_wrong(c, "calls code that writes %s", ZydisRegisterGetString(o->reg.value));
}

/* Walks the code of a subroutine up to its return. */
static void lose_what_is_written(struct check *c, size_t at)
{
    ZydisDecodedInstruction instruction;
    ZydisDecodedOperand operand[ZYDIS_MAX_OPERAND_COUNT];
    for (; at < c->m->code_bytes && !c->wrong; at += instruction.length) {
        if (!ZYAN_SUCCESS(ZydisDecoderDecodeFull(&c->decoder, c->m->code + at, c->m->code_bytes - at,
                                                 &instruction, operand)))
            placement_wrong(c, "calls bytes that are not code at 0x%zx", at);
        else if (instruction.meta.category == ZYDIS_CATEGORY_RET)
            return;
        for (unsigned n = 0; n < instruction.operand_count && !c->wrong; n++)
            note_write(c, &operand[n]);
    }
    placement_wrong(c, "calls code that does not return");
}

void placement_run_call(struct check *c)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
    size_t to = c->offset + c->instruction.length + (size_t)c->operand[0].imm.value.s;
    if (i->op != IR_call || c->inside || c->called) {
        placement_wrong(c, "calls");
        return;
    }
    uint32_t subroutine = find_subroutine(c, i->k), line = line_of(c, subroutine);
    if (line + 1 >= c->m->lines || c->m->line[line + 1].offset != to)
        placement_wrong(c, "calls 0x%zx, where its subroutine does not begin", to);
    else if (c->job != i->field)
        placement_wrong(c, "calls with the job %lld bytes further, expected %d", (long long)c->job,
                        (int)i->field);
    else if (line_of(c, find_leave(c, subroutine)) == c->m->lines)
        placement_wrong(c, "calls a subroutine without an end");
    else
        lose_what_is_written(c, to);
    c->called = true;
}

void placement_move_job(struct check *c)
{
    if (c->instruction.mnemonic != ZYDIS_MNEMONIC_ADD || c->operand[0].reg.value != ZYDIS_REGISTER_R8 ||
        c->operand[1].type != ZYDIS_OPERAND_TYPE_IMMEDIATE)
        placement_wrong(c, "writes a register that is not that of the job");
    else
        c->job += c->operand[1].imm.value.s;
}

void placement_end_call(struct check *c)
{
    if (!c->called)
        placement_wrong(c, "does not call");
    else if (c->job)
        placement_wrong(c, "leaves the job %lld bytes further", (long long)c->job);
}

/* --- The walk ------------------------------------------------------------------------------------------- */

static void start(struct check *c, const struct builder *b)
{
    c->b = b;
    c->ir = &b->ir;
    c->m = &b->emitter;
    c->places = SLOTS + b->allocation.slots + REGISTERS; /* the registers that are saved around a call */
    c->visit = c->line = c->regions = c->loops = c->offset = 0;
    c->wrong = c->again = c->inside = false;
    for (unsigned n = 0; n < LOCAL_JUMPS; n++)
        c->local[n].reached = false;
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
    c->now = none;
    for (unsigned n = 0; n < LOCAL_JUMPS; n++) {
        free(c->local[n].at);
        c->local[n] = none;
    }
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
    const bool sections = ir_find_body(c.ir) > 1;
    if (!sections)
        placement_run_kept(&c);
    for (c.number = 1; c.number < c.ir->count && !c.wrong; c.number++) {
        if (sections && c.number == ir_find_body(c.ir) - 1 && !c.loops)
            placement_run_kept(&c);
        placement_run_code(&c);
        expect_operands(&c);
        expect_result(&c);
        if (!c.wrong)
            run_meaning(&c);
    }
    if (!sections && !c.wrong) {
        c.number = c.ir->count - 1;
        expect_kept(&c);
    }
    finish(&c);
    return c.wrong ? c.text : NULL;
}
