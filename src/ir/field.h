/* The fields of the structures that routines read and write (def/state/record.def), found by offset. */
#ifndef IR_FIELD_H
#define IR_FIELD_H

#include "ir/ir.h"

/* A record of def/state/record.def; IR_RECORD_words: words of any type. */
enum ir_record {
    IR_RECORD_words,
#define RECORD(record, type) IR_RECORD_##record,
#define FIELD(...)
#define PART(...)
#define POINTER(...)
#define PLACE(...)
#include "def/state/record.def"
#undef RECORD
#undef FIELD
#undef PART
#undef POINTER
#undef PLACE
    IR_RECORD_COUNT
};

enum { IR_FIELD_TEXT = 96 };

struct ir_field {
    uint8_t type;             /* enum ir_type; TYPE_non: words of any type */
    bool pointer, named;      /* named: `name` is stored too */
    enum ir_record target;    /* of a pointer */
    char name[IR_FIELD_TEXT]; /* "texture[0].width"; "" for words of any type */
};

/* Finds the field of a record that begins at a byte, or the element of it. Returns false if no field does.
 * For tests: every field of a record. */
bool ir_find_field(enum ir_record record, int64_t offset, struct ir_field *field);

/* Finds the memory that an instruction reads or writes, in a program with a unit: the field, and for a gather
 * by a pointer that pointer. Returns null, or the reason why there is none. */
const char *ir_find_memory(const struct ir *ir, const struct ir_instruction *instruction,
                           struct ir_field *pointer, struct ir_field *field);

/* The same without the names, which take most of the time. */
const char *ir_find_unnamed(const struct ir *ir, const struct ir_instruction *instruction,
                            struct ir_field *pointer, struct ir_field *field);

#endif
