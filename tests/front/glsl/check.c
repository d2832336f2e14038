/* Types, names and qualifiers: sources without errors, and the first report of those with one. */
#include "tests/front/glsl/source.h"

#include <stdio.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void good_vertex_shaders_have_no_report(void)
{
    static const struct row rows[] = {
        {"attribute vec4 p; uniform mat4 m; varying vec2 uv;\n"
         "void main() { gl_Position = m * p; uv = p.xy; gl_PointSize = 2.0; }",
         NULL},
        {"struct M { float s; }; struct L { vec3 d; M m[2]; };\nuniform L lights[3];\n"
         "void main() { gl_Position = vec4(lights[1].m[0].s); }",
         NULL},
        {"float f(const in float x, out float y, inout vec2 z);\n"
         "void main() { float a; vec2 b; f(1.0, a, b); }\n"
         "float f(const in float x, out float y, inout vec2 z) { y = x; z.x += y; return z.y; }",
         NULL},
        {"float f(float x) { return x; } float f(vec2 x) { return x.x; } float sin(int i) { return 0.0; }\n"
         "void main() { f(1.0); f(vec2(1)); sin(1); sin(1.0); }",
         NULL},
        {"void main() { for (int i = 0; i < 3; i++) { if (i == 1) continue; break; } int j; do j++; while (j "
         "< 2);\n"
         "while (bool more = j < 5) { j += 2; } }",
         NULL},
        {"int x = 1;\nvoid main() { int x = x + 1; { float x = 2.0; vec2 y = vec2(x); } x++; }", NULL},
        {"struct S { int i; };\nvoid main() { S S = S(1); int i = S.i; }", NULL},
        {"precision highp float;\nlowp float a; mediump vec3 b;\nvoid main() { a = b.x; }", NULL},
        {"invariant gl_Position; varying vec2 v; invariant v;\nvoid main() { gl_Position = vec4(0); v = "
         "vec2(0); }",
         NULL},
        {"void f(vec4 a[2]) {} void main() { vec4 a[2]; a[0] = vec4(1); f(a); (a[1]).xy = vec2(2); }", NULL},
        {"void main() { gl_Position = vec4(gl_DepthRange.near + gl_DepthRange.diff, 0, 0, "
         "float(gl_MaxVertexAttribs)); }",
         NULL},
        {"void main() { vec4 v = vec4(0); v.wzyx = v.xyzw; v.st++; bvec2 b = bvec2(v.x > 0.0, !true); }",
         NULL},
    };
    CHECK_ROWS(GLSL_VERTEX, rows);
}

static void good_fragment_shaders_have_no_report(void)
{
    static const struct row rows[] = {
        {"uniform sampler2D t; uniform samplerCube c; varying vec3 v;\n"
         "void main() { gl_FragColor = texture2D(t, v.xy, 1.0) + textureCube(c, v) + texture2DProj(t, v); }",
         NULL},
        {"void main() { if (gl_FragCoord.x < 2.0 && gl_FrontFacing) discard; gl_FragData[0] = "
         "vec4(gl_PointCoord, 0, 0); }",
         NULL},
        {"vec4 f(sampler2D s) { return texture2D(s, vec2(0)); } uniform sampler2D t;\nvoid main() { "
         "gl_FragColor = f(t); }",
         NULL},
        {"void main() { gl_FragColor = vec4(dFdx(gl_FragCoord.x) + fwidth(1.0)); }", NULL},
    };
    CHECK_ROWS(GLSL_FRAGMENT, rows);
}

static void wrong_expressions_are_reported(void)
{
    static const struct row rows[] = {
        {"void main() { int i = 1.0; }", "ERROR: 1:1:19: found a value of type float for 'i', expected int"},
        {"void main() { float f = 1.0 + 1; }", "ERROR: 1:1:29: found float + int, which is not defined"},
        {"void main() { x = 1; }", "ERROR: 1:1:15: found 'x', which is not declared, expected a variable"},
        {"void main() { vec2 v; v.z = 1.0; }", "ERROR: 1:1:25: found '.z', expected 1 to 4 components of "
                                               "vec2 by letters of one set: xyzw, rgba, stpq"},
        {"void main() { vec2 v; v.xg; }", "ERROR: 1:1:25: found '.xg', expected 1 to 4 components of vec2 by "
                                          "letters of one set: xyzw, rgba, stpq"},
        {"void main() { vec2 v; v.xx = v; }",
         "ERROR: 1:1:23: found a component twice in what is written, expected each once"},
        {"uniform float u; void main() { u = 1.0; }",
         "ERROR: 1:1:32: found 'u', which is a uniform, expected a variable that can be written"},
        {"void main() { 1 = 2; }",
         "ERROR: 1:1:15: found an expression that cannot be written, expected a variable or a part of one"},
        {"void main() { float a[2]; a[2] = 1.0; }", "ERROR: 1:1:29: found the index 2, expected 0 to 1"},
        {"void main() { float a[2], b[2]; a = b; }",
         "ERROR: 1:1:35: found an assignment of float[2], but arrays cannot be assigned"},
        {"void main() { if (1) ; }", "ERROR: 1:1:19: found a condition of type int, expected bool"},
        {"void main() { float f = true ? 1.0 : 1; }",
         "ERROR: 1:1:30: found float and int around ':', expected the same type"},
        {"void main() { f(1); }", "ERROR: 1:1:15: found a call of 'f', which is not declared"},
        {"void main() { sin(1); }",
         "ERROR: 1:1:15: found a call of 'sin' with (int), expected the types of one of its declarations"},
        {"void main() { vec3(1, 2); }", "ERROR: 1:1:15: found a constructor of vec3 with too few components"},
        {"void main() { vec2(vec2(1), 2); }",
         "ERROR: 1:1:15: found a constructor of vec2 with too many arguments"},
        {"void main() { mat3 m = mat2(1) * mat3(1); }",
         "ERROR: 1:1:32: found mat2 * mat3, which is not defined"},
        {"void main() { int i = 1; i %= 2; }", "ERROR: 1:1:28: found '%=', which is reserved"},
        {"void main() { int i = 1 << 2; }", "ERROR: 1:1:25: found '<<', expected ';' or ','"},
        {"void main() { dFdx(1.0); }", "ERROR: 1:1:15: found a call of 'dFdx', which is not declared"},
    };
    CHECK_ROWS(GLSL_VERTEX, rows);
}

static void wrong_declarations_are_reported(void)
{
    static const struct row rows[] = {
        {"int a; float a; void main() {}",
         "ERROR: 1:1:14: found 'a', which is already declared in this scope"},
        {"int gl_x; void main() {}",
         "ERROR: 1:1:5: found 'gl_x', expected a name that does not begin with gl_"},
        {"const int a; void main() {}",
         "ERROR: 1:1:11: found a declaration of 'a' of a constant without a value"},
        {"int f() { return 1; } const int a = f(); void main() {}",
         "ERROR: 1:1:37: found a value of 'a' that is not a constant expression"},
        {"varying int v; void main() {}",
         "ERROR: 1:1:1: found a varying that is not float, a vector, a matrix or an array of float"},
        {"float a[0]; void main() {}", "ERROR: 1:1:9: found the size 0, expected 1 to 65536"},
        {"float a[]; void main() {}", "ERROR: 1:1:7: found an array without a size, expected a constant"},
        {"void v; void main() {}", "ERROR: 1:1:6: found a declaration of 'v' of type void"},
        {"sampler2D s; void main() {}",
         "ERROR: 1:1:11: found a declaration of 's' with a sampler, expected it as a uniform or a parameter"},
        {"struct S { float a; int a; }; void main() {}", "ERROR: 1:1:25: found the field 'a' twice"},
        {"struct L { struct M { float s; } m; }; void main() {}",
         "ERROR: 1:1:12: found the definition of a structure as the type of a field, expected it before"},
        {"union u; void main() {}", "ERROR: 1:1:1: found 'union'"},
        {"void main() { uniform float f; }",
         "ERROR: 1:1:15: found an attribute, a uniform or a varying in a function, expected it outside"},
        {"void main() {} invariant gl_PointSize; uniform float u; invariant u;",
         "ERROR: 1:1:67: found 'invariant' of 'u', expected a varying or an output"},
    };
    CHECK_ROWS(GLSL_VERTEX, rows);
}

static void wrong_functions_are_reported(void)
{
    static const struct row rows[] = {
        {"int main() { return 1; }", "ERROR: 1:1:5: found another 'main', expected void main()"},
        {"mediump float f(); highp float f() { return 1.0; } void main() {}",
         "ERROR: 1:1:32: found another declaration of 'f', expected the same result and qualifiers"},
        {"void f(); void main() { f(); }",
         "ERROR: 1:1:25: found a call of 'f', which is declared and not defined"},
        {"void f() { f(); } void main() {}",
         "ERROR: 1:1:12: found a call of 'f' by itself, which the language does not have"},
        {"void g(); void f() { g(); } void g() { f(); } void main() {}",
         "ERROR: 1:1:22: found a call of 'g' by itself, which the language does not have"},
        {"void f() {} void f() {} void main() {}", "ERROR: 1:1:18: found a second definition of 'f'"},
        {"float sin(float x) { return x; } void main() {}",
         "ERROR: 1:1:7: found 'sin' with the parameters of a function of the language"},
        {"float f() { return; } void main() {}", "ERROR: 1:1:13: found no value in 'f', expected float"},
        {"void f() { return 1; } void main() {}", "ERROR: 1:1:12: found a value in 'f', which returns none"},
        {"void f(out float x) {} void main() { f(1.0); }",
         "ERROR: 1:1:40: found an expression that cannot be written, expected a variable or a part of one"},
        {"void main() { break; }", "ERROR: 1:1:15: found 'break' outside of a loop"},
        {"void main() { discard; }",
         "ERROR: 1:1:15: found 'discard' in a vertex shader, expected it in a fragment shader"},
        {"void main() { void f(); }", "ERROR: 1:1:20: found a function in a function, expected it outside"},
        {"void f(const out float x) {} void main() {}",
         "ERROR: 1:1:24: found a constant parameter that is out or inout, expected in"},
    };
    CHECK_ROWS(GLSL_VERTEX, rows);
}

#define SECOND "#extension GL_EXT_blend_func_extended : enable\nprecision mediump float; void main() { "

static void a_second_colour_is_a_part_of_its_extension(void)
{
    static const struct row rows[] = {
        {SECOND "gl_FragColor = gl_SecondaryFragColorEXT = vec4(gl_MaxDualSourceDrawBuffersEXT); }", ""},
        {SECOND "gl_FragData[0] = gl_SecondaryFragDataEXT[0] = vec4(1); }", ""},
        {"void main() { gl_SecondaryFragColorEXT.x = 1.0; }",
         "ERROR: 0:1:15: found 'gl_SecondaryFragColorEXT', which needs an extension that the source does not "
         "enable\n"},
        {"void main() { int i = gl_MaxDualSourceDrawBuffersEXT; }",
         "ERROR: 0:1:23: found 'gl_MaxDualSourceDrawBuffersEXT', which needs an extension that the source "
         "does "
         "not enable\n"},
        {SECOND "gl_FragData[0] = gl_SecondaryFragColorEXT = vec4(1); }",
         "ERROR: 0:2:93: found gl_SecondaryFragColorEXT and gl_FragData, expected variables of one kind\n"},
        {SECOND "gl_FragColor = gl_FragData[0] = vec4(1); }",
         "ERROR: 0:2:81: found gl_FragColor and gl_FragData, expected variables of one kind\n"},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *log;
        const char *source = rows[i].source;
        struct glsl_unit *unit = glsl_compile(GLSL_FRAGMENT, &source, NULL, 1, NULL, &log);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(rows[i].line, log, source);
        TEST_ASSERT_EQUAL(!*rows[i].line, unit != NULL);
        glsl_unit_free(unit);
        free(log);
    }
}

static void a_fragment_shader_needs_a_precision(void)
{
    const char *source = "void main() { float f; }";
    char *log;
    struct glsl_unit *unit = glsl_compile(GLSL_FRAGMENT, &source, NULL, 1, NULL, &log);
    TEST_ASSERT_NULL(unit);
    TEST_ASSERT_EQUAL_STRING(
        "ERROR: 0:1:15: found float without a precision, expected lowp, mediump or highp, or a precision "
        "statement before\n",
        log);
    free(log);
}

/* Sources whose nesting exceeds a bound are refused, and do not exhaust the stack. */
static void deep_nesting_is_refused(void)
{
    static char source[400000];
    static const char *const parts[][2] = {{"(", ")"}, {"{", "}"}, {"-", ""}, {"if(true)", ";"}};
    for (unsigned i = 0; i < sizeof parts / sizeof *parts; i++) {
        char *end = source + sprintf(source, "void main() { ");
        for (int n = 0; n < 20000; n++)
            end += sprintf(end, "%s", parts[i][0]);
        sprintf(end, "1; }");
        char *log, *text = source;
        struct glsl_unit *unit = glsl_compile(GLSL_VERTEX, (const char *const *)&text, NULL, 1, NULL, &log);
        TEST_ASSERT_NULL(unit);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(log, "found more than"), log);
        free(log);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(good_vertex_shaders_have_no_report);
    RUN_TEST(good_fragment_shaders_have_no_report);
    RUN_TEST(wrong_expressions_are_reported);
    RUN_TEST(wrong_declarations_are_reported);
    RUN_TEST(wrong_functions_are_reported);
    RUN_TEST(a_second_colour_is_a_part_of_its_extension);
    RUN_TEST(a_fragment_shader_needs_a_precision);
    RUN_TEST(deep_nesting_is_refused);
    return UNITY_END();
}
