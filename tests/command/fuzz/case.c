/* The generator of cases: its texts are streams, and have every call of the table of calls often enough. */
#include "capture/call.h"
#include "command/fuzz/campaign.h"
#include "command/fuzz/case/case.h"
#include "command/stream/stream.h"
#include "tests/support/system/seed.h"

#include <unity.h>

#include <stdlib.h>
#include <string.h>

/* A campaign of 100,000 cases has each call in at least 200 of them. */
enum { CASES = 4000, ONE_OF = 500 };

static unsigned cases, cases_with[CALL_TYPES], refused;
static char reason[640];

void setUp(void)
{
}

void tearDown(void)
{
}

static void count_calls(const struct stream *stream)
{
    bool found[CALL_TYPES] = {false};
    for (uint32_t i = 0; i < stream->call_count; i++)
        found[stream->calls[i].type] = true;
    for (int type = 0; type < CALL_TYPES; type++)
        cases_with[type] += found[type];
}

static void make_cases(uint64_t seed)
{
    struct text text = {0};
    cases = CASES / test_stride_of(3);
    for (uint64_t number = 0; number < cases; number++) {
        struct stream *stream;
        struct error error = {{0}};
        campaign_case(seed, number, &text);
        TEST_ASSERT_FALSE(text.failed);
        if (stream_parse("case", text.data, text.length, &stream, &error)) {
            refused++;
            snprintf(reason, sizeof reason, "case %u: %s", (unsigned)number, error.text);
            continue;
        }
        count_calls(stream);
        stream_free(stream);
    }
    text_free(&text);
}

static void every_case_is_a_stream(void)
{
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, refused, reason);
}

static void expect_frequent(enum call_type type, const char *name)
{
    char message[128];
    snprintf(message, sizeof message, "%s is in %u of %u cases", name, cases_with[type], cases);
    TEST_ASSERT_TRUE_MESSAGE(cases_with[type] >= cases / ONE_OF, message);
}

static void every_call_is_frequent(void)
{
#define CALL(name, ...)      expect_frequent(CALL_##name, #name);
#define CALL_OF(name, ...)   expect_frequent(CALL_##name, #name);
#define CALL_BARE(name, ...) expect_frequent(CALL_##name, #name);
#include "capture/call.def"
#undef CALL
#undef CALL_OF
#undef CALL_BARE
}

static void a_case_depends_only_on_its_seed_and_number(void)
{
    struct text first = {0}, other = {0};
    campaign_case(3, 7, &first);
    campaign_case(3, 8, &other);
    TEST_ASSERT_TRUE(strcmp(first.data, other.data));
    campaign_case(3, 7, &other);
    TEST_ASSERT_EQUAL_STRING(first.data, other.data);
    text_free(&first);
    text_free(&other);
}

int main(void)
{
    UNITY_BEGIN();
    make_cases(1);
    RUN_TEST(every_case_is_a_stream);
    RUN_TEST(every_call_is_frequent);
    RUN_TEST(a_case_depends_only_on_its_seed_and_number);
    return UNITY_END();
}
