/* The maker: the state that the writers of a case share, and what has been written. */
#ifndef COMMAND_FUZZ_CASE_CASE_PART_H
#define COMMAND_FUZZ_CASE_CASE_PART_H

#include "command/fuzz/case/random.h"
#include "command/fuzz/case/text.h"
#include "triptych.h"

enum { CASE_TEXTURES = 6, CASE_IMAGES = 5, ANY_TEXTURE = TRIPTYCH_TEXTURE_TYPE_COUNT };

struct fuzz_shader;

struct case_texture {
    enum triptych_texture_type type;
    unsigned size; /* of a side */
    bool target;   /* can be drawn to */
    bool depth;    /* has depth, not colours */
    bool mips;
    unsigned update_words; /* of the buffer that can replace a face's first level; 0: there is none */
};

struct case_image {
    unsigned width, height, samples;
    bool depth, stencil; /* it is not a colour; it has stencil */
};

struct maker {
    struct random random;
    struct text *text;
    unsigned width, height;            /* of the target */
    bool has_depth, has_stencil;       /* what is drawn to */
    bool target_depth, target_stencil; /* the target that is drawn to while nothing is attached */
    unsigned targets, samples;
    bool wild;   /* vertices and matrices hold anything */
    bool window; /* vertices are in pixels of the target */
    unsigned vertices, indices, index_bits;
    unsigned bytes;  /* of a vertex of v0 */
    unsigned stride; /* the same if v0 is stream 0; otherwise 0 */
    bool instanced;  /* which only draws with indices can be */
    struct case_texture texture[CASE_TEXTURES];
    unsigned textures;
    struct case_image image[CASE_IMAGES];
    unsigned images;
    bool attached;     /* the target is one of surfaces */
    uint64_t elements; /* of vertices that a shader needs: enum stream_element, a bit each */
    const struct fuzz_shader *shader[TRIPTYCH_SHADER_STAGE_COUNT]; /* null: the fixed function */
    unsigned stages;                                               /* texture stages in use */
    uint32_t samplers;                                             /* in use, a bit each */
    unsigned sampler_type[TRIPTYCH_SAMPLERS]; /* the type that a shader needs, or ANY_TEXTURE */
};

/* The parts, in the order in which a case has them; names are made of the maker's counts. */
void case_target(struct maker *);
void case_shaders(struct maker *, struct fuzz_shader *made); /* one per stage */
void case_textures(struct maker *);
void case_images(struct maker *);
void case_vertices(struct maker *);
void case_transforms(struct maker *);
void case_lights(struct maker *);
void case_window(struct maker *);
void case_features(struct maker *);
void case_states(struct maker *, unsigned changes);
void case_constants(struct maker *);
void case_samplers(struct maker *);
void case_stages(struct maker *);

/* Changes between draws. case_attach returns true if draws go to a texture from here on. */
bool case_attach(struct maker *);
/* Draws go to other surfaces from here on, or to the target again; to the target. */
void case_switch_target(struct maker *);
void case_detach(struct maker *);
/* The clear of a target with these. */
void case_clear(struct maker *, bool depth, bool stencil);
void case_copy(struct maker *);
void case_fill(struct maker *);
void case_write_pixels(struct maker *);
void case_change(struct maker *);
void case_change_buffer(struct maker *);
void case_switch_shaders(struct maker *);

/* The names of a depth format, and of a random format that can be a target. */
const char *case_depth_format(unsigned format);
const char *case_target_format(struct maker *);

/* Forms of values: " 0.25", four of them, " 0xAARRGGBB". */
void case_number(struct maker *, float least, float most);
void case_numbers(struct maker *, unsigned count, float least, float most);
void case_color(struct maker *);

#endif
