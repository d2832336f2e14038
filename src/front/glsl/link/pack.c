/* Packing of vectors into registers (appendix A, section 7). */
#include "front/glsl/link/link.h"

enum { MOST_REGISTERS = 256 };

static void set_spots(struct glsl_block_to_place *block, unsigned first, unsigned component)
{
    for (unsigned i = 0; i < block->registers; i++)
        block->spot[i] = (struct glsl_spot){(int16_t)(first + i), (uint8_t)component};
}

static unsigned place_in_order(struct glsl_block_to_place *block, unsigned count, unsigned most)
{
    unsigned next = 0;
    for (unsigned i = 0; i < count && next <= most; i++) {
        if (next + block[i].registers <= most)
            set_spots(&block[i], next, 0);
        next += block[i].registers;
    }
    return next;
}

/* --- A grid of registers and components ----------------------------------------------------------------- */

struct grid {
    uint8_t used[MOST_REGISTERS]; /* a bit for each component */
    unsigned most;
};

/* The free registers from `first` on that have all components of a mask. */
static unsigned run_at(const struct grid *grid, unsigned first, unsigned mask)
{
    unsigned end = first;
    while (end < grid->most && !(grid->used[end] & mask))
        end++;
    return end - first;
}

/* The shortest run that has room in a component; `least` is its length, and is reduced. */
static int shortest_run(const struct grid *grid, unsigned mask, unsigned needed, unsigned *least)
{
    int best = -1;
    for (unsigned first = 0; first < grid->most;) {
        unsigned run = run_at(grid, first, mask);
        if (run >= needed && run < *least) {
            *least = run;
            best = (int)first;
        }
        first += run + 1;
    }
    return best;
}

static int first_run(const struct grid *grid, unsigned mask, unsigned needed)
{
    for (unsigned first = 0; first < grid->most;) {
        unsigned run = run_at(grid, first, mask);
        if (run >= needed)
            return (int)first;
        first += run + 1;
    }
    return -1;
}

/* Three or four components begin at x, in the first registers. Two are in x and y, or else in z and w, in
 * the last registers. One is in the component with the shortest run. */
static int find_place(const struct grid *grid, const struct glsl_block_to_place *block, unsigned *component)
{
    unsigned least = MOST_REGISTERS + 1, mask = glsl_mask(block->rows);
    int best = -1;
    *component = 0;
    if (block->rows > 1) {
        best = first_run(grid, mask, block->registers);
        if (best >= 0 || block->rows > 2)
            return best;
        *component = 2;
        for (unsigned first = grid->most; first-- > 0;)
            if (run_at(grid, first, mask << 2) >= block->registers)
                return (int)first;
        return -1;
    }
    for (unsigned c = 0; c < 4; c++) {
        int place = shortest_run(grid, 1u << c, block->registers, &least);
        if (place >= 0) {
            best = place;
            *component = c;
        }
    }
    return best;
}

static bool place_block(struct grid *grid, struct glsl_block_to_place *block)
{
    unsigned component;
    int first = find_place(grid, block, &component);
    if (first < 0)
        return false;
    set_spots(block, (unsigned)first, component);
    for (unsigned i = 0; i < block->registers; i++)
        grid->used[(unsigned)first + i] |= (uint8_t)(glsl_mask(block->rows) << component);
    return true;
}

/* The wide ones first, of these the long ones. Returns the next block that is not placed yet. */
static struct glsl_block_to_place *largest(struct glsl_block_to_place *block, unsigned count, bool *placed)
{
    int best = -1;
    for (unsigned i = 0; i < count; i++) {
        const struct glsl_block_to_place *b = best < 0 ? NULL : &block[best];
        if (!placed[i] && (!b || block[i].rows > b->rows ||
                           (block[i].rows == b->rows && block[i].registers > b->registers)))
            best = (int)i;
    }
    placed[best] = true;
    return &block[best];
}

static unsigned place_packed(struct glsl_linker *linker, struct glsl_block_to_place *block, unsigned count,
                             unsigned most)
{
    struct grid *grid = GLSL_NEW(&linker->arena, struct grid);
    bool *placed = glsl_take(&linker->arena, count + 1);
    unsigned used = 0;
    grid->most = most;
    for (unsigned i = 0; i < count; i++)
        if (!place_block(grid, largest(block, count, placed)))
            return most + 1;
    for (unsigned i = 0; i < most; i++)
        if (grid->used[i])
            used = i + 1;
    return used;
}

unsigned glsl_link_place(struct glsl_linker *linker, struct glsl_block_to_place *block, unsigned count,
                         unsigned most)
{
    enum { MOST_BLOCKS = 4 * MOST_REGISTERS };
    unsigned used = place_in_order(block, count, most);
    if (used <= most)
        return used;
    return count > MOST_BLOCKS ? most + 1 : place_packed(linker, block, count, most);
}
