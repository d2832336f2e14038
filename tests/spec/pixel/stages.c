/* Single texture stages and chains of stages: every operation and argument, the temporary colour,
 * premodulation and unbound textures. The expected pixels are computed one by one from Direct3D 9's formulas,
 * on integers. */
#include "tests/support/picture/canvas.h"
#include "contract/key_query.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static unsigned limited(int value)
{
    return value < 0 ? 0 : value > 255 ? 255 : (unsigned)value;
}

/* Arguments: sources with modifiers. */
struct argument {
    int source; /* D3DTA_ */
    int complement, replicate;
};

struct half_stage {
    const char *word;
    struct argument argument[3]; /* 0, 1, 2 */
};

/* The sources of a pixel's arguments. Each has a word. */
enum { DIFFUSE, CURRENT, TEXTURE, FACTOR, SPECULAR, TEMPORARY, CONSTANT, SOURCES };
typedef const uint32_t sources[SOURCES];

static int argument_value(const struct argument *a, sources from, int c)
{
    int value = (int)channel(from[a->source], a->replicate ? 3 : c);
    return a->complement ? 255 - value : value;
}

static int rounded(int numerator)
{
    return (int)floor(numerator / 255.0 + 0.5);
}

static int dot(const struct half_stage *h, sources from)
{
    int s = 0;
    for (int c = 0; c < 3; c++)
        s += (argument_value(&h->argument[1], from, c) - 128) *
             (argument_value(&h->argument[2], from, c) - 128);
    return (int)floor(s / 64.0);
}

static int blend_by(int a, int b, int weight)
{
    return rounded(a * weight + b * (255 - weight));
}

/* Direct3D 9's formulas, one by one. */
static unsigned combined(const struct half_stage *h, sources from, int c)
{
    int z = argument_value(&h->argument[0], from, c), a = argument_value(&h->argument[1], from, c);
    int b = argument_value(&h->argument[2], from, c), p = rounded(a * b);
    int alpha = argument_value(&h->argument[1], from, 3), texture = (int)channel(from[TEXTURE], 3);
    const struct {
        const char *word;
        int value;
    } results[] = {{"selectarg1", a},
                   {"selectarg2", b},
                   {"premodulate", a},
                   {"modulate", p},
                   {"modulate2x", 2 * p},
                   {"modulate4x", 4 * p},
                   {"add", a + b},
                   {"addsigned", a + b - 128},
                   {"addsigned2x", 2 * (a + b - 128)},
                   {"subtract", a - b},
                   {"addsmooth", a + b - p},
                   {"blenddiffusealpha", blend_by(a, b, (int)channel(from[DIFFUSE], 3))},
                   {"blendtexturealpha", blend_by(a, b, texture)},
                   {"blendfactoralpha", blend_by(a, b, (int)channel(from[FACTOR], 3))},
                   {"blendtexturealphapm", a + rounded(b * (255 - texture))},
                   {"blendcurrentalpha", blend_by(a, b, (int)channel(from[CURRENT], 3))},
                   {"multiplyadd", z + p},
                   {"lerp", blend_by(a, b, z)},
                   {"modulatealpha_addcolor", a + rounded(alpha * b)},
                   {"modulatecolor_addalpha", p + alpha},
                   {"modulateinvalpha_addcolor", a + rounded((255 - alpha) * b)},
                   {"modulateinvcolor_addalpha", rounded((255 - a) * b) + alpha},
                   {"dotproduct3", dot(h, from)}};
    for (unsigned i = 0; i < sizeof results / sizeof results[0]; i++)
        if (!strcmp(results[i].word, h->word))
            return limited(results[i].value);
    TEST_FAIL_MESSAGE(h->word);
    return 0;
}

static uint32_t expected_stage(const struct half_stage *color, const struct half_stage *alpha, sources from)
{
    uint32_t word = 0;
    int all = !strcmp(color->word, "dotproduct3");
    for (int c = 0; c < 4; c++)
        word |= combined(c < 3 || all ? color : alpha, from, c) << 8 * c;
    return word;
}

static void random_half(struct half_stage *h, const char *word)
{
    h->word = word;
    for (int i = 0; i < 3; i++)
        h->argument[i] = (struct argument){(int)(random_word() % SOURCES), (int)(random_word() & 1),
                                           (int)(random_word() & 1)};
}

static void set_half(unsigned stage, const struct half_stage *h, enum triptych_stage_state operation,
                     const enum triptych_stage_state argument[3])
{
    set_stage(stage, operation, h->word);
    for (int i = 0; i < 3; i++) {
        const struct argument *a = &h->argument[i];
        uint32_t value = (uint32_t)(a->source + 0x10 * a->complement + 0x20 * a->replicate);
        OK(triptych_set_stage_state(device, stage, argument[i], value));
    }
}

struct whole_stage {
    struct half_stage color, alpha;
    uint32_t constant; /* packed */
    int temporary;
    unsigned texture; /* of `textures` */
};

enum { TEXTURES = 3 };
static uint32_t texels[TEXTURES][SIZE * SIZE];
static triptych_texture *textures[TEXTURES];

static void make_textures(void)
{
    for (int i = 0; i < TEXTURES; i++) {
        for (int p = 0; p < SIZE * SIZE; p++)
            texels[i][p] = random_word();
        OK(triptych_texture_create(device, texels[i], SIZE, SIZE, &textures[i]));
    }
}

static void set_whole(unsigned i, const struct whole_stage *stage)
{
    static const enum triptych_stage_state color_arguments[3] = {
        TRIPTYCH_STAGE_COLORARG0, TRIPTYCH_STAGE_COLORARG1, TRIPTYCH_STAGE_COLORARG2};
    static const enum triptych_stage_state alpha_arguments[3] = {
        TRIPTYCH_STAGE_ALPHAARG0, TRIPTYCH_STAGE_ALPHAARG1, TRIPTYCH_STAGE_ALPHAARG2};
    set_half(i, &stage->color, TRIPTYCH_STAGE_COLOROP, color_arguments);
    set_half(i, &stage->alpha, TRIPTYCH_STAGE_ALPHAOP, alpha_arguments);
    set_stage(i, TRIPTYCH_STAGE_RESULTARG, stage->temporary ? "temp" : "current");
    set_stage(i, TRIPTYCH_STAGE_TEXCOORDINDEX, "0");
    OK(triptych_set_stage_state(device, i, TRIPTYCH_STAGE_CONSTANT, stage->constant));
    OK(triptych_set_texture(device, i, textures[stage->texture]));
}

/* Returns the current colour, multiplied by the texture if the previous stage premodulates. */
static uint32_t premodulated(const struct whole_stage *before, uint32_t current, uint32_t texture)
{
    uint32_t word = 0;
    int all = !strcmp(before->color.word, "dotproduct3");
    for (int c = 0; c < 4; c++) {
        const struct half_stage *half = c < 3 || all ? &before->color : &before->alpha;
        int value = (int)channel(current, c);
        if (!strcmp(half->word, "premodulate"))
            value = rounded(value * (int)channel(texture, c));
        word |= (uint32_t)value << 8 * c;
    }
    return word;
}

static uint32_t expected_chain(const struct whole_stage *stage, unsigned count, uint32_t diffuse,
                               uint32_t factor, int p)
{
    uint32_t current = diffuse, temporary = 0;
    for (unsigned i = 0; i < count; i++) {
        uint32_t texture = texels[stage[i].texture][p];
        uint32_t read = i ? premodulated(&stage[i - 1], current, texture) : current;
        sources from = {diffuse, read, texture, factor, 0, temporary, image_word(stage[i].constant)};
        uint32_t result = expected_stage(&stage[i].color, &stage[i].alpha, from);
        *(stage[i].temporary ? &temporary : &current) = result;
    }
    return current;
}

static void check_chain(const struct whole_stage *stage, unsigned count)
{
    uint32_t diffuse = random_word(), factor = random_word();
    char what[96];
    for (unsigned i = 0; i < count; i++)
        set_whole(i, &stage[i]);
    if (count < TRIPTYCH_STAGES)
        set_stage(count, TRIPTYCH_STAGE_COLOROP, "disable");
    snprintf(what, sizeof what, "%u stages, the last %s and %s", count, stage[count - 1].color.word,
             stage[count - 1].alpha.word);
    OK(triptych_set_state(device, TRIPTYCH_STATE_TEXTUREFACTOR, factor));
    draw_square(0, diffuse, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE,
                     expected_chain(stage, count, image_word(diffuse), image_word(factor), p), what);
}

/* The last five are for colour only. */
static const char *const operation_words[] = {"selectarg1",
                                              "selectarg2",
                                              "premodulate",
                                              "modulate",
                                              "modulate2x",
                                              "modulate4x",
                                              "add",
                                              "addsigned",
                                              "addsigned2x",
                                              "subtract",
                                              "addsmooth",
                                              "blenddiffusealpha",
                                              "blendtexturealpha",
                                              "blendfactoralpha",
                                              "blendtexturealphapm",
                                              "blendcurrentalpha",
                                              "multiplyadd",
                                              "lerp",
                                              "modulatealpha_addcolor",
                                              "modulatecolor_addalpha",
                                              "modulateinvalpha_addcolor",
                                              "modulateinvcolor_addalpha",
                                              "dotproduct3"};
enum { OPERATIONS = sizeof operation_words / sizeof operation_words[0], ALPHA_OPERATIONS = OPERATIONS - 5 };

static void random_stage(struct whole_stage *stage, const char *color, const char *alpha)
{
    random_half(&stage->color, color);
    random_half(&stage->alpha, alpha);
    stage->constant = random_word();
    stage->temporary = 0;
    stage->texture = random_word() % TEXTURES;
}

static const char *random_operation(unsigned count)
{
    return operation_words[random_word() % count];
}

static void check_stages(void)
{
    struct whole_stage stage;
    make_textures();
    for (int i = 0; i < OPERATIONS; i++)
        for (int round = 0; round < (int)test_share(12); round++) {
            random_stage(&stage, operation_words[i], random_operation(ALPHA_OPERATIONS));
            if (round % 3 == 0 && i < ALPHA_OPERATIONS)
                stage.alpha = stage.color; /* all channels alike */
            check_chain(&stage, 1);
        }
    for (int i = 0; i < ALPHA_OPERATIONS; i++) {
        random_stage(&stage, random_operation(OPERATIONS), operation_words[i]);
        check_chain(&stage, 1);
    }
}

/* Half of the stages read the current colour, so that earlier stages affect the result. */
static void check_chains(void)
{
    struct whole_stage stage[TRIPTYCH_STAGES];
    make_textures();
    for (int round = 0; round < (int)test_share(60); round++) {
        unsigned count = 2 + random_word() % (TRIPTYCH_STAGES - 1);
        for (unsigned i = 0; i < count; i++) {
            random_stage(&stage[i], random_operation(OPERATIONS), random_operation(ALPHA_OPERATIONS));
            stage[i].temporary = random_word() % 4 == 0;
            if (random_word() & 1)
                stage[i].color.argument[1].source = stage[i].alpha.argument[1].source = CURRENT;
        }
        check_chain(stage, count);
    }
}

/* The most frequent chains: two textures, modulated, added, or blended by alpha. */
static void check_usual_chains(void)
{
    static const char *const usual[] = {"selectarg1", "modulate", "add", "modulate2x", "blendtexturealpha"};
    struct whole_stage stage[3];
    make_textures();
    for (unsigned round = 0; round < test_share(25); round++) {
        for (int i = 0; i < 3; i++) {
            const char *word = usual[i ? (round / (i == 1 ? 5 : 1)) % 5 : round % 2];
            random_stage(&stage[i], word, word);
            for (int j = 1; j < 3; j++)
                stage[i].color.argument[j] = stage[i].alpha.argument[j] =
                    (struct argument){j == 1 ? TEXTURE : CURRENT, 0, 0};
        }
        check_chain(stage, 2 + round % 2);
    }
}

/* Without a texture, the half of a stage that reads it is off, and a half that does not read it is on. */
static void check_stages_without_texture(void)
{
    static const struct {
        const char *operation, *argument;
        uint32_t expected;
    } cases[] = {{"modulate", "texture", 0x20302010},
                 {"disable", "tfactor", 0x40302010},
                 {"selectarg1", "tfactor", 0x80706050},
                 {"add", "tfactor", 0xc0a08060}};
    OK(triptych_set_state(device, TRIPTYCH_STATE_TEXTUREFACTOR, 0x80706050));
    set_stage(0, TRIPTYCH_STAGE_ALPHAARG1, "tfactor");
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        set_stage(0, TRIPTYCH_STAGE_COLOROP, cases[i].operation);
        set_stage(0, TRIPTYCH_STAGE_ALPHAOP, cases[i].operation);
        set_stage(0, TRIPTYCH_STAGE_COLORARG1, cases[i].argument);
        draw_square(0, 0x40302010, NULL, 0, 0, 1, 1);
        OK(triptych_read_color(device, image, sizeof image));
        for (int p = 0; p < SIZE * SIZE; p++)
            expect_pixel(p % SIZE, p / SIZE, image_word(cases[i].expected), cases[i].operation);
    }
}

static void test_stages_combine_channels_as_defined(void)
{
    on_every_engine(check_stages);
}

static void test_stages_build_on_earlier_ones(void)
{
    on_every_engine(check_chains);
}

static void test_textures_are_combined_in_stages(void)
{
    on_every_engine(check_usual_chains);
}

static void test_stages_without_a_texture(void)
{
    on_every_engine(check_stages_without_texture);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_stages_combine_channels_as_defined);
    RUN_TEST(test_stages_build_on_earlier_ones);
    RUN_TEST(test_textures_are_combined_in_stages);
    RUN_TEST(test_stages_without_a_texture);
    return UNITY_END();
}
