/* The bounds of the folder. Another process may add or remove files at the same time. */
#include "command/store/store.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { NAME = 2 * DIGEST_BYTES, NAME_ROOM = NAME + 1, LEFTOVER_SECONDS = 3600 };

struct file {
    char name[NAME_ROOM];
    uint64_t bytes;
    struct timespec used;
};

struct listing {
    struct file *files;
    unsigned count, capacity;
    uint64_t bytes;
};

static bool is_entry(const char *name)
{
    return strlen(name) == NAME && strspn(name, "0123456789abcdef") == NAME;
}

/* The temporary file of a process that was killed: base/file.h has the form of its name. */
static bool is_leftover(const char *name, const struct stat *status)
{
    size_t length = strlen(name);
    return length > NAME && strspn(name, "0123456789abcdef") == NAME && name[NAME] == '.' &&
           !strcmp(name + length - 4, ".new") && time(NULL) - status->st_mtime > LEFTOVER_SECONDS;
}

/* If memory is refused, the file is left out and stays. */
static void add(struct listing *listing, const char *name, const struct stat *status)
{
    if (listing->count == listing->capacity) {
        unsigned capacity = 2 * listing->capacity + 64;
        struct file *larger = realloc(listing->files, capacity * sizeof *larger);
        if (!larger)
            return;
        listing->files = larger;
        listing->capacity = capacity;
    }
    struct file *file = &listing->files[listing->count++];
    strcpy(file->name, name);
    file->bytes = (uint64_t)status->st_size;
    file->used = status->st_mtim;
    listing->bytes += file->bytes;
}

static void list(DIR *folder, struct listing *listing)
{
    struct stat status;
    for (struct dirent *entry; (entry = readdir(folder));) {
        if (fstatat(dirfd(folder), entry->d_name, &status, AT_SYMLINK_NOFOLLOW))
            continue;
        if (is_entry(entry->d_name))
            add(listing, entry->d_name, &status);
        else if (is_leftover(entry->d_name, &status))
            unlinkat(dirfd(folder), entry->d_name, 0);
    }
}

static int compare_use(const void *a, const void *b)
{
    const struct timespec *x = &((const struct file *)a)->used, *y = &((const struct file *)b)->used;
    if (x->tv_sec != y->tv_sec)
        return x->tv_sec < y->tv_sec ? -1 : 1;
    return (x->tv_nsec > y->tv_nsec) - (x->tv_nsec < y->tv_nsec);
}

static void remove_oldest(DIR *folder, struct listing *listing, uint64_t bytes, unsigned files)
{
    qsort(listing->files, listing->count, sizeof *listing->files, compare_use);
    unsigned left = listing->count;
    for (struct file *file = listing->files; left && (listing->bytes > bytes || left > files);
         file++, left--) {
        unlinkat(dirfd(folder), file->name, 0);
        listing->bytes -= file->bytes;
    }
}

void store_trim(uint64_t bytes, unsigned files)
{
    char path[STORE_PATH];
    struct listing listing = {0};
    DIR *folder = store_folder(path) ? opendir(path) : NULL;
    if (!folder)
        return;
    list(folder, &listing);
    if (listing.bytes > bytes || listing.count > files)
        remove_oldest(folder, &listing, bytes / 4 * 3, (unsigned)((uint64_t)files * 3 / 4));
    free(listing.files);
    closedir(folder);
}
