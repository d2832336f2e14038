#include "front/glsl/lower/code.h"

#include <string.h>

const struct glsl_op_row glsl_ops[GLSL_OPS] = {
#define GLSL_OP(id, text, sources, kind) [GLSL_OP_##id] = {text, sources, GLSL_##kind},
#include "front/glsl/lower/op.def"
#undef GLSL_OP
};

void glsl_code_fail(struct glsl_code *code, const char *reason)
{
    if (!code->failure)
        code->failure = reason;
}

/* Room for one more element of an array in the arena. */
static void *grown(struct glsl_code *code, void *array, uint32_t count, uint32_t needed, uint32_t *room,
                   size_t bytes)
{
    enum { LEAST = 64 };
    if (needed <= *room)
        return array;
    while (*room < needed)
        *room = *room ? 2 * *room : LEAST;
    void *larger = glsl_take(code->arena, *room * bytes);
    if (count)
        memcpy(larger, array, count * bytes);
    return larger;
}

#define GROW(code, array, count, more, room)                                                                 \
    ((code)->array = grown((code), (code)->array, (code)->count, (code)->count + (more), &(code)->room,      \
                           sizeof *(code)->array))

/* --- Registers ------------------------------------------------------------------------------------------ */

uint32_t glsl_code_temporary(struct glsl_code *code, unsigned count)
{
    enum { MOST = 1 << 20 };
    uint32_t first = code->temporaries;
    if (first + count > MOST) {
        glsl_code_fail(code, "more temporaries than can be allocated");
        return 0;
    }
    GROW(code, temporary, temporaries, count, temporary_room);
    for (unsigned i = 0; i < count; i++)
        code->temporary[first + i] = (struct glsl_temporary){.home = code->region};
    code->temporaries += count;
    return first;
}

uint32_t glsl_registers(struct glsl_type type)
{
    uint32_t count = type.columns;
    if (type.base == GLSL_STRUCT) {
        count = 0;
        for (unsigned i = 0; i < type.record->count; i++)
            count += glsl_registers(type.record->field[i].type);
    }
    return type.array ? count * (uint32_t)type.array : count;
}

struct glsl_slot *glsl_code_slot(struct glsl_code *code, struct glsl_slots *slots,
                                 const struct glsl_variable *variable)
{
    for (unsigned i = 0; i < slots->count; i++)
        if (slots->slot[i].variable == variable)
            return &slots->slot[i];
    if (slots->count == slots->room) {
        struct glsl_slot *old = slots->slot;
        slots->room = slots->room ? 2 * slots->room : 16;
        slots->slot = glsl_take(code->arena, slots->room * sizeof *old);
        if (old)
            memcpy(slots->slot, old, slots->count * sizeof *old);
    }
    struct glsl_slot *slot = &slots->slot[slots->count++];
    *slot = (struct glsl_slot){variable, slots->registers, glsl_registers(variable->type)};
    slots->registers += slot->registers;
    return slot;
}

/* --- Operands ------------------------------------------------------------------------------------------- */

struct glsl_operand glsl_operand_temporary(uint32_t number, unsigned rows)
{
    return (struct glsl_operand){
        .file = GLSL_FILE_TEMPORARY, .number = number, .swizzle = rows == 1 ? GLSL_XXXX : GLSL_XYZW};
}

struct glsl_operand glsl_operand_swizzled(struct glsl_operand operand, uint8_t swizzle)
{
    unsigned result = 0;
    for (unsigned i = 0; i < 4; i++)
        result |= glsl_component(operand.swizzle, glsl_component(swizzle, i)) << 2 * i;
    operand.swizzle = (uint8_t)result;
    return operand;
}

struct glsl_operand glsl_operand_scalar(struct glsl_operand operand, unsigned component)
{
    operand.swizzle = glsl_replicate(glsl_component(operand.swizzle, component));
    return operand;
}

struct glsl_operand glsl_operand_negative(struct glsl_operand operand)
{
    operand.negative = !operand.negative;
    return operand;
}

static bool same_bits(float a, float b)
{
    return !memcmp(&a, &b, sizeof a);
}

/* Finds the values in a register of literals, or adds them to it. Returns false if there is no room. */
static bool place_literals(struct glsl_literal *literal, const float *value, unsigned count, uint8_t *swizzle)
{
    struct glsl_literal with = *literal;
    unsigned result = 0;
    for (unsigned i = 0; i < 4; i++) {
        unsigned c = 0;
        while (c < with.count && !same_bits(with.value[c], value[i < count ? i : count - 1]))
            c++;
        if (c == 4)
            return false;
        if (c == with.count)
            with.value[with.count++] = value[i];
        result |= c << 2 * i;
    }
    *literal = with;
    *swizzle = (uint8_t)result;
    return true;
}

struct glsl_operand glsl_operand_literals(struct glsl_code *code, const float *value, unsigned count)
{
    enum { SEARCHED = 16 };
    struct glsl_operand operand = {.file = GLSL_FILE_LITERAL};
    unsigned i = code->literals > SEARCHED ? code->literals - SEARCHED : 0;
    while (i < code->literals && !place_literals(&code->literal[i], value, count, &operand.swizzle))
        i++;
    if (i == GLSL_LITERALS) {
        glsl_code_fail(code, "more literals than there are registers");
        return operand;
    }
    if (i == code->literals)
        place_literals(&code->literal[code->literals++], value, count, &operand.swizzle);
    operand.number = i;
    return operand;
}

struct glsl_operand glsl_operand_literal(struct glsl_code *code, float value)
{
    return glsl_operand_literals(code, &value, 1);
}

/* --- Instructions --------------------------------------------------------------------------------------- */

struct glsl_instruction *glsl_emit(struct glsl_code *code, enum glsl_op op, struct glsl_operand to,
                                   unsigned mask, const struct glsl_operand *from)
{
    if (code->count >= GLSL_MOST_INSTRUCTIONS)
        glsl_code_fail(code, "more than 65000 instructions");
    if (code->failure && code->count)
        return &code->instruction[0];
    GROW(code, instruction, count, 1, room);
    struct glsl_instruction *instruction = &code->instruction[code->count++];
    *instruction =
        (struct glsl_instruction){.op = (uint8_t)op, .mask = (uint8_t)mask, .region = code->region, .to = to};
    for (unsigned i = 0; i < glsl_ops[op].sources; i++)
        instruction->from[i] = from[i];
    if (to.file == GLSL_FILE_TEMPORARY)
        code->temporary[to.number].writes++;
    return instruction;
}

static struct glsl_operand emit_new(struct glsl_code *code, enum glsl_op op, unsigned rows,
                                    const struct glsl_operand *from)
{
    struct glsl_operand to = glsl_operand_temporary(glsl_code_temporary(code, 1), rows);
    glsl_emit(code, op, to, glsl_mask(rows), from);
    return to;
}

struct glsl_operand glsl_emit_1(struct glsl_code *code, enum glsl_op op, unsigned rows, struct glsl_operand a)
{
    return emit_new(code, op, rows, &a);
}

struct glsl_operand glsl_emit_2(struct glsl_code *code, enum glsl_op op, unsigned rows, struct glsl_operand a,
                                struct glsl_operand b)
{
    struct glsl_operand from[] = {a, b};
    return emit_new(code, op, rows, from);
}

struct glsl_operand glsl_emit_3(struct glsl_code *code, enum glsl_op op, unsigned rows, struct glsl_operand a,
                                struct glsl_operand b, struct glsl_operand c)
{
    struct glsl_operand from[] = {a, b, c};
    return emit_new(code, op, rows, from);
}

struct glsl_operand glsl_emit_dot(struct glsl_code *code, unsigned rows, struct glsl_operand a,
                                  struct glsl_operand b)
{
    switch (rows) {
    case 1: return glsl_emit_2(code, GLSL_OP_MUL, 1, a, b);
    case 2: return glsl_emit_3(code, GLSL_OP_DP2, 1, a, b, glsl_operand_literal(code, 0));
    case 3: return glsl_emit_2(code, GLSL_OP_DP3, 1, a, b);
    default: return glsl_emit_2(code, GLSL_OP_DP4, 1, a, b);
    }
}

/* --- Stores --------------------------------------------------------------------------------------------- */

static bool reads(const struct glsl_instruction *x, struct glsl_operand register_)
{
    for (unsigned i = 0; i < glsl_ops[x->op].sources; i++) {
        const struct glsl_operand *from = &x->from[i];
        bool index = from->access && register_.file == GLSL_FILE_TEMPORARY && from->index == register_.number;
        bool block = from->access && from->file == register_.file;
        if ((from->file == register_.file && from->number == register_.number) || index || block)
            return true;
    }
    return x->to.access != 0;
}

static bool writes(const struct glsl_instruction *x, struct glsl_operand register_)
{
    return x->mask && x->to.file == register_.file && (x->to.number == register_.number || x->to.access);
}

/* Finds the first of the instructions that computed all components of a temporary, among the last ones.
 * Returns the count if other code could read or write the temporary or `to` in between. */
static uint32_t first_of(const struct glsl_code *code, struct glsl_operand to, unsigned mask,
                         struct glsl_operand value)
{
    enum { WINDOW = 8 };
    uint32_t found = 0, first = code->count;
    unsigned written = 0;
    for (uint32_t i = code->count; i-- > 0 && code->count - i <= WINDOW;) {
        const struct glsl_instruction *x = &code->instruction[i];
        bool defines = writes(x, value);
        if (glsl_ops[x->op].kind == GLSL_FLOW || x->region != code->region || writes(x, to) ||
            reads(x, value))
            return code->count;
        if (defines) {
            written |= x->mask;
            first = i;
            if (++found == code->temporary[value.number].writes)
                return written == mask ? first : code->count;
        }
        if (reads(x, to))
            return code->count;
    }
    return code->count;
}

/* Returns true if an operand is a register as it is, in the components of a mask. */
static bool is_plain(struct glsl_operand x, unsigned mask)
{
    for (unsigned c = 0; c < 4; c++)
        if (mask >> c & 1 && glsl_component(x.swizzle, c) != c)
            return false;
    return true;
}

static bool can_be_renamed(const struct glsl_code *code, struct glsl_operand value)
{
    return value.file == GLSL_FILE_TEMPORARY && !value.access && !value.negative && !value.absolute &&
           !code->temporary[value.number].variable && !code->temporary[value.number].registers;
}

static void rename_results(struct glsl_code *code, uint32_t first, struct glsl_operand to,
                           struct glsl_operand value)
{
    for (uint32_t i = first; i < code->count; i++)
        if (writes(&code->instruction[i], value)) {
            code->instruction[i].to.file = to.file;
            code->instruction[i].to.number = to.number;
            if (to.file == GLSL_FILE_TEMPORARY)
                code->temporary[to.number].writes++;
        }
    code->temporary[value.number].writes = 0;
}

/* Moves the only component of the last instruction's result to another component. */
static bool rename_scalar(struct glsl_code *code, struct glsl_operand to, unsigned mask,
                          struct glsl_operand value)
{
    struct glsl_instruction *x = code->count ? &code->instruction[code->count - 1] : NULL;
    if (!x || !writes(x, value) || x->region != code->region || code->temporary[value.number].writes != 1 ||
        x->mask & (x->mask - 1) || glsl_ops[x->op].kind == GLSL_FIXED || glsl_ops[x->op].kind == GLSL_APART)
        return false;
    unsigned component = (unsigned)__builtin_ctz(x->mask);
    for (unsigned c = 0; c < 4; c++)
        if (mask >> c & 1 && glsl_component(value.swizzle, c) != component)
            return false;
    for (unsigned i = 0; i < glsl_ops[x->op].sources && glsl_ops[x->op].kind == GLSL_EACH; i++)
        x->from[i] = glsl_operand_scalar(x->from[i], component);
    x->mask = (uint8_t)mask;
    rename_results(code, code->count - 1, to, value);
    return true;
}

void glsl_emit_store(struct glsl_code *code, struct glsl_operand to, unsigned mask, struct glsl_operand value)
{
    if (code->failure)
        return;
    if (!to.access && can_be_renamed(code, value)) {
        uint32_t first = is_plain(value, mask) ? first_of(code, to, mask, value) : code->count;
        if (first < code->count) {
            rename_results(code, first, to, value);
            return;
        }
        if (rename_scalar(code, to, mask, value))
            return;
    }
    glsl_emit(code, GLSL_OP_MOV, to, mask, &value);
}

/* --- Flow control --------------------------------------------------------------------------------------- */

static void enter(struct glsl_code *code)
{
    GROW(code, parent, regions, 1, parent_room);
    code->parent[code->regions] = code->region;
    code->region = code->regions++;
}

static void leave(struct glsl_code *code)
{
    code->region = code->parent[code->region];
}

static struct glsl_instruction *emit_flow(struct glsl_code *code, enum glsl_op op,
                                          const struct glsl_operand *from)
{
    return glsl_emit(code, op, (struct glsl_operand){0}, 0, from);
}

static void open_block(struct glsl_code *code)
{
    if (++code->blocks > GLSL_MOST_BLOCKS)
        glsl_code_fail(code, "more than 64 blocks inside of each other");
    enter(code);
}

void glsl_emit_if(struct glsl_code *code, enum glsl_comparison comparison, struct glsl_operand a,
                  struct glsl_operand b)
{
    struct glsl_operand from[] = {a, b};
    emit_flow(code, GLSL_OP_IF, from)->comparison = (uint8_t)comparison;
    open_block(code);
}

void glsl_emit_else(struct glsl_code *code)
{
    leave(code);
    emit_flow(code, GLSL_OP_ELSE, NULL);
    enter(code);
}

void glsl_emit_endif(struct glsl_code *code)
{
    leave(code);
    emit_flow(code, GLSL_OP_ENDIF, NULL);
    code->blocks--;
}

void glsl_emit_while(struct glsl_code *code)
{
    emit_flow(code, GLSL_OP_WHILE, NULL);
    open_block(code);
    code->has_loop = true;
    if (++code->loops > GLSL_MOST_LOOPS)
        glsl_code_fail(code, "more than 16 loops inside of each other");
}

void glsl_emit_endwhile(struct glsl_code *code)
{
    leave(code);
    emit_flow(code, GLSL_OP_ENDWHILE, NULL);
    code->blocks--;
    code->loops--;
}

void glsl_emit_jump(struct glsl_code *code, enum glsl_op op)
{
    emit_flow(code, op, NULL);
}

void glsl_emit_jump_if(struct glsl_code *code, enum glsl_op op, enum glsl_comparison comparison,
                       struct glsl_operand a, struct glsl_operand b)
{
    struct glsl_operand from[] = {a, b};
    emit_flow(code, op, from)->comparison = (uint8_t)comparison;
}
