/* Scheduling: find the live instructions, their lifetimes and their rows; then make a step for each live
 * instruction.
 *
 * Liveness ignores control flow: a `set` is live when its variable is read anywhere. A copy shares the row of
 * its source, and loops and ends need no step. The recording is not changed otherwise. The specializer's
 * passes are not used, so this engine shows whether a wrong result comes from the recording or from the code
 * generated from it. */
#include "emu/batch/schedule.h"

#include "base/hash.h"

#include <stdlib.h>
#include <string.h>

enum location { LOCATION_NONE, LOCATION_LITERAL, LOCATION_GROUP, LOCATION_ROW };

/* Facts about an instruction, by its number. A root is a value with a row of its own. */
struct note {
    uint16_t root; /* of a value: the root that it shares a row with */
    uint16_t last; /* of a root: the instruction of its last use */
    uint16_t ends; /* the first root whose last use is this instruction */
    uint16_t
        next; /* of a root: the next root with the same last use; of a set: the next set of its variable */
    uint16_t match;    /* of a region's begin: its end; of its end: the begin */
    uint16_t outer;    /* of a loop: the loop around it, or 0 */
    uint16_t pair;     /* of an operation of a pair: the other one, or 0 */
    uint16_t region;   /* the innermost region's begin, or 0 */
    uint16_t uses;     /* of a root: by live instructions */
    bool live, varies; /* varies: the value can differ between lanes */
    uint8_t location;  /* of a root */
    uint32_t
        slot; /* of a root: its number among those of its location; of a region's begin: its first step */
};

/* The numbers of one kind of location. Released numbers are reused. */
struct numbers {
    uint32_t count, free_count;
    uint32_t *free;
};

struct scheduler {
    const struct ir *ir;
    struct note *note;
    uint16_t *work; /* a stack of instructions whose operands must be marked, or of open regions */
    uint16_t sets[VARIABLES];
    uint16_t variable[VARIABLES]; /* 1 + the row of each live variable */
    struct numbers groups, rows;
    struct hash_table literal_table; /* 1 + the number of each literal */
    int32_t *literal;
    uint32_t literals;
};

/* Returns true if the base is the same address in all groups of any batch. */
static bool is_common(enum base base)
{
    return base == BASE_JOB || base == BASE_VERTICES || base == BASE_CONSTANT;
}

static bool is_value(const struct ir_instruction *i)
{
    return i->type && i->op != IR_set;
}

static bool has_step(const struct scheduler *p, uint32_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    if (!p->note[number].live || p->note[number].pair > number)
        return false;
    return i->op != IR_nop && i->op != IR_copy && i->op != IR_literal && i->op != IR_end && i->op != IR_loop;
}

/* --- Liveness ----------------------------------------------------------------------------------------- */

static bool has_effect(const struct ir_instruction *i)
{
    unsigned properties = ir_op_information[i->op].properties;
    return properties & IR_EFFECT && i->op != IR_set;
}

static uint32_t mark(struct scheduler *p, uint32_t work, uint16_t number)
{
    if (!p->note[number].live) {
        p->note[number].live = true;
        p->work[work++] = number;
    }
    return work;
}

static void mark_live(struct scheduler *p)
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

/* --- Lifetimes
 * --------------------------------------------------------------------------------------------- */

static void match_regions(struct scheduler *p)
{
    uint32_t open = 0;
    uint16_t loop = 0;
    for (uint32_t number = 1; number < p->ir->count; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        struct note *note = &p->note[number];
        note->region = open ? p->work[open - 1] : 0;
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

/* --- Pairs ---------------------------------------------------------------------------------------------- */

static bool varies(const struct scheduler *p, const struct ir_instruction *i)
{
    unsigned reads = ir_op_information[i->op].properties & IR_READS;
    if (i->op == IR_load || i->op == IR_get || (reads && !is_common(i->base)))
        return true;
    for (int o = 0; o < ir_op_information[i->op].operands; o++)
        if (p->note[p->note[i->operand[o]].root].varies)
            return true;
    return false;
}

/* Finds roots, their uses, and which values can differ between lanes. */
static void find_uses(struct scheduler *p)
{
    for (uint32_t number = 1; number < p->ir->count; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        struct note *note = &p->note[number];
        if (!note->live)
            continue;
        note->root = i->op == IR_copy ? p->note[i->operand[0]].root : (uint16_t)number;
        note->varies = varies(p, i);
        for (int o = 0; o < ir_op_information[i->op].operands && i->op != IR_copy; o++)
            p->note[p->note[i->operand[o]].root].uses++;
    }
}

/* Joins an operation with the one that computes its operand, if nothing else uses that result. Both must be
 * in the same region, because the first is then computed where the second is. */
static void join_pair(struct scheduler *p, uint16_t number, int position)
{
    const struct ir_instruction *second = &p->ir->instruction[number];
    uint16_t first = p->note[second->operand[position]].root;
    struct note *note = &p->note[first];
    if (p->note[number].pair || note->pair || note->uses != 1 || !note->varies ||
        note->region != p->note[number].region ||
        !schedule_pair_of(p->ir->instruction[first].op, second->op, position))
        return;
    note->pair = number;
    p->note[number].pair = first;
}

static void find_pairs(struct scheduler *p)
{
    for (uint32_t number = 1; number < p->ir->count; number++) {
        int operands = ir_op_information[p->ir->instruction[number].op].operands;
        for (int o = 0; p->note[number].live && o < operands && o < 2; o++)
            join_pair(p, (uint16_t)number, o);
    }
}

/* --- Lifetimes of values -------------------------------------------------------------------------------- */

/* A value that is used in a loop that begins after it lasts until the outermost such loop ends. */
static uint16_t last_use(const struct scheduler *p, uint16_t value, uint16_t position, uint16_t loop)
{
    for (; loop > value; loop = p->note[loop].outer)
        position = p->note[loop].match;
    return position;
}

static void find_last_uses(struct scheduler *p)
{
    uint16_t loop = 0;
    for (uint32_t number = 1; number < p->ir->count; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        struct note *note = &p->note[number];
        if (!note->live)
            continue;
        uint16_t position = note->pair > number ? note->pair : (uint16_t)number;
        if (i->op == IR_loop)
            loop = (uint16_t)number;
        for (int o = 0; o < ir_op_information[i->op].operands; o++) {
            uint16_t root = p->note[i->operand[o]].root;
            uint16_t last = last_use(p, root, position, loop);
            if (last > p->note[root].last)
                p->note[root].last = last;
        }
        if (i->op == IR_again)
            loop = p->note[loop].outer;
    }
}

/* --- Rows ----------------------------------------------------------------------------------------- */

static uint32_t take_number(struct numbers *numbers)
{
    return numbers->free_count ? numbers->free[--numbers->free_count] : numbers->count++;
}

struct literal_sought {
    const struct scheduler *p;
    int32_t bits;
};

static bool is_literal(const void *context, uint32_t number)
{
    const struct literal_sought *sought = context;
    return sought->p->literal[number - 1] == sought->bits;
}

static uint32_t literal_number(struct scheduler *p, int32_t bits)
{
    const struct literal_sought sought = {p, bits};
    uint32_t slot = hash_find(p->literal_table, (uint32_t)bits * 0x9e3779b1u >> 12, is_literal, &sought);
    uint32_t number = hash_get(p->literal_table, slot);
    if (number)
        return number - 1;
    p->literal[p->literals] = bits;
    hash_set(p->literal_table, slot, ++p->literals);
    return p->literals - 1;
}

static void locate_value(struct scheduler *p, uint16_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    struct note *note = &p->note[number];
    if (i->op == IR_literal) {
        note->location = LOCATION_LITERAL;
        note->slot = literal_number(p, i->k);
        return;
    }
    note->location = note->varies ? LOCATION_ROW : LOCATION_GROUP;
    note->slot = take_number(note->location == LOCATION_ROW ? &p->rows : &p->groups);
    note->next = p->note[note->last].ends;
    p->note[note->last].ends = number;
}

static void release_values(struct scheduler *p, uint16_t position)
{
    for (uint16_t value = p->note[position].ends; value; value = p->note[value].next) {
        struct numbers *numbers = p->note[value].location == LOCATION_ROW ? &p->rows : &p->groups;
        numbers->free[numbers->free_count++] = p->note[value].slot;
    }
}

static void locate_values(struct scheduler *p)
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
        if (p->note[number].live && is_value(&p->ir->instruction[number]) && p->note[number].root == number &&
            p->note[number].pair <= number)
            locate_value(p, (uint16_t)number);
    }
}

/* --- Steps
 * ------------------------------------------------------------------------------------------------ */

/* Offsets in the scratch memory for one number of lanes. */
struct layout {
    uint32_t groups, rows; /* their first bytes */
    uint32_t row_bytes;
    uint32_t bytes;
};

static struct layout lay_out(const struct scheduler *p, unsigned lanes)
{
    struct layout layout = {.groups = p->literals * GROUP_BYTES, .row_bytes = lanes * 4};
    layout.rows = (layout.groups + p->groups.count * GROUP_BYTES + 63) & ~63u;
    layout.bytes = (layout.rows + p->rows.count * layout.row_bytes + 63) & ~63u;
    return layout;
}

static uint32_t value_offset(const struct scheduler *p, const struct layout *layout, uint16_t value)
{
    const struct note *root = &p->note[p->note[value].root];
    switch (root->location) {
    case LOCATION_LITERAL: return root->slot * GROUP_BYTES;
    case LOCATION_GROUP: return layout->groups + root->slot * GROUP_BYTES;
    default: return layout->rows + root->slot * layout->row_bytes;
    }
}

static uint32_t variable_offset(const struct scheduler *p, const struct layout *layout, int32_t variable)
{
    return layout->rows + (p->variable[variable] - 1u) * layout->row_bytes;
}

static void set_operand(const struct scheduler *p, const struct layout *layout, struct schedule_step *step,
                        int o, uint16_t value)
{
    step->operand[o] = value_offset(p, layout, value);
    step->stride[o] = p->note[p->note[value].root].location == LOCATION_ROW ? GROUP_BYTES : 0;
}

/* The operands of the first operation of a pair, then the other operand of the second, `number`. */
static void set_pair(const struct scheduler *p, const struct layout *layout, struct schedule_step *step,
                     uint16_t number)
{
    const struct ir_instruction *second = &p->ir->instruction[number];
    const struct ir_instruction *first = &p->ir->instruction[p->note[number].pair];
    int position = p->note[second->operand[0]].root != p->note[number].pair;
    step->run = schedule_pair_of(first->op, second->op, position);
    set_operand(p, layout, step, 0, first->operand[0]);
    set_operand(p, layout, step, 1, first->operand[1]);
    set_operand(p, layout, step, 2, second->operand[!position]);
}

static struct schedule_step make_step(const struct scheduler *p, const struct layout *layout, uint16_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    struct schedule_step step = {
        .run = schedule_step_of(i->op), .base = i->base, .scale = i->scale, .k = i->k, .field = i->field};
    for (int o = 0; o < ir_op_information[i->op].operands; o++)
        set_operand(p, layout, &step, o, i->operand[o]);
    if (p->note[number].pair)
        set_pair(p, layout, &step, number);
    if (is_value(i)) {
        step.to = value_offset(p, layout, number);
        step.once = p->note[number].location == LOCATION_GROUP;
    }
    if (i->op == IR_set)
        step.to = variable_offset(p, layout, i->k);
    if (i->op == IR_get) {
        step.operand[0] = variable_offset(p, layout, i->k);
        step.stride[0] = GROUP_BYTES;
    }
    return step;
}

static void make_steps(struct scheduler *p, const struct layout *layout, struct schedule *schedule,
                       uint16_t *numbers)
{
    for (uint32_t number = 1; number < p->ir->count; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        const struct note *note = &p->note[number];
        if (!note->live)
            continue;
        if (ir_op_information[i->op].properties & IR_OPENS)
            p->note[number].slot = schedule->count;
        struct schedule_step *step = &schedule->step[schedule->count];
        if (has_step(p, number)) {
            *step = make_step(p, layout, (uint16_t)number);
            if (numbers)
                numbers[schedule->count] = (uint16_t)number;
            schedule->count++;
        }
        if (i->op == IR_again)
            step->k = (int32_t)(step - (schedule->step + p->note[note->match].slot));
        if (i->op == IR_end) {
            struct schedule_step *when = schedule->step + p->note[note->match].slot;
            when->k = (int32_t)(step - when);
        }
        if (i->op == IR_store && i->base == BASE_LANES)
            schedule->counts = true;
    }
    schedule->step[schedule->count++] = (struct schedule_step){.run = schedule_step_end};
}

static struct schedule *make_schedule(struct scheduler *p, unsigned lanes, uint16_t *numbers)
{
    struct layout layout = lay_out(p, lanes);
    while (layout.bytes > SCRATCH_LIMIT && lanes > GROUP_LANES)
        layout = lay_out(p, lanes /= 2);
    uint32_t steps = 1;
    for (uint32_t number = 1; number < p->ir->count; number++)
        steps += has_step(p, number);
    struct schedule *schedule =
        malloc(sizeof *schedule + steps * sizeof *schedule->step + p->literals * sizeof(int32_t));
    if (!schedule)
        return NULL;
    *schedule = (struct schedule){.lanes = lanes, .scratch_bytes = layout.bytes, .literals = p->literals};
    make_steps(p, &layout, schedule, numbers);
    schedule->literal = (int32_t *)(void *)(schedule->step + schedule->count);
    memcpy(schedule->literal, p->literal, p->literals * sizeof(int32_t));
    return schedule;
}

static int scheduler_open(struct scheduler *p, const struct ir *ir)
{
    uint32_t slots = hash_slots(ir->count, 16);
    p->ir = ir;
    p->note = calloc(ir->count, sizeof *p->note);
    p->work = malloc(ir->count * sizeof *p->work);
    p->groups.free = malloc(ir->count * sizeof *p->groups.free);
    p->rows.free = malloc(ir->count * sizeof *p->rows.free);
    p->literal = malloc(ir->count * sizeof *p->literal);
    p->literal_table = (struct hash_table){calloc(slots, sizeof(uint16_t)), slots - 1, false};
    return p->note && p->work && p->groups.free && p->rows.free && p->literal && p->literal_table.slot ? 0
                                                                                                       : -1;
}

static void scheduler_close(struct scheduler *p)
{
    free(p->note);
    free(p->work);
    free(p->groups.free);
    free(p->rows.free);
    free(p->literal);
    free(p->literal_table.slot);
}

struct schedule *schedule_create(const struct ir *ir, unsigned lanes, bool fuses, uint16_t *numbers,
                                 struct error *error)
{
    struct scheduler p = {0};
    struct schedule *schedule = NULL;
    if (!scheduler_open(&p, ir)) {
        mark_live(&p);
        match_regions(&p);
        find_uses(&p);
        if (fuses)
            find_pairs(&p);
        find_last_uses(&p);
        locate_values(&p);
        schedule = make_schedule(&p, lanes, numbers);
    }
    scheduler_close(&p);
    if (!schedule)
        error_set(error, "out of memory for a schedule of %u operations", ir->count - 1);
    return schedule;
}

void schedule_free(struct schedule *schedule)
{
    free(schedule);
}

void schedule_start(const struct schedule *schedule, uint8_t *scratch)
{
    for (uint32_t i = 0; i < schedule->literals; i++) {
        int32_t group[GROUP_LANES];
        for (int lane = 0; lane < GROUP_LANES; lane++)
            group[lane] = schedule->literal[i];
        memcpy(scratch + i * GROUP_BYTES, group, sizeof group);
    }
}
