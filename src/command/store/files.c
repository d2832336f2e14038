#define _GNU_SOURCE /* basename of string.h */
#include "command/store/files.h"

#include "base/file.h"
#include "command/stream/stream.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { HEAD_BYTES = 4096, PIECE_BYTES = 32768 };

int store_add_file(struct store_files *files, const struct store_file *file)
{
    struct store_file *larger = realloc(files->file, (files->count + 1) * sizeof *larger);
    if (!larger)
        return -1;
    files->file = larger;
    larger[files->count] = *file;
    larger[files->count].name = strdup(file->name);
    if (!larger[files->count].name)
        return -1;
    files->count++;
    return 0;
}

void store_free_files(struct store_files *files)
{
    for (uint32_t i = 0; i < files->count; i++)
        free(files->file[i].name);
    free(files->file);
    *files = (struct store_files){0};
}

int store_add_main_file(struct store_files *files, const char *path, const void *data, size_t bytes)
{
    const struct store_file file = {
        .name = basename(path), .beside = true, .part = PART_WHOLE, .digest = digest_of(data, bytes)};
    return store_add_file(files, &file);
}

/* --- Comparing --- */

/* Opens a regular file. Other files might never end, or never begin. */
static int open_regular(const char *path)
{
    struct stat status;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (file >= 0 && (fstat(file, &status) || !S_ISREG(status.st_mode))) {
        close(file);
        return -1;
    }
    return file;
}

/* Reads at most HEAD_BYTES. The name can be from an entry of the cache, which is untrusted, so only a regular
 * file is read. */
static bool read_head(const char *path, struct digest *digest)
{
    char data[HEAD_BYTES];
    int file = open_regular(path);
    if (file < 0)
        return false;
    ssize_t got = read(file, data, sizeof data);
    close(file);
    if (got >= 0)
        *digest = digest_of(data, (size_t)got);
    return got >= 0;
}

bool store_digest_file(const char *path, struct digest *digest)
{
    struct digest_state state;
    char piece[PIECE_BYTES];
    size_t bytes = 0;
    ssize_t got = -1;
    int file = open_regular(path);
    digest_begin(&state);
    while (file >= 0 && bytes <= LIMIT_FILE_BYTES && (got = read(file, piece, sizeof piece)) > 0) {
        digest_add(&state, piece, (size_t)got);
        bytes += (size_t)got;
    }
    if (file >= 0)
        close(file);
    *digest = digest_end(&state);
    return got == 0;
}

int store_read_file(const char *path, char **data, size_t *bytes)
{
    struct stat status;
    *data = NULL;
    if (stat(path, &status) || !S_ISREG(status.st_mode))
        return -1;
    return file_read(path, LIMIT_FILE_BYTES, data, bytes, NULL);
}

static char *path_of(const struct store_file *file, const char *path)
{
    size_t folder = file->beside ? (size_t)(basename(path) - path) : 0;
    char *joined = malloc(folder + strlen(file->name) + 1);
    if (joined) {
        memcpy(joined, path, folder);
        strcpy(joined + folder, file->name);
    }
    return joined;
}

static bool is_unchanged(const struct store_file *file, const char *path)
{
    struct digest digest;
    char *whole = path_of(file, path);
    bool read =
        whole && (file->part == PART_HEAD ? read_head(whole, &digest) : store_digest_file(whole, &digest));
    free(whole);
    if (file->part == PART_NONE)
        return whole && !read;
    return read && !memcmp(&digest, &file->digest, sizeof digest);
}

bool store_other_files_are_unchanged(const struct store_files *files, const char *path)
{
    for (uint32_t i = 1; i < files->count; i++)
        if (!is_unchanged(&files->file[i], path))
            return false;
    return true;
}

int store_add_head(struct store_files *files, const char *path)
{
    struct store_file file = {.name = (char *)(uintptr_t)path, .part = PART_HEAD};
    return read_head(path, &file.digest) ? store_add_file(files, &file) : -1;
}
