/* Materials of a model: the surface of some of its triangles. */
#ifndef COMMAND_IMPORT_MATERIAL_H
#define COMMAND_IMPORT_MATERIAL_H

#include <stddef.h>
#include <stdint.h>

enum { MATERIALS_MAXIMUM = 256 };

struct material {
    char *name;            /* may be empty */
    float diffuse[4];      /* red, green, blue, alpha, 0 to 1 */
    uint32_t first, count; /* its indices in the mesh: three per triangle */
    char *texture;         /* the diffuse texture's file as the model names it; null: none */
    uint8_t *picture;      /* the file itself, if it is embedded in the model; or null */
    size_t picture_bytes;
    uint32_t resource; /* for readers of streams: the number of the texture */
};

struct materials {
    struct material *of;
    uint32_t count;
};

/* Frees what it holds. */
void material_free_all(struct materials *materials);

struct aiScene;

/* Appends the material of that index, without triangles; a white one if the scene does not have it. Returns
 * 0, or -1 if memory is short. */
int material_add(struct materials *materials, const struct aiScene *scene, unsigned index);

/* Returns the path of a texture that a model names: relative to the folder of the model, within it. Of a path
 * that leads out of it, or starts at a root, only the last part is kept. The caller frees it; null if memory
 * is short. */
char *material_path(const char *texture);

#endif
