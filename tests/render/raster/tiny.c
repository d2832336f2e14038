/* The kernel for tiny triangles is called through the checked trampoline. It keeps the calling convention,
 * and its results are those of a plain call. tests/render/raster/raster.c checks the results. */
#include "machine/cpu.h"
#include "render/raster/raster.h"
#include "tests/support/differential/trampoline.h"
#include "tests/support/system/seed.h"

#include <string.h>
#include <unity.h>

enum { ROUNDS = 2000, TRIANGLES = 40, SPARE = 4, RECORD = 64, EXTENT = 9 * 256, MXCSR = 0x7f80 };

static uint64_t seed;
static struct raster_site site;
static _Alignas(64) uint8_t records[TRIANGLES * RECORD];
static uint32_t offset[TRIANGLES];

void setUp(void)
{
    const struct rectangle target = {0, 0, TILE_SIZE, TILE_SIZE};
    seed = test_seed();
    raster_enter(&site, &target, 0, 0);
}

void tearDown(void)
{
}

static uint32_t random_below(uint32_t limit)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (uint32_t)(seed * 0x2545f4914f6cdd1dull >> 32) % limit;
}

/* Corners within a few pixels, in the tile or across its border; some triangles are too large for the
 * kernel. */
static void make_triangle(struct triangle_head *head)
{
    const uint32_t extent = random_below(16) ? EXTENT : 4 * EXTENT;
    const int32_t x = (int32_t)random_below(TILE_SIZE * 256), y = (int32_t)random_below(TILE_SIZE * 256);
    memset(head, 0, sizeof *head);
    head->visible = random_below(8) ? -1 : 0;
    for (int i = 0; i < 3; i++) {
        head->x[i] = x + (int32_t)random_below(extent) - (int32_t)extent / 2;
        head->y[i] = y + (int32_t)random_below(extent) - (int32_t)extent / 2;
    }
    const int64_t area = (int64_t)(head->x[1] - head->x[0]) * (head->y[2] - head->y[0]) -
                         (int64_t)(head->x[2] - head->x[0]) * (head->y[1] - head->y[0]);
    if (area < 0) {
        const int32_t x1 = head->x[1], y1 = head->y[1];
        head->x[1] = head->x[2];
        head->y[1] = head->y[2];
        head->x[2] = x1;
        head->y[2] = y1;
    }
}

static void make_triangles(void)
{
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        offset[i] = i * RECORD;
        make_triangle((struct triangle_head *)(void *)(records + offset[i]));
    }
}

static uint32_t round_done(void)
{
    static struct entry plain[PIXEL_ENTRIES + SPARE + 1], checked[PIXEL_ENTRIES + SPARE + 1];
    const uint32_t count = 1 + random_below(TRIANGLES), room = random_below(PIXEL_ENTRIES - TILE_BLOCKS);
    uint64_t result[2];
    memset(plain, 0x5a, sizeof plain);
    memset(checked, 0x5a, sizeof checked);
    struct raster_progress progress = raster_tiny_avx512(&site, records, offset, count, plain, plain + room);
    const uint64_t argument[TRAMPOLINE_ARGUMENTS] = {(uintptr_t)&site,   (uintptr_t)records,
                                                     (uintptr_t)offset,  count,
                                                     (uintptr_t)checked, (uintptr_t)(checked + room)};
    const char *found =
        trampoline_call_with((const void *)(uintptr_t)raster_tiny_avx512, argument, MXCSR, &seed, result);
    TEST_ASSERT_NULL_MESSAGE(found, found);
    TEST_ASSERT_EQUAL_UINT64((uintptr_t)progress.next - (uintptr_t)plain, result[0] - (uintptr_t)checked);
    TEST_ASSERT_EQUAL_UINT64(progress.left, result[1]);
    TEST_ASSERT_EQUAL_MEMORY(plain, checked, sizeof plain);
    const struct entry *end = progress.next + SPARE;
    for (const uint8_t *byte = (const uint8_t *)end; byte < (const uint8_t *)(end + 1); byte++)
        TEST_ASSERT_EQUAL_HEX8(0x5a, *byte);
    return count - (uint32_t)progress.left;
}

static void the_kernel_is_chosen_where_the_processor_has_avx512(void)
{
    const bool *has = cpu_native()->has;
    TEST_ASSERT_EQUAL(has[CPU_avx512f] && has[CPU_avx512dq] && has[CPU_avx512bw] && has[CPU_avx512vl],
                      site.kernel);
}

static void the_kernel_keeps_the_calling_convention(void)
{
    uint32_t done = 0;
    if (!site.kernel)
        TEST_IGNORE_MESSAGE("the kernel needs AVX-512");
    for (unsigned i = 0; i < ROUNDS; i++) {
        make_triangles();
        done += round_done();
    }
    TEST_ASSERT_GREATER_THAN_UINT32(ROUNDS, done);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_kernel_is_chosen_where_the_processor_has_avx512);
    RUN_TEST(the_kernel_keeps_the_calling_convention);
    return UNITY_END();
}
