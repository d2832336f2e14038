#define _GNU_SOURCE /* REG_RIP and others */
#include "tests/support/routine/stepper.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <ucontext.h>
#include <unity.h>

enum { TRAP_FLAG = 0x100, STACK_BYTES = 1 << 18 };

static struct {
    uint64_t code, bytes;
    stepper_callback *callback;
    void *user;
} stepped;

static void trap(int signal, siginfo_t *information, void *context)
{
    static const int number[UNWINDER_REGISTERS] = {REG_RAX, REG_RDX, REG_RCX, REG_RBX, REG_RSI, REG_RDI,
                                                   REG_RBP, REG_RSP, REG_R8,  REG_R9,  REG_R10, REG_R11,
                                                   REG_R12, REG_R13, REG_R14, REG_R15, REG_RIP};
    ucontext_t *machine = context;
    uint64_t value[UNWINDER_REGISTERS];
    (void)signal, (void)information;
    for (int i = 0; i < UNWINDER_REGISTERS; i++)
        value[i] = (uint64_t)machine->uc_mcontext.gregs[number[i]];
    if (value[UNWINDER_REGISTERS - 1] - stepped.code < stepped.bytes)
        stepped.callback(stepped.user, value);
}

/* The flag is set immediately before the call, and cleared immediately after it. */
static void call_trapped(void (*function)(const void *, const void *), const void *first, const void *second)
{
    __asm__ volatile("mov %%rsp, %%rbx\n"
                     "and $-16, %%rsp\n"
                     "sub $248, %%rsp\n"
                     "pushf\n"
                     "pushf\n"
                     "orl %[flag], (%%rsp)\n"
                     "popf\n"
                     "call *%[function]\n"
                     "popf\n"
                     "mov %%rbx, %%rsp\n"
                     : "+D"(first), "+S"(second)
                     : [function] "r"(function), [flag] "i"(TRAP_FLAG)
                     : "rax", "rbx", "rcx", "rdx", "r8", "r9", "r10", "r11", "memory", "cc", "xmm0", "xmm1",
                       "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8", "xmm9", "xmm10", "xmm11",
                       "xmm12", "xmm13", "xmm14", "xmm15");
}

void stepper_call(void (*function)(const void *first, const void *second), const void *first,
                  const void *second, const void *code, size_t bytes, stepper_callback *callback, void *user)
{
    struct sigaction action = {.sa_sigaction = trap, .sa_flags = SA_SIGINFO | SA_ONSTACK}, before;
    stack_t stack = {.ss_sp = malloc(STACK_BYTES), .ss_size = STACK_BYTES}, stack_before;
    TEST_ASSERT_NOT_NULL(stack.ss_sp);
    TEST_ASSERT_EQUAL_INT(0, sigaltstack(&stack, &stack_before));
    TEST_ASSERT_EQUAL_INT(0, sigaction(SIGTRAP, &action, &before));
    stepped.code = (uintptr_t)code;
    stepped.bytes = bytes;
    stepped.callback = callback;
    stepped.user = user;
    call_trapped(function, first, second);
    sigaction(SIGTRAP, &before, NULL);
    sigaltstack(&stack_before, NULL);
    free(stack.ss_sp);
}
