/* Properties of Assimp's materials are looked up here, not by its functions, which would have to be loaded.
 * Their keys are those of assimp/material.h. Damaged files can contain properties of any length. */
#include "command/import/material.h"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

void material_free_all(struct materials *materials)
{
    for (uint32_t i = 0; i < materials->count; i++) {
        free(materials->of[i].name);
        free(materials->of[i].texture);
        free(materials->of[i].picture);
    }
    free(materials->of);
    *materials = (struct materials){0};
}

static const struct aiMaterialProperty *find(const struct aiMaterial *material, const char *key,
                                             unsigned semantic, enum aiPropertyTypeInfo type)
{
    for (unsigned i = 0; i < material->mNumProperties; i++) {
        const struct aiMaterialProperty *property = material->mProperties[i];
        if (property && property->mSemantic == semantic && !property->mIndex && property->mType == type &&
            !strcmp(property->mKey.data, key))
            return property;
    }
    return NULL;
}

/* Reads up to `count` numbers. Returns how many there are; they are limited to 0 to 1. */
static unsigned read_numbers(const struct aiMaterial *material, const char *key, float *numbers,
                             unsigned count)
{
    const struct aiMaterialProperty *property = find(material, key, 0, aiPTI_Float);
    unsigned there = property ? property->mDataLength / (unsigned)sizeof *numbers : 0;
    there = there < count ? there : count;
    if (there)
        memcpy(numbers, property->mData, there * sizeof *numbers);
    for (unsigned i = 0; i < there; i++)
        numbers[i] = isfinite(numbers[i]) ? fminf(fmaxf(numbers[i], 0), 1) : 1;
    return there;
}

/* The text is its length in 32 bits, then its bytes. Returns a copy; null also if memory is short. */
static char *read_text(const struct aiMaterialProperty *property)
{
    uint32_t length;
    if (property->mDataLength < sizeof length)
        return NULL;
    memcpy(&length, property->mData, sizeof length);
    if (length > property->mDataLength - sizeof length)
        length = property->mDataLength - (uint32_t)sizeof length;
    return strndup(property->mData + sizeof length, length);
}

static void read_color(const struct aiMaterial *material, float diffuse[4])
{
    unsigned count = read_numbers(material, "$clr.base", diffuse, 4);
    if (!count)
        count = read_numbers(material, "$clr.diffuse", diffuse, 4);
    if (count < 4)
        read_numbers(material, "$mat.opacity", &diffuse[3], 1);
}

/* A name that is * and a number is that of an embedded file. Pictures that Assimp has decoded have a height
 * and are left out. */
static int read_picture(const struct aiScene *scene, struct material *material)
{
    const char *name = material->texture;
    if (name[0] != '*')
        return 0;
    unsigned long number = strtoul(name + 1, NULL, 10);
    const struct aiTexture *texture = number < scene->mNumTextures ? scene->mTextures[number] : NULL;
    if (!texture || texture->mHeight || !texture->mWidth)
        return 0;
    material->picture = malloc(texture->mWidth);
    if (!material->picture)
        return -1;
    memcpy(material->picture, texture->pcData, texture->mWidth);
    material->picture_bytes = texture->mWidth;
    return 0;
}

static int read_texture(const struct aiScene *scene, const struct aiMaterial *from, struct material *material)
{
    const struct aiMaterialProperty *property = find(from, "$tex.file", aiTextureType_DIFFUSE, aiPTI_String);
    if (!property)
        property = find(from, "$tex.file", aiTextureType_BASE_COLOR, aiPTI_String);
    if (!property)
        return 0;
    material->texture = read_text(property);
    if (!material->texture)
        return -1;
    if (*material->texture)
        return read_picture(scene, material);
    free(material->texture);
    material->texture = NULL;
    return 0;
}

int material_add(struct materials *materials, const struct aiScene *scene, unsigned index)
{
    const struct aiMaterial *from = index < scene->mNumMaterials ? scene->mMaterials[index] : NULL;
    struct material *larger = realloc(materials->of, (materials->count + 1) * sizeof *larger);
    if (!larger)
        return -1;
    materials->of = larger;
    struct material *material = &larger[materials->count++];
    *material = (struct material){.diffuse = {1, 1, 1, 1}};
    const struct aiMaterialProperty *name = from ? find(from, "?mat.name", 0, aiPTI_String) : NULL;
    material->name = name ? read_text(name) : strdup("");
    if (!material->name)
        return -1;
    if (!from)
        return 0;
    read_color(from, material->diffuse);
    return read_texture(scene, from, material);
}

char *material_path(const char *texture)
{
    char *path = strdup(texture);
    bool outside = path && (path[0] == '/' || path[0] == '\\' || (path[0] && path[1] == ':'));
    for (char *c = path; c && *c; c++)
        if (*c == '\\')
            *c = '/';
    for (const char *part = path; part && *part && !outside; part += strspn(part, "/")) {
        size_t length = strcspn(part, "/");
        outside = length == 2 && !memcmp(part, "..", 2);
        part += length;
    }
    const char *last = path && outside ? strrchr(path, '/') : NULL;
    if (last)
        memmove(path, last + 1, strlen(last));
    else if (path && path[0] == '.' && path[1] == '/')
        memmove(path, path + 2, strlen(path) - 1);
    return path;
}
