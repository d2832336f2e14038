/* Every encoding in src/def/x86.def, decoded by a disassembler that shares nothing with the encoder.
 *
 * The rows drive everything: from a row's form and operand classes the test derives what to ask for (all
 * register combinations; all addressing modes) and what Zydis must see: mnemonic, operands in order with
 * their registers, widths, addresses and immediates, the instruction's length, and that the encoding is the
 * shortest. A row added to the table is tested without a change here. */
#include "jit/encode.h"

#include <Zydis/Zydis.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

/* One instruction under test sits at offset HERE between a bound label and one that is bound after it. */
enum {
    ROOM = 512,
    HERE = 160,
    BEHIND = 0,
    AHEAD = 1,
    LABELS = 2,
    FIXUPS = 4,
    BEHIND_OFFSET = 16,
    AHEAD_OFFSET = 400
};

static struct {
    uint8_t code[ROOM];
    int32_t labels[LABELS];
    struct fixup fixups[FIXUPS];
    struct encoder encoder;
    unsigned length; /* of the instruction, as the encoder sees it */
    ZydisDecoder decoder;
    ZydisDecodedInstruction decoded;
    ZydisDecodedOperand operands[ZYDIS_MAX_OPERAND_COUNT];
    int unit;        /* of a displacement of one byte */
    const char *row; /* its id, for messages */
} at;

static void fail(const char *what)
{
    char message[512];
    int used = snprintf(message, sizeof message, "%s: wrong %s:", at.row, what);
    for (unsigned i = 0; i < at.length && i < 15; i++)
        used += snprintf(message + used, sizeof message - (size_t)used, " %02x", at.code[HERE + i]);
    TEST_FAIL_MESSAGE(message);
}

static void require(bool condition, const char *what)
{
    if (!condition)
        fail(what);
}

static struct encoder *begin(void)
{
    encoder_start(&at.encoder, at.code, ROOM, at.labels, LABELS, at.fixups, FIXUPS);
    at.unit = 1;
    at.encoder.at += BEHIND_OFFSET;
    encode_label(&at.encoder, BEHIND);
    at.encoder.at = at.encoder.start + HERE;
    return &at.encoder;
}

/* Decodes what was encoded since `begin`; what follows it decodes as nothing, so that a length is not luck.
 */
static void finish(const char *mnemonic, unsigned operand_count)
{
    at.length = (unsigned)encoder_size(&at.encoder) - HERE;
    memset(at.encoder.at, 0x06, 16);
    at.encoder.at = at.encoder.start + AHEAD_OFFSET;
    encode_label(&at.encoder, AHEAD);
    struct error error = {0};
    if (encoder_finish(&at.encoder, &error))
        TEST_FAIL_MESSAGE(error.text);
    require(ZYAN_SUCCESS(ZydisDecoderDecodeFull(&at.decoder, at.code + HERE, 16, &at.decoded, at.operands)),
            "instruction");
    require(at.decoded.length == at.length, "length");
    require(!strcmp(ZydisMnemonicGetString(at.decoded.mnemonic), mnemonic), "mnemonic");
    require(at.decoded.operand_count_visible == operand_count, "operand count");
    for (unsigned i = 0; i < at.decoded.raw.prefix_count; i++)
        require(at.decoded.raw.prefixes[i].type != ZYDIS_PREFIX_TYPE_IGNORED, "prefix that says nothing");
}

/* What an operand must be. */

static void require_register(unsigned operand, ZydisRegister first, unsigned number)
{
    const ZydisDecodedOperand *o = &at.operands[operand];
    require(o->type == ZYDIS_OPERAND_TYPE_REGISTER && o->reg.value == first + (int)number, "register");
}

static ZydisRegister gpr_of(unsigned number)
{
    return number == X86_NONE ? ZYDIS_REGISTER_NONE : (ZydisRegister)(ZYDIS_REGISTER_RAX + (int)number);
}

/* `index_first` is rax, or the first of the gather's index registers. `bits` 0: memory that is not accessed.
 */
static void require_memory(unsigned operand, struct address address, ZydisRegister index_first, unsigned bits)
{
    const ZydisDecodedOperand *o = &at.operands[operand];
    require(o->type == ZYDIS_OPERAND_TYPE_MEMORY, "kind of operand");
    require(bits ? o->size == bits : o->mem.type == ZYDIS_MEMOP_TYPE_AGEN, "memory width");
    if (address.base == X86_RIP_LABEL) {
        ZyanU64 target;
        require(o->mem.base == ZYDIS_REGISTER_RIP, "base");
        require(ZYAN_SUCCESS(ZydisCalcAbsoluteAddress(&at.decoded, o, HERE, &target)), "target");
        int label = address.label == BEHIND ? BEHIND_OFFSET : AHEAD_OFFSET;
        require((int64_t)target == (int64_t)label + address.displacement, "target");
        return;
    }
    require(o->mem.base == gpr_of(address.base), "base");
    if (address.index == X86_NONE)
        require(o->mem.index == ZYDIS_REGISTER_NONE, "index");
    else
        require(o->mem.index == index_first + address.index && o->mem.scale == address.scale, "index");
    require(o->mem.disp.value == address.displacement, "displacement");
    bool none = address.displacement == 0 && (address.base & 7) != X86_RBP;
    int32_t units = address.displacement / at.unit;
    bool byte = address.displacement % at.unit == 0 && units == (int8_t)units;
    unsigned shortest = address.base == X86_NONE ? 32 : none ? 0 : byte ? 8 : 32;
    require(at.decoded.raw.disp.size == shortest, "displacement size");
}

static void require_immediate(unsigned operand, int64_t value, bool is_signed)
{
    const ZydisDecodedOperand *o = &at.operands[operand];
    require(o->type == ZYDIS_OPERAND_TYPE_IMMEDIATE, "kind of operand");
    require(is_signed ? o->imm.value.s == value : o->imm.value.u == (uint64_t)value, "immediate");
}

/* Addresses: every base with every displacement class, every base, index and scale, no base, and both labels. */

typedef void address_function(void *context, struct address address);

static const int32_t displacements[] = {0,    1,    -1,   127,   -128,  128,        -129,     508,
                                        -512, 4064, 8128, -8192, -8256, 0x12345678, INT32_MIN};
enum { DISPLACEMENTS = sizeof displacements / sizeof *displacements };

static bool index_allowed(unsigned index, bool vector_index)
{
    return vector_index || index != X86_RSP;
}

/* Every other displacement with every other scale, in turn from one call to the next; all of them in a long run. */
static void for_each_indexed(address_function *function, void *context, bool vector_index)
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

static void for_each_address(address_function *function, void *context)
{
    for (unsigned d = 0; d < DISPLACEMENTS; d++) {
        for (unsigned base = 0; base < 16; base++)
            function(context, address_at(base, displacements[d]));
        function(context, address_at(X86_NONE, displacements[d]));
        for (unsigned label = 0; label < LABELS; label++)
            function(context, address_label(label, displacements[d] / 2));
    }
    for_each_indexed(function, context, false);
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
#include "def/x86.def"
#define X86_EVEX(id, mnemonic, form, prefix, map, w, opcode, digit, lengths, reg, vvvv, rm, memory,          \
                 broadcast, masking)                                                                         \
    {X86_##id, #id, #mnemonic, #form,      #prefix,  #map, #lengths, #reg,                                   \
     #vvvv,    #rm, #memory,   #broadcast, #masking, w,    opcode,   true},
#include "def/x86.def"
};

enum { VECTOR_ROWS = sizeof vector_rows / sizeof *vector_rows };

/* One choice of everything an instruction can have; a form uses a part of it. */
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

/* The destination, as the encoder is asked for it. */
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
        vector_mr(e, id, l, to, c->reg);
    else if (is(form, "MRI"))
        vector_mri(e, id, l, to, c->reg, c->immediate);
    else if (is(form, "RVMS"))
        vector_rrmr(e, id, l, c->reg, c->vvvv, c->address, c->third);
    else if (is(form, "MVR"))
        vector_mrr(e, id, l, c->address, c->vvvv, c->reg);
    else if (is(form, "GATHER"))
        vector_gather(e, id, l, c->reg, c->address, c->vvvv);
    else if (is(form, "M"))
        vector_m(e, id, c->address);
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
        vector_rm(e, id, l, to, address);
    else if (is(form, "RMI"))
        vector_rmi(e, id, l, to, address, c->immediate);
    else if (is(form, "VMI"))
        vector_rmi(e, id, l, decorated(c, c->vvvv), address, c->immediate);
    else if (is(form, "RVM"))
        vector_rrm(e, id, l, to, c->vvvv, address);
    else if (is(form, "RVMI"))
        vector_rrmi(e, id, l, to, c->vvvv, address, c->immediate);
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
        vector_rr(e, id, l, to, c->rm);
    else if (is(form, "MR"))
        vector_rr(e, id, l, decorated(c, c->rm), c->reg);
    else if (is(form, "RMI"))
        vector_rri(e, id, l, to, c->rm, c->immediate);
    else if (is(form, "MRI"))
        vector_rri(e, id, l, decorated(c, c->rm), c->reg, c->immediate);
    else if (is(form, "VMI"))
        vector_rri(e, id, l, decorated(c, c->vvvv), c->rm, c->immediate);
    else if (is(form, "RVM"))
        vector_rrr(e, id, l, to, c->vvvv, c->rm);
    else if (is(form, "RVMI"))
        vector_rrri(e, id, l, to, c->vvvv, c->rm, c->immediate);
    else if (is(form, "RVMS"))
        vector_rrrr(e, id, l, c->reg, c->vvvv, c->rm, c->third);
    else if (is(form, "NONE"))
        vector_none(e, id);
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

/* VEX.W costs a byte: where it is set, the same bytes without it must be another instruction. */
static void require_w_has_meaning(void)
{
    ZydisDecodedInstruction other;
    ZydisDecodedOperand operands[ZYDIS_MAX_OPERAND_COUNT];
    at.code[HERE + 2] ^= 0x80;
    bool decodes = ZYAN_SUCCESS(ZydisDecoderDecodeFull(&at.decoder, at.code + HERE, 16, &other, operands));
    at.code[HERE + 2] ^= 0x80;
    bool same = decodes && other.mnemonic == at.decoded.mnemonic;
    for (unsigned i = 0; same && i < other.operand_count_visible; i++)
        same = operands[i].size == at.operands[i].size &&
               operands[i].element_count == at.operands[i].element_count;
    require(!same, "VEX.W that says nothing");
}

/* Two-byte VEX exactly when nothing needs the third byte. */
static void require_shortest_vex(const struct vector_choice *c, bool map_0f, bool w)
{
    bool extended = c->memory ? (c->address.base < 16 && c->address.base >= 8) ||
                                    (c->address.index < 16 && c->address.index >= 8)
                              : c->rm >= 8;
    if (c->row->evex) {
        require(at.decoded.encoding == ZYDIS_INSTRUCTION_ENCODING_EVEX, "encoding");
        return;
    }
    require(at.decoded.encoding == ZYDIS_INSTRUCTION_ENCODING_VEX, "encoding");
    require(at.decoded.raw.vex.size == (map_0f && !w && !extended ? 2 : 3), "VEX size");
    if (w)
        require_w_has_meaning();
}

/* The disassembler lists the mask of what can be masked behind the destination, also where it is none. */
static unsigned at_lists_masks(const struct vector_expectation *row)
{
    return !is(row->masking, "ZZ");
}

/* Whether the encoder has to choose EVEX for what is asked; else the row's other encoding is the shorter one. */
static bool needs_evex(const struct vector_choice *c)
{
    bool shared = false;
    for (unsigned i = 0; i < VECTOR_ROWS; i++)
        shared |= !vector_rows[i].evex && vector_rows[i].id == c->row->id;
    unsigned rm = c->memory ? 0 : c->rm;
    return !shared || c->length == X86_512 || (c->reg | c->vvvv | rm) > 15 || c->mask || c->broadcast;
}

/* The mask that is applied, whether the other lanes become zero, and the broadcast; an operand that is the mask is hidden
 * unless there is one. */
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
    require(at.decoded.avx.mask.reg == (ZydisRegister)(ZYDIS_REGISTER_K0 + (int)c->mask), "mask");
    require(at.decoded.avx.mask.mode == mode, "mode of masking");
    if (c->broadcast)
        require(at.decoded.avx.broadcast.mode == (is(c->row->broadcast, "B8") ? pairs : all)[c->length],
                "broadcast");
}

/* The letters of the form, in order, are the operands the disassembler must list. */
static void check_vector(const struct vector_choice *c)
{
    const struct vector_expectation *row = c->row;
    const char *letters = is(row->form, "NONE") ? "" : is(row->form, "GATHER") ? "RMV" : row->form;
    if (row->evex && !needs_evex(c))
        return;
    at.row = row->name;
    struct encoder *encoder = begin();
    if (c->memory)
        encode_memory_form(encoder, c);
    else
        encode_register_form(encoder, c);
    finish(row->mnemonic, (unsigned)strlen(letters) + row->evex * at_lists_masks(row));
    if (row->evex)
        require_decoration(c);
    unsigned element = is(row->broadcast, "B8") ? 64 : 32;
    unsigned bits = !c->memory ? 0 : c->broadcast ? element : memory_bits(row->memory, c->length);
    at.unit = row->evex && c->memory ? (int)bits / 8 : 1;
    for (unsigned n = 0; letters[n]; n++) {
        bool gather = is(row->form, "GATHER");
        unsigned i = n + (n && row->evex ? at_lists_masks(row) : 0);
        switch (letters[n]) {
        case 'R': require_register(i, class_first(row->reg, c->length), c->reg); break;
        case 'V': require_register(i, class_first(row->vvvv, c->length), c->vvvv); break;
        case 'S': require_register(i, class_first(row->reg, c->length), c->third); break;
        case 'I': require_immediate(i, c->immediate, false); break;
        case 'M':
            if (c->memory)
                require_memory(i, c->address, gather ? class_first(row->rm, c->length) : ZYDIS_REGISTER_RAX,
                               bits);
            else
                require_register(i, class_first(row->rm, c->length), c->rm);
            break;
        }
    }
    require_shortest_vex(c, is(row->map, "0F"), row->w);
}

typedef void vector_test(struct vector_choice *choice);

static void for_each_vector_row(vector_test *test)
{
    for (unsigned i = 0; i < VECTOR_ROWS; i++)
        for (unsigned length = X86_128; length <= X86_512; length++)
            if (has_length(&vector_rows[i], length))
                test(&(struct vector_choice){.row = &vector_rows[i], .length = length});
}

/* Fields that the form does not use stay at one value. */
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

/* Masks and broadcasts in turn, as far as the row has them. */
static void decorate(struct vector_choice *c, unsigned turn)
{
    bool stores = c->row->form[0] == 'M' && c->memory;
    c->mask = is(c->row->masking, "ZZ") ? 0 : turn % 8;
    c->zero = c->mask && is(c->row->masking, "ZM") && !stores && turn / 8 % 2;
    c->broadcast = c->memory && !is(c->row->broadcast, "BN") && turn / 3 % 2;
}

/* Of registers that three fields name, EVEX has too many to try all triples: every pair is met. All in a long run. */
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
    if (is(c->row->form, "GATHER")) { /* all three differ */
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
        for_each_indexed(check_at_address, c, true);
    else
        for_each_address(check_at_address, c);
}

/* One address of each kind, with every register in every other field. */
static void all_registers_with_memory(struct vector_choice *c)
{
    const struct address addresses[] = {address_at(X86_RDI, 64), address_indexed(X86_R13, 11, 4, 0),
                                        address_label(AHEAD, 4)};
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

/* vector_copy is vmovaps whichever way round it is encoded, in four bytes whenever one register is low. */
static void vector_copy_is_the_shortest_vmovaps(void)
{
    at.row = "vector_copy";
    for (unsigned length = X86_128; length <= X86_512; length++)
        for (unsigned to = 0; to < 32; to++)
            for (unsigned from = 0; from < 32; from++) {
                bool evex = length == X86_512 || to > 15 || from > 15;
                vector_copy(begin(), length, to, from);
                finish("vmovaps", 2 + evex);
                require_register(0, class_first("V", length), to);
                require_register(1 + evex, class_first("V", length), from);
                require(at.length == (evex ? 6 : to >= 8 && from >= 8 ? 5 : 4), "length");
            }
}

/* General-register rows. */

struct gpr_expectation {
    enum x86_gpr id;
    const char *name, *mnemonic, *trait;
    uint8_t rm, mr, imm8, imm32, single;
};

static const struct gpr_expectation gpr_rows[] = {
#define X86_GPR(id, mnemonic, prefix, map, rm, mr, imm8, imm32, single, digit, trait)                        \
    {X86_##id, #id, #mnemonic, #trait, rm, mr, imm8, imm32, single},
#include "def/x86.def"
};

struct gpr_choice {
    const struct gpr_expectation *row;
    enum gpr_size size;
    unsigned reg;
};

static bool has_immediate(const struct gpr_expectation *row)
{
    return row->imm8 || row->imm32;
}

static unsigned rm_bits(const struct gpr_choice *c)
{
    const char *trait = c->row->trait;
    if (is(trait, "BYTE") || is(trait, "BYTES"))
        return 8;
    if (is(trait, "WORD") || is(trait, "WORDS"))
        return 16;
    if (is(trait, "DWORD"))
        return 32;
    return c->size == X86_64 || is(trait, "WIDE") || is(trait, "PLUS") ? 64 : 32;
}

static unsigned reg_bits(const struct gpr_choice *c)
{
    if (is(c->row->trait, "BYTES") || is(c->row->trait, "WORDS"))
        return rm_bits(c);
    return c->size == X86_64 ? 64 : 32;
}

static void require_gpr(unsigned operand, unsigned bits, unsigned number)
{
    switch (bits) {
    case 64: require_register(operand, ZYDIS_REGISTER_RAX, number); break;
    case 32: require_register(operand, ZYDIS_REGISTER_EAX, number); break;
    case 16: require_register(operand, ZYDIS_REGISTER_AX, number); break;
    case 8:
        if (number < 4)
            require_register(operand, ZYDIS_REGISTER_AL, number);
        else
            require_register(operand, ZYDIS_REGISTER_SPL, number - 4);
        break;
    default: TEST_FAIL();
    }
}

static void require_gpr_memory(const struct gpr_choice *c, unsigned operand, struct address address)
{
    require_memory(operand, address, ZYDIS_REGISTER_RAX, is(c->row->trait, "ADDRESS") ? 0 : rm_bits(c));
}

static void require_gpr_immediate(const struct gpr_choice *c, unsigned operand, int32_t immediate)
{
    bool byte = c->row->imm8 && immediate == (int8_t)immediate;
    require(at.operands[operand].type == ZYDIS_OPERAND_TYPE_IMMEDIATE, "kind of operand");
    require((int32_t)at.operands[operand].imm.value.u == immediate, "immediate");
    if (c->size == X86_64 && !is(c->row->trait, "COUNT"))
        require(at.operands[operand].imm.value.s == immediate, "sign of the immediate");
    require(at.decoded.raw.imm[0].size == (byte ? 8 : 32), "immediate size");
}

/* A REX only where a bit of it is needed, or a byte register without it would be ah to bh. */
static void require_rex(const struct gpr_choice *c, bool extended, bool new_byte_register)
{
    const char *trait = c->row->trait;
    bool wide = c->size == X86_64 && !is(trait, "WIDE") && !is(trait, "PLUS") && !is(trait, "BYTES") &&
                !is(trait, "WORDS");
    bool has = at.decoded.attributes & ZYDIS_ATTRIB_HAS_REX;
    require(has == (wide || extended || new_byte_register), "REX");
}

static void check_gpr_registers(const struct gpr_choice *c, unsigned to, unsigned from)
{
    gpr_rr(begin(), c->row->id, c->size, to, from);
    finish(c->row->mnemonic, 2);
    bool store = !c->row->rm, new_byte = false;
    require_gpr(0, store ? rm_bits(c) : reg_bits(c), to);
    require_gpr(1, store ? reg_bits(c) : rm_bits(c), from);
    if (rm_bits(c) == 8)
        new_byte = from >= 4 || (reg_bits(c) == 8 && to >= 4);
    require_rex(c, to >= 8 || from >= 8, new_byte);
}

static bool extends(struct address address)
{
    return (address.base < 16 && address.base >= 8) || (address.index < 16 && address.index >= 8);
}

static void check_gpr_load(void *context, struct address address)
{
    struct gpr_choice *c = context;
    c->reg = (c->reg + 5) % 16;
    gpr_rm(begin(), c->row->id, c->size, c->reg, address);
    finish(c->row->mnemonic, 2);
    require_gpr(0, reg_bits(c), c->reg);
    require_gpr_memory(c, 1, address);
    require_rex(c, c->reg >= 8 || extends(address), false);
}

static void check_gpr_store(void *context, struct address address)
{
    struct gpr_choice *c = context;
    c->reg = (c->reg + 5) % 16;
    gpr_mr(begin(), c->row->id, c->size, address, c->reg);
    finish(c->row->mnemonic, 2);
    require_gpr_memory(c, 0, address);
    require_gpr(1, reg_bits(c), c->reg);
    require_rex(c, c->reg >= 8 || extends(address), reg_bits(c) == 8 && c->reg >= 4);
}

static void check_gpr_single_memory(void *context, struct address address)
{
    struct gpr_choice *c = context;
    gpr_m(begin(), c->row->id, c->size, address);
    finish(c->row->mnemonic, 1);
    require_gpr_memory(c, 0, address);
    require_rex(c, extends(address), false);
}

static const int32_t immediates[] = {0,    1,   31,   32,         63,        -1,       127,
                                     -128, 128, -129, 0x12345678, INT32_MAX, INT32_MIN};
enum { IMMEDIATES = sizeof immediates / sizeof *immediates };

static bool takes_immediate(const struct gpr_choice *c, int32_t immediate)
{
    return !is(c->row->trait, "COUNT") || (immediate >= 0 && immediate < (c->size == X86_64 ? 64 : 32));
}

static void check_gpr_memory_immediate(void *context, struct address address)
{
    struct gpr_choice *c = context;
    bool triple = is(c->row->trait, "TRIPLE");
    c->reg = (c->reg + 5) % 16;
    for (unsigned i = 0; i < IMMEDIATES; i++) {
        if (!takes_immediate(c, immediates[i]))
            continue;
        if (triple)
            gpr_rmi(begin(), c->row->id, c->size, c->reg, address, immediates[i]);
        else
            gpr_mi(begin(), c->row->id, c->size, address, immediates[i]);
        finish(c->row->mnemonic, 2 + triple);
        if (triple)
            require_gpr(0, reg_bits(c), c->reg);
        require_gpr_memory(c, triple, address);
        require_gpr_immediate(c, 1 + triple, immediates[i]);
        require_rex(c, extends(address) || (triple && c->reg >= 8), false);
    }
}

static void check_gpr_register_immediate(const struct gpr_choice *c, unsigned to, unsigned from)
{
    bool triple = is(c->row->trait, "TRIPLE");
    for (unsigned i = 0; i < IMMEDIATES; i++) {
        if (!takes_immediate(c, immediates[i]))
            continue;
        if (triple)
            gpr_rri(begin(), c->row->id, c->size, to, from, immediates[i]);
        else
            gpr_ri(begin(), c->row->id, c->size, to, immediates[i]);
        finish(c->row->mnemonic, 2 + triple);
        require_gpr(0, reg_bits(c), to);
        if (triple)
            require_gpr(1, rm_bits(c), from);
        require_gpr_immediate(c, 1 + triple, immediates[i]);
        require_rex(c, to >= 8 || (triple && from >= 8), false);
    }
}

typedef void gpr_test(struct gpr_choice *choice);

static void for_each_gpr_row(gpr_test *test)
{
    for (unsigned i = 0; i < X86_GPR_COUNT; i++)
        for (unsigned size = X86_32; size <= X86_64; size++) {
            at.row = gpr_rows[i].name;
            test(&(struct gpr_choice){.row = &gpr_rows[i], .size = size});
        }
}

static void all_gpr_registers(struct gpr_choice *c)
{
    const struct gpr_expectation *row = c->row;
    for (unsigned to = 0; to < 16; to++) {
        for (unsigned from = 0; from < 16; from++) {
            if ((row->rm || row->mr) && !is(row->trait, "ADDRESS"))
                check_gpr_registers(c, to, from);
            if (has_immediate(row) && row->id != X86_mov && (from == 0 || is(row->trait, "TRIPLE")))
                check_gpr_register_immediate(c, to, from);
        }
        if (row->single) {
            gpr_r(begin(), row->id, c->size, to);
            finish(row->mnemonic, 1);
            require_gpr(0, rm_bits(c), to);
            require_rex(c, to >= 8, false);
        }
    }
}

static void all_gpr_addresses(struct gpr_choice *c)
{
    if (c->row->rm)
        for_each_address(check_gpr_load, c);
    if (c->row->mr)
        for_each_address(check_gpr_store, c);
    if (c->row->single && !is(c->row->trait, "PLUS"))
        for_each_address(check_gpr_single_memory, c);
    if (has_immediate(c->row))
        for_each_address(check_gpr_memory_immediate, c);
}

static void gpr_rows_take_all_registers(void)
{
    for_each_gpr_row(all_gpr_registers);
}

static void gpr_rows_take_all_addresses(void)
{
    for_each_gpr_row(all_gpr_addresses);
}

/* The decoded mov sets all 64 bits of the register to the value, in the fewest bytes there are. */
static void check_constant(unsigned to, uint64_t value)
{
    finish("mov", 2);
    const ZydisDecodedOperand *source = &at.operands[1];
    bool zero_extends = value <= UINT32_MAX, sign_extends = (int64_t)value == (int32_t)value;
    require(source->type == ZYDIS_OPERAND_TYPE_IMMEDIATE, "kind of operand");
    require_gpr(0, zero_extends ? 32 : 64, to);
    require((zero_extends ? (uint32_t)source->imm.value.u : source->imm.value.u) == value, "immediate");
    require(at.length == (zero_extends ? 5u + (to >= 8) : sign_extends ? 7u : 10u), "length");
}

static void constants_use_the_shortest_mov(void)
{
    static const uint64_t values[] = {0,
                                      1,
                                      0x7FFFFFFF,
                                      0x80000000,
                                      0xFFFFFFFF,
                                      0x100000000,
                                      0x123456789ABCDEF0,
                                      0xFFFFFFFF80000000,
                                      0xFFFFFFFF7FFFFFFF,
                                      UINT64_MAX,
                                      INT64_MAX,
                                      1ull << 63};
    at.row = "gpr_constant";
    for (unsigned to = 0; to < 16; to++) {
        for (unsigned i = 0; i < sizeof values / sizeof *values; i++) {
            gpr_constant(begin(), to, values[i]);
            check_constant(to, values[i]);
        }
        for (unsigned i = 0; i < IMMEDIATES; i++) {
            gpr_ri(begin(), X86_mov, X86_64, to, immediates[i]);
            check_constant(to, (uint64_t)(int64_t)immediates[i]);
            gpr_ri(begin(), X86_mov, X86_32, to, immediates[i]);
            check_constant(to, (uint32_t)immediates[i]);
        }
    }
}

/* The table covers each mnemonic once per encoding: no two rows may stand for the same thing. */
static void no_row_is_there_twice(void)
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
    ZydisDecoderInit(&at.decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    UNITY_BEGIN();
    RUN_TEST(vector_rows_take_all_registers);
    RUN_TEST(vector_rows_take_all_addresses);
    RUN_TEST(vector_rows_take_all_registers_with_memory);
    RUN_TEST(vector_copy_is_the_shortest_vmovaps);
    RUN_TEST(gpr_rows_take_all_registers);
    RUN_TEST(gpr_rows_take_all_addresses);
    RUN_TEST(constants_use_the_shortest_mov);
    RUN_TEST(no_row_is_there_twice);
    return UNITY_END();
}
