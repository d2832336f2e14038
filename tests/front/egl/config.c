/* Configs: how eglChooseConfig selects and sorts them (EGL 1.5, 3.4). */
#include "display.h"

#include <stdbool.h>

enum { MOST = 64 };

void setUp(void)
{
    begin_display();
}

void tearDown(void)
{
    end_display();
}

static EGLint choose(const EGLint *list, EGLConfig configs[MOST])
{
    EGLint count = -1;
    TEST_ASSERT_TRUE(egl_ChooseConfig(dpy, list, configs, MOST, &count));
    return count;
}

static void all_configs_have_different_numbers(void)
{
    EGLConfig configs[MOST];
    EGLint count;
    TEST_ASSERT_TRUE(egl_GetConfigs(dpy, configs, MOST, &count));
    TEST_ASSERT_EQUAL_INT(60, count);
    for (EGLint i = 0; i < count; i++)
        for (EGLint j = 0; j < i; j++)
            TEST_ASSERT_NOT_EQUAL(attribute(configs[i], EGL_CONFIG_ID), attribute(configs[j], EGL_CONFIG_ID));
}

static void the_count_is_that_of_returned_configs(void)
{
    EGLConfig configs[2] = {0};
    EGLint count;
    TEST_ASSERT_TRUE(egl_GetConfigs(dpy, NULL, 0, &count));
    TEST_ASSERT_EQUAL_INT(60, count);
    TEST_ASSERT_TRUE(egl_GetConfigs(dpy, configs, 1, &count));
    TEST_ASSERT_EQUAL_INT(1, count);
    TEST_ASSERT_NOT_NULL(configs[0]);
    TEST_ASSERT_NULL(configs[1]);
    FAILS(EGL_BAD_PARAMETER, egl_GetConfigs(dpy, configs, 1, NULL));
}

static void the_buffer_size_is_the_sum_of_its_channels(void)
{
    EGLConfig configs[MOST];
    EGLint count;
    egl_GetConfigs(dpy, configs, MOST, &count);
    for (EGLint i = 0; i < count; i++) {
        EGLint sum = attribute(configs[i], EGL_RED_SIZE) + attribute(configs[i], EGL_GREEN_SIZE) +
                     attribute(configs[i], EGL_BLUE_SIZE) + attribute(configs[i], EGL_ALPHA_SIZE);
        TEST_ASSERT_EQUAL_INT(sum, attribute(configs[i], EGL_BUFFER_SIZE));
        TEST_ASSERT_EQUAL_INT(attribute(configs[i], EGL_SAMPLES) > 0,
                              attribute(configs[i], EGL_SAMPLE_BUFFERS));
    }
}

static void sizes_are_least_values(void)
{
    const EGLint list[] = {EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_ES2_BIT,
                           EGL_SURFACE_TYPE,
                           EGL_PBUFFER_BIT,
                           EGL_DEPTH_SIZE,
                           17,
                           EGL_STENCIL_SIZE,
                           1,
                           EGL_SAMPLES,
                           2,
                           EGL_NONE};
    EGLConfig configs[MOST];
    EGLint count = choose(list, configs);
    TEST_ASSERT_EQUAL_INT(6, count);
    for (EGLint i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_INT(24, attribute(configs[i], EGL_DEPTH_SIZE));
        TEST_ASSERT_EQUAL_INT(8, attribute(configs[i], EGL_STENCIL_SIZE));
        TEST_ASSERT_EQUAL_INT(4, attribute(configs[i], EGL_SAMPLES));
    }
}

/* More bits of requested channels come first; without a request, smaller buffers. */
static void requested_channels_sort_larger_first(void)
{
    const EGLint red[] = {EGL_RENDERABLE_TYPE,
                          EGL_OPENGL_ES2_BIT,
                          EGL_SURFACE_TYPE,
                          EGL_PBUFFER_BIT,
                          EGL_RED_SIZE,
                          1,
                          EGL_NONE};
    const EGLint alpha[] = {EGL_RENDERABLE_TYPE,
                            EGL_OPENGL_ES2_BIT,
                            EGL_SURFACE_TYPE,
                            EGL_PBUFFER_BIT,
                            EGL_RED_SIZE,
                            1,
                            EGL_ALPHA_SIZE,
                            1,
                            EGL_NONE};
    const EGLint none[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES2_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                           EGL_NONE};
    EGLConfig configs[MOST];
    choose(red, configs);
    TEST_ASSERT_EQUAL_INT(10, attribute(configs[0], EGL_RED_SIZE));
    choose(alpha, configs);
    TEST_ASSERT_EQUAL_INT(32, attribute(configs[0], EGL_BUFFER_SIZE));
    TEST_ASSERT_EQUAL_INT(8, attribute(configs[0], EGL_RED_SIZE));
    choose(none, configs);
    TEST_ASSERT_EQUAL_INT(16, attribute(configs[0], EGL_BUFFER_SIZE));
}

static const EGLint order[] = {EGL_BUFFER_SIZE, EGL_SAMPLES, EGL_DEPTH_SIZE, EGL_STENCIL_SIZE, EGL_CONFIG_ID};

/* With one sample, and with four. */
static void each_format_has_each_pair_of_depth_and_stencil(void)
{
    static const EGLint colors[][4] = {{8, 8, 8, 8}, {8, 8, 8, 0}, {5, 6, 5, 0},
                                       {5, 5, 5, 1}, {4, 4, 4, 4}, {10, 10, 10, 2}};
    static const EGLint depths[][2] = {{0, 0}, {16, 0}, {24, 0}, {24, 8}, {0, 8}};
    static const EGLint names[] = {EGL_RED_SIZE,   EGL_GREEN_SIZE, EGL_BLUE_SIZE,
                                   EGL_ALPHA_SIZE, EGL_DEPTH_SIZE, EGL_STENCIL_SIZE};
    EGLConfig configs[MOST];
    EGLint count;
    egl_GetConfigs(dpy, configs, MOST, &count);
    for (unsigned color = 0; color < 6; color++)
        for (unsigned depth = 0; depth < 5; depth++) {
            EGLint found = 0;
            for (EGLint i = 0; i < count; i++) {
                bool same = true;
                for (unsigned k = 0; k < 6; k++)
                    same &=
                        attribute(configs[i], names[k]) == (k < 4 ? colors[color][k] : depths[depth][k - 4]);
                found += same;
            }
            TEST_ASSERT_EQUAL_INT(2, found);
        }
}

static int is_after(EGLConfig a, EGLConfig b)
{
    for (unsigned i = 0; i < sizeof order / sizeof *order; i++)
        if (attribute(a, order[i]) != attribute(b, order[i]))
            return attribute(a, order[i]) > attribute(b, order[i]);
    return 0;
}

static void smaller_sizes_sort_first_in_the_order_of_the_specification(void)
{
    const EGLint list[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES2_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                           EGL_NONE};
    EGLConfig configs[MOST];
    EGLint count = choose(list, configs);
    TEST_ASSERT_EQUAL_INT(60, count);
    for (EGLint i = 1; i < count; i++)
        TEST_ASSERT_TRUE(is_after(configs[i], configs[i - 1]));
}

static void the_number_excludes_other_criteria(void)
{
    const EGLint list[] = {EGL_CONFIG_ID, 7, EGL_DEPTH_SIZE, 32, EGL_NONE};
    EGLConfig configs[MOST];
    TEST_ASSERT_EQUAL_INT(1, choose(list, configs));
    TEST_ASSERT_EQUAL_INT(7, attribute(configs[0], EGL_CONFIG_ID));
}

static void an_empty_selection_succeeds(void)
{
    const EGLint list[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_DEPTH_SIZE, 32, EGL_NONE};
    EGLConfig configs[MOST];
    TEST_ASSERT_EQUAL_INT(0, choose(list, configs));
    TEST_ASSERT_EQUAL_HEX(EGL_SUCCESS, egl_GetError());
}

/* Without a window system the default type, windows, selects nothing. */
static void the_default_type_is_windows(void)
{
    const EGLint list[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES2_BIT, EGL_NONE};
    EGLConfig configs[MOST];
    TEST_ASSERT_EQUAL_INT(0, choose(list, configs));
}

static void wrong_attributes_are_errors(void)
{
    static const EGLint lists[][3] = {
        {EGL_WIDTH, 1, EGL_NONE},
        {EGL_RED_SIZE, -2, EGL_NONE},
        {EGL_LEVEL, EGL_DONT_CARE, EGL_NONE},
        {EGL_MATCH_NATIVE_PIXMAP, EGL_DONT_CARE, EGL_NONE},
        {EGL_CONFIG_CAVEAT, EGL_TRUE, EGL_NONE},
        {EGL_COLOR_BUFFER_TYPE, EGL_NONE, EGL_NONE},
        {EGL_BIND_TO_TEXTURE_RGB, 5, EGL_NONE},
    };
    EGLConfig config;
    EGLint count;
    for (unsigned i = 0; i < sizeof lists / sizeof *lists; i++)
        FAILS(EGL_BAD_ATTRIBUTE, egl_ChooseConfig(dpy, lists[i], &config, 1, &count));
    FAILS(EGL_BAD_PARAMETER, egl_ChooseConfig(dpy, NULL, &config, 1, NULL));
}

static void attributes_of_wrong_configs_are_errors(void)
{
    EGLint value = 5;
    FAILS(EGL_BAD_CONFIG, egl_GetConfigAttrib(dpy, &value, EGL_RED_SIZE, &value));
    FAILS(EGL_BAD_ATTRIBUTE, egl_GetConfigAttrib(dpy, config_with(EGL_LEVEL, 0), EGL_WIDTH, &value));
    TEST_ASSERT_EQUAL_INT(5, value);
}

static void values_of_transparency_are_ignored_without_it(void)
{
    EGLConfig config = config_with(EGL_TRANSPARENT_RED_VALUE, 77);
    TEST_ASSERT_EQUAL_INT(EGL_NONE, attribute(config, EGL_TRANSPARENT_TYPE));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(all_configs_have_different_numbers);
    RUN_TEST(the_count_is_that_of_returned_configs);
    RUN_TEST(the_buffer_size_is_the_sum_of_its_channels);
    RUN_TEST(each_format_has_each_pair_of_depth_and_stencil);
    RUN_TEST(sizes_are_least_values);
    RUN_TEST(requested_channels_sort_larger_first);
    RUN_TEST(smaller_sizes_sort_first_in_the_order_of_the_specification);
    RUN_TEST(the_number_excludes_other_criteria);
    RUN_TEST(an_empty_selection_succeeds);
    RUN_TEST(the_default_type_is_windows);
    RUN_TEST(wrong_attributes_are_errors);
    RUN_TEST(attributes_of_wrong_configs_are_errors);
    RUN_TEST(values_of_transparency_are_ignored_without_it);
    return UNITY_END();
}
