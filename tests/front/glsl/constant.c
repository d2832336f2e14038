/* Values of constant expressions. */
#include "tests/front/glsl/source.h"

#include <stdio.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static struct glsl_unit *constant(const char *type, const char *expression)
{
    char source[512], *log;
    snprintf(source, sizeof source, "struct S { int i; vec2 v; };\nconst %s value = %s;\nvoid main() {}\n",
             type, expression);
    struct glsl_unit *unit = compile(GLSL_FRAGMENT, source, &log);
    TEST_ASSERT_NOT_NULL_MESSAGE(unit, log);
    free(log);
    return unit;
}

struct value {
    const char *type, *expression;
    float expected[16];
};

static void check_floats(const struct value *row)
{
    struct glsl_unit *unit = constant(row->type, row->expression);
    for (unsigned i = 0; i < glsl_scalars(unit->global->type); i++)
        TEST_ASSERT_FLOAT_WITHIN_MESSAGE(1e-6f, row->expected[i], unit->global->value[i].f, row->expression);
    glsl_unit_free(unit);
}

static void floats_have_values(void)
{
    static const struct value rows[] = {
        {"float", "1.5e1 + .5 - 2.", {13.5f}},
        {"float", "float(7) / 2.0", {3.5f}},
        {"float", "true ? 1.0 : 2.0", {1}},
        {"vec3", "vec3(2)", {2, 2, 2}},
        {"vec4", "vec4(vec2(1, 2), 3, true)", {1, 2, 3, 1}},
        {"vec2", "vec4(1, 2, 3, 4).wx", {4, 1}},
        {"vec2", "vec2(vec4(1, 2, 3, 4))", {1, 2}},
        {"float", "vec3(1, 2, 3)[1]", {2}},
        {"mat2", "mat2(3)", {3, 0, 0, 3}},
        {"mat2", "mat2(1, 2, 3, 4) * mat2(0, 1, 1, 0)", {3, 4, 1, 2}},
        {"vec2", "mat2(1, 2, 3, 4) * vec2(1, 10)", {31, 42}},
        {"vec2", "vec2(1, 10) * mat2(1, 2, 3, 4)", {21, 43}},
        {"vec2", "mat2(1, 2, 3, 4)[1]", {3, 4}},
        {"mat3", "mat3(mat2(5, 6, 7, 8))", {5, 6, 0, 7, 8, 0, 0, 0, 1}},
        {"mat2", "matrixCompMult(mat2(1, 2, 3, 4), mat2(2))", {2, 0, 0, 8}},
        {"vec2", "S(1, vec2(2, 3)).v", {2, 3}},
        {"vec2", "-vec2(1, -2)", {-1, 2}},
        {"vec2", "2.0 - vec2(1, 3)", {1, -1}},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
        check_floats(&rows[i]);
}

static void functions_have_values(void)
{
    static const struct value rows[] = {
        {"float", "sin(1.0)", {0.84147098f}},
        {"float", "atan(1.0, -1.0)", {2.35619449f}},
        {"vec2", "pow(vec2(2, 3), vec2(3, 2))", {8, 9}},
        {"float", "mod(-1.5, 1.0)", {0.5f}},
        {"vec2", "clamp(vec2(-1, 2), 0.0, 1.0)", {0, 1}},
        {"vec2", "mix(vec2(0), vec2(2, 4), 0.25)", {0.5f, 1}},
        {"vec2", "step(1.0, vec2(0.5, 1.0))", {0, 1}},
        {"float", "smoothstep(0.0, 2.0, 1.0)", {0.5f}},
        {"float", "length(vec2(3, 4))", {5}},
        {"float", "distance(vec2(1), vec2(4, 5))", {5}},
        {"float", "dot(vec3(1, 2, 3), vec3(4, 5, 6))", {32}},
        {"vec3", "cross(vec3(1, 0, 0), vec3(0, 1, 0))", {0, 0, 1}},
        {"vec2", "normalize(vec2(3, 4))", {0.6f, 0.8f}},
        {"vec2", "reflect(vec2(1, -1), vec2(0, 1))", {1, 1}},
        {"vec2", "refract(vec2(0, -1), vec2(0, 1), 1.0)", {0, -1}},
        {"vec2", "faceforward(vec2(0, 1), vec2(0, 1), vec2(0, 1))", {0, -1}},
        {"float", "radians(180.0) / acos(-1.0)", {1}},
        {"float", "dFdx(3.0)", {0}},
        {"float", "fract(-0.25) + sign(-3.0) + abs(-2.0) + floor(1.9) + ceil(1.1)", {4.75f}},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
        check_floats(&rows[i]);
}

static void whole_numbers_and_bools_have_values(void)
{
    static const struct {
        const char *type, *expression;
        int expected[4];
    } rows[] = {
        {"int", "0x10 + 010 + 10", {34}},
        {"int", "7 / 2 * 2", {6}},
        {"int", "int(-2.9)", {-2}},
        {"int", "int(1e20)", {2147483647}},
        {"int", "7 / (1 - 1)", {0}},
        {"ivec2", "ivec2(1, 2) * 3", {3, 6}},
        {"bool", "1 < 2 && 2.0 >= 2.0 ^^ false", {1}},
        {"bool", "vec2(1, 2) == vec2(1, 2)", {1}},
        {"bool", "S(1, vec2(2)) != S(1, vec2(3))", {1}},
        {"bvec2", "lessThan(vec2(1, 2), vec2(2, 1))", {1, 0}},
        {"bvec2", "not(equal(ivec2(1, 2), ivec2(1, 3)))", {0, 1}},
        {"bool", "any(bvec2(false, true)) && !all(bvec2(false, true))", {1}},
        {"bool", "bool(0.5)", {1}},
        {"int", "gl_MaxDrawBuffers / gl_MaxDrawBuffers", {1}},
        {"int", "true ? S(4, vec2(0)).i : 0", {4}},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct glsl_unit *unit = constant(rows[i].type, rows[i].expression);
        for (unsigned c = 0; c < glsl_scalars(unit->global->type); c++)
            TEST_ASSERT_EQUAL_INT_MESSAGE(rows[i].expected[c], unit->global->value[c].i, rows[i].expression);
        glsl_unit_free(unit);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(floats_have_values);
    RUN_TEST(functions_have_values);
    RUN_TEST(whole_numbers_and_bools_have_values);
    return UNITY_END();
}
