#include "width.h"

#include <string.h>

/* The VEX prefix of three bytes, the opcode, and the ModRM byte. In the prefix:
 *
 *   byte 1   R, X and B extend register numbers to four bits, inverted; the rest selects the opcode map 0F
 *   byte 2   W; vvvv, the left operand, inverted; L, bit 2: 0 for 128 bits, 1 for 256; pp, bits 1 and 0:
 *            0 for vectors of binary32 ("ps"), 2 for one number ("ss") */
static void vex(uint8_t **at, int lanes, uint8_t opcode, int reg, int left, int rm, uint8_t mode)
{
    (void)lanes;
    uint8_t l = 0, pp = 2;
    *(*at)++ = 0xc4;
    *(*at)++ = (uint8_t)((reg & 8 ? 0 : 0x80) | 0x40 | (rm & 8 ? 0 : 0x20) | 1);
    *(*at)++ = (uint8_t)((~left & 15) << 3 | l << 2 | pp);
    *(*at)++ = opcode;
    *(*at)++ = (uint8_t)(mode << 6 | (reg & 7) << 3 | (rm & 7));
}

static void memory(uint8_t **at, int lanes, uint8_t opcode, int reg, enum base base, int displacement)
{
    vex(at, lanes, opcode, reg, 0, base, 2);
    memcpy(*at, &displacement, 4);
    *at += 4;
}

void encode_load(uint8_t **at, int lanes, int reg, enum base base, int displacement)
{
    memory(at, lanes, 0x10, reg, base, displacement);
}

void encode_store(uint8_t **at, int lanes, int reg, enum base base, int displacement)
{
    memory(at, lanes, 0x11, reg, base, displacement);
}

void encode_multiply(uint8_t **at, int lanes, int to, int left, int right)
{
    vex(at, lanes, 0x59, to, left, right, 3);
}

void encode_add(uint8_t **at, int lanes, int to, int left, int right)
{
    vex(at, lanes, 0x58, to, left, right, 3);
}

void encode_return(uint8_t **at)
{
    *(*at)++ = 0xc3;
}
