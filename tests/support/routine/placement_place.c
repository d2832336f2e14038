#include "placement_part.h"

#include <stdlib.h>
#include <string.h>

/* --- What a place holds ------------------------------------------------------------------------------ */

static bool contains(const struct content *p, unsigned value)
{
    for (unsigned n = 0; n < p->count; n++)
        if (p->value[n] == value)
            return true;
    return false;
}

/* All variables may begin as one value. A full set drops its oldest value, because the latest is the one
 * that is needed. */
void place_add(struct content *p, unsigned value)
{
    if (contains(p, value))
        return;
    if (p->count == SET)
        memmove(p->value, p->value + 1, --p->count * sizeof p->value[0]);
    p->value[p->count++] = (uint16_t)value;
}

/* The used part of a set. Most sets are small. */
void place_assign(struct content *to, const struct content *from)
{
    memcpy(to, from, offsetof(struct content, value) + from->count * sizeof from->value[0]);
}

static void remove_value(struct content *p, unsigned value)
{
    for (unsigned n = 0; n < p->count; n++)
        if (p->value[n] == value)
            p->value[n--] = p->value[--p->count];
}

/* Returns true for a read of the word of a slot of the constant table: one that only the preamble uses. */
static bool reads_constant(const struct check *c, const struct ir_instruction *i, unsigned slot)
{
    const struct ir_constant *constant = &c->ir->constant[slot];
    return i->op == IR_uniform && i->base == constant->base && i->k == constant->offset;
}

/* Returns true if a location that was loaded from an address contains a value that can be read there. */
static bool comes_from(const struct check *c, const struct content *p, const struct ir_instruction *i)
{
    bool word = i->op == IR_uniform || (emit_is_scalar(c->m) && i->op == IR_load);
    switch (p->origin) {
    case FROM_LITERAL: return i->op == IR_literal && i->k == p->number;
    case FROM_CONSTANT:
        return (i->op == IR_constant && i->k == p->number) || reads_constant(c, i, (unsigned)p->number);
    case FROM_WORD:
        if (i->op == IR_constant)
            return emit_base_register[c->ir->constant[i->k].base] == p->base &&
                   c->ir->constant[i->k].offset == p->number;
        return word && emit_base_register[i->base] == p->base && i->k == p->number;
    case FROM_LANES: return i->op == IR_load && emit_base_register[i->base] == p->base && i->k == p->number;
    case FROM_VARIABLE:
        return (i->op == IR_get || i->op == IR_take) && placement_variable(c, i) == p->number &&
               i == placement_operation(c, c->number);
    }
    return false;
}

/* Returns true if a value can be read again. Only the operation itself can read memory that routines
 * write. */
bool place_lasts(const struct ir_instruction *i)
{
    return allocate_is_constant(i) || ir_is_invariant_read(i);
}

bool place_holds(const struct check *c, const struct content *p, unsigned value)
{
    const struct ir_instruction *i = placement_operation(c, value);
    if (contains(p, value))
        return true;
    if (i->op == IR_copy && allocate_is_constant(placement_operation(c, i->operand[0])))
        i = placement_operation(c, i->operand[0]);
    return (place_lasts(i) || value == c->number) && comes_from(c, p, i);
}

/* Records the operands of the operation that are read here. Returns true if any is. */
bool place_note_operands(struct check *c, const struct content *p)
{
    bool any = false;
    for (int o = 0; o < placement_operands(c); o++)
        if (place_holds(c, p, placement_operand(c, o))) {
            c->read |= 1u << o;
            any = true;
        }
    return any;
}

/* Values that an operation loads itself: literals, the words of a reciprocal's plane. */
static bool is_own(const struct ir_instruction *i, const struct content *p)
{
    bool word = p->origin == FROM_WORD || p->origin == FROM_LANES;
    if (i->op == IR_reciprocal && word && p->base == emit_base_register[i->base])
        return p->number >= i->k && p->number < i->k + (int32_t)sizeof(struct plane);
    if (p->origin != FROM_LITERAL)
        return false;
    if (i->op == IR_upper_i)
        return p->number == (int32_t)ir_evaluate(IR_upper_i, 0x03020100, 0, 0, 0);
    if (i->op == IR_rotl_i)
        return p->number == (int32_t)ir_evaluate(IR_rotl_i, 0x03020100, 0, 0, i->k);
    return i->op == IR_window || i->op == IR_near_column || i->op == IR_reciprocal ||
           (i->op == IR_neg_f && p->number == INT32_MIN);
}

void place_expect(struct check *c, const struct content *p, const char *where, long number)
{
    const struct ir_instruction *i = placement_operation(c, c->number);
    bool own = is_own(i, p);
    if (place_note_operands(c, p) || own || p->made_in == c->visit)
        return;
    if (p->count)
        placement_wrong(c, "reads %s %ld, which holds %%%u", where, number, p->value[p->count - 1]);
    else
        placement_wrong(c, "reads %s %ld, which holds no operand", where, number);
}

/* --- States ------------------------------------------------------------------------------------------ */

void places_copy(const struct check *c, struct places *to, const struct places *from)
{
    if (!to->at)
        to->at = malloc(c->places * sizeof *to->at);
    if (!to->at)
        abort();
    to->reached = from->reached;
    for (unsigned p = 0; p < c->places; p++)
        place_assign(&to->at[p], &from->at[p]);
}

/* Keeps the values that both states have. Returns true if any value was removed. */
static bool intersect(struct content *p, const struct content *other)
{
    unsigned kept = 0;
    bool changed =
        p->origin && (p->origin != other->origin || p->base != other->base || p->number != other->number);
    if (changed)
        p->origin = FROM_NOTHING;
    for (unsigned n = 0; n < p->count; n++)
        if (contains(other, p->value[n]) && p->bits == other->bits)
            p->value[kept++] = p->value[n];
    changed |= kept != p->count;
    p->count = (uint16_t)kept;
    p->made_in = p->made_in == other->made_in ? p->made_in : 0;
    return changed;
}

bool places_merge(const struct check *c, struct places *to, const struct places *from)
{
    bool changed = false;
    if (!from->reached)
        return false;
    if (!to->reached) {
        places_copy(c, to, from);
        return true;
    }
    for (unsigned p = 0; p < c->places; p++)
        changed |= intersect(&to->at[p], &from->at[p]);
    return changed;
}

/* From now on, every location that contains `source` also contains `name`. */
void places_rename(struct check *c, struct places *s, unsigned name, unsigned source)
{
    for (unsigned p = 0; p < c->places; p++)
        if (place_holds(c, &s->at[p], source))
            place_add(&s->at[p], name);
}

void places_name_joins(struct check *c, struct places *s, uint32_t end, int operand)
{
    for (uint32_t n = end + 1; n < c->ir->count && placement_operation(c, n)->op == IR_join; n++)
        places_rename(c, s, n, placement_operation(c, n)->operand[operand]);
}

/* All phis of the loop that ends here become their next values simultaneously. */
void places_name_next(struct check *c, struct places *s)
{
    for (unsigned p = 0; p < c->places; p++) {
        struct content before, *after = &s->at[p];
        place_assign(&before, after);
        for (uint32_t n = c->number - 1; placement_operation(c, n)->op == IR_next; n--)
            remove_value(after, placement_operation(c, n)->operand[0]);
        for (uint32_t n = c->number - 1; placement_operation(c, n)->op == IR_next; n--)
            if (place_holds(c, &before, placement_operation(c, n)->operand[1]))
                place_add(after, placement_operation(c, n)->operand[0]);
    }
}
