/* Texture coordinates that only choose texels, in stages and in shaders. */
#include "render/derive/derive.h"

#include "shader/program/program.h"

#include <string.h>
#include <unity.h>

static struct pixel_key key;
static uint16_t samplers[TEXTURE_STAGES];

/* A stage, or a shader's sampler 0, with the coordinates of channel 2. */
void setUp(void)
{
    memset(&key, 0, sizeof key);
    key.varying[VARYING_diffuse] = INTERPOLATION_FLAT;
    key.varying[VARYING_texcoord2] = INTERPOLATION_SMOOTH;
    key.stages = 1;
    key.texture[0] = TEXTURE_2D;
    key.coordinates[0] = 2;
    key.address_u[0] = ADDRESS_CLAMP;
    key.address_v[0] = ADDRESS_MIRROR_POWER;
}

void tearDown(void)
{
}

static void a_stage_that_samples_a_level_has_a_lookup(void)
{
    TEST_ASSERT_TRUE(derive_lookups(&key, samplers));
    for (int c = 0; c < TEXTURE_STAGES; c++)
        TEST_ASSERT_EQUAL_HEX16(c == 2 ? 1 : 0, samplers[c]);
    key.stages = 2;
    TEST_ASSERT_TRUE(derive_lookups(&key, samplers)); /* without a texture */
    key.texture[1] = TEXTURE_2D;
    key.coordinates[1] = 2;
    key.address_u[1] = key.address_v[1] = ADDRESS_BORDER;
    key.filter[1] = FILTER_LINEAR;
    TEST_ASSERT_TRUE(derive_lookups(&key, samplers));
    TEST_ASSERT_EQUAL_HEX16(3, samplers[2]);
}

/* Changes one byte of the key. */
static bool has_lookups_with(uint8_t *field, int value)
{
    uint8_t before = *field;
    *field = (uint8_t)value;
    bool found = derive_lookups(&key, samplers);
    *field = before;
    return found;
}

static void what_depends_on_more_than_positions_has_none(void)
{
    TEST_ASSERT_FALSE(has_lookups_with(&key.address_u[0], ADDRESS_WRAP));
    TEST_ASSERT_FALSE(has_lookups_with(&key.address_v[0], ADDRESS_MIRROR));
    TEST_ASSERT_TRUE(has_lookups_with(&key.address_u[0], ADDRESS_WRAP_POWER));
    TEST_ASSERT_TRUE(has_lookups_with(&key.address_w[0], ADDRESS_MIRROR));
    TEST_ASSERT_FALSE(has_lookups_with(&key.texture[0], TEXTURE_CUBE));
    TEST_ASSERT_FALSE(has_lookups_with(&key.texture[0], TEXTURE_VOLUME));
    TEST_ASSERT_FALSE(has_lookups_with(&key.texel[0], TEXEL_COMPARE));
    TEST_ASSERT_TRUE(has_lookups_with(&key.texel[0], TEXEL_SRGB));
    TEST_ASSERT_FALSE(has_lookups_with(&key.mip[0], MIP_POINT));
    TEST_ASSERT_FALSE(has_lookups_with(&key.minify[0], MINIFY_OTHER));
    TEST_ASSERT_FALSE(has_lookups_with(&key.bump[0], BUMP_DISPLACED));
    TEST_ASSERT_FALSE(has_lookups_with(&key.varying[VARYING_diffuse], INTERPOLATION_SMOOTH));
    TEST_ASSERT_FALSE(has_lookups_with(&key.varying[VARYING_third2], INTERPOLATION_SMOOTH));
    TEST_ASSERT_FALSE(has_lookups_with(&key.varying[VARYING_divisor2], INTERPOLATION_FLAT));
}

/* --- Shaders -------------------------------------------------------------------------------------------- */

enum answer { NO, YES };

static const struct {
    enum answer answer;
    const char *text;
} shaders[] = {
    {YES, "ps_2_0\ndcl t2.xy\ndcl v0\ndcl_2d s0\ntexld r0, t2, s0\nmul r0, r0, v0\nmov oC0, r0"},
    {YES, "ps_3_0\ndcl_texcoord2 v5.xy\ndcl_2d s0\ntexld r0, v5, s0\nmov oC0, r0"},
    {YES, "ps_3_0\ndcl_texcoord2 v5.xy\ndcl_2d s0\ntexld r0, v5.xyyy, s0\nmov oC0, r0"},
    {NO, "ps_3_0\ndcl_texcoord2 v5.xy\ndcl_2d s0\ntexld r0, v5.yxyy, s0\nmov oC0, r0"},
    {NO, "ps_3_0\ndcl_texcoord2 v5.xy\ndcl_2d s0\ntexld r0, -v5, s0\nmov oC0, r0"},
    {NO, "ps_3_0\ndcl_texcoord2 v5.xy\ndcl_2d s0\ntexld r0, v5, s0\nadd oC0, r0, v5.x"},
    {NO, "ps_3_0\ndcl_texcoord2 v5.xy\ndcl_2d s0\nmov r1, v5.xyxx\ntexld r0, r1, s0\nmov oC0, r0"},
    {NO, "ps_3_0\ndcl_texcoord2 v5.xy\ndcl_2d s0\ntexld r0, v5, s0\ndsx r0, r0\nmov oC0, r0"},
    {NO, "ps_3_0\ndcl_texcoord2 v5\ndcl_2d s0\ntexldb r0, v5, s0\nmov oC0, r0"},
    {NO, "ps_2_0\ndcl t2\ndcl_2d s0\ntexkill t2\ntexld r0, t2, s0\nmov oC0, r0"},
    {NO,
     "ps_3_0\ndcl_texcoord2 v5.xy\ndcl_2d s0\ndcl_2d s1\ntexld r0, v5, s0\ntexld r0, r0, s1\nmov oC0, r0"},
    {NO, "ps_1_4\ntexld r0, t2\nmov r0, r0"},
};

static const struct program *program_of(const char *text)
{
    struct shader *shader;
    struct error error = {""};
    TEST_ASSERT_EQUAL_MESSAGE(0, shader_assemble("test", text, strlen(text), &shader, &error), error.text);
    const struct program *program = program_acquire(shader, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, error.text);
    shader_free(shader);
    return program;
}

static void a_shader_has_lookups_if_it_only_samples_with_its_coordinates(void)
{
    key.stages = 0;
    key.texture[1] = TEXTURE_2D;
    key.mip[1] = MIP_LINEAR;
    for (size_t i = 0; i < sizeof shaders / sizeof *shaders; i++) {
        const struct program *program = program_of(shaders[i].text);
        key_set_program(key.shader, program->number);
        TEST_ASSERT_EQUAL_MESSAGE(shaders[i].answer, derive_lookups(&key, samplers), shaders[i].text);
        if (shaders[i].answer)
            TEST_ASSERT_EQUAL_HEX16(1, samplers[2]);
        program_release(program);
    }
}

/* A program without users has no routine either. */
static void a_shader_that_is_gone_has_none(void)
{
    const struct program *program = program_of(shaders[0].text);
    key_set_program(key.shader, program->number);
    program_release(program);
    TEST_ASSERT_FALSE(derive_lookups(&key, samplers));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_stage_that_samples_a_level_has_a_lookup);
    RUN_TEST(what_depends_on_more_than_positions_has_none);
    RUN_TEST(a_shader_has_lookups_if_it_only_samples_with_its_coordinates);
    RUN_TEST(a_shader_that_is_gone_has_none);
    return UNITY_END();
}
