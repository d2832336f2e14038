#include "render/tile/round.h"

#include "render/tile/hidden.h"

#include <string.h>

void round_stop_at(struct round *round, uint32_t chunk)
{
    uint32_t first = atomic_load(&round->first_stopped);
    while (chunk < first && !atomic_compare_exchange_weak(&round->first_stopped, &first, chunk))
        ;
}

void round_begin_bands(struct round *round, bool several)
{
    uint32_t tiles = round->target->columns * round->target->rows;
    round->band_shift = several ? bin_band_shift(tiles) : 31;
    round->bands = ((tiles - 1) >> round->band_shift) + 1;
}

/* Appends the bins of a chunk to those of the band's tiles. */
static void link_chunk(struct round *round, const struct chunk *chunk, uint32_t band)
{
    uint16_t *busy = round->busy + (band ? band << round->band_shift : 0);
    for (uint32_t head = chunk->heads[band]; head; head = bin_cell(&round->arena, head)->sibling) {
        uint32_t tile = bin_cell(&round->arena, head)->tile;
        if (!round->tile_first[tile]) {
            round->tile_first[tile] = head;
            busy[round->busy_of_band[band]++] = (uint16_t)tile;
        } else {
            bin_cell(&round->arena, round->tile_last[tile])->later = head;
        }
        round->tile_last[tile] = head;
    }
}

/* Returns true if the chunk's draw overwrites everything that one of its triangles covers. */
static bool overwrites(const struct round *round, const struct chunk *chunk)
{
    const struct routine *routine = round->command[chunk->command].draw.routine[UNIT_PIXEL];
    return routine->traits & PIXEL_OVERWRITES_ALL &&
           hidden_writes_all_targets(&routine->key.pixel, round->target);
}

/* Notes the bins of a chunk that overwrite their tiles, those of a band. */
static void link_covered(struct round *round, uint32_t number, uint32_t band)
{
    const struct chunk *chunk = round->chunk + number;
    if (!overwrites(round, chunk))
        return;
    for (uint32_t head = chunk->heads[band]; head; head = bin_cell(&round->arena, head)->sibling)
        if (bin_covers(&round->arena, head))
            round->tile_start[bin_cell(&round->arena, head)->tile] = number + 1;
}

static void link_everywhere(struct round *round, uint32_t number)
{
    const struct chunk *chunk = round->chunk + number;
    round->everywhere[round->everywhere_count++] = number;
    if (chunk->wide && overwrites(round, chunk))
        round->wide_start[round->wide_starts++] = number;
}

static void forget_bins(struct round *round)
{
    uint32_t tiles = round->target->columns * round->target->rows;
    memset(round->tile_first, 0, tiles * sizeof *round->tile_first);
    memset(round->tile_start, 0, tiles * sizeof *round->tile_start);
    memset(round->busy_of_band, 0, sizeof round->busy_of_band);
    round->everywhere_count = round->wide_starts = 0;
    round->pixels = round->head_count = 0;
    round->counts = (struct batch_counts){0};
}

static void count_chunk(struct round *round, const struct chunk *chunk)
{
    round->pixels += chunk->pixels;
    round->head_count += chunk->head_count;
    round->counts.vertices_shaded += chunk->counts.vertices_shaded;
    round->counts.triangles_set_up += chunk->counts.triangles_set_up;
    round->counts.triangles_visible += chunk->counts.triangles_visible;
}

/* The first primitive after what is done of a chunk. */
static struct cursor chunk_end(const struct round *round, const struct chunk *chunk)
{
    const struct command *command = round->command + chunk->command;
    uint32_t end = chunk->first + chunk->done;
    if (command->kind == COMMAND_CLEAR || end == command->draw.count)
        return (struct cursor){chunk->command + 1, 0};
    return (struct cursor){chunk->command, end};
}

static void link_band(struct round *round, uint32_t number, uint32_t band)
{
    const struct chunk *chunk = round->chunk + number;
    if (!chunk->head_count)
        return;
    link_chunk(round, chunk, band);
    if (chunk->covered)
        link_covered(round, number, band);
}

struct cursor round_begin_linking(struct round *round)
{
    uint32_t stopped = atomic_load(&round->first_stopped);
    struct cursor end = {0, 0};
    forget_bins(round);
    round->linked = stopped < round->chunks ? stopped + 1 : round->chunks;
    for (uint32_t i = 0; i < round->linked; i++) {
        const struct chunk *chunk = round->chunk + i;
        if (round_command(round, i)->kind == COMMAND_CLEAR || chunk->wide)
            link_everywhere(round, i);
        if (round->bands == 1)
            link_band(round, i, 0);
        count_chunk(round, chunk);
        end = chunk_end(round, chunk);
    }
    return end;
}

void round_link_band(struct round *round, uint32_t band)
{
    for (uint32_t i = 0; i < round->linked; i++)
        link_band(round, i, band);
}

void round_end_linking(struct round *round)
{
    round->busy_count = round->busy_of_band[0];
    for (uint32_t band = 1; band < round->bands; band++) {
        memmove(round->busy + round->busy_count, round->busy + (band << round->band_shift),
                round->busy_of_band[band] * sizeof *round->busy);
        round->busy_count += round->busy_of_band[band];
    }
    round->tiles = round->everywhere_count ? round->target->columns * round->target->rows : round->busy_count;
}

struct cursor round_link(struct round *round)
{
    struct cursor end = round_begin_linking(round);
    for (uint32_t band = 0; band < round->bands && round->bands > 1; band++)
        round_link_band(round, band);
    round_end_linking(round);
    return end;
}

static uint64_t count_bin(const struct round *round, uint32_t tile)
{
    uint64_t count = 0;
    for (uint32_t head = round->tile_first[tile]; head; head = bin_cell(&round->arena, head)->later)
        for (uint32_t at = head; at; at = bin_cell(&round->arena, at)->next)
            count += bin_cell(&round->arena, at)->count;
    return count;
}

static uint64_t count_wide(const struct round *round, uint32_t tile)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < round->everywhere_count; i++) {
        const struct chunk *chunk = round->chunk + round->everywhere[i];
        struct bin_cell cell = {.count = 0};
        if (chunk->wide)
            bin_wide_cell(bin_wide(&round->arena, chunk->wide), tile % round->target->columns,
                          tile / round->target->columns, &cell);
        count += cell.count;
    }
    return count;
}

uint64_t round_tile_triangles(const struct round *round)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < round->tiles; i++)
        count += count_bin(round, round_tile(round, i)) + count_wide(round, round_tile(round, i));
    return count;
}
