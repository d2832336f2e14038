/* Lines, operands and labels of assembly text (assemble.h). */
#include "engines/specialize/encode/assemble.h"

#include <string.h>

/* --- Characters ----------------------------------------------------------------------------------------- */

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_word(char c)
{
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static char peek(const struct assembler *as)
{
    return as->at < as->end ? *as->at : '\n';
}

static void skip_spaces(struct assembler *as)
{
    while (peek(as) == ' ' || peek(as) == '\t')
        as->at++;
}

static bool accept(struct assembler *as, char c)
{
    skip_spaces(as);
    if (peek(as) != c)
        return false;
    as->at++;
    return true;
}

/* A word of the line, with its length. */
struct word {
    const char *text;
    size_t length;
};

static struct word take_word(struct assembler *as)
{
    skip_spaces(as);
    struct word word = {as->at, 0};
    while (is_word(peek(as)))
        as->at++;
    word.length = (size_t)(as->at - word.text);
    return word;
}

static bool is(struct word word, const char *text)
{
    return strlen(text) == word.length && !memcmp(text, word.text, word.length);
}

int encode_assemble_fail(struct assembler *as, const char *found, size_t length, const char *expected)
{
    if (length > 40)
        length = 40;
    if (!length || *found == '\n')
        return error_set(as->error, "line %u: found the end of the line, expected %s", as->line, expected);
    return error_set(as->error, "line %u: found \"%.*s\", expected %s", as->line, (int)length, found,
                     expected);
}

static int fail_here(struct assembler *as, const char *expected)
{
    size_t length = (size_t)(as->end - as->at);
    const char *line_end = memchr(as->at, '\n', length);
    return encode_assemble_fail(as, as->at, line_end ? (size_t)(line_end - as->at) : length, expected);
}

/* --- Numbers and labels --------------------------------------------------------------------------------- */

static int digit_of(char c, unsigned base)
{
    int digit = is_digit(c) ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : 99;
    return digit < (int)base ? digit : -1;
}

/* The digits of a number in the base; stops before one that would overflow. */
static uint64_t take_digits(struct assembler *as, unsigned base)
{
    uint64_t value = 0, more;
    while (digit_of(peek(as), base) >= 0) {
        if (__builtin_mul_overflow(value, base, &more) ||
            __builtin_add_overflow(more, (unsigned)digit_of(peek(as), base), &more))
            break;
        value = more;
        as->at++;
    }
    return value;
}

/* A whole number, in decimal or hexadecimal digits, with a sign. */
static int take_number(struct assembler *as, int64_t *value)
{
    bool negative = accept(as, '-');
    skip_spaces(as);
    if (!is_digit(peek(as)))
        return fail_here(as, "a number");
    bool hexadecimal = as->end - as->at > 2 && as->at[0] == '0' && as->at[1] == 'x';
    as->at += hexadecimal ? 2 : 0;
    uint64_t digits = take_digits(as, hexadecimal ? 16 : 10);
    if (is_word(peek(as)))
        return fail_here(as, "the end of a number of at most 64 bits");
    *value = (int64_t)(negative ? -digits : digits);
    return 0;
}

static int label_of(struct assembler *as, struct word word, uint32_t *label)
{
    uint64_t number = 0;
    bool valid = word.length > 1 && word.length < 12 && word.text[0] == 'L';
    for (size_t i = 1; valid && i < word.length; i++) {
        valid = is_digit(word.text[i]);
        number = number * 10 + (unsigned)(word.text[i] - '0');
    }
    if (!valid || number >= as->encoder->label_count)
        return encode_assemble_fail(as, word.text, word.length, "a label");
    *label = (uint32_t)number;
    return 0;
}

/* --- Registers ------------------------------------------------------------------------------------------ */

/* The number after the first `from` letters of a word, of at most two digits below `limit`; -1: none. */
static int number_in(struct word word, size_t from, size_t to, int limit)
{
    int number = 0;
    if (to <= from || to - from > 2)
        return -1;
    for (size_t i = from; i < to; i++) {
        if (!is_digit(word.text[i]))
            return -1;
        number = number * 10 + word.text[i] - '0';
    }
    return number < limit ? number : -1;
}

static bool numbered(struct x86_operand *o, enum x86_operand_kind kind, int number)
{
    o->kind = (uint8_t)kind;
    o->number = (unsigned)number;
    return number >= 0;
}

static bool extended_gpr(struct word word, struct x86_operand *o)
{
    static const char suffixes[] = "bwd";
    const char *suffix = strchr(suffixes, word.text[word.length - 1]);
    int number = number_in(word, 1, word.length - (suffix != NULL), 16);
    return number >= 8 &&
           numbered(o, suffix ? X86_OPERAND_GPR8 + (unsigned)(suffix - suffixes) : X86_OPERAND_GPR64, number);
}

static bool legacy_gpr(struct word word, struct x86_operand *o)
{
    static const char names[4][8][4] = {{"al", "cl", "dl", "bl", "spl", "bpl", "sil", "dil"},
                                        {"ax", "cx", "dx", "bx", "sp", "bp", "si", "di"},
                                        {"eax", "ecx", "edx", "ebx", "esp", "ebp", "esi", "edi"},
                                        {"rax", "rcx", "rdx", "rbx", "rsp", "rbp", "rsi", "rdi"}};
    for (int size = 0; size < 4; size++)
        for (int number = 0; number < 8; number++)
            if (is(word, names[size][number]))
                return numbered(o, X86_OPERAND_GPR8 + (unsigned)size, number);
    return false;
}

static bool register_of(struct word word, struct x86_operand *o)
{
    if (word.length < 2)
        return false;
    if (word.length > 3 && !memcmp(word.text + 1, "mm", 2) && word.text[0] >= 'x' && word.text[0] <= 'z')
        return numbered(o, X86_OPERAND_XMM + (unsigned)(word.text[0] - 'x'),
                        number_in(word, 3, word.length, 32));
    if (word.text[0] == 'k')
        return numbered(o, X86_OPERAND_MASK, number_in(word, 1, word.length, 8));
    if (word.text[0] == 'r' && is_digit(word.text[1]))
        return extended_gpr(word, o);
    return legacy_gpr(word, o);
}

/* --- Operands ------------------------------------------------------------------------------------------- */

static unsigned size_of(struct word word)
{
    static const char *const sizes[] = {"byte", "word", "dword", "qword", "oword", "yword", "zword"};
    for (unsigned i = 0; i < sizeof sizes / sizeof *sizes; i++)
        if (is(word, sizes[i]))
            return 8u << i;
    return 0;
}

static int take_scale(struct assembler *as, struct x86_operand *o, struct x86_operand reg)
{
    int64_t scale;
    if (take_number(as, &scale))
        return -1;
    bool stack = reg.kind == X86_OPERAND_GPR64 && reg.number == X86_RSP;
    if (stack || o->address.index != X86_NONE || scale < 1 || scale > 8 || scale & (scale - 1))
        return fail_here(as, "one index register times 1, 2, 4 or 8");
    o->index = reg.kind;
    o->address.index = (uint8_t)reg.number;
    o->address.scale = (uint8_t)scale;
    return 0;
}

/* A register in an address: the base, or the index with its scale. */
static int add_register(struct assembler *as, struct x86_operand *o, struct word word)
{
    struct x86_operand reg = {0};
    if (!register_of(word, &reg) || (reg.kind != X86_OPERAND_GPR64 && reg.kind > X86_OPERAND_ZMM))
        return encode_assemble_fail(as, word.text, word.length, "a register of an address");
    if (accept(as, '*'))
        return take_scale(as, o, reg);
    if (o->address.base != X86_NONE || reg.kind != X86_OPERAND_GPR64)
        return encode_assemble_fail(as, word.text, word.length, "one base register");
    o->address.base = (uint8_t)reg.number;
    return 0;
}

static int add_term(struct assembler *as, struct x86_operand *o)
{
    skip_spaces(as);
    if (is_digit(peek(as)) || peek(as) == '-') {
        int64_t displacement;
        if (take_number(as, &displacement))
            return -1;
        o->address.displacement = (int32_t)displacement;
        return 0;
    }
    struct word word = take_word(as);
    if (!is(word, "rel"))
        return add_register(as, o, word);
    if (o->address.base != X86_NONE)
        return encode_assemble_fail(as, word.text, word.length, "one base");
    o->address.base = X86_RIP_LABEL;
    return label_of(as, take_word(as), &o->address.label);
}

/* {1toN}: one element for all lanes; {kN}: a mask; {z}: other lanes become zero. */
static int take_decorations(struct assembler *as, struct x86_operand *o)
{
    while (accept(as, '{')) {
        struct word word = take_word(as);
        int number = number_in(word, 1, word.length, 8);
        if (o->kind == X86_OPERAND_MEMORY && word.length > 3 && !memcmp(word.text, "1to", 3))
            o->address.broadcast = 1;
        else if (word.length == 2 && word.text[0] == 'k' && number > 0 && o->kind == X86_OPERAND_MEMORY)
            o->address.mask = (uint8_t)number;
        else if (word.length == 2 && word.text[0] == 'k' && number > 0)
            o->number |= (unsigned)number << 8;
        else if (is(word, "z") && o->kind != X86_OPERAND_MEMORY)
            o->number |= 1u << 15;
        else
            return encode_assemble_fail(as, word.text, word.length, "1toN, k1 to k7, or z");
        if (!accept(as, '}'))
            return fail_here(as, "}");
    }
    return 0;
}

static int take_address(struct assembler *as, struct x86_operand *o)
{
    o->kind = X86_OPERAND_MEMORY;
    o->address = (struct address){.base = X86_NONE, .index = X86_NONE, .scale = 1};
    do {
        if (add_term(as, o))
            return -1;
        skip_spaces(as);
    } while (accept(as, '+') || peek(as) == '-');
    if (o->address.base == X86_RIP_LABEL && o->address.index != X86_NONE)
        return fail_here(as, "an address relative to a label without a register");
    return accept(as, ']') ? take_decorations(as, o) : fail_here(as, "+, - or ]");
}

static int take_operand(struct assembler *as, struct x86_operand *o)
{
    skip_spaces(as);
    if (is_digit(peek(as)) || peek(as) == '-') {
        o->kind = X86_OPERAND_IMMEDIATE;
        return take_number(as, &o->immediate);
    }
    if (accept(as, '['))
        return take_address(as, o);
    struct word word = take_word(as);
    if (register_of(word, o))
        return take_decorations(as, o);
    o->bits = (uint16_t)size_of(word);
    if (!o->bits || !accept(as, '['))
        return encode_assemble_fail(as, word.text, word.length, "an operand");
    return take_address(as, o);
}

/* --- Lines ---------------------------------------------------------------------------------------------- */

static int take_jump(struct assembler *as, const enum x86_condition *condition)
{
    struct word word = take_word(as);
    uint32_t label;
    bool near = is(word, "near");
    if (near)
        word = take_word(as);
    if (label_of(as, word, &label))
        return -1;
    if (near && as->encoder->labels[label] != LABEL_UNBOUND)
        return encode_assemble_fail(as, word.text, word.length, "a label after a near jump");
    if (condition)
        encode_jump_if(as->encoder, *condition, label);
    else
        encode_jump(as->encoder, label);
    return 0;
}

static int take_call(struct assembler *as)
{
    uint32_t label;
    if (label_of(as, take_word(as), &label))
        return -1;
    encode_call(as->encoder, label);
    return 0;
}

static bool find_condition(struct word word, enum x86_condition *condition)
{
    static const struct {
        const char *name;
        enum x86_condition condition;
    } rows[] = {
#define X86_CONDITION(name, code) {"j" #name, X86_IF_##name},
#include "def/engine/x86.def"
    };
    for (size_t i = 0; word.text[0] == 'j' && i < sizeof rows / sizeof *rows; i++)
        if (is(word, rows[i].name))
            return *condition = rows[i].condition, true;
    return false;
}

static int take_words(struct assembler *as)
{
    do {
        int64_t value;
        if (take_number(as, &value))
            return -1;
        encode_data(as->encoder, &(uint32_t){(uint32_t)value}, sizeof(uint32_t));
    } while (accept(as, ','));
    return 0;
}

static int take_alignment(struct assembler *as)
{
    int64_t value;
    if (take_number(as, &value))
        return -1;
    if (value < 1 || value > 4096 || value & (value - 1))
        return error_set(as->error, "line %u: found an alignment of %lld, expected a power of two up to 4096",
                         as->line, (long long)value);
    encode_align(as->encoder, (unsigned)value);
    return 0;
}

static int take_instruction(struct assembler *as, struct word mnemonic)
{
    struct x86_operand operands[X86_OPERANDS] = {{0}};
    unsigned count = 0;
    skip_spaces(as);
    if (peek(as) != '\n' && peek(as) != ';')
        do {
            if (count == X86_OPERANDS)
                return fail_here(as, "at most four operands");
            if (take_operand(as, &operands[count++]))
                return -1;
        } while (accept(as, ','));
    return encode_match(as, mnemonic.text, mnemonic.length, operands, count);
}

static int take_statement(struct assembler *as, struct word word)
{
    enum x86_condition condition;
    int64_t bits;
    if (find_condition(word, &condition))
        return take_jump(as, &condition);
    skip_spaces(as);
    if (is(word, "jmp") && (peek(as) == 'L' || peek(as) == 'n')) /* a label, or near; else an operand */
        return take_jump(as, NULL);
    if (is(word, "call") && peek(as) == 'L')
        return take_call(as);
    if (is(word, "dd"))
        return take_words(as);
    if (is(word, "align"))
        return take_alignment(as);
    if (is(word, "ret"))
        return encode_return(as->encoder), 0;
    if (!is(word, "bits"))
        return take_instruction(as, word);
    return take_number(as, &bits) ? -1 : bits == 64 ? 0 : fail_here(as, "64 bits");
}

static int take_label(struct assembler *as, struct word word)
{
    uint32_t label;
    if (label_of(as, word, &label))
        return -1;
    if (as->encoder->labels[label] != LABEL_UNBOUND)
        return encode_assemble_fail(as, word.text, word.length, "a label that is not bound yet");
    encode_label(as->encoder, label);
    return 0;
}

int encode_assemble_line(struct assembler *as)
{
    as->line++;
    struct word word = take_word(as);
    if (word.length && accept(as, ':')) {
        if (take_label(as, word))
            return -1;
        word = take_word(as);
    }
    if (word.length && take_statement(as, word))
        return -1;
    skip_spaces(as);
    if (peek(as) == ';')
        while (peek(as) != '\n')
            as->at++;
    if (peek(as) != '\n')
        return fail_here(as, "the end of the line");
    as->at += as->at < as->end;
    return 0;
}
