/* Injects faults into file operations: full disks, short writes, and processes that are killed in between.
 *
 * The functions open, write, fsync, fchmod, close, rename and unlink below replace those of the C library in
 * the test program. One source file of the program includes this file. Calls inside the C library, for
 * example in printf, are not replaced. While the functions are armed they count their calls, and the fault
 * happens to the n-th call. */
#ifndef TESTS_SUPPORT_SYSTEM_FAULT_FILE_H
#define TESTS_SUPPORT_SYSTEM_FAULT_FILE_H

#ifndef _GNU_SOURCE
#error "a program that includes fault_file.h begins with #define _GNU_SOURCE"
#endif

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/syscall.h>
#include <unistd.h>

enum file_fault {
    FILE_FAULT_NONE,
    FILE_FAULT_ERROR,  /* the call fails with `reason` and does nothing; but close() closes the file */
    FILE_FAULT_SHORT,  /* a write stores half of its bytes; other calls succeed */
    FILE_FAULT_BYTES,  /* this write and all later ones store one byte each */
    FILE_FAULT_ZERO,   /* a write stores nothing and returns 0 */
    FILE_FAULT_KILL,   /* the process is killed before the call */
    FILE_FAULT_KILLED, /* the process is killed after the call, or after the first half of a write */
};

static struct {
    bool armed;
    enum file_fault fault;
    int reason;
    unsigned long at, count;
    const char *name; /* of the function that had the fault; null: none yet */
} file_fault;

static void file_fault_arm(enum file_fault fault, int reason, unsigned long at)
{
    file_fault.fault = fault;
    file_fault.reason = reason;
    file_fault.at = at;
    file_fault.count = 0;
    file_fault.name = NULL;
    file_fault.armed = true;
}

/* Disarms, and returns the number of calls since file_fault_arm(). */
static unsigned long file_fault_end(void)
{
    file_fault.armed = false;
    return file_fault.count;
}

/* Counts a call of the function `name` and returns its fault. */
static enum file_fault file_fault_next(const char *name)
{
    if (!file_fault.armed)
        return FILE_FAULT_NONE;
    unsigned long number = ++file_fault.count;
    if (number != file_fault.at && !(file_fault.fault == FILE_FAULT_BYTES && number > file_fault.at))
        return FILE_FAULT_NONE;
    file_fault.name = name;
    if (file_fault.fault == FILE_FAULT_KILL)
        raise(SIGKILL);
    errno = file_fault.reason;
    return file_fault.fault;
}

/* Makes the system call `number`, with its fault if it has one. Returns its result, or -1 with errno. */
static long file_fault_call(const char *name, long number, long a, long b, long c)
{
    enum file_fault fault = file_fault_next(name);
    if (fault == FILE_FAULT_ERROR && number != SYS_close)
        return -1;
    long result = syscall(number, a, b, c);
    if (fault == FILE_FAULT_KILLED)
        raise(SIGKILL);
    if (fault != FILE_FAULT_ERROR)
        return result;
    errno = file_fault.reason; /* after the close: Linux closes the file even if close() fails */
    return -1;
}

#define FILE_FAULT_EXPORT __attribute__((visibility("default"), noinline))

FILE_FAULT_EXPORT int open(const char *path, int flags, ...)
{
    va_list more;
    va_start(more, flags);
    int mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, int) : 0;
    va_end(more);
    return (int)file_fault_call("open", SYS_open, (long)path, flags, mode);
}

FILE_FAULT_EXPORT ssize_t write(int file, const void *data, size_t bytes)
{
    enum file_fault fault = file_fault_next("write");
    if (fault == FILE_FAULT_ERROR)
        return -1;
    if (fault == FILE_FAULT_ZERO && bytes)
        return 0;
    if (fault == FILE_FAULT_SHORT || fault == FILE_FAULT_KILLED)
        bytes = (bytes + 1) / 2;
    if (fault == FILE_FAULT_BYTES && bytes > 1)
        bytes = 1;
    ssize_t result = syscall(SYS_write, file, data, bytes);
    if (fault == FILE_FAULT_KILLED)
        raise(SIGKILL);
    return result;
}

FILE_FAULT_EXPORT int fsync(int file)
{
    return (int)file_fault_call("fsync", SYS_fsync, file, 0, 0);
}

FILE_FAULT_EXPORT int fchmod(int file, mode_t mode)
{
    return (int)file_fault_call("fchmod", SYS_fchmod, file, (long)mode, 0);
}

FILE_FAULT_EXPORT int close(int file)
{
    return (int)file_fault_call("close", SYS_close, file, 0, 0);
}

FILE_FAULT_EXPORT int rename(const char *from, const char *to)
{
    return (int)file_fault_call("rename", SYS_rename, (long)from, (long)to, 0);
}

FILE_FAULT_EXPORT int unlink(const char *path)
{
    return (int)file_fault_call("unlink", SYS_unlink, (long)path, 0, 0);
}

#endif
