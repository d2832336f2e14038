#include "machine/disassemble.h"

#include <Zydis/Zydis.h>
#include <stdio.h>

enum { LINE_CAPACITY = 256 };

/* Returns the instruction's length, or 0 if there is none. */
static size_t decode(const ZydisDecoder *decoder, const ZydisFormatter *formatter, const uint8_t *code,
                     size_t count, uint64_t address, char text[LINE_CAPACITY])
{
    ZydisDecodedInstruction instruction;
    ZydisDecodedOperand operands[ZYDIS_MAX_OPERAND_COUNT];
    if (!ZYAN_SUCCESS(ZydisDecoderDecodeFull(decoder, code, count, &instruction, operands)))
        return 0;
    if (!ZYAN_SUCCESS(ZydisFormatterFormatInstruction(formatter, &instruction, operands,
                                                      instruction.operand_count_visible, text, LINE_CAPACITY,
                                                      address, NULL)))
        return 0;
    return instruction.length;
}

const char *disassemble_set(const void *code, size_t count)
{
    ZydisDecoder decoder;
    ZydisDecoderInit(&decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    const uint8_t *bytes = code;
    const char *set = "SSE2";
    for (size_t offset = 0; offset < count;) {
        ZydisDecodedInstruction instruction;
        if (!ZYAN_SUCCESS(ZydisDecoderDecodeInstruction(&decoder, NULL, bytes + offset, count - offset,
                                                        &instruction))) {
            offset++;
            continue;
        }
        if (instruction.encoding == ZYDIS_INSTRUCTION_ENCODING_EVEX)
            return "AVX-512";
        if (instruction.encoding == ZYDIS_INSTRUCTION_ENCODING_VEX)
            set = "AVX2";
        offset += instruction.length;
    }
    return set;
}

/* Adds an operand: addresses that are only computed do not count, nor do pushes. */
static void count_operand(struct disassemble_counts *counts, const ZydisDecodedOperand *operand)
{
    if (operand->type != ZYDIS_OPERAND_TYPE_MEMORY || operand->mem.type == ZYDIS_MEMOP_TYPE_AGEN)
        return;
    counts->reads += (operand->actions & ZYDIS_OPERAND_ACTION_MASK_READ) != 0;
    counts->writes += (operand->actions & ZYDIS_OPERAND_ACTION_MASK_WRITE) != 0;
    counts->frame += operand->mem.base == ZYDIS_REGISTER_RSP || operand->mem.base == ZYDIS_REGISTER_RBP;
}

struct disassemble_counts disassemble_count(const void *code, size_t count)
{
    ZydisDecoder decoder;
    ZydisDecoderInit(&decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    const uint8_t *bytes = code;
    struct disassemble_counts counts = {0};
    for (size_t offset = 0; offset < count;) {
        ZydisDecodedInstruction instruction;
        ZydisDecodedOperand operands[ZYDIS_MAX_OPERAND_COUNT];
        if (!ZYAN_SUCCESS(
                ZydisDecoderDecodeFull(&decoder, bytes + offset, count - offset, &instruction, operands))) {
            offset++;
            continue;
        }
        offset += instruction.length;
        if (instruction.mnemonic == ZYDIS_MNEMONIC_NOP)
            continue;
        counts.instructions++;
        for (unsigned n = 0; n < instruction.operand_count_visible; n++)
            count_operand(&counts, &operands[n]);
    }
    return counts;
}

size_t disassemble(const void *code, size_t count, uint64_t address, disassemble_line *line, void *context)
{
    ZydisDecoder decoder;
    ZydisDecoderInit(&decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    ZydisFormatter formatter;
    ZydisFormatterInit(&formatter, ZYDIS_FORMATTER_STYLE_INTEL);
    ZydisFormatterSetProperty(&formatter, ZYDIS_FORMATTER_PROP_HEX_UPPERCASE, ZYAN_FALSE);
    ZydisFormatterSetProperty(&formatter, ZYDIS_FORMATTER_PROP_ADDR_PADDING_ABSOLUTE, ZYDIS_PADDING_DISABLED);
    ZydisFormatterSetProperty(&formatter, ZYDIS_FORMATTER_PROP_DISP_PADDING, ZYDIS_PADDING_DISABLED);
    ZydisFormatterSetProperty(&formatter, ZYDIS_FORMATTER_PROP_IMM_PADDING, ZYDIS_PADDING_DISABLED);
    const uint8_t *bytes = code;
    size_t lines = 0;
    for (size_t offset = 0, length; offset < count; offset += length, lines++) {
        char text[LINE_CAPACITY];
        length = decode(&decoder, &formatter, bytes + offset, count - offset, address + offset, text);
        if (!length) {
            length = 1;
            snprintf(text, sizeof text, "db 0x%02x", bytes[offset]);
        }
        line(context, offset, length, text);
    }
    return lines;
}
