/* Shaders that their models forbid and drivers accept (front/d3d9/state/tolerate.c). */
#include "front/d3d9/state/shader.h"

#include <string.h>
#include <unity.h>

enum { XYZW = 0x800f0005, XYZ = 0x80070005, XY = 0x80030005, X = 0x80010005, SOURCE = 0x90e40000 };
enum {
    M4X4 = 20,
    M4X3 = 21,
    M3X3 = 23,
    M3X2 = 24,
    EXPP = 78,
    LOGP = 79,
    DEF = 81,
    NOP = 0,
    MOV = 1,
    END = 0xffff
};

void setUp(void)
{
}
void tearDown(void)
{
}

static void check(uint32_t version, uint32_t opcode, uint32_t result, uint32_t expected)
{
    uint32_t code[] = {version, opcode, result, SOURCE, SOURCE, END};
    d3d9_state_tolerate(code, 6);
    TEST_ASSERT_EQUAL_HEX32(expected, code[2]);
    TEST_ASSERT_EQUAL_HEX32(opcode, code[1]);
    TEST_ASSERT_EQUAL_HEX32(SOURCE, code[3]);
}

static void a_matrix_writes_the_components_of_its_rows(void)
{
    check(0xfffe0101, M3X3, XYZW, XYZ);
    check(0xfffe0101, M4X3, XYZW, XYZ);
    check(0xfffe0101, M3X2, XYZ, XY);
    check(0xfffe0200, M3X3 | 3 << 24, XYZW, XYZ);
}

static void other_masks_stay(void)
{
    check(0xfffe0101, M3X3, XYZ, XYZ);
    check(0xfffe0101, M3X3, X, X);
    check(0xfffe0101, M4X4, XYZW, XYZW);
}

/* The constant's words look like an instruction with another mask. */
static void constants_and_comments_are_not_instructions(void)
{
    uint32_t code[] = {0xfffe0101, DEF, 0xa00f0000, M3X3, XYZW, 0, 0, 0x0002fffe, M3X3, XYZW, END};
    d3d9_state_tolerate(code, 11);
    TEST_ASSERT_EQUAL_HEX32(XYZW, code[4]);
    TEST_ASSERT_EQUAL_HEX32(XYZW, code[9]);
}

static void an_instruction_after_a_constant_is_found(void)
{
    uint32_t code[] = {0xfffe0101, DEF, 0xa00f0000, 0, 0, 0, 0, M3X3, XYZW, SOURCE, SOURCE, END};
    d3d9_state_tolerate(code, 12);
    TEST_ASSERT_EQUAL_HEX32(XYZ, code[8]);
}

/* The words of a constant and of a comment stay, and so do operands. */
static void software_shaders_have_the_lengths_of_instructions(void)
{
    uint32_t code[] = {0xfffe0101, 31,         0x80000000, 0x900f0000, DEF, 0xa00f0100, MOV,        XYZW, 0,
                       0,          0x0001fffe, MOV,        NOP,        MOV, 0xc00f0000, 0xa0e40100, END};
    uint32_t expected[sizeof code / sizeof *code];
    memcpy(expected, code, sizeof code);
    expected[0] = 0xfffe02ff;
    expected[1] |= 2 << 24;
    expected[4] |= 5 << 24;
    expected[13] |= 2 << 24;
    TEST_ASSERT_TRUE(d3d9_state_lengthen(code, sizeof code / sizeof *code));
    TEST_ASSERT_EQUAL_HEX32_ARRAY(expected, code, sizeof code / sizeof *code);
}

static void expect_no_software(uint32_t opcode, uint32_t result)
{
    uint32_t code[] = {0xfffe0101, opcode, result, SOURCE, END};
    TEST_ASSERT_FALSE(d3d9_state_lengthen(code, sizeof code / sizeof *code));
}

static void instructions_with_another_meaning_in_model_2_stay_in_model_1(void)
{
    expect_no_software(EXPP, XYZW);
    expect_no_software(LOGP, XYZW);
    expect_no_software(MOV, 0xb0010000);
    expect_no_software(MOV | 2 << 24, XYZW);
    expect_no_software(DEF, XYZW);
    expect_no_software(0x7ffffffe, XYZW);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_matrix_writes_the_components_of_its_rows);
    RUN_TEST(other_masks_stay);
    RUN_TEST(constants_and_comments_are_not_instructions);
    RUN_TEST(an_instruction_after_a_constant_is_found);
    RUN_TEST(software_shaders_have_the_lengths_of_instructions);
    RUN_TEST(instructions_with_another_meaning_in_model_2_stay_in_model_1);
    return UNITY_END();
}
