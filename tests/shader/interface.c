/* Inputs, outputs and samplers of shaders of every generation, with the names of usages. */
#include "shader/interface.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

static struct error error;
static struct shader_interface interface;

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

static void describe(const char *text)
{
    struct shader *shader;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_assemble("t", text, strlen(text), &shader, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_validate(shader, NULL, &error), error.text);
    shader_describe(shader, &interface);
    shader_free(shader);
}

/* "v0:position0.xyzw oT1:texcoord1.xy" */
static void expect_ports(const char *expected, const struct shader_port *ports, unsigned count)
{
    char text[512] = "";
    for (unsigned i = 0; i < count; i++) {
        const struct shader_register *row = &shader_registers[ports[i].file];
        char number[8] = "";
        if (row->index == NUMBERED)
            snprintf(number, sizeof number, "%u", ports[i].index);
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s%s:%s%u.", i ? " " : "", row->name,
                 number, shader_word_name(shader_usages, ports[i].usage), ports[i].usage_index);
        for (unsigned c = 0; c < 4; c++)
            if (ports[i].mask >> c & 1)
                strncat(text, &"xyzw"[c], 1);
    }
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static void the_fixed_outputs_of_a_vertex_shader_have_usages(void)
{
    describe("vs_1_1\ndcl_position v0\ndcl_texcoord2 v5.xy\nm4x4 oPos, v0, c4\nmov oT3.xy, v5\nmov oD1, c9\n"
             "mov oFog, c8.x\nmov oPts.x, c8.x\nmov r7, c0\nmov oT3.z, r7.x\n");
    expect_ports("v0:position0.xyzw v5:texcoord2.xy", interface.inputs, interface.input_count);
    expect_ports("oPos:position0.xyzw oT3:texcoord3.xyzw oD1:color1.xyzw oFog:fog0.xyzw oPts:psize0.xyzw",
                 interface.outputs, interface.output_count);
    TEST_ASSERT_EQUAL_UINT(8, interface.temporaries);
    TEST_ASSERT_EQUAL_UINT(10, interface.constants);
    TEST_ASSERT_FALSE(interface.indexed);
    TEST_ASSERT_EQUAL_HEX(0, interface.sampled);
}

static void a_matrix_counts_with_all_its_rows(void)
{
    describe("vs_1_1\ndcl_position v0\nm4x4 oPos, v0, c4\n");
    TEST_ASSERT_EQUAL_UINT(8, interface.constants);
    describe("vs_2_0\ndcl_position v0\nmova a0.x, v0\nm4x4 oPos, v0, c4[a0.x]\n");
    TEST_ASSERT_EQUAL_UINT(0, interface.constants);
    TEST_ASSERT_TRUE(interface.indexed);
}

static void declared_outputs_share_registers(void)
{
    describe("vs_3_0\ndcl_position v0\ndcl_volume s2\ndcl_position o7\ndcl_texcoord o1.xy\ndcl_fog o1.w\n"
             "texldl r0, v0, s2\nmov o7, r0\nmov o1.xyw, r0\n");
    expect_ports("o7:position0.xyzw o1:texcoord0.xy o1:fog0.w", interface.outputs, interface.output_count);
    TEST_ASSERT_EQUAL_HEX(4, interface.sampled);
    TEST_ASSERT_EQUAL_UINT(4, interface.kinds[2]);
}

static void old_pixel_shaders_sample_by_stage(void)
{
    describe("ps_1_1\ntex t0\ntexreg2ar t2, t0\nmul r0, t0, v1\nmad r0, t2, c3, r0\n");
    expect_ports("t0:texcoord0.xyzw v1:color1.xyzw", interface.inputs, interface.input_count);
    TEST_ASSERT_EQUAL_HEX(5, interface.sampled);
    TEST_ASSERT_EQUAL_UINT(0, interface.kinds[0]);
    TEST_ASSERT_EQUAL_HEX(1, interface.targets);
    describe("ps_1_4\ntexld r3, t1\nmov r0, r3\nphase\ntexld r4, r0\ntexkill t2\nmov r0, r4\n");
    expect_ports("t1:texcoord1.xyzw t2:texcoord2.xyzw", interface.inputs, interface.input_count);
    TEST_ASSERT_EQUAL_HEX(0x18, interface.sampled);
    TEST_ASSERT_TRUE(interface.kills);
    TEST_ASSERT_FALSE(interface.depth);
}

static void pixel_shaders_of_models_2_and_3_list_their_outputs(void)
{
    describe("ps_2_0\ndcl t4.xy\ndcl v1\ndcl_cube s3\ntexld r0, t4.xyzw, s3\nmul r0, r0, v1\nmov oC0, "
             "r0\nmov oC1, r0\n"
             "mov oDepth, r0.x\n");
    expect_ports("t4:texcoord4.xy v1:color1.xyzw", interface.inputs, interface.input_count);
    TEST_ASSERT_EQUAL_HEX(3, interface.targets);
    TEST_ASSERT_TRUE(interface.depth);
    TEST_ASSERT_EQUAL_UINT(3, interface.kinds[3]);
    describe("ps_3_0\ndcl_normal2 v9.xyz\ndcl vFace\nmul oC3, v9.xyzz, vFace\n");
    expect_ports("v9:normal2.xyz", interface.inputs, interface.input_count);
    TEST_ASSERT_EQUAL_HEX(8, interface.targets);
    TEST_ASSERT_TRUE(interface.face);
    TEST_ASSERT_FALSE(interface.place);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_fixed_outputs_of_a_vertex_shader_have_usages);
    RUN_TEST(a_matrix_counts_with_all_its_rows);
    RUN_TEST(declared_outputs_share_registers);
    RUN_TEST(old_pixel_shaders_sample_by_stage);
    RUN_TEST(pixel_shaders_of_models_2_and_3_list_their_outputs);
    return UNITY_END();
}
