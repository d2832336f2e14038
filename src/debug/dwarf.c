#include "debug/dwarf.h"

#include <stdlib.h>
#include <string.h>

/* --- Bytes --------------------------------------------------------------------------------------------- */

void bytes_append(struct bytes *bytes, const void *data, size_t count)
{
    if (!bytes->failed && bytes->count + count > bytes->capacity) {
        size_t capacity = 2 * (bytes->count + count) + 256;
        uint8_t *larger = realloc(bytes->data, capacity);
        bytes->failed = !larger;
        if (larger) {
            bytes->data = larger;
            bytes->capacity = capacity;
        }
    }
    if (bytes->failed || !count)
        return;
    memcpy(bytes->data + bytes->count, data, count);
    bytes->count += count;
}

void bytes_append_number(struct bytes *bytes, uint64_t value, size_t count)
{
    bytes_append(bytes, &value, count);
}

void bytes_append_text(struct bytes *bytes, const char *text)
{
    bytes_append(bytes, text, strlen(text) + 1);
}

void bytes_align(struct bytes *bytes, size_t alignment)
{
    while (!bytes->failed && bytes->count % alignment)
        bytes_append_number(bytes, 0, 1);
}

void bytes_free(struct bytes *bytes)
{
    free(bytes->data);
    *bytes = (struct bytes){0};
}

static void byte(struct bytes *out, unsigned value)
{
    bytes_append_number(out, value, 1);
}

static void uleb(struct bytes *out, uint64_t value)
{
    for (; value >= 0x80; value >>= 7)
        byte(out, (value & 0x7f) | 0x80);
    byte(out, (unsigned)value);
}

static void sleb(struct bytes *out, int64_t value)
{
    for (; value < -64 || value > 63; value >>= 7)
        byte(out, (value & 0x7f) | 0x80);
    byte(out, value & 0x7f);
}

/* A length of 32 bits, which end_length fills in. */
static size_t begin_length(struct bytes *out)
{
    bytes_append_number(out, 0, 4);
    return out->count;
}

static void end_length(struct bytes *out, size_t begin)
{
    uint32_t length = (uint32_t)(out->count - begin);
    if (!out->failed)
        memcpy(out->data + begin - 4, &length, sizeof length);
}

/* --- Frames -------------------------------------------------------------------------------------------- */

enum {
    DW_CFA_nop = 0x00,
    DW_CFA_advance_loc4 = 0x04,
    DW_CFA_same_value = 0x08,
    DW_CFA_def_cfa = 0x0c,
    DW_CFA_advance_loc = 0x40, /* and a distance below 64 */
    DW_CFA_offset = 0x80,      /* and a register */
    DATA_ALIGNMENT = -8,
    RETURN_ADDRESS = 16
};

/* DWARF's number of a register. */
static unsigned dwarf_register(unsigned reg)
{
    static const uint8_t number[] = {0, 2, 1, 3, 7, 6, 4, 5};
    return reg < sizeof number ? number[reg] : reg;
}

static void advance(struct bytes *out, uint32_t distance)
{
    if (distance && distance < 64) {
        byte(out, DW_CFA_advance_loc | distance);
    } else if (distance) {
        byte(out, DW_CFA_advance_loc4);
        bytes_append_number(out, distance, 4);
    }
}

static void add_rule(struct bytes *out, const struct debug_unwind *row)
{
    unsigned reg = dwarf_register(row->reg);
    switch ((enum debug_rule)row->rule) {
    case DEBUG_CFA:
        byte(out, DW_CFA_def_cfa);
        uleb(out, reg);
        uleb(out, (uint32_t)row->value);
        break;
    case DEBUG_SAVED:
        byte(out, DW_CFA_offset | reg);
        uleb(out, (uint32_t)(row->value / -DATA_ALIGNMENT));
        break;
    case DEBUG_RESTORED:
        byte(out, DW_CFA_same_value);
        uleb(out, reg);
        break;
    }
}

/* The rules at the first instruction of all code. */
static void add_common(struct bytes *out, enum dwarf_frame_form form)
{
    static const struct debug_unwind entry = {.rule = DEBUG_CFA, .reg = 4, .value = 8};
    size_t length = begin_length(out);
    bytes_append_number(out, form == DWARF_EH_FRAME ? 0 : UINT32_MAX, 4); /* marks the common information */
    byte(out, 1);                                                         /* version */
    byte(out, 0);                                                         /* no augmentation */
    uleb(out, 1);                                                         /* alignment of code, in bytes */
    sleb(out, DATA_ALIGNMENT);
    byte(out, RETURN_ADDRESS);
    add_rule(out, &entry);
    byte(out, DW_CFA_offset | RETURN_ADDRESS);
    uleb(out, 8 / -DATA_ALIGNMENT);
    bytes_align(out, 8); /* DW_CFA_nop */
    end_length(out, length);
}

void dwarf_frame(const struct debug_code *code, enum dwarf_frame_form form, struct bytes *out)
{
    size_t common = out->count;
    add_common(out, form);
    size_t length = begin_length(out);
    bytes_append_number(out, form == DWARF_EH_FRAME ? length - common : common, 4);
    bytes_append_number(out, (uintptr_t)code->code, 8);
    bytes_append_number(out, code->bytes, 8);
    uint32_t at = 0;
    for (uint32_t i = 0; i < code->unwinds; i++) {
        advance(out, code->unwind[i].offset - at);
        at = code->unwind[i].offset;
        add_rule(out, code->unwind + i);
    }
    bytes_align(out, 8);
    end_length(out, length);
    if (form == DWARF_EH_FRAME)
        bytes_append_number(out, 0, 4);
}

/* --- Lines --------------------------------------------------------------------------------------------- */

enum {
    DW_LNS_copy = 1,
    DW_LNS_advance_pc = 2,
    DW_LNS_advance_line = 3,
    DW_LNS_set_file = 4,
    DW_LNE_end_sequence = 1,
    DW_LNE_set_address = 2,
    FILES = 64, /* more than a routine has; further files count as the last one */
    LINE_BASE = -5,
    LINE_RANGE = 14,
    OPCODE_BASE = 13
};

struct files {
    const char *name[FILES];
    unsigned count;
};

/* Returns the number of a file, from 1. */
static unsigned file_number(struct files *files, const char *name)
{
    for (unsigned i = 0; i < files->count; i++)
        if (files->name[i] == name || !strcmp(files->name[i], name))
            return i + 1;
    if (files->count < FILES)
        files->name[files->count++] = name;
    return files->count;
}

static void add_header(const struct debug_code *code, struct files *files, struct bytes *out)
{
    static const uint8_t operands[OPCODE_BASE - 1] = {0, 1, 1, 1, 1, 0, 0, 0, 1, 0, 0, 1};
    bytes_append_number(out, 4, 2); /* version */
    size_t length = begin_length(out);
    byte(out, 1); /* shortest instruction */
    byte(out, 1); /* operations in one */
    byte(out, 1); /* every row is a statement */
    byte(out, (uint8_t)LINE_BASE);
    byte(out, LINE_RANGE);
    byte(out, OPCODE_BASE);
    bytes_append(out, operands, sizeof operands);
    if (code->folder[0])
        bytes_append_text(out, code->folder);
    byte(out, 0);
    for (uint32_t i = 0; i < code->sources; i++)
        file_number(files, code->source[i].file);
    for (unsigned i = 0; i < files->count; i++) {
        bytes_append_text(out, files->name[i]);
        uleb(out, code->folder[0] != 0);
        uleb(out, 0); /* time */
        uleb(out, 0); /* bytes */
    }
    byte(out, 0);
    end_length(out, length);
}

static void add_extended(struct bytes *out, unsigned operation, uint64_t value, size_t count)
{
    byte(out, 0);
    uleb(out, 1 + count);
    byte(out, operation);
    bytes_append_number(out, value, count);
}

void dwarf_line(const struct debug_code *code, struct bytes *out)
{
    struct files files = {.count = 0};
    size_t length = begin_length(out);
    add_header(code, &files, out);
    add_extended(out, DW_LNE_set_address, (uintptr_t)code->code, 8);
    uint32_t at = 0, line = 1;
    unsigned file = 1;
    for (uint32_t i = 0; i < code->sources; i++) {
        const struct debug_source *row = code->source + i;
        unsigned number = file_number(&files, row->file);
        byte(out, DW_LNS_advance_pc);
        uleb(out, row->offset - at);
        byte(out, DW_LNS_advance_line);
        sleb(out, (int64_t)row->line - line);
        if (number != file) {
            byte(out, DW_LNS_set_file);
            uleb(out, number);
        }
        byte(out, DW_LNS_copy);
        at = row->offset;
        line = row->line;
        file = number;
    }
    byte(out, DW_LNS_advance_pc);
    uleb(out, code->bytes - at);
    add_extended(out, DW_LNE_end_sequence, 0, 0);
    end_length(out, length);
}

/* --- The unit ------------------------------------------------------------------------------------------ */

enum {
    DW_TAG_compile_unit = 0x11,
    DW_TAG_subprogram = 0x2e,
    DW_AT_name = 0x03,
    DW_AT_stmt_list = 0x10,
    DW_AT_low_pc = 0x11,
    DW_AT_high_pc = 0x12,
    DW_AT_language = 0x13,
    DW_AT_producer = 0x25,
    DW_AT_external = 0x3f,
    DW_AT_frame_base = 0x40,
    DW_FORM_addr = 0x01,
    DW_FORM_data2 = 0x05,
    DW_FORM_data8 = 0x07,
    DW_FORM_string = 0x08,
    DW_FORM_sec_offset = 0x17,
    DW_FORM_exprloc = 0x18,
    DW_FORM_flag_present = 0x19,
    DW_LANG_C99 = 0x0c,
    DW_OP_call_frame_cfa = 0x9c,
    UNIT = 1, /* numbers of the abbreviations */
    FUNCTION = 2
};

void dwarf_abbreviations(struct bytes *out)
{
    static const uint8_t table[] = {UNIT,
                                    DW_TAG_compile_unit,
                                    1, /* with children */
                                    DW_AT_producer,
                                    DW_FORM_string,
                                    DW_AT_language,
                                    DW_FORM_data2,
                                    DW_AT_name,
                                    DW_FORM_string,
                                    DW_AT_low_pc,
                                    DW_FORM_addr,
                                    DW_AT_high_pc,
                                    DW_FORM_data8,
                                    DW_AT_stmt_list,
                                    DW_FORM_sec_offset,
                                    0,
                                    0, //
                                    FUNCTION,
                                    DW_TAG_subprogram,
                                    0,
                                    DW_AT_name,
                                    DW_FORM_string,
                                    DW_AT_external,
                                    DW_FORM_flag_present,
                                    DW_AT_low_pc,
                                    DW_FORM_addr,
                                    DW_AT_high_pc,
                                    DW_FORM_data8,
                                    DW_AT_frame_base,
                                    DW_FORM_exprloc,
                                    0,
                                    0,
                                    0};
    bytes_append(out, table, sizeof table);
}

static void add_range(const struct debug_code *code, struct bytes *out)
{
    bytes_append_number(out, (uintptr_t)code->code, 8);
    bytes_append_number(out, code->bytes, 8);
}

void dwarf_information(const struct debug_code *code, struct bytes *out)
{
    size_t length = begin_length(out);
    bytes_append_number(out, 4, 2); /* version */
    bytes_append_number(out, 0, 4); /* of .debug_abbrev */
    byte(out, 8);                   /* bytes of an address */
    uleb(out, UNIT);
    bytes_append_text(out, "Triptych");
    bytes_append_number(out, DW_LANG_C99, 2);
    bytes_append_text(out, code->name);
    add_range(code, out);
    bytes_append_number(out, 0, 4); /* of .debug_line */
    uleb(out, FUNCTION);
    bytes_append_text(out, code->name);
    add_range(code, out);
    uleb(out, 1);
    byte(out, DW_OP_call_frame_cfa);
    byte(out, 0); /* no more children */
    end_length(out, length);
}
