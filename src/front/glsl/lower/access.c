/* Parts of variables and values: fields, elements, components (5.5 to 5.7). */
#include "front/glsl/lower/lower.h"

/* --- Relative addresses --------------------------------------------------------------------------------- */

static uint16_t add_access(struct glsl_code *code, const struct glsl_access *access)
{
    if (!code->accesses)
        code->accesses = 1;
    if (code->accesses >= code->access_room) {
        struct glsl_access *old = code->access;
        code->access_room = code->access_room ? 2 * code->access_room : 16;
        code->access = glsl_take(code->arena, code->access_room * sizeof *old);
        for (uint32_t i = 1; old && i < code->accesses; i++)
            code->access[i] = old[i];
    }
    if (code->accesses == UINT16_MAX) {
        glsl_code_fail(code, "more than 65534 indices that are not constant");
        return 0;
    }
    code->access[code->accesses] = *access;
    return (uint16_t)code->accesses++;
}

/* The index in registers: index * stride, added to that of the operand before. */
static struct glsl_operand scaled(struct glsl_lowering *l, const struct glsl_operand *base,
                                  struct glsl_operand index, uint32_t stride)
{
    struct glsl_code *code = &l->code;
    struct glsl_operand before = glsl_operand_temporary(base->index, 1);
    before.swizzle = glsl_replicate(base->index_component);
    if (stride == 1 && !base->access)
        return glsl_value_index(l, index);
    struct glsl_operand factor = glsl_operand_literal(code, (float)stride);
    if (!base->access)
        return glsl_emit_2(code, GLSL_OP_MUL, 1, index, factor);
    return stride == 1 ? glsl_emit_2(code, GLSL_OP_ADD, 1, index, before)
                       : glsl_emit_3(code, GLSL_OP_MAD, 1, index, factor, before);
}

/* Makes the first register of a value that of its element `index`. */
static void add_index(struct glsl_lowering *l, struct glsl_value *value, struct glsl_operand index,
                      uint32_t stride, uint32_t count)
{
    struct glsl_access access = {.first = value->root, .registers = value->registers};
    if (value->at.access)
        access = l->code.access[value->at.access];
    if (access.levels == GLSL_LEVELS) {
        glsl_code_fail(&l->code, "more than 4 indices that are not constant in one operand");
        return;
    }
    access.level[access.levels].stride = stride;
    access.level[access.levels++].count = count;
    struct glsl_operand scaled_index = scaled(l, &value->at, index, stride);
    value->at.index = scaled_index.number;
    value->at.index_component = (uint8_t)glsl_component(scaled_index.swizzle, 0);
    value->at.access = add_access(&l->code, &access);
}

/* --- Elements ------------------------------------------------------------------------------------------- */

static void normalize_scalar(struct glsl_value *value)
{
    if (glsl_is_scalar(value->type))
        value->at = glsl_operand_scalar(value->at, 0);
    else
        value->at.swizzle = GLSL_XYZW;
}

/* Selects an element of an array, or a column. */
static void select_element(struct glsl_lowering *l, struct glsl_value *value, const struct glsl_expression *x)
{
    struct glsl_type element = x->type;
    uint32_t stride = glsl_registers(element);
    uint32_t count = (uint32_t)(value->type.array ? value->type.array : value->type.columns);
    if (x->operand[1]->value)
        value->at.number += stride * (uint32_t)x->operand[1]->value->i;
    else
        add_index(l, value, glsl_lower_operand(l, x->operand[1]), stride, count);
    value->type = element;
    normalize_scalar(value);
}

static void select_field(struct glsl_value *value, const struct glsl_expression *x)
{
    const struct glsl_record *record = value->type.record;
    for (unsigned i = 0; i < x->index; i++)
        value->at.number += glsl_registers(record->field[i].type);
    value->type = x->type;
    normalize_scalar(value);
}

static uint8_t packed_swizzle(const struct glsl_expression *x)
{
    unsigned result = 0;
    for (unsigned i = 0; i < 4; i++)
        result |= (unsigned)x->swizzle[i < x->type.rows ? i : x->type.rows - 1u] << 2 * i;
    return (uint8_t)result;
}

static bool is_component_index(const struct glsl_expression *x)
{
    return x->operation == GLSL_INDEX && glsl_is_vector(x->operand[0]->type);
}

/* Applies the operation of a node to the place of its operand. */
static void apply(struct glsl_lowering *l, struct glsl_place_to *place, const struct glsl_expression *x)
{
    struct glsl_value *value = &place->value;
    if (is_component_index(x)) {
        if (x->operand[1]->value)
            value->at = glsl_operand_scalar(value->at, (unsigned)x->operand[1]->value->i);
        else
            place->component = glsl_value_index(l, glsl_lower_operand(l, x->operand[1]));
        if (x->operand[1]->value)
            value->type = x->type;
    } else if (x->operation == GLSL_INDEX) {
        select_element(l, value, x);
    } else if (x->operation == GLSL_FIELD) {
        select_field(value, x);
    } else {
        value->at = glsl_operand_swizzled(value->at, packed_swizzle(x));
        value->type = x->type;
    }
}

static bool is_part(const struct glsl_expression *x)
{
    return x->operation == GLSL_INDEX || x->operation == GLSL_FIELD || x->operation == GLSL_SWIZZLE;
}

/* A constant has no address: with an index that is not constant it is copied to registers. */
static struct glsl_value addressable(struct glsl_lowering *l, struct glsl_value value)
{
    return value.constant ? glsl_value_copied(l, &value) : value;
}

struct glsl_place_to glsl_lower_place(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_place_to place = {0};
    if (++l->depth > GLSL_MOST_DEPTH)
        glsl_code_fail(&l->code, "an expression of more than 1000 levels");
    if (l->code.failure) {
        place.value = glsl_value_temporary(l, x->type);
    } else if (is_part(x)) {
        place = glsl_lower_place(l, x->operand[0]);
        if (!l->code.failure)
            apply(l, &place, x);
    } else {
        place.value = addressable(l, glsl_lower_expression(l, x));
    }
    l->depth--;
    return place;
}

/* --- Components by an index ----------------------------------------------------------------------------- */

/* 1 in the components whose number is the index, in the order of a vector's components. */
static struct glsl_operand is_component(struct glsl_lowering *l, struct glsl_operand index, unsigned rows)
{
    static const float numbers[] = {0, 1, 2, 3};
    return glsl_emit_2(&l->code, GLSL_OP_SEQ, rows, glsl_operand_literals(&l->code, numbers, rows), index);
}

static struct glsl_value read_component(struct glsl_lowering *l, const struct glsl_place_to *place)
{
    unsigned rows = place->value.type.rows;
    struct glsl_operand is = is_component(l, place->component, rows), at = place->value.at;
    struct glsl_operand result = glsl_operand_scalar(at, 0);
    for (unsigned c = 1; c < rows; c++)
        result = glsl_emit_3(&l->code, GLSL_OP_SELECT, 1, glsl_operand_scalar(is, c),
                             glsl_operand_scalar(at, c), result);
    return glsl_value_of(glsl_element_type(place->value.type), result);
}

struct glsl_value glsl_lower_read(struct glsl_lowering *l, const struct glsl_place_to *place)
{
    return place->component.file ? read_component(l, place) : place->value;
}

struct glsl_value glsl_lower_part(struct glsl_lowering *l, const struct glsl_expression *x)
{
    struct glsl_place_to place = glsl_lower_place(l, x);
    return glsl_lower_read(l, &place);
}

/* --- Writes --------------------------------------------------------------------------------------------- */

/* Writes a vector to components of a register: component i to the one that the swizzle of `to` names. */
static void write_components(struct glsl_lowering *l, struct glsl_operand to, unsigned rows,
                             struct glsl_operand from)
{
    unsigned mask = 0, swizzle = 0;
    for (unsigned i = 0; i < rows; i++) {
        unsigned c = glsl_component(to.swizzle, i);
        mask |= 1u << c;
        swizzle |= i << 2 * c;
    }
    to.swizzle = GLSL_XYZW;
    glsl_emit_store(&l->code, to, mask,
                    rows == 1 ? glsl_operand_scalar(from, 0) : glsl_operand_swizzled(from, (uint8_t)swizzle));
}

static void write_component(struct glsl_lowering *l, const struct glsl_place_to *to,
                            const struct glsl_value *value)
{
    unsigned rows = to->value.type.rows;
    struct glsl_operand is = is_component(l, to->component, rows);
    struct glsl_operand all =
        glsl_emit_3(&l->code, GLSL_OP_SELECT, rows, is, glsl_value_part(l, value, 0), to->value.at);
    write_components(l, to->value.at, rows, all);
}

void glsl_lower_write(struct glsl_lowering *l, const struct glsl_place_to *to, const struct glsl_value *value)
{
    struct glsl_type type = to->value.type;
    if (l->code.failure)
        return;
    if (to->component.file)
        write_component(l, to, value);
    else if (glsl_is_numeric(type) && type.columns == 1 && !type.array)
        write_components(l, to->value.at, type.rows, glsl_value_part(l, value, 0));
    else
        glsl_value_copy(l, &to->value, value);
}
