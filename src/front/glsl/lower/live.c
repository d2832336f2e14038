/* Removal of instructions without an effect, from the last to the first.
 *
 * A component is live if a later instruction can read it. A write ends this only in the home region of the
 * register, where no path goes around it. At the end of a loop, everything is live that the loop reads of
 * registers from outside, because the next pass reads it. */
#include "front/glsl/lower/code.h"

#include <string.h>

struct read {
    uint32_t temporary;
    uint8_t mask;
};

struct loop {
    uint32_t first_region; /* of its body */
    struct read *read;
    uint32_t reads, room;
};

struct state {
    struct glsl_code *code;
    struct loop *loop;                                /* in the order of their beginnings */
    unsigned loops, open[GLSL_MOST_LOOPS + 1], depth; /* `open`: those around the instruction */
};

/* The components that a source reads. */
static unsigned read_mask(const struct glsl_instruction *x, unsigned source)
{
    unsigned swizzle = x->from[source].swizzle, wanted, result = 0;
    switch ((enum glsl_op)x->op) {
    case GLSL_OP_DP2: wanted = source == 2 ? 1 : 3; break;
    case GLSL_OP_DP3:
    case GLSL_OP_CRS: wanted = 7; break;
    case GLSL_OP_DP4:
    case GLSL_OP_TEXLD:
    case GLSL_OP_TEXLDP:
    case GLSL_OP_TEXLDB:
    case GLSL_OP_TEXLDL:
    case GLSL_OP_TEXLDD: wanted = 15; break;
    default: wanted = glsl_ops[x->op].kind == GLSL_EACH ? x->mask : 1;
    }
    for (unsigned c = 0; c < 4; c++)
        if (wanted >> c & 1)
            result |= 1u << glsl_component(swizzle, c);
    return result;
}

/* Calls `note` for each temporary that an operand means. */
typedef void note(struct state *state, uint32_t temporary, unsigned mask);

static void note_operand(struct state *state, const struct glsl_operand *operand, unsigned mask, note *to)
{
    if (operand->access)
        to(state, operand->index, 1u << operand->index_component);
    if (operand->file != GLSL_FILE_TEMPORARY || !mask)
        return;
    if (!operand->access) {
        to(state, operand->number, mask);
        return;
    }
    const struct glsl_access *access = &state->code->access[operand->access];
    for (uint32_t i = 0; i < access->registers; i++)
        to(state, access->first + i, mask);
}

static void note_sources(struct state *state, const struct glsl_instruction *x, note *to)
{
    for (unsigned i = 0; i < glsl_ops[x->op].sources; i++)
        note_operand(state, &x->from[i], read_mask(x, i), to);
    if (x->to.access)
        note_operand(state, &x->to, 0, to);
}

/* --- Reads of loops ------------------------------------------------------------------------------------- */

static void add_read(struct state *state, struct loop *loop, uint32_t temporary, unsigned mask)
{
    if (loop->reads == loop->room) {
        struct read *old = loop->read;
        loop->room = loop->room ? 2 * loop->room : 32;
        loop->read = glsl_take(state->code->arena, loop->room * sizeof *old);
        if (loop->reads)
            memcpy(loop->read, old, loop->reads * sizeof *old);
    }
    loop->read[loop->reads++] = (struct read){temporary, (uint8_t)mask};
}

static void note_in_loops(struct state *state, uint32_t temporary, unsigned mask)
{
    uint32_t home = state->code->temporary[temporary].home;
    for (unsigned i = state->depth; i-- > 0;) {
        struct loop *loop = &state->loop[state->open[i]];
        if (home >= loop->first_region)
            return;
        add_read(state, loop, temporary, mask);
    }
}

/* Regions are numbered in order, so those of a loop's body are consecutive, and begin with that of its first
 * instruction, which is an instruction of the loop's condition or of its body. */
static void collect_loops(struct state *state)
{
    struct glsl_code *code = state->code;
    unsigned count = 0;
    for (uint32_t i = 0; i < code->count; i++)
        count += code->instruction[i].op == GLSL_OP_WHILE;
    state->loop = glsl_take(code->arena, (count + 1) * sizeof *state->loop);
    for (uint32_t i = 0; i < code->count; i++) {
        const struct glsl_instruction *x = &code->instruction[i];
        if (x->op == GLSL_OP_WHILE) {
            state->open[state->depth++] = state->loops;
            state->loop[state->loops++].first_region = code->instruction[i + 1].region;
        } else if (x->op == GLSL_OP_ENDWHILE) {
            code->instruction[i].to.number = state->open[--state->depth];
        }
        note_sources(state, x, note_in_loops);
    }
}

/* --- From the last to the first ------------------------------------------------------------------------- */

static void note_live(struct state *state, uint32_t temporary, unsigned mask)
{
    state->code->temporary[temporary].live |= (uint8_t)mask;
}

static bool has_effect(struct state *state, struct glsl_instruction *x)
{
    const uint8_t *needed = state->code->needed;
    if (x->to.file == GLSL_FILE_VARYING && needed)
        return x->mask &= needed[x->to.number];
    if (x->to.file != GLSL_FILE_TEMPORARY)
        return true;
    if (!x->to.access)
        return state->code->temporary[x->to.number].live & x->mask;
    const struct glsl_access *access = &state->code->access[x->to.access];
    for (uint32_t i = 0; i < access->registers; i++)
        if (state->code->temporary[access->first + i].live & x->mask)
            return true;
    return false;
}

static bool visit_result(struct state *state, struct glsl_instruction *x)
{
    if (!x->mask || !has_effect(state, x)) {
        x->mask = 0;
        return false;
    }
    if (x->to.file != GLSL_FILE_TEMPORARY || x->to.access)
        return true;
    struct glsl_temporary *temporary = &state->code->temporary[x->to.number];
    x->mask &= temporary->live;
    if (temporary->home == x->region)
        temporary->live &= (uint8_t)~x->mask;
    return true;
}

/* An `if` without a body is removed: its instructions get the op MOV and no mask. */
static void remove_block(struct glsl_code *code, uint32_t from)
{
    unsigned depth = 0;
    for (uint32_t i = from; i < code->count; i++) {
        struct glsl_instruction *x = &code->instruction[i];
        depth += x->op == GLSL_OP_IF;
        depth -= x->op == GLSL_OP_ENDIF;
        bool end = x->op == GLSL_OP_ENDIF && !depth;
        x->op = GLSL_OP_MOV;
        x->mask = 0;
        if (end)
            return;
    }
}

static void end_loop(struct state *state, const struct loop *loop)
{
    for (uint32_t i = 0; i < loop->reads; i++)
        note_live(state, loop->read[i].temporary, loop->read[i].mask);
}

/* `kept` counts the instructions of each open block; depth 0 is outside of all. */
static void visit_flow(struct state *state, uint32_t i, uint32_t *kept, unsigned *depth)
{
    struct glsl_instruction *x = &state->code->instruction[i];
    switch ((enum glsl_op)x->op) {
    case GLSL_OP_ENDWHILE: end_loop(state, &state->loop[x->to.number]); /* fall through */
    case GLSL_OP_ENDIF: kept[++*depth] = 0; return;
    case GLSL_OP_ELSE: return;
    case GLSL_OP_IF:
        if (!kept[(*depth)--]) {
            remove_block(state->code, i);
            return;
        }
        break;
    case GLSL_OP_WHILE: --*depth; break;
    default: break;
    }
    kept[*depth]++;
    note_sources(state, x, note_live);
}

static void visit_all(struct state *state)
{
    struct glsl_code *code = state->code;
    unsigned depth = 0;
    uint32_t kept[GLSL_MOST_BLOCKS + 2] = {0};
    for (uint32_t i = code->count; i-- > 0;) {
        struct glsl_instruction *x = &code->instruction[i];
        if (glsl_ops[x->op].kind == GLSL_FLOW) {
            visit_flow(state, i, kept, &depth);
        } else if (visit_result(state, x)) {
            kept[depth]++;
            note_sources(state, x, note_live);
        }
    }
}

static bool remove_marked(struct glsl_code *code)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < code->count; i++)
        if (code->instruction[i].mask || glsl_ops[code->instruction[i].op].kind == GLSL_FLOW)
            code->instruction[kept++] = code->instruction[i];
    bool removed = kept < code->count;
    code->count = kept;
    return removed;
}

void glsl_code_remove_dead(struct glsl_code *code)
{
    bool again = true;
    for (unsigned pass = 0; pass < 2 && again; pass++) {
        struct state state = {.code = code};
        for (uint32_t i = 0; i < code->temporaries; i++)
            code->temporary[i].live = 0;
        collect_loops(&state);
        visit_all(&state);
        again = remove_marked(code) && code->has_loop;
    }
}
