#include "placement_part.h"

#include <stdlib.h>

/* --- The code of an operation -------------------------------------------------------------------------- */

/* Jumps to the current position end here. */
static void arrive(struct check *c)
{
    for (unsigned n = 0; n < LOCAL_JUMPS; n++) {
        if (!c->local[n].reached || c->local_to[n] != c->offset)
            continue;
        places_merge(c, &c->now, &c->local[n]);
        c->local[n].reached = false;
    }
}

static void run_range(struct check *c, size_t end);

/* The end of the code of this operation that begins at an offset after the routine; 0: none does. */
static size_t end_outside(const struct check *c, size_t begin)
{
    for (uint32_t n = c->line + 1; n < c->m->lines; n++)
        if (c->m->line[n].offset == begin && c->m->line[n].instruction == c->number)
            return n + 1 < c->m->lines ? c->m->line[n + 1].offset : c->m->code_bytes;
    return 0;
}

static bool has_other_ways(const struct ir_instruction *i)
{
    return i->op == IR_near || i->op == IR_stretch;
}

/* The other ways of a hint of the pass near, or of texels of the pass stretch, are after the routine. They
 * begin with the state of the jump there, and end with jumps back. */
static void run_outside(struct check *c)
{
    struct places inside = {0};
    const size_t back = c->offset;
    for (unsigned n = 0; n < LOCAL_JUMPS && has_other_ways(placement_operation(c, c->number)); n++) {
        size_t begin = c->local_to[n], end = c->local[n].reached ? end_outside(c, begin) : 0;
        if (!end)
            continue;
        places_copy(c, &inside, &c->now);
        places_copy(c, &c->now, &c->local[n]);
        c->local[n].reached = false;
        c->offset = begin;
        run_range(c, end);
        if (c->now.reached)
            placement_wrong(c, "does not jump back");
        places_copy(c, &c->now, &inside);
        c->offset = back;
    }
    free(inside.at);
}

static void run_range(struct check *c, size_t end)
{
    for (size_t next; c->offset < end && !c->wrong; c->offset = next) {
        arrive(c);
        if (!ZYAN_SUCCESS(ZydisDecoderDecodeFull(&c->decoder, c->m->code + c->offset, end - c->offset,
                                                 &c->instruction, c->operand))) {
            placement_wrong(c, "is not an instruction");
            return;
        }
        next = c->offset + c->instruction.length;
        if (c->now.reached)
            placement_run_instruction(c);
        else
            placement_wrong(c, "cannot be reached");
        run_outside(c);
    }
}

/* The ends of the loops of the span reading, and of the parts of a program, belong to the frame. */
static bool is_of_frame(const struct ir_instruction *i)
{
    return i->op == IR_rest || ((i->op == IR_loop || i->op == IR_again) && i->k != IR_LOOP_LANES);
}

/* Code of the frame uses scratch registers, and changes the base registers, except that of the job. A
 * location that was loaded from there still contains the value, but is not known as that word of memory any
 * more. */
static void run_frame(struct check *c)
{
    static const uint8_t scratch[] = {SCRATCH_FIRST, SCRATCH_SECOND, SCRATCH_RESULT};
    for (unsigned n = 0; n < sizeof scratch; n++)
        c->now.at[scratch[n]] = (struct content){.origin = FROM_ELSEWHERE};
    for (unsigned p = 0; p < c->places; p++) {
        struct content *at = &c->now.at[p];
        if ((at->origin == FROM_WORD || at->origin == FROM_LANES) && at->base != emit_base_register[BASE_JOB])
            at->origin = FROM_NOTHING;
    }
}

static bool is_kept(const struct check *c, uint32_t line)
{
    return c->b->allocation.residence[c->m->line[line].instruction] == RESIDENCE_KEPT;
}

void placement_run_kept(struct check *c)
{
    const uint32_t number = c->number;
    for (uint32_t line = 0; line + 1 < c->m->lines && !c->wrong; line++) {
        if (!is_kept(c, line))
            continue;
        c->visit++;
        c->number = c->m->line[line].instruction;
        c->offset = c->m->line[line].offset;
        run_range(c, c->m->line[line + 1].offset);
    }
    c->number = number;
}

/* The code that was selected for the current operation, if any. */
void placement_run_code(struct check *c)
{
    c->visit++;
    c->coded = c->called = false;
    c->read = c->stores = 0;
    c->job = 0;
    if (is_of_frame(placement_operation(c, c->number))) {
        run_frame(c);
        return;
    }
    while (c->line < c->m->lines && (c->m->line[c->line].instruction < c->number || is_kept(c, c->line)))
        c->line++;
    if (c->line + 1 >= c->m->lines || c->m->line[c->line].instruction != c->number)
        return;
    size_t end = c->m->line[c->line + 1].offset;
    c->coded = !placement_covers(placement_operation(c, c->number)) || end > c->m->line[c->line].offset;
    c->offset = c->m->line[c->line].offset;
    run_range(c, end);
    arrive(c);
    if (placement_operation(c, c->number)->op == IR_call)
        placement_end_call(c);
    for (unsigned n = 0; n < LOCAL_JUMPS; n++)
        if (c->local[n].reached)
            placement_wrong(c, "jumps out of its code");
}
