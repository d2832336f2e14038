#define _GNU_SOURCE /* memfd_create */
#include "base/code.h"

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

/* The allocator. Memory is counted in units, of CODE_ALIGNMENT bytes or of a page, and is tiled by blocks, free or used. A
 * side array has one entry per unit; a block describes itself in the entries of its first and last unit
 * (boundary tags), so that a released block finds both neighbours at once and no two free blocks ever touch.
 * Free blocks hang in lists by the logarithm of their size. The array is zero pages until used, and a zero
 * entry is a used one: the sentinels before the first and after the last unit come for free. Released memory
 * never needs an allocation, so code_free cannot fail.
 *
 * A processor may have fetched the old bytes of memory that held code before, and writing through another
 * linear address does not promise to correct it (Intel SDM volume 3, "Self-Modifying Code"). Hence a commit
 * into memory that has been freed makes every core that runs this process serialize, where the kernel offers
 * it. Fresh memory, the usual case, needs nothing. */

enum {
    DEFAULT_BYTES = 64 << 20,
    TRAP = 0xCC,
    LIST_COUNT = 32,
    NO_BLOCK = 0, /* unit 0 is the sentinel, so it starts no block */
    FIRST_UNIT = 1,
    AHEAD = 32 << 10,  /* bytes of pages that are had at once, */
    BEGIN = 256 << 10, /* and when an arena is made */
};

/* Linux 5.14; earlier kernels do not know it, nor may the C library's headers. */
#ifndef MADV_POPULATE_WRITE
#define MADV_POPULATE_WRITE 23
#endif

struct unit {
    uint32_t free; /* is this an end of a free block? */
    uint32_t count;
    uint32_t next; /* in the list; only in a first unit */
    uint32_t previous;
};

struct code_arena {
    uint8_t *writable;
    uint8_t *executable;
    size_t capacity;
    size_t unit; /* bytes */
    enum code_purpose purpose;
    size_t populated;      /* bytes from the start that need no page fault any more, as far as is known */
    pthread_mutex_t mutex; /* guards all below */
    struct unit *units;
    uint32_t lists[LIST_COUNT]; /* first units; list n holds sizes 2^n to 2^(n+1) - 1 */
    uint32_t nonempty;          /* bit n: list n has a block */
    uint32_t recycled_from;     /* [from, to): where code has been freed */
    uint32_t recycled_to;
    bool can_serialize;
    size_t used_units;
    size_t peak_units;
    size_t free_blocks;
    size_t refused; /* bytes that the last reservation found no hole for, or 0 */
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

/* Blocks. The caller holds the mutex. */

static uint32_t list_of(uint32_t count)
{
    return 31 - (uint32_t)__builtin_clz(count);
}

static void mark(struct code_arena *arena, uint32_t first, uint32_t count, bool is_free)
{
    struct unit *head = &arena->units[first], *tail = &arena->units[first + count - 1];
    head->free = tail->free = is_free;
    head->count = tail->count = count;
}

static void link_free(struct code_arena *arena, uint32_t first, uint32_t count)
{
    mark(arena, first, count, true);
    uint32_t list = list_of(count), next = arena->lists[list];
    arena->units[first].next = next;
    arena->units[first].previous = NO_BLOCK;
    if (next != NO_BLOCK)
        arena->units[next].previous = first;
    arena->lists[list] = first;
    arena->nonempty |= 1u << list;
    arena->free_blocks++;
}

static void unlink_free(struct code_arena *arena, uint32_t first)
{
    struct unit *block = &arena->units[first];
    uint32_t list = list_of(block->count);
    if (block->next != NO_BLOCK)
        arena->units[block->next].previous = block->previous;
    if (block->previous != NO_BLOCK)
        arena->units[block->previous].next = block->next;
    else
        arena->lists[list] = block->next;
    if (arena->lists[list] == NO_BLOCK)
        arena->nonempty &= ~(1u << list);
    arena->free_blocks--;
}

/* The tightest block in the list of `count`'s own size, else any of the next larger list. */
static uint32_t find_free(const struct code_arena *arena, uint32_t count)
{
    uint32_t list = list_of(count), best = NO_BLOCK, best_count = UINT32_MAX;
    for (uint32_t block = arena->lists[list]; block != NO_BLOCK; block = arena->units[block].next) {
        uint32_t size = arena->units[block].count;
        if (size >= count && size < best_count) {
            best = block;
            best_count = size;
        }
        if (size == count)
            return block;
    }
    uint32_t larger = arena->nonempty & ~((2u << list) - 1);
    return best != NO_BLOCK || !larger ? best : arena->lists[__builtin_ctz(larger)];
}

/* Uses the first `count` units of a free block. */
static void take(struct code_arena *arena, uint32_t first, uint32_t count)
{
    uint32_t whole = arena->units[first].count;
    unlink_free(arena, first);
    if (whole > count)
        link_free(arena, first + count, whole - count);
    mark(arena, first, count, false);
    arena->used_units += count;
    if (arena->peak_units < arena->used_units)
        arena->peak_units = arena->used_units;
}

/* Frees used units and joins them with the free neighbours. */
static void release(struct code_arena *arena, uint32_t first, uint32_t count)
{
    arena->used_units -= count;
    if (arena->units[first + count].free) {
        uint32_t after = first + count;
        count += arena->units[after].count;
        unlink_free(arena, after);
    }
    if (arena->units[first - 1].free) {
        uint32_t before = first - arena->units[first - 1].count;
        count += arena->units[before].count;
        first = before;
        unlink_free(arena, before);
    }
    link_free(arena, first, count);
}

/* Spans and units. */

static uint32_t unit_count(const struct code_arena *arena, size_t bytes)
{
    return (uint32_t)((bytes + arena->unit - 1) / arena->unit);
}

static uint32_t first_unit(const struct code_arena *arena, const struct code_span *span)
{
    return FIRST_UNIT + (uint32_t)((size_t)(span->writable - arena->writable) / arena->unit);
}

static struct code_span span_of(const struct code_arena *arena, uint32_t first, uint32_t count)
{
    size_t offset = (size_t)(first - FIRST_UNIT) * arena->unit;
    return (struct code_span){arena->writable + offset, arena->executable + offset,
                              (size_t)count * arena->unit};
}

/* Has the pages up to `end`, and some ahead of it: one by one, as they are written, they cost several times as much, and
 * more than stitching what is written there. Two threads at once do it both, which does no harm. */
static void populate(struct code_arena *arena, size_t end)
{
    size_t from = __atomic_load_n(&arena->populated, __ATOMIC_RELAXED);
    if (end <= from)
        return;
    size_t to = end - from < AHEAD ? from + AHEAD : (end + AHEAD - 1) / AHEAD * AHEAD;
    if (to > arena->capacity)
        to = arena->capacity;
    if (madvise(arena->writable + from, to - from, MADV_POPULATE_WRITE))
        to = arena->capacity; /* it is not to be had: not again */
    __atomic_store_n(&arena->populated, to, __ATOMIC_RELAXED);
}

int code_reserve(struct code_arena *arena, size_t bytes, struct code_span *span, struct error *error)
{
    assert(bytes);
    uint32_t first = NO_BLOCK, count = bytes <= arena->capacity ? unit_count(arena, bytes) : 0;
    pthread_mutex_lock(&arena->mutex);
    if (count)
        first = find_free(arena, count);
    if (first != NO_BLOCK)
        take(arena, first, count);
    arena->refused = first == NO_BLOCK ? bytes : 0;
    size_t used = arena->used_units * arena->unit;
    pthread_mutex_unlock(&arena->mutex);
    if (first == NO_BLOCK) {
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

/* A hole where `count` units fit more tightly than they do at the start of the used block that begins at
 * `first`, counted with the free block after it; NO_BLOCK if there is none. */
static uint32_t find_tighter(const struct code_arena *arena, uint32_t first, uint32_t count)
{
    uint32_t after = first + arena->units[first].count;
    uint32_t here = arena->units[first].count + (arena->units[after].free ? arena->units[after].count : 0);
    uint32_t hole = find_free(arena, count);
    return hole != after && hole != NO_BLOCK && arena->units[hole].count < here ? hole : NO_BLOCK;
}

/* The executable view shows the file's pages again, where a debugger has put its own in their place. */
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
    assert(!arena->units[first].free && arena->units[first].count == reserved);
    uint32_t hole = find_tighter(arena, first, count);
    if (hole != NO_BLOCK) {
        take(arena, hole, count);
        struct code_span moved = span_of(arena, hole, count);
        memcpy(moved.writable, span->writable, moved.bytes);
        memset(span->writable, TRAP, dirty);
        release(arena, first, reserved);
        first = hole;
    } else if (count < reserved) {
        mark(arena, first, count, false);
        release(arena, first + count, reserved - count);
    }
    bool recycled = first < arena->recycled_to && first + count > arena->recycled_from;
    pthread_mutex_unlock(&arena->mutex);

    *span = span_of(arena, first, count);
    forget_breakpoints(arena, span);
    if (recycled && arena->can_serialize)
        syscall(SYS_membarrier, MEMBARRIER_CMD_PRIVATE_EXPEDITED_SYNC_CORE, 0, 0);
    return span->executable;
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
    assert(!arena->units[first].free && arena->units[first].count == count);
    release(arena, first, count);
    if (arena->recycled_from > first)
        arena->recycled_from = first;
    if (arena->recycled_to < first + count)
        arena->recycled_to = first + count;
    pthread_mutex_unlock(&arena->mutex);
    *span = (struct code_span){0};
}

/* The arena. */

/* Kernels from 6.3 on want to be told that a memfd will be executed; earlier ones do not know the flag. */
static int create_file(const struct code_system *system)
{
    const unsigned executable = 0x10; /* MFD_EXEC */
    int file = system->create_file("triptych-code", MFD_CLOEXEC | executable);
    if (file < 0 && errno == EINVAL)
        file = system->create_file("triptych-code", MFD_CLOEXEC);
    return file;
}

/* Maps the two views; both or none. */
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
    void *executable = mremap(writable, 0, bytes, MREMAP_MAYMOVE); /* of shared memory, 0 is a second view */
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
    enum { SENTINELS = 2 };
    struct code_arena *arena = calloc(1, sizeof *arena);
    struct unit *units = calloc(capacity / unit + SENTINELS, sizeof *units);
    if (!arena || !units) {
        free(arena);
        free(units);
        error_set(error, "code arena: out of memory for the bookkeeping of %zu bytes", capacity);
        return NULL;
    }
    arena->capacity = capacity;
    arena->unit = unit;
    arena->units = units;
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
        error_set(error, "code arena: %zu bytes asked for, expected at most %zu", bytes, most);
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
    link_free(arena, FIRST_UNIT, unit_count(arena, capacity));
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
    free(arena->units);
    free(arena);
}

/* A function that gives ANSWER: what is written at one address has to run at the other. */
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

const void *code_executable(const struct code_arena *arena, const void *writable)
{
    return arena->executable + ((const uint8_t *)writable - arena->writable);
}

void *code_writable(const struct code_arena *arena, const void *executable)
{
    return arena->writable + ((const uint8_t *)executable - arena->executable);
}

bool code_contains(const struct code_arena *arena, const void *executable)
{
    return (uintptr_t)executable - (uintptr_t)arena->executable < arena->capacity;
}

static size_t largest_free(const struct code_arena *arena)
{
    uint32_t largest = 0;
    if (arena->nonempty)
        for (uint32_t block = arena->lists[list_of(arena->nonempty)]; block != NO_BLOCK;
             block = arena->units[block].next)
            if (largest < arena->units[block].count)
                largest = arena->units[block].count;
    return (size_t)largest * arena->unit;
}

struct code_statistics code_statistics(struct code_arena *arena)
{
    pthread_mutex_lock(&arena->mutex);
    struct code_statistics statistics = {
        .capacity = arena->capacity,
        .used = arena->used_units * arena->unit,
        .peak = arena->peak_units * arena->unit,
        .free_spans = arena->free_blocks,
        .largest_free = largest_free(arena),
    };
    pthread_mutex_unlock(&arena->mutex);
    return statistics;
}
