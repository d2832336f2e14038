#include "tests/support/differential/trampoline.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>

/* The memory that assembly reads and writes; the names are global because assembly refers to them. */
struct machine_state trampoline_in, trampoline_out;
const void *trampoline_code;
uint32_t trampoline_wide; /* the processor has AVX-512 */
uint64_t trampoline_stack;
uint32_t trampoline_mxcsr;

_Static_assert(offsetof(struct machine_state, general) == 512, "the assembly's offsets");
_Static_assert(offsetof(struct machine_state, flags) == 640, "the assembly's offsets");
_Static_assert(offsetof(struct machine_state, mxcsr) == 648, "the assembly's offsets");
_Static_assert(offsetof(struct machine_state, taken) == 652, "the assembly's offsets");
_Static_assert(offsetof(struct machine_state, zmm_high) == 704, "the assembly's offsets");

__asm__(".text\n"
        ".hidden trampoline_in\n.hidden trampoline_out\n.hidden trampoline_code\n"
        ".hidden trampoline_stack\n.hidden trampoline_mxcsr\n.hidden trampoline_wide\n"
        ".hidden trampoline_enter\n.globl trampoline_enter\n.type trampoline_enter, @function\n"
        "trampoline_enter:\n"
        "  push %rbx\n  push %rbp\n  push %r12\n  push %r13\n  push %r14\n  push %r15\n"
        "  mov %rsp, trampoline_stack(%rip)\n"
        "  stmxcsr trampoline_mxcsr(%rip)\n"
        "  ldmxcsr trampoline_in+648(%rip)\n"
        ".irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15\n"
        "  vmovaps trampoline_in+32*\\n(%rip), %ymm\\n\n"
        ".endr\n"
        "  cmpl $0, trampoline_wide(%rip)\n"
        "  je 1f\n"
        ".irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15\n"
        "  vinserti64x4 $1, trampoline_in+704+32*\\n(%rip), %zmm\\n, %zmm\\n\n"
        ".endr\n"
        ".irp n, 16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31\n"
        "  vbroadcasti64x4 trampoline_in+704+32*(\\n-16)(%rip), %zmm\\n\n"
        ".endr\n"
        "1:\n"
        "  mov trampoline_in+512+0(%rip), %rax\n"
        "  mov trampoline_in+512+8(%rip), %rcx\n"
        "  mov trampoline_in+512+16(%rip), %rdx\n"
        "  mov trampoline_in+512+24(%rip), %rbx\n"
        "  mov trampoline_in+512+32(%rip), %rsp\n"
        "  mov trampoline_in+512+40(%rip), %rbp\n"
        "  mov trampoline_in+512+48(%rip), %rsi\n"
        "  mov trampoline_in+512+56(%rip), %rdi\n"
        ".irp n, 8,9,10,11,12,13,14,15\n"
        "  mov trampoline_in+512+8*\\n(%rip), %r\\n\n"
        ".endr\n"
        "  jmp *trampoline_code(%rip)\n"
        ".hidden trampoline_exit_taken\n.globl trampoline_exit_taken\n"
        "trampoline_exit_taken:\n"
        "  movl $1, trampoline_out+652(%rip)\n"
        ".hidden trampoline_exit\n.globl trampoline_exit\n"
        "trampoline_exit:\n"
        "  mov %rax, trampoline_out+512+0(%rip)\n"
        "  mov %rcx, trampoline_out+512+8(%rip)\n"
        "  mov %rdx, trampoline_out+512+16(%rip)\n"
        "  mov %rbx, trampoline_out+512+24(%rip)\n"
        "  mov %rsp, trampoline_out+512+32(%rip)\n"
        "  mov %rbp, trampoline_out+512+40(%rip)\n"
        "  mov %rsi, trampoline_out+512+48(%rip)\n"
        "  mov %rdi, trampoline_out+512+56(%rip)\n"
        ".irp n, 8,9,10,11,12,13,14,15\n"
        "  mov %r\\n, trampoline_out+512+8*\\n(%rip)\n"
        ".endr\n"
        "  mov trampoline_stack(%rip), %rsp\n"
        "  pushf\n  pop trampoline_out+640(%rip)\n  cld\n"
        "  stmxcsr trampoline_out+648(%rip)\n"
        "  ldmxcsr trampoline_mxcsr(%rip)\n"
        ".irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15\n"
        "  vmovaps %ymm\\n, trampoline_out+32*\\n(%rip)\n"
        ".endr\n"
        "  cmpl $0, trampoline_wide(%rip)\n"
        "  je 1f\n"
        ".irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15\n"
        "  vextracti64x4 $1, %zmm\\n, trampoline_out+704+32*\\n(%rip)\n"
        ".endr\n"
        ".irp n, 16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31\n"
        "  vpxorq %zmm\\n, %zmm\\n, %zmm\\n\n"
        ".endr\n"
        "1:\n"
        "  vzeroupper\n"
        "  pop %r15\n  pop %r14\n  pop %r13\n  pop %r12\n  pop %rbp\n  pop %rbx\n"
        "  ret\n");

void trampoline_enter(void);

int trampoline_is_wide(void)
{
    static int known, wide;
    if (!known)
        wide = __builtin_cpu_supports("avx512f") != 0;
    known = 1;
    return wide;
}

void trampoline_run(const void *code, const struct machine_state *in, struct machine_state *out)
{
    trampoline_in = *in;
    trampoline_code = code;
    trampoline_wide = (uint32_t)trampoline_is_wide();
    trampoline_out = (struct machine_state){.taken = 0};
    trampoline_enter();
    *out = trampoline_out;
}

/* --- Calls ------------------------------------------------------------------------------------------
 *
 *   unreadable page | the callee's stack, STACK_BYTES | return address | guard words | unreadable page */

enum {
    STACK_BYTES = 2 << 20,
    GUARD_BYTES = 4096, /* above the return address */
    PAGE_BYTES = 4096,
    STEPS = 256, /* of 16 bytes: the range of distances of the stack pointer from the end of the memory */
    DIRECTION_FLAG = 0x400,
    MXCSR_FLAGS = 0x3f
};

enum { RAX = 0, RCX = 1, RDX = 2, RBX = 3, RSP = 4, RBP = 5, RSI = 6, RDI = 7, R12 = 12 };

static char message[160];

__attribute__((format(printf, 1, 2))) static const char *offence(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return message;
}

static uint64_t next_random(uint64_t *seed)
{
    *seed += !*seed;
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return *seed * 0x2545f4914f6cdd1dull;
}

/* The first byte after the callee's stack and its guard words. Allocated once. */
static uint8_t *stack_end(void)
{
    static uint8_t *end;
    size_t room = STACK_BYTES + GUARD_BYTES + STEPS * 16;
    if (end)
        return end;
    uint8_t *start = mmap(NULL, room + 2 * PAGE_BYTES, PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (start == MAP_FAILED || mprotect(start, PAGE_BYTES, PROT_NONE) ||
        mprotect(start + PAGE_BYTES + room, PAGE_BYTES, PROT_NONE))
        return NULL;
    return end = start + PAGE_BYTES + room;
}

static void fill(void *memory, size_t bytes, uint64_t *seed)
{
    for (size_t at = 0; at + 8 <= bytes; at += 8)
        memcpy((uint8_t *)memory + at, &(uint64_t){next_random(seed)}, 8);
}

static const char *check_saved(const struct machine_state *in, const struct machine_state *out)
{
    static const char *const name[] = {"rax", "rcx", "rdx", "rbx", "rsp", "rbp", "rsi", "rdi"};
    if (out->general[RSP] != in->general[RSP] + 8)
        return offence("returns with rsp %lld bytes off",
                       (long long)(out->general[RSP] - in->general[RSP] - 8));
    for (int r = RBX; r < 16; r++)
        if ((r == RBX || r == RBP || r >= R12) && in->general[r] != out->general[r])
            return r < 8 ? offence("does not restore %s", name[r]) : offence("does not restore r%d", r);
    if (out->flags & DIRECTION_FLAG)
        return offence("returns with the direction flag set");
    if ((out->mxcsr ^ in->mxcsr) & ~(uint32_t)MXCSR_FLAGS)
        return offence("does not restore MXCSR: %04x, was %04x", out->mxcsr, in->mxcsr);
    return NULL;
}

/* Upper halves that are not zero slow down the next instructions that use the lower halves. */
static const char *check_upper_halves(const struct machine_state *out)
{
    static const uint8_t zero[32];
    for (int n = 0; n < 16; n++)
        if (memcmp(out->ymm[n] + 16, zero, 16) || memcmp(out->zmm_high[n], zero, 32))
            return offence("returns with something in the upper half of vector register %d", n);
    return NULL;
}

const char *trampoline_call_with(const void *function, const uint64_t argument[static TRAMPOLINE_ARGUMENTS],
                                 uint32_t mxcsr, uint64_t *seed, uint64_t result[static 2])
{
    static const uint8_t number[TRAMPOLINE_ARGUMENTS] = {RDI, RSI, RDX, RCX, 8, 9};
    static struct machine_state in, out;
    static uint8_t guard[GUARD_BYTES];
    uint8_t *end = stack_end();
    if (!end)
        return "there is no memory for a stack";
    uint8_t *top = end - GUARD_BYTES - 16 * (next_random(seed) % STEPS);
    fill(&in, offsetof(struct machine_state, flags), seed);
    fill(in.zmm_high, sizeof in.zmm_high, seed);
    fill(top, GUARD_BYTES, seed);
    memcpy(guard, top, GUARD_BYTES);
    memcpy(top - 8, &(const void *){trampoline_exit}, sizeof(void *));
    in.general[RSP] = (uint64_t)(uintptr_t)(top - 8);
    for (int i = 0; i < TRAMPOLINE_ARGUMENTS; i++)
        in.general[number[i]] = argument[i];
    in.mxcsr = mxcsr;
    trampoline_run(function, &in, &out);
    const char *found = check_saved(&in, &out);
    if (!found)
        found = check_upper_halves(&out);
    if (!found && memcmp(guard, top, GUARD_BYTES))
        found = offence("writes to its caller's frame");
    result[0] = out.general[RAX];
    result[1] = out.general[RDX];
    return found;
}

const char *trampoline_call(const void *function, const void *first, const void *second, uint32_t mxcsr,
                            uint64_t *seed)
{
    uint64_t argument[TRAMPOLINE_ARGUMENTS] = {(uint64_t)(uintptr_t)first, (uint64_t)(uintptr_t)second},
             result[2];
    for (int i = 2; i < TRAMPOLINE_ARGUMENTS; i++)
        argument[i] = next_random(seed);
    return trampoline_call_with(function, argument, mxcsr, seed, result);
}
