/* The format: head, vertices, indices, files, materials; for a skeleton its head, then joints, bones and
 * animations one by one. A name is its length and its bytes. */
#include "command/assets/transfer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAGIC = 0x6873656d, NAME_BYTES = 4096 };

struct head {
    uint32_t magic, vertices, indices, has_color, has_texcoord, has_skeleton, files, materials;
};

struct file_head {
    uint32_t beside, part;
    struct digest digest;
};

struct material_head {
    float diffuse[4];
    uint32_t count, has_texture, picture_bytes;
};

struct skeleton_head {
    uint32_t joints, bones, animations, zero;
    double center[3], scale;
};

/* --- Writing --- */

static int add_name(struct answer *answer, const char *name)
{
    uint32_t length = (uint32_t)strnlen(name, NAME_BYTES);
    return isolate_append(answer, &length, sizeof length) || isolate_append(answer, name, length);
}

static int add_files(struct answer *answer, const struct mesh *mesh)
{
    int bad = 0;
    for (uint32_t i = 0; !bad && i < mesh->files.count; i++) {
        const struct store_file *file = &mesh->files.file[i];
        struct file_head head = {file->beside, file->part, file->digest};
        bad = isolate_append(answer, &head, sizeof head) || add_name(answer, file->name);
    }
    return bad;
}

static int add_materials(struct answer *answer, const struct materials *materials)
{
    int bad = 0;
    for (uint32_t i = 0; !bad && i < materials->count; i++) {
        const struct material *material = &materials->of[i];
        struct material_head head = {.count = material->count,
                                     .has_texture = material->texture != NULL,
                                     .picture_bytes = (uint32_t)material->picture_bytes};
        memcpy(head.diffuse, material->diffuse, sizeof head.diffuse);
        bad = isolate_append(answer, &head, sizeof head) || add_name(answer, material->name) ||
              add_name(answer, material->texture ? material->texture : "") ||
              isolate_append(answer, material->picture, material->picture_bytes);
    }
    return bad;
}

static int add_animation(struct answer *answer, const struct animation *animation)
{
    int bad = add_name(answer, animation->name) ||
              isolate_append(answer, &animation->seconds, sizeof animation->seconds) ||
              isolate_append(answer, &animation->track_count, sizeof animation->track_count);
    for (uint32_t t = 0; !bad && t < animation->track_count; t++) {
        const struct track *track = &animation->tracks[t];
        bad = isolate_append(answer, &track->joint, sizeof track->joint) ||
              isolate_append(answer, track->key_count, sizeof track->key_count);
        for (int part = 0; !bad && part < TRACK_PARTS; part++)
            bad =
                isolate_append(answer, track->keys[part], track->key_count[part] * sizeof *track->keys[part]);
    }
    return bad;
}

static int add_skeleton(struct answer *answer, const struct skeleton *skeleton)
{
    struct skeleton_head head = {
        skeleton->joint_count, skeleton->bone_count, skeleton->animation_count, 0, {0}, skeleton->scale};
    memcpy(head.center, skeleton->center, sizeof head.center);
    int bad = isolate_append(answer, &head, sizeof head);
    for (uint32_t j = 0; !bad && j < head.joints; j++) {
        const struct joint *joint = &skeleton->joints[j];
        bad = add_name(answer, joint->name) || isolate_append(answer, &joint->parent, sizeof joint->parent) ||
              isolate_append(answer, joint->rest, sizeof joint->rest);
    }
    bad = bad || isolate_append(answer, skeleton->bones, head.bones * sizeof *skeleton->bones);
    for (uint32_t a = 0; !bad && a < head.animations; a++)
        bad = add_animation(answer, &skeleton->animations[a]);
    return bad;
}

int transfer_write(const struct mesh *mesh, struct answer *answer)
{
    struct head head = {MAGIC,
                        mesh->vertex_count,
                        mesh->index_count,
                        mesh->has_color != 0,
                        mesh->has_texcoord != 0,
                        mesh->skeleton != NULL,
                        mesh->files.count,
                        mesh->materials.count};
    int bad = isolate_append(answer, &head, sizeof head) ||
              isolate_append(answer, mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices) ||
              isolate_append(answer, mesh->indices, mesh->index_count * sizeof *mesh->indices) ||
              add_files(answer, mesh) || add_materials(answer, &mesh->materials) ||
              (mesh->skeleton && add_skeleton(answer, mesh->skeleton));
    return bad ? -1 : 0;
}

/* --- Reading --- */

struct reader {
    const uint8_t *at;
    size_t left;
    const char *path;
    struct error *error;
};

static int damaged(const struct reader *reader, const char *what)
{
    return error_set(reader->error, "%s: the answer of its reader is damaged: %s", reader->path, what);
}

static int take(struct reader *reader, void *out, size_t bytes)
{
    if (bytes > reader->left)
        return damaged(reader, "it ends early");
    if (bytes)
        memcpy(out, reader->at, bytes);
    reader->at += bytes;
    reader->left -= bytes;
    return 0;
}

/* Allocates `count` zeroed elements. Each takes at least `least` of the remaining bytes, which bounds
 * `count`. */
static int make_room(struct reader *reader, size_t count, size_t size, size_t least, void *room)
{
    void *made;
    if (count > reader->left / least)
        return damaged(reader, "it ends early");
    made = calloc(count ? count : 1, size);
    memcpy(room, &made, sizeof made);
    return made ? 0 : error_set(reader->error, "%s: not enough memory", reader->path);
}

static int take_array(struct reader *reader, size_t count, size_t size, void *array)
{
    void *made;
    if (make_room(reader, count, size, size, array))
        return -1;
    memcpy(&made, array, sizeof made);
    return take(reader, made, count * size);
}

static int take_name(struct reader *reader, char **name)
{
    uint32_t length = 0;
    if (take(reader, &length, sizeof length))
        return -1;
    if (length > NAME_BYTES)
        return damaged(reader, "a name is too long");
    if (!(*name = malloc(length + 1)))
        return error_set(reader->error, "%s: not enough memory", reader->path);
    (*name)[length] = 0;
    if (take(reader, *name, length))
        return -1;
    for (uint32_t i = 0; i < length; i++)
        if ((unsigned char)(*name)[i] < ' ' || (*name)[i] == 0x7f)
            (*name)[i] = ' ';
    return 0;
}

static bool are_finite(const float *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return false;
    return true;
}

static int check_vertices(struct reader *reader, const struct mesh *mesh)
{
    uint32_t bones = mesh->skeleton ? mesh->skeleton->bone_count : 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const struct mesh_vertex *vertex = &mesh->vertices[v];
        if (!are_finite(vertex->position, 3) || !are_finite(vertex->normal, 3) ||
            !are_finite(vertex->texcoord, 2) || !are_finite(vertex->weight, 4))
            return damaged(reader, "a vertex is not finite");
        for (int i = 0; i < 4; i++)
            if (vertex->bone[i] >= bones)
                return damaged(reader, "a vertex has a missing bone");
    }
    for (uint32_t i = 0; i < mesh->index_count; i++)
        if (mesh->indices[i] >= mesh->vertex_count)
            return damaged(reader, "a triangle uses a missing vertex");
    return 0;
}

/* --- Skeletons --- */

static int take_joints(struct reader *reader, struct skeleton *skeleton, uint32_t count)
{
    enum { LEAST = sizeof(uint32_t) + sizeof(int) + sizeof(double[4][4]) };
    if (make_room(reader, count, sizeof *skeleton->joints, LEAST, &skeleton->joints))
        return -1;
    while (skeleton->joint_count < count) {
        int number = (int)skeleton->joint_count++;
        struct joint *joint = &skeleton->joints[number];
        if (take_name(reader, &joint->name) || take(reader, &joint->parent, sizeof joint->parent) ||
            take(reader, joint->rest, sizeof joint->rest))
            return -1;
        if (joint->parent < -1 || joint->parent >= number)
            return damaged(reader, "a joint precedes its parent");
    }
    return 0;
}

static int take_bones(struct reader *reader, struct skeleton *skeleton, uint32_t count)
{
    if (!count || count > SKELETON_BONES)
        return damaged(reader, "a wrong number of bones");
    if (take_array(reader, count, sizeof *skeleton->bones, &skeleton->bones))
        return -1;
    skeleton->bone_count = count;
    for (uint32_t b = 0; b < count; b++)
        if (skeleton->bones[b].joint >= skeleton->joint_count)
            return damaged(reader, "a bone without its joint");
    return 0;
}

static int take_track(struct reader *reader, const struct skeleton *skeleton, struct track *track)
{
    if (take(reader, &track->joint, sizeof track->joint) ||
        take(reader, track->key_count, sizeof track->key_count))
        return -1;
    if (track->joint >= skeleton->joint_count)
        return damaged(reader, "a track without its joint");
    for (int part = 0; part < TRACK_PARTS; part++)
        if (take_array(reader, track->key_count[part], sizeof *track->keys[part], &track->keys[part]))
            return -1;
    return 0;
}

static int take_animation(struct reader *reader, const struct skeleton *skeleton, struct animation *animation)
{
    enum { LEAST = sizeof(uint32_t) * (1 + TRACK_PARTS) };
    uint32_t count = 0;
    if (take_name(reader, &animation->name) || take(reader, &animation->seconds, sizeof animation->seconds) ||
        take(reader, &count, sizeof count) ||
        make_room(reader, count, sizeof *animation->tracks, LEAST, &animation->tracks))
        return -1;
    while (animation->track_count < count)
        if (take_track(reader, skeleton, &animation->tracks[animation->track_count++]))
            return -1;
    return 0;
}

static int take_skeleton(struct reader *reader, struct mesh *mesh)
{
    enum { LEAST = sizeof(uint32_t) * 2 + sizeof(double) };
    struct skeleton_head head;
    struct skeleton *skeleton = mesh->skeleton = calloc(1, sizeof *skeleton);
    if (!skeleton)
        return error_set(reader->error, "%s: not enough memory", reader->path);
    if (take(reader, &head, sizeof head))
        return -1;
    if (!isfinite(head.center[0] + head.center[1] + head.center[2] + head.scale))
        return damaged(reader, "a skeleton's place is not finite");
    memcpy(skeleton->center, head.center, sizeof head.center);
    skeleton->scale = head.scale;
    if (take_joints(reader, skeleton, head.joints) || take_bones(reader, skeleton, head.bones) ||
        make_room(reader, head.animations, sizeof *skeleton->animations, LEAST, &skeleton->animations))
        return -1;
    while (skeleton->animation_count < head.animations)
        if (take_animation(reader, skeleton, &skeleton->animations[skeleton->animation_count++]))
            return -1;
    return 0;
}

/* --- Meshes --- */

static int take_files(struct reader *reader, struct mesh *mesh, uint32_t count)
{
    if (count > STORE_FILES_MAXIMUM)
        return damaged(reader, "too many files");
    for (uint32_t i = 0; i < count; i++) {
        struct file_head head;
        char *name = NULL;
        int bad = take(reader, &head, sizeof head) || take_name(reader, &name);
        if (!bad && head.part >= PART_COUNT)
            bad = damaged(reader, "a wrong part of a file");
        if (!bad &&
            store_add_file(&mesh->files, &(struct store_file){name, head.beside, head.part, head.digest}))
            bad = error_set(reader->error, "%s: not enough memory", reader->path);
        free(name);
        if (bad)
            return -1;
    }
    return 0;
}

static int take_material(struct reader *reader, struct material *material)
{
    struct material_head head;
    if (take(reader, &head, sizeof head) || take_name(reader, &material->name) ||
        take_name(reader, &material->texture))
        return -1;
    for (int i = 0; i < 4; i++)
        if (!(head.diffuse[i] >= 0 && head.diffuse[i] <= 1))
            return damaged(reader, "a colour beyond 0 to 1");
    memcpy(material->diffuse, head.diffuse, sizeof head.diffuse);
    material->count = head.count;
    if (!head.has_texture) {
        free(material->texture);
        material->texture = NULL;
    }
    if (!head.picture_bytes)
        return 0;
    material->picture_bytes = head.picture_bytes;
    return take_array(reader, head.picture_bytes, 1, &material->picture);
}

/* The materials have all triangles, each its own. */
static int take_materials(struct reader *reader, struct mesh *mesh, uint32_t count)
{
    struct materials *materials = &mesh->materials;
    uint32_t first = 0;
    if (count > MATERIALS_MAXIMUM)
        return damaged(reader, "too many materials");
    if (count &&
        make_room(reader, count, sizeof *materials->of, sizeof(struct material_head), &materials->of))
        return -1;
    while (materials->count < count) {
        struct material *material = &materials->of[materials->count++];
        if (take_material(reader, material))
            return -1;
        material->first = first;
        if (!material->count || material->count % 3 || material->count > mesh->index_count - first)
            return damaged(reader, "a material with a wrong number of triangles");
        first += material->count;
    }
    return !count || first == mesh->index_count ? 0 : damaged(reader, "triangles without a material");
}

static int take_mesh(struct reader *reader, struct mesh *mesh)
{
    struct head head;
    if (take(reader, &head, sizeof head))
        return -1;
    if (head.magic != MAGIC || head.vertices > LIMIT_VERTICES || head.indices > LIMIT_VALUES ||
        head.indices % 3)
        return damaged(reader, "a wrong number of vertices or indices");
    mesh->has_color = head.has_color != 0;
    mesh->has_texcoord = head.has_texcoord != 0;
    if (take_array(reader, head.vertices, sizeof *mesh->vertices, &mesh->vertices))
        return -1;
    mesh->vertex_count = mesh->vertex_capacity = head.vertices;
    if (take_array(reader, head.indices, sizeof *mesh->indices, &mesh->indices))
        return -1;
    mesh->index_count = mesh->index_capacity = head.indices;
    if (take_files(reader, mesh, head.files) || take_materials(reader, mesh, head.materials))
        return -1;
    if (head.has_skeleton && take_skeleton(reader, mesh))
        return -1;
    return reader->left ? damaged(reader, "it continues after its end") : check_vertices(reader, mesh);
}

int transfer_read(const char *path, const void *data, size_t bytes, struct mesh *mesh, struct error *error)
{
    struct reader reader = {data, bytes, path, error};
    int result = take_mesh(&reader, mesh);
    if (result)
        mesh_free(mesh);
    return result;
}
