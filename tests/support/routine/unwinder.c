#include "tests/support/routine/unwinder.h"

#include <string.h>

enum { RSP = 7, RETURN_ADDRESS = 16 };

struct reader {
    const uint8_t *at, *end;
    const char *wrong;
};

struct rules {
    uint64_t location;
    unsigned cfa_register;
    uint64_t cfa_offset;
    int saved[UNWINDER_REGISTERS]; /* 1: in memory at the frame's address + offset */
    int64_t offset[UNWINDER_REGISTERS];
};

static uint64_t number(struct reader *r, unsigned bytes)
{
    uint64_t value = 0;
    if ((size_t)(r->end - r->at) < bytes) {
        r->wrong = "the information ends too early";
        r->at = r->end;
        return 0;
    }
    memcpy(&value, r->at, bytes);
    r->at += bytes;
    return value;
}

static uint64_t unsigned_leb(struct reader *r)
{
    uint64_t value = 0, byte;
    unsigned shift = 0;
    do {
        byte = number(r, 1);
        value |= (byte & 0x7f) << shift;
        shift += 7;
    } while (byte & 0x80 && shift < 63);
    return value;
}

static int64_t signed_leb(struct reader *r)
{
    uint64_t value = 0, byte;
    unsigned shift = 0;
    do {
        byte = number(r, 1);
        value |= (byte & 0x7f) << shift;
        shift += 7;
    } while (byte & 0x80 && shift < 63);
    return (int64_t)(byte & 0x40 ? value | ~0ull << shift : value);
}

static unsigned reg(struct reader *r, uint64_t n)
{
    if (n >= UNWINDER_REGISTERS)
        r->wrong = "a register that there is not";
    return n < UNWINDER_REGISTERS ? (unsigned)n : 0;
}

/* Executes the instructions up to the row of `at`. */
static void run(struct reader *r, struct rules *rules, uint64_t at, uint64_t code_factor, int64_t data_factor)
{
    while (r->at < r->end && !r->wrong) {
        uint8_t instruction = (uint8_t)number(r, 1), low = instruction & 0x3f;
        uint64_t advance = 0;
        unsigned n;
        switch (instruction >> 6 ? instruction & 0xc0 : instruction) {
        case 0x40: advance = low * code_factor; break;
        case 0x02: advance = number(r, 1) * code_factor; break;
        case 0x03: advance = number(r, 2) * code_factor; break;
        case 0x04: advance = number(r, 4) * code_factor; break;
        case 0x80:
            n = reg(r, low);
            rules->saved[n] = 1;
            rules->offset[n] = (int64_t)unsigned_leb(r) * data_factor;
            break;
        case 0x08: rules->saved[reg(r, unsigned_leb(r))] = 0; break;
        case 0x0c:
            rules->cfa_register = reg(r, unsigned_leb(r));
            rules->cfa_offset = unsigned_leb(r);
            break;
        case 0x00: break;
        default: r->wrong = "an instruction that this does not know"; break;
        }
        if (advance && rules->location + advance > at)
            return;
        rules->location += advance;
    }
}

/* Memory below the stack pointer may be overwritten, so no saved register may be there. */
static const char *apply(const struct rules *rules, const uint64_t value[UNWINDER_REGISTERS],
                         struct unwinder_frame *caller)
{
    caller->cfa = value[rules->cfa_register] + rules->cfa_offset;
    memcpy(caller->value, value, sizeof caller->value);
    for (int i = 0; i < UNWINDER_REGISTERS; i++) {
        uint64_t place = caller->cfa + (uint64_t)rules->offset[i];
        if (!rules->saved[i])
            continue;
        if (place < value[RSP])
            return "a register is saved below the stack pointer";
        memcpy(&caller->value[i], (const void *)(uintptr_t)place, sizeof place);
    }
    caller->value[RSP] = caller->cfa;
    return NULL;
}

/* A common entry, the routine's own, a zero. */
const char *unwinder_step(const uint8_t *information, size_t bytes, uint64_t at,
                          const uint64_t value[UNWINDER_REGISTERS], struct unwinder_frame *caller)
{
    struct reader r = {information, information + bytes, NULL};
    struct rules rules = {0};
    uint64_t length = number(&r, 4);
    struct reader common = {r.at, r.at + length, NULL};
    if (length > bytes - 4 || number(&common, 4) != 0 || number(&common, 1) != 1 || number(&common, 1) != 0)
        return "the first entry is not a common one of version 1 without augmentation";
    uint64_t code_factor = unsigned_leb(&common);
    int64_t data_factor = signed_leb(&common);
    if (number(&common, 1) != RETURN_ADDRESS)
        return "the return address is not register 16";
    run(&common, &rules, UINT64_MAX, code_factor, data_factor);
    r.at += length;
    length = number(&r, 4);
    if (length > (size_t)(r.end - r.at))
        return "the routine's entry is longer than all";
    struct reader own = {r.at, r.at + length, NULL};
    if (number(&own, 4) != (uint64_t)(r.at - information))
        return "the routine's entry does not have the offset of the common one";
    rules.location = number(&own, 8);
    uint64_t size = number(&own, 8);
    if (at - rules.location >= size)
        return "the address is not the routine's";
    run(&own, &rules, at, code_factor, data_factor);
    r.at += length;
    if (number(&r, 4) != 0 || r.at != r.end)
        return "no zero at the end";
    const char *wrong = common.wrong ? common.wrong : own.wrong;
    return wrong ? wrong : apply(&rules, value, caller);
}
