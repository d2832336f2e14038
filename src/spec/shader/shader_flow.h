/* Flow control of shaders: the lanes that execute each step.
 *
 * A Boolean constant decides when the routine is built. An integer constant counts at run time and is the
 * same in all lanes. A condition on values splits the lanes: each side of an if executes in its own lanes,
 * and is skipped if there are none. A loop repeats while any lane has not left it. Registers that a region
 * writes leave it in variables with the numbers of their cells. */
#ifndef SPEC_SHADER_SHADER_FLOW_H
#define SPEC_SHADER_SHADER_FLOW_H

#include "contract/language.h"
#include "spec/math/vector.h"
#include "spec/shader/shader.h"
#include "spec/shader/shader_execute.h"

static inline void execute_steps(struct env *e, struct machine *m, uint32_t from, uint32_t to);

static inline void save_cells(struct env *e, const struct machine *m, const struct cell_set *set)
{
    for (unsigned c = cell_next(set, 0); c < CELL_COUNT; c = cell_next(set, c + 1)) {
        if (c < CELL_FLOATS)
            set_f(E, (int)c, m->cell[c]);
        else if (c < CELL_PREDICATE)
            set_i(E, (int)c, m->address[c - CELL_ADDRESS]);
        else
            set_m(E, (int)c, c == CELL_KILLED ? m->killed : m->predicate[c - CELL_PREDICATE]);
    }
}

static inline void load_cells(struct env *e, struct machine *m, const struct cell_set *set)
{
    for (unsigned c = cell_next(set, 0); c < CELL_COUNT; c = cell_next(set, c + 1)) {
        if (c < CELL_FLOATS)
            m->cell[c] = get_f(E, (int)c);
        else if (c < CELL_PREDICATE)
            m->address[c - CELL_ADDRESS] = get_i(E, (int)c);
        else if (c == CELL_KILLED)
            m->killed = get_m(E, (int)c);
        else
            m->predicate[c - CELL_PREDICATE] = get_m(E, (int)c);
    }
}

/* Executes steps in the given lanes, a subset of those that execute now. Afterwards fewer lanes execute if a
 * break inside leaves the surrounding loop. */
static inline void execute_where(struct env *e, struct machine *m, const struct program_step *step, msk lanes,
                                 uint32_t from, uint32_t to)
{
    bool masked = m->masked;
    int live = VARIABLE_LIVE + m->loops - 1;
    msk mask = m->mask;
    settle(E, m);
    save_cells(E, m, &step->written);
    if (step->leaves)
        set_m(E, live, m->live);
    WHEN (E, lanes) {
        m->masked = true;
        m->mask = lanes;
        execute_steps(E, m, from, to);
        settle(E, m);
        save_cells(E, m, &step->written);
        if (step->leaves)
            set_m(E, live, m->live);
    }
    NOTE_STEP(E, (uint32_t)(step - m->program->step));
    load_cells(E, m, &step->written);
    m->masked = masked;
    m->mask = mask;
    if (!step->leaves)
        return;
    m->live = get_m(E, live);
    m->mask = masked ? and_m(E, mask, m->live) : m->live;
    m->masked = true;
}

static inline bool is_set(const struct machine *m, const struct shader_operand *o)
{
    const struct program_constant *defined = program_defined(m->program, FILE_BOOLEAN, o->index);
    bool value = defined ? defined->value[0] != 0 : m->booleans >> o->index & 1;
    return value ^ (o->modifier == MODIFIER_NOT);
}

/* The condition of if, break and other instructions that compare values. */
static inline msk condition(struct env *e, const struct machine *m, const struct shader_instruction *i)
{
    const struct shader_operand *o = &i->source[i->opcode == SHADER_CALLNZ];
    if (o->file == FILE_PREDICATE)
        return predicate_of(E, m, o, 0);
    struct vector4 a = read_source(E, m, &i->source[0], 0, 1);
    struct vector4 b = read_source(E, m, &i->source[1], 0, 1);
    return compare_values(E, i->comparison, a.v[0], b.v[0]);
}

static inline msk executing(struct env *e, const struct machine *m)
{
    return m->masked ? m->mask : lit_m(E, -1);
}

static inline void execute_if(struct env *e, struct machine *m, uint32_t at)
{
    const struct program_step *step = &m->program->step[at];
    bool has_else = step->match != step->end;
    if (step->instruction.source[0].file == FILE_BOOLEAN) {
        if (is_set(m, &step->instruction.source[0]))
            execute_steps(E, m, at + 1, step->match);
        else if (has_else)
            execute_steps(E, m, step->match + 1, step->end);
        return;
    }
    msk here = executing(E, m);
    msk holds = condition(E, m, &step->instruction);
    msk then = and_m(E, here, holds);
    execute_where(E, m, step, then, at + 1, step->match);
    if (!has_else)
        return;
    msk otherwise = andn_m(E, here, holds);
    execute_where(E, m, &m->program->step[step->match], otherwise, step->match + 1, step->end);
}

static inline void execute_call(struct env *e, struct machine *m, const struct program_step *step)
{
    const struct shader_instruction *i = &step->instruction;
    if (i->opcode == SHADER_CALLNZ && i->source[1].file == FILE_PREDICATE) {
        msk here = executing(E, m);
        msk holds = condition(E, m, i);
        msk lanes = and_m(E, here, holds);
        execute_where(E, m, step, lanes, step->match, step->end);
    } else if (i->opcode == SHADER_CALL || is_set(m, &i->source[1]))
        execute_steps(E, m, step->match, step->end);
}

static inline void execute_break(struct env *e, struct machine *m, const struct shader_instruction *i)
{
    msk lanes = m->mask;
    settle(E, m);
    if (i->opcode != SHADER_BREAK) {
        msk holds = condition(E, m, i);
        lanes = and_m(E, lanes, holds);
    }
    m->live = andn_m(E, m->live, lanes);
    m->mask = andn_m(E, m->mask, lanes);
}

/* Component c of an integer constant. */
static inline itg integer_constant(struct env *e, const struct machine *m, unsigned index, int c)
{
    const struct program_constant *defined = program_defined(m->program, FILE_INTEGER, index);
    if (defined)
        return lit_i(E, (int32_t)defined->value[c]);
    return uniform_i(E, BASE_CONSTANT, program_integer_offset(m->program, index) + 4 * c);
}

/* One round of a loop. `left` counts down, and the counter advances by the integer's third component. */
static inline void execute_pass(struct env *e, struct machine *m, uint32_t at, int partly, unsigned integer)
{
    const struct program_step *step = &m->program->step[at];
    int depth = m->loops - 1;
    load_cells(E, m, &step->written);
    m->live = get_m(E, VARIABLE_LIVE + depth);
    itg left = get_i(E, VARIABLE_COUNT + depth);
    itg fewer = add_i(E, left, lit_i(E, -1));
    set_i(E, VARIABLE_COUNT + depth, fewer);
    if (step->instruction.opcode == SHADER_LOOP) {
        m->counter = get_i(E, VARIABLE_COUNTER + depth);
        itg by = integer_constant(E, m, integer, 2);
        itg next = add_i(E, m->counter, by);
        set_i(E, VARIABLE_COUNTER + depth, next);
    }
    m->masked = partly;
    m->mask = m->live;
    execute_steps(E, m, at + 1, step->match);
    NOTE_STEP(E, step->match);
    settle(E, m);
    save_cells(E, m, &step->written);
    msk more = gt_i(E, fewer, lit_i(E, 0));
    msk live = and_m(E, m->live, more);
    set_m(E, VARIABLE_LIVE + depth, live);
}

static inline void execute_loop(struct env *e, struct machine *m, uint32_t at)
{
    const struct program_step *step = &m->program->step[at];
    bool loop = step->instruction.opcode == SHADER_LOOP, masked = m->masked;
    int depth = m->loops;
    unsigned integer = step->instruction.source[loop].index;
    msk mask = m->mask, live = m->live;
    itg counter = m->counter;
    settle(E, m);
    itg count = integer_constant(E, m, integer, 0);
    msk begin = gt_i(E, count, lit_i(E, 0));
    if (masked)
        begin = and_m(E, begin, mask);
    save_cells(E, m, &step->written);
    set_m(E, VARIABLE_LIVE + depth, begin);
    set_i(E, VARIABLE_COUNT + depth, count);
    if (loop) {
        itg start = integer_constant(E, m, integer, 1);
        set_i(E, VARIABLE_COUNTER + depth, start);
    }
    m->loops = depth + 1;
    WHEN (E, begin) {
        LOOP(E, VARIABLE_LIVE + depth)
        execute_pass(E, m, at, masked || step->leaves, integer);
    }
    load_cells(E, m, &step->written);
    m->loops = depth;
    m->masked = masked;
    m->mask = mask;
    m->live = live;
    m->counter = counter;
}

/* --- Steps ---------------------------------------------------------------------------------------------- */

/* Executes one step that is not the first of a pair; returns the number of the next step. */
static inline uint32_t execute_step(struct env *e, struct machine *m, uint32_t at)
{
    const struct program_step *step = &m->program->step[at];
    const struct shader_instruction *i = &step->instruction;
    if (is_if(i->opcode)) {
        execute_if(E, m, at);
        return step->end + 1;
    }
    if (i->opcode == SHADER_LOOP || i->opcode == SHADER_REP) {
        execute_loop(E, m, at);
        return step->match + 1;
    }
    if (is_call(i->opcode))
        execute_call(E, m, step);
    else if (is_break(i->opcode))
        execute_break(E, m, i);
    else if (i->opcode == SHADER_SETP)
        execute_setp(E, m, i);
    else if (i->destination.file == FILE_ADDRESS)
        execute_address(E, m, i);
    else
        execute_plain(E, m, i);
    return at + 1;
}

/* Returns true if the step and the next one are a pair. */
static inline bool begins_pair(const struct program *program, uint32_t at)
{
    return at + 1 < program->steps && program->step[at + 1].instruction.coissue;
}

/* Executes a step, or a pair; returns the number of the next step. */
static inline uint32_t execute_next(struct env *e, struct machine *m, uint32_t at)
{
    const struct program_step *step = m->program->step + at;
    if (!begins_pair(m->program, at))
        return execute_step(E, m, at);
    execute_pair(E, m, &step[0].instruction, &step[1].instruction);
    return at + 2;
}

static inline void execute_steps(struct env *e, struct machine *m, uint32_t from, uint32_t to)
{
    for (uint32_t at = from; at < to;) {
        NOTE_STEP(E, at);
        at = EXECUTE_NEXT(E, m, at);
    }
}

/* A machine whose registers are all zero. The caller sets the inputs. */
static inline void machine_begin(struct env *e, struct machine *m, const uint8_t booleans[2], bool legacy)
{
    flt zero = lit_f(E, 0.0f);
    itg none = lit_i(E, 0);
    msk never = lit_m(E, 0);
    m->program = e->program;
    m->booleans = booleans[0] | (unsigned)booleans[1] << 8;
    m->legacy = legacy;
    for (unsigned c = 0; c < CELL_FLOATS; c++)
        m->cell[c] = m->before[c] = zero;
    for (unsigned s = 0; s < 8; s++)
        m->product[s] = zero;
    for (unsigned c = 0; c < 4; c++) {
        m->address[c] = m->address_before[c] = none;
        m->predicate[c] = m->predicate_before[c] = never;
    }
    m->counter = none;
    m->killed = m->mask = m->live = never;
    m->masked = false;
    m->loops = 0;
    m->changed = (struct cell_set){{0}};
    m->pixel = NULL;
    m->vertex = NULL;
}

static inline void machine_run(struct env *e, struct machine *m)
{
    execute_steps(E, m, 0, m->program->main);
    NOTE_STEP(E, NO_STEP);
}

#endif
