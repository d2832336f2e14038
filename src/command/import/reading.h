/* The files that Assimp opens while it imports a model. Each is read once, whole, into memory. */
#ifndef COMMAND_IMPORT_READING_H
#define COMMAND_IMPORT_READING_H

#include "command/store/files.h"

#include <stdbool.h>

struct aiFileIO;
struct reading;

/* Begins the import of the file at `path`, which must outlive it. Returns null if memory is short. */
struct reading *reading_begin(const char *path);

/* The functions to give to Assimp. */
struct aiFileIO *reading_functions(struct reading *reading);

/* Returns true if a file was not opened because memory was short. The import may have gone on without it. */
bool reading_was_short_of_memory(const struct reading *reading);

/* Ends the import. Adds the files that were opened, those that were searched for, and the library's to
 * `files`. Adds none if they are too many, if one has a name with control characters, or if memory is
 * short. */
void reading_end(struct reading *reading, const char *library, struct store_files *files);

#endif
