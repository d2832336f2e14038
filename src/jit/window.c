/* Windows: which gathers of texels lie close together.
 *
 * The pixels of a block look at texels that are near each other, unless the texture is much smaller on the screen than
 * it is: within a few rows, and a few texels of each. These few rows are loaded as they are, once for all lanes, and each
 * lane's texel is chosen among them in registers (gather_window.c). This pass finds what reads texels by place, x + y *
 * pitch, and puts a `window` before it that names x and y, so that both are still there:
 *
 *   a = add x (dot y pitch)          one gather: a texel
 *   a, b = add x (dot y' pitch)      four gathers of neighbours, a a+1 b b+1: the texels that are blended linearly
 *
 * Behind the window stand the gathers and what of their indices nobody else needs: the way for lanes that are not near
 * each other, which is found out when the routine runs. For 16 lanes only. Runs last: a window is no value and has no
 * effect, which other passes would have to know. */
#include "jit/pass.h"

#include <string.h>

/* Of memory->flag: the value is computed of something gathered; it goes behind the window. */
enum { DEPENDS = 1, MOVES = 2 };

/* Where a gather reads: x + y * pitch, the pitch a word of the job. */
struct texel_place {
    uint16_t x, y;
    int32_t pitch;
};

/* The offset in the job of what is the same in all lanes; -1: it is no such word. */
static int32_t job_word(const struct ir *ir, unsigned value)
{
    const struct ir_instruction *i = &ir->instruction[value];
    if (i->op == IR_uniform && i->base == BASE_JOB)
        return i->k;
    if (i->op == IR_constant && ir->constant[i->k].base == BASE_JOB)
        return ir->constant[i->k].offset;
    return -1;
}

static int find_row(const struct ir *ir, unsigned row, struct texel_place *place)
{
    const struct ir_instruction *i = &ir->instruction[row];
    for (int o = 0; i->op == IR_dot_i && o < 2; o++) {
        place->y = i->operand[1 - o];
        place->pitch = job_word(ir, i->operand[o]);
        if (place->pitch >= 0)
            return 1;
    }
    return 0;
}

static int find_place(const struct ir *ir, unsigned index, struct texel_place *place)
{
    const struct ir_instruction *i = &ir->instruction[index];
    for (int o = 0; i->op == IR_add_i && o < 2; o++) {
        place->x = i->operand[1 - o];
        if (find_row(ir, i->operand[o], place))
            return 1;
    }
    return 0;
}

/* Whether an instruction is the gather of `index`, `words` behind where `first` reads. */
static int reads(const struct ir_instruction *i, const struct ir_instruction *first, unsigned index,
                 int words)
{
    return i->op == IR_gather && i->operand[0] == index && i->base == first->base &&
           i->field == first->field && i->scale == first->scale && i->k == first->k + 4 * words;
}

/* The window of the gathers from this one on; its op is nop if there is none. */
static struct ir_instruction window_at(const struct ir *ir, uint32_t number)
{
    const struct ir_instruction *i = &ir->instruction[number];
    struct ir_instruction none = {.op = IR_nop};
    struct texel_place upper, lower;
    if (i->op != IR_gather || i->field == GATHER_DIRECT || i->scale != 4 || i->k ||
        !find_place(ir, i->operand[0], &upper))
        return none;
    struct ir_instruction window = {.op = IR_window,
                                    .base = i->base,
                                    .field = i->field,
                                    .k = upper.pitch,
                                    .operand = {upper.x, upper.y, upper.y},
                                    .line = i->line,
                                    .file = i->file};
    if (number + 1 == ir->count || !reads(i + 1, i, i->operand[0], 1))
        return window;
    unsigned below = number + 2 < ir->count ? i[2].operand[0] : 0;
    if (number + 3 >= ir->count || !reads(i + 2, i, below, 0) || !reads(i + 3, i, below, 1) ||
        !find_place(ir, below, &lower) || lower.x != upper.x || lower.pitch != upper.pitch)
        return none;
    window.operand[2] = lower.y;
    return window;
}

static unsigned gathers_of(const struct ir_instruction *window)
{
    return window->operand[1] == window->operand[2] ? 1 : 4;
}

/* The indices of a window's gathers and the rows that they are made of, rows first; returns how many. */
static unsigned indices_of(const struct ir *ir, uint32_t first, unsigned gathers, uint16_t value[4])
{
    unsigned rows = gathers > 1 ? 2 : 1;
    struct texel_place place;
    for (unsigned row = 0; row < rows; row++) {
        unsigned index = ir->instruction[first + 2 * row].operand[0];
        const uint16_t *operand = ir->instruction[index].operand;
        value[row] = operand[!find_row(ir, operand[0], &place)];
        value[rows + row] = (uint16_t)index;
    }
    return 2 * rows;
}

/* Marks those of them that go behind the window: the indices if only its gathers use them, and then their rows. Returns how
 * many. */
static unsigned move_indices(const struct ir *ir, struct pass_memory *memory, uint32_t first,
                             unsigned gathers)
{
    uint16_t value[4];
    unsigned rows = indices_of(ir, first, gathers, value) / 2, moved = 0;
    for (unsigned row = 0; row < rows; row++) {
        unsigned index = value[rows + row];
        if (memory->region[index] != gathers / rows)
            continue;
        memory->flag[index] |= MOVES;
        moved++;
        if (memory->region[value[row]] != 1)
            continue;
        memory->flag[value[row]] |= MOVES;
        moved++;
    }
    return moved;
}

/* A single texel at a place that was looked up: tables are read so, and their entries are anywhere. */
static int is_scattered(const struct pass_memory *memory, const struct ir_instruction *window)
{
    return gathers_of(window) == 1 &&
           (memory->flag[window->operand[0]] | memory->flag[window->operand[1]]) & DEPENDS;
}

static void count_uses(const struct ir *ir, uint16_t *uses)
{
    memset(uses, 0, ir->count * sizeof *uses);
    for (uint32_t number = 1; number < ir->count; number++)
        for (int o = 0; o < 3; o++)
            uses[ir->instruction[number].operand[o]]++;
}

/* Marks what is computed of something gathered: memory->flag is DEPENDS. */
static void find_dependent(const struct ir *ir, struct pass_memory *memory)
{
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        uint8_t any = i->op == IR_gather ? DEPENDS : 0;
        for (int o = 0; o < 3; o++)
            any |= memory->flag[i->operand[o]] & DEPENDS;
        memory->flag[number] = any;
    }
}

/* Where each window goes, and what behind it: memory->same of its first gather is how many instructions. */
static unsigned find_windows(const struct ir *ir, struct pass_memory *memory)
{
    unsigned windows = 0;
    count_uses(ir, memory->region);
    memory->flag[0] = 0;
    find_dependent(ir, memory);
    memset(memory->same, 0, ir->count * sizeof *memory->same);
    for (uint32_t number = 1; number < ir->count && ir->count + windows < IR_CAPACITY; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        struct ir_instruction window = window_at(ir, number);
        if (i->op == IR_window)
            number += i->scale;
        if (window.op != IR_window || is_scattered(memory, &window))
            continue;
        unsigned gathers = gathers_of(&window);
        memory->same[number] = (uint16_t)(gathers + move_indices(ir, memory, number, gathers));
        number += gathers - 1;
        windows++;
    }
    return windows;
}

struct rebuild {
    const struct ir *ir;
    struct pass_memory *memory;
    uint32_t count;
};

static void append(struct rebuild *r, const struct ir_instruction *i)
{
    struct ir_instruction *to = &r->memory->rebuilt[r->count++];
    *to = *i;
    for (int o = 0; o < 3; o++)
        to->operand[o] = r->memory->map[i->operand[o]];
}

static void append_value(struct rebuild *r, uint32_t number)
{
    r->memory->map[number] = (uint16_t)r->count;
    append(r, &r->ir->instruction[number]);
}

static void append_window(struct rebuild *r, uint32_t first)
{
    struct ir_instruction window = window_at(r->ir, first);
    uint16_t value[4];
    unsigned values = indices_of(r->ir, first, gathers_of(&window), value);
    window.scale = (uint8_t)r->memory->same[first];
    append(r, &window);
    for (unsigned v = 0; v < values; v++)
        if (r->memory->flag[value[v]] & MOVES)
            append_value(r, value[v]);
}

unsigned pass_window(struct ir *ir, struct pass_memory *memory)
{
    struct rebuild r = {ir, memory, 1};
    if (memory->lanes != 16)
        return 0;
    ir_compact(ir, memory->map);
    unsigned windows = find_windows(ir, memory);
    if (!windows)
        return 0;
    memory->map[0] = 0;
    memory->rebuilt[0] = ir->instruction[0];
    for (uint32_t number = 1; number < ir->count; number++) {
        if (memory->same[number])
            append_window(&r, number);
        if (!(memory->flag[number] & MOVES))
            append_value(&r, number);
    }
    memcpy(ir->instruction, memory->rebuilt, r.count * sizeof *memory->rebuilt);
    ir->count = r.count;
    return windows;
}
