/* The text of the programs in the staged language. A file includes a binding first. */
#ifndef TESTS_SUPPORT_CONTROL_NEST_TEXT_H
#define TESTS_SUPPORT_CONTROL_NEST_TEXT_H

#include "contract/control.h"
#include "nest.h"

/* Variables: the data, then those of each node. */
enum { NODE_COUNT = CONTROL_VARIABLES, NODE_LIMIT, NODE_VARIABLES };

static int variable_of(unsigned number)
{
    return NEST_DATA + (int)number * NODE_VARIABLES;
}

/* The surroundings of a list: the loop or flow around it, and the lanes that began it. */
struct place {
    const struct nest *nest;
    int around; /* its first variable; -1: none */
    msk began;
};

static void text_list(struct env *e, const struct place *place, unsigned number);

static msk lanes_at(struct env *e, const struct place *place)
{
    if (place->around < 0)
        return place->began;
    msk lanes = LANES(E, place->around);
    return and_m(E, place->began, lanes);
}

static msk text_holds(struct env *e, const struct place *place, const struct nest_node *node)
{
    msk lanes = lanes_at(E, place);
    itg datum = get_i(E, node->data);
    itg bits = and_i(E, datum, lit_i(E, node->number));
    msk holds = eq_i(E, bits, lit_i(E, 0));
    return and_m(E, lanes, holds);
}

static void text_step(struct env *e, const struct place *place, const struct nest_node *node)
{
    itg datum = get_i(E, node->data), other = get_i(E, (node->data + 1) % NEST_DATA);
    itg triple = mul_i(E, datum, lit_i(E, 3));
    itg sum = add_i(E, triple, lit_i(E, node->number));
    itg mixed = xor_i(E, sum, other);
    msk lanes = lanes_at(E, place);
    assign_i(E, node->data, lanes, mixed);
}

/* The lanes that have passes left. */
static msk text_more(struct env *e, int variable)
{
    itg count = get_i(E, variable + NODE_COUNT), limit = get_i(E, variable + NODE_LIMIT);
    return gt_i(E, limit, count);
}

static msk text_first(struct env *e, int variable, msk lanes)
{
    msk more = text_more(E, variable);
    return and_m(E, lanes, more);
}

static void count_pass(struct env *e, int variable)
{
    itg count = get_i(E, variable + NODE_COUNT);
    itg more = add_i(E, count, lit_i(E, 1));
    msk lanes = LANES(E, variable);
    assign_i(E, variable + NODE_COUNT, lanes, more);
}

static void text_while(struct env *e, const struct place *place, unsigned number)
{
    const struct nest_node *node = &place->nest->node[number];
    int variable = variable_of(number);
    msk lanes = lanes_at(E, place);
    itg datum = get_i(E, node->data);
    itg limit = and_i(E, datum, lit_i(E, 3));
    set_i(E, variable + NODE_COUNT, lit_i(E, 0));
    set_i(E, variable + NODE_LIMIT, limit);
    WHILE(E, variable, text_first(E, variable, lanes))
    {
        count_pass(E, variable);
        struct place inside = {place->nest, variable, LANES(E, variable)};
        text_list(E, &inside, node->body[0]);
    }
}

/* A block that is entered too often does nothing. */
static void text_block(struct env *e, const struct place *place, unsigned number, int block)
{
    int variable = variable_of(number);
    LABEL(E, variable, block)
    {
        msk more = text_more(E, variable);
        count_pass(E, variable);
        msk lanes = LANES(E, variable);
        struct place inside = {place->nest, variable, and_m(E, lanes, more)};
        text_list(E, &inside, place->nest->node[number].body[block]);
    }
}

static void text_flow(struct env *e, const struct place *place, unsigned number)
{
    int variable = variable_of(number);
    msk lanes = lanes_at(E, place);
    set_i(E, variable + NODE_COUNT, lit_i(E, 0));
    set_i(E, variable + NODE_LIMIT, lit_i(E, 2 * NEST_BLOCKS));
    FLOW(E, variable, lanes, NEST_BLOCKS)
    {
        for (int block = 0; block < NEST_BLOCKS; block++)
            text_block(E, place, number, block);
    }
}

static void text_node(struct env *e, const struct place *place, unsigned number)
{
    const struct nest_node *node = &place->nest->node[number];
    struct place inside = *place;
    switch ((enum nest_kind)node->kind) {
    case NEST_IF:
        inside.began = text_holds(E, place, node);
        WHEN (E, inside.began) {
            text_list(E, &inside, node->body[0]);
        }
        break;
    case NEST_WHILE: text_while(E, place, number); break;
    case NEST_FLOW: text_flow(E, place, number); break;
    case NEST_BREAK: BREAK(E, place->around, text_holds(E, place, node)); break;
    case NEST_CONTINUE: CONTINUE(E, place->around, text_holds(E, place, node)); break;
    case NEST_GOTO: GOTO(E, place->around, node->block, text_holds(E, place, node)); break;
    case NEST_STEP: text_step(E, place, node); break;
    case NEST_KINDS: break;
    }
}

/* After a statement that lanes leave, the rest is skipped if none is left. */
static void text_list(struct env *e, const struct place *place, unsigned number)
{
    if (!number)
        return;
    const struct nest_node *node = &place->nest->node[number];
    text_node(E, place, number);
    if (node->kind != NEST_BREAK && node->kind != NEST_CONTINUE && node->kind != NEST_GOTO)
        text_list(E, place, node->next);
    else
        REST(E, place->around)
    text_list(E, place, node->next);
}

static void nest_text(struct env *e, const struct nest *nest)
{
    struct place place = {nest, -1, lit_m(E, -1)};
    for (int d = 0; d < NEST_DATA; d++) {
        itg datum = load_i(E, BASE_INPUT, d * NEST_LANES * 4);
        set_i(E, d, datum);
    }
    text_list(E, &place, nest->nodes > 1);
    for (int d = 0; d < NEST_DATA; d++) {
        itg datum = get_i(E, d);
        store_i(E, BASE_OUTPUT, d * VERTEX_SLOT_BYTES, datum);
    }
}

#endif
