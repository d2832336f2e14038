/* Named fields: the table of records against the structures of the host, the names of what recordings read
 * and write, and what the verifier refuses. */
#include "base/srgb.h"
#include "contract/layout.h"
#include "engines/specialize/build.h"
#include "ir/field.h"
#include "tests/support/routine/routines.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <string.h>

static struct builder *builder;
static struct error error;
static struct ir ir;
static char message[KEY_TEXT_CAPACITY + 300];

void setUp(void)
{
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
    ir_start(&ir);
}

void tearDown(void)
{
    specialize_give(builder);
}

/* --- The table ------------------------------------------------------------------------------------------ */

static void expect_field(enum ir_record record, size_t offset, const char *name, enum ir_type type)
{
    struct ir_field field;
    TEST_ASSERT_TRUE_MESSAGE(ir_find_field(record, (int64_t)offset, &field), name);
    TEST_ASSERT_EQUAL_STRING(name, field.name);
    TEST_ASSERT_EQUAL_MESSAGE(type, field.type, name);
}

static void test_fields_have_the_names_and_types_of_the_host(void)
{
    expect_field(IR_RECORD_job, offsetof(struct job, fog_scale), "fog_scale", TYPE_flt);
    expect_field(IR_RECORD_job, offsetof(struct job, stencil_mask), "stencil_mask", TYPE_itg);
    expect_field(IR_RECORD_job, offsetof(struct job, texture[3].pitch), "texture[3].pitch", TYPE_itg);
    expect_field(IR_RECORD_job, offsetof(struct job, world_view[2][1]), "world_view[2][1]", TYPE_flt);
    expect_field(IR_RECORD_job, offsetof(struct job, texture_matrix[5][3][2]), "texture_matrix[5][3][2]",
                 TYPE_flt);
    expect_field(IR_RECORD_job, offsetof(struct job, bump[1].matrix[1][0]), "bump[1].matrix[1][0]", TYPE_flt);
    expect_field(IR_RECORD_job, offsetof(struct job, light[7].axis[2]), "light[7].axis[2]", TYPE_flt);
    expect_field(IR_RECORD_entry, offsetof(struct entry, block), "block", TYPE_itg);
    expect_field(IR_RECORD_vertices, (SLOT_diffuse + 2) * VERTEX_SLOT_BYTES, "diffuse[2]", TYPE_flt);
    expect_field(IR_RECORD_vertices, SLOT_CODE * VERTEX_SLOT_BYTES + 32, "code+32", TYPE_itg);
}

static void test_pointers_have_targets(void)
{
    struct ir_field field;
    TEST_ASSERT_TRUE(ir_find_field(IR_RECORD_job, offsetof(struct job, texture[2].levels), &field));
    TEST_ASSERT_TRUE(field.pointer);
    TEST_ASSERT_EQUAL(IR_RECORD_level, field.target);
    TEST_ASSERT_TRUE(ir_find_field(IR_RECORD_job, offsetof(struct job, texture[2].texels), &field));
    TEST_ASSERT_TRUE(field.pointer);
    TEST_ASSERT_EQUAL(IR_RECORD_words, field.target);
}

static void test_no_field_begins_within_another_or_in_padding(void)
{
    static const size_t wrong[] = {
        offsetof(struct job, texture[0].texels) + 4, offsetof(struct job, fog_scale) + 2,
        offsetof(struct job, attribute[0].reserved), sizeof(struct job), (size_t)-4};
    struct ir_field field;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        TEST_ASSERT_FALSE(ir_find_field(IR_RECORD_job, (int64_t)(ptrdiff_t)wrong[i], &field));
}

/* Every word of the job has a field, except what the structures call reserved and padding for alignment. */
static void test_all_words_of_the_job_have_names(void)
{
    const size_t reserved = sizeof(int32_t) * (ATTRIBUTE_COUNT + INPUTS) + sizeof(float[2]) * LIGHT_COUNT;
    struct ir_field field;
    size_t without = 0;
    for (size_t at = 0; at < sizeof(struct job); at += 4)
        if (!ir_find_field(IR_RECORD_job, (int64_t)at, &field) &&
            !(ir_find_field(IR_RECORD_job, (int64_t)at - 4, &field) && field.pointer))
            without += 4;
    TEST_ASSERT_GREATER_OR_EQUAL(reserved, without);
    TEST_ASSERT_LESS_THAN(reserved + 64 + 4 * SAMPLERS, without);
}

/* --- Recordings ----------------------------------------------------------------------------------------- */

static void fail_at(enum unit unit, const union key *key, const char *what)
{
    char text[KEY_TEXT_CAPACITY];
    snprintf(message, sizeof message, "%s; %s key: %s", what, unit_name[unit], key_print(unit, key, text));
    TEST_FAIL_MESSAGE(message);
}

struct passed {
    const char *wrong;
    enum pass pass;
    unsigned checks;
};

static void check_pass(void *context, enum pass pass, unsigned changed, const struct ir *result)
{
    struct passed *passed = context;
    if (!changed || passed->wrong)
        return;
    passed->checks++;
    passed->wrong = ir_verify(result);
    passed->pass = pass;
}

static unsigned checks, memory;

static void check_recording(void *context, enum unit unit, const union key *key)
{
    struct passed passed = {0};
    struct ir_field pointer, field;
    (void)context;
    ir_record(&builder->ir, unit, key);
    const char *wrong = ir_verify(&builder->ir);
    if (wrong)
        fail_at(unit, key, wrong);
    for (uint32_t n = 1; n < builder->ir.count; n++) {
        const struct ir_instruction *i = &builder->ir.instruction[n];
        if (ir_properties(i) & (IR_READS | IR_WRITES) && !ir_find_memory(&builder->ir, i, &pointer, &field))
            memory += *field.name != 0;
    }
    builder->pass.lanes = checks % 2 ? 16 : 8;
    builder->pass.parts = builder->pass.lanes == 16 ? 1 : 1 + checks % 3 / 2;
    pass_run_all(&builder->ir, &builder->pass, pass_select(PROFILE_FULL, 0, 0), check_pass, &passed);
    if (passed.wrong) {
        char what[200];
        snprintf(what, sizeof what, "pass %s: %s", pass_name(passed.pass), passed.wrong);
        fail_at(unit, key, what);
    }
    checks += passed.checks;
}

static void test_recordings_and_results_of_passes_keep_types_and_fields(void)
{
    checks = memory = 0;
    visit_random_keys(test_share(300), test_seed(), check_recording, NULL);
    visit_shaders(test_seed(), check_recording, NULL);
    visit_streams(check_recording, NULL);
    TEST_ASSERT_GREATER_THAN(test_share(1000), checks);
    TEST_ASSERT_GREATER_THAN(test_share(10000), memory);
}

/* --- Refusals ------------------------------------------------------------------------------------------- */

static uint16_t append(enum ir_op op, enum ir_type type, enum base base, uint16_t operand, size_t k,
                       int32_t field)
{
    return ir_append(&ir, (struct ir_instruction){.op = (uint8_t)op,
                                                  .type = (uint8_t)type,
                                                  .base = (uint8_t)base,
                                                  .scale = 4,
                                                  .operand = {operand},
                                                  .k = (int32_t)k,
                                                  .field = field});
}

static void refuse(const char *reason)
{
    const char *wrong = ir_verify(&ir);
    TEST_ASSERT_NOT_NULL_MESSAGE(wrong, reason);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(wrong, reason), wrong);
    ir_start(&ir);
    ir.unit = UNIT_VERTEX;
}

static void accept(void)
{
    const char *wrong = ir_verify(&ir);
    TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
    ir_start(&ir);
    ir.unit = UNIT_VERTEX;
}

static uint16_t index_of_lanes(void)
{
    ir.unit = UNIT_VERTEX;
    return append(IR_load, TYPE_itg, BASE_INPUT, 0, 0, 0);
}

static void test_a_word_is_read_with_the_type_of_its_field(void)
{
    ir.unit = UNIT_VERTEX;
    append(IR_uniform, TYPE_flt, BASE_JOB, 0, offsetof(struct job, fog_scale), 0);
    accept();
    append(IR_uniform, TYPE_itg, BASE_JOB, 0, offsetof(struct job, fog_scale), 0);
    refuse("fog_scale is flt, found itg");
    append(IR_uniform, TYPE_flt, BASE_JOB, 0, offsetof(struct job, texture[1].pitch), 0);
    refuse("texture[1].pitch is itg, found flt");
    append(IR_uniform, TYPE_itg, BASE_JOB, 0, offsetof(struct job, texture[1].texels), 0);
    refuse("its field is a pointer");
}

static void test_a_word_is_stored_with_the_type_of_its_field(void)
{
    uint16_t index = index_of_lanes();
    append(IR_store, TYPE_non, BASE_OUTPUT, index, SLOT_CODE * VERTEX_SLOT_BYTES, 0);
    accept();
    index = index_of_lanes();
    append(IR_store, TYPE_non, BASE_OUTPUT, index, SLOT_Y * VERTEX_SLOT_BYTES, 0);
    refuse("position[1] is flt, found itg");
}

static void test_a_word_beyond_a_structure_is_refused(void)
{
    ir.unit = UNIT_VERTEX;
    append(IR_uniform, TYPE_flt, BASE_JOB, 0, sizeof(struct job), 0);
    refuse("no field begins there");
    append(IR_uniform, TYPE_flt, BASE_JOB, 0, offsetof(struct job, fog_scale) + 1, 0);
    refuse("no field begins there");
    ir.unit = UNIT_PIXEL;
    append(IR_load, TYPE_flt, BASE_LANES, 0, sizeof(struct lane_table), 0);
    refuse("no field begins there");
    ir.unit = UNIT_PIXEL; /* a triangle without planes */
    append(IR_uniform, TYPE_flt, BASE_TRIANGLE, 0, 4 * sizeof(struct plane), 0);
    refuse("no field begins there");
}

static void test_a_gather_starts_from_a_pointer(void)
{
    const int32_t texels = offsetof(struct job, texture[0].texels),
                  levels = offsetof(struct job, texture[0].levels);
    append(IR_gather, TYPE_itg, BASE_JOB, index_of_lanes(), 4, texels);
    accept();
    append(IR_gather, TYPE_flt, BASE_JOB, index_of_lanes(), 4, texels); /* texels may be floats */
    accept();
    append(IR_gather, TYPE_itg, BASE_JOB, index_of_lanes(), offsetof(struct texture_level, pitch), levels);
    accept();
    append(IR_gather, TYPE_flt, BASE_JOB, index_of_lanes(), offsetof(struct texture_level, pitch), levels);
    refuse("pitch is itg, found flt");
    append(IR_gather, TYPE_itg, BASE_JOB, index_of_lanes(), offsetof(struct texture_level, reserved), levels);
    refuse("no field begins there in what its pointer points to");
    append(IR_gather, TYPE_itg, BASE_JOB, index_of_lanes(), 0, offsetof(struct job, texture[0].width));
    refuse("its field is not a pointer");
}

/* A program without a unit, such as those of other tests, has memory of words. */
static void test_without_a_unit_memory_has_no_fields(void)
{
    append(IR_uniform, TYPE_itg, BASE_JOB, 0, offsetof(struct job, fog_scale), 0);
    TEST_ASSERT_NULL(ir_verify(&ir));
}

/* --- Listings ------------------------------------------------------------------------------------------- */

static void expect_text(const char *expected)
{
    char text[200] = "";
    FILE *out = fmemopen(text, sizeof text, "w");
    TEST_ASSERT_NOT_NULL(out);
    ir_print_instruction(&ir, ir.count - 1, out);
    fclose(out);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static void test_listings_name_fields(void)
{
    uint16_t index = index_of_lanes();
    append(IR_uniform, TYPE_flt, BASE_JOB, 0, offsetof(struct job, texture[1].width_256), 0);
    expect_text("flt  uniform   JOB texture[1].width_256");
    append(IR_gather, TYPE_itg, BASE_JOB, index, 4, offsetof(struct job, texture[0].texels));
    expect_text("itg  gather    %1 JOB texture[0].texels->+4 scale 4");
    append(IR_gather, TYPE_itg, BASE_JOB, index, offsetof(struct texture_level, pitch),
           offsetof(struct job, texture[0].levels));
    expect_text("itg  gather    %1 JOB texture[0].levels->pitch scale 4");
    ir.unit = UNIT_COUNT;
    append(IR_uniform, TYPE_flt, BASE_JOB, 0, 40, 0);
    expect_text("flt  uniform   JOB+40");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_fields_have_the_names_and_types_of_the_host);
    RUN_TEST(test_pointers_have_targets);
    RUN_TEST(test_no_field_begins_within_another_or_in_padding);
    RUN_TEST(test_all_words_of_the_job_have_names);
    RUN_TEST(test_recordings_and_results_of_passes_keep_types_and_fields);
    RUN_TEST(test_a_word_is_read_with_the_type_of_its_field);
    RUN_TEST(test_a_word_is_stored_with_the_type_of_its_field);
    RUN_TEST(test_a_word_beyond_a_structure_is_refused);
    RUN_TEST(test_a_gather_starts_from_a_pointer);
    RUN_TEST(test_without_a_unit_memory_has_no_fields);
    RUN_TEST(test_listings_name_fields);
    return UNITY_END();
}
