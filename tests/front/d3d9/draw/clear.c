/* Targets, Clear and queries (front/d3d9/draw). */
#include "front/d3d9/resource/surface.h"
#include "tests/support/front/device.h"

#include <unity.h>

enum { COLOR = 1, DEPTH = 2, STENCIL = 4, INVALID = D3D9_INVALID_CALL, SCISSOR = 174, STRIP = 5 };
enum { WHITE = 0xffffffff, RED = 0xffff0000, GREEN = 0x8000ff00 };

static struct d3d9_device *device;

void setUp(void)
{
    device = bare_device_make(D3D9_CREATE_HARDWARE_VERTICES);
    bare_device_begin(device);
}

void tearDown(void)
{
    bare_device_free(device);
}

static void clear(uint32_t count, const struct d3d9_rect *rectangles, uint32_t color)
{
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_clear(device, count, rectangles, COLOR, color, 0, 0));
}

/* The pixels of a diagonal that have the colour, bit i at i, i. */
static unsigned diagonal(uint32_t color)
{
    unsigned found = 0;
    for (unsigned i = 0; i < BARE_WIDTH; i++)
        found |= (unsigned)(bare_device_pixel(device, i, i) == color) << i;
    return found;
}

static void a_clear_is_inside_of_rectangles_viewport_and_scissor(void)
{
    const struct d3d9_rect rectangles[] = {{0, 0, 2, 2}, {6, 6, 99, 99}, {5, 5, 4, 4}, {-9, -9, -1, -1}};
    struct d3d9_viewport viewport = {.x = 1, .y = 1, .width = 6, .height = 6, .max_z = 1};
    clear(0, NULL, WHITE);
    TEST_ASSERT_EQUAL_HEX(0xff, diagonal(WHITE));
    clear(4, rectangles, RED);
    TEST_ASSERT_EQUAL_HEX(0xc3, diagonal(RED));
    clear(0, rectangles, GREEN);
    TEST_ASSERT_EQUAL_HEX(0xc3, diagonal(RED));
    d3d9_device_set_viewport(device, &viewport);
    clear(1, NULL, GREEN);
    TEST_ASSERT_EQUAL_HEX(0x7e, diagonal(GREEN));
    d3d9_device_set_scissor_rect(device, &(struct d3d9_rect){3, 3, 5, 5});
    clear(4, rectangles, WHITE);
    TEST_ASSERT_EQUAL_HEX(0x42, diagonal(WHITE));
    d3d9_device_set_render_state(device, SCISSOR, 1);
    clear(0, NULL, RED);
    TEST_ASSERT_EQUAL_HEX(0x99, diagonal(RED));
    TEST_ASSERT_EQUAL_HEX(0x24, diagonal(GREEN));
}

static void depth_and_stencil_need_a_surface(void)
{
    struct d3d9_surface *depth = NULL;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_get_depth_stencil_surface(device, &depth));
    d3d9_object_release(&depth->resource.object);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_clear(device, 0, NULL, DEPTH | STENCIL, 0, 0.5F, 3));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_clear(device, 0, NULL, 0, 0, 0, 0));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_depth_stencil_surface(device, NULL));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_clear(device, 0, NULL, COLOR | DEPTH, 0, 0, 0));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_FOUND, d3d9_device_get_depth_stencil_surface(device, &depth));
    clear(0, NULL, RED);
    TEST_ASSERT_EQUAL_HEX(0xff, diagonal(RED));
}

static void a_new_target_resets_viewport_and_scissor(void)
{
    struct d3d9_viewport viewport = {.x = 1, .width = 2, .height = 3, .min_z = 0.25F, .max_z = 0.5F};
    struct d3d9_state_block *block;
    struct d3d9_rect scissor = {1, 2, 3, 4};
    struct d3d9_surface *target = NULL;
    d3d9_device_get_render_target(device, 0, &target);
    d3d9_device_set_viewport(device, &viewport);
    d3d9_device_set_scissor_rect(device, &scissor);
    d3d9_device_begin_state_block(device);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_render_target(device, 0, target));
    d3d9_device_end_state_block(device, &block);
    d3d9_object_release((struct d3d9_object *)block);
    d3d9_device_get_viewport(device, &viewport);
    d3d9_device_get_scissor_rect(device, &scissor);
    TEST_ASSERT_EQUAL_UINT32(0, viewport.x);
    TEST_ASSERT_EQUAL_UINT32(BARE_WIDTH, viewport.width);
    TEST_ASSERT_EQUAL_FLOAT(0, viewport.min_z);
    TEST_ASSERT_EQUAL_FLOAT(1, viewport.max_z);
    TEST_ASSERT_EQUAL_INT32(0, scissor.left);
    TEST_ASSERT_EQUAL_INT32(BARE_HEIGHT, scissor.bottom);
    d3d9_object_release(&target->resource.object);
}

static void targets_that_are_not_valid_are_refused(void)
{
    struct d3d9_surface *target = NULL, *depth = NULL, *none = NULL;
    d3d9_device_get_render_target(device, 0, &target);
    d3d9_device_get_depth_stencil_surface(device, &depth);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_render_target(device, 4, target));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_render_target(device, 0, depth));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_depth_stencil_surface(device, target));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_set_render_target(device, 0, NULL));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_set_render_target(device, 1, NULL));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_FOUND, d3d9_device_get_render_target(device, 1, &none));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_get_render_target(device, 4, &none));
    d3d9_object_release(&target->resource.object);
    d3d9_object_release(&depth->resource.object);
}

/* --- Queries --- */

enum { EVENT = 8, OCCLUSION, TIMESTAMP, DISJOINT, FREQUENCY, END = 1, BEGIN = 2 };

static struct d3d9_query *query_of(uint32_t type)
{
    struct d3d9_query *query = NULL;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_device_create_query(device, type, &query));
    TEST_ASSERT_EQUAL_UINT32(type, d3d9_query_get_type(query));
    return query;
}

static uint64_t data_of(struct d3d9_query *query)
{
    uint64_t data = UINT64_MAX;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_query_get_data(query, &data, d3d9_query_get_data_size(query), 1));
    return data;
}

static void occlusion_counts_pixels(void)
{
    static const float quad[4][4] = {{-1, -1, 0, 1}, {8, -1, 0, 1}, {-1, 8, 0, 1}, {8, 8, 0, 1}};
    struct d3d9_query *query = query_of(OCCLUSION);
    uint16_t word[4] = {1, 1, 1, 1};
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0xffffffffdddddddd), data_of(query));
    d3d9_device_set_fvf(device, 0x004);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_query_issue(query, BEGIN));
    TEST_ASSERT_EQUAL_INT32(D3D9_FALSE, d3d9_query_get_data(query, word, 2, 0));
    d3d9_device_draw_primitive_up(device, STRIP, 2, quad, sizeof *quad);
    d3d9_device_draw_primitive_up(device, STRIP, 2, quad, sizeof *quad);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_query_issue(query, END));
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0xffffffff00000080), data_of(query));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_query_get_data(query, word, 2, 0));
    TEST_ASSERT_EQUAL_HEX16(0x80, word[0]);
    TEST_ASSERT_EQUAL_HEX16(1, word[1]);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_query_issue(query, END));
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0xffffffff00000000), data_of(query));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_query_issue(query, BEGIN));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_query_issue(query, BEGIN));
    d3d9_object_release((struct d3d9_object *)query);
}

static void other_queries_have_results_after_their_end(void)
{
    struct d3d9_query *event = query_of(EVENT), *time = query_of(TIMESTAMP);
    struct d3d9_query *disjoint = query_of(DISJOINT), *frequency = query_of(FREQUENCY);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_query_issue(event, BEGIN));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_query_issue(event, END));
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0xffffffff00000001), data_of(event));
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0xdddddddddddddddd), data_of(time));
    d3d9_query_issue(time, END);
    uint64_t first = data_of(time);
    d3d9_query_issue(time, END);
    TEST_ASSERT_TRUE(data_of(time) > first && first);
    d3d9_query_issue(frequency, END);
    TEST_ASSERT_EQUAL_UINT64(1000000000, data_of(frequency));
    d3d9_query_issue(disjoint, BEGIN);
    d3d9_query_issue(disjoint, END);
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0xffffffff00000000), data_of(disjoint));
    d3d9_object_release((struct d3d9_object *)event);
    d3d9_object_release((struct d3d9_object *)time);
    d3d9_object_release((struct d3d9_object *)disjoint);
    d3d9_object_release((struct d3d9_object *)frequency);
}

static void queries_that_no_device_has_are_refused(void)
{
    struct d3d9_query *query = NULL;
    for (uint32_t type = 0; type < 40; type++) {
        bool exists = type >= EVENT && type <= FREQUENCY;
        TEST_ASSERT_EQUAL_INT32(exists ? D3D9_OK : D3D9_NOT_AVAILABLE,
                                d3d9_device_create_query(device, type, NULL));
        if (!exists)
            TEST_ASSERT_EQUAL_INT32(D3D9_NOT_AVAILABLE, d3d9_device_create_query(device, type, &query));
    }
    TEST_ASSERT_NULL(query);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_clear_is_inside_of_rectangles_viewport_and_scissor);
    RUN_TEST(depth_and_stencil_need_a_surface);
    RUN_TEST(a_new_target_resets_viewport_and_scissor);
    RUN_TEST(targets_that_are_not_valid_are_refused);
    RUN_TEST(occlusion_counts_pixels);
    RUN_TEST(other_queries_have_results_after_their_end);
    RUN_TEST(queries_that_no_device_has_are_refused);
    return UNITY_END();
}
