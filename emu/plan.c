/* Planning: what is live, how long, in which row; then a step for each instruction that is left.
 *
 * Liveness does not follow the flow: a `set` is live when its variable is read anywhere. Copies are other
 * names of the same row, and loops and ends take no time. Nothing else is done to the recording: the
 * specializer's passes have no part in this engine, which makes it the judge of whether the recording or the
 * code made from it is wrong. */
#include "emu/plan.h"

#include <stdlib.h>
#include <string.h>

enum place { PLACE_NONE, PLACE_LITERAL, PLACE_GROUP, PLACE_ROW };

/* What is known of an instruction. Positions are instruction numbers. */
struct note {
    uint16_t root;  /* of a value: the one whose row it has */
    uint16_t last;  /* of a root: the position of its last use */
    uint16_t ends;  /* of a position: the first root whose last use it is */
    uint16_t next;  /* of a root: the next such one; of a set: the next set of the same variable */
    uint16_t match; /* of a region's beginning: its end, and the reverse */
    uint16_t outer; /* of a loop: the loop that it is in, or 0 */
    uint8_t live;
    uint8_t place; /* of a root */
    uint32_t slot; /* of a root: the number in its place; of a region's beginning: of the step behind */
};

/* Numbers of one kind of place: as few as are needed at once. */
struct pool {
    uint32_t count, free_count;
    uint32_t *free;
};

struct planner {
    const struct ir *ir;
    struct note *note;
    uint16_t *work; /* instructions whose operands are to be marked; open regions */
    uint16_t sets[VARIABLES];
    uint16_t variable[VARIABLES]; /* 1 + the row of each that is live */
    struct pool groups, rows;
    uint16_t *literal_table; /* 1 + the number of the literal, hashed by bits */
    uint32_t literal_mask;
    int32_t *literal;
    uint32_t literals;
};

/* The bases that are one address in all groups of any batch. */
static int is_common(enum base base)
{
    return base == BASE_JOB || base == BASE_VERTICES || base == BASE_CONSTANT;
}

static int is_value(const struct ir_instruction *i)
{
    return i->type && i->op != IR_set;
}

static int has_step(const struct ir_instruction *i)
{
    return i->op != IR_nop && i->op != IR_copy && i->op != IR_literal && i->op != IR_end && i->op != IR_loop;
}

/* --- What is live ----------------------------------------------------------------------------------------- */

static int has_effect(const struct ir_instruction *i)
{
    int properties = ir_op_information[i->op].properties;
    return properties & IR_EFFECT && i->op != IR_set;
}

static uint32_t mark(struct planner *p, uint32_t work, uint16_t number)
{
    if (!p->note[number].live) {
        p->note[number].live = 1;
        p->work[work++] = number;
    }
    return work;
}

static void mark_live(struct planner *p)
{
    uint32_t work = 0;
    for (uint32_t number = 1; number < p->ir->count; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        if (i->op == IR_set) {
            p->note[number].next = p->sets[i->k];
            p->sets[i->k] = (uint16_t)number;
        }
        if (has_effect(i))
            work = mark(p, work, (uint16_t)number);
    }
    while (work) {
        const struct ir_instruction *i = &p->ir->instruction[p->work[--work]];
        for (int o = 0; o < ir_op_information[i->op].operands; o++)
            work = mark(p, work, i->operand[o]);
        if (i->op == IR_get)
            for (uint16_t set = p->sets[i->k]; set; set = p->note[set].next)
                work = mark(p, work, set);
    }
}

/* --- How long --------------------------------------------------------------------------------------------- */

static void match_regions(struct planner *p)
{
    uint32_t open = 0;
    uint16_t loop = 0;
    for (uint32_t number = 1; number < p->ir->count; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        struct note *note = &p->note[number];
        if (ir_op_information[i->op].properties & IR_OPENS)
            p->work[open++] = (uint16_t)number;
        if (i->op == IR_loop) {
            note->outer = loop;
            loop = (uint16_t)number;
        }
        if (!(ir_op_information[i->op].properties & IR_CLOSES))
            continue;
        note->match = p->work[--open];
        p->note[note->match].match = (uint16_t)number;
        if (i->op == IR_again)
            loop = p->note[loop].outer;
    }
}

/* A use inside of loops that begin behind the value lasts until the outermost of them ends. */
static uint16_t last_use(const struct planner *p, uint16_t value, uint16_t position, uint16_t loop)
{
    for (; loop > value; loop = p->note[loop].outer)
        position = p->note[loop].match;
    return position;
}

static void find_last_uses(struct planner *p)
{
    uint16_t loop = 0;
    for (uint32_t number = 1; number < p->ir->count; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        struct note *note = &p->note[number];
        if (!note->live)
            continue;
        note->root = i->op == IR_copy ? p->note[i->operand[0]].root : (uint16_t)number;
        if (i->op == IR_loop)
            loop = (uint16_t)number;
        for (int o = 0; o < ir_op_information[i->op].operands; o++) {
            uint16_t root = p->note[i->operand[o]].root;
            uint16_t last = last_use(p, root, (uint16_t)number, loop);
            if (last > p->note[root].last)
                p->note[root].last = last;
        }
        if (i->op == IR_again)
            loop = p->note[loop].outer;
    }
}

/* --- In which row ----------------------------------------------------------------------------------------- */

static int is_once(const struct planner *p, const struct ir_instruction *i)
{
    int reads = ir_op_information[i->op].properties & IR_READS;
    if (i->op == IR_load || i->op == IR_get || (reads && !is_common(i->base)))
        return 0;
    for (int o = 0; o < ir_op_information[i->op].operands; o++)
        if (p->note[p->note[i->operand[o]].root].place == PLACE_ROW)
            return 0;
    return 1;
}

static uint32_t pool_take(struct pool *pool)
{
    return pool->free_count ? pool->free[--pool->free_count] : pool->count++;
}

static uint32_t literal_number(struct planner *p, int32_t bits)
{
    uint32_t slot = (uint32_t)bits * 0x9e3779b1u >> 12 & p->literal_mask;
    for (; p->literal_table[slot]; slot = (slot + 1) & p->literal_mask)
        if (p->literal[p->literal_table[slot] - 1] == bits)
            return p->literal_table[slot] - 1u;
    p->literal[p->literals] = bits;
    p->literal_table[slot] = (uint16_t)++p->literals;
    return p->literals - 1;
}

static void place_value(struct planner *p, uint16_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    struct note *note = &p->note[number];
    if (i->op == IR_literal) {
        note->place = PLACE_LITERAL;
        note->slot = literal_number(p, i->k);
        return;
    }
    note->place = is_once(p, i) ? PLACE_GROUP : PLACE_ROW;
    note->slot = pool_take(note->place == PLACE_ROW ? &p->rows : &p->groups);
    note->next = p->note[note->last].ends;
    p->note[note->last].ends = number;
}

static void release_values(struct planner *p, uint16_t position)
{
    for (uint16_t value = p->note[position].ends; value; value = p->note[value].next) {
        struct pool *pool = p->note[value].place == PLACE_ROW ? &p->rows : &p->groups;
        pool->free[pool->free_count++] = p->note[value].slot;
    }
}

static void place_values(struct planner *p)
{
    for (uint32_t number = 1; number < p->ir->count; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        if (!p->note[number].live)
            continue;
        if (i->op == IR_get && !p->variable[i->k])
            p->variable[i->k] = (uint16_t)(1 + p->rows.count++);
    }
    for (uint32_t number = 1; number < p->ir->count; number++) {
        release_values(p, (uint16_t)number);
        if (p->note[number].live && is_value(&p->ir->instruction[number]) && p->note[number].root == number)
            place_value(p, (uint16_t)number);
    }
}

/* --- Steps ------------------------------------------------------------------------------------------------ */

/* Offsets in a frame of one number of lanes. */
struct layout {
    uint32_t groups, rows; /* where they begin */
    uint32_t row_bytes;
    uint32_t bytes;
};

static struct layout lay_out(const struct planner *p, unsigned lanes)
{
    struct layout layout = {.groups = p->literals * GROUP_BYTES, .row_bytes = lanes * 4};
    layout.rows = (layout.groups + p->groups.count * GROUP_BYTES + 63) & ~63u;
    layout.bytes = (layout.rows + p->rows.count * layout.row_bytes + 63) & ~63u;
    return layout;
}

static uint32_t value_offset(const struct planner *p, const struct layout *layout, uint16_t value)
{
    const struct note *root = &p->note[p->note[value].root];
    switch (root->place) {
    case PLACE_LITERAL: return root->slot * GROUP_BYTES;
    case PLACE_GROUP: return layout->groups + root->slot * GROUP_BYTES;
    default: return layout->rows + root->slot * layout->row_bytes;
    }
}

static uint32_t variable_offset(const struct planner *p, const struct layout *layout, int32_t variable)
{
    return layout->rows + (p->variable[variable] - 1u) * layout->row_bytes;
}

static struct plan_step make_step(const struct planner *p, const struct layout *layout, uint16_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    struct plan_step step = {
        .run = plan_step_of(i->op), .base = i->base, .scale = i->scale, .k = i->k, .field = i->field};
    for (int o = 0; o < ir_op_information[i->op].operands; o++) {
        step.operand[o] = value_offset(p, layout, i->operand[o]);
        step.stride[o] = p->note[p->note[i->operand[o]].root].place == PLACE_ROW ? GROUP_BYTES : 0;
    }
    if (is_value(i)) {
        step.to = value_offset(p, layout, number);
        step.once = p->note[number].place == PLACE_GROUP;
    }
    if (i->op == IR_set)
        step.to = variable_offset(p, layout, i->k);
    if (i->op == IR_get) {
        step.operand[0] = variable_offset(p, layout, i->k);
        step.stride[0] = GROUP_BYTES;
    }
    return step;
}

static void make_steps(struct planner *p, const struct layout *layout, struct plan *plan)
{
    for (uint32_t number = 1; number < p->ir->count; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        const struct note *note = &p->note[number];
        if (!note->live)
            continue;
        if (ir_op_information[i->op].properties & IR_OPENS)
            p->note[number].slot = plan->count;
        struct plan_step *step = &plan->step[plan->count];
        if (has_step(i)) {
            *step = make_step(p, layout, (uint16_t)number);
            plan->count++;
        }
        if (i->op == IR_again)
            step->k = (int32_t)(step - (plan->step + p->note[note->match].slot));
        if (i->op == IR_end) {
            struct plan_step *when = plan->step + p->note[note->match].slot;
            when->k = (int32_t)(step - when);
        }
        if (i->op == IR_store && i->base == BASE_LANES)
            plan->counts = 1;
    }
    plan->step[plan->count++] = (struct plan_step){.run = plan_step_end};
}

static struct plan *make_plan(struct planner *p, unsigned lanes)
{
    struct layout layout = lay_out(p, lanes);
    while (layout.bytes > FRAME_LIMIT && lanes > GROUP_LANES)
        layout = lay_out(p, lanes /= 2);
    uint32_t steps = 1;
    for (uint32_t number = 1; number < p->ir->count; number++)
        steps += p->note[number].live && has_step(&p->ir->instruction[number]);
    struct plan *plan = malloc(sizeof *plan + steps * sizeof *plan->step + p->literals * sizeof(int32_t));
    if (!plan)
        return NULL;
    *plan = (struct plan){.lanes = lanes, .frame_bytes = layout.bytes, .literals = p->literals};
    make_steps(p, &layout, plan);
    plan->literal = (int32_t *)(void *)(plan->step + plan->count);
    memcpy(plan->literal, p->literal, p->literals * sizeof(int32_t));
    return plan;
}

static int planner_open(struct planner *p, const struct ir *ir)
{
    uint32_t table = 16;
    while (table < 2 * ir->count)
        table *= 2;
    p->ir = ir;
    p->literal_mask = table - 1;
    p->note = calloc(ir->count, sizeof *p->note);
    p->work = malloc(ir->count * sizeof *p->work);
    p->groups.free = malloc(ir->count * sizeof *p->groups.free);
    p->rows.free = malloc(ir->count * sizeof *p->rows.free);
    p->literal = malloc(ir->count * sizeof *p->literal);
    p->literal_table = calloc(table, sizeof *p->literal_table);
    return p->note && p->work && p->groups.free && p->rows.free && p->literal && p->literal_table ? 0 : -1;
}

static void planner_close(struct planner *p)
{
    free(p->note);
    free(p->work);
    free(p->groups.free);
    free(p->rows.free);
    free(p->literal);
    free(p->literal_table);
}

struct plan *plan_create(const struct ir *ir, unsigned lanes, struct error *error)
{
    struct planner p = {0};
    struct plan *plan = NULL;
    if (!planner_open(&p, ir)) {
        mark_live(&p);
        match_regions(&p);
        find_last_uses(&p);
        place_values(&p);
        plan = make_plan(&p, lanes);
    }
    planner_close(&p);
    if (!plan)
        error_set(error, "out of memory for a plan of %u operations", ir->count - 1);
    return plan;
}

void plan_free(struct plan *plan)
{
    free(plan);
}

void plan_start(const struct plan *plan, uint8_t *frame)
{
    for (uint32_t i = 0; i < plan->literals; i++) {
        int32_t group[GROUP_LANES];
        for (int lane = 0; lane < GROUP_LANES; lane++)
            group[lane] = plan->literal[i];
        memcpy(frame + i * GROUP_BYTES, group, sizeof group);
    }
}
