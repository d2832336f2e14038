/* The file is the header, the contents of the sections, and the table of sections. .text has the address of
 * the code and no contents: a debugger reads the instructions from the process. All addresses are final. */
#include "debug/elf.h"

#include <elf.h>
#include <string.h>

enum section {
    SECTION_NONE,
    SECTION_TEXT,
    SECTION_INFORMATION,
    SECTION_ABBREVIATIONS,
    SECTION_LINE,
    SECTION_FRAME,
    SECTION_SYMBOLS,
    SECTION_STRINGS,
    SECTION_NAMES,
    SECTION_COUNT
};

static const struct {
    const char *name;
    uint32_t type;
} sections[SECTION_COUNT] = {
    [SECTION_NONE] = {"", SHT_NULL},
    [SECTION_TEXT] = {".text", SHT_NOBITS},
    [SECTION_INFORMATION] = {".debug_info", SHT_PROGBITS},
    [SECTION_ABBREVIATIONS] = {".debug_abbrev", SHT_PROGBITS},
    [SECTION_LINE] = {".debug_line", SHT_PROGBITS},
    [SECTION_FRAME] = {".debug_frame", SHT_PROGBITS},
    [SECTION_SYMBOLS] = {".symtab", SHT_SYMTAB},
    [SECTION_STRINGS] = {".strtab", SHT_STRTAB},
    [SECTION_NAMES] = {".shstrtab", SHT_STRTAB},
};

static void write_names(struct bytes *out, Elf64_Shdr *header)
{
    size_t start = out->count;
    for (int i = 0; i < SECTION_COUNT; i++) {
        header[i].sh_name = (uint32_t)(out->count - start);
        bytes_append_text(out, sections[i].name);
    }
}

static void write_symbols(const struct debug_code *code, struct bytes *out)
{
    const Elf64_Sym symbols[] = {{0},
                                 {.st_name = 1,
                                  .st_info = ELF64_ST_INFO(STB_GLOBAL, STT_FUNC),
                                  .st_shndx = SECTION_TEXT,
                                  .st_value = (uintptr_t)code->code,
                                  .st_size = code->bytes}};
    bytes_append(out, symbols, sizeof symbols);
}

static void write_contents(const struct debug_code *code, enum section section, struct bytes *out,
                           Elf64_Shdr *header)
{
    switch (section) {
    case SECTION_INFORMATION: dwarf_information(code, out); break;
    case SECTION_ABBREVIATIONS: dwarf_abbreviations(out); break;
    case SECTION_LINE: dwarf_line(code, out); break;
    case SECTION_FRAME: dwarf_frame(code, DWARF_DEBUG_FRAME, out); break;
    case SECTION_SYMBOLS: write_symbols(code, out); break;
    case SECTION_STRINGS:
        bytes_append_number(out, 0, 1);
        bytes_append_text(out, code->name);
        break;
    case SECTION_NAMES: write_names(out, header); break;
    default: break;
    }
}

static void write_sections(const struct debug_code *code, struct bytes *out, Elf64_Shdr *header)
{
    for (int i = 0; i < SECTION_COUNT; i++) {
        struct bytes contents = {0};
        write_contents(code, i, &contents, header);
        header[i].sh_type = sections[i].type;
        header[i].sh_addralign = i ? 8 : 0;
        header[i].sh_offset = i ? out->count : 0;
        header[i].sh_size = contents.count;
        bytes_append(out, contents.data, contents.count);
        out->failed |= contents.failed;
        bytes_free(&contents);
        bytes_align(out, 8);
    }
    header[SECTION_TEXT].sh_flags = SHF_ALLOC | SHF_EXECINSTR;
    header[SECTION_TEXT].sh_addr = (uintptr_t)code->code;
    header[SECTION_TEXT].sh_size = code->bytes;
    header[SECTION_TEXT].sh_addralign = 1;
    header[SECTION_SYMBOLS].sh_link = SECTION_STRINGS;
    header[SECTION_SYMBOLS].sh_info = 1; /* the first global symbol */
    header[SECTION_SYMBOLS].sh_entsize = sizeof(Elf64_Sym);
}

void elf_write(const struct debug_code *code, struct bytes *out)
{
    Elf64_Shdr header[SECTION_COUNT] = {0};
    Elf64_Ehdr file = {.e_ident = {ELFMAG0, ELFMAG1, ELFMAG2, ELFMAG3, ELFCLASS64, ELFDATA2LSB, EV_CURRENT},
                       .e_type = ET_EXEC,
                       .e_machine = EM_X86_64,
                       .e_version = EV_CURRENT,
                       .e_ehsize = sizeof file,
                       .e_shentsize = sizeof *header,
                       .e_shnum = SECTION_COUNT,
                       .e_shstrndx = SECTION_NAMES};
    size_t start = out->count;
    bytes_append(out, &file, sizeof file);
    write_sections(code, out, header);
    file.e_shoff = out->count - start;
    bytes_append(out, header, sizeof header);
    if (!out->failed)
        memcpy(out->data + start, &file, sizeof file);
}
