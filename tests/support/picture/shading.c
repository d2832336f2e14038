#include "tests/support/picture/shading.h"

#include "base/bits.h"
#include "tests/support/picture/canvas.h"

#include "machine/code.h"
#include "render/derive/derive_part.h"
#include "engines/list.h"

#include <string.h>

struct state shading_state;
alignas(64) float shaded[SLOT_COUNT * VERTEX_CAPACITY];
union key shading_key[UNIT_COUNT];
struct job shading_job;
uint8_t shading_varying[VARYING_COUNT];
const struct palette_entry *shading_palette;
enum primitive shading_primitive;

static const struct engine *engine;
static struct code_arena *arena;
static struct triptych_buffer buffers[TRIPTYCH_ATTRIBUTE_COUNT];

void shading_set(enum triptych_state_table table, unsigned i, unsigned row, const char *word)
{
    uint32_t value;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, triptych_value_number(triptych_state_at(table, row)->kind, word, &value),
                                  word);
    shading_number(table, i, row, value);
}

void shading_number(enum triptych_state_table table, unsigned i, unsigned row, uint32_t value)
{
    struct error error = {{0}};
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, state_set_value(&shading_state, table, i, row, value, &error),
                                  error.text);
}

void shading_bind(enum triptych_attribute attribute, enum triptych_format format, const void *data,
                  size_t stride)
{
    struct error error = {{0}};
    struct triptych_element element = {format, &buffers[attribute], 0, stride};
    buffers[attribute].data = (uint8_t *)(uintptr_t)data;
    buffers[attribute].bytes = SIZE_MAX / 2;
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, state_set_element(&shading_state, attribute, &element, &error),
                                  error.text);
}

void shade(uint32_t count)
{
    alignas(64) uint32_t index[VERTEX_CAPACITY];
    struct error error = {{0}};
    uint32_t padded = (count + LANES_MAXIMUM - 1) / LANES_MAXIMUM * LANES_MAXIMUM;
    for (uint32_t i = 0; i < padded; i++)
        index[i] = i < count ? i : count - 1;
    derive_keys(&shading_state, shading_primitive, shading_key);
    struct pixel_key *pixel = &shading_key[UNIT_PIXEL].pixel;
    for (int v = 0; v < VARYING_COUNT; v++)
        if (shading_varying[v])
            pixel->varying[v] = shading_varying[v];
    if (shading_varying[VARYING_fog])
        pixel->fog = FOG_VARYING;
    memset(&shading_key[UNIT_VERTEX], 0, sizeof shading_key[UNIT_VERTEX]);
    struct setup_key *setup = &shading_key[UNIT_SETUP].setup;
    memcpy(setup->varying, pixel->varying, sizeof setup->varying);
    derive_vertex(&shading_state, pixel, setup, &shading_key[UNIT_VERTEX].vertex);
    derive_job(&shading_state, &shading_key[UNIT_VERTEX].vertex, &shading_key[UNIT_PIXEL].pixel,
               &shading_job);
    shading_job.palette = shading_palette;
    struct routine *routine = engine_build(engine, arena, UNIT_VERTEX, &shading_key[UNIT_VERTEX], &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    struct vertex_arguments call = {&shading_job, index, shaded, padded};
    memset(shaded, 0, sizeof shaded);
    routine->run(&call, routine);
    engine->free(arena, routine);
}

void shading_close(void)
{
    code_destroy(arena);
    arena = NULL;
}

void shading_on_every_engine(void (*test)(void))
{
    unsigned run = 0;
    for (unsigned i = 0; engine_at(i); i++) {
        struct error error = {{0}};
        engine = engine_at(i);
        if (engine_unavailable(engine) || engine->on_request)
            continue;
        arena = engine->without_arena ? NULL : code_create(1 << 22, NULL, &error);
        shading_palette = NULL;
        shading_primitive = PRIMITIVE_TRIANGLE;
        random_begin();
        state_initialize(&shading_state);
        memset(shading_varying, 0, sizeof shading_varying);
        struct triptych_viewport viewport = {0, 0, 64, 64, 0, 1};
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_viewport(&shading_state, &viewport, &error));
        test();
        shading_close();
        run++;
    }
    TEST_ASSERT_GREATER_THAN(0, run);
}
