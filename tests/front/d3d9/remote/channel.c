/* Calls of a program in another process (front/d3d9/remote). This program is also the server that its tests
 * start. */
#include "front/d3d9/object.h"
#include "front/d3d9/remote/channel.h"
#include "front/d3d9/remote/packing.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
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

static int call(unsigned code, void *block)
{
    uint8_t *begin = (uint8_t *)client.channel;
    struct d3d9_packing packing = {begin + D3D9_CHANNEL_HEADER, begin + D3D9_CHANNEL_ARENA, false};
    void *shared = client.process ? d3d9_pack(&packing, code, block) : NULL;
    if (!shared)
        return -1;
    client.channel->code = code;
    client.channel->block = (uint32_t)(uintptr_t)shared;
    if (d3d9_client_call(&client))
        return -1;
    d3d9_unpack(code, block, shared);
    return client.channel->result;
}

static void open_it(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        0, d3d9_client_open(&client, server, D3D9_CODE_COUNT, reason, sizeof reason), reason);
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
    struct d3d9_host_adapter adapter = {.monitor = 1, .name = "\\\\.\\DISPLAY1"};
    struct d3d9_host_mode mode = {640, 480, 60, 22, 1};
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

static void a_code_that_does_not_exist_is_refused(void)
{
    open_it();
    TEST_ASSERT_EQUAL_INT(-1, call(D3D9_CODE_COUNT, NULL));
    client.channel->code = D3D9_CODE_COUNT;
    TEST_ASSERT_EQUAL_INT(0, d3d9_client_call(&client));
    TEST_ASSERT_EQUAL_INT(D3D9_BAD_CODE, client.channel->result);
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
    TEST_ASSERT_EQUAL_INT(-1, call(D3D9_CODE_factory_create, &block));
    TEST_ASSERT_EQUAL_INT(-1, call(D3D9_CODE_factory_create, &block));
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

int main(int count, char **arguments)
{
    enum { DESCRIPTOR = 3 };
    if (count == 3)
        return d3d9_serve(DESCRIPTOR, (uint32_t)strtoul(arguments[1], NULL, 10), atoi(arguments[2]));
    UNITY_BEGIN();
    RUN_TEST(objects_have_one_address_in_both);
    RUN_TEST(a_null_pointer_stays_one);
    RUN_TEST(results_come_back);
    RUN_TEST(a_code_that_does_not_exist_is_refused);
    RUN_TEST(arguments_that_do_not_fit_are_refused);
    RUN_TEST(a_server_that_ends_is_noticed);
    RUN_TEST(a_missing_server_has_a_reason);
    RUN_TEST(another_table_of_calls_is_refused);
    return UNITY_END();
}
