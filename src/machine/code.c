#define _GNU_SOURCE /* memfd_create */
#include "machine/code.h"

#include "machine/code_block.h"

#include <assert.h>
#include <errno.h>
#include <linux/membarrier.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

/* A processor may have fetched the old bytes of memory that held code before. A write through another linear
 * address need not invalidate them (Intel SDM volume 3, "Self-Modifying Code"). So a commit into recycled
 * memory serializes every core that runs this process, if the kernel supports it. New memory, the usual case,
 * needs no such step. */

enum {
    DEFAULT_BYTES = 64 << 20,
    TRAP = 0xCC,
    AHEAD = 32 << 10,  /* bytes of pages that are populated ahead of need, */
    BEGIN = 256 << 10, /* and when an arena is created */
};

/* Since Linux 5.14. Older kernels reject it, and the C library's headers may lack it. */
#ifndef MADV_POPULATE_WRITE
#define MADV_POPULATE_WRITE 23
#endif

struct code_arena {
    uint8_t *writable;
    uint8_t *executable;
    size_t capacity;
    size_t unit; /* bytes */
    enum code_purpose purpose;
    size_t populated;          /* bytes from the start whose pages are known to be populated */
    pthread_mutex_t mutex;     /* guards all members below */
    struct code_blocks blocks; /* of CODE_ALIGNMENT bytes or of a page */
    uint32_t recycled_from;    /* [from, to): memory where code has been freed */
    uint32_t recycled_to;
    bool can_serialize;
    size_t refused; /* bytes of the last reservation that found no hole, or 0 */
};

static int native_create_file(const char *name, unsigned flags)
{
    return memfd_create(name, flags);
}

static int native_set_size(int file, off_t bytes)
{
    return ftruncate(file, bytes);
}

static void *native_map(void *address, size_t bytes, int protection, int flags, int file, off_t offset)
{
    return mmap(address, bytes, protection, flags, file, offset);
}

const struct code_system code_system_native = {native_create_file, native_set_size, native_map};

/* --- Spans and units --- */

static uint32_t unit_count(const struct code_arena *arena, size_t bytes)
{
    return (uint32_t)((bytes + arena->unit - 1) / arena->unit);
}

static uint32_t first_unit(const struct code_arena *arena, const struct code_span *span)
{
    return CODE_FIRST_UNIT + (uint32_t)((size_t)(span->writable - arena->writable) / arena->unit);
}

static struct code_span span_of(const struct code_arena *arena, uint32_t first, uint32_t count)
{
    size_t offset = (size_t)(first - CODE_FIRST_UNIT) * arena->unit;
    return (struct code_span){arena->writable + offset, arena->executable + offset,
                              (size_t)count * arena->unit};
}

/* Populates the pages up to `end`, and some ahead of it. Page faults one by one cost several times as much,
 * more than stitching the code in the page. Two threads may populate the same pages, which is harmless. */
static void populate(struct code_arena *arena, size_t end)
{
    size_t from = __atomic_load_n(&arena->populated, __ATOMIC_RELAXED);
    if (end <= from)
        return;
    size_t to = end - from < AHEAD ? from + AHEAD : (end + AHEAD - 1) / AHEAD * AHEAD;
    if (to > arena->capacity)
        to = arena->capacity;
    if (madvise(arena->writable + from, to - from, MADV_POPULATE_WRITE))
        to = arena->capacity; /* refused: do not try again */
    __atomic_store_n(&arena->populated, to, __ATOMIC_RELAXED);
}

int code_reserve(struct code_arena *arena, size_t bytes, struct code_span *span, struct error *error)
{
    assert(bytes);
    uint32_t first = CODE_NO_BLOCK, count = bytes <= arena->capacity ? unit_count(arena, bytes) : 0;
    pthread_mutex_lock(&arena->mutex);
    if (count)
        first = code_blocks_find(&arena->blocks, count);
    if (first != CODE_NO_BLOCK)
        code_blocks_take(&arena->blocks, first, count);
    arena->refused = first == CODE_NO_BLOCK ? bytes : 0;
    size_t used = arena->blocks.used * arena->unit;
    pthread_mutex_unlock(&arena->mutex);
    if (first == CODE_NO_BLOCK) {
        *span = (struct code_span){0};
        return error_set(error, "code arena: no hole of %zu bytes (%zu of %zu bytes are used)", bytes, used,
                         arena->capacity);
    }
    *span = span_of(arena, first, count);
    populate(arena, (size_t)(span->writable - arena->writable) + span->bytes);
    return 0;
}

size_t code_refused(struct code_arena *arena)
{
    pthread_mutex_lock(&arena->mutex);
    size_t refused = arena->refused;
    pthread_mutex_unlock(&arena->mutex);
    return refused;
}

/* Restores the file's pages in the executable view, where a debugger has written its own copies. */
static void forget_breakpoints(const struct code_arena *arena, const struct code_span *span)
{
    if (arena->purpose == CODE_TO_DEBUG)
        madvise((void *)(uintptr_t)span->executable, span->bytes, MADV_DONTNEED);
}

const void *code_commit(struct code_arena *arena, struct code_span *span, size_t bytes)
{
    assert(bytes && bytes <= span->bytes);
    size_t dirty = bytes + arena->unit < span->bytes ? bytes + arena->unit : span->bytes;
    memset(span->writable + bytes, TRAP, dirty - bytes);

    uint32_t count = unit_count(arena, bytes), reserved = unit_count(arena, span->bytes);
    pthread_mutex_lock(&arena->mutex);
    uint32_t first = first_unit(arena, span);
    assert(code_blocks_is_used(&arena->blocks, first, reserved));
    uint32_t hole = code_blocks_find_tighter(&arena->blocks, first, count);
    if (hole != CODE_NO_BLOCK) {
        code_blocks_take(&arena->blocks, hole, count);
        struct code_span moved = span_of(arena, hole, count);
        memcpy(moved.writable, span->writable, moved.bytes);
        memset(span->writable, TRAP, dirty);
        code_blocks_release(&arena->blocks, first, reserved);
        first = hole;
    } else {
        code_blocks_shrink(&arena->blocks, first, count);
    }
    bool recycled = first < arena->recycled_to && first + count > arena->recycled_from;
    pthread_mutex_unlock(&arena->mutex);

    *span = span_of(arena, first, count);
    forget_breakpoints(arena, span);
    if (recycled && arena->can_serialize)
        syscall(SYS_membarrier, MEMBARRIER_CMD_PRIVATE_EXPEDITED_SYNC_CORE, 0, 0);
    return span->executable;
}

bool code_can_patch(const struct code_arena *arena)
{
    return arena->can_serialize;
}

void code_patch(struct code_arena *arena, const struct code_span *span, const struct code_word *words,
                size_t count)
{
    assert(arena->can_serialize);
    for (size_t i = 0; i < count; i++) {
        assert(words[i].offset + sizeof words[i].value <= span->bytes);
        memcpy(span->writable + words[i].offset, &words[i].value, sizeof words[i].value);
    }
    forget_breakpoints(arena, span);
    syscall(SYS_membarrier, MEMBARRIER_CMD_PRIVATE_EXPEDITED_SYNC_CORE, 0, 0);
}

void code_free(struct code_arena *arena, struct code_span *span)
{
    if (!span->bytes)
        return;
    memset(span->writable, TRAP, span->bytes);
    forget_breakpoints(arena, span);
    uint32_t count = unit_count(arena, span->bytes);
    pthread_mutex_lock(&arena->mutex);
    uint32_t first = first_unit(arena, span);
    assert(code_blocks_is_used(&arena->blocks, first, count));
    code_blocks_release(&arena->blocks, first, count);
    if (arena->recycled_from > first)
        arena->recycled_from = first;
    if (arena->recycled_to < first + count)
        arena->recycled_to = first + count;
    pthread_mutex_unlock(&arena->mutex);
    *span = (struct code_span){0};
}

/* --- The arena --- */

/* Since Linux 6.3 a memfd to be executed has a flag; older kernels reject it. */
static int create_file(const struct code_system *system)
{
    const unsigned executable = 0x10; /* MFD_EXEC */
    int file = system->create_file("triptych-code", MFD_CLOEXEC | executable);
    if (file < 0 && errno == EINVAL)
        file = system->create_file("triptych-code", MFD_CLOEXEC);
    return file;
}

/* Maps both views, or none. */
static int map_views(struct code_arena *arena, const struct code_system *system, int file,
                     struct error *error)
{
    size_t bytes = arena->capacity;
    if (system->set_size(file, (off_t)bytes))
        return error_set(error, "code arena: cannot size a memory file to %zu bytes: %s", bytes,
                         strerror(errno));
    void *writable = system->map(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (writable == MAP_FAILED)
        return error_set(error, "code arena: cannot map %zu bytes writable: %s", bytes, strerror(errno));
    void *executable = system->map(NULL, bytes, PROT_READ | PROT_EXEC,
                                   arena->purpose == CODE_TO_DEBUG ? MAP_PRIVATE : MAP_SHARED, file, 0);
    if (executable == MAP_FAILED) {
        int reason = errno;
        munmap(writable, bytes);
        return error_set(error, "code arena: cannot map %zu bytes executable: %s", bytes, strerror(reason));
    }
    arena->writable = writable;
    arena->executable = executable;
    return 0;
}

static int map_without_file(struct code_arena *arena, const struct code_system *system, struct error *error)
{
    size_t bytes = arena->capacity;
    void *writable = system->map(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (writable == MAP_FAILED)
        return error_set(error, "code arena: cannot map %zu bytes writable: %s", bytes, strerror(errno));
    void *executable =
        mremap(writable, 0, bytes, MREMAP_MAYMOVE); /* of shared memory, size 0 creates a second view */
    if (executable == MAP_FAILED || mprotect(executable, bytes, PROT_READ | PROT_EXEC)) {
        int reason = errno;
        munmap(writable, bytes);
        if (executable != MAP_FAILED)
            munmap(executable, bytes);
        return error_set(error, "code arena: cannot map %zu bytes executable: %s", bytes, strerror(reason));
    }
    arena->writable = writable;
    arena->executable = executable;
    return 0;
}

static int map_memory(struct code_arena *arena, const struct code_system *system, struct error *error)
{
    if (arena->purpose == CODE_TO_PROFILE)
        return map_without_file(arena, system, error);
    int file = create_file(system);
    if (file < 0)
        return error_set(error, "code arena: cannot create a memory file: %s", strerror(errno));
    int result = map_views(arena, system, file, error);
    close(file);
    return result;
}

static struct code_arena *allocate(size_t capacity, size_t unit, struct error *error)
{
    struct code_arena *arena = calloc(1, sizeof *arena);
    if (!arena || code_blocks_create(&arena->blocks, (uint32_t)(capacity / unit))) {
        free(arena);
        error_set(error, "code arena: out of memory for the bookkeeping of %zu bytes", capacity);
        return NULL;
    }
    arena->capacity = capacity;
    arena->unit = unit;
    arena->recycled_from = UINT32_MAX;
    arena->can_serialize =
        !syscall(SYS_membarrier, MEMBARRIER_CMD_REGISTER_PRIVATE_EXPEDITED_SYNC_CORE, 0, 0);
    pthread_mutex_init(&arena->mutex, NULL);
    return arena;
}

struct code_arena *code_create_for(enum code_purpose purpose, size_t bytes, const struct code_system *system,
                                   struct error *error)
{
    const size_t most = (size_t)2 << 30, page = (size_t)sysconf(_SC_PAGESIZE);
    if (bytes > most) {
        error_set(error, "code arena: %zu bytes requested, expected at most %zu", bytes, most);
        return NULL;
    }
    size_t capacity = bytes ? (bytes + page - 1) / page * page : DEFAULT_BYTES;
    struct code_arena *arena = allocate(capacity, purpose == CODE_TO_DEBUG ? page : CODE_ALIGNMENT, error);
    if (!arena)
        return NULL;
    arena->purpose = purpose;
    if (map_memory(arena, system ? system : &code_system_native, error)) {
        code_destroy(arena);
        return NULL;
    }
    populate(arena, bytes && bytes < BEGIN ? bytes : BEGIN);
    return arena;
}

struct code_arena *code_create(size_t bytes, const struct code_system *system, struct error *error)
{
    return code_create_for(CODE_TO_RUN, bytes, system, error);
}

void code_destroy(struct code_arena *arena)
{
    if (!arena)
        return;
    if (arena->writable) {
        munmap(arena->writable, arena->capacity);
        munmap(arena->executable, arena->capacity);
    }
    pthread_mutex_destroy(&arena->mutex);
    code_blocks_destroy(&arena->blocks);
    free(arena);
}

/* Runs a function that returns ANSWER: it is written in one view and must run in the other. */
static int try_arena(struct code_arena *arena, struct error *error)
{
    enum { ANSWER = 0x54726970 };
    static const uint8_t answer[] = {0xb8, 0x70, 0x69, 0x72, 0x54, 0xc3}; /* mov eax, ANSWER; ret */
    struct code_span span;
    if (code_reserve(arena, sizeof answer, &span, error))
        return -1;
    memcpy(span.writable, answer, sizeof answer);
    int (*function)(void) = (int (*)(void))(uintptr_t)code_commit(arena, &span, sizeof answer);
    int given = function();
    code_free(arena, &span);
    return given == ANSWER ? 0 : error_set(error, "code arena: what is written is not what runs");
}

const char *code_unavailable(void)
{
    static _Thread_local char text[ERROR_CAPACITY + 32];
    struct error error = {{0}};
    struct code_arena *arena = code_create(1, NULL, &error);
    int result = arena ? try_arena(arena, &error) : -1;
    code_destroy(arena);
    if (!result)
        return NULL;
    snprintf(text, sizeof text, "needs executable memory; %s", error.text);
    return text;
}

bool code_contains(const struct code_arena *arena, const void *executable)
{
    return (uintptr_t)executable - (uintptr_t)arena->executable < arena->capacity;
}

const void *code_executable(const struct code_arena *arena, const void *writable)
{
    return arena->executable + ((const uint8_t *)writable - arena->writable);
}

void *code_writable(const struct code_arena *arena, const void *executable)
{
    return arena->writable + ((const uint8_t *)executable - arena->executable);
}

struct code_statistics code_statistics(struct code_arena *arena)
{
    pthread_mutex_lock(&arena->mutex);
    struct code_statistics statistics = {
        .capacity = arena->capacity,
        .used = arena->blocks.used * arena->unit,
        .peak = arena->blocks.peak * arena->unit,
        .free_spans = arena->blocks.free,
        .largest_free = code_blocks_largest(&arena->blocks) * arena->unit,
    };
    pthread_mutex_unlock(&arena->mutex);
    return statistics;
}
