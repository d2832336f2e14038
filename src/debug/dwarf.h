/* The parts of DWARF that a routine needs: lines, unwinding, and a unit and a function with its name.
 *
 * Sources: DWARF Debugging Information Format, version 4; System V ABI, AMD64 supplement, section 3.6.2
 * (registers); Linux Standard Base 5.0, section 10.6 (.eh_frame). */
#ifndef DEBUG_DWARF_H
#define DEBUG_DWARF_H

#include "debug/code.h"

/* A growing array of bytes. A failed allocation sets `failed`. */
struct bytes {
    uint8_t *data;
    size_t count, capacity;
    bool failed;
};

void bytes_append(struct bytes *bytes, const void *data, size_t count);
void bytes_append_number(struct bytes *bytes, uint64_t value, size_t count); /* little-endian */
void bytes_append_text(struct bytes *bytes, const char *text);               /* with its terminating zero */
void bytes_align(struct bytes *bytes, size_t alignment);                     /* with zeros */
void bytes_free(struct bytes *bytes);

/* The two forms of call frame information: the section for debuggers, and the form for the process's own
 * unwinder, which ends with a zero. Addresses are absolute in both. */
enum dwarf_frame_form { DWARF_DEBUG_FRAME, DWARF_EH_FRAME };
void dwarf_frame(const struct debug_code *code, enum dwarf_frame_form form, struct bytes *out);

/* .debug_line, .debug_info and .debug_abbrev of the same code. */
void dwarf_line(const struct debug_code *code, struct bytes *out);
void dwarf_information(const struct debug_code *code, struct bytes *out);
void dwarf_abbreviations(struct bytes *out);

#endif
