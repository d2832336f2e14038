/* The shaders of a case and the constants that they read. They are written before the textures and vertex
 * elements that they need. */
#include "command/fuzz/case/case_part.h"
#include "command/fuzz/case/shader.h"

#include "command/stream/stream.h"
#include "capture/word.h"

#include <string.h>

/* Most shaders read few constants; distant ones are often zero. */
enum { CONSTANTS = 96, USUAL = 16, CONSTANTS_ON_A_LINE = 4 };

static unsigned texture_type(unsigned kind)
{
    switch (kind) {
#define KIND(id, name, number)                                                                               \
    case number:                                                                                             \
        return TRIPTYCH_TEXTURE_##id;
#include "def/shader/shader_usage.def"
#undef KIND
    default: return ANY_TEXTURE;
    }
}

/* Notes the samplers that it uses, from `first` on, and the elements that it needs. */
static void note(struct maker *maker, const struct fuzz_shader *shader, unsigned first)
{
    for (unsigned i = 0; i < SHADER_SAMPLERS && first + i < TRIPTYCH_SAMPLERS; i++)
        if (shader->interface.sampled >> i & 1) {
            maker->samplers |= 1u << (first + i);
            maker->sampler_type[first + i] = texture_type(shader->interface.kinds[i]);
        }
    for (unsigned i = 0; first && i < shader->interface.input_count; i++) {
        const struct shader_port *input = &shader->interface.inputs[i];
        const char *word = stream_element_word(input->usage, input->usage_index);
        unsigned element;
        if (word && !word_value(WORDS_ATTRIBUTE, word, strlen(word), &element))
            maker->elements |= 1ull << element;
    }
}

/* --- Constants ------------------------------------------------------------------------------------------ */

static void add_floats(struct maker *maker, const char *stage, const struct fuzz_shader *shader)
{
    unsigned count = shader->interface.indexed ? CONSTANTS / 2 : shader->interface.constants;
    for (unsigned c = 0; c < count && c < CONSTANTS; c += CONSTANTS_ON_A_LINE) {
        if (c >= USUAL && random_chance(&maker->random, 2))
            continue;
        text_add(maker->text, "%sconstant %u", stage, c);
        for (unsigned i = 0; i < 4 * CONSTANTS_ON_A_LINE; i++)
            if (maker->wild && random_chance(&maker->random, 16))
                text_add(maker->text, " %.9g", (double)wild_float(&maker->random));
            else
                case_number(maker, -1, 1.5f);
        text_add(maker->text, "\n");
    }
}

static void add_others(struct maker *maker, const char *stage, const struct fuzz_shader *shader)
{
    for (unsigned i = 0; i < FUZZ_SHADER_INTEGERS; i++)
        if (shader->integers >> i & 1)
            text_add(maker->text, "%sinteger %u %d %d %d\n", stage, i,
                     random_below(&maker->random, (uint32_t)shader->integer[i][0] + 1), shader->integer[i][1],
                     shader->integer[i][2]);
    for (unsigned i = 0; i < TRIPTYCH_SHADER_BOOLEANS; i++)
        if (shader->booleans >> i & 1 && random_chance(&maker->random, 2))
            text_add(maker->text, "%sboolean %u true\n", stage, i);
}

static void add_bumps(struct maker *maker, const struct fuzz_shader *shader)
{
    static const char *const name[] = {"bumpenvmat00", "bumpenvmat01",  "bumpenvmat10",
                                       "bumpenvmat11", "bumpenvlscale", "bumpenvloffset"};
    for (unsigned stage = 0; stage < TRIPTYCH_STAGES; stage++)
        for (unsigned i = 0; shader->bumps >> stage & 1 && i < sizeof name / sizeof *name; i++)
            text_add(maker->text, "stage %u %s %.9g\n", stage, name[i],
                     (double)random_float(&maker->random, -1, 1));
}

/* After the transforms, whose product is the matrix of a vertex shader. It must be finite. */
void case_constants(struct maker *maker)
{
    const struct fuzz_shader *vertex = maker->shader[TRIPTYCH_SHADER_VERTEX],
                             *pixel = maker->shader[TRIPTYCH_SHADER_PIXEL];
    if (vertex) {
        add_floats(maker, "vertex", vertex);
        add_others(maker, "vertex", vertex);
        if (vertex->matrix >= 0 && !maker->huge && !random_chance(&maker->random, 16))
            text_add(maker->text, "vertexconstant %d transform world view projection\n", vertex->matrix);
    }
    if (pixel) {
        add_floats(maker, "pixel", pixel);
        add_others(maker, "pixel", pixel);
        add_bumps(maker, pixel);
    }
}

/* --- Shaders -------------------------------------------------------------------------------------------- */

static int write_shaders(struct maker *maker, struct fuzz_shader *made)
{
    const struct fuzz_shader_options options = {.tame = !maker->wild && random_chance(&maker->random, 2)};
    struct random *random = &maker->random;
    unsigned which = random_below(random, 6);
    if (which > 1) {
        maker->shader[TRIPTYCH_SHADER_VERTEX] = &made[TRIPTYCH_SHADER_VERTEX];
        maker->shader[TRIPTYCH_SHADER_PIXEL] = &made[TRIPTYCH_SHADER_PIXEL];
        return fuzz_shader_pair(random, maker->text, "vs", "ps", &options, &made[TRIPTYCH_SHADER_VERTEX],
                                &made[TRIPTYCH_SHADER_PIXEL], NULL);
    }
    enum triptych_shader_stage stage = which ? TRIPTYCH_SHADER_VERTEX : TRIPTYCH_SHADER_PIXEL;
    maker->shader[stage] = &made[stage];
    return fuzz_shader_write(random, maker->text, stage == TRIPTYCH_SHADER_PIXEL ? "ps" : "vs",
                             fuzz_shader_model(random, (enum shader_stage)stage), &options, &made[stage],
                             NULL);
}

void case_shaders(struct maker *maker, struct fuzz_shader *made)
{
    if (random_chance(&maker->random, 3))
        return;
    if (write_shaders(maker, made)) {
        maker->text->failed = true;
        maker->shader[TRIPTYCH_SHADER_VERTEX] = maker->shader[TRIPTYCH_SHADER_PIXEL] = NULL;
        return;
    }
    if (maker->shader[TRIPTYCH_SHADER_VERTEX]) {
        note(maker, maker->shader[TRIPTYCH_SHADER_VERTEX], TRIPTYCH_VERTEX_SAMPLER);
        text_add(maker->text, "vertexshader vs\n");
    }
    if (maker->shader[TRIPTYCH_SHADER_PIXEL]) {
        note(maker, maker->shader[TRIPTYCH_SHADER_PIXEL], 0);
        text_add(maker->text, "pixelshader ps\n");
    }
}

/* Draws with a shader less, or with both again. */
void case_switch_shaders(struct maker *maker)
{
    static const char *const name[] = {"vs", "ps"}, *const call[] = {"vertexshader", "pixelshader"};
    for (unsigned stage = 0; stage < TRIPTYCH_SHADER_STAGE_COUNT; stage++)
        if (maker->shader[stage])
            text_add(maker->text, "%s %s\n", call[stage],
                     random_chance(&maker->random, 3) ? "none" : name[stage]);
}
