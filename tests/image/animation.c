#include "image/animation.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

enum { WIDTH = 5, HEIGHT = 3, FRAMES = 2 };

static char path[] = "/tmp/triptych-animation-XXXXXX";
static struct animation animation;
static struct error error;
static uint32_t rgba[WIDTH * HEIGHT];

void setUp(void)
{
    error_clear(&error);
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++)
        rgba[i] = 0xff000000 | i * 0x102030;
    FILE *file = fopen(path, "w");
    fputs("before", file);
    fclose(file);
}

void tearDown(void)
{
}

/* The file has its old contents. */
static bool is_unchanged(void)
{
    char text[16] = "";
    FILE *file = fopen(path, "r");
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    return !strcmp(text, "before");
}

static void begin(enum animation_form form)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, animation_begin(&animation, form, path, FRAMES, 25, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, animation_add(&animation, WIDTH, HEIGHT, rgba, &error), error.text);
}

/* tests/frames.sh reads the contents. */
static void the_file_appears_at_the_end(void)
{
    for (enum animation_form form = ANIMATION_APNG; form <= ANIMATION_Y4M; form++) {
        setUp();
        begin(form);
        TEST_ASSERT_EQUAL_INT(0, animation_add(&animation, WIDTH, HEIGHT, rgba, &error));
        TEST_ASSERT_TRUE(is_unchanged());
        TEST_ASSERT_EQUAL_INT(0, animation_end(&animation, &error));
        TEST_ASSERT_FALSE(is_unchanged());
    }
}

static void a_discarded_animation_leaves_the_file(void)
{
    for (enum animation_form form = ANIMATION_APNG; form <= ANIMATION_Y4M; form++) {
        begin(form);
        animation_discard(&animation);
        TEST_ASSERT_TRUE(is_unchanged());
    }
}

static void a_frame_of_another_size_is_refused(void)
{
    char reason[128];
    begin(ANIMATION_Y4M);
    TEST_ASSERT_EQUAL_INT(-1, animation_add(&animation, HEIGHT, WIDTH, rgba, &error));
    snprintf(reason, sizeof reason, "%s: picture 1 has 3 x 5 pixels, expected 5 x 3, like the first", path);
    TEST_ASSERT_EQUAL_STRING(reason, error.text);
    animation_discard(&animation);
    TEST_ASSERT_TRUE(is_unchanged());
}

static void a_missing_folder_is_refused(void)
{
    TEST_ASSERT_EQUAL_INT(-1,
                          animation_begin(&animation, ANIMATION_APNG, "/tmp/no-such-folder/a", 1, 1, &error));
    TEST_ASSERT_EQUAL_STRING_LEN("/tmp/no-such-folder/a: ", error.text, 23);
}

int main(void)
{
    int descriptor = mkstemp(path);
    if (descriptor < 0)
        return 1;
    close(descriptor);
    UNITY_BEGIN();
    RUN_TEST(the_file_appears_at_the_end);
    RUN_TEST(a_discarded_animation_leaves_the_file);
    RUN_TEST(a_frame_of_another_size_is_refused);
    RUN_TEST(a_missing_folder_is_refused);
    unlink(path);
    return UNITY_END();
}
