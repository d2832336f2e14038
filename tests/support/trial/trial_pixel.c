/* Runs a trial's pixel shader by whole draws, one pixel for each set of operands. The operands are texels of
 * binary32 textures, and the results go to binary32 targets. */
#include "tests/support/picture/canvas.h"
#include "tests/support/trial/trial.h"

#include "contract/engine.h"
#include "engines/list.h"
#include "shader/program/program.h"

#include <string.h>

enum { ENGINES = 32, TARGETS_USED = 4, ROWS = 16, PIXELS = SIZE * ROWS };

/* One for all trials, never freed. */
static struct painter {
    const struct engine *engine;
    triptych_device *device;
    triptych_texture *operand[TRIAL_OPERANDS];
    struct trial_operands held[PIXELS]; /* the textures' texels */
    unsigned sets;
} painters[ENGINES];

static triptych_shader *assemble(const char *text)
{
    triptych_shader *shader;
    OK(triptych_shader_assemble(device, "trial", text, strlen(text), &shader));
    return shader;
}

static void open_painter(struct painter *painter, const char *engine)
{
    struct triptych_options options = {.engine = engine, .threads = 1};
    char reason[256] = "";
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        TRIPTYCH_OK, triptych_device_create(&options, &painter->device, reason, sizeof reason), reason);
    device = painter->device;
    struct triptych_target_description target = {.width = SIZE, .height = ROWS};
    for (int t = 0; t < TARGETS_USED; t++)
        target.color_format[t] = TRIPTYCH_SURFACE_A32B32G32R32F;
    OK(triptych_set_target_description(device, &target));
    set(TRIPTYCH_STATE_CULLMODE, "none");
    set(TRIPTYCH_STATE_ZENABLE, "false");
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
    for (unsigned o = 0; o < TRIAL_OPERANDS; o++) {
        struct triptych_texture_description texture = {.type = TRIPTYCH_TEXTURE_2D,
                                                       .format = TRIPTYCH_SURFACE_A32B32G32R32F,
                                                       .width = SIZE,
                                                       .height = ROWS,
                                                       .depth = 1,
                                                       .levels = 1};
        OK(triptych_texture_define(device, &texture, &painter->operand[o]));
        OK(triptych_set_texture(device, o + 1, painter->operand[o]));
        set_sampler(o + 1, TRIPTYCH_SAMPLER_MINFILTER, "point");
        set_sampler(o + 1, TRIPTYCH_SAMPLER_MAGFILTER, "point");
        set_sampler(o + 1, TRIPTYCH_SAMPLER_ADDRESSU, "clamp");
        set_sampler(o + 1, TRIPTYCH_SAMPLER_ADDRESSV, "clamp");
    }
}

static struct painter *painter_of(const struct engine *engine)
{
    unsigned i = 0;
    while (i < ENGINES && painters[i].engine && painters[i].engine != engine)
        i++;
    TEST_ASSERT_TRUE(i < ENGINES);
    painters[i].engine = engine;
    if (!painters[i].device)
        open_painter(&painters[i], engine->name);
    return &painters[i];
}

static void fill_operands(struct painter *painter, const struct trial *trial)
{
    static float texels[PIXELS][4];
    size_t bytes = trial->sets * sizeof *trial->operands;
    TEST_ASSERT_TRUE(trial->sets <= PIXELS);
    if (painter->sets == trial->sets && !memcmp(painter->held, trial->operands, bytes))
        return;
    for (unsigned o = 0; o < TRIAL_OPERANDS; o++) {
        for (unsigned p = 0; p < PIXELS; p++)
            memcpy(texels[p], trial->operands[p % trial->sets].v[o], sizeof *texels);
        OK(triptych_texture_update(device, painter->operand[o], 0, 0, NULL, texels, sizeof *texels * SIZE,
                                   0));
    }
    memcpy(painter->held, trial->operands, bytes);
    painter->sets = trial->sets;
}

static void set_constants(const struct trial *trial)
{
    static const float zeros[224][4];
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, zeros[0], 224));
    if (trial->constants)
        OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, trial->constant[0],
                                      trial->constants));
    if (trial->integers)
        OK(triptych_set_shader_integers(device, TRIPTYCH_SHADER_PIXEL, 0, trial->integer[0],
                                        trial->integers));
    int32_t booleans[TRIPTYCH_SHADER_BOOLEANS];
    for (int i = 0; i < TRIPTYCH_SHADER_BOOLEANS; i++)
        booleans[i] = trial->booleans >> i & 1;
    OK(triptych_set_shader_booleans(device, TRIPTYCH_SHADER_PIXEL, 0, booleans, TRIPTYCH_SHADER_BOOLEANS));
    OK(triptych_set_convention(device, TRIPTYCH_MULTIPLY,
                               trial->legacy ? TRIPTYCH_MULTIPLY_LEGACY : TRIPTYCH_MULTIPLY_IEEE));
}

/* Returns a vertex shader that can be used with a pixel shader of the model. */
static const char *companion(const struct shader_model *model)
{
    if (shader_major(model) == 3)
        return "vs_3_0\ndcl_position v0\ndcl_texcoord v1\ndcl_position o0\ndcl_texcoord o1.xy\nmov o0, "
               "v0\nmov o1.xy, v1\n";
    return "vs_2_0\ndcl_position v0\ndcl_texcoord v1\nmov oPos, v0\nmov oT0, v1\nmov oT1, v1\nmov oT2, v1\n";
}

static void take_results(const struct trial *trial, struct trial_results *results)
{
    static float numbers[PIXELS][4];
    for (unsigned r = 0; r < trial->results; r++) {
        OK(triptych_read_target_numbers(device, r, numbers[0], sizeof numbers));
        for (unsigned set = 0; set < trial->sets; set++)
            memcpy(results[set].v[r], numbers[set], sizeof *numbers);
    }
}

void trial_run_pixels(const struct trial *trial, const char *text, const struct engine *engine,
                      struct trial_results *results)
{
    static const float nothing[4];
    struct painter *painter = painter_of(engine);
    device = painter->device;
    fill_operands(painter, trial);
    set_constants(trial);
    const char *above = companion(trial_model(trial->model));
    triptych_shader *vertex = assemble(above), *pixel = assemble(text);
    OK(triptych_set_vertex_shader(device, vertex));
    OK(triptych_set_pixel_shader(device, pixel));
    OK(triptych_set_scissor(device, 0, 0, SIZE, (trial->sets + SIZE - 1) / SIZE));
    OK(triptych_clear(device, nothing, 1));
    draw_square(0.5f, 0, NULL, 0, 0, 1, 1);
    take_results(trial, results);
    OK(triptych_shader_destroy(device, pixel));
    OK(triptych_shader_destroy(device, vertex));
    device = NULL;
}
