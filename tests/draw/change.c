/* What is derived of the state a part at a time is what is derived from scratch, byte by byte, whatever changes.
 *
 * In every situation of tests/support/situation.def every setter of the interface is called, states by the tables with
 * each of their values. After each call the device derives what the setter says may have changed, and then everything.
 * The other way around, a part that is left out must be missed in some situation: no setter names too many, and the
 * comparison sees each of them. */
#include "draw/device.h"

#include "emu/emulate.h"
#include "tests/support/programs.h"
#include "tests/support/situation.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

static const struct {
    const char *name, *description;
} situations[] = {
#define SITUATION(name, description) {name, description},
#define GATE(holds, means_nothing)
#include "tests/support/situation.def"
#undef SITUATION
#undef GATE
    {"skinned", "state lighting false state vertexblend 3weights state indexedvertexblendenable true"},
    {"in the window", "attribute positiont float4 state lighting false"},
    {"user clip planes", "state lighting false state clipplaneenable 5"},
    {"w-buffer", "state lighting false state zenable usew"},
};

enum { SITUATIONS = sizeof situations / sizeof *situations, VARIANTS = 8 };

static triptych_device *device;
static triptych_buffer *buffer[2];
static triptych_texture *texture[VARIANTS];
static triptych_shader *shader[SHADER_STAGES];
static triptych_query *query;
static enum triptych_primitive drawn;

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

/* --- Setters ------------------------------------------------------------------------------------------------ */

static void set_transform(unsigned which, unsigned variant)
{
    const float v = (float)variant;
    const float matrix[VARIANTS][4][4] = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}},
                                          {{2, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1}, {0, 0, -1, 0}},
                                          {{v, 0, 1, 0}, {0, v, 0, 0}, {1, 0, v, 0}, {v, 0, 0, 1}},
                                          {{0, v, 0, 0}, {v, 0, 0, 0}, {0, 0, v, 0}, {0, v, 0, 1}}};
    OK(triptych_set_transform(device, (enum triptych_transform)which, matrix[variant % 4]));
}

static void set_world(unsigned variant)
{
    set_transform(TRIPTYCH_TRANSFORM_WORLD, variant);
}

static void set_view(unsigned variant)
{
    set_transform(TRIPTYCH_TRANSFORM_VIEW, variant);
}

static void set_projection(unsigned variant)
{
    set_transform(TRIPTYCH_TRANSFORM_PROJECTION, variant);
}

static void set_texture_matrix(unsigned variant)
{
    set_transform(TRIPTYCH_TRANSFORM_TEXTURE0 + variant / 4, variant);
}

static void set_second_world(unsigned variant)
{
    set_transform(TRIPTYCH_TRANSFORM_WORLD1 + variant % 3, variant);
}

static void set_viewport(unsigned variant)
{
    const float v = (float)variant;
    const struct triptych_viewport viewport = {
        v, v, 50 - 2 * v, 40 - v, variant & 1 ? 0.25f : 0, variant & 2 ? 0.75f : 1};
    OK(triptych_set_viewport(device, &viewport));
}

static void set_scissor(unsigned variant)
{
    OK(triptych_set_scissor(device, variant, 2 * variant, 20, 30 - variant));
}

static void set_clip_plane(unsigned variant)
{
    OK(triptych_set_clip_plane(device, variant % TRIPTYCH_CLIP_PLANES, (float[]){1, 2, (float)variant, 4}));
}

static void set_convention(unsigned variant)
{
    OK(triptych_set_convention(device, variant % TRIPTYCH_CONVENTION_COUNT, variant / 4));
}

static void set_material(unsigned variant)
{
    struct triptych_material material = device->state.material;
    float *values = (float *)(void *)&material;
    values[3 * variant % (sizeof material / sizeof(float))] += 0.25f;
    OK(triptych_set_material(device, &material));
}

static void set_power(unsigned variant)
{
    struct triptych_material material = device->state.material;
    material.power = (float)variant / 2;
    OK(triptych_set_material(device, &material));
}

static void set_light(unsigned variant)
{
    struct triptych_light light = device->state.light[variant & 1 ? 3 : 0];
    light.type = (enum triptych_light_type)(variant % 3);
    light.falloff = (float)(variant / 4);
    light.phi = 1;
    light.theta = 0.5f;
    light.diffuse[0] += 0.125f;
    OK(triptych_set_light(device, variant & 1 ? 3 : 0, &light));
}

static void set_light_color(unsigned variant)
{
    unsigned i = variant & 1 ? 3 : 0;
    struct triptych_light light = device->state.light[i];
    light.diffuse[variant % 3] += 0.125f;
    light.direction[0] += 1;
    light.position[2] += 1;
    OK(triptych_set_light(device, i, &light));
}

static void enable_light(unsigned variant)
{
    OK(triptych_enable_light(device, variant / 2, variant & 1));
}

static void set_texture(unsigned variant)
{
    OK(triptych_set_texture(device, 0, texture[variant]));
}

static void set_other_texture(unsigned variant)
{
    OK(triptych_set_texture(device, variant & 1 ? 1 : TRIPTYCH_VERTEX_SAMPLER + 3, texture[variant / 2]));
}

static void set_element(unsigned variant)
{
    static const enum triptych_attribute attribute[] = {TRIPTYCH_POSITION, TRIPTYCH_NORMAL, TRIPTYCH_DIFFUSE,
                                                        TRIPTYCH_POSITIONT};
    const struct triptych_element element = {variant & 1 ? TRIPTYCH_FORMAT_FLOAT4 : TRIPTYCH_FORMAT_NONE,
                                             variant & 1 ? buffer[0] : NULL, 16, 32};
    OK(triptych_set_element(device, attribute[variant / 2], &element));
}

static void set_declaration(unsigned variant)
{
    const struct triptych_declaration_element elements[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {0, 12, TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 0},
        {1, 0, TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_USAGE_TEXCOORD, 0},
        {1, 8, TRIPTYCH_FORMAT_UBYTE4, TRIPTYCH_USAGE_BLENDINDICES, 0}};
    OK(triptych_set_declaration(device, elements, 1 + variant % 4));
    OK(triptych_set_stream(device, 0, buffer[0], 0, 16));
}

static void set_fvf(unsigned variant)
{
    OK(triptych_set_fvf(device, variant & 1 ? 0x042 : 0x112));
    OK(triptych_set_stream(device, 0, buffer[0], 0, 32));
}

static void set_stream(unsigned variant)
{
    OK(triptych_set_stream(device, variant / 4, variant & 1 ? buffer[variant & 2 ? 1 : 0] : NULL, 4 * variant,
                           16));
}

static void set_frequency(unsigned variant)
{
    if (variant & 1)
        OK(triptych_set_stream_frequency(device, 1, TRIPTYCH_FREQUENCY_INSTANCE, 1 + variant));
    else
        OK(triptych_set_stream_frequency(device, 0, TRIPTYCH_FREQUENCY_INDEXED, 1 + variant));
}

static void set_vertex_shader(unsigned variant)
{
    OK(triptych_set_vertex_shader(device, variant & 1 ? shader[STAGE_VERTEX] : NULL));
}

static void set_pixel_shader(unsigned variant)
{
    OK(triptych_set_pixel_shader(device, variant & 1 ? shader[STAGE_PIXEL] : NULL));
}

static void set_booleans(unsigned variant)
{
    const int32_t values[4] = {variant & 1, variant & 2, variant & 4, 1};
    OK(triptych_set_shader_booleans(device, variant & 1, 2, values, 4));
}

static void set_target(unsigned variant)
{
    const struct triptych_target_description description = {
        .width = 50 + variant,
        .height = 60,
        .depth_format = (enum triptych_depth_format)(variant % TRIPTYCH_DEPTH_COUNT),
        .samples = variant & 4 ? 4 : 1};
    OK(triptych_set_target_description(device, &description));
}

static void count_pixels(unsigned variant)
{
    OK(variant & 1 ? triptych_query_end(device, query) : triptych_query_begin(device, query));
}

static void destroy_buffer(unsigned variant)
{
    (void)variant;
    OK(triptych_buffer_destroy(device, buffer[1]));
    OK(triptych_buffer_create(device, "0123456789abcdef0123456789abcdef", 32, &buffer[1]));
    OK(triptych_set_stream(device, 1, buffer[1], 0, 8));
}

static const struct setter {
    const char *name;
    void (*set)(unsigned variant);
    unsigned never_needed; /* parts that matter for what none of the situations has */
} setters[] = {
    {"world", set_world, 0},
    {"view", set_view, 0},
    {"projection", set_projection, 0},
    {"texture matrix", set_texture_matrix, 0},
    {"world 1", set_second_world, 0},
    {"viewport", set_viewport, 0},
    {"scissor", set_scissor, 0},
    {"clip plane", set_clip_plane, 0},
    {"convention", set_convention, 0},
    {"material", set_material, 0},
    {"power", set_power, 0},
    {"light", set_light, 0},
    {"light's colour", set_light_color, 0},
    {"enable light", enable_light, 0},
    {"texture", set_texture, 0},
    {"other textures", set_other_texture, 0},
    {"element", set_element, 0},
    {"declaration", set_declaration, 0},
    {"fvf", set_fvf, 0},
    {"stream", set_stream, 0},
    {"frequency", set_frequency, 0},
    {"vertex shader", set_vertex_shader, 0},
    {"pixel shader", set_pixel_shader, 0},
    {"Boolean constants", set_booleans, 0},
    {"target", set_target, 0},
    {"query", count_pixels, 0},
    {"end of a buffer", destroy_buffer, 0},
};

enum { SETTERS = sizeof setters / sizeof *setters };

/* --- Devices in situations ---------------------------------------------------------------------------------- */

static void make_texture(unsigned i, enum triptych_texture_type type, enum triptych_surface_format format,
                         unsigned size, unsigned levels)
{
    const struct triptych_texture_description description = {
        type, format, size, size, type == TRIPTYCH_TEXTURE_VOLUME ? size : 1, levels};
    OK(triptych_texture_define(device, &description, &texture[i]));
}

static triptych_shader *make_shader(const char *text)
{
    triptych_shader *made;
    OK(triptych_shader_assemble(device, NULL, text, strlen(text), &made));
    return made;
}

void setUp(void)
{
    static const uint8_t bytes[64];
    TEST_ASSERT_EQUAL_INT(
        TRIPTYCH_OK, device_create(&engine_emulate, &(struct device_options){.threads = 1}, &device, NULL));
    OK(triptych_set_target(device, 60, 60));
    OK(triptych_buffer_create(device, bytes, 64, &buffer[0]));
    OK(triptych_buffer_create(device, bytes, 32, &buffer[1]));
    OK(triptych_query_create(device, TRIPTYCH_QUERY_OCCLUSION, &query));
    texture[0] = NULL;
    make_texture(1, TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 8, 1);
    make_texture(2, TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 16, 1);
    make_texture(3, TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 12, 1);
    make_texture(4, TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 8, 2);
    make_texture(5, TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_A8R8G8B8, 8, 1);
    make_texture(6, TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_A8R8G8B8, 8, 1);
    make_texture(7, TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_R32F, 8, 1);
    shader[STAGE_VERTEX] = make_shader("vs_2_0\ndcl_position v0\ndcl_texcoord v1\nmov oPos, v0\nif b3\n"
                                       "mov oT0, v1\nelse\nmov oT0, v0\nendif\nmov oD0, v0\n");
    shader[STAGE_PIXEL] =
        make_shader("ps_2_0\ndcl t0\ndcl_2d s0\ntexld r0, t0, s0\nmul r0, r0, c0\nmov oC0, r0\n");
}

void tearDown(void)
{
    triptych_device_destroy(device);
    device = NULL;
}

/* The device's state becomes the situation's; false if that is not supported. */
static bool enter(const char *description)
{
    static struct situation situation;
    situation_start(&situation);
    if (situation_add(&situation, description))
        return false;
    for (int stage = 0; stage < SHADER_STAGES; stage++)
        situation.state.registers[stage] = &device->registers[stage];
    device->state = situation.state;
    drawn = situation.drawn;
    device_state_changed(device, PARTS_ALL);
    OK(device_derive(device, drawn, &device->error));
    return true;
}

/* --- Comparing ---------------------------------------------------------------------------------------------- */

struct derived {
    union key key[UNIT_COUNT];
    struct job job;
    struct draw draw;
    uint64_t vertices;
    struct palette_entry palette[WORLD_MATRICES];
};

static void take(struct derived *derived)
{
    memset(derived, 0, sizeof *derived);
    memcpy(derived->key, device->key, sizeof derived->key);
    memcpy(&derived->job, &device->job, sizeof derived->job);
    memcpy(&derived->draw, &device->draw, sizeof derived->draw);
    derived->vertices = device->vertices;
    if (device->job.palette)
        memcpy(derived->palette, device->job.palette, sizeof derived->palette);
    derived->job.palette = NULL;
}

/* Palettes pile up while nothing is rendered. */
static void derive(struct derived *derived)
{
    OK(device_derive(device, drawn, &device->error));
    take(derived);
    triptych_finish(device);
}

static const char *print(const char *situation, const char *setter, unsigned value)
{
    static char text[256];
    snprintf(text, sizeof text, "%s: %s %u", situation, setter, value);
    return text;
}

/* Derives a part at a time, without each of the parts, and from scratch. What was missed is added to `needed`. */
static void compare(const char *what, unsigned *named, unsigned *needed)
{
    static struct derived by_parts, whole, before;
    unsigned stale = device->stale;
    take(&before);
    derive(&by_parts);
    device_state_changed(device, PARTS_ALL);
    derive(&whole);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&whole, &by_parts, sizeof whole, what);
    if (!named || stale & PARTS(KEYS))
        return;
    *named |= stale;
    for (unsigned part = 0; part < DERIVED_PARTS; part++) {
        if (!(stale >> part & 1))
            continue;
        memcpy(&device->job, &before.job, sizeof device->job);
        memcpy(&device->draw, &before.draw, sizeof device->draw);
        device->vertices = before.vertices;
        device->stale = stale & ~(1u << part);
        take(&by_parts);
        memcpy(by_parts.palette, before.palette, sizeof before.palette);
        if (device->stale) {
            OK(device_derive(device, drawn, &device->error));
            if (part != PART_PALETTE)
                take(&by_parts);
        }
        *needed |= (unsigned)(memcmp(&by_parts, &whole, sizeof whole) != 0) << part;
    }
    device_state_changed(device, PARTS_ALL);
    derive(&whole);
}

/* --- Tests -------------------------------------------------------------------------------------------------- */

static void report_unneeded(const char *setter, unsigned named, unsigned needed)
{
    static const char *const part_name[DERIVED_PARTS] = {
#define JOB_PART(name, keys, first, last, meaning) #name,
#include "def/job_part.def"
#undef JOB_PART
        "SETTING", "VERTICES", "KEYS"};
    for (unsigned part = 0; part < DERIVED_PARTS; part++)
        if (named >> part & ~needed >> part & 1) {
            char text[128];
            snprintf(text, sizeof text, "%s: %s is never missed", setter, part_name[part]);
            TEST_FAIL_MESSAGE(text);
        }
}

static void every_setter_in_every_situation(void)
{
    static unsigned named[SETTERS], needed[SETTERS];
    for (unsigned s = 0; s < SITUATIONS; s++)
        for (unsigned i = 0; i < SETTERS; i++) {
            if (!enter(situations[s].description))
                continue;
            for (unsigned variant = 0; variant < VARIANTS; variant++) {
                setters[i].set(variant);
                compare(print(situations[s].name, setters[i].name, variant), &named[i], &needed[i]);
            }
        }
    for (unsigned i = 0; i < SETTERS; i++)
        report_unneeded(setters[i].name, named[i], needed[i]);
}

/* The values that are tried: all words, or numbers of all sizes of which those in the range are taken. */
static bool candidate(const struct triptych_kind *kind, unsigned i, uint32_t *value)
{
    static const uint32_t numbers[] = {0, 1, 2, 3, 5, 8, 15, 128, 255, 0x12345678, 0x80ff4020, 0xffffffff};
    static const float reals[] = {0, .25f, 1, 3, -1, 40};
    const struct triptych_value *word = triptych_value_at(kind, i);
    if (kind->notation == TRIPTYCH_NOTATION_WORDS) {
        *value = word ? word->number : 0;
        return word;
    }
    if (kind->notation == TRIPTYCH_NOTATION_REAL) {
        *value = i < sizeof reals / sizeof *reals ? triptych_float_bits(reals[i]) : 0;
        return i < sizeof reals / sizeof *reals;
    }
    *value = i < sizeof numbers / sizeof *numbers ? numbers[i] : 0;
    return i < sizeof numbers / sizeof *numbers;
}

static enum triptych_result set_value(enum triptych_state_table table, unsigned i, unsigned row,
                                      uint32_t value)
{
    return table == TRIPTYCH_SAMPLER_STATES ? triptych_set_sampler_state(device, i, row, value)
           : table == TRIPTYCH_STAGE_STATES ? triptych_set_stage_state(device, i, row, value)
                                            : triptych_set_state(device, row, value);
}

/* Sets a place to each of its values and back. */
static void try_values(const char *situation, enum triptych_state_table table, unsigned i, unsigned row,
                       unsigned *named, unsigned *needed)
{
    const struct triptych_state_row *state = triptych_state_at(table, row);
    uint32_t before = table == TRIPTYCH_SAMPLER_STATES ? device->state.sampler[i][row]
                      : table == TRIPTYCH_STAGE_STATES ? device->state.stage[i][row]
                                                       : device->state.value[row],
             value;
    for (unsigned v = 0; candidate(state->kind, v, &value); v++)
        if (set_value(table, i, row, value) == TRIPTYCH_OK)
            compare(print(situation, state->name, value), named, needed);
    OK(set_value(table, i, row, before));
    compare(print(situation, state->name, before), named, needed);
}

static void every_state_in_every_situation(void)
{
    enum { ROWS = 256 };
    static unsigned named[TRIPTYCH_STATE_TABLE_COUNT][ROWS], needed[TRIPTYCH_STATE_TABLE_COUNT][ROWS];
    for (unsigned s = 0; s < SITUATIONS; s++) {
        if (!enter(situations[s].description))
            continue;
        for (unsigned table = 0; table < TRIPTYCH_STATE_TABLE_COUNT; table++) {
            unsigned last = triptych_table_size(table) - 1, at[] = {0, 1, last};
            for (unsigned p = 0; p < (last ? 3 : 1); p++)
                for (unsigned row = 0; triptych_state_at(table, row); row++)
                    try_values(situations[s].name, table, at[p], row, &named[table][row],
                               &needed[table][row]);
        }
    }
    for (unsigned table = 0; table < TRIPTYCH_STATE_TABLE_COUNT; table++)
        for (unsigned row = 0; triptych_state_at(table, row); row++)
            report_unneeded(triptych_state_at(table, row)->name, named[table][row], needed[table][row]);
}

/* States whose rules are narrow are those that the tables say are in no key. */
static void what_leaves_keys_alone_is_in_no_key(void)
{
    for (unsigned table = 0; table < TRIPTYCH_STATE_TABLE_COUNT; table++)
        for (unsigned row = 0; triptych_state_at(table, row); row++)
            if (!(change_of_value(table, row) & PARTS(KEYS)))
                TEST_ASSERT_EQUAL_STRING_MESSAGE("job", triptych_state_at(table, row)->units,
                                                 triptych_state_at(table, row)->name);
}

static uint32_t random_below(uint64_t *seed, uint32_t limit)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((*seed >> 32) * limit >> 32);
}

static void change_at_random(uint64_t *seed)
{
    uint32_t value;
    if (!random_below(seed, 3)) {
        unsigned i = random_below(seed, SETTERS);
        if (setters[i].set != count_pixels)
            setters[i].set(random_below(seed, VARIANTS));
        return;
    }
    unsigned table = random_below(seed, TRIPTYCH_STATE_TABLE_COUNT), rows = 0;
    while (triptych_state_at(table, rows))
        rows++;
    unsigned row = random_below(seed, rows);
    if (candidate(triptych_state_at(table, row)->kind, random_below(seed, 8), &value))
        set_value(table, random_below(seed, triptych_table_size(table)) % 4, row, value);
}

/* Several changes between two draws, of one thing more than once. */
static void random_changes(void)
{
    uint64_t seed = 20;
    for (unsigned s = 0; s < SITUATIONS; s++) {
        if (!enter(situations[s].description))
            continue;
        for (unsigned step = 0; step < 400; step++) {
            for (unsigned n = 1 + random_below(&seed, 5); n--;)
                change_at_random(&seed);
            drawn = (enum triptych_primitive)random_below(&seed, TRIPTYCH_PRIMITIVE_COUNT);
            compare(print(situations[s].name, "step", step), NULL, NULL);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(what_leaves_keys_alone_is_in_no_key);
    RUN_TEST(every_setter_in_every_situation);
    RUN_TEST(every_state_in_every_situation);
    RUN_TEST(random_changes);
    return UNITY_END();
}
