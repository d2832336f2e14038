/* Random inputs of blits. Input and rows end at fences. */
#include "tests/support/differential/differential_part.h"
#include "contract/key_query.h"

#include "base/bits.h"

#include <string.h>

/* Elements of a call, at most a row of blocks. */
static void choose_count(struct differential *d, uint32_t maximum)
{
    d->count = LANES_MAXIMUM * (1 + differential_below(d, maximum / LANES_MAXIMUM));
}

/* Input of `words` words, which end at the fence. */
static uint32_t *make_input(struct differential *d, size_t words)
{
    d->blit_input_bytes = 4 * words;
    return (uint32_t *)(void *)(d->blit_input + BLIT_INPUT_BYTES - d->blit_input_bytes);
}

static void make_clear(struct differential *d)
{
    choose_count(d, BLIT_ROW_WORDS);
    d->blit = (struct blit_job){.word = differential_word(d),
                                .mask = differential_word(d),
                                .left = (int32_t)differential_below(d, 40) - 1,
                                .top = (int32_t)differential_below(d, 3) - 1};
    d->blit.right = d->blit.left + 1 + (int32_t)differential_below(d, 40);
    d->blit.bottom = d->blit.top + 1 + (int32_t)differential_below(d, 4);
    uint32_t *place = make_input(d, d->count);
    for (uint32_t i = 0; i < d->count; i++)
        place[i] = differential_below(d, TILE_SIZE) | differential_below(d, BLOCK_SIZE) << 16;
}

static void fill(struct differential *d, bool numbers, void *memory, size_t bytes)
{
    if (numbers)
        differential_fill_numbers(d, memory, bytes, 0, 1);
    else
        differential_fill_words(d, memory, bytes);
}

/* Only the words that are read are new for each call. */
static void make_samples(struct differential *d, const struct blit_key *key)
{
    int samples = 1 << key->samples;
    choose_count(d, BLIT_ROW_WORDS);
    uint8_t *input = (uint8_t *)make_input(d, (size_t)blit_sample_offset(key, samples - 1) / 4 + d->count);
    for (int s = 0; s < samples; s++)
        fill(d, key->numbers, input + blit_sample_offset(key, s), 4 * (size_t)d->count);
}

/* Rows of texels. The last one ends at the fence. */
static uint8_t *make_rows(struct differential *d, uint32_t rows, uint32_t texels, bool numbers)
{
    uint32_t row_bytes = (numbers ? 16 : 4) * texels;
    d->blit_rows_bytes = (size_t)rows * row_bytes;
    uint8_t *first = d->blit_rows + BLIT_ROWS_BYTES - d->blit_rows_bytes;
    fill(d, numbers, first, d->blit_rows_bytes);
    for (uint32_t row = 0; row < rows; row++)
        d->blit.row[row] = first + (size_t)row * row_bytes;
    return first;
}

/* The weights of the texels along an axis of an odd size that becomes `half`; others have the weight 1. */
static void axis_weights(struct differential *d, int taps, int32_t weight[BLIT_TAPS_MAXIMUM])
{
    int32_t half = 1 + (int32_t)differential_below(d, 300),
            i = (int32_t)differential_below(d, (uint32_t)half);
    weight[0] = weight[1] = weight[2] = 1;
    if (taps == 3) {
        weight[0] = half - i;
        weight[1] = half;
        weight[2] = i + 1;
    }
}

static void make_shrink(struct differential *d, const struct blit_key *key)
{
    uint32_t half = 1 + differential_below(d, BLIT_ROW_TEXELS / 2 - 1);
    uint32_t width = key->taps[0] == 1 ? 1 : 2 * half + (key->taps[0] == 3);
    int32_t y[BLIT_TAPS_MAXIMUM], z[BLIT_TAPS_MAXIMUM], sum = 0;
    d->blit = (struct blit_job){.half = (int32_t)half};
    choose_count(d, BLIT_ROW_WORDS);
    make_rows(d, (uint32_t)key->taps[1] * key->taps[2], width, false);
    axis_weights(d, key->taps[1], y);
    axis_weights(d, key->taps[2], z);
    for (int row = 0; row < key->taps[1] * key->taps[2]; row++) {
        d->blit.row_weight[row] = y[row % key->taps[1]] * z[row / key->taps[1]];
        sum += d->blit.row_weight[row];
    }
    d->blit.total = sum * (int32_t)width;
    uint32_t *index = make_input(d, d->count);
    for (uint32_t i = 0; i < d->count; i++)
        index[i] = key->taps[0] == 1 ? 0 : differential_below(d, half);
}

static void make_blend(struct differential *d, const struct blit_key *key)
{
    uint32_t texels = 1 + differential_below(d, BLIT_ROW_TEXELS);
    d->blit = (struct blit_job){.weight = differential_below(d, 4) ? differential_between(d, 0, 1) : 0,
                                .missing = differential_below(d, 2) ? 0xff000000 : 0};
    choose_count(d, BLIT_BLEND_PIXELS);
    make_rows(d, 2, texels, key->numbers);
    uint32_t *element = make_input(d, 2 * BLIT_BLEND_PIXELS + d->count);
    for (uint32_t i = 0; i < 2 * BLIT_BLEND_PIXELS; i++)
        element[i] = differential_below(d, texels);
    for (uint32_t i = 0; i < d->count; i++)
        element[2 * BLIT_BLEND_PIXELS + i] =
            bits_of_float(differential_below(d, 4) ? differential_between(d, 0, 1) : 0);
}

void differential_blit_inputs(struct differential *d, const struct blit_key *key)
{
    d->blit = (struct blit_job){0};
    differential_fill_words(d, d->initial.color, 4 * sizeof(uint32_t[BLIT_ROW_WORDS]));
    switch ((enum blit_operation)key->operation) {
    case BLIT_CLEAR: make_clear(d); break;
    case BLIT_RESOLVE: make_samples(d, key); break;
    case BLIT_SHRINK: make_shrink(d, key); break;
    case BLIT_BLEND: make_blend(d, key); break;
    case BLIT_COUNT: break;
    }
}
