/* The disassembly listing: Intel syntax, absolute targets, no byte omitted. */
#include "machine/disassemble.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

static char listing[1024];

void setUp(void)
{
    listing[0] = 0;
}

void tearDown(void)
{
}

static void append(void *context, size_t offset, size_t length, const char *text)
{
    size_t used = strlen(context);
    snprintf((char *)context + used, sizeof listing - used, "%zu+%zu %s\n", offset, length, text);
}

static void instructions_are_listed_in_intel_syntax(void)
{
    const uint8_t code[] = {0xC5, 0xF4, 0x58, 0x47, 0x40, 0x48, 0x83, 0xC7, 0x10, 0xC3};
    TEST_ASSERT_EQUAL_UINT64(3, disassemble(code, sizeof code, 0, append, listing));
    TEST_ASSERT_EQUAL_STRING("0+5 vaddps ymm0, ymm1, [rdi+0x40]\n"
                             "5+4 add rdi, 0x10\n"
                             "9+1 ret\n",
                             listing);
}

static void targets_are_absolute_in_the_address_the_code_runs_at(void)
{
    const uint8_t code[] = {0xEB, 0x06, 0xC5, 0xFA, 0x10, 0x05, 0x10, 0, 0, 0};
    TEST_ASSERT_EQUAL_UINT64(2, disassemble(code, sizeof code, 0x7f0012340000, append, listing));
    TEST_ASSERT_EQUAL_STRING("0+2 jmp 0x7f0012340008\n"
                             "2+8 vmovss xmm0, dword ptr [0x7f001234001a]\n",
                             listing);
}

static void invalid_or_incomplete_instructions_become_data(void)
{
    const uint8_t code[] = {0x06, 0x90, 0xC5, 0x06};
    TEST_ASSERT_EQUAL_UINT64(4, disassemble(code, sizeof code, 0, append, listing));
    TEST_ASSERT_EQUAL_STRING("0+1 db 0x06\n"
                             "1+1 nop\n"
                             "2+1 db 0xc5\n"
                             "3+1 db 0x06\n",
                             listing);
}

static void the_instruction_set_is_the_largest_encoding(void)
{
    static const uint8_t sse[] = {0x0f, 0x58, 0xc1}, avx[] = {0x0f, 0x58, 0xc1, 0xc5, 0xf4, 0x58, 0xc2},
                         evex[] = {0xc5, 0xf4, 0x58, 0xc2, 0x62, 0xf1, 0x74, 0x48, 0x58, 0xc2};
    TEST_ASSERT_EQUAL_STRING("SSE2", disassemble_set(sse, sizeof sse));
    TEST_ASSERT_EQUAL_STRING("AVX2", disassemble_set(avx, sizeof avx));
    TEST_ASSERT_EQUAL_STRING("AVX-512", disassemble_set(evex, sizeof evex));
    TEST_ASSERT_EQUAL_STRING("SSE2", disassemble_set(evex, 0));
}

static void an_empty_range_has_an_empty_listing(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, disassemble("", 0, 0, append, listing));
    TEST_ASSERT_EQUAL_STRING("", listing);
}

/* A nop, a push and an address that is only computed do not count as accesses. */
static void memory_operands_are_counted(void)
{
    static const uint8_t code[] = {
        0x55,                         /* push rbp */
        0x48, 0x8d, 0x44, 0x24, 0x08, /* lea rax, [rsp + 8] */
        0x0f, 0x1f, 0x00,             /* nop [rax] */
        0xc5, 0xfa, 0x10, 0x01,       /* vmovss xmm0, [rcx] */
        0xc5, 0xfa, 0x11, 0x04, 0x24, /* vmovss [rsp], xmm0 */
        0x01, 0x04, 0x24,             /* add [rsp], eax */
        0x8b, 0x45, 0xf8,             /* mov eax, [rbp - 8] */
        0xc3                          /* ret */
    };
    struct disassemble_counts counts = disassemble_count(code, sizeof code);
    TEST_ASSERT_EQUAL_UINT32(7, counts.instructions);
    TEST_ASSERT_EQUAL_UINT32(3, counts.reads);
    TEST_ASSERT_EQUAL_UINT32(2, counts.writes);
    TEST_ASSERT_EQUAL_UINT32(3, counts.frame);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(instructions_are_listed_in_intel_syntax);
    RUN_TEST(targets_are_absolute_in_the_address_the_code_runs_at);
    RUN_TEST(invalid_or_incomplete_instructions_become_data);
    RUN_TEST(the_instruction_set_is_the_largest_encoding);
    RUN_TEST(an_empty_range_has_an_empty_listing);
    RUN_TEST(memory_operands_are_counted);
    return UNITY_END();
}
