#include "command/assets/folder.h"
#include "base/file.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The real path of the folder that contains a file; the caller frees it. */
static char *real_folder(const char *path)
{
    const char *slash = file_is_standard(path) ? NULL : strrchr(path, '/');
    char *folder = slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : strdup(".");
    char *real = folder ? realpath(folder, NULL) : NULL;
    free(folder);
    return real;
}

/* "../" for each folder of `from` that is not a folder of `to`, then the rest of `to` and a slash. Both are
 * real paths. */
static char *relative_folder(const char *from, const char *to)
{
    size_t common = 0, length = 0, up = 0;
    while (from[length] && from[length] == to[length])
        if (from[length++] == '/')
            common = length;
    if ((!from[length] || from[length] == '/') && (!to[length] || to[length] == '/'))
        common = length;
    for (const char *c = from + common; *c; c++)
        up += *c != '/' && (c == from + common || c[-1] == '/');
    const char *rest = to + common + (to[common] == '/');
    char *out = malloc(3 * up + strlen(rest) + 2), *at = out;
    for (; out && up; up--)
        at = stpcpy(at, "../");
    if (out)
        sprintf(at, "%s%s", rest, *rest ? "/" : "");
    return out;
}

static bool is_relative(const char *path)
{
    return path && path[0] != '/';
}

static bool has_relative_face(const struct resource *resource)
{
    for (int face = 0; face < 6 && resource->type == RESOURCE_TEXTURE; face++)
        if (is_relative(resource->face_path[face]))
            return true;
    return false;
}

static bool names_files(const struct stream *stream)
{
    for (uint32_t i = 0; i < stream->resource_count; i++)
        if (is_relative(stream->resources[i].path) || has_relative_face(&stream->resources[i]))
            return true;
    return false;
}

int folder_prefix(const struct stream *stream, const char *path, char **prefix, struct error *error)
{
    *prefix = NULL;
    if (!names_files(stream)) {
        *prefix = strdup("");
        return *prefix ? 0 : error_set(error, "%s: not enough memory", path);
    }
    char *from = real_folder(path), *to = from ? real_folder(stream->path) : NULL;
    bool found = to || errno == ENOMEM;
    if (to)
        *prefix = relative_folder(from, to);
    free(from);
    free(to);
    if (!found)
        return error_set(error, "%s: its folder or that of %s is missing, expected both", path, stream->path);
    if (!*prefix)
        return error_set(error, "%s: not enough memory", path);
    for (const char *c = *prefix; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            return error_set(error, "%s: a folder's name has control characters, which paths cannot have",
                             path);
    return 0;
}

char *folder_join(const char *prefix, const char *path)
{
    size_t length = path[0] == '/' ? 0 : strlen(prefix);
    char *joined = malloc(length + strlen(path) + 1);
    if (joined) {
        memcpy(joined, prefix, length);
        strcpy(joined + length, path);
    }
    return joined;
}
