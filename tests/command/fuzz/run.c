/* The runner: a device draws a case once for each number of threads, so a case whose draws read what its
 * later calls change is the same again only if all of it is made as it was. */
#include "command/fuzz/run.h"
#include "contract/arguments.h"
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
        enum outcome outcome =
            runner_run(runner, "case.tri", text, strlen(text), &(struct setting_values){{0}}, &finding);
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

/* The second frame shows what the first one drew. */
static void frames_are_drawn_in_their_order(void)
{
    expect_same("triptych 1\ntarget 8 8\ntexture t0 2d A8R8G8B8 4 4 gradient\n" SAMPLES_T0
                "clear color 0 0 0 1\ndraw triangles 0 1\nframe\nstate alphablendenable true\n"
                "state srcblend one\nstate destblend one\ndraw triangles 0 1\n");
}

/* --- Processed vertices --- */

static struct engine wrong;
static routine_function *right_run;

static void run_wrongly(const void *arguments, const struct routine *routine)
{
    const struct vertex_arguments *call = arguments;
    right_run(arguments, routine);
    call->out[SLOT_specular * VERTEX_CAPACITY] += 1;
}

/* An engine whose routines are wrong if all varyings are computed. The draws of a case need fewer. */
static struct routine *build_wrongly(const struct engine *self, struct code_arena *arena, enum unit unit,
                                     const union key *key, struct error *error)
{
    const struct engine *right = engine_at(0);
    struct routine *routine = right->build(right, arena, unit, key, error);
    (void)self;
    if (routine && unit == UNIT_VERTEX && key->vertex.varying[VARYING_specular]) {
        right_run = routine->run;
        routine->run = run_wrongly;
    }
    return routine;
}

static void processed_vertices_are_compared(void)
{
    static const char text[] = "triptych 1\ntarget 8 8\ntexture t0 2d A8R8G8B8 4 4 gradient\n" SAMPLES_T0
                               "clear color 0 0 0 1\ndraw triangles 0 1\n";
    const struct runner_options options = {{engine_at(0), &wrong}, 2, {1, 2}, 2};
    struct error error = {{0}};
    struct finding finding;
    wrong = *engine_at(0);
    wrong.build = build_wrongly;
    struct runner *both = runner_create(&options, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(both, error.text);
    enum outcome outcome =
        runner_run(both, "case.tri", text, sizeof text - 1, &(struct setting_values){{0}}, &finding);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("different", outcome_name[outcome], finding.what);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(finding.what, "processed vertex number 0"), finding.what);
    runner_destroy(both);
}

/* With range=off a hidden draw fills the tile, and the clear of a channel finds no pending clear. */
static void pixels_outside_of_the_target_do_not_depend_on_settings(void)
{
    static const char text[] = "triptych 1\ntarget 2 1\nvertices v0 position:float4 {\n0 -1 0 0\n-1 0 0 0\n"
                               "0 0 0 0\n0 0 1 1\n}\nbind vertices v0\nclear depth 0\n"
                               "draw quadstrip 0 1\nclear color 1 0 0 0 colormask 1\n";
    const struct runner_options options = {{engine_at(0), engine_at(0)}, 2, {1, 2}, 2};
    struct setting_values settings = {{0}};
    struct error error = {{0}};
    struct finding finding;
    settings.of[SETTING_range] = SETTING_range_off;
    struct runner *both = runner_create(&options, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(both, error.text);
    enum outcome outcome = runner_run(both, "case.tri", text, sizeof text - 1, &settings, &finding);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("same", outcome_name[outcome], finding.what);
    runner_destroy(both);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(pixels_outside_of_the_target_do_not_depend_on_settings);
    RUN_TEST(textures_that_are_copied_to_begin_anew);
    RUN_TEST(textures_that_are_drawn_to_begin_anew);
    RUN_TEST(textures_that_are_filled_begin_anew);
    RUN_TEST(frames_are_drawn_in_their_order);
    RUN_TEST(processed_vertices_are_compared);
    return UNITY_END();
}
