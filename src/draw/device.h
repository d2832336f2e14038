/* The device: the state, what the application made, the routine cache, and the frame that records and
 * renders.
 *
 * The functions are those of triptych.h without its checks of null pointers; each gives its result and the
 * reason, and changes nothing when it fails. The engine is the caller's choice (engines.h). */
#ifndef DRAW_DEVICE_H
#define DRAW_DEVICE_H

#include "draw/cache.h"
#include "draw/change.h"
#include "draw/constant.h"
#include "draw/frame.h"
#include "draw/query.h"
#include "draw/shuffle.h"
#include "draw/state.h"
#include "draw/surface.h"
#include "shader/shader.h"

#include <errno.h>

/* Called for each draw that is recorded: its number, from 0, and its keys, indexed by enum unit. */
typedef void device_draw_callback(void *user, uint64_t number, const union key key[UNIT_COUNT]);

/* World matrices of indexed vertex blending, as draws have them. */
struct palette {
    struct palette *next;
    struct palette_entry entry[WORLD_MATRICES];
};

struct triptych_shader {
    struct triptych_device *device;
    struct triptych_shader *next; /* of the device's */
    const struct program *program;
    void *source; /* what it was made of, for recordings */
    size_t source_bytes;
    bool source_is_text;
    uint32_t recorded; /* its number while calls are recorded */
};

struct held {
    const struct routine *routine;
    uint64_t hits; /* of draws that did not have to ask the cache */
};

struct triptych_device {
    const struct engine *engine;
    struct code_arena *arena; /* null when the engine generates no code */
    struct cache *cache;
    struct pool *pool;
    struct frame *frame;
    struct target target;
    struct target parked;                  /* what was the target before textures are drawn to */
    struct triptych_target_textures drawn; /* these, while */
    bool draws_to_textures;
    struct state state;
    struct shader_registers registers[SHADER_STAGES]; /* the state's */
    struct triptych_buffer *buffers;
    struct triptych_texture *textures;
    struct triptych_shader *shaders, *shader[SHADER_STAGES]; /* all, those that are set */
    struct constants constants;                              /* of recorded draws */
    bool integers_checked;                                   /* state_check_integers found nothing */
    struct queries queries;

    /* What the state derives to, but for what has changed since somebody asked (device_record.c). */
    unsigned stale; /* these parts (draw/derive.h) */
    union key key[UNIT_COUNT];
    struct job job;
    struct live_job live;     /* of the job */
    struct palette *palettes; /* the job's, then those of recorded draws */
    bool steps;               /* some stream does not go by the vertex */
    uint64_t vertices;        /* that all elements have which are read; 0 if one has no buffer, or none */
    struct draw draw; /* what does not depend on the call; routines and job, if held and recorded, or null */

    /* Routines that recorded draws use, each held once for all draws that follow one another, or nearly. */
    struct held *held; /* one of held_by */
    uint32_t held_count;
    uint32_t in_use[UNIT_COUNT]; /* of them, by the draw's routines */

    /* What the draws use that are rendered in the background (device_render.c). */
    struct {
        struct held *held; /* the other one */
        uint32_t held_count;
        struct palette *palettes;
        uint32_t commands;
    } rendered;
    struct held held_by[2][FRAME_COMMANDS * UNIT_COUNT];

    uint64_t draws, triangles;
    uint64_t recording;        /* counts how often the queue was emptied */
    struct recorder *recorder; /* of calls (container/record.h), or null */

    device_draw_callback *on_draw;
    void *on_draw_user;

    struct error error;               /* of the last failed public call */
    struct error debug_error;         /* why something of options.debug cannot be done */
    struct error debug_told;          /* what triptych_debug_error gave */
    char key_text[KEY_TEXT_CAPACITY]; /* of the last routine reported */
};

struct device_options {
    unsigned threads;   /* 0: as many as processors */
    size_t cache_bytes; /* 0: CACHE_BYTES */
    size_t code_bytes;  /* of the code arena; 0: enough for the cache and the largest routines */
    bool measure;       /* the calls of routines are timed */
    const char *debug;  /* words of def/debug.def, comma-separated; null: none */
    pool_create_thread *create_thread; /* null: pthread_create */
    uint32_t arena_bytes;              /* of the frame's arena; 0: ARENA_BYTES */
};

/* What a failure was, of a function before which errno was 0. */
static inline enum triptych_result device_refusal(enum triptych_result otherwise)
{
    return errno == ENOMEM ? TRIPTYCH_NO_MEMORY : otherwise;
}

enum { CACHE_BYTES = 16 << 20, CACHE_BYTES_MAXIMUM = 1 << 30 };

enum triptych_result device_create(const struct engine *engine, const struct device_options *options,
                                   struct triptych_device **device, struct error *error);
void device_destroy(struct triptych_device *device);

enum triptych_result device_set_target(struct triptych_device *device,
                                       const struct triptych_target_description *description,
                                       struct error *error);
/* Whether set_target was called: fails without a target. */
enum triptych_result device_has_target(const struct triptych_device *device, struct error *error);
/* Whether a description is one of a target. */
enum triptych_result device_check_target(const struct triptych_target_description *description,
                                         struct error *error);

/* Drawing to textures (device_surface.c); null goes back. */
enum triptych_result device_set_target_textures(struct triptych_device *device,
                                                const struct triptych_target_textures *textures,
                                                struct error *error);
void device_leave_textures(struct triptych_device *device);
bool device_draws_to(const struct triptych_device *device, const struct triptych_texture *texture);

/* Before texels are read or changed by others than draws: renders what is recorded if it may use or draw the
 * texture, and stores what was drawn. After a change: what is drawn to begins with it. */
void device_store_texture(struct triptych_device *device, const struct triptych_texture *texture);
void device_load_texture(struct triptych_device *device, const struct triptych_texture *texture);

enum triptych_result device_copy(struct triptych_device *device, const struct surface_copy *copy,
                                 struct error *error);
enum triptych_result device_read_surface(struct triptych_device *device,
                                         const struct triptych_surface *surface, uint32_t *rgba,
                                         struct error *error);
enum triptych_result device_read_surface_numbers(struct triptych_device *device,
                                                 const struct triptych_surface *surface, float *numbers,
                                                 struct error *error);

/* What is drawn to, and a texture, as they are stored (draw/contents.c). */
size_t device_contents_bytes(const struct triptych_device *device);
enum triptych_result device_read_contents(struct triptych_device *device, void *data, struct error *error);
enum triptych_result device_write_contents(struct triptych_device *device, const void *data, size_t bytes,
                                           struct error *error);
void device_read_texels(struct triptych_device *device, struct triptych_texture *texture, void *data);
enum triptych_result device_write_texels(struct triptych_device *device, struct triptych_texture *texture,
                                         const void *data, size_t bytes, struct error *error);

/* Direct access to the state is for changes; they must be followed by this, with the parts that may have changed
 * (draw/change.h). */
static inline void device_state_changed(struct triptych_device *device, unsigned parts)
{
    device->stale |= parts;
}

/* device_record.c: derives what is stale, for draws of a primitive. */
enum triptych_result device_derive(struct triptych_device *device, enum triptych_primitive primitive,
                                   struct error *error);

/* Records a checked draw of what is derived, all instances one after the other: `source` has what depends on the call. */
enum triptych_result device_record(struct triptych_device *device, const struct draw *source,
                                   uint32_t instances, struct error *error);

/* The place of the next command; renders what is recorded if there is no other. */
struct command *device_next_command(struct triptych_device *device);

/* Whether draws sample the texture of sampler number i. */
bool device_samples(const struct triptych_device *device, int i);

/* Tells the cache of hits that it does not know of. */
void device_count_hits(struct triptych_device *device);

/* Lets go of the routines that were held last, down to `count`. */
void device_let_go(struct triptych_device *device, uint32_t count);

/* Vertices or indices that `count` primitives take; count is not 0. */
uint64_t primitive_corners(enum triptych_primitive primitive, uint32_t count);

/* Records `count` primitives: from vertex `first` on, or with the bound indices from `first` on, plus base.
 */
enum triptych_result device_draw(struct triptych_device *device, enum triptych_primitive primitive,
                                 uint32_t first, uint32_t count, struct error *error);
enum triptych_result device_draw_indexed(struct triptych_device *device, enum triptych_primitive primitive,
                                         int32_t base, uint32_t first, uint32_t count, struct error *error);
/* What a clear sets: flags as in triptych.h, and the values that they name. */
struct clear_values {
    unsigned flags;
    const float *color; /* four */
    float depth;
    unsigned stencil;
};
enum triptych_result device_clear(struct triptych_device *device, const struct clear_values *values,
                                  struct error *error);

enum triptych_result device_query_begin(struct triptych_device *device, struct triptych_query *query,
                                        struct error *error);
enum triptych_result device_query_end(struct triptych_device *device, struct triptych_query *query,
                                      struct error *error);
enum triptych_result device_query_result(struct triptych_device *device, struct triptych_query *query,
                                         uint64_t *result, struct error *error);

/* From now on rendering takes no more than so many of the device's threads; 0: all. For tools that compare numbers of
 * threads without building routines twice. */
void device_limit_threads(struct triptych_device *device, unsigned threads);

/* Renders everything recorded. Cannot fail. */
void device_finish(struct triptych_device *device);
/* The same, but where there are threads it may only have begun when this returns: what is recorded next does not wait. */
void device_start(struct triptych_device *device);
/* Whether draws that are not rendered yet sample the texture. */
bool device_uses(const struct triptych_device *device, const struct triptych_texture *texture);
/* How many commands are recorded that nobody knows to be rendered. */
uint32_t device_commands(const struct triptych_device *device);
/* Nothing that was recorded is wanted any more. */
void device_forget(struct triptych_device *device);

/* Finishes and copies the target, if there is one. */
enum triptych_result device_read_target(struct triptych_device *device, unsigned t, uint32_t *rgba,
                                        struct error *error);
enum triptych_result device_read_target_numbers(struct triptych_device *device, unsigned t, float *numbers,
                                                struct error *error);
enum triptych_result device_read_depth(struct triptych_device *device, float *depth, struct error *error);
enum triptych_result device_read_stencil(struct triptych_device *device, uint8_t *stencil,
                                         struct error *error);

/* Changes a texture, after rendering what is recorded if some of that reads it. Arguments are not null, but
 * for the box. */
enum triptych_result device_texture_create(struct triptych_device *device,
                                           const struct triptych_texture_description *description,
                                           struct triptych_texture **texture, struct error *error);
enum triptych_result device_texture_update(struct triptych_device *device, struct triptych_texture *texture,
                                           unsigned face, unsigned level, const struct triptych_box *box,
                                           const void *data, size_t row_pitch, size_t slice_pitch,
                                           struct error *error);
void device_texture_generate_mips(struct triptych_device *device, struct triptych_texture *texture);

/* device_resource.c; arguments are not null. */
enum triptych_result device_buffer_destroy(struct triptych_device *device, struct triptych_buffer *buffer,
                                           struct error *error);
enum triptych_result device_texture_destroy(struct triptych_device *device, struct triptych_texture *texture,
                                            struct error *error);
enum triptych_result device_query_destroy(struct triptych_device *device, struct triptych_query *query,
                                          struct error *error);

/* Shaders (device_shader.c): from a decoded one, which is validated and may be freed; null sets none. */
enum triptych_result device_shader_create(struct triptych_device *device, const struct shader *shader,
                                          struct triptych_shader **result, struct error *error);
/* Keeps a copy of what the shader was made of. */
enum triptych_result device_shader_keep(struct triptych_shader *shader, const void *source, size_t bytes,
                                        bool is_text, struct error *error);
enum triptych_result device_shader_destroy(struct triptych_device *device, struct triptych_shader *shader,
                                           struct error *error);
void device_free_shaders(struct triptych_device *device);
enum triptych_result device_set_shader(struct triptych_device *device, enum shader_stage stage,
                                       struct triptych_shader *shader, struct error *error);
enum triptych_result device_set_floats(struct triptych_device *device, enum triptych_shader_stage stage,
                                       unsigned first, const float *values, unsigned count,
                                       struct error *error);
enum triptych_result device_set_integers(struct triptych_device *device, enum triptych_shader_stage stage,
                                         unsigned first, const int32_t *values, unsigned count,
                                         struct error *error);
enum triptych_result device_set_booleans(struct triptych_device *device, enum triptych_shader_stage stage,
                                         unsigned first, const int32_t *values, unsigned count,
                                         struct error *error);
/* Whether draws may run with the integer constants as they are. */
enum triptych_result device_check_integers(struct triptych_device *device, struct error *error);

/* One sample's of colour target 0 and of depth and stencil; what is null is not read. */
enum triptych_result device_read_sample(struct triptych_device *device, unsigned sample, uint32_t *rgba,
                                        float *depth, uint8_t *stencil, struct error *error);

/* The first reason why something that was asked for in options.debug is not done; empty when all is. */
void device_debug_error(struct triptych_device *device, struct error *error);

void device_get_statistics(const struct triptych_device *device, struct triptych_statistics *statistics);

/* For tools: who is told of each draw (null: nobody), and what the device works with. */
void device_on_draw(struct triptych_device *device, device_draw_callback *callback, void *user);
const struct engine *device_engine(const struct triptych_device *device);
struct code_arena *device_arena(const struct triptych_device *device);

#endif
