#include "front/glsl/type.h"

bool glsl_same_type(struct glsl_type a, struct glsl_type b)
{
    return a.base == b.base && a.rows == b.rows && a.columns == b.columns && a.array == b.array &&
           a.record == b.record;
}

struct glsl_type glsl_element_type(struct glsl_type type)
{
    if (type.array)
        type.array = 0;
    else if (type.columns > 1)
        type.columns = 1;
    else
        type.rows = 1;
    return type;
}

unsigned glsl_scalars(struct glsl_type type)
{
    unsigned count = (unsigned)type.rows * type.columns;
    if (type.base == GLSL_STRUCT) {
        count = 0;
        for (unsigned i = 0; i < type.record->count; i++)
            count += glsl_scalars(type.record->field[i].type);
    }
    return type.array ? count * (unsigned)type.array : count;
}

static bool any_field(struct glsl_type type, bool (*test)(struct glsl_type))
{
    for (unsigned i = 0; type.base == GLSL_STRUCT && i < type.record->count; i++)
        if (test(type.record->field[i].type))
            return true;
    return false;
}

bool glsl_has_array(struct glsl_type type)
{
    return type.array || any_field(type, glsl_has_array);
}

bool glsl_has_sampler(struct glsl_type type)
{
    return glsl_is_sampler(type) || any_field(type, glsl_has_sampler);
}

static const char *plain_name(struct glsl_arena *arena, struct glsl_type type)
{
    static const char *const scalar[] = {"void", "float", "int", "bool", "sampler2D", "samplerCube"};
    static const char *const vector[] = {"", "vec", "ivec", "bvec"};
    if (type.base == GLSL_ERROR)
        return "an error";
    if (type.base == GLSL_STRUCT)
        return *type.record->name ? type.record->name : "a structure without a name";
    if (type.columns > 1)
        return glsl_format(arena, "mat%d", type.columns);
    if (type.rows > 1)
        return glsl_format(arena, "%s%d", vector[type.base], type.rows);
    return scalar[type.base];
}

const char *glsl_type_name(struct glsl_arena *arena, struct glsl_type type)
{
    const char *name = plain_name(arena, type);
    return type.array ? glsl_format(arena, "%s[%d]", name, type.array) : name;
}
