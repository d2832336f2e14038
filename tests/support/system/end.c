/* _exit for a build that counts executed lines. The linker replaces _exit by this function (see the
 * Makefile). Processes that end by _exit, for example those that draw random cases, write their counters
 * first. A process with a limit on the size of files does not: a signal would end it during the write. */
#include <sys/resource.h>

void __gcov_dump(void) __attribute__((weak));
_Noreturn void __real__exit(int status) __attribute__((weak));
_Noreturn void __wrap__exit(int status);

_Noreturn void __wrap__exit(int status)
{
    struct rlimit limit;
    if (__gcov_dump && !getrlimit(RLIMIT_FSIZE, &limit) && limit.rlim_cur == RLIM_INFINITY)
        __gcov_dump();
    __real__exit(status);
}
