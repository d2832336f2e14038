/* Every encoding in src/def/engine/x86.def, decoded by an independent disassembler, Zydis.
 *
 * From a row's form and operand classes the test derives the instructions to encode (all combinations of
 * registers, all addressing modes) and the expected result of the disassembler: mnemonic, operands in order
 * with their registers, widths, addresses and immediates, and the length. It also checks that the encoding is
 * the shortest. A new row of the table is tested without a change here. Each test runs again by way of text,
 * which the assembler reads, with every seventh choice of operands. */
#include "engines/specialize/encode/encode.h"
#include "tests/support/routine/decoded.h"
#include "tests/support/system/seed.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

/* Vector rows. */

struct vector_expectation {
    enum x86_vector id;
    const char *name, *mnemonic, *form, *prefix, *map, *lengths, *reg, *vvvv, *rm, *memory, *broadcast,
        *masking;
    unsigned w, opcode;
    bool evex;
};

static const struct vector_expectation vector_rows[] = {
#define X86_VECTOR(id, mnemonic, form, prefix, map, w, opcode, digit, lengths, reg, vvvv, rm, memory)        \
    {X86_##id, #id, #mnemonic, #form, #prefix, #map, #lengths, #reg,                                         \
     #vvvv,    #rm, #memory,   "BN",  "ZZ",    w,    opcode,   false},
#include "def/engine/x86.def"
#define X86_EVEX(id, mnemonic, form, prefix, map, w, opcode, digit, lengths, reg, vvvv, rm, memory,          \
                 broadcast, masking)                                                                         \
    {X86_##id, #id, #mnemonic, #form,      #prefix,  #map, #lengths, #reg,                                   \
     #vvvv,    #rm, #memory,   #broadcast, #masking, w,    opcode,   true},
#include "def/engine/x86.def"
};

enum { VECTOR_ROWS = sizeof vector_rows / sizeof *vector_rows };

/* One choice of all operands; a form uses some of them. */
struct vector_choice {
    const struct vector_expectation *row;
    enum vector_length length;
    unsigned reg, vvvv, rm, third, immediate;
    unsigned mask; /* 0: none */
    bool zero, broadcast;
    bool memory;
    struct address address;
};

static bool is(const char *text, const char *other)
{
    return !strcmp(text, other);
}

static bool has_register_form(const struct vector_expectation *row)
{
    return !is(row->rm, "N") && !is(row->form, "GATHER");
}

static bool has_memory_form(const struct vector_expectation *row)
{
    return !is(row->memory, "MN");
}

static bool has_length(const struct vector_expectation *row, enum vector_length length)
{
    static const char *const which[] = {"LX", "LY LW", "LW LZ"};
    return (is(row->lengths, "LV") && (length < X86_512 || row->evex)) ||
           strstr(which[length], row->lengths) != NULL;
}

/* The destination operand for the encoder. */
static unsigned decorated(const struct vector_choice *c, unsigned to)
{
    return c->zero ? zeroed(to, c->mask) : masked(to, c->mask);
}

static void encode_other_memory_form(struct encoder *e, const struct vector_choice *c)
{
    const char *form = c->row->form;
    enum x86_vector id = c->row->id;
    enum vector_length l = c->length;
    struct address to = c->address;
    to.mask = (uint8_t)c->mask;
    if (is(form, "MR"))
        encode_mr(e, id, l, to, c->reg);
    else if (is(form, "MRI"))
        encode_mri(e, id, l, to, c->reg, c->immediate);
    else if (is(form, "RVMS"))
        encode_rrmr(e, id, l, c->reg, c->vvvv, c->address, c->third);
    else if (is(form, "MVR"))
        encode_mrr(e, id, l, c->address, c->vvvv, c->reg);
    else if (is(form, "GATHER"))
        encode_gather(e, id, l, c->reg, c->address, c->vvvv);
    else if (is(form, "M"))
        encode_m(e, id, c->address);
    else
        TEST_FAIL_MESSAGE(form);
}

static void encode_memory_form(struct encoder *e, const struct vector_choice *c)
{
    const char *form = c->row->form;
    enum x86_vector id = c->row->id;
    enum vector_length l = c->length;
    struct address address = c->address;
    unsigned to = decorated(c, c->reg);
    address.broadcast = c->broadcast;
    if (is(form, "RM"))
        encode_rm(e, id, l, to, address);
    else if (is(form, "RMI"))
        encode_rmi(e, id, l, to, address, c->immediate);
    else if (is(form, "VMI"))
        encode_rmi(e, id, l, decorated(c, c->vvvv), address, c->immediate);
    else if (is(form, "RVM"))
        encode_rrm(e, id, l, to, c->vvvv, address);
    else if (is(form, "RVMI"))
        encode_rrmi(e, id, l, to, c->vvvv, address, c->immediate);
    else
        encode_other_memory_form(e, c);
}

static void encode_register_form(struct encoder *e, const struct vector_choice *c)
{
    const char *form = c->row->form;
    enum x86_vector id = c->row->id;
    enum vector_length l = c->length;
    unsigned to = decorated(c, c->reg);
    if (is(form, "RM"))
        encode_rr(e, id, l, to, c->rm);
    else if (is(form, "MR"))
        encode_rr(e, id, l, decorated(c, c->rm), c->reg);
    else if (is(form, "RMI"))
        encode_rri(e, id, l, to, c->rm, c->immediate);
    else if (is(form, "MRI"))
        encode_rri(e, id, l, decorated(c, c->rm), c->reg, c->immediate);
    else if (is(form, "VMI"))
        encode_rri(e, id, l, decorated(c, c->vvvv), c->rm, c->immediate);
    else if (is(form, "RVM"))
        encode_rrr(e, id, l, to, c->vvvv, c->rm);
    else if (is(form, "RVMI"))
        encode_rrri(e, id, l, to, c->vvvv, c->rm, c->immediate);
    else if (is(form, "RVMS"))
        encode_rrrr(e, id, l, c->reg, c->vvvv, c->rm, c->third);
    else if (is(form, "NONE"))
        encode_none(e, id);
    else
        TEST_FAIL_MESSAGE(form);
}

static ZydisRegister class_first(const char *class, enum vector_length length)
{
    static const ZydisRegister vector[] = {ZYDIS_REGISTER_XMM0, ZYDIS_REGISTER_YMM0, ZYDIS_REGISTER_ZMM0};
    switch (*class) {
    case 'V': return vector[length];
    case 'H': return vector[length == X86_512];
    case 'K': return ZYDIS_REGISTER_K0;
    case 'X': return ZYDIS_REGISTER_XMM0;
    case 'Y': return ZYDIS_REGISTER_YMM0;
    case 'G': return ZYDIS_REGISTER_EAX;
    case 'Q': return ZYDIS_REGISTER_RAX;
    }
    TEST_FAIL_MESSAGE(class);
    return ZYDIS_REGISTER_NONE;
}

static unsigned memory_bits(const char *memory, enum vector_length length)
{
    unsigned vector = 128u << length, bits = 0;
    if (is(memory, "MV"))
        return vector;
    if (is(memory, "MH"))
        return vector / 2;
    if (is(memory, "MQ"))
        return vector / 4;
    TEST_ASSERT_EQUAL_INT(1, sscanf(memory, "M%u", &bits));
    return bits;
}

/* VEX.W costs a byte. If a row sets it, the same bytes without it must be another instruction. */
static void require_w_has_meaning(void)
{
    ZydisDecodedInstruction other;
    ZydisDecodedOperand operands[ZYDIS_MAX_OPERAND_COUNT];
    decoded_at.code[DECODED_HERE + 2] ^= 0x80;
    bool decodes = ZYAN_SUCCESS(
        ZydisDecoderDecodeFull(&decoded_at.decoder, decoded_at.code + DECODED_HERE, 16, &other, operands));
    decoded_at.code[DECODED_HERE + 2] ^= 0x80;
    bool same = decodes && other.mnemonic == decoded_at.decoded.mnemonic;
    for (unsigned i = 0; same && i < other.operand_count_visible; i++)
        same = operands[i].size == decoded_at.operands[i].size &&
               operands[i].element_count == decoded_at.operands[i].element_count;
    decoded_require(!same, "VEX.W without effect");
}

/* The prefix has two bytes if and only if nothing needs the third byte. */
static void require_shortest_vex(const struct vector_choice *c, bool map_0f, bool w)
{
    bool extended = c->memory ? (c->address.base < 16 && c->address.base >= 8) ||
                                    (c->address.index < 16 && c->address.index >= 8)
                              : c->rm >= 8;
    if (c->row->evex) {
        decoded_require(decoded_at.decoded.encoding == ZYDIS_INSTRUCTION_ENCODING_EVEX, "encoding");
        return;
    }
    decoded_require(decoded_at.decoded.encoding == ZYDIS_INSTRUCTION_ENCODING_VEX, "encoding");
    /* The assembler may choose another row, with a shorter encoding of the same instruction. */
    unsigned size = map_0f && !w && !extended ? 2 : 3;
    decoded_require(decoded_at.decoded.raw.vex.size <= size, "VEX size");
    decoded_require(decoded_at.decoded.raw.vex.size == size || decoded_at.by_text, "VEX size");
    if (w && !decoded_at.by_text)
        require_w_has_meaning();
}

/* The disassembler lists the mask after the destination of every instruction that can be masked, even without
 * one. */
static unsigned at_lists_masks(const struct vector_expectation *row)
{
    return !is(row->masking, "ZZ");
}

/* Returns true if the encoder has to choose EVEX. Otherwise VEX is shorter. */
static bool needs_evex(const struct vector_choice *c)
{
    bool shared = false;
    for (unsigned i = 0; i < VECTOR_ROWS; i++)
        shared |= !vector_rows[i].evex && vector_rows[i].id == c->row->id;
    unsigned rm = c->memory ? 0 : c->rm;
    return !shared || c->length == X86_512 || (c->reg | c->vvvv | rm) > 15 || c->mask || c->broadcast;
}

/* Checks the mask, whether the other lanes become zero, and the broadcast. The operand for the mask is hidden
 * if there is no mask. */
static void require_decoration(const struct vector_choice *c)
{
    static const ZydisBroadcastMode all[] = {ZYDIS_BROADCAST_MODE_1_TO_4, ZYDIS_BROADCAST_MODE_1_TO_8,
                                             ZYDIS_BROADCAST_MODE_1_TO_16};
    static const ZydisBroadcastMode pairs[] = {ZYDIS_BROADCAST_MODE_1_TO_2, ZYDIS_BROADCAST_MODE_1_TO_4,
                                               ZYDIS_BROADCAST_MODE_1_TO_8};
    ZydisMaskMode mode = !c->mask               ? ZYDIS_MASK_MODE_DISABLED
                         : c->zero              ? ZYDIS_MASK_MODE_ZEROING
                         : is(c->row->reg, "K") ? ZYDIS_MASK_MODE_CONTROL
                                                : ZYDIS_MASK_MODE_MERGING;
    if (is(c->row->name, "vblendmps") && c->mask)
        mode = c->zero ? ZYDIS_MASK_MODE_CONTROL_ZEROING : ZYDIS_MASK_MODE_CONTROL;
    if (is(c->row->reg, "K") && c->mask)
        mode = ZYDIS_MASK_MODE_ZEROING;
    decoded_require(decoded_at.decoded.avx.mask.reg == (ZydisRegister)(ZYDIS_REGISTER_K0 + (int)c->mask),
                    "mask");
    decoded_require(decoded_at.decoded.avx.mask.mode == mode, "mode of masking");
    if (c->broadcast)
        decoded_require(decoded_at.decoded.avx.broadcast.mode ==
                            (is(c->row->broadcast, "B8") ? pairs : all)[c->length],
                        "broadcast");
}

/* The disassembler must list the operands in the order of the letters of the form. */
static void check_vector(const struct vector_choice *c)
{
    const struct vector_expectation *row = c->row;
    const char *letters = is(row->form, "NONE") ? "" : is(row->form, "GATHER") ? "RMV" : row->form;
    static unsigned turn;
    if ((row->evex && !needs_evex(c)) || (decoded_at.by_text && turn++ % 7))
        return;
    decoded_at.row = row->name;
    struct encoder *encoder = decoded_begin();
    if (c->memory)
        encode_memory_form(encoder, c);
    else
        encode_register_form(encoder, c);
    decoded_finish(row->mnemonic, (unsigned)strlen(letters) + row->evex * at_lists_masks(row));
    if (row->evex)
        require_decoration(c);
    unsigned element = is(row->broadcast, "B8") ? 64 : 32;
    unsigned bits = !c->memory ? 0 : c->broadcast ? element : memory_bits(row->memory, c->length);
    decoded_at.unit = row->evex && c->memory ? (int)bits / 8 : 1;
    for (unsigned n = 0; letters[n]; n++) {
        bool gather = is(row->form, "GATHER");
        unsigned i = n + (n && row->evex ? at_lists_masks(row) : 0);
        switch (letters[n]) {
        case 'R': decoded_require_register(i, class_first(row->reg, c->length), c->reg); break;
        case 'V': decoded_require_register(i, class_first(row->vvvv, c->length), c->vvvv); break;
        case 'S': decoded_require_register(i, class_first(row->reg, c->length), c->third); break;
        case 'I': decoded_require_immediate(i, c->immediate, false); break;
        case 'M':
            if (c->memory)
                decoded_require_memory(i, c->address,
                                       gather ? class_first(row->rm, c->length) : ZYDIS_REGISTER_RAX, bits);
            else
                decoded_require_register(i, class_first(row->rm, c->length), c->rm);
            break;
        }
    }
    require_shortest_vex(c, is(row->map, "0F"), row->w);
}

typedef void vector_test(struct vector_choice *choice);

static void for_each_vector_row(vector_test *test)
{
    for (unsigned i = 0; i < VECTOR_ROWS; i += test_stride_of(9))
        for (unsigned length = X86_128; length <= X86_512; length++)
            if (has_length(&vector_rows[i], length))
                test(&(struct vector_choice){.row = &vector_rows[i], .length = length});
}

/* Fields that the form does not use have one value. */
static unsigned values(const struct vector_choice *c, char letter)
{
    const char *form = is(c->row->form, "GATHER") ? "RMV" : is(c->row->form, "NONE") ? "" : c->row->form;
    const char *class = letter == 'R' || letter == 'S' ? c->row->reg
                        : letter == 'V'                ? c->row->vvvv
                                                       : c->row->rm;
    if (!strchr(form, letter))
        return 1;
    return is(class, "K") ? 8 : is(class, "G") || is(class, "Q") || !c->row->evex ? 16 : 32;
}

/* Masks and broadcasts in turn, if the row has them. */
static void decorate(struct vector_choice *c, unsigned turn)
{
    bool stores = c->row->form[0] == 'M' && c->memory;
    c->mask = is(c->row->masking, "ZZ") ? 0 : turn % 8;
    c->zero = c->mask && is(c->row->masking, "ZM") && !stores && turn / 8 % 2;
    c->broadcast = c->memory && !is(c->row->broadcast, "BN") && turn / 3 % 2;
}

/* EVEX has too many registers to try all triples of three fields, so every pair is tried; all triples in a
 * long run. */
static unsigned stride(const struct vector_choice *c)
{
    return c->row->evex && strchr(c->row->form, 'V') && strchr(c->row->form, 'R') && !getenv("TRIPTYCH_SEED")
               ? 11
               : 1;
}

static void all_registers(struct vector_choice *c)
{
    if (!has_register_form(c->row) && !is(c->row->form, "NONE"))
        return;
    unsigned count = 0;
    for (c->reg = 0; c->reg < values(c, 'R'); c->reg++)
        for (c->vvvv = 0; c->vvvv < values(c, 'V'); c->vvvv++)
            for (c->rm = (c->reg + c->vvvv) % stride(c); c->rm < values(c, 'M'); c->rm += stride(c))
                for (c->third = 0; c->third < values(c, 'S'); c->third++) {
                    decorate(c, count);
                    c->immediate = count++ * 37 & 255;
                    check_vector(c);
                }
}

static void check_at_address(void *context, struct address address)
{
    struct vector_choice *c = context;
    c->address = address;
    c->reg = (c->reg + 5) % values(c, 'R');
    c->vvvv = (c->vvvv + 3) % values(c, 'V');
    c->third = (c->third + 7) % 16;
    c->immediate = (c->immediate + 37) & 255;
    decorate(c, c->immediate);
    if (is(c->row->form, "GATHER")) { /* all three must be different */
        c->reg = (address.index + 1 + c->immediate % 7) % 16;
        c->vvvv = (address.index + 8 + c->immediate % 8) % 16;
    }
    check_vector(c);
}

static void all_addresses(struct vector_choice *c)
{
    c->memory = true;
    if (!has_memory_form(c->row))
        return;
    if (is(c->row->form, "GATHER"))
        decoded_for_each_indexed(check_at_address, c, true);
    else
        decoded_for_each_address(check_at_address, c);
}

/* One address of each kind, with every register in every other field. */
static void all_registers_with_memory(struct vector_choice *c)
{
    const struct address addresses[] = {address_at(X86_RDI, 64), address_indexed(X86_R13, 11, 4, 0),
                                        address_label(DECODED_AHEAD, 4)};
    c->memory = true;
    if (!has_memory_form(c->row) || is(c->row->form, "GATHER"))
        return;
    for (unsigned a = 0; a < sizeof addresses / sizeof *addresses; a++)
        for (c->reg = 0; c->reg < values(c, 'R'); c->reg++)
            for (c->vvvv = 0; c->vvvv < values(c, 'V'); c->vvvv++)
                for (c->third = 0; c->third < values(c, 'S'); c->third++) {
                    c->address = addresses[a];
                    decorate(c, c->reg * 5 + c->vvvv * 3 + a);
                    check_vector(c);
                }
}

static void all_gather_registers(struct vector_choice *c)
{
    if (!is(c->row->form, "GATHER"))
        return;
    c->memory = true;
    for (c->reg = 0; c->reg < 16; c->reg++)
        for (c->vvvv = 0; c->vvvv < 16; c->vvvv++)
            for (unsigned index = 0; index < 16; index++)
                if (c->reg != c->vvvv && c->reg != index && c->vvvv != index) {
                    c->address = address_indexed((c->reg + index) % 16, index, 4, 0);
                    check_vector(c);
                }
}

static void vector_rows_take_all_registers(void)
{
    for_each_vector_row(all_registers);
}

static void vector_rows_take_all_addresses(void)
{
    for_each_vector_row(all_addresses);
}

static void vector_rows_take_all_registers_with_memory(void)
{
    for_each_vector_row(all_registers_with_memory);
    for_each_vector_row(all_gather_registers);
}

/* encode_copy is vmovaps in either encoding, with four bytes if one register is below 8. */
static void vector_copy_is_the_shortest_vmovaps(void)
{
    decoded_at.row = "encode_copy";
    for (unsigned length = X86_128; length <= X86_512; length++)
        for (unsigned to = 0; to < 32; to++)
            for (unsigned from = 0; from < 32; from++) {
                bool evex = length == X86_512 || to > 15 || from > 15;
                encode_copy(decoded_begin(), length, to, from);
                decoded_finish("vmovaps", 2 + evex);
                decoded_require_register(0, class_first("V", length), to);
                decoded_require_register(1 + evex, class_first("V", length), from);
                decoded_require(decoded_at.length == (evex ? 6 : to >= 8 && from >= 8 ? 5 : 4), "length");
            }
}

/* The table has one row for each mnemonic and encoding. */
static void every_row_is_different(void)
{
    for (unsigned i = 0; i < VECTOR_ROWS; i++)
        for (unsigned j = 0; j < i; j++) {
            const struct vector_expectation *a = &vector_rows[i], *b = &vector_rows[j];
            bool same = is(a->form, b->form) && is(a->prefix, b->prefix) && is(a->map, b->map) &&
                        a->w == b->w && a->opcode == b->opcode && is(a->mnemonic, b->mnemonic) &&
                        is(a->rm, b->rm) && a->evex == b->evex;
            TEST_ASSERT_FALSE_MESSAGE(same, a->name);
        }
}

int main(void)
{
    ZydisDecoderInit(&decoded_at.decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    UNITY_BEGIN();
    decoded_run(vector_rows_take_all_registers, "vector_rows_take_all_registers",
                "vector_rows_take_all_registers_by_text", __LINE__);
    decoded_run(vector_rows_take_all_addresses, "vector_rows_take_all_addresses",
                "vector_rows_take_all_addresses_by_text", __LINE__);
    decoded_run(vector_rows_take_all_registers_with_memory, "vector_rows_take_all_registers_with_memory",
                "vector_rows_take_all_registers_with_memory_by_text", __LINE__);
    decoded_run(vector_copy_is_the_shortest_vmovaps, "vector_copy_is_the_shortest_vmovaps",
                "vector_copy_is_the_shortest_vmovaps_by_text", __LINE__);
    decoded_run(every_row_is_different, "every_row_is_different", "every_row_is_different_by_text", __LINE__);
    return UNITY_END();
}
