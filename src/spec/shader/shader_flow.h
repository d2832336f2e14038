/* Flow control of shaders: the lanes that execute each step.
 *
 * A Boolean constant decides when the routine is built. An integer constant counts at run time and is the
 * same in all lanes. A condition on values splits the lanes: each side of an if executes in its own lanes,
 * and is skipped if there are none. A loop repeats while any lane has not left it. A lane leaves by break the
 * loop, by continue the pass, by ret the subroutine or the program with all loops inside it. Registers that a
 * region writes leave it in the variables of their cells. */
#ifndef SPEC_SHADER_SHADER_FLOW_H
#define SPEC_SHADER_SHADER_FLOW_H

#include "contract/language.h"
#include "spec/math/vector.h"
#include "spec/shader/shader.h"
#include "spec/shader/shader_execute.h"

static inline void execute_steps(struct env *e, struct machine *m, uint32_t from, uint32_t to);

static inline void save_cells(struct env *e, const struct machine *m, const struct cell_set *set)
{
    unsigned end = m->program->cells;
    for (unsigned c = cell_next(set, 0, end); c < end; c = cell_next(set, c + 1, end)) {
        if (cell_is_float(c))
            set_f(E, variable_of_cell(c), m->cell[c]);
        else if (c < CELL_PREDICATE)
            set_i(E, (int)c, m->address[c - CELL_ADDRESS]);
        else
            set_m(E, (int)c, c == CELL_KILLED ? m->killed : m->predicate[c - CELL_PREDICATE]);
    }
}

static inline void load_cells(struct env *e, struct machine *m, const struct cell_set *set)
{
    unsigned end = m->program->cells;
    for (unsigned c = cell_next(set, 0, end); c < end; c = cell_next(set, c + 1, end)) {
        if (cell_is_float(c))
            m->cell[c] = get_f(E, variable_of_cell(c));
        else if (c < CELL_PREDICATE)
            m->address[c - CELL_ADDRESS] = get_i(E, (int)c);
        else if (c == CELL_KILLED)
            m->killed = get_m(E, (int)c);
        else
            m->predicate[c - CELL_PREDICATE] = get_m(E, (int)c);
    }
}

/* Saves the lanes that a region can make leave a loop, its pass or the subroutine. */
static inline void save_lanes(struct env *e, const struct machine *m, const struct program_step *step)
{
    if (step->leaves)
        set_m(E, VARIABLE_LIVE + m->loops - 1, m->live);
    if (step->continues)
        set_m(E, VARIABLE_RESUMED + m->loops - 1, m->resumed);
    if (step->returns)
        set_m(E, VARIABLE_STAY + m->calls, m->stay);
}

/* The lanes that remain of those that execute. */
static inline void keep_lanes(struct env *e, struct machine *m, msk lanes)
{
    m->mask = m->masked ? and_m(E, m->mask, lanes) : lanes;
    m->masked = true;
}

static inline void load_lanes(struct env *e, struct machine *m, const struct program_step *step)
{
    if (step->continues)
        m->resumed = get_m(E, VARIABLE_RESUMED + m->loops - 1);
    if (step->leaves) {
        m->live = get_m(E, VARIABLE_LIVE + m->loops - 1);
        keep_lanes(E, m, m->live);
    }
    if (step->returns) {
        m->stay = get_m(E, VARIABLE_STAY + m->calls);
        keep_lanes(E, m, m->stay);
    }
}

static inline msk executing(struct env *e, const struct machine *m)
{
    return m->masked ? m->mask : lit_m(E, -1);
}

/* Executes the steps of a region or of a subroutine. Lanes that return early leave the subroutine. */
static inline void execute_body(struct env *e, struct machine *m, const struct program_step *step,
                                uint32_t from, uint32_t to)
{
    bool masked = m->masked;
    msk mask = m->mask, stay = m->stay;
    if (!step->early) {
        execute_steps(E, m, from, to);
        return;
    }
    m->stay = executing(E, m);
    m->calls++;
    execute_steps(E, m, from, to);
    settle(E, m);
    m->calls--;
    m->stay = stay;
    m->mask = mask;
    m->masked = masked;
}

/* Executes steps in the given lanes, a subset of those that execute now. Afterwards fewer lanes execute if
 * some leave the surrounding loop or subroutine inside. */
static inline void execute_where(struct env *e, struct machine *m, const struct program_step *step, msk lanes,
                                 uint32_t from, uint32_t to)
{
    bool masked = m->masked;
    msk mask = m->mask;
    settle(E, m);
    save_cells(E, m, &step->written);
    save_lanes(E, m, step);
    WHEN (E, lanes) {
        m->masked = true;
        m->mask = lanes;
        execute_body(E, m, step, from, to);
        settle(E, m);
        save_cells(E, m, &step->written);
        save_lanes(E, m, step);
    }
    NOTE_STEP(E, (uint32_t)(step - m->program->step));
    load_cells(E, m, &step->written);
    m->masked = masked;
    m->mask = mask;
    load_lanes(E, m, step);
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
        execute_body(E, m, step, step->match, step->end);
}

/* break, and continue. */
static inline void execute_break(struct env *e, struct machine *m, const struct shader_instruction *i)
{
    msk lanes = m->mask;
    settle(E, m);
    if (i->opcode == SHADER_CONTINUE)
        m->resumed = or_m(E, m->resumed, lanes);
    else if (i->opcode != SHADER_BREAK) {
        msk holds = condition(E, m, i);
        lanes = and_m(E, lanes, holds);
    }
    m->live = andn_m(E, m->live, lanes);
    m->mask = andn_m(E, m->mask, lanes);
}

/* A ret inside a block. */
static inline void execute_return(struct env *e, struct machine *m)
{
    msk lanes = executing(E, m);
    settle(E, m);
    m->stay = andn_m(E, m->stay, lanes);
    m->mask = lit_m(E, 0);
    m->masked = true;
}

/* Component c of an integer constant. */
static inline itg integer_constant(struct env *e, const struct machine *m, unsigned index, int c)
{
    const struct program_constant *defined = program_defined(m->program, FILE_INTEGER, index);
    if (defined)
        return lit_i(E, (int32_t)defined->value[c]);
    return uniform_i(E, BASE_CONSTANT, program_integer_offset(m->program, index) + 4 * c);
}

/* The passes of a loop. */
static inline itg loop_passes(struct env *e, const struct machine *m, const struct shader_instruction *i)
{
    if (i->opcode == SHADER_WHILE)
        return lit_i(E, PROGRAM_PASSES);
    return integer_constant(E, m, i->source[i->opcode == SHADER_LOOP].index, 0);
}

/* The lanes that begin the next pass: those that end this one and those that have resumed. */
static inline void end_pass(struct env *e, struct machine *m, const struct program_step *step)
{
    if (step->continues)
        m->live = or_m(E, m->live, m->resumed);
    if (!step->returns)
        return;
    m->live = and_m(E, m->live, m->stay);
    set_m(E, VARIABLE_STAY + m->calls, m->stay);
}

/* One round of a loop. `left` counts down, and the counter advances by the integer's third component. */
static inline void execute_pass(struct env *e, struct machine *m, uint32_t at, int partly, unsigned integer)
{
    const struct program_step *step = &m->program->step[at];
    int depth = m->loops - 1;
    load_cells(E, m, &step->written);
    m->live = get_m(E, VARIABLE_LIVE + depth);
    if (step->continues)
        m->resumed = lit_m(E, 0);
    if (step->returns)
        m->stay = get_m(E, VARIABLE_STAY + m->calls);
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
    end_pass(E, m, step);
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
    msk mask = m->mask, live = m->live, resumed = m->resumed;
    itg counter = m->counter;
    settle(E, m);
    itg count = loop_passes(E, m, &step->instruction);
    msk begin = gt_i(E, count, lit_i(E, 0));
    if (masked)
        begin = and_m(E, begin, mask);
    save_cells(E, m, &step->written);
    if (step->returns)
        set_m(E, VARIABLE_STAY + m->calls, m->stay);
    set_m(E, VARIABLE_LIVE + depth, begin);
    set_i(E, VARIABLE_COUNT + depth, count);
    if (loop) {
        itg start = integer_constant(E, m, integer, 1);
        set_i(E, VARIABLE_COUNTER + depth, start);
    }
    m->loops = depth + 1;
    WHEN (E, begin) {
        LOOP(E, VARIABLE_LIVE + depth)
        execute_pass(E, m, at, masked || step->leaves || step->returns, integer);
    }
    load_cells(E, m, &step->written);
    m->loops = depth;
    m->masked = masked;
    m->mask = mask;
    m->live = live;
    m->resumed = resumed;
    m->counter = counter;
    if (!step->returns)
        return;
    m->stay = get_m(E, VARIABLE_STAY + m->calls);
    keep_lanes(E, m, m->stay);
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
    if (is_loop(i->opcode)) {
        execute_loop(E, m, at);
        return step->match + 1;
    }
    if (is_call(i->opcode))
        execute_call(E, m, step);
    else if (is_break(i->opcode) || i->opcode == SHADER_CONTINUE)
        execute_break(E, m, i);
    else if (i->opcode == SHADER_RET)
        execute_return(E, m);
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
    for (unsigned c = CELL_MORE; c < e->program->cells; c++)
        m->cell[c] = m->before[c] = zero;
    for (unsigned s = 0; s < 8; s++)
        m->product[s] = zero;
    for (unsigned c = 0; c < 4; c++) {
        m->address[c] = m->address_before[c] = none;
        m->predicate[c] = m->predicate_before[c] = never;
    }
    m->counter = none;
    m->killed = m->mask = m->live = m->resumed = m->stay = never;
    if (m->program->early)
        m->stay = lit_m(E, -1);
    m->masked = false;
    m->loops = m->calls = 0;
    m->changed = (struct cell_set){{0}};
    m->pixel = NULL;
    m->vertex = NULL;
}

static inline void machine_run(struct env *e, struct machine *m)
{
    execute_steps(E, m, 0, m->program->main);
    if (m->program->early)
        settle(E, m);
    NOTE_STEP(E, NO_STEP);
}

#endif
