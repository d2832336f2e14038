#include "unixlib.h"
#include <windows.h>
#include <winternl.h>

typedef UINT64 unixlib_handle_t;
NTSTATUS WINAPI __wine_unix_call(unixlib_handle_t, unsigned, void *);
NTSTATUS WINAPI NtQueryVirtualMemory(HANDLE, const void *, int, void *, SIZE_T, SIZE_T *);

enum { MEMORY_WINE_UNIX_FUNCTIONS = 1000 };

static unixlib_handle_t library;

int unixlib_start(void)
{
    extern IMAGE_DOS_HEADER __ImageBase;
    return !NtQueryVirtualMemory(GetCurrentProcess(), &__ImageBase, MEMORY_WINE_UNIX_FUNCTIONS, &library,
                                 sizeof library, NULL);
}

int unixlib_call(unsigned number, void *arguments)
{
    return __wine_unix_call(library, number, arguments);
}
