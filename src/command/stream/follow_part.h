/* The parts of a follower: states (follow.c), vertices and draws (follow_vertices.c), resources
 * (follow_resource.c). */
#ifndef COMMAND_STREAM_FOLLOW_PART_H
#define COMMAND_STREAM_FOLLOW_PART_H

#include "command/stream/follow.h"
#include "render/device/device.h"

/* A buffer that represents a resource in the state. The state reads its size and the values of indices. */
struct stand_in {
    struct triptych_buffer buffer; /* first: the state points to it */
    uint32_t resource;
    uint8_t *changed; /* its bytes, once a call has changed them; null: those of the resource */
};

struct followed {
    struct stand_in *stand_in;      /* null until the resource is bound */
    bool begun, released;           /* a query; any resource */
    struct call_position beginning; /* the call that began the query */
};

struct follower {
    const struct stream *stream;
    struct state state;
    struct shader_registers registers[SHADER_STAGES];
    uint32_t width, height;                    /* of the current target; 0: none yet */
    struct triptych_target_description target; /* the last CALL_TARGET's */
    struct triptych_target_description drawn;  /* the current target's: that one's, or that of textures */
    struct followed *resources;                /* by number, up to the largest that was used */
    uint32_t resource_count, begun;            /* queries that have begun */
    uint32_t indices, index_bits;
    uint32_t clip_mask; /* its texture */
    uint32_t texture[TRIPTYCH_SAMPLERS], shader[SHADER_STAGES], attached[TRIPTYCH_TARGETS + 1];
    bool integers_checked; /* the integer constants are valid for the shaders that are set */
};

/* Returns the resource as a buffer; null with the reason. */
struct triptych_buffer *follower_buffer(struct follower *follower, uint32_t resource, struct error *error);

/* Frees the buffer of a resource. */
void follower_free_buffer(struct followed *entry);

/* Sets the current target. */
void follower_draw_to(struct follower *follower, const struct triptych_target_description *target);

/* Calls whose rows do not describe them (stream_functions). They check that a call can be executed in the
 * current state, and change the state as the call does. */
int follow_target(struct follower *follower, const struct call *call, struct error *error);
int follow_viewport(struct follower *follower, const struct call *call, struct error *error);
int follow_scissor(struct follower *follower, const struct call *call, struct error *error);
int follow_set(struct follower *follower, const struct call *call, struct error *error);
int follow_convention(struct follower *follower, const struct call *call, struct error *error);
int follow_clip_mask(struct follower *follower, const struct call *call, struct error *error);
int follow_clip_plane(struct follower *follower, const struct call *call, struct error *error);
int follow_transform(struct follower *follower, const struct call *call, struct error *error);
int follow_material(struct follower *follower, const struct call *call, struct error *error);
int follow_light(struct follower *follower, const struct call *call, struct error *error);
int follow_bind_texture(struct follower *follower, const struct call *call, struct error *error);
int follow_bind_vertices(struct follower *follower, const struct call *call, struct error *error);
int follow_bind_indices(struct follower *follower, const struct call *call, struct error *error);
int follow_bind_element(struct follower *follower, const struct call *call, struct error *error);
int follow_bind_stream(struct follower *follower, const struct call *call, struct error *error);
int follow_declare(struct follower *follower, const struct call *call, struct error *error);
int follow_fvf(struct follower *follower, const struct call *call, struct error *error);
int follow_frequency(struct follower *follower, const struct call *call, struct error *error);
int follow_shader(struct follower *follower, const struct call *call, struct error *error);
int follow_constants(struct follower *follower, const struct call *call, struct error *error);
int follow_constant_matrix(struct follower *follower, const struct call *call, struct error *error);
int follow_texels(struct follower *follower, const struct call *call, struct error *error);
int follow_contents(struct follower *follower, const struct call *call, struct error *error);
int follow_attach(struct follower *follower, const struct call *call, struct error *error);
int follow_copy(struct follower *follower, const struct call *call, struct error *error);
int follow_set_pixels(struct follower *follower, const struct call *call, struct error *error);
int follow_fill(struct follower *follower, const struct call *call, struct error *error);
int follow_clear(struct follower *follower, const struct call *call, struct error *error);
int follow_draw(struct follower *follower, const struct call *call, struct error *error);
int follow_draw_indexed(struct follower *follower, const struct call *call, struct error *error);
int follow_draw_mesh(struct follower *follower, const struct call *call, struct error *error);
int follow_draw_user(struct follower *follower, const struct call *call, struct error *error);
int follow_draw_indexed_user(struct follower *follower, const struct call *call, struct error *error);
int follow_write(struct follower *follower, const struct call *call, struct error *error);
int follow_discard(struct follower *follower, const struct call *call, struct error *error);
int follow_begin_query(struct follower *follower, const struct call *call, struct error *error);
int follow_end_query(struct follower *follower, const struct call *call, struct error *error);
int follow_release(struct follower *follower, const struct call *call, struct error *error);

#endif
