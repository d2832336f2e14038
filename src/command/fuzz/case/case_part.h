/* The maker: the state that the writers of a case share, and what has been written. */
#ifndef COMMAND_FUZZ_CASE_CASE_PART_H
#define COMMAND_FUZZ_CASE_CASE_PART_H

#include "command/fuzz/case/wild.h"
#include "command/fuzz/case/text.h"
#include "triptych.h"

enum { CASE_TEXTURES = 6, CASE_IMAGES = 5, CASE_ELEMENTS = 24, ANY_TEXTURE = TRIPTYCH_TEXTURE_TYPE_COUNT };

struct fuzz_shader;

struct case_texture {
    enum triptych_texture_type type;
    unsigned size;   /* of a side */
    unsigned slices; /* of a volume; faces of a cube */
    unsigned levels;
    bool target; /* can be drawn to */
    bool depth;  /* has depth, not colours */
    bool mips;
    unsigned update_words; /* of the buffer that can replace a face's first level; 0: there is none */
    bool whole;            /* a buffer can replace all texels */
};

struct case_image {
    unsigned width, height, samples;
    bool depth, stencil;   /* it is not a colour; it has stencil */
    unsigned depth_format; /* enum triptych_depth_format */
};

/* An element of vertices. */
struct case_element {
    unsigned number; /* enum stream_element */
    enum triptych_format format;
};

struct maker {
    struct random random;
    struct text *text;
    struct triptych_target_description target;
    unsigned width, height;            /* of the target */
    bool has_depth, has_stencil;       /* what is drawn to */
    bool target_depth, target_stencil; /* the target that is drawn to while nothing is attached */
    unsigned targets, samples;
    bool wild;   /* vertices and matrices hold anything */
    bool window; /* vertices are in pixels of the target */
    bool coded;  /* vertices have the elements of a vertex format code */
    bool huge;   /* the matrices of the world or of the view hold anything: products may overflow */
    unsigned vertices, indices, index_bits;
    unsigned bytes;  /* of a vertex of v0 */
    unsigned stride; /* the same if v0 is stream 0; otherwise 0 */
    bool instanced;  /* which only draws with indices can be */
    bool contents;   /* a buffer can replace the contents of the target */
    bool mesh;       /* there is a mesh m0 */
    struct case_texture texture[CASE_TEXTURES];
    unsigned textures;
    struct case_image image[CASE_IMAGES];
    unsigned images;
    bool attached;     /* the target is one of surfaces */
    uint64_t elements; /* of vertices that must be there: enum stream_element, a bit each */
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

/* A draw of textured rectangles, with its resources and states. It replaces the vertices. */
void case_rectangles(struct maker *);

/* Vertices and their binding. The elements of part[1] follow those of part[0]; they are v1, the first are
 * v0. case_bind_skip returns the number of vertices before those that are drawn. */
unsigned case_coded_elements(struct maker *, struct case_element elements[CASE_ELEMENTS]);
unsigned case_stride(const struct maker *, const struct case_element *, unsigned count);
void case_add_elements(struct maker *, const struct case_element *, unsigned count);
unsigned case_bind_skip(struct maker *, const unsigned part[2]);
void case_bind(struct maker *, const struct case_element *, const unsigned part[2], unsigned skip);

/* A texture that can be drawn to; -1: there is none. */
int case_find_target(struct maker *);
/* Writes a random level and slice of a texture; returns the size of its sides. */
unsigned case_level(struct maker *, int texture);

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
void case_lights_off(struct maker *);

/* The names of a depth format, and of a random format that can be a target. */
const char *case_depth_format(unsigned format);
const char *case_target_format(struct maker *);

/* Forms of values: " 0.25", four of them, " 0xAARRGGBB". */
void case_number(struct maker *, float least, float most);
void case_numbers(struct maker *, unsigned count, float least, float most);
void case_color(struct maker *);

/* " { number... }" and the end of the line: words of any bits. */
void case_words(struct maker *, size_t count);

#endif
