/* Jitdump: the code of each routine, its lines and the time of its registration. `perf inject --jit` makes an
 * ELF file of each. Source: the Linux kernel's tools/perf/Documentation/jitdump-specification.txt, version 1.
 *
 * perf finds the file because the process maps a page of it as executable, which leaves an event in perf's
 * data; the page is never executed. Times are CLOCK_MONOTONIC, so perf needs `-k mono`. If new code has the
 * address of code that was freed, the later record is valid from its time on. */
#define _GNU_SOURCE /* secure_getenv, gettid */
#include "base/clock.h"
#include "debug/debug.h"
#include "debug/log.h"

#include <elf.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { MAGIC = 0x4a695444, VERSION = 1, JIT_CODE_LOAD = 0, JIT_CODE_DEBUG_INFO = 2, HEADER_BYTES = 40 };

static struct log dump = {.lock = PTHREAD_MUTEX_INITIALIZER};
static atomic_uint_least64_t next_index;

static int write_header(struct error *error)
{
    struct bytes header = {0};
    bytes_append_number(&header, MAGIC, 4);
    bytes_append_number(&header, VERSION, 4);
    bytes_append_number(&header, HEADER_BYTES, 4);
    bytes_append_number(&header, EM_X86_64, 4);
    bytes_append_number(&header, 0, 4);
    bytes_append_number(&header, (uint64_t)getpid(), 4);
    bytes_append_number(&header, clock_ns(), 8);
    bytes_append_number(&header, 0, 8); /* flags: times are not the processor's time stamp counter */
    int result = log_append(&dump, &header, error);
    bytes_free(&header);
    return result;
}

/* The page stays mapped until the process ends. */
static int map_marker(struct error *error)
{
    void *page = mmap(NULL, (size_t)sysconf(_SC_PAGESIZE), PROT_READ | PROT_EXEC, MAP_PRIVATE, dump.file, 0);
    if (page != MAP_FAILED)
        return 0;
    return error_set(error, "%s: perf cannot find it, since it cannot be mapped as executable: %s", dump.path,
                     strerror(errno));
}

static int open_dump(struct error *error)
{
    char path[LOG_PATH_CAPACITY];
    const char *folder = secure_getenv("JITDUMPDIR");
    int length =
        snprintf(path, sizeof path, "%s/jit-%d.dump", folder && *folder ? folder : ".", (int)getpid());
    if (length >= (int)sizeof path)
        return error_set(error, "JITDUMPDIR is too long a path");
    int made = log_open(&dump, path, error);
    if (made == 1)
        return write_header(error) || map_marker(error) ? -1 : 0;
    return made;
}

/* end_record fills in the length. */
static size_t begin_record(struct bytes *out, unsigned kind)
{
    bytes_append_number(out, kind, 4);
    bytes_append_number(out, 0, 4);
    bytes_append_number(out, clock_ns(), 8);
    return out->count - 16;
}

static void end_record(struct bytes *out, size_t begin)
{
    uint32_t length = (uint32_t)(out->count - begin);
    if (!out->failed)
        memcpy(out->data + begin + 4, &length, sizeof length);
}

static void add_lines(const struct debug_code *code, struct bytes *out)
{
    char path[256];
    size_t begin = begin_record(out, JIT_CODE_DEBUG_INFO);
    bytes_append_number(out, (uintptr_t)code->code, 8);
    bytes_append_number(out, code->sources, 8);
    for (uint32_t i = 0; i < code->sources; i++) {
        const struct debug_source *row = code->source + i;
        snprintf(path, sizeof path, "%s%s%s", code->folder, code->folder[0] ? "/" : "", row->file);
        bytes_append_number(out, (uintptr_t)code->code + row->offset, 8);
        bytes_append_number(out, row->line, 4);
        bytes_append_number(out, 0, 4); /* discriminator */
        bytes_append_text(out, path);
    }
    end_record(out, begin);
}

static void add_load(const struct debug_code *code, struct bytes *out)
{
    size_t begin = begin_record(out, JIT_CODE_LOAD);
    bytes_append_number(out, (uint64_t)getpid(), 4);
    bytes_append_number(out, (uint64_t)gettid(), 4);
    bytes_append_number(out, (uintptr_t)code->code, 8);
    bytes_append_number(out, (uintptr_t)code->code, 8);
    bytes_append_number(out, code->bytes, 8);
    bytes_append_number(out, atomic_fetch_add(&next_index, 1), 8);
    bytes_append_text(out, code->name);
    bytes_append(out, code->code, code->bytes);
    end_record(out, begin);
}

/* Lines belong to the load record after them. */
static int add(const struct debug_code *code, void **record, struct error *error)
{
    struct bytes records = {0};
    (void)record;
    if (code->sources)
        add_lines(code, &records);
    add_load(code, &records);
    int result = log_append(&dump, &records, error);
    bytes_free(&records);
    return result;
}

const struct debug_interface debug_to_jitdump = {open_dump, add, NULL};
