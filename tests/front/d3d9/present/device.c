/* Devices and swap chains (front/d3d9/present): present parameters, Reset, lost devices, presenting. */
#include "base/clock.h"
#include "front/d3d9/present/swapchain.h"
#include "tests/support/front/factory.h"

#include <string.h>
#include <unity.h>

enum { HARDWARE = 1, A8 = TRIPTYCH_SURFACE_A8R8G8B8, X8 = TRIPTYCH_SURFACE_X8R8G8B8, OK = D3D9_OK };
enum { INVALID = D3D9_INVALID_CALL, RED = (int)0xffff0000, BLUE = 0xff };

void setUp(void)
{
}

void tearDown(void)
{
}

/* Completes parameters of a window or, with a size, of full screen. */
static int32_t complete(struct d3d9_present_parameters *p, bool extended)
{
    const struct d3d9_host_window window = factory_window();
    struct d3d9_factory *factory = factory_make(extended);
    int32_t result = d3d9_parameters_complete(p, 0, &window, extended);
    d3d9_object_release((struct d3d9_object *)factory);
    return result;
}

static void parameters_are_filled_in(void)
{
    struct d3d9_present_parameters p = factory_parameters();
    TEST_ASSERT_EQUAL_INT32(OK, complete(&p, false));
    TEST_ASSERT_EQUAL_UINT32(FACTORY_WIDTH, p.back_buffer_width);
    TEST_ASSERT_EQUAL_UINT32(FACTORY_HEIGHT, p.back_buffer_height);
    TEST_ASSERT_EQUAL_UINT32(X8, p.back_buffer_format);
    TEST_ASSERT_EQUAL_UINT32(1, p.back_buffer_count);
    TEST_ASSERT_EQUAL_UINT64(0, p.device_window);
}

static void parameters_are_refused_without_being_changed(void)
{
    const struct {
        uint32_t width, height, format, count, samples, effect;
        bool windowed;
        uint32_t interval;
        int32_t base, extended;
    } cases[] = {
        {0, 0, 0, 1, 0, 0, true, 0, INVALID, INVALID},
        {0, 0, 0, 1, 0, D3D9_SWAP_FLIP_EX, true, 0, INVALID, OK},
        {0, 0, 0, 1, 0, D3D9_SWAP_OVERLAY, true, 0, INVALID, INVALID},
        {0, 0, 0, 2, 0, D3D9_SWAP_COPY, true, 0, INVALID, INVALID},
        {0, 0, 0, 3, 0, D3D9_SWAP_DISCARD, true, 0, OK, OK},
        {0, 0, 0, 4, 0, D3D9_SWAP_DISCARD, true, 0, INVALID, OK},
        {0, 0, 0, 31, 0, D3D9_SWAP_DISCARD, true, 0, INVALID, INVALID},
        {0, 0, 0, 1, 4, D3D9_SWAP_DISCARD, true, 0, OK, OK},
        {0, 0, 0, 1, 4, D3D9_SWAP_FLIP, true, 0, INVALID, INVALID},
        {0, 0, 0, 1, 3, D3D9_SWAP_DISCARD, true, 0, INVALID, INVALID},
        {0, 0, 0, 1, 0, D3D9_SWAP_DISCARD, true, 5, INVALID, INVALID},
        {0, 0, TRIPTYCH_SURFACE_DXT1, 1, 0, D3D9_SWAP_DISCARD, true, 0, INVALID, INVALID},
        {0, 0, X8, 1, 0, D3D9_SWAP_DISCARD, false, 0, INVALID, INVALID},
        {801, 600, X8, 1, 0, D3D9_SWAP_DISCARD, false, 0, INVALID, INVALID},
        {800, 600, A8, 1, 0, D3D9_SWAP_DISCARD, false, 0, OK, OK},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int extended = 0; extended < 2; extended++) {
            struct d3d9_present_parameters p = {
                .back_buffer_width = cases[i].width,
                .back_buffer_height = cases[i].height,
                .back_buffer_format = cases[i].format,
                .back_buffer_count = cases[i].count,
                .multi_sample_type = cases[i].samples,
                .swap_effect = cases[i].effect,
                .windowed = cases[i].windowed,
            };
            p.presentation_interval = cases[i].interval;
            const struct d3d9_present_parameters before = p;
            const char number[] = {(char)('a' + i), extended ? 'x' : ' ', 0};
            int32_t expected = extended ? cases[i].extended : cases[i].base;
            TEST_ASSERT_EQUAL_INT32_MESSAGE(expected, complete(&p, extended), number);
            if (expected < 0)
                TEST_ASSERT_EQUAL_MEMORY(&before, &p, sizeof p);
        }
}

static void a_device_has_a_swap_chain_and_its_own_depth_surface(void)
{
    struct d3d9_present_parameters p = factory_parameters();
    p.enable_auto_depth_stencil = true;
    p.auto_depth_stencil_format = TRIPTYCH_SURFACE_D24S8;
    struct d3d9_device *device = factory_device(false, p);
    struct d3d9_swapchain *chain;
    struct d3d9_surface *buffer, *other = (void *)1;
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_get_swap_chain(device, 0, &chain));
    TEST_ASSERT_EQUAL_UINT32(2, device->object.references);
    TEST_ASSERT_EQUAL_UINT64(FACTORY_WINDOW, chain->parameters.device_window);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_swapchain_get_back_buffer(chain, 0, 0, &buffer));
    TEST_ASSERT_EQUAL_PTR(device->target[0], buffer);
    TEST_ASSERT_EQUAL_PTR(device->presentation.depth, device->depth);
    TEST_ASSERT_EQUAL_PTR(chain, buffer->resource.object.container);
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(&buffer->resource.object));
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(&chain->object));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_get_back_buffer(device, 0, 1, 0, &other));
    TEST_ASSERT_NULL(other);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_get_swap_chain(device, 1, &chain));
    factory_device_free(device);
}

static int32_t reset(struct d3d9_device *device, uint32_t width)
{
    struct d3d9_present_parameters p = factory_parameters();
    const struct d3d9_host_window window = factory_window();
    p.back_buffer_width = p.back_buffer_height = width;
    return d3d9_device_reset(device, &p, &window);
}

static void resources_of_the_default_pool_prevent_a_reset(void)
{
    for (int extended = 0; extended < 2; extended++) {
        struct d3d9_device *device = factory_device(extended, factory_parameters());
        struct d3d9_surface *surface;
        d3d9_device_create_offscreen_plain_surface(device, 4, 4, A8, D3D9_POOL_DEFAULT, &surface, NULL);
        TEST_ASSERT_EQUAL_INT32(extended ? OK : INVALID, reset(device, 20));
        TEST_ASSERT_EQUAL_INT32(extended ? OK : D3D9_DEVICE_NOT_RESET,
                                d3d9_device_test_cooperative_level(device));
        d3d9_object_release(&surface->resource.object);
        d3d9_device_create_offscreen_plain_surface(device, 4, 4, A8, D3D9_POOL_SCRATCH, &surface, NULL);
        TEST_ASSERT_EQUAL_INT32(OK, reset(device, 24));
        TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_test_cooperative_level(device));
        TEST_ASSERT_EQUAL_UINT32(24, device->state->viewport->width);
        d3d9_object_release(&surface->resource.object);
        factory_device_free(device);
    }
}

static void a_referenced_back_buffer_prevents_a_reset(void)
{
    struct d3d9_device *device = factory_device(false, factory_parameters());
    struct d3d9_surface *buffer;
    d3d9_device_get_back_buffer(device, 0, 0, 0, &buffer);
    TEST_ASSERT_EQUAL_INT32(INVALID, reset(device, 20));
    d3d9_object_release(&buffer->resource.object);
    TEST_ASSERT_EQUAL_INT32(OK, reset(device, 20));
    factory_device_free(device);
}

static struct d3d9_device *full_screen(bool extended)
{
    struct d3d9_present_parameters p = factory_parameters();
    p.windowed = false;
    p.back_buffer_width = 640;
    p.back_buffer_height = 480;
    return factory_device(extended, p);
}

static void a_device_in_full_screen_is_lost_with_the_focus(void)
{
    struct d3d9_device *device = full_screen(false);
    struct d3d9_host_picture picture = {0};
    d3d9_device_activate(device, false);
    TEST_ASSERT_EQUAL_INT32(D3D9_DEVICE_LOST, d3d9_device_test_cooperative_level(device));
    TEST_ASSERT_EQUAL_INT32(D3D9_DEVICE_LOST, d3d9_device_present(device, NULL, NULL, 0, NULL, &picture));
    TEST_ASSERT_EQUAL_UINT32(0, picture.shown);
    TEST_ASSERT_EQUAL_INT32(D3D9_DEVICE_LOST, reset(device, 20));
    d3d9_device_activate(device, true);
    TEST_ASSERT_EQUAL_INT32(D3D9_DEVICE_NOT_RESET, d3d9_device_test_cooperative_level(device));
    TEST_ASSERT_EQUAL_INT32(D3D9_DEVICE_LOST, d3d9_device_present(device, NULL, NULL, 0, NULL, &picture));
    TEST_ASSERT_EQUAL_INT32(OK, reset(device, 20));
    d3d9_device_activate(device, false); /* in a window the focus has no effect */
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_test_cooperative_level(device));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_present(device, NULL, NULL, 0, NULL, &picture));
    factory_device_free(device);
}

static void an_extended_device_in_full_screen_is_occluded_without_the_focus(void)
{
    struct d3d9_device *device = full_screen(true);
    struct d3d9_host_picture picture = {0};
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_check_device_state(device, FACTORY_WINDOW, NULL));
    TEST_ASSERT_EQUAL_INT32(D3D9_PRESENT_OCCLUDED, d3d9_device_check_device_state(device, 0, NULL));
    d3d9_device_activate(device, false);
    TEST_ASSERT_EQUAL_INT32(D3D9_PRESENT_OCCLUDED,
                            d3d9_device_present_ex(device, NULL, NULL, 0, NULL, 0, &picture));
    TEST_ASSERT_EQUAL_INT32(D3D9_PRESENT_OCCLUDED,
                            d3d9_device_check_device_state(device, FACTORY_WINDOW, NULL));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_check_device_state(device, 0, NULL));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_test_cooperative_level(device));
    factory_device_free(device);
}

static struct d3d9_host_picture picture_of(uint32_t *words, uint32_t width, uint32_t height)
{
    return (struct d3d9_host_picture){
        .bits = (uintptr_t)words, .pitch = width * 4, .room_width = width, .room_height = height};
}

static void present_fills_a_bitmap_that_is_large_enough(void)
{
    static uint32_t words[FACTORY_WIDTH * FACTORY_HEIGHT];
    struct d3d9_device *device = factory_device(false, factory_parameters());
    struct d3d9_host_picture picture = picture_of(words, 8, 8);
    d3d9_device_color_fill(device, device->target[0], NULL, (uint32_t)RED);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_present(device, NULL, NULL, 0, NULL, &picture));
    TEST_ASSERT_EQUAL_UINT32(0, picture.filled);
    TEST_ASSERT_EQUAL_UINT32(FACTORY_WIDTH, picture.width);
    TEST_ASSERT_EQUAL_UINT64(FACTORY_WINDOW, picture.window);
    picture = picture_of(words, FACTORY_WIDTH, FACTORY_HEIGHT);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_swapchain_read_picture(device->presentation.chain, &picture));
    TEST_ASSERT_EQUAL_UINT32(1, picture.filled);
    TEST_ASSERT_EQUAL_HEX32(RED & 0xffffff, words[FACTORY_WIDTH * FACTORY_HEIGHT - 1] & 0xffffff);
    factory_device_free(device);
}

static void flipped_buffers_rotate(void)
{
    static uint32_t words[FACTORY_WIDTH * FACTORY_HEIGHT];
    struct d3d9_present_parameters p = factory_parameters();
    p.back_buffer_count = 2;
    p.swap_effect = D3D9_SWAP_FLIP;
    struct d3d9_device *device = factory_device(false, p);
    struct d3d9_swapchain *chain = device->presentation.chain;
    d3d9_device_color_fill(device, chain->buffer[0], NULL, (uint32_t)RED);
    d3d9_device_color_fill(device, chain->buffer[1], NULL, BLUE);
    for (int round = 0; round < 4; round++) {
        struct d3d9_host_picture picture = picture_of(words, FACTORY_WIDTH, FACTORY_HEIGHT);
        d3d9_device_present(device, NULL, NULL, 0, NULL, &picture);
        TEST_ASSERT_EQUAL_HEX32(round % 2 ? BLUE : RED & 0xffffff, words[7] & 0xffffff);
    }
    factory_device_free(device);
}

static void gamma_changes_pictures_in_full_screen_only(void)
{
    static uint32_t words[640 * 480];
    for (int windowed = 0; windowed < 2; windowed++) {
        struct d3d9_device *device =
            windowed ? factory_device(false, factory_parameters()) : full_screen(false);
        struct d3d9_host_picture picture = picture_of(words, 640, 480);
        struct d3d9_gamma_ramp ramp = {0};
        ramp.green[255] = 0x8000;
        d3d9_device_set_gamma_ramp(device, 0, 0, &ramp);
        d3d9_device_color_fill(device, device->target[0], NULL, 0xffffffff);
        d3d9_device_present(device, NULL, NULL, 0, NULL, &picture);
        TEST_ASSERT_EQUAL_HEX32(windowed ? 0xffffff : 0x8000, words[5] & 0xffffff);
        factory_device_free(device);
    }
}

static void creation_is_refused(void)
{
    struct d3d9_factory *factory = factory_make(true);
    const struct d3d9_host_window window = factory_window();
    struct d3d9_present_parameters p = factory_parameters();
    struct d3d9_display_mode_ex mode = {sizeof mode, 640, 480, 0, X8, 0};
    struct d3d9_device *device = (void *)1;
    enum { BOTH = D3D9_CREATE_SOFTWARE_VERTICES | D3D9_CREATE_HARDWARE_VERTICES };
    TEST_ASSERT_EQUAL_INT32(
        INVALID, d3d9_factory_create_device(factory, 0, HARDWARE, FACTORY_WINDOW, 0, &p, &device, &window));
    TEST_ASSERT_NULL(device);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_factory_create_device(factory, 0, HARDWARE, FACTORY_WINDOW, BOTH,
                                                                &p, &device, &window));
    TEST_ASSERT_EQUAL_INT32(INVALID,
                            d3d9_factory_create_device(factory, 1, HARDWARE, FACTORY_WINDOW,
                                                       D3D9_CREATE_HARDWARE_VERTICES, &p, &device, &window));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE,
                            d3d9_factory_create_device(factory, 0, 2, FACTORY_WINDOW,
                                                       D3D9_CREATE_HARDWARE_VERTICES, &p, &device, &window));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_factory_create_device_ex(factory, 0, HARDWARE, FACTORY_WINDOW,
                                                                   D3D9_CREATE_HARDWARE_VERTICES, &p, &mode,
                                                                   &device, &window));
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release((struct d3d9_object *)factory));
}

/* Programs wait until it changes. The period is a sixtieth of a second. */
static void the_raster_is_in_the_blank_and_out_of_it(void)
{
    struct d3d9_device *device = factory_device(false, factory_parameters());
    struct d3d9_raster_status status;
    bool seen[2] = {false, false};
    const uint64_t begin = clock_ns();
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_get_raster_status(device, 0, NULL));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_get_raster_status(device, 1, &status));
    while (!(seen[0] && seen[1]) && clock_ns() - begin < 10000000000u) {
        TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_get_raster_status(device, 0, &status));
        TEST_ASSERT_TRUE(status.scan_line < 480);
        TEST_ASSERT_TRUE(!status.in_vblank || !status.scan_line);
        seen[status.in_vblank != 0] = true;
    }
    TEST_ASSERT_TRUE(seen[0] && seen[1]);
    factory_device_free(device);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(parameters_are_filled_in);
    RUN_TEST(parameters_are_refused_without_being_changed);
    RUN_TEST(a_device_has_a_swap_chain_and_its_own_depth_surface);
    RUN_TEST(resources_of_the_default_pool_prevent_a_reset);
    RUN_TEST(a_referenced_back_buffer_prevents_a_reset);
    RUN_TEST(a_device_in_full_screen_is_lost_with_the_focus);
    RUN_TEST(an_extended_device_in_full_screen_is_occluded_without_the_focus);
    RUN_TEST(present_fills_a_bitmap_that_is_large_enough);
    RUN_TEST(flipped_buffers_rotate);
    RUN_TEST(gamma_changes_pictures_in_full_screen_only);
    RUN_TEST(creation_is_refused);
    RUN_TEST(the_raster_is_in_the_blank_and_out_of_it);
    return UNITY_END();
}
