/* Declarations: qualifiers, precision, structures, variables (chapter 4). */
#include "front/glsl/check/builtin.h"

#include <string.h>

/* --- Precision (4.5) ------------------------------------------------------------------------------------ */

/* Completes a type with the precision in force; reports a missing one. */
static struct glsl_type with_precision(struct glsl_context *context, struct glsl_place place,
                                       struct glsl_type type, unsigned precision)
{
    bool has = type.base == GLSL_FLOAT || type.base == GLSL_INT || glsl_is_sampler(type);
    if (precision && !has)
        glsl_error(context, place,
                   "found a precision of %s, expected it of float, int, their vectors, matrices, or samplers",
                   glsl_type_name(&context->arena, type));
    if (!precision && has)
        precision = context->scopes.scope[context->scopes.depth].precision[type.base];
    if (!precision && has)
        glsl_error(
            context, place,
            "found %s without a precision, expected lowp, mediump or highp, or a precision statement before",
            glsl_type_name(&context->arena, type));
    type.precision = (uint8_t)precision;
    return type;
}

struct glsl_specifier glsl_node_specify(struct glsl_context *context, struct glsl_place place,
                                        struct glsl_type type, unsigned precision)
{
    return (struct glsl_specifier){
        .type = with_precision(context, place, type, precision),
        .defines_record = context->defines_record,
        .place = place,
    };
}

void glsl_check_no_record(struct glsl_context *context, const struct glsl_specifier *specifier,
                          const char *where)
{
    if (specifier->defines_record)
        glsl_error(context, specifier->place,
                   "found the definition of a structure as the type of %s, expected it before", where);
}

void glsl_node_default_precision(struct glsl_context *context, struct glsl_place place, unsigned precision,
                                 struct glsl_type type)
{
    bool good = (glsl_is_scalar(type) && type.base != GLSL_BOOL) || glsl_is_sampler(type);
    if (!good)
        glsl_error(context, place, "found a default precision of %s, expected float, int or a sampler",
                   glsl_type_name(&context->arena, type));
    else
        context->scopes.scope[context->scopes.depth].precision[type.base] = (uint8_t)precision;
}

/* --- Qualifiers (4.3) ----------------------------------------------------------------------------------- */

static bool all_float(struct glsl_type type)
{
    return type.base == GLSL_FLOAT;
}

/* Returns the error in a type with a storage qualifier; null if there is none. */
static const char *wrong_storage(const struct glsl_context *context, enum glsl_storage storage,
                                 struct glsl_type type)
{
    switch (storage) {
    case GLSL_ATTRIBUTE:
        if (context->stage == GLSL_FRAGMENT)
            return "an attribute in a fragment shader, expected it in a vertex shader";
        return all_float(type) ? NULL : "an attribute that is not float, a vector or a matrix of float";
    case GLSL_VARYING:
        return all_float(type) ? NULL
                               : "a varying that is not float, a vector, a matrix or an array of float";
    default: return NULL;
    }
}

struct glsl_specifier glsl_node_qualify(struct glsl_context *context, struct glsl_place place,
                                        enum glsl_storage storage, bool invariant,
                                        struct glsl_specifier specifier)
{
    const char *wrong = wrong_storage(context, storage, specifier.type);
    if (wrong)
        glsl_error(context, place, "found %s", wrong);
    if (storage != GLSL_CONSTANT_STORAGE && context->scopes.depth > 1)
        glsl_error(context, place,
                   "found an attribute, a uniform or a varying in a function, expected it outside");
    specifier.storage = (uint8_t)storage;
    specifier.invariant = invariant;
    specifier.qualified = true;
    return specifier;
}

void glsl_check_empty_declaration(struct glsl_context *context, const struct glsl_specifier *specifier)
{
    if (specifier->type.base != GLSL_STRUCT)
        glsl_warning(context, specifier->place, "found a declaration without a name");
}

void glsl_node_invariant(struct glsl_context *context, struct glsl_place place, const char *name)
{
    const struct glsl_symbol *symbol = glsl_symbol_find(context, name);
    struct glsl_variable *variable = symbol && symbol->kind == GLSL_VARIABLE_SYMBOL ? symbol->variable : NULL;
    bool output = variable && (variable->storage == GLSL_VARYING || variable->storage >= GLSL_BUILTIN_IN);
    if (context->scopes.depth > 1)
        glsl_error(context, place, "found 'invariant' in a function, expected it outside");
    else if (!output)
        glsl_error(context, place, "found 'invariant' of '%s', expected a varying or an output", name);
    else if (variable->read || variable->written)
        glsl_error(context, place, "found 'invariant' of '%s' after its use, expected it before", name);
    else
        variable->invariant = true;
    if (output && variable->storage >= GLSL_BUILTIN_IN)
        context->unit->invariants |= 1u << variable->builtin;
}

/* --- Variables ------------------------------------------------------------------------------------------ */

static const char *type_name(struct glsl_context *context, struct glsl_type type)
{
    return glsl_type_name(&context->arena, type);
}

/* Returns the error in the type of a variable; null if there is none. */
static const char *wrong_type(const struct glsl_specifier *specifier, struct glsl_type type, bool initial)
{
    if (type.base == GLSL_VOID)
        return "of type void";
    if (glsl_has_sampler(type) && specifier->storage != GLSL_UNIFORM)
        return "with a sampler, expected it as a uniform or a parameter";
    if (type.array && specifier->storage == GLSL_ATTRIBUTE)
        return "of an attribute, which cannot be an array";
    if (glsl_has_array(type) && specifier->storage == GLSL_CONSTANT_STORAGE)
        return "of a constant, which cannot be or contain an array";
    if (initial && specifier->storage != GLSL_LOCAL && specifier->storage != GLSL_CONSTANT_STORAGE)
        return "with a value, expected none for attributes, uniforms and varyings";
    if (!initial && specifier->storage == GLSL_CONSTANT_STORAGE)
        return "of a constant without a value";
    return NULL;
}

static void check_initial(struct glsl_context *context, struct glsl_variable *variable,
                          struct glsl_place place, const struct glsl_expression *initial)
{
    if (glsl_has_failed(initial))
        return;
    if (!glsl_same_type(variable->type, initial->type))
        glsl_error(context, place, "found a value of type %s for '%s', expected %s",
                   type_name(context, initial->type), variable->name, type_name(context, variable->type));
    else if (glsl_has_array(variable->type))
        glsl_error(context, place, "found a value for '%s', but arrays have none", variable->name);
    else if ((variable->storage == GLSL_CONSTANT_STORAGE || variable->global) && !initial->value)
        glsl_error(context, initial->place, "found a value of '%s' that is not a constant expression",
                   variable->name);
    else if (variable->storage == GLSL_CONSTANT_STORAGE)
        variable->value = initial->value;
}

static struct glsl_variable *add_variable(struct glsl_context *context,
                                          const struct glsl_specifier *specifier, struct glsl_place place,
                                          const char *name, struct glsl_type type)
{
    struct glsl_variable *variable = GLSL_NEW(&context->arena, struct glsl_variable);
    variable->name = name;
    variable->type = type;
    variable->storage = specifier->storage;
    variable->place = place;
    variable->global = context->scopes.depth == 1;
    variable->invariant = specifier->invariant;
    return variable;
}

static void add_global(struct glsl_context *context, struct glsl_variable *variable,
                       struct glsl_statement *declaration)
{
    struct glsl_unit *unit = context->unit;
    *unit->last_global = variable;
    unit->last_global = &variable->next;
    if (!declaration->expression || variable->storage == GLSL_CONSTANT_STORAGE)
        return;
    *unit->last_initial = declaration;
    unit->last_initial = &declaration->next;
}

struct glsl_statement *glsl_node_declare(struct glsl_context *context, const struct glsl_specifier *specifier,
                                         struct glsl_place place, const char *name,
                                         struct glsl_expression *size, struct glsl_expression *initial,
                                         bool has_size)
{
    struct glsl_type type = specifier->type;
    if (has_size)
        type.array = glsl_check_array_size(context, place, size);
    const char *wrong = wrong_type(specifier, type, initial);
    if (wrong)
        glsl_error(context, place, "found a declaration of '%s' %s", name, wrong);
    struct glsl_variable *variable = add_variable(context, specifier, place, name, type);
    if (initial && !wrong)
        check_initial(context, variable, place, initial);
    struct glsl_symbol *symbol = glsl_symbol_add(context, GLSL_VARIABLE_SYMBOL, name, place);
    if (!symbol)
        return NULL;
    symbol->variable = variable;
    struct glsl_statement *declaration = glsl_node_statement(context, GLSL_DECLARATION, place);
    declaration->variable = variable;
    declaration->expression = initial;
    if (variable->global)
        add_global(context, variable, declaration);
    return declaration;
}

/* --- Structures (4.1.8) --------------------------------------------------------------------------------- */

void glsl_node_add_member(struct glsl_context *context, struct glsl_members *members, struct glsl_place place,
                          struct glsl_type type, const char *name, struct glsl_expression *size,
                          bool has_size)
{
    struct glsl_member *member = GLSL_NEW(&context->arena, struct glsl_member);
    if (has_size)
        type.array = glsl_check_array_size(context, place, size);
    if (type.base == GLSL_VOID)
        glsl_error(context, place, "found the field '%s' of type void", name);
    *member = (struct glsl_member){name, type, place, NULL};
    if (members->last)
        members->last->next = member;
    else
        members->first = member;
    members->last = member;
    members->count++;
}

static void check_members(struct glsl_context *context, const struct glsl_members *members)
{
    for (const struct glsl_member *a = members->first; a; a = a->next)
        for (const struct glsl_member *b = members->first; b != a; b = b->next)
            if (!strcmp(a->name, b->name))
                glsl_error(context, a->place, "found the field '%s' twice", a->name);
}

struct glsl_type glsl_node_record(struct glsl_context *context, struct glsl_place place, const char *name,
                                  const struct glsl_members *members)
{
    struct glsl_record *record = GLSL_NEW(&context->arena, struct glsl_record);
    struct glsl_type type = glsl_type_of(GLSL_STRUCT, 1, 1);
    unsigned i = 0;
    check_members(context, members);
    record->name = name;
    record->count = members->count;
    record->field = glsl_take(&context->arena, members->count * sizeof *record->field);
    for (const struct glsl_member *m = members->first; m; m = m->next)
        record->field[i++] = (struct glsl_field){m->name, m->type};
    struct glsl_symbol *symbol = *name ? glsl_symbol_add(context, GLSL_RECORD_SYMBOL, name, place) : NULL;
    if (symbol)
        symbol->record = record;
    type.record = record;
    return type;
}

/* --- layout(...) out; --- */

void glsl_check_blend_support(struct glsl_context *context, struct glsl_place place, const char *name)
{
    static const char *const qualifiers[] = {
#define GLSL_BLEND(name, value, qualifier) "blend_support_" qualifier,
#include "front/glsl/blend.def"
#undef GLSL_BLEND
    };
    enum { COUNT = sizeof qualifiers / sizeof *qualifiers };
    unsigned i = 0;
    glsl_extension_enabled(context, GLSL_KHR_BLEND_EQUATION_ADVANCED, place);
    while (i < COUNT && strcmp(name, qualifiers[i]))
        i++;
    if (i < COUNT)
        context->unit->blends |= (uint16_t)(1u << i);
    else if (!strcmp(name, "blend_support_all_equations"))
        context->unit->blends = (1u << COUNT) - 1;
    else
        glsl_error(context, place, "found '%s', expected a qualifier such as blend_support_multiply", name);
}
