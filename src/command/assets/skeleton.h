/* Skeletons: a tree of joints, bones that move the vertices, and animations.
 *
 * Matrices are for row vectors, in binary64. A bone's `offset` transforms a vertex of the mesh at rest,
 * before it is centred and scaled, to the coordinates of its joint. A joint's matrix leads to the coordinates
 * of its parent. Parents precede their joints. Times are in seconds. */
#ifndef COMMAND_ASSETS_SKELETON_H
#define COMMAND_ASSETS_SKELETON_H

#include <stdint.h>

enum { SKELETON_BONES = 256 }; /* the most that indices of one byte distinguish */

enum track_part { TRACK_POSITION, TRACK_ROTATION, TRACK_SCALE, TRACK_PARTS };

struct track_key {
    double time;
    double value[4]; /* x y z; a rotation's quaternion x y z w */
};

struct skeleton {
    struct joint {
        char *name;
        int parent; /* -1: none */
        double rest[4][4];
    } * joints;
    struct bone {
        uint32_t joint;
        double offset[4][4];
    } * bones;
    struct animation {
        char *name;
        double seconds;
        struct track {
            uint32_t joint;
            struct track_key *keys[TRACK_PARTS]; /* sorted by time */
            uint32_t key_count[TRACK_PARTS];     /* 0: the part is the identity */
        } * tracks;
        uint32_t track_count;
    } * animations;
    uint32_t joint_count, bone_count, animation_count;
    double center[3], scale; /* of the mesh: its points are (p - center) * scale */
};

/* Null is allowed. */
void skeleton_free(struct skeleton *skeleton);

/* The number of that animation, or -1. */
int skeleton_find(const struct skeleton *skeleton, const char *animation);

/* Computes each bone's matrix, from the mesh at rest to the animation at a time. Time wraps at the
 * animation's end. `matrices` has room for bone_count. Returns 0, or -1 if memory is short. */
int skeleton_pose(const struct skeleton *skeleton, uint32_t animation, double time, double (*matrices)[4][4]);

/* Inverts an affine matrix. Returns 0, or -1 if it has no inverse. */
int skeleton_invert(const double m[4][4], double inverse[4][4]);

#endif
