/* The kind and the place of a program of `triptych run`. */
#ifndef COMMAND_RUN_EXECUTABLE_H
#define COMMAND_RUN_EXECUTABLE_H

#include <limits.h>
#include <stdbool.h>

enum executable_kind {
    EXECUTABLE_MISSING, /* there is no such file */
    EXECUTABLE_NONE,    /* the file is not a program that is known here */
    EXECUTABLE_LINUX,   /* an ELF file or a script */
    EXECUTABLE_WINDOWS, /* a file that begins with MZ, or a path of Windows */
};

/* Finds a program. A name without a slash is that of an executable file in a folder of PATH, else of a file
 * in the current folder. As for Wine, NAME is also NAME.exe. Writes the path of the file; that of a program
 * of Linux has a slash. */
enum executable_kind place_find(const char *name, char path[PATH_MAX]);

/* Returns true if the prefix has a program of that name, without a path, in the folders that Wine searches:
 * NAME, or NAME.exe, in small or large letters. */
bool place_has_program(const char *prefix, const char *name);

#endif
