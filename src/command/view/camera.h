/* The camera of the viewer: it turns the view of a stream around a point on the view's axis.
 *
 * The camera follows the stream's own matrices: each view transform is followed by a rotation around the
 * point that is as far from the camera as the origin of the world, and by a movement along the axis. In a
 * stream without a view transform, the projections are turned. Shader constants that the stream computes from
 * transforms follow; matrices that it gives as numbers do not. */
#ifndef COMMAND_VIEW_CAMERA_H
#define COMMAND_VIEW_CAMERA_H

#include "command/stream/stream.h"

#include <stdbool.h>

struct camera {
    float yaw, pitch; /* radians */
    float nearer;     /* 0: the stream's distance; d: exp(d) times nearer */
};

/* The transforms of a stream that the camera changes, as they were read. */
struct camera_original {
    uint32_t call;
    float matrix[4][4];
};

struct camera_originals {
    struct camera_original *original;
    uint32_t count;
};

/* Remembers the transforms of the stream. Returns 0, or -1 when there is no memory. Without transforms the
 * camera cannot be moved. The caller frees `original`. */
int camera_remember(const struct stream *stream, struct camera_originals *originals);

/* Sets the transforms of the stream for the camera. */
void camera_apply(const struct camera *camera, const struct camera_originals *originals,
                  struct stream *stream);

#endif
