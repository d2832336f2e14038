/* The job: the values of a draw, for keys that are derived already. */
#include "base/bits.h"
#include "machine/mxcsr.h"
#include "base/srgb.h"
#include "contract/lane.h"
#include "contract/key_query.h"
#include "render/derive/derive_part.h"
#include "render/derive/matrix.h"
#include "shader/program/program.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Clip depth from -w to w becomes 0 to w: z' = z / 2 + w / 2. */
static void fold_depth_range(const struct state *state, struct matrix *projection)
{
    if (state->convention[TRIPTYCH_DEPTH_RANGE] == TRIPTYCH_DEPTH_RANGE_MINUS)
        for (int i = 0; i < 4; i++)
            projection->m[i][2] = projection->m[i][2] / 2 + projection->m[i][3] / 2;
}

/* NaN becomes -most. */
static float bounded(double value, double most)
{
    double high = value > -most ? value : -most;
    return (float)(high < most ? high : most);
}

/* The factors of w that keep x / w * half + centre within +-GUARD_BAND_PIXELS. Their own bound only matters
 * for viewports of a fraction of a pixel, or none; it keeps the products with w from overflowing where w does
 * not. */
static void guard_band(double half, double centre, float *least, float *most)
{
    *least = bounded((-GUARD_BAND_PIXELS - centre) / half, 0x1p20);
    *most = bounded((GUARD_BAND_PIXELS - centre) / half, 0x1p20);
}

static void fill_viewport(const struct state *state, struct job *job)
{
    const struct triptych_viewport *viewport = &state->viewport;
    double half_width = (double)viewport->width / 2, half_height = (double)viewport->height / 2;
    double shift = 0.5 - pixel_centre(state); /* the rasterizer's pixel 0 has its centre at 0.5 */
    double centre_x = (double)viewport->x + half_width + shift;
    double centre_y = (double)viewport->y + half_height + shift;
    double subpixels = 1 << SUBPIXEL_BITS, up = derive_window_up(state);
    guard_band(half_width, centre_x, &job->guard_left, &job->guard_right);
    guard_band(half_height, up * centre_y, &job->guard_bottom, &job->guard_top);
    job->scale_x = bounded(half_width * subpixels, (double)FLT_MAX);
    job->offset_x = bounded(centre_x * subpixels, (double)FLT_MAX);
    job->scale_y = bounded(up * half_height * subpixels, (double)FLT_MAX);
    job->offset_y = bounded(centre_y * subpixels, (double)FLT_MAX);
    job->depth_scale = viewport->depth_far - viewport->depth_near;
    job->depth_offset = viewport->depth_near;
}

/* Vertices in the window: only the grid of 1/256 pixel is left to find, and depth is as it is. */
static void fill_window(const struct state *state, struct job *job)
{
    job->offset_x = job->offset_y = (float)((0.5 - pixel_centre(state)) * (1 << SUBPIXEL_BITS));
    job->guard_left = job->guard_bottom = (float)-GUARD_BAND_PIXELS;
    job->guard_right = job->guard_top = (float)GUARD_BAND_PIXELS;
    job->scale_x = job->scale_y = 1 << SUBPIXEL_BITS;
    job->depth_scale = 1;
}

static void fill_bump(const struct state *state, int stage, struct bump_job *job)
{
    job->matrix[0][0] = STAGE_FLOAT(state, stage, bumpenvmat00);
    job->matrix[0][1] = STAGE_FLOAT(state, stage, bumpenvmat01);
    job->matrix[1][0] = STAGE_FLOAT(state, stage, bumpenvmat10);
    job->matrix[1][1] = STAGE_FLOAT(state, stage, bumpenvmat11);
    job->luminance_scale = STAGE_FLOAT(state, stage, bumpenvlscale);
    job->luminance_offset = STAGE_FLOAT(state, stage, bumpenvloffset);
}

/* The stage whose matrix displaces is the one that ps_1_x writes. */
static void fill_shader_bumps(const struct state *state, const struct program *program, struct job *job)
{
    if (!program || shader_major(program->model) > 1)
        return;
    for (uint32_t i = 0; i < program->steps; i++) {
        const struct shader_instruction *instruction = &program->step[i].instruction;
        int stage = instruction->destination.index;
        if (instruction->opcode == SHADER_TEXBEM || instruction->opcode == SHADER_TEXBEML ||
            instruction->opcode == SHADER_BEM)
            fill_bump(state, stage, &job->bump[stage]);
    }
}

static void fill_stages(const struct state *state, const struct pixel_key *key, struct job *job)
{
    for (int i = 0; i < key->stages; i++) {
        if (key->bump[i])
            fill_bump(state, i - 1, &job->bump[i]);
        if (stage_reads(key, i, SOURCE_CONSTANT))
            job->stage_constant[i] = rgba_word(STAGE(state, i, constant));
        if (stage_reads(key, i, SOURCE_FACTOR))
            job->texture_factor = rgba_word(GET(state, texturefactor));
    }
}

static void fill_fog(const struct state *state, const struct vertex_key *vertex, const struct pixel_key *key,
                     struct job *job)
{
    if (!key->fog)
        return;
    job->fog_color = rgba_word(GET(state, fogcolor));
    uint32_t mode = key->fog != FOG_VARYING ? GET(state, fogtablemode)
                    : key_program(vertex->shader) || vertex->fog == VERTEX_FOG_SPECULAR_ALPHA
                        ? FOGMODE_none
                        : GET(state, fogvertexmode);
    derive_fog_formula(state, mode, key->fog != FOG_VARYING, &job->fog_scale, &job->fog_offset);
}

struct attribute_job derive_element(const struct state *state, const struct state_element *element)
{
    const struct state_stream *stream = state_source(state, element);
    struct attribute_job r = {0};
    if (!stream->buffer)
        return r;
    r.data = stream->buffer->data + stream->offset + element->offset;
    if (stream->frequency != TRIPTYCH_FREQUENCY_INSTANCE)
        r.stride = (int32_t)stream->stride;
    return r;
}

static void fill_attributes(const struct state *state, const struct vertex_key *key, struct job *job)
{
    for (unsigned i = key_next(key->attribute, 0, ATTRIBUTE_COUNT); i < ATTRIBUTE_COUNT;
         i = key_next(key->attribute, i + 1, ATTRIBUTE_COUNT))
        job->attribute[i] = derive_element(state, state->element + i);
    for (unsigned i = key_next(key->input, 0, INPUTS); i < INPUTS; i = key_next(key->input, i + 1, INPUTS))
        job->input[i] = derive_element(state, derive_input(state, key, i));
}

/* Where the projection's near and far plane have w: z' = z m33 + m43 and w = z m34 + m44 of camera space's z
 * give z' = 0 and z' = w there. A w-buffer's depth runs from 0 to 1 between them, then over the viewport's
 * range; where a projection has no such planes, depth is w. */
static void fill_w_range(const struct state *state, struct job *job)
{
    struct matrix m = matrix_of((const float(*)[4])state->transform[TRIPTYCH_TRANSFORM_PROJECTION]);
    fold_depth_range(state, &m);
    const struct triptych_viewport *v = &state->viewport;
    double low = (double)v->depth_near, range = (double)v->depth_far - low;
    double near = m.m[3][3] - m.m[3][2] / m.m[2][2] * m.m[2][3];
    double far = (m.m[3][3] - m.m[3][2]) / (m.m[2][2] - m.m[2][3]) * m.m[2][3] + m.m[3][3];
    double scale = isfinite(near) && isfinite(far) && near != far ? range / (far - near) : range;
    double offset = isfinite(near) && isfinite(far) && near != far ? low - near * scale : low;
    job->w_scale = derive_narrow(scale);
    job->w_offset = derive_narrow(offset);
}

static void fill_depth(const struct state *state, const struct pixel_key *key, struct job *job)
{
    uint32_t bits = stencil_mask(state->depth_format);
    if (key->depth_format == DEPTH_UNORM)
        job->depth_maximum = depth_maximum(state->depth_format);
    if (key->depth_w)
        fill_w_range(state, job);
    if (!key->stencil)
        return;
    job->stencil_maximum = (int32_t)bits;
    job->stencil_reference = (int32_t)(GET(state, stencilref) & bits);
    job->stencil_mask = (int32_t)(GET(state, stencilmask) & bits);
    job->stencil_write_mask = (int32_t)(GET(state, stencilwritemask) & bits);
}

static void fill_entry(const struct state *state, unsigned world, const struct matrix *view,
                       struct palette_entry *entry)
{
    unsigned which = world ? TRIPTYCH_TRANSFORM_WORLD1 + world - 1 : TRIPTYCH_TRANSFORM_WORLD;
    struct matrix matrix = matrix_of((const float(*)[4])state->transform[which]);
    struct matrix world_view = matrix_multiply(&matrix, view);
    matrix_store(&world_view, entry->world_view);
    matrix_store_normal(&world_view, entry->normal);
}

static void fill_blend(const struct state *state, const struct vertex_key *key, const struct matrix *view,
                       const struct matrix *projection, struct job *job)
{
    matrix_store(projection, job->projection);
    for (unsigned i = 0; i < key->matrices && !key->indexed_matrices; i++)
        fill_entry(state, i, view, &job->blend[i]);
}

/* Channels have the matrices of the stages that read them. */
static void fill_texture_matrices(const struct state *state, const struct vertex_key *vertex,
                                  const struct pixel_key *pixel, struct job *job)
{
    for (int channel = 0; channel < TEXTURE_STAGES; channel++)
        if (vertex->texture_matrix[channel]) {
            int stage = derive_channel_set(state, pixel, channel);
            memcpy(job->texture_matrix[channel], state->transform[TRIPTYCH_TRANSFORM_TEXTURE0 + stage],
                   sizeof job->texture_matrix[channel]);
        }
}

__attribute__((noinline)) static void fill_palette(const struct state *state, struct palette_entry *palette)
{
    struct matrix view = matrix_of((const float(*)[4])state->transform[TRIPTYCH_TRANSFORM_VIEW]);
    for (unsigned i = 0; i < WORLD_MATRICES; i++)
        fill_entry(state, i, &view, &palette[i]);
}

void derive_palette(const struct state *state, struct palette_entry palette[WORLD_MATRICES])
{
    unsigned saved = mxcsr_enter();
    memset(palette, 0, WORLD_MATRICES * sizeof *palette);
    fill_palette(state, palette);
    mxcsr_leave(saved);
}

/* Where user clip planes are with a vertex shader: the space of its positions. */
static struct matrix shader_clip_space(const struct state *state)
{
    struct matrix r = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    fold_depth_range(state, &r);
    return r;
}

static bool is_constant(int factor)
{
    return factor >= FACTOR_CONSTANT && factor <= FACTOR_INVERSE_CONSTANT_ALPHA;
}

static bool blends_by_constant(const struct pixel_key *key)
{
    bool r = false;
    for (int c = 0; c < BLEND_CHANNELS; c++)
        r |= is_constant(key->source_factor[c]) || is_constant(key->target_factor[c]);
    return r;
}

/* --- The parts --- */

/* The sources of a derivation. */
struct given {
    const struct state *state;
    const struct vertex_key *vertex;
    const struct pixel_key *pixel;
};

static struct matrix transform(const struct given *s, unsigned which)
{
    return matrix_of((const float(*)[4])s->state->transform[which]);
}

static struct matrix projection_of(const struct given *s)
{
    struct matrix r = transform(s, TRIPTYCH_TRANSFORM_PROJECTION);
    fold_depth_range(s->state, &r);
    return r;
}

static void fill_PALETTE(const struct given *s, struct job *job)
{
    (void)s, (void)job; /* the caller's */
}

static void fill_VIEWPORT(const struct given *s, struct job *job)
{
    if (s->vertex->attribute[ATTRIBUTE_POSITIONT] != ATTRIBUTE_FORMAT_NONE)
        fill_window(s->state, job);
    else
        fill_viewport(s->state, job);
}

static void fill_DEPTH(const struct given *s, struct job *job)
{
    fill_depth(s->state, s->pixel, job);
}

static void fill_CCW_STENCIL(const struct given *s, struct job *job)
{
    const struct state *state = s->state;
    uint32_t bits = stencil_mask(state->depth_format);
    if (s->pixel->stencil_values == STENCIL_VALUES_FIRST)
        return;
    job->ccw_stencil_reference = (int32_t)(GET(state, ccw_stencilref) & bits);
    job->ccw_stencil_mask = (int32_t)(GET(state, ccw_stencilmask) & bits);
    job->ccw_stencil_write_mask = (int32_t)(GET(state, ccw_stencilwritemask) & bits);
}

static void fill_FOG(const struct given *s, struct job *job)
{
    fill_fog(s->state, s->vertex, s->pixel, job);
}

static void fill_REFERENCES(const struct given *s, struct job *job)
{
    const struct state *state = s->state;
    if (s->pixel->alpha_discard)
        job->alpha_reference = (int32_t)GET(state, alpharef);
    if (blends_by_constant(s->pixel))
        job->blend_constant = rgba_word(GET(state, blendfactor));
    if (s->vertex->tween)
        job->tween_factor = GET_FLOAT(state, tweenfactor);
}

static void fill_SETUP(const struct given *s, struct job *job)
{
    derive_setup_job(s->state, s->vertex, job);
}

/* Vertex shaders read their constants instead. */
static void fill_TRANSFORM(const struct given *s, struct job *job)
{
    if (key_program(s->vertex->shader))
        return;
    struct matrix world = transform(s, TRIPTYCH_TRANSFORM_WORLD),
                  view = transform(s, TRIPTYCH_TRANSFORM_VIEW);
    struct matrix projection = projection_of(s), world_view = matrix_multiply(&world, &view);
    struct matrix world_view_projection = matrix_multiply(&world_view, &projection);
    matrix_store(&world_view_projection, job->world_view_projection);
    matrix_store(&world_view, job->world_view);
    if (s->vertex->attribute[ATTRIBUTE_NORMAL] || s->vertex->attribute[ATTRIBUTE_NORMAL1])
        matrix_store_normal(&world_view, job->normal);
}

static void fill_ATTRIBUTES(const struct given *s, struct job *job)
{
    fill_attributes(s->state, s->vertex, job);
}

static void fill_STAGES(const struct given *s, struct job *job)
{
    fill_stages(s->state, s->pixel, job);
    fill_shader_bumps(s->state, program_find(key_program(s->pixel->shader)), job);
}

static void fill_TEXTURES(const struct given *s, struct job *job)
{
    derive_texture_job(s->state, s->vertex, s->pixel, job);
}

static void fill_LIGHTS(const struct given *s, struct job *job)
{
    if (!s->vertex->lighting)
        return;
    struct matrix view = transform(s, TRIPTYCH_TRANSFORM_VIEW);
    derive_lights(s->state, s->vertex, &view, job);
}

static void fill_TEXTURE_MATRICES(const struct given *s, struct job *job)
{
    fill_texture_matrices(s->state, s->vertex, s->pixel, job);
}

static void fill_BLEND(const struct given *s, struct job *job)
{
    if (!s->vertex->matrices)
        return;
    struct matrix view = transform(s, TRIPTYCH_TRANSFORM_VIEW), projection = projection_of(s);
    fill_blend(s->state, s->vertex, &view, &projection, job);
}

static void fill_CLIP_PLANES(const struct given *s, struct job *job)
{
    if (!s->vertex->clip_planes)
        return;
    struct matrix planes = shader_clip_space(s->state);
    if (!key_program(s->vertex->shader)) {
        struct matrix view = transform(s, TRIPTYCH_TRANSFORM_VIEW), projection = projection_of(s);
        planes = matrix_multiply(&view, &projection);
    }
    derive_clip_planes(s->state, s->vertex, (const double(*)[4])planes.m, job);
}

enum {
    READS_VERTEX = 1 << UNIT_VERTEX,
    READS_PIXEL = 1 << UNIT_PIXEL,
    READS_BOTH = READS_VERTEX | READS_PIXEL
};

/* Where each part is, the units whose keys it is derived from, and what fills it in when it is zero. */
static const struct {
    uint16_t begin, end;
    uint8_t units;
    void (*fill)(const struct given *, struct job *);
} job_part[JOB_PARTS] = {
#define JOB_PART(name, keys, first, last, meaning)                                                           \
    {offsetof(struct job, first), offsetof(struct job, last) + sizeof((struct job *)0)->last, READS_##keys,  \
     fill_##name},
#include "def/job_part.def"
#undef JOB_PART
};

/* Not inlined: the compiler may move arithmetic over a change of MXCSR, but not a call. */
__attribute__((noinline)) static void fill_parts(const struct given *given, unsigned parts, struct job *job)
{
    for (; parts; parts &= parts - 1) {
        int part = __builtin_ctz(parts);
        memset((char *)job + job_part[part].begin, 0, (size_t)(job_part[part].end - job_part[part].begin));
        job_part[part].fill(given, job);
    }
}

unsigned derive_parts_of_key(enum unit unit)
{
    static const unsigned others[UNIT_COUNT] = {[UNIT_VERTEX] = PARTS(VERTICES), [UNIT_SETUP] = PARTS(AREA)};
    unsigned parts = others[unit];
    for (unsigned part = 0; part < JOB_PARTS; part++)
        if (job_part[part].units >> unit & 1)
            parts |= 1u << part;
    return parts;
}

void derive_job_parts(const struct state *state, const struct vertex_key *vertex,
                      const struct pixel_key *pixel, unsigned parts, struct job *job)
{
    const struct given given = {state, vertex, pixel};
    unsigned saved = mxcsr_enter();
    fill_parts(&given, parts & PARTS_OF_JOB, job);
    mxcsr_leave(saved);
}

void derive_job(const struct state *state, const struct vertex_key *vertex, const struct pixel_key *pixel,
                struct job *job)
{
    memset(job, 0, sizeof *job);
    derive_job_parts(state, vertex, pixel, PARTS_OF_JOB, job);
    job->srgb = &srgb_tables;
}
