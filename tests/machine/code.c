/* The executable-code arena: two views of one memory, an allocator without leaks, and refusals with a reason.
 */
#define _GNU_SOURCE
#include "machine/code.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

enum { CAPACITY = 1 << 20 };

static struct error error;
static struct code_arena *arena;

void setUp(void)
{
    error_clear(&error);
    arena = code_create(CAPACITY, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
}

void tearDown(void)
{
    code_destroy(arena);
    arena = NULL;
}

typedef int function(void);

/* mov eax, value; ret */
enum { FUNCTION_BYTES = 6 };

static void write_function(uint8_t *at, int value)
{
    at[0] = 0xB8;
    memcpy(at + 1, &value, 4);
    at[5] = 0xC3;
}

static struct code_span reserve(size_t bytes)
{
    struct code_span span;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, code_reserve(arena, bytes, &span, &error), error.text);
    return span;
}

static int run(const void *code)
{
    return ((function *)(uintptr_t)code)();
}

static void committed_code_runs_at_the_executable_address(void)
{
    struct code_span span = reserve(1000);
    write_function(span.writable, 42);
    const void *code = code_commit(arena, &span, FUNCTION_BYTES);
    TEST_ASSERT_EQUAL_PTR(span.executable, code);
    TEST_ASSERT_EQUAL_UINT64(CODE_ALIGNMENT, span.bytes);
    TEST_ASSERT_EQUAL_INT(42, run(code));
}

static void views_translate_into_each_other(void)
{
    struct code_span span = reserve(256);
    TEST_ASSERT_TRUE(span.writable != span.executable);
    for (size_t i = 0; i < span.bytes; i++)
        span.writable[i] = (uint8_t)(i * 7);
    TEST_ASSERT_EQUAL_MEMORY(span.writable, span.executable, span.bytes);
    TEST_ASSERT_EQUAL_PTR(span.executable + 9, code_executable(arena, span.writable + 9));
    TEST_ASSERT_EQUAL_PTR(span.writable + 9, code_writable(arena, span.executable + 9));
}

/* The permissions of the mapping that contains `address`, as in /proc/self/maps. */
static void permissions_of(const void *address, char permissions[5])
{
    strcpy(permissions, "none");
    FILE *maps = fopen("/proc/self/maps", "r");
    TEST_ASSERT_NOT_NULL(maps);
    char line[1024];
    while (fgets(line, sizeof line, maps)) {
        unsigned long from, to;
        char found[5];
        if (sscanf(line, "%lx-%lx %4s", &from, &to, found) == 3 && (uintptr_t)address - from < to - from)
            memcpy(permissions, found, 5);
    }
    fclose(maps);
}

static void no_address_is_both_writable_and_executable(void)
{
    char permissions[5];
    struct code_span span = reserve(64);
    permissions_of(span.writable, permissions);
    TEST_ASSERT_EQUAL_STRING("rw-s", permissions);
    permissions_of(span.executable, permissions);
    TEST_ASSERT_EQUAL_STRING("r-xs", permissions);
}

/* Writes to code as a debugger does. */
static void poke(const uint8_t *code, uint8_t byte)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    void *start = (void *)((uintptr_t)code & ~(page - 1));
    TEST_ASSERT_EQUAL_INT(0, mprotect(start, page, PROT_READ | PROT_WRITE));
    *(volatile uint8_t *)(uintptr_t)code = byte;
    TEST_ASSERT_EQUAL_INT(0, mprotect(start, page, PROT_READ | PROT_EXEC));
}

/* A function that returns a 64-bit constant: mov rax, value; ret. */
static void words_of_code_are_replaced_and_views_keep_their_permissions(void)
{
    uint8_t bytes[] = {0x48, 0xb8, 1, 2, 3, 4, 5, 6, 7, 8, 0xc3};
    char permissions[5];
    if (!code_can_patch(arena))
        TEST_IGNORE_MESSAGE("needs membarrier");
    struct code_span span = reserve(sizeof bytes);
    memcpy(span.writable, bytes, sizeof bytes);
    code_commit(arena, &span, sizeof bytes);
    uint64_t (*function)(void) = (uint64_t(*)(void))(uintptr_t)span.executable;
    TEST_ASSERT_EQUAL_HEX64(0x0807060504030201, function());
    for (uint64_t value = 1; value < 1000; value++) {
        const struct code_word word = {2, value << 40 | value};
        code_patch(arena, &span, &word, 1);
        TEST_ASSERT_EQUAL_HEX64(value << 40 | value, function());
    }
    permissions_of(span.executable, permissions);
    TEST_ASSERT_EQUAL_STRING("r-xs", permissions);
    permissions_of(span.writable, permissions);
    TEST_ASSERT_EQUAL_STRING("rw-s", permissions);
}

static void breakpoints_stay_in_their_routine_and_end_with_it(void)
{
    code_destroy(arena);
    arena = code_create_for(CODE_TO_DEBUG, CAPACITY, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    struct code_span first = reserve(2 * FUNCTION_BYTES), second = reserve(FUNCTION_BYTES);
    write_function(first.writable, 1);
    write_function(second.writable, 2);
    const uint8_t *one = code_commit(arena, &first, FUNCTION_BYTES);
    const uint8_t *two = code_commit(arena, &second, FUNCTION_BYTES);
    TEST_ASSERT_EQUAL_UINT64(0, (uintptr_t)one % (size_t)sysconf(_SC_PAGESIZE));
    poke(one, 0xCC);
    poke(two + 1, 7); /* not a breakpoint, but visible without a trap */
    TEST_ASSERT_EQUAL_HEX8(0xCC, *one);
    TEST_ASSERT_EQUAL_HEX8(0xB8, *(uint8_t *)code_writable(arena, one));
    TEST_ASSERT_EQUAL_INT(7, run(two));
    code_free(arena, &first);
    first = reserve(FUNCTION_BYTES);
    write_function(first.writable, 3);
    TEST_ASSERT_EQUAL_PTR(one, code_commit(arena, &first, FUNCTION_BYTES));
    TEST_ASSERT_EQUAL_INT(3, run(one));
    TEST_ASSERT_EQUAL_INT(7, run(two));
    char permissions[5];
    permissions_of(one, permissions);
    TEST_ASSERT_EQUAL_STRING("r-xp", permissions);
    permissions_of(first.writable, permissions);
    TEST_ASSERT_EQUAL_STRING("rw-s", permissions);
}

static void code_to_profile_is_in_no_file_and_never_writable_and_executable(void)
{
    char permissions[5];
    code_destroy(arena);
    arena = code_create_for(CODE_TO_PROFILE, CAPACITY, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    struct code_span span = reserve(FUNCTION_BYTES);
    write_function(span.writable, 9);
    TEST_ASSERT_EQUAL_INT(9, run(code_commit(arena, &span, FUNCTION_BYTES)));
    permissions_of(span.writable, permissions);
    TEST_ASSERT_EQUAL_STRING("rw-s", permissions);
    permissions_of(span.executable, permissions);
    TEST_ASSERT_EQUAL_STRING("r-xs", permissions);
}

/* The signal that ends a process which calls `act(argument)`, or 0. */
static int signal_of(void (*act)(void *), void *argument)
{
    fflush(stdout);
    pid_t child = fork();
    if (!child) {
        setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
        signal(SIGSEGV, SIG_DFL);
        signal(SIGTRAP, SIG_DFL);
        act(argument);
        _exit(0);
    }
    int status;
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

static void write_byte(void *address)
{
    *(volatile uint8_t *)address = 1;
}

static void call(void *address)
{
    run(address);
}

static void the_wrong_view_faults_and_the_right_one_does_not(void)
{
    struct code_span span = reserve(64);
    write_function(span.writable, 1);
    TEST_ASSERT_EQUAL_INT(SIGSEGV, signal_of(write_byte, (void *)(uintptr_t)span.executable));
    TEST_ASSERT_EQUAL_INT(SIGSEGV, signal_of(call, span.writable));
    TEST_ASSERT_EQUAL_INT(0, signal_of(write_byte, span.writable + 32));
    TEST_ASSERT_EQUAL_INT(0, signal_of(call, (void *)(uintptr_t)span.executable));
}

static void assert_traps(const uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        TEST_ASSERT_EQUAL_HEX8(0xCC, bytes[i]);
}

static void freed_code_and_the_tail_of_code_trap(void)
{
    struct code_span span = reserve(4096);
    memset(span.writable, 0x90, 100 + CODE_ALIGNMENT);
    const uint8_t *code = code_commit(arena, &span, 100);
    TEST_ASSERT_EQUAL_UINT64(128, span.bytes);
    assert_traps(code + 100, CODE_ALIGNMENT);
    TEST_ASSERT_EQUAL_HEX8(0x90, code[99]);
    code_free(arena, &span);
    TEST_ASSERT_NULL(span.writable);
    assert_traps(code, 128);
    TEST_ASSERT_EQUAL_INT(SIGTRAP, signal_of(call, (void *)(uintptr_t)code));
}

static void freeing_an_empty_span_does_nothing(void)
{
    struct code_span span = {0};
    code_free(arena, &span);
    TEST_ASSERT_EQUAL_UINT64(0, code_statistics(arena).used);
}

static void a_commit_gives_the_rest_back(void)
{
    struct code_span span = reserve(CAPACITY);
    struct code_span second;
    TEST_ASSERT_EQUAL_INT(-1, code_reserve(arena, 1, &second, &error));
    code_commit(arena, &span, 65);
    struct code_statistics statistics = code_statistics(arena);
    TEST_ASSERT_EQUAL_UINT64(128, statistics.used);
    TEST_ASSERT_EQUAL_UINT64(CAPACITY, statistics.peak);
    TEST_ASSERT_EQUAL_UINT64(1, statistics.free_spans);
    TEST_ASSERT_EQUAL_UINT64(CAPACITY - 128, statistics.largest_free);
}

static struct code_span commit_function(size_t reserved, size_t bytes, int value)
{
    struct code_span span = reserve(reserved);
    write_function(span.writable, value);
    code_commit(arena, &span, bytes);
    return span;
}

static void a_commit_moves_code_into_the_hole_that_an_eviction_left(void)
{
    enum { MOST = 64 << 10, BYTES = 640 };
    struct code_span first = commit_function(MOST, BYTES, 1);
    struct code_span second = commit_function(MOST, BYTES, 2);
    struct code_span third = commit_function(MOST, BYTES, 3);
    const uint8_t *hole = second.executable;
    code_free(arena, &second);
    struct code_span fourth = commit_function(MOST, BYTES - 64, 4);
    TEST_ASSERT_EQUAL_PTR(hole, fourth.executable);
    TEST_ASSERT_EQUAL_INT(1, run(first.executable));
    TEST_ASSERT_EQUAL_INT(3, run(third.executable));
    TEST_ASSERT_EQUAL_INT(4, run(fourth.executable));
    TEST_ASSERT_EQUAL_UINT64(2, code_statistics(arena).free_spans);
}

static void eviction_keeps_a_full_arena_usable_for_ever(void)
{
    enum { MOST = 128 << 10, LIVE = 100, ROUNDS = 20000 };
    struct code_span live[LIVE] = {0};
    uint32_t random = 1;
    for (int round = 0; round < ROUNDS; round++) {
        struct code_span *slot = &live[round % LIVE];
        code_free(arena, slot);
        random = random * 1664525 + 1013904223;
        *slot = commit_function(MOST, FUNCTION_BYTES + (random >> 20), round);
        TEST_ASSERT_EQUAL_INT(round, run(slot->executable));
    }
    for (int i = 0; i < LIVE; i++)
        TEST_ASSERT_EQUAL_INT(ROUNDS - LIVE + i, run(live[i].executable));
}

/* A random sequence of operations, compared with a model that tracks the owner of every byte. */
static void random_spans_never_overlap_and_all_memory_is_freed(void)
{
    enum { SLOTS = 64, STEPS = 30000 };
    struct code_span slots[SLOTS] = {0};
    size_t used = 0;
    uint32_t random = 7;
    for (int step = 0; step < STEPS; step++) {
        random = random * 1664525 + 1013904223;
        uint32_t i = (random >> 8) % SLOTS, size = 1 + (random >> 16) % (1u << (4 + (random >> 4) % 12));
        struct code_span *slot = &slots[i];
        if (slot->bytes) {
            for (size_t at = 0; at < slot->bytes; at += 16)
                TEST_ASSERT_EQUAL_HEX8(i, slot->executable[at]);
            used -= slot->bytes;
            code_free(arena, slot);
        } else if (!code_reserve(arena, size, slot, &error)) {
            TEST_ASSERT_EQUAL_UINT64(0, (uintptr_t)slot->executable % CODE_ALIGNMENT);
            TEST_ASSERT_TRUE(slot->bytes >= size && slot->bytes < size + CODE_ALIGNMENT);
            memset(slot->writable, (int)i, slot->bytes);
            if (random >> 31) {
                size_t before = slot->bytes;
                memset(slot->writable, 0xCC, before);
                memset(slot->writable, (int)i, (size + 1) / 2);
                code_commit(arena, slot, (size + 1) / 2);
                memset(slot->writable, (int)i, slot->bytes);
            }
            used += slot->bytes;
        }
        TEST_ASSERT_EQUAL_UINT64(used, code_statistics(arena).used);
    }
    for (uint32_t i = 0; i < SLOTS; i++) {
        for (size_t at = 0; at < slots[i].bytes; at++)
            TEST_ASSERT_EQUAL_HEX8(i, slots[i].executable[at]);
        code_free(arena, &slots[i]);
    }
    struct code_statistics statistics = code_statistics(arena);
    TEST_ASSERT_EQUAL_UINT64(0, statistics.used);
    TEST_ASSERT_EQUAL_UINT64(1, statistics.free_spans);
    TEST_ASSERT_EQUAL_UINT64(CAPACITY, statistics.largest_free);
}

static void a_span_that_does_not_fit_is_refused_with_the_numbers(void)
{
    struct code_span span = reserve(4096), refused = span;
    TEST_ASSERT_EQUAL_INT(-1, code_reserve(arena, CAPACITY, &refused, &error));
    TEST_ASSERT_EQUAL_STRING("code arena: no hole of 1048576 bytes (4096 of 1048576 bytes are used)",
                             error.text);
    TEST_ASSERT_NULL(refused.writable);
    TEST_ASSERT_EQUAL_INT(-1, code_reserve(arena, SIZE_MAX, &refused, NULL));
    code_free(arena, &span);
    span = reserve(CAPACITY);
    TEST_ASSERT_EQUAL_UINT64(CAPACITY, span.bytes);
}

static void capacity_is_whole_pages_and_64_mib_by_default(void)
{
    struct code_arena *other = code_create(1, NULL, &error);
    TEST_ASSERT_EQUAL_UINT64((size_t)sysconf(_SC_PAGESIZE), code_statistics(other).capacity);
    code_destroy(other);
    other = code_create(0, NULL, &error);
    TEST_ASSERT_EQUAL_UINT64(64u << 20, code_statistics(other).capacity);
    code_destroy(other);
    TEST_ASSERT_NULL(code_create(((size_t)2 << 30) + 1, NULL, &error));
    TEST_ASSERT_EQUAL_STRING("code arena: 2147483649 bytes requested, expected at most 2147483648",
                             error.text);
}

/* A system that refuses one call and records what it returned. */
static struct {
    enum refusal {
        REFUSE_NOTHING,
        REFUSE_FILE,
        REFUSE_SIZE,
        REFUSE_WRITABLE,
        REFUSE_EXECUTABLE,
        REFUSE_FLAG
    } refusal;
    int file;
    void *mapped;
} fake;

static int refuse(enum refusal call, int reason)
{
    if (fake.refusal != call)
        return 0;
    errno = reason;
    return -1;
}

static int fake_create_file(const char *name, unsigned flags)
{
    if (refuse(REFUSE_FILE, ENOSYS) || (flags != MFD_CLOEXEC && refuse(REFUSE_FLAG, EINVAL)))
        return -1;
    return fake.file = code_system_native.create_file(name, flags);
}

static int fake_set_size(int file, off_t bytes)
{
    return refuse(REFUSE_SIZE, ENOSPC) ? -1 : code_system_native.set_size(file, bytes);
}

static void *fake_map(void *address, size_t bytes, int protection, int flags, int file, off_t offset)
{
    bool executable = protection & PROT_EXEC;
    if (refuse(executable ? REFUSE_EXECUTABLE : REFUSE_WRITABLE, executable ? EACCES : ENOMEM))
        return MAP_FAILED;
    return fake.mapped = code_system_native.map(address, bytes, protection, flags, file, offset);
}

static const struct code_system fake_system = {fake_create_file, fake_set_size, fake_map};

static void assert_refusal(enum refusal refusal, const char *reason)
{
    memset(&fake, 0, sizeof fake);
    fake.refusal = refusal;
    fake.file = -1;
    error_clear(&error);
    TEST_ASSERT_NULL(code_create(CAPACITY, &fake_system, &error));
    TEST_ASSERT_EQUAL_STRING(reason, error.text);
    if (fake.file >= 0)
        TEST_ASSERT_EQUAL_INT_MESSAGE(-1, fcntl(fake.file, F_GETFD), "the memory file was left open");
    if (fake.mapped) {
        char permissions[5];
        permissions_of(fake.mapped, permissions);
        TEST_ASSERT_TRUE_MESSAGE(strcmp(permissions, "rw-s"), "the writable view was left mapped");
    }
}

static void every_refused_system_call_gives_its_reason_and_leaks_nothing(void)
{
    assert_refusal(REFUSE_FILE, "code arena: cannot create a memory file: Function not implemented");
    assert_refusal(REFUSE_SIZE,
                   "code arena: cannot size a memory file to 1048576 bytes: No space left on device");
    assert_refusal(REFUSE_WRITABLE, "code arena: cannot map 1048576 bytes writable: Cannot allocate memory");
    assert_refusal(REFUSE_EXECUTABLE, "code arena: cannot map 1048576 bytes executable: Permission denied");
}

static void a_kernel_without_the_execute_flag_gets_a_second_request_without_it(void)
{
    memset(&fake, 0, sizeof fake);
    fake.refusal = REFUSE_FLAG;
    struct code_arena *other = code_create(CAPACITY, &fake_system, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(other, error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(-1, fcntl(fake.file, F_GETFD), "the memory file was left open");
    code_destroy(other);
}

/* Unity's assertions work only in the main thread, so a worker counts its errors. */
struct worker {
    pthread_t thread;
    uint32_t seed;
    int wrong;
};

static void *work(void *argument)
{
    enum { SLOTS = 16, STEPS = 3000 };
    struct worker *worker = argument;
    struct code_span slots[SLOTS] = {0};
    int values[SLOTS] = {0};
    for (int step = 0; step < STEPS; step++) {
        worker->seed = worker->seed * 1664525 + 1013904223;
        int i = (int)(worker->seed >> 8) % SLOTS;
        if (slots[i].bytes) {
            worker->wrong += run(slots[i].executable) != values[i];
            code_free(arena, &slots[i]);
        } else if (code_reserve(arena, 16 << 10, &slots[i], NULL)) {
            worker->wrong++;
        } else {
            values[i] = (int)worker->seed;
            write_function(slots[i].writable, values[i]);
            code_commit(arena, &slots[i], FUNCTION_BYTES + (worker->seed >> 22));
        }
    }
    for (int i = 0; i < SLOTS; i++)
        code_free(arena, &slots[i]);
    return NULL;
}

static void threads_share_an_arena(void)
{
    enum { WORKERS = 4 };
    struct worker workers[WORKERS] = {0};
    for (int i = 0; i < WORKERS; i++) {
        workers[i].seed = (uint32_t)i * 977;
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&workers[i].thread, NULL, work, &workers[i]));
    }
    for (int i = 0; i < WORKERS; i++) {
        pthread_join(workers[i].thread, NULL);
        TEST_ASSERT_EQUAL_INT(0, workers[i].wrong);
    }
    TEST_ASSERT_EQUAL_UINT64(0, code_statistics(arena).used);
    TEST_ASSERT_EQUAL_UINT64(1, code_statistics(arena).free_spans);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(committed_code_runs_at_the_executable_address);
    RUN_TEST(views_translate_into_each_other);
    RUN_TEST(no_address_is_both_writable_and_executable);
    RUN_TEST(words_of_code_are_replaced_and_views_keep_their_permissions);
    RUN_TEST(code_to_profile_is_in_no_file_and_never_writable_and_executable);
    RUN_TEST(breakpoints_stay_in_their_routine_and_end_with_it);
    RUN_TEST(the_wrong_view_faults_and_the_right_one_does_not);
    RUN_TEST(freed_code_and_the_tail_of_code_trap);
    RUN_TEST(freeing_an_empty_span_does_nothing);
    RUN_TEST(a_commit_gives_the_rest_back);
    RUN_TEST(a_commit_moves_code_into_the_hole_that_an_eviction_left);
    RUN_TEST(eviction_keeps_a_full_arena_usable_for_ever);
    RUN_TEST(random_spans_never_overlap_and_all_memory_is_freed);
    RUN_TEST(a_span_that_does_not_fit_is_refused_with_the_numbers);
    RUN_TEST(capacity_is_whole_pages_and_64_mib_by_default);
    RUN_TEST(every_refused_system_call_gives_its_reason_and_leaks_nothing);
    RUN_TEST(a_kernel_without_the_execute_flag_gets_a_second_request_without_it);
    RUN_TEST(threads_share_an_arena);
    return UNITY_END();
}
