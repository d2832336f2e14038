/* The printer's parts: print.c has the function, its loops and one statement for an instruction; pixels.c has
 * the statements for packs. */
#ifndef ENGINES_EXTERNAL_PRINT_PART_H
#define ENGINES_EXTERNAL_PRINT_PART_H

#include "engines/external/external.h"
#include "engines/external/pack.h"

struct printer {
    const struct ir *ir;
    FILE *out;
    int depth;
    const struct lanes *lanes; /* null: a value is all lanes */
    const struct packs *packs; /* of c=pixels, else null */
    uint8_t *printed;          /* by instruction: its pack is printed */
    uint32_t group;            /* the open loop over lanes; 0: none */
};

extern const char *const external_type_word[];

void external_begin_line(const struct printer *p);

/* Writes the comment with the number and the source of an instruction. */
void external_end_line(const struct printer *p, const struct ir_instruction *i);

/* Writes the name of a value. */
void external_print_name(const struct printer *p, uint16_t number);

/* Writes the address base + k. */
void external_print_address(const struct printer *p, const struct ir_instruction *i);

/* Writes the conversion of an integer to a value of type `to`, or what precedes and follows it. */
void external_begin_cast(const struct printer *p, enum ir_type to);
void external_end_cast(const struct printer *p, enum ir_type to);

/* Of pixels.c: writes the statements of an instruction in a loop over pixels, and before them those that it
 * needs; a condition on the mask `number`; the declarations of arrays that other loops use. */
void external_print_pixel(struct printer *p, uint32_t number);
void external_print_pixel_any(const struct printer *p, uint16_t number);
void external_declare_pixels(const struct printer *p, uint32_t number);

#endif
