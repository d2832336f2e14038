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

/* The targets of jumps: around a region, to the moves on the way into it, to one of the paths of a window,
 * back to the head of a loop, or out of the loop. */
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
    } else if (i->op == IR_when || i->op == IR_window || i->op == IR_reciprocal || zero) {
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
            i->op == IR_join || (self->op == IR_window && i->op != IR_gather))
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
                                          : i->op == IR_store || i->op == IR_store_where || i->op == IR_set;
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

/* Walks the loop once more from a state with fewer known values, or leaves it. */
static void close_loop(struct check *c)
{
    struct loop_state *loop = &c->loop[c->loops - 1];
    if (!c->again) {
        c->loops--;
        return;
    }
    c->again = false;
    places_copy(c, &c->now, &loop->head);
    c->number = loop->number;
    c->line = 0;
}

/* The effect of the operation itself, apart from its code. */
static void run_meaning(struct check *c)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
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
    c->wrong = c->again = false;
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
    for (c.number = 1; c.number < c.ir->count && !c.wrong; c.number++) {
        placement_run_code(&c);
        expect_operands(&c);
        expect_result(&c);
        if (!c.wrong)
            run_meaning(&c);
    }
    finish(&c);
    return c.wrong ? c.text : NULL;
}
