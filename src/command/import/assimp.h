/* Assimp, loaded when the first model is imported.
 *
 * The library and those that it needs have 50,000 relocations, which take the dynamic linker longer than most
 * commands take to run. A process that imports no model never loads them. The process that imports models
 * (import.c) is a fork, so the command's own process never does. */
#ifndef COMMAND_IMPORT_ASSIMP_H
#define COMMAND_IMPORT_ASSIMP_H

#include "base/error.h"

#include <assimp/cimport.h>

struct assimp {
#define ASSIMP(name) __typeof__(name) *name;
#include "command/import/assimp.def"
#undef ASSIMP
    const char *path; /* of the library's file */
};

/* Returns the functions, or null with a reason that begins with `path`, the file to be imported. The first
 * call loads the library; no two threads may make it. */
const struct assimp *assimp_load(const char *path, struct error *error);

/* For tests, which replace them: the two calls in which Assimp reads a file and frees what it has read. */
const struct aiScene *assimp_import(const struct assimp *assimp, const char *path, unsigned steps,
                                    struct aiFileIO *files, const struct aiPropertyStore *properties);
void assimp_release(const struct assimp *assimp, const struct aiScene *scene);

#endif
