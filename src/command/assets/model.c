/* Models through Assimp's C interface: every mesh of the scene at every node that shows it, in world
 * coordinates.
 *
 * Assimp's matrices are for column vectors. Normals are transformed by the cofactors of the upper 3x3 matrix:
 * the inverse transpose up to a positive factor, which also exists for singular matrices. A mirroring node
 * reverses its triangles. */
#include "command/import/assimp.h"
#include "command/assets/bones.h"
#include "command/assets/mesh.h"
#include "command/import/locate.h"
#include "command/import/reading.h"
#include "base/file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { NODE_DEPTH_MAXIMUM = 64, REASON_BYTES = 160 };

struct placement {
    struct aiMatrix4x4 matrix;
    float cofactor[3][3];
    float determinant;
};

static struct placement make_placement(const struct aiMatrix4x4 *m)
{
    struct placement p = {.matrix = *m};
    const float a[3][3] = {{m->a1, m->a2, m->a3}, {m->b1, m->b2, m->b3}, {m->c1, m->c2, m->c3}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            p.cofactor[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
        }
    for (int j = 0; j < 3; j++)
        p.determinant += a[0][j] * p.cofactor[0][j];
    return p;
}

/* A normal without a direction, in a damaged file, counts as missing. */
static void place_normal(const struct placement *p, const struct aiVector3D *n, float out[3])
{
    float length, sign = p->determinant < 0 ? -1.0f : 1.0f;
    for (int i = 0; i < 3; i++)
        out[i] = sign * (p->cofactor[i][0] * n->x + p->cofactor[i][1] * n->y + p->cofactor[i][2] * n->z);
    length = sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int i = 0; i < 3; i++)
        out[i] = length > 0 && isfinite(length) ? out[i] / length : 0;
}

static uint32_t pack_color(const struct aiColor4D *color)
{
    const float channel[4] = {color->b, color->g, color->r, color->a};
    uint32_t packed = 0;
    for (int i = 0; i < 4; i++)
        packed |= (uint32_t)lrintf(255 * fminf(fmaxf(channel[i], 0), 1)) << 8 * i;
    return packed;
}

static struct mesh_vertex make_vertex(const struct aiMesh *source, unsigned i, const struct placement *p)
{
    const struct aiMatrix4x4 *m = &p->matrix;
    struct aiVector3D at = source->mVertices[i];
    struct mesh_vertex v = {.color = 0xffffffff};
    v.position[0] = m->a1 * at.x + m->a2 * at.y + m->a3 * at.z + m->a4;
    v.position[1] = m->b1 * at.x + m->b2 * at.y + m->b3 * at.z + m->b4;
    v.position[2] = m->c1 * at.x + m->c2 * at.y + m->c3 * at.z + m->c4;
    if (source->mNormals)
        place_normal(p, &source->mNormals[i], v.normal);
    if (source->mColors[0])
        v.color = pack_color(&source->mColors[0][i]);
    if (source->mTextureCoords[0]) {
        v.texcoord[0] = source->mTextureCoords[0][i].x;
        v.texcoord[1] = source->mTextureCoords[0][i].y;
    }
    return v;
}

static int add_mesh(struct mesh *mesh, const char *path, const struct aiMesh *source,
                    const struct aiNode *node, const struct placement *p, struct error *error)
{
    uint32_t first = mesh->vertex_count;
    bool mirrored = p->determinant < 0;
    for (unsigned i = 0; i < source->mNumVertices; i++) {
        struct mesh_vertex vertex = make_vertex(source, i, p);
        if (mesh_add_vertex(mesh, path, &vertex, error))
            return -1;
    }
    if (mesh->skeleton && bones_add(mesh, path, source, node, &p->matrix, first, error))
        return -1;
    for (unsigned i = 0; i < source->mNumFaces; i++) {
        const struct aiFace *face = &source->mFaces[i];
        if (face->mNumIndices != 3)
            continue;
        for (int c = 0; c < 3; c++)
            if (face->mIndices[c] >= source->mNumVertices)
                return error_set(error, "%s: a triangle uses a missing vertex", path);
        if (mesh_add_triangle(mesh, path, first + face->mIndices[0], first + face->mIndices[mirrored ? 2 : 1],
                              first + face->mIndices[mirrored ? 1 : 2], error))
            return -1;
    }
    mesh->has_color |= source->mColors[0] != NULL;
    mesh->has_texcoord |= source->mTextureCoords[0] != NULL;
    return 0;
}

/* a = a * b, with the order of additions that Assimp has. */
static void multiply(struct aiMatrix4x4 *a, const struct aiMatrix4x4 *b)
{
    float x[4][4], y[4][4], product[4][4];
    memcpy(x, a, sizeof x);
    memcpy(y, b, sizeof y);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            product[i][j] = x[i][0] * y[0][j] + x[i][1] * y[1][j] + x[i][2] * y[2][j] + x[i][3] * y[3][j];
    memcpy(a, product, sizeof product);
}

/* A mesh to which the meshes of a scene are added: those of one material, or of all. */
struct addition {
    struct mesh *mesh;
    const char *path;
    const struct aiScene *scene;
    unsigned material; /* the number of materials: of meshes without one */
    bool all;
};

static bool is_wanted(const struct addition *addition, const struct aiMesh *source)
{
    unsigned count = addition->scene->mNumMaterials;
    unsigned material = source->mMaterialIndex < count ? source->mMaterialIndex : count;
    return addition->all || material == addition->material;
}

static int add_node(const struct addition *to, const struct aiNode *node, const struct aiMatrix4x4 *parent,
                    struct error *error)
{
    struct aiMatrix4x4 matrix = *parent;
    if (!node)
        return 0;
    multiply(&matrix, &node->mTransformation);
    struct placement placement = make_placement(&matrix);
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        unsigned number = node->mMeshes[i];
        if (number < to->scene->mNumMeshes && is_wanted(to, to->scene->mMeshes[number]) &&
            add_mesh(to->mesh, to->path, to->scene->mMeshes[number], node, &placement, error))
            return -1;
    }
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (add_node(to, node->mChildren[i], &matrix, error))
            return -1;
    return 0;
}

static bool is_used(const struct addition *to)
{
    for (unsigned i = 0; i < to->scene->mNumMeshes; i++)
        if (is_wanted(to, to->scene->mMeshes[i]))
            return true;
    return false;
}

/* Adds the triangles of one material after the other. */
static int add_by_material(struct addition *to, const struct aiMatrix4x4 *identity, struct error *error)
{
    struct materials *materials = &to->mesh->materials;
    for (to->material = 0; to->material <= to->scene->mNumMaterials; to->material++) {
        uint32_t first = to->mesh->index_count;
        if (!is_used(to))
            continue;
        if (add_node(to, to->scene->mRootNode, identity, error))
            return -1;
        if (to->mesh->index_count == first)
            continue;
        if (materials->count == MATERIALS_MAXIMUM)
            return error_set(error, "%s: more than %d materials", to->path, MATERIALS_MAXIMUM);
        if (material_add(materials, to->scene, to->material))
            return error_set(error, "%s: not enough memory", to->path);
        materials->of[materials->count - 1].first = first;
        materials->of[materials->count - 1].count = to->mesh->index_count - first;
    }
    return 0;
}

/* Assimp's reasons can have several lines; only the first is kept. */
static int fail_import(const struct assimp *assimp, const char *path, struct error *error)
{
    char reason[REASON_BYTES];
    snprintf(reason, sizeof reason, "%s", assimp->aiGetErrorString());
    for (char *c = reason; *c; c++)
        if ((unsigned char)*c < ' ')
            *c = ' ';
    return error_set(error, "%s: found no model that Assimp reads, expected one: %s", path,
                     *reason ? reason : "no reason is given");
}

/* Replaces the reason by one with a line, if the file is text that has a fault. */
static void locate_in_file(const char *path, struct error *error)
{
    struct error found = {{0}};
    char *text;
    size_t bytes;
    if (file_read(path, LIMIT_FILE_BYTES, &text, &bytes, &found))
        return;
    if (error && locate_fault(path, text, bytes, &found))
        *error = found;
    free(text);
}

/* Assimp allocates and reads the sizes that a PLY header claims. A count larger than the file's bytes is
 * refused first. */
static int check_ply(const char *path, FILE *file, long long bytes, struct error *error)
{
    char line[256], name[64];
    unsigned long long count;
    if (!fgets(line, sizeof line, file) || strncmp(line, "ply", 3) || (unsigned char)line[3] > ' ')
        return 0;
    for (int number = 2; fgets(line, sizeof line, file) && strncmp(line, "end_header", 10); number++)
        if (sscanf(line, " element %63s %llu", name, &count) == 2 && count > (unsigned long long)bytes)
            return error_set(error, "%s:%d: %llu entries of %s in a file of %lld bytes", path, number, count,
                             name, bytes);
    return 0;
}

/* Assimp opens the file itself, and the files that it names. */
static int check_file(const char *path, struct error *error)
{
    FILE *file = fopen(path, "rb");
    struct stat status;
    if (!file)
        return error_set(error, "%s: cannot open: %s, expected a model file", path, strerror(errno));
    int result = fstat(fileno(file), &status);
    if (result || !S_ISREG(status.st_mode) || status.st_size > LIMIT_FILE_BYTES)
        result =
            error_set(error, "%s: is not a file of at most %d bytes, expected one", path, LIMIT_FILE_BYTES);
    else
        result = check_ply(path, file, status.st_size, error);
    fclose(file);
    return result;
}

/* Children can be null: Assimp leaves them so when a RAW file has several groups. */
static int check_depth(const struct aiNode *node, int depth)
{
    if (!node)
        return 0;
    if (depth == NODE_DEPTH_MAXIMUM)
        return -1;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (check_depth(node->mChildren[i], depth + 1))
            return -1;
    return 0;
}

/* Adds all meshes of all nodes. */
static int add_scene(struct mesh *mesh, const char *path, const struct aiScene *scene, unsigned parts,
                     struct error *error)
{
    struct addition to = {mesh, path, scene, 0, !(parts & MODEL_MATERIALS)};
    const struct aiMatrix4x4 identity = {.a1 = 1, .b2 = 1, .c3 = 1, .d4 = 1};
    if (!scene->mRootNode)
        return error_set(error, "%s: no meshes", path);
    if (check_depth(scene->mRootNode, 0))
        return error_set(error, "%s: nodes nested more than %d deep", path, NODE_DEPTH_MAXIMUM);
    if ((parts & MODEL_BONES) && !(mesh->skeleton = bones_read(scene, path, error)))
        return -1;
    if (to.all ? add_node(&to, scene->mRootNode, &identity, error) : add_by_material(&to, &identity, error))
        return -1;
    return mesh->index_count ? 0 : error_set(error, "%s: no triangles", path);
}

int mesh_import_model(struct mesh *mesh, const char *path, unsigned parts, struct error *error)
{
    static const unsigned steps = aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                                  aiProcess_SortByPType | aiProcess_FlipUVs | aiProcess_ImproveCacheLocality |
                                  aiProcess_FindInvalidData;
    const struct assimp *assimp = check_file(path, error) ? NULL : assimp_load(path, error);
    if (!assimp)
        return -1;
    struct aiPropertyStore *properties = assimp->aiCreatePropertyStore();
    struct reading *reading = properties ? reading_begin(path) : NULL;
    const struct aiScene *scene = NULL;
    int result = -1;
    if (reading) {
        assimp->aiSetImportPropertyInteger(properties, AI_CONFIG_PP_SBP_REMOVE,
                                           aiPrimitiveType_POINT | aiPrimitiveType_LINE);
        scene = assimp_import(assimp, path, steps, reading_functions(reading), properties);
        bool starved = reading_was_short_of_memory(reading);
        if (starved)
            error_set(error, "%s: not enough memory", path);
        else
            result = scene ? add_scene(mesh, path, scene, parts, error) : fail_import(assimp, path, error);
        reading_end(reading, assimp->path, &mesh->files);
        if (result && !starved)
            locate_in_file(path, error);
    } else {
        error_set(error, "%s: not enough memory", path);
    }
    if (scene)
        assimp_release(assimp, scene);
    if (properties)
        assimp->aiReleasePropertyStore(properties);
    return result;
}
