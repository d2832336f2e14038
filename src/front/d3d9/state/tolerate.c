/* Shaders that drivers accept although their models forbid them, made valid for the renderer. */
#include "front/d3d9/state/shader.h"

enum { OPCODE_M4X3 = 21, OPCODE_M3X3 = 23, OPCODE_M3X2 = 24, OPCODE_DEFINE = 81, OPCODE_COMMENT = 0xfffe };
enum { OPCODE_MOV = 1, OPCODE_EXPP = 78, OPCODE_LOGP = 79 };
enum {
    MASK_SHIFT = 16,
    LENGTH_SHIFT = 24,
    DEFINE_TOKENS = 5,
    MOST_OPERANDS = 15,
    SOFTWARE_VERSION = 0xfffe02ff
};

/* The components that a matrix instruction with fewer than four rows writes; 0: another instruction. */
static uint32_t rows_mask(uint32_t opcode)
{
    switch (opcode) {
    case OPCODE_M4X3:
    case OPCODE_M3X3: return 7;
    case OPCODE_M3X2: return 3;
    default: return 0;
    }
}

/* The tokens of the instruction after its first. In model 1, operands are recognized by their highest bit. */
static uint64_t operands(const uint32_t *code, uint64_t at, uint64_t tokens)
{
    const uint32_t opcode = code[at] & 0xffff;
    if (opcode == OPCODE_COMMENT)
        return code[at] >> 16 & 0x7fff;
    if ((code[0] >> 8 & 0xff) >= 2)
        return code[at] >> 24 & 0xf;
    if (opcode == OPCODE_DEFINE)
        return DEFINE_TOKENS;
    uint64_t count = 0;
    while (at + 1 + count < tokens && code[at + 1 + count] >> 31)
        count++;
    return count;
}

void d3d9_state_tolerate(uint32_t *code, uint64_t tokens)
{
    for (uint64_t at = 1; at + 1 < tokens; at += 1 + operands(code, at, tokens)) {
        const uint32_t mask = rows_mask(code[at] & 0xffff);
        const uint32_t written = code[at + 1] >> MASK_SHIFT & 15;
        if (mask && (written & mask) == mask)
            code[at + 1] = (code[at + 1] & ~(UINT32_C(15) << MASK_SHIFT)) | mask << MASK_SHIFT;
    }
}

/* expp and logp of model 1 give other components, and its mov rounds an address to the number below. */
static bool changes_with_model(const uint32_t *instruction)
{
    enum { REGISTER = 0x70001800, ADDRESS = 3 << 28 };
    const uint32_t opcode = instruction[0] & 0xffff;
    return opcode == OPCODE_EXPP || opcode == OPCODE_LOGP ||
           (opcode == OPCODE_MOV && (instruction[1] & REGISTER) == ADDRESS);
}

bool d3d9_state_lengthen(uint32_t *code, uint64_t tokens)
{
    for (uint64_t at = 1; at + 1 < tokens;) {
        const bool comment = (code[at] & 0xffff) == OPCODE_COMMENT;
        const uint64_t count = operands(code, at, tokens);
        if (at + 1 + count >= tokens || (!comment && count > MOST_OPERANDS))
            return false;
        if (!comment && (code[at] >> MASK_SHIFT || changes_with_model(code + at)))
            return false;
        if (!comment)
            code[at] |= (uint32_t)count << LENGTH_SHIFT;
        at += 1 + count;
    }
    code[0] = SOFTWARE_VERSION;
    return true;
}
