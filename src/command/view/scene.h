/* The stream that the viewer shows: drawn with any engine, up to any draw, and read again when its files
 * change. */
#ifndef COMMAND_VIEW_SCENE_H
#define COMMAND_VIEW_SCENE_H

#include "command/inspect/inspection.h"
#include "command/view/camera.h"

enum { SCENE_ALL = UINT32_MAX };

/* The part of the stream that is drawn, and how. */
struct scene_choice {
    unsigned engine,
        threads;          /* engine: a number of triptych_engine_name; threads: 0: one for each processor */
    uint32_t frame, draw; /* draw: the last one; SCENE_ALL: all of the frame */
    struct camera camera;
};

/* The result, which is valid until the next one. */
struct scene_picture {
    unsigned width, height;
    uint32_t *color; /* RGBA8, red in the low byte; the picture's upper row first */
    bool lower;      /* that is the target's last row (session_is_lower) */
    double ms;       /* of the frame's calls */
    unsigned routines;
    uint64_t code_bytes, triangles, pixels; /* pixels: covered */
};

/* Results of an observed frame: rows of the picture's size, in its order. */
struct scene_analysis {
    unsigned width, height;
    uint32_t *count;           /* how often each pixel is covered */
    struct watch_owner *owner; /* the primitive that it shows */
};

struct scene;

/* Functions that return int return 0, or -1 with the reason in one line. */

/* Reads a stream. Null with the reason. */
struct scene *scene_open(const char *path, struct error *error);
void scene_close(struct scene *scene);

/* Returns true if a file of the stream has changed since it was read: the stream itself, its meshes, textures
 * and shaders. */
bool scene_has_changed(struct scene *scene);

/* Reads the stream again. If that fails, the scene stays as it was. */
int scene_reload(struct scene *scene, struct error *error);

uint32_t scene_frames(const struct scene *scene);
uint32_t scene_draws(const struct scene *scene, uint32_t frame);

/* Returns true if the camera can be moved. */
bool scene_has_camera(const struct scene *scene);

int scene_draw(struct scene *scene, const struct scene_choice *choice, struct error *error);
const struct scene_picture *scene_picture(const struct scene *scene);

/* Observes what scene_draw draws. */
int scene_analyse(struct scene *scene, const struct scene_choice *choice, struct error *error);
const struct scene_analysis *scene_analysis(const struct scene *scene);

#endif
