/* Programs in two parts: which programs have them, and what each part has; the same results as the emulator's
 * for calls of every length, also where blocks of a call are the same block. */
#include "engines/list.h"
#include "emu/emulate/emulate.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "machine/code.h"
#include "tests/support/differential/differential_part.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

static struct code_arena *arena;
static struct differential *differential;
static struct error error;

void setUp(void)
{
    error_clear(&error);
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
}

void tearDown(void)
{
    differential_destroy(differential);
    code_destroy(arena);
}

/* --- Keys ----------------------------------------------------------------------------------------------- */

/* A texture times a colour. */
static union key textured(int filter)
{
    union key key;
    memset(&key, 0, sizeof key);
    key.pixel.depth_function = COMPARE_ALWAYS;
    key.pixel.stages = key.pixel.texture[0] = 1;
    key.pixel.write_mask[0] = 15;
    key.pixel.varying[VARYING_diffuse] = INTERPOLATION_FLAT;
    key.pixel.varying[VARYING_texcoord0] = INTERPOLATION_SMOOTH;
    key.pixel.filter[0] = (uint8_t)filter;
    key.pixel.address_u[0] = key.pixel.address_v[0] = ADDRESS_CLAMP;
    key.pixel.color_stage[0] = key.pixel.alpha_stage[0] = STAGE_MODULATE;
    key.pixel.color_argument[0] = key.pixel.alpha_argument[0] = 1;
    return key;
}

/* Premultiplied blending. */
static union key blended(void)
{
    union key key = textured(FILTER_POINT);
    key.pixel.blend[BLEND_COLOR] = key.pixel.blend[BLEND_ALPHA] = BLEND_ADD;
    key.pixel.source_factor[BLEND_COLOR] = key.pixel.source_factor[BLEND_ALPHA] = FACTOR_ONE;
    key.pixel.target_factor[BLEND_COLOR] = key.pixel.target_factor[BLEND_ALPHA] = FACTOR_INVERSE_SOURCE_ALPHA;
    return key;
}

/* With a condition after the texels. */
static union key alpha_tested(void)
{
    union key key = blended();
    key.pixel.alpha_discard = COMPARE_GREATER;
    return key;
}

/* With a condition before the texels. */
static union key depth_tested(void)
{
    union key key = blended();
    key.pixel.depth_function = COMPARE_LESS;
    return key;
}

/* One channel is converted to sRGB by a table, after the target is read. */
static union key converted(void)
{
    union key key;
    memset(&key, 0, sizeof key);
    key.pixel.depth_function = COMPARE_ALWAYS;
    key.pixel.varying[VARYING_diffuse] = INTERPOLATION_SMOOTH;
    key.pixel.target[0] = 4;
    key.pixel.write_mask[0] = 1;
    key.pixel.float_color = 1;
    return key;
}

/* --- Parts ---------------------------------------------------------------------------------------------- */

struct seen {
    unsigned parts, targets; /* and the instructions of the first part that access the target */
};

static void look(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    struct seen *seen = context;
    if (pass != PASS_early || !changed)
        return;
    for (uint32_t n = 1, accesses = 0; n < ir->count; n++) {
        const struct ir_instruction *i = &ir->instruction[n];
        accesses +=
            ir_properties(i) & (IR_READS | IR_WRITES) && (i->base == BASE_COLOR || i->base == BASE_DEPTH);
        if (i->op == IR_rest) {
            seen->parts++;
            seen->targets += accesses;
        }
    }
    TEST_ASSERT_EQUAL_STRING(NULL, ir_verify(ir));
}

static void expect_parts(const char *name, const union key *key, unsigned parts)
{
    struct seen seen = {0, 0};
    struct builder *b = specialize_take(&error);
    const struct build_options options = specialize_options(engine_named(name, &error), UNIT_PIXEL);
    TEST_ASSERT_NOT_NULL_MESSAGE(b, error.text);
    TEST_ASSERT_MESSAGE(specialize_code(b, &options, UNIT_PIXEL, key, look, &seen, &error), error.text);
    specialize_give(b);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(parts, seen.parts, name);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, seen.targets, name);
}

static void texels_of_whole_blocks_are_read_early(void)
{
    const union key blend = blended(), alpha = alpha_tested(), depth = depth_tested(), other = converted();
    const union key linear = textured(FILTER_LINEAR);
    expect_parts("specialize-8x2", &blend, 1);
    expect_parts("specialize-8x2", &alpha, 1);
    expect_parts("specialize-8x2", &depth, 0);
    expect_parts("specialize-8x2", &linear, 0);
    expect_parts("specialize-8x2", &other, 0);
    expect_parts("specialize-8x2:without=early", &blend, 0);
    expect_parts("specialize-8", &blend, 0);
    expect_parts("specialize-4x4", &blend, 0);
}

/* --- Programs by hand ----------------------------------------------------------------------------------- */

static uint16_t append(struct ir *ir, enum ir_op op, enum base base, uint16_t a, uint16_t b)
{
    return ir_append(ir,
                     (struct ir_instruction){
                         .op = (uint8_t)op, .type = TYPE_itg, .base = (uint8_t)base, .operand = {a, b, 0}});
}

static uint16_t append_sums(struct ir *ir, uint16_t value)
{
    for (unsigned n = 0; n < 20; n++)
        value = append(ir, IR_add_i, 0, value, value);
    return value;
}

/* Sums lead to a texel, or to a word of a table whose index is a word of the target; from these, to the
 * target. Returns the number of texels and words of the first part. */
static unsigned gathers_of_first_part(struct builder *b, bool reads_texel, bool reads_target)
{
    struct ir *ir = &b->ir;
    ir_start(ir);
    ir->unit = UNIT_PIXEL;
    b->pass.lanes = 8;
    b->pass.parts = 2;
    b->pass.judges = false;
    uint16_t value = append_sums(ir, append(ir, IR_load, BASE_LANES, 0, 0));
    if (reads_texel)
        value = append(ir, IR_gather, BASE_JOB, value, 0);
    if (reads_target) {
        value = append_sums(ir, append(ir, IR_add_i, 0, value, append(ir, IR_load, BASE_COLOR, 0, 0)));
        value = append(ir, IR_gather, BASE_JOB, value, 0);
    }
    append(ir, IR_store, BASE_COLOR, append_sums(ir, value), 0);
    pass_early(ir, &b->pass);
    unsigned gathers = 0;
    for (uint32_t n = 1; n < ir->count && ir->instruction[n].op != IR_rest; n++)
        gathers += ir->instruction[n].op == IR_gather;
    return ir->early ? gathers : 0;
}

/* An earlier block of the group may be about to write the word. */
static void words_of_the_target_are_not_read_early(void)
{
    struct builder *b = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(b, error.text);
    TEST_ASSERT_EQUAL_UINT(1, gathers_of_first_part(b, true, false));
    TEST_ASSERT_EQUAL_UINT(1, gathers_of_first_part(b, true, true));
    TEST_ASSERT_EQUAL_UINT(0, gathers_of_first_part(b, false, true));
    specialize_give(b);
}

/* --- Results -------------------------------------------------------------------------------------------- */

enum { MOST = 200, BLOCKS = 7 };

/* Many entries are of the same block, and some of them follow each other. */
static void fill_entries(uint32_t count)
{
    struct differential *d = differential;
    d->count = count;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t block = differential_below(d, BLOCKS) * 37;
        const uint16_t coverage = (uint16_t)differential_word(d);
        d->entries.entry[i] = (struct entry){.x = (float)(block % 16 * 4),
                                             .y = (float)(block / 16 * 4),
                                             .coverage = coverage ? coverage : 1,
                                             .block = (uint16_t)block,
                                             .triangle = d->entries.entry[i % 2].triangle};
    }
}

static void expect_equal(const struct routine *const routine[2], uint32_t count)
{
    struct differential *d = differential;
    char what[32];
    snprintf(what, sizeof what, "%u entries", count);
    for (unsigned i = 0; i < 2; i++) {
        d->result[i] = d->initial;
        const struct differential_arguments arguments = differential_arguments(d, &d->result[i]);
        routine_run(routine[i], &arguments.pixel, count * BLOCK_PIXELS);
    }
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&d->result[0], &d->result[1], sizeof d->result[0], what);
}

static void calls_of_every_length_are_equal(const char *name, const union key *key)
{
    const struct engine *const engine[2] = {&engine_emulate, engine_named(name, &error)};
    struct routine *routine[2];
    for (unsigned i = 0; i < 2; i++)
        TEST_ASSERT_NOT_NULL_MESSAGE(routine[i] = engine_build(engine[i], arena, UNIT_PIXEL, key, &error),
                                     error.text);
    for (uint32_t count = 1; count <= MOST; count += count < 70 ? 1 : 13) {
        differential_fill(differential, UNIT_PIXEL, key, count);
        fill_entries(count);
        expect_equal((const struct routine *const *)routine, count);
    }
    for (unsigned i = 0; i < 2; i++)
        engine[i]->free(arena, routine[i]);
}

static void calls_have_the_same_results_also_where_blocks_are_drawn_again(void)
{
    const union key keys[] = {blended(), alpha_tested(), depth_tested(), converted(), textured(FILTER_POINT)};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        calls_of_every_length_are_equal("specialize-8x2", &keys[i]);
        calls_of_every_length_are_equal("specialize-8x4", &keys[i]); /* two blocks in a pass */
    }
}

int main(void)
{
    UNITY_BEGIN();
    if (engine_unavailable(&engine_specialize_8)) {
        puts("left out: needs AVX2 and FMA");
        return UNITY_END();
    }
    RUN_TEST(texels_of_whole_blocks_are_read_early);
    RUN_TEST(words_of_the_target_are_not_read_early);
    RUN_TEST(calls_have_the_same_results_also_where_blocks_are_drawn_again);
    return UNITY_END();
}
