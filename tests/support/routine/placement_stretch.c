#include "placement_part.h"

/* --- Stretched rows (engines/specialize/emit/stretch.c) ------------------------------------------------ */

/* The search for the rows of a chunk, and the steps from pair to pair, are code of the frame. The proof has
 * no values for general registers. It therefore requires that the code of operations does not write those
 * that the frame uses in these loops. */

static int kind_of(const struct check *c, uint32_t loop)
{
    return placement_operation(c, loop)->k;
}

/* A chunk may need no row that is not stretched yet, or have no pairs, or have nothing but pairs. */
bool placement_may_skip(const struct check *c, uint32_t loop)
{
    int kind = kind_of(c, loop);
    return kind == IR_LOOP_STRETCH || kind == IR_LOOP_PAIRS ||
           (kind == IR_LOOP_BLOCKS && c->ir->stretch_words);
}

/* The operation names the upper or the lower stretched rows, one for each of the rows of pixels p and q. The
 * distance of the pair of blocks from their beginning is in rax. */
void placement_expect_stretched(struct check *c, const ZydisDecodedOperand *o)
{
    static const ZydisRegister rows[2][2] = {{ZYDIS_REGISTER_R12, ZYDIS_REGISTER_R13},
                                             {ZYDIS_REGISTER_R10, ZYDIS_REGISTER_RCX}};
    const struct ir_instruction *i = placement_operation(c, c->number);
    const ZydisRegister *row = rows[i->field != 0];
    bool is_row = o->mem.base == row[0] || o->mem.base == row[1];
    if (!is_row || o->mem.index != ZYDIS_REGISTER_RAX || o->mem.scale != 1 || o->mem.disp.value != i->k)
        placement_wrong(c, "reads %lld bytes further in a stretched row, expected %d in another",
                        (long long)o->mem.disp.value, (int)i->k);
}

/* Loads of texels may write rax. */
void placement_keep_general(struct check *c, const ZydisDecodedOperand *o)
{
    int kind = c->loops ? kind_of(c, c->loop[c->loops - 1].number) : IR_LOOP_LANES;
    if ((kind != IR_LOOP_PAIRS && kind != IR_LOOP_STRETCH) || o->type != ZYDIS_OPERAND_TYPE_REGISTER)
        return;
    ZydisRegister whole = ZydisRegisterGetLargestEnclosing(ZYDIS_MACHINE_MODE_LONG_64, o->reg.value);
    bool general = whole >= ZYDIS_REGISTER_RAX && whole <= ZYDIS_REGISTER_R15;
    if (general && (kind == IR_LOOP_PAIRS || whole != ZYDIS_REGISTER_RAX))
        placement_wrong(c, "writes %s, which its loop needs", ZydisRegisterGetString(o->reg.value));
}
