#include "render/target/attachment.h"

#include "machine/cpu.h"
#include "machine/large.h"
#include "machine/mxcsr.h"

#include <immintrin.h>
#include <stdlib.h>

/* --- Memory --- */

const struct tile_order tile_order_alone = {TILE_PIXELS, 0, 0, BLOCK_PIXELS, 16 * BLOCK_PIXELS, 8};

_Static_assert(TILE_SIZE == 16 * BLOCK_SIZE, "a row of a tile has 16 blocks");

static struct tile_order order_of(uint32_t columns, uint32_t rows, uint32_t planes, bool quad_rows)
{
    struct tile_order order = tile_order_alone;
    const uint32_t row = columns * 2 * TILE_SIZE; /* words of a row of quads */
    if (quad_rows)
        return (struct tile_order){.plane = (size_t)columns * rows * TILE_PIXELS,
                                   .tile_column = 2 * TILE_SIZE,
                                   .tile_row = (size_t)row * (TILE_SIZE / 2),
                                   .block = 2 * BLOCK_SIZE,
                                   .block_row = 2 * row,
                                   .lower = row};
    order.tile_column = (size_t)planes * TILE_PIXELS;
    order.tile_row = columns * order.tile_column;
    return order;
}

static void copy_half(const uint32_t *from, uint32_t *to)
{
    const __m128i *source = (const __m128i *)from;
    __m128i *target = (__m128i *)to;
    _mm_store_si128(target, _mm_load_si128(source));
    _mm_store_si128(target + 1, _mm_load_si128(source + 1));
}

void tile_order_copy(const struct tile_order *from_order, const uint32_t *from,
                     const struct tile_order *to_order, uint32_t *to)
{
    for (uint32_t y = 0; y < TILE_SIZE; y += BLOCK_SIZE)
        for (uint32_t x = 0; x < TILE_SIZE; x += BLOCK_SIZE) {
            const uint32_t *source = from + tile_order_word(from_order, x, y);
            uint32_t *target = to + tile_order_word(to_order, x, y);
            copy_half(source, target);
            copy_half(source + from_order->lower, target + to_order->lower);
        }
}

/* A whole tile whose rows of blocks follow each other, by registers of 32 bytes. */
__attribute__((target("avx2"))) static void fill_wide(uint32_t *words, uint32_t value)
{
    const __m256i v = _mm256_set1_epi32((int)value);
    for (uint32_t i = 0; i < TILE_PIXELS; i += 16) {
        _mm256_store_si256((__m256i *)(void *)(words + i), v);
        _mm256_store_si256((__m256i *)(void *)(words + i + 8), v);
    }
}

void tile_order_fill(const struct tile_order *order, uint32_t *words, uint32_t value)
{
    if (order->block_row == tile_order_alone.block_row && cpu_has_avx2_fma()) {
        fill_wide(words, value);
        return;
    }
    __m128i v = _mm_set1_epi32((int)value);
    for (uint32_t y = 0; y < TILE_SIZE; y += BLOCK_SIZE)
        for (uint32_t x = 0; x < TILE_SIZE; x += BLOCK_SIZE)
            for (int half = 0; half < 2; half++) {
                uint32_t *eight = words + tile_order_word(order, x, y) + (half ? order->lower : 0);
                _mm_store_si128((__m128i *)eight, v);
                _mm_store_si128((__m128i *)(eight + 4), v);
            }
}

struct tile_memory *attachment_memory_create(uint32_t columns, uint32_t rows, uint32_t planes, bool quad_rows,
                                             struct error *error)
{
    size_t bytes = (size_t)columns * rows * planes * TILE_PLANE_BYTES;
    struct tile_memory *memory = malloc(sizeof *memory);
    if (memory)
        *memory = (struct tile_memory){.words = large_allocate(bytes),
                                       .columns = columns,
                                       .rows = rows,
                                       .planes = planes,
                                       .references = 1,
                                       .quad_rows = quad_rows,
                                       .order = order_of(columns, rows, planes, quad_rows)};
    if (memory && memory->words)
        return memory;
    free(memory);
    error_set(error, "out of memory for a target of %u x %u pixels (%zu MiB)", columns * TILE_SIZE,
              rows * TILE_SIZE, bytes >> 20);
    return NULL;
}

void attachment_memory_set_order(struct tile_memory *memory, bool quad_rows)
{
    struct tile_memory *other =
        memory && memory->quad_rows != quad_rows
            ? attachment_memory_create(memory->columns, memory->rows, memory->planes, quad_rows, NULL)
            : NULL;
    if (!other)
        return;
    for (uint32_t row = 0; row < memory->rows; row++)
        for (uint32_t column = 0; column < memory->columns; column++)
            for (uint32_t plane = 0; plane < memory->planes; plane++)
                tile_order_copy(&memory->order, tile_memory_words(memory, column, row, plane), &other->order,
                                tile_memory_words(other, column, row, plane));
    free(memory->words);
    memory->words = other->words;
    memory->order = other->order;
    memory->quad_rows = quad_rows;
    free(other);
}

struct tile_memory *attachment_memory_retain(struct tile_memory *memory)
{
    if (memory)
        memory->references++;
    return memory;
}

void attachment_memory_release(struct tile_memory *memory)
{
    if (!memory || --memory->references)
        return;
    free(memory->words);
    free(memory);
}

/* --- Attachments --- */

/* Not inlined: the compiler may move arithmetic over a change of MXCSR, but not a call. */
__attribute__((noinline)) static void clear_tiles(struct attachment *a)
{
    uint32_t tiles = a->columns * a->rows;
    struct color_clear color = {.pending = true};
    struct depth_clear depth = {.word = depth_encode(a->depth_format, 1), .pending = true};
    depth.range = (struct depth_range){depth.word, depth.word};
    if (a->format)
        color_encode(a->format, (const float[4]){0}, color.word);
    for (uint32_t i = 0; i < tiles && a->color_clear; i++)
        a->color_clear[i] = color;
    for (uint32_t i = 0; i < tiles && a->depth_clear; i++)
        a->depth_clear[i] = depth;
}

static struct attachment *create(struct attachment made, struct error *error)
{
    struct attachment *a = malloc(sizeof *a);
    made.references = 1;
    made.columns = (made.width + TILE_SIZE - 1) / TILE_SIZE;
    made.rows = (made.height + TILE_SIZE - 1) / TILE_SIZE;
    size_t tiles = (size_t)made.columns * made.rows;
    if (made.format)
        made.color_clear = calloc(tiles, sizeof *made.color_clear);
    else
        made.depth_clear = calloc(tiles, sizeof *made.depth_clear);
    if (!a || !(made.color_clear || made.depth_clear)) {
        free(made.color_clear);
        free(made.depth_clear);
        free(a);
        error_set(error, "out of memory for a target of %u x %u pixels", made.width, made.height);
        return NULL;
    }
    *a = made;
    unsigned saved = mxcsr_enter();
    clear_tiles(a);
    mxcsr_leave(saved);
    return a;
}

struct attachment *attachment_create_color(const struct format *format, uint32_t width, uint32_t height,
                                           uint32_t samples, struct error *error)
{
    return create((struct attachment){.format = format, .width = width, .height = height, .samples = samples},
                  error);
}

struct attachment *attachment_create_depth(enum triptych_depth_format format, uint32_t width, uint32_t height,
                                           uint32_t samples, struct error *error)
{
    return create(
        (struct attachment){.depth_format = format, .width = width, .height = height, .samples = samples},
        error);
}

struct attachment *attachment_retain(struct attachment *attachment)
{
    if (attachment)
        attachment->references++;
    return attachment;
}

void attachment_release(struct attachment *attachment)
{
    if (!attachment || --attachment->references)
        return;
    attachment_memory_release(attachment->memory);
    free(attachment->color_clear);
    free(attachment->depth_clear);
    free(attachment->stored);
    free(attachment);
}
