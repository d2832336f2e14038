#include "trampoline.h"

#include <stddef.h>
#include <string.h>

/* The assembly's view of memory; names are global because assembly refers to them. */
struct machine_state trampoline_in, trampoline_out;
const void *trampoline_code;
uint64_t trampoline_stack;
uint32_t trampoline_mxcsr;

_Static_assert(offsetof(struct machine_state, general) == 512, "the assembly's offsets");
_Static_assert(offsetof(struct machine_state, flags) == 640, "the assembly's offsets");
_Static_assert(offsetof(struct machine_state, mxcsr) == 648, "the assembly's offsets");
_Static_assert(offsetof(struct machine_state, taken) == 652, "the assembly's offsets");

__asm__(".text\n"
        ".hidden trampoline_in\n.hidden trampoline_out\n.hidden trampoline_code\n"
        ".hidden trampoline_stack\n.hidden trampoline_mxcsr\n"
        ".hidden trampoline_enter\n.globl trampoline_enter\n.type trampoline_enter, @function\n"
        "trampoline_enter:\n"
        "  push %rbx\n  push %rbp\n  push %r12\n  push %r13\n  push %r14\n  push %r15\n"
        "  mov %rsp, trampoline_stack(%rip)\n"
        "  stmxcsr trampoline_mxcsr(%rip)\n"
        "  ldmxcsr trampoline_in+648(%rip)\n"
        ".irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15\n"
        "  vmovaps trampoline_in+32*\\n(%rip), %ymm\\n\n"
        ".endr\n"
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
        "  vzeroupper\n"
        "  pop %r15\n  pop %r14\n  pop %r13\n  pop %r12\n  pop %rbp\n  pop %rbx\n"
        "  ret\n");

void trampoline_enter(void);

void trampoline_run(const void *code, const struct machine_state *in, struct machine_state *out)
{
    trampoline_in = *in;
    trampoline_code = code;
    trampoline_out.taken = 0;
    trampoline_enter();
    *out = trampoline_out;
}
