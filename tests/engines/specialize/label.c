/* Labels and references to them, padding, data, and the limits of the encoder's memory. Code with labels is
 * also executed, in a code arena. */
#include "machine/code.h"
#include "machine/cpu.h"
#include "machine/disassemble.h"
#include "engines/specialize/encode/encode.h"

#include <Zydis/Zydis.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unity.h>

enum { LABELS = 8, FIXUPS = 16, ROOM = 4096 };

static struct error error;
static struct code_arena *arena;
static struct code_span span;
static struct encoder encoder;
static int32_t labels[LABELS];
static struct fixup fixups[FIXUPS];

void setUp(void)
{
    error_clear(&error);
    arena = code_create(1 << 20, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, code_reserve(arena, ROOM, &span, &error), error.text);
    encode_start(&encoder, span.writable, span.bytes, labels, LABELS, fixups, FIXUPS);
}

void tearDown(void)
{
    code_destroy(arena);
}

static const void *finish(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, encode_finish(&encoder, &error), error.text);
    return code_commit(arena, &span, encode_size(&encoder));
}

typedef int integer_function(int);
typedef float float_function(float);

static void loops_and_forward_exits_run(void)
{
    enum { TOP, OUT };
    encode_gpr_rr(&encoder, X86_xor, X86_32, X86_RAX, X86_RAX);
    encode_label(&encoder, TOP);
    encode_gpr_rr(&encoder, X86_test, X86_32, X86_RDI, X86_RDI);
    encode_jump_if(&encoder, X86_IF_z, OUT);
    encode_gpr_rr(&encoder, X86_add, X86_32, X86_RAX, X86_RDI);
    encode_gpr_r(&encoder, X86_dec, X86_32, X86_RDI);
    encode_jump(&encoder, TOP);
    encode_label(&encoder, OUT);
    encode_return(&encoder);
    integer_function *sum = (integer_function *)(uintptr_t)finish();
    TEST_ASSERT_EQUAL_INT(0, sum(0));
    TEST_ASSERT_EQUAL_INT(5050, sum(100));
}

/* The subroutine is called before and after its label is bound. */
static void subroutines_are_called_and_return(void)
{
    enum { BEGIN, DOUBLE };
    encode_jump(&encoder, BEGIN);
    for (int copy = 0; copy < 2; copy++) {
        encode_label(&encoder, copy ? BEGIN : DOUBLE);
        if (copy)
            encode_call(&encoder, DOUBLE);
        encode_gpr_rr(&encoder, X86_add, X86_32, X86_RDI, X86_RDI);
        if (copy)
            encode_call(&encoder, 2);
        encode_gpr_rr(&encoder, X86_mov, X86_32, X86_RAX, X86_RDI);
        encode_return(&encoder);
    }
    encode_label(&encoder, 2);
    encode_gpr_ri(&encoder, X86_add, X86_32, X86_RDI, 1);
    encode_return(&encoder);
    integer_function *function = (integer_function *)(uintptr_t)finish();
    TEST_ASSERT_EQUAL_INT(5 * 4 + 1, function(5));
}

/* Two labels, each before the code of the other: both are referenced before and after they are bound. */
static void branches_cross_in_both_directions(void)
{
    enum { ODD, EVEN, DONE };
    encode_jump(&encoder, EVEN);
    encode_label(&encoder, ODD);
    encode_gpr_ri(&encoder, X86_sub, X86_32, X86_RDI, 1);
    encode_gpr_ri(&encoder, X86_mov, X86_32, X86_RAX, 1);
    encode_jump_if(&encoder, X86_IF_b, DONE);
    encode_label(&encoder, EVEN);
    encode_gpr_ri(&encoder, X86_sub, X86_32, X86_RDI, 1);
    encode_gpr_ri(&encoder, X86_mov, X86_32, X86_RAX, 0);
    encode_jump_if(&encoder, X86_IF_nb, ODD);
    encode_label(&encoder, DONE);
    encode_return(&encoder);
    integer_function *parity = (integer_function *)(uintptr_t)finish();
    for (int i = 0; i < 10; i++)
        TEST_ASSERT_EQUAL_INT(i & 1, parity(i));
}

/* Distances are relative to the end of the instruction, so an immediate after the address changes them. */
static void constants_before_and_after_the_code_are_found_with_any_immediate(void)
{
    enum { BEFORE, AFTER, ENTRY };
    const int32_t before[] = {3, 1000}, after[] = {0x12345678, 5};
    encode_jump(&encoder, ENTRY);
    encode_align(&encoder, 16);
    encode_label(&encoder, BEFORE);
    encode_data(&encoder, before, sizeof before);
    encode_label(&encoder, ENTRY);
    encode_gpr_rmi(&encoder, X86_imul_immediate, X86_32, X86_RAX, address_label(BEFORE, 0), 7); /* 21 */
    encode_gpr_rmi(&encoder, X86_imul_immediate, X86_32, X86_RCX, address_label(BEFORE, 4),
                   100000); /* 10^8 */
    encode_gpr_rr(&encoder, X86_add, X86_32, X86_RAX, X86_RCX);
    encode_gpr_rmi(&encoder, X86_imul_immediate, X86_32, X86_RCX, address_label(AFTER, 4), -9); /* -45 */
    encode_gpr_rr(&encoder, X86_add, X86_32, X86_RAX, X86_RCX);
    encode_gpr_rmi(&encoder, X86_imul_immediate, X86_32, X86_RCX, address_label(AFTER, 4), 1 << 20);
    encode_gpr_rr(&encoder, X86_add, X86_32, X86_RAX, X86_RCX);
    encode_gpr_rm(&encoder, X86_movzx16, X86_32, X86_RCX, address_label(AFTER, 1));
    encode_gpr_rr(&encoder, X86_add, X86_32, X86_RAX, X86_RCX);
    encode_return(&encoder);
    encode_align(&encoder, 32);
    encode_label(&encoder, AFTER);
    encode_data(&encoder, after, sizeof after);
    integer_function *function = (integer_function *)(uintptr_t)finish();
    TEST_ASSERT_EQUAL_INT(21 + 100000000 - 45 + (5 << 20) + 0x3456, function(0));
}

static void vector_code_reads_its_pool(void)
{
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    enum { POOL };
    const float pool[] = {2.5f, 0.25f};
    encode_rrr(&encoder, X86_vaddss, X86_128, 9, 0, 0);
    encode_rm(&encoder, X86_vbroadcastss, X86_128, 14, address_label(POOL, 0));
    encode_rrm(&encoder, X86_vfmadd213ps, X86_128, 9, 14, address_label(POOL, -12)); /* lane 3 is 2.5 */
    encode_copy(&encoder, X86_128, 1, 9);
    encode_rrri(&encoder, X86_vshufps, X86_128, 0, 1, 1, 0);
    encode_rrm(&encoder, X86_vmulss, X86_128, 0, 0, address_label(POOL, 4));
    encode_none(&encoder, X86_vzeroupper);
    encode_return(&encoder);
    encode_align(&encoder, 16);
    encode_data(&encoder, (float[]){7.0f, 0, 0}, 12);
    encode_label(&encoder, POOL);
    encode_data(&encoder, pool, sizeof pool);
    float_function *function = (float_function *)(uintptr_t)finish();
    TEST_ASSERT_EQUAL_FLOAT((2 * 3.0f * 2.5f + 7.0f) * 0.25f, function(3.0f));
}

/* Decodes the instruction at `offset`; returns its mnemonic and where it jumps to. */
static const char *decode_jump(size_t offset, size_t *length, int64_t *target)
{
    ZydisDecoder decoder;
    ZydisDecodedInstruction instruction;
    ZydisDecodedOperand operands[ZYDIS_MAX_OPERAND_COUNT];
    ZyanU64 address;
    ZydisDecoderInit(&decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    TEST_ASSERT_TRUE(ZYAN_SUCCESS(ZydisDecoderDecodeFull(
        &decoder, span.writable + offset, encode_size(&encoder) - offset, &instruction, operands)));
    TEST_ASSERT_TRUE(ZYAN_SUCCESS(ZydisCalcAbsoluteAddress(&instruction, &operands[0], offset, &address)));
    *length = instruction.length;
    *target = (int64_t)address;
    return ZydisMnemonicGetString(instruction.mnemonic);
}

/* Encodes one jump with `gap` bytes between it and its label, on either side, and checks the result. */
static void check_jump(const char *mnemonic, int condition, unsigned gap, bool backward)
{
    encode_start(&encoder, span.writable, span.bytes, labels, LABELS, fixups, FIXUPS);
    if (backward) {
        encode_label(&encoder, 0);
        encode_nops(&encoder, gap);
    }
    size_t offset = encode_size(&encoder), length;
    if (condition < 0)
        encode_jump(&encoder, 0);
    else
        encode_jump_if(&encoder, (enum x86_condition)condition, 0);
    size_t end = encode_size(&encoder);
    if (!backward) {
        encode_nops(&encoder, gap);
        encode_label(&encoder, 0);
    }
    int64_t target;
    TEST_ASSERT_EQUAL_INT(0, encode_finish(&encoder, &error));
    TEST_ASSERT_EQUAL_STRING(mnemonic, decode_jump(offset, &length, &target));
    TEST_ASSERT_EQUAL_INT64(backward ? 0 : (int64_t)(end + gap), target);
    bool is_short = backward && gap + 2 <= 128;
    TEST_ASSERT_EQUAL_UINT64(is_short ? 2 : condition < 0 ? 5 : 6, length);
    TEST_ASSERT_EQUAL_UINT64(end - offset, length);
}

static void every_jump_reaches_its_label_and_near_backward_ones_are_short(void)
{
    static const struct {
        const char *mnemonic;
        int condition;
    } jumps[] = {
        {"jmp", -1},
#define X86_CONDITION(name, code) {"j" #name, X86_IF_##name},
#include "def/engine/x86.def"
    };
    static const unsigned gaps[] = {0, 1, 100, 125, 126, 127, 128, 1000};
    for (unsigned j = 0; j < sizeof jumps / sizeof *jumps; j++)
        for (unsigned g = 0; g < sizeof gaps / sizeof *gaps; g++)
            for (int backward = 0; backward <= 1; backward++)
                check_jump(jumps[j].mnemonic, jumps[j].condition, gaps[g], backward);
}

static void count_nop(void *context, size_t offset, size_t length, const char *text)
{
    (void)offset, (void)length;
    *(int *)context += !strncmp(text, "nop", 3);
}

static void padding_is_the_fewest_nops(void)
{
    for (unsigned count = 0; count <= 64; count++) {
        encode_start(&encoder, span.writable, span.bytes, labels, LABELS, fixups, FIXUPS);
        encode_nops(&encoder, count);
        int nops = 0;
        size_t lines = disassemble(span.writable, encode_size(&encoder), 0, count_nop, &nops);
        TEST_ASSERT_EQUAL_UINT64(count, encode_size(&encoder));
        TEST_ASSERT_EQUAL_INT((int)(count + 8) / 9, nops);
        TEST_ASSERT_EQUAL_UINT64((uint64_t)nops, lines);
    }
}

static void alignment_counts_from_the_start(void)
{
    for (unsigned alignment = 1; alignment <= 64; alignment *= 2)
        for (unsigned before = 0; before <= 65; before++) {
            encode_start(&encoder, span.writable, span.bytes, labels, LABELS, fixups, FIXUPS);
            encode_nops(&encoder, before);
            encode_align(&encoder, alignment);
            TEST_ASSERT_EQUAL_UINT64((before + alignment - 1) / alignment * alignment, encode_size(&encoder));
        }
}

/* Calls every function that writes bytes. */
static void encode_much(struct encoder *e)
{
    encode_label(e, 0);
    for (int i = 0; i < 3; i++) {
        encode_rrm(e, X86_vaddps, X86_256, 1, 2, address_indexed(X86_R12, X86_R13, 8, 0x1000));
        encode_rrmr(e, X86_vblendvps, X86_256, 12, 2, address_label(1, 64), 9);
        encode_gpr_mi(e, X86_mov, X86_64, address_indexed(X86_R8, X86_R9, 4, 1000), 123456789);
        encode_gpr_constant(e, X86_R15, 0x123456789ABCDEF0);
        encode_gpr_constant(e, X86_R15, 5);
        encode_gpr_r(e, X86_push, X86_64, X86_R12);
        encode_none(e, X86_vzeroupper);
        encode_jump_if(e, X86_IF_z, 1);
        encode_jump(e, 0);
        encode_data(e, "constant", 8);
        encode_nops(e, 13);
        encode_return(e);
    }
    encode_label(e, 1);
}

static void nothing_is_written_past_the_limit(void)
{
    enum { GUARD = 64 };
    static uint8_t whole[ROOM], part[ROOM];
    encode_start(&encoder, whole, sizeof whole, labels, LABELS, fixups, FIXUPS);
    encode_much(&encoder);
    size_t size = encode_size(&encoder);
    TEST_ASSERT_EQUAL_INT(0, encode_finish(&encoder, &error));
    TEST_ASSERT_TRUE(size < ROOM - GUARD);
    for (size_t room = 0; room < size; room++) {
        memset(part, 0xAA, sizeof part);
        encode_start(&encoder, part, room, labels, LABELS, fixups, FIXUPS);
        encode_much(&encoder);
        size_t written = encode_size(&encoder);
        TEST_ASSERT_EQUAL_INT(ENCODER_OUT_OF_CODE, encoder.failure);
        TEST_ASSERT_TRUE(written <= room && written + 40 > room);
        for (size_t i = room; i < room + GUARD; i++)
            TEST_ASSERT_EQUAL_HEX8(0xAA, part[i]);
        error_clear(&error);
        TEST_ASSERT_EQUAL_INT(-1, encode_finish(&encoder, &error));
        char reason[128];
        snprintf(reason, sizeof reason, "machine code does not fit: no room after %zu bytes", written);
        TEST_ASSERT_EQUAL_STRING(reason, error.text);
    }
    encode_start(&encoder, part, size + ENCODER_SLACK, labels, LABELS, fixups, FIXUPS);
    encode_much(&encoder);
    TEST_ASSERT_EQUAL_INT(0, encode_finish(&encoder, NULL));
    TEST_ASSERT_EQUAL_MEMORY(whole, part, size);
}

static void a_failure_is_sticky(void)
{
    static uint8_t code[ENCODER_SLACK - 1];
    encode_start(&encoder, code, sizeof code, labels, LABELS, fixups, FIXUPS);
    encode_none(&encoder, X86_vzeroupper);
    encode_return(&encoder); /* would fit */
    TEST_ASSERT_EQUAL_INT(ENCODER_OUT_OF_CODE, encoder.failure);
    TEST_ASSERT_EQUAL_UINT64(0, encode_size(&encoder));
    TEST_ASSERT_EQUAL_HEX8(0, code[0]);
}

static void more_forward_references_than_fixups_are_refused(void)
{
    encode_start(&encoder, span.writable, span.bytes, labels, LABELS, fixups, 2);
    for (int i = 0; i < 3; i++)
        encode_jump(&encoder, 0);
    encode_label(&encoder, 0);
    encode_jump(&encoder, 0);
    TEST_ASSERT_EQUAL_INT(-1, encode_finish(&encoder, &error));
    TEST_ASSERT_EQUAL_INT(ENCODER_OUT_OF_FIXUPS, encoder.failure);
    TEST_ASSERT_EQUAL_STRING("machine code has more than 2 forward references", error.text);
}

static void an_unbound_label_is_refused(void)
{
    encode_jump(&encoder, 3);
    TEST_ASSERT_EQUAL_INT(-1, encode_finish(&encoder, &error));
    TEST_ASSERT_EQUAL_INT(ENCODER_UNBOUND_LABEL, encoder.failure);
    TEST_ASSERT_EQUAL_STRING("machine code refers to label 3, which is bound nowhere", error.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(loops_and_forward_exits_run);
    RUN_TEST(branches_cross_in_both_directions);
    RUN_TEST(subroutines_are_called_and_return);
    RUN_TEST(constants_before_and_after_the_code_are_found_with_any_immediate);
    RUN_TEST(vector_code_reads_its_pool);
    RUN_TEST(every_jump_reaches_its_label_and_near_backward_ones_are_short);
    RUN_TEST(padding_is_the_fewest_nops);
    RUN_TEST(alignment_counts_from_the_start);
    RUN_TEST(nothing_is_written_past_the_limit);
    RUN_TEST(a_failure_is_sticky);
    RUN_TEST(more_forward_references_than_fixups_are_refused);
    RUN_TEST(an_unbound_label_is_refused);
    return UNITY_END();
}
