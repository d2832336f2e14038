#include "front/glsl/lower/lower.h"

#include <string.h>

struct glsl_value glsl_value_constant(struct glsl_type type, const union glsl_scalar *constant)
{
    return (struct glsl_value){.type = type, .constant = constant};
}

struct glsl_value glsl_value_of(struct glsl_type type, struct glsl_operand at)
{
    return (struct glsl_value){.type = type, .at = at, .root = at.number, .registers = glsl_registers(type)};
}

struct glsl_value glsl_value_temporary(struct glsl_lowering *l, struct glsl_type type)
{
    uint32_t first = glsl_code_temporary(&l->code, glsl_registers(type));
    bool scalar = glsl_is_scalar(type);
    return glsl_value_of(type, glsl_operand_temporary(first, scalar ? 1 : 4));
}

/* --- Registers of a value ------------------------------------------------------------------------------- */

/* The type of register i of a value, and the number of scalars before it. */
static struct glsl_type type_at(struct glsl_type type, unsigned i, unsigned *scalars)
{
    while (type.array || type.base == GLSL_STRUCT || type.columns > 1) {
        if (!type.array && type.base == GLSL_STRUCT) {
            const struct glsl_field *field = type.record->field;
            for (; i >= glsl_registers(field->type); field++) {
                i -= glsl_registers(field->type);
                *scalars += glsl_scalars(field->type);
            }
            type = field->type;
            continue;
        }
        struct glsl_type element = glsl_element_type(type);
        unsigned size = glsl_registers(element);
        *scalars += i / size * glsl_scalars(element);
        i %= size;
        type = element;
    }
    return type;
}

unsigned glsl_value_rows(struct glsl_type type, unsigned i)
{
    unsigned scalars = 0;
    return type_at(type, i, &scalars).rows;
}

static struct glsl_operand constant_part(struct glsl_lowering *l, const struct glsl_value *value, unsigned i)
{
    unsigned scalars = 0;
    struct glsl_type type = type_at(value->type, i, &scalars);
    float numbers[4];
    for (unsigned c = 0; c < type.rows; c++) {
        union glsl_scalar x = value->constant[scalars + c];
        numbers[c] = type.base == GLSL_FLOAT ? x.f : (float)x.i;
    }
    return glsl_operand_literals(&l->code, numbers, type.rows);
}

struct glsl_operand glsl_value_part(struct glsl_lowering *l, const struct glsl_value *value, unsigned i)
{
    if (value->constant)
        return constant_part(l, value, i);
    struct glsl_operand part = value->at;
    part.number += i;
    if (glsl_value_rows(value->type, i) == 1)
        part = glsl_operand_scalar(part, 0);
    return part;
}

void glsl_value_copy(struct glsl_lowering *l, const struct glsl_value *to, const struct glsl_value *from)
{
    unsigned count = glsl_registers(to->type);
    for (unsigned i = 0; i < count && !l->code.failure; i++) {
        struct glsl_operand register_ = to->at;
        register_.number += i;
        glsl_emit_store(&l->code, register_, glsl_mask(glsl_value_rows(to->type, i)),
                        glsl_value_part(l, from, i));
    }
}

struct glsl_value glsl_value_copied(struct glsl_lowering *l, const struct glsl_value *from)
{
    struct glsl_value to = glsl_value_temporary(l, from->type);
    glsl_value_copy(l, &to, from);
    return to;
}

struct glsl_operand glsl_value_index(struct glsl_lowering *l, struct glsl_operand scalar)
{
    bool usable = scalar.file == GLSL_FILE_TEMPORARY && !scalar.access && !scalar.negative &&
                  !scalar.absolute && !l->code.temporary[scalar.number].variable;
    return usable ? scalar : glsl_emit_1(&l->code, GLSL_OP_MOV, 1, scalar);
}

/* --- Variables ------------------------------------------------------------------------------------------ */

static struct glsl_binding_of *find(struct glsl_lowering *l, const struct glsl_variable *variable)
{
    unsigned at = (unsigned)((uintptr_t)variable >> 4) * 2654435761u >> 7;
    for (;; at++) {
        struct glsl_binding_of *binding = &l->binding[at & (l->binding_room - 1)];
        if (!binding->variable || binding->variable == variable)
            return binding;
    }
}

static void make_room(struct glsl_lowering *l)
{
    struct glsl_binding_of *old = l->binding;
    unsigned room = l->binding_room;
    if (2 * l->bindings < room)
        return;
    l->binding_room = room ? 2 * room : 64;
    l->binding = glsl_take(l->code.arena, l->binding_room * sizeof *old);
    for (unsigned i = 0; i < room; i++)
        if (old[i].variable)
            *find(l, old[i].variable) = old[i];
}

/* A temporary that has a name is read again, so its instructions keep their result. */
static void mark_named(struct glsl_code *code, const struct glsl_value *value)
{
    if (value->constant || value->at.file != GLSL_FILE_TEMPORARY || code->failure)
        return;
    for (uint32_t i = 0; i < glsl_registers(value->type); i++)
        code->temporary[value->at.number + i].variable = true;
}

void glsl_value_bind(struct glsl_lowering *l, const struct glsl_variable *variable, struct glsl_value value)
{
    mark_named(&l->code, &value);
    make_room(l);
    struct glsl_binding_of *binding = find(l, variable);
    l->bindings += !binding->variable;
    *binding = (struct glsl_binding_of){variable, value};
}

/* The value of a variable of the interface: registers of a file. */
static struct glsl_value interface_value(struct glsl_lowering *l, const struct glsl_variable *variable,
                                         struct glsl_slots *slots, enum glsl_file file)
{
    struct glsl_slot *slot = glsl_code_slot(&l->code, slots, variable);
    struct glsl_operand at = glsl_operand_temporary(slot->first, glsl_is_scalar(variable->type) ? 1 : 4);
    at.file = (uint8_t)file;
    return glsl_value_of(variable->type, at);
}

/* Varyings and outputs are variables while the shader runs, and moved to results at its end. */
static void note_result(struct glsl_lowering *l, const struct glsl_variable *variable,
                        const struct glsl_value *value)
{
    if (variable->storage == GLSL_VARYING)
        glsl_code_slot(&l->code, &l->code.varying, variable);
    if (variable->storage != GLSL_BUILTIN_OUT)
        return;
    l->result[variable->builtin] = *value;
    l->has_result |= 1u << variable->builtin;
}

struct glsl_value glsl_value_variable(struct glsl_lowering *l, const struct glsl_variable *variable)
{
    make_room(l);
    struct glsl_binding_of *binding = find(l, variable);
    if (binding->variable)
        return binding->value;
    struct glsl_value value;
    if (variable->storage == GLSL_UNIFORM)
        value = interface_value(l, variable, &l->code.uniform, GLSL_FILE_UNIFORM);
    else if (variable->storage == GLSL_ATTRIBUTE)
        value = interface_value(l, variable, &l->code.attribute, GLSL_FILE_ATTRIBUTE);
    else if (variable->storage == GLSL_VARYING && l->code.unit->stage == GLSL_FRAGMENT)
        value = interface_value(l, variable, &l->code.varying, GLSL_FILE_VARYING);
    else if (variable->storage == GLSL_BUILTIN_IN)
        value = glsl_lower_source(l, variable);
    else {
        value = glsl_value_temporary(l, variable->type);
        for (uint32_t i = 0; i < value.registers && !l->code.failure; i++) {
            l->code.temporary[value.root + i].global = variable->global;
            l->code.temporary[value.root + i].home = variable->global ? 0 : l->code.region;
        }
        note_result(l, variable, &value);
    }
    glsl_value_bind(l, variable, value);
    return value;
}
