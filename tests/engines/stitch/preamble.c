/* The parts of a routine's loop have nothing that is the same for a whole call
 * (src/engines/stitch/operations.c). That results stay the same is tested by program.c and equal.c. */
#include "engines/stitch/plan.h"
#include "tests/support/shader/programs.h"
#include <unity.h>

static struct plan *plan;

void setUp(void)
{
    struct error error = {{0}};
    plan = plan_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(plan, error.text);
}

void tearDown(void)
{
    plan_give(plan);
}

/* The part with which the loop of vertices, or of entries, begins. */
static unsigned find_top(void)
{
    unsigned part = 0;
    while (plan->part[part].fragment != &fragment_vertex_begin &&
           plan->part[part].fragment != &fragment_pixel_begin)
        part++;
    for (unsigned last = plan->count; --last > part;)
        if (plan->part[last].fragment == &fragment_vertex_next)
            return (unsigned)plan->part[last].arguments.vertex_next.to_loop;
        else if (plan->part[last].fragment == &fragment_pixel_next)
            return (unsigned)plan->part[last].arguments.pixel_next.to_entry;
    TEST_FAIL_MESSAGE("no loop");
    return 0;
}

static unsigned count(const struct fragment *fragment, unsigned from, unsigned to)
{
    unsigned found = 0;
    for (unsigned part = from; part < to; part++)
        found += plan->part[part].fragment == fragment || plan->part[part].fragment == fragment + 1;
    return found;
}

static void make(enum unit unit, const char *name)
{
    const union key key = sample_key(unit, name);
    struct error error = {{0}};
    plan_operations(plan, unit, &key);
    TEST_ASSERT_EQUAL_MESSAGE(0, plan_complete(plan, &error), error.text);
    TEST_ASSERT_EQUAL_MESSAGE(0, plan_check(plan, &error), error.text);
}

/* The product of two matrices of constants, a normalized constant, and a comparison of constants. */
static void a_vertex_shader_repeats_nothing_that_is_of_constants(void)
{
    make(UNIT_VERTEX, "vertex_uniform");
    unsigned top = find_top();
    TEST_ASSERT_EQUAL(1, count(&fragment_sqrt_f, 0, top));
    TEST_ASSERT_EQUAL(0, count(&fragment_sqrt_f, top, plan->count));
    TEST_ASSERT_EQUAL(1, count(&fragment_div_f, 0, top));
    TEST_ASSERT_EQUAL(0, count(&fragment_div_f, top, plan->count));
    TEST_ASSERT_GREATER_OR_EQUAL(64 + 9, top); /* the product, the direction */
}

/* Inside of the region of the covered lanes. */
static void a_pixel_shader_repeats_nothing_that_is_of_constants(void)
{
    make(UNIT_PIXEL, "pixel_uniform");
    unsigned top = find_top();
    TEST_ASSERT_EQUAL(1, count(&fragment_sqrt_f, 0, top));
    TEST_ASSERT_EQUAL(0, count(&fragment_sqrt_f, top, plan->count));
    TEST_ASSERT_EQUAL(1, count(&fragment_div_f, 0, top));
    TEST_ASSERT_EQUAL(1, count(&fragment_div_f, top, plan->count)); /* by w */
}

static void few_operations_leave_a_region_that_may_be_skipped(void)
{
    unsigned usual = 0, once = 0, depth = 0;
    make(UNIT_PIXEL, "pixel_uniform");
    for (uint32_t n = 1; n < plan->operations; n++) {
        const struct operation *operation = &plan->operation[n];
        depth += operation->kind == OPERATION_WHEN;
        depth -= operation->kind == OPERATION_END;
        usual += depth < 2 && operation->once == ONCE_NOT;
        once += depth > 1 && operation->once == ONCE_COMPUTED;
    }
    TEST_ASSERT_LESS_OR_EQUAL(usual / 8, once);
    TEST_ASSERT_GREATER_THAN(0, once);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_vertex_shader_repeats_nothing_that_is_of_constants);
    RUN_TEST(a_pixel_shader_repeats_nothing_that_is_of_constants);
    RUN_TEST(few_operations_leave_a_region_that_may_be_skipped);
    return UNITY_END();
}
