/* The commands of a device that are not rendered yet: draws, clears, changes of the target, and transfers
 * between its tiles and textures, self-contained.
 *
 * A draw is a snapshot: the data that it refers to does not change until it is rendered. Draws between
 * which nothing has changed share their job. */
#ifndef RENDER_DRAW_COMMAND_H
#define RENDER_DRAW_COMMAND_H

#include "contract/engine.h"
#include "render/raster/raster_sample.h"
#include "render/target/target.h"
#include "triptych.h"

/* The routines of a draw: one for each unit; the span reading of the pixel routine (render/tile/span.h), and
 * its reading for joined rectangles (render/geometry/bin_pair.h), which are null if it has none. */
enum { ROUTINE_SPAN = UNIT_COUNT, ROUTINE_JOINED, DRAW_ROUTINES };

/* Records that can be joined to rectangles (render/geometry/bin_pair.h): their words are the same but for the
 * planes of texture coordinates, u then v. */
enum { PAIR_LOOKUPS = 4 };

/* Without padding, because builds that check compare the bytes of draws (device_derived_is_exact). */
struct pair_form {
    uint16_t bytes;   /* of a record, without padding; 0: none can be joined */
    uint8_t depth;    /* the plane of depth follows the head */
    uint8_t smooth;   /* the plane of 1/w is after these */
    uint16_t diffuse; /* offset of the flat diffuse colour; 0: there is none */
    uint16_t lookups;
    struct {
        uint16_t offset; /* of the planes, not descending */
        uint16_t sampler;
    } lookup[PAIR_LOOKUPS]; /* of textures with the coordinates */
};

struct draw {
    const struct job *job;
    const struct routine *routine[DRAW_ROUTINES];
    struct rectangle scissor;
    enum triptych_primitive primitive;
    uint32_t count;      /* parts of primitives (def/state/primitive.def): records before clipping */
    const void *indices; /* the first one; null: vertices in order */
    uint32_t index_bits; /* 8, 16 or 32; 0: vertices in order */
    uint32_t base;       /* added to each index, modulo 2^32 */
    uint32_t stride;     /* bytes of a record */
    struct pair_form pairs;
    enum raster_shape shape;
    struct sampling sampling;
    uint32_t clip_ignored;  /* bits of clip codes that do not count */
    uint32_t point_clipped; /* bits with which a point is not drawn, if they count */
    uint64_t
        wrapped; /* bit s: the values of slot s (enum vertex_slot) at a triangle's second and third corner are
                    moved by whole numbers to within 1/2 of the first's (Direct3D 9's texture wrapping) */
    uint32_t line_extra;             /* pixels across a line beyond the first */
    uint32_t line_width;             /* of smooth lines, in 1/256 pixel */
    uint32_t edges;                  /* the smooth edges of each triangle, in the state's order */
    struct attribute_job edge_masks; /* of vertices; without data, edges are smooth in all triangles */
    uint32_t edge_format;            /* enum attribute_format of the masks */
    bool last_pixel;                 /* lines draw their last */
    bool flat;                       /* of edges and corners: colours are the triangle's first vertex' */
    bool counts_spans;               /* tiles count the blocks that a wider span reading would draw */
    bool counts_joined;              /* and those that the reading for joined rectangles would draw */
    uint8_t span;                    /* enum span: that of the draw's routine, if it has one */
    uint8_t span_narrowest;          /* the narrowest span reading of the key (render/geometry/span.h), */
    uint8_t span_widest;             /* and the widest */
    uint32_t span_extent; /* pixels: triangles of at least this width and height are tested for the class of
                             the span reading (render/geometry/span.h); 0: none are */
    bool last_provokes;   /* flat colours are those of a primitive's last vertex */
};

struct surface_transfer;

struct command {
    enum { COMMAND_DRAW, COMMAND_CLEAR, COMMAND_TARGET, COMMAND_TRANSFER } kind;
    union {
        struct draw draw;
        struct clear clear;
        struct target *target; /* of the commands that follow */
        const struct surface_transfer *transfer;
    };
};

/* Returns true if commands of the kind change pixels of the target, so that a round can have several. */
static inline bool command_draws(const struct command *command)
{
    return command->kind == COMMAND_DRAW || command->kind == COMMAND_CLEAR;
}

#endif
