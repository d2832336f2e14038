/* The parts of the assembler: statements (assemble.c) and their operands (operand.c). */
#ifndef SHADER_ASSEMBLE_H
#define SHADER_ASSEMBLE_H

#include "shader/scan.h"
#include "shader/shader.h"

struct assembler {
    struct scanner scanner;
    struct shader *shader;
};

/* The operand at the current token; the reason says what was expected. The mask of a destination is MASK_FULL
 * if none is written. */
int parse_source(struct assembler *assembler, struct shader_operand *operand);
int parse_destination(struct assembler *assembler, struct shader_operand *operand);

/* A register without anything before or behind it. */
int parse_register(struct assembler *assembler, struct shader_operand *operand);

#endif
