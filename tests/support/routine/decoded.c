#include "decoded.h"

#include "engines/specialize/encode/assemble.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

struct decoded decoded_at;

static void fail(const char *what)
{
    char message[512];
    int used = snprintf(message, sizeof message, "%s: wrong %s:", decoded_at.row, what);
    for (unsigned i = 0; i < decoded_at.length && i < 15; i++)
        used += snprintf(message + used, sizeof message - (size_t)used, " %02x",
                         decoded_at.code[DECODED_HERE + i]);
    TEST_FAIL_MESSAGE(message);
}

void decoded_require(bool condition, const char *what)
{
    if (!condition)
        fail(what);
}

struct encoder *decoded_begin(void)
{
    encode_start(&decoded_at.encoder, decoded_at.code, DECODED_ROOM, decoded_at.labels, DECODED_LABELS,
                 decoded_at.fixups, DECODED_FIXUPS);
    decoded_at.unit = 1;
    decoded_at.encoder.at += DECODED_BEHIND_OFFSET;
    encode_label(&decoded_at.encoder, DECODED_BEHIND);
    decoded_at.encoder.at = decoded_at.encoder.start + DECODED_HERE;
    decoded_at.line = (struct encode_text){decoded_at.text, decoded_at.text, decoded_at.text + DECODED_ROOM};
    decoded_at.encoder.text = decoded_at.by_text ? &decoded_at.line : NULL;
    return &decoded_at.encoder;
}

static void assemble_text(void)
{
    static struct mnemonics mnemonics;
    struct error error = {0};
    struct assembler assembler = {.start = decoded_at.text,
                                  .at = decoded_at.text,
                                  .end = decoded_at.line.at,
                                  .encoder = &decoded_at.encoder,
                                  .mnemonics = &mnemonics,
                                  .error = &error};
    decoded_at.encoder.text = NULL;
    if (encode_assemble_line(&assembler))
        TEST_FAIL_MESSAGE(error.text);
    TEST_ASSERT_EQUAL_PTR(assembler.end, assembler.at);
}

void decoded_run(void (*test)(void), const char *name, const char *name_by_text, int line)
{
    UnityDefaultTestRun(test, name, line);
    decoded_at.by_text = true;
    UnityDefaultTestRun(test, name_by_text, line);
    decoded_at.by_text = false;
}

void decoded_finish(const char *mnemonic, unsigned operand_count)
{
    if (decoded_at.by_text)
        assemble_text();
    decoded_at.length = (unsigned)encode_size(&decoded_at.encoder) - DECODED_HERE;
    memset(decoded_at.encoder.at, 0x06, 16);
    decoded_at.encoder.at = decoded_at.encoder.start + DECODED_AHEAD_OFFSET;
    encode_label(&decoded_at.encoder, DECODED_AHEAD);
    struct error error = {0};
    if (encode_finish(&decoded_at.encoder, &error))
        TEST_FAIL_MESSAGE(error.text);
    decoded_require(ZYAN_SUCCESS(ZydisDecoderDecodeFull(&decoded_at.decoder, decoded_at.code + DECODED_HERE,
                                                        16, &decoded_at.decoded, decoded_at.operands)),
                    "instruction");
    decoded_require(decoded_at.decoded.length == decoded_at.length, "length");
    decoded_require(!strcmp(ZydisMnemonicGetString(decoded_at.decoded.mnemonic), mnemonic), "mnemonic");
    decoded_require(decoded_at.decoded.operand_count_visible == operand_count, "operand count");
    for (unsigned i = 0; i < decoded_at.decoded.raw.prefix_count; i++)
        decoded_require(decoded_at.decoded.raw.prefixes[i].type != ZYDIS_PREFIX_TYPE_IGNORED,
                        "prefix without effect");
}

void decoded_require_register(unsigned operand, ZydisRegister first, unsigned number)
{
    const ZydisDecodedOperand *o = &decoded_at.operands[operand];
    decoded_require(o->type == ZYDIS_OPERAND_TYPE_REGISTER && o->reg.value == first + (int)number,
                    "register");
}

static ZydisRegister gpr_of(unsigned number)
{
    return number == X86_NONE ? ZYDIS_REGISTER_NONE : (ZydisRegister)(ZYDIS_REGISTER_RAX + (int)number);
}

void decoded_require_memory(unsigned operand, struct address address, ZydisRegister index_first,
                            unsigned bits)
{
    const ZydisDecodedOperand *o = &decoded_at.operands[operand];
    decoded_require(o->type == ZYDIS_OPERAND_TYPE_MEMORY, "kind of operand");
    decoded_require(bits ? o->size == bits : o->mem.type == ZYDIS_MEMOP_TYPE_AGEN, "memory width");
    if (address.base == X86_RIP_LABEL) {
        ZyanU64 target;
        decoded_require(o->mem.base == ZYDIS_REGISTER_RIP, "base");
        decoded_require(ZYAN_SUCCESS(ZydisCalcAbsoluteAddress(&decoded_at.decoded, o, DECODED_HERE, &target)),
                        "target");
        int label = address.label == DECODED_BEHIND ? DECODED_BEHIND_OFFSET : DECODED_AHEAD_OFFSET;
        decoded_require((int64_t)target == (int64_t)label + address.displacement, "target");
        return;
    }
    decoded_require(o->mem.base == gpr_of(address.base), "base");
    if (address.index == X86_NONE)
        decoded_require(o->mem.index == ZYDIS_REGISTER_NONE, "index");
    else
        decoded_require(o->mem.index == index_first + address.index && o->mem.scale == address.scale,
                        "index");
    decoded_require(o->mem.disp.value == address.displacement, "displacement");
    bool none = address.displacement == 0 && (address.base & 7) != X86_RBP;
    int32_t units = address.displacement / decoded_at.unit;
    bool byte = address.displacement % decoded_at.unit == 0 && units == (int8_t)units;
    unsigned shortest = address.base == X86_NONE ? 32 : none ? 0 : byte ? 8 : 32;
    decoded_require(decoded_at.decoded.raw.disp.size == shortest, "displacement size");
}

void decoded_require_immediate(unsigned operand, int64_t value, bool is_signed)
{
    const ZydisDecodedOperand *o = &decoded_at.operands[operand];
    decoded_require(o->type == ZYDIS_OPERAND_TYPE_IMMEDIATE, "kind of operand");
    decoded_require(is_signed ? o->imm.value.s == value : o->imm.value.u == (uint64_t)value, "immediate");
}

static const int32_t displacements[] = {0,    1,    -1,   127,   -128,  128,        -129,     508,
                                        -512, 4064, 8128, -8192, -8256, 0x12345678, INT32_MIN};
enum { DISPLACEMENTS = sizeof displacements / sizeof *displacements };

static bool index_allowed(unsigned index, bool vector_index)
{
    return vector_index || index != X86_RSP;
}

void decoded_for_each_indexed(decoded_address_function *function, void *context, bool vector_index)
{
    static const unsigned char scales[] = {1, 2, 4, 8};
    static unsigned turn;
    unsigned step = getenv("TRIPTYCH_SEED") ? 1 : 2;
    turn++;
    for (unsigned base = 0; base <= 16; base++)
        for (unsigned index = 0; index < 16; index++)
            for (unsigned s = 0; index_allowed(index, vector_index) && s < sizeof scales; s++)
                for (unsigned d = (s + turn) % step; d < DISPLACEMENTS; d += step)
                    function(context, address_indexed(base < 16 ? base : X86_NONE, index, scales[s],
                                                      displacements[d]));
}

void decoded_for_each_address(decoded_address_function *function, void *context)
{
    for (unsigned d = 0; d < DISPLACEMENTS; d++) {
        for (unsigned base = 0; base < 16; base++)
            function(context, address_at(base, displacements[d]));
        function(context, address_at(X86_NONE, displacements[d]));
        for (unsigned label = 0; label < DECODED_LABELS; label++)
            function(context, address_label(label, displacements[d] / 2));
    }
    decoded_for_each_indexed(function, context, false);
}
