#define _GNU_SOURCE /* dl_iterate_phdr */
#include "command/store/build.h"

#include <elf.h>
#include <link.h>
#include <stdbool.h>
#include <string.h>

struct search {
    uintptr_t address; /* in the object */
    const uint8_t *id;
    size_t bytes;
};

static bool contains(const struct dl_phdr_info *object, uintptr_t address)
{
    for (int i = 0; i < object->dlpi_phnum; i++) {
        const ElfW(Phdr) *segment = &object->dlpi_phdr[i];
        uintptr_t start = object->dlpi_addr + segment->p_vaddr;
        if (segment->p_type == PT_LOAD && address - start < segment->p_memsz)
            return true;
    }
    return false;
}

/* Notes are a head, a name and contents, each padded to four bytes. */
static void search_notes(struct search *search, const uint8_t *at, size_t bytes)
{
    static const char name[] = "GNU";
    ElfW(Nhdr) note;
    while (bytes >= sizeof note) {
        memcpy(&note, at, sizeof note);
        size_t named = ((size_t)note.n_namesz + 3) & ~(size_t)3,
               contents = ((size_t)note.n_descsz + 3) & ~(size_t)3;
        if (named + contents > bytes - sizeof note)
            return;
        if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == sizeof name &&
            !memcmp(at + sizeof note, name, sizeof name)) {
            search->id = at + sizeof note + named;
            search->bytes = note.n_descsz;
            return;
        }
        at += sizeof note + named + contents;
        bytes -= sizeof note + named + contents;
    }
}

static int search_object(struct dl_phdr_info *object, size_t size, void *user)
{
    struct search *search = user;
    (void)size;
    if (!contains(object, search->address))
        return 0;
    for (int i = 0; i < object->dlpi_phnum && !search->id; i++) {
        const ElfW(Phdr) *segment = &object->dlpi_phdr[i];
        const uint8_t *notes = (const uint8_t *)object->dlpi_addr + segment->p_vaddr;
        if (segment->p_type == PT_NOTE)
            search_notes(search, notes, segment->p_filesz);
    }
    return 1;
}

const uint8_t *store_build_id(size_t *bytes)
{
    struct search search = {.address = (uintptr_t)search_object};
    dl_iterate_phdr(search_object, &search);
    *bytes = search.bytes;
    return search.id;
}
