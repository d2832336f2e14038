#include "tests/support/picture/canvas.h"

#include "engines/list.h"
#include "tests/support/system/tried.h"

#include <stdio.h>
#include <math.h>
#include <string.h>

triptych_device *device;
uint32_t image[SIZE * SIZE];
static uint64_t seed = 1;

void random_begin(void)
{
    seed = 1;
}

uint32_t random_word(void)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (uint32_t)(seed * 0x2545f4914f6cdd1dull >> 32);
}

double random_between(double low, double high)
{
    return low + (high - low) * random_word() / 4294967296.0;
}

double dyadic(double low, double high)
{
    return floor(random_between(low, high) * 1024) / 1024;
}

static uint32_t value_of(enum triptych_state_table table, unsigned row, const char *word)
{
    const struct triptych_state_row *state = triptych_state_at(table, row);
    uint32_t value = 0;
    TEST_ASSERT_NOT_NULL_MESSAGE(state, word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, triptych_value_number(state->kind, word, &value), word);
    return value;
}

void set(enum triptych_state state, const char *word)
{
    OK(triptych_set_state(device, state, value_of(TRIPTYCH_RENDER_STATES, state, word)));
}

void set_sampler(unsigned sampler, enum triptych_sampler_state state, const char *word)
{
    OK(triptych_set_sampler_state(device, sampler, state, value_of(TRIPTYCH_SAMPLER_STATES, state, word)));
}

void set_stage(unsigned stage, enum triptych_stage_state state, const char *word)
{
    OK(triptych_set_stage_state(device, stage, state, value_of(TRIPTYCH_STAGE_STATES, state, word)));
}

static void open_device(const char *engine)
{
    struct triptych_options options = {.engine = engine, .threads = 1};
    char reason[256] = "";
    random_begin();
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK,
                                  triptych_device_create(&options, &device, reason, sizeof reason), reason);
    OK(triptych_set_target(device, SIZE, SIZE));
    set(TRIPTYCH_STATE_LIGHTING, "false");
    set(TRIPTYCH_STATE_CULLMODE, "none");
    set(TRIPTYCH_STATE_ZENABLE, "false");
}

void on_every_engine(void (*test)(void))
{
    unsigned run = 0;
    for (unsigned i = 0; triptych_engine_name(i); i++) {
        if (!engine_is_tried(engine_at(i)))
            continue;
        open_device(triptych_engine_name(i));
        test();
        triptych_device_destroy(device);
        device = NULL;
        run++;
    }
    TEST_ASSERT_GREATER_THAN(0, run);
}

void close_canvas(void)
{
    triptych_device_destroy(device);
    device = NULL;
}

struct vertex {
    float x, y, z;
    float normal[3];
    uint32_t color; /* 0xAARRGGBB */
    float u, v;
};

static void bind_element(enum triptych_attribute attribute, enum triptych_format format,
                         triptych_buffer *buffer, size_t offset)
{
    struct triptych_element element = {format, buffer, offset, sizeof(struct vertex)};
    OK(triptych_set_element(device, attribute, &element));
}

float extent = 1;

void draw_square(float z, uint32_t color, const float normal[3], float u0, float v0, float u1, float v1)
{
    static const float up[3] = {0, 0, -1};
    struct vertex vertex[4] = {{-extent, extent, z, {0}, color, u0, v0},
                               {extent, extent, z, {0}, color, u1, v0},
                               {-extent, -extent, z, {0}, color, u0, v1},
                               {extent, -extent, z, {0}, color, u1, v1}};
    triptych_buffer *buffer;
    for (int i = 0; i < 4; i++)
        memcpy(vertex[i].normal, normal ? normal : up, sizeof up);
    OK(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    bind_element(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3, buffer, offsetof(struct vertex, x));
    bind_element(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3, buffer, offsetof(struct vertex, normal));
    bind_element(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR, buffer, offsetof(struct vertex, color));
    bind_element(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT2, buffer, offsetof(struct vertex, u));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
}

uint32_t image_word(uint32_t color)
{
    return (color & 0xff00ff00) | (color >> 16 & 255) | (color & 255) << 16;
}

unsigned channel(uint32_t word, int c)
{
    return word >> 8 * c & 255;
}

void clear_to(uint32_t word)
{
    float color[4];
    for (int c = 0; c < 4; c++)
        color[c] = (float)channel(word, c) / 255.0f;
    OK(triptych_clear(device, color, 1));
}

uint32_t texel[SIZE * SIZE];

void bind_random_texture(unsigned width, unsigned height)
{
    triptych_texture *texture;
    for (unsigned i = 0; i < width * height; i++)
        texel[i] = random_word();
    OK(triptych_texture_create(device, texel, width, height, &texture));
    OK(triptych_set_texture(device, 0, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
}

int pixel_stride(void)
{
    static int stride;
    stride = stride ? stride : (int)test_stride_of(7);
    return stride;
}

void expect_pixel(int x, int y, uint32_t expected, const char *what)
{
    char message[160];
    uint32_t got = image[y * SIZE + x];
    if (got == expected)
        return;
    snprintf(message, sizeof message, "%s: pixel (%d, %d): expected %08x, got %08x", what, x, y, expected,
             got);
    TEST_FAIL_MESSAGE(message);
}
