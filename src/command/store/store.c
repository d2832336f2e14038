/* An entry's file is a head and the data. The folder is the user's own, so its files are opened by path. */
#define _GNU_SOURCE /* secure_getenv */
#include "command/store/store.h"

#include "base/file.h"
#include "command/store/build.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <xxhash.h>

enum { NAME = 2 * DIGEST_BYTES, ENTRY_PATH = STORE_PATH + NAME + 2, USED_SECONDS = 3600 };

struct head {
    char magic[8];
    uint64_t bytes;          /* of the data */
    struct digest key;       /* an entry renamed by hand is not that of its name */
    XXH128_canonical_t hash; /* of the data */
};

static const char magic[8] = "TRIcache";

bool store_off;

/* --- The folder --- */

bool store_folder(char path[static STORE_PATH])
{
    if (store_off || getauxval(AT_SECURE))
        return false;
    const char *cache = secure_getenv("XDG_CACHE_HOME"), *home = secure_getenv("HOME");
    int length = -1;
    if (cache && *cache == '/')
        length = snprintf(path, STORE_PATH, "%s/triptych", cache);
    else if (home && *home == '/')
        length = snprintf(path, STORE_PATH, "%s/.cache/triptych", home);
    return length > 0 && length < STORE_PATH;
}

/* Other users could write wrong results into a folder that they own or may write to. */
static bool is_own(const char *folder)
{
    struct stat status;
    return !stat(folder, &status) && S_ISDIR(status.st_mode) && status.st_uid == geteuid() &&
           !(status.st_mode & (S_IWGRP | S_IWOTH));
}

/* Makes the folder and those that contain it. */
static void make_folder(char path[static STORE_PATH])
{
    for (char *slash = path; (slash = strchr(slash + 1, '/'));) {
        *slash = 0;
        mkdir(path, 0700);
        *slash = '/';
    }
    mkdir(path, 0700);
}

/* Returns false if there is no cache. */
static bool entry_path(const struct digest *key, bool make, char path[static ENTRY_PATH])
{
    if (!store_folder(path))
        return false;
    if (make)
        make_folder(path);
    if (!is_own(path))
        return false;
    char *at = path + strlen(path);
    *at++ = '/';
    for (int i = 0; i < DIGEST_BYTES; i++, at += 2)
        sprintf(at, "%02x", key->byte[i]);
    return true;
}

/* --- Keys --- */

bool store_begin_key(struct digest_state *key, const char *kind)
{
    size_t bytes;
    const uint8_t *build = store_build_id(&bytes);
    if (!build)
        return false;
    digest_begin(key);
    digest_add(key, kind, strlen(kind) + 1);
    digest_add(key, &bytes, sizeof bytes);
    digest_add(key, build, bytes);
    return true;
}

/* --- Entries --- */

static void make_head(struct head *head, const struct digest *key, const void *data, size_t bytes)
{
    *head = (struct head){.bytes = bytes, .key = *key};
    memcpy(head->magic, magic, sizeof magic);
    XXH128_canonicalFromHash(&head->hash, XXH3_128bits(data, bytes));
}

static bool is_whole(const char *file, size_t bytes, const struct digest *key)
{
    struct head expected;
    if (bytes < sizeof expected)
        return false;
    make_head(&expected, key, file + sizeof expected, bytes - sizeof expected);
    return !memcmp(file, &expected, sizeof expected);
}

/* The time of the file is that of its last use, to within an hour. */
static void mark_used(const char *path, const struct stat *status)
{
    if (time(NULL) - status->st_mtime > USED_SECONDS)
        utimensat(AT_FDCWD, path, NULL, 0);
}

bool store_find(const struct digest *key, struct store_entry *entry)
{
    char path[ENTRY_PATH];
    struct stat status;
    size_t bytes;
    if (!entry_path(key, false, path) || lstat(path, &status) || !S_ISREG(status.st_mode) ||
        file_read(path, sizeof(struct head) + STORE_ENTRY_BYTES, &entry->file, &bytes, NULL))
        return false;
    if (!is_whole(entry->file, bytes, key)) {
        free(entry->file);
        unlink(path);
        return false;
    }
    mark_used(path, &status);
    entry->data = entry->file + sizeof(struct head);
    entry->bytes = bytes - sizeof(struct head);
    return true;
}

/* Without syncing, because an entry that a crash of the system damages is found to be damaged. */
void store_keep(const struct digest *key, const void *data, size_t bytes)
{
    char path[ENTRY_PATH];
    struct head head;
    struct file_output output;
    if (bytes > STORE_ENTRY_BYTES || !entry_path(key, true, path) || file_begin(&output, path, NULL))
        return;
    output.unsynced = true;
    make_head(&head, key, data, bytes);
    if (file_append(&output, &head, sizeof head, NULL) || file_append(&output, data, bytes, NULL))
        file_discard(&output);
    else
        file_commit(&output, NULL);
    store_trim(STORE_BYTES, STORE_FILES);
}

void store_remove(const struct digest *key)
{
    char path[ENTRY_PATH];
    if (entry_path(key, false, path))
        unlink(path);
}
