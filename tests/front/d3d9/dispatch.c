/* Calls as data (front/d3d9/dispatch.h), and what the Linux side leaves for the Windows side (host.h). */
#include "front/d3d9/dispatch.h"
#include "front/d3d9/object.h"
#include "tests/support/front/factory.h"

#include <pthread.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

static struct d3d9_device *device;

void setUp(void)
{
    device = factory_device(false, factory_parameters());
}

void tearDown(void)
{
    if (device)
        factory_device_free(device);
}

/* --- Blocks --------------------------------------------------------------------------------------------- */

static void a_block_becomes_the_arguments_of_a_function(void)
{
    struct d3d9_block_device_set_render_state set = {(uintptr_t)device, 22, 3, -1}; /* D3DRS_CULLMODE */
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, d3d9_dispatch(D3D9_CODE_device_set_render_state, &set));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, set.result);
    uint32_t value = 0;
    struct d3d9_block_device_get_render_state get = {(uintptr_t)device, 22, (uintptr_t)&value, -1};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, d3d9_dispatch(D3D9_CODE_device_get_render_state, &get));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, get.result);
    TEST_ASSERT_EQUAL_UINT32(3, value);
}

static void floats_and_signed_numbers_pass_a_block(void)
{
    struct d3d9_block_device_set_n_patch_mode set = {(uintptr_t)device, 2.5f, -1};
    d3d9_dispatch(D3D9_CODE_device_set_n_patch_mode, &set);
    struct d3d9_block_device_get_n_patch_mode get = {(uintptr_t)device, -1};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, d3d9_dispatch(D3D9_CODE_device_get_n_patch_mode, &get));
    TEST_ASSERT_EQUAL_FLOAT(d3d9_device_get_n_patch_mode(device), get.result);
    struct d3d9_block_device_set_gpu_thread_priority priority = {(uintptr_t)device, -7, 0};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, d3d9_dispatch(D3D9_CODE_device_set_gpu_thread_priority, &priority));
}

static void an_unknown_code_executes_nothing(void)
{
    uint8_t block[64], before[64];
    memset(block, 0x5a, sizeof block);
    memcpy(before, block, sizeof block);
    TEST_ASSERT_EQUAL_INT(D3D9_BAD_CODE, d3d9_dispatch(D3D9_CODE_COUNT, block));
    TEST_ASSERT_EQUAL_INT(D3D9_BAD_CODE, d3d9_dispatch(UINT32_MAX, block));
    TEST_ASSERT_EQUAL_MEMORY(before, block, sizeof block);
}

/* A process with 32-bit pointers has the same block: no member depends on their size or on its alignment. */
static void members_of_blocks_have_fixed_offsets(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, offsetof(struct d3d9_block_device_clear, self));
    TEST_ASSERT_EQUAL_UINT64(8, offsetof(struct d3d9_block_device_clear, count));
    TEST_ASSERT_EQUAL_UINT64(16, offsetof(struct d3d9_block_device_clear, rectangles));
    TEST_ASSERT_EQUAL_UINT64(24, offsetof(struct d3d9_block_device_clear, flags));
    TEST_ASSERT_EQUAL_UINT64(36, offsetof(struct d3d9_block_device_clear, stencil));
    TEST_ASSERT_EQUAL_UINT64(40, offsetof(struct d3d9_block_device_clear, result));
    TEST_ASSERT_EQUAL_UINT64(16, sizeof(struct d3d9_host_face));
    TEST_ASSERT_EQUAL_UINT64(24, sizeof(struct d3d9_host_bits));
    TEST_ASSERT_EQUAL_UINT64(64, sizeof(struct d3d9_host_picture));
}

static void objects_of_another_device_are_refused(void)
{
    struct d3d9_device *other = factory_device(false, factory_parameters());
    struct d3d9_texture *texture;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_texture(other, 4, 4, 1, 0, 21, 1, &texture, NULL));
    struct d3d9_block_device_set_texture set = {(uintptr_t)device, 0, (uintptr_t)texture, 0};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, d3d9_dispatch(D3D9_CODE_device_set_texture, &set));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, set.result);
    TEST_ASSERT_NULL(device->state->texture[0]);
    set.self = (uintptr_t)other;
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, d3d9_dispatch(D3D9_CODE_device_set_texture, &set));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, set.result);
    d3d9_object_release((struct d3d9_object *)texture);
    factory_device_free(other);
}

static void an_identifier_can_be_null(void)
{
    struct d3d9_object *object = &device->object;
    uint32_t bytes = 0;
    void *out = device;
    TEST_ASSERT_EQUAL_INT32(D3D9_BAD_POINTER, d3d9_object_query_interface(object, NULL, &out));
    TEST_ASSERT_NULL(out);
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_object_set_private_data(object, NULL, &bytes, 4, 0));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_object_get_private_data(object, NULL, NULL, &bytes));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_object_free_private_data(object, NULL));
    TEST_ASSERT_FALSE(d3d9_object_private_data_is_interface(object, NULL));
}

static void a_draw_has_a_largest_number_of_primitives(void)
{
    struct d3d9_caps caps;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_device_caps(device, &caps));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_fvf(device, 0x44));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_begin_scene(device));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_draw_primitive(device, 4, 0, 1));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL,
                            d3d9_device_draw_primitive(device, 4, 0, caps.max_primitive_count + 1));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_device_draw_primitive(device, 4, 0, UINT32_MAX));
}

enum { CALLS = 2000, THREADS = 4 };

static void *add_and_release(void *object)
{
    for (int i = 0; i < CALLS; i++) {
        struct d3d9_block_object_add_ref add = {(uintptr_t)object, 0};
        struct d3d9_block_object_release release = {(uintptr_t)object, 0};
        d3d9_dispatch(D3D9_CODE_object_add_ref, &add);
        d3d9_dispatch(D3D9_CODE_object_release, &release);
    }
    return NULL;
}

static void calls_of_several_threads_are_one_after_another(void)
{
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; i++)
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&threads[i], NULL, add_and_release, device));
    for (int i = 0; i < THREADS; i++)
        pthread_join(threads[i], NULL);
    TEST_ASSERT_EQUAL_UINT32(1, device->object.references);
}

/* --- Events --------------------------------------------------------------------------------------------- */

static uint32_t take(struct d3d9_host_event *events, uint32_t room, int *more)
{
    struct d3d9_block_host_take_events block = {(uintptr_t)events, room, 0};
    *more = d3d9_dispatch(D3D9_CODE_host_take_events, &block) == D3D9_EVENTS;
    return block.result;
}

static void the_end_of_an_object_leaves_the_data_of_the_windows_side(void)
{
    struct d3d9_host_event event = {0};
    int more;
    ((struct d3d9_head *)device)->host = 0x123456789;
    struct d3d9_block_object_release release = {(uintptr_t)device, 1};
    TEST_ASSERT_EQUAL_INT(D3D9_EVENTS, d3d9_dispatch(D3D9_CODE_object_release, &release));
    TEST_ASSERT_EQUAL_UINT32(0, release.result);
    device = NULL;
    TEST_ASSERT_EQUAL_UINT32(1, take(&event, 1, &more));
    TEST_ASSERT_FALSE(more);
    TEST_ASSERT_EQUAL_UINT32(D3D9_EVENT_FORGET, event.kind);
    TEST_ASSERT_EQUAL_UINT64(0x123456789, event.pointer);
}

static void interfaces_of_the_program_are_released_by_events(void)
{
    static const struct d3d9_guid tags[2] = {{1, 0, 0, {0}}, {2, 0, 0, {0}}};
    struct d3d9_host_event event = {0};
    struct d3d9_surface *surface;
    int more;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_back_buffer(device, 0, 0, 0, &surface));
    struct d3d9_object *object = (struct d3d9_object *)surface;
    for (int i = 0; i < 2; i++)
        d3d9_object_set_private_data(object, &tags[i], &(uint64_t){0x1000 + (unsigned)i}, sizeof(uint64_t),
                                     D3D9_PRIVATE_INTERFACE);
    TEST_ASSERT_TRUE(d3d9_object_private_data_is_interface(object, &tags[1]));
    for (int i = 0; i < 2; i++)
        d3d9_object_free_private_data(object, &tags[i]);
    TEST_ASSERT_EQUAL_UINT32(1, take(&event, 1, &more));
    TEST_ASSERT_TRUE(more);
    TEST_ASSERT_EQUAL_UINT32(D3D9_EVENT_RELEASE, event.kind);
    TEST_ASSERT_EQUAL_UINT64(0x1001, event.pointer);
    TEST_ASSERT_EQUAL_UINT32(1, take(&event, 1, &more));
    TEST_ASSERT_FALSE(more);
    TEST_ASSERT_EQUAL_UINT64(0x1000, event.pointer);
    TEST_ASSERT_EQUAL_UINT32(0, take(&event, 1, &more));
    d3d9_object_release(object);
}

/* --- The host ------------------------------------------------------------------------------------------- */

static void adapters_and_modes_are_those_that_were_handed_over(void)
{
    const struct d3d9_host_mode modes[2] = {{320, 200, 60, 22, 1}, {640, 400, 75, 22, 1}};
    const struct d3d9_host_adapter adapter = {.monitor = 5, .luid = 6, .name = "second", .current = modes[0]};
    uint32_t count, before = d3d9_host_adapter_count();
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_host_set_adapter(D3D9_HOST_ADAPTERS, &adapter, modes, 2));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_host_set_adapter_count(D3D9_HOST_ADAPTERS + 1));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_host_set_adapter(before, &adapter, modes, 2));
    TEST_ASSERT_NULL(d3d9_host_adapter(before));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_host_set_mode(before, &modes[1]));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_host_set_adapter_count(before + 1));
    TEST_ASSERT_EQUAL_STRING("second", d3d9_host_adapter(before)->name);
    TEST_ASSERT_EQUAL_UINT32(400, d3d9_host_modes(before, &count)[1].height);
    TEST_ASSERT_EQUAL_UINT32(2, count);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_host_set_mode(before, &modes[1]));
    TEST_ASSERT_EQUAL_UINT32(640, d3d9_host_adapter(before)->current.width);
    TEST_ASSERT_NULL(d3d9_host_modes(before + 1, &count));
    TEST_ASSERT_EQUAL_UINT32(0, count);
    d3d9_host_set_adapter(before, &adapter, NULL, 0);
    d3d9_host_set_adapter_count(before);
}

static void a_recording_ends_with_the_process(void)
{
    char path[] = "/tmp/triptych-dispatch-XXXXXX";
    int descriptor = mkstemp(path);
    TEST_ASSERT_TRUE(descriptor >= 0);
    close(descriptor);
    TEST_ASSERT_EQUAL_INT(0, unlink(path));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_record_start(device->renderer, path));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_clear(device, 0, NULL, 1, 0xff00ff00, 1, 0));
    TEST_ASSERT_NOT_EQUAL(0, access(path, F_OK));
    struct d3d9_block_host_end end = {-1};
    TEST_ASSERT_EQUAL_INT(D3D9_DONE, d3d9_dispatch(D3D9_CODE_host_end, &end));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, end.result);
    TEST_ASSERT_EQUAL_INT(0, access(path, F_OK));
    unlink(path);
}

/* --- Cursors -------------------------------------------------------------------------------------------- */

static int32_t set_cursor(uint32_t width, uint32_t height, uint32_t format)
{
    struct d3d9_surface *surface;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_offscreen_plain_surface(device, width, height, format,
                                                                                3, &surface, NULL));
    int32_t result = d3d9_device_set_cursor_properties(device, 0, 0, surface);
    d3d9_object_release((struct d3d9_object *)surface);
    return result;
}

static void a_cursor_has_alpha_and_sides_of_powers_of_two_within_the_mode(void)
{
    enum { A8R8G8B8 = 21, X8R8G8B8 = 22 };
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, d3d9_device_set_cursor_properties(device, 0, 0, NULL));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, set_cursor(32, 32, A8R8G8B8));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, set_cursor(2, 4, A8R8G8B8));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, set_cursor(3, 2, A8R8G8B8));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, set_cursor(2, 6, A8R8G8B8));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, set_cursor(32, 32, X8R8G8B8));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, set_cursor(512, 256, A8R8G8B8));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, set_cursor(1024, 256, A8R8G8B8));
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, set_cursor(512, 512, A8R8G8B8));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_block_becomes_the_arguments_of_a_function);
    RUN_TEST(floats_and_signed_numbers_pass_a_block);
    RUN_TEST(an_unknown_code_executes_nothing);
    RUN_TEST(members_of_blocks_have_fixed_offsets);
    RUN_TEST(objects_of_another_device_are_refused);
    RUN_TEST(an_identifier_can_be_null);
    RUN_TEST(a_draw_has_a_largest_number_of_primitives);
    RUN_TEST(calls_of_several_threads_are_one_after_another);
    RUN_TEST(the_end_of_an_object_leaves_the_data_of_the_windows_side);
    RUN_TEST(interfaces_of_the_program_are_released_by_events);
    RUN_TEST(adapters_and_modes_are_those_that_were_handed_over);
    RUN_TEST(a_recording_ends_with_the_process);
    RUN_TEST(a_cursor_has_alpha_and_sides_of_powers_of_two_within_the_mode);
    return UNITY_END();
}
