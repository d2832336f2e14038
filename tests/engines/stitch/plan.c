/* Plans of all keys: every part finds valid values in the registers that its fragment reads, every
 * fragment is used, and errors in plans are reported. contract.c tests that fragments keep their
 * contracts. */
#define _GNU_SOURCE
#include "machine/code.h"
#include "engines/stitch/cover.h"
#include "engines/stitch/plan.h"
#include "engines/stitch/stitch.h"
#include "tests/support/shader/random_key.h"
#include "tests/support/routine/stitched.h"
#include "tests/support/system/seed.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

static struct code_arena *arena;
static const union key no_state;
static uint64_t seed = 0x91a45;

static struct plan plan;
static uint8_t planned[1024]; /* by number in the section */

static void note_planned(void)
{
    for (unsigned i = 0; i < plan.count; i++)
        planned[plan.part[i].fragment - __start_stitch_fragments] = 1;
}

/* A build with sanitizers plans stages for every fifth key. */
static bool is_left_out(planner *planner)
{
    static unsigned number, stride;
    stride = stride ? stride : test_stride_of(5);
    return planner == plan_stages && number++ % stride;
}

static void check_plan(planner *planner, enum unit unit, const union key *key)
{
    struct error error = {{0}};
    if (is_left_out(planner) || (planner == plan_stages && !stages_cover(unit, key)))
        return;
    planner(&plan, unit, key);
    TEST_ASSERT_EQUAL_MESSAGE(0, plan.dropped, "the plan is too large");
    if (plan_check(&plan, &error)) {
        char text[KEY_TEXT_CAPACITY], both[sizeof text + ERROR_CAPACITY];
        snprintf(both, sizeof both, "%s [%s]", error.text, key_print(unit, key, text));
        TEST_FAIL_MESSAGE(both);
    }
    note_planned();
}

static size_t field_number(enum unit unit, const char *name)
{
    size_t count, i = 0;
    const struct key_field *field = key_fields(unit, &count);
    while (i < count && strcmp(field[i].name, name))
        i++;
    TEST_ASSERT_LESS_THAN_MESSAGE(count, i, name);
    return i;
}

static size_t field_end(enum unit unit)
{
    size_t count;
    key_fields(unit, &count);
    return count;
}

/* The number of values and elements of a field that represent all others: one stage, one channel, and the
 * values up to the last one that stage fragments cover. */
struct digits {
    unsigned count, radix;
};

static struct digits field_digits(enum unit unit, const struct key_field *field)
{
    struct digits r = {field->count, 1};
    if (!strcmp(field->name, "varying"))
        r.count = 2;
    else if (!strcmp(field->name, "coordinates") || !strcmp(field->name, "anisotropy") ||
             !strcmp(field->name, "address_w"))
        r.count = 0;
    else if (field->count == TEXTURE_STAGES || field->count == PIXEL_SAMPLERS)
        r.count = 1;
    unsigned most = strcmp(field->name, "stages") ? field->radix : 2;
    for (unsigned value = 1; value < most; value++) {
        union key key = no_state;
        ((uint8_t *)&key)[field->offset] = (uint8_t)value;
        if (stages_cover(unit, &key))
            r.radix = value + 1;
    }
    return r;
}

static const struct digits *unit_digits(enum unit unit)
{
    static struct digits digits[UNIT_COUNT][256];
    size_t count;
    const struct key_field *field = key_fields(unit, &count);
    TEST_ASSERT_LESS_OR_EQUAL(256, count);
    for (size_t i = 0; i < count && !digits[unit][count - 1].radix; i++)
        digits[unit][i] = field_digits(unit, field + i);
    return digits[unit];
}

/* Advances the covered values of the fields from `first` to before `end` like digits. Returns 0 after the
 * last combination. */
static int next_key(enum unit unit, size_t first, size_t end, union key *key)
{
    size_t count;
    const struct key_field *field = key_fields(unit, &count);
    const struct digits *digits = unit_digits(unit);
    for (size_t i = first; i < end; i++)
        for (unsigned j = 0; j < digits[i].count; j++) {
            uint8_t *digit = (uint8_t *)key + field[i].offset + j;
            while (++*digit < digits[i].radix)
                if (stages_cover(unit, key))
                    return 1;
            *digit = 0;
        }
    return 0;
}

/* The eight lights are the last digits but one of the key, and they are equivalent: the registers that a
 * light's fragment reads and gives do not depend on its number. One light of each kind, and all lights of
 * each kind, represent all combinations. */
static void set_lights(struct vertex_key *key, int pattern)
{
    static const uint8_t pair[6][2] = {{0, 0}, {1, 0}, {2, 0}, {1, 2}, {2, 1}, {2, 2}};
    memset(key->light, 0, sizeof key->light);
    key->light[0] = pair[pattern][0];
    key->light[1] = pair[pattern][1];
}

static void vertex_plans_keep_the_contract(void)
{
    for (int pattern = 0; pattern < 6; pattern++)
        for (int rest = 0; rest < 6 * 6 * 6 * 6 * 16; rest++) {
            enum { FORMATS = ATTRIBUTE_FORMAT_COLOR + 1 }; /* those that stages have */
            union key key = no_state;
            int digits = rest;
            for (int a = 0; a <= ATTRIBUTE_TEXCOORD; a++, digits /= FORMATS)
                key.vertex.attribute[a] = (uint8_t)(digits % FORMATS);
            key.vertex.lighting = digits & 1;
            key.vertex.normalize = digits >> 1 & 1;
            key.vertex.clip_planes = (uint8_t)(rest % 3);
            key.vertex.varying[0] = digits >> 2 & 1;
            key.vertex.varying[1] = digits >> 3 & 1;
            set_lights(&key.vertex, pattern);
            check_plan(plan_stages, UNIT_VERTEX, &key);
        }
}

static void setup_plans_keep_the_contract(void)
{
    union key key = no_state;
    do
        check_plan(plan_stages, UNIT_SETUP, &key);
    while (next_key(UNIT_SETUP, 0, field_end(UNIT_SETUP), &key));
}

/* Checks plans with everything that is before the stage. Stages have too many operations and arguments to
 * combine them with everything else. */
static void check_beginnings(union key key)
{
    do
        check_plan(plan_stages, UNIT_PIXEL, &key);
    while (next_key(UNIT_PIXEL, 0, field_number(UNIT_PIXEL, "color_stage"), &key));
}

static void check_ends(union key *key)
{
    static const uint8_t masks[] = {0, 7, 15};
    for (int discard = 0; discard < COMPARE_COUNT; discard++)
        for (size_t m = 0; m < sizeof masks; m++) {
            key->pixel.alpha_discard = (uint8_t)discard;
            key->pixel.write_mask[0] = masks[m];
            check_plan(plan_stages, UNIT_PIXEL, key);
        }
}

/* When alpha is blended, the state of the registers does not depend on the blending of colour. So each
 * blending for both, and each for alpha after one for colour, represent all pairs. */
static void check_blendings(union key *key)
{
    for (int i = 0; i < BLEND_COUNT * FACTOR_COUNT * FACTOR_COUNT; i++) {
        struct pixel_key *pixel = &key->pixel;
        for (int c = 0; c < BLEND_CHANNELS; c++) {
            pixel->blend[c] = (uint8_t)(i / (FACTOR_COUNT * FACTOR_COUNT));
            pixel->source_factor[c] = (uint8_t)(i / FACTOR_COUNT % FACTOR_COUNT);
            pixel->target_factor[c] = (uint8_t)(i % FACTOR_COUNT);
        }
        check_ends(key);
        pixel->blend[BLEND_COLOR] = BLEND_SUBTRACT;
        pixel->source_factor[BLEND_COLOR] = FACTOR_TARGET_COLOR;
        pixel->target_factor[BLEND_COLOR] = FACTOR_SATURATED_ALPHA;
        check_plan(plan_stages, UNIT_PIXEL, key);
    }
}

/* The parts after the stage depend on the parts before it only through the colour, the live lanes and the
 * position. So all parts before the stage with a few after it, and the reverse, represent all
 * combinations. */
static void pixel_plans_keep_the_contract(void)
{
    static const struct pixel_key ends[] = {{.write_mask = {0}},
                                            {.write_mask = {15}},
                                            {.write_mask = {7}, .blend = {BLEND_MINIMUM, BLEND_MINIMUM}},
                                            {.write_mask = {0}, .alpha_discard = COMPARE_LESS},
                                            {.write_mask = {15}, .alpha_discard = COMPARE_LESS}};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        union key key = {.pixel = ends[i]};
        check_beginnings(key);
        key.pixel.color_argument[0] = key.pixel.alpha_argument[0] = SOURCE_TEXTURE;
        check_beginnings(key);
        key.pixel.color_stage[0] = STAGE_LERP;
        key.pixel.color_argument[2] = SOURCE_FACTOR;
        check_beginnings(key);
    }
    for (int depth_write = 0; depth_write < 2; depth_write++) {
        union key key = {.pixel = {.depth_function = COMPARE_ALWAYS, .depth_write = (uint8_t)depth_write}};
        check_blendings(&key);
    }
}

/* The operation only in colour, in both, and only in alpha. */
static void check_stage_plans(union key key, enum stage stage, unsigned first, unsigned second,
                              unsigned third)
{
    const uint8_t argument[STAGE_ARGUMENTS] = {(uint8_t)first, (uint8_t)second, (uint8_t)third};
    key.pixel.color_stage[0] = (uint8_t)stage;
    memcpy(key.pixel.color_argument, argument, sizeof argument);
    check_plan(plan_stages, UNIT_PIXEL, &key);
    if (stage == STAGE_DOT)
        return;
    key.pixel.alpha_stage[0] = (uint8_t)stage;
    memcpy(key.pixel.alpha_argument, argument, sizeof argument);
    check_plan(plan_stages, UNIT_PIXEL, &key);
    key.pixel.color_stage[0] = STAGE_LERP;
    check_plan(plan_stages, UNIT_PIXEL, &key);
}

static void stage_plans_keep_the_contract(void)
{
    const unsigned radix = STAGE_ARGUMENT_RADIX;
    union key key = no_state;
    key.pixel.texture[0] = 1;
    key.pixel.stages = 1;
    key.pixel.write_mask[0] = 15;
    for (int stage = 0; stage < STAGE_COUNT; stage++)
        for (unsigned digits = 0; digits < radix * radix * radix; digits++)
            check_stage_plans(key, stage, digits % radix, digits / radix % radix, digits / radix / radix);
}

/* Random keys of several stages. */
static void plans_of_many_stages_keep_the_contract(void)
{
    for (int i = 0; i < 3000; i++) {
        union key key;
        key_random(UNIT_PIXEL, &seed, &key);
        for (int j = 0; j < TEXTURE_STAGES * STAGE_ARGUMENTS; j++) {
            uint8_t *argument[2] = {key.pixel.color_argument + j, key.pixel.alpha_argument + j};
            for (int half = 0; half < 2; half++)
                *argument[half] =
                    (uint8_t)(*argument[half] / SOURCE_COUNT * SOURCE_COUNT + SOURCE_TEXTURE + i % 3);
        }
        stages_reduce(UNIT_PIXEL, &key);
        check_plan(plan_stages, UNIT_PIXEL, &key);
    }
}

/* A coverage that promises stage fragments for every key. */
static const char *lack_nothing(enum unit unit, const union key *key)
{
    (void)unit;
    (void)key;
    return NULL;
}

static void a_missing_stage_fragment_is_refused_with_its_key(void)
{
    struct engine promising = engine_stitch;
    union key key = no_state;
    struct error error = {{0}};
    promising.options = &(const struct stitch_options){lack_nothing};
    key.vertex.attribute[ATTRIBUTE_POSITION] = ATTRIBUTE_FORMAT_DEC3N;
    TEST_ASSERT_NULL(promising.build(&promising, arena, UNIT_VERTEX, &key, &error));
    TEST_ASSERT_EQUAL_STRING("the stitcher lacks a stage fragment that def/engine/cover.def promises for the "
                             "vertex key attribute=15",
                             error.text);
}

static void operation_plans_keep_the_contract(void)
{
    union key most = no_state;
    most.vertex.lighting = most.vertex.normalize = most.vertex.varying[0] = most.vertex.varying[1] = 1;
    memset(most.vertex.light, LIGHT_POINT, sizeof most.vertex.light);
    memset(most.vertex.attribute, ATTRIBUTE_FORMAT_FLOAT4, ATTRIBUTE_TEXCOORD + 1);
    check_plan(plan_operations, UNIT_VERTEX, &most);
    for (int i = 0; i < (int)test_share_of(3000, 8); i++) {
        union key key;
        key_random((enum unit)(i % UNIT_COUNT), &seed, &key);
        check_plan(plan_operations, (enum unit)(i % UNIT_COUNT), &key);
    }
}

static void note_program(const struct ir *ir)
{
    struct error error = {{0}};
    stitched_plan(&plan, ir);
    TEST_ASSERT_EQUAL_MESSAGE(0, plan_check(&plan, &error), error.text);
    note_planned();
}

/* Plans programs with the features that only shaders have: loops and variables, negated products,
 * constants. */
static void plan_shader_features(void)
{
    static struct ir ir;
    const struct program program = {.model = &shader_models[0]};
    uint64_t random = 0x5eed;
    struct error error = {{0}};
    for (int i = 0; i < 50; i++) {
        program_make_loops(&ir, 100, &random);
        note_program(&ir);
        stitched_make_fusing(&ir, 100, &random);
        note_program(&ir);
    }
    plan_enter(&plan);
    plan_locate_operations(&plan, UNIT_VERTEX, &no_state, &program);
    TEST_ASSERT_EQUAL_MESSAGE(0, plan_check(&plan, &error), error.text);
    note_planned();
}

/* Runs after the tests of plans above. Operations that the specification does not use are not planned. */
static void every_fragment_is_planned_by_some_key(void)
{
    plan_shader_features();
#define FRAGMENT(name, arguments, meaning)                                                                   \
    TEST_ASSERT_TRUE_MESSAGE(planned[&fragment_##name - __start_stitch_fragments], #name);
#include "def/engine/fragment.def"
#undef FRAGMENT
}

/* A plan without one part, or with two parts exchanged, is reported. */
static void broken_plans_are_reported(void)
{
    union key key = no_state;
    struct error error = {{0}};
    key.pixel.write_mask[0] = 15;
    key.pixel.depth_function = COMPARE_LESS;
    plan_stages(&plan, UNIT_PIXEL, &key);
    TEST_ASSERT_EQUAL(0, plan_check(&plan, &error));
    for (unsigned i = 0; i < plan.count; i++)
        if (plan.part[i].fragment == &fragment_position)
            plan.part[i].fragment = &fragment_stage_replace;
    TEST_ASSERT_EQUAL(-1, plan_check(&plan, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "stage_replace: reads ymm"), error.text);
    error_clear(&error);
    plan_stages(&plan, UNIT_PIXEL, &key);
    plan.part[plan.count - 2].arguments.value[0] = (int32_t)plan.count;
    TEST_ASSERT_EQUAL(-1, plan_check(&plan, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "jumps to part"), error.text);
}

static void listings_show_parts_holes_and_instructions(void)
{
    union key key = no_state;
    struct error error = {{0}};
    char *text = NULL;
    size_t size;
    key.pixel.write_mask[0] = 3;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_EQUAL_MESSAGE(0, stitch_dump(&engine_stitch, arena, UNIT_PIXEL, &key, out, &error),
                              error.text);
    TEST_ASSERT_EQUAL_MESSAGE(0, stitch_dump(&engine_stitch_operation, arena, UNIT_PIXEL, &key, out, &error),
                              error.text);
    fclose(out);
    TEST_ASSERT_NOT_NULL(strstr(text, "granularity: stage\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "write_masked value=0xffff"));
    TEST_ASSERT_NOT_NULL(strstr(text, "granularity: operation\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "src/spec/pixel/write.h:"));
    TEST_ASSERT_NOT_NULL(strstr(text, "vpblendvb"));
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "db 0x"), "bytes that are not an instruction");
    free(text);
}

static void plans_that_exceed_a_capacity_are_refused(void)
{
    static union key key;
    struct error error = {{0}};
    struct code_arena *small = code_create(1, NULL, &error); /* a page */
    struct code_span rest;
    size_t room = code_statistics(small).largest_free;
    TEST_ASSERT_EQUAL(0, code_reserve(small, room - CODE_ALIGNMENT, &rest, &error));
    TEST_ASSERT_NULL(engine_build(&engine_stitch, small, UNIT_PIXEL, &key, &error));
    TEST_ASSERT_NOT_EQUAL('\0', error.text[0]);
    error_clear(&error);
    plan_enter(&plan);
    plan.count = 0;
    for (int i = 0; i <= PART_CAPACITY; i++)
        plan_append(&plan, &fragment_leave, (union arguments){{0}});
    TEST_ASSERT_EQUAL(-1, plan_join(&plan, arena, &rest, &error));
    TEST_ASSERT_EQUAL_STRING("the stitcher's plan of 131073 parts exceeds its room of 131072", error.text);
    code_destroy(small);
}

void setUp(void)
{
    struct error error = {{0}};
    arena = code_create(1 << 24, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
}

void tearDown(void)
{
    code_destroy(arena);
    arena = NULL;
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(vertex_plans_keep_the_contract);
    RUN_TEST(setup_plans_keep_the_contract);
    RUN_TEST(pixel_plans_keep_the_contract);
    RUN_TEST(stage_plans_keep_the_contract);
    RUN_TEST(plans_of_many_stages_keep_the_contract);
    RUN_TEST(a_missing_stage_fragment_is_refused_with_its_key);
    RUN_TEST(operation_plans_keep_the_contract);
    RUN_TEST(every_fragment_is_planned_by_some_key);
    RUN_TEST(broken_plans_are_reported);
    RUN_TEST(plans_that_exceed_a_capacity_are_refused);
    RUN_TEST(listings_show_parts_holes_and_instructions);
    return UNITY_END();
}
