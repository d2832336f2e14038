#include "command/assets/bones.h"

#include "command/stream/transform.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static int no_memory(const char *path, struct error *error)
{
    return error_set(error, "%s: not enough memory", path);
}

static void copy_matrix(const struct aiMatrix4x4 *from, double to[4][4])
{
    const float column[4][4] = {{from->a1, from->b1, from->c1, from->d1},
                                {from->a2, from->b2, from->c2, from->d2},
                                {from->a3, from->b3, from->c3, from->d3},
                                {from->a4, from->b4, from->c4, from->d4}};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            to[i][j] = column[i][j];
}

static int find_joint(const struct skeleton *skeleton, const char *name)
{
    for (uint32_t j = 0; j < skeleton->joint_count; j++)
        if (!strcmp(skeleton->joints[j].name, name))
            return (int)j;
    return -1;
}

/* --- Joints --- */

static uint32_t count_nodes(const struct aiNode *node)
{
    uint32_t count = 1;
    if (!node)
        return 0;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        count += count_nodes(node->mChildren[i]);
    return count;
}

static int add_joints(struct skeleton *skeleton, const struct aiNode *node, int parent)
{
    if (!node)
        return 0;
    struct joint *joint = &skeleton->joints[skeleton->joint_count];
    int number = (int)skeleton->joint_count++;
    joint->name = strdup(node->mName.data);
    joint->parent = parent;
    copy_matrix(&node->mTransformation, joint->rest);
    int result = joint->name ? 0 : -1;
    for (unsigned i = 0; !result && i < node->mNumChildren; i++)
        result = add_joints(skeleton, node->mChildren[i], number);
    return result;
}

/* --- Animations --- */

static int copy_vectors(struct track *track, enum track_part part, const struct aiVectorKey *from,
                        uint32_t count, double rate)
{
    track->keys[part] = calloc(count, sizeof *track->keys[part]);
    if (count && !track->keys[part])
        return -1;
    track->key_count[part] = count;
    for (uint32_t i = 0; i < count; i++)
        track->keys[part][i] =
            (struct track_key){from[i].mTime / rate, {from[i].mValue.x, from[i].mValue.y, from[i].mValue.z}};
    return 0;
}

static int copy_turns(struct track *track, const struct aiQuatKey *from, uint32_t count, double rate)
{
    track->keys[TRACK_ROTATION] = calloc(count, sizeof *track->keys[TRACK_ROTATION]);
    if (count && !track->keys[TRACK_ROTATION])
        return -1;
    track->key_count[TRACK_ROTATION] = count;
    for (uint32_t i = 0; i < count; i++)
        track->keys[TRACK_ROTATION][i] = (struct track_key){
            from[i].mTime / rate, {from[i].mValue.x, from[i].mValue.y, from[i].mValue.z, from[i].mValue.w}};
    return 0;
}

/* Omits tracks of nodes that do not exist. */
static int add_animation(struct skeleton *skeleton, const struct aiAnimation *from)
{
    static const double usual_rate = 25; /* ticks a second, if the file has no rate */
    double rate = from->mTicksPerSecond > 0 ? from->mTicksPerSecond : usual_rate;
    struct animation *animation = &skeleton->animations[skeleton->animation_count++];
    animation->name = strdup(from->mName.data);
    animation->seconds = from->mDuration / rate;
    animation->tracks = calloc(from->mNumChannels ? from->mNumChannels : 1, sizeof *animation->tracks);
    if (!animation->name || !animation->tracks)
        return -1;
    for (unsigned i = 0; i < from->mNumChannels; i++) {
        const struct aiNodeAnim *channel = from->mChannels[i];
        int joint = find_joint(skeleton, channel->mNodeName.data);
        if (joint < 0)
            continue;
        struct track *track = &animation->tracks[animation->track_count++];
        track->joint = (uint32_t)joint;
        if (copy_vectors(track, TRACK_POSITION, channel->mPositionKeys, channel->mNumPositionKeys, rate) ||
            copy_turns(track, channel->mRotationKeys, channel->mNumRotationKeys, rate) ||
            copy_vectors(track, TRACK_SCALE, channel->mScalingKeys, channel->mNumScalingKeys, rate))
            return -1;
    }
    return 0;
}

struct skeleton *bones_read(const struct aiScene *scene, const char *path, struct error *error)
{
    struct skeleton *skeleton = calloc(1, sizeof *skeleton);
    bool good = skeleton != NULL;
    if (good) {
        skeleton->scale = 1;
        skeleton->joints = calloc(count_nodes(scene->mRootNode), sizeof *skeleton->joints);
        skeleton->bones = calloc(SKELETON_BONES, sizeof *skeleton->bones);
        skeleton->animations =
            calloc(scene->mNumAnimations ? scene->mNumAnimations : 1, sizeof *skeleton->animations);
        good = skeleton->joints && skeleton->bones && skeleton->animations &&
               !add_joints(skeleton, scene->mRootNode, -1);
    }
    for (unsigned i = 0; good && i < scene->mNumAnimations; i++)
        good = !add_animation(skeleton, scene->mAnimations[i]);
    if (good)
        return skeleton;
    skeleton_free(skeleton);
    no_memory(path, error);
    return NULL;
}

/* --- Bones --- */

/* A null `offset` means the joint itself, at the position of its node. Returns the bone's number. */
static int add_bone(struct skeleton *skeleton, const char *path, const char *name,
                    const struct aiMatrix4x4 *offset, double from_rest[4][4], struct error *error)
{
    int joint = find_joint(skeleton, name);
    if (joint < 0)
        return error_set(error, "%s: bone '%s' has no node", path, name);
    if (skeleton->bone_count == SKELETON_BONES)
        return error_set(error, "%s: more than %d bones", path, SKELETON_BONES);
    struct bone *bone = &skeleton->bones[skeleton->bone_count];
    bone->joint = (uint32_t)joint;
    memcpy(bone->offset, from_rest, sizeof bone->offset);
    if (offset) {
        double matrix[4][4];
        copy_matrix(offset, matrix);
        transform_multiply(from_rest, matrix, bone->offset);
    }
    return (int)skeleton->bone_count++;
}

/* Keeps the four largest weights. */
static void add_weight(struct mesh_vertex *vertex, int bone, float weight)
{
    int least = 0;
    for (int i = 1; i < 4; i++)
        least = vertex->weight[i] < vertex->weight[least] ? i : least;
    if (weight > vertex->weight[least]) {
        vertex->weight[least] = weight;
        vertex->bone[least] = (uint8_t)bone;
    }
}

/* Sorts the largest weight last: the pipeline computes the last weight as 1 minus the others. */
static void even_out(struct mesh_vertex *vertex, int node_bone)
{
    int most = 3;
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        sum += (double)vertex->weight[i];
        most = vertex->weight[i] > vertex->weight[most] ? i : most;
    }
    if (!(sum > 0)) {
        vertex->weight[3] = 1;
        vertex->bone[3] = (uint8_t)node_bone;
        return;
    }
    struct mesh_vertex old = *vertex;
    vertex->weight[most] = old.weight[3];
    vertex->bone[most] = old.bone[3];
    vertex->weight[3] = old.weight[most];
    vertex->bone[3] = old.bone[most];
    for (int i = 0; i < 4; i++)
        vertex->weight[i] = (float)((double)vertex->weight[i] / sum);
}

static int follow(struct mesh *mesh, const char *path, const struct aiBone *bone, int number, uint32_t first,
                  struct error *error)
{
    for (unsigned i = 0; i < bone->mNumWeights; i++) {
        const struct aiVertexWeight *weight = &bone->mWeights[i];
        if (weight->mVertexId >= mesh->vertex_count - first || !isfinite(weight->mWeight))
            return error_set(error, "%s: bone '%s' moves a missing vertex", path, bone->mName.data);
        add_weight(&mesh->vertices[first + weight->mVertexId], number, weight->mWeight);
    }
    return 0;
}

int bones_add(struct mesh *mesh, const char *path, const struct aiMesh *source, const struct aiNode *node,
              const struct aiMatrix4x4 *matrix, uint32_t first, struct error *error)
{
    double place[4][4], from_rest[4][4];
    int number = 0;
    copy_matrix(matrix, place);
    if (skeleton_invert(place, from_rest))
        return error_set(error, "%s: the matrix of node '%s' has no inverse", path, node->mName.data);
    for (unsigned i = 0; i < source->mNumBones; i++) {
        const struct aiBone *bone = source->mBones[i];
        number = add_bone(mesh->skeleton, path, bone->mName.data, &bone->mOffsetMatrix, from_rest, error);
        if (number < 0 || follow(mesh, path, bone, number, first, error))
            return -1;
    }
    bool unbound = source->mNumBones == 0;
    for (uint32_t v = first; !unbound && v < mesh->vertex_count; v++) {
        const float *weight = mesh->vertices[v].weight;
        unbound = !(weight[0] > 0 || weight[1] > 0 || weight[2] > 0 || weight[3] > 0);
    }
    if (unbound)
        number = add_bone(mesh->skeleton, path, node->mName.data, NULL, from_rest, error);
    for (uint32_t v = first; number >= 0 && v < mesh->vertex_count; v++)
        even_out(&mesh->vertices[v], number);
    return number < 0 ? -1 : 0;
}
