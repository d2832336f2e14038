#include "tests/support/front/device.h"
#include "front/d3d9/draw/draw.h"
#include "front/d3d9/resource/surface.h"

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

static struct d3d9_surface *surface_of(struct d3d9_device *device, uint32_t format, uint32_t usage)
{
    struct d3d9_surface *surface = NULL;
    struct d3d9_surface_creation creation = {.width = BARE_WIDTH,
                                             .height = BARE_HEIGHT,
                                             .format = format,
                                             .usage = usage,
                                             .pool = D3D9_POOL_DEFAULT};
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_surface_make(device, &creation, &surface));
    return surface;
}

void bare_device_begin(struct d3d9_device *device)
{
    enum { A8R8G8B8 = 21, D24S8 = 75, ZENABLE = 7, CULLMODE = 22, LIGHTING = 137 };
    struct d3d9_surface *color = surface_of(device, A8R8G8B8, D3D9_USAGE_RENDER_TARGET);
    struct d3d9_surface *depth = surface_of(device, D24S8, D3D9_USAGE_DEPTH_STENCIL);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_render_target(device, 0, color));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_depth_stencil_surface(device, depth));
    d3d9_object_release(&color->resource.object);
    d3d9_object_release(&depth->resource.object);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_begin_scene(device));
    d3d9_device_set_render_state(device, ZENABLE, 0);
    d3d9_device_set_render_state(device, CULLMODE, 1);
    d3d9_device_set_render_state(device, LIGHTING, 0);
}

uint32_t bare_device_pixel(struct d3d9_device *device, unsigned x, unsigned y)
{
    uint32_t rgba[BARE_WIDTH * BARE_HEIGHT];
    TEST_ASSERT_TRUE(d3d9_draw_prepare_targets(device));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_read_color(device->renderer, rgba, sizeof rgba));
    uint32_t p = rgba[y * BARE_WIDTH + x];
    return (p & 0xff00ff00) | (p & 0xff) << 16 | (p >> 16 & 0xff);
}
