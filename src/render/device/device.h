/* The device: the state, what the application made, the routine cache, and the queue that collects and
 * renders.
 *
 * The functions are those of triptych.h without its checks of null pointers; each gives its result and the
 * reason, and changes nothing when it fails. The engine is the caller's choice (engines/list.h). Functions
 * that the parts of the device share are in device_part.h. */
#ifndef RENDER_DEVICE_DEVICE_H
#define RENDER_DEVICE_DEVICE_H

#include "memory/extent.h"
#include "render/blit/blit.h"
#include "render/cache/cache.h"
#include "render/derive/change.h"
#include "render/draw/constant.h"
#include "render/device/derived.h"
#include "render/device/routines.h"
#include "render/queue/queue.h"
#include "render/draw/query.h"
#include "render/draw/transient.h"
#include "render/device/shuffle.h"
#include "render/state/state.h"
#include "render/target/surface.h"
#include "shader/shader.h"

#include <errno.h>

/* Called for each draw that is recorded: its number, from 0, and its keys, indexed by enum unit. */
typedef void device_draw_callback(void *user, uint64_t number, const union key key[UNIT_COUNT]);

struct triptych_shader {
    struct triptych_device *device;
    struct triptych_shader *next; /* of the device's */
    const struct program *program;
    void *source; /* what it was made of, for recordings */
    size_t source_bytes;
    bool source_is_text;
    uint32_t recorded; /* its number while calls are recorded */
};

/* The target. While surfaces are drawn to, `main` is the target that was set before. */
struct device_binding {
    struct target *target, *main;             /* never null */
    struct target none;                       /* of width 0 */
    struct triptych_target_surfaces surfaces; /* valid while draws_to_surfaces is set */
    bool draws_to_surfaces;
    unsigned textured; /* the parts of the target (enum target_part) that are surfaces of textures */
    bool stale;        /* some of these may have newer texels than tiles */
    uint32_t newer;    /* surfaces of textures, of this target or not, whose tiles are newer than texels */
};

/* Parts of a target: bit t is colour t. */
enum target_part { TARGET_DEPTH = 1 << TARGETS };

/* Objects that the commands of a buffer refer to, to be released when these are rendered. */
struct released {
    struct released *next;
    struct target *target; /* or null */
    struct surface_transfer transfer;
};

/* Objects that the application has created and not destroyed: lists, linked by `next`. */
struct device_resources {
    struct triptych_buffer *buffers;
    struct triptych_texture *textures;
    struct triptych_image *images;
    struct triptych_shader *shaders;
    struct extents retired; /* that only queued draws use */
    struct extents spare;   /* for storage of the same size */
    uint32_t mapped;        /* buffers */
    bool tiled;             /* texels of textures are in tiles (the setting `texels`) */
    bool quad_rows;         /* words of targets are in rows of quads (the setting `target`) */
};

/* The resources of the draws that are rendered in the background. */
struct device_background {
    struct held *held;
    uint32_t held_count;
    struct palette *palettes;
    struct extents retired; /* that only these draws use */
    struct released *released;
    uint32_t commands; /* 0: nothing is rendered in the background */
};

/* Draw calls, and the triangles in them. */
struct device_counts {
    uint64_t draws, triangles;
    uint64_t vertices; /* in the ranges of their numbers that draws read */
};

/* The receiver of events (triptych_log_function). */
struct device_log {
    triptych_log_function *function; /* null: none */
    void *user;
};

struct device_hook {
    device_draw_callback *on_draw; /* null: none */
    void *user;
};

struct device_errors {
    struct error last;  /* of the last public call that failed */
    struct error debug; /* why something of options.debug cannot be done */
    struct error told;  /* the last answer of triptych_debug_error */
};

struct triptych_device {
    /* Execution. */
    const struct engine *engine;
    struct code_arena *arena; /* null when the engine generates no code */
    struct cache *cache;
    struct blits blits; /* of the cache */
    struct pool *pool;
    struct queue *queue;
    uint64_t epoch; /* increases when the queue is emptied */
    struct device_background rendered;

    struct device_binding binding;
    struct released *released; /* by the buffer that is filled */

    /* State and objects of the application. */
    struct state state;
    struct shader_registers registers[SHADER_STAGES]; /* the state's */
    struct triptych_shader *shader[SHADER_STAGES];    /* those that are set */
    struct device_resources resources;
    struct queries queries;

    /* The parts that draws are built from. */
    struct device_derived derived;
    struct constants constants; /* of queued draws */
    struct transient transient; /* the same */
    bool integers_checked;      /* state_check_integers has passed since shaders and integers have changed */
    struct device_routines routines;
    enum setting_spans spans; /* the value of the setting */

    struct device_counts counts;
    struct recorder *recorder; /* of calls (capture/record.h), or null */
    struct device_hook hook;
    struct device_log log;
    struct device_errors errors;
    char key_text[KEY_TEXT_CAPACITY]; /* of the last routine reported */
};

/* The current target; its width is 0 when there is none. */
static inline struct target *device_target(struct triptych_device *device)
{
    return device->binding.target;
}

/* The target of the commands that are rendered, for observers of routines (struct engine). */
static inline struct target *device_rendered_target(struct triptych_device *device)
{
    struct target *open = device->queue->worker[0].tile.target; /* observers have one thread */
    return open ? open : device->queue->round.target;
}

/* The target that was set, even while surfaces are drawn to. */
static inline struct target *device_main_target(struct triptych_device *device)
{
    return device->binding.main;
}

/* The surfaces that are drawn to; null: none. */
static inline const struct triptych_target_surfaces *
device_drawn_surfaces(const struct triptych_device *device)
{
    return device->binding.draws_to_surfaces ? &device->binding.surfaces : NULL;
}

/* For a recording of a running device: the state, the constants and the shader of a stage (or null),
 * and the first of the objects that exist, which are linked by `next`. */
static inline const struct state *device_state(const struct triptych_device *device)
{
    return &device->state;
}

static inline const struct shader_registers *device_registers(const struct triptych_device *device,
                                                              enum triptych_shader_stage stage)
{
    return &device->registers[stage];
}

static inline struct triptych_shader *device_shader(const struct triptych_device *device,
                                                    enum triptych_shader_stage stage)
{
    return device->shader[stage];
}

static inline const struct device_resources *device_resources(const struct triptych_device *device)
{
    return &device->resources;
}

static inline struct triptych_query *device_queries(const struct triptych_device *device)
{
    return device->queries.first;
}

/* The recorder of the device's calls (capture/record.h), or null. */
static inline struct recorder *device_recorder(const struct triptych_device *device)
{
    return device->recorder;
}

static inline void device_set_recorder(struct triptych_device *device, struct recorder *recorder)
{
    device->recorder = recorder;
}

/* Reports an event to the application's log function, if there is one. */
static inline void device_report(const struct triptych_device *device, enum triptych_log_level level,
                                 const char *text)
{
    if (device->log.function)
        device->log.function(device->log.user, level, text);
}

/* Returns true if the application has a log function. */
static inline bool device_has_log(const struct triptych_device *device)
{
    return device->log.function != NULL;
}

struct device_options {
    unsigned threads;     /* 0: one for each processor */
    size_t cache_bytes;   /* 0: CACHE_BYTES */
    size_t code_bytes;    /* of the code arena; 0: enough for the cache and the largest routines */
    bool measure;         /* the calls of routines are timed */
    const char *debug;    /* words of def/debug.def, comma-separated; null: none */
    const char *settings; /* a list of setting/setting.h; null: the defaults */
    pool_create_thread *create_thread; /* null: pthread_create */
    uint32_t arena_bytes;              /* of the arena of the queue; 0: ARENA_BYTES */
};

/* The result of a failed function before which errno was 0: out of memory, or `otherwise`. */
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
/* Fails if the description is not valid. */
enum triptych_result device_check_target(const struct triptych_target_description *description,
                                         struct error *error);

/* Drawing to surfaces (render/device/surfaces.c); null goes back. */
enum triptych_result device_set_target_surfaces(struct triptych_device *device,
                                                const struct triptych_target_surfaces *surfaces,
                                                struct error *error);
bool device_draws_to(const struct triptych_device *device, const struct triptych_texture *texture);
bool device_draws_to_image(const struct triptych_device *device, const struct triptych_image *image);

enum triptych_result device_image_create(struct triptych_device *device,
                                         const struct triptych_image_description *description,
                                         struct triptych_image **image, struct error *error);
enum triptych_result device_image_destroy(struct triptych_device *device, struct triptych_image *image,
                                          struct error *error);

/* Renders what is recorded and brings the tiles of the target up to date. */
void device_finish_target(struct triptych_device *device);

/* The tiles of an image, of a surface of a texture that has tiles, or, without both, of colour `slice` of
 * the main target: a target of one colour, or of depth. The caller finishes before it reads or changes
 * pixels, and destroys the view. */
enum triptych_result device_view(struct triptych_device *device, const struct triptych_surface *surface,
                                 struct target *view, struct error *error);

enum triptych_result device_copy(struct triptych_device *device, const struct surface_copy *copy,
                                 struct error *error);
/* Rectangles of pixels in memory, rows `pitch` bytes apart: backwards if it is negative; `found` receives
 * what was written. */
enum triptych_result device_read_rectangle(struct triptych_device *device,
                                           const struct triptych_surface *surface,
                                           const struct triptych_rectangle *rectangle,
                                           enum triptych_surface_format format, void *data, ptrdiff_t pitch,
                                           struct error *error);
enum triptych_result device_write_rectangle(struct triptych_device *device,
                                            const struct triptych_surface *surface,
                                            const struct triptych_rectangle *rectangle,
                                            enum triptych_surface_format format, const void *data,
                                            size_t pitch, struct surface_memory *found, struct error *error);
enum triptych_result device_fill(struct triptych_device *device, const struct triptych_surface *surface,
                                 const struct triptych_rectangle *rectangle, const float color[4],
                                 struct error *error);
enum triptych_result device_read_surface(struct triptych_device *device,
                                         const struct triptych_surface *surface, uint32_t *rgba, size_t bytes,
                                         struct error *error);
enum triptych_result device_read_surface_numbers(struct triptych_device *device,
                                                 const struct triptych_surface *surface, float *numbers,
                                                 size_t bytes, struct error *error);

/* The contents of the target and of a texture, as they are stored (render/device/contents.c). */
size_t device_contents_bytes(const struct triptych_device *device);
enum triptych_result device_read_contents(struct triptych_device *device, void *data, size_t bytes,
                                          struct error *error);
enum triptych_result device_write_contents(struct triptych_device *device, const void *data, size_t bytes,
                                           struct error *error);
void device_read_texels(struct triptych_device *device, struct triptych_texture *texture, void *data);
enum triptych_result device_write_texels(struct triptych_device *device, struct triptych_texture *texture,
                                         const void *data, size_t bytes, struct error *error);

/* Direct access to the state is for changes; they must be followed by this, with the parts that may have
 * changed (render/derive/change.h). */
static inline void device_state_changed(struct triptych_device *device, unsigned parts)
{
    device->derived.changed |= parts;
}

/* Reports hits to the cache that it has not counted yet. */
void device_count_hits(struct triptych_device *device);

/* Vertices or indices that `count` primitives take; count is not 0. */
uint64_t device_corners(enum triptych_primitive primitive, uint32_t count);
/* Triangles, lines or points of one primitive. */
uint32_t device_parts(enum triptych_primitive primitive);

/* Records `count` primitives: from vertex `first` on, or with the bound indices from `first` on, plus base.
 */
enum triptych_result device_draw(struct triptych_device *device, enum triptych_primitive primitive,
                                 uint32_t first, uint32_t count, struct error *error);
enum triptych_result device_draw_indexed(struct triptych_device *device, enum triptych_primitive primitive,
                                         int32_t base, uint32_t first, uint32_t count, struct error *error);

/* The same with vertices and indices in memory of the caller (render/device/draw_user.c). Indices are null,
 * or there is one for each corner. */
struct user_draw {
    enum triptych_primitive primitive;
    uint32_t count;
    const void *indices;
    unsigned index_bits;   /* with indices */
    uint32_t vertex_count; /* with indices */
    const void *vertices;
    size_t stride;
};
enum triptych_result device_draw_user(struct triptych_device *device, const struct user_draw *draw,
                                      struct error *error);

/* Runs the vertex routine (render/device/process.c). */
enum triptych_result device_process_vertices(struct triptych_device *device, uint32_t first, uint32_t count,
                                             struct triptych_processed_vertex *out, struct error *error);

/* Records a clear of rectangles, or with count 0 of everything. */
enum triptych_result device_clear(struct triptych_device *device, const struct triptych_clear_values *values,
                                  const struct triptych_rectangle *rectangles, unsigned count,
                                  struct error *error);

enum triptych_result device_query_begin(struct triptych_device *device, struct triptych_query *query,
                                        struct error *error);
enum triptych_result device_query_end(struct triptych_device *device, struct triptych_query *query,
                                      struct error *error);
/* Flushes. *ready is 1, and *result valid, if the query's end is rendered. */
enum triptych_result device_query_poll(struct triptych_device *device, struct triptych_query *query,
                                       int *ready, uint64_t *result, struct error *error);
enum triptych_result device_query_result(struct triptych_device *device, struct triptych_query *query,
                                         uint64_t *result, struct error *error);

/* From now on rendering uses at most `threads` of the device's threads; 0: all. Tools compare numbers of
 * threads with it, without building routines again. */
void device_limit_threads(struct triptych_device *device, unsigned threads);

/* From now on the device has these settings. Tools compare settings with it, like numbers of threads. */
void device_set_settings(struct triptych_device *device, const struct setting_values *settings);

/* Renders everything recorded. Cannot fail. */
void device_finish(struct triptych_device *device);
/* The same, but where there are threads it may only have begun when this returns: what is recorded next
 * does not wait. */
void device_start(struct triptych_device *device);
/* The same if nothing is being rendered. Waits only if there are no threads. */
void device_flush(struct triptych_device *device);
/* The number of queued commands that are not known to be rendered. */
uint32_t device_commands(const struct triptych_device *device);

/* Finishes and copies the target, if there is one, to an array of `bytes` bytes. */
enum triptych_result device_read_target(struct triptych_device *device, unsigned t, uint32_t *rgba,
                                        size_t bytes, struct error *error);
enum triptych_result device_read_target_numbers(struct triptych_device *device, unsigned t, float *numbers,
                                                size_t bytes, struct error *error);
enum triptych_result device_read_depth(struct triptych_device *device, float *depth, size_t bytes,
                                       struct error *error);
enum triptych_result device_read_stencil(struct triptych_device *device, uint8_t *stencil, size_t bytes,
                                         struct error *error);
/* Fails if an array of the caller for `what` has fewer bytes than needed. */
enum triptych_result device_check_room(const char *what, size_t bytes, size_t needed, struct error *error);

/* Changes a texture, after rendering what is recorded if some of that reads it. Arguments are not null, but
 * for the box. */
enum triptych_result device_texture_create(struct triptych_device *device,
                                           const struct triptych_texture_description *description,
                                           struct triptych_texture **texture, struct error *error);
enum triptych_result device_texture_update(struct triptych_device *device, struct triptych_texture *texture,
                                           unsigned face, unsigned level, const struct triptych_box *box,
                                           const void *data, size_t row_pitch, size_t slice_pitch,
                                           struct error *error);
enum triptych_result device_texture_read(struct triptych_device *device, struct triptych_texture *texture,
                                         unsigned face, unsigned level, const struct triptych_box *box,
                                         void *data, size_t row_pitch, size_t slice_pitch,
                                         struct error *error);
enum triptych_result device_texture_generate_mips(struct triptych_device *device,
                                                  struct triptych_texture *texture, struct error *error);

/* Return true if the object is one of the device's. */
bool device_has_buffer(struct triptych_device *device, const struct triptych_buffer *buffer);
bool device_has_texture(struct triptych_device *device, const struct triptych_texture *texture);
bool device_has_image(struct triptych_device *device, const struct triptych_image *image);
bool device_has_query(struct triptych_device *device, const struct triptych_query *query);
bool device_has_shader(struct triptych_device *device, const struct triptych_shader *shader);

/* Buffers (render/device/buffer.c). A buffer is created with zeros if `data` is null. */
enum triptych_result device_buffer_create(struct triptych_device *device, const void *data, size_t bytes,
                                          struct triptych_buffer **buffer, struct error *error);
enum triptych_result device_buffer_update(struct triptych_device *device, struct triptych_buffer *buffer,
                                          size_t offset, const void *data, size_t bytes, struct error *error);
enum triptych_result device_buffer_map(struct triptych_device *device, struct triptych_buffer *buffer,
                                       size_t offset, size_t bytes, enum triptych_map mode, void **data,
                                       struct error *error);
enum triptych_result device_buffer_unmap(struct triptych_device *device, struct triptych_buffer *buffer,
                                         struct error *error);

/* render/device/destroy.c; arguments are not null. */
enum triptych_result device_buffer_destroy(struct triptych_device *device, struct triptych_buffer *buffer,
                                           struct error *error);
enum triptych_result device_texture_destroy(struct triptych_device *device, struct triptych_texture *texture,
                                            struct error *error);
enum triptych_result device_query_destroy(struct triptych_device *device, struct triptych_query *query,
                                          struct error *error);

/* Shaders (render/device/shader.c): from a decoded one, which is validated and may be freed; null sets
 * none. */
enum triptych_result device_shader_create(struct triptych_device *device, const struct shader *shader,
                                          struct triptych_shader **result, struct error *error);
/* Keeps a copy of what the shader was made of. */
enum triptych_result device_shader_keep(struct triptych_shader *shader, const void *source, size_t bytes,
                                        bool is_text, struct error *error);
enum triptych_result device_shader_destroy(struct triptych_device *device, struct triptych_shader *shader,
                                           struct error *error);
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

/* Arrays for one sample of each pixel, and their bytes. */
struct sample_images {
    uint32_t *color;
    size_t color_bytes;
    float *depth;
    size_t depth_bytes;
    uint8_t *stencil;
    size_t stencil_bytes;
};

/* One sample's of colour target 0 and of depth and stencil; what is null is not read. */
enum triptych_result device_read_sample(struct triptych_device *device, unsigned sample,
                                        const struct sample_images *images, struct error *error);

/* The first reason why an option of options.debug has no effect; empty when all have. */
void device_debug_error(struct triptych_device *device, struct error *error);

void device_get_statistics(const struct triptych_device *device, struct triptych_statistics *statistics);

/* For tools: a function that is called for each draw; null: none. */
void device_on_draw(struct triptych_device *device, device_draw_callback *callback, void *user);
const struct engine *device_engine(const struct triptych_device *device);

#endif
