/* Executable memory: no address is ever writable and executable. On a system that refuses executable
 * memory, the engines that need none work, and the others report why they cannot run. */
#include "machine/code.h"
#include "render/device/device.h"
#include "engines/list.h"
#include "engines/external/external.h"
#include "tests/support/system/sandbox.h"
#include "tests/support/picture/varied.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

enum { STATES = 40, DEVICES = 32 };

static struct varied_image expected;

void setUp(void)
{
    struct varied_image none;
    varied_render(engine_find("emulate"), &(struct device_options){.threads = 1}, 0, STATES, &expected);
    varied_render(engine_find("emulate"), &(struct device_options){.threads = 1}, 0, 0, &none);
    TEST_ASSERT_TRUE(memcmp(&expected, &none, sizeof none));
}

void tearDown(void)
{
}

/* --- Never writable and executable --- */

struct mappings {
    unsigned all, writable_and_executable, code_writable, code_executable;
};

static struct mappings read_mappings(void)
{
    struct mappings found = {0};
    FILE *maps = fopen("/proc/self/maps", "r");
    char line[1024], protection[5];
    while (maps && fgets(line, sizeof line, maps)) {
        if (sscanf(line, "%*s %4s", protection) != 1)
            continue;
        int writable = protection[1] == 'w', executable = protection[2] == 'x',
            code = !!strstr(line, "triptych-code");
        found.all++;
        found.writable_and_executable += writable && executable;
        found.code_writable += code && writable;
        found.code_executable += code && executable;
    }
    if (maps)
        fclose(maps);
    return found;
}

static atomic_uint readings, violations;
static atomic_bool stop;

static void *watch(void *unused)
{
    while (!atomic_load(&stop)) {
        if (read_mappings().writable_and_executable)
            atomic_fetch_add(&violations, 1);
        atomic_fetch_add(&readings, 1);
    }
    return unused;
}

/* Builds, evicts and runs routines until the watcher has read the mappings `looks` times. */
static void draw_watched(triptych_device *device, unsigned looks)
{
    unsigned until = atomic_load(&readings) + looks, n = 0;
    varied_begin(device);
    do {
        varied_draw(device, n++ % VARIED_STATES);
        if (n % 16 == 0)
            device_finish(device);
    } while (atomic_load(&readings) < until);
}

static void no_mapping_is_writable_and_executable_while_all_engines_build(void)
{
    triptych_device *devices[DEVICES];
    unsigned count = 0, arenas = 0;
    pthread_t watcher;
    struct error error = {{0}};
    atomic_store(&stop, false);
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&watcher, NULL, watch, NULL));
    for (unsigned i = 0; engine_at(i); i++) {
        const struct device_options options = {.threads = 2, .cache_bytes = 50000};
        if (engine_unavailable(engine_at(i)))
            continue;
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            TRIPTYCH_OK, device_create(engine_at(i), &options, &devices[count], &error), error.text);
        arenas += !engine_at(i)->without_arena;
        if (engine_at(i)->on_request) {
            varied_begin(devices[count]);
            varied_draw(devices[count++], 0);
        } else {
            draw_watched(devices[count++], 4);
        }
    }
    struct mappings found = read_mappings();
    atomic_store(&stop, true);
    pthread_join(watcher, NULL);
    TEST_ASSERT_EQUAL_UINT(0, atomic_load(&violations));
    TEST_ASSERT_EQUAL_UINT(0, found.writable_and_executable);
    TEST_ASSERT_EQUAL_UINT(arenas, found.code_writable);
    TEST_ASSERT_EQUAL_UINT(arenas, found.code_executable);
    TEST_ASSERT_TRUE(found.all > 10 && arenas && atomic_load(&readings) > 4 * arenas);
    while (count--)
        triptych_device_destroy(devices[count]);
    TEST_ASSERT_EQUAL_UINT(0, read_mappings().code_executable);
}

static void ask_for_both(const void *unused)
{
    (void)unused;
    sandbox_enter(&(struct sandbox){.protection = PROT_WRITE | PROT_EXEC});
    mmap(NULL, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
}

/* Under this filter, the kernel ends a process that requests memory with both permissions. First the test
 * checks the filter, then that no engine is ended. */
static void render_under_guard(const void *debug)
{
    const struct device_options options = {.threads = 2, .cache_bytes = 20000, .debug = debug};
    char map[64];
    sandbox_enter(&(struct sandbox){.protection = PROT_WRITE | PROT_EXEC});
    for (unsigned i = 0; engine_at(i); i++) {
        struct varied_image found;
        if (engine_at(i)->on_request || engine_unavailable(engine_at(i)))
            continue;
        varied_render(engine_at(i), &options, 0, STATES, &found);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &found, sizeof found, engine_at(i)->name);
    }
    snprintf(map, sizeof map, "/tmp/perf-%d.map", (int)getpid());
    unlink(map);
}

static void no_engine_requests_memory_that_is_writable_and_executable(void)
{
    fflush(stdout);
    pid_t child = fork();
    int status;
    if (!child) {
        ask_for_both(NULL);
        _exit(0);
    }
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    TEST_ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGSYS);
    sandbox_child(render_under_guard, "");
    sandbox_child(render_under_guard, "gdb");
    sandbox_child(render_under_guard, "perf");
}

/* --- Refused --- */

static bool needs_refused(const struct engine *engine, const struct sandbox *sandbox)
{
    if (engine == &engine_external)
        return sandbox->protection && !sandbox->shared;
    return !engine->without_arena;
}

static void check_line(const char *line, const struct sandbox *sandbox)
{
    TEST_ASSERT_NOT_NULL(line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(line, "needs "), line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(line, strerror(sandbox->error)), line);
    TEST_ASSERT_NULL_MESSAGE(strchr(line, '\n'), line);
}

static void check_refused(unsigned i, const struct sandbox *sandbox)
{
    const struct triptych_options options = {.engine = triptych_engine_name(i)};
    char reason[512];
    triptych_device *device;
    check_line(triptych_engine_unavailable(i), sandbox);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_ENGINE_FAILED,
                          triptych_device_create(&options, &device, reason, sizeof reason));
    TEST_ASSERT_NULL(device);
    check_line(reason, sandbox);
}

static void check_engines(const void *argument)
{
    const struct sandbox *sandbox = argument;
    unsigned rendered = 0;
    sandbox_enter(sandbox);
    for (unsigned i = 0; engine_at(i); i++) {
        struct varied_image found;
        if (needs_refused(engine_at(i), sandbox)) {
            check_refused(i, sandbox);
        } else if (!engine_at(i)->on_request) {
            TEST_ASSERT_NULL(triptych_engine_unavailable(i));
            varied_render(engine_at(i), &(struct device_options){.threads = 2}, 0, STATES, &found);
            TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &found, sizeof found, engine_at(i)->name);
            rendered++;
        }
    }
    TEST_ASSERT_TRUE(rendered >= 2);
}

static void engines_work_without_executable_memory_or_report_why_not(void)
{
    for (int i = 0; i < SANDBOX_REFUSALS; i++)
        sandbox_child(check_engines, sandbox_refusals + i);
}

/* Creates devices, and then enters the sandbox. */
static void enter_late(const void *unused)
{
    triptych_device *devices[DEVICES];
    unsigned count = 0;
    (void)unused;
    for (unsigned i = 0; engine_at(i); i++)
        if (!engine_at(i)->on_request && !engine_unavailable(engine_at(i)))
            TEST_ASSERT_EQUAL_INT(
                TRIPTYCH_OK,
                device_create(engine_at(i), &(struct device_options){.threads = 2}, &devices[count++], NULL));
    sandbox_enter(sandbox_refusals);
    while (count--) {
        struct varied_image found;
        varied_begin(devices[count]);
        for (unsigned n = 0; n < STATES; n++)
            varied_draw(devices[count], n);
        varied_read(devices[count], &found);
        TEST_ASSERT_EQUAL_MEMORY(&expected, &found, sizeof found);
        triptych_device_destroy(devices[count]);
    }
}

static void devices_made_before_the_refusal_continue_to_work(void)
{
    sandbox_child(enter_late, NULL);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(no_mapping_is_writable_and_executable_while_all_engines_build);
    RUN_TEST(no_engine_requests_memory_that_is_writable_and_executable);
    RUN_TEST(engines_work_without_executable_memory_or_report_why_not);
    RUN_TEST(devices_made_before_the_refusal_continue_to_work);
    return UNITY_END();
}
