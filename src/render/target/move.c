/* Moves within an attachment: each pixel is read before it is written, because rows and columns are taken
 * in the direction of the move. A column of tiles is moved as a whole, so that memory is read and written in
 * its order.
 *
 * If columns keep their place in blocks, the rows of a block move together: two halves of a block, of eight
 * words that follow each other (struct tile_order). Two rows that are the lower one of a half and the upper
 * one of the next half become a half. A pair of rows above the first whole block and one below the last are
 * moved as halves. All else moves in rows. */
#include "base/minmax.h"
#include "render/target/pixels_tile.h"

#include <emmintrin.h>
#include <string.h>

/* The source of the target's pixel (x, y) is (x + right, y + down). */
struct move {
    const struct pixels *pixels;
    uint32_t x0, y0, x1, y1; /* the target's part; from move_part on, of one column of tiles */
    int32_t right, down;
};

static uint32_t source_of(uint32_t place, int32_t distance)
{
    return (uint32_t)((int32_t)place + distance);
}

/* One row. Its sources may be in two tiles. */
static void move_row(const struct move *move, uint32_t y)
{
    uint32_t row[4 * PIXELS_ROW], words = pixels_words(move->pixels);
    uint32_t from = source_of(move->x0, move->right), row_from = source_of(y, move->down);
    uint32_t count = move->x1 - move->x0, first = min_u32(count, TILE_SIZE - from % TILE_SIZE);
    pixels_read_row(move->pixels, from, row_from, first, row);
    if (first < count)
        pixels_read_row(move->pixels, from + first, row_from, count - first, row + first * words);
    pixels_write_row(move->pixels, move->x0, y, count, row);
}

/* --- Halves of blocks --- */

/* Halves of neighbouring blocks in a plane of a tile. */
struct halves {
    _Alignas(16) uint32_t clear[2 * BLOCK_SIZE];
    uint32_t *words;    /* of the first one to be moved */
    ptrdiff_t distance; /* to the next one; 0 if all have the value of a clear */
    ptrdiff_t row;      /* to the same half in the next row of blocks; 0 with `distance` */
};

/* Blocks within a tile of the target, whose sources lie in one tile or, if they are one row of blocks, in
 * two; or a row of upper or lower halves of blocks. */
struct blocks {
    uint32_t x, y;            /* the first block or half to be moved */
    uint32_t columns, rows;   /* blocks; no rows: halves */
    ptrdiff_t step, row_step; /* words to the next block, or row of blocks, to be moved */
};

static void find_halves(const struct attachment *a, uint32_t x, uint32_t y, uint32_t plane,
                        const struct blocks *blocks, struct halves *halves)
{
    uint32_t tile = pixels_tile_of(a, x, y);
    const uint32_t *pending = pixels_pending_words(a, tile);
    halves->distance = pending ? 0 : blocks->step;
    halves->row = pending ? 0 : blocks->row_step;
    halves->words = pending ? halves->clear
                            : pixels_tile_words(a, tile) + plane * a->memory->order.plane +
                                  tile_order_word(&a->memory->order, x % TILE_SIZE, y % TILE_SIZE);
    for (int i = 0; pending && i < 2 * BLOCK_SIZE; i++)
        halves->clear[i] = pending[plane];
}

static __m128i load(const uint32_t *words)
{
    return _mm_load_si128((const __m128i *)(const void *)words);
}

static void store(uint32_t *words, __m128i value)
{
    _mm_store_si128((__m128i *)(void *)words, value);
}

/* The second row of the quads of `upper`, and the first row of those of `lower`. */
static __m128i between(__m128i upper, __m128i lower)
{
    return _mm_castpd_si128(_mm_shuffle_pd(_mm_castsi128_pd(upper), _mm_castsi128_pd(lower), 1));
}

/* One half to one half. */
static void copy_halves(const struct halves from[1], const struct blocks *blocks, uint32_t *to)
{
    const uint32_t *word = from->words;
    for (uint32_t i = 0; i < blocks->columns; i++, word += from->distance, to += blocks->step) {
        __m128i left = load(word), right = load(word + BLOCK_SIZE);
        store(to, left);
        store(to + BLOCK_SIZE, right);
    }
}

/* The blocks follow each other, in the source and in the target. */
static bool are_contiguous(const struct halves from[2], const struct blocks *blocks, uint32_t lower)
{
    return blocks->step == BLOCK_PIXELS && from[0].distance && lower == BLOCK_PIXELS / 2 &&
           from[1].words == from[0].words + lower;
}

/* Two halves to a block whose lower half is `lower` words from its upper one. */
static void copy_blocks(const struct halves from[2], const struct blocks *blocks, uint32_t *to,
                        uint32_t lower)
{
    const uint32_t *a = from[0].words, *b = from[1].words;
    if (are_contiguous(from, blocks, lower)) {
        memmove(to, a, blocks->columns * sizeof(uint32_t[BLOCK_PIXELS]));
        return;
    }
    for (uint32_t i = 0; i < blocks->columns; i++, to += blocks->step) {
        __m128i a_left = load(a), a_right = load(a + BLOCK_SIZE);
        __m128i b_left = load(b), b_right = load(b + BLOCK_SIZE);
        store(to, a_left);
        store(to + BLOCK_SIZE, a_right);
        store(to + lower, b_left);
        store(to + lower + BLOCK_SIZE, b_right);
        a += from[0].distance, b += from[1].distance;
    }
}

static void join_halves(const struct halves from[2], const struct blocks *blocks, uint32_t *to)
{
    const uint32_t *a = from[0].words, *b = from[1].words;
    for (uint32_t i = 0; i < blocks->columns; i++, to += blocks->step) {
        __m128i left = between(load(a), load(b));
        __m128i right = between(load(a + BLOCK_SIZE), load(b + BLOCK_SIZE));
        store(to, left);
        store(to + BLOCK_SIZE, right);
        a += from[0].distance, b += from[1].distance;
    }
}

static void join_blocks(const struct halves from[3], const struct blocks *blocks, uint32_t *to,
                        uint32_t lower)
{
    const uint32_t *a = from[0].words, *b = from[1].words, *c = from[2].words;
    for (uint32_t i = 0; i < blocks->columns; i++, to += blocks->step) {
        __m128i middle_left = load(b), middle_right = load(b + BLOCK_SIZE);
        __m128i left = between(load(a), middle_left), right = between(load(a + BLOCK_SIZE), middle_right);
        __m128i lower_left = between(middle_left, load(c));
        __m128i lower_right = between(middle_right, load(c + BLOCK_SIZE));
        store(to, left);
        store(to + BLOCK_SIZE, right);
        store(to + lower, lower_left);
        store(to + lower + BLOCK_SIZE, lower_right);
        a += from[0].distance, b += from[1].distance, c += from[2].distance;
    }
}

/* Rows of blocks, each from two halves or, if `joined`, from three. */
static void move_rows_of_blocks(struct halves from[3], const struct blocks *blocks, bool joined, uint32_t *to,
                                uint32_t lower)
{
    for (uint32_t row = 0; row < blocks->rows; row++, to += blocks->row_step) {
        (joined ? join_blocks : copy_blocks)(from, blocks, to, lower);
        for (uint32_t i = 0; i < 2u + joined; i++)
            from[i].words += from[i].row;
    }
}

static void move_plane(const struct move *move, const struct blocks *blocks, uint32_t plane, uint32_t *to)
{
    const struct attachment *a = move->pixels->tiles;
    uint32_t x = source_of(blocks->x, move->right), y = source_of(blocks->y, move->down);
    uint32_t joined = y & 1, halves = (blocks->rows ? 2 : 1) + joined;
    struct halves from[3];
    for (uint32_t i = 0; i < halves; i++)
        find_halves(a, x, (y & ~1u) + 2 * i, plane, blocks, &from[i]);
    if (blocks->rows)
        move_rows_of_blocks(from, blocks, joined, to, a->memory->order.lower);
    else
        (joined ? join_halves : copy_halves)(from, blocks, to);
}

static void move_blocks(const struct move *move, const struct blocks *blocks)
{
    const struct attachment *a = move->pixels->tiles;
    const struct tile_order *order = &a->memory->order;
    uint32_t *to = pixels_open_tile(a, pixels_tile_of(a, blocks->x, blocks->y)) +
                   tile_order_word(order, blocks->x % TILE_SIZE, blocks->y % TILE_SIZE);
    for (uint32_t p = 0; p < attachment_planes(a); p++)
        move_plane(move, blocks, p, to + p * order->plane);
}

/* `rows` rows of blocks, or, if 0, a row of halves. The one at y is the first to be moved. */
static void move_band(const struct move *move, uint32_t y, uint32_t rows)
{
    const struct tile_order *order = &move->pixels->tiles->memory->order;
    ptrdiff_t block = order->block;
    struct blocks blocks = {.y = y, .rows = rows, .step = move->right >= 0 ? block : -block};
    blocks.row_step = move->down >= 0 ? (ptrdiff_t)order->block_row : -(ptrdiff_t)order->block_row;
    for (uint32_t left = move->x1 - move->x0, count; left; left -= count) {
        blocks.x = move->right >= 0 ? move->x1 - left : move->x0 + left - BLOCK_SIZE;
        uint32_t from = source_of(blocks.x, move->right);
        count = move->right >= 0 ? TILE_SIZE - max_u32(blocks.x % TILE_SIZE, from % TILE_SIZE)
                                 : min_u32(blocks.x % TILE_SIZE, from % TILE_SIZE) + BLOCK_SIZE;
        count = min_u32(count, left);
        blocks.columns = count / BLOCK_SIZE;
        move_blocks(move, &blocks);
    }
}

/* --- The order of rows --- */

static bool keeps_blocks(const struct move *move)
{
    return !((move->x0 | move->x1 | (uint32_t)move->right) % BLOCK_SIZE);
}

/* Both are even: the first and the last row of what moves in halves and blocks. */
struct even {
    uint32_t first, last;
};

/* Rows of blocks from y on that are moved together: within one tile of the target, their sources within one
 * tile too. A single row may have them in two. 0: a half has to be moved first. */
static uint32_t rows_below(const struct move *move, uint32_t y, uint32_t last)
{
    uint32_t from = source_of(y, move->down), end = min_u32(last - y, TILE_SIZE - y % TILE_SIZE);
    if (y % BLOCK_SIZE || last - y < BLOCK_SIZE)
        return 0;
    return max_u32(1, min_u32(end, TILE_SIZE - from % TILE_SIZE) / BLOCK_SIZE);
}

/* The same of the rows above y. */
static uint32_t rows_above(const struct move *move, uint32_t y, uint32_t first)
{
    uint32_t from = source_of(y - 1, move->down), end = min_u32(y - first, (y - 1) % TILE_SIZE + 1);
    if (y % BLOCK_SIZE || y - first < BLOCK_SIZE)
        return 0;
    return max_u32(1, min_u32(end, from % TILE_SIZE + 1) / BLOCK_SIZE);
}

static void move_up(const struct move *move, struct even even)
{
    for (uint32_t y = move->y0; y < even.first; y++)
        move_row(move, y);
    for (uint32_t y = even.first, rows; y < even.last; y += rows ? rows * BLOCK_SIZE : 2) {
        rows = rows_below(move, y, even.last);
        move_band(move, y, rows);
    }
    for (uint32_t y = even.last; y < move->y1; y++)
        move_row(move, y);
}

static void move_down(const struct move *move, struct even even)
{
    for (uint32_t y = move->y1; y-- > even.last;)
        move_row(move, y);
    for (uint32_t y = even.last, rows; y > even.first; y -= rows ? rows * BLOCK_SIZE : 2) {
        rows = rows_above(move, y, even.first);
        move_band(move, y - (rows ? BLOCK_SIZE : 2), rows);
    }
    for (uint32_t y = even.first; y-- > move->y0;)
        move_row(move, y);
}

static void move_part(const struct move *move)
{
    struct even even = {(move->y0 + 1) & ~1u, move->y1 & ~1u};
    if (!keeps_blocks(move) || even.first >= even.last)
        even.first = even.last = move->y1;
    (move->down >= 0 ? move_up : move_down)(move, even);
}

static void move_columns(struct move move)
{
    const uint32_t first = move.x0, last = move.x1;
    for (; move.right >= 0 && move.x0 < last; move.x0 = move.x1) {
        move.x1 = min_u32(last, (move.x0 / TILE_SIZE + 1) * TILE_SIZE);
        move_part(&move);
    }
    for (; move.right < 0 && move.x1 > first; move.x1 = move.x0) {
        move.x0 = max_u32(first, (move.x1 - 1) / TILE_SIZE * TILE_SIZE);
        move_part(&move);
    }
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
    move_columns(move);
    return true;
}
