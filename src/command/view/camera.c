#include "command/view/camera.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The distance of the point when the origin of the world is not in front of the camera. */
static const float default_distance = 4;

static bool sets(const struct call *call, enum triptych_transform which)
{
    return call->type == CALL_TRANSFORM && call->transform.which == which;
}

static uint32_t count_of(const struct stream *stream, enum triptych_transform which)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < stream->call_count; i++)
        count += sets(&stream->calls[i], which);
    return count;
}

int camera_remember(const struct stream *stream, struct camera_originals *originals)
{
    enum triptych_transform which = TRIPTYCH_TRANSFORM_VIEW;
    uint32_t count = count_of(stream, which);
    if (!count) {
        which = TRIPTYCH_TRANSFORM_PROJECTION;
        count = count_of(stream, which);
    }
    *originals = (struct camera_originals){malloc((count + 1) * sizeof *originals->original), 0};
    if (!originals->original)
        return -1;
    for (uint32_t i = 0; i < stream->call_count; i++)
        if (sets(&stream->calls[i], which)) {
            struct camera_original *original = originals->original + originals->count++;
            original->call = i;
            memcpy(original->matrix, stream->calls[i].transform.matrix, sizeof original->matrix);
        }
    return 0;
}

/* Rows are vectors: p' = p * M. */
static void multiply(const float a[4][4], const float b[4][4], float product[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            product[i][j] = 0;
            for (int k = 0; k < 4; k++)
                product[i][j] += a[i][k] * b[k][j];
        }
}

/* A rotation around the camera's vertical axis, then its horizontal one, around the point (0, 0, z). */
static void rotation(const struct camera *camera, float z, float m[4][4])
{
    float sy = sinf(camera->yaw), cy = cosf(camera->yaw), sp = sinf(camera->pitch), cp = cosf(camera->pitch);
    const float r[3][3] = {{cy, sy * sp, -sy * cp}, {0, cp, sp}, {sy, -cy * sp, cy * cp}};
    memset(m, 0, 16 * sizeof(float));
    for (int i = 0; i < 3; i++)
        memcpy(m[i], r[i], sizeof r[i]);
    for (int j = 0; j < 3; j++)
        m[3][j] = -z * r[2][j];
    m[3][2] += z;
    m[3][3] = 1;
}

/* The depth of the point: of a view that of the world's origin, of a projection a guess. */
static float pivot(const float original[4][4], bool view)
{
    if (view)
        return original[3][2] != 0 ? original[3][2] : default_distance;
    return default_distance * original[2][3]; /* 0 without perspective, negative if it looks along -z */
}

static void turn(const struct camera *camera, const float original[4][4], bool view, float matrix[4][4])
{
    float turned[4][4], z = pivot(original, view);
    rotation(camera, z, turned);
    turned[3][2] += z * (expf(-camera->nearer) - 1);
    if (view)
        multiply(original, turned, matrix);
    else
        multiply(turned, original, matrix);
}

void camera_apply(const struct camera *camera, const struct camera_originals *originals,
                  struct stream *stream)
{
    bool moved = camera->yaw != 0 || camera->pitch != 0 || camera->nearer != 0;
    for (uint32_t i = 0; i < originals->count; i++) {
        const struct camera_original *original = originals->original + i;
        struct call_transform *transform = &stream->calls[original->call].transform;
        if (moved)
            turn(camera, original->matrix, transform->which == TRIPTYCH_TRANSFORM_VIEW, transform->matrix);
        else
            memcpy(transform->matrix, original->matrix, sizeof transform->matrix);
    }
}
