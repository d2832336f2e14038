/* Gathers read the addresses that they specify, in every engine: pointers anywhere in a job of 64 KiB, every
 * scale, elements of 16 bytes, positive and negative displacements, and elements before the start. */
#include "base/bits.h"
#include "machine/code.h"
#include "machine/cpu.h"
#include "emu/emulate/bind.h"
#include "tests/support/routine/stitched.h"

#include <string.h>
#include <unity.h>

enum {
    JOB_BYTES = 64 * 1024,
    TEXELS = 64, /* of 16 bytes, around the start */
    BYTES_A_TEXEL = 16,
    CHANNELS = BYTES_A_TEXEL / 4,
    LANES = LANES_MAXIMUM
};

static alignas(64) uint8_t job[JOB_BYTES];
static uint32_t table[TEXELS * CHANNELS];
static alignas(64) int32_t index_of[LANES];
static alignas(64) float output[SLOT_COUNT * VERTEX_CAPACITY];
static struct code_arena *arena;
static struct builder *builder;
static struct plan *plan;
static uint64_t seed;

/* One gather's addressing: element `texel` of 16 bytes is index * scale after the start. */
struct addressing {
    int field, scale, displacement;
};

/* Chooses texels before and after the start, which is the middle of the table. */
static void fill(const struct addressing *how)
{
    const uint32_t *start = table + TEXELS / 2 * CHANNELS;
    for (int i = 0; i < TEXELS * CHANNELS; i++)
        table[i] = program_random(&seed);
    memset(job, 0xa5, sizeof job);
    memcpy(job + how->field, &start, sizeof start);
    for (int lane = 0; lane < LANES; lane++) {
        int texel = (int)(program_random(&seed) % (TEXELS / 2)) - TEXELS / 4;
        index_of[lane] = texel * (BYTES_A_TEXEL / how->scale);
    }
}

static uint32_t wanted(const struct addressing *how, int lane, int channel)
{
    int bytes = index_of[lane] * how->scale + how->displacement + 4 * channel;
    return table[TEXELS / 2 * CHANNELS + bytes / 4];
}

static void check(const struct addressing *how, const char *engine)
{
    for (int lane = 0; lane < LANES; lane++)
        for (int channel = 0; channel < CHANNELS; channel++) {
            uint32_t got = bits_of_float(output[channel * VERTEX_CAPACITY + lane]);
            char text[128];
            snprintf(text, sizeof text, "%s: field %d, scale %d, displacement %d, lane %d, channel %d",
                     engine, how->field, how->scale, how->displacement, lane, channel);
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(wanted(how, lane, channel), got, text);
        }
    memset(output, 0, sizeof output);
}

static void emulate(const struct addressing *how)
{
    struct env e = {.base = {[BASE_JOB] = job}};
    for (int lane = 0; lane < LANES; lane += EMULATE_WIDTH)
        for (int channel = 0; channel < CHANNELS; channel++) {
            itg index;
            memcpy(&index, index_of + lane, sizeof index);
            itg word = gather_i(&e, BASE_JOB, how->field, index, how->scale, how->displacement + 4 * channel);
            memcpy(output + channel * VERTEX_CAPACITY + lane, &word, sizeof word);
        }
    check(how, "emulate");
}

/* Records the gathers of the four channels. If they follow each other, they are a row; with stores between
 * them they are not. */
static void record(struct ir *ir, const struct addressing *how, int rows)
{
    uint16_t word[CHANNELS];
    ir_start(ir);
    uint16_t index =
        ir_append(ir, (struct ir_instruction){.op = IR_load, .type = TYPE_itg, .base = BASE_INPUT});
    /* A sum instead of the loaded value itself, because gathers with such an index are made lane by lane. */
    uint16_t sum =
        ir_append(ir, (struct ir_instruction){.op = IR_add_i, .type = TYPE_itg, .operand = {index, index}});
    index = ir_append(ir, (struct ir_instruction){.op = IR_sub_i, .type = TYPE_itg, .operand = {sum, index}});
    for (int channel = 0; channel < CHANNELS; channel++) {
        word[channel] = ir_append(ir, (struct ir_instruction){.op = IR_gather,
                                                              .type = TYPE_itg,
                                                              .base = BASE_JOB,
                                                              .scale = (uint8_t)how->scale,
                                                              .operand = {index},
                                                              .k = how->displacement + 4 * channel,
                                                              .field = how->field});
        if (!rows || channel == CHANNELS - 1)
            for (int c = rows ? 0 : channel; c <= channel; c++)
                ir_append(ir, (struct ir_instruction){.op = IR_store,
                                                      .base = BASE_OUTPUT,
                                                      .operand = {word[c]},
                                                      .k = c * VERTEX_SLOT_BYTES});
    }
    TEST_ASSERT_NULL(ir_verify(ir));
}

static void run(const void *code)
{
    routine_function *function;
    memcpy(&function, &code, sizeof function);
    struct vertex_arguments call = {(const struct job *)(const void *)job, (const uint32_t *)index_of, output,
                                    LANES};
    function(&call, NULL);
}

static void specialize(const struct addressing *how, unsigned width, int rows)
{
    static const union key key;
    struct error error = {{0}};
    struct code_span span;
    record(&builder->ir, how, rows);
    allocate_registers(&builder->ir, &builder->allocation, &(struct register_file){0});
    builder->emitter.ir = &builder->ir;
    builder->emitter.allocation = &builder->allocation;
    builder->emitter.width = width;
    builder->emitter.length = width == 4 ? X86_128 : X86_256;
    size_t bytes = emit_routine(&builder->emitter, UNIT_VERTEX, &key, &error);
    TEST_ASSERT_NOT_EQUAL_MESSAGE(0, bytes, error.text);
    TEST_ASSERT_EQUAL_MESSAGE(0, code_reserve(arena, bytes, &span, &error), error.text);
    memcpy(span.writable, builder->emitter.code, bytes);
    run(code_commit(arena, &span, bytes));
    code_free(arena, &span);
    check(how, rows ? "specialize, by rows" : "specialize");
}

static void stitch(const struct addressing *how)
{
    struct error error = {{0}};
    struct code_span span;
    record(&builder->ir, how, 0);
    stitched_plan(plan, &builder->ir);
    TEST_ASSERT_EQUAL_MESSAGE(0, plan_join(plan, arena, &span, &error), error.text);
    run(span.executable);
    code_free(arena, &span);
    check(how, "stitch");
}

static void every_engine(const struct addressing *how)
{
    fill(how);
    emulate(how);
    if (!cpu_has_avx2_fma())
        return;
    for (int rows = 0; rows < 2; rows++) {
        specialize(how, 8, rows);
        specialize(how, 4, rows);
    }
    stitch(how);
}

static void pointers_anywhere_in_a_job(void)
{
    static const int fields[] = {0, 8, 120, 128, 4096, 32760, 32768, JOB_BYTES - 8};
    for (size_t f = 0; f < sizeof fields / sizeof *fields; f++)
        for (int scale = 1; scale <= 8; scale *= 2)
            every_engine(&(struct addressing){fields[f], scale, 0});
}

static void displacements_either_way(void)
{
    static const int displacements[] = {-256, -132, -128, -4, 4, 124, 128, 240};
    for (size_t d = 0; d < sizeof displacements / sizeof *displacements; d++)
        for (int scale = 1; scale <= 8; scale *= 2)
            every_engine(&(struct addressing){16, scale, displacements[d]});
}

void setUp(void)
{
    struct error error = {{0}};
    seed = 0x6a7e;
    arena = code_create(0, NULL, &error);
    builder = specialize_take(&error);
    plan = plan_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(plan, error.text);
}

void tearDown(void)
{
    plan_give(plan);
    specialize_give(builder);
    code_destroy(arena);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(pointers_anywhere_in_a_job);
    RUN_TEST(displacements_either_way);
    return UNITY_END();
}
