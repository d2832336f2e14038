/* The cache: a folder of results that can be computed again, found by the digest of everything that they
 * depend on.
 *
 * The folder is $XDG_CACHE_HOME/triptych, or $HOME/.cache/triptych if that variable is not an absolute path.
 * An entry is a file whose name is its key. It is written under another name and then renamed, so processes
 * can share the folder. Its length and hash are checked when it is read: a damaged entry is removed.
 *
 * A failure only costs time. There is no cache if the folder cannot be made, belongs to another user or can
 * be written by others, if the process has more rights than its user (AT_SECURE), and after store_off is set.
 * An entry that cannot be written, as on a full disk, is not kept. No function reports an error. */
#ifndef COMMAND_STORE_STORE_H
#define COMMAND_STORE_STORE_H

#include "base/digest.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The bounds of the folder, and of one entry. */
enum { STORE_BYTES = 256 << 20, STORE_FILES = 4096, STORE_ENTRY_BYTES = 64 << 20 };

/* Disables the cache for this process: the option --no-cache. */
extern bool store_off;

/* Writes the path of the folder. It need not exist. Returns false if there is no cache. */
enum { STORE_PATH = 4096 };
bool store_folder(char path[static STORE_PATH]);

/* Begins a key with the build of this program, which determines how results are computed, and the name of a
 * kind of result. Returns false if the program has no build id; then there are no keys. */
bool store_begin_key(struct digest_state *key, const char *kind);

/* An entry that was read. The data are untrusted input, because anything could have written the file. */
struct store_entry {
    char *file; /* the memory to free */
    const void *data;
    size_t bytes;
};

/* Returns false if there is no such entry. */
bool store_find(const struct digest *key, struct store_entry *entry);

/* Keeps the data. Removes the entries that were not used for the longest time if the folder is larger than
 * its bounds. */
void store_keep(const struct digest *key, const void *data, size_t bytes);

/* Removes an entry whose data are wrong. */
void store_remove(const struct digest *key);

/* Removes the oldest entries until at most three quarters of the bounds are left, if there is more than the
 * bounds. For tests: smaller bounds. */
void store_trim(uint64_t bytes, unsigned files);

#endif
