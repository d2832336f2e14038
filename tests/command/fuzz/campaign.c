/* Campaigns. Random cases are valid, the same in every run, and cover pixels. A campaign finds a wrong engine
 * by its pictures, crashes or hangs, and minimises the cases that it finds. */
#include "engines/list.h"
#include "command/fuzz/campaign.h"
#include "command/fuzz/case/case.h"
#include "tests/support/routine/wrong.h"
#include "triptych.h"
#include "tests/support/system/seed.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

static struct campaign campaign;
static struct error error;
static struct text text;

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
    text_free(&text);
}

static struct campaign_options options_with(const struct engine *other)
{
    return (struct campaign_options){.run = {{engine_at(0), other}, other ? 2 : 1, {1, 2}, other ? 2 : 1},
                                     .seed = 5,
                                     .count = 2000,
                                     .limit = 300,
                                     .jobs = 2,
                                     .enough = 1};
}

static void run(const struct campaign_options *options)
{
    int result = campaign_run(options, NULL, NULL, &campaign, &error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, result, error.text);
}

static void cases_are_the_same_every_time(void)
{
    struct text again = {0};
    for (uint64_t n = 0; n < 50; n++) {
        campaign_case(1, n, &text);
        campaign_case(1, n, &again);
        TEST_ASSERT_EQUAL_STRING(text.data, again.data);
        campaign_case(2, n, &again);
        TEST_ASSERT_TRUE(strcmp(text.data, again.data) != 0);
    }
    text_free(&again);
}

/* Returns true if some case sets the state, to the value if there is one. */
static void expect_set(const struct text *all, const struct triptych_state_row *state,
                       const struct triptych_value *value)
{
    char line[160];
    snprintf(line, sizeof line, " %s %s%s", state->name, value ? value->word : "", value ? "\n" : "");
    TEST_ASSERT_TRUE_MESSAGE(strstr(all->data, line), line);
}

static void expect_values(const struct text *all, const struct triptych_state_row *state)
{
    const struct triptych_value *value;
    if (state->support != TRIPTYCH_SUPPORT_YES)
        return;
    expect_set(all, state, NULL);
    for (unsigned v = 0; (value = triptych_value_at(state->kind, v)); v++)
        if (value->support == TRIPTYCH_SUPPORT_YES)
            expect_set(all, state, value);
}

static void every_state_and_value_occurs(void)
{
    struct text all = {0};
    for (uint64_t n = 0; n < 4000; n++) {
        campaign_case(9, n, &text);
        text_add_bytes(&all, text.data, text.length);
    }
    for (unsigned table = 0; table < TRIPTYCH_STATE_TABLE_COUNT; table++)
        for (unsigned row = 0; triptych_state_at(table, row); row += test_stride_of(9))
            expect_values(&all, triptych_state_at(table, row));
    text_free(&all);
}

static void cases_are_valid_and_draw(void)
{
    struct campaign_options options = options_with(NULL);
    options.count = test_share_of(1000, 16);
    run(&options);
    TEST_ASSERT_EQUAL_UINT64(options.count, campaign.cases);
    TEST_ASSERT_LESS_THAN_UINT64(10, campaign.outcomes[OUTCOME_REFUSED]);
    TEST_ASSERT_EQUAL_UINT64(0, campaign.findings);
    TEST_ASSERT_GREATER_THAN_UINT64(test_share_of(20000, 16), campaign.pixels);
}

static void expect_found(enum wrong wrong, enum outcome outcome)
{
    struct campaign_options options = options_with(wrong_engine(wrong));
    if (wrong == WRONG_HANG)
        options.limit = 2;
    run(&options);
    TEST_ASSERT_GREATER_THAN_UINT32(0, campaign.findings);
    const struct finding *finding = &campaign.finding[0].finding;
    TEST_ASSERT_EQUAL_INT_MESSAGE(outcome, finding->outcome, finding->what);
    TEST_ASSERT_LESS_THAN_UINT64(2000, campaign.cases);
}

static void wrong_colors_and_depths_are_found(void)
{
    expect_found(WRONG_COLOR, OUTCOME_DIFFERENT);
    TEST_ASSERT_NOT_NULL(strstr(campaign.finding[0].finding.what, "colour of pixel"));
    expect_found(WRONG_DEPTH, OUTCOME_DIFFERENT);
}

static void crashes_and_hangs_are_found_and_the_campaign_goes_on(void)
{
    expect_found(WRONG_HANG, OUTCOME_HUNG);
    struct campaign_options options = options_with(wrong_engine(WRONG_CRASH));
    options.enough = 2;
    run(&options);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(2, campaign.findings);
    TEST_ASSERT_EQUAL_STRING("ends with signal 6, Aborted", campaign.finding[0].finding.what);
}

static void found_cases_are_minimised(void)
{
    struct text smallest = {0};
    if (test_stride() > 1)
        TEST_IGNORE_MESSAGE("hundreds of processes draw; minimize.c has small cases");
    struct campaign_options options = options_with(wrong_engine(WRONG_COLOR));
    run(&options);
    campaign_case(options.seed, campaign.finding[0].number, &text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        0, campaign_minimize(&options, &campaign.finding[0].finding, &text, &smallest, &error), error.text);
    /* A declaration with all elements, four vertices and a draw. */
    TEST_ASSERT_TRUE_MESSAGE(smallest.length < 500, smallest.data);
    TEST_ASSERT_NOT_NULL(strstr(smallest.data, "state alphatestenable true"));
    TEST_ASSERT_NULL(strstr(smallest.data, "sampler"));
    text_free(&smallest);
}

/* Interrupts a campaign after some cases. */
static bool interrupt(void *user, const struct campaign *now)
{
    const uint64_t *cases = user;
    return now->cases >= *cases;
}

static void expect_equal_results(const struct campaign *expected, const struct campaign *got)
{
    TEST_ASSERT_EQUAL_UINT64(expected->cases, got->cases);
    TEST_ASSERT_EQUAL_UINT64_ARRAY(expected->outcomes, got->outcomes, OUTCOME_COUNT);
    TEST_ASSERT_EQUAL_UINT64(expected->pixels, got->pixels);
    TEST_ASSERT_EQUAL_UINT(expected->findings, got->findings);
    for (unsigned i = 0; i < expected->findings; i++) {
        TEST_ASSERT_EQUAL_UINT64(expected->finding[i].number, got->finding[i].number);
        TEST_ASSERT_EQUAL_INT(expected->finding[i].finding.outcome, got->finding[i].finding.outcome);
    }
}

/* Counts exactly the cases that are done. */
static void expect_consistent(const struct campaign *now)
{
    uint64_t sum = 0;
    for (unsigned o = 0; o < OUTCOME_COUNT; o++)
        sum += now->outcomes[o];
    TEST_ASSERT_EQUAL_UINT64(ranges_size(&now->done), now->cases);
    TEST_ASSERT_EQUAL_UINT64(sum, now->cases);
}

/* Continues again and again, with another number of processes each time. */
static void expect_continued(const struct campaign_options *options, const struct campaign *expected)
{
    static struct campaign parts[2];
    struct campaign_options part = *options;
    unsigned rounds = 0;
    for (uint64_t cases = 40; parts[0].cases < options->count; cases += 40, rounds++) {
        part.jobs = 1 + rounds % 3;
        part.earlier = &parts[0];
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, campaign_run(&part, interrupt, &cases, &parts[1], &error),
                                      error.text);
        expect_consistent(&parts[1]);
        struct campaign swapped = parts[0];
        parts[0] = parts[1];
        parts[1] = swapped;
    }
    TEST_ASSERT_GREATER_THAN_UINT(1, rounds);
    expect_equal_results(expected, &parts[0]);
    campaign_free(&parts[0]);
    campaign_free(&parts[1]);
}

static void a_continued_campaign_has_the_results_of_one(void)
{
    struct campaign_options options = options_with(NULL);
    options.first = 300;
    options.count = 400 / test_stride_of(8);
    run(&options);
    TEST_ASSERT_EQUAL_UINT64(1, campaign.done.count);
    TEST_ASSERT_EQUAL_UINT64(300, campaign.done.item[0].first);
    TEST_ASSERT_EQUAL_UINT64(299 + options.count, campaign.done.item[0].last);
    expect_continued(&options, &campaign);
}

static void findings_and_crashes_are_continued_too(void)
{
    struct campaign_options options = options_with(wrong_engine(WRONG_CRASH));
    options.count = 300 / test_stride_of(6);
    options.enough = CAMPAIGN_FINDINGS;
    run(&options);
    TEST_ASSERT_GREATER_THAN_UINT32(0, campaign.findings);
    expect_consistent(&campaign);
    if (campaign.cases == options.count)
        expect_continued(&options, &campaign);
}

static void nothing_is_drawn_twice(void)
{
    static struct campaign again;
    struct campaign_options options = options_with(NULL);
    options.count = 50;
    run(&options);
    options.earlier = &campaign;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, campaign_run(&options, NULL, NULL, &again, &error), error.text);
    expect_equal_results(&campaign, &again);
    campaign_free(&again);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(cases_are_the_same_every_time);
    RUN_TEST(every_state_and_value_occurs);
    RUN_TEST(cases_are_valid_and_draw);
    RUN_TEST(wrong_colors_and_depths_are_found);
    RUN_TEST(crashes_and_hangs_are_found_and_the_campaign_goes_on);
    RUN_TEST(found_cases_are_minimised);
    RUN_TEST(a_continued_campaign_has_the_results_of_one);
    RUN_TEST(findings_and_crashes_are_continued_too);
    RUN_TEST(nothing_is_drawn_twice);
    campaign_free(&campaign);
    return UNITY_END();
}
