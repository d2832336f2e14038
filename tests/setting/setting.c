#include "setting/setting.h"

#include <string.h>
#include <unity.h>

static struct setting_values values;
static struct error error;

void setUp(void)
{
    memset(&values, 0, sizeof values);
    error_clear(&error);
}

void tearDown(void)
{
}

static void a_list_sets_the_values_that_it_names(void)
{
    TEST_ASSERT_EQUAL_INT(0, setting_read("geometry=serial", &values, &error));
    TEST_ASSERT_EQUAL_UINT8(SETTING_geometry_serial, values.of[SETTING_geometry]);
    TEST_ASSERT_EQUAL_UINT8(SETTING_order_tiles, values.of[SETTING_order]);
    TEST_ASSERT_EQUAL_INT(0, setting_read("order=stripes,geometry=parallel", &values, &error));
    TEST_ASSERT_EQUAL_UINT8(SETTING_geometry_parallel, values.of[SETTING_geometry]);
    TEST_ASSERT_EQUAL_UINT8(SETTING_order_stripes, values.of[SETTING_order]);
}

static void no_list_sets_nothing(void)
{
    TEST_ASSERT_EQUAL_INT(0, setting_read("order=stripes", &values, &error));
    TEST_ASSERT_EQUAL_INT(0, setting_read(NULL, &values, &error));
    TEST_ASSERT_EQUAL_INT(0, setting_read("", &values, &error));
    TEST_ASSERT_EQUAL_UINT8(SETTING_order_stripes, values.of[SETTING_order]);
}

static void the_last_value_of_a_setting_counts(void)
{
    TEST_ASSERT_EQUAL_INT(0, setting_read("order=stripes,order=tiles", &values, &error));
    TEST_ASSERT_EQUAL_UINT8(SETTING_order_tiles, values.of[SETTING_order]);
}

static void refuse(const char *list, const char *reason)
{
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, setting_read(list, &values, &error));
    TEST_ASSERT_EQUAL_STRING_LEN(reason, error.text, strlen(reason));
    TEST_ASSERT_NULL(strchr(error.text, '\n'));
}

static void unknown_settings_and_values_are_refused(void)
{
    refuse("odrer=tiles", "settings have \"odrer\", expected one of: order, ");
    TEST_ASSERT_NOT_NULL(strstr(error.text, "did you mean \"order\"?"));
    refuse("order=stripe", "settings have \"stripe\", expected one of: tiles, stripes");
    TEST_ASSERT_NOT_NULL(strstr(error.text, "did you mean \"stripes\"?"));
    refuse("order", "settings have \"order\" without a value, expected order=VALUE");
    refuse("order,geometry=serial", "settings have \"order\" without a value, expected order=VALUE");
    refuse("geometry=serial,,order=tiles", "settings have \"\", expected one of: order, ");
    refuse("order=", "settings have \"\", expected one of: tiles, ");
}

static void every_pair_is_read_and_written_again(void)
{
    unsigned i = 0;
    char text[SETTING_TEXT];
    for (unsigned setting = 0; setting_name(setting); setting++)
        for (unsigned value = 0; setting_value_name(setting, value); value++) {
            struct setting_values one = {{0}};
            const char *pair = setting_choice(i++);
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, setting_read(pair, &one, &error), pair);
            TEST_ASSERT_EQUAL_UINT8(value, one.of[setting]);
            TEST_ASSERT_EQUAL_STRING(value ? pair : "", setting_write(&one, text));
            TEST_ASSERT_NOT_NULL(setting_value_meaning(setting, value));
        }
    TEST_ASSERT_NULL(setting_choice(i));
}

static void the_values_farthest_from_the_defaults_fit_a_text(void)
{
    char text[SETTING_TEXT];
    struct setting_values all = {{0}}, read = {{0}};
    for (unsigned setting = 0; setting_name(setting); setting++)
        while (setting_value_name(setting, all.of[setting] + 1u))
            all.of[setting]++;
    TEST_ASSERT_TRUE(strlen(setting_write(&all, text)) + 1 < SETTING_TEXT);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, setting_read(text, &read, &error), error.text);
    TEST_ASSERT_EQUAL_MEMORY(&all, &read, sizeof all);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_list_sets_the_values_that_it_names);
    RUN_TEST(no_list_sets_nothing);
    RUN_TEST(the_last_value_of_a_setting_counts);
    RUN_TEST(unknown_settings_and_values_are_refused);
    RUN_TEST(every_pair_is_read_and_written_again);
    RUN_TEST(the_values_farthest_from_the_defaults_fit_a_text);
    return UNITY_END();
}
