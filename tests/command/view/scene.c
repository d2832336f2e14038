/* The scene of the viewer: a stream drawn up to any draw, with a camera, and read again; and text in its
 * pictures. */
#include "base/file.h"
#include "command/view/font.h"
#include "command/view/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

enum { SIDE = 16, PIXELS = SIDE * SIDE };

static const char blue_then_red[] =
    "triptych 1\ntarget 16 16\n"
    "vertices v position:float3 diffuse:color {\n"
    "-1 -1 0.5 ff0000ff\n-1 1 0.5 ff0000ff\n1 -1 0.5 ff0000ff\n1 1 0.5 ff0000ff\n"
    "-1 -1 0.2 ffff0000\n-1 1 0.2 ffff0000\n1 -1 0.2 ffff0000\n1 1 0.2 ffff0000\n"
    "}\nstate lighting false\nbind vertices v\ntransform view translate 0 0 0.1\n"
    "clear color 0 1 0 1 depth 1\ndraw strip 0 2\ndraw strip 4 1\n";

static struct error error;
static struct scene *scene;
static char path[64];
static struct scene_choice choice;

static void write_stream(const char *text)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_write(path, text, strlen(text), &error), error.text);
}

void setUp(void)
{
    error_clear(&error);
    snprintf(path, sizeof path, "/tmp/triptych-scene-%ld.tri", (long)getpid());
    write_stream(blue_then_red);
    scene = scene_open(path, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(scene, error.text);
    choice = (struct scene_choice){.threads = 1, .draw = SCENE_ALL};
}

void tearDown(void)
{
    scene_close(scene);
    remove(path);
}

static const uint32_t *drawn(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, scene_draw(scene, &choice, &error), error.text);
    TEST_ASSERT_EQUAL_UINT(SIDE, scene_picture(scene)->width);
    return scene_picture(scene)->color;
}

static unsigned count_of(uint32_t color)
{
    const uint32_t *picture = drawn();
    unsigned count = 0;
    for (int i = 0; i < PIXELS; i++)
        count += picture[i] == color;
    return count;
}

static void a_frame_is_drawn_up_to_any_draw(void)
{
    TEST_ASSERT_EQUAL_UINT32(2, scene_draws(scene, 0));
    unsigned red = count_of(0xff0000ff);
    TEST_ASSERT_TRUE(red > PIXELS / 4 && red < PIXELS);
    choice.draw = 0;
    TEST_ASSERT_EQUAL_UINT(PIXELS, count_of(0xffff0000));
    choice.draw = 1;
    TEST_ASSERT_EQUAL_UINT(red, count_of(0xff0000ff));
}

static void another_engine_draws_the_same(void)
{
    uint32_t first[PIXELS];
    memcpy(first, drawn(), sizeof first);
    for (choice.engine = 1; triptych_engine_name(choice.engine); choice.engine++)
        if (!strcmp(triptych_engine_name(choice.engine), "batch") ||
            !strcmp(triptych_engine_name(choice.engine), "specialize"))
            if (!triptych_engine_unavailable(choice.engine))
                TEST_ASSERT_EQUAL_MEMORY(first, drawn(), sizeof first);
}

static void the_camera_turns_and_returns(void)
{
    unsigned red = count_of(0xff0000ff);
    TEST_ASSERT_TRUE(scene_has_camera(scene));
    choice.camera.yaw = 0.7f;
    TEST_ASSERT_TRUE(count_of(0xff0000ff) != red);
    choice.camera = (struct camera){0};
    TEST_ASSERT_EQUAL_UINT(red, count_of(0xff0000ff));
}

static void each_pixel_has_a_count_and_an_owner(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, scene_analyse(scene, &choice, &error), error.text);
    const struct scene_analysis *analysis = scene_analysis(scene);
    TEST_ASSERT_EQUAL_UINT(SIDE, analysis->width);
    for (int i = 0; i < PIXELS; i++) {
        TEST_ASSERT_TRUE(analysis->count[i] == 1 || analysis->count[i] == 2);
        TEST_ASSERT_EQUAL_UINT32(analysis->count[i], analysis->owner[i].draw);
    }
}

static void a_changed_stream_is_noticed_once_and_read_again(void)
{
    TEST_ASSERT_FALSE(scene_has_changed(scene));
    write_stream("triptych 1\ntarget 16 16\nclear color 0 0 1 1\n");
    TEST_ASSERT_TRUE(scene_has_changed(scene));
    TEST_ASSERT_FALSE(scene_has_changed(scene));
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, scene_reload(scene, &error), error.text);
    TEST_ASSERT_EQUAL_UINT(PIXELS, count_of(0xffff0000));
    TEST_ASSERT_FALSE(scene_has_camera(scene));
}

static void a_wrong_stream_leaves_the_scene(void)
{
    unsigned red = count_of(0xff0000ff);
    write_stream("triptych 1\ntarget 16 16\ndrow strip 0 2\n");
    TEST_ASSERT_EQUAL_INT(-1, scene_reload(scene, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, ":3:1: "), error.text);
    TEST_ASSERT_EQUAL_UINT(red, count_of(0xff0000ff));
}

static void text_stays_within_the_picture(void)
{
    uint32_t color[PIXELS + 2] = {0};
    const struct font_picture picture = {SIDE, SIDE, color + 1};
    font_draw(&picture, 1, 1, 1, 0xffffffff, "I");
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, color[1 + 2 * SIDE + 3]); /* the letter's first row */
    font_draw(&picture, -3, -5, 2, 0xffffffff, "wide \x80 text");
    font_draw(&picture, 10, 12, 3, 0xffffffff, "wide");
    TEST_ASSERT_EQUAL_HEX32(0, color[0]);
    TEST_ASSERT_EQUAL_HEX32(0, color[PIXELS + 1]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_frame_is_drawn_up_to_any_draw);
    RUN_TEST(another_engine_draws_the_same);
    RUN_TEST(the_camera_turns_and_returns);
    RUN_TEST(each_pixel_has_a_count_and_an_owner);
    RUN_TEST(a_changed_stream_is_noticed_once_and_read_again);
    RUN_TEST(a_wrong_stream_leaves_the_scene);
    RUN_TEST(text_stays_within_the_picture);
    return UNITY_END();
}
