/* The system refuses threads. A device then has fewer threads, at least the thread of its caller, and draws
 * the same picture. */
#define _GNU_SOURCE
#include "tests/support/system/fault.h"

#include "render/device/device.h"
#include "engines/list.h"
#include "triptych.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unity.h>

enum { SIDE = 200, THREADS = 6 };

static uint32_t expected[SIDE * SIDE], got[SIDE * SIDE];

void setUp(void)
{
}

void tearDown(void)
{
    fault_disarm();
}

/* Draws a picture with a device. Its request number `at` for a thread (from 1; 0: none) is refused, and with
 * `onwards` all later ones are too. Returns the number of threads of the device. */
static unsigned draw(const char *engine, unsigned long at, bool onwards, uint32_t *image)
{
    static const float corners[6][3] = {{-1, -1, 0}, {0, 1, 0.5f}, {1, -0.9f, 1},
                                        {-1, 1, 1},  {1, 0.8f, 0}, {0, -1, 0}};
    struct triptych_options options = {.engine = engine, .threads = THREADS};
    struct triptych_element element = {.format = TRIPTYCH_FORMAT_FLOAT3, .stride = 12};
    triptych_device *device;
    char reason[256] = "";
    fault_only_threads(true);
    fault_arm(at, onwards);
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK,
                                  triptych_device_create(&options, &device, reason, sizeof reason), reason);
    fault_disarm();
    fault_only_threads(false);
    unsigned workers = pool_workers(device->pool);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_target(device, SIDE, SIDE));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_state(device, TRIPTYCH_STATE_AMBIENT, 0xff4080c0));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          triptych_buffer_create(device, corners, sizeof corners, &element.buffer));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_set_element(device, TRIPTYCH_POSITION, &element));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 2));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_read_color(device, image, sizeof got));
    triptych_device_destroy(device);
    return workers;
}

static void test_a_device_without_a_refused_thread_draws_the_same_picture(void)
{
    static const char *const engines[] = {"emulate", "specialize"};
    for (unsigned e = 0; e < 2; e++) {
        TEST_ASSERT_EQUAL_UINT(THREADS, draw(engines[e], 0, false, expected));
        for (unsigned long at = 1; at < THREADS; at++)
            for (int onwards = 0; onwards < 2; onwards++) {
                TEST_ASSERT_EQUAL_UINT(at, draw(engines[e], at, onwards, got));
                TEST_ASSERT_EQUAL_UINT64(1, fault.refused);
                TEST_ASSERT_EQUAL_MEMORY(expected, got, sizeof got);
            }
    }
}

/* The system itself refuses, by its limit of processes. The superuser has no limit, so the test changes its
 * user. */
static void test_a_limit_of_the_system(void)
{
    int status;
    draw("specialize", 0, false, expected);
    fflush(NULL);
    pid_t process = fork();
    TEST_ASSERT_GREATER_OR_EQUAL(0, process);
    if (!process) {
        struct rlimit none = {0, 0};
        if (setrlimit(RLIMIT_NPROC, &none) || (!geteuid() && (setgid(65534) || setuid(65534))))
            _exit(100);
        unsigned workers = draw("specialize", 0, false, got);
        _exit(memcmp(expected, got, sizeof got) ? 101 : (int)workers);
    }
    TEST_ASSERT_EQUAL_INT(process, waitpid(process, &status, 0));
    TEST_ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == 100)
        TEST_IGNORE_MESSAGE("the system does not let us be limited");
    TEST_ASSERT_EQUAL_INT(1, WEXITSTATUS(status));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_device_without_a_refused_thread_draws_the_same_picture);
    RUN_TEST(test_a_limit_of_the_system);
    return UNITY_END();
}
