#include "base/words.h"

#include <string.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static const char *const names[] = {"draw",   "clear", "state", "",    "texture",
                                    "target", "mov",   "mova",  "mul", "tessfactor"};

static const char *nearest(const char *given)
{
    return words_nearest(WORDS_OF_ROWS(names), given, strlen(given));
}

static void one_error_of_each_kind_is_recognised(void)
{
    TEST_ASSERT_EQUAL_STRING("draw", nearest("drw"));
    TEST_ASSERT_EQUAL_STRING("draw", nearest("draww"));
    TEST_ASSERT_EQUAL_STRING("draw", nearest("drav"));
    TEST_ASSERT_EQUAL_STRING("draw", nearest("darw"));
    TEST_ASSERT_EQUAL_STRING("clear", nearest("Clear"));
    TEST_ASSERT_EQUAL_STRING("mov", nearest("mvo"));
}

static void a_beginning_of_three_letters_is_recognised(void)
{
    TEST_ASSERT_EQUAL_STRING("tessfactor", nearest("tess"));
    TEST_ASSERT_EQUAL_STRING("tessfactor", nearest("TES"));
}

static void a_word_that_is_not_similar_is_not_suggested(void)
{
    TEST_ASSERT_NULL(nearest("paint"));
    TEST_ASSERT_NULL(nearest("x"));
    TEST_ASSERT_NULL(nearest(""));
    TEST_ASSERT_NULL(nearest("te"));
    TEST_ASSERT_NULL(nearest("texture"));
}

static void the_first_of_equally_near_words_is_suggested(void)
{
    TEST_ASSERT_EQUAL_STRING("mov", nearest("mou"));
    TEST_ASSERT_EQUAL_STRING("mul", nearest("mup"));
}

static void a_word_of_any_length_is_measured(void)
{
    char text[300];
    for (size_t length = 0; length < sizeof text; length++) {
        memset(text, 'a', length);
        TEST_ASSERT_NULL(words_nearest(WORDS_OF_ROWS(names), text, length));
    }
}

static void a_word_is_found_with_its_index(void)
{
    unsigned index = 0;
    TEST_ASSERT_EQUAL_STRING("texture", words_find(WORDS_OF_ROWS(names), "texture 3", 7, &index));
    TEST_ASSERT_EQUAL_UINT(4, index);
    TEST_ASSERT_NULL(words_find(WORDS_OF_ROWS(names), "textur", 6, &index));
    TEST_ASSERT_NULL(words_find(WORDS_OF_ROWS(names), "", 0, &index));
}

static void a_list_is_joined_up_to_the_capacity(void)
{
    char text[64];
    words_join(WORDS_OF_ROWS(names), text, sizeof text);
    TEST_ASSERT_EQUAL_STRING("draw, clear, state, texture, target, mov, mova, mul, ...", text);
    words_join(WORDS_OF_ROWS(names), text, 20);
    TEST_ASSERT_EQUAL_STRING("draw, clear, ...", text);
    words_join((struct words){.at = words_row}, text, sizeof text);
    TEST_ASSERT_EQUAL_STRING("", text);
}

static void a_suggestion_is_a_question(void)
{
    char text[WORDS_SUGGESTION];
    TEST_ASSERT_EQUAL_STRING("; did you mean \"clear\"?",
                             words_suggest(WORDS_OF_ROWS(names), "claer", 5, text));
    TEST_ASSERT_EQUAL_STRING("", words_suggest(WORDS_OF_ROWS(names), "paint", 5, text));
}

static void a_choice_is_found_or_all_are_named(void)
{
    static const char *const speeds[] = {"slow", "fast"};
    struct error error = {""};
    unsigned index = 7;
    TEST_ASSERT_EQUAL_INT(0, words_choose(WORDS_OF_ROWS(speeds), "speed", "fast", &index, &error));
    TEST_ASSERT_EQUAL_UINT(1, index);
    TEST_ASSERT_EQUAL_INT(-1, words_choose(WORDS_OF_ROWS(speeds), "speed", "fsat", &index, &error));
    TEST_ASSERT_EQUAL_UINT(1, index);
    TEST_ASSERT_EQUAL_STRING("speed is \"fsat\", expected one of: slow, fast; did you mean \"fast\"?",
                             error.text);
}

static void a_suggestion_takes_the_place_of_the_end_of_a_full_reason(void)
{
    static const char end[] = "...; did you mean \"clear\"?";
    struct error error = {""};
    TEST_ASSERT_EQUAL_INT(-1, words_suggest_in(WORDS_OF_ROWS(names), "claer", 5, &error));
    TEST_ASSERT_EQUAL_STRING("; did you mean \"clear\"?", error.text);
    for (size_t length = sizeof error.text - 40; length < sizeof error.text; length++) {
        memset(error.text, 'a', length);
        error.text[length] = 0;
        words_suggest_in(WORDS_OF_ROWS(names), "claer", 5, &error);
        TEST_ASSERT_TRUE(strlen(error.text) < sizeof error.text);
        TEST_ASSERT_NOT_NULL(strstr(error.text, end + 3));
        if (length + strlen(end + 3) >= sizeof error.text)
            TEST_ASSERT_EQUAL_STRING(end, error.text + strlen(error.text) - strlen(end));
    }
    TEST_ASSERT_EQUAL_INT(-1, words_suggest_in(WORDS_OF_ROWS(names), "claer", 5, NULL));
}

static void a_cut_does_not_split_a_character(void)
{
    struct error error = {""};
    for (size_t i = 0; i + 2 < sizeof error.text; i += 2)
        memcpy(error.text + i, "\xc3\xa9", 2);
    for (int shift = 0; shift < 2; shift++) {
        words_suggest_in(WORDS_OF_ROWS(names), "claer", 5, &error);
        const char *dots = strstr(error.text, "...");
        TEST_ASSERT_NOT_NULL(dots);
        TEST_ASSERT_EQUAL_HEX8(0xa9, (unsigned char)dots[-1]);
        memset(&error, 0, sizeof error);
        error.text[0] = 'a';
        for (size_t i = 1; i + 2 < sizeof error.text; i += 2)
            memcpy(error.text + i, "\xc3\xa9", 2);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(one_error_of_each_kind_is_recognised);
    RUN_TEST(a_beginning_of_three_letters_is_recognised);
    RUN_TEST(a_word_that_is_not_similar_is_not_suggested);
    RUN_TEST(the_first_of_equally_near_words_is_suggested);
    RUN_TEST(a_word_of_any_length_is_measured);
    RUN_TEST(a_word_is_found_with_its_index);
    RUN_TEST(a_list_is_joined_up_to_the_capacity);
    RUN_TEST(a_suggestion_is_a_question);
    RUN_TEST(a_choice_is_found_or_all_are_named);
    RUN_TEST(a_suggestion_takes_the_place_of_the_end_of_a_full_reason);
    RUN_TEST(a_cut_does_not_split_a_character);
    return UNITY_END();
}
