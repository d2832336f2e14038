/* A routine has no instruction of a stage that its key disables. Each machine instruction of a listing
 * belongs to a line of the specification, so the file of the line is that of the stage. */
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "machine/cpu.h"
#include "tests/support/routine/routines.h"
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

/* --- Stages --------------------------------------------------------------------------------------------- */

static bool any(const uint8_t *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (values[i])
            return true;
    return false;
}

#define ANY(array) any(array, sizeof(array))

static bool pixel_fog(const union key *key)
{
    return key->pixel.fog != 0;
}

static bool pixel_alpha(const union key *key)
{
    return key->pixel.alpha_discard || key->pixel.alpha_coverage;
}

static bool pixel_blend(const union key *key)
{
    /* Factors without blending are in no derived key; in random keys they can differ for colour and alpha. */
    return ANY(key->pixel.blend) || ANY(key->pixel.source_factor) || ANY(key->pixel.target_factor);
}

static bool pixel_textures(const union key *key)
{
    return ANY(key->pixel.texture);
}

static bool pixel_cubes(const union key *key)
{
    return memchr(key->pixel.texture, TEXTURE_CUBE, sizeof key->pixel.texture) != NULL;
}

static bool pixel_logic(const union key *key)
{
    return key->pixel.logic != LOGIC_COPY;
}

static bool has_shader(const union key *key)
{
    return key_shader(UNIT_PIXEL, key) != NULL;
}

static bool has_stages(const union key *key)
{
    return key->pixel.stages && !has_shader(key);
}

static bool pixel_floats(const union key *key)
{
    return key->pixel.float_color != 0;
}

static bool pixel_bump(const union key *key)
{
    return ANY(key->pixel.bump) || has_shader(key);
}

static bool vertex_shader(const union key *key)
{
    return key_shader(UNIT_VERTEX, key) != NULL;
}

static bool vertex_lighting(const union key *key)
{
    return key->vertex.lighting != 0;
}

static bool vertex_fog(const union key *key)
{
    return key->vertex.fog != 0;
}

static bool vertex_skin(const union key *key)
{
    return key->vertex.matrices || key->vertex.indexed_matrices || key->vertex.tween;
}

static bool setup_points(const union key *key)
{
    return key->setup.primitive == PRIMITIVE_POINT || key->setup.primitive == PRIMITIVE_CORNER;
}

static bool setup_lines(const union key *key)
{
    return key->setup.primitive == PRIMITIVE_LINE || key->setup.primitive == PRIMITIVE_EDGE;
}

static struct part {
    enum unit unit;
    const char *files; /* of the specification: a beginning of their paths */
    bool (*is_enabled)(const union key *key);
    unsigned disabled, seen; /* routines without the stage; recorded instructions of it in the others */
} stages[] = {
    {UNIT_PIXEL, "spec/pixel/fog.h", pixel_fog, 0, 0},
    {UNIT_PIXEL, "spec/pixel/alpha.h", pixel_alpha, 0, 0},
    {UNIT_PIXEL, "spec/pixel/blend.h", pixel_blend, 0, 0},
    {UNIT_PIXEL, "spec/pixel/float_blend.h", pixel_blend, 0, 0},
    {UNIT_PIXEL, "spec/pixel/logic.h", pixel_logic, 0, 0},
    {UNIT_PIXEL, "spec/pixel/float_", pixel_floats, 0, 0},
    {UNIT_PIXEL, "spec/pixel/stage.h", has_stages, 0, 0},
    {UNIT_PIXEL, "spec/texture/", pixel_textures, 0, 0},
    {UNIT_PIXEL, "spec/texture/cube.h", pixel_cubes, 0, 0},
    {UNIT_PIXEL, "spec/texture/bump.h", pixel_bump, 0, 0},
    {UNIT_PIXEL, "spec/shader/", has_shader, 0, 0},
    {UNIT_VERTEX, "spec/shader/", vertex_shader, 0, 0},
    {UNIT_VERTEX, "spec/vertex/light.h", vertex_lighting, 0, 0},
    {UNIT_VERTEX, "spec/vertex/vertex_fog.h", vertex_fog, 0, 0},
    {UNIT_VERTEX, "spec/vertex/skin.h", vertex_skin, 0, 0},
    {UNIT_SETUP, "spec/setup/setup_point.h", setup_points, 0, 0},
    {UNIT_SETUP, "spec/setup/setup_line.h", setup_lines, 0, 0},
};

enum { STAGES = sizeof stages / sizeof *stages };

/* --- Listings ------------------------------------------------------------------------------------------- */

/* The instructions of the listing that belong to files of a stage. */
static unsigned lines_of(const struct part *part)
{
    const struct emitter *m = &builder->emitter;
    unsigned count = 0;
    for (uint32_t n = 0; n < m->lines; n++) {
        const struct ir_instruction *i = &builder->ir.instruction[m->line[n].instruction];
        if (m->line[n].instruction && i->line)
            count += !strncmp(builder->ir.file[i->file], part->files, strlen(part->files));
    }
    return count;
}

/* The instructions of the recording that do: the passes may fold them into others. */
static unsigned recorded_of(const struct part *part, const struct ir *ir)
{
    unsigned count = 0;
    for (uint32_t n = 1; n < ir->count; n++)
        count += !strncmp(ir->file[ir->instruction[n].file], part->files, strlen(part->files));
    return count;
}

static void check_listing(void *context, enum unit unit, const union key *key)
{
    static char message[KEY_TEXT_CAPACITY + 200];
    const struct build_options options = specialize_options(&engine_specialize_8, unit);
    char text[KEY_TEXT_CAPACITY];
    static struct ir recording;
    (void)context;
    ir_record(&recording, unit, key);
    TEST_ASSERT_MESSAGE(specialize_code(builder, &options, unit, key, NULL, NULL, &error), error.text);
    for (struct part *part = stages; part < stages + STAGES; part++) {
        if (part->unit != unit)
            continue;
        unsigned lines = lines_of(part);
        if (part->is_enabled(key)) {
            part->seen += recorded_of(part, &recording);
            continue;
        }
        part->disabled++;
        snprintf(message, sizeof message, "%u instructions of %s, which is disabled; %s key: %s", lines,
                 part->files, unit_name[unit], key_print(unit, key, text));
        TEST_ASSERT_EQUAL_MESSAGE(0, lines, message);
    }
}

static void test_listings_have_no_instruction_of_a_disabled_stage(void)
{
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    visit_streams(check_listing, NULL);
    visit_shaders(test_seed(), check_listing, NULL);
    visit_random_keys(test_share(300), test_seed(), check_listing, NULL);
    for (const struct part *part = stages; part < stages + STAGES; part++) {
        TEST_ASSERT_GREATER_THAN_MESSAGE(0, part->disabled, part->files);
        TEST_ASSERT_GREATER_THAN_MESSAGE(0, part->seen, part->files);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_listings_have_no_instruction_of_a_disabled_stage);
    return UNITY_END();
}
