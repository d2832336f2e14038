/* The joiner: lays the parts out one behind the other, copies their bytes and fills their holes.
 *
 * This is all there is to code generation by stitching. Two passes over the plan: the first finds each part's
 * offset and the size of the whole, so that jumps in both directions are known in the second. */
#include "stitch/plan.h"

#include <string.h>

static void fill(uint8_t *code, const struct plan *plan, const struct part *part, const struct hole *hole)
{
    uint32_t at = part->offset + hole->offset;
    int32_t value = part->arguments.value[hole->argument];
    int32_t word;
    switch (hole->kind) {
    case HOLE_WORD:
        memcpy(&word, code + at, sizeof word);
        word = (int32_t)((uint32_t)word + (uint32_t)value);
        memcpy(code + at, &word, sizeof word);
        break;
    case HOLE_BYTE: code[at] = (uint8_t)(code[at] + value); break;
    case HOLE_JUMP:
        word = (int32_t)(plan->part[value].offset - (at + (uint32_t)sizeof word));
        memcpy(code + at, &word, sizeof word);
        break;
    case HOLE_CONSTANTS: {
        const uint8_t *address = stitch_constants;
        memcpy(code + at, &address, sizeof address);
        break;
    }
    }
}

static void copy_part(uint8_t *code, const struct plan *plan, const struct part *part)
{
    const struct fragment *fragment = part->fragment;
    memcpy(code + part->offset, fragment->code, fragment->bytes);
    for (unsigned i = 0; i < fragment->holes; i++)
        fill(code, plan, part, fragment->hole + i);
}

int plan_join(struct plan *plan, struct code_arena *arena, struct code_span *span, struct error *error)
{
    uint32_t bytes = 0;
    if (plan_complete(plan, error))
        return -1;
    for (unsigned i = 0; i < plan->count; i++) {
        plan->part[i].offset = bytes;
        bytes += plan->part[i].fragment->bytes;
    }
    if (code_reserve(arena, bytes, span, error))
        return -1;
    for (unsigned i = 0; i < plan->count; i++)
        copy_part(span->writable, plan, plan->part + i);
    code_commit(arena, span, bytes);
    return 0;
}
