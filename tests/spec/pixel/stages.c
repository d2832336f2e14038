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

/* The last five are for colour only. */
enum operation {
    SELECTARG1,
    SELECTARG2,
    PREMODULATE,
    MODULATE,
    MODULATE2X,
    MODULATE4X,
    ADD,
    ADDSIGNED,
    ADDSIGNED2X,
    SUBTRACT,
    ADDSMOOTH,
    BLENDDIFFUSEALPHA,
    BLENDTEXTUREALPHA,
    BLENDFACTORALPHA,
    BLENDTEXTUREALPHAPM,
    BLENDCURRENTALPHA,
    MULTIPLYADD,
    LERP,
    MODULATEALPHA_ADDCOLOR,
    MODULATECOLOR_ADDALPHA,
    MODULATEINVALPHA_ADDCOLOR,
    MODULATEINVCOLOR_ADDALPHA,
    DOTPRODUCT3,
    OPERATIONS,
    ALPHA_OPERATIONS = OPERATIONS - 5
};

static const char *const operation_words[OPERATIONS] = {"selectarg1",
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

struct half_stage {
    enum operation operation;
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
    switch (h->operation) {
    case SELECTARG1: return limited(a);
    case SELECTARG2: return limited(b);
    case PREMODULATE: return limited(a);
    case MODULATE: return limited(p);
    case MODULATE2X: return limited(2 * p);
    case MODULATE4X: return limited(4 * p);
    case ADD: return limited(a + b);
    case ADDSIGNED: return limited(a + b - 128);
    case ADDSIGNED2X: return limited(2 * (a + b - 128));
    case SUBTRACT: return limited(a - b);
    case ADDSMOOTH: return limited(a + b - p);
    case BLENDDIFFUSEALPHA: return limited(blend_by(a, b, (int)channel(from[DIFFUSE], 3)));
    case BLENDTEXTUREALPHA: return limited(blend_by(a, b, texture));
    case BLENDFACTORALPHA: return limited(blend_by(a, b, (int)channel(from[FACTOR], 3)));
    case BLENDTEXTUREALPHAPM: return limited(a + rounded(b * (255 - texture)));
    case BLENDCURRENTALPHA: return limited(blend_by(a, b, (int)channel(from[CURRENT], 3)));
    case MULTIPLYADD: return limited(z + p);
    case LERP: return limited(blend_by(a, b, z));
    case MODULATEALPHA_ADDCOLOR: return limited(a + rounded(alpha * b));
    case MODULATECOLOR_ADDALPHA: return limited(p + alpha);
    case MODULATEINVALPHA_ADDCOLOR: return limited(a + rounded((255 - alpha) * b));
    case MODULATEINVCOLOR_ADDALPHA: return limited(rounded((255 - a) * b) + alpha);
    case DOTPRODUCT3: return limited(dot(h, from));
    default: TEST_FAIL_MESSAGE("an operation without a formula"); return 0;
    }
}

static uint32_t expected_stage(const struct half_stage *color, const struct half_stage *alpha, sources from)
{
    uint32_t word = 0;
    int all = color->operation == DOTPRODUCT3;
    for (int c = 0; c < 4; c++)
        word |= combined(c < 3 || all ? color : alpha, from, c) << 8 * c;
    return word;
}

static void random_half(struct half_stage *h, enum operation operation)
{
    h->operation = operation;
    for (int i = 0; i < 3; i++)
        h->argument[i] = (struct argument){(int)(random_word() % SOURCES), (int)(random_word() & 1),
                                           (int)(random_word() & 1)};
}

static void set_half(unsigned stage, const struct half_stage *h, enum triptych_stage_state operation,
                     const enum triptych_stage_state argument[3])
{
    set_stage(stage, operation, operation_words[h->operation]);
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
    int all = before->color.operation == DOTPRODUCT3;
    for (int c = 0; c < 4; c++) {
        const struct half_stage *half = c < 3 || all ? &before->color : &before->alpha;
        int value = (int)channel(current, c);
        if (half->operation == PREMODULATE)
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
    snprintf(what, sizeof what, "%u stages, the last %s and %s", count,
             operation_words[stage[count - 1].color.operation],
             operation_words[stage[count - 1].alpha.operation]);
    OK(triptych_set_state(device, TRIPTYCH_STATE_TEXTUREFACTOR, factor));
    draw_square(0, diffuse, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride())
        expect_pixel(p % SIZE, p / SIZE,
                     expected_chain(stage, count, image_word(diffuse), image_word(factor), p), what);
}

static void random_stage(struct whole_stage *stage, enum operation color, enum operation alpha)
{
    random_half(&stage->color, color);
    random_half(&stage->alpha, alpha);
    stage->constant = random_word();
    stage->temporary = 0;
    stage->texture = random_word() % TEXTURES;
}

static enum operation random_operation(unsigned count)
{
    return (enum operation)(random_word() % count);
}

static void check_stages(void)
{
    struct whole_stage stage;
    make_textures();
    for (enum operation i = 0; i < OPERATIONS; i++)
        for (int round = 0; round < (int)test_share_of(12, 12); round++) {
            random_stage(&stage, i, random_operation(ALPHA_OPERATIONS));
            if (round % 3 == 0 && i < ALPHA_OPERATIONS)
                stage.alpha = stage.color; /* all channels alike */
            check_chain(&stage, 1);
        }
    for (enum operation i = 0; i < ALPHA_OPERATIONS; i++) {
        random_stage(&stage, random_operation(OPERATIONS), i);
        check_chain(&stage, 1);
    }
}

/* Half of the stages read the current colour, so that earlier stages affect the result. */
static void check_chains(void)
{
    struct whole_stage stage[TRIPTYCH_STAGES];
    make_textures();
    for (int round = 0; round < (int)test_share_of(60, 6); round++) {
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
    static const enum operation usual[] = {SELECTARG1, MODULATE, ADD, MODULATE2X, BLENDTEXTUREALPHA};
    struct whole_stage stage[3];
    make_textures();
    for (unsigned round = 0; round < test_share(25); round++) {
        for (int i = 0; i < 3; i++) {
            enum operation operation = usual[i ? (round / (i == 1 ? 5 : 1)) % 5 : round % 2];
            random_stage(&stage[i], operation, operation);
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
