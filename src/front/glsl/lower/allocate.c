/* Registers for temporaries: one pass over the code, with the first and the last instruction that needs each
 * one. A temporary from outside of a loop that the loop uses is needed during the whole loop. Arrays get
 * consecutive registers. */
#include "front/glsl/lower/code.h"

#include <string.h>

enum { REGISTERS = 256, WORDS = REGISTERS / 64, NEVER = 0xffffffff };

struct loop {
    uint32_t first_region, begin;
};

struct state {
    struct glsl_code *code;
    uint32_t *first, *last; /* of each instruction: the temporaries that begin and end there, as a list */
    uint32_t *next_first, *next_last;
    uint64_t used[WORDS];
    unsigned most;
    struct loop open[GLSL_MOST_LOOPS + 1];
    unsigned depth;
};

/* --- Ranges --------------------------------------------------------------------------------------------- */

/* The temporary whose range is that of a register: the first one of an array. */
static struct glsl_temporary *leader(struct glsl_code *code, uint32_t number)
{
    struct glsl_temporary *temporary = &code->temporary[number];
    return temporary->registers ? &code->temporary[temporary->block] : temporary;
}

/* Widens a range to the begin of the outermost loop that the temporary is from outside of, and notes that it
 * lasts to the end of it. */
static void touch(struct state *state, uint32_t number, uint32_t at)
{
    struct glsl_temporary *temporary = leader(state->code, number);
    uint32_t begin = at;
    unsigned i = 0;
    while (i < state->depth && temporary->home >= state->open[i].first_region)
        i++;
    if (i < state->depth)
        begin = state->open[i].begin;
    if (temporary->first > begin)
        temporary->first = begin;
    if (temporary->last == NEVER || temporary->last < at)
        temporary->last = at;
}

static void touch_operand(struct state *state, const struct glsl_operand *operand, uint32_t at)
{
    if (operand->access)
        touch(state, operand->index, at);
    if (operand->file == GLSL_FILE_TEMPORARY)
        touch(state, operand->number, at);
}

/* Calls touch for all operands of an instruction, as if it were at `at`. */
static void touch_all(struct state *state, const struct glsl_instruction *x, uint32_t at)
{
    for (unsigned i = 0; i < glsl_ops[x->op].sources; i++)
        touch_operand(state, &x->from[i], at);
    if (glsl_ops[x->op].kind != GLSL_FLOW)
        touch_operand(state, &x->to, at);
}

static void extend_operand(struct state *state, const struct glsl_operand *operand, const struct loop *loop,
                           uint32_t end)
{
    struct glsl_temporary *index = operand->access ? leader(state->code, operand->index) : NULL;
    struct glsl_temporary *temporary =
        operand->file == GLSL_FILE_TEMPORARY ? leader(state->code, operand->number) : NULL;
    if (index && index->home < loop->first_region && index->last < end)
        index->last = end;
    if (temporary && temporary->home < loop->first_region && temporary->last < end)
        temporary->last = end;
}

/* At the end of a loop: what it uses from outside lasts to its end. Each instruction is visited once for
 * each loop around it. */
static void extend_loop(struct state *state, const struct loop *loop, uint32_t end)
{
    for (uint32_t i = loop->begin; i < end; i++) {
        const struct glsl_instruction *x = &state->code->instruction[i];
        for (unsigned k = 0; k < glsl_ops[x->op].sources; k++)
            extend_operand(state, &x->from[k], loop, end);
        if (glsl_ops[x->op].kind != GLSL_FLOW)
            extend_operand(state, &x->to, loop, end);
    }
}

static void find_ranges(struct state *state)
{
    struct glsl_code *code = state->code;
    for (uint32_t i = 0; i < code->temporaries; i++)
        code->temporary[i].first = code->temporary[i].last = NEVER;
    for (uint32_t i = 0; i < code->count; i++) {
        const struct glsl_instruction *x = &code->instruction[i];
        if (x->op == GLSL_OP_WHILE)
            state->open[state->depth++] = (struct loop){code->instruction[i + 1].region, i};
        else if (x->op == GLSL_OP_ENDWHILE)
            extend_loop(state, &state->open[--state->depth], i);
        touch_all(state, x, i);
    }
}

/* --- Arrays --------------------------------------------------------------------------------------------- */

/* A block that contains others joins them. */
static void mark_block(struct glsl_code *code, const struct glsl_access *access)
{
    for (uint32_t i = 0; i < access->registers; i++) {
        struct glsl_temporary *temporary = &code->temporary[access->first + i];
        temporary->block = access->first;
        temporary->registers = access->registers;
    }
}

static void mark_operand(struct glsl_code *code, const struct glsl_operand *operand)
{
    if (operand->file == GLSL_FILE_TEMPORARY && operand->access)
        mark_block(code, &code->access[operand->access]);
}

static void mark_blocks(struct glsl_code *code)
{
    if (code->accesses <= 1)
        return;
    for (uint32_t i = 0; i < code->count; i++) {
        const struct glsl_instruction *x = &code->instruction[i];
        mark_operand(code, &x->to);
        for (unsigned k = 0; k < glsl_ops[x->op].sources; k++)
            mark_operand(code, &x->from[k]);
    }
}

/* --- Places --------------------------------------------------------------------------------------------- */

static void make_lists(struct state *state)
{
    struct glsl_code *code = state->code;
    for (uint32_t i = 0; i < code->temporaries; i++) {
        struct glsl_temporary *x = &code->temporary[i];
        if (x->first == NEVER)
            continue;
        state->next_first[i] = state->first[x->first];
        state->first[x->first] = i + 1;
        state->next_last[i] = state->last[x->last];
        state->last[x->last] = i + 1;
    }
}

static bool is_free(const struct state *state, unsigned place)
{
    return !(state->used[place / 64] >> place % 64 & 1);
}

/* The first of `count` consecutive free registers; REGISTERS if there are none. */
static unsigned find_free(const struct state *state, unsigned count)
{
    unsigned run = 0;
    for (unsigned place = 0; place < REGISTERS; place++) {
        if (!(place % 64) && state->used[place / 64] == ~0ull) {
            place += 63;
            run = 0;
            continue;
        }
        run = is_free(state, place) ? run + 1 : 0;
        if (run == count)
            return place + 1 - count;
    }
    return REGISTERS;
}

static void set_used(struct state *state, unsigned place, unsigned count, bool used)
{
    for (unsigned i = place; i < place + count; i++)
        if (used)
            state->used[i / 64] |= 1ull << i % 64;
        else
            state->used[i / 64] &= ~(1ull << i % 64);
}

static unsigned size_of(const struct glsl_temporary *x)
{
    return x->registers ? x->registers : 1;
}

static void begin_ranges(struct state *state, uint32_t at)
{
    for (uint32_t i = state->first[at]; i; i = state->next_first[i - 1]) {
        struct glsl_temporary *x = &state->code->temporary[i - 1];
        unsigned size = size_of(x), place = find_free(state, size);
        if (place == REGISTERS) {
            glsl_code_fail(state->code, "more than 256 vectors of variables that are in use together");
            return;
        }
        x->place = place;
        set_used(state, place, size, true);
        if (state->most < place + size)
            state->most = place + size;
    }
}

/* Ends the ranges that end here, either those that began before or those that begin here. */
static void end_ranges(struct state *state, uint32_t at, bool began_here)
{
    for (uint32_t i = state->last[at]; i; i = state->next_last[i - 1]) {
        const struct glsl_temporary *x = &state->code->temporary[i - 1];
        if ((x->first == at) == began_here)
            set_used(state, x->place, size_of(x), false);
    }
}

/* The registers of an array follow its first one. */
static void place_elements(struct glsl_code *code)
{
    for (uint32_t i = 0; i < code->temporaries; i++) {
        struct glsl_temporary *x = &code->temporary[i];
        if (x->registers && x->block != i)
            x->place = code->temporary[x->block].place + i - x->block;
    }
}

unsigned glsl_code_allocate(struct glsl_code *code)
{
    struct state state = {.code = code};
    mark_blocks(code);
    state.first = glsl_take(code->arena, (code->count + 1) * sizeof *state.first);
    state.last = glsl_take(code->arena, (code->count + 1) * sizeof *state.last);
    state.next_first = glsl_take(code->arena, (code->temporaries + 1) * sizeof *state.next_first);
    state.next_last = glsl_take(code->arena, (code->temporaries + 1) * sizeof *state.next_last);
    find_ranges(&state);
    make_lists(&state);
    for (uint32_t i = 0; i < code->count && !code->failure; i++) {
        bool apart = glsl_ops[code->instruction[i].op].kind == GLSL_APART;
        if (!apart)
            end_ranges(&state, i, false);
        begin_ranges(&state, i);
        if (apart)
            end_ranges(&state, i, false);
        end_ranges(&state, i, true);
    }
    place_elements(code);
    return state.most;
}
