#include "command/run/place.h"
#include "base/file.h"
#include "command/support/tool.h"

#include <errno.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { DLL_BYTES = 64 << 20, REGISTRY_LINES = 8 };

static const char *const dlls[] = {"d3d9.dll", "triptych9.dll"};

static int join(char path[PATH_MAX], const char *folder, const char *name, struct error *error)
{
    if (snprintf(path, PATH_MAX, "%s/%s", folder, name) < PATH_MAX)
        return 0;
    return error_set(error, "%s/%s: the path is too long, expected fewer than %d bytes", folder, name,
                     PATH_MAX);
}

int place_absolute(const char *path, char absolute[PATH_MAX], struct error *error)
{
    char here[PATH_MAX];
    if (*path == '/')
        return join(absolute, "", path + 1, error);
    if (!getcwd(here, sizeof here))
        return error_set(error, "the current folder is gone: %s", strerror(errno));
    return join(absolute, here, path, error);
}

static bool has_files(const char *folder)
{
    static const char *const files[] = {"x86_64-windows/d3d9.dll", "x86_64-windows/triptych9.dll",
                                        "x86_64-unix/triptych9.so"};
    struct error error = {""};
    char path[PATH_MAX];
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        if (join(path, folder, files[i], &error) || access(path, R_OK))
            return false;
    return true;
}

int place_files(char folder[PATH_MAX], struct error *error)
{
    char command[PATH_MAX], built[PATH_MAX], installed[PATH_MAX];
    ssize_t bytes = readlink("/proc/self/exe", command, sizeof command - 1);
    if (bytes < 0)
        return error_set(error, "/proc/self/exe: %s", strerror(errno));
    command[bytes] = 0;
    *strrchr(command, '/') = 0;
    if (join(built, command, "d3d9", error) || join(installed, command, "../lib/triptych/d3d9", error))
        return -1;
    if (!has_files(built) && !has_files(installed))
        return error_set(
            error, "Direct3D 9 is not built: %s has no files, expected those that `make d3d9` makes", built);
    memcpy(folder, has_files(built) ? built : installed, PATH_MAX);
    return 0;
}

int place_prefix(const char *given, char prefix[PATH_MAX], struct error *error)
{
    const char *home = getenv("HOME"), *environment = getenv("WINEPREFIX");
    if (!given && environment && *environment)
        given = environment;
    if (given)
        return place_absolute(given, prefix, error);
    if (!home || *home != '/')
        return error_set(error, "HOME is not an absolute path, expected one, WINEPREFIX or --prefix");
    return join(prefix, home, ".wine", error);
}

/* --- The prefix ----------------------------------------------------------------------------------------- */

static const char system_dlls[] = "drive_c/windows/system32", narrow_dlls[] = "drive_c/windows/syswow64";

/* wineboot makes it. The two overrides disable questions about downloads. */
static int boot(const char *wine, const char *prefix, struct error *error)
{
    char *arguments[] = {(char *)wine, "wineboot", "-i", NULL};
    const char *old = getenv("WINEDLLOVERRIDES");
    char *kept = old ? strdup(old) : NULL;
    pid_t process;
    int status = 0;
    if ((old && !kept) || setenv("WINEPREFIX", prefix, 1) ||
        setenv("WINEDLLOVERRIDES", "mscoree=;mshtml=", 1) || setenv("WINEDEBUG", "-all", 0)) {
        free(kept);
        return error_set(error, "no memory for the environment");
    }
    int reason = posix_spawnp(&process, wine, NULL, NULL, arguments, environ);
    if (!reason && waitpid(process, &status, 0) < 0)
        reason = errno;
    if (kept)
        setenv("WINEDLLOVERRIDES", kept, 1);
    else
        unsetenv("WINEDLLOVERRIDES");
    free(kept);
    if (reason)
        return error_set(error, "%s: cannot start: %s", wine, strerror(reason));
    if (!WIFEXITED(status) || WEXITSTATUS(status))
        return error_set(error, "%s: `%s wineboot -i` failed, expected a new prefix", prefix, wine);
    return 0;
}

bool place_has_prefix(const char *prefix)
{
    struct error error = {""};
    char path[PATH_MAX];
    return !join(path, prefix, system_dlls, &error) && !access(path, F_OK);
}

int place_make_prefix(const char *wine, const char *prefix, struct error *error)
{
    char path[PATH_MAX];
    if (join(path, prefix, system_dlls, error))
        return -1;
    if (!access(path, F_OK))
        return 0;
    tool_progress("making Wine's prefix %s", prefix);
    int status = boot(wine, prefix, error);
    tool_progress(NULL);
    if (status)
        return -1;
    if (access(path, F_OK))
        return error_set(error, "%s: has no %s after `%s wineboot -i`", prefix, system_dlls, wine);
    return 0;
}

/* Some distributions' prefixes have links to Wine's own DLLs, which must stay as they are. */
static int remove_link(const char *path, struct error *error)
{
    struct stat status;
    if (lstat(path, &status) || !S_ISLNK(status.st_mode) || !unlink(path))
        return 0;
    return error_set(error, "%s: cannot remove: %s", path, strerror(errno));
}

/* Copies a file, unless the copy is equal. */
static int copy(const char *from, const char *to, struct error *error)
{
    struct error ignored = {""};
    char *data = NULL, *old = NULL;
    size_t bytes, old_bytes;
    int status = remove_link(to, error) || file_read(from, DLL_BYTES, &data, &bytes, error);
    if (!status && (file_read(to, DLL_BYTES, &old, &old_bytes, &ignored) || old_bytes != bytes ||
                    memcmp(old, data, bytes)))
        status = file_write(to, data, bytes, error);
    free(data);
    free(old);
    return status;
}

static int install(const char *from_folder, const char *to_folder, struct error *error)
{
    char from[PATH_MAX], to[PATH_MAX];
    for (size_t i = 0; i < sizeof dlls / sizeof *dlls; i++)
        if (join(from, from_folder, dlls[i], error) || join(to, to_folder, dlls[i], error) ||
            copy(from, to, error))
            return -1;
    return 0;
}

/* A prefix of 64 bits has the DLLs of 32-bit programs in syswow64. The registry of one of 32 bits has a
 * line of it at its beginning. */
static bool is_narrow(const char *prefix)
{
    char path[PATH_MAX], line[256];
    struct error error = {""};
    bool narrow = false;
    FILE *file = join(path, prefix, "system.reg", &error) ? NULL : fopen(path, "r");
    for (int i = 0; file && i < REGISTRY_LINES && fgets(line, sizeof line, file); i++)
        narrow |= !strncmp(line, "#arch=win32", strlen("#arch=win32"));
    if (file)
        fclose(file);
    return narrow;
}

int place_install(const char *folder, const char *prefix, struct error *error)
{
    char system[PATH_MAX], system32[PATH_MAX], wide[PATH_MAX], narrow[PATH_MAX];
    if (join(system, prefix, system_dlls, error) || join(system32, prefix, narrow_dlls, error) ||
        join(wide, folder, "x86_64-windows", error) || join(narrow, folder, "i386-windows", error))
        return -1;
    bool has_narrow = !access(narrow, F_OK);
    if (is_narrow(prefix))
        return has_narrow
                   ? install(narrow, system, error)
                   : error_set(error, "%s: has only programs of 32 bits, expected i386-windows in %s for it",
                               prefix, folder);
    if (has_narrow && !access(system32, F_OK) && install(narrow, system32, error))
        return -1;
    return install(wide, system, error);
}
