/* GDB's interface for generated code: a list of ELF files in memory, and a function in which GDB sets a
 * breakpoint; it is called after each change of the list.
 *
 * Source: Debugging with GDB, chapter "JIT Compilation Interface", which defines the names and layouts. The
 * symbols are weak, so that another code generator can be linked into the same program. A debugger that
 * attaches later reads the whole list. */
#include "debug/debug.h"
#include "debug/elf.h"

#include <pthread.h>
#include <stdlib.h>

enum { JIT_NOACTION, JIT_REGISTER_FN, JIT_UNREGISTER_FN };

struct jit_code_entry {
    struct jit_code_entry *next_entry, *prev_entry;
    const char *symfile_addr;
    uint64_t symfile_size;
};

struct jit_descriptor {
    uint32_t version;
    uint32_t action_flag;
    struct jit_code_entry *relevant_entry;
    struct jit_code_entry *first_entry;
};

__attribute__((weak)) struct jit_descriptor __jit_debug_descriptor = {1, JIT_NOACTION, NULL, NULL};

void __jit_debug_register_code(void);

__attribute__((weak, noinline)) void __jit_debug_register_code(void)
{
    __asm__ volatile("" ::: "memory");
}

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static void notify(uint32_t action, struct jit_code_entry *entry)
{
    __jit_debug_descriptor.action_flag = action;
    __jit_debug_descriptor.relevant_entry = entry;
    __jit_debug_register_code();
    __jit_debug_descriptor.action_flag = JIT_NOACTION;
    __jit_debug_descriptor.relevant_entry = NULL;
}

static int open_list(struct error *error)
{
    (void)error;
    return 0;
}

static void insert(struct jit_code_entry *entry)
{
    pthread_mutex_lock(&lock);
    entry->next_entry = __jit_debug_descriptor.first_entry;
    if (entry->next_entry)
        entry->next_entry->prev_entry = entry;
    __jit_debug_descriptor.first_entry = entry;
    notify(JIT_REGISTER_FN, entry);
    pthread_mutex_unlock(&lock);
}

static int add(const struct debug_code *code, void **record, struct error *error)
{
    struct bytes file = {0};
    struct jit_code_entry *entry = calloc(1, sizeof *entry);
    elf_write(code, &file);
    if (!entry || file.failed) {
        free(entry);
        bytes_free(&file);
        return error_set(error, "out of memory for registering %s with GDB", code->name);
    }
    entry->symfile_addr = (const char *)file.data;
    entry->symfile_size = file.count;
    insert(entry);
    *record = entry;
    return 0;
}

static void remove_entry(void *record)
{
    struct jit_code_entry *entry = record;
    pthread_mutex_lock(&lock);
    if (entry->prev_entry)
        entry->prev_entry->next_entry = entry->next_entry;
    else
        __jit_debug_descriptor.first_entry = entry->next_entry;
    if (entry->next_entry)
        entry->next_entry->prev_entry = entry->prev_entry;
    notify(JIT_UNREGISTER_FN, entry);
    pthread_mutex_unlock(&lock);
    free((char *)(uintptr_t)entry->symfile_addr);
    free(entry);
}

const struct debug_interface debug_to_gdb = {open_list, add, remove_entry};
