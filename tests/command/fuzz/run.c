/* The runner: a device draws a case once for each number of threads, so a case whose draws read what its
 * later calls change is the same again only if all of it is made as it was. */
#include "command/fuzz/run.h"
#include "engines/list.h"

#include <unity.h>

#include <string.h>

static struct runner *runner;

void setUp(void)
{
    const struct runner_options options = {{engine_at(0)}, 1, {1, 2}, 2};
    struct error error = {{0}};
    runner = runner_create(&options, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(runner, error.text);
}

void tearDown(void)
{
    runner_destroy(runner);
}

/* A triangle over the whole target, lit by t0. */
#define SAMPLES_T0                                                                                           \
    "state lighting false\nstate cullmode none\n"                                                            \
    "vertices v0 position:float3 texcoord:float2 {\n-1 3 0 0 0\n-1 -1 0 0 1\n3 -1 0 1 1\n}\n"                \
    "bind vertices v0\nbind texture t0\nstage 0 colorop selectarg1\nstage 0 colorarg1 texture\n"

static void expect_same(const char *text)
{
    struct finding finding;
    for (int again = 0; again < 2; again++) {
        enum outcome outcome = runner_run(runner, "case.tri", text, strlen(text), &finding);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("same", outcome_name[outcome], finding.what);
    }
    TEST_ASSERT_TRUE(runner_pixels(runner) > 0);
}

static void textures_that_are_copied_to_begin_anew(void)
{
    expect_same("triptych 1\ntarget 8 8\ntexture t0 2d A8R8G8B8 4 4 gradient\n" SAMPLES_T0
                "clear color 0 0 0 1\ndraw triangles 0 1\ncopy target part 0 0 2 2 to t0\n");
}

static void textures_that_are_drawn_to_begin_anew(void)
{
    expect_same("triptych 1\ntarget 8 8\ntexture t0 2d A8R8G8B8 4 4 gradient\n" SAMPLES_T0
                "clear color 0 0 0 1\ndraw triangles 0 1\nattach color t0\nclear color 0.5 0.25 1 1\n");
}

static void textures_that_are_filled_begin_anew(void)
{
    expect_same("triptych 1\ntarget 8 8\ntexture t0 2d A8R8G8B8 4 4 gradient\n" SAMPLES_T0
                "clear color 0 0 0 1\ndraw triangles 0 1\nfill t0 color 0.5 0.25 1 1\n");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(textures_that_are_copied_to_begin_anew);
    RUN_TEST(textures_that_are_drawn_to_begin_anew);
    RUN_TEST(textures_that_are_filled_begin_anew);
    return UNITY_END();
}
