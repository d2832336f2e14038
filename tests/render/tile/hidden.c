/* Skipping hidden work changes no pixel. The tests compare the functions with their definitions, and scenes
 * of large triangles with the same scenes cut into strips. The strips are so narrow that no triangle covers a
 * tile. */
#include "render/tile/hidden.h"

#include "base/random.h"
#include "render/device/device.h"
#include "emu/emulate/emulate.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <string.h>
#include <unity.h>

enum { WIDTH = 200, HEIGHT = 160, STRIP = 32, SCENES = 150, DRAWS = 14 };

static struct random source;

void setUp(void)
{
    source = random_start(test_seed(), 0);
}

void tearDown(void)
{
}

static uint32_t below(uint32_t bound)
{
    return random_below(&source, bound);
}

static float between(float low, float high)
{
    return low + (high - low) * (float)below(1 << 20) / (float)(1 << 20);
}

/* --- Depths --- */

static float depth_at(const struct triangle_head *head, const struct plane *plane, int x, int y)
{
    float dx = (float)x + 0.5f - head->origin_x, dy = (float)y + 0.5f - head->origin_y;
    float depth = fmaf(dx, plane->dx, fmaf(dy, plane->dy, plane->value));
    depth = depth > 0 ? depth : 0;
    return depth < 1 ? depth : 1;
}

static struct depth_range depths(const struct triangle_head *head, const struct plane *plane,
                                 const struct rectangle *area, enum triptych_depth_format format)
{
    return hidden_is_level(plane) ? hidden_level_depths(plane, format)
                                  : hidden_depths(head, plane, area, format);
}

static void check_plane(const struct triangle_head *head, const struct plane *plane,
                        enum triptych_depth_format format)
{
    int x0 = (int)below(1000), y0 = (int)below(1000);
    struct rectangle area = {x0, y0, x0 + 1 + (int)below(64), y0 + 1 + (int)below(64)};
    struct depth_range range = depths(head, plane, &area, format);
    for (int y = area.y0; y < area.y1; y++)
        for (int x = area.x0; x < area.x1; x++) {
            uint32_t word = depth_encode(format, depth_at(head, plane, x, y));
            if (word < range.least || word > range.most)
                TEST_FAIL_MESSAGE("a pixel's depth is outside of the range of the triangle");
        }
}

static void every_pixels_depth_lies_in_the_range(void)
{
    static const float slopes[] = {0, 1e-6f, 1e-3f, 0.1f, 50, 1e-12f};
    for (unsigned i = 0; i < test_share_of(3000, 10); i++) {
        struct triangle_head head = {.origin_x = between(-4000, 4000), .origin_y = between(-4000, 4000)};
        float across = slopes[below(6)], down = slopes[below(6)];
        struct plane plane = {.dx = between(-across, across), .dy = between(-down, down)};
        plane.value =
            between(-0.5f, 1.5f) - plane.dx * (500 - head.origin_x) - plane.dy * (500 - head.origin_y);
        check_plane(&head, &plane, (enum triptych_depth_format)below(TRIPTYCH_DEPTH_NONE));
    }
}

static void a_level_plane_has_one_depth(void)
{
    static const float values[] = {0, -0.0f, 0.25f, 0.99999994f, 1, -3, 7, 1e30f};
    const struct triangle_head head = {.origin_x = 3.5f, .origin_y = -70};
    for (unsigned i = 0; i < sizeof values / sizeof *values; i++)
        for (int format = 0; format < TRIPTYCH_DEPTH_NONE; format++) {
            const struct plane plane = {values[i], 0, -0.0f};
            struct depth_range range = hidden_level_depths(&plane, (enum triptych_depth_format)format);
            TEST_ASSERT_TRUE(hidden_is_level(&plane));
            TEST_ASSERT_EQUAL_HEX32(range.least, range.most);
            TEST_ASSERT_EQUAL_HEX32(
                depth_encode((enum triptych_depth_format)format, depth_at(&head, &plane, 9, 41)),
                range.least);
        }
    TEST_ASSERT_FALSE(hidden_is_level(&(struct plane){0.5f, 0, 1e-30f}));
    TEST_ASSERT_FALSE(hidden_is_level(&(struct plane){0.5f, 1e-30f, 0}));
}

static void a_depth_that_is_not_a_number_may_be_anything(void)
{
    const struct triangle_head head = {.origin_x = 5};
    const struct rectangle area = {0, 0, 64, 64};
    const struct plane planes[] = {{NAN, 0, 0}, {0, NAN, 0}, {0.5f, 0, INFINITY}, {INFINITY, 0, 0}};
    for (int i = 0; i < 4; i++) {
        struct depth_range range = depths(&head, &planes[i], &area, TRIPTYCH_DEPTH_D24S8);
        TEST_ASSERT_FALSE(hidden_is_level(&planes[i]));
        TEST_ASSERT_EQUAL_HEX32(0, range.least);
        TEST_ASSERT_EQUAL_HEX32(0xffffff00, range.most);
    }
}

static bool passes(int function, uint32_t new, uint32_t stored)
{
    switch (function) {
    case COMPARE_NEVER: return false;
    case COMPARE_LESS: return new < stored;
    case COMPARE_EQUAL: return new == stored;
    case COMPARE_LESS_EQUAL: return new <= stored;
    case COMPARE_GREATER: return new > stored;
    case COMPARE_NOT_EQUAL: return new != stored;
    case COMPARE_GREATER_EQUAL: return new >= stored;
    default: return true;
    }
}

static bool in_range(struct depth_range range, uint32_t word)
{
    return word >= range.least && word <= range.most;
}

/* Checks all ranges from 0 to 4, with all words in them. */
static void check_ranges(int function, struct depth_range new, struct depth_range stored)
{
    enum depth_verdict verdict = hidden_verdict(function, new, stored);
    struct depth_range widened = hidden_widened(function, stored, new);
    struct depth_range narrowed = hidden_narrowed(function, stored, new);
    unsigned passed = 0, all = 0;
    for (uint32_t n = new.least; n <= new.most; n++)
        for (uint32_t s = stored.least; s <= stored.most; s++) {
            bool pass = passes(function, n, s);
            TEST_ASSERT_TRUE(in_range(widened, s) && in_range(widened, pass ? n : s));
            TEST_ASSERT_TRUE(in_range(narrowed, pass ? n : s));
            passed += pass;
            all++;
        }
    TEST_ASSERT_EQUAL_INT(passed == all ? DEPTH_PASSES : passed ? DEPTH_UNDECIDED : DEPTH_FAILS, verdict);
}

static void verdicts_and_ranges_are_those_of_every_pair_of_depths(void)
{
    enum { DEPTHS = 5 };
    for (int function = 0; function < COMPARE_COUNT; function++)
        for (uint32_t i = 0; i < DEPTHS * DEPTHS * DEPTHS * DEPTHS; i++) {
            struct depth_range new = {i % DEPTHS, i / DEPTHS % DEPTHS};
            struct depth_range stored = {i / (DEPTHS * DEPTHS) % DEPTHS, i / (DEPTHS * DEPTHS * DEPTHS)};
            if (new.least <= new.most && stored.least <= stored.most)
                check_ranges(function, new, stored);
        }
}

/* --- Scenes --- */

struct vertex {
    float position[4];
    uint32_t color;
};

/* One device draws normally, one draws everything in strips. */
static triptych_device *device[2];
static triptych_query *query[2];

#define OK(which, call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device[which]))
#define BOTH(call)                                                                                           \
    for (int which = 0; which < 2; which++)                                                                  \
    OK(which, call)

static void open_devices(enum triptych_depth_format format)
{
    struct triptych_target_description target = {
        .width = WIDTH, .height = HEIGHT, .depth_format = format, .samples = 1};
    target.color_format[1] = below(4) ? (enum triptych_surface_format)0 : TRIPTYCH_SURFACE_A8R8G8B8;
    for (int i = 0; i < 2; i++) {
        const struct device_options options = {.threads = 1 + (unsigned)i};
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(&engine_emulate, &options, &device[i], NULL));
    }
    BOTH(triptych_set_target_description(device[which], &target));
    BOTH(triptych_set_state(device[which], TRIPTYCH_STATE_LIGHTING, 0));
    BOTH(triptych_set_state(device[which], TRIPTYCH_STATE_CULLMODE, 1));
    BOTH(triptych_set_state(device[which], TRIPTYCH_STATE_SCISSORTESTENABLE, 1));
    BOTH(triptych_query_create(device[which], TRIPTYCH_QUERY_OCCLUSION, &query[which]));
}

static void close_devices(void)
{
    for (int i = 0; i < 2; i++)
        triptych_device_destroy(device[i]);
}

static void set(enum triptych_state state, uint32_t value)
{
    BOTH(triptych_set_state(device[which], state, value));
}

/* Sets random states on which skipping depends. Most of them allow it. */
static void set_states(bool stencil)
{
    set(TRIPTYCH_STATE_ZENABLE, below(4) > 0);
    set(TRIPTYCH_STATE_ZFUNC, 1 + (below(2) ? 1 + 2 * below(2) : below(8)));
    set(TRIPTYCH_STATE_ZWRITEENABLE, below(3) > 0);
    set(TRIPTYCH_STATE_SHADEMODE, 1 + (below(3) == 0));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, below(5) == 0);
    set(TRIPTYCH_STATE_DESTBLEND, 2);
    set(TRIPTYCH_STATE_LOGICOP, below(8) ? TRIPTYCH_LOGICOP_NONE : below(17));
    set(TRIPTYCH_STATE_COLORWRITEENABLE, below(6) ? 15 : below(16));
    set(TRIPTYCH_STATE_COLORWRITEENABLE1, 15 * below(2));
    set(TRIPTYCH_STATE_ALPHATESTENABLE, below(6) == 0);
    set(TRIPTYCH_STATE_ALPHAFUNC, 5);
    set(TRIPTYCH_STATE_ALPHAREF, 128);
    if (stencil) {
        set(TRIPTYCH_STATE_STENCILENABLE, below(6) == 0);
        set(TRIPTYCH_STATE_STENCILPASS, 1 + below(8));
    }
}

static struct triptych_rectangle random_area(void)
{
    struct triptych_rectangle r = {below(3) * 64, below(2) * 64, 64 * (1 + below(3)), 64 * (1 + below(3))};
    if (below(3) == 0)
        r = (struct triptych_rectangle){below(WIDTH - 1), below(HEIGHT - 1), 1 + below(WIDTH),
                                        1 + below(HEIGHT)};
    r.width = r.x + r.width > WIDTH ? WIDTH - r.x : r.width;
    r.height = r.y + r.height > HEIGHT ? HEIGHT - r.y : r.height;
    return r;
}

/* Binds a triangle that is larger than the target. Its depth is one of a few values, or a slope. */
static void bind_triangle(void)
{
    float z[3];
    uint32_t color = below(1 << 24) << 8 | below(256);
    z[0] = z[1] = z[2] = (float)below(9) / 8;
    for (int i = 0; below(3) == 0 && i < 3; i++)
        z[i] = between(-0.2f, 1.2f);
    const struct vertex vertex[3] = {
        {{-1, 5, z[0], 1}, color}, {{5, -1, z[1], 1}, below(2) ? color : ~color}, {{-1, -1, z[2], 1}, color}};
    for (int i = 0; i < 2; i++) {
        triptych_buffer *buffer;
        OK(i, triptych_buffer_create(device[i], vertex, sizeof vertex, &buffer));
        struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof(struct vertex)};
        struct triptych_element diffuse = {TRIPTYCH_FORMAT_COLOR, buffer, 16, sizeof(struct vertex)};
        OK(i, triptych_set_element(device[i], TRIPTYCH_POSITION, &position));
        OK(i, triptych_set_element(device[i], TRIPTYCH_DIFFUSE, &diffuse));
    }
}

typedef void action(int which);

/* Acts on the first device for the whole area, and on the second strip by strip. */
static void act(const struct triptych_rectangle *area, action *does)
{
    OK(0, triptych_set_scissor(device[0], area->x, area->y, area->width, area->height));
    does(0);
    for (unsigned x = area->x / STRIP * STRIP; x < area->x + area->width; x += STRIP) {
        unsigned first = x < area->x ? area->x : x, end = x + STRIP;
        end = end > area->x + area->width ? area->x + area->width : end;
        OK(1, triptych_set_scissor(device[1], first, area->y, end - first, area->height));
        does(1);
    }
}

static void draw(int which)
{
    OK(which, triptych_draw(device[which], TRIPTYCH_TRIANGLE_LIST, 0, 1));
}

static unsigned clear_flags;
static float clear_depth;

static void clear(int which)
{
    static const float color[4] = {0.25f, 0.5f, 0.75f, 1};
    OK(which, triptych_clear_buffers(device[which], clear_flags, color, clear_depth, 3));
}

static void expect_equal_pixels(void)
{
    static uint32_t color[2][2][WIDTH * HEIGHT];
    static float depth[2][WIDTH * HEIGHT];
    static uint8_t stencil[2][WIDTH * HEIGHT];
    uint64_t counted[2];
    for (int i = 0; i < 2; i++) {
        OK(i, triptych_read_target(device[i], 0, color[i][0], sizeof color[i][0]));
        if (device_target(device[i])->colors[1].format)
            OK(i, triptych_read_target(device[i], 1, color[i][1], sizeof color[i][1]));
        OK(i, triptych_read_depth(device[i], depth[i], sizeof depth[i]));
        if (depth_formats[device_target(device[i])->depth_format].stencil_bits)
            OK(i, triptych_read_stencil(device[i], stencil[i], sizeof stencil[i]));
        OK(i, triptych_query_result(device[i], query[i], &counted[i]));
    }
    TEST_ASSERT_EQUAL_MEMORY(color[0], color[1], sizeof color[0]);
    TEST_ASSERT_EQUAL_MEMORY(depth[0], depth[1], sizeof depth[0]);
    TEST_ASSERT_EQUAL_MEMORY(stencil[0], stencil[1], sizeof stencil[0]);
    TEST_ASSERT_EQUAL_UINT64(counted[0], counted[1]);
}

static void draw_scene(bool stencil)
{
    unsigned asked = below(2) ? below(DRAWS) : DRAWS;
    for (unsigned i = 0; i < DRAWS; i++) {
        struct triptych_rectangle area = random_area();
        if (i == asked)
            BOTH(triptych_query_begin(device[which], query[which]));
        if (below(6) == 0) {
            clear_flags = 1 + below(stencil ? 7 : 3);
            clear_depth = (float)below(5) / 4;
            act(&area, clear);
        } else {
            set_states(stencil);
            bind_triangle();
            act(&area, draw);
        }
        if (below(8) == 0)
            BOTH(triptych_finish(device[which]));
    }
    if (asked == DRAWS)
        BOTH(triptych_query_begin(device[which], query[which]));
    BOTH(triptych_query_end(device[which], query[which]));
    expect_equal_pixels();
}

static void large_triangles_draw_what_strips_of_them_draw(void)
{
    static const enum triptych_depth_format formats[] = {TRIPTYCH_DEPTH_D32F_LOCKABLE, TRIPTYCH_DEPTH_D16,
                                                         TRIPTYCH_DEPTH_D24S8,         TRIPTYCH_DEPTH_D24X8,
                                                         TRIPTYCH_DEPTH_D24FS8,        TRIPTYCH_DEPTH_D32};
    for (unsigned i = 0; i < test_share_of(SCENES, 5); i++) {
        enum triptych_depth_format format = formats[i % 6];
        open_devices(format);
        draw_scene(depth_formats[format].stencil_bits);
        close_devices();
    }
}

/* --- Skipped pixels --- */

static uint64_t pixels_shaded(void)
{
    struct triptych_statistics statistics;
    device_get_statistics(device[0], &statistics);
    return statistics.pixels_shaded;
}

static void fill(float z)
{
    const struct vertex vertex[3] = {{{-1, 5, z, 1}, 1}, {{5, -1, z, 1}, 2}, {{-1, -1, z, 1}, 3}};
    triptych_buffer *buffer;
    OK(0, triptych_buffer_create(device[0], vertex, sizeof vertex, &buffer));
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof(struct vertex)};
    struct triptych_element diffuse = {TRIPTYCH_FORMAT_COLOR, buffer, 16, sizeof(struct vertex)};
    OK(0, triptych_set_element(device[0], TRIPTYCH_POSITION, &position));
    OK(0, triptych_set_element(device[0], TRIPTYCH_DIFFUSE, &diffuse));
    OK(0, triptych_draw(device[0], TRIPTYCH_TRIANGLE_LIST, 0, 1));
    OK(0, triptych_finish(device[0]));
}

/* Opens a device with a target of 3 x 2 whole tiles. */
static void open_tiles(void)
{
    const struct device_options options = {.threads = 1};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(&engine_emulate, &options, &device[0], NULL));
    OK(0, triptych_set_target(device[0], 192, 128));
    OK(0, triptych_set_state(device[0], TRIPTYCH_STATE_LIGHTING, 0));
    OK(0, triptych_set_state(device[0], TRIPTYCH_STATE_CULLMODE, 1));
}

static void hidden_tiles_are_not_shaded(void)
{
    open_tiles();
    fill(0.5f);
    uint64_t before = pixels_shaded();
    TEST_ASSERT_EQUAL_UINT64(192 * 128, before);
    fill(0.75f);
    TEST_ASSERT_EQUAL_UINT64(before, pixels_shaded());
    fill(0.25f);
    TEST_ASSERT_EQUAL_UINT64(2 * before, pixels_shaded());
    triptych_device_destroy(device[0]);
}

static void uniform_tiles_shade_one_block(void)
{
    open_tiles();
    OK(0, triptych_set_state(device[0], TRIPTYCH_STATE_SHADEMODE, 1));
    fill(0.5f);
    TEST_ASSERT_EQUAL_UINT64(6 * 16, pixels_shaded());
    triptych_device_destroy(device[0]);
}

static void overwritten_pixels_are_not_shaded(void)
{
    open_tiles();
    OK(0, triptych_set_state(device[0], TRIPTYCH_STATE_ZENABLE, 0));
    const struct vertex vertex[3] = {{{-1, 5, 0, 1}, 1}, {{5, -1, 0, 1}, 2}, {{-1, -1, 0, 1}, 3}};
    triptych_buffer *buffer;
    OK(0, triptych_buffer_create(device[0], vertex, sizeof vertex, &buffer));
    struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT4, buffer, 0, sizeof(struct vertex)};
    struct triptych_element diffuse = {TRIPTYCH_FORMAT_COLOR, buffer, 16, sizeof(struct vertex)};
    OK(0, triptych_set_element(device[0], TRIPTYCH_POSITION, &position));
    OK(0, triptych_set_element(device[0], TRIPTYCH_DIFFUSE, &diffuse));
    for (int i = 0; i < 5; i++)
        OK(0, triptych_draw(device[0], TRIPTYCH_TRIANGLE_LIST, 0, 1));
    OK(0, triptych_finish(device[0]));
    TEST_ASSERT_EQUAL_UINT64(192 * 128, pixels_shaded());
    triptych_device_destroy(device[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_pixels_depth_lies_in_the_range);
    RUN_TEST(a_level_plane_has_one_depth);
    RUN_TEST(a_depth_that_is_not_a_number_may_be_anything);
    RUN_TEST(verdicts_and_ranges_are_those_of_every_pair_of_depths);
    RUN_TEST(large_triangles_draw_what_strips_of_them_draw);
    RUN_TEST(hidden_tiles_are_not_shaded);
    RUN_TEST(uniform_tiles_shade_one_block);
    RUN_TEST(overwritten_pixels_are_not_shaded);
    return UNITY_END();
}
