/* The joiner: lays the parts out one after the other, copies their bytes and fills their holes.
 *
 * This is the complete code generation of stitching. The first pass over the plan finds the offset of each
 * part and the total size, so that the second pass can fill in the targets of jumps in both directions. */
#include "engines/stitch/plan.h"

#include <string.h>

enum { LITERAL_BYTES = SLOT_BYTES, INT3 = 0xcc };

/* The longest instruction with a three-byte prefix, and some room. */
enum { PLAIN_BYTES = 16 };

/* The roles: bits 0-1 are the argument of ModRM.reg (3: none), 2-4 of VEX.vvvv, 5-7 of ModRM.rm (4 to 7:
 * none). The prefix has its bits inverted, so exclusive or is correct for both parts of a number. */
static uint32_t vector_bits(const union arguments *arguments, unsigned roles)
{
    const int32_t *value = arguments->value;
    unsigned first = roles & 3, second = roles >> 2 & 7, third = roles >> 5;
    uint32_t reg = first == 3 ? 0 : (uint32_t)value[first];
    uint32_t vvvv = second > 3 ? 0 : (uint32_t)value[second];
    uint32_t rm = third > 3 ? 0 : (uint32_t)value[third];
    return (reg & 7) << 27 | (reg & 8) << 4 | vvvv << 11 | (rm & 7) << 24 | (rm & 8) << 2;
}

static void flip_vectors(uint8_t *at, const union arguments *arguments, unsigned roles)
{
    uint32_t word;
    memcpy(&word, at, sizeof word);
    word ^= vector_bits(arguments, roles);
    memcpy(at, &word, sizeof word);
}

/* Replaces the number of rsp by another general-purpose register, in the SIB byte and inverted in the
 * prefix. */
static void fill_address(uint8_t *at, int32_t displacement, uint32_t base)
{
    memcpy(at, &displacement, sizeof displacement);
    base ^= REGISTER_FRAME;
    at[-1] ^= (uint8_t)(base & 7);
    at[-5] ^= (uint8_t)((base & 8) << 2);
}

static void fill(uint8_t *code, const struct plan *plan, const struct part *part, const struct hole *hole)
{
    uint32_t at = part->offset + hole->offset;
    int32_t value = part->arguments.value[hole->argument % ARGUMENT_COUNT];
    int32_t word;
    if (hole->kind == HOLE_WORD) { /* the most frequent kind */
        memcpy(&word, code + at, sizeof word);
        word = (int32_t)((uint32_t)word + (uint32_t)value);
        memcpy(code + at, &word, sizeof word);
        return;
    }
    switch (hole->kind) {
    case HOLE_BYTE: code[at] = (uint8_t)(code[at] + value); break;
    case HOLE_JUMP:
        word = (int32_t)(plan->part[value].offset - (at + (uint32_t)sizeof word));
        memcpy(code + at, &word, sizeof word);
        break;
    case HOLE_VECTOR: flip_vectors(code + at, &part->arguments, hole->argument); break;
    case HOLE_ADDRESS: fill_address(code + at, value, (uint32_t)part->arguments.value[ARGUMENT_BASE]); break;
    case HOLE_INDEX:
        code[at] ^= (uint8_t)((value & 8) << 3);
        code[at + 4] ^= (uint8_t)((value & 7) << 3);
        break;
    case HOLE_MASK: code[at] ^= (uint8_t)(value << 4); break;
    case HOLE_LITERALS:
        word = (int32_t)(plan->literals_offset - (at + (uint32_t)sizeof word));
        memcpy(code + at, &word, sizeof word);
        break;
    case HOLE_CONSTANTS: {
        const uint8_t *address = stitch_constants;
        memcpy(code + at, &address, sizeof address);
        break;
    }
    }
}

/* Returns true for one instruction with only a register hole and optionally an address hole, the most
 * frequent kind in operation plans. */
static bool is_plain(const struct fragment *fragment)
{
    return fragment->hole->kind == HOLE_VECTOR && fragment->holes == 1u + fragment->based &&
           fragment->bytes <= PLAIN_BYTES;
}

/* Does the same as fill() on two words before they are stored. Bytes after the fragment are overwritten by
 * the next part. */
static void copy_plain(uint8_t *code, const struct part *part)
{
    const struct fragment *fragment = part->fragment;
    uint64_t word[2];
    memcpy(word, fragment->code, sizeof word);
    word[0] ^= (uint64_t)vector_bits(&part->arguments, fragment->hole->argument) << 8;
    if (fragment->based) {
        uint32_t displacement = (uint32_t)part->arguments.value[fragment->hole[1].argument];
        uint64_t base = (uint64_t)part->arguments.value[ARGUMENT_BASE] ^ REGISTER_FRAME;
        word[0] ^= (base & 7) << 40 | (base & 8) << 10 | (uint64_t)displacement << 48;
        word[1] ^= displacement >> 16;
    }
    memcpy(code, word, sizeof word);
}

static void copy_part(uint8_t *code, const struct plan *plan, const struct part *part)
{
    const struct fragment *fragment = part->fragment;
    if (fragment->given | fragment->read && is_plain(fragment)) {
        copy_plain(code + part->offset, part);
        return;
    }
    memcpy(code + part->offset, fragment->code, fragment->bytes);
    for (unsigned i = 0; i < fragment->holes; i++)
        fill(code, plan, part, fragment->hole + i);
}

static void write_literals(uint8_t *to, const struct plan *plan)
{
    for (unsigned i = 0; i < plan->literals; i++)
        for (unsigned lane = 0; lane < LITERAL_BYTES / 4; lane++, to += 4)
            memcpy(to, &plan->literal[i], 4);
}

/* Sets the offset of each part, then of the literals, which begin at a cache line. */
static void lay_out(struct plan *plan)
{
    uint32_t bytes = 0;
    for (unsigned i = 0; i < plan->count; i++) {
        plan->part[i].offset = bytes;
        bytes += plan->part[i].fragment->bytes;
    }
    plan->code_bytes = bytes;
    plan->literals_offset = (bytes + CODE_ALIGNMENT - 1) & ~(CODE_ALIGNMENT - 1u);
    plan->bytes = plan->literals ? plan->literals_offset + plan->literals * LITERAL_BYTES : bytes;
}

int plan_lay_out(struct plan *plan, struct error *error)
{
    if (plan_complete(plan, error))
        return -1;
    lay_out(plan);
    if (plan->bytes > ROUTINE_BYTES_MAXIMUM)
        return error_set(error, "the routine's code is %u bytes, expected at most %d", plan->bytes,
                         ROUTINE_BYTES_MAXIMUM);
    return 0;
}

int plan_join(struct plan *plan, struct code_arena *arena, struct code_span *span, struct error *error)
{
    if (plan_lay_out(plan, error))
        return -1;
    if (code_reserve(arena, plan->bytes, span, error))
        return -1;
    for (unsigned i = 0; i < plan->count; i++)
        copy_part(span->writable, plan, plan->part + i);
    if (plan->literals) {
        memset(span->writable + plan->code_bytes, INT3, plan->literals_offset - plan->code_bytes);
        write_literals(span->writable + plan->literals_offset, plan);
    }
    code_commit(arena, span, plan->bytes);
    return 0;
}
