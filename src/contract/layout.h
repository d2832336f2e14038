/* The memory layouts that routines share with the renderer.
 *
 * All three kinds of routine are loops around a kernel of W lanes. Layouts are the same for every W and every
 * engine, so engines can be exchanged between any two calls.
 *
 * Vertex batch (structure of arrays): slot s of vertex i is the word s * VERTEX_CAPACITY + i. Slots are the
 * clip-space position x y z w, the clip code, then the varyings' components in the order of
 * def/state/varying.def.
 *
 * Triangle record (array of structures): struct triangle_head; of a smooth primitive a struct
 * smooth_triangle, smooth_line or smooth_point; one `struct plane` for depth if it is read; one for 1/w if
 * any varying is smooth or w itself is read; then for each component of each varying that is read a plane if
 * it is smooth, one word if it is flat. The offsets follow from the key: setup uses layout_of_setup(), pixel
 * layout_of_pixel().
 *
 * Tile: TILE_SIZE x TILE_SIZE pixels as 4x4 blocks in row order, 16 words each in quad order: lane l of a
 * block is pixel x = (l & 1) + 2 * (l >> 2 & 1), y = (l >> 1 & 1) + 2 * (l >> 3 & 1).
 *
 *      0  1 |  4  5
 *      2  3 |  6  7
 *     ------+------
 *      8  9 | 12 13
 *     10 11 | 14 15 */
#ifndef CONTRACT_LAYOUT_H
#define CONTRACT_LAYOUT_H

#include "contract/key_query.h"

#include <stdalign.h>

enum {
    LANES_MAXIMUM = 16,    /* element counts are padded to a multiple of W, or of this if W is more */
    VERTEX_CAPACITY = 256, /* lanes of a vertex batch, with room for the clipper */
    VERTEX_SLOT_BYTES = VERTEX_CAPACITY * 4,
    SETUP_CAPACITY = 256, /* triangles of one setup call */
    SETUP_INDEX_BYTES = SETUP_CAPACITY * 4,
    SETUP_INDEX_ROWS = 5,
    TILE_SIZE = 64,
    TILE_PIXELS = TILE_SIZE * TILE_SIZE,
    BLOCK_SIZE = 4,
    BLOCK_PIXELS = 16,
    TILE_BLOCKS = TILE_PIXELS / BLOCK_PIXELS,
    TILE_PLANE_BYTES = TILE_PIXELS * 4,
    BLIT_ROW_WORDS = TILE_SIZE * BLOCK_SIZE, /* of a row of a tile's blocks */
    BLIT_BLEND_PIXELS = TILE_SIZE,           /* of a call */
    SUBPIXEL_BITS = 8,
    TARGET_SIZE_MAXIMUM = 8192,
    POINT_SIZE_MAXIMUM = 8192 /* pixels: half of it from beyond the guard band reaches no target */
};

enum vertex_slot {
    SLOT_X,
    SLOT_Y,
    SLOT_Z,
    SLOT_W,
    SLOT_CODE,
#define VARYING(name, components, text) SLOT_##name, SLOT_##name##_last = SLOT_##name + (components)-1,
#include "def/state/varying.def"
#undef VARYING
    SLOT_POINT_SIZE, /* pixels; used if points have sizes of their own */
    SLOT_COUNT
};

/* Bits of the clip code, set when the vertex is outside. A triangle is dropped when all three share a
 * CLIP_FRUSTUM bit or any has CLIP_INVALID; it needs the clipper when any has a CLIP_NEEDED bit. */
enum clip_bit {
    CLIP_LEFT = 1,         /* x < -w */
    CLIP_RIGHT = 2,        /* x > w */
    CLIP_BOTTOM = 4,       /* y < -w */
    CLIP_TOP = 8,          /* y > w */
    CLIP_NEAR = 16,        /* z < 0 */
    CLIP_FAR = 32,         /* z > w */
    CLIP_EYE = 64,         /* w < CLIP_EYE_W */
    CLIP_GUARD_LEFT = 128, /* x < guard_left * w */
    CLIP_GUARD_RIGHT = 256,
    CLIP_GUARD_BOTTOM = 512,
    CLIP_GUARD_TOP = 1024,
    CLIP_INVALID = 2048, /* a coordinate is infinite or not a number */
    CLIP_USER = 4096,    /* outside of user clip plane 0; the others' bits follow */
    CLIP_USER_ALL = ((1 << CLIP_PLANES_USER) - 1) * CLIP_USER,
    CLIP_DEPTH = CLIP_NEAR | CLIP_FAR,
    CLIP_GUARD = CLIP_GUARD_LEFT | CLIP_GUARD_RIGHT | CLIP_GUARD_BOTTOM | CLIP_GUARD_TOP,
    CLIP_FRUSTUM = 127 | CLIP_USER_ALL,
    CLIP_NEEDED = CLIP_DEPTH | CLIP_EYE | CLIP_GUARD | CLIP_USER_ALL
};

#define CLIP_EYE_W 0x1p-40f /* vertices nearer to the eye plane are clipped: 1/w stays finite */

/* Window positions are clamped to this many 1/256 pixels either way. It is beyond the guard band, and edge
 * functions stay within 32 bits. */
#define WINDOW_LIMIT 4194303.0f

/* The rasterizer's part of a record, written by setup. Window positions are in 1/256 pixel, y down.
 *
 * Triangles are ordered so that the area is positive (clockwise on the screen): interior points have three
 * positive edge functions. Lines: start and end in 0 and 1; x[2] is the number of pixels across beyond the
 * first, with its bits inverted if the last pixel is drawn; of smooth lines the width in 1/256 pixel. Points:
 * left and top in 0, right and bottom in 1. Other words are undefined; if `visible` is 0, all other words
 * are. */
struct triangle_head {
    int32_t
        visible; /* 0: culled or without area; else -1, or 1 with the key's `facing` if counterclockwise */
    int32_t x[3];
    int32_t y[3];
    float origin_x; /* window position of vertex 0 (points: the centre) in pixels: where the planes have their
                       value */
    float origin_y;
};

/* The head's `visible` if the record is a rectangle (render/geometry/bin_pair.h). Its corners 0 and 1 are
 * the lowest and the highest position. */
enum { HEAD_RECTANGLE = 2 };

/* value + (x - origin_x) * dx + (y - origin_y) * dy */
struct plane {
    float value;
    float dx;
    float dy;
};

/* The part after the head of a smooth primitive's record (spec/setup/setup_smooth.h).
 *
 * An edge of a triangle: value + (x - origin_x) * dx + (y - origin_y) * dy is the distance of a pixel's
 * centre from the edge's line along the window's axis that is nearer to its normal, in pixels, positive
 * inside. `slope` is the tangent between the normal and that axis, 0 to 1; the square is cut up to the
 * distance `reach`. */
struct smooth_edge {
    float value, dx, dy;
    float slope, reach;
    float bend; /* 1 / (2 slope) */
};

/* The factors of a product and of a minimum, from which follows what is outside of two edges. */
struct smooth_overlap {
    float product, least;
};

struct smooth_triangle {
    int32_t edges;                    /* bit i: from vertex i to the next, in the head's order */
    struct smooth_edge edge[3];       /* without its bit: no square is cut */
    struct smooth_overlap overlap[3]; /* of edges 0 and 1, 1 and 2, 2 and 0 */
};

/* A line is a rectangle: its direction is x, y, and the longer component is 1 or -1. In units of the length
 * along that axis: half of the width, and the length. */
struct smooth_line {
    float x, y;
    float half, length;
    float slope, reach, bend; /* of all four sides */
};

struct smooth_point {
    float radius; /* pixels */
    float square; /* of it */
};

enum { RECORD_COVERAGE = sizeof(struct triangle_head) };

struct triangle_layout {
    uint16_t coverage;               /* enum coverage_form: which structure is at RECORD_COVERAGE, if any */
    uint16_t depth;                  /* byte offset of depth's plane */
    uint16_t reciprocal_w;           /* byte offset of 1/w's plane */
    uint16_t varying[VARYING_COUNT]; /* byte offset of each varying's first component */
    uint16_t smooth;                 /* 1/w is present: a varying is smooth, or w itself is read */
    uint16_t stride;                 /* bytes of a record, a multiple of 64 */
};

/* One 4x4 block of one triangle for the pixel routine: 16 bytes. */
struct entry {
    float x, y;        /* window position of the block's upper left corner in pixels */
    uint16_t coverage; /* bit l: lane l is inside; never 0 */
    uint16_t block;    /* block number in the tile, 0 to 255 */
    uint32_t triangle; /* byte offset of the record from pixel_arguments.triangles */
};

/* With several samples per pixel, an entry's coverage is that of any sample. The coverage of each sample is
 * SAMPLE_COVERAGE bytes after the entry: entries are in the first of two arrays of PIXEL_ENTRIES. */
enum { PIXEL_ENTRIES = 1024, SAMPLE_COVERAGE = PIXEL_ENTRIES * 16 };

struct sample_coverage {
    uint16_t sample[SAMPLES_MAXIMUM];
};

struct entry_list {
    struct entry entry[PIXEL_ENTRIES];
    struct sample_coverage coverage[PIXEL_ENTRIES];
    uint32_t reserved; /* coverage is read by the word */
};

_Static_assert(offsetof(struct entry_list, coverage) == SAMPLE_COVERAGE &&
                   sizeof(struct entry) == sizeof(struct sample_coverage),
               "an entry's samples are at a constant distance");

/* The position of sample i of 2^n in 1/16 pixel from the centre, y down: the standard patterns of Direct3D
 * 10.1. */
struct sample_position {
    int8_t x, y;
};

extern const struct sample_position layout_samples[SAMPLES_RADIX][SAMPLES_MAXIMUM];

/* Per-lane constants of the pixel routine, and its counters, for 16 lanes in quad order; a chunk of W lanes
 * starts at c * W. */
struct lane_table {
    float x[LANES_MAXIMUM]; /* pixel centre from the block's corner */
    float y[LANES_MAXIMUM];
    int32_t bit[LANES_MAXIMUM];    /* 1 << lane */
    int32_t dither[LANES_MAXIMUM]; /* the pixel's threshold in both halves: spec/pixel/target.h */
    int32_t passed[LANES_MAXIMUM]; /* passed pixels, if the key counts them */
};

extern const struct lane_table lane_table;

/* The record layout of a setup key or a pixel key. Both keys of a draw give the same, but for the coverage if
 * the pixel routine reads no more than the head. */
struct triangle_layout layout_of_setup(const struct setup_key *key);
struct triangle_layout layout_of_pixel(const struct pixel_key *key);

/* The layout of a unit's key; of vertices an empty one. */
struct triangle_layout layout_of_unit(enum unit unit, const union key *key);

#endif
