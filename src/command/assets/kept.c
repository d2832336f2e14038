/* A key has the mesh's own file and its options. The entry has the digests of the other files. */
#define _GNU_SOURCE /* basename of string.h */
#include "command/assets/kept.h"

#include "command/assets/transfer.h"
#include "command/store/store.h"

#include <stdlib.h>
#include <string.h>

/* A new option must be added to add_options. */
_Static_assert(sizeof(struct mesh_options) == 72, "an option is missing in the key");

static void add_options(struct digest_state *key, const struct mesh_options *options)
{
    const uint32_t numbers[] = {options->source,       options->normals, options->texcoords,
                                options->subdivisions, options->center,  options->bones};
    const float factors[] = {options->fit, options->repeat[0], options->repeat[1]};
    digest_add(key, numbers, sizeof numbers);
    digest_add(key, factors, sizeof factors);
}

/* The name of the file is part of the key, because its ending chooses the format, and formats can have files
 * beside it with names that follow from its own. */
static bool make_key(const char *path, const struct mesh_options *options, const struct digest *contents,
                     struct digest *key)
{
    struct digest_state state;
    const char *name = basename(path);
    if (!store_begin_key(&state, "mesh"))
        return false;
    digest_add(&state, name, strlen(name) + 1);
    add_options(&state, options);
    digest_add(&state, contents, sizeof *contents);
    *key = digest_end(&state);
    return true;
}

static bool make_key_of_file(const char *path, const struct mesh_options *options, struct digest *key)
{
    struct digest contents;
    char folder[STORE_PATH];
    return store_folder(folder) && store_digest_file(path, &contents) &&
           make_key(path, options, &contents, key);
}

bool kept_find(const char *path, const struct mesh_options *options, struct mesh *mesh)
{
    struct digest key;
    struct store_entry entry;
    if (!make_key_of_file(path, options, &key) || !store_find(&key, &entry))
        return false;
    bool good = !transfer_read(path, entry.data, entry.bytes, mesh, NULL) && mesh->index_count;
    free(entry.file);
    if (!good)
        store_remove(&key);
    if (good && store_other_files_are_unchanged(&mesh->files, path))
        return true;
    mesh_free(mesh);
    return false;
}

void kept_add(const char *path, const struct mesh_options *options, const struct mesh *mesh)
{
    struct digest key;
    struct answer entry = {0};
    if (mesh->files.count && make_key(path, options, &mesh->files.file[0].digest, &key) &&
        !transfer_write(mesh, &entry))
        store_keep(&key, entry.data, entry.bytes);
    free(entry.data);
}
