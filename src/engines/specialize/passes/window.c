/* Windows: marks gathers of texels that may be close together, for 16 lanes and for two parts of 8.
 *
 * Unless a texture is strongly minified, the texels that the pixels of a block read are within a few rows,
 * and within a few texels of each row. The routine loads this window once for all lanes and chooses each
 * lane's texel in registers (emit/gather_window.c). This pass finds gathers whose index is x + y * pitch, and
 * inserts a `window` instruction before them that has x and y as operands:
 *
 *   a = add x (dot y pitch)          one gather: a texel
 *   a, b = add x (dot y' pitch)      four gathers, at a, a + 1, b, b + 1: the texels of a bilinear filter
 *
 * The `window` is followed by `scale` instructions. The last ones are the gathers; the others compute the
 * parts of their indices that nothing else uses. At run time they are skipped if the texels are close
 * together, and executed otherwise. The pass runs last, because the other passes do not preserve this order.
 *
 * Eight lanes are two rows of four pixels, and each row has a window of its own, wherever it is in the
 * texture. Compact texels have windows, too; those of a filter are in two words, and each has a window. The
 * `window` therefore has the indices themselves as operands: a, or a and b. Only the gathers belong to it. A
 * single part has no windows: the wait for the window's address costs more than they save. */
#include "contract/job.h"
#include "engines/specialize/passes/pass.h"

#include <string.h>

enum {
    DEPENDS = 1, /* the value is computed from texels */
    MOVES = 2    /* the value is computed after the window */
};

struct window_memory {
    uint16_t uses[IR_CAPACITY];
    uint16_t length[IR_CAPACITY]; /* of the first gather of a window: its `scale`, else 0 */
    uint8_t flags[IR_CAPACITY];   /* DEPENDS, MOVES */
};

static_assert(sizeof(struct window_memory) <= PASS_SCRATCH, "scratch memory is large enough");

/* The index of a gather, x + y * pitch; the pitch is the offset of a word of the job. */
struct texel_index {
    uint16_t x, y;
    int32_t pitch;
};

/* The offset in the job of a uniform word or of a slot of the constant table; -1: it is something else. */
static int32_t job_word(const struct ir *ir, unsigned value)
{
    const struct ir_instruction *i = &ir->instruction[value];
    if (i->op == IR_uniform && i->base == BASE_JOB)
        return i->k;
    if (i->op == IR_constant && ir->constant[i->k].base == BASE_JOB)
        return ir->constant[i->k].offset;
    return -1;
}

static bool find_row(const struct ir *ir, unsigned row, struct texel_index *texel)
{
    const struct ir_instruction *i = &ir->instruction[row];
    for (int o = 0; i->op == IR_dot_i && o < 2; o++) {
        texel->y = i->operand[1 - o];
        texel->pitch = job_word(ir, i->operand[o]);
        if (texel->pitch >= 0)
            return true;
    }
    return false;
}

static bool find_texel(const struct ir *ir, unsigned index, struct texel_index *texel)
{
    const struct ir_instruction *i = &ir->instruction[index];
    for (int o = 0; i->op == IR_add_i && o < 2; o++) {
        texel->x = i->operand[1 - o];
        if (find_row(ir, i->operand[o], texel))
            return true;
    }
    return false;
}

/* Returns true if an instruction is the gather at `index` that reads `words` words further than `first`. */
static bool reads(const struct ir_instruction *i, const struct ir_instruction *first, unsigned index,
                  int words)
{
    return i->op == IR_gather && i->operand[0] == index && i->base == first->base &&
           i->field == first->field && i->scale == first->scale && i->k == first->k + 4 * words;
}

/* The window whose first gather is this instruction; its op is nop if there is none. */
static struct ir_instruction window_at(const struct ir *ir, uint32_t number)
{
    const struct ir_instruction *i = &ir->instruction[number];
    struct ir_instruction none = {.op = IR_nop};
    struct texel_index upper, lower;
    if (i->op != IR_gather || i->field == GATHER_DIRECT || i->scale != 4 || i->k ||
        !find_texel(ir, i->operand[0], &upper))
        return none;
    struct ir_instruction window = {.op = IR_window,
                                    .base = i->base,
                                    .field = i->field,
                                    .k = upper.pitch,
                                    .operand = {upper.x, upper.y, upper.y},
                                    .line = i->line,
                                    .file = i->file,
                                    .origin = i->origin};
    if (number + 1 == ir->count || !reads(i + 1, i, i->operand[0], 1))
        return window;
    unsigned below = number + 2 < ir->count ? i[2].operand[0] : 0;
    if (number + 3 >= ir->count || !reads(i + 2, i, below, 0) || !reads(i + 3, i, below, 1) ||
        !find_texel(ir, below, &lower) || lower.x != upper.x || lower.pitch != upper.pitch)
        return none;
    window.operand[2] = lower.y;
    return window;
}

static unsigned gathers_of(const struct ir_instruction *window)
{
    return window->operand[1] == window->operand[2] ? 1 : 4;
}

/* Lists the rows (y * pitch) of a window's gathers and then their indices. Returns the length of the list. */
static unsigned indices_of(const struct ir *ir, uint32_t first, unsigned gathers, uint16_t value[4])
{
    unsigned rows = gathers > 1 ? 2 : 1;
    struct texel_index texel;
    for (unsigned row = 0; row < rows; row++) {
        unsigned index = ir->instruction[first + 2 * row].operand[0];
        const uint16_t *operand = ir->instruction[index].operand;
        value[row] = operand[!find_row(ir, operand[0], &texel)];
        value[rows + row] = (uint16_t)index;
    }
    return 2 * rows;
}

/* Marks those of them that are computed after the window: an index if only the gathers use it, and its row if
 * only that index uses it. Returns their number. */
static unsigned move_indices(const struct ir *ir, struct window_memory *m, uint32_t first, unsigned gathers)
{
    uint16_t value[4];
    unsigned rows = indices_of(ir, first, gathers, value) / 2, moved = 0;
    for (unsigned row = 0; row < rows; row++) {
        unsigned index = value[rows + row];
        if (m->uses[index] != gathers / rows)
            continue;
        m->flags[index] |= MOVES;
        moved++;
        if (m->uses[value[row]] != 1)
            continue;
        m->flags[value[row]] |= MOVES;
        moved++;
    }
    return moved;
}

/* Returns true for a single texel whose coordinates were gathered: a look-up in a table, whose entries can be
 * anywhere. */
static bool is_scattered(const struct window_memory *m, const struct ir_instruction *window)
{
    return gathers_of(window) == 1 && (m->flags[window->operand[0]] | m->flags[window->operand[1]]) & DEPENDS;
}

static void count_uses(const struct ir *ir, uint16_t *uses)
{
    memset(uses, 0, ir->count * sizeof *uses);
    for (uint32_t number = 1; number < ir->count; number++)
        for (int o = 0; o < 3; o++)
            uses[ir->instruction[number].operand[o]]++;
}

/* Returns true for a gather that begins at the texels of a texture, which have a margin. */
static bool reads_texels(const struct ir_instruction *i)
{
    size_t texture = (size_t)i->field - offsetof(struct job, texture);
    return i->op == IR_gather && i->field != GATHER_DIRECT && i->base == BASE_JOB && i->scale <= 4 &&
           texture < sizeof((struct job *)0)->texture &&
           texture % sizeof(struct texture_job) == offsetof(struct texture_job, texels);
}

/* Marks the values that are computed from texels. */
static void find_dependent(const struct ir *ir, struct window_memory *m)
{
    m->flags[0] = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        uint8_t any = reads_texels(i) ? DEPENDS : 0;
        for (int o = 0; o < 3; o++)
            any |= m->flags[i->operand[o]] & DEPENDS;
        m->flags[number] = any;
    }
}

/* Finds all windows: sets the lengths and marks the values that move. Returns the number of windows. */
static unsigned find_windows(const struct ir *ir, struct window_memory *m)
{
    unsigned windows = 0;
    count_uses(ir, m->uses);
    find_dependent(ir, m);
    memset(m->length, 0, ir->count * sizeof *m->length);
    for (uint32_t number = 1; number < ir->count && ir->count + windows < IR_CAPACITY; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        struct ir_instruction window = window_at(ir, number);
        if (i->op == IR_window)
            number += i->scale;
        if (window.op != IR_window || is_scattered(m, &window))
            continue;
        unsigned gathers = gathers_of(&window);
        m->length[number] = (uint16_t)(gathers + move_indices(ir, m, number, gathers));
        number += gathers - 1;
        windows++;
    }
    return windows;
}

static uint32_t append_window(const struct ir *ir, struct pass_memory *memory, const struct window_memory *m,
                              uint32_t first, uint32_t count)
{
    struct ir_instruction window = window_at(ir, first);
    uint16_t value[4];
    unsigned values = indices_of(ir, first, gathers_of(&window), value);
    window.scale = (uint8_t)m->length[first];
    for (int o = 0; o < 3; o++)
        window.operand[o] = memory->map[window.operand[o]];
    memory->rebuilt[count++] = window;
    for (unsigned v = 0; v < values; v++)
        if (m->flags[value[v]] & MOVES)
            pass_append(ir, memory, value[v], &count);
    return count;
}

/* --- Eight lanes --------------------------------------------------------------------------------------- */

/* The window of eight lanes whose first gather is this instruction; its op is nop if there is none. An index
 * that is not a sum belongs to texels of several words, or to a table. */
static struct ir_instruction row_window_at(const struct ir *ir, const struct window_memory *m,
                                           uint32_t number)
{
    const struct ir_instruction *i = &ir->instruction[number];
    struct ir_instruction none = {.op = IR_nop};
    uint16_t index = i->operand[0];
    if (!reads_texels(i) || i->k || ir->instruction[index].op != IR_add_i)
        return none;
    struct ir_instruction window = {.op = IR_window,
                                    .base = i->base,
                                    .field = i->field,
                                    .scale = 1,
                                    .operand = {index, index, index},
                                    .line = i->line,
                                    .file = i->file,
                                    .origin = i->origin};
    if (i->scale != 4 || number + 1 == ir->count || !reads(i + 1, i, index, 1))
        return m->flags[index] & DEPENDS ? none : window;
    unsigned below = number + 2 < ir->count ? i[2].operand[0] : 0;
    if (number + 3 >= ir->count || !reads(i + 2, i, below, 0) || !reads(i + 3, i, below, 1))
        return none;
    window.scale = 4;
    window.operand[1] = window.operand[2] = (uint16_t)below;
    return window;
}

static unsigned insert_row_windows(struct ir *ir, struct pass_memory *memory, struct window_memory *m)
{
    unsigned windows = 0;
    uint32_t count = pass_rebuild(ir, memory), until = 0;
    find_dependent(ir, m);
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction window = row_window_at(ir, m, number);
        if (number >= until && window.op == IR_window && ir->count + windows < IR_CAPACITY) {
            until = number + window.scale;
            for (int o = 0; o < 3; o++)
                window.operand[o] = memory->map[window.operand[o]];
            memory->rebuilt[count++] = window;
            windows++;
        }
        pass_append(ir, memory, number, &count);
    }
    if (windows)
        pass_replace(ir, memory, count);
    return windows;
}

static bool has_windows(const struct ir *ir)
{
    for (uint32_t number = 1; number < ir->count; number++)
        if (ir->instruction[number].op == IR_window)
            return true;
    return false;
}

unsigned pass_window(struct ir *ir, struct pass_memory *memory)
{
    struct window_memory *m = pass_scratch(memory, sizeof *m);
    bool rows = memory->lanes == 8 && memory->parts == 2;
    if (memory->lanes != 16 && !rows)
        return 0;
    ir_compact(ir, memory->map);
    if (rows)
        return has_windows(ir) ? 0 : insert_row_windows(ir, memory, m);
    unsigned windows = find_windows(ir, m);
    if (!windows)
        return 0;
    uint32_t count = pass_rebuild(ir, memory);
    for (uint32_t number = 1; number < ir->count; number++) {
        if (m->length[number])
            count = append_window(ir, memory, m, number, count);
        if (!(m->flags[number] & MOVES))
            pass_append(ir, memory, number, &count);
    }
    pass_replace(ir, memory, count);
    return windows;
}
