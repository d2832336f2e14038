#define _GNU_SOURCE /* dladdr */
#include "command/import/assimp.h"

#include <dlfcn.h>
#include <stddef.h>
#include <string.h>

static struct assimp assimp;

/* Returns -1 if the library has no function of that name. */
static int find(void *library, const char *name, void *function)
{
    void *found = dlsym(library, name);
    memcpy(function, &found, sizeof found);
    return found ? 0 : -1;
}

const struct assimp *assimp_load(const char *path, struct error *error)
{
    Dl_info information;
    if (assimp.path)
        return &assimp;
    void *library = dlopen(ASSIMP_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    int bad = library ? 0 : -1;
#define ASSIMP(name) bad = bad || find(library, #name, &assimp.name);
#include "command/import/assimp.def"
#undef ASSIMP
    if (!bad && dladdr((const void *)(uintptr_t)assimp.aiReleaseImport, &information))
        assimp.path = information.dli_fname;
    if (assimp.path)
        return &assimp;
    const char *reason = dlerror();
    error_set(error, "%s: needs " ASSIMP_LIBRARY ", which reads models: %s", path,
              reason ? reason : "no reason given");
    return NULL;
}

const struct aiScene *assimp_import(const struct assimp *functions, const char *path, unsigned steps,
                                    struct aiFileIO *files, const struct aiPropertyStore *properties)
{
    return functions->aiImportFileExWithProperties(path, steps, files, properties);
}

void assimp_release(const struct assimp *functions, const struct aiScene *scene)
{
    functions->aiReleaseImport(scene);
}
