/* Flow control of a program: its targets, and the cells that each region writes.
 *
 * Validated shaders nest properly, calls are forward only, and the last ret of the main program and of each
 * subroutine is outside of all blocks. So two walks are enough. A forward walk finds the ends of regions. A
 * backward walk adds up the cells that they write: a subroutine follows all calls of it, so its cells are
 * complete before its callers are walked. */
#include "shader/check/check.h"
#include "shader/program/program.h"

static bool begins(unsigned opcode)
{
    return is_if(opcode) || opcode == SHADER_ELSE || is_loop(opcode);
}

static bool ends(unsigned opcode)
{
    return opcode == SHADER_ELSE || opcode == SHADER_ENDIF || ends_loop(opcode);
}

/* --- Matching ------------------------------------------------------------------------------------------ */

static void match_blocks(struct program *program)
{
    uint32_t open[CHECK_BLOCKS], depth = 0;
    for (uint32_t i = 0; i < program->steps; i++) {
        unsigned opcode = program->step[i].instruction.opcode;
        if (ends(opcode))
            program->step[open[--depth]].match = i;
        if (begins(opcode))
            open[depth++] = i;
    }
    for (uint32_t i = 0; i < program->steps; i++) {
        struct program_step *step = &program->step[i];
        if (is_if(step->instruction.opcode) || step->instruction.opcode == SHADER_ELSE) {
            const struct program_step *match = &program->step[step->match];
            step->end = match->instruction.opcode == SHADER_ELSE ? match->match : step->match;
        }
    }
}

/* The first ret from there on that is outside of all blocks, or the label or the end before one. Sets `early`
 * if there are others before it. */
static uint32_t find_return(const struct program *program, uint32_t from, bool *early)
{
    unsigned depth = 0;
    uint32_t i = from;
    *early = false;
    for (; i < program->steps; i++) {
        unsigned opcode = program->step[i].instruction.opcode;
        depth -= ends(opcode);
        if (opcode == SHADER_LABEL || (opcode == SHADER_RET && !depth))
            break;
        *early |= opcode == SHADER_RET;
        depth += begins(opcode);
    }
    return i;
}

enum { LABELS = 2048 }; /* numbers of registers have 11 bits */

/* Finds the beginnings and ends of subroutines, and the end of the main program. */
static void match_calls(struct program *program)
{
    uint32_t body[LABELS] = {0};
    program->main = find_return(program, 0, &program->early);
    for (uint32_t i = program->main; i < program->steps; i++) {
        struct program_step *step = &program->step[i];
        if (step->instruction.opcode != SHADER_LABEL)
            continue;
        body[step->instruction.source[0].index] = step->match = i + 1;
        step->end = find_return(program, i + 1, &step->early);
    }
    for (uint32_t i = 0; i < program->steps; i++) {
        struct program_step *step = &program->step[i];
        if (!is_call(step->instruction.opcode))
            continue;
        step->match = body[step->instruction.source[0].index];
        step->end = program->step[step->match - 1].end;
        step->early = program->step[step->match - 1].early;
    }
}

/* --- What is written ----------------------------------------------------------------------------------- */

unsigned program_cell(const struct shader_operand *destination)
{
    unsigned index = destination->index;
    switch (destination->file) {
    case FILE_TEMPORARY: return cell_of_temporary(index);
    case FILE_TEXTURE: return CELL_TEXTURE + 4 * index;
    case FILE_ADDRESS: return CELL_ADDRESS;
    case FILE_POSITION: return CELL_OUTPUT + 4 * OUTPUT_POSITION;
    case FILE_FOG: return CELL_OUTPUT + 4 * OUTPUT_FOG;
    case FILE_POINT: return CELL_OUTPUT + 4 * OUTPUT_POINT;
    case FILE_COLOR: return CELL_OUTPUT + 4 * (OUTPUT_COLOR + index);
    case FILE_COORDINATE: return CELL_OUTPUT + 4 * (OUTPUT_COORDINATE + index);
    case FILE_OUTPUT:
    case FILE_TARGET: return CELL_OUTPUT + 4 * index;
    case FILE_DEPTH: return CELL_DEPTH;
    case FILE_PREDICATE: return CELL_PREDICATE;
    default: return CELL_COUNT;
    }
}

static void add_cells(struct cell_set *set, unsigned cell, unsigned mask)
{
    for (unsigned c = 0; c < 4; c++)
        if (mask >> c & 1 && cell + c < CELL_COUNT)
            cell_add(set, cell + c);
}

static void add_set(struct cell_set *to, const struct cell_set *from)
{
    for (unsigned i = 0; i < sizeof to->word / sizeof *to->word; i++)
        to->word[i] |= from->word[i];
}

/* A relative destination can be any of its file or its array. */
static void add_relative(const struct program *program, const struct shader_operand *to, struct cell_set *set)
{
    if (to->file == FILE_TEMPORARY)
        for (unsigned r = program->array_begin[to->index]; r < program->array_end[to->index]; r++)
            add_cells(set, cell_of_temporary(r), to->swizzle);
    else
        for (unsigned o = 0; o < OUTPUT_COUNT; o++)
            add_cells(set, CELL_OUTPUT + 4 * o, to->swizzle);
}

static void add_written(const struct program *program, const struct shader_instruction *i,
                        struct cell_set *set)
{
    const struct shader_operation *row = &shader_operations[i->opcode];
    const struct shader_operand *to = &i->destination;
    if (is_kill(i->opcode)) {
        cell_add(set, CELL_KILLED);
        return;
    }
    if (i->opcode == SHADER_TEXM3X2DEPTH || i->opcode == SHADER_TEXDEPTH)
        cell_add(set, CELL_DEPTH);
    if (!row->destination || to->file == FILE_NONE)
        return;
    if (to->relative)
        add_relative(program, to, set);
    else
        add_cells(set, program_cell(to), to->swizzle);
}

/* The cells that steps from `from` to before `to` write, including their blocks and calls. */
static void sum_up(const struct program *program, uint32_t from, uint32_t to, struct cell_set *set)
{
    for (uint32_t i = from; i < to; i++) {
        const struct program_step *step = &program->step[i];
        add_written(program, &step->instruction, set);
        if (is_call(step->instruction.opcode))
            add_set(set, &step->written);
    }
}

/* Finds out if something in the region of a step leaves the pass of a loop that began before, or returns. */
static void find_leaving(const struct program *program, uint32_t at, struct program_step *region)
{
    uint32_t inner = at; /* the end of the loop inside, if it is further on */
    for (uint32_t i = at + 1; i < region->match; i++) {
        const struct program_step *step = &program->step[i];
        unsigned opcode = step->instruction.opcode;
        if (is_loop(opcode) && i >= inner)
            inner = step->match;
        region->returns |= opcode == SHADER_RET;
        region->continues |= opcode == SHADER_CONTINUE && i >= inner;
        region->leaves |= (is_break(opcode) || opcode == SHADER_CONTINUE) && i >= inner;
    }
}

static void find_written(struct program *program)
{
    for (uint32_t i = program->steps; i-- > 0;) {
        struct program_step *step = &program->step[i];
        unsigned opcode = step->instruction.opcode;
        if (begins(opcode)) {
            sum_up(program, i + 1, step->match, &step->written);
            find_leaving(program, i, step);
            add_set(&program->initial, &step->written);
        } else if (opcode == SHADER_LABEL)
            sum_up(program, step->match, step->end, &step->written);
        else if (is_call(opcode)) {
            step->written = program->step[step->match - 1].written;
            if (opcode == SHADER_CALLNZ)
                add_set(&program->initial, &step->written);
        }
        if (step->instruction.predicate.file)
            add_written(program, &step->instruction, &program->initial);
    }
    sum_up(program, 0, program->steps, &program->written);
}

/* --- Bounds -------------------------------------------------------------------------------------------- */

/* The most steps that one run executes, with calls, and the most loops around a step. */
struct bound {
    const struct program *program;
    const int32_t (*integers)[4]; /* null: each loop with an integer constant runs once */
    uint64_t executed;            /* counting ends after PROGRAM_EXECUTED */
    unsigned loops;
};

/* At least 1: building a routine also walks through the body of a loop that never runs. Loops of OpenGL's
 * models count once. */
static uint64_t loop_count(const struct bound *bound, const struct shader_instruction *i)
{
    if (shader_is_opengl(bound->program->model))
        return 1;
    unsigned index = i->source[i->opcode == SHADER_LOOP].index;
    const struct program_constant *defined = program_defined(bound->program, FILE_INTEGER, index);
    int32_t count = defined ? (int32_t)defined->value[0] : bound->integers ? bound->integers[index][0] : 1;
    return count > 1 ? (uint64_t)count : 1;
}

/* Adds up steps `from` to `to`, each `times`, with `loops` around them. The model bounds the depth of calls.
 */
static void count_steps(struct bound *bound, uint32_t from, uint32_t to, uint64_t times, unsigned loops)
{
    uint64_t outer[CHECK_BLOCKS];
    unsigned depth = 0;
    for (uint32_t i = from; i < to; i++) {
        const struct program_step *step = &bound->program->step[i];
        unsigned opcode = step->instruction.opcode;
        bound->executed += times;
        if (bound->executed > PROGRAM_EXECUTED)
            return;
        if (is_loop(opcode)) {
            outer[depth++] = times;
            times *= loop_count(bound, &step->instruction);
            if (loops + depth > bound->loops)
                bound->loops = loops + depth;
        } else if (ends_loop(opcode))
            times = outer[--depth];
        else if (is_call(opcode))
            count_steps(bound, step->match, step->end, times, loops + depth);
    }
}

static int check_count(unsigned index, int32_t count, struct error *error)
{
    if (count >= 0 && count <= PROGRAM_PASSES)
        return 0;
    return error_set(error, "integer constant i%u: found the count %d, expected 0 to %d", index, count,
                     PROGRAM_PASSES);
}

static int check_numbers(const struct program *program, const int32_t (*integers)[4], struct error *error)
{
    bool software = program->model->capabilities & CAN_SOFTWARE, opengl = shader_is_opengl(program->model);
    for (uint32_t i = 0; i < program->steps; i++) {
        const struct shader_instruction *at = &program->step[i].instruction;
        if (!is_loop(at->opcode) || at->opcode == SHADER_WHILE)
            continue;
        unsigned index = at->source[at->opcode == SHADER_LOOP].index;
        if (program_defined(program, FILE_INTEGER, index))
            continue;
        const int32_t *n = integers[index];
        if (opengl && check_count(index, n[0], error))
            return -1;
        if (opengl)
            continue;
        bool bad = n[0] < 0 || n[0] > 255;
        if (at->opcode == SHADER_LOOP && !software)
            bad |= n[1] < 0 || n[1] > 255 || n[2] < -128 || n[2] > 127;
        if (bad)
            return error_set(
                error,
                "integer constant i%u: found %d %d %d, expected a count and a start from 0 to 255 and a "
                "step from -128 to 127",
                index, n[0], n[1], n[2]);
    }
    return 0;
}

static int check_executed(const struct program *program, const int32_t (*integers)[4], struct error *error)
{
    struct bound bound = {.program = program, .integers = integers};
    count_steps(&bound, 0, program->main, 1, 0);
    if (bound.executed > PROGRAM_EXECUTED)
        return error_set(
            error, "%s shader: loops and calls execute more than %d instructions, expected at most that",
            program->model->name, PROGRAM_EXECUTED);
    if (bound.loops > PROGRAM_LOOPS)
        return error_set(error, "%s shader: found loops %u deep, through calls, expected at most %d",
                         program->model->name, bound.loops, PROGRAM_LOOPS);
    return 0;
}

int program_check_integers(const struct program *program, const int32_t (*integers)[4], struct error *error)
{
    if (check_numbers(program, integers, error))
        return -1;
    return check_executed(program, integers, error);
}

int program_connect(struct program *program, struct error *error)
{
    match_blocks(program);
    match_calls(program);
    if (check_executed(program, NULL, error))
        return -1;
    find_written(program);
    return 0;
}
