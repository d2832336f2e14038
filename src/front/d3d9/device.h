/* A Direct3D device: what its methods share. */
#ifndef D3D9_DEVICE_H
#define D3D9_DEVICE_H

#include "object.h"
#include "presentation.h"
#include "state.h"
#include "front/common/statistics.h"
#include "triptych.h"
#include "types.h"

struct d3d9_factory;
struct d3d9_state_block;
struct d3d9_surface;

/* Groups of values that are passed on to the renderer before the next draw (draw/prepare.c). */
enum {
    D3D9_LATE_TARGETS = 1,
    D3D9_LATE_AREA = 2, /* viewport, scissor rectangle */
    D3D9_LATE_TEXTURES = 4,
    D3D9_LATE_STREAMS = 8, /* and indices */
    D3D9_LATE_DECLARATION = 16,
    D3D9_LATE_SHADERS = 32,
    D3D9_LATE_LIGHTS = 64,
    D3D9_LATE_ALL = 127
};

/* D3DCREATE_... of the creation parameters. */
enum {
    D3D9_CREATE_PURE_DEVICE = 0x10,
    D3D9_CREATE_SOFTWARE_VERTICES = 0x20,
    D3D9_CREATE_HARDWARE_VERTICES = 0x40,
    D3D9_CREATE_MIXED_VERTICES = 0x80
};

struct d3d9_palette {
    uint32_t number;
    struct d3d9_palette_entry entry[256];
    struct d3d9_palette *next;
};

struct d3d9_device {
    struct d3d9_object object; /* its parent is the factory */
    bool extended;             /* IDirect3DDevice9Ex */
    struct d3d9_creation_parameters creation;
    triptych_device *renderer;

    struct d3d9_presentation presentation;
    struct front_statistics statistics;

    /* Values that the program sets (state/). */
    struct d3d9_state *state;
    unsigned vertex_floats; /* of `state` */
    struct d3d9_lights lights;
    struct d3d9_state_block *recording;    /* null: none */
    unsigned late;                         /* D3D9_LATE_... */
    struct d3d9_declaration *declarations; /* made for vertex format codes: a list of held objects */
    struct d3d9_palette *palettes;
    uint32_t palette; /* the current one */
    struct d3d9_clip_status clip_status;
    bool software_vertices;
    bool dialog_box;
    int32_t gpu_priority;
    uint32_t frame_latency; /* frames; 0: not set */

    /* Targets (draw/target.c). Held. */
    struct d3d9_surface *target[TRIPTYCH_TARGETS];
    struct d3d9_surface *depth;

    /* Draws (draw/). */
    bool in_scene;
    uint32_t sampled;                /* samplers with a texture, bit i sampler i */
    uint32_t first_level;            /* of these: those whose texture has a first level (SetLOD) */
    uint32_t lod[TRIPTYCH_SAMPLERS]; /* the first level that the renderer has */
    struct d3d9_shader *refused; /* of software vertex processing, for which a draw has failed; not held */
    unsigned passed;             /* D3D9_NEEDS_... of the streams that were passed on (draw/draw.h) */
    bool instances;              /* a stream's frequency is not that of vertices */
    triptych_buffer *zeros;      /* what streams without a buffer read; null until it is needed */
};

/* Make the values of a device whose `renderer`, `creation` and `object` are set, and set the renderer's
 * conventions; free them. Reset gives all values their defaults, and sets no target. `depth`: the device has
 * a depth surface of its own, so the depth test is on. */
int32_t d3d9_device_make_state(struct d3d9_device *, bool depth);
void d3d9_device_reset_state(struct d3d9_device *, bool depth);
void d3d9_device_free_state(struct d3d9_device *);

/* Notes in `object.draws` whether draws with valid arguments succeed. Called after each change of
 * the declaration, the vertex shader or the vertex processing. */
void d3d9_device_note_draws(struct d3d9_device *);

/* Make a surface the target or the depth surface, without checks and without a reference of the program;
 * target 0 sets the viewport and the scissor rectangle. */
void d3d9_device_bind_target(struct d3d9_device *, unsigned index, struct d3d9_surface *);
void d3d9_device_bind_depth(struct d3d9_device *, struct d3d9_surface *);

#endif
