/* Textures whose texels are written in the stream: their order over levels, faces and slices. */
#include "command/stream/stream.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

static struct stream *stream;

void setUp(void)
{
}

void tearDown(void)
{
    stream_free(stream);
    stream = NULL;
}

static const uint8_t *texels_of(const char *text, size_t bytes)
{
    struct error error = {{0}};
    char whole[1024];
    snprintf(whole, sizeof whole, "triptych 1\ntarget 1 1\n%sframe\n", text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("paint.tri", whole, strlen(whole), &stream, &error),
                                  error.text);
    TEST_ASSERT_EQUAL_UINT(bytes, stream->resources[0].texel_bytes);
    return stream->resources[0].texels;
}

/* Compares the first bytes of red with the digits of `reds`. */
static void expect_reds(const char *text, const char *reds)
{
    const uint8_t *texels = texels_of(text, 4 * strlen(reds));
    for (size_t i = 0; i < strlen(reds); i++)
        TEST_ASSERT_EQUAL_HEX8((reds[i] - '0') * 0x11, texels[4 * i + 2]); /* blue, green, red, alpha */
}

static void colors_come_level_by_level(void)
{
    expect_reds("texture a 2d A8R8G8B8 4 2 levels 3 colors {\n"
                "ff110000 ff220000 ff330000 ff440000\nff550000 ff660000 ff770000 ff880000\n"
                "ff990000 ff110000\nff000000 }\n",
                "12345678910");
}

static void colors_come_face_by_face(void)
{
    expect_reds(
        "texture a cube A8R8G8B8 2 levels 2 colors {\n"
        "ff110000 ff110000 ff110000 ff110000 ff220000\nff330000 ff330000 ff330000 ff330000 ff440000\n"
        "ff550000 ff550000 ff550000 ff550000 ff660000\nff770000 ff770000 ff770000 ff770000 ff880000\n"
        "ff990000 ff990000 ff990000 ff990000 ff000000\nff110000 ff220000 ff330000 ff440000 ff550000 }\n",
        "111123333455556777789999012345");
}

static void colors_come_slice_by_slice(void)
{
    expect_reds("texture a volume A8R8G8B8 2 1 3 levels 2 colors {\n"
                "ff110000 ff220000  ff330000 ff440000  ff550000 ff660000\nff770000 }\n",
                "1234567");
}

static void each_level_is_filled_with_its_own_color(void)
{
    expect_reds("texture a 2d A8R8G8B8 4 2 levels 3 fill { ff110000 ff220000 ff330000 }\n", "11111111223");
}

static void checkers_start_again_in_every_level(void)
{
    expect_reds("texture a 2d A8R8G8B8 4 2 levels 3 checker 1 ff110000 ff220000\n", "12122121121");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(colors_come_level_by_level);
    RUN_TEST(colors_come_face_by_face);
    RUN_TEST(colors_come_slice_by_slice);
    RUN_TEST(each_level_is_filled_with_its_own_color);
    RUN_TEST(checkers_start_again_in_every_level);
    return UNITY_END();
}
