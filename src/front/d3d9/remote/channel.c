#define _GNU_SOURCE /* syscall */
#include "channel.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

/* A call takes about a microsecond, and waking a process some tens of them. Cycles of the time stamp counter:
 * about 20 microseconds. */
enum { SPIN_CYCLES = 50000 };

static void spin(_Atomic uint32_t *word, uint32_t old)
{
    uint64_t start = __builtin_ia32_rdtsc();
    while (*word == old && __builtin_ia32_rdtsc() - start < SPIN_CYCLES)
        __builtin_ia32_pause();
}

void d3d9_channel_wait(_Atomic uint32_t *word, uint32_t old, _Atomic uint32_t *sleeps)
{
    /* The structure that the kernel expects of this process. */
    struct timespec limit = {.tv_nsec = 200000000};
    spin(word, old);
    if (*word != old)
        return;
    *sleeps = 1;
    if (*word == old)
        syscall(SYS_futex, word, FUTEX_WAIT, old, &limit, NULL, 0);
    *sleeps = 0;
}

void d3d9_channel_wake(_Atomic uint32_t *word, const _Atomic uint32_t *sleeps)
{
    if (*sleeps)
        syscall(SYS_futex, word, FUTEX_WAKE, 1, NULL, NULL, 0);
}
