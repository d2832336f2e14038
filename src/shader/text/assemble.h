/* The parts of the assembler: statements (assemble.c) and their operands (operand.c). */
#ifndef SHADER_TEXT_ASSEMBLE_H
#define SHADER_TEXT_ASSEMBLE_H

#include "shader/text/scan.h"
#include "shader/shader.h"

struct assembler {
    struct scanner scanner;
    struct shader *shader;
};

/* Reads the operand at the current token. On failure the reason names the expected token. The mask of a
 * destination is MASK_FULL if none is written. */
int assemble_source(struct assembler *assembler, struct shader_operand *operand);
int assemble_destination(struct assembler *assembler, struct shader_operand *operand);

#endif
