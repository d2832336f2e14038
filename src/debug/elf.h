/* An ELF file in memory for one routine: its symbol and its DWARF, over code that lies elsewhere. */
#ifndef DEBUG_ELF_H
#define DEBUG_ELF_H

#include "debug/dwarf.h"

/* Appends the file to `out`, which notes when memory was short. */
void elf_write(const struct debug_code *code, struct bytes *out);

#endif
