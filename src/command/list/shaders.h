/* `triptych list shaders`: the tables of shader models as JSON, as text, and as the page docs/shaders.md. */
#ifndef COMMAND_LIST_SHADERS_H
#define COMMAND_LIST_SHADERS_H

#include <cjson/cJSON.h>
#include <stdio.h>

/* Adds an object for each instruction to the array. */
void shaders_list(cJSON *rows);

/* Prints models, registers and instructions. */
void shaders_print(FILE *out);

/* Prints the page docs/shaders.md. */
void shaders_print_markdown(FILE *out);

#endif
