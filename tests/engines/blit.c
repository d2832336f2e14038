/* Blits: every engine's results are those of the definitions, which are computed a second time here. */
#include "engines/list.h"
#include "contract/lane.h"
#include "machine/code.h"
#include "machine/mxcsr.h"
#include "render/blit/blit.h"
#include <unity.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS = TILE_PIXELS };

static struct code_arena *arena;
static const struct engine *engine;
static struct routine *routine;
static struct error reason;
static uint32_t random_state = 1;
alignas(64) static uint32_t source[4 * SAMPLES_MAXIMUM * WORDS], result[WORDS], expected[WORDS];

void setUp(void)
{
    arena = code_create(4 << 20, NULL, &reason);
    routine = NULL;
}

static void drop(void)
{
    if (routine)
        engine->free(arena, routine);
    routine = NULL;
}

void tearDown(void)
{
    drop();
    code_destroy(arena);
}

static uint32_t random_word(void)
{
    random_state = random_state * 1664525 + 1013904223;
    return random_state ^ random_state >> 15;
}

static float random_number(void)
{
    return ((float)(random_word() % 20001) - 10000) / (float)(1 + random_word() % 5000);
}

static void build(struct blit_key blit)
{
    const union key key = {.blit = blit};
    drop();
    routine = engine_build(engine, arena, UNIT_BLIT, &key, &reason);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, reason.text);
}

/* Runs a check with every engine that runs where all engines do. */
static void with_engines(void (*check)(void))
{
    unsigned ran = 0;
    for (unsigned i = 0; (engine = engine_at(i)); i++)
        if (!engine->on_request && !engine_unavailable(engine)) {
            random_state = 1;
            check();
            drop();
            ran++;
        }
    TEST_ASSERT_GREATER_THAN_UINT(3, ran);
}

/* One number in 64 is an infinity or a NaN. */
static void fill_source(bool numbers)
{
    static const uint32_t special[] = {0x7f800000, 0xff800000, 0xffc12345, 0x7f800001};
    for (size_t i = 0; i < sizeof source / sizeof *source; i++) {
        source[i] = numbers ? bits_of_float(random_number()) : random_word();
        if (numbers && random_word() % 64 == 0)
            source[i] = special[random_word() % 4];
    }
}

/* The bits of a number that is stored. */
static uint32_t stored(float number)
{
    return isnan(number) ? 0x7fc00000 : bits_of_float(number);
}

/* --- Clears --- */

static uint32_t mask_of(int write_mask, uint32_t job_mask)
{
    uint32_t mask = 0;
    for (int byte = 0; byte < 4; byte++)
        mask |= write_mask >> byte & 1 ? 0xffu << 8 * byte : 0;
    return write_mask == BLIT_MASK_JOB ? job_mask : mask;
}

static void check_clear(void)
{
    for (int write_mask = 0; write_mask < BLIT_MASKS; write_mask++)
        for (uint8_t part = 0; part < 2; part++) {
            const struct blit_job job = {
                .word = random_word(), .mask = random_word(), .left = 3, .top = 4, .right = 20, .bottom = 9};
            uint32_t mask = mask_of(write_mask, job.mask);
            build(
                (struct blit_key){.operation = BLIT_CLEAR, .write_mask = (uint8_t)write_mask, .part = part});
            for (uint32_t i = 0; i < WORDS; i++) {
                uint32_t x = i % 32, y = i / 32 % 16;
                bool inside = !part || (x > 3 && x < 20 && y > 4 && y < 9);
                source[i] = x | y << 16;
                result[i] = random_word();
                expected[i] = inside ? (result[i] & ~mask) | (job.word & mask) : result[i];
            }
            blit_run(routine, &job, source, result, WORDS);
            TEST_ASSERT_EQUAL_HEX32_ARRAY(expected, result, WORDS);
        }
}

static void test_a_clear_sets_the_bits_of_its_mask_in_its_part(void)
{
    with_engines(check_clear);
}

/* --- Samples --- */

static uint32_t mean_of_bytes(uint32_t i, uint32_t samples, uint32_t distance)
{
    uint32_t word = 0;
    for (int c = 0; c < 4; c++) {
        uint32_t sum = 0;
        for (uint32_t s = 0; s < samples; s++)
            sum += source[s * distance + i] >> 8 * c & 255;
        word |= (sum + samples / 2) / samples << 8 * c;
    }
    return word;
}

static uint32_t mean_of_numbers(uint32_t i, uint32_t samples, uint32_t distance)
{
    float sum = 0;
    for (uint32_t s = 0; s < samples; s++)
        sum += bits_to_float(source[s * distance + i]);
    return stored(sum / (float)samples);
}

static void check_samples(struct blit_key key, uint32_t count)
{
    uint32_t samples = 1u << key.samples, words = key.numbers ? 4 * TILE_PIXELS : TILE_PIXELS;
    uint32_t distance = key.by_rows ? BLIT_ROW_WORDS : words;
    build(key);
    blit_run(routine, NULL, source, result, count);
    for (uint32_t i = 0; i < count; i++)
        TEST_ASSERT_EQUAL_HEX32(key.numbers ? mean_of_numbers(i, samples, distance)
                                            : mean_of_bytes(i, samples, distance),
                                result[i]);
}

static void check_resolve(void)
{
    for (uint8_t numbers = 0; numbers < 2; numbers++) {
        fill_source(numbers);
        for (uint8_t samples = 1; samples < SAMPLES_RADIX; samples++)
            for (uint8_t by_rows = 0; by_rows < 2; by_rows++)
                check_samples((struct blit_key){.operation = BLIT_RESOLVE,
                                                .numbers = numbers,
                                                .samples = samples,
                                                .by_rows = by_rows},
                              by_rows ? BLIT_ROW_WORDS : 1024);
    }
}

static void test_samples_are_averaged_to_nearest_and_numbers_in_order(void)
{
    with_engines(check_resolve);
}

/* --- Mip levels --- */

enum { ROW_TEXELS = 2100 };

/* The weights of an axis: of `taps` texels for texel i of n / 2. */
static uint32_t weight_of(unsigned taps, uint32_t half, uint32_t i, unsigned tap)
{
    const uint32_t three[] = {half - i, half, i + 1};
    return taps == 3 ? three[tap] : 1;
}

static uint32_t mean_of_texels(const struct blit_key *key, const struct blit_job *job, uint32_t i)
{
    uint32_t word = 0;
    for (int c = 0; c < 4; c++) {
        uint64_t sum = 0, total = (uint64_t)job->total;
        for (int row = 0; row < key->taps[1] * key->taps[2]; row++)
            for (unsigned tap = 0; tap < key->taps[0]; tap++)
                sum += (uint64_t)weight_of(key->taps[0], (uint32_t)job->half, i, tap) *
                       (uint64_t)job->row_weight[row] *
                       (((const uint32_t *)job->row[row])[2 * i + tap] >> 8 * c & 255);
        word |= (uint32_t)((2 * sum + total) / (2 * total)) << 8 * c;
    }
    return word;
}

/* Rows of random weights, as large as sizes allow. */
static void check_level(struct blit_key key)
{
    int rows = key.taps[1] * key.taps[2];
    bool even = key.taps[1] < 3 && key.taps[2] < 3;
    uint32_t count = 1008;
    uint32_t largest = key.taps[2] == 3 ? 1024 : 1 << 17;
    struct blit_job job = {.half = (int32_t)count, .total = 0};
    for (int row = 0; row < rows; row++) {
        job.row[row] = source + row * ROW_TEXELS;
        job.row_weight[row] = even ? 1 : (int32_t)(1 + random_word() % largest);
        job.total += job.row_weight[row];
    }
    job.total *= key.taps[0] == 3 ? 2 * job.half + 1 : key.taps[0];
    for (uint32_t i = 0; i < count; i++)
        source[9 * ROW_TEXELS + i] = i;
    build(key);
    blit_run(routine, &job, source + 9 * ROW_TEXELS, result, count);
    for (uint32_t i = 0; i < count; i++)
        TEST_ASSERT_EQUAL_HEX32(mean_of_texels(&key, &job, i), result[i]);
}

static void check_shrink(void)
{
    fill_source(false);
    for (int i = 0; i < ROW_TEXELS; i++)
        source[i] = source[3 * ROW_TEXELS + i] = i % 3 ? 0xffffffff : 0x00ff00fe;
    for (uint8_t x = 1; x <= 3; x++)
        for (uint8_t y = 1; y <= 3; y++)
            for (uint8_t z = 1; z <= 3; z++)
                check_level((struct blit_key){.operation = BLIT_SHRINK, .taps = {x, y, z}});
}

static void test_texels_of_mip_levels_are_exact_means_by_area(void)
{
    with_engines(check_shrink);
}

/* --- Scaled copies --- */

static float pair(float a, float b, float weight)
{
    return weight > 0 ? a * (1 - weight) + b * weight : a;
}

static float channel_of(bool numbers, uint32_t row, uint32_t pixel, int c)
{
    const uint32_t *words = source + row * ROW_TEXELS;
    return numbers ? bits_to_float(words[4 * pixel + (uint32_t)c])
                   : (float)(words[pixel] >> 8 * c & 255) / 255.0f;
}

static uint32_t byte_of(float value)
{
    float inside = value > 0 ? value < 1 ? value : 1 : 0;
    return (uint32_t)nearbyintf(inside * 255.0f);
}

static float blended(const struct blit_key *key, const struct blit_job *job, const uint32_t *index,
                     uint32_t i, int c)
{
    float row[2], weight = bits_to_float(index[2 * BLIT_BLEND_PIXELS + i]);
    for (uint32_t r = 0; r < 2; r++)
        row[r] = pair(channel_of(key->numbers, r, index[i], c),
                      channel_of(key->numbers, r, index[BLIT_BLEND_PIXELS + i], c), weight);
    return pair(row[0], row[1], job->weight);
}

static void check_row(struct blit_key key, float down)
{
    const struct blit_job job = {.row = {source, source + ROW_TEXELS}, .weight = down, .missing = 0xff000000};
    alignas(64) uint32_t index[3 * BLIT_BLEND_PIXELS];
    for (uint32_t i = 0; i < BLIT_BLEND_PIXELS; i++) {
        index[i] = random_word() % 500;
        index[BLIT_BLEND_PIXELS + i] = random_word() % 500;
        index[2 * BLIT_BLEND_PIXELS + i] = bits_of_float(i % 5 ? (float)(random_word() % 256) / 256 : 0);
    }
    build(key);
    blit_run(routine, &job, index, result, BLIT_BLEND_PIXELS);
    for (uint32_t i = 0; i < BLIT_BLEND_PIXELS; i++) {
        uint32_t word = job.missing;
        for (int c = 0; c < 4; c++) {
            float value = blended(&key, &job, index, i, c);
            word |= byte_of(value) << 8 * c;
            if (key.number_results)
                TEST_ASSERT_EQUAL_HEX32(stored(value), result[(uint32_t)c * BLIT_BLEND_PIXELS + i]);
        }
        if (!key.number_results)
            TEST_ASSERT_EQUAL_HEX32(word, result[i]);
    }
}

static void check_blend(void)
{
    for (uint8_t numbers = 0; numbers < 2; numbers++) {
        fill_source(numbers);
        for (uint8_t results = 0; results < 2; results++)
            for (int n = 0; n < 3; n++)
                check_row(
                    (struct blit_key){.operation = BLIT_BLEND, .numbers = numbers, .number_results = results},
                    n * 0.375f);
    }
}

static void test_scaled_copies_blend_in_binary32_and_round_as_draws_do(void)
{
    with_engines(check_blend);
}

/* --- Keys --- */

static void test_keys_of_blits_are_packed_and_printed(void)
{
    union key key = {.blit = {.operation = BLIT_SHRINK, .samples = 3, .write_mask = 16, .taps = {3, 2, 1}}},
              back;
    char text[KEY_TEXT_CAPACITY];
    const char *where;
    const struct packed_key packed = key_pack(UNIT_BLIT, &key);
    key_unpack(UNIT_BLIT, &packed, &back);
    TEST_ASSERT_EQUAL_MEMORY(&key.blit, &back.blit, sizeof key.blit);
    TEST_ASSERT_EQUAL_STRING("operation=2 samples=3 write_mask=16 taps=3,2,1",
                             key_print(UNIT_BLIT, &key, text));
    TEST_ASSERT_EQUAL_INT(0, key_parse(UNIT_BLIT, text, &back, &where));
    TEST_ASSERT_EQUAL_MEMORY(&key.blit, &back.blit, sizeof key.blit);
}

int main(void)
{
    unsigned saved = mxcsr_enter();
    UNITY_BEGIN();
    RUN_TEST(test_a_clear_sets_the_bits_of_its_mask_in_its_part);
    RUN_TEST(test_samples_are_averaged_to_nearest_and_numbers_in_order);
    RUN_TEST(test_texels_of_mip_levels_are_exact_means_by_area);
    RUN_TEST(test_scaled_copies_blend_in_binary32_and_round_as_draws_do);
    RUN_TEST(test_keys_of_blits_are_packed_and_printed);
    mxcsr_leave(saved);
    return UNITY_END();
}
