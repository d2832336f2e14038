/* Programs of two stages: errors of linking, active uniforms and attributes, and their places. */
#include "front/glsl/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static struct glsl_unit *compile(enum glsl_stage stage, const char *source)
{
    char *log;
    struct glsl_unit *unit = glsl_compile(stage, &source, NULL, 1, NULL, &log);
    TEST_ASSERT_NOT_NULL_MESSAGE(unit, log);
    free(log);
    return unit;
}

static struct glsl_program *link_bound(const char *vertex, const char *fragment,
                                       const struct glsl_binding *bindings, unsigned count, char **log)
{
    struct glsl_unit *v = compile(GLSL_VERTEX, vertex), *f = compile(GLSL_FRAGMENT, fragment);
    struct glsl_program *program = glsl_link(v, f, bindings, count, log);
    glsl_unit_free(v);
    glsl_unit_free(f);
    return program;
}

static struct glsl_program *link_good(const char *vertex, const char *fragment)
{
    char *log;
    struct glsl_program *program = link_bound(vertex, fragment, NULL, 0, &log);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, log);
    TEST_ASSERT_EQUAL_STRING("", log);
    free(log);
    return program;
}

#define FRAGMENT "precision mediump float;\n"
#define NOTHING  "void main() { gl_Position = vec4(0); }"

/* --- Errors --------------------------------------------------------------------------------------------- */

static void errors_name_what_was_found(void)
{
    static const struct {
        const char *vertex, *fragment, *line;
    } rows[] = {
        {NOTHING, FRAGMENT "varying vec2 a; void main() { gl_FragColor = a.xyxy; }",
         "ERROR: found the varying 'a' in the fragment shader, expected it in the vertex shader too\n"},
        {"varying vec3 a; " NOTHING, FRAGMENT "varying vec2 a; void main() { gl_FragColor = a.xyxy; }",
         "ERROR: found the varying 'a' as vec3 and as vec2, expected the same type\n"},
        {"invariant varying vec2 a; " NOTHING,
         FRAGMENT "varying vec2 a; void main() { gl_FragColor = a.xyxy; }",
         "ERROR: found the varying 'a' invariant in the vertex shader only, expected it in both\n"},
        {NOTHING, FRAGMENT "float f() { return 1.0 / 0.0; }",
         "ERROR: found no 'main' in the fragment shader, expected void main()\n"},
        {NOTHING, FRAGMENT "invariant gl_FragCoord; void main() { gl_FragColor = gl_FragCoord; }",
         "ERROR: found gl_FragCoord invariant and gl_Position not, expected both\n"},
        {"uniform vec3 a; " NOTHING, FRAGMENT "uniform vec2 a; void main() { gl_FragColor = a.xyxy; }",
         "ERROR: found the uniform 'a' as vec3 and as vec2, expected the same type\n"},
        {"uniform float a; void main() { gl_Position = vec4(a); }",
         FRAGMENT "uniform float a; void main() { gl_FragColor = vec4(a); }",
         "ERROR: found the uniform 'a' with two precisions, expected the same one\n"},
        {"struct S { vec2 x; }; uniform S a; " NOTHING,
         FRAGMENT "struct S { vec2 y; }; uniform S a; void main() { gl_FragColor = a.y.xyxy; }",
         "ERROR: found the uniform 'a' as S and as S, expected the same type\n"},
        {"varying vec4 a[9]; void main() { a[0] = vec4(0); }",
         FRAGMENT "varying vec4 a[9]; void main() { gl_FragColor = a[8]; }",
         "ERROR: found varyings that need more than 8 vectors, expected at most these\n"},
        {"uniform vec4 a[257]; void main() { gl_Position = a[256]; }", FRAGMENT "void main() {}",
         "ERROR: found uniforms of the vertex shader that need more than 256 vectors\n"},
        {NOTHING,
         FRAGMENT "uniform sampler2D s[17]; void main() { gl_FragColor = texture2D(s[16], vec2(0)); }",
         "ERROR: found 17 samplers in the fragment shader, expected at most 16\n"},
        {"attribute vec4 a, b, c, d; attribute mat4 e, f, g, h; void main() { gl_Position = (e + f + g + h) "
         "* (a + b + c "
         "+ d); }",
         FRAGMENT "void main() {}",
         "ERROR: found no free locations for the attribute 'a', expected 1 of 16\n"},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *log;
        struct glsl_program *program = link_bound(rows[i].vertex, rows[i].fragment, NULL, 0, &log);
        TEST_ASSERT_NULL_MESSAGE(program, rows[i].line);
        TEST_ASSERT_EQUAL_STRING_LEN(rows[i].line, log, strlen(rows[i].line));
        free(log);
    }
}

static void some_differences_are_allowed(void)
{
    static const struct {
        const char *vertex, *fragment;
    } rows[] = {
        {NOTHING, FRAGMENT "varying vec2 a; void main() {}"},
        {"varying highp vec2 a; void main() { a = vec2(0); }",
         FRAGMENT "varying lowp vec2 a; void main() { gl_FragColor = a.xyxy; }"},
        {"uniform float a; " NOTHING, FRAGMENT "uniform float a; void main() { gl_FragColor = vec4(a); }"},
        {"invariant gl_Position; " NOTHING,
         FRAGMENT "invariant gl_FragCoord; void main() { gl_FragColor = gl_FragCoord; }"},
        {"#pragma STDGL invariant(all)\nvarying vec2 a; void main() { a = vec2(0); gl_Position = a.xyxy; }",
         FRAGMENT "varying vec2 a; void main() { gl_FragColor = a.xyxy; }"},
        {"varying vec2 a; void main() { a = vec2(0); }",
         "#pragma STDGL invariant(all)\n" FRAGMENT "varying vec2 a; void main() { gl_FragColor = a.xyxy; }"},
        {"#pragma STDGL invariant(all)\nvarying vec2 a; void main() { a = vec2(0); gl_Position = a.xyxy; }",
         FRAGMENT
         "invariant gl_FragCoord; invariant varying vec2 a; void main() { gl_FragColor = gl_FragCoord "
         "+ a.xyxy; }"},
        {"struct S { vec2 x; }; uniform S a; void main() { gl_Position = a.x.xyxy; }",
         "precision highp float; struct S { vec2 x; }; uniform S a; void main() { gl_FragColor = a.x.xyxy; "
         "}"},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
        glsl_program_free(link_good(rows[i].vertex, rows[i].fragment));
}

/* --- Uniforms ------------------------------------------------------------------------------------------- */

/* "name base rows[array]" of all uniforms, in the order of their first use, each with "v" or "f", register,
 * component and elements of its stages. */
static void expect_uniforms(const char *vertex, const char *fragment, const char *expected)
{
    struct glsl_program *program = link_good(vertex, fragment);
    char text[2048] = "";
    for (unsigned i = 0; i < program->uniforms; i++) {
        const struct glsl_uniform *u = &program->uniform[i];
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s %d %d[%d]", u->name, u->type.base, u->type.rows,
                 u->type.array);
        for (unsigned s = 0; s < GLSL_STAGES; s++) {
            used = strlen(text);
            if (u->stage[s].first >= 0)
                snprintf(text + used, sizeof text - used, " %c%d.%d*%d", "vf"[s], u -> stage[s].first,
                         u->stage[s].component, u->stage[s].elements);
        }
        strcat(text, "\n");
    }
    TEST_ASSERT_EQUAL_STRING(expected, text);
    glsl_program_free(program);
}

static void uniforms_are_the_parts_that_are_used(void)
{
    expect_uniforms(
        "struct L { vec3 d; float p; }; uniform L l[3]; uniform vec4 gone, a[5]; uniform mat3 m;\n"
        "void main() { float x = gone.x; gl_Position = a[1] + vec4(l[2].p) + vec4(m[0], 1); }",
        FRAGMENT "void main() {}", "a 1 4[2] v0.0*2\nl[2].p 1 1[0] v2.0*1\nm 1 3[0] v3.0*1\n");
}

static void an_index_that_is_not_constant_uses_all_elements(void)
{
    expect_uniforms("struct L { vec3 d; float p; }; uniform L l[2]; uniform int i;\n"
                    "void main() { gl_Position = vec4(l[i].p); }",
                    FRAGMENT "void main() {}",
                    "l[0].p 1 1[0] v1.0*1\nl[1].p 1 1[0] v3.0*1\ni 2 1[0] v4.0*1\n");
}

static void stages_share_uniforms_and_have_registers_of_their_own(void)
{
    expect_uniforms("uniform mat4 m; uniform vec4 c; void main() { gl_Position = m * c; }",
                    "precision highp float; uniform sampler2D s[2]; uniform samplerCube t; uniform vec4 c;\n"
                    "void main() { gl_FragColor = c + texture2D(s[1], c.xy) + textureCube(t, c.xyz); }",
                    "m 1 4[0] v0.0*1\nc 1 4[0] v4.0*1 f0.0*1\ns 4 1[2] f0.0*2\nt 5 1[0] f2.0*1\n");
}

static void uniforms_without_room_share_registers(void)
{
    expect_uniforms("uniform vec4 a[255]; uniform float x; uniform vec2 z; uniform int i;\n"
                    "void main() { gl_Position = a[i] + vec4(x, z, x); }",
                    FRAGMENT "void main() {}",
                    "a 1 4[255] v0.0*255\ni 2 1[0] v255.2*1\nx 1 1[0] v255.3*1\nz 1 2[0] v255.0*1\n");
}

/* --- Attributes and varyings ---------------------------------------------------------------------------- */

static void attributes_are_bound_or_get_free_locations(void)
{
    static const struct glsl_binding bindings[] = {{"a", 3}, {"unused", 0}, {"b", 1}, {"a", 2}};
    char *log, text[256] = "";
    struct glsl_program *program = link_bound("attribute vec4 a, b, c, unused; attribute mat2 m;\n"
                                              "void main() { gl_Position = a + b + c + vec4(m[0], m[1]); }",
                                              FRAGMENT "void main() {}", bindings, 4, &log);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, log);
    for (unsigned i = 0; i < program->attributes; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s %u\n", program->attribute[i].name,
                 program->attribute[i].location);
    TEST_ASSERT_EQUAL_STRING("a 2\nb 1\nm 3\nc 0\n", text);
    TEST_ASSERT_EQUAL_UINT(2, program->attribute_name_bytes);
    glsl_program_free(program);
    free(log);
}

static void attributes_bound_to_one_location_share_a_register(void)
{
    static const struct glsl_binding bindings[] = {{"a", 5}, {"b", 5}};
    char *log;
    struct glsl_program *program = link_bound(
        "attribute vec4 a, b; uniform bool c; void main() { if (c) gl_Position = a; else gl_Position = b; }",
        FRAGMENT "void main() {}", bindings, 2, &log);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, log);
    const char *first = strstr(program->text[0], "dcl_texcoord5 v5\n");
    TEST_ASSERT_NOT_NULL(first);
    TEST_ASSERT_NULL(strstr(first + 1, "dcl_texcoord5"));
    glsl_program_free(program);
    free(log);
}

static void varyings_that_are_not_read_are_not_computed(void)
{
    struct glsl_program *program =
        link_good("attribute vec4 p; varying vec4 a, b; void main() { gl_Position = p; a = sin(p); b = p; }",
                  FRAGMENT "varying vec4 a, b; void main() { vec4 c = a; gl_FragColor = b; }");
    TEST_ASSERT_EQUAL_UINT(1, program->varyings);
    TEST_ASSERT_NULL(strstr(program->text[0], "sincos"));
    glsl_program_free(program);
}

static void varyings_are_packed_if_they_need_it(void)
{
    struct glsl_program *program =
        link_good("varying vec2 a[4]; varying vec3 b[4]; varying float c, d[3]; varying vec2 e[4];\n"
                  "void main() { for (int i = 0; i < 4; i++) a[i] = e[i] = vec2(i); b[3] = vec3(1); c = 1.0; "
                  "d[2] = 3.0; }",
                  FRAGMENT "varying vec2 a[4]; varying vec3 b[4]; varying float c, d[3]; varying vec2 e[4];\n"
                           "void main() { gl_FragColor = vec4(a[1], e[2]) + vec4(b[3], c) + vec4(d[2]); }");
    TEST_ASSERT_EQUAL_UINT(8, program->varyings);
    TEST_ASSERT_NOT_NULL(strstr(program->text[0], "o8.zw"));
    glsl_program_free(program);
}

/* --- Programs ------------------------------------------------------------------------------------------- */

static void a_program_describes_its_results(void)
{
    struct glsl_program *program =
        link_good("void main() { gl_Position = vec4(0); gl_PointSize = 2.0; }",
                  "#extension GL_EXT_frag_depth : enable\n#extension GL_EXT_draw_buffers : enable\n" FRAGMENT
                  "void main() { if (gl_PointCoord.x > 0.5 || gl_FrontFacing) discard;\n"
                  "gl_FragData[2] = gl_FragCoord; gl_FragData[0].x = 1.0; gl_FragDepthEXT = 0.5; }");
    TEST_ASSERT_EQUAL_HEX8(5, program->colors);
    TEST_ASSERT_TRUE(program->point_size && program->depth && program->discards && program->point_coord);
    TEST_ASSERT_TRUE(program->frag_coord && program->front_facing && !program->broadcasts);
    glsl_program_free(program);
    program = link_good(NOTHING, "#extension GL_NV_draw_buffers : require\n" FRAGMENT
                                 "void main() { gl_FragData[gl_MaxDrawBuffers - 1] = vec4(1); }");
    TEST_ASSERT_EQUAL_HEX8(8, program->colors);
    glsl_program_free(program);
    program = link_good(NOTHING, FRAGMENT "void main() { gl_FragColor = vec4(1); }");
    TEST_ASSERT_EQUAL_HEX8(1, program->colors);
    TEST_ASSERT_TRUE(program->broadcasts);
    TEST_ASSERT_FALSE(program->point_size || program->depth || program->discards || program->point_coord);
    TEST_ASSERT_NULL(program->second[0]);
    glsl_program_free(program);
}

static void a_second_colour_is_in_a_text_of_its_own(void)
{
    struct glsl_program *program =
        link_good(NOTHING, "#extension GL_EXT_blend_func_extended : enable\n"
                           "#extension GL_EXT_draw_buffers : enable\n" FRAGMENT
                           "void main() { gl_FragData[0] = vec4(1); gl_FragData[1] = vec4(2); "
                           "gl_FragData[2] = vec4(3); gl_SecondaryFragDataEXT[0] = vec4(4); }");
    TEST_ASSERT_EQUAL_HEX8(7, program->colors);
    TEST_ASSERT_NOT_NULL(strstr(program->text[GLSL_FRAGMENT], "oC2"));
    TEST_ASSERT_NOT_NULL(program->second[0]);
    TEST_ASSERT_NULL(strstr(program->second[0], "oC2"));
    TEST_ASSERT_NOT_NULL(strstr(program->second[0], "oC1"));
    TEST_ASSERT_NULL(program->second[1]); /* it does not read gl_FrontFacing */
    glsl_program_free(program);
}

static void a_unit_can_be_linked_again_and_a_program_survives_it(void)
{
    char *log, *other;
    struct glsl_unit *v =
        compile(GLSL_VERTEX, "uniform mat4 m; attribute vec4 p; void main() { gl_Position = m * p; }");
    struct glsl_unit *f =
        compile(GLSL_FRAGMENT, FRAGMENT "uniform vec4 c; void main() { gl_FragColor = c; }");
    struct glsl_program *first = glsl_link(v, f, NULL, 0, &log), *second = glsl_link(v, f, NULL, 0, &other);
    glsl_unit_free(v);
    glsl_unit_free(f);
    for (unsigned s = 0; s < GLSL_STAGES; s++)
        TEST_ASSERT_EQUAL_STRING(first->text[s], second->text[s]);
    TEST_ASSERT_EQUAL_STRING("m", first->uniform[0].name);
    glsl_program_free(first);
    TEST_ASSERT_EQUAL_STRING("c", second->uniform[1].name);
    glsl_program_free(second);
    free(log);
    free(other);
}

static void a_shader_without_an_end_of_its_growth_is_refused(void)
{
    enum { LEVELS = 20, BYTES = 4096 };
    static char source[BYTES];
    char *log;
    size_t used = (size_t)snprintf(source, BYTES, "uniform float u; float f0(float x) { return x * u; }\n");
    for (int i = 1; i < LEVELS; i++)
        used += (size_t)snprintf(source + used, BYTES - used,
                                 "float f%d(float x) { return f%d(x) + f%d(x + 1.0); }\n", i, i - 1, i - 1);
    snprintf(source + used, BYTES - used, "void main() { gl_Position = vec4(f%d(1.0)); }", LEVELS - 1);
    TEST_ASSERT_NULL(link_bound(source, FRAGMENT "void main() {}", NULL, 0, &log));
    TEST_ASSERT_EQUAL_STRING(
        "ERROR: found more than 20000 calls of functions after inlining in the vertex shader\n", log);
    free(log);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(errors_name_what_was_found);
    RUN_TEST(some_differences_are_allowed);
    RUN_TEST(uniforms_are_the_parts_that_are_used);
    RUN_TEST(an_index_that_is_not_constant_uses_all_elements);
    RUN_TEST(stages_share_uniforms_and_have_registers_of_their_own);
    RUN_TEST(uniforms_without_room_share_registers);
    RUN_TEST(attributes_are_bound_or_get_free_locations);
    RUN_TEST(attributes_bound_to_one_location_share_a_register);
    RUN_TEST(varyings_that_are_not_read_are_not_computed);
    RUN_TEST(varyings_are_packed_if_they_need_it);
    RUN_TEST(a_program_describes_its_results);
    RUN_TEST(a_second_colour_is_in_a_text_of_its_own);
    RUN_TEST(a_unit_can_be_linked_again_and_a_program_survives_it);
    RUN_TEST(a_shader_without_an_end_of_its_growth_is_refused);
    return UNITY_END();
}
