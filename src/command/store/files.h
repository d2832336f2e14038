/* Files that determine a result, also by being absent, so that the result can be kept until one of them
 * changes. */
#ifndef COMMAND_STORE_FILES_H
#define COMMAND_STORE_FILES_H

#include "base/digest.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { STORE_FILES_MAXIMUM = 256 };

struct store_file {
    char *name;
    bool beside; /* the name is relative to the folder of the first file */
    enum store_part {
        PART_NONE,
        PART_WHOLE,
        PART_HEAD,
        PART_COUNT
    } part; /* in the digest; none: it is absent */
    struct digest digest;
};

/* The first is the main file: its name is relative to its own folder. No files: they are not known. */
struct store_files {
    struct store_file *file;
    uint32_t count;
};

/* Appends a copy. Functions that return int return 0, or -1 if memory is short. */
int store_add_file(struct store_files *files, const struct store_file *file);

/* Appends the main file, the first, by its contents. */
int store_add_main_file(struct store_files *files, const char *path, const void *data, size_t bytes);

/* Appends a file by its first 4,096 bytes, where a library has its build id. Returns -1 also if it cannot be
 * read. */
int store_add_head(struct store_files *files, const char *path);

void store_free_files(struct store_files *files);

/* Computes the digest of a file that store_read_file can read. Returns true if it did. */
bool store_digest_file(const char *path, struct digest *digest);

/* Reads a regular file within the limit of a stream's files; the caller frees *data. Returns 0, or -1 with
 * *data null. */
int store_read_file(const char *path, char **data, size_t *bytes);

/* Returns true if all files but the main one, which is at `path`, are as they were. */
bool store_other_files_are_unchanged(const struct store_files *files, const char *path);

#endif
