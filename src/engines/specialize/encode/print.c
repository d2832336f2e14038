/* Instructions as text, in the syntax of NASM: the mnemonic, then the operands in Intel order.
 *
 *     vaddps ymm3, ymm4, [rdi+64]
 *     vblendmps zmm1{k2}, zmm3, [rel L12]{1to16}
 *     jz near L7
 *
 * A forward jump is `near`, because the encoder does not shorten it. Data are `dd`, and every label has the
 * name L and its number. */
#include "engines/specialize/encode/assemble.h"
#include "engines/specialize/encode/operand.h"

#include <assert.h>
#include <string.h>

enum { LINE_CAPACITY = 256 };

/* --- Forms of vector instructions ----------------------------------------------------------------------- */

#define FIELDS_RM     "RM"
#define FIELDS_MR     "MR"
#define FIELDS_RMI    "RMI"
#define FIELDS_MRI    "MRI"
#define FIELDS_VMI    "VMI"
#define FIELDS_RVM    "RVM"
#define FIELDS_RVMI   "RVMI"
#define FIELDS_RVMS   "RVMS"
#define FIELDS_MVR    "MVR"
#define FIELDS_GATHER "RMV"
#define FIELDS_M      "M"
#define FIELDS_NONE   ""

enum {
    LENGTHS_LX = 1 << X86_128,
    LENGTHS_LY = 1 << X86_256,
    LENGTHS_LZ = 1 << X86_512,
    LENGTHS_LW = LENGTHS_LY | LENGTHS_LZ,
    MEMORY_MV = -1,
    MEMORY_MH = -2,
    MEMORY_MQ = -4,
    MEMORY_M8 = 8,
    MEMORY_M16 = 16,
    MEMORY_M32 = 32,
    MEMORY_M64 = 64,
    MEMORY_M128 = 128,
    MEMORY_M256 = 256,
    MEMORY_MN = 0,
    BROADCAST_BN = 0,
    BROADCAST_B4 = 32,
    BROADCAST_B8 = 64
};

#define MASKING_ZZ false, false
#define MASKING_MM true, false
#define MASKING_ZM true, true

const struct vector_form encode_vex_form[X86_VECTOR_COUNT] = {
#define LENGTHS_LV (LENGTHS_LX | LENGTHS_LY)
#define X86_VECTOR(id, mnemonic, form, prefix, map, w, opcode, digit, lengths, reg, vvvv, rm, memory)        \
    [X86_##id] = {#mnemonic,         FIELDS_##form,   (#reg)[0],    (#vvvv)[0], (#rm)[0],                    \
                  LENGTHS_##lengths, MEMORY_##memory, BROADCAST_BN, MASKING_ZZ},
#include "def/engine/x86.def"
#undef LENGTHS_LV
};

const struct vector_form encode_evex_form[X86_VECTOR_COUNT] = {
#define LENGTHS_LV (LENGTHS_LX | LENGTHS_LW)
#define X86_EVEX(id, mnemonic, form, prefix, map, w, opcode, digit, lengths, reg, vvvv, rm, memory,          \
                 broadcast, masking)                                                                         \
    [X86_##id] = {#mnemonic,        FIELDS_##form,     (#reg)[0],       (#vvvv)[0],                          \
                  (#rm)[0],         LENGTHS_##lengths, MEMORY_##memory, BROADCAST_##broadcast,               \
                  MASKING_##masking},
#include "def/engine/x86.def"
#undef LENGTHS_LV
};

static enum x86_operand_kind vector_of_length(enum vector_length length)
{
    return (enum x86_operand_kind)(X86_OPERAND_XMM + (unsigned)length);
}

enum x86_operand_kind encode_field_kind(const struct vector_form *form, char field, enum vector_length length)
{
    char class = field == 'R' ? form->reg : field == 'M' ? form->rm : field == 'S' ? 'V' : form->vvvv;
    switch (class) {
    case 'V': return vector_of_length(length);
    case 'X': return X86_OPERAND_XMM;
    case 'Y': return X86_OPERAND_YMM;
    case 'H': return vector_of_length(length == X86_512 ? X86_256 : X86_128);
    case 'K': return X86_OPERAND_MASK;
    case 'G': return X86_OPERAND_GPR32;
    case 'Q': return X86_OPERAND_GPR64;
    default: return X86_OPERAND_NONE;
    }
}

unsigned encode_memory_bits(const struct vector_form *form, enum vector_length length)
{
    return form->memory < 0 ? (128u << length) / (unsigned)-form->memory : (unsigned)form->memory;
}

bool encode_needs_evex(enum x86_vector id, enum vector_length length,
                       const struct x86_operand operands[X86_OPERANDS], unsigned count)
{
    bool needs = length == X86_512 || !encode_vex_form[id].mnemonic;
    for (unsigned o = 0; o < count; o++)
        if (operands[o].kind == X86_OPERAND_MEMORY)
            needs |= operands[o].address.broadcast || operands[o].address.mask;
        else if (operands[o].kind != X86_OPERAND_IMMEDIATE)
            needs |= operands[o].number > 15;
    return needs;
}

/* --- Writing -------------------------------------------------------------------------------------------- */

static char *put_text(char *to, const char *text)
{
    size_t length = strlen(text);
    memcpy(to, text, length);
    return to + length;
}

static char *put_unsigned(char *to, uint64_t value)
{
    char digits[20];
    unsigned count = 0;
    do
        digits[count++] = (char)('0' + value % 10);
    while (value /= 10);
    while (count)
        *to++ = digits[--count];
    return to;
}

static char *put_signed(char *to, int64_t value)
{
    if (value < 0)
        *to++ = '-';
    return put_unsigned(to, value < 0 ? -(uint64_t)value : (uint64_t)value);
}

static char *put_hexadecimal(char *to, uint64_t value)
{
    to = put_text(to, "0x");
    int shift = 60;
    while (shift && !(value >> shift & 15))
        shift -= 4;
    for (; shift >= 0; shift -= 4)
        *to++ = "0123456789abcdef"[value >> shift & 15];
    return to;
}

static char *put_label(char *to, uint32_t label)
{
    *to++ = 'L';
    return put_unsigned(to, label);
}

static char *put_gpr(char *to, unsigned number, unsigned bits)
{
    static const char plain[8][3] = {"ax", "cx", "dx", "bx", "sp", "bp", "si", "di"};
    static const char bytes[8][4] = {"al", "cl", "dl", "bl", "spl", "bpl", "sil", "dil"};
    if (number >= 8) {
        *to++ = 'r';
        to = put_unsigned(to, number);
        return put_text(to, bits == 8 ? "b" : bits == 16 ? "w" : bits == 32 ? "d" : "");
    }
    if (bits == 8)
        return put_text(to, bytes[number]);
    if (bits > 16)
        *to++ = bits == 32 ? 'e' : 'r';
    return put_text(to, plain[number]);
}

static char *put_register(char *to, enum x86_operand_kind kind, unsigned number)
{
    static const char *const vectors[] = {"xmm", "ymm", "zmm", "k"};
    if (kind >= X86_OPERAND_GPR8)
        return put_gpr(to, number, 8u << (kind - X86_OPERAND_GPR8));
    to = put_unsigned(put_text(to, vectors[kind - X86_OPERAND_XMM]), number & 31);
    if (number >> 8 & 7) {
        to = put_unsigned(put_text(to, "{k"), number >> 8 & 7);
        *to++ = '}';
    }
    return number >> 15 & 1 ? put_text(to, "{z}") : to;
}

static char *put_size(char *to, unsigned bits)
{
    switch (bits) {
    case 8: return put_text(to, "byte ");
    case 16: return put_text(to, "word ");
    case 32: return put_text(to, "dword ");
    case 64: return put_text(to, "qword ");
    case 128: return put_text(to, "oword ");
    case 256: return put_text(to, "yword ");
    case 512: return put_text(to, "zword ");
    default: return to;
    }
}

/* `index` is the kind of the index register. */
static char *put_address(char *to, const struct address *a, enum x86_operand_kind index)
{
    char *begin = to + 1;
    *to++ = '[';
    if (a->base == X86_RIP_LABEL)
        to = put_label(put_text(to, "rel "), a->label);
    else if (a->base != X86_NONE)
        to = put_gpr(to, a->base, 64);
    if (a->index != X86_NONE) {
        if (to != begin)
            *to++ = '+';
        to = put_register(to, index, a->index);
        *to++ = '*';
        to = put_unsigned(to, a->scale);
    }
    if (to != begin && a->displacement > 0)
        *to++ = '+';
    if (a->displacement || to == begin)
        to = put_signed(to, a->displacement);
    *to++ = ']';
    return to;
}

static void finish_line(struct encoder *e, const char *line, char *end)
{
    struct encode_text *text = e->text;
    *end++ = '\n';
    assert(end - line <= LINE_CAPACITY);
    if (text->limit - text->at < end - line) {
        text->limit = text->at;
        e->failure = ENCODER_OUT_OF_TEXT;
        return;
    }
    memcpy(text->at, line, (size_t)(end - line));
    text->at += end - line;
}

/* --- Lines ---------------------------------------------------------------------------------------------- */

/* The size is written where the mnemonic and the registers do not determine it. (NASM 2.16 refuses that of
 * vcmpss.) */
static char *put_vector_memory(char *to, const struct vector_form *form, enum vector_length length,
                               const struct address *address)
{
    bool gathers = form->fields[1] == 'M' && form->fields[2] == 'V',
         general = form->rm == 'G' || form->rm == 'Q';
    unsigned bits = encode_memory_bits(form, length), element = address->broadcast ? form->broadcast : bits;
    if (general)
        to = put_size(to, element);
    to = put_address(to, address, gathers ? encode_field_kind(form, 'M', length) : X86_OPERAND_GPR64);
    if (address->broadcast) {
        to = put_unsigned(put_text(to, "{1to"), bits / element);
        *to++ = '}';
    }
    if (address->mask) {
        to = put_unsigned(put_text(to, "{k"), address->mask);
        *to++ = '}';
    }
    return to;
}

void encode_print_vector(struct encoder *e, enum x86_vector id, enum vector_length length,
                         const struct x86_operand *operands)
{
    const struct vector_form *vex = &encode_vex_form[id], *form = vex->mnemonic ? vex : &encode_evex_form[id];
    unsigned count = (unsigned)strlen(form->fields);
    char line[LINE_CAPACITY], *at = line;
    if (encode_needs_evex(id, length, operands, count))
        form = &encode_evex_form[id];
    at = put_text(at, form->mnemonic);
    for (unsigned o = 0; o < count; o++) {
        at = put_text(at, o ? ", " : " ");
        if (operands[o].kind == X86_OPERAND_MEMORY)
            at = put_vector_memory(at, form, length, &operands[o].address);
        else if (operands[o].kind == X86_OPERAND_IMMEDIATE)
            at = put_unsigned(at, (uint64_t)operands[o].immediate);
        else
            at = put_register(at, encode_field_kind(form, form->fields[o], length), operands[o].number);
    }
    finish_line(e, line, at);
}

/* The operand in ModRM.reg is the register beside the other operand; if both are registers, the row
 * decides. */
void encode_print_gpr(struct encoder *e, enum x86_gpr id, enum gpr_size size,
                      const struct x86_operand *operands, unsigned count)
{
    char line[LINE_CAPACITY], *at = put_text(line, encode_gpr_mnemonic[id]);
    unsigned reg, rm;
    encode_gpr_bits(id, size, &reg, &rm);
    bool pair =
        count > 1 && operands[0].kind == X86_OPERAND_REGISTER && operands[1].kind != X86_OPERAND_IMMEDIATE;
    for (unsigned o = 0; o < count; o++) {
        unsigned bits = pair && o == 0 ? reg : rm;
        if (operands[0].kind == X86_OPERAND_MEMORY && operands[o].kind == X86_OPERAND_REGISTER)
            bits = reg;
        at = put_text(at, o ? ", " : " ");
        if (operands[o].kind == X86_OPERAND_MEMORY)
            at = put_address(put_size(at, rm), &operands[o].address, X86_OPERAND_GPR64);
        else if (operands[o].kind == X86_OPERAND_IMMEDIATE)
            at = put_signed(at, operands[o].immediate);
        else
            at = put_gpr(at, operands[o].number, bits);
    }
    finish_line(e, line, at);
}

void encode_print_jump(struct encoder *e, const char *condition, uint32_t label)
{
    char line[LINE_CAPACITY], *at = put_text(line, "j");
    at = put_text(put_text(at, condition), e->labels[label] == LABEL_UNBOUND ? " near " : " ");
    finish_line(e, line, put_label(at, label));
}

void encode_print_call(struct encoder *e, uint32_t label)
{
    char line[LINE_CAPACITY];
    finish_line(e, line, put_label(put_text(line, "call "), label));
}

void encode_print_label(struct encoder *e, uint32_t label)
{
    char line[LINE_CAPACITY], *at = put_label(line, label);
    *at++ = ':';
    finish_line(e, line, at);
}

void encode_print_words(struct encoder *e, const void *bytes, size_t count)
{
    char line[LINE_CAPACITY], *at = put_text(line, "dd ");
    assert(count % sizeof(uint32_t) == 0 && count <= 64);
    for (size_t i = 0; i < count; i += sizeof(uint32_t)) {
        uint32_t word;
        memcpy(&word, (const uint8_t *)bytes + i, sizeof word);
        at = put_hexadecimal(i ? put_text(at, ", ") : at, word);
    }
    finish_line(e, line, at);
}

void encode_print_directive(struct encoder *e, const char *name, unsigned number)
{
    char line[LINE_CAPACITY], *at = put_text(line, name);
    if (number)
        at = put_unsigned(put_text(at, " "), number);
    finish_line(e, line, at);
}
