/* What moves a mesh: joints that hang from one another, bones that carry the vertices, and animations.
 *
 * Matrices are for row vectors, in binary64. A bone's `offset` takes a vertex of the mesh, as it lies at rest
 * and before it is centred and scaled, to the coordinates of its joint; joint matrices lead to the parent's.
 * Joints stand behind their parents. Times are in seconds. */
#ifndef STREAM_SKELETON_H
#define STREAM_SKELETON_H

#include <stdint.h>

enum { SKELETON_BONES = 256 }; /* what indices of four bytes can tell apart */

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
            struct track_key *keys[TRACK_PARTS]; /* by time */
            uint32_t key_count[TRACK_PARTS];     /* 0: that part is the identity's */
        } * tracks;
        uint32_t track_count;
    } * animations;
    uint32_t joint_count, bone_count, animation_count;
    double center[3], scale; /* of the mesh: (p - center) * scale */
};

/* Null is allowed. */
void skeleton_free(struct skeleton *skeleton);

/* The number of the animation of that name, or -1. */
int skeleton_find(const struct skeleton *skeleton, const char *animation);

/* Each bone's matrix, from the mesh at rest to the mesh in the animation at a time; past its end it begins
 * anew. `matrices` has room for bone_count. Returns -1 if memory is short. */
int skeleton_pose(const struct skeleton *skeleton, uint32_t animation, double time, double (*matrices)[4][4]);

/* Of an affine matrix. Returns -1 if it has no inverse. */
int skeleton_invert(const double m[4][4], double inverse[4][4]);

#endif
