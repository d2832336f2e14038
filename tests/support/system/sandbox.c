#include "tests/support/system/sandbox.h"

#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

const struct sandbox sandbox_refusals[SANDBOX_REFUSALS] = {
    {.protection = PROT_EXEC, .error = EPERM},  /* the seccomp filter of a sandbox */
    {.protection = PROT_EXEC, .error = EACCES}, /* SELinux without execmem */
    {.protection = PROT_EXEC,
     .shared = 1,
     .error = EACCES},                    /* SELinux: programs are loaded, a memfd is not run */
    {.memory_files = 1, .error = ENOSYS}, /* an old kernel */
    {.memory_files = 1, .error = EACCES}, /* vm.memfd_noexec = 2 */
    {.protection = PROT_EXEC, .memory_files = 1, .error = EPERM}, /* both */
};

enum { FILTER_CAPACITY = 64, PROTECTION = 2, FLAGS = 3 /* arguments of the system calls */ };

struct filter {
    struct sock_filter code[FILTER_CAPACITY];
    unsigned short count;
};

static void add(struct filter *filter, struct sock_filter instruction)
{
    filter->code[filter->count++] = instruction;
}

static void load(struct filter *filter, size_t offset)
{
    add(filter, (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (uint32_t)offset));
}

static size_t argument(int i) /* the offset of its lower half */
{
    return offsetof(struct seccomp_data, args) + (size_t)i * sizeof(uint64_t);
}

/* Skips the next `count` instructions unless the loaded word is `value`. */
static void unless_equal(struct filter *filter, uint32_t value, uint8_t count)
{
    add(filter, (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, count));
}

static void refuse(struct filter *filter, const struct sandbox *sandbox)
{
    uint32_t action =
        sandbox->error ? SECCOMP_RET_ERRNO | (uint32_t)sandbox->error : SECCOMP_RET_KILL_PROCESS;
    add(filter, (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, action));
}

static void refuse_protection(struct filter *filter, const struct sandbox *sandbox, long call)
{
    int looks_at_flags = sandbox->shared && call == SYS_mmap;
    load(filter, offsetof(struct seccomp_data, nr));
    unless_equal(filter, (uint32_t)call, looks_at_flags ? 6 : 4);
    if (looks_at_flags) {
        load(filter, argument(FLAGS));
        add(filter, (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, MAP_SHARED, 0, 4));
    }
    load(filter, argument(PROTECTION));
    add(filter, (struct sock_filter)BPF_STMT(BPF_ALU | BPF_AND | BPF_K, (uint32_t)sandbox->protection));
    unless_equal(filter, (uint32_t)sandbox->protection, 1);
    refuse(filter, sandbox);
}

static void make_filter(struct filter *filter, const struct sandbox *sandbox)
{
    filter->count = 0;
    load(filter, offsetof(struct seccomp_data, arch));
    unless_equal(filter, AUDIT_ARCH_X86_64, 0); /* skips nothing: other architectures do not occur */
    if (sandbox->protection) {
        refuse_protection(filter, sandbox, SYS_mmap);
        if (!sandbox->shared) {
            refuse_protection(filter, sandbox, SYS_mprotect);
            refuse_protection(filter, sandbox, SYS_pkey_mprotect);
        }
    }
    if (sandbox->memory_files) {
        load(filter, offsetof(struct seccomp_data, nr));
        unless_equal(filter, SYS_memfd_create, 1);
        refuse(filter, sandbox);
    }
    add(filter, (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
}

void sandbox_enter(const struct sandbox *sandbox)
{
    struct filter filter;
    make_filter(&filter, sandbox);
    struct sock_fprog program = {filter.count, filter.code};
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), strerror(errno));
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program), strerror(errno));
}

/* Unity's message about a failure goes to `output`. The parent reads it and fails with this message. */
static void run_child(void (*act)(const void *argument), const void *argument, int output)
{
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    if (TEST_PROTECT()) {
        act(argument);
        _exit(0);
    }
    fflush(stdout);
    _exit(1);
}

static void read_all(int from, char *text, size_t capacity)
{
    size_t length = 0;
    ssize_t count;
    char rest[256];
    while ((count = read(from, length + 1 < capacity ? text + length : rest,
                         length + 1 < capacity ? capacity - 1 - length : sizeof rest)) > 0)
        if (length + 1 < capacity)
            length += (size_t)count;
    text[length] = 0;
}

void sandbox_child(void (*act)(const void *argument), const void *argument)
{
    static char text[4096], message[sizeof text + 128];
    int ends[2], status;
    fflush(stdout);
    TEST_ASSERT_EQUAL_INT(0, pipe(ends));
    pid_t child = fork();
    if (!child)
        run_child(act, argument, ends[1]);
    close(ends[1]);
    read_all(ends[0], text, sizeof text);
    close(ends[0]);
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    if (status) {
        snprintf(message, sizeof message, "the child ended with status %#x: %s", (unsigned)status, text);
        TEST_FAIL_MESSAGE(message);
    }
}
