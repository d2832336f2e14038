/* The history of a pixel: it ends with the pixel of the picture, each step begins with the result of the step
 * before, and each test has its word. */
#include "base/bits.h"
#include "command/fuzz/case/case.h"
#include "command/inspect/trail.h"
#include "tests/support/system/seed.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

static struct error error;
static struct stream *stream;
static struct trail trail;

void setUp(void)
{
    error_clear(&error);
    stream = NULL;
    memset(&trail, 0, sizeof trail);
}

void tearDown(void)
{
    trail_close(&trail);
    stream_free(stream);
}

static void open_at(const struct trail_options *options)
{
    trail_close(&trail);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, trail_open(&trail, stream, options, &error), error.text);
}

static const struct trail_canvas *canvas(void)
{
    return trail.canvas + trail.draw[trail.draws - 1].canvas;
}

/* --- Agreement with pictures ---------------------------------------------------------------------------- */

static void start_with(const char *engine, triptych_device **device, struct player **player)
{
    const struct triptych_options options = {.engine = engine, .threads = 1};
    char reason[256];
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, triptych_device_create(&options, device, reason, sizeof reason), reason);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_prepare(&trail.view, *device, player, &error), error.text);
}

/* The words of the pixel after another engine has played the same calls. */
static void play_with(const char *engine, struct pixel_words *words)
{
    triptych_device *device;
    struct player *player;
    start_with(engine, &device, &player);
    for (uint32_t i = 1; i < trail.view.frame_count; i++)
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, player_frame(player, i, &error), error.text);
    pixel_read(device_target(device), (uint32_t)trail.options.x, (uint32_t)trail.options.y, words);
    player_free(player);
    triptych_device_destroy(device);
}

/* The pixels that the device has shaded up to now. */
static uint64_t shaded_by(triptych_device *device)
{
    struct triptych_statistics statistics;
    triptych_finish(device);
    triptych_get_statistics(device, &statistics);
    return statistics.pixels_shaded;
}

/* Each draw covers at least the pixels that another engine shades, which leaves out hidden ones and draws
 * that cannot change the target. So a frame without a history is one in which nothing is shaded. */
static void check_counts(const char *path)
{
    triptych_device *device;
    struct player *player;
    uint32_t draws = 0;
    start_with("specialize", &device, &player);
    for (uint32_t i = 1; i < trail.view.frame_count; i++) {
        uint64_t before = shaded_by(device);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, player_frame(player, i, &error), error.text);
        if (draws == trail.draws || trail.draw[draws].position + 1 != trail.view.frames[i + 1])
            continue;
        uint64_t shaded = shaded_by(device) - before;
        TEST_ASSERT_LESS_OR_EQUAL_UINT64_MESSAGE(trail.draw[draws].counts.covered, shaded, path);
        draws++;
    }
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(trail.draws, draws, path);
    player_free(player);
    triptych_device_destroy(device);
}

/* Each primitive begins with the words that the one before has left, and one that does not pass changes no
 * colour. */
static void check_event(const struct trail_event *event)
{
    struct pixel_words now = event->before;
    for (uint32_t i = 0; i < event->touches; i++) {
        const struct touch *touch = trail.touch + event->touch + i;
        if (touch->kind != TOUCH_DRAWN)
            continue;
        TEST_ASSERT_EQUAL_MEMORY(&now, &touch->before, sizeof now);
        now = touch->after;
    }
    if (event->draw != TRAIL_LAST)
        TEST_ASSERT_EQUAL_MEMORY(&now, &event->after, sizeof now);
}

static void check_history(const char *path)
{
    static const char *const engines[] = {"emulate", "specialize"};
    struct pixel_words last = {0}, words;
    bool begun = false;
    for (uint32_t i = 0; i < trail.events; i++) {
        const struct trail_event *event = trail.event + i;
        if (trail.canvas + event->canvas != canvas())
            continue;
        if (begun)
            TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&last, &event->before, sizeof last, path);
        check_event(event);
        last = event->after;
        begun = true;
    }
    if (!begun)
        last = canvas()->last;
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&canvas()->last, &last, sizeof last, path);
    for (size_t i = 0; i < sizeof engines / sizeof *engines; i++) {
        play_with(engines[i], &words);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&words, &last, sizeof last, path);
    }
}

/* The first pixel that is touched most often. */
static void find_pixel(struct trail_options *options)
{
    const uint32_t *count = canvas()->count;
    size_t best = 0;
    for (size_t i = 0; i < (size_t)canvas()->width * canvas()->height; i++)
        if (count[i] > count[best])
            best = i;
    options->x = (int32_t)(best % canvas()->width);
    options->y = (int32_t)(best / canvas()->width);
}

/* Of the last frame that draws, at the pixels that are covered and that pass most often; with words of
 * targets in tiles or in rows. Returns false if nothing is covered. */
static bool check_last_frame(const char *name, bool rows)
{
    struct trail_options options = {
        .frame = stream->frame_count, .draw = TRAIL_LAST, .x = -1, .counts = true};
    if (rows)
        options.settings.of[SETTING_target] = SETTING_target_rows;
    do {
        trail_close(&trail);
        if (!options.frame--)
            return false;
    } while (trail_open(&trail, stream, &options, &error));
    for (int what = WATCH_COVERED; what <= WATCH_PASSED; what += WATCH_PASSED) {
        struct trail_options at = options;
        options.what = (enum watch_what)what;
        open_at(&options);
        find_pixel(&at);
        if (what == WATCH_COVERED)
            check_counts(name);
        if (what == WATCH_COVERED && !canvas()->count[(size_t)at.y * canvas()->width + (size_t)at.x])
            return false;
        open_at(&at);
        check_history(name);
    }
    return true;
}

static void check_stream(const char *path, bool rows)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_read(path, &stream, &error), error.text);
    TEST_ASSERT_TRUE_MESSAGE(check_last_frame(path, rows), path);
    trail_close(&trail);
    stream_free(stream);
    stream = NULL;
}

static void the_last_value_of_a_history_is_the_pixel_of_the_picture(void)
{
    static const char *const names[] = {"alpha-functions",
                                        "alpha-to-coverage",
                                        "blend-factors",
                                        "blend-operations",
                                        "clip-planes",
                                        "cull-and-shade",
                                        "depth-formats",
                                        "depth-functions",
                                        "dither",
                                        "fill-modes",
                                        "frames",
                                        "lines",
                                        "multisampling",
                                        "opengl",
                                        "opengl-conventions",
                                        "opengl-states",
                                        "points",
                                        "queries",
                                        "render-to-texture",
                                        "scissors",
                                        "shaders",
                                        "stencil-operations",
                                        "stencil-shadow",
                                        "target-formats",
                                        "targets",
                                        "texture-stages",
                                        "viewports",
                                        "window-origin",
                                        "write-masks"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i += test_stride_of(7)) {
        char path[96];
        snprintf(path, sizeof path, "tests/data/streams/%s.tri", names[i]);
        check_stream(path, i & 1);
    }
}

/* Returns true if the case has a history. */
static bool check_case(uint64_t seed)
{
    struct random random = random_start(test_seed(), seed);
    struct text text = {0};
    bool checked = false;
    char name[32];
    snprintf(name, sizeof name, "case %u", (unsigned)seed);
    case_write(&random, &text);
    error_clear(&error);
    if (!stream_parse(name, text.data, text.length, &stream, &error))
        checked = check_last_frame(name, seed & 1);
    trail_close(&trail);
    stream_free(stream);
    stream = NULL;
    text_free(&text);
    return checked;
}

/* About two of five cases cover nothing in their last frame. */
static void histories_of_random_streams_agree_with_pictures(void)
{
    unsigned histories = test_share(16), checked = 0;
    for (uint64_t seed = 1; seed <= 8 * histories && checked < histories; seed++)
        checked += check_case(seed);
    TEST_ASSERT_EQUAL_UINT(histories, checked);
}

/* --- Each test ------------------------------------------------------------------------------------------ */

/* Squares of two triangles each at depths 0.5, 0.25 and 0.75. The alpha of the second is 0x40. */
static const char begin[] = "triptych 1\n"
                            "target 16 16 depth d24s8\n"
                            "vertices v position:float3 diffuse:color {\n"
                            "-1 -1 0.5 ff0000ff\n-1 1 0.5 ff0000ff\n1 -1 0.5 ff0000ff\n1 1 0.5 ff0000ff\n"
                            "-1 -1 0.25 40ff0000\n-1 1 0.25 40ff0000\n1 -1 0.25 40ff0000\n1 1 0.25 40ff0000\n"
                            "-1 -1 0.75 ffffffff\n-1 1 0.75 ffffffff\n1 -1 0.75 ffffffff\n1 1 0.75 ffffffff\n"
                            "}\n"
                            "state lighting false\nbind vertices v\nclear color 0 0 0 0 depth 1 stencil 3\n"
                            "draw strip 0 2\n";

static void load(const char *rest)
{
    char text[4096];
    snprintf(text, sizeof text, "%s%s", begin, rest);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("h.tri", text, strlen(text), &stream, &error), error.text);
    open_at(&(struct trail_options){.draw = TRAIL_LAST, .x = 4, .y = 8});
}

/* The only primitive of the last event. */
static const struct touch *last_touch(void)
{
    const struct trail_event *event = trail.event + trail.events - 1;
    TEST_ASSERT_EQUAL_UINT32(trail.draws - 1, event->draw);
    TEST_ASSERT_EQUAL_UINT32(1, event->touches);
    return trail.touch + event->touch;
}

static bool seen(const struct touch *touch, enum observed name)
{
    return touch->seen[name] & 1;
}

static bool passes(const struct touch *touch, enum observed name)
{
    return touch->value[name][0][0];
}

static void a_clear_and_a_draw_are_events(void)
{
    load("");
    TEST_ASSERT_EQUAL_UINT32(2, trail.events);
    TEST_ASSERT_EQUAL_UINT32(TRAIL_LAST, trail.event[0].draw);
    TEST_ASSERT_EQUAL_HEX32(0xffffff03, trail.event[0].after.depth[0]);
    TEST_ASSERT_EQUAL_UINT32(0, trail.event[1].draw);
    TEST_ASSERT_EQUAL_HEX32(0xffff0000, last_touch()->after.color[0][0]);
    TEST_ASSERT_EQUAL_UINT32(0, last_touch()->primitive);
}

static void the_primitive_of_the_pixel_has_its_number_and_vertices(void)
{
    load("");
    trail_close(&trail);
    open_at(&(struct trail_options){.draw = TRAIL_LAST, .x = 12, .y = 15});
    TEST_ASSERT_EQUAL_UINT32(0, last_touch()->primitive);
    open_at(&(struct trail_options){.draw = TRAIL_LAST, .x = 12, .y = 1});
    TEST_ASSERT_EQUAL_UINT32(1, last_touch()->primitive);
    TEST_ASSERT_EQUAL_UINT32(3, last_touch()->vertices);
    TEST_ASSERT_EQUAL_UINT32(1, last_touch()->vertex[0]);
}

static void a_failed_depth_test_leaves_the_pixel(void)
{
    load("draw strip 8 2\n");
    TEST_ASSERT_TRUE(seen(last_touch(), OBSERVED_depth));
    TEST_ASSERT_FALSE(passes(last_touch(), OBSERVED_depth));
    TEST_ASSERT_EQUAL_FLOAT(0.75f, bits_to_float(last_touch()->value[OBSERVED_depth_value][0][0]));
    TEST_ASSERT_EQUAL_MEMORY(&last_touch()->before, &last_touch()->after, sizeof(struct pixel_words));
}

static void a_failed_alpha_test_leaves_the_pixel(void)
{
    load("state alphatestenable true\nstate alphafunc greater\nstate alpharef 128\ndraw strip 4 2\n");
    TEST_ASSERT_TRUE(seen(last_touch(), OBSERVED_alpha));
    TEST_ASSERT_FALSE(passes(last_touch(), OBSERVED_alpha));
    TEST_ASSERT_EQUAL_UINT32(0x40, last_touch()->value[OBSERVED_alpha_value][0][0]);
    TEST_ASSERT_EQUAL_MEMORY(&last_touch()->before, &last_touch()->after, sizeof(struct pixel_words));
}

static void a_failed_stencil_test_changes_only_the_stencil(void)
{
    load("state stencilenable true\nstate stencilfunc less\nstate stencilref 3\nstate stencilfail zero\n"
         "draw strip 4 2\n");
    TEST_ASSERT_TRUE(seen(last_touch(), OBSERVED_stencil));
    TEST_ASSERT_FALSE(passes(last_touch(), OBSERVED_stencil));
    TEST_ASSERT_EQUAL_HEX32(last_touch()->before.color[0][0], last_touch()->after.color[0][0]);
    TEST_ASSERT_EQUAL_HEX32(last_touch()->before.depth[0] - 3, last_touch()->after.depth[0]);
}

static void a_blended_pixel_has_the_new_colour_and_the_stored_ones(void)
{
    load("state alphablendenable true\nstate srcblend srcalpha\nstate destblend invsrcalpha\ndraw strip 4 "
         "2\n");
    const uint32_t *color = last_touch()->value[OBSERVED_color][0];
    TEST_ASSERT_EQUAL_HEX32(0x000000ff, color[0]);
    TEST_ASSERT_EQUAL_HEX32(0x00400000, color[1]);
    TEST_ASSERT_EQUAL_HEX32(0xffff0000, last_touch()->before.color[0][0]);
    TEST_ASSERT_EQUAL_HEX32(0xcfbf0040, last_touch()->after.color[0][0]);
}

static void a_culled_primitive_is_named(void)
{
    load("state cullmode cw\ndraw strip 4 2\n");
    TEST_ASSERT_EQUAL_INT(TOUCH_CULLED, last_touch()->kind);
}

static void a_primitive_outside_of_the_scissor_rectangle_is_named(void)
{
    load("state scissortestenable true\nscissor 8 0 8 16\ndraw strip 4 2\n");
    TEST_ASSERT_EQUAL_INT(TOUCH_SCISSORED, last_touch()->kind);
}

static void hidden_primitives_of_a_draw_are_in_the_history(void)
{
    load("bind vertices v\ndraw strip 4 6\n");
    const struct trail_event *event = trail.event + trail.events - 1;
    TEST_ASSERT_EQUAL_UINT32(6, trail.draw[trail.draws - 1].counts.primitives);
    TEST_ASSERT_TRUE(event->touches >= 2);
    for (uint32_t i = 1; i < event->touches; i++)
        TEST_ASSERT_TRUE(trail.touch[event->touch + i].primitive >
                         trail.touch[event->touch + i - 1].primitive);
}

static void every_covered_pixel_is_counted(void)
{
    load("draw strip 8 2\n");
    open_at(&(struct trail_options){.draw = TRAIL_LAST, .x = -1, .counts = true});
    TEST_ASSERT_EQUAL_UINT64(256, trail.draw[0].counts.passed);
    TEST_ASSERT_EQUAL_UINT64(256, trail.draw[1].counts.covered);
    TEST_ASSERT_EQUAL_UINT64(0, trail.draw[1].counts.passed);
    for (size_t i = 0; i < 256; i++)
        TEST_ASSERT_EQUAL_UINT32(2, canvas()->count[i]);
}

static void a_missing_frame_or_draw_is_refused(void)
{
    load("");
    trail_close(&trail);
    TEST_ASSERT_EQUAL_INT(-1,
                          trail_open(&trail, stream, &(struct trail_options){.frame = 1, .x = -1}, &error));
    TEST_ASSERT_EQUAL_STRING("h.tri has no frame 1, its last is 0", error.text);
    trail_close(&trail);
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1,
                          trail_open(&trail, stream, &(struct trail_options){.draw = 1, .x = -1}, &error));
    TEST_ASSERT_EQUAL_STRING("h.tri: frame 0 has no draw 1, it has 1, from 0", error.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_last_value_of_a_history_is_the_pixel_of_the_picture);
    RUN_TEST(histories_of_random_streams_agree_with_pictures);
    RUN_TEST(a_clear_and_a_draw_are_events);
    RUN_TEST(the_primitive_of_the_pixel_has_its_number_and_vertices);
    RUN_TEST(a_failed_depth_test_leaves_the_pixel);
    RUN_TEST(a_failed_alpha_test_leaves_the_pixel);
    RUN_TEST(a_failed_stencil_test_changes_only_the_stencil);
    RUN_TEST(a_blended_pixel_has_the_new_colour_and_the_stored_ones);
    RUN_TEST(a_culled_primitive_is_named);
    RUN_TEST(a_primitive_outside_of_the_scissor_rectangle_is_named);
    RUN_TEST(hidden_primitives_of_a_draw_are_in_the_history);
    RUN_TEST(every_covered_pixel_is_counted);
    RUN_TEST(a_missing_frame_or_draw_is_refused);
    return UNITY_END();
}
