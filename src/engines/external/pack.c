#include "engines/external/pack.h"

#include <string.h>

static bool is_packed(const struct ir_instruction *instruction)
{
    return ir_properties(instruction) & IR_COMPUTES || instruction->op == IR_copy ||
           instruction->op == IR_permute;
}

static bool are_alike(const struct ir *ir, const struct lanes *lanes, uint32_t a, uint32_t b)
{
    const struct ir_instruction *x = &ir->instruction[a], *y = &ir->instruction[b];
    bool alike = x->op == y->op && x->type == y->type && x->k == y->k && x->file == y->file &&
                 x->line == y->line && lanes->group[a] == lanes->group[b] &&
                 ir_step_of(ir, x->origin) == ir_step_of(ir, y->origin);
    for (unsigned o = 0; alike && o < ir_operands(x); o++)
        alike = ir->instruction[x->operand[o]].type == ir->instruction[y->operand[o]].type;
    return alike;
}

/* Returns true if instruction `from` needs a member of the pack before it can execute. */
static bool depends(const struct ir *ir, const struct lanes *lanes, struct packs *packs, uint32_t from,
                    uint16_t pack)
{
    uint32_t count = 0;
    const uint32_t stamp = ++packs->stamp;
    packs->work[count++] = (uint16_t)from;
    while (count) {
        const struct ir_instruction *i = &ir->instruction[packs->work[--count]];
        for (unsigned o = 0; o < ir_operands(i); o++) {
            uint16_t operand = i->operand[o], first = packs->pack[operand];
            if (lanes->group[operand] != lanes->group[from] || packs->seen[operand] == stamp)
                continue;
            if (first && first == pack)
                return true;
            for (int l = 0; l < PACK_LANES; l++) {
                uint16_t member = first ? packs->member[first][l] : l ? 0 : operand;
                if (member && packs->seen[member] != stamp) {
                    packs->seen[member] = stamp;
                    packs->work[count++] = member;
                }
            }
        }
    }
    return false;
}

/* The lane that an operand suggests: its own, or that of a word in a row of four. */
static int wish(const struct ir *ir, const struct packs *packs, uint16_t operand)
{
    const struct ir_instruction *i = &ir->instruction[operand];
    if (packs->pack[operand])
        return packs->lane[operand];
    return i->op == IR_uniform && i->base == BASE_CONSTANT ? i->k / 4 % PACK_LANES : -1;
}

static int choose_lane(const struct ir *ir, const struct packs *packs, uint32_t number, uint16_t pack)
{
    const struct ir_instruction *i = &ir->instruction[number];
    for (unsigned o = 0; o < ir_operands(i); o++) {
        int lane = wish(ir, packs, i->operand[o]);
        if (lane >= 0 && !packs->member[pack][lane])
            return lane;
    }
    for (int lane = 0; lane < PACK_LANES; lane++)
        if (!packs->member[pack][lane])
            return lane;
    return -1;
}

static void join(const struct ir *ir, struct packs *packs, uint32_t number, uint16_t pack)
{
    int lane = choose_lane(ir, packs, number, pack);
    packs->pack[number] = pack;
    packs->lane[number] = (uint8_t)lane;
    packs->member[pack][lane] = (uint16_t)number;
}

static bool has_room(const struct packs *packs, uint16_t pack)
{
    for (int lane = 0; lane < PACK_LANES; lane++)
        if (!packs->member[pack][lane])
            return true;
    return false;
}

/* The newest open pack that the instruction can join; else one of its own. */
static uint16_t find_pack(const struct ir *ir, const struct lanes *lanes, struct packs *packs,
                          uint32_t number)
{
    for (uint32_t n = 1; n <= PACK_OPEN && n <= packs->opened; n++) {
        uint16_t pack = packs->open[(packs->opened - n) % PACK_OPEN];
        if (has_room(packs, pack) && are_alike(ir, lanes, number, pack) &&
            !depends(ir, lanes, packs, number, pack))
            return pack;
    }
    memset(packs->member[number], 0, sizeof packs->member[number]);
    packs->open[packs->opened++ % PACK_OPEN] = (uint16_t)number;
    return (uint16_t)number;
}

void external_pack(const struct ir *ir, const struct lanes *lanes, struct packs *packs)
{
    memset(packs->pack, 0, ir->count * sizeof *packs->pack);
    memset(packs->lane, 0, ir->count * sizeof *packs->lane);
    memset(packs->seen, 0, ir->count * sizeof *packs->seen);
    packs->opened = packs->stamp = 0;
    for (uint32_t number = 1; number < ir->count; number++)
        if (is_packed(&ir->instruction[number]))
            join(ir, packs, number, find_pack(ir, lanes, packs, number));
}
