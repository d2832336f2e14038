/* The setup key, and the other states that apply between vertices and pixels: fill modes, culling, depth
 * bias, clipping.
 *
 * Fill modes apply only to triangles. So do culling and depth bias (Direct3D 9, Depth Bias): they are
 * removed from the keys of lines and points, but not from the keys of a triangle's edges and corners. */
#include "base/minmax.h"
#include "base/bits.h"
#include "render/derive/derive_part.h"
#include "render/state/primitive.h"
#include "contract/key_query.h"
#include "shader/program/program.h"

#include <math.h>

enum primitive derive_primitive(const struct state *state, enum triptych_primitive primitive)
{
    if (state_primitives[primitive].kind != PRIMITIVE_TRIANGLE)
        return state_primitives[primitive].kind;
    switch ((enum triptych_fill)GET(state, fillmode)) {
    case TRIPTYCH_FILL_POINT: return PRIMITIVE_CORNER;
    case TRIPTYCH_FILL_WIREFRAME: return PRIMITIVE_EDGE;
    case TRIPTYCH_FILL_SOLID: return PRIMITIVE_TRIANGLE;
    }
    derive_impossible("fill mode", GET(state, fillmode));
}

enum raster_shape derive_shape(const struct setup_key *key)
{
    static const uint8_t shape[PRIMITIVE_COUNT][2] = {
        [PRIMITIVE_TRIANGLE] = {SHAPE_TRIANGLE, SHAPE_SMOOTH_TRIANGLE},
        [PRIMITIVE_LINE] = {SHAPE_LINE, SHAPE_SMOOTH_LINE},
        [PRIMITIVE_EDGE] = {SHAPE_LINE, SHAPE_SMOOTH_LINE},
        [PRIMITIVE_POINT] = {SHAPE_POINT, SHAPE_SMOOTH_POINT},
        [PRIMITIVE_CORNER] = {SHAPE_POINT, SHAPE_SMOOTH_POINT}};
    return shape[key->primitive][key->smooth];
}

uint32_t derive_edges(const struct state *state)
{
    return GET(state, edgeantialias);
}

const struct state_element *derive_edge_masks(const struct state *state)
{
    const struct state_element *element = &state->element[ATTRIBUTE_TEXCOORD7];
    bool reads = derive_edges(state) && GET(state, edgemaskenable) && !state->samples;
    return reads && element->format ? element : NULL;
}

bool derive_smooth(const struct state *state, enum primitive primitive)
{
    if (state->samples)
        return false;
    switch (primitive) {
    case PRIMITIVE_LINE:
    case PRIMITIVE_EDGE: return GET(state, antialiasedlineenable);
    case PRIMITIVE_POINT:
    case PRIMITIVE_CORNER: return GET(state, antialiasedpointenable) && !GET(state, pointspriteenable);
    default: return derive_edges(state) != 0;
    }
}

/* The limits of points themselves; corners of triangles are in the viewport. */
static enum triptych_point_clip point_clip(const struct state *state, enum primitive primitive)
{
    return primitive == PRIMITIVE_POINT ? (enum triptych_point_clip)state->convention[TRIPTYCH_POINT_CLIP]
                                        : TRIPTYCH_POINT_CLIP_VIEWPORT;
}

/* The end of a side of the box, which can be beyond every target. */
static int32_t end_of(uint32_t first, uint32_t size)
{
    uint64_t end = (uint64_t)first + size;
    return end < TARGET_SIZE_MAXIMUM ? (int32_t)end : TARGET_SIZE_MAXIMUM;
}

/* The pixels of the rectangle that are in the mask's box and have a texel. */
static struct rectangle masked(const struct triptych_clip_mask *mask, struct rectangle r)
{
    const struct texture_level *level = mask->texture->level;
    r.x1 = min_i32(r.x1, min_i32(end_of(mask->box.x, mask->box.width), mask->x + level->width));
    r.y1 = min_i32(r.y1, min_i32(end_of(mask->box.y, mask->box.height), mask->y + level->height));
    r.x0 = max_i32(r.x0, max_i32(end_of(mask->box.x, 0), mask->x));
    r.y0 = max_i32(r.y0, max_i32(end_of(mask->box.y, 0), mask->y));
    r.x1 = max_i32(r.x0, r.x1);
    r.y1 = max_i32(r.y0, r.y1);
    return r;
}

struct rectangle derive_pixels(const struct state *state, enum primitive primitive)
{
    struct rectangle r = derive_area(state, point_clip(state, primitive) != TRIPTYCH_POINT_CLIP_VIEWPORT);
    return derive_has_clip_mask(state) ? masked(&state->clip_mask, r) : r;
}

uint32_t derive_point_clipped(const struct state *state, enum primitive primitive)
{
    bool sides = GET(state, clipping) && point_clip(state, primitive) == TRIPTYCH_POINT_CLIP_CENTER;
    return CLIP_NEEDED | CLIP_INVALID | (sides ? CLIP_FRUSTUM : 0);
}

/* Without clipping, depth is limited by the pixel routine, and the sides by the scissor rectangle as ever. */
uint32_t derive_clip_ignored(const struct state *state)
{
    return GET(state, clipping) ? 0 : CLIP_DEPTH | CLIP_USER_ALL;
}

bool derive_last_pixel(const struct state *state)
{
    return GET(state, lastpixel) != 0;
}

uint32_t derive_line_extra(const struct state *state)
{
    float width = GET_FLOAT(state, linewidth);
    if (width < 1.5f)
        return 0;
    return width < LINE_WIDTH_MAXIMUM ? (uint32_t)(width + 0.5f) - 1 : LINE_WIDTH_MAXIMUM - 1;
}

uint32_t derive_line_width(const struct state *state, enum primitive primitive)
{
    float width = primitive == PRIMITIVE_LINE ? fminf(GET_FLOAT(state, linewidth), LINE_WIDTH_MAXIMUM) : 1;
    return (uint32_t)(width * (1 << SUBPIXEL_BITS) + 0.5f);
}

/* Phong shading is Gouraud shading in Direct3D 9. */
bool derive_flat(const struct state *state)
{
    switch ((enum triptych_shade)GET(state, shademode)) {
    case TRIPTYCH_SHADE_FLAT: return true;
    case TRIPTYCH_SHADE_GOURAUD:
    case TRIPTYCH_SHADE_PHONG: return false;
    }
    derive_impossible("shade mode", GET(state, shademode));
}

bool derive_last_provokes(const struct state *state)
{
    return (derive_flat(state) || derive_blends_by_primitive(state)) &&
           state->convention[TRIPTYCH_PROVOKING_VERTEX] == TRIPTYCH_PROVOKING_VERTEX_LAST;
}

static bool bias_in_steps(const struct state *state)
{
    return state->convention[TRIPTYCH_DEPTH_BIAS_UNIT] == TRIPTYCH_DEPTH_BIAS_UNIT_SMALLEST;
}

static enum depth_bias constant_bias(const struct state *state)
{
    enum depth_storage storage = depth_formats[state->depth_format].storage;
    if (!bias_in_steps(state) || GET_FLOAT(state, depthbias) == 0)
        return DEPTH_BIAS_CONSTANT;
    return storage == DEPTH_FLOAT     ? DEPTH_BIAS_FLOAT
           : storage == DEPTH_FLOAT24 ? DEPTH_BIAS_FLOAT24
                                      : DEPTH_BIAS_CONSTANT;
}

static uint8_t derive_depth_bias(const struct state *state)
{
    if (GET_FLOAT(state, slopescaledepthbias) != 0)
        return (uint8_t)(constant_bias(state) + DEPTH_BIAS_SLOPE - DEPTH_BIAS_CONSTANT);
    return GET_FLOAT(state, depthbias) != 0 ? (uint8_t)constant_bias(state) : DEPTH_BIAS_NONE;
}

/* The state depthbias as a depth, or as a part of numbers from 1 to 2 where the routine has the power of
 * two. An integer of 32 bits is computed from binary32, whose steps below 1 are 2^-24. */
static float bias_value(const struct state *state)
{
    double bias = (double)GET_FLOAT(state, depthbias);
    uint32_t bits = depth_formats[state->depth_format].depth_bits;
    if (!bias_in_steps(state) || !bits)
        return (float)bias;
    switch (depth_formats[state->depth_format].storage) {
    case DEPTH_FLOAT: return derive_narrow(bias * 0x1p-23);
    case DEPTH_FLOAT24: return derive_narrow(bias * 0x1p-20);
    case DEPTH_UNORM: return derive_narrow(bias / ((double)(UINT64_C(1) << bits) - 1));
    case DEPTH_UNORM32:
    case DEPTH_STORAGE_COUNT: break;
    }
    return derive_narrow(bias * 0x1p-24);
}

static bool smooth_varyings(const struct pixel_key *key)
{
    for (int v = 0; v < VARYING_COUNT; v++)
        if (key->varying[v] == INTERPOLATION_SMOOTH)
            return true;
    return false;
}

enum point_size derive_point_size(const struct state *state, enum primitive primitive)
{
    bool window = state->element[ATTRIBUTE_POSITIONT].format != TRIPTYCH_FORMAT_NONE;
    const struct program *program = derive_vertex_program(state);
    if (!primitive_is_point(primitive))
        return POINT_SIZE_CONSTANT;
    if (program) /* it does what pointscaleenable does by itself */
        return derive_shader_gives(program, USAGE_PSIZE) ? POINT_SIZE_VERTEX : POINT_SIZE_CONSTANT;
    if (GET(state, pointscaleenable) && !window)
        return POINT_SIZE_SCALED;
    return state->element[ATTRIBUTE_POINT_SIZE].format ? POINT_SIZE_VERTEX : POINT_SIZE_CONSTANT;
}

static bool reads_face(const struct state *state, const struct pixel_key *pixel)
{
    return key_program(pixel->shader) && derive_pixel_program(state)->interface.face;
}

static bool smooth_texcoords(const struct pixel_key *key)
{
    for (int v = 0; v < VARYING_COUNT; v++)
        if (varying_is_texcoord(v) && key->varying[v] == INTERPOLATION_SMOOTH)
            return true;
    return false;
}

void derive_setup(const struct state *state, enum primitive primitive, const struct pixel_key *pixel,
                  struct setup_key *key)
{
    key->primitive = (uint8_t)primitive;
    key->window = state->element[ATTRIBUTE_POSITIONT].format != TRIPTYCH_FORMAT_NONE;
    key->smooth = derive_smooth(state, primitive);
    key->depth = (uint8_t)pixel_reads_depth(pixel);
    key->w = pixel_reads_w(pixel) && (primitive_is_point(primitive) || !smooth_varyings(pixel));
    memcpy(key->varying, pixel->varying, sizeof key->varying);
    key->point_size = derive_point_size(state, primitive) != POINT_SIZE_CONSTANT;
    bool turned = state->convention[TRIPTYCH_SPRITE_ORIGIN] == TRIPTYCH_SPRITE_ORIGIN_LAST ||
                  derive_window_up(state) > 0;
    key->sprite_turned = turned && primitive_is_point(primitive) && smooth_texcoords(pixel);
    if (!primitive_has_area(primitive))
        return;
    key->cull = derive_cull(GET(state, cullmode));
    key->facing = pixel->stencil == STENCIL_TWO || reads_face(state, pixel);
    if (key->depth)
        key->depth_bias = derive_depth_bias(state);
}

/* --- The job's part --- */

/* Minor of row i and column j. */
static double minor(const double m[4][4], int i, int j)
{
    double s[3][3];
    for (int r = 0, a = 0; r < 4; r++) {
        if (r == i)
            continue;
        for (int c = 0, b = 0; c < 4; c++)
            if (c != j)
                s[a][b++] = m[r][c];
        a++;
    }
    return s[0][0] * (s[1][1] * s[2][2] - s[1][2] * s[2][1]) -
           s[0][1] * (s[1][0] * s[2][2] - s[1][2] * s[2][0]) +
           s[0][2] * (s[1][0] * s[2][1] - s[1][1] * s[2][0]);
}

static double cofactor(const double m[4][4], int i, int j)
{
    return (i + j) & 1 ? -minor(m, i, j) : minor(m, i, j);
}

/* A plane of world space in clip space. With v' = v * M a point is inside where v . p >= 0, that is where
 * v' . (M^-1 p) is: the plane times the inverse, as a column. The length of a plane means nothing: it is made
 * such that no coefficient exceeds 1. Without an inverse the plane is zero, and everything inside. */
static void transform_plane(const float plane[4], const double m[4][4], float result[4])
{
    double determinant = 0, most = 0, p[4] = {0};
    for (int j = 0; j < 4; j++)
        determinant += m[0][j] * cofactor(m, 0, j);
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++)
            p[i] += cofactor(m, j, i) * (double)plane[j];
        p[i] = determinant < 0 ? -p[i] : p[i];
        most = fmax(most, fabs(p[i]));
    }
    bool usable = determinant != 0 && isfinite(determinant) && most > 0 && isfinite(most);
    for (int i = 0; i < 4; i++)
        result[i] = usable ? (float)(p[i] / most) : 0;
}

/* Direct3D 9, Point Sprites: the maximum is looked at first, and the device has one of its own. */
static float point_size(const struct state *state)
{
    float most = fminf(GET_FLOAT(state, pointsize_max), POINT_SIZE_MAXIMUM),
          size = GET_FLOAT(state, pointsize);
    if (size > most)
        return most;
    return size < GET_FLOAT(state, pointsize_min) ? fminf(GET_FLOAT(state, pointsize_min), POINT_SIZE_MAXIMUM)
                                                  : size;
}

static float point_limit(uint32_t bits)
{
    return fminf(bits_to_float(bits), POINT_SIZE_MAXIMUM);
}

static void fill_point_limits(const struct state *state, struct job *job)
{
    job->point_least = point_limit(GET(state, pointsize_min));
    job->point_most = point_limit(GET(state, pointsize_max));
}

static void fill_point_scale(const struct state *state, struct job *job)
{
    job->point_scale[0] = GET_FLOAT(state, pointscale_a);
    job->point_scale[1] = GET_FLOAT(state, pointscale_b);
    job->point_scale[2] = GET_FLOAT(state, pointscale_c);
    job->viewport_height = state->viewport.height;
}

void derive_setup_job(const struct state *state, const struct vertex_key *vertex, struct job *job)
{
    job->depth_bias = bias_value(state);
    job->depth_bias_slope = GET_FLOAT(state, slopescaledepthbias);
    job->point_size = vertex->point_size  ? GET_FLOAT(state, pointsize)
                      : vertex->size_link ? 0
                                          : point_size(state);
    if (vertex->point_size || vertex->size_link)
        fill_point_limits(state, job);
    if (vertex->point_size)
        fill_point_scale(state, job);
}

void derive_clip_planes(const struct state *state, const struct vertex_key *vertex,
                        const double view_projection[4][4], struct job *job)
{
    for (int i = 0, n = 0; n < vertex->clip_planes; i++)
        if (GET(state, clipplaneenable) >> i & 1)
            transform_plane(state->clip_plane[i], view_projection, job->clip_plane[n++]);
}
