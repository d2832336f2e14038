#include "command/run/salvage.h"

#include "command/container/container.h"
#include "command/support/tool.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The folder of recordings, and their name: "STEM.EXTENSION". */
struct recordings {
    char folder[PATH_MAX];
    const char *name;
    size_t stem;
};

/* The bytes before ".PID-NUMBER.new", or 0 if the name does not end so. */
static size_t bytes_of_target(const char *name, long *process)
{
    size_t bytes = strlen(name);
    unsigned number;
    int used = 0;
    for (unsigned dots = 0; bytes && dots < 2;)
        dots += name[--bytes] == '.';
    return sscanf(name + bytes, ".%ld-%u.new%n", process, &number, &used) == 2 && used &&
                   !name[bytes + (size_t)used]
               ? bytes
               : 0;
}

/* Returns true for "STEM.EXTENSION" and "STEM-NUMBER.EXTENSION". */
static bool is_recording(const struct recordings *of, const char *name, size_t bytes)
{
    size_t at = of->stem;
    if (bytes < at || memcmp(name, of->name, at))
        return false;
    if (name[at] == '-' && isdigit((unsigned char)name[at + 1]))
        for (at++; isdigit((unsigned char)name[at]);)
            at++;
    return bytes - at == strlen(of->name + of->stem) && !memcmp(name + at, of->name + of->stem, bytes - at);
}

static bool has_ended(long process)
{
    return process > 0 && kill((pid_t)process, 0) && errno == ESRCH;
}

/* Returns true if the file has been changed since `begin`. */
static bool is_new(const char *path, const struct timespec *begin)
{
    struct stat found;
    return !stat(path, &found) && S_ISREG(found.st_mode) &&
           (found.st_mtim.tv_sec > begin->tv_sec ||
            (found.st_mtim.tv_sec == begin->tv_sec && found.st_mtim.tv_nsec >= begin->tv_nsec));
}

static void complete(const struct command *self, const char *unfinished, const char *path)
{
    struct stream *stream;
    struct error error = {""};
    if (container_read(unfinished, CONTAINER_SALVAGE, &stream, &error)) {
        tool_fail(self, "%s: the program did not end by itself, and no whole frame is left: %s", path,
                  error.text);
        return;
    }
    const unsigned frames = stream->frame_count;
    const int bad = container_save(stream, path, &error);
    stream_free(stream);
    if (bad) {
        tool_fail(self, "%s", error.text);
        return;
    }
    unlink(unfinished);
    tool_fail(self, "%s: the program did not end by itself; the recording has its %u whole frame%s", path,
              frames, frames == 1 ? "" : "s");
}

/* Returns true if the file of the folder is an unfinished recording of a process that has ended. */
static bool salvage_one(const struct command *self, const struct recordings *of, const char *name,
                        const struct timespec *begin)
{
    char unfinished[PATH_MAX], path[PATH_MAX];
    long process;
    const size_t bytes = bytes_of_target(name, &process), folder = strlen(of->folder) + 1;
    if (!bytes || !is_recording(of, name, bytes) || !has_ended(process))
        return false;
    if (snprintf(unfinished, sizeof unfinished, "%s/%s", of->folder, name) >= (int)sizeof unfinished)
        return false;
    memcpy(path, unfinished, folder + bytes);
    path[folder + bytes] = 0;
    if (!is_new(unfinished, begin) || is_new(path, begin))
        return false;
    complete(self, unfinished, path);
    return true;
}

bool salvage_recordings(const struct command *self, const char *record, const struct timespec *begin)
{
    const char *slash = strrchr(record, '/'), *name = slash + 1, *dot = strrchr(name, '.');
    struct recordings of = {.name = name, .stem = dot ? (size_t)(dot - name) : strlen(name)};
    bool found = false;
    snprintf(of.folder, sizeof of.folder, "%.*s", slash == record ? 1 : (int)(slash - record), record);
    DIR *folder = opendir(of.folder);
    if (!folder)
        return false;
    for (const struct dirent *entry; (entry = readdir(folder));)
        found |= salvage_one(self, &of, entry->d_name, begin);
    closedir(folder);
    return found;
}
