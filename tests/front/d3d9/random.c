/* Random calls of Direct3D 9 (tests/support/front/caller.h): none crashes, hangs, or leaves memory, and all
 * engines give the same results.
 *
 * A failure names its case and call. `TRIPTYCH_CASE=SEED:CALLS` executes only that case, and only its first
 * calls. */
#include "tests/support/front/caller.h"
#include "tests/support/system/seed.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

enum { CASES = 120, CALLS = 400, LIMIT_SECONDS = 60 };

static struct caller caller;
static uint64_t current;

void setUp(void)
{
}

void tearDown(void)
{
}

/* --- What was executed when the process ends --- */

static void report(void)
{
    char line[160];
    int bytes = snprintf(line, sizeof line, "TRIPTYCH_CASE=%llu:%u ended in %s_%s\n",
                         (unsigned long long)current, caller.calls, caller.class, caller.name);
    if (write(STDERR_FILENO, line, (size_t)bytes) < 0)
        return;
}

static void stop(int signal)
{
    report();
    _exit(128 + signal);
}

const char *__asan_default_options(void);
void __sanitizer_set_death_callback(void (*callback)(void)) __attribute__((weak));

const char *__asan_default_options(void)
{
    return "allocator_may_return_null=1:detect_stack_use_after_return=0";
}

static void watch(void)
{
    signal(SIGALRM, stop);
    if (__sanitizer_set_death_callback) {
        __sanitizer_set_death_callback(report);
        return;
    }
    signal(SIGSEGV, stop);
    signal(SIGBUS, stop);
    signal(SIGFPE, stop);
    signal(SIGABRT, stop);
}

/* --- Cases --- */

static uint64_t run(uint64_t seed, unsigned calls, const char *engine)
{
    current = seed;
    setenv("TRIPTYCH_ENGINE", engine, 1);
    setenv("TRIPTYCH_THREADS", "1", 1);
    alarm(LIMIT_SECONDS);
    caller_begin(&caller, seed);
    while (caller.calls < calls)
        caller_call(&caller);
    caller_end(&caller);
    alarm(0);
    return caller.digest;
}

static void run_engines(uint64_t seed, unsigned calls)
{
    char text[80];
    snprintf(text, sizeof text, "TRIPTYCH_CASE=%llu:%u", (unsigned long long)seed, calls);
    uint64_t expected = run(seed, calls, "emulate");
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(expected, run(seed, calls, "specialize"), text);
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(expected, run(seed, calls, "stitch"), text);
}

static void random_programs_run(void)
{
    const char *only = getenv("TRIPTYCH_CASE");
    uint64_t seed = test_seed();
    if (only) {
        const char *colon = strchr(only, ':');
        run_engines(strtoull(only, NULL, 10), colon ? (unsigned)atoi(colon + 1) : CALLS);
        return;
    }
    for (unsigned i = 0; i < test_share(CASES); i++)
        run_engines(seed + i * 0x9e3779b97f4a7c15, CALLS);
}

int main(void)
{
    UNITY_BEGIN();
    watch();
    RUN_TEST(random_programs_run);
    return UNITY_END();
}
