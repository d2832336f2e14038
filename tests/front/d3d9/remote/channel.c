/* Calls of a program in another process (front/d3d9/remote). This program is also the server that its tests
 * start. */
#include "front/d3d9/object.h"
#include "front/d3d9/remote/check.h"
#include "front/d3d9/remote/channel.h"
#include "front/d3d9/remote/narrow.h"
#include "front/d3d9/remote/packing.h"
#include "front/d3d9/remote/queue.h"
#include "tests/support/front/values.h"
#include "tests/support/system/seed.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

static const char server[] = "/proc/self/exe";
static struct d3d9_client client;
static char reason[200];

void setUp(void)
{
}

void tearDown(void)
{
    d3d9_client_close(&client);
}

static struct d3d9_queue queue;

static int send_messages(void *context, bool wait)
{
    return d3d9_client_send(context, wait);
}

static int call(unsigned code, void *block)
{
    return d3d9_queue_call(&queue, code, block);
}

static void open_it(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        0, d3d9_client_open(&client, server, D3D9_CODE_COUNT, reason, sizeof reason), reason);
    d3d9_queue_begin(&queue, client.channel, send_messages, &client);
}

/* Where a 32-bit program has the address of an object written. */
static uint32_t factory;

static void make_factory(void)
{
    struct d3d9_block_factory_create block = {.version = 32, .factory = (uintptr_t)&factory};
    factory = 0;
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_factory_create, &block));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, block.result);
}

static void objects_have_one_address_in_both(void)
{
    struct d3d9_host_face faces[] = {{.number = D3D9_INTERFACE_FACTORY, .vtable = 0x1234}};
    struct d3d9_block_host_start start = {.faces = (uintptr_t)faces, .count = 1};
    open_it();
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_host_start, &start));
    make_factory();
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32((uint32_t)(uintptr_t)client.channel + D3D9_CHANNEL_ARENA, factory);
    struct d3d9_head *head = (void *)(uintptr_t)factory;
    TEST_ASSERT_EQUAL_HEX64(0x1234, head->face);
}

static void a_null_pointer_stays_one(void)
{
    open_it();
    make_factory();
    struct d3d9_block_factory_get_device_caps block = {.self = factory, .adapter = 0, .type = 1, .caps = 0};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_factory_get_device_caps, &block));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, block.result);
}

static void add_adapter(void)
{
    struct d3d9_host_mode mode = {640, 480, 60, 22, 1};
    struct d3d9_host_adapter adapter = {
        .monitor = 1, .name = "\\\\.\\DISPLAY1", .current = mode, .desktop = mode};
    struct d3d9_block_host_set_adapter_count count = {.count = 1};
    struct d3d9_block_host_set_adapter set = {
        .adapter = (uintptr_t)&adapter, .modes = (uintptr_t)&mode, .count = 1};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_host_set_adapter_count, &count));
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_host_set_adapter, &set));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, set.result);
}

static void results_come_back(void)
{
    open_it();
    add_adapter();
    make_factory();
    struct d3d9_caps caps;
    memset(&caps, 0xcd, sizeof caps);
    struct d3d9_block_factory_get_device_caps block = {.self = factory, .type = 1, .caps = (uintptr_t)&caps};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_factory_get_device_caps, &block));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, block.result);
    TEST_ASSERT_EQUAL_UINT32(1, caps.device_type);
}

/* --- Devices, and calls that do not wait --- */

static uint32_t device;

static void make_device(void)
{
    struct d3d9_narrow_present_parameters parameters = {.before[6] = 1 /* D3DSWAPEFFECT_DISCARD */,
                                                        .after[0] = 1 /* windowed */};
    struct d3d9_host_window window = {.window = 1, .width = 16, .height = 16, .exists = 1};
    struct d3d9_block_factory_create_device block = {.self = factory,
                                                     .type = 1,
                                                     .focus = 1,
                                                     .flags = 0x40,
                                                     .parameters = (uintptr_t)&parameters,
                                                     .device = (uintptr_t)&device,
                                                     .target = (uintptr_t)&window};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_factory_create_device, &block));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, block.result);
}

static void open_with_device(void)
{
    setenv("TRIPTYCH_ENGINE", "emulate", 1);
    open_it();
    add_adapter();
    make_factory();
    make_device();
}

static uint32_t render_state(uint32_t state)
{
    uint32_t value = 0;
    struct d3d9_block_device_get_render_state block = {
        .self = device, .state = state, .value = (uintptr_t)&value};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_device_get_render_state, &block));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, block.result);
    return value;
}

/* More messages than there is room for are executed in their order. */
static void calls_that_do_not_wait_are_executed_in_order(void)
{
    enum { CULLMODE = 22, MANY = 3 * D3D9_CHANNEL_MESSAGES };
    open_with_device();
    for (uint32_t i = 0; i <= MANY; i++) {
        struct d3d9_block_device_set_render_state block = {
            .self = device, .state = CULLMODE, .value = i, .result = -1};
        TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_device_set_render_state, &block));
        TEST_ASSERT_EQUAL_INT32(D3D9_OK, block.result);
    }
    TEST_ASSERT_EQUAL_UINT32(MANY, render_state(CULLMODE));
    TEST_ASSERT_EQUAL_UINT32(client.channel->sent, client.channel->done);
}

static void known_calls_wait_for_nothing(void)
{
    open_with_device();
    uint32_t done = client.channel->done;
    kill(client.process, SIGSTOP);
    struct d3d9_block_device_set_render_state block = {.self = device, .state = 7, .value = 0};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_device_set_render_state, &block));
    TEST_ASSERT_EQUAL_UINT32(done, client.channel->done);
    TEST_ASSERT_EQUAL_UINT32(done + 1, client.channel->sent);
    kill(client.process, SIGCONT);
    TEST_ASSERT_EQUAL_UINT32(0, render_state(7));
}

static void draws_need_a_declaration(void)
{
    struct d3d9_block_device_draw_primitive draw = {.type = 4, .first = 0, .count = 1};
    struct d3d9_block_device_set_fvf fvf = {.fvf = 0x44};
    open_with_device();
    draw.self = fvf.self = device;
    call(D3D9_CODE_device_draw_primitive, &draw);
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, draw.result);
    call(D3D9_CODE_device_set_fvf, &fvf);
    render_state(7);
    TEST_ASSERT_TRUE(((struct d3d9_head *)(uintptr_t)device)->draws);
    call(D3D9_CODE_device_draw_primitive, &draw);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, draw.result);
}

static void counts_change_without_the_server(void)
{
    struct d3d9_block_object_add_ref add = {.result = 0};
    struct d3d9_block_object_release release = {.result = 0};
    open_with_device();
    add.self = release.self = device;
    uint32_t sent = client.channel->sent;
    call(D3D9_CODE_object_add_ref, &add);
    TEST_ASSERT_EQUAL_UINT32(2, add.result);
    call(D3D9_CODE_object_release, &release);
    TEST_ASSERT_EQUAL_UINT32(1, release.result);
    TEST_ASSERT_EQUAL_UINT32(sent, client.channel->sent);
    call(D3D9_CODE_object_release, &release);
    TEST_ASSERT_EQUAL_UINT32(0, release.result);
    TEST_ASSERT_EQUAL_UINT32(sent + 1, client.channel->sent);
}

extern void __lsan_disable(void) __attribute__((weak));

/* --- Damaged messages --- */

/* Sends a message as it is. The server ends with status 2. */
static void ends_server(uint32_t code, uint32_t block)
{
    struct d3d9_channel *channel = client.channel;
    int status = 0, process = client.process;
    channel->message[channel->sent % D3D9_CHANNEL_MESSAGES] = (struct d3d9_message){code, block};
    channel->sent++;
    d3d9_channel_wake(&channel->sent, &channel->server_sleeps);
    TEST_ASSERT_EQUAL_INT(process, waitpid(process, &status, 0));
    TEST_ASSERT_TRUE(WIFEXITED(status));
    TEST_ASSERT_EQUAL_INT(2, WEXITSTATUS(status));
    client.process = 0;
    d3d9_client_close(&client);
}

static uint32_t first_block(void)
{
    return (uint32_t)(uintptr_t)client.channel + D3D9_CHANNEL_HEADER;
}

static void a_damaged_message_ends_the_server(void)
{
    open_it();
    ends_server(D3D9_CODE_COUNT, first_block());
    open_it();
    ends_server(D3D9_CODE_host_end, 0);
    open_it();
    ends_server(D3D9_CODE_host_end, (uint32_t)(uintptr_t)client.channel + D3D9_CHANNEL_ARENA);
    open_it();
    ends_server(D3D9_CODE_host_end, first_block() + 3);
}

static void a_damaged_argument_ends_the_server(void)
{
    struct d3d9_block_device_clear *clear;
    open_with_device();
    clear = (void *)(uintptr_t)first_block();
    *clear = (struct d3d9_block_device_clear){.self = device, .count = 1, .rectangles = device, .flags = 1};
    ends_server(D3D9_CODE_device_clear, first_block());
    open_with_device();
    clear = (void *)(uintptr_t)first_block();
    *clear =
        (struct d3d9_block_device_clear){.self = device, .count = UINT32_MAX, .rectangles = first_block()};
    ends_server(D3D9_CODE_device_clear, first_block());
    open_with_device();
    *(struct d3d9_block_device_clear *)(uintptr_t)first_block() =
        (struct d3d9_block_device_clear){.self = factory};
    ends_server(D3D9_CODE_device_clear, first_block());
    open_with_device();
    *(struct d3d9_block_device_set_texture *)(uintptr_t)first_block() =
        (struct d3d9_block_device_set_texture){.self = device, .texture = device};
    ends_server(D3D9_CODE_device_set_texture, first_block());
}

/* A random call with random bytes as its block: the server executes it, or ends with status 2. */
static void try_random_message(uint64_t *seed)
{
    uint64_t *block = (uint64_t *)(uintptr_t)first_block();
    struct d3d9_channel *channel = client.channel;
    int status = 0, process = client.process;
    for (unsigned i = 0; i < D3D9_MESSAGE_BLOCK / sizeof *block; i++)
        block[i] = values_once_in(seed, 3) ? values_below(seed, UINT32_MAX) : values_below(seed, 2) * device;
    block[0] = device;
    channel->message[channel->sent % D3D9_CHANNEL_MESSAGES] =
        (struct d3d9_message){values_below(seed, D3D9_CODE_COUNT), first_block()};
    channel->sent++;
    d3d9_channel_wake(&channel->sent, &channel->server_sleeps);
    while (channel->done != channel->sent && !waitpid(process, &status, WNOHANG))
        usleep(200);
    if (channel->done == channel->sent)
        return;
    TEST_ASSERT_TRUE(WIFEXITED(status));
    TEST_ASSERT_EQUAL_INT(2, WEXITSTATUS(status));
    client.process = 0;
}

static void random_messages_end_the_server(void)
{
    uint64_t seed = test_seed();
    for (unsigned i = 0; i < test_share(100); i++) {
        open_with_device();
        for (int n = 0; n < 10 && client.process; n++)
            try_random_message(&seed);
        d3d9_client_close(&client);
    }
}

/* Objects are in memory that the program can write to. In a build with sanitizers these report the access to
 * damaged memory before the signal that the server catches. */
static void damaged_objects_end_the_server(void)
{
    if (__lsan_disable)
        return;
    open_with_device();
    memset((char *)(uintptr_t)device + sizeof(struct d3d9_object), 0x5a, 2000);
    struct d3d9_block_device_present *present = (void *)(uintptr_t)first_block();
    struct d3d9_host_picture *picture = (void *)(uintptr_t)(first_block() + 1024);
    *picture = (struct d3d9_host_picture){.bits = 0};
    *present = (struct d3d9_block_device_present){.self = device, .picture = (uintptr_t)picture};
    ends_server(D3D9_CODE_device_present, first_block());
}

static void arguments_that_do_not_fit_are_refused(void)
{
    struct d3d9_packing packing = {.at = (uint8_t *)reason, .end = (uint8_t *)reason + 16};
    struct d3d9_block_factory_get_device_caps block = {.self = 1};
    TEST_ASSERT_NULL(d3d9_pack(&packing, D3D9_CODE_factory_get_device_caps, &block));
}

static void a_server_that_ends_is_noticed(void)
{
    open_it();
    kill(client.process, SIGKILL);
    struct d3d9_block_factory_create block = {.version = 32, .factory = (uintptr_t)&factory};
    for (int i = 0; i < 2; i++) {
        block.result = D3D9_OK;
        TEST_ASSERT_EQUAL_INT(D3D9_DONE, call(D3D9_CODE_factory_create, &block));
        TEST_ASSERT_EQUAL_INT32(D3D9_DEVICE_LOST, block.result);
    }
}

static void a_missing_server_has_a_reason(void)
{
    TEST_ASSERT_EQUAL_INT(-1, d3d9_client_open(&client, "/nonexistent/server", 1, reason, sizeof reason));
    TEST_ASSERT_EQUAL_STRING("/nonexistent/server: cannot start: No such file or directory", reason);
}

static void another_table_of_calls_is_refused(void)
{
    TEST_ASSERT_EQUAL_INT(-1, d3d9_client_open(&client, server, D3D9_CODE_COUNT + 1, reason, sizeof reason));
    TEST_ASSERT_NOT_NULL(strstr(reason, "ended before it was ready"));
}

/* This program as the server. A server that refuses a message ends with the program's objects, which is not a
 * leak. */
static int serve(char **arguments)
{
    enum { DESCRIPTOR = 3 };
    if (__lsan_disable)
        __lsan_disable();
    return d3d9_serve(DESCRIPTOR, (uint32_t)strtoul(arguments[1], NULL, 10), atoi(arguments[2]));
}

int main(int count, char **arguments)
{
    if (count == 3)
        return serve(arguments);
    UNITY_BEGIN();
    RUN_TEST(objects_have_one_address_in_both);
    RUN_TEST(a_null_pointer_stays_one);
    RUN_TEST(results_come_back);
    RUN_TEST(calls_that_do_not_wait_are_executed_in_order);
    RUN_TEST(known_calls_wait_for_nothing);
    RUN_TEST(draws_need_a_declaration);
    RUN_TEST(counts_change_without_the_server);
    RUN_TEST(a_damaged_message_ends_the_server);
    RUN_TEST(a_damaged_argument_ends_the_server);
    RUN_TEST(random_messages_end_the_server);
    RUN_TEST(damaged_objects_end_the_server);
    RUN_TEST(arguments_that_do_not_fit_are_refused);
    RUN_TEST(a_server_that_ends_is_noticed);
    RUN_TEST(a_missing_server_has_a_reason);
    RUN_TEST(another_table_of_calls_is_refused);
    return UNITY_END();
}
