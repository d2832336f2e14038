/* `triptych list shaders`: the tables of shader models for programs, for people, and as docs/shaders.md. */
#ifndef TOOL_SHADERS_H
#define TOOL_SHADERS_H

#include <cjson/cJSON.h>
#include <stdio.h>

/* Adds an object per instruction to the array. */
void shaders_list(cJSON *rows);

/* Models, registers and instructions. */
void shaders_print(FILE *out);

/* The whole page. */
void shaders_print_markdown(FILE *out);

#endif
