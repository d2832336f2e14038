#define _GNU_SOURCE /* basename of string.h */
#include "command/import/reading.h"

#include "command/store/files.h"

#include <assimp/cfileio.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* A file by the path that Assimp used; data is null if there is no such file. */
struct opened {
    struct opened *next;
    char *path, *data;
    size_t bytes;
};

struct reading {
    struct aiFileIO functions;
    const char *path;
    struct opened *first, **last;
    uint32_t count;
    bool short_of_memory;
};

/* An open file and the position in it. */
struct handle {
    struct aiFile functions;
    const struct opened *file;
    size_t position;
};

/* --- Functions for Assimp --- */

static struct handle *handle_of(struct aiFile *file)
{
    return (struct handle *)(void *)file;
}

static size_t read_items(struct aiFile *file, char *out, size_t size, size_t count)
{
    struct handle *handle = handle_of(file);
    size_t left = handle->file->bytes - handle->position;
    size_t items = size ? left / size : 0;
    items = items < count ? items : count;
    memcpy(out, handle->file->data + handle->position, items * size);
    handle->position += items * size;
    return items;
}

static size_t write_items(struct aiFile *file, const char *data, size_t size, size_t count)
{
    (void)file, (void)data, (void)size, (void)count;
    return 0;
}

static size_t tell(struct aiFile *file)
{
    return handle_of(file)->position;
}

static size_t size_of(struct aiFile *file)
{
    return handle_of(file)->file->bytes;
}

static enum aiReturn seek(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    struct handle *handle = handle_of(file);
    size_t base = origin == aiOrigin_CUR   ? handle->position
                  : origin == aiOrigin_END ? handle->file->bytes
                                           : 0;
    if (base + offset > handle->file->bytes) /* a negative offset wraps around */
        return aiReturn_FAILURE;
    handle->position = base + offset;
    return aiReturn_SUCCESS;
}

static void flush(struct aiFile *file)
{
    (void)file;
}

static struct opened *find(const struct reading *reading, const char *path)
{
    struct opened *file = reading->first;
    while (file && strcmp(file->path, path))
        file = file->next;
    return file;
}

static struct opened *add(struct reading *reading, const char *path)
{
    struct opened *file = calloc(1, sizeof *file);
    char *copy = file ? strdup(path) : NULL;
    if (!copy) {
        reading->short_of_memory = true;
        free(file);
        return NULL;
    }
    file->path = copy;
    errno = 0;
    if (store_read_file(path, &file->data, &file->bytes))
        reading->short_of_memory |= errno == ENOMEM;
    *reading->last = file;
    reading->last = &file->next;
    reading->count++;
    return file;
}

static struct aiFile *open_file(struct aiFileIO *functions, const char *path, const char *mode)
{
    struct reading *reading = (struct reading *)(void *)functions;
    struct opened *file = find(reading, path);
    if (strpbrk(mode, "wa+"))
        return NULL;
    if (!file)
        file = add(reading, path);
    if (!file || !file->data)
        return NULL;
    struct handle *handle = calloc(1, sizeof *handle);
    if (!handle) {
        reading->short_of_memory = true;
        return NULL;
    }
    handle->file = file;
    handle->functions = (struct aiFile){.ReadProc = read_items,
                                        .WriteProc = write_items,
                                        .TellProc = tell,
                                        .FileSizeProc = size_of,
                                        .SeekProc = seek,
                                        .FlushProc = flush};
    return &handle->functions;
}

static void close_file(struct aiFileIO *functions, struct aiFile *file)
{
    (void)functions;
    free(handle_of(file));
}

/* --- Beginning and end --- */

struct reading *reading_begin(const char *path)
{
    struct reading *reading = calloc(1, sizeof *reading);
    if (!reading)
        return NULL;
    reading->functions = (struct aiFileIO){.OpenProc = open_file, .CloseProc = close_file};
    reading->path = path;
    reading->last = &reading->first;
    add(reading, path);
    return reading;
}

struct aiFileIO *reading_functions(struct reading *reading)
{
    return &reading->functions;
}

bool reading_was_short_of_memory(const struct reading *reading)
{
    return reading->short_of_memory;
}

static bool has_control(const char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < ' ' || *text == 0x7f)
            return true;
    return false;
}

static int list_file(const struct reading *reading, const struct opened *file, struct store_files *files)
{
    size_t folder = (size_t)(basename(reading->path) - reading->path);
    bool beside = !strncmp(file->path, reading->path, folder);
    struct store_file listed = {.name = file->path + (beside ? folder : 0),
                                .beside = beside,
                                .part = file->data ? PART_WHOLE : PART_NONE};
    if (file->data)
        listed.digest = digest_of(file->data, file->bytes);
    return has_control(listed.name) ? -1 : store_add_file(files, &listed);
}

void reading_end(struct reading *reading, const char *library, struct store_files *files)
{
    int bad = reading->short_of_memory || reading->count > STORE_FILES_MAXIMUM - 1;
    for (struct opened *file = reading->first, *next; file; file = next) {
        bad = bad || list_file(reading, file, files);
        next = file->next;
        free(file->path);
        free(file->data);
        free(file);
    }
    if (bad || store_add_head(files, library))
        store_free_files(files);
    free(reading);
}
