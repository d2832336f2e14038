#include "tests/support/front/device.h"

#include <unity.h>

static void destroy_device(struct d3d9_object *object)
{
    struct d3d9_device *device = (struct d3d9_device *)object;
    d3d9_device_free_state(device);
    triptych_device_destroy(device->renderer);
}

struct d3d9_device *bare_device_make(uint32_t flags)
{
    struct d3d9_device *device =
        d3d9_object_make(sizeof *device, D3D9_INTERFACE_DEVICE_EX, NULL, destroy_device);
    TEST_ASSERT_NOT_NULL(device);
    struct triptych_options options = {.engine = "emulate", .threads = 1};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&options, &device->renderer, NULL, 0));
    device->creation.behavior_flags = flags;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_make_state(device, true));
    return device;
}

void bare_device_free(struct d3d9_device *device)
{
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(&device->object));
}
