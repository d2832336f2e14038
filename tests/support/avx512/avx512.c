#define _GNU_SOURCE /* REG_RIP and others */
#include "tests/support/avx512/avx512_part.h"

#include "machine/cpu.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { TRAP_FLAG = 0x100, STACK_BYTES = 1 << 18, XSAVE_HEADER = 512, XSAVE_HIGH = 576, XSAVE_VECTORS = 7 };

static struct avx512_machine machine;
static const struct code_arena *code;
static struct sigaction before[2];
static stack_t stack, stack_before;

void avx512_fail(const struct avx512_machine *m, const char *reason)
{
    fprintf(stderr, "%s with %u operands: %s\n", ZydisMnemonicGetString(m->instruction.mnemonic),
            m->instruction.operand_count_visible, reason);
    abort();
}

/* --- Registers ------------------------------------------------------------------------------------------ */

struct avx512_vector avx512_read(const struct avx512_machine *m, unsigned number)
{
    struct avx512_vector vector;
    if (number >= AVX512_WORDS)
        return m->further[number - AVX512_WORDS];
    memcpy(vector.word, m->low[number], sizeof m->low[number]);
    memcpy(vector.word + AVX512_LANE, m->high[number], sizeof m->high[number]);
    memcpy(vector.word + AVX512_HALF, m->upper[number], sizeof m->upper[number]);
    return vector;
}

void avx512_write(struct avx512_machine *m, unsigned number, const struct avx512_vector *vector)
{
    if (number >= AVX512_WORDS) {
        m->further[number - AVX512_WORDS] = *vector;
        return;
    }
    memcpy(m->low[number], vector->word, sizeof m->low[number]);
    memcpy(m->high[number], vector->word + AVX512_LANE, sizeof m->high[number]);
    memcpy(m->upper[number], vector->word + AVX512_HALF, sizeof m->upper[number]);
}

int avx512_vector_number(ZydisRegister reg)
{
    if (reg >= ZYDIS_REGISTER_XMM0 && reg <= ZYDIS_REGISTER_XMM31)
        return (int)(reg - ZYDIS_REGISTER_XMM0);
    if (reg >= ZYDIS_REGISTER_YMM0 && reg <= ZYDIS_REGISTER_YMM31)
        return (int)(reg - ZYDIS_REGISTER_YMM0);
    return reg >= ZYDIS_REGISTER_ZMM0 && reg <= ZYDIS_REGISTER_ZMM31 ? (int)(reg - ZYDIS_REGISTER_ZMM0) : -1;
}

int avx512_mask_number(ZydisRegister reg)
{
    return reg >= ZYDIS_REGISTER_K0 && reg <= ZYDIS_REGISTER_K7 ? (int)(reg - ZYDIS_REGISTER_K0) : -1;
}

greg_t *avx512_general(const struct avx512_machine *m, ZydisRegister reg)
{
    static const int number[] = {REG_RAX, REG_RCX, REG_RDX, REG_RBX, REG_RSP, REG_RBP, REG_RSI, REG_RDI,
                                 REG_R8,  REG_R9,  REG_R10, REG_R11, REG_R12, REG_R13, REG_R14, REG_R15};
    ZydisRegister whole = ZydisRegisterGetLargestEnclosing(ZYDIS_MACHINE_MODE_LONG_64, reg);
    if (whole < ZYDIS_REGISTER_RAX || whole > ZYDIS_REGISTER_R15)
        avx512_fail(m, "a register is not a general one");
    return &m->general[number[whole - ZYDIS_REGISTER_RAX]];
}

uint8_t *avx512_address(const struct avx512_machine *m, const ZydisDecodedOperand *operand)
{
    int64_t at = operand->mem.disp.value;
    if (operand->mem.base == ZYDIS_REGISTER_RIP)
        at += m->general[REG_RIP] + m->instruction.length;
    else if (operand->mem.base != ZYDIS_REGISTER_NONE)
        at += *avx512_general(m, operand->mem.base);
    if (operand->mem.index != ZYDIS_REGISTER_NONE)
        at += *avx512_general(m, operand->mem.index) * operand->mem.scale;
    return (uint8_t *)(uintptr_t)at;
}

/* --- Operands ------------------------------------------------------------------------------------------- */

/* How many words one element of memory that is broadcast has. */
static unsigned broadcast_words(const struct avx512_machine *m)
{
    switch (m->instruction.avx.broadcast.mode) {
    case ZYDIS_BROADCAST_MODE_1_TO_2: return m->words / 2;
    case ZYDIS_BROADCAST_MODE_1_TO_4: return m->words / 4;
    case ZYDIS_BROADCAST_MODE_1_TO_8: return m->words / 8;
    case ZYDIS_BROADCAST_MODE_1_TO_16: return m->words / 16;
    default: return 0;
    }
}

/* Returns true if the mask chooses the words of memory that are read, not only those of the result. */
static bool is_move(const struct avx512_machine *m)
{
    return m->instruction.mnemonic == ZYDIS_MNEMONIC_VMOVUPS ||
           m->instruction.mnemonic == ZYDIS_MNEMONIC_VMOVAPS;
}

struct avx512_vector avx512_operand(const struct avx512_machine *m, const ZydisDecodedOperand *operand)
{
    struct avx512_vector vector = {{0}};
    if (operand->type == ZYDIS_OPERAND_TYPE_REGISTER) {
        int number = avx512_vector_number(operand->reg.value);
        if (number < 0)
            avx512_fail(m, "an operand is not a vector");
        return avx512_read(m, (unsigned)number);
    }
    const uint8_t *from = avx512_address(m, operand);
    const unsigned element = broadcast_words(m), words = operand->size / 32;
    for (unsigned i = 0; i < (element ? m->words : words); i++)
        if (!is_move(m) || m->writes >> i & 1)
            memcpy(&vector.word[i], from + 4 * (element ? i % element : i), sizeof vector.word[i]);
    return vector;
}

void avx512_result(struct avx512_machine *m, const struct avx512_vector *vector)
{
    const ZydisDecodedOperand *to = &m->operand[0];
    if (to->type == ZYDIS_OPERAND_TYPE_MEMORY) {
        for (unsigned i = 0; i < to->size / 32; i++)
            if (m->writes >> i & 1)
                memcpy(avx512_address(m, to) + sizeof(uint32_t) * i, &vector->word[i], sizeof(uint32_t));
        return;
    }
    const unsigned number = (unsigned)avx512_vector_number(to->reg.value);
    struct avx512_vector result = avx512_read(m, number);
    for (unsigned i = 0; i < AVX512_WORDS; i++)
        if (i >= m->words || (m->zeroes && !(m->writes >> i & 1)))
            result.word[i] = 0;
        else if (m->writes >> i & 1)
            result.word[i] = vector->word[i];
    avx512_write(m, number, &result);
}

/* --- Signals -------------------------------------------------------------------------------------------- */

/* Removes the operand that is the mask from the list. */
static void take_mask(struct avx512_machine *m)
{
    m->writes = AVX512_ALL;
    m->zeroes = m->instruction.avx.mask.mode == ZYDIS_MASK_MODE_ZEROING;
    if (m->instruction.encoding != ZYDIS_INSTRUCTION_ENCODING_EVEX ||
        m->operand[1].encoding != ZYDIS_OPERAND_ENCODING_MASK)
        return;
    if (m->operand[1].reg.value != ZYDIS_REGISTER_K0)
        m->writes = m->mask[avx512_mask_number(m->operand[1].reg.value)];
    memmove(m->operand + 1, m->operand + 2, (ZYDIS_MAX_OPERAND_COUNT - 2) * sizeof m->operand[0]);
}

static bool is_inside(const struct avx512_machine *m)
{
    return code_contains(code, (const void *)(uintptr_t)m->general[REG_RIP]);
}

static void decode(struct avx512_machine *m)
{
    const uint8_t *at = (const uint8_t *)(uintptr_t)m->general[REG_RIP];
    if (!ZYAN_SUCCESS(ZydisDecoderDecodeFull(&m->decoder, at, ZYDIS_MAX_INSTRUCTION_LENGTH, &m->instruction,
                                             m->operand)))
        avx512_fail(m, "is not an instruction");
    m->words = m->instruction.avx.vector_length / 32;
    if (avx512_is_own(m))
        take_mask(m);
}

/* An instruction with a VEX prefix clears the rest of its result's register. */
static void clear_upper(struct avx512_machine *m)
{
    if (m->instruction.mnemonic == ZYDIS_MNEMONIC_VZEROUPPER)
        memset(m->upper, 0, sizeof m->upper);
    for (unsigned n = 0; n < m->instruction.operand_count; n++) {
        const ZydisDecodedOperand *o = &m->operand[n];
        int number = o->type == ZYDIS_OPERAND_TYPE_REGISTER ? avx512_vector_number(o->reg.value) : -1;
        if (number >= 0 && o->actions & ZYDIS_OPERAND_ACTION_MASK_WRITE)
            memset(m->upper[number], 0, sizeof m->upper[number]);
    }
}

/* The registers of the interrupted program. In the area, a vector state that was never used is absent. */
static void find_registers(struct avx512_machine *m, ucontext_t *context)
{
    uint8_t *area = (uint8_t *)context->uc_mcontext.fpregs;
    uint64_t *present = (uint64_t *)(void *)(area + XSAVE_HEADER);
    m->general = context->uc_mcontext.gregs;
    m->low = (uint32_t(*)[AVX512_LANE])(void *)context->uc_mcontext.fpregs->_xmm;
    m->high = (uint32_t(*)[AVX512_LANE])(void *)(area + XSAVE_HIGH);
    m->mxcsr = &context->uc_mcontext.fpregs->mxcsr;
    if (!(*present & 2))
        memset(m->low, 0, AVX512_WORDS * sizeof m->low[0]);
    if (!(*present & 4))
        memset(m->high, 0, AVX512_WORDS * sizeof m->high[0]);
    *present |= XSAVE_VECTORS;
}

/* Other code must not depend on what is left. */
static void leave(struct avx512_machine *m)
{
    memset(m->upper, 0, sizeof m->upper);
    memset(m->further, 0xa5, sizeof m->further);
    memset(m->mask, 0x5a, sizeof m->mask);
    m->general[REG_EFL] &= ~TRAP_FLAG;
}

/* The signals are that of an instruction that the processor refuses, and that of the trap flag. Others, such
 * as that of a stray jump to padding, end the process. */
static void step(int number, siginfo_t *information, void *context)
{
    struct avx512_machine *m = &machine;
    bool refused = number == SIGILL;
    find_registers(m, context);
    if (refused ? !is_inside(m) : information->si_code != TRAP_TRACE)
        avx512_fail(m, "was executed last, before code that is not that of the arena");
    for (; is_inside(m); refused = false) {
        decode(m);
        if (!avx512_is_own(m)) {
            if (refused)
                avx512_fail(m, "is refused by the processor");
            clear_upper(m);
            m->general[REG_EFL] |= TRAP_FLAG;
            return;
        }
        avx512_execute(m);
        m->executed++;
        m->general[REG_RIP] += m->instruction.length;
    }
    leave(m);
}

void avx512_begin(const struct code_arena *arena)
{
    struct sigaction action = {.sa_sigaction = step, .sa_flags = SA_SIGINFO | SA_ONSTACK};
    stack = (stack_t){.ss_sp = malloc(STACK_BYTES), .ss_size = STACK_BYTES};
    TEST_ASSERT_NOT_NULL(stack.ss_sp);
    avx512_prepare_twins();
    memset(&machine, 0, sizeof machine);
    ZydisDecoderInit(&machine.decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    code = arena;
    TEST_ASSERT_EQUAL_INT(0, sigaltstack(&stack, &stack_before));
    TEST_ASSERT_EQUAL_INT(0, sigaction(SIGILL, &action, &before[0]));
    TEST_ASSERT_EQUAL_INT(0, sigaction(SIGTRAP, &action, &before[1]));
}

void avx512_end(void)
{
    if (!code)
        return;
    sigaction(SIGILL, &before[0], NULL);
    sigaction(SIGTRAP, &before[1], NULL);
    sigaltstack(&stack_before, NULL);
    free(stack.ss_sp);
    code = NULL;
}

bool avx512_runs(void)
{
    return code || !cpu_lacks_avx512();
}

size_t avx512_executed(void)
{
    return machine.executed;
}
