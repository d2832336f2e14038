#include "render/target/rectangle.h"

#include "base/bits.h"
#include "base/minmax.h"
#include "machine/cpu.h"
#include "render/target/pixels_tile.h"
#include "render/texture/convert.h"

#include <string.h>

enum { DEPTH_SHIFT = 8, TEXEL_BYTES_MAXIMUM = 16 };

bool pixels_is_memory_format(const struct format *format)
{
    return format->side == 1 && format->roles & (ROLE_TEXTURE | ROLE_TARGET) &&
           !(format->roles & ROLE_DEPTH) && format->number != TRIPTYCH_SURFACE_NULL;
}

/* Bytes of a word of depth and stencil. */
static size_t depth_bytes(enum triptych_depth_format format)
{
    return depth_formats[format].depth_bits <= 16 ? 2 : 4;
}

size_t pixels_memory_bytes(const struct pixels *pixels, const struct format *format)
{
    return format ? format->bytes : depth_bytes(pixels->depth_format);
}

/* --- Rows of colours --- */

/* Texels of compressed formats are words of bytes until they are compressed. */
bool pixels_are_plain_words(const struct format *format)
{
    return format->side > 1 ||
           (format->roles & ROLE_TARGET && format->target == TARGET_8888 && !format->compact);
}

uint32_t pixels_missing_bits(const struct format *format)
{
    return format->side == 1 && format->channel[3].type == CHANNEL_ONE ? 0xff000000 : 0;
}

/* The same as color_encode for 8 bits a channel. NaN is 0: MAXPS gives its second operand. */
static void encode_plain_words(const struct format *to, const float *numbers, uint32_t count,
                               uint32_t *result)
{
    const __m128 most = _mm_set1_ps(255), one = _mm_set1_ps(1), zero = _mm_setzero_ps();
    uint32_t missing = pixels_missing_bits(to);
    for (uint32_t i = 0; i < count; i++) {
        __m128 inside = _mm_min_ps(_mm_max_ps(_mm_loadu_ps(numbers + 4 * i), zero), one);
        __m128i words = _mm_cvtps_epi32(_mm_mul_ps(inside, most));
        words = _mm_packs_epi32(words, words);
        result[i] = (uint32_t)_mm_cvtsi128_si32(_mm_packus_epi16(words, words)) | missing;
    }
}

static void encode_numbers(const struct format *to, const float *numbers, uint32_t count, uint32_t *result)
{
    uint32_t planes = to->storage == STORAGE_RGBA8 ? 1 : 4;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t words[4];
        color_encode(to, numbers + 4 * i, words);
        memcpy(result + i * planes, words, planes * sizeof *words);
    }
}

/* To the values that a format of textures has. */
static void convert_by_format(const struct format *to, enum storage storage, const void *row, uint32_t count,
                              uint32_t *result)
{
    uint8_t data[TEXEL_BYTES_MAXIMUM * PIXELS_ROW];
    format_encode_row(to, storage, row, count, data);
    format_decode_row(to, data, count, result);
}

void pixels_convert_numbers(const struct format *to, const float *numbers, uint32_t count, uint32_t *result)
{
    if (to->side > 1)
        encode_numbers(format_find(TRIPTYCH_SURFACE_A8B8G8R8), numbers, count, result);
    else if (pixels_are_plain_words(to) && to->number != TRIPTYCH_SURFACE_NULL)
        encode_plain_words(to, numbers, count, result);
    else if (to->roles & ROLE_TARGET)
        encode_numbers(to, numbers, count, result);
    else
        convert_by_format(to, STORAGE_FLOAT4, numbers, count, result);
}

static void convert_bytes(const struct format *to, const uint32_t *row, uint32_t count, uint32_t *result)
{
    if (!pixels_are_plain_words(to)) {
        convert_by_format(to, STORAGE_RGBA8, row, count, result);
        return;
    }
    uint32_t missing = pixels_missing_bits(to);
    for (uint32_t i = 0; i < count; i++)
        result[i] = row[i] | missing;
}

void pixels_convert_row(const struct format *from, const struct format *to, const uint32_t *row,
                        uint32_t count, uint32_t *result)
{
    float numbers[4 * PIXELS_ROW];
    if (from == to) {
        memcpy(result, row, count * format_row_bytes(from));
    } else if (from->storage == STORAGE_RGBA8 && to->storage == STORAGE_RGBA8) {
        convert_bytes(to, row, count, result);
    } else if (from->storage == STORAGE_RGBA8) {
        format_numbers_of_bytes(row, count, numbers);
        pixels_convert_numbers(to, numbers, count, result);
    } else {
        memcpy(numbers, row, count * sizeof(float[4]));
        pixels_convert_numbers(to, numbers, count, result);
    }
}

/* --- Rows of depth --- */

void pixels_row_numbers(const struct pixels *pixels, const uint32_t *row, uint32_t count, float *numbers)
{
    if (pixels->format && pixels_storage(pixels) == STORAGE_RGBA8)
        format_numbers_of_bytes(row, count, numbers);
    else if (pixels->format)
        memcpy(numbers, row, count * sizeof(float[4]));
    for (uint32_t i = 0; i < 4 * count && !pixels->format; i++)
        numbers[i] = depth_decode(pixels->depth_format, row[i / 4]);
}

static void encode_depth(enum triptych_depth_format format, const uint32_t *row, uint32_t count,
                         uint8_t *data)
{
    unsigned stencil = depth_formats[format].stencil_bits;
    if (depth_bytes(format) == 4) {
        memcpy(data, row, count * sizeof *row);
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        uint16_t word = (uint16_t)(row[i] >> DEPTH_SHIFT << stencil | (row[i] & stencil_mask(format)));
        memcpy(data + 2 * i, &word, sizeof word);
    }
}

/* Words that no drawing writes become words that drawing can write. */
static void decode_depth(enum triptych_depth_format format, const uint8_t *data, uint32_t count,
                         uint32_t *row)
{
    unsigned stencil = depth_formats[format].stencil_bits;
    for (uint32_t i = 0; i < count; i++) {
        uint16_t word;
        if (depth_bytes(format) == 4) {
            memcpy(row + i, data + 4 * i, sizeof *row);
        } else {
            memcpy(&word, data + 2 * i, sizeof word);
            row[i] = (uint32_t)word >> stencil << DEPTH_SHIFT | (word & stencil_mask(format));
        }
        row[i] = depth_valid(format, row[i]);
    }
}

/* --- Parts --- */

static uint32_t tiles_across(uint32_t first, uint32_t size)
{
    return (first + size + TILE_SIZE - 1) / TILE_SIZE - first / TILE_SIZE;
}

uint32_t pixels_parts(const struct triptych_rectangle *rectangle)
{
    return tiles_across(rectangle->x, rectangle->width) * tiles_across(rectangle->y, rectangle->height);
}

/* The part of first .. first + size - 1 in its i-th tile. */
static void cut(uint32_t first, uint32_t size, uint32_t i, unsigned *from, unsigned *length)
{
    uint32_t start = (first / TILE_SIZE + i) * TILE_SIZE;
    *from = max_u32(first, start);
    *length = min_u32(first + size, start + TILE_SIZE) - *from;
}

struct triptych_rectangle pixels_part(const struct triptych_rectangle *rectangle, uint32_t i)
{
    struct triptych_rectangle part;
    uint32_t columns = tiles_across(rectangle->x, rectangle->width);
    cut(rectangle->x, rectangle->width, i % columns, &part.x, &part.width);
    cut(rectangle->y, rectangle->height, i / columns, &part.y, &part.height);
    return part;
}

static uint8_t *memory_of(const struct pixels_memory *memory, uint32_t x, uint32_t y)
{
    return memory->data + (ptrdiff_t)(y - memory->rectangle.y) * memory->pitch +
           (x - memory->rectangle.x) * pixels_memory_bytes(&memory->pixels, memory->format);
}

static void read_row(const struct pixels_memory *memory, const struct triptych_rectangle *part, uint32_t y,
                     uint8_t *data)
{
    const struct pixels *pixels = &memory->pixels;
    uint32_t row[4 * PIXELS_ROW];
    pixels_read_row(pixels, part->x, y, part->width, row);
    if (memory->format)
        format_encode_row(memory->format, pixels_storage(pixels), row, part->width, data);
    else
        encode_depth(pixels->depth_format, row, part->width, data);
}

/* --- Blocks to rows of words, with AVX2: what a window gets of a frame --- */

enum { PAIR = 2 * BLOCK_SIZE };

/* Where rows of blocks are written, and what becomes of their words. */
struct destination {
    uint8_t *data;
    ptrdiff_t pitch;
    struct format_words form;
};

/* A row of blocks. */
__attribute__((target("avx2"))) static void read_block_row(const struct tile_order *order,
                                                           const uint32_t *block, uint32_t columns,
                                                           const struct destination *to)
{
    const __m128i same = _mm_set_epi8(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    const __m128i exchanged = _mm_set_epi8(15, 12, 13, 14, 11, 8, 9, 10, 7, 4, 5, 6, 3, 0, 1, 2);
    const __m256i bytes = _mm256_broadcastsi128_si256(to->form.exchanged ? exchanged : same);
    const __m256i kept = _mm256_set1_epi32((int)to->form.kept);
    for (uint32_t x = 0; x < columns; x += PAIR, block += 2 * order->block) {
        const uint32_t *next = block + order->block;
        uint8_t *data = to->data + x * sizeof *block;
        __m256i row[BLOCK_SIZE];
        pixels_pair_rows(block, next, row, row + 1);
        pixels_pair_rows(block + order->lower, next + order->lower, row + 2, row + 3);
        for (uint32_t y = 0; y < BLOCK_SIZE; y++, data += to->pitch)
            _mm256_storeu_si256((__m256i *)(void *)data,
                                _mm256_and_si256(_mm256_shuffle_epi8(row[y], bytes), kept));
    }
}

/* Reads the first rows of a part of a tile that is not cleared, if memory has its words as they are stored.
 * Returns the number of these rows; `data` is the place of the first one. */
static uint32_t read_block_rows(const struct pixels_memory *memory, const struct triptych_rectangle *part,
                                uint8_t *data)
{
    const struct attachment *a = memory->pixels.tiles;
    struct destination to = {.pitch = memory->pitch};
    if (!a || !memory->format || attachment_planes(a) != 1 || !format_is_words(memory->format, &to.form) ||
        !cpu_has_avx2_fma() || part->x % BLOCK_SIZE || part->y % BLOCK_SIZE || part->width % PAIR)
        return 0;
    const struct tile_order *order = &a->memory->order;
    const uint32_t *words = pixels_tile_words(a, pixels_tile_of(a, part->x, part->y));
    const uint32_t rows = part->height & -(uint32_t)BLOCK_SIZE, x = part->x % TILE_SIZE;
    for (uint32_t y = 0; y < rows; y += BLOCK_SIZE) {
        to.data = data + (ptrdiff_t)y * memory->pitch;
        read_block_row(order, words + tile_order_word(order, x, part->y % TILE_SIZE + y), part->width, &to);
    }
    return rows;
}

/* --- Parts in memory --- */

/* The rows of a cleared tile are alike: one is converted. */
void pixels_read_part(const struct pixels_memory *memory, uint32_t i)
{
    const struct pixels *pixels = &memory->pixels;
    struct triptych_rectangle part = pixels_part(&memory->rectangle, i);
    uint8_t *first = memory_of(memory, part.x, part.y);
    size_t bytes = part.width * pixels_memory_bytes(pixels, memory->format);
    bool alike = pixels_are_cleared(pixels, part.x, part.y);
    uint32_t done = alike ? 0 : read_block_rows(memory, &part, first);
    for (uint32_t y = part.y + done; y < part.y + part.height; y++) {
        uint8_t *data = memory_of(memory, part.x, y);
        if (alike && y > part.y)
            memcpy(data, first, bytes);
        else
            read_row(memory, &part, y, data);
    }
}

void pixels_write_part(const struct pixels_memory *memory, uint32_t i)
{
    const struct pixels *pixels = &memory->pixels;
    struct triptych_rectangle part = pixels_part(&memory->rectangle, i);
    uint32_t row[4 * PIXELS_ROW], converted[4 * PIXELS_ROW];
    for (uint32_t y = part.y; y < part.y + part.height; y++) {
        const uint8_t *data = memory_of(memory, part.x, y);
        if (memory->format) {
            format_decode_row(memory->format, data, part.width, row);
            pixels_convert_row(memory->format, pixels->format, row, part.width, converted);
        } else {
            decode_depth(pixels->depth_format, data, part.width, converted);
        }
        pixels_write_row(pixels, part.x, y, part.width, converted);
    }
}
