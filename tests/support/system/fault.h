/* Refuses requests for memory, mappings and threads, as a system without free memory does.
 *
 * One source file of a test program includes this file. The functions below then replace those of the C
 * library in the whole process, including its libraries and the C library itself, and call the functions that
 * they replace. While they are armed, they count requests and refuse the n-th request, or the n-th and all
 * later ones. Requests of C++ libraries (Assimp) are neither counted nor refused, because these libraries are
 * not a part of this project.
 *
 * While they watch, the functions record each block that is allocated and not yet freed, so that a test finds
 * leaks without a sanitizer. If the environment contains TRIPTYCH_FAULT_SITES=FILE, the program appends to
 * FILE the addresses of its code whose requests were refused, one a line, relative to the program's start.
 * tests/support/scripts/faults.sh compares them with the sources. */
#ifndef TESTS_SUPPORT_SYSTEM_FAULT_H
#define TESTS_SUPPORT_SYSTEM_FAULT_H

#ifndef _GNU_SOURCE
#error "a program that includes fault.h begins with #define _GNU_SOURCE"
#endif

#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <link.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { FAULT_FRAMES = 24, FAULT_SEEN = 8, FAULT_SITES = 4096, FAULT_BLOCKS = 1 << 16, FAULT_FOREIGN = 8 };

static struct fault {
    atomic_flag lock;
    bool armed, onwards; /* `onwards`: all requests from number `at` on are refused, not only this one */
    bool only_threads;   /* memory is neither counted nor refused */
    bool watching;
    pthread_t thread;    /* the thread that armed it */
    unsigned long count; /* requests since it was armed, from 1 */
    unsigned long at;
    unsigned long refused; /* requests */
    unsigned long total;   /* refused since the program began */
    uint64_t stack;        /* result of `seen` for the last request: a hash of the calls that led to it */
    struct {
        uintptr_t begin, end;
    } foreign[FAULT_FOREIGN];
    unsigned foreigners;
    /* Blocks that were allocated while watching and are not freed: a hash table with open addressing. */
    struct {
        uintptr_t address;
        void *caller;
    } block[FAULT_BLOCKS];
    unsigned blocks;
    /* If not null, called for each request, with at least FAULT_SEEN frames if there are as many. */
    uint64_t (*seen)(void *const *frames, int count);
} fault = {.lock = ATOMIC_FLAG_INIT};

/* True while the thread decides about a request. Requests of the unwinder in this time are granted. */
static _Thread_local bool fault_inside;

/* In memory that forks share, because refusals in child processes count too. */
static struct fault_sites {
    unsigned count;
    void *site[FAULT_SITES];
} * fault_sites;

/* --- The replaced functions ----------------------------------------------------------------------------- */

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define FAULT_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FAULT_SANITIZED
#endif

#ifdef FAULT_SANITIZED
enum { FAULT_INSTRUMENTED = 1 };
#define FAULT_REAL(name) __interceptor_##name
#else
enum { FAULT_INSTRUMENTED = 0 };
#define FAULT_REAL(name) __libc_##name
#endif

void *FAULT_REAL(malloc)(size_t);
void *FAULT_REAL(calloc)(size_t, size_t);
void *FAULT_REAL(realloc)(void *, size_t);
void *FAULT_REAL(memalign)(size_t, size_t);
void FAULT_REAL(free)(void *);

/* The sanitizers request memory before their own instrumentation can run. */
#if defined(__has_feature)
#define FAULT_PLAIN __attribute__((no_sanitize("address", "thread", "undefined")))
#else
#define FAULT_PLAIN __attribute__((no_sanitize_address, no_sanitize_thread, no_sanitize_undefined))
#endif
#define FAULT_EXPORT FAULT_PLAIN __attribute__((visibility("default"), noinline))

/* --- Deciding ------------------------------------------------------------------------------------------- */

static FAULT_PLAIN void fault_lock(void)
{
    while (atomic_flag_test_and_set_explicit(&fault.lock, memory_order_acquire))
        ;
}

static FAULT_PLAIN void fault_unlock(void)
{
    atomic_flag_clear_explicit(&fault.lock, memory_order_release);
}

static FAULT_PLAIN bool fault_is_foreign(const void *caller)
{
    for (unsigned i = 0; i < fault.foreigners; i++)
        if ((uintptr_t)caller - fault.foreign[i].begin < fault.foreign[i].end - fault.foreign[i].begin)
            return true;
    return false;
}

static bool fault_is_ours(const void *address)
{
    extern char __executable_start, etext;
    return (const char *)address >= &__executable_start && (const char *)address < &etext;
}

/* Stores up to `most` return addresses, from the caller of the replaced function outwards, and returns their
 * number. */
static int fault_backtrace(const void *caller, void **frames, int most)
{
    void *all[FAULT_FRAMES + 8];
    int count = backtrace(all, most + 8), first = 0;
    while (first < count && all[first] != caller)
        first++;
    count -= first;
    count = count < most ? count : most;
    memcpy(frames, all + first, (size_t)count * sizeof *frames);
    return count;
}

static void fault_note_site(void *const *frames, int count)
{
    int i = 0;
    while (i < count && !fault_is_ours(frames[i]))
        i++;
    if (i == count)
        return;
    for (unsigned s = 0; s < fault_sites->count; s++)
        if (fault_sites->site[s] == frames[i])
            return;
    if (fault_sites->count < FAULT_SITES)
        fault_sites->site[fault_sites->count++] = frames[i];
}

/* Returns true if this request is refused. `caller` is the return address of the request. */
static FAULT_PLAIN __attribute__((noinline)) bool fault_refuses(void *caller)
{
    if (!fault.armed || fault.only_threads || fault_inside || fault_is_foreign(caller))
        return false;
#ifdef FAULT_SANITIZED
    if (!pthread_equal(pthread_self(), fault.thread)) /* a sanitizer allocates when a thread begins */
        return false;
#endif
    fault_inside = true;
    fault_lock();
    unsigned long number = ++fault.count;
    fault_unlock();
    bool refuses = number == fault.at || (fault.onwards && number > fault.at);
    if (refuses || fault.seen) {
        void *frames[FAULT_FRAMES];
        int count = fault_backtrace(caller, frames, refuses ? FAULT_FRAMES : FAULT_SEEN);
        if (fault.seen)
            fault.stack = fault.seen(frames, count);
        for (int i = 0; i < count && i < 4; i++) /* the C library may allocate for a C++ library */
            refuses &= !fault_is_foreign(frames[i]);
        fault_lock();
        if (refuses)
            fault_note_site(frames, count);
        fault.refused += refuses;
        fault.total += refuses;
        fault_unlock();
    }
    fault_inside = false;
    if (refuses)
        errno = ENOMEM;
    return refuses;
}

static void fault_arm(unsigned long at, bool onwards)
{
    fault.count = fault.refused = 0;
    fault.at = at;
    fault.onwards = onwards;
    fault.thread = pthread_self();
    fault.armed = true;
}

__attribute__((unused)) static void fault_only_threads(bool only)
{
    fault.only_threads = only;
}

static void fault_disarm(void)
{
    fault.armed = false;
}

/* --- Watching ------------------------------------------------------------------------------------------- */

static FAULT_PLAIN unsigned fault_place(uintptr_t address)
{
    return (unsigned)(address >> 4) * 0x9e3779b1u >> 16 & (FAULT_BLOCKS - 1);
}

static FAULT_PLAIN void *fault_allocated(void *block, void *caller)
{
    if (!fault.watching || !block)
        return block;
    fault_lock();
    unsigned at = fault_place((uintptr_t)block);
    if (fault.blocks < FAULT_BLOCKS / 2) {
        while (fault.block[at].address)
            at = (at + 1) & (FAULT_BLOCKS - 1);
        fault.block[at].address = (uintptr_t)block;
        fault.block[at].caller = caller;
        fault.blocks++;
    }
    fault_unlock();
    return block;
}

/* Empties an entry, and moves later entries of its cluster up so that a search does not end at the gap. */
static FAULT_PLAIN void fault_remove(unsigned at)
{
    for (unsigned next = at;;) {
        next = (next + 1) & (FAULT_BLOCKS - 1);
        if (!fault.block[next].address)
            break;
        unsigned home = fault_place(fault.block[next].address);
        if (((next - home) & (FAULT_BLOCKS - 1)) < ((next - at) & (FAULT_BLOCKS - 1)))
            continue;
        fault.block[at] = fault.block[next];
        at = next;
    }
    fault.block[at].address = 0;
    fault.blocks--;
}

static FAULT_PLAIN void fault_freed(const void *block)
{
    if (!fault.blocks || !block)
        return;
    fault_lock();
    unsigned at = fault_place((uintptr_t)block);
    while (fault.block[at].address && fault.block[at].address != (uintptr_t)block)
        at = (at + 1) & (FAULT_BLOCKS - 1);
    if (fault.block[at].address)
        fault_remove(at);
    fault_unlock();
}

__attribute__((unused)) static void fault_watch(void)
{
    if (fault.blocks) /* else all entries are empty */
        memset(fault.block, 0, sizeof fault.block);
    fault.blocks = 0;
    fault.watching = true;
}

/* Stops watching. Returns a description of the blocks that are still allocated, or null if there are none. */
__attribute__((unused)) static const char *fault_lost(void)
{
    static char text[512];
    Dl_info info = {0};
    fault.watching = false;
    if (!fault.blocks)
        return NULL;
    unsigned length = (unsigned)snprintf(text, sizeof text, "%u blocks lost, requested by", fault.blocks);
    for (unsigned i = 0; i < FAULT_BLOCKS && length < sizeof text - 96; i++)
        if (fault.block[i].address) {
            extern char __executable_start;
            dladdr(fault.block[i].caller, &info);
            length += (unsigned)snprintf(
                text + length, sizeof text - length, " %.40s+0x%tx",
                info.dli_fname && strrchr(info.dli_fname, '/') ? strrchr(info.dli_fname, '/') + 1 : "program",
                (char *)fault.block[i].caller -
                    (info.dli_fbase ? (char *)info.dli_fbase : &__executable_start));
        }
    return text;
}

/* --- The functions -------------------------------------------------------------------------------------- */

#define FAULT_CALLER __builtin_return_address(0)

FAULT_EXPORT void *malloc(size_t bytes)
{
    return fault_refuses(FAULT_CALLER) ? NULL : fault_allocated(FAULT_REAL(malloc)(bytes), FAULT_CALLER);
}

FAULT_EXPORT void *calloc(size_t count, size_t bytes)
{
    return fault_refuses(FAULT_CALLER) ? NULL
                                       : fault_allocated(FAULT_REAL(calloc)(count, bytes), FAULT_CALLER);
}

FAULT_EXPORT void *realloc(void *block, size_t bytes)
{
    if (fault_refuses(FAULT_CALLER))
        return NULL;
    fault_freed(block);
    return fault_allocated(FAULT_REAL(realloc)(block, bytes), FAULT_CALLER);
}

FAULT_EXPORT void *memalign(size_t alignment, size_t bytes)
{
    return fault_refuses(FAULT_CALLER)
               ? NULL
               : fault_allocated(FAULT_REAL(memalign)(alignment, bytes), FAULT_CALLER);
}

FAULT_EXPORT void *aligned_alloc(size_t alignment, size_t bytes)
{
    return fault_refuses(FAULT_CALLER)
               ? NULL
               : fault_allocated(FAULT_REAL(memalign)(alignment, bytes), FAULT_CALLER);
}

FAULT_EXPORT int posix_memalign(void **block, size_t alignment, size_t bytes)
{
    if (fault_refuses(FAULT_CALLER))
        return ENOMEM;
    void *made = fault_allocated(FAULT_REAL(memalign)(alignment, bytes), FAULT_CALLER);
    *block = made ? made : *block;
    return made ? 0 : ENOMEM;
}

FAULT_EXPORT void free(void *block)
{
    fault_freed(block);
    FAULT_REAL(free)(block);
}

/* strndup and strdup are replaced because those of the sanitizers do not call malloc. */
FAULT_EXPORT char *strndup(const char *text, size_t most)
{
    size_t length = strnlen(text, most);
    char *copy =
        fault_refuses(FAULT_CALLER) ? NULL : fault_allocated(FAULT_REAL(malloc)(length + 1), FAULT_CALLER);
    if (copy) {
        memcpy(copy, text, length);
        copy[length] = 0;
    }
    return copy;
}

FAULT_EXPORT char *strdup(const char *text)
{
    size_t bytes = strlen(text) + 1;
    char *copy =
        fault_refuses(FAULT_CALLER) ? NULL : fault_allocated(FAULT_REAL(malloc)(bytes), FAULT_CALLER);
    return copy ? memcpy(copy, text, bytes) : NULL;
}

FAULT_EXPORT void *mmap(void *address, size_t bytes, int protection, int flags, int file, off_t offset)
{
    if (fault_refuses(FAULT_CALLER))
        return MAP_FAILED;
    void *made = (void *)syscall(SYS_mmap, address, bytes, protection, flags, file, offset);
    if (made != MAP_FAILED)
        fault_allocated(made, FAULT_CALLER);
    return made;
}

FAULT_EXPORT int munmap(void *address, size_t bytes)
{
    fault_freed(address);
    return (int)syscall(SYS_munmap, address, bytes);
}

FAULT_EXPORT int memfd_create(const char *name, unsigned flags)
{
    return fault_refuses(FAULT_CALLER) ? -1 : (int)syscall(SYS_memfd_create, name, flags);
}

FAULT_EXPORT int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                                void *argument)
{
    static int (*real)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
    if (!real) {
        void *found = dlsym(RTLD_NEXT, "pthread_create");
        memcpy(&real, &found, sizeof real);
    }
    bool only_threads = fault.only_threads;
    fault.only_threads = false;
    bool refuses = fault_refuses(FAULT_CALLER);
    fault.only_threads = only_threads;
    return refuses ? EAGAIN : real(thread, attributes, run, argument);
}

/* Returns memory that forks share, all zeros. */
static void *fault_shared(size_t bytes)
{
    return (void *)syscall(SYS_mmap, NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
}

/* --- Beginning and end ---------------------------------------------------------------------------------- */

static int fault_find_foreign(struct dl_phdr_info *info, size_t size, void *user)
{
    (void)size;
    (void)user;
    const char *slash = strrchr(info->dlpi_name, '/'), *name = slash ? slash + 1 : info->dlpi_name;
    if (strncmp(name, "libstdc++", 9) && strncmp(name, "libassimp", 9))
        return 0;
    uintptr_t end = 0;
    for (unsigned i = 0; i < info->dlpi_phnum; i++) {
        uintptr_t last = info->dlpi_phdr[i].p_vaddr + info->dlpi_phdr[i].p_memsz;
        if (info->dlpi_phdr[i].p_type == PT_LOAD && last > end)
            end = last;
    }
    if (fault.foreigners < FAULT_FOREIGN) {
        fault.foreign[fault.foreigners].begin = info->dlpi_addr;
        fault.foreign[fault.foreigners++].end = info->dlpi_addr + end;
    }
    return 0;
}

/* The leak sanitizer recognizes memory of the dynamic linker by the caller of malloc. That caller is the
 * malloc above here, so fault_begin() disables the search for leaks while the linker allocates. */
extern void __lsan_disable(void) __attribute__((weak));
extern void __lsan_enable(void) __attribute__((weak));

/* Unwinds once, because the first unwinding of a process loads a library. */
__attribute__((constructor)) static void fault_begin(void)
{
    void *frames[4];
    fault_sites = fault_shared(sizeof *fault_sites);
    dl_iterate_phdr(fault_find_foreign, NULL);
    if (__lsan_disable)
        __lsan_disable();
    backtrace(frames, 4);
    if (__lsan_enable)
        __lsan_enable();
}

__attribute__((destructor)) static void fault_end(void)
{
    extern char __executable_start;
    const char *path = getenv("TRIPTYCH_FAULT_SITES");
    FILE *out = path ? fopen(path, "a") : NULL;
    for (unsigned i = 0; i < fault_sites->count && out; i++)
        fprintf(out, "0x%tx\n", (char *)fault_sites->site[i] - &__executable_start);
    if (out)
        fclose(out);
}

#endif
