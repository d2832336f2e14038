/* The estimates of the pass shape, and what follows from them and from the coverage of blocks. */
#include "engines/specialize/sixteen.h"
#include "engines/specialize/specialize.h"
#include "base/random.h"
#include "tests/support/system/seed.h"

#include <string.h>
#include <unity.h>

static struct builder *builder;
static struct error error;

void setUp(void)
{
    error_clear(&error);
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
}

void tearDown(void)
{
    specialize_give(builder);
}

/* --- Coverage ------------------------------------------------------------------------------------------- */

static void blocks_with_both_halves_are_counted(void)
{
    enum { MOST = 37, ROUNDS = 200 };
    static const uint16_t edges[] = {1, 0x80, 0x100, 0x8000, 0x8001, 0xff, 0xff00, 0xffff, 0x180, 0x0ff0};
    struct entry entries[MOST];
    struct random source = random_start(test_seed(), 0);
    for (unsigned round = 0; round < ROUNDS; round++) {
        uint32_t count = round % (MOST + 1), expected = 0;
        memset(entries, round & 1 ? 0xff : 0, sizeof entries);
        for (uint32_t i = 0; i < count; i++) {
            entries[i].coverage = edges[random_below(&source, sizeof edges / sizeof *edges)];
            entries[i].block = (uint16_t)random_below(&source, 256);
            expected += entries[i].coverage % 256 != 0 && entries[i].coverage / 256 != 0;
        }
        TEST_ASSERT_EQUAL_UINT32(expected, specialize_count_both(entries, count));
    }
}

static void many_blocks_are_sampled(void)
{
    enum { MANY = 1000 };
    static struct entry entries[MANY];
    for (uint32_t i = 0; i < MANY; i++)
        entries[i].coverage = i % 16 < 4 ? 0xff : 0x180;
    TEST_ASSERT_UINT32_WITHIN(MANY / 4, 3 * MANY / 4, specialize_count_both(entries, MANY));
    for (uint32_t i = 0; i < MANY; i++)
        entries[i].coverage = 0x180;
    TEST_ASSERT_EQUAL_UINT32(MANY, specialize_count_both(entries, MANY));
    memset(entries, 0, sizeof entries);
    TEST_ASSERT_EQUAL_UINT32(0, specialize_count_both(entries, MANY));
}

static void entries_with_the_same_record_are_pairs(void)
{
    enum { MANY = 1000 };
    static struct entry entries[MANY];
    const uint32_t triangle[7] = {64, 64, 64, 128, 192, 192, 192};
    for (uint32_t i = 0; i < 7; i++)
        entries[i] = (struct entry){.block = (uint16_t)(i % 2), .triangle = triangle[i]};
    TEST_ASSERT_EQUAL_UINT32(2, specialize_count_pairs(entries, 7));
    TEST_ASSERT_EQUAL_UINT32(1, specialize_count_pairs(entries, 3));
    TEST_ASSERT_EQUAL_UINT32(0, specialize_count_pairs(entries, 1));
    TEST_ASSERT_EQUAL_UINT32(0, specialize_count_pairs(entries, 0));
    for (uint32_t i = 0; i < MANY; i++)
        entries[i] = (struct entry){.block = (uint16_t)(i % 2)};
    TEST_ASSERT_EQUAL_UINT32(MANY / 2, specialize_count_pairs(entries, MANY));
    entries[1].block = 0; /* the same block twice */
    TEST_ASSERT_EQUAL_UINT32(1, specialize_count_pairs(entries, 4));
    for (uint32_t i = 0; i < MANY; i++)
        entries[i].triangle = i;
    TEST_ASSERT_EQUAL_UINT32(0, specialize_count_pairs(entries, MANY));
}

/* With 100 and 30 cycles: a pass over two blocks takes 60, also with one of them. */
static void the_pairs_of_a_call_decide(void)
{
    const struct pass_shapes shapes = {100, 60, 30};
    TEST_ASSERT_TRUE(specialize_prefers_pairs(&shapes, 10, 10, 5));
    TEST_ASSERT_TRUE(specialize_prefers_pairs(&shapes, 10, 10, 0));
    TEST_ASSERT_TRUE(specialize_prefers_pairs(&shapes, 10, 0, 2));
    TEST_ASSERT_FALSE(specialize_prefers_pairs(&shapes, 10, 0, 1));
}

/* With 100 and 60 cycles, a block takes 50 for each half that is covered, or 60. Where both kinds of block
 * alternate, each of the rarer kind takes 20 more. */
static void the_coverage_of_a_call_decides(void)
{
    const struct pass_shapes shapes = {100, 60, 0};
    TEST_ASSERT_TRUE(specialize_prefers_sixteen(&shapes, 10, 10));
    TEST_ASSERT_TRUE(specialize_prefers_sixteen(&shapes, 10, 2));
    TEST_ASSERT_FALSE(specialize_prefers_sixteen(&shapes, 10, 1));
    TEST_ASSERT_FALSE(specialize_prefers_sixteen(&shapes, 10, 0));
    TEST_ASSERT_FALSE(specialize_prefers_sixteen(&(struct pass_shapes){100, 95, 0}, 10, 7));
    TEST_ASSERT_TRUE(specialize_prefers_sixteen(&(struct pass_shapes){100, 95, 0}, 10, 9));
    TEST_ASSERT_TRUE(specialize_is_worth(&shapes));
    TEST_ASSERT_FALSE(specialize_is_worth(&(struct pass_shapes){100, 99, 0}));
    TEST_ASSERT_FALSE(specialize_is_worth(&(struct pass_shapes){0, 0, 0}));
}

/* --- Programs ------------------------------------------------------------------------------------------- */

static uint16_t append(enum ir_op op, int32_t k, unsigned a, unsigned b, unsigned c)
{
    return ir_append(&builder->ir,
                     (struct ir_instruction){.op = (uint8_t)op,
                                             .type = TYPE_flt,
                                             .base = BASE_LANES,
                                             .k = k,
                                             .operand = {(uint16_t)a, (uint16_t)b, (uint16_t)c}});
}

/* Estimates a program of `chains` sums. To each of them `length` values are added, one after the other. */
static struct pass_shapes estimate(unsigned chains, unsigned length)
{
    enum { CHAINS = 64 };
    uint16_t sum[CHAINS];
    ir_start(&builder->ir);
    uint16_t step = append(IR_load, 0, 0, 0, 0);
    for (unsigned i = 0; i < chains; i++)
        sum[i] = append(IR_load, 4 * (int32_t)i, 0, 0, 0);
    for (unsigned n = 0; n < length; n++)
        for (unsigned i = 0; i < chains; i++)
            sum[i] = append(IR_add_f, 0, sum[i], step, 0);
    for (unsigned i = 0; i < chains; i++)
        append(IR_store, 4 * (int32_t)i, sum[i], 0, 0);
    builder->pass.lanes = 8;
    builder->pass.parts = 1;
    builder->pass.judges = true;
    builder->pass.may_pair = false;
    builder->pass.shapes = (struct pass_shapes){0};
    TEST_ASSERT_EQUAL_UINT(0, pass_shape(&builder->ir, &builder->pass));
    return builder->pass.shapes;
}

/* A sum of 2,000 additions waits 8,000 cycles. Little of the next pass is within reach meanwhile. */
static void halves_hide_the_latency_of_a_chain(void)
{
    const struct pass_shapes shapes = estimate(1, 2000);
    TEST_ASSERT_UINT32_WITHIN(1600, 16000, shapes.one);
    TEST_ASSERT_UINT32_WITHIN(800, 8000, shapes.two);
}

/* The next pass of a short program is within reach. */
static void a_short_chain_needs_no_second_register(void)
{
    const struct pass_shapes shapes = estimate(1, 8), chain = estimate(1, 2000);
    TEST_ASSERT_LESS_THAN_UINT32(chain.one * shapes.two, chain.two * shapes.one);
}

/* Twelve sums keep the processor busy, but twice as many need more registers than there are. */
static void values_without_a_register_cost(void)
{
    const struct pass_shapes shapes = estimate(12, 40);
    TEST_ASSERT_GREATER_OR_EQUAL(shapes.one, shapes.two);
    TEST_ASSERT_FALSE(specialize_is_worth(&shapes));
}

/* A program that has both chunks of a block takes half of the time of two passes. */
static void one_pass_of_both_chunks_is_a_block(void)
{
    const struct pass_shapes two_passes = estimate(3, 200);
    builder->ir.chunks = 2;
    builder->pass.shapes = (struct pass_shapes){0};
    pass_shape(&builder->ir, &builder->pass);
    TEST_ASSERT_UINT32_WITHIN(two_passes.one / 10, two_passes.one / 2, builder->pass.shapes.one);
}

static void the_program_stays_and_is_estimated_once(void)
{
    static struct ir before;
    estimate(3, 20);
    ir_duplicate(&before, &builder->ir);
    builder->pass.shapes = (struct pass_shapes){1, 2, 3};
    pass_shape(&builder->ir, &builder->pass);
    TEST_ASSERT_EQUAL_UINT32(1, builder->pass.shapes.one);
    TEST_ASSERT_EQUAL_UINT32(before.count, builder->ir.count);
    TEST_ASSERT_EQUAL_MEMORY(before.instruction, builder->ir.instruction,
                             before.count * sizeof *before.instruction);
}

/* Chooses the parts of the program that was estimated, as if it took these cycles. */
static unsigned choose(struct pass_shapes shapes, bool may_pair)
{
    builder->pass.parts = 2;
    builder->pass.may_pair = may_pair;
    builder->pass.shapes = shapes;
    TEST_ASSERT_EQUAL_UINT(0, pass_shape(&builder->ir, &builder->pass));
    return builder->pass.parts;
}

static void two_blocks_are_chosen_where_they_are_faster(void)
{
    estimate(1, 8);
    TEST_ASSERT_EQUAL_UINT(4, choose((struct pass_shapes){200, 160, 149}, true));
    TEST_ASSERT_EQUAL_UINT(2, choose((struct pass_shapes){200, 160, 149}, false));
    TEST_ASSERT_EQUAL_UINT(2, choose((struct pass_shapes){200, 160, 150}, true));
    TEST_ASSERT_EQUAL_UINT(4, choose((struct pass_shapes){150, 128, 100}, true));
    TEST_ASSERT_EQUAL_UINT(2, choose((struct pass_shapes){150, 127, 100}, true));
}

/* A loop runs until the last lane of both blocks leaves it. */
static void loops_of_two_blocks_have_to_be_faster_by_more(void)
{
    estimate(1, 8);
    append(IR_loop, 0, 0, 0, 0);
    builder->ir.loops = 1;
    TEST_ASSERT_EQUAL_UINT(2, choose((struct pass_shapes){200, 160, 149}, true));
    TEST_ASSERT_EQUAL_UINT(4, choose((struct pass_shapes){200, 160, 139}, true));
}

/* A chain of 2,000 additions with a store of a colour: four registers hide more of its latency than two. The
 * estimate of a program that cannot have two blocks is 0. */
static void two_blocks_are_estimated_where_they_are_possible(void)
{
    struct pass_shapes shapes = estimate(1, 2000);
    TEST_ASSERT_EQUAL_UINT32(0, shapes.four);
    builder->ir.instruction[builder->ir.count - 1].base = BASE_COLOR;
    TEST_ASSERT_EQUAL_UINT(4, choose((struct pass_shapes){0}, true));
    shapes = builder->pass.shapes;
    TEST_ASSERT_UINT32_WITHIN(shapes.two / 10, shapes.two / 2, shapes.four);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(blocks_with_both_halves_are_counted);
    RUN_TEST(many_blocks_are_sampled);
    RUN_TEST(entries_with_the_same_record_are_pairs);
    RUN_TEST(the_pairs_of_a_call_decide);
    RUN_TEST(the_coverage_of_a_call_decides);
    RUN_TEST(halves_hide_the_latency_of_a_chain);
    RUN_TEST(a_short_chain_needs_no_second_register);
    RUN_TEST(values_without_a_register_cost);
    RUN_TEST(one_pass_of_both_chunks_is_a_block);
    RUN_TEST(the_program_stays_and_is_estimated_once);
    RUN_TEST(two_blocks_are_chosen_where_they_are_faster);
    RUN_TEST(loops_of_two_blocks_have_to_be_faster_by_more);
    RUN_TEST(two_blocks_are_estimated_where_they_are_possible);
    return UNITY_END();
}
