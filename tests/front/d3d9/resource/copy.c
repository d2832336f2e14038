/* Copies between resources (front/d3d9/resource): dirty boxes, uploads, UpdateSurface, UpdateTexture,
 * StretchRect, ColorFill. */
#include "front/d3d9/resource/texture.h"
#include "tests/support/front/factory.h"

#include <unity.h>

enum { SIDE = 16, A8 = TRIPTYCH_SURFACE_A8R8G8B8, OK = D3D9_OK, INVALID = D3D9_INVALID_CALL };

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

static struct d3d9_base_texture *texture(uint32_t levels, uint32_t usage, uint32_t format, uint32_t pool)
{
    struct d3d9_texture *made;
    TEST_ASSERT_EQUAL_INT32(
        OK, d3d9_device_create_texture(device, SIDE, SIDE, levels, usage, format, pool, &made, NULL));
    return &made->base;
}

/* Writes one word to a level's part; null: all of it. */
static void write_words(struct d3d9_base_texture *to, uint32_t level, const struct d3d9_rect *part,
                        uint32_t word, uint32_t flags)
{
    struct d3d9_surface *surface = d3d9_base_texture_part(to, 0, level);
    const struct d3d9_rect whole = {0, 0, (int32_t)surface->image.width, (int32_t)surface->image.height};
    struct d3d9_locked_rect locked;
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_lock_rect(surface, &locked, part, flags));
    if (!part)
        part = &whole;
    for (int32_t y = 0; y < part->bottom - part->top; y++)
        for (int32_t x = 0; x < part->right - part->left; x++)
            ((uint32_t *)locked.bits)[y * locked.pitch / 4 + x] = word;
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_surface_unlock_rect(surface));
}

/* The texel that a draw samples. */
static uint32_t sampled(struct d3d9_base_texture *from, uint32_t level, uint32_t x, uint32_t y)
{
    triptych_texture *made = d3d9_base_texture_use(from);
    const struct triptych_surface surface = {.texture = made, .level = level};
    const struct triptych_rectangle part = {x, y, 1, 1};
    uint32_t word = 0;
    TEST_ASSERT_NOT_NULL(made);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          triptych_read_rectangle(device->renderer, &surface, &part,
                                                  TRIPTYCH_SURFACE_A8R8G8B8, &word, sizeof word));
    return word;
}

static const struct d3d9_rect middle = {4, 4, 8, 8};

static void managed_textures_upload_dirty_boxes_only(void)
{
    struct d3d9_base_texture *managed = texture(2, 0, A8, D3D9_POOL_MANAGED);
    write_words(managed, 0, NULL, 1, 0);
    write_words(managed, 1, NULL, 2, 0);
    TEST_ASSERT_EQUAL_HEX32(1, sampled(managed, 0, 5, 5));
    TEST_ASSERT_EQUAL_HEX32(2, sampled(managed, 1, 2, 2));
    write_words(managed, 0, NULL, 3, D3D9_LOCK_NO_DIRTY_UPDATE);
    write_words(managed, 1, NULL, 4, D3D9_LOCK_NO_DIRTY_UPDATE);
    TEST_ASSERT_EQUAL_HEX32(1, sampled(managed, 0, 5, 5));
    d3d9_texture_add_dirty_rect((struct d3d9_texture *)managed, &middle);
    TEST_ASSERT_EQUAL_HEX32(3, sampled(managed, 0, 5, 5));
    TEST_ASSERT_EQUAL_HEX32(1, sampled(managed, 0, 0, 0));
    TEST_ASSERT_EQUAL_HEX32(4, sampled(managed, 1, 2, 2));
    TEST_ASSERT_EQUAL_HEX32(2, sampled(managed, 1, 0, 0));
    d3d9_device_evict_managed_resources(device);
    TEST_ASSERT_EQUAL_HEX32(3, sampled(managed, 0, 0, 0));
    release(managed);
}

static void dirty_rectangles_are_checked(void)
{
    const struct d3d9_rect bad[] = {{-1, 0, 4, 4}, {4, 0, 4, 4}, {0, 0, 17, 4}, {0, 8, 4, 4}};
    struct d3d9_base_texture *system = texture(1, 0, A8, D3D9_POOL_SYSTEM);
    for (unsigned i = 0; i < sizeof bad / sizeof *bad; i++)
        TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_texture_add_dirty_rect((struct d3d9_texture *)system, &bad[i]));
    release(system);
}

static void dynamic_textures_have_all_that_was_written(void)
{
    struct d3d9_base_texture *dynamic = texture(1, D3D9_USAGE_DYNAMIC, A8, D3D9_POOL_DEFAULT);
    write_words(dynamic, 0, NULL, 7, D3D9_LOCK_NO_DIRTY_UPDATE);
    TEST_ASSERT_EQUAL_HEX32(7, sampled(dynamic, 0, 3, 3));
    write_words(dynamic, 0, &middle, 8, D3D9_LOCK_DISCARD);
    TEST_ASSERT_EQUAL_HEX32(8, sampled(dynamic, 0, 5, 5));
    release(dynamic);
}

static void generated_levels_follow_the_first_one(void)
{
    struct d3d9_base_texture *managed = texture(0, D3D9_USAGE_AUTOMATIC_MIPS, A8, D3D9_POOL_MANAGED);
    TEST_ASSERT_EQUAL_UINT32(1, d3d9_base_texture_get_level_count(managed));
    TEST_ASSERT_NULL(d3d9_base_texture_part(managed, 0, 1));
    write_words(managed, 0, NULL, 0x10203040, 0);
    TEST_ASSERT_EQUAL_HEX32(0x10203040, sampled(managed, 4, 0, 0));
    write_words(managed, 0, NULL, 0x50607080, 0);
    TEST_ASSERT_EQUAL_HEX32(0x50607080, sampled(managed, 4, 0, 0));
    release(managed);
}

static void update_texture_copies_and_clears_dirty_boxes(void)
{
    struct d3d9_base_texture *from = texture(1, 0, A8, D3D9_POOL_SYSTEM), *to = texture(1, 0, A8, 0);
    write_words(from, 0, NULL, 1, 0);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_update_texture(device, from, to));
    write_words(from, 0, NULL, 2, D3D9_LOCK_NO_DIRTY_UPDATE);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_update_texture(device, from, to));
    TEST_ASSERT_EQUAL_HEX32(1, sampled(to, 0, 5, 5));
    write_words(from, 0, &middle, 3, 0);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_update_texture(device, from, to));
    TEST_ASSERT_EQUAL_HEX32(3, sampled(to, 0, 5, 5));
    TEST_ASSERT_EQUAL_HEX32(1, sampled(to, 0, 0, 0));
    TEST_ASSERT_EQUAL_HEX32(2, sampled(from, 0, 0, 0)); /* a texture of the system pool is sampled as it is */
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_update_texture(device, to, from));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_update_texture(device, from, NULL));
    release(from);
    release(to);
}

static void update_texture_converts_formats(void)
{
    struct d3d9_base_texture *from = texture(1, 0, A8, D3D9_POOL_SYSTEM);
    struct d3d9_base_texture *to = texture(1, 0, TRIPTYCH_SURFACE_R5G6B5, D3D9_POOL_DEFAULT);
    write_words(from, 0, NULL, 0xffff00ff, 0);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_update_texture(device, from, to));
    TEST_ASSERT_EQUAL_HEX32(0xffff00ff, sampled(to, 0, 5, 5));
    struct d3d9_base_texture *floats = texture(1, 0, TRIPTYCH_SURFACE_R32F, D3D9_POOL_DEFAULT);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_update_texture(device, from, floats));
    release(floats);
    release(from);
    release(to);
}

static void update_surface_checks_rectangles_and_locks(void)
{
    struct d3d9_base_texture *from = texture(2, 0, A8, D3D9_POOL_SYSTEM), *to = texture(2, 0, A8, 0);
    struct d3d9_surface *source = from->part[0], *target = to->part[0];
    const struct d3d9_point corner = {12, 12}, inside = {8, 0}, negative = {-1, 0};
    struct d3d9_locked_rect locked;
    write_words(from, 0, &middle, 9, 0);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_update_surface(device, source, NULL, target, &inside));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_update_surface(device, source, &middle, target, &negative));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_update_surface(device, source, NULL, to->part[1], NULL));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_update_surface(device, source, &middle, target, &corner));
    TEST_ASSERT_EQUAL_HEX32(9, sampled(to, 0, 15, 15));
    TEST_ASSERT_EQUAL_HEX32(0, sampled(to, 0, 11, 11));
    d3d9_surface_lock_rect(source, &locked, NULL, 0);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_update_surface(device, source, &middle, target, NULL));
    d3d9_surface_unlock_rect(source);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_update_surface(device, target, NULL, source, NULL));
    release(from);
    release(to);
}

static struct d3d9_surface *render_target(uint32_t side)
{
    struct d3d9_surface *surface;
    TEST_ASSERT_EQUAL_INT32(
        OK, d3d9_device_create_render_target(device, side, side, A8, 0, 0, true, &surface, NULL));
    return surface;
}

static void stretch_rect_scales_between_targets(void)
{
    struct d3d9_surface *small = render_target(8), *large = render_target(32);
    const struct d3d9_rect half = {0, 0, 16, 32}, flipped = {16, 0, 0, 32};
    struct d3d9_locked_rect locked;
    d3d9_device_color_fill(device, small, NULL, 0xff112233);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_stretch_rect(device, small, NULL, large, &half, 0));
    d3d9_surface_lock_rect(large, &locked, NULL, D3D9_LOCK_READ_ONLY);
    TEST_ASSERT_EQUAL_HEX32(0xff112233, ((uint32_t *)locked.bits)[15]);
    TEST_ASSERT_EQUAL_HEX32(0, ((uint32_t *)locked.bits)[16]);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_stretch_rect(device, small, NULL, large, NULL, 0));
    d3d9_surface_unlock_rect(large);
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_stretch_rect(device, small, NULL, large, &flipped, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_stretch_rect(device, small, NULL, large, NULL, 3));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_stretch_rect(device, small, NULL, small, NULL, 0));
    release(small);
    release(large);
}

static void only_targets_and_plain_surfaces_are_destinations(void)
{
    struct d3d9_surface *target = render_target(16), *plain;
    struct d3d9_base_texture *sampled_only = texture(1, 0, A8, D3D9_POOL_DEFAULT);
    TEST_ASSERT_EQUAL_INT32(OK,
                            d3d9_device_create_offscreen_plain_surface(device, 16, 16, A8, 0, &plain, NULL));
    TEST_ASSERT_EQUAL_INT32(OK,
                            d3d9_device_stretch_rect(device, sampled_only->part[0], NULL, target, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_stretch_rect(device, plain, NULL, target, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID,
                            d3d9_device_stretch_rect(device, target, NULL, sampled_only->part[0], NULL, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_stretch_rect(device, target, NULL, plain, NULL, 0));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_color_fill(device, sampled_only->part[0], NULL, 1));
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_color_fill(device, plain, NULL, 1));
    release(target);
    release(plain);
    release(sampled_only);
}

static void depth_is_copied_whole(void)
{
    struct d3d9_surface *a, *b;
    const struct d3d9_rect part = {0, 0, 8, 8};
    enum { D24S8 = TRIPTYCH_SURFACE_D24S8, LINEAR = 2 };
    d3d9_device_create_depth_stencil_surface(device, 16, 16, D24S8, 0, 0, false, &a, NULL);
    d3d9_device_create_depth_stencil_surface(device, 16, 16, D24S8, 0, 0, false, &b, NULL);
    TEST_ASSERT_EQUAL_INT32(OK, d3d9_device_stretch_rect(device, a, NULL, b, NULL, LINEAR));
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_stretch_rect(device, a, &part, b, &part, 0));
    device->in_scene = true;
    TEST_ASSERT_EQUAL_INT32(INVALID, d3d9_device_stretch_rect(device, a, NULL, b, NULL, 0));
    device->in_scene = false;
    release(a);
    release(b);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(managed_textures_upload_dirty_boxes_only);
    RUN_TEST(dirty_rectangles_are_checked);
    RUN_TEST(dynamic_textures_have_all_that_was_written);
    RUN_TEST(generated_levels_follow_the_first_one);
    RUN_TEST(update_texture_copies_and_clears_dirty_boxes);
    RUN_TEST(update_texture_converts_formats);
    RUN_TEST(update_surface_checks_rectangles_and_locks);
    RUN_TEST(stretch_rect_scales_between_targets);
    RUN_TEST(only_targets_and_plain_surfaces_are_destinations);
    RUN_TEST(depth_is_copied_whole);
    return UNITY_END();
}
