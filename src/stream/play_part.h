/* What the parts of the player share: resources and frames (play.c), calls and the state before them (play_call.c),
 * recordings that are read as they are played (play_recording.c). */
#ifndef STREAM_PLAY_PART_H
#define STREAM_PLAY_PART_H

#include "stream/reader.h"

enum { NOWHERE = UINT32_MAX };

struct handles {
    triptych_buffer *vertices, *indices;
    triptych_texture *texture;
    triptych_shader *shader;
    triptych_query *query;
    uint32_t frame; /* that the query ended in last, or NOWHERE */
};

struct player {
    const struct stream *stream;  /* or the window of: */
    struct stream_reader *reader; /* null if the stream is whole */
    triptych_device *device;
    struct handles *handles; /* one per resource */
    uint32_t handle_count;
    uint32_t frame; /* being played, or played last */
    uint32_t next;  /* the frame that the device's state is right for, or NOWHERE */
    float transform[TRIPTYCH_TRANSFORM_COUNT][4][4]; /* as they are, for constants that are made of them */
};

/* The device's resources for one of the stream's; and their end. */
enum triptych_result player_create(triptych_device *device, const struct resource *resource,
                                   struct handles *handles);
void player_destroy(triptych_device *device, const struct handles *handles);

/* The texture's contents as the stream defines them. */
enum triptych_result player_fill(triptych_device *device, const struct resource *resource,
                                 triptych_texture *texture);

/* A call: what stays from call to call, and what changes pixels and counts. */
enum triptych_result player_execute_state(struct player *player, const struct call *call);
enum triptych_result player_execute_pixels(struct player *player, const struct call *call);

/* Everything to what it is before the first call. */
enum triptych_result player_reset(struct player *player);

/* player_frame of a recording. */
int player_recorded_frame(struct player *player, uint32_t frame, struct error *error);

#endif
