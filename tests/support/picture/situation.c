#include "tests/support/picture/situation.h"

#include "tests/support/shader/programs.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { WORD_CAPACITY = 48, BUFFER_BYTES = 4096, TEXTURES = 64 };

/* The remainder of a description, and the statement that is being read. */
struct reader {
    const char *at;
    struct situation *situation;
    char word[WORD_CAPACITY];
    struct error error;
};

static const char *next(struct reader *r)
{
    r->at += strspn(r->at, " ");
    size_t length = strcspn(r->at, " ");
    TEST_ASSERT_TRUE_MESSAGE(length < WORD_CAPACITY, r->at);
    memcpy(r->word, r->at, length);
    r->word[length] = 0;
    r->at += length;
    return r->word;
}

static unsigned number(struct reader *r, unsigned limit)
{
    char *end;
    unsigned long value = strtoul(next(r), &end, 0);
    TEST_ASSERT_TRUE_MESSAGE(end != r->word && !*end && value < limit, r->word);
    return (unsigned)value;
}

/* Returns the index of the next word in a list. */
static unsigned choice(struct reader *r, const char *const *words, unsigned count)
{
    next(r);
    for (unsigned i = 0; i < count; i++)
        if (!strcmp(r->word, words[i]))
            return i;
    TEST_FAIL_MESSAGE(r->word);
    return 0;
}

#define CHOICE(r, words) choice(r, words, sizeof(words) / sizeof *(words))

static uint32_t state_value(struct reader *r, const struct triptych_kind *kind)
{
    uint32_t value;
    char *end;
    next(r);
    if (!triptych_value_number(kind, r->word, &value))
        return value;
    value = kind->notation == TRIPTYCH_NOTATION_REAL ? triptych_float_bits(strtof(r->word, &end))
                                                     : (uint32_t)strtoul(r->word, &end, 0);
    TEST_ASSERT_TRUE_MESSAGE(end != r->word && !*end, r->word);
    return value;
}

static enum triptych_result set_value(struct reader *r, enum triptych_state_table table)
{
    unsigned i = table == TRIPTYCH_RENDER_STATES ? 0 : number(r, triptych_table_size(table)), row = 0;
    next(r);
    while (triptych_state_at(table, row) && strcmp(triptych_state_at(table, row)->name, r->word) != 0)
        row++;
    TEST_ASSERT_NOT_NULL_MESSAGE(triptych_state_at(table, row), r->word);
    return state_set_value(&r->situation->state, table, i, row,
                           state_value(r, triptych_state_at(table, row)->kind), &r->error);
}

static enum triptych_result set_state(struct reader *r)
{
    return set_value(r, TRIPTYCH_RENDER_STATES);
}

static enum triptych_result set_sampler(struct reader *r)
{
    return set_value(r, TRIPTYCH_SAMPLER_STATES);
}

static enum triptych_result set_stage(struct reader *r)
{
    return set_value(r, TRIPTYCH_STAGE_STATES);
}

/* Returns a texture of this description without texels. Equal descriptions give the same texture. */
static struct triptych_texture *texture_of(const struct triptych_texture_description *description)
{
    static uint32_t texel[4];
    static struct triptych_texture_description known[TEXTURES];
    static struct triptych_texture texture[TEXTURES];
    static unsigned count;
    unsigned i = 0;
    while (i < count && memcmp(&known[i], description, sizeof *description) != 0)
        i++;
    if (i < count)
        return &texture[i];
    struct error error = {{0}};
    TEST_ASSERT_TRUE(count < TEXTURES);
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, texture_describe(description, &texture[i], &error),
                                  error.text);
    texture[i].texels = texel;
    known[count++] = *description;
    return &texture[i];
}

static enum triptych_result set_texture(struct reader *r)
{
    static const char *const type[] = {"2d", "cube", "volume", "none"};
    struct triptych_texture_description description;
    unsigned i = number(r, TRIPTYCH_SAMPLERS), which = CHOICE(r, type);
    memset(&description, 0, sizeof description);
    if (which == TRIPTYCH_TEXTURE_TYPE_COUNT) {
        r->situation->state.texture[i] = NULL;
        return TRIPTYCH_OK;
    }
    next(r);
    const struct format *format = format_named(r->word, strlen(r->word));
    TEST_ASSERT_NOT_NULL_MESSAGE(format, r->word);
    description.type = (enum triptych_texture_type)which;
    description.format = (enum triptych_surface_format)format->number;
    description.width = description.height = number(r, TRIPTYCH_TEXTURE_MAXIMUM + 1);
    description.depth = which == TRIPTYCH_TEXTURE_VOLUME ? description.width : 1;
    r->situation->state.texture[i] = texture_of(&description);
    return TRIPTYCH_OK;
}

/* `vertex none`, `pixel none`: the fixed function. */
static enum triptych_result set_shader(struct reader *r, enum shader_stage stage)
{
    static struct shader_registers registers;
    const struct program *program = strcmp(next(r), "none") ? sample_named(r->word) : NULL;
    TEST_ASSERT_TRUE_MESSAGE(!program || program->model->stage == stage, r->word);
    r->situation->state.program[stage] = program;
    r->situation->state.registers[stage] = &registers;
    return TRIPTYCH_OK;
}

static enum triptych_result set_vertex_shader(struct reader *r)
{
    return set_shader(r, STAGE_VERTEX);
}

static enum triptych_result set_pixel_shader(struct reader *r)
{
    return set_shader(r, STAGE_PIXEL);
}

static enum triptych_result set_booleans(struct reader *r)
{
    uint16_t *bits = &r->situation->state.booleans[number(r, SHADER_STAGES)];
    *bits = (uint16_t)number(r, 0x10000);
    return TRIPTYCH_OK;
}

static enum triptych_result set_light(struct reader *r)
{
    static const char *const type[] = {"directional", "point"};
    unsigned i = number(r, TRIPTYCH_LIGHTS);
    struct triptych_light light = r->situation->state.light[i];
    light.type = (enum triptych_light_type)CHOICE(r, type);
    light.range = 100;
    light.attenuation[0] = 1;
    r->situation->state.light_enabled[i] = 1;
    return state_set_light(&r->situation->state, i, &light, &r->error);
}

static enum triptych_result bind(struct situation *situation, unsigned attribute, enum triptych_format format)
{
    static uint8_t bytes[BUFFER_BYTES];
    static struct triptych_buffer buffer = {.data = bytes, .bytes = sizeof bytes};
    struct triptych_element element = {format, &buffer, 16 * attribute, 512};
    return state_set_element(&situation->state, (enum triptych_attribute)attribute, &element, NULL);
}

static enum triptych_format format(struct reader *r)
{
    static const char *const word[] = {
        "none",
#define VERTEX_TYPE(name, word, components, encoding, bits, divisor, meaning) #word,
#include "def/state/vertex_type.def"
#undef VERTEX_TYPE
    };
    return (enum triptych_format)CHOICE(r, word);
}

static enum triptych_result set_attribute(struct reader *r)
{
    unsigned attribute = choice(r, state_attribute_name, TRIPTYCH_ATTRIBUTE_COUNT);
    return bind(r->situation, attribute, format(r));
}

static void add_other(struct state *state, enum triptych_usage usage, uint8_t index,
                      enum triptych_format format)
{
    if (format)
        state->other[state->others++] =
            (struct state_other){(uint8_t)usage, index, {.format = format, .stream = 0}};
}

static enum triptych_result set_blending(struct reader *r)
{
    r->situation->state.others = 0;
    add_other(&r->situation->state, TRIPTYCH_USAGE_BLENDINDICES, 1, format(r));
    add_other(&r->situation->state, TRIPTYCH_USAGE_COLOR, 2, format(r));
    return TRIPTYCH_OK;
}

static enum triptych_result set_target(struct reader *r)
{
    static const char *const storage[] = {
#define TARGET(name, planes, red, green, blue, alpha, meaning) #name,
#include "def/state/target.def"
#undef TARGET
    };
    struct target_channels *target = &r->situation->state.target[number(r, TARGETS)];
    target->storage = (uint8_t)CHOICE(r, storage);
    target->channels = (uint8_t)number(r, 16);
    return TRIPTYCH_OK;
}

static enum triptych_result set_depth(struct reader *r)
{
    static const char *const format[] = {
#define DEPTH_FORMAT(name, word, storage, depth_bits, stencil_bits, meaning) #word,
#include "def/state/depth_format.def"
#undef DEPTH_FORMAT
    };
    r->situation->state.depth_format = (enum triptych_depth_format)CHOICE(r, format);
    return TRIPTYCH_OK;
}

static enum triptych_result set_samples(struct reader *r)
{
    r->situation->state.samples = (uint8_t)number(r, 4);
    return TRIPTYCH_OK;
}

static enum triptych_result set_projection(struct reader *r)
{
    static const char *const name[] = {"parallel", "perspective"};
    static const float perspective[4][4] = {{1.5f, 0, 0, 0},
                                            {0, 2, 0, 0},
                                            {0, 0, 1.01f, 1},
                                            {0, 0, -1.01f, 0}},
                       parallel[4][4] = {{.1f, 0, 0, 0}, {0, .1f, 0, 0}, {0, 0, .01f, 0}, {0, 0, 0, 1}};
    return state_set_transform(&r->situation->state, TRIPTYCH_TRANSFORM_PROJECTION,
                               CHOICE(r, name) ? perspective : parallel, &r->error);
}

static enum triptych_result set_drawn(struct reader *r)
{
    static const char *const name[] = {"triangles", "lines", "points"};
    static const uint8_t drawn[] = {TRIPTYCH_TRIANGLE_LIST, TRIPTYCH_LINE_LIST, TRIPTYCH_POINT_LIST};
    r->situation->drawn = (enum triptych_primitive)drawn[CHOICE(r, name)];
    return TRIPTYCH_OK;
}

const char *situation_add(struct situation *situation, const char *description)
{
    static const char *const name[] = {"state",     "sampler", "stage", "texture",  "light",
                                       "attribute", "target",  "depth", "samples",  "projection",
                                       "draw",      "vertex",  "pixel", "booleans", "blending"};
    static enum triptych_result (*const follow[])(struct reader *) = {
        set_state,     set_sampler,       set_stage,        set_texture,  set_light,
        set_attribute, set_target,        set_depth,        set_samples,  set_projection,
        set_drawn,     set_vertex_shader, set_pixel_shader, set_booleans, set_blending};
    static struct reader r;
    r = (struct reader){.at = description, .situation = situation};
    for (r.at += strspn(r.at, " "); *r.at; r.at += strspn(r.at, " ")) {
        enum triptych_result result = follow[CHOICE(&r, name)](&r);
        if (result == TRIPTYCH_UNSUPPORTED)
            return r.error.text;
        TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, result, r.error.text);
    }
    return NULL;
}

static void bind_attributes(struct situation *situation)
{
    static const uint8_t format[TRIPTYCH_ATTRIBUTE_COUNT] = {
        [TRIPTYCH_POSITION] = TRIPTYCH_FORMAT_FLOAT3,  [TRIPTYCH_NORMAL] = TRIPTYCH_FORMAT_FLOAT3,
        [TRIPTYCH_DIFFUSE] = TRIPTYCH_FORMAT_COLOR,    [TRIPTYCH_SPECULAR] = TRIPTYCH_FORMAT_COLOR,
        [TRIPTYCH_WEIGHTS] = TRIPTYCH_FORMAT_FLOAT3,   [TRIPTYCH_INDICES] = TRIPTYCH_FORMAT_UBYTE4,
        [TRIPTYCH_POSITION1] = TRIPTYCH_FORMAT_FLOAT3, [TRIPTYCH_NORMAL1] = TRIPTYCH_FORMAT_FLOAT3};
    for (unsigned i = 0; i < TRIPTYCH_ATTRIBUTE_COUNT; i++)
        if (format[i])
            bind(situation, i, (enum triptych_format)format[i]);
    for (unsigned i = 0; i < TEXCOORD_SETS; i++)
        bind(situation, TRIPTYCH_TEXCOORD + i, TRIPTYCH_FORMAT_FLOAT4);
}

/* Sets matrices that rotate, move and scale by different amounts, so that no element has its default
 * value. */
static void transform(struct situation *situation)
{
    static const float world[4][4] = {{0, 2, 0, 0}, {-2, 0, 0, 0}, {0, 0, 2, 0}, {1, 2, 3, 1}};
    static const float view[4][4] = {{0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}, {.5f, .25f, 8, 1}};
    state_set_transform(&situation->state, TRIPTYCH_TRANSFORM_WORLD, world, NULL);
    state_set_transform(&situation->state, TRIPTYCH_TRANSFORM_VIEW, view, NULL);
    situation_add(situation, "projection perspective");
}

static void set_material(struct situation *situation)
{
    struct triptych_material material;
    float value[sizeof material / sizeof(float)];
    for (size_t i = 0; i < sizeof value / sizeof *value; i++)
        value[i] = (float)(i + 1) / 32;
    memcpy(&material, value, sizeof material);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_material(&situation->state, &material, NULL));
}

void situation_start(struct situation *situation)
{
    struct state *state = &situation->state;
    situation->drawn = TRIPTYCH_TRIANGLE_LIST;
    state_initialize(state);
    state->width = 640;
    state->height = 480;
    state_set_viewport(state, &(struct triptych_viewport){10, 20, 600, 400, .25f, .75f}, NULL);
    state_set_scissor(state, (struct scissor){100, 50, 300, 200});
    state->target[0] = (struct target_channels){TARGET_8888, 15};
    for (unsigned i = 0; i < TRIPTYCH_CLIP_PLANES; i++)
        state_set_clip_plane(state, i, (float[]){1, (float)i, .5f, 2}, NULL);
    bind_attributes(situation);
    transform(situation);
    set_material(situation);
}
