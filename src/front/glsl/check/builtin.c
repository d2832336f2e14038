#include "front/glsl/check/builtin.h"

#include <string.h>

enum { GLSL_NONE = -1 };

static const struct row {
    const char *name, *result, *parameters;
    uint8_t meaning, stages;
    int8_t extension;
} rows[] = {
#define GLSL_BUILTIN(id, name, result, parameters, stages, extension)                                        \
    {name, result, parameters, GLSL_CALL_##id, stages, GLSL_##extension},
#include "front/glsl/check/builtin.def"
#undef GLSL_BUILTIN
};

enum { ROWS = sizeof rows / sizeof *rows };

static bool is_here(const struct glsl_context *context, unsigned stages)
{
    return stages >> context->stage & 1;
}

/* --- Functions ------------------------------------------------------------------------------------------ */

/* Returns true if a type fits a letter; `size` is that of G, V, I, B and M in this call, 0 before the
 * first. */
static bool fits(char letter, struct glsl_type type, unsigned *size)
{
    static const struct {
        char letter;
        uint8_t base, least, most, columns; /* rows from least to most */
    } letters[] = {
        {'G', GLSL_FLOAT, 1, 4, 1}, {'V', GLSL_FLOAT, 2, 4, 1},      {'I', GLSL_INT, 2, 4, 1},
        {'B', GLSL_BOOL, 2, 4, 1},  {'F', GLSL_FLOAT, 1, 1, 1},      {'2', GLSL_FLOAT, 2, 2, 1},
        {'3', GLSL_FLOAT, 3, 3, 1}, {'4', GLSL_FLOAT, 4, 4, 1},      {'b', GLSL_BOOL, 1, 1, 1},
        {'M', GLSL_FLOAT, 2, 4, 2}, {'S', GLSL_SAMPLER_2D, 1, 1, 1}, {'C', GLSL_SAMPLER_CUBE, 1, 1, 1},
    };
    unsigned i = 0;
    while (letters[i].letter != letter)
        i++;
    bool matrix = letters[i].columns > 1;
    if (type.base != letters[i].base || type.array || type.rows < letters[i].least ||
        type.rows > letters[i].most || (type.columns > 1) != matrix)
        return false;
    if (letters[i].least == letters[i].most)
        return true;
    bool same = !*size || *size == type.rows;
    *size = type.rows;
    return same;
}

/* Returns true if the types fit a row. `next` gives them one after the other. */
static bool fits_row(const struct row *row, const struct glsl_type *types, unsigned count, unsigned *size)
{
    *size = 0;
    if (strlen(row->parameters) != count)
        return false;
    for (unsigned i = 0; i < count; i++)
        if (!fits(row->parameters[i], types[i], size))
            return false;
    return true;
}

static struct glsl_type result_of(const struct row *row, unsigned size)
{
    unsigned rows_of = size ? size : 1;
    switch (*row->result) {
    case 'G': return glsl_type_of(GLSL_FLOAT, rows_of, 1);
    case 'B': return glsl_type_of(GLSL_BOOL, rows_of, 1);
    case 'M': return glsl_type_of(GLSL_FLOAT, rows_of, rows_of);
    case 'b': return glsl_type_of(GLSL_BOOL, 1, 1);
    case '3': return glsl_type_of(GLSL_FLOAT, 3, 1);
    case '4': return glsl_type_of(GLSL_FLOAT, 4, 1);
    default: return glsl_type_of(GLSL_FLOAT, 1, 1);
    }
}

enum { PARAMETERS = 4 };

static const struct row *find(const struct glsl_context *context, const char *name,
                              const struct glsl_type *types, unsigned count, unsigned *size)
{
    for (const struct row *row = rows; row < rows + ROWS; row++)
        if (is_here(context, row->stages) && !strcmp(row->name, name) && fits_row(row, types, count, size))
            return row;
    return NULL;
}

bool glsl_builtin_has(const struct glsl_context *context, const char *name)
{
    for (const struct row *row = rows; row < rows + ROWS; row++)
        if (is_here(context, row->stages) && !strcmp(row->name, name))
            return true;
    return false;
}

static uint8_t highest_precision(const struct glsl_expressions *arguments)
{
    uint8_t precision = 0;
    for (const struct glsl_expression *x = arguments->first; x; x = x->next)
        if (x->type.precision > precision)
            precision = x->type.precision;
    return precision;
}

static bool extension_is_enabled(struct glsl_context *context, struct glsl_place place, const char *name,
                                 int extension)
{
    if (extension < 0 || glsl_extension_enabled(context, (enum glsl_extension)extension, place))
        return true;
    glsl_error(context, place, "found '%s', which needs an extension that the source does not enable", name);
    return false;
}

bool glsl_builtin_find(struct glsl_context *context, struct glsl_place place, const char *name,
                       const struct glsl_expressions *arguments, enum glsl_meaning *meaning,
                       struct glsl_type *result)
{
    struct glsl_type types[PARAMETERS];
    unsigned count = 0, size;
    if (arguments->count > PARAMETERS)
        return false;
    for (const struct glsl_expression *x = arguments->first; x; x = x->next)
        types[count++] = x->type;
    const struct row *row = find(context, name, types, count, &size);
    if (!row)
        return false;
    extension_is_enabled(context, place, name, row->extension);
    *meaning = (enum glsl_meaning)row->meaning;
    *result = result_of(row, size);
    result->precision = highest_precision(arguments);
    return true;
}

bool glsl_builtin_has_parameters(const struct glsl_context *context, const char *name,
                                 const struct glsl_variable *parameters)
{
    struct glsl_type types[PARAMETERS];
    unsigned count = 0, size;
    for (const struct glsl_variable *p = parameters; p; p = p->next) {
        if (count == PARAMETERS)
            return false;
        types[count++] = p->type;
    }
    return find(context, name, types, count, &size);
}

/* --- Variables ------------------------------------------------------------------------------------------ */

static struct glsl_variable *predefine(struct glsl_context *context, const char *name, struct glsl_type type,
                                       enum glsl_storage storage)
{
    struct glsl_symbol *symbol = glsl_symbol_predefine(context, GLSL_VARIABLE_SYMBOL, name);
    struct glsl_variable *variable = GLSL_NEW(&context->arena, struct glsl_variable);
    variable->name = name;
    variable->type = type;
    variable->storage = (uint8_t)storage;
    variable->global = true;
    return symbol->variable = variable;
}

static const struct {
    const char *name;
    size_t array; /* the offset of a member of struct glsl_limits, or NO_ARRAY */
    uint8_t id, base, rows, storage, stages;
    int8_t extension;
} variables[] = {
#define NO_ARRAY                           ((size_t)-1)
#define OFFSET_OF_none                     NO_ARRAY
#define OFFSET_OF_draw_buffers             offsetof(struct glsl_limits, draw_buffers)
#define OFFSET_OF_dual_source_draw_buffers offsetof(struct glsl_limits, dual_source_draw_buffers)
#define GLSL_BUILTIN_VARIABLE(id, name, base, rows, array, storage, stages, extension)                       \
    {name, OFFSET_OF_##array, GLSL_##id, GLSL_##base, rows, GLSL_BUILTIN_##storage, stages, GLSL_##extension},
#include "front/glsl/check/builtin.def"
#undef GLSL_BUILTIN_VARIABLE
};

static const struct {
    const char *name;
    size_t member;
    int8_t extension;
} constants[] = {
#define GLSL_BUILTIN_CONSTANT(name, member, extension)                                                       \
    {name, offsetof(struct glsl_limits, member), GLSL_##extension},
#include "front/glsl/check/builtin.def"
#undef GLSL_BUILTIN_CONSTANT
};

static int limit_at(const struct glsl_context *context, size_t offset)
{
    int value;
    memcpy(&value, (const char *)&context->limits + offset, sizeof value);
    return value;
}

/* gl_DepthRange, a uniform with three fields (7.5). */
static void predefine_depth_range(struct glsl_context *context)
{
    static struct glsl_field fields[] = {
        {"near", {.base = GLSL_FLOAT, .rows = 1, .columns = 1, .precision = GLSL_HIGH}},
        {"far", {.base = GLSL_FLOAT, .rows = 1, .columns = 1, .precision = GLSL_HIGH}},
        {"diff", {.base = GLSL_FLOAT, .rows = 1, .columns = 1, .precision = GLSL_HIGH}}};
    static const struct glsl_record record = {"gl_DepthRangeParameters", fields, 3};
    struct glsl_type type = glsl_type_of(GLSL_STRUCT, 1, 1);
    type.record = &record;
    struct glsl_symbol *symbol = glsl_symbol_predefine(context, GLSL_RECORD_SYMBOL, record.name);
    symbol->record = &record;
    predefine(context, "gl_DepthRange", type, GLSL_UNIFORM);
}

void glsl_builtin_begin(struct glsl_context *context)
{
    for (unsigned i = 0; i < sizeof variables / sizeof *variables; i++) {
        if (!is_here(context, variables[i].stages))
            continue;
        struct glsl_type type = glsl_type_of((enum glsl_base)variables[i].base, variables[i].rows, 1);
        type.precision = GLSL_MEDIUM;
        if (variables[i].array != NO_ARRAY)
            type.array = limit_at(context, variables[i].array);
        struct glsl_variable *variable =
            predefine(context, variables[i].name, type, (enum glsl_storage)variables[i].storage);
        variable->builtin = variables[i].id;
    }
    for (unsigned i = 0; i < sizeof constants / sizeof *constants; i++) {
        union glsl_scalar *value = GLSL_NEW(&context->arena, union glsl_scalar);
        value->i = limit_at(context, constants[i].member);
        struct glsl_type type = glsl_type_of(GLSL_INT, 1, 1);
        type.precision = GLSL_MEDIUM;
        predefine(context, constants[i].name, type, GLSL_CONSTANT_STORAGE)->value = value;
    }
    predefine_depth_range(context);
}

static bool has_draw_buffers(const struct glsl_context *context)
{
    return context->behavior[GLSL_EXT_DRAW_BUFFERS] != GLSL_DISABLED ||
           context->behavior[GLSL_NV_DRAW_BUFFERS] != GLSL_DISABLED;
}

void glsl_builtin_use_constant(struct glsl_context *context, const struct glsl_expression *x)
{
    for (unsigned i = 0; i < sizeof constants / sizeof *constants; i++)
        if (constants[i].extension >= 0 && !strcmp(constants[i].name, x->variable->name))
            extension_is_enabled(context, x->place, x->variable->name, constants[i].extension);
}

void glsl_builtin_use(struct glsl_context *context, struct glsl_expression *x)
{
    unsigned i = 0;
    while (variables[i].id != x->variable->builtin)
        i++;
    context->unit->builtins |= 1u << x->variable->builtin;
    extension_is_enabled(context, x->place, x->variable->name, variables[i].extension);
    if (x->variable->builtin == GLSL_FRAG_DATA && !has_draw_buffers(context))
        x->type.array = 1;
}
