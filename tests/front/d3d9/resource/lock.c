/* Surfaces and textures (front/d3d9/resource): creation, memory, locks, dirty boxes. */
#include "front/d3d9/resource/texture.h"
#include "tests/support/front/factory.h"

#include <string.h>
#include <unity.h>

enum {
    A8 = TRIPTYCH_SURFACE_A8R8G8B8,
    X8 = TRIPTYCH_SURFACE_X8R8G8B8,
    R5 = TRIPTYCH_SURFACE_R5G6B5,
    DXT1 = TRIPTYCH_SURFACE_DXT1,
    OK = D3D9_OK,
    INVALID = D3D9_INVALID_CALL
};

static struct d3d9_device *device;

void setUp(void)
{
    device = factory_device(false, factory_parameters());
}

void tearDown(void)
{
    factory_device_free(device);
}

static void release(void *object)
{
    d3d9_object_release(object);
}

static struct d3d9_surface *plain(uint32_t width, uint32_t height, uint32_t format, uint32_t pool)
{
    struct d3d9_surface *surface;
    TEST_ASSERT_EQUAL_INT32(
        OK, d3d9_device_create_offscreen_plain_surface(device, width, height, format, pool, &surface, NULL));
    return surface;
}

static struct d3d9_texture *texture(uint32_t levels, uint32_t usage, uint32_t format, uint32_t pool)
{
    struct d3d9_texture *made;
    TEST_ASSERT_EQUAL_INT32(
        OK, d3d9_device_create_texture(device, 16, 16, levels, usage, format, pool, &made, NULL));
    return made;
}

static void a_target_that_keeps_nothing_can_be_locked(void)
{
    struct d3d9_surface *surface;
    struct d3d9_locked_rect locked;
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_create_render_target(device, 16, 16, TRIPTYCH_SURFACE_NULL, 0, 0,
                                                                 true, &surface, NULL));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_lock_rect(surface, &locked, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(64, locked.pitch);
    memset(locked.bits, 7, 16 * 64);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_unlock_rect(surface));
    release(surface);
}

static void rows_are_multiples_of_four_bytes(void)
{
    struct d3d9_surface *surface = plain(5, 5, R5, D3D9_POOL_SYSTEM);
    struct d3d9_locked_rect locked;
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_lock_rect(surface, &locked, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(12, locked.pitch);
    uint8_t *base = locked.bits;
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_unlock_rect(surface));
    const struct d3d9_rect part = {2, 1, 4, 3}, outside = {-2, 1, 9, 9};
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_lock_rect(surface, &locked, &part, 0));
    TEST_ASSERT_EQUAL_INT(12 + 4, (uint8_t *)locked.bits - base);
    d3d9_surface_unlock_rect(surface);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_lock_rect(surface, &locked, &outside, 0));
    TEST_ASSERT_EQUAL_INT(12 - 4, (uint8_t *)locked.bits - base);
    d3d9_surface_unlock_rect(surface);
    release(surface);
}

static void a_second_lock_is_refused_and_changes_nothing(void)
{
    struct d3d9_surface *surface = plain(8, 8, A8, D3D9_POOL_SCRATCH);
    struct d3d9_locked_rect locked, second = {1, NULL};
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_surface_unlock_rect(surface));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_lock_rect(surface, &locked, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_surface_lock_rect(surface, &second, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(1, second.pitch);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_unlock_rect(surface));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_surface_unlock_rect(surface));
    release(surface);
}

static void the_default_pool_refuses_bad_rectangles(void)
{
    const struct d3d9_rect bad[] = {{2, 0, 2, 4}, {4, 4, 2, 8}, {-4, 0, 4, 4}, {0, 0, 20, 4}};
    struct d3d9_surface *surface = plain(16, 16, A8, D3D9_POOL_DEFAULT);
    struct d3d9_locked_rect locked;
    for (unsigned i = 0; i < sizeof bad / sizeof *bad; i++)
        TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_surface_lock_rect(surface, &locked, &bad[i], 0));
    release(surface);
    struct d3d9_texture *dynamic = texture(1, D3D9_USAGE_DYNAMIC, DXT1, D3D9_POOL_DEFAULT);
    const struct d3d9_rect half_block = {0, 0, 2, 4}, block = {4, 4, 8, 8};
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_texture_lock_rect(dynamic, 0, &locked, &half_block, 0));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_texture_lock_rect(dynamic, 0, &locked, &block, 0));
    TEST_ASSERT_EQUAL_INT32(4 * 8, locked.pitch);
    release(dynamic);
}

static void only_some_resources_of_the_default_pool_are_lockable(void)
{
    const struct {
        uint32_t usage, format;
        bool lockable;
    } cases[] = {{0, A8, false},
                 {D3D9_USAGE_DYNAMIC, A8, true},
                 {D3D9_USAGE_RENDER_TARGET, A8, false},
                 {0, TRIPTYCH_SURFACE_ATI2, true},
                 {0, DXT1, false}};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct d3d9_texture *made = texture(1, cases[i].usage, cases[i].format, D3D9_POOL_DEFAULT);
        struct d3d9_locked_rect locked;
        int32_t result = d3d9_texture_lock_rect(made, 0, &locked, NULL, 0);
        TEST_ASSERT_EQUAL_INT32(cases[i].lockable ? OK : INVALID, result);
        release(made);
    }
}

/* A lockable target is read when it is locked and written when it is unlocked. */
static void texels_of_a_locked_target_are_those_of_the_renderer(void)
{
    struct d3d9_surface *target;
    struct d3d9_locked_rect locked;
    TEST_ASSERT_EQUAL_INT32(OK,
                            d3d9_device_create_render_target(device, 8, 8, A8, 0, 0, true, &target, NULL));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_color_fill(device, target, NULL, 0x80402010));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_lock_rect(target, &locked, NULL, 0));
    TEST_ASSERT_EQUAL_HEX32(0x80402010, ((uint32_t *)locked.bits)[63]);
    ((uint32_t *)locked.bits)[9] = 0x01020304;
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_unlock_rect(target));
    struct d3d9_surface *copy = plain(8, 8, A8, D3D9_POOL_SYSTEM);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_get_render_target_data(device, target, copy));
    d3d9_surface_lock_rect(copy, &locked, NULL, D3D9_LOCK_READ_ONLY);
    TEST_ASSERT_EQUAL_HEX32(0x01020304, ((uint32_t *)locked.bits)[9]);
    TEST_ASSERT_EQUAL_HEX32(0x80402010, ((uint32_t *)locked.bits)[10]);
    d3d9_surface_unlock_rect(copy);
    release(copy);
    release(target);
}

static void a_device_context_excludes_locks_of_the_whole_texture(void)
{
    struct d3d9_texture *managed = texture(2, 0, X8, D3D9_POOL_MANAGED);
    struct d3d9_surface *level[2];
    struct d3d9_host_bits bits;
    struct d3d9_locked_rect locked;
    for (unsigned i = 0; i < 2; i++)
        d3d9_texture_get_surface_level(managed, i, &level[i]);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_get_dc(level[0], &bits));
    TEST_ASSERT_EQUAL_UINT32(16, bits.width);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_surface_get_dc(level[1], &bits));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_surface_lock_rect(level[1], &locked, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_surface_release_dc(level[1]));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_release_dc(level[0]));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_surface_release_dc(level[0]));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_lock_rect(level[1], &locked, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_surface_get_dc(level[0], &bits));
    d3d9_surface_unlock_rect(level[1]);
    for (unsigned i = 0; i < 2; i++)
        release(level[i]);
    release(managed);
}

static void levels_share_the_count_of_their_texture(void)
{
    struct d3d9_texture *made = texture(0, 0, A8, D3D9_POOL_MANAGED);
    struct d3d9_surface *level, *again;
    TEST_ASSERT_EQUAL_UINT32(5, d3d9_base_texture_get_level_count(&made->base));
    d3d9_texture_get_surface_level(made, 4, &level);
    d3d9_texture_get_surface_level(made, 4, &again);
    TEST_ASSERT_EQUAL_PTR(level, again);
    TEST_ASSERT_EQUAL_UINT32(3, made->base.resource.object.references);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_texture_get_surface_level(made, 5, &again));
    struct d3d9_surface_desc desc;
    d3d9_surface_get_desc(level, &desc);
    TEST_ASSERT_EQUAL_UINT32(1, desc.width);
    release(level);
    release(level);
    release(made);
}

static void creation_refuses_what_direct3d_refuses(void)
{
    const struct {
        uint32_t width, levels, usage, format, pool;
    } cases[] = {
        {0, 1, 0, A8, D3D9_POOL_DEFAULT},
        {16, 6, 0, A8, D3D9_POOL_MANAGED},
        {16, 1, 0, 0, D3D9_POOL_SCRATCH},
        {16, 1, 0, TRIPTYCH_SURFACE_P8, D3D9_POOL_MANAGED},
        {16, 1, D3D9_USAGE_WRITE_ONLY, A8, D3D9_POOL_MANAGED},
        {16, 1, D3D9_USAGE_RENDER_TARGET, A8, D3D9_POOL_MANAGED},
        {16, 1, D3D9_USAGE_RENDER_TARGET | D3D9_USAGE_DYNAMIC, A8, D3D9_POOL_DEFAULT},
        {16, 1, D3D9_USAGE_RENDER_TARGET, DXT1, D3D9_POOL_DEFAULT},
        {16, 1, D3D9_USAGE_DEPTH_STENCIL, A8, D3D9_POOL_DEFAULT},
        {16, 1, D3D9_USAGE_DYNAMIC, A8, D3D9_POOL_MANAGED},
        {16, 2, D3D9_USAGE_AUTOMATIC_MIPS, A8, D3D9_POOL_MANAGED},
        {16, 0, D3D9_USAGE_AUTOMATIC_MIPS, A8, D3D9_POOL_SYSTEM},
        {6, 1, 0, DXT1, D3D9_POOL_SCRATCH},
        {16, 1, 0, TRIPTYCH_SURFACE_D24S8, D3D9_POOL_MANAGED},
        {16, 1, 0, A8, D3D9_POOL_COUNT},
        {16384, 1, 0, A8, D3D9_POOL_SYSTEM},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct d3d9_texture *made = (void *)1;
        const char number[] = {(char)('a' + i), 0};
        TEST_ASSERT_EQUAL_INT32_MESSAGE(
            INVALID,
            d3d9_device_create_texture(device, cases[i].width, cases[i].width, cases[i].levels,
                                       cases[i].usage, cases[i].format, cases[i].pool, &made, NULL),
            number);
        TEST_ASSERT_NULL(made);
    }
    uint64_t shared = 0;
    struct d3d9_texture *made;
    TEST_ASSERT_EQUAL_INT32(
        D3D9_NOT_IMPLEMENTED,
        d3d9_device_create_texture(device, 16, 16, 1, 0, A8, D3D9_POOL_DEFAULT, &made, &shared));
}

static void volumes_check_boxes_in_every_pool(void)
{
    struct d3d9_volume_texture *made;
    struct d3d9_locked_box locked;
    TEST_ASSERT_EQUAL_INT32(
        OK, d3d9_device_create_volume_texture(device, 4, 4, 2, 1, 0, A8, D3D9_POOL_SCRATCH, &made, NULL));
    const struct d3d9_box good = {2, 1, 4, 4, 1, 2}, bad = {0, 0, 4, 4, 0, 3};
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_volume_texture_lock_box(made, 0, &locked, NULL, 0));
    uint8_t *base = locked.bits;
    d3d9_volume_texture_unlock_box(made, 0);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_volume_texture_lock_box(made, 0, &locked, &bad, 0));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_volume_texture_lock_box(made, 0, &locked, &good, 0));
    TEST_ASSERT_EQUAL_INT(64 + 16 + 8, (uint8_t *)locked.bits - base);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_volume_texture_unlock_box(made, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_volume_texture_unlock_box(made, 0));
    release(made);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_target_that_keeps_nothing_can_be_locked);
    RUN_TEST(rows_are_multiples_of_four_bytes);
    RUN_TEST(a_second_lock_is_refused_and_changes_nothing);
    RUN_TEST(the_default_pool_refuses_bad_rectangles);
    RUN_TEST(only_some_resources_of_the_default_pool_are_lockable);
    RUN_TEST(texels_of_a_locked_target_are_those_of_the_renderer);
    RUN_TEST(a_device_context_excludes_locks_of_the_whole_texture);
    RUN_TEST(levels_share_the_count_of_their_texture);
    RUN_TEST(creation_refuses_what_direct3d_refuses);
    RUN_TEST(volumes_check_boxes_in_every_pool);
    return UNITY_END();
}
