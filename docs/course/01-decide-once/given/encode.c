#include "matrix.h"

#include <string.h>

/* The VEX prefix of three bytes: map 0F, prefix F3 (scalar binary32), 128 bits. R and B extend the two
 * registers of the ModRM byte, and vvvv is the left operand; all are inverted. */
static void vex(uint8_t **at, int reg, int left, int rm, uint8_t opcode)
{
    uint8_t bytes[4] = {0xc4, (uint8_t)(0xe1 ^ (reg >= 8) << 7 ^ (rm >= 8) << 5),
                        (uint8_t)((~left & 15) << 3 | 2), opcode};
    memcpy(*at, bytes, sizeof bytes);
    *at += sizeof bytes;
}

static void registers(uint8_t **at, int result, int left, int right, uint8_t opcode)
{
    vex(at, result, left, right, opcode);
    *(*at)++ = (uint8_t)(0xc0 | (result & 7) << 3 | (right & 7));
}

/* An address of a register and a displacement of one byte: up to 31 floats. */
static void memory_operand(uint8_t **at, int xmm, enum memory memory, int element, uint8_t opcode)
{
    vex(at, xmm, 0, memory, opcode);
    *(*at)++ = (uint8_t)(0x40 | (xmm & 7) << 3 | memory);
    *(*at)++ = (uint8_t)(element * (int)sizeof(float));
}

void encode_load(uint8_t **at, int result, enum memory memory, int element)
{
    memory_operand(at, result, memory, element, 0x10);
}

void encode_store(uint8_t **at, enum memory memory, int element, int stored)
{
    memory_operand(at, stored, memory, element, 0x11);
}

void encode_multiply(uint8_t **at, int result, int left, int right)
{
    registers(at, result, left, right, 0x59);
}

void encode_add(uint8_t **at, int result, int left, int right)
{
    registers(at, result, left, right, 0x58);
}

void encode_return(uint8_t **at)
{
    *(*at)++ = 0xc3;
}
