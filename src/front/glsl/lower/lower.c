#include "front/glsl/lower/lower.h"

#include "front/glsl/check/builtin.h"

/* --- Sources -------------------------------------------------------------------------------------------- */

/* gl_FrontFacing is a bool, and the register's sign. */
static void begin_facing(struct glsl_lowering *l)
{
    struct glsl_operand face = {.file = GLSL_FILE_SOURCE, .number = GLSL_SOURCE_FACING};
    struct glsl_operand from[] = {glsl_operand_literal(&l->code, 0), face};
    if (l->code.unit->builtins >> GLSL_FRONT_FACING & 1)
        l->facing = glsl_emit_2(&l->code, GLSL_OP_SLT, 1, from[0], from[1]);
}

/* Rows of pixels are counted from the bottom, and so is t of the register. That of gl_PointCoord is 0 at the
 * top (3.3). */
static void begin_point(struct glsl_lowering *l)
{
    static const float factor[2] = {1, -1}, offset[2] = {0, 1};
    struct glsl_operand point = {.file = GLSL_FILE_SOURCE, .number = GLSL_SOURCE_POINT, .swizzle = GLSL_XYZW};
    if (l->code.unit->builtins >> GLSL_POINT_COORD & 1)
        l->point = glsl_emit_3(&l->code, GLSL_OP_MAD, 2, point, glsl_operand_literals(&l->code, factor, 2),
                               glsl_operand_literals(&l->code, offset, 2));
}

struct glsl_value glsl_lower_source(struct glsl_lowering *l, const struct glsl_variable *variable)
{
    struct glsl_operand coord = {.file = GLSL_FILE_SOURCE, .number = GLSL_SOURCE_COORD, .swizzle = GLSL_XYZW};
    return glsl_value_of(variable->type, variable->builtin == GLSL_FRAG_COORD     ? coord
                                         : variable->builtin == GLSL_FRONT_FACING ? l->facing
                                                                                  : l->point);
}

/* --- Results -------------------------------------------------------------------------------------------- */

/* The use of a temporary by the code; for those that are moved to results. */
struct use {
    bool read, fixed;
    uint8_t mask;
};

static void note_source(struct glsl_code *code, struct use *use, const struct glsl_operand *x)
{
    if (x->access)
        use[x->index].read = true;
    if (x->file != GLSL_FILE_TEMPORARY)
        return;
    use[x->number].read = true;
    for (uint32_t i = 0; x->access && i < code->access[x->access].registers; i++)
        use[code->access[x->access].first + i].read = true;
}

static struct use *find_uses(struct glsl_code *code)
{
    struct use *use = glsl_take(code->arena, (code->temporaries + 1) * sizeof *use);
    for (uint32_t i = 0; i < code->count; i++) {
        const struct glsl_instruction *x = &code->instruction[i];
        for (unsigned k = 0; k < glsl_ops[x->op].sources; k++)
            note_source(code, use, &x->from[k]);
        if (x->to.access)
            note_source(code, use, &x->to);
        if (x->to.file != GLSL_FILE_TEMPORARY)
            continue;
        use[x->to.number].mask |= x->mask;
        use[x->to.number].fixed |= glsl_ops[x->op].kind == GLSL_FIXED || glsl_ops[x->op].kind == GLSL_APART;
    }
    return use;
}

/* A result: a register of a value to a register of a file. */
struct move {
    struct glsl_operand from, to;
    uint8_t mask;
};

struct moves {
    struct move move[256];
    unsigned count;
};

static void add_move(struct moves *moves, struct glsl_lowering *l, const struct glsl_value *value, unsigned i,
                     enum glsl_file file, unsigned number)
{
    if (moves->count == sizeof moves->move / sizeof *moves->move) {
        glsl_code_fail(&l->code, "more than 256 vectors of results");
        return;
    }
    struct glsl_operand to = {.file = (uint8_t)file, .number = number, .swizzle = GLSL_XYZW};
    moves->move[moves->count++] =
        (struct move){glsl_value_part(l, value, i), to, (uint8_t)glsl_mask(glsl_value_rows(value->type, i))};
}

static void add_varyings(struct moves *moves, struct glsl_lowering *l)
{
    const struct glsl_slots *slots = &l->code.varying;
    for (unsigned s = 0; s < slots->count; s++) {
        struct glsl_value value = glsl_value_variable(l, slots->slot[s].variable);
        for (uint32_t i = 0; i < slots->slot[s].registers; i++)
            add_move(moves, l, &value, i, GLSL_FILE_VARYING, slots->slot[s].first + i);
    }
}

/* An element of gl_FragData that no instruction writes is not a result. */
static bool is_written(const struct glsl_code *code, const struct glsl_value *value, unsigned i)
{
    for (uint32_t k = 0; k < code->count; k++) {
        const struct glsl_operand *to = &code->instruction[k].to;
        if (to->file == GLSL_FILE_TEMPORARY &&
            (to->number == value->root + i || (to->access && code->access[to->access].first == value->root)))
            return true;
    }
    return false;
}

static void add_builtin(struct moves *moves, struct glsl_lowering *l, enum glsl_builtin_variable id,
                        enum glsl_result result)
{
    const struct glsl_value *value = &l->result[id];
    for (unsigned i = 0; l->has_result >> id & 1 && i < value->registers; i++)
        if (is_written(&l->code, value, i))
            add_move(moves, l, value, i, GLSL_FILE_RESULT, (unsigned)result + i);
}

/* A shader that does not write gl_Position has an undefined one; here it is 0. */
static void add_position(struct moves *moves, struct glsl_lowering *l)
{
    static const union glsl_scalar zero[4];
    struct glsl_value value = glsl_value_constant(glsl_type_of(GLSL_FLOAT, 4, 1), zero);
    if (l->has_result >> GLSL_POSITION & 1)
        value = l->result[GLSL_POSITION];
    add_move(moves, l, &value, 0, GLSL_FILE_RESULT, GLSL_RESULT_POSITION);
}

/* A variable that is only written is replaced by the result itself. A varying can get other components, so
 * instructions whose results cannot be moved keep the variable. */
static bool can_be_result(const struct use *use, const struct move *move)
{
    return move->from.file == GLSL_FILE_TEMPORARY && !use[move->from.number].read &&
           use[move->from.number].mask == move->mask &&
           !(use[move->from.number].fixed && move->to.file == GLSL_FILE_VARYING);
}

static void emit_moves(struct glsl_lowering *l, const struct moves *moves)
{
    struct glsl_code *code = &l->code;
    struct use *use = find_uses(code);
    uint8_t *renamed = glsl_take(code->arena, code->temporaries + 1); /* 1 + number of the move */
    uint32_t count = code->count;
    for (unsigned m = 0; m < moves->count; m++)
        if (m < 255 && can_be_result(use, &moves->move[m]))
            renamed[moves->move[m].from.number] = (uint8_t)(m + 1);
        else
            glsl_emit(code, GLSL_OP_MOV, moves->move[m].to, moves->move[m].mask, &moves->move[m].from);
    for (uint32_t i = 0; i < count; i++) {
        struct glsl_operand *to = &code->instruction[i].to;
        if (to->file == GLSL_FILE_TEMPORARY && renamed[to->number]) {
            const struct glsl_operand *result = &moves->move[renamed[to->number] - 1].to;
            to->file = result->file;
            to->number = result->number;
        }
    }
}

static void emit_results(struct glsl_lowering *l)
{
    struct moves *moves = glsl_take(l->code.arena, sizeof *moves);
    if (l->code.unit->stage == GLSL_VERTEX) {
        add_position(moves, l);
        add_builtin(moves, l, GLSL_POINT_SIZE, GLSL_RESULT_POINT_SIZE);
        add_varyings(moves, l);
    } else {
        add_builtin(moves, l, GLSL_FRAG_DEPTH, GLSL_RESULT_DEPTH);
        add_builtin(moves, l, GLSL_FRAG_COLOR, GLSL_RESULT_COLOR);
        add_builtin(moves, l, GLSL_FRAG_DATA, GLSL_RESULT_COLOR);
        add_builtin(moves, l, GLSL_SECOND_COLOR, GLSL_RESULT_SECOND);
        add_builtin(moves, l, GLSL_SECOND_DATA, GLSL_RESULT_SECOND);
    }
    if (!l->code.failure)
        emit_moves(l, moves);
}

/* --- All ------------------------------------------------------------------------------------------------ */

static void lower_main(struct glsl_lowering *l)
{
    const struct glsl_unit *unit = l->code.unit;
    struct glsl_expression call = {.operation = GLSL_CALL, .type = unit->main->type, .function = unit->main};
    begin_facing(l);
    begin_point(l);
    for (const struct glsl_statement *s = unit->initial; s; s = s->next)
        glsl_lower_global(l, s);
    glsl_lower_call(l, &call);
}

struct glsl_lowering *glsl_lower(struct glsl_arena *arena, const struct glsl_unit *unit)
{
    struct glsl_lowering *l = GLSL_NEW(arena, struct glsl_lowering);
    l->code.arena = arena;
    l->code.unit = unit;
    l->code.parent = GLSL_NEW(arena, uint32_t);
    l->code.parent_room = l->code.regions = 1;
    lower_main(l);
    if (!l->code.failure)
        emit_results(l);
    return l;
}
