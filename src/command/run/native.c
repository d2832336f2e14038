/* The library of EGL for programs of Linux. */
#include "command/run/place.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const folders[] = {"egl", "../lib/triptych/egl"};

static bool has_library(char file[PATH_MAX], const char *command, const char *folder)
{
    char library[PATH_MAX];
    return snprintf(library, PATH_MAX, "%s/%s/libEGL_triptych.so.0", command, folder) < PATH_MAX &&
           snprintf(file, PATH_MAX, "%s/%s/10_triptych.json", command, folder) < PATH_MAX &&
           !access(library, R_OK) && !access(file, R_OK);
}

int place_vendor(char file[PATH_MAX], struct error *error)
{
    char command[PATH_MAX];
    ssize_t bytes = readlink("/proc/self/exe", command, sizeof command - 1);
    if (bytes < 0)
        return error_set(error, "/proc/self/exe: %s", strerror(errno));
    command[bytes] = 0;
    *strrchr(command, '/') = 0;
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        if (has_library(file, command, folders[i]))
            return 0;
    return error_set(
        error, "OpenGL ES is not built: %s/egl has no files, expected those that `make gles` makes", command);
}
