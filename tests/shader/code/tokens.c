/* Text becomes the tokens that the documentation of the token format requires. The expected values were
 * computed by hand from the fields in d3d9types.h. */
#include "shader/shader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

static struct error error;

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

static const struct sample {
    const char *model, *text;
    uint32_t version, tokens[12]; /* the tokens after the version; ends with END */
} samples[] = {
#define END 0xffff
    {"vs_1_1", "nop", 0xfffe0101, {0, END}},
    {"vs.1.1", "mov r3, v2", 0xfffe0101, {1, 0x800f0003, 0x90e40002, END}},
    {"vs_1_1", "mov oPos, c5", 0xfffe0101, {1, 0xc00f0000, 0xa0e40005, END}},
    {"vs_1_1", "mov oFog, c5.w", 0xfffe0101, {1, 0xc00f0001, 0xa0ff0005, END}},
    {"vs_1_1", "mov oPts.x, c5.y", 0xfffe0101, {1, 0xc0010002, 0xa0550005, END}},
    {"vs_1_1", "mov oD1, v4", 0xfffe0101, {1, 0xd00f0001, 0x90e40004, END}},
    {"vs_1_1", "mov oT7.xy, v4", 0xfffe0101, {1, 0xe0030007, 0x90e40004, END}},
    {"vs_1_1",
     "mad r0.yz, -r1.wzyx, c2.x, r11",
     0xfffe0101,
     {4, 0x80060000, 0x811b0001, 0xa0000002, 0x80e4000b, END}},
    {"vs_1_1", "mov a0.x, c1.z", 0xfffe0101, {1, 0xb0010000, 0xa0aa0001, END}},
    {"vs_1_1", "m4x4 oPos, v0, c[a0.x + 9]", 0xfffe0101, {0x14, 0xc00f0000, 0x90e40000, 0xa0e42009, END}},
    {"vs_1_1", "dcl_color1 v6", 0xfffe0101, {0x1f, 0x8001000a, 0x900f0006, END}},
    {"vs_1_1",
     "def c95, 1, -2, 0.25, 1.0e3f",
     0xfffe0101,
     {0x51, 0xa00f005f, 0x3f800000, 0xc0000000, 0x3e800000, 0x447a0000, END}},
    {"vs_2_0", "mul r1, r2, r3", 0xfffe0200, {0x03000005, 0x800f0001, 0x80e40002, 0x80e40003, END}},
    {"vs_2_0",
     "add r1, c[a0.z + 3], v1",
     0xfffe0200,
     {0x04000002, 0x800f0001, 0xa0e42003, 0xb0aa0000, 0x90e40001, END}},
    {"vs_2_0", "mov r1, c7[aL]", 0xfffe0200, {0x03000001, 0x800f0001, 0xa0e42007, 0xf0e40800, END}},
    {"vs_2_0", "mova a0.yw, r1", 0xfffe0200, {0x0200002e, 0xb00a0000, 0x80e40001, END}},
    {"vs_2_0", "loop aL, i3", 0xfffe0200, {0x0200001b, 0xf0e40800, 0xf0e40003, END}},
    {"vs_2_0", "callnz l5, !b9", 0xfffe0200, {0x0200001a, 0xa0e41005, 0xede40809, END}},
    {"vs_2_0", "defb b15, true", 0xfffe0200, {0x0200002f, 0xe00f080f, 1, END}},
    {"vs_2_0", "defi i2, 255, -1, 0, 7", 0xfffe0200, {0x05000030, 0xf00f0002, 255, 0xffffffff, 0, 7, END}},
    {"vs_2_0",
     "sincos r0.xy, r1.x, c0, c1",
     0xfffe0200,
     {0x04000025, 0x80030000, 0x80000001, 0xa0e40000, 0xa0e40001, END}},
    {"vs_2_x", "break_lt r0.x, c0.x", 0xfffe0201, {0x0204002d, 0x80000000, 0xa0000000, END}},
    {"vs_2_a", "setp_le p0.xy, r0, r1", 0xfffe0201, {0x0306005e, 0xb0031000, 0x80e40000, 0x80e40001, END}},
    {"vs_2_x",
     "(!p0.y) rcp_sat r0.w, r1.z",
     0xfffe0201,
     {0x13000006, 0x80180000, 0xbd551000, 0x80aa0001, END}},
    {"vs_2_x", "breakp !p0.x", 0xfffe0201, {0x01000060, 0xbd001000, END}},
    {"vs_2_sw", "mov r0, c8191", 0xfffe02ff, {0x02000001, 0x800f0000, 0xd0e40fff, END}},
    {"vs_2_sw", "mov r0, c2048", 0xfffe02ff, {0x02000001, 0x800f0000, 0xb0e40800, END}},
    {"vs_3_0",
     "mov o[aL + 2].xyz, r1_abs",
     0xfffe0300,
     {0x03000001, 0xe0072002, 0xf0e40800, 0x8be40001, END}},
    {"vs_3_0", "texldl r0, -v3_abs, s3", 0xfffe0300, {0x0300005f, 0x800f0000, 0x9ce40003, 0xa0e40803, END}},
    {"vs_3_0", "dcl_psize o4.x", 0xfffe0300, {0x0200001f, 0x80000004, 0xe0010004, END}},
    {"vs_3_0", "dcl_volume s1", 0xfffe0300, {0x0200001f, 0xa0000000, 0xa00f0801, END}},
    {"ps_1_1", "texbem t2, t0", 0xffff0101, {0x43, 0xb00f0002, 0xb0e40000, END}},
    {"ps_1_1", "+mov_sat r0.w, 1-v1_bias", 0, {0}},
    {"ps_1_1", "+mov_sat r0.w, 1 - v1", 0xffff0101, {0x40000001, 0x80180000, 0x96e40001, END}},
    {"ps_1_2",
     "cmp_d2 r1.rgb, -t0_bx2, c3.a, v0_bias",
     0xffff0102,
     {0x58, 0x8f070001, 0xb5e40000, 0xa0ff0003, 0x92e40000, END}},
    {"ps_1_3", "texm3x3spec t3, t0, c7", 0xffff0103, {0x4c, 0xb00f0003, 0xb0e40000, 0xa0e40007, END}},
    {"ps_1_4", "texld r5, t2_dw.xyw", 0xffff0104, {0x42, 0x800f0005, 0xbaf40002, END}},
    {"ps_1_4", "texcrd r1.rgb, t4_da.xyw", 0xffff0104, {0x40, 0x80070001, 0xbaf40004, END}},
    {"ps_1_4", "phase", 0xffff0104, {0xfffd, END}},
    {"ps_1_4", "mul_x8_sat r0, -r1_x2, r2_x2.g", 0xffff0104, {5, 0x831f0000, 0x88e40001, 0x87550002, END}},
    {"ps_2_0", "dcl t3.xy", 0xffff0200, {0x0200001f, 0x80000000, 0xb0030003, END}},
    {"ps_2_0", "dcl_2d s15", 0xffff0200, {0x0200001f, 0x90000000, 0xa00f080f, END}},
    {"ps_2_0", "texldb_pp r1, t3, s2", 0xffff0200, {0x03020042, 0x802f0001, 0xb0e40003, 0xa0e40802, END}},
    {"ps_2_0", "texldp r1, r2, s2", 0xffff0200, {0x03010042, 0x800f0001, 0x80e40002, 0xa0e40802, END}},
    {"ps_2_0", "mov oDepth, r0.z", 0xffff0200, {0x02000001, 0x900f0800, 0x80aa0000, END}},
    {"ps_2_0", "mov oC2, r0", 0xffff0200, {0x02000001, 0x800f0802, 0x80e40000, END}},
    {"ps_2_b",
     "dp2add r0, r1, r2, c3.w",
     0xffff0201,
     {0x0400005a, 0x800f0000, 0x80e40001, 0x80e40002, 0xa0ff0003, END}},
    {"ps_2_x",
     "texldd r0, t0, s1, r2, r3",
     0xffff0201,
     {0x0500005d, 0x800f0000, 0xb0e40000, 0xa0e40801, 0x80e40002, 0x80e40003, END}},
    {"ps_2_sw", "if_ne r0.x, -c0.y", 0xffff02ff, {0x02050029, 0x80000000, 0xa1550000, END}},
    {"ps_3_0", "dcl_fog_centroid v9.x", 0xffff0300, {0x0200001f, 0x8000000b, 0x90410009, END}},
    {"ps_3_0", "dcl vPos.xy", 0xffff0300, {0x0200001f, 0x80000000, 0x90031000, END}},
    {"ps_3_0",
     "cmp r0, vFace, c0, v[aL+4]",
     0xffff0300,
     {0x05000058, 0x800f0000, 0x90e41001, 0xa0e40000, 0x90e42004, 0xf0e40800, END}},
    {"ps_3_sw", "dsy_sat_pp r0, r1.xxyy", 0xffff03ff, {0x0200005c, 0x803f0000, 0x80500001, END}},
#undef END
};

enum { SAMPLE_COUNT = sizeof samples / sizeof *samples };

static unsigned length_of(const struct sample *sample)
{
    unsigned length = 0;
    while (sample->tokens[length] != 0xffff)
        length++;
    return length;
}

static void expect_tokens(const struct sample *sample)
{
    char text[256];
    struct shader *shader;
    uint32_t *tokens;
    size_t count;
    snprintf(text, sizeof text, "%s\n%s\n", sample->model, sample->text);
    int bad = shader_assemble("sample", text, strlen(text), &shader, &error);
    if (!sample->version) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(-1, bad, text);
        return;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, bad, error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_encode(shader, &tokens, &count, &error), error.text);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(length_of(sample) + 2, count, text);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(sample->version, tokens[0], text);
    TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(sample->tokens, tokens + 1, count - 1, text);
    free(tokens);
    shader_free(shader);
}

static void samples_assemble_to_tokens_computed_by_hand(void)
{
    for (unsigned i = 0; i < SAMPLE_COUNT; i++) {
        error_clear(&error);
        expect_tokens(&samples[i]);
    }
}

static void both_spellings_of_components_and_letters_give_equal_tokens(void)
{
    static const char first[] = "PS_1_4\nMAD_SAT R0.RGB, -T1_BX2.A, C2, 1 - R3.BGRA\n";
    static const char second[] = "ps.1.4\nmad_sat r0.xyz,-t1_bx2.w,c2,1-r3.zyxw // the same\n";
    struct shader *shaders[2];
    uint32_t *tokens[2];
    size_t count[2];
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_assemble("a", first, sizeof first - 1, &shaders[0], &error),
                                  error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_assemble("b", second, sizeof second - 1, &shaders[1], &error),
                                  error.text);
    for (int i = 0; i < 2; i++)
        TEST_ASSERT_EQUAL_INT(0, shader_encode(shaders[i], &tokens[i], &count[i], &error));
    TEST_ASSERT_EQUAL_UINT64(count[0], count[1]);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(tokens[0], tokens[1], count[0]);
    for (int i = 0; i < 2; i++) {
        free(tokens[i]);
        shader_free(shaders[i]);
    }
}

static void every_opcode_of_the_header_has_a_row(void)
{
    bool seen[97] = {false};
    for (unsigned i = 0; i < SHADER_COUNT; i++)
        if (shader_operations[i].opcode < 97)
            seen[shader_operations[i].opcode] = true;
    for (unsigned opcode = 0; opcode < 97; opcode++)
        TEST_ASSERT_EQUAL_MESSAGE((opcode < 49 || opcode > 63) && opcode != 75, seen[opcode], "opcode");
}

static bool differs_inside_a_column(unsigned first, unsigned second)
{
    const struct shader_operation *a = &shader_operations[first], *b = &shader_operations[second];
    for (unsigned column = 0; column < COLUMN_COUNT; column++)
        if (a->slots[column] != '.' && b->slots[column] != '.' && a->opcode == b->opcode &&
            a->control == b->control)
            return false;
    return true;
}

static void rows_differ_and_have_every_column(void)
{
    for (unsigned i = 0; i < SHADER_COUNT; i++) {
        TEST_ASSERT_EQUAL_UINT64(COLUMN_COUNT, strlen(shader_operations[i].slots));
        for (unsigned j = 0; j < i; j++)
            TEST_ASSERT_TRUE_MESSAGE(differs_inside_a_column(i, j), shader_operations[i].name);
    }
    for (unsigned i = 1; i < FILE_COUNT; i++)
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(COLUMN_COUNT, strlen(shader_registers[i].ports),
                                         shader_registers[i].name);
}

/* The reference counts the version as an instruction, and has separate pages for `if` and `callnz` with a
 * predicate and for `dcl` of samplers. */
static void each_version_has_the_documented_number_of_instructions(void)
{
    static const struct {
        unsigned model, count;
    } rows[] = {
        {MODEL_VS_1_1, 29}, {MODEL_VS_2_0, 50}, {MODEL_VS_2_X, 57}, {MODEL_VS_3_0, 59},
        {MODEL_PS_1_1, 24}, {MODEL_PS_1_2, 30}, {MODEL_PS_1_3, 31}, {MODEL_PS_1_4, 19},
        {MODEL_PS_2_0, 36}, {MODEL_PS_2_X, 57}, {MODEL_PS_3_0, 60},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct shader_model *model = &shader_models[rows[i].model];
        unsigned count = 1 + 2 * (shader_register_count(FILE_PREDICATE, model) != 0) +
                         (shader_register_count(FILE_SAMPLER, model) != 0);
        for (unsigned j = 0; j < SHADER_COUNT; j++)
            count += shader_slots(&shader_operations[j], model) >= 0;
        TEST_ASSERT_EQUAL_UINT_MESSAGE(rows[i].count, count, model->name);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(samples_assemble_to_tokens_computed_by_hand);
    RUN_TEST(both_spellings_of_components_and_letters_give_equal_tokens);
    RUN_TEST(every_opcode_of_the_header_has_a_row);
    RUN_TEST(rows_differ_and_have_every_column);
    RUN_TEST(each_version_has_the_documented_number_of_instructions);
    return UNITY_END();
}
