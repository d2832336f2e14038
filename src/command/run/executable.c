#include "command/run/executable.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* --- Files ---------------------------------------------------------------------------------------------- */

static bool is_file(const char *path)
{
    struct stat status;
    return !stat(path, &status) && S_ISREG(status.st_mode);
}

static enum executable_kind kind_of(const char *path)
{
    char first[4] = "";
    FILE *file = is_file(path) ? fopen(path, "rb") : NULL;
    if (!file)
        return is_file(path) ? EXECUTABLE_NONE : EXECUTABLE_MISSING;
    const size_t bytes = fread(first, 1, sizeof first, file);
    fclose(file);
    if ((bytes == 4 && !memcmp(first, "\177ELF", 4)) || (bytes >= 2 && !memcmp(first, "#!", 2)))
        return EXECUTABLE_LINUX;
    return bytes >= 2 && !memcmp(first, "MZ", 2) ? EXECUTABLE_WINDOWS : EXECUTABLE_NONE;
}

/* An empty folder of PATH is the current one. */
static bool join(char path[PATH_MAX], int length, const char *folder, const char *name)
{
    return snprintf(path, PATH_MAX, "%.*s/%s", length ? length : 1, length ? folder : ".", name) < PATH_MAX;
}

static enum executable_kind find_in_path(const char *name, char path[PATH_MAX])
{
    const char *folder = getenv("PATH");
    while (folder && *folder) {
        const int length = (int)strcspn(folder, ":");
        if (join(path, length, folder, name) && is_file(path) && !access(path, X_OK))
            return kind_of(path);
        folder += length + (folder[length] == ':');
    }
    return EXECUTABLE_MISSING;
}

/* `C:/x.exe`, or with any backslash. */
static bool is_path_of_windows(const char *name)
{
    const bool letter = (*name >= 'a' && *name <= 'z') || (*name >= 'A' && *name <= 'Z');
    return strchr(name, '\\') || (letter && name[1] == ':');
}

static enum executable_kind find_file(const char *name, char path[PATH_MAX])
{
    enum executable_kind kind = kind_of(name);
    snprintf(path, PATH_MAX, "%s%s", kind == EXECUTABLE_LINUX && !strchr(name, '/') ? "./" : "", name);
    if (kind != EXECUTABLE_MISSING)
        return kind;
    if (snprintf(path, PATH_MAX, "%s.exe", name) < PATH_MAX)
        kind = kind_of(path);
    if (kind == EXECUTABLE_WINDOWS || !is_path_of_windows(name))
        return kind == EXECUTABLE_WINDOWS ? kind : EXECUTABLE_MISSING;
    snprintf(path, PATH_MAX, "%s", name);
    return EXECUTABLE_WINDOWS;
}

enum executable_kind place_find(const char *name, char path[PATH_MAX])
{
    if (strlen(name) >= PATH_MAX - sizeof "./.exe")
        return EXECUTABLE_MISSING;
    const enum executable_kind kind = strchr(name, '/') ? EXECUTABLE_MISSING : find_in_path(name, path);
    return kind == EXECUTABLE_MISSING ? find_file(name, path) : kind;
}

/* --- The prefix ----------------------------------------------------------------------------------------- */

static bool is_name(const char *file, const char *name)
{
    const size_t length = strlen(name);
    return !strncasecmp(file, name, length) && (!file[length] || !strcasecmp(file + length, ".exe"));
}

static bool has_program(const char *folder, const char *name)
{
    DIR *files = opendir(folder);
    bool found = false;
    for (struct dirent *file; files && !found && (file = readdir(files));)
        found = is_name(file->d_name, name);
    if (files)
        closedir(files);
    return found;
}

bool place_has_program(const char *prefix, const char *name)
{
    static const char *const folders[] = {"system32", "syswow64", "", "system32/wbem"};
    char path[PATH_MAX];
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        if (snprintf(path, sizeof path, "%s/drive_c/windows/%s", prefix, folders[i]) < PATH_MAX &&
            has_program(path, name))
            return true;
    return false;
}
