/* Control of lanes, in the staged language: loops and jumps for each lane by itself. They are made of WHEN,
 * LOOP and variables, so every binding has them (language.h includes this file).
 *
 *   WHILE (E, first, condition) { }   while the condition holds in a lane; evaluated before each pass
 *   BREAK (E, first, lanes)           these lanes leave the loop
 *   CONTINUE (E, first, lanes)        these lanes leave the pass
 *
 *   FLOW (E, first, lanes, count) { LABEL (E, first, 0) { } ... LABEL (E, first, count - 1) { } }
 *                                     each lane executes the blocks in order, from block 0 on
 *   GOTO (E, first, block, lanes)     these lanes leave the block for another; at `count` they end
 *
 *   LANES (E, first)                  the lanes that execute now, in the loop or block
 *   REST (E, first) { }               the rest of a body, skipped if no lane executes it any more
 *
 * `first` is the number of the first of three variables, which belong to the construct: VARIABLES are there,
 * and constructs that are nested have different ones. The first condition includes the lanes that execute
 * around the loop. A body has values of lanes that do not execute: it changes variables in LANES only, with
 * assign_f, assign_i or a mask of its own. The host's `break` and `continue` do not leave a body. */
#ifndef CONTRACT_CONTROL_H
#define CONTRACT_CONTROL_H

#include "contract/language.h"

/* The variables of a construct: WHILE has the lanes that repeat; FLOW the block that each lane executes next,
 * and the lanes that have one. */
enum { CONTROL_LANES, CONTROL_LIVE, CONTROL_LABEL, CONTROL_VARIABLES };

static inline msk control_lanes(struct env *e, int first)
{
    return get_m(E, first + CONTROL_LANES);
}

static inline void control_leave(struct env *e, int variable, msk lanes)
{
    msk before = get_m(E, variable);
    msk after = andn_m(E, before, lanes);
    set_m(E, variable, after);
}

static inline void control_begin(struct env *e, int first, msk lanes)
{
    set_m(E, first + CONTROL_LIVE, lanes);
    set_m(E, first + CONTROL_LANES, lanes);
}

static inline void control_begin_pass(struct env *e, int first)
{
    msk live = get_m(E, first + CONTROL_LIVE);
    set_m(E, first + CONTROL_LANES, live);
}

static inline void control_end_pass(struct env *e, int first, msk condition)
{
    msk live = get_m(E, first + CONTROL_LIVE);
    msk more = and_m(E, live, condition);
    set_m(E, first + CONTROL_LIVE, more);
}

static inline void control_break(struct env *e, int first, msk lanes)
{
    msk executing = get_m(E, first + CONTROL_LANES);
    msk leaving = and_m(E, executing, lanes);
    control_leave(E, first + CONTROL_LIVE, leaving);
    control_leave(E, first + CONTROL_LANES, leaving);
}

static inline void control_begin_flow(struct env *e, int first, msk lanes)
{
    set_i(E, first + CONTROL_LABEL, lit_i(E, 0));
    control_begin(E, first, lanes);
}

/* The lanes whose next block this is. Unless they jump, they continue with the block after it. */
static inline msk control_begin_block(struct env *e, int first, int block)
{
    itg label = get_i(E, first + CONTROL_LABEL);
    msk live = get_m(E, first + CONTROL_LIVE);
    msk here = eq_i(E, label, lit_i(E, block));
    msk lanes = and_m(E, live, here);
    itg next = select_i(E, lanes, lit_i(E, block + 1), label);
    set_i(E, first + CONTROL_LABEL, next);
    set_m(E, first + CONTROL_LANES, lanes);
    return lanes;
}

static inline void control_goto(struct env *e, int first, int block, msk lanes)
{
    itg label = get_i(E, first + CONTROL_LABEL);
    msk executing = get_m(E, first + CONTROL_LANES);
    msk leaving = and_m(E, executing, lanes);
    itg next = select_i(E, leaving, lit_i(E, block), label);
    set_i(E, first + CONTROL_LABEL, next);
    control_leave(E, first + CONTROL_LANES, leaving);
}

static inline msk control_has_block(struct env *e, int first, int count)
{
    itg label = get_i(E, first + CONTROL_LABEL);
    return gt_i(E, lit_i(E, count), label);
}

/* A variable gets a value in some lanes. */
static inline void assign_f(struct env *e, int variable, msk lanes, flt value)
{
    flt before = get_f(E, variable);
    flt after = select_f(E, lanes, value, before);
    set_f(E, variable, after);
}

static inline void assign_i(struct env *e, int variable, msk lanes, itg value)
{
    itg before = get_i(E, variable);
    itg after = select_i(E, lanes, value, before);
    set_i(E, variable, after);
}

#define LANES(e, first) control_lanes(e, first)
#define REST(e, first)  WHEN (e, control_lanes(e, first))

/* A host's loop of one pass: `begin` before its body, `end` after it. */
#define CONTROL_AROUND(name, begin, end) for (int name = ((begin), 1); name; name = ((end), 0))

#define CONTROL_REPEAT(e, first, condition)                                                                  \
    REST(e, first)                                                                                           \
    LOOP(e, (first) + CONTROL_LIVE)                                                                          \
    CONTROL_AROUND(pass_, control_begin_pass(e, first), control_end_pass(e, first, condition))

#define WHILE(e, first, condition)                                                                           \
    CONTROL_AROUND(while_, control_begin(e, first, condition), (void)0)                                      \
    CONTROL_REPEAT(e, first, condition)

#define BREAK(e, first, lanes)    control_break(e, first, lanes)
#define CONTINUE(e, first, lanes) control_leave(e, (first) + CONTROL_LANES, lanes)

#define FLOW(e, first, lanes, count)                                                                         \
    CONTROL_AROUND(flow_, control_begin_flow(e, first, lanes), (void)0)                                      \
    CONTROL_REPEAT(e, first, control_has_block(e, first, count))

#define LABEL(e, first, block)       WHEN (e, control_begin_block(e, first, block))
#define GOTO(e, first, block, lanes) control_goto(e, first, block, lanes)

#endif
