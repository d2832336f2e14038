/* Flow control: nested blocks, loops, subroutines, and divergence (neighbouring pixels on different paths).
 *
 * The main program is first and ends with ret, or with the text if there are no subroutines. Each subroutine
 * extends from its label to its ret. Calls are forward only, so there is no recursion. A walk over the labels
 * from the last to the first finds the nesting of calls, and the components that a call can write. */
#include "shader/check/check.h"

#include <stdlib.h>
#include <string.h>

/* Returns true if the branch depends on computed values. */
static bool is_computed(const struct shader_instruction *instruction)
{
    switch (instruction->opcode) {
    case SHADER_IF: return instruction->source[0].file == FILE_PREDICATE;
    case SHADER_CALLNZ: return instruction->source[1].file == FILE_PREDICATE;
    case SHADER_IF_COMPARE:
    case SHADER_BREAK_COMPARE:
    case SHADER_BREAKP: return true;
    default: return false;
    }
}

/* --- Subroutines --------------------------------------------------------------------------------------- */

static void add_written(struct written *to, const struct written *from)
{
    uint8_t *into = (uint8_t *)to;
    const uint8_t *more = (const uint8_t *)from;
    for (size_t i = 0; i < sizeof *to; i++)
        into[i] |= more[i];
}

/* One more than the highest label that the model has. */
static unsigned label_count(const struct check *check)
{
    unsigned count = 0, limit = shader_register_count(FILE_LABEL, check->model);
    for (uint32_t i = 0; i < check->shader->count; i++) {
        const struct shader_instruction *instruction = &check->shader->instructions[i];
        unsigned label = instruction->source[0].index;
        if (instruction->opcode == SHADER_LABEL && label < limit && label >= count)
            count = label + 1;
    }
    return count;
}

/* Finds the labels. The pass itself refuses repeated labels and numbers out of range. */
static void find_labels(struct check *check)
{
    for (unsigned i = 0; i < check->labels; i++)
        check->subroutines[i].position = UINT32_MAX;
    for (uint32_t i = check->shader->count; i-- > 0;) {
        const struct shader_instruction *instruction = &check->shader->instructions[i];
        unsigned label = instruction->source[0].index;
        if (instruction->opcode == SHADER_LABEL && label < check->labels)
            check->subroutines[label].position = i;
    }
}

/* From the last instruction to the first: instructions between a label and the next one belong to the label.
 */
static void sum_up_subroutines(struct check *check)
{
    struct subroutine body = {.depth = 1};
    for (uint32_t i = check->shader->count; i-- > 0;) {
        const struct shader_instruction *instruction = &check->shader->instructions[i];
        unsigned label = instruction->source[0].index;
        check_note_written(&body.written, instruction);
        if (is_call(instruction->opcode) && label < check->labels &&
            check->subroutines[label].position != UINT32_MAX && check->subroutines[label].position > i) {
            const struct subroutine *called = &check->subroutines[label];
            add_written(&body.written, &called->written);
            if (called->depth >= body.depth)
                body.depth = (uint16_t)(called->depth + 1);
        } else if (instruction->opcode == SHADER_LABEL && label < check->labels) {
            check->subroutines[label].written = body.written;
            check->subroutines[label].depth = body.depth;
            body = (struct subroutine){.depth = 1};
        }
    }
}

int check_flow_begin(struct check *check)
{
    unsigned labels = label_count(check);
    check->labels = labels > check->labels ? labels : check->labels;
    if (!check->labels)
        return 0;
    check->subroutines = calloc(check->labels, sizeof *check->subroutines);
    if (!check->subroutines)
        return error_set(check->error, "%s: not enough memory to validate it", check->shader->path);
    find_labels(check);
    sum_up_subroutines(check);
    return 0;
}

static int check_call(struct check *check)
{
    const struct shader_operand *label = &check->at->source[0];
    struct subroutine *called = label->index < check->labels ? &check->subroutines[label->index] : NULL;
    uint32_t position = (uint32_t)(check->at - check->shader->instructions);
    if (!called || called->position == UINT32_MAX)
        return REFUSE(check, label, "found a call of l%u, expected a label l%u", label->index, label->index);
    if (called->position < position)
        return REFUSE(check, label, "found a call of l%u after its label, expected calls forward only",
                      label->index);
    if (!check->inside && called->depth > check->model->calls)
        return REFUSE(check, label, "found calls %u deep, expected at most %u in %s", called->depth,
                      check->model->calls, check->model->name);
    if (is_computed(check->at) && check->dynamic >= check->model->dynamic)
        return REFUSE(check, NULL,
                      "found a conditional call %u computed conditions deep, expected at most %u",
                      check->dynamic + 1, check->model->dynamic);
    called->divergent |= is_computed(check->at) || check_is_divergent(check);
    add_written(&check->written, &called->written);
    return 0;
}

static int check_label(struct check *check)
{
    const struct shader_operand *label = &check->at->source[0];
    struct subroutine *subroutine = &check->subroutines[label->index];
    if (!check->ended)
        return REFUSE(check, NULL, "found a label, expected ret before it");
    if (check->shader->instructions + subroutine->position != check->at)
        return REFUSE(check, label, "found another label l%u, expected each once", label->index);
    check->ended = false;
    check->inside = subroutine;
    return 0;
}

/* --- Blocks -------------------------------------------------------------------------------------------- */

/* Returns true if some pixels may leave the loop that the current instruction begins before others: it has a
 * break by comparison or predicate, or a break inside an if of that kind. */
static bool parts_in_loop(const struct check *check)
{
    const struct shader_instruction *end = check->shader->instructions + check->shader->count;
    unsigned depth = 0, inside = 0; /* of loops; of blocks since a computed if */
    for (const struct shader_instruction *i = check->at; i < end; i++) {
        switch (i->opcode) {
        case SHADER_LOOP:
        case SHADER_REP:
        case SHADER_WHILE: depth++; break;
        case SHADER_ENDLOOP:
        case SHADER_ENDREP:
        case SHADER_ENDWHILE:
            if (--depth == 0)
                return false;
            break;
        case SHADER_IF:
        case SHADER_IF_COMPARE: inside += inside || is_computed(i); break;
        case SHADER_ENDIF: inside -= inside > 0; break;
        case SHADER_BREAK:
            if (inside)
                return true;
            break;
        case SHADER_BREAK_COMPARE:
        case SHADER_BREAKP: return true;
        }
    }
    return false;
}

static int refuse_depth(struct check *check, const char *what, unsigned limit)
{
    return REFUSE(check, NULL, "found %s %u deep, expected at most %u in %s", what, limit + 1, limit,
                  check->model->name);
}

static int open_block(struct check *check)
{
    bool loops = !is_if(check->at->opcode), computed = is_computed(check->at);
    unsigned limit = loops ? check->model->loops : computed ? check->model->dynamic : check->model->branches;
    unsigned *depth = loops ? &check->loops : computed ? &check->dynamic : &check->branches;
    if (*depth == limit)
        return refuse_depth(check, loops ? "loops" : computed ? "computed conditions" : "conditions", limit);
    struct block *block = &check->blocks[check->block_count++];
    *block = (struct block){.opcode = check->at->opcode,
                            .dynamic = loops ? parts_in_loop(check) : computed,
                            .opened = (uint32_t)(check->at - check->shader->instructions)};
    ++*depth;
    return 0;
}

static void close_block(struct check *check)
{
    const struct block *block = &check->blocks[--check->block_count];
    if (!is_if(block->opcode))
        check->loops--;
    else if (block->dynamic)
        check->dynamic--;
    else
        check->branches--;
}

/* The innermost block, if one of these opened it. */
static struct block *innermost(struct check *check, unsigned first, unsigned second)
{
    struct block *block = check->block_count ? &check->blocks[check->block_count - 1] : NULL;
    return block && (block->opcode == first || block->opcode == second) ? block : NULL;
}

static int end_block(struct check *check, unsigned first, unsigned second, const char *begins)
{
    struct block *block = innermost(check, first, second);
    if (!block)
        return REFUSE(check, NULL, "found %s, expected %s before it in the same block", check->row->name,
                      begins);
    if (check->at->opcode == SHADER_ELSE) {
        if (block->has_else)
            return REFUSE(check, NULL, "found another else, expected endif");
        block->has_else = true;
        return 0;
    }
    close_block(check);
    return 0;
}

static int check_break(struct check *check)
{
    if (!check->loops)
        return REFUSE(check, NULL, "found %s outside a loop, expected it inside %s", check->row->name,
                      shader_is_opengl(check->model) ? "loop, rep or while" : "loop or rep");
    if (check->at->opcode == SHADER_BREAK_COMPARE && check->dynamic >= check->model->dynamic)
        return refuse_depth(check, "computed conditions", check->model->dynamic);
    return 0;
}

static int check_return(struct check *check)
{
    if (check->block_count && shader_is_opengl(check->model))
        return 0;
    if (check->block_count)
        return REFUSE(check, NULL, "found ret inside a block, expected the block's end before it");
    check->ended = true;
    return 0;
}

/* --- For the other parts ------------------------------------------------------------------------------- */

bool check_is_divergent(const struct check *check)
{
    for (unsigned i = 0; i < check->block_count; i++)
        if (check->blocks[i].dynamic)
            return true;
    return check->inside && check->inside->divergent;
}

/* The integers of a loop, if the shader defines them. */
static int check_counts(struct check *check, const struct shader_operand *integer)
{
    for (const struct shader_instruction *i = check->shader->instructions;
         shader_operations[i->opcode].flags & IS_SETUP; i++) {
        if (i->opcode != SHADER_DEFI || i->destination.index != integer->index)
            continue;
        int32_t count = (int32_t)i->literal[0], start = (int32_t)i->literal[1], step = (int32_t)i->literal[2];
        if (check->model->capabilities & CAN_SOFTWARE)
            return 0;
        if (shader_is_opengl(check->model))
            return count >= 0 && count <= CHECK_PASSES
                       ? 0
                       : REFUSE(check, integer, "found a loop of %d times, expected 0 to %d", count,
                                CHECK_PASSES);
        if (count < 0 || count > 255)
            return REFUSE(check, integer, "found a loop of %d times, expected 0 to 255", count);
        if (check->at->opcode == SHADER_LOOP && (start < 0 || start > 255))
            return REFUSE(check, integer, "found a loop from %d, expected 0 to 255", start);
        if (check->at->opcode == SHADER_LOOP && (step < -128 || step > 127))
            return REFUSE(check, integer, "found a loop by steps of %d, expected -128 to 127", step);
        return 0;
    }
    return 0;
}

static bool counts_as_static(const struct check *check)
{
    switch (check->at->opcode) {
    case SHADER_IF:
    case SHADER_CALLNZ: return !is_computed(check->at);
    case SHADER_ELSE: return check->block_count && !check->blocks[check->block_count - 1].dynamic;
    case SHADER_LOOP:
    case SHADER_REP:
    case SHADER_WHILE:
    case SHADER_CALL: return true;
    default: return false;
    }
}

static int check_kind(struct check *check)
{
    switch (check->at->opcode) {
    case SHADER_IF:
    case SHADER_IF_COMPARE:
    case SHADER_WHILE: return open_block(check);
    case SHADER_LOOP: return check_counts(check, &check->at->source[1]) ? -1 : open_block(check);
    case SHADER_REP: return check_counts(check, &check->at->source[0]) ? -1 : open_block(check);
    case SHADER_ELSE:
    case SHADER_ENDIF: return end_block(check, SHADER_IF, SHADER_IF_COMPARE, "if");
    case SHADER_ENDLOOP: return end_block(check, SHADER_LOOP, SHADER_LOOP, "loop");
    case SHADER_ENDREP: return end_block(check, SHADER_REP, SHADER_REP, "rep");
    case SHADER_ENDWHILE: return end_block(check, SHADER_WHILE, SHADER_WHILE, "while");
    case SHADER_CONTINUE:
    case SHADER_BREAK:
    case SHADER_BREAK_COMPARE:
    case SHADER_BREAKP: return check_break(check);
    case SHADER_CALL:
    case SHADER_CALLNZ: return check_call(check);
    case SHADER_LABEL: return check_label(check);
    case SHADER_RET: return check_return(check);
    default: return 0;
    }
}

int check_flow(struct check *check)
{
    if (check->ended && check->at->opcode != SHADER_LABEL)
        return REFUSE(check, NULL, "found %s after ret, expected a label", check->row->name);
    if (!(check->row->flags & IS_FLOW))
        return 0;
    if (!check->model->loops || (check->row->flags & IS_DYNAMIC && !check->model->dynamic))
        return REFUSE(check, NULL, "found %s, which %s does not have", check->row->name, check->model->name);
    if (counts_as_static(check) && ++check->flow > check->model->flow && check->model->flow)
        return REFUSE(check, NULL, "found %u instructions of static flow control, expected at most %u in %s",
                      check->flow, check->model->flow, check->model->name);
    return check_kind(check);
}

int check_flow_end(struct check *check)
{
    if (check->block_count) {
        check->at = &check->shader->instructions[check->blocks[check->block_count - 1].opened];
        return REFUSE(check, NULL, "found %s without its end, expected %s before the block around it ends",
                      shader_operations[check->at->opcode].name,
                      is_if(check->at->opcode)            ? "endif"
                      : check->at->opcode == SHADER_LOOP  ? "endloop"
                      : check->at->opcode == SHADER_WHILE ? "endwhile"
                                                          : "endrep");
    }
    if (check->inside && !check->ended)
        return REFUSE(check, NULL, "found the end of the shader in a subroutine, expected ret");
    return 0;
}
