/* Moves within an attachment: each pixel is read before it is written, because rows and columns are taken
 * in the direction of the move.
 *
 * If columns keep their place in blocks, a pair of rows moves a half of a block at a time: eight words,
 * which follow each other (struct tile_order). Two rows that are the lower one of a half and the upper one
 * of the next half become a half. All else moves in rows. */
#include "base/minmax.h"
#include "render/target/pixels_tile.h"

#include <emmintrin.h>

/* The source of the target's pixel (x, y) is (x + right, y + down). */
struct move {
    const struct pixels *pixels;
    uint32_t x0, y0, x1, y1; /* the target's part */
    int32_t right, down;
};

static uint32_t source_of(uint32_t place, int32_t distance)
{
    return (uint32_t)((int32_t)place + distance);
}

/* Pixels of one row and one column of tiles of the target, whose source may be in two. */
static void move_piece(const struct move *move, uint32_t x, uint32_t y, uint32_t count)
{
    uint32_t row[4 * PIXELS_ROW], words = pixels_words(move->pixels);
    uint32_t from = source_of(x, move->right), row_from = source_of(y, move->down);
    uint32_t first = min_u32(count, TILE_SIZE - from % TILE_SIZE);
    pixels_read_row(move->pixels, from, row_from, first, row);
    if (first < count)
        pixels_read_row(move->pixels, from + first, row_from, count - first, row + first * words);
    pixels_write_row(move->pixels, x, y, count, row);
}

static void move_row(const struct move *move, uint32_t y)
{
    if (move->right >= 0) {
        for (uint32_t x = move->x0, end; x < move->x1; x = end) {
            end = min_u32(move->x1, (x / TILE_SIZE + 1) * TILE_SIZE);
            move_piece(move, x, y, end - x);
        }
        return;
    }
    for (uint32_t end = move->x1, x; end > move->x0; end = x) {
        x = max_u32(move->x0, (end - 1) / TILE_SIZE * TILE_SIZE);
        move_piece(move, x, y, end - x);
    }
}

/* --- Halves of blocks --- */

/* Halves of neighbouring blocks in a plane of a tile. */
struct halves {
    uint32_t *words;    /* of the first one to be moved */
    ptrdiff_t distance; /* to the next one; 0 if all have the value of a clear */
    uint32_t clear[2 * BLOCK_SIZE];
};

static void find_halves(const struct attachment *a, uint32_t x, uint32_t y, uint32_t plane, ptrdiff_t step,
                        struct halves *halves)
{
    uint32_t tile = pixels_tile_of(a, x, y);
    const uint32_t *pending = pixels_pending_words(a, tile);
    halves->distance = pending ? 0 : step;
    halves->words = pending ? halves->clear
                            : pixels_tile_words(a, tile) + plane * a->memory->order.plane +
                                  tile_order_word(&a->memory->order, x % TILE_SIZE, y % TILE_SIZE);
    for (int i = 0; pending && i < 2 * BLOCK_SIZE; i++)
        halves->clear[i] = pending[plane];
}

static void copy_halves(const struct halves *from, uint32_t count, uint32_t *to, ptrdiff_t step)
{
    const uint32_t *word = from->words;
    for (uint32_t i = 0; i < count; i++, word += from->distance, to += step) {
        __m128i left = _mm_load_si128((const __m128i *)(const void *)word);
        __m128i right = _mm_load_si128((const __m128i *)(const void *)(word + BLOCK_SIZE));
        _mm_store_si128((__m128i *)(void *)to, left);
        _mm_store_si128((__m128i *)(void *)(to + BLOCK_SIZE), right);
    }
}

/* The second row of the quads of `upper`, and the first row of those of `lower`. */
static __m128i between(const uint32_t *upper, const uint32_t *lower)
{
    __m128d a = _mm_load_pd((const double *)(const void *)upper);
    __m128d b = _mm_load_pd((const double *)(const void *)lower);
    return _mm_castpd_si128(_mm_shuffle_pd(a, b, 1));
}

static void join_halves(const struct halves *upper, const struct halves *lower, uint32_t count, uint32_t *to,
                        ptrdiff_t step)
{
    const uint32_t *a = upper->words, *b = lower->words;
    for (uint32_t i = 0; i < count; i++, a += upper->distance, b += lower->distance, to += step) {
        __m128i left = between(a, b), right = between(a + BLOCK_SIZE, b + BLOCK_SIZE);
        _mm_store_si128((__m128i *)(void *)to, left);
        _mm_store_si128((__m128i *)(void *)(to + BLOCK_SIZE), right);
    }
}

/* `count` blocks in a row of a tile, from the one at x on, to the right if step is positive. */
static void move_halves(const struct move *move, uint32_t x, uint32_t y, uint32_t count, ptrdiff_t step)
{
    const struct attachment *a = move->pixels->tiles;
    uint32_t *tile = pixels_open_tile(a, pixels_tile_of(a, x, y));
    uint32_t from = source_of(x, move->right), row = source_of(y, move->down);
    size_t place = tile_order_word(&a->memory->order, x % TILE_SIZE, y % TILE_SIZE);
    struct halves upper, lower;
    for (uint32_t p = 0; p < attachment_planes(a); p++) {
        uint32_t *to = tile + p * a->memory->order.plane + place;
        find_halves(a, from, row & ~1u, p, step, &upper);
        if (!(row & 1)) {
            copy_halves(&upper, count, to, step);
            continue;
        }
        find_halves(a, from, row + 1, p, step, &lower);
        join_halves(&upper, &lower, count, to, step);
    }
}

/* The rows y and y + 1; y is even. */
static void move_rows(const struct move *move, uint32_t y)
{
    ptrdiff_t block = move->pixels->tiles->memory->order.block;
    if (move->right >= 0) {
        for (uint32_t x = move->x0, count; x < move->x1; x += count) {
            uint32_t from = source_of(x, move->right);
            count = min_u32(move->x1 - x, TILE_SIZE - max_u32(x % TILE_SIZE, from % TILE_SIZE));
            move_halves(move, x, y, count / BLOCK_SIZE, block);
        }
        return;
    }
    for (uint32_t end = move->x1, count; end > move->x0; end -= count) {
        uint32_t last = end - BLOCK_SIZE, from = source_of(last, move->right);
        count = min_u32(end - move->x0, min_u32(last % TILE_SIZE, from % TILE_SIZE) + BLOCK_SIZE);
        move_halves(move, last, y, count / BLOCK_SIZE, -block);
    }
}

/* --- The order of rows --- */

static bool keeps_blocks(const struct move *move)
{
    return !((move->x0 | move->x1 | (uint32_t)move->right) % BLOCK_SIZE);
}

static void move_up(const struct move *move, uint32_t first, uint32_t last)
{
    for (uint32_t y = move->y0; y < first; y++)
        move_row(move, y);
    for (uint32_t y = first; y < last; y += 2)
        move_rows(move, y);
    for (uint32_t y = last; y < move->y1; y++)
        move_row(move, y);
}

static void move_down(const struct move *move, uint32_t first, uint32_t last)
{
    for (uint32_t y = move->y1; y-- > last;)
        move_row(move, y);
    for (uint32_t y = last; y > first; y -= 2)
        move_rows(move, y - 2);
    for (uint32_t y = first; y-- > move->y0;)
        move_row(move, y);
}

bool pixels_move(const struct pixels *pixels, const struct triptych_rectangle *from,
                 const struct triptych_rectangle *to)
{
    const struct move move = {.pixels = pixels,
                              .x0 = to->x,
                              .y0 = to->y,
                              .x1 = to->x + to->width,
                              .y1 = to->y + to->height,
                              .right = (int32_t)from->x - (int32_t)to->x,
                              .down = (int32_t)from->y - (int32_t)to->y};
    if (!pixels->tiles || pixels->tiles->samples != 1 || from->width != to->width ||
        from->height != to->height)
        return false;
    uint32_t first = (move.y0 + 1) & ~1u, last = move.y1 & ~1u;
    if (!keeps_blocks(&move) || first >= last)
        first = last = move.y1;
    (move.down >= 0 ? move_up : move_down)(&move, first, last);
    return true;
}
