#include "command/assets/skeleton.h"

#include "command/stream/transform.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void skeleton_free(struct skeleton *skeleton)
{
    if (!skeleton)
        return;
    for (uint32_t j = 0; j < skeleton->joint_count; j++)
        free(skeleton->joints[j].name);
    for (uint32_t a = 0; a < skeleton->animation_count; a++) {
        struct animation *animation = &skeleton->animations[a];
        for (uint32_t t = 0; t < animation->track_count; t++)
            for (int part = 0; part < TRACK_PARTS; part++)
                free(animation->tracks[t].keys[part]);
        free(animation->tracks);
        free(animation->name);
    }
    free(skeleton->joints);
    free(skeleton->bones);
    free(skeleton->animations);
    free(skeleton);
}

int skeleton_find(const struct skeleton *skeleton, const char *animation)
{
    for (uint32_t a = 0; a < skeleton->animation_count; a++)
        if (!strcmp(skeleton->animations[a].name, animation))
            return (int)a;
    return -1;
}

int skeleton_invert(const double m[4][4], double inverse[4][4])
{
    double determinant = 0, cofactor[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            cofactor[i][j] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
        }
    for (int j = 0; j < 3; j++)
        determinant += m[0][j] * cofactor[0][j];
    if (!(fabs(determinant) > 1e-30) || !isfinite(determinant))
        return -1;
    memset(inverse, 0, sizeof(double[4][4]));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            inverse[i][j] = cofactor[j][i] / determinant;
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            inverse[3][j] -= m[3][i] * inverse[i][j];
    inverse[3][3] = 1;
    return 0;
}

/* --- Between keys --- */

/* Interpolates along the shorter arc at constant speed; nearly equal rotations along the chord. */
static void turn_between(const double a[4], const double b[4], double part, double out[4])
{
    double cosine = 0, length = 0, from = 1 - part, to = part;
    for (int i = 0; i < 4; i++)
        cosine += a[i] * b[i];
    double sign = cosine < 0 ? -1 : 1;
    if (fabs(cosine) < 0.9999) {
        double angle = acos(fabs(cosine));
        from = sin(from * angle) / sin(angle);
        to = sin(to * angle) / sin(angle);
    }
    for (int i = 0; i < 4; i++) {
        out[i] = from * a[i] + to * sign * b[i];
        length += out[i] * out[i];
    }
    for (int i = 0; i < 4 && length > 0; i++)
        out[i] /= sqrt(length);
}

static void value_at(const struct track *track, enum track_part part, double time, double out[4])
{
    const struct track_key *keys = track->keys[part];
    uint32_t count = track->key_count[part], next = 0;
    while (next < count && keys[next].time <= time)
        next++;
    const struct track_key *a = &keys[next ? next - 1 : 0], *b = &keys[next < count ? next : count - 1];
    double between = b->time > a->time ? (time - a->time) / (b->time - a->time) : 0;
    if (part == TRACK_ROTATION) {
        turn_between(a->value, b->value, between, out);
        return;
    }
    for (int i = 0; i < 3; i++)
        out[i] = a->value[i] + between * (b->value[i] - a->value[i]);
}

/* Scale, then rotation, then position. */
static void track_matrix(const struct track *track, double time, double m[4][4])
{
    double value[TRACK_PARTS][4] = {{0}, {0, 0, 0, 1}, {1, 1, 1}};
    for (int part = 0; part < TRACK_PARTS; part++)
        if (track->key_count[part])
            value_at(track, (enum track_part)part, time, value[part]);
    const double *q = value[TRACK_ROTATION];
    double x = q[0], y = q[1], z = q[2], w = q[3];
    const double rotation[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
        {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
        {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
    };
    memset(m, 0, sizeof(double[4][4]));
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            m[i][j] = value[TRACK_SCALE][i] * rotation[i][j];
        m[3][i] = value[TRACK_POSITION][i];
    }
    m[3][3] = 1;
}

/* --- Poses --- */

/* Computes each joint's matrix to the coordinates of the model. */
static void place_joints(const struct skeleton *skeleton, const struct animation *animation, double time,
                         double (*place)[4][4])
{
    for (uint32_t j = 0; j < skeleton->joint_count; j++)
        memcpy(place[j], skeleton->joints[j].rest, sizeof place[j]);
    for (uint32_t t = 0; t < animation->track_count; t++)
        track_matrix(&animation->tracks[t], time, place[animation->tracks[t].joint]);
    for (uint32_t j = 0; j < skeleton->joint_count; j++)
        if (skeleton->joints[j].parent >= 0)
            transform_multiply(place[j], place[skeleton->joints[j].parent], place[j]);
}

int skeleton_pose(const struct skeleton *skeleton, uint32_t animation, double time, double (*matrices)[4][4])
{
    const struct animation *of = &skeleton->animations[animation];
    double(*place)[4][4] = malloc(skeleton->joint_count * sizeof *place);
    double into[4][4] = {{0}}, out[4][4] = {{0}}; /* from the mesh's coordinates to the file's, and back */
    if (!place)
        return -1;
    time = of->seconds > 0 ? fmod(time, of->seconds) : 0;
    place_joints(skeleton, of, time < 0 ? time + of->seconds : time, place);
    for (int i = 0; i < 3; i++) {
        into[i][i] = 1 / skeleton->scale;
        into[3][i] = skeleton->center[i];
        out[i][i] = skeleton->scale;
        out[3][i] = -skeleton->center[i] * skeleton->scale;
    }
    into[3][3] = out[3][3] = 1;
    for (uint32_t b = 0; b < skeleton->bone_count; b++) {
        double offset[4][4];
        memcpy(offset, skeleton->bones[b].offset, sizeof offset);
        transform_multiply(into, offset, matrices[b]);
        transform_multiply(matrices[b], place[skeleton->bones[b].joint], matrices[b]);
        transform_multiply(matrices[b], out, matrices[b]);
    }
    free(place);
    return 0;
}
