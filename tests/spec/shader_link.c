/* How the halves of a draw meet, on every engine: elements of any usage, vertex and pixel shaders of any models and
 * the fixed function on either side, what nobody gives, and how values travel. */
#include "tests/support/drawn.h"

#include <stdio.h>
#include <string.h>

void setUp(void)
{
    drawn_begin();
}

void tearDown(void)
{
    close_canvas();
}

static const char *const usage_names[TRIPTYCH_USAGE_COUNT] = {
    "position", "blendweight", "blendindices", "normal", "psize", "texcoord", "tangent",
    "binormal", "tessfactor",  "positiont",    "color",  "fog",   "depth",    "sample"};

/* --- Inputs -----------------------------------------------------------------------------------------------
 */

static void check_usages(void)
{
    char text[256], what[64];
    use_float_target();
    for (unsigned usage = 0; usage < TRIPTYCH_USAGE_COUNT; usage++)
        for (unsigned index = usage % 3; index < 16; index += 5) {
            if (usage == TRIPTYCH_USAGE_POSITIONT || (usage == TRIPTYCH_USAGE_POSITION && !index))
                continue;
            float tag = (float)(usage * 16 + index);
            struct drawn_element elements[2] = {
                drawn_constant(usage, index, tag, tag + 0.25f, tag + 0.5f, tag + 0.75f),
                drawn_constant(usage == TRIPTYCH_USAGE_SAMPLE ? TRIPTYCH_USAGE_DEPTH : TRIPTYCH_USAGE_SAMPLE,
                               15, 9, 9, 9, 9)};
            snprintf(what, sizeof what, "%s%u", usage_names[usage], index);
            snprintf(text, sizeof text,
                     "vs_3_0\ndcl_position v0\ndcl_%s v7\ndcl_position o0\ndcl_tangent3 o5\n"
                     "mov o0, v0\nmov o5, v7\n",
                     what);
            use_shaders(text, "ps_3_0\ndcl_tangent3 v4\nmov oC0, v4\n");
            draw_declared(TRIPTYCH_USAGE_POSITION, elements, 2);
            read_numbers(0);
            EXPECT_CENTRE(what, tag, tag + 0.25f, tag + 0.5f, tag + 0.75f);
        }
}

static void test_elements_of_every_usage_reach_the_shader(void)
{
    on_every_engine(check_usages);
}

static void check_missing(void)
{
    use_float_target();
    use_shaders("vs_1_1\ndcl_position v0\ndcl_tangent v1\nmov oPos, v0\nmov oT0, v1\n",
                "ps_2_0\ndcl t0\nmov r0, t0\nmov oC0, r0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("nothing declared", 0, 0, 0, 1);
}

static void test_elements_that_are_missing_are_0_0_0_1(void)
{
    on_every_engine(check_missing);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_elements_of_every_usage_reach_the_shader);
    RUN_TEST(test_elements_that_are_missing_are_0_0_0_1);
    return UNITY_END();
}
