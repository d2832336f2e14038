/* Text and bytecode that are not shaders are refused with one line: the position, and the expected token. */
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

static const struct {
    const char *text, *reason;
} texts[] = {
    {"", "t:1:1: found the end of the text, expected a version, vs_1_1 to vs_3_0 or ps_1_1 to ps_3_0"},
    {"mov r0, r1", "t:1:1: found 'mov', expected a version"},
    {"vs_1_2", "t:1:1: found 'vs_1_2', expected a version"},
    {"vs_4_0", "t:1:1: found 'vs_4_0', expected a version"},
    {"\n ps.1.5\n", "t:2:2: found 'ps', expected a version"},
    {"vs_1_1 mov r0, r1", "t:1:8: found 'mov', expected the end of the line"},
    {"vs_1_1\nfoo r0, r1", "t:2:1: found 'foo', expected an instruction of vs_1_1"},
    {"vs_1_1\nmvo_sat r0, r1",
     "t:2:1: found 'mvo_sat', expected an instruction of vs_1_1; did you mean \"mov\"?"},
    {"vs_2_0\nnorm r0, r1", "t:2:1: found 'norm', expected an instruction of vs_2_0; did you mean \"nrm\"?"},
    {"vs_1_1\nnorm r0, r1", "t:2:1: found 'norm', expected an instruction of vs_1_1"},
    {"vs_1_1\nmov oPso, r1", "t:2:5: found 'oPso', expected a register of vs_1_1; did you mean \"oPos\"?"},
    {"vs_1_1\nmov_sta r0, r1", "t:2:5: found '_sta', expected a modifier, like _sat; did you mean \"sat\"?"},
    {"vs_2_0\ndcl_texcord v0",
     "t:2:5: found '_texcord', expected a modifier, like _sat; did you mean \"texcoord\"?"},
    {"ps_1_4\nmov r0, r1_bais",
     "t:2:9: found the modifier '_bais', which ps_1_4 does not have; did you mean \"bias\"?"},
    {"vs_11\nmov r0, r1", "t:1:1: found 'vs_11', expected a version, vs_1_1 to vs_3_0 or ps_1_1 to ps_3_0; "
                          "did you mean \"vs_1_1\"?"},
    {"vs_1_1\n12", "t:2:1: found '12', expected an instruction"},
    {"vs_1_1\n, mov r0, r1", "t:2:1: found ',', expected an instruction"},
    {"vs_1_1\nlrp r0, r1, r2, r3", "t:2:1: found 'lrp', which vs_1_1 does not have"},
    {"ps_1_1\ntexld r0, t0", "t:2:1: found 'texld', which ps_1_1 does not have"},
    {"ps_2_0\ntex t0", "t:2:1: found 'tex', which ps_2_0 does not have"},
    {"vs_2_0\nif_gt r0.x, r1.x", "t:2:1: found 'if_gt', which vs_2_0 does not have"},
    {"ps_2_0\nif b0", "t:2:1: found 'if', which ps_2_0 does not have"},
    {"ps_2_x\nloop aL, i0", "t:2:1: found 'loop', which ps_2_x does not have"},
    {"vs_3_0\nsetp p0, r0, r1", "t:2:1: found 'setp', expected an instruction"},
    {"vs_3_0\nadd_gt r0, r0, r1", "t:2:1: found 'add_gt', expected an instruction"},
    {"vs_1_1\nmov", "t:2:4: found the end of the text, expected a register"},
    {"vs_1_1\nmov\n", "t:2:4: found the end of the line, expected a register"},
    {"vs_1_1\nmov r0", "t:2:7: found the end of the text, expected ','"},
    {"vs_1_1\nmov r0 r1", "t:2:8: found 'r1', expected ','"},
    {"vs_1_1\nmov r0,", "t:2:8: found the end of the text, expected a register"},
    {"vs_1_1\nmov r0, r1,", "t:2:11: found ',', expected the end of the line"},
    {"vs_1_1\nmov r0, r1, r2", "t:2:11: found ',', expected the end of the line"},
    {"vs_1_1\nmov r0, r1 r2", "t:2:12: found 'r2', expected the end of the line"},
    {"vs_1_1\nadd r0, r1", "t:2:11: found the end of the text, expected ','"},
    {"vs_1_1\nnop r0", "t:2:5: found 'r0', expected the end of the line"},
    {"vs_1_1\nmov q0, r1", "t:2:5: found 'q0', expected a register of vs_1_1"},
    {"vs_1_1\nmov r0x, r1", "t:2:5: found 'r0x', expected a register of vs_1_1"},
    {"vs_1_1\nmov r, r1", "t:2:5: found 'r' without a number, expected one, like r0"},
    {"vs_1_1\nmov r0, c", "t:2:9: found 'c' without a number, expected one, like c0"},
    {"vs_1_1\nmov r2048, r1", "t:2:5: found 'r2048', expected a number from 0 to 2047"},
    {"vs_1_1\nmov r0, c8192", "t:2:9: found 'c8192', expected a number from 0 to 8191"},
    {"vs_1_1\nmov r99999999999, r1", "t:2:5: found 'r99999999999', expected a register of vs_1_1"},
    {"vs_1_1\nmov t0, r1", "t:2:5: found 't0', which vs_1_1 does not have"},
    {"vs_3_0\nmov oPos, r1", "t:2:5: found 'oPos', which vs_3_0 does not have, expected a register"},
    {"vs_3_0\nmov oT0, r1", "t:2:5: found 'oT0', which vs_3_0 does not have"},
    {"vs_2_0\nmov o0, r1", "t:2:5: found 'o0', which vs_2_0 does not have"},
    {"vs_1_1\nmov r0, s0", "t:2:9: found 's0', which vs_1_1 does not have"},
    {"vs_1_1\n(p0) mov r0, r1", "t:2:2: found 'p0', which vs_1_1 does not have"},
    {"ps_1_3\nmov oC0, r0", "t:2:5: found 'oC0', which ps_1_3 does not have"},
    {"ps_3_0\nmov r0, t0", "t:2:9: found 't0', which ps_3_0 does not have"},
    {"ps_2_0\nmov r0, vFace", "t:2:9: found 'vFace', which ps_2_0 does not have"},
    {"ps_3_0\nmov r0, a0", "t:2:9: found 'a0', which ps_3_0 does not have"},
    {"ps_3_0\nmov r0, v[a0.x]", "t:2:11: found 'a0', which ps_3_0 does not have"},
    {"ps_2_0\nmov r0, v[aL]", "t:2:11: found 'aL', which ps_2_0 does not have"},
    {"vs_1_1\nmov r0, oPos1", "t:2:9: found 'oPos1', expected a register of vs_1_1"},
    {"vs_1_1\nmov r0.q, r1", "t:2:8: found 'q', expected some of x, y, z, w in this order"},
    {"vs_1_1\nmov r0.yx, r1", "t:2:8: found 'yx', expected some of x, y, z, w in this order"},
    {"vs_1_1\nmov r0.xx, r1", "t:2:8: found 'xx', expected some of"},
    {"vs_1_1\nmov r0., r1", "t:2:8: found ',', expected some of x, y, z, w"},
    {"vs_1_1\nmov r0, r1.xyzwx", "t:2:12: found 'xyzwx', expected one to four of x, y, z, w"},
    {"vs_1_1\nmov r0, r1.abcd", "t:2:12: found 'abcd', expected one to four of x, y, z, w"},
    {"vs_1_1\nmov r0, r1.", "t:2:12: found the end of the text, expected one to four of x, y, z, w"},
    {"vs_1_1\nmov r0, r1.5", "t:2:11: found '.5', expected the end of the line"},
    {"vs_1_1\nmov_foo r0, r1", "t:2:5: found '_foo', expected a modifier, like _sat"},
    {"vs_1_1\nmov_ r0, r1", "t:2:1: found 'mov_', expected"},
    {"vs_3_0\nmov_sat_sat r0, r1", "t:2:9: found '_sat', expected each modifier once"},
    {"ps_1_3\nmov_x2_d2 r0, r1", "t:2:8: found '_d2', expected each modifier once"},
    {"ps_1_3\nmov_x2_x2 r0, r1", "t:2:8: found '_x2', expected each modifier once"},
    {"vs_2_0\nendif_sat", "t:2:7: found '_sat', expected no modifier: nothing is written"},
    {"vs_1_1\nmov r0_sat, r1", "t:2:5: found the modifier '_sat' on a destination, expected none"},
    {"vs_1_1\nmov -r0, r1", "t:2:5: found '-', expected a register"},
    {"vs_1_1\nmov r0, r1_x2", "t:2:9: found the modifier '_x2', which vs_1_1 does not have"},
    {"vs_1_1\nmov r0, r1_abs", "t:2:9: found the modifier '_abs', which vs_1_1 does not have"},
    {"ps_2_0\nmov r0, 1 - r1", "t:2:9: found the modifier '1-', which ps_2_0 does not have"},
    {"ps_2_0\nmov r0, r1_bx2", "t:2:9: found the modifier '_bx2', which ps_2_0 does not have"},
    {"ps_1_3\nmov r0, r1_x2", "t:2:9: found the modifier '_x2', which ps_1_3 does not have"},
    {"ps_1_4\ntexld r0, -r1_dz", "t:2:11: found the modifier '-_dz', which ps_1_4 does not have"},
    {"ps_1_3\nmov r0, 1-r1_bias", "t:2:9: found the modifier '1-_bias', which ps_1_3 does not have"},
    {"vs_1_1\nmov r0, !r1", "t:2:9: found the modifier '!', which vs_1_1 does not have"},
    {"ps_1_3\nmov r0, 2 - r1", "t:2:9: found '2', expected a register"},
    {"ps_1_3\nmov r0, 1 r1", "t:2:11: found 'r1', expected '-'"},
    {"vs_2_0\nmov r0, --r1", "t:2:10: found '-', expected a register"},
    {"vs_1_1\nmov r0, c[", "t:2:11: found the end of the text, expected a register"},
    {"vs_1_1\nmov r0, c[]", "t:2:11: found ']', expected a register"},
    {"vs_1_1\nmov r0, c[a0.x", "t:2:15: found the end of the text, expected ']'"},
    {"vs_1_1\nmov r0, c[a0]", "t:2:13: found ']', expected '.'"},
    {"vs_1_1\nmov r0, c[a0.xy]", "t:2:14: found 'xy', expected one of x, y, z and w"},
    {"vs_1_1\nmov r0, c[a0.y]", "t:2:11: found another component than a0.x, the only one in vs_1_1"},
    {"vs_1_1\nmov r0, c[aL]", "t:2:11: found 'aL', which vs_1_1 does not have"},
    {"vs_2_0\nmov r0, c[a1.x]", "t:2:11: found 'a1', expected a0.x, a0.y, a0.z, a0.w or aL"},
    {"vs_2_0\nmov r0, c[r0.x]", "t:2:11: found 'r0', expected a0.x, a0.y, a0.z, a0.w or aL"},
    {"vs_2_0\nmov r0, c[aL.x]", "t:2:13: found '.', expected ']'"},
    {"vs_2_0\nmov r0, c[aL + a0.x]", "t:2:16: found 'a0', expected one register between the brackets"},
    {"vs_2_0\nmov r0, c[aL + 3.4]", "t:2:16: found '3.4', expected a number from 0 to 8191"},
    {"vs_2_0\nmov r0, c[aL - 3]", "t:2:14: found '-', expected ']'"},
    {"vs_2_0\nmov r0, c8000[aL + 192]", "t:2:20: found c8192, expected a number from 0 to 8191"},
    {"vs_2_0\nmov oPos[aL], r0", "t:2:9: found '[', expected no index of oPos"},
    {"vs_1_1\ndef c0, 1, 2, 3", "t:2:16: found the end of the text, expected ','"},
    {"vs_1_1\ndef c0, 1, 2, 3, r0", "t:2:18: found 'r0', expected a number"},
    {"vs_1_1\ndef c0, 1, --2, 3, 4", "t:2:13: found '-', expected a number"},
    {"vs_1_1\ndef c0, 1e39, 2, 3, 4", "t:2:9: found '1e39', expected a number in the range of binary32"},
    {"vs_1_1\ndef c0, 0x12, 2, 3, 4", "t:2:9: found '0x12', expected a number: 0x and eight digits"},
    {"vs_1_1\ndef c0, 1, 2, 3, 4, 5", "t:2:19: found ',', expected the end of the line"},
    {"vs_2_0\ndefi i0, 1.0, 2, 3, 4", "t:2:10: found '1.0', expected a whole number from 0 to 2147483647"},
    {"vs_2_0\ndefi i0, -2147483649, 2, 3, 4", "t:2:11: found '2147483649', expected a whole number"},
    {"vs_2_0\ndefi i0, 1 - 1, 2, 3, 4", "t:2:12: found '-', expected ','"},
    {"vs_2_0\ndefb b0, 1", "t:2:10: found '1', expected true or false"},
    {"vs_2_0\ndefb b0, maybe", "t:2:10: found 'maybe', expected true or false"},
    {"ps_2_0\ndefi i0, 1, 2, 3, 4", "t:2:1: found 'defi', which ps_2_0 does not have"},
    {"vs_1_1\ndcl_position16 v0", "t:2:5: found '_position16', expected a usage's number from 0 to 15"},
    {"vs_1_1\ndcl_positio v0", "t:2:5: found '_positio', expected a modifier, like _sat"},
    {"vs_3_0\ndcl_1d s0", "t:2:5: found '_1d', expected a modifier, like _sat"},
    {"ps_2_0\ndcl s0", "t:2:5: found a sampler, expected dcl_2d, dcl_cube or dcl_volume before it"},
    {"ps_2_0\ndcl_2d t0", "t:2:8: found t0 after a kind of texture, expected a sampler"},
    {"ps_2_0\ndcl_texcoord t0", "t:2:14: found t0 after a usage, expected only dcl before it"},
    {"vs_2_x\n(r0) mov r0, r1", "t:2:2: found another register, expected p0 between the brackets"},
    {"vs_2_x\n(p0 mov r0, r1", "t:2:5: found 'mov', expected ')'"},
    {"vs_2_x\n(-p0) mov r0, r1", NULL},
    {"vs_1_1\n/* mov", "t:2:1: found a comment without an end, expected */"},
    {"vs_1_1\nmov r0, r1 /* \n * \n", "t:2:12: found a comment without an end, expected */"},
    {"vs_1_1\nmov r0,\001 r1", "t:2:8: found byte 0x01, expected text"},
    {"vs_1_1\nmov r0, \xc3\xa9", "t:2:9: found byte 0xc3, expected text"},
    {"vs_1_1\nabcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyz",
     "t:2:1: found 'abcdefghijklmnopqrstuvwxyzabcdefghijklmn...', expected"},
};

static void bad_texts_are_refused_at_their_position(void)
{
    TEST_ASSERT_TRUE(sizeof texts / sizeof *texts > 100);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct shader *shader;
        error_clear(&error);
        int bad = shader_assemble("t", texts[i].text, strlen(texts[i].text), &shader, &error);
        if (!texts[i].reason) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, bad, error.text);
            shader_free(shader);
            continue;
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(-1, bad, texts[i].text);
        TEST_ASSERT_NULL_MESSAGE(shader, texts[i].text);
        TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(texts[i].reason, error.text, strlen(texts[i].reason),
                                             texts[i].text);
    }
}

static const struct {
    const char *reason;
    uint32_t tokens[10];
} codes[] = {
#define END 0xffff
    {"c: token 0: found 0x00000000, expected a version token", {0, END}},
    {"c: token 0: found 0xfffe0400, expected a version token", {0xfffe0400, END}},
    {"c: token 0: found 0xfffd0200, expected a version token", {0xfffd0200, END}},
    {"c: token 1: found 0x00000062, expected an instruction that the", {0xfffe0101, 0x62, END}},
    {"c: token 1: found 0x0000004b, expected an instruction that the", {0xffff0103, 0x4b, END}},
    {"c: token 1: found 0x00010001, expected an instruction that the",
     {0xfffe0101, 0x10001, 0x800f0000, 0x80e40000, END}},
    {"c: token 1: found 0x02070029, expected an instruction that the",
     {0xfffe0300, 0x02070029, 0x80000000, 0x80000000, END}},
    {"c: token 1: found 0x02000029, expected an instruction that the",
     {0xfffe0300, 0x02000029, 0x80000000, 0x80000000, END}},
    {"c: token 1: found 0x80000001, expected an instruction, whose reserved bits",
     {0xfffe0101, 0x80000001, 0x800f0000, 0x80e40000, END}},
    {"c: token 1: found 0x22000001, expected an instruction, whose reserved bits",
     {0xfffe0200, 0x22000001, 0x800f0000, 0x80e40000, END}},
    {"c: token 1: found 0x40000001, expected an instruction, whose reserved bits",
     {0xfffe0101, 0x40000001, 0x800f0000, 0x80e40000, END}},
    {"c: token 1: found 0x10000001, expected an instruction, whose reserved bits",
     {0xffff0101, 0x10000001, 0x800f0000, 0x80e40000, END}},
    {"c: token 1: found 0x02000001, expected zero in bits 24 to 27",
     {0xfffe0101, 0x02000001, 0x800f0000, 0x80e40000, END}},
    {"c: token 1: found 0x03000001, expected the number of its operands' tokens",
     {0xfffe0200, 0x03000001, 0x800f0000, 0x80e40000, END}},
    {"c: token 1: found 0x00000001, expected the number of its operands' tokens",
     {0xfffe0200, 0x00000001, 0x800f0000, 0x80e40000, END}},
    {"c: token 2: found 0x000f0000, expected an operand, whose bit 31",
     {0xfffe0101, 1, 0xf0000, 0x80e40000, END}},
    {"c: token 3: found 0x80e44000, expected an operand, whose bits 14 and 15",
     {0xfffe0101, 1, 0x800f0000, 0x80e44000, END}},
    {"c: token 3: found 0x0000ffff, expected an operand, whose bit 31", {0xfffe0101, 1, 0x800f0000, END}},
    {"c: token 2: found 0x80000000, expected a mask that is not empty",
     {0xfffe0101, 1, 0x80000000, 0x80e40000, END}},
    {"c: token 2: found 0x808f0000, expected a result modifier that exists",
     {0xfffe0101, 1, 0x808f0000, 0x80e40000, END}},
    {"c: token 2: found 0x840f0000, expected a shift from -3 to 3",
     {0xffff0101, 1, 0x840f0000, 0x80e40000, END}},
    {"c: token 2: found 0x880f0000, expected a shift from -3 to 3",
     {0xffff0101, 1, 0x880f0000, 0x80e40000, END}},
    {"c: token 2: found 0x800f1000, expected a register that the shader's model",
     {0xfffe0101, 1, 0x800f1000, 0x80e40000, END}},
    {"c: token 2: found 0xc00f0003, expected a register that the shader's model",
     {0xfffe0101, 1, 0xc00f0003, 0x80e40000, END}},
    {"c: token 3: found 0x8ee40000, expected a modifier that the",
     {0xfffe0101, 1, 0x800f0000, 0x8ee40000, END}},
    {"c: token 3: found 0x82e40000, expected a modifier that the",
     {0xfffe0101, 1, 0x800f0000, 0x82e40000, END}},
    {"c: token 3: found 0xa0e42000, expected no relative addressing in this model",
     {0xffff0101, 1, 0x800f0000, 0xa0e42000, END}},
    {"c: token 4: found 0x80000000, expected a0 or aL",
     {0xfffe0200, 0x03000001, 0x800f0000, 0xa0e42000, 0x80000000, END}},
    {"c: token 4: found 0xb0e40000, expected one component of a0",
     {0xfffe0200, 0x03000001, 0x800f0000, 0xa0e42000, 0xb0e40000, END}},
    {"c: token 4: found 0xb1000000, expected a0 or aL",
     {0xfffe0200, 0x03000001, 0x800f0000, 0xa0e42000, 0xb1000000, END}},
    {"c: token 2: found 0xc00f2000, expected no relative addressing of this register",
     {0xfffe0200, 0x03000001, 0xc00f2000, 0xb0000000, 0x80e40000, END}},
    {"c: token 3: found 0x80e40000, expected the predicate p0",
     {0xfffe0201, 0x13000001, 0x800f0000, 0x80e40000, 0x80e40000, END}},
    {"c: token 2: found 0x0000ffff, expected a usage, whose other bits", {0xfffe0101, 0x1f, END}},
    {"c: token 2: found 0x8000000e, expected a usage from 0 to 13",
     {0xfffe0101, 0x1f, 0x8000000e, 0x900f0000, END}},
    {"c: token 2: found 0x88000000, expected a kind of texture",
     {0xffff0200, 0x0200001f, 0x88000000, 0xa00f0800, END}},
    {"c: token 2: found 0x90000000, expected a kind of texture",
     {0xffff0200, 0x0200001f, 0x90000000, 0xb00f0000, END}},
    {"c: token 2: found 0x80000005, expected no usage of this register",
     {0xffff0200, 0x0200001f, 0x80000005, 0xb00f0000, END}},
    {"c: token 1: found 0x7ffffffe, expected a comment that ends before the data",
     {0xfffe0101, 0x7ffffffe, END}},
    {"c: token 1: found 0x8000fffe, expected a comment, whose bit 31 is zero", {0xfffe0101, 0x8000fffe, END}},
#undef END
};

static unsigned code_length(const uint32_t *tokens)
{
    unsigned length = 0;
    while (tokens[length] != 0xffff)
        length++;
    return length + 1;
}

static void bad_tokens_are_refused_at_their_position(void)
{
    for (size_t i = 0; i < sizeof codes / sizeof *codes; i++) {
        struct shader *shader;
        error_clear(&error);
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            -1, shader_read("c", codes[i].tokens, 4 * code_length(codes[i].tokens), &shader, &error),
            codes[i].reason);
        TEST_ASSERT_NULL(shader);
        TEST_ASSERT_EQUAL_STRING_LEN(codes[i].reason, error.text, strlen(codes[i].reason));
    }
}

/* A shader with every kind of token is truncated before each token. */
static void bytecode_cut_off_anywhere_is_refused(void)
{
    static const char text[] =
        "vs_2_x\ndcl_position v0\ndef c0, 1, 2, 3, 4\ndefi i0, 1, 2, 3, 4\ndefb b0, true\n"
        "(!p0) mad oPos, c0[a0.x], r0, v0\nloop aL, i0\nendloop\n";
    struct shader *shader;
    uint32_t *tokens;
    size_t count;
    TEST_ASSERT_EQUAL_INT(0, shader_assemble("t", text, sizeof text - 1, &shader, &error));
    TEST_ASSERT_EQUAL_INT(0, shader_encode(shader, &tokens, &count, &error));
    shader_free(shader);
    for (size_t bytes = 0; bytes < 4 * count; bytes++) {
        /* The memory has exactly the size of the bytes, so that the sanitizer finds reads after their end. */
        void *cut = malloc(bytes ? bytes : 1);
        memcpy(cut, tokens, bytes);
        error_clear(&error);
        TEST_ASSERT_EQUAL_INT(-1, shader_read("c", cut, bytes, &shader, &error));
        TEST_ASSERT_EQUAL_STRING_LEN("c: ", error.text, 3);
        free(cut);
    }
    TEST_ASSERT_EQUAL_STRING_LEN("c: 123 bytes, expected a multiple of 4", error.text, 38);
    uint32_t *longer = calloc(count + 1, 4);
    memcpy(longer, tokens, 4 * count);
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, shader_read("c", longer, 4 * count + 4, &shader, &error));
    TEST_ASSERT_EQUAL_STRING("c: token 31: found 0x00000000, expected nothing after the end token",
                             error.text);
    free(longer);
    free(tokens);
}

static void too_many_instructions_are_refused(void)
{
    enum { LINE = 4 };
    size_t bytes = 8 + LINE * (SHADER_INSTRUCTIONS + 1u);
    char *text = malloc(bytes + 1);
    struct shader *shader;
    strcpy(text, "vs_3_sw\n");
    for (size_t i = 0; i <= SHADER_INSTRUCTIONS; i++)
        memcpy(text + 8 + LINE * i, "nop\n", LINE);
    TEST_ASSERT_EQUAL_INT(-1, shader_assemble("t", text, bytes, &shader, &error));
    TEST_ASSERT_EQUAL_STRING("t: more than 65536 instructions", error.text);
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(0, shader_assemble("t", text, bytes - LINE, &shader, &error));
    TEST_ASSERT_EQUAL_UINT(SHADER_INSTRUCTIONS, shader->count);
    shader_free(shader);
    free(text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(bad_texts_are_refused_at_their_position);
    RUN_TEST(bad_tokens_are_refused_at_their_position);
    RUN_TEST(bytecode_cut_off_anywhere_is_refused);
    RUN_TEST(too_many_instructions_are_refused);
    return UNITY_END();
}
