/* In a build that counts what is executed, the command's processes that end by _exit, as those do that
 * draw random cases, write their counters first: the linker puts this instead of _exit (see the Makefile).
 * Not where files may not grow: a signal would end the process in the middle. */
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
