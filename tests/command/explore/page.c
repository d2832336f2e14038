/* The data of a page: texts that cannot leave their strings or their element, and the difference between two
 * programs. */
#include "command/explore/page.h"

#include <unity.h>

#include <stdlib.h>
#include <string.h>

static struct explore_recording recording;
static struct page page;
static struct ir *before, *after;
static char *html;

void setUp(void)
{
    static const union key key;
    struct error error = {""};
    recording.ir = malloc(sizeof *recording.ir);
    before = malloc(sizeof *before);
    after = malloc(sizeof *after);
    TEST_ASSERT_TRUE(recording.ir && before && after);
    ir_start(recording.ir);
    ir_start(before);
    ir_start(after);
    TEST_ASSERT_EQUAL_MESSAGE(0, page_open(&page, &recording, UNIT_PIXEL, &key, &error), error.text);
}

void tearDown(void)
{
    page_discard(&page);
    free(recording.ir);
    free(before);
    free(after);
    free(html);
    html = NULL;
}

/* Completes the page and checks that it has the text. */
static void expect(const char *text)
{
    struct error error = {""};
    size_t bytes;
    TEST_ASSERT_EQUAL_MESSAGE(0, page_close(&page, &html, &bytes, &error), error.text);
    TEST_ASSERT_EQUAL(strlen(html), bytes);
    const char *model = strstr(html, "id=\"model\"");
    TEST_ASSERT_NOT_NULL(model);
    *strstr(model, "</script>") = 0;
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(model, text), model);
}

static void a_text_cannot_end_its_string_or_its_element(void)
{
    page_string(&page, "</script><!--&amp; \"\\\n\r\t\x01\x7f");
    expect("\"\\u003c/script\\u003e\\u003c!--\\u0026amp; \\\"\\\\\\n\\u000d\\u0009\\u0001\\u007f\"");
}

static void bytes_outside_of_characters_are_replaced(void)
{
    page_string(&page, "\xc3\xbc|\xff|\xc3|\xc0\xaf|\xed\xa0\x80|\xf4\x90\x80\x80|\xe2\x82");
    expect("\"\xc3\xbc|\\ufffd|\\ufffd|\\ufffd\\ufffd|\\ufffd\\ufffd\\ufffd|\\ufffd\\ufffd\\ufffd\\ufffd|"
           "\\ufffd\\ufffd\"");
}

static void equal_texts_have_one_number(void)
{
    TEST_ASSERT_EQUAL(0, page_text(&page, "first", 5));
    TEST_ASSERT_EQUAL(1, page_text(&page, "second", 6));
    TEST_ASSERT_EQUAL(0, page_text(&page, "first and more", 5));
    for (unsigned i = 0; i < 5000; i++) {
        char text[8];
        int length = snprintf(text, sizeof text, "%u", i);
        TEST_ASSERT_EQUAL(i + 2, page_text(&page, text, (size_t)length));
    }
    TEST_ASSERT_EQUAL(1002, page_text(&page, "1000", 4));
    expect("\"first\",\n\"second\",\n\"0\"");
}

static uint16_t add(struct ir *ir, enum ir_op op, uint16_t a, uint16_t b)
{
    return ir_append(ir, (struct ir_instruction){.op = (uint8_t)op, .type = TYPE_itg, .operand = {a, b}});
}

static struct change print_change(void)
{
    struct version old, new;
    struct change change;
    TEST_ASSERT_EQUAL(0, version_take(&old, &page, before));
    TEST_ASSERT_EQUAL(0, version_take(&new, &page, after));
    page_begin_pane(&page, "ir", "test", "Test", "");
    TEST_ASSERT_EQUAL(0, version_print(&page, &old, &new, &change));
    page_end_pane(&page);
    version_free(&old);
    version_free(&new);
    return change;
}

/* %3 is a copy of %1, whose use in %4 becomes one of %1. */
static void a_removed_operation_names_its_replacement(void)
{
    uint16_t a = add(before, IR_load, 0, 0), b = add(before, IR_load, 0, 0),
             copy = add(before, IR_copy, a, 0);
    add(before, IR_add_i, copy, b);
    ir_duplicate(after, before);
    after->instruction[3] = (struct ir_instruction){.op = IR_nop};
    after->instruction[4].operand[0] = a;
    struct change change = print_change();
    TEST_ASSERT_EQUAL(1, change.removed);
    TEST_ASSERT_EQUAL(0, change.added);
    TEST_ASSERT_EQUAL(1, change.altered);
    expect("\"lines\":[[0,2],\n[3,3,1,3,1],\n[2,4,3,4,2]]");
}

static void a_new_number_changes_nothing(void)
{
    static uint16_t map[IR_CAPACITY];
    add(before, IR_load, 0, 0);
    uint16_t b = add(before, IR_load, 0, 0);
    add(before, IR_add_i, b, b);
    before->instruction[1] = (struct ir_instruction){.op = IR_nop};
    ir_duplicate(after, before);
    ir_compact(after, map);
    struct change change = print_change();
    TEST_ASSERT_EQUAL(0, change.removed + change.added + change.altered);
    expect("\"lines\":[[0,1,0,2],\n[0,2,2,3]]");
}

static void what_a_pass_adds_is_marked(void)
{
    uint16_t a = add(before, IR_load, 0, 0);
    ir_duplicate(after, before);
    add(after, IR_copy, a, 0);
    after->instruction[2].origin = 0;
    struct change change = print_change();
    TEST_ASSERT_EQUAL(1, change.added);
    expect("\"lines\":[[0,1],\n[1,2,1,0]]");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_text_cannot_end_its_string_or_its_element);
    RUN_TEST(bytes_outside_of_characters_are_replaced);
    RUN_TEST(equal_texts_have_one_number);
    RUN_TEST(a_removed_operation_names_its_replacement);
    RUN_TEST(a_new_number_changes_nothing);
    RUN_TEST(what_a_pass_adds_is_marked);
    return UNITY_END();
}
