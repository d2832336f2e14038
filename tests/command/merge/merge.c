/* Merging: results that a test makes, split into shards, merged in any order, with gaps, twice, damaged. */
#include "base/file.h"
#include "command/merge/merge.h"
#include "command/support/option.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

enum { PATH_CAPACITY = 256, ARGUMENTS = 16, CASES = 60, TEXT_CAPACITY = 1 << 16 };

static char folder[] = "/tmp/triptych-merge-XXXXXX";
static char output[TEXT_CAPACITY];

void setUp(void)
{
    json_begin();
    tool_report_begin();
    fflush(stdout);
}

void tearDown(void)
{
    json_end();
}

static const char *path_of(const char *name)
{
    static char path[ARGUMENTS][PATH_CAPACITY];
    static unsigned next;
    char *text = path[next++ % ARGUMENTS];
    snprintf(text, PATH_CAPACITY, "%s/%s", folder, name);
    return text;
}

static void write_text(const char *name, const char *text)
{
    struct error error = {""};
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_write(path_of(name), text, strlen(text), &error), error.text);
}

static const char *read_text(const char *name)
{
    static char *text;
    struct error error = {""};
    size_t bytes;
    free(text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_read(path_of(name), TEXT_CAPACITY, &text, &bytes, &error),
                                  error.text);
    return text;
}

/* Runs triptych merge with the words: options are themselves, other words are files of the folder. */
static int merge(const char *words)
{
    char copy[512], *argument[ARGUMENTS];
    long long settings[8] = {0};
    struct operands operands;
    int count = 0;
    snprintf(copy, sizeof copy, "%s", words);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " "))
        argument[count++] = *word == '-' ? word : (char *)(size_t)path_of(word);
    TEST_ASSERT_TRUE(command_merge.settings_bytes <= sizeof settings);
    TEST_ASSERT_EQUAL_INT(OPTIONS_GO, options_read(&command_merge, count, argument, settings, &operands));
    unlink(operands.value[0]);
    return command_merge.run(&command_merge, settings, &operands);
}

/* --- Results of fuzz ------------------------------------------------------------------------------------ */

/* The values that a test changes. */
struct made {
    unsigned seed;
    const char *commit, *engines, *done, *finding;
    int cases; /* added to the number of cases */
};

static const struct made usual = {
    .seed = 7, .commit = "abc", .engines = "\"emulate\",\"batch\"", .finding = ""};

/* Case n covers n pixels; every tenth is limited, every sixteenth is different. */
static void write_shard(const char *name, unsigned first, unsigned count, const struct made *made)
{
    unsigned pixels = 0, same = 0, limited = 0, different = 0;
    char done[32] = "", findings[2048] = "";
    for (unsigned n = first; n < first + count; n++) {
        pixels += n;
        if (n % 16 == 5) {
            snprintf(findings + strlen(findings), sizeof findings - strlen(findings),
                     "%s{\"case\":%u,\"outcome\":\"different\",\"engine\":\"batch\",\"threads\":2,"
                     "\"what\":\"colour\"}",
                     different++ ? "," : "", n);
            continue;
        }
        limited += n % 10 == 0;
        same += n % 10 != 0;
    }
    if (count)
        snprintf(done, sizeof done, count > 1 ? "%u-%u" : "%u", first, first + count - 1);
    snprintf(
        output, sizeof output,
        "{\"command\":\"fuzz\",\"machine\":{\"cpu\":\"P\",\"commit\":\"%s\",\"date\":\"%u\"},"
        "\"seed\":%u,\"first\":0,\"count\":%d,\"engines\":[%s],\"threads\":[1,2],\"seconds\":0.%u1,"
        "\"pixels\":%u,\"cases\":%u,\"same\":%u,\"refused\":0,\"limited\":%u,\"different\":%u,"
        "\"failed\":0,\"crashed\":0,\"hung\":0,\"interrupted\":false,\"done\":\"%s\",\"findings\":[%s%s]}",
        made->commit, first, made->seed, CASES, made->engines, first, pixels, count + (unsigned)made->cases,
        same, limited, different, made->done ? made->done : done, made->finding, findings);
    write_text(name, output);
}

static void write_shards(void)
{
    write_shard("one", 0, CASES, &usual);
    write_shard("a", 0, 15, &usual);
    write_shard("b", 15, 1, &usual);
    write_shard("c", 16, 30, &usual);
    write_shard("d", 46, 14, &usual);
}

static void expect_same_file(const char *a, const char *b)
{
    char *text = strdup(read_text(a));
    TEST_ASSERT_EQUAL_STRING(text, read_text(b));
    free(text);
}

static void shards_are_one_run_in_any_order(void)
{
    static const char *const orders[] = {"a b c d", "d c b a", "c a d b", "b d a c"};
    write_shards();
    TEST_ASSERT_EQUAL_INT(STATUS_OK, merge("--canonical expected one"));
    TEST_ASSERT_EQUAL_INT(STATUS_OK, merge("whole a b c d"));
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++) {
        char words[64];
        snprintf(words, sizeof words, "--canonical out %s", orders[i]);
        TEST_ASSERT_EQUAL_INT(STATUS_OK, merge(words));
        expect_same_file("expected", "out");
        snprintf(words, sizeof words, "out %s", orders[i]);
        TEST_ASSERT_EQUAL_INT(STATUS_OK, merge(words));
        expect_same_file("whole", "out");
    }
    TEST_ASSERT_NOT_NULL(strstr(read_text("whole"), "\"cases\":\t60"));
    TEST_ASSERT_NOT_NULL(strstr(read_text("whole"), "\"pixels\":\t1770"));
    TEST_ASSERT_NULL(strstr(read_text("expected"), "seconds"));
}

static void merged_results_can_be_merged_again(void)
{
    write_shards();
    TEST_ASSERT_EQUAL_INT(STATUS_OK, merge("whole a b c d"));
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, merge("left a d"));
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, merge("right c b"));
    TEST_ASSERT_EQUAL_INT(STATUS_OK, merge("out right left"));
    expect_same_file("whole", "out");
}

static void gaps_are_reported_and_what_there_is_is_merged(void)
{
    write_shards();
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, merge("out d a"));
    TEST_ASSERT_NOT_NULL(strstr(read_text("out"), "\"done\":\t\"0-14,46-59\""));
    TEST_ASSERT_NOT_NULL(strstr(read_text("out"), "\"interrupted\":\ttrue"));
}

static void cases_that_are_there_twice_are_not_counted(void)
{
    write_shards();
    write_shard("overlap", 40, 10, &usual);
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, merge("out a b c d overlap"));
    TEST_ASSERT_TRUE(access(path_of("out"), F_OK) != 0);
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, merge("out one one"));
    TEST_ASSERT_TRUE(access(path_of("out"), F_OK) != 0);
}

static void expect_refused(const char *words)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(STATUS_BAD, merge(words), words);
    TEST_ASSERT_TRUE_MESSAGE(access(path_of("out"), F_OK) != 0, words);
}

static void other_campaigns_are_refused(void)
{
    struct made other[3] = {usual, usual, usual};
    other[0].seed = 8;
    other[1].commit = "abd";
    other[2].engines = "\"emulate\",\"stitch\"";
    write_shards();
    for (int i = 0; i < 3; i++) {
        write_shard("other", 15, 1, &other[i]);
        expect_refused("out a other c d");
        expect_refused("out other a c d");
    }
    write_text("other", "{\"command\":\"bench\",\"inputs\":[\"a\"],\"streams\":[]}");
    expect_refused("out a other");
}

static void damaged_files_are_refused(void)
{
    static const struct made damaged[] = {
        {.seed = 7, .commit = "abc", .engines = "", .finding = "", .cases = 1},
        {.seed = 7, .commit = "abc", .engines = "", .finding = "", .cases = -1},
        {.seed = 7, .commit = "abc", .engines = "", .finding = "", .done = "0-4,3-9"},
        {.seed = 7, .commit = "abc", .engines = "", .finding = "", .done = "0-8"},
        {.seed = 7, .commit = "abc", .engines = "", .finding = "", .done = "51-60"},
        {.seed = 7, .commit = "abc", .engines = "", .finding = "7,"},
        {.seed = 7, .commit = "abc", .engines = "", .finding = "{\"case\":30,\"outcome\":\"hung\"},"},
        {.seed = 7, .commit = "abc", .engines = "", .finding = "{\"case\":3,\"outcome\":\"same\"},"},
    };
    static const char *const texts[] = {"",
                                        "{}",
                                        "[]",
                                        "null",
                                        "{\"command\":\"fuzz\"}",
                                        "{\"command\":\"verify\",\"inputs\":[\"a\"]}",
                                        "{\"command\":7}"};
    for (size_t i = 0; i < sizeof damaged / sizeof *damaged; i++) {
        write_shard("bad", 0, 10, &damaged[i]);
        expect_refused("out bad");
    }
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        write_text("bad", texts[i]);
        expect_refused("out bad");
    }
    expect_refused("out missing");
}

/* Files with random bytes changed end with a status, never with a crash. */
static void any_damage_is_survived(void)
{
    write_shards();
    char *text = strdup(read_text("c"));
    size_t length = strlen(text);
    srand(3);
    for (int round = 0; round < 300; round++) {
        char *damaged = strdup(text);
        for (int i = rand() % 3; i >= 0; i--)
            damaged[(size_t)rand() % length] = "0-,\"{}[]9a"[rand() % 10];
        if (rand() % 4 == 0)
            damaged[(size_t)rand() % length] = 0;
        write_text("damaged", damaged);
        int status = merge("out a b damaged d");
        TEST_ASSERT_TRUE(status >= STATUS_OK && status <= STATUS_BAD);
        free(damaged);
    }
    free(text);
}

/* --- Entries -------------------------------------------------------------------------------------------- */

/* A result of verify with one stream and some engines; the campaign has two streams and two engines. */
static void write_verified(const char *name, unsigned number, const char *engines, unsigned configurations,
                           const char *digest, bool complete)
{
    snprintf(
        output, sizeof output,
        "{\"command\":\"verify\",\"machine\":{\"commit\":\"abc\"},\"identical\":true,"
        "\"inputs\":[\"x.tri\",\"y.tri\"],\"threads\":[1,2],\"frames\":8,\"shuffle\":0,\"engines\":["
        "{\"engine\":\"emulate\",\"lanes\":\"\",\"instruction_set\":\"\",\"unit_lanes\":[0,0,0]},"
        "{\"engine\":\"batch\",\"lanes\":\"64\",\"instruction_set\":\"SSE2\",\"unit_lanes\":[64,%u,64]}],"
        "\"streams\":[{\"number\":%u,\"stream\":\"s\",\"path\":\"%s\",\"engines\":[%s],\"frames\":3,"
        "\"complete\":%s,\"configurations\":%u,\"xxh3\":\"%s\",\"identical\":true,\"differences\":[]}]}",
        number ? 64 : 32, number, number ? "y.tri" : "x.tri", engines, complete ? "true" : "false",
        configurations, digest);
    write_text(name, output);
}

static void parts_of_a_stream_become_one_entry(void)
{
    write_verified("a", 0, "\"emulate\"", 2, "0123", true);
    write_verified("b", 0, "\"batch\"", 3, "0123", true);
    write_verified("c", 1, "\"emulate\",\"batch\"", 4, "4567", true);
    TEST_ASSERT_EQUAL_INT(STATUS_OK, merge("--canonical out c b a"));
    char *text = strdup(read_text("out"));
    TEST_ASSERT_EQUAL_INT(STATUS_OK, merge("--canonical out a c b"));
    TEST_ASSERT_EQUAL_STRING(text, read_text("out"));
    TEST_ASSERT_NOT_NULL(strstr(text, "\"configurations\":\t4,\n\t\t\t\"xxh3\":\t\"0123\""));
    TEST_ASSERT_NOT_NULL(strstr(text, "[64, 64, 64]"));
    free(text);
}

static void missing_incomplete_and_repeated_parts_are_reported(void)
{
    write_verified("a", 0, "\"emulate\"", 2, "0123", true);
    write_verified("b", 0, "\"batch\"", 3, "0123", false);
    write_verified("c", 1, "\"emulate\",\"batch\"", 4, "4567", true);
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, merge("out c b a"));
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, merge("out c a c"));
    write_verified("bad", 1, "\"stitch\"", 4, "4567", true);
    expect_refused("out bad");
    write_verified("bad", 2, "\"batch\"", 4, "4567", true);
    expect_refused("out bad");
}

static void machines_that_draw_different_pictures_are_reported(void)
{
    write_verified("a", 0, "\"emulate\"", 2, "0123", true);
    write_verified("b", 0, "\"batch\"", 3, "0124", true);
    write_verified("c", 1, "\"emulate\",\"batch\"", 4, "4567", true);
    TEST_ASSERT_EQUAL_INT(STATUS_DIFFERENT, merge("out a b c"));
    TEST_ASSERT_TRUE(access(path_of("out"), F_OK) != 0);
}

/* A result of claims with one of three claims. */
static void write_claim(const char *name, const char *id)
{
    snprintf(output, sizeof output,
             "{\"command\":\"claims\",\"machine\":{\"commit\":\"abc\"},\"inputs\":[\"C1\",\"C2\",\"C3\"],"
             "\"claims\":[{\"id\":\"%s\",\"verdict\":\"holds\",\"seconds\":%zu}]}",
             id, strlen(name));
    write_text(name, output);
}

static void claims_are_in_the_order_of_the_campaign(void)
{
    write_claim("x", "C1");
    write_claim("yy", "C2");
    write_claim("zzz", "C3");
    TEST_ASSERT_EQUAL_INT(STATUS_OK, merge("--canonical out zzz x yy"));
    const char *text = read_text("out"), *claims = strstr(text, "\"claims\":\t[");
    TEST_ASSERT_TRUE(strstr(claims, "C1") < strstr(claims, "C2") &&
                     strstr(claims, "C2") < strstr(claims, "C3"));
    TEST_ASSERT_NULL(strstr(text, "seconds"));
    write_claim("bad", "C4");
    expect_refused("out bad");
}

int main(void)
{
    UNITY_BEGIN();
    if (!mkdtemp(folder))
        return 1;
    RUN_TEST(shards_are_one_run_in_any_order);
    RUN_TEST(merged_results_can_be_merged_again);
    RUN_TEST(gaps_are_reported_and_what_there_is_is_merged);
    RUN_TEST(cases_that_are_there_twice_are_not_counted);
    RUN_TEST(other_campaigns_are_refused);
    RUN_TEST(damaged_files_are_refused);
    RUN_TEST(any_damage_is_survived);
    RUN_TEST(parts_of_a_stream_become_one_entry);
    RUN_TEST(missing_incomplete_and_repeated_parts_are_reported);
    RUN_TEST(machines_that_draw_different_pictures_are_reported);
    RUN_TEST(claims_are_in_the_order_of_the_campaign);
    char command[PATH_CAPACITY];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return UNITY_END() + (system(command) != 0);
}
