/* Shared by the parts of the player: resources and frames (play.c), calls (play_call.c), the initial state
 * (play_reset.c), recordings that are read while they are played (play_recording.c). */
#ifndef COMMAND_PLAY_PLAY_PART_H
#define COMMAND_PLAY_PLAY_PART_H

#include "command/container/reader.h"

enum { NOWHERE = UINT32_MAX };

struct handles {
    triptych_buffer *vertices, *indices;
    triptych_texture *texture;
    triptych_image *image;
    triptych_shader *shader;
    triptych_query *query;
    uint32_t frame; /* the frame in which the query ended last, or NOWHERE */
};

struct player {
    const struct stream *stream;  /* the whole stream, or the window of `reader` */
    struct stream_reader *reader; /* null if the stream is whole */
    triptych_device *device;
    struct handles *handles; /* one per resource */
    uint32_t handle_count;
    uint32_t frame; /* being played, or played last */
    uint32_t next;  /* the frame for which the device's state is correct, or NOWHERE */
    /* current values, for constants that are computed from them */
    float transform[TRIPTYCH_TRANSFORM_COUNT][4][4];
};

/* Creates the device's objects for a resource of the stream; destroys them. */
enum triptych_result player_create(triptych_device *device, const struct resource *resource,
                                   struct handles *handles);
void player_destroy(triptych_device *device, const struct handles *handles);

/* Execute a call: changes of state; changes of pixels and query results. */
enum triptych_result player_execute_state(struct player *player, const struct call *call);
enum triptych_result player_execute_pixels(struct player *player, const struct call *call);

/* Parts of calls, which the reset uses too. */
enum triptych_result player_set_value(triptych_device *device, enum triptych_state_table table, uint32_t i,
                                      uint32_t row, uint32_t value);
enum triptych_result player_set_transform(struct player *player, enum triptych_transform which,
                                          const float matrix[4][4]);
enum triptych_result player_bind_indices(struct player *player, uint32_t resource, uint32_t bits);

/* Calls that their rows do not describe (stream_functions). */
enum triptych_result play_target(struct player *player, const struct call *call);
enum triptych_result play_viewport(struct player *player, const struct call *call);
enum triptych_result play_set(struct player *player, const struct call *call);
enum triptych_result play_transform(struct player *player, const struct call *call);
enum triptych_result play_material(struct player *player, const struct call *call);
enum triptych_result play_light(struct player *player, const struct call *call);
enum triptych_result play_shader(struct player *player, const struct call *call);
enum triptych_result play_constants(struct player *player, const struct call *call);
enum triptych_result play_constant_matrix(struct player *player, const struct call *call);
enum triptych_result play_bind_element(struct player *player, const struct call *call);
enum triptych_result play_bind_stream(struct player *player, const struct call *call);
enum triptych_result play_declare(struct player *player, const struct call *call);
enum triptych_result play_bind_vertices(struct player *player, const struct call *call);
enum triptych_result play_bind_indices(struct player *player, const struct call *call);
enum triptych_result play_bind_mesh(struct player *player, const struct call *call);
enum triptych_result play_update(struct player *player, const struct call *call);
enum triptych_result play_texels(struct player *player, const struct call *call);
enum triptych_result play_contents(struct player *player, const struct call *call);
enum triptych_result play_attach(struct player *player, const struct call *call);
enum triptych_result play_copy(struct player *player, const struct call *call);
enum triptych_result play_clear_parts(struct player *player, const struct call *call);
enum triptych_result play_set_pixels(struct player *player, const struct call *call);
enum triptych_result play_fill(struct player *player, const struct call *call);
enum triptych_result play_clear(struct player *player, const struct call *call);
enum triptych_result play_draw_mesh(struct player *player, const struct call *call);
enum triptych_result play_write(struct player *player, const struct call *call);
enum triptych_result play_discard(struct player *player, const struct call *call);
enum triptych_result play_draw_user(struct player *player, const struct call *call);
enum triptych_result play_draw_indexed_user(struct player *player, const struct call *call);
enum triptych_result play_end_query(struct player *player, const struct call *call);

/* Sets the state in which streams begin. */
enum triptych_result player_reset(struct player *player);

/* player_frame of a recording. */
int player_recorded_frame(struct player *player, uint32_t frame, struct error *error);

#endif
