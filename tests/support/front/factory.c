#include "tests/support/front/factory.h"

#include "triptych.h"

#include <stdlib.h>
#include <unity.h>

struct d3d9_factory *factory_make(bool extended)
{
    static const struct d3d9_host_mode modes[] = {
        {640, 480, 60, TRIPTYCH_SURFACE_X8R8G8B8, 1}, {640, 480, 60, TRIPTYCH_SURFACE_R5G6B5, 1},
        {800, 600, 60, TRIPTYCH_SURFACE_X8R8G8B8, 1}, {800, 600, 60, TRIPTYCH_SURFACE_R5G6B5, 1},
        {800, 600, 75, TRIPTYCH_SURFACE_X8R8G8B8, 1},
    };
    const struct d3d9_host_adapter adapter = {
        .luid = 0x500000007, .name = "\\\\.\\DISPLAY1", .current = modes[0], .desktop = modes[0]};
    struct d3d9_factory *factory;
    d3d9_host_set_adapter(0, &adapter, modes, sizeof modes / sizeof *modes);
    d3d9_host_set_adapter_count(1);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_factory_create(32, extended, &factory));
    return factory;
}

struct d3d9_present_parameters factory_parameters(void)
{
    return (struct d3d9_present_parameters){.swap_effect = 1, .windowed = true};
}

struct d3d9_host_window factory_window(void)
{
    return (struct d3d9_host_window){FACTORY_WINDOW, FACTORY_WIDTH, FACTORY_HEIGHT, true, false};
}

struct d3d9_device *factory_device(bool extended, struct d3d9_present_parameters parameters)
{
    enum { HARDWARE = 1 };
    struct d3d9_factory *factory = factory_make(extended);
    struct d3d9_host_window window = factory_window();
    struct d3d9_device *device;
    setenv("TRIPTYCH_ENGINE", "emulate", 1);
    setenv("TRIPTYCH_THREADS", "1", 1);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_factory_create_device(factory, 0, HARDWARE, FACTORY_WINDOW,
                                                                D3D9_CREATE_HARDWARE_VERTICES, &parameters,
                                                                &device, &window));
    TEST_ASSERT_EQUAL_UINT32(1, d3d9_object_release((struct d3d9_object *)factory));
    return device;
}

void factory_device_free(struct d3d9_device *device)
{
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(&device->object));
}
