/* The code of a routine's loop has nothing that is the same for a whole call (passes/preamble.c), and no
 * selection by a uniform condition (passes/condition.c): its instructions are counted. That results stay the
 * same is tested by sequence.c, pass.c and equal.c; that the code reads the right values by placement.c. */
#include "machine/disassemble.h"
#include "engines/specialize/build.h"
#include "engines/specialize/passes/pass.h"
#include "engines/specialize/specialize.h"
#include "tests/support/routine/routines.h"
#include "tests/support/shader/programs.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <string.h>

static struct builder *builder;
static struct error error;

void setUp(void)
{
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
}

void tearDown(void)
{
    specialize_give(builder);
}

/* --- The code of two shaders ---------------------------------------------------------------------------- */

/* The instructions of a routine's preamble, of the repeated part, and of these the ones with each name. */
struct listing {
    unsigned once, repeated, roots, divisions, masks, selections;
};

static bool begins(const char *text, const char *name)
{
    return !strncmp(text, name, strlen(name));
}

/* The number of the IR instruction that the code at an offset belongs to; 0: the frame. */
static uint32_t instruction_at(size_t offset)
{
    uint32_t line = builder->emitter.lines;
    while (line && builder->emitter.line[line - 1].offset > offset)
        line--;
    return line ? builder->emitter.line[line - 1].instruction : 0;
}

static void note(void *context, size_t offset, size_t length, const char *text)
{
    struct listing *listing = context;
    uint32_t number = instruction_at(offset);
    (void)length;
    if (!number)
        return;
    if (number < ir_find_body(&builder->ir) || builder->allocation.residence[number] == RESIDENCE_KEPT) {
        listing->once++;
        return;
    }
    listing->repeated++;
    listing->roots += begins(text, "vsqrt");
    listing->divisions += begins(text, "vdiv");
    listing->masks += begins(text, "vcmp");
    listing->selections += begins(text, "vblendv");
}

static struct listing list(enum unit unit, const char *name, uint32_t disabled)
{
    struct listing listing = {0};
    const union key key = sample_key(unit, name);
    struct build_options options = specialize_options(&engine_specialize_8, unit);
    options.disabled = disabled;
    TEST_ASSERT_MESSAGE(specialize_code(builder, &options, unit, &key, NULL, NULL, &error), error.text);
    disassemble(builder->emitter.code, builder->emitter.code_bytes, 0, note, &listing);
    return listing;
}

enum { NEITHER = 1u << PASS_preamble | 1u << PASS_condition };

/* The product of two matrices of constants, a normalized constant, and a comparison of constants. */
static void test_a_vertex_shader_repeats_nothing_that_is_of_constants(void)
{
    struct listing without = list(UNIT_VERTEX, "vertex_uniform", NEITHER);
    TEST_ASSERT_EQUAL(0, without.once);
    TEST_ASSERT_EQUAL(1, without.roots);
    TEST_ASSERT_EQUAL(1, without.divisions);
    struct listing with = list(UNIT_VERTEX, "vertex_uniform", 0);
    TEST_ASSERT_EQUAL(0, with.roots + with.divisions);
    TEST_ASSERT_EQUAL(0, with.selections);
    TEST_ASSERT_EQUAL(without.masks - 2, with.masks); /* zero length; the condition */
    TEST_ASSERT_EQUAL(406, without.repeated);         /* the numbers of docs/specializer.md */
    TEST_ASSERT_EQUAL(241, with.repeated);
    TEST_ASSERT_EQUAL(167, with.once);
}

/* A normalized constant and two conditions of constants, inside of the region of the covered lanes. */
static void test_a_pixel_shader_repeats_nothing_that_is_of_constants(void)
{
    struct listing without = list(UNIT_PIXEL, "pixel_uniform", NEITHER);
    struct listing with = list(UNIT_PIXEL, "pixel_uniform", 0);
    TEST_ASSERT_EQUAL(1, without.roots);
    TEST_ASSERT_EQUAL(0, with.roots);
    TEST_ASSERT_EQUAL(2, without.divisions);
    TEST_ASSERT_EQUAL(1, with.divisions);  /* by w */
    TEST_ASSERT_EQUAL(1, with.masks);      /* the condition of lanes */
    TEST_ASSERT_EQUAL(5, with.selections); /* its four results, and the write */
    TEST_ASSERT_EQUAL(167, without.repeated);
    TEST_ASSERT_EQUAL(137, with.repeated);
    TEST_ASSERT_EQUAL(26, with.once);
}

/* --- Uniform conditions --------------------------------------------------------------------------------- */

/* The number of machine instructions of an IR instruction. */
struct counted {
    uint32_t number;
    unsigned instructions;
};

static void count_instruction(void *context, size_t offset, size_t length, const char *text)
{
    struct counted *counted = context;
    (void)length, (void)text;
    counted->instructions += instruction_at(offset) == counted->number;
}

static unsigned instructions_of(uint32_t number)
{
    struct counted counted = {number, 0};
    disassemble(builder->emitter.code, builder->emitter.code_bytes, 0, count_instruction, &counted);
    return counted.instructions;
}

static void test_a_uniform_condition_is_a_comparison_and_a_jump(void)
{
    const uint32_t body = (list(UNIT_PIXEL, "pixel_uniform", 0), ir_find_body(&builder->ir));
    unsigned uniform = 0;
    for (uint32_t n = body; n < builder->ir.count; n++) {
        const struct ir_instruction *i = &builder->ir.instruction[n];
        if (i->op != IR_when || i->operand[0] >= body)
            continue;
        TEST_ASSERT_EQUAL(2, instructions_of(n));
        uniform++;
    }
    TEST_ASSERT_EQUAL(3, uniform);
}

/* --- What moves ----------------------------------------------------------------------------------------- */

static uint8_t section[IR_CAPACITY];
static unsigned moved, repeated;

/* Outside of regions that may be skipped in a whole call, each operation of the body depends on an
 * element. */
static void check_body(const struct ir *ir)
{
    unsigned depth = 0, uniform = 0;
    pass_find_sections(ir, section);
    for (uint32_t n = ir_find_body(ir); n < ir->count; n++) {
        const struct ir_instruction *i = &ir->instruction[n];
        depth += (ir_properties(i) & IR_OPENS) != 0;
        if (i->op == IR_when && section[i->operand[0]] == IR_SECTION_CALL && !uniform)
            uniform = depth;
        if (depth < 2 && !uniform && ir_properties(i) & IR_COMPUTES) {
            TEST_ASSERT_EQUAL_MESSAGE(IR_SECTION_BODY, section[n], ir_op_information[i->op].name);
            repeated++;
        }
        if (ir_properties(i) & IR_CLOSES && uniform == depth)
            uniform = 0;
        depth -= (ir_properties(i) & IR_CLOSES) != 0;
    }
    for (uint32_t n = 1; n < ir_find_body(ir); n++)
        moved += (ir_properties(&ir->instruction[n]) & IR_COMPUTES) != 0;
}

static void check_routine(void *context, enum unit unit, const union key *key)
{
    const struct build_options options = specialize_options(&engine_specialize_8, unit);
    (void)context;
    ir_record(&builder->ir, unit, key);
    specialize_run_passes(builder, &options, NULL, NULL);
    if (!builder->ir.separated) /* the span reading has a section of triangles instead */
        check_body(&builder->ir);
}

static void test_no_operation_of_a_body_is_the_same_in_the_whole_call(void)
{
    moved = repeated = 0;
    visit_random_keys(test_share(400), test_seed(), check_routine, NULL);
    visit_shaders(test_seed(), check_routine, NULL);
    TEST_ASSERT_GREATER_THAN(test_share(2000), moved);
    TEST_ASSERT_GREATER_THAN(test_share(20000), repeated);
}

/* --- Programs made here --------------------------------------------------------------------------------- */

static uint16_t append(enum ir_op op, enum ir_type type, uint16_t a, uint16_t b, int k)
{
    enum base base = op == IR_store ? BASE_OUTPUT : op == IR_uniform ? BASE_JOB : BASE_INPUT;
    return ir_append(
        &builder->ir,
        (struct ir_instruction){
            .op = (uint8_t)op, .type = (uint8_t)type, .base = (uint8_t)base, .operand = {a, b}, .k = k});
}

static unsigned run_preamble(void)
{
    unsigned changed = pass_preamble(&builder->ir, &builder->pass);
    const char *wrong = ir_verify(&builder->ir);
    TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
    return changed;
}

static unsigned count_moved(void)
{
    unsigned count = 0;
    for (uint32_t n = 1; n < ir_find_body(&builder->ir); n++)
        count += (ir_properties(&builder->ir.instruction[n]) & IR_COMPUTES) != 0;
    return count;
}

/* `outside` operations of lanes; a region with as many operations on words of the job as `inside`. */
static void make_region(unsigned outside, unsigned inside, bool uniform)
{
    ir_start(&builder->ir);
    uint16_t lanes = append(IR_load, TYPE_flt, 0, 0, 0), word = append(IR_uniform, TYPE_flt, 0, 0, 0);
    uint16_t value = lanes, chain = word;
    for (unsigned n = 1; n < outside; n++)
        value = append(IR_add_f, TYPE_flt, value, lanes, 0);
    append(IR_when, TYPE_non, append(IR_lt_f, TYPE_msk, uniform ? word : value, word, 0), 0, 0);
    for (unsigned n = 0; n < inside; n++)
        chain = append(IR_mul_f, TYPE_flt, chain, word, 0);
    append(IR_store, TYPE_non, append(IR_add_f, TYPE_flt, value, chain, 0), 0, 0);
    append(IR_end, TYPE_non, 0, 0, 0);
}

/* The two uses of a condition, in its region and after the region. */
static void test_a_uniform_condition_is_true_in_its_region_only(void)
{
    ir_start(&builder->ir);
    uint16_t lanes = append(IR_load, TYPE_flt, 0, 0, 0), word = append(IR_uniform, TYPE_flt, 0, 0, 0);
    uint16_t condition = append(IR_lt_f, TYPE_msk, word, word, 0), use[2], uses = 0;
    uint16_t other = append(IR_lt_f, TYPE_msk, lanes, word, 0);
    append(IR_when, TYPE_non, condition, 0, 0);
    append(IR_and_m, TYPE_msk, condition, other, 0);
    append(IR_end, TYPE_non, 0, 0, 0);
    append(IR_and_m, TYPE_msk, condition, other, 0);
    builder->ir.phis = 1; /* as in programs with results that leave a region */
    TEST_ASSERT_EQUAL(1, pass_condition(&builder->ir, &builder->pass));
    for (uint32_t n = 1; n < builder->ir.count; n++)
        if (builder->ir.instruction[n].op == IR_and_m)
            use[uses++ % 2] = builder->ir.instruction[n].operand[0];
    TEST_ASSERT_EQUAL(2, uses);
    TEST_ASSERT_EQUAL(IR_literal, builder->ir.instruction[use[0]].op);
    TEST_ASSERT_EQUAL(IR_lt_f, builder->ir.instruction[use[1]].op);
}

static void test_few_operations_leave_a_region_that_may_be_skipped(void)
{
    make_region(80, 40, true);
    TEST_ASSERT_EQUAL(1 + 10, run_preamble()); /* the condition, and an eighth of 80 */
    TEST_ASSERT_EQUAL(0, run_preamble());
    TEST_ASSERT_EQUAL(1 + 10, count_moved());
    make_region(80, 40, false);
    TEST_ASSERT_EQUAL(40, run_preamble());
    make_region(80, 0, false);
    TEST_ASSERT_EQUAL(0, run_preamble());
    TEST_ASSERT_FALSE(builder->ir.preamble);
}

static void test_equal_operations_of_two_regions_move_as_one(void)
{
    ir_start(&builder->ir);
    uint16_t lanes = append(IR_load, TYPE_flt, 0, 0, 0), word = append(IR_uniform, TYPE_flt, 0, 0, 0);
    uint16_t mask = append(IR_lt_f, TYPE_msk, lanes, word, 0);
    for (int region = 0; region < 2; region++) {
        append(IR_when, TYPE_non, mask, 0, 0);
        uint16_t square = append(IR_mul_f, TYPE_flt, word, word, 0);
        append(IR_store, TYPE_non, append(IR_add_f, TYPE_flt, lanes, square, 0), 0, 64 * region);
        append(IR_end, TYPE_non, 0, 0, 0);
    }
    TEST_ASSERT_EQUAL(2, run_preamble());
    ir_compact(&builder->ir, builder->pass.map);
    TEST_ASSERT_EQUAL(1, count_moved());
}

/* A gather with an index of the call, from a pointer of the job or from the constants of the shader. */
static unsigned moves_gather(enum base base, int32_t field)
{
    ir_start(&builder->ir);
    uint16_t lanes = append(IR_load, TYPE_flt, 0, 0, 0), index = append(IR_uniform, TYPE_itg, 0, 0, 0);
    uint16_t gathered = append(IR_gather, TYPE_flt, index, 0, 0);
    builder->ir.instruction[gathered].base = (uint8_t)base;
    builder->ir.instruction[gathered].field = field;
    builder->ir.instruction[gathered].scale = 4;
    append(IR_store, TYPE_non, append(IR_mul_f, TYPE_flt, lanes, gathered, 0), 0, 0);
    return run_preamble();
}

/* A texture may be the target of the draw. */
static void test_reads_of_constants_move_but_not_those_of_textures(void)
{
    TEST_ASSERT_EQUAL(1, moves_gather(BASE_CONSTANT, GATHER_DIRECT));
    TEST_ASSERT_EQUAL(0, moves_gather(BASE_JOB, offsetof(struct job, texture[0].texels)));
}

/* A square of a word, and an addition of it to as many loads as `lanes`, all alive at the same time. */
static uint16_t allocate_square(unsigned lanes)
{
    const struct register_file file = {.wide = false};
    uint16_t load[32], sum = 0;
    ir_start(&builder->ir);
    uint16_t word = append(IR_uniform, TYPE_flt, 0, 0, 0), square = append(IR_mul_f, TYPE_flt, word, word, 0);
    for (unsigned n = 0; n < lanes; n++)
        load[n] = append(IR_load, TYPE_flt, 0, 0, (int)(32 * n));
    for (unsigned n = 0; n < lanes; n++)
        load[n] = append(IR_mul_f, TYPE_flt, load[n], load[lanes - 1], 0);
    for (unsigned n = 0; n < lanes; n++)
        sum = append(IR_sub_f, TYPE_flt, load[n], n ? sum : square, 0);
    append(IR_store, TYPE_non, sum, 0, 0);
    run_preamble();
    allocate_registers(&builder->ir, &builder->allocation, &file);
    return 2; /* the square's number */
}

static void test_a_result_keeps_its_register_if_the_body_leaves_one(void)
{
    const struct allocation *a = &builder->allocation;
    uint16_t square = allocate_square(8);
    TEST_ASSERT_EQUAL(IR_mul_f, builder->ir.instruction[square].op);
    TEST_ASSERT_EQUAL(RESIDENCE_REGISTER, a->residence[square]);
    TEST_ASSERT_EQUAL(NEVER, a->split[square]);
    TEST_ASSERT_EQUAL(a->repeat, a->last[square]);
    for (uint32_t n = a->section; n < a->repeat; n++)
        TEST_ASSERT_TRUE(a->residence[n] != RESIDENCE_REGISTER || a->reg[n] != a->reg[square]);
}

static void test_a_result_is_in_memory_if_the_body_needs_all_registers(void)
{
    const struct allocation *a = &builder->allocation;
    uint16_t square = allocate_square(ALLOCATABLE);
    TEST_ASSERT_EQUAL(a->section, a->split[square]);
    TEST_ASSERT_EQUAL(1, a->slots);
    TEST_ASSERT_EQUAL(0, a->slot[square]);
}

/* `count` loads that are all alive, and sums of them with a literal. Returns the literal. */
static uint16_t allocate_sums(unsigned count, unsigned sums)
{
    const struct register_file file = {.wide = false};
    uint16_t value[32];
    ir_start(&builder->ir);
    uint16_t literal = append(IR_literal, TYPE_flt, 0, 0, 0x3f800000);
    for (unsigned n = 0; n < count; n++)
        value[n] = append(IR_load, TYPE_flt, 0, 0, (int)(32 * n));
    for (unsigned n = 0; n < count; n++)
        value[n] = append(IR_mul_f, TYPE_flt, value[n], value[count - 1], 0);
    for (unsigned n = 0; n < sums; n++)
        value[n] = append(IR_add_f, TYPE_flt, value[n], literal, 0);
    for (unsigned n = 0; n < count; n++)
        append(IR_store, TYPE_non, value[n], 0, (int)(32 * n));
    allocate_registers(&builder->ir, &builder->allocation, &file);
    return literal;
}

static void test_a_constant_has_the_register_that_the_body_leaves(void)
{
    const struct allocation *a = &builder->allocation;
    uint16_t literal = allocate_sums(8, 8);
    TEST_ASSERT_EQUAL(RESIDENCE_KEPT, a->residence[literal]);
    for (uint32_t n = 1; n < builder->ir.count; n++)
        TEST_ASSERT_TRUE(n == literal || a->reg[n] != a->reg[literal]);
}

static void test_a_constant_is_in_memory_if_it_has_one_use_or_the_body_needs_all_registers(void)
{
    const struct allocation *a = &builder->allocation;
    uint16_t literal = allocate_sums(8, 1);
    TEST_ASSERT_EQUAL(RESIDENCE_MEMORY, a->residence[literal]);
    literal = allocate_sums(ALLOCATABLE, 8);
    TEST_ASSERT_EQUAL(RESIDENCE_MEMORY, a->residence[literal]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_vertex_shader_repeats_nothing_that_is_of_constants);
    RUN_TEST(test_a_pixel_shader_repeats_nothing_that_is_of_constants);
    RUN_TEST(test_a_uniform_condition_is_a_comparison_and_a_jump);
    RUN_TEST(test_no_operation_of_a_body_is_the_same_in_the_whole_call);
    RUN_TEST(test_a_uniform_condition_is_true_in_its_region_only);
    RUN_TEST(test_few_operations_leave_a_region_that_may_be_skipped);
    RUN_TEST(test_equal_operations_of_two_regions_move_as_one);
    RUN_TEST(test_reads_of_constants_move_but_not_those_of_textures);
    RUN_TEST(test_a_result_keeps_its_register_if_the_body_leaves_one);
    RUN_TEST(test_a_result_is_in_memory_if_the_body_needs_all_registers);
    RUN_TEST(test_a_constant_has_the_register_that_the_body_leaves);
    RUN_TEST(test_a_constant_is_in_memory_if_it_has_one_use_or_the_body_needs_all_registers);
    return UNITY_END();
}
