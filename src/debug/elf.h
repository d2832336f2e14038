/* An ELF file in memory for one routine, with its symbol and its DWARF. It does not contain the code. */
#ifndef DEBUG_ELF_H
#define DEBUG_ELF_H

#include "debug/dwarf.h"

/* Appends the file to `out`. A failed allocation sets out->failed. */
void elf_write(const struct debug_code *code, struct bytes *out);

#endif
