/* Finds the row of def/engine/x86.def for a mnemonic and its operands, and encodes it. */
#include "engines/specialize/encode/assemble.h"

#include <string.h>

/* --- Rows by mnemonic ----------------------------------------------------------------------------------- */

/* All rows in one sequence: VEX encodings, EVEX encodings, general registers. */
enum { EVEX_ROWS = X86_VECTOR_COUNT, GPR_ROWS = 2 * X86_VECTOR_COUNT };

static const char *mnemonic_of(unsigned row)
{
    if (row < EVEX_ROWS)
        return encode_vex_form[row].mnemonic;
    return row < GPR_ROWS ? encode_evex_form[row - EVEX_ROWS].mnemonic : encode_gpr_mnemonic[row - GPR_ROWS];
}

static unsigned hash_of(const char *mnemonic, size_t length)
{
    uint32_t hash = 0;
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (uint8_t)mnemonic[i]) * 0x9e3779b1u;
    return hash >> (32 - __builtin_ctz(MNEMONIC_BUCKETS));
}

static void fill(struct mnemonics *m)
{
    for (unsigned row = MNEMONICS; row-- > 0;) {
        const char *mnemonic = mnemonic_of(row);
        if (!mnemonic)
            continue;
        uint16_t *bucket = &m->bucket[hash_of(mnemonic, strlen(mnemonic))];
        m->next[row] = *bucket;
        *bucket = (uint16_t)(row + 1);
    }
    m->filled = true;
}

/* --- Vector instructions -------------------------------------------------------------------------------- */

static bool is_gather(const struct vector_form *form)
{
    return form->fields[0] && form->fields[1] == 'M' && form->fields[2] == 'V';
}

/* A gather has a vector as its index, all others a general register. */
static bool fits_memory(const struct vector_form *form, enum vector_length length,
                        const struct x86_operand *o)
{
    unsigned bits = o->address.broadcast ? form->broadcast : encode_memory_bits(form, length);
    bool gathers = is_gather(form);
    if (!bits || (o->bits && o->bits != bits))
        return false;
    return gathers ? o->index == encode_field_kind(form, 'M', length)
                   : o->index == X86_OPERAND_NONE || o->index == X86_OPERAND_GPR64;
}

/* Only the destination has decorations. */
static bool fits_decoration(const struct vector_form *form, const struct x86_operand *o, unsigned position)
{
    bool memory = o->kind == X86_OPERAND_MEMORY;
    bool mask = memory ? o->address.mask : o->kind != X86_OPERAND_IMMEDIATE && o->number >> 8 & 7;
    bool zero = !memory && o->kind != X86_OPERAND_IMMEDIATE && o->number >> 15 & 1;
    return (!mask || (form->masks && !position)) && (!zero || (form->zeroes && mask));
}

static bool fits_field(const struct vector_form *form, enum vector_length length, char field,
                       const struct x86_operand *o)
{
    if (field == 'I')
        return o->kind == X86_OPERAND_IMMEDIATE && (uint64_t)o->immediate <= 255;
    if (o->kind == X86_OPERAND_MEMORY)
        return field == 'M' && fits_memory(form, length, o);
    if (field == 'M' && is_gather(form))
        return false;
    return o->kind != X86_OPERAND_NONE && o->kind == encode_field_kind(form, field, length) &&
           (field != 'S' || o->number < 16);
}

/* The registers of a gather must be different. */
static bool fits(const struct vector_form *form, enum vector_length length, const struct x86_operand *o,
                 unsigned count)
{
    if (!(form->lengths >> length & 1) || strlen(form->fields) != count)
        return false;
    for (unsigned i = 0; i < count; i++)
        if (!fits_field(form, length, form->fields[i], &o[i]) || !fits_decoration(form, &o[i], i))
            return false;
    return !is_gather(form) || (o[0].number != o[2].number && o[0].number != o[1].address.index &&
                                o[2].number != o[1].address.index && o[1].address.index < 16);
}

/* The functions of the encoder, by form: each letter is an operand as in their names. */
static void encode_form(struct encoder *e, enum x86_vector id, enum vector_length length, const char *shape,
                        const struct x86_operand o[X86_OPERANDS])
{
    const unsigned a = o[0].number, b = o[1].number, c = o[2].number, d = o[3].number;
    const unsigned third = (unsigned)o[2].immediate, fourth = (unsigned)o[3].immediate;
    const struct address first = o[0].address, second = o[1].address, last = o[2].address;
    if (!*shape)
        encode_none(e, id);
    else if (!strcmp(shape, "m"))
        encode_m(e, id, first);
    else if (!strcmp(shape, "rr"))
        encode_rr(e, id, length, a, b);
    else if (!strcmp(shape, "rm"))
        encode_rm(e, id, length, a, second);
    else if (!strcmp(shape, "mr"))
        encode_mr(e, id, length, first, b);
    else if (!strcmp(shape, "rri"))
        encode_rri(e, id, length, a, b, third);
    else if (!strcmp(shape, "rmi"))
        encode_rmi(e, id, length, a, second, third);
    else if (!strcmp(shape, "mri"))
        encode_mri(e, id, length, first, b, third);
    else if (!strcmp(shape, "rrr"))
        encode_rrr(e, id, length, a, b, c);
    else if (!strcmp(shape, "rrm"))
        encode_rrm(e, id, length, a, b, last);
    else if (!strcmp(shape, "rmr"))
        encode_gather(e, id, length, a, second, c);
    else if (!strcmp(shape, "rrri"))
        encode_rrri(e, id, length, a, b, c, fourth);
    else if (!strcmp(shape, "rrmi"))
        encode_rrmi(e, id, length, a, b, last, fourth);
    else if (!strcmp(shape, "rrrr"))
        encode_rrrr(e, id, length, a, b, c, d);
    else if (!strcmp(shape, "rrmr"))
        encode_rrmr(e, id, length, a, b, last, d);
    else
        encode_mrr(e, id, length, first, b, c);
}

static void shape_of(char shape[X86_OPERANDS + 1], const struct x86_operand *operands, unsigned count)
{
    for (unsigned o = 0; o < count; o++)
        shape[o] = operands[o].kind == X86_OPERAND_MEMORY      ? 'm'
                   : operands[o].kind == X86_OPERAND_IMMEDIATE ? 'i'
                                                               : 'r';
    shape[count] = 0;
}

/* A row whose operands fit, and their vector length or their enum gpr_size. */
struct match {
    uint16_t row;
    uint8_t size;
};

static bool fits_vector(unsigned row, const struct x86_operand *operands, unsigned count, uint8_t *size)
{
    bool evex = row >= EVEX_ROWS;
    enum x86_vector id = evex ? row - EVEX_ROWS : row;
    const struct vector_form *form = evex ? &encode_evex_form[id] : &encode_vex_form[id];
    for (enum vector_length length = X86_128; length <= X86_512; length++)
        if (fits(form, length, operands, count) && encode_needs_evex(id, length, operands, count) == evex)
            return *size = (uint8_t)length, true;
    return false;
}

/* --- General registers ---------------------------------------------------------------------------------- */

static unsigned bits_of(const struct x86_operand *o)
{
    return o->kind >= X86_OPERAND_GPR8 && o->kind <= X86_OPERAND_GPR64 ? 8u << (o->kind - X86_OPERAND_GPR8)
           : o->kind == X86_OPERAND_MEMORY                             ? o->bits
                                                                       : 0;
}

/* Returns true if the operands have the sizes of a row for this operation size. */
static bool has_bits(enum x86_gpr id, enum gpr_size size, const struct x86_operand *o, unsigned count)
{
    unsigned reg, rm;
    encode_gpr_bits(id, size, &reg, &rm);
    bool pair = count > 1 && o[1].kind != X86_OPERAND_IMMEDIATE;
    if (!pair)
        return bits_of(o) == rm;
    return o->kind == X86_OPERAND_MEMORY ? bits_of(o) == rm && bits_of(o + 1) == reg
                                         : bits_of(o) == reg && bits_of(o + 1) == rm;
}

static void encode_shape(struct encoder *e, enum x86_gpr id, enum gpr_size size, const char *shape,
                         const struct x86_operand o[X86_OPERANDS])
{
    const enum gpr a = o[0].number, b = o[1].number;
    const struct address first = o[0].address, second = o[1].address;
    const int32_t immediate = (int32_t)o[1].immediate, third = (int32_t)o[2].immediate;
    if (!strcmp(shape, "r"))
        encode_gpr_r(e, id, size, a);
    else if (!strcmp(shape, "m"))
        encode_gpr_m(e, id, size, first);
    else if (!strcmp(shape, "rr"))
        encode_gpr_rr(e, id, size, a, b);
    else if (!strcmp(shape, "rm"))
        encode_gpr_rm(e, id, size, a, second);
    else if (!strcmp(shape, "mr"))
        encode_gpr_mr(e, id, size, first, b);
    else if (!strcmp(shape, "ri") && id == X86_mov)
        encode_gpr_constant(e, a, size == X86_64 ? (uint64_t)o[1].immediate : (uint32_t)immediate);
    else if (!strcmp(shape, "ri"))
        encode_gpr_ri(e, id, size, a, immediate);
    else if (!strcmp(shape, "mi"))
        encode_gpr_mi(e, id, size, first, immediate);
    else if (!strcmp(shape, "rri"))
        encode_gpr_rri(e, id, size, a, b, third);
    else
        encode_gpr_rmi(e, id, size, a, second, third);
}

static bool is_general(const struct x86_operand *o)
{
    return (o->kind >= X86_OPERAND_GPR8 && o->kind <= X86_OPERAND_MEMORY) || o->kind == X86_OPERAND_IMMEDIATE;
}

/* A constant of mov may have 64 bits, a count less than 64, all others have 32 bits. */
static bool fits_immediate(enum x86_gpr id, const struct x86_operand *operands, unsigned count)
{
    const struct x86_operand *last = &operands[count - 1];
    if (last->kind == X86_OPERAND_IMMEDIATE && encode_gpr_counts(id))
        return last->immediate >= 0 && last->immediate < 64;
    return last->kind != X86_OPERAND_IMMEDIATE || (id == X86_mov && operands[0].kind == X86_OPERAND_GPR64) ||
           last->immediate == (int32_t)last->immediate || last->immediate == (uint32_t)last->immediate;
}

static bool fits_gpr(enum x86_gpr id, const struct x86_operand *operands, unsigned count, uint8_t *size)
{
    if (!count || count > 3 || operands[0].kind == X86_OPERAND_IMMEDIATE)
        return false;
    for (unsigned o = 0; o < count; o++)
        if (!is_general(&operands[o]))
            return false;
    if (!encode_gpr_has_shape(id, operands, count) || !fits_immediate(id, operands, count))
        return false;
    for (enum gpr_size bits = X86_32; bits <= X86_64; bits++)
        if (has_bits(id, bits, operands, count))
            return *size = (uint8_t)bits, true;
    return false;
}

/* --- The choice ----------------------------------------------------------------------------------------- */

static void encode_row(struct encoder *e, struct match match, const struct x86_operand operands[X86_OPERANDS],
                       unsigned count)
{
    char shape[X86_OPERANDS + 1];
    shape_of(shape, operands, count);
    if (match.row >= GPR_ROWS)
        encode_shape(e, (enum x86_gpr)(match.row - GPR_ROWS), match.size, shape, operands);
    else
        encode_form(e, match.row % X86_VECTOR_COUNT, match.size, shape, operands);
}

/* The bytes of the row's encoding, which is taken back. */
static ptrdiff_t length_of(struct encoder *e, struct match match,
                           const struct x86_operand operands[X86_OPERANDS], unsigned count)
{
    uint8_t *at = e->at;
    uint32_t fixups = e->fixup_count;
    encode_row(e, match, operands, count);
    ptrdiff_t length = e->at - at;
    e->at = at;
    e->fixup_count = fixups;
    return length;
}

enum { MATCHES = 4 };

/* Finds the rows whose operands fit. Returns their number; `known` becomes true if there is a row with the
 * mnemonic. */
static unsigned find(struct mnemonics *m, const char *mnemonic, size_t length,
                     const struct x86_operand *operands, unsigned count, struct match match[MATCHES],
                     bool *known)
{
    unsigned found = 0;
    for (unsigned at = m->bucket[hash_of(mnemonic, length)]; at && found < MATCHES; at = m->next[at - 1]) {
        unsigned row = at - 1;
        const char *name = mnemonic_of(row);
        if (strncmp(name, mnemonic, length) || name[length])
            continue;
        *known = true;
        match[found].row = (uint16_t)row;
        found += row < GPR_ROWS
                     ? fits_vector(row, operands, count, &match[found].size)
                     : fits_gpr((enum x86_gpr)(row - GPR_ROWS), operands, count, &match[found].size);
    }
    return found;
}

int encode_match(struct assembler *as, const char *mnemonic, size_t length,
                 const struct x86_operand operands[X86_OPERANDS], unsigned count)
{
    struct match match[MATCHES];
    bool known = false;
    unsigned best = 0;
    if (!as->mnemonics->filled)
        fill(as->mnemonics);
    unsigned found = find(as->mnemonics, mnemonic, length, operands, count, match, &known);
    if (!found)
        return encode_assemble_fail(as, mnemonic, length, known ? "operands that it has" : "an instruction");
    for (unsigned i = 1; i < found; i++)
        if (length_of(as->encoder, match[i], operands, count) <
            length_of(as->encoder, match[best], operands, count))
            best = i;
    encode_row(as->encoder, match[best], operands, count);
    return 0;
}
