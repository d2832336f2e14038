/* Playing: frames in any order give the pictures that they give in order, resources are created once, and the
 * device receives all that the stream contains. */
#include "command/stream/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { WIDTH = 24, HEIGHT = 16, PIXELS = WIDTH * HEIGHT };

static struct error error;
static triptych_device *device;
static struct stream *stream;
static struct player *player;

static void make_device(void)
{
    static const struct triptych_options options = {.engine = "emulate", .threads = 1};
    char reason[256];
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, triptych_device_create(&options, &device, reason, sizeof reason),
                                  reason);
}

void setUp(void)
{
    error_clear(&error);
    make_device();
}

static void unload(void)
{
    player_free(player);
    stream_free(stream);
    player = NULL;
    stream = NULL;
}

void tearDown(void)
{
    unload();
    triptych_device_destroy(device);
}

static void load(const char *text)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("p.tri", text, strlen(text), &stream, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_prepare(stream, device, &player, &error), error.text);
}

static void play(uint32_t frame, uint32_t picture[PIXELS])
{
    unsigned width, height;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, player_frame(player, frame, &error), error.text);
    triptych_target_size(device, &width, &height);
    TEST_ASSERT_EQUAL_UINT(PIXELS, width * height);
    TEST_ASSERT_EQUAL_INT(0, triptych_read_color(device, picture, PIXELS * sizeof *picture));
}

static int holds(const uint32_t picture[PIXELS], uint32_t color)
{
    int count = 0;
    for (int i = 0; i < PIXELS; i++)
        count += picture[i] == color;
    return count;
}

/* Every frame clears, and depends on the states that all earlier frames set. */
static const char standing[] =
    "triptych 1\n"
    "target 24 16\n"
    "texture t 2 1 { ff808080 ffffffff }\n"
    "vertices v position:float2 diffuse:color texcoord:float2 {\n"
    "-1 -1 ffff0000 0 0\n-1 1 ff00ff00 0 1\n1 1 ff0000ff 1 1\n1 -1 ffffffff 1 0\n}\n"
    "indices i 16 { 0 1 2 0 2 3 }\n"
    "sequence quad\n clear color 0 0 0 1 depth 1\n draw-indexed triangles 0 0 2\nend\n"
    "state lighting false\nbind vertices v\nbind indices i\n"
    "play quad\nframe\n"
    "transform world scale 0.5 0.5 1\nplay quad\nframe\n"
    "bind texture t\nplay quad\nframe\n"
    "state cullmode cw\nplay quad\nframe\n"
    "state cullmode none\nclear color 0 0 1 1\nviewport 4 4 8 8 0 1\nplay quad\nframe\n"
    "target 16 24\nplay quad\n";

static void frames_in_any_order_are_the_frames_in_order(void)
{
    static const uint32_t order[] = {5, 0, 3, 3, 4, 1, 5, 2, 0, 0, 1, 4};
    static uint32_t expected[6][PIXELS], picture[PIXELS];
    load(standing);
    TEST_ASSERT_EQUAL_UINT(6, stream->frame_count);
    for (uint32_t f = 0; f < 6; f++)
        play(f, expected[f]);
    for (uint32_t f = 1; f < 6; f++)
        TEST_ASSERT_TRUE(memcmp(expected[f], expected[f - 1], sizeof expected[f]));
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        play(order[i], picture);
        TEST_ASSERT_EQUAL_HEX32_ARRAY(expected[order[i]], picture, PIXELS);
    }
    TEST_ASSERT_EQUAL_INT(PIXELS, holds(expected[3], 0xff000000)); /* culled */
}

/* Without a clear, a frame draws over the previous picture. A frame that is played by itself starts from an
 * empty target. */
static void earlier_draws_are_left_out_when_one_frame_is_played(void)
{
    static uint32_t picture[PIXELS];
    load("triptych 1\ntarget 24 16\nviewport 0 0 12 16 0 1\nclear color 1 0 0 1\nframe\n"
         "viewport 12 0 12 16 0 1\nclear color 0 1 0 1\nframe\n");
    play(0, picture);
    play(1, picture);
    TEST_ASSERT_EQUAL_INT(PIXELS / 2, holds(picture, 0xff0000ff));
    TEST_ASSERT_EQUAL_INT(PIXELS / 2, holds(picture, 0xff00ff00));
    play(1, picture);
    TEST_ASSERT_EQUAL_INT(PIXELS / 2, holds(picture, 0));
    TEST_ASSERT_EQUAL_INT(PIXELS / 2, holds(picture, 0xff00ff00));
}

/* A target starts empty each time it is set, also when the same frame is played again. */
static void a_replayed_target_is_empty_unless_it_is_cleared_as_a_whole(void)
{
    static uint32_t picture[PIXELS];
    static float depth[PIXELS];
    static const char *const partial[] = {
        "viewport 0 0 12 16 0 1\nclear color 1 0 0 1 depth 0\n",
        "clear color 1 1 1 1\ntarget 24 16\nviewport 0 0 12 16 0 1\nclear color 1 0 0 1 depth 0\n",
        "clear depth 0\nviewport 0 0 12 16 0 1\nclear color 1 0 0 1\nframe\nclear color 1 1 1 1\n",
    };
    for (size_t i = 0; i < sizeof partial / sizeof *partial; i++) {
        char text[256];
        snprintf(text, sizeof text, "triptych 1\ntarget 24 16\n%s", partial[i]);
        load(text);
        for (int round = 0; round < 3; round++) {
            play(0, picture);
            TEST_ASSERT_EQUAL_INT(PIXELS / 2, holds(picture, 0));
            TEST_ASSERT_EQUAL_INT(PIXELS / 2, holds(picture, 0xff0000ff));
            if (stream->frame_count > 1)
                play(1, picture);
        }
        unload();
    }
    load(
        "triptych 1\ntarget 24 16\nstate zfunc less\nclear color 0 0 1 1 depth 0.25\nviewport 1 1 2 2 0 1\n");
    for (int round = 0; round < 3; round++) {
        play(0, picture);
        TEST_ASSERT_EQUAL_INT(PIXELS, holds(picture, 0xffff0000));
        TEST_ASSERT_EQUAL_INT(0, triptych_read_depth(device, depth, sizeof depth));
        for (int p = 0; p < PIXELS; p++)
            TEST_ASSERT_EQUAL_FLOAT(0.25f, depth[p]);
    }
}

/* The state that another stream left on the same device has no effect. */
static void a_stream_starts_from_the_defaults(void)
{
    static uint32_t expected[PIXELS], picture[PIXELS];
    static const float matrix[4][4] = {{.5f}, {0, 2}, {0, 0, 1}, {.1f, 0, 0, 1}};
    static const struct triptych_material material = {.emissive = {0, 1, 0, 1}};
    load(standing);
    play(0, expected);
    unload();
    triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 2);
    triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, 0);
    triptych_set_transform(device, TRIPTYCH_TRANSFORM_VIEW, matrix);
    triptych_set_material(device, &material);
    triptych_enable_light(device, 3, 1);
    load(standing);
    play(0, picture);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(expected, picture, PIXELS);
}

static void a_material_and_lights_start_as_documented(void)
{
    static uint32_t implicit[PIXELS], explicit[PIXELS];
    static const char body[] =
        "target 24 16\nvertices v position:float3 normal:float3 {\n-1 -1 0 0 0 -1\n-1 3 0 0 0 -1\n3 -1 0 0 0 "
        "-1\n}\n"
        "bind vertices v\nclear color 0 0 0 1 depth 1\nlight 0 on\ndraw triangles 0 1\n";
    char text[1024];
    snprintf(text, sizeof text, "triptych 1\n%s", body);
    load(text);
    play(0, implicit);
    unload();
    snprintf(text, sizeof text,
             "triptych 1\nmaterial diffuse 1 1 1 1 ambient 0 0 0 0 emissive 0 0 0 0\n"
             "light 0 directional diffuse 1 1 1 1 ambient 0 0 0 0 direction 0 0 1\n%s",
             body);
    load(text);
    play(0, explicit);
    TEST_ASSERT_EQUAL_INT(PIXELS, holds(implicit, 0xffffffff));
    TEST_ASSERT_EQUAL_HEX32_ARRAY(explicit, implicit, PIXELS);
}

static void elements_in_buffers_draw_what_vertices_draw(void)
{
    static uint32_t expected[PIXELS], picture[PIXELS];
    load("triptych 1\ntarget 24 16\nstate lighting false\nclear color 0 0 0 1\n"
         "vertices v position:float2 diffuse:color {\n-1 -1 ffff8000\n-1 1 ffff8000\n1 1 ffff8000\n}\n"
         "bind vertices v\ndraw triangles 0 1\n");
    play(0, expected);
    unload();
    load("triptych 1\ntarget 24 16\nstate lighting false\nclear color 0 0 0 1\n"
         "buffer p float { 9 -1 -1 -1 1 1 1 }\nbuffer c color { 00000000 ffff8000 }\nbuffer i u32 { 7 0 1 2 "
         "}\n"
         "bind element position float2 p 4 8\nbind element diffuse color c 4 0\nbind indices i\n"
         "draw-indexed triangles 0 1 1\n");
    play(0, picture);
    TEST_ASSERT_TRUE(holds(expected, 0xff0080ff) > 0);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(expected, picture, PIXELS);
}

/* When an earlier frame is played again, resources have the contents of their definitions. */
static void changed_textures_are_themselves_again_when_a_frame_is_replayed(void)
{
    static uint32_t picture[PIXELS];
    load("triptych 1\ntarget 24 16\nstate lighting false\nstate cullmode none\n"
         "stage 0 colorop selectarg1\nstage 0 alphaop selectarg1\n"
         "texture t 2d A8R8G8B8 1 1 colors { ff102030 }\nbuffer later color { ff405060 }\n"
         "vertices v position:float2 {\n-1 -1\n-1 3\n3 -1\n}\nbind vertices v\nbind texture t\n"
         "sequence change\nupdate t later\nend\n"
         "draw triangles 0 1\nframe\nplay change\ndraw triangles 0 1\nframe\ndraw triangles 0 1\n");
    for (int again = 0; again < 2; again++) {
        play(0, picture);
        TEST_ASSERT_EQUAL_INT(PIXELS, holds(picture, 0xff302010));
        play(1, picture);
        TEST_ASSERT_EQUAL_INT(PIXELS, holds(picture, 0xff605040));
        play(2, picture);
        TEST_ASSERT_EQUAL_INT(PIXELS, holds(picture, 0xff605040));
    }
    play(2, picture); /* the frame by itself: it has the change of the previous frame */
    TEST_ASSERT_EQUAL_INT(PIXELS, holds(picture, 0xff605040));
}

/* Draws keep the constants that were set when they were made. A frame that is played by itself has the
 * constants of earlier frames, and none of the device's earlier ones. */
static void constants_are_those_of_their_draw_and_their_frame(void)
{
    static uint32_t picture[PIXELS];
    static const int32_t yes = 1;
    static const float ones[4] = {1, 1, 1, 1};
    for (int again = 0; again < 2; again++) {
        load("triptych 1\ntarget 24 16\nstate cullmode none\n"
             "vertices v position:float2 {\n-1 -1\n-1 3\n3 -1\n}\nbind vertices v\n"
             "shader vs {\nvs_2_0\ndcl_position v0\nmov r0, c1\nif b0\nmov r0, c2\nendif\nmov oD0, r0\n"
             "m4x4 oPos, v0, c4\n}\n"
             "shader ps {\nps_2_0\ndcl v0\nmov r0, v0\nadd r0, r0, c0\nmov oC0, r0\n}\n"
             "vertexshader vs\npixelshader ps\nvertexconstant 4 transform world\n"
             "vertexconstant 1 1 0 0 1  0 1 0 1\nviewport 0 0 12 16 0 1\ndraw triangles 0 1\n"
             "vertexboolean 0 true\npixelconstant 0 0 0 1 0\nviewport 12 0 12 16 0 1\ndraw triangles 0 "
             "1\nframe\n"
             "viewport 0 0 24 16 0 1\ndraw triangles 0 1\nframe\n"
             "transform world translate 8 0 0\nvertexconstant 4 transform world\nclear color 0 0 0 1\n"
             "draw triangles 0 1\n");
        for (int order = 0; order < 2; order++) {
            play(0, picture);
            TEST_ASSERT_EQUAL_INT(PIXELS / 2, holds(picture, 0xff0000ff));
            TEST_ASSERT_EQUAL_INT(PIXELS / 2, holds(picture, 0xffffff00));
            play(2, picture);
            TEST_ASSERT_EQUAL_INT(PIXELS, holds(picture, 0xff000000));
            play(1, picture);
            TEST_ASSERT_EQUAL_INT(PIXELS, holds(picture, 0xffffff00));
        }
        unload();
        triptych_set_shader_booleans(device, TRIPTYCH_SHADER_VERTEX, 0, &yes, 1);
        triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, ones, 1);
    }
}

/* The shader reads a tangent from vertices and from a declared stream. If vertices have no tangent, none is
 * bound. */
static void elements_that_only_shaders_read_are_bound_and_unbound(void)
{
    static uint32_t picture[PIXELS];
    load("triptych 1\ntarget 24 16\nstate cullmode none\n"
         "vertices v tangent:float3 position:float2 {\n1 0 0 -1 -1\n1 0 0 -1 3\n1 0 0 3 -1\n}\n"
         "vertices plain position:float2 {\n-1 -1\n-1 3\n3 -1\n}\nbuffer t float { 0 1 1 }\n"
         "shader vs {\nvs_1_1\ndcl_position v0\ndcl_tangent v3\nmov oPos, v0\nmov oD0, v3\n}\n"
         "vertexshader vs\nbind vertices v\ndraw triangles 0 1\nframe\n"
         "bind vertices plain\nclear color 1 1 1 1 depth 1\ndraw triangles 0 1\nframe\n"
         "declare position:float2 3 tangent:float3\nbind stream 0 plain 0 8\nbind stream 3 t 0 0\n"
         "draw triangles 0 1\n");
    for (int again = 0; again < 2; again++) {
        play(0, picture);
        TEST_ASSERT_EQUAL_INT(PIXELS, holds(picture, 0xff0000ff));
        play(1, picture);
        TEST_ASSERT_EQUAL_INT(PIXELS, holds(picture, 0xff000000)); /* without one it is 0 0 0 1 */
        play(2, picture);
        TEST_ASSERT_EQUAL_INT(PIXELS, holds(picture, 0xffffff00));
    }
}

static void a_frame_past_the_last_is_refused(void)
{
    load(standing);
    TEST_ASSERT_EQUAL_INT(-1, player_frame(player, 6, &error));
    TEST_ASSERT_EQUAL_STRING("p.tri: frame 6, expected 0 to 5", error.text);
}

struct seen {
    uint32_t frames[8];
    int count, stop;
};

static int see(void *user, uint32_t frame, triptych_device *played, struct error *reason)
{
    struct seen *seen = user;
    (void)reason;
    TEST_ASSERT_TRUE(played == device);
    seen->frames[seen->count++] = frame;
    return frame == (uint32_t)seen->stop ? 7 : 0;
}

static void the_callback_receives_every_frame_and_can_stop(void)
{
    struct seen all = {.stop = -1}, some = {.stop = 3};
    load(standing);
    TEST_ASSERT_EQUAL_INT(0, stream_play(stream, device, 1, 5, see, &all, &error));
    TEST_ASSERT_EQUAL_INT(5, all.count);
    for (int i = 0; i < 5; i++)
        TEST_ASSERT_EQUAL_UINT(i + 1, all.frames[i]);
    TEST_ASSERT_EQUAL_INT(7, stream_play(stream, device, 2, 5, see, &some, &error));
    TEST_ASSERT_EQUAL_INT(2, some.count);
    TEST_ASSERT_EQUAL_INT(-1, stream_play(stream, device, 5, 6, NULL, NULL, &error));
}

static void test_a_frame_continues_from_the_contents_of_the_target(void)
{
    uint32_t once[PIXELS], again[PIXELS];
    load("triptych 1\ntarget 24 16\nvertices v position:float2 {\n-1 -1\n-1 1\n1 1\n}\nstate lighting false\n"
         "bind vertices v\nclear color 0 0 0 1\nframe\n"
         "state alphablendenable true\nstate srcblend one\nstate destblend one\nstage 0 colorop selectarg1\n"
         "stage 0 colorarg1 tfactor\nstate texturefactor 0xff202020\ndraw triangles 0 1\n");
    TEST_ASSERT_EQUAL_INT_MESSAGE(-1, player_go_on(player, 1, &error), "no frame was played");
    error_clear(&error);
    play(0, once);
    play(1, once);
    TEST_ASSERT_GREATER_THAN_INT(0, holds(once, 0xff202020));
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, player_go_on(player, 1, &error), error.text);
    TEST_ASSERT_EQUAL_INT(0, triptych_read_color(device, again, sizeof again));
    TEST_ASSERT_EQUAL_INT(holds(once, 0xff202020), holds(again, 0xff404040));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(frames_in_any_order_are_the_frames_in_order);
    RUN_TEST(earlier_draws_are_left_out_when_one_frame_is_played);
    RUN_TEST(a_replayed_target_is_empty_unless_it_is_cleared_as_a_whole);
    RUN_TEST(a_stream_starts_from_the_defaults);
    RUN_TEST(a_material_and_lights_start_as_documented);
    RUN_TEST(elements_in_buffers_draw_what_vertices_draw);
    RUN_TEST(changed_textures_are_themselves_again_when_a_frame_is_replayed);
    RUN_TEST(constants_are_those_of_their_draw_and_their_frame);
    RUN_TEST(elements_that_only_shaders_read_are_bound_and_unbound);
    RUN_TEST(a_frame_past_the_last_is_refused);
    RUN_TEST(the_callback_receives_every_frame_and_can_stop);
    RUN_TEST(test_a_frame_continues_from_the_contents_of_the_target);
    return UNITY_END();
}
