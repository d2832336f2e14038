/* The job: the values of a draw, for keys that are derived already. */
#include "base/mxcsr.h"
#include "base/srgb.h"
#include "def/lane.h"
#include "draw/derive_part.h"

#include <math.h>
#include <string.h>

/* Products are summed in double precision, first row first, and rounded once when stored in the job. */
struct matrix {
    double m[4][4];
};

static struct matrix matrix_of(const float source[4][4])
{
    struct matrix r;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            r.m[i][j] = (double)source[i][j];
    return r;
}

static struct matrix multiply(const struct matrix *a, const struct matrix *b)
{
    struct matrix r;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            r.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j] +
                        a->m[i][3] * b->m[3][j];
    return r;
}

float derive_narrow(double value)
{
    return (float)fmax(-(double)__FLT_MAX__, fmin(value, (double)__FLT_MAX__));
}

static void store_matrix(const struct matrix *source, float target[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            target[i][j] = derive_narrow(source->m[i][j]);
}

/* Clip depth from -w to w becomes 0 to w: z' = z / 2 + w / 2. */
static void fold_depth_range(const struct state *state, struct matrix *projection)
{
    if (state->convention[TRIPTYCH_DEPTH_RANGE] == TRIPTYCH_DEPTH_RANGE_MINUS)
        for (int i = 0; i < 4; i++)
            projection->m[i][2] = projection->m[i][2] / 2 + projection->m[i][3] / 2;
}

static double cofactor(const struct matrix *m, int row, int column)
{
    int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
    return m->m[r1][c1] * m->m[r2][c2] - m->m[r1][c2] * m->m[r2][c1];
}

/* Inverse transpose of the upper left 3x3: cofactors over the determinant; the cofactors alone, which have
 * the right directions as far as there are any, when there is no inverse. */
static void store_normal_matrix(const struct matrix *world_view, float target[3][4])
{
    double determinant = 0;
    for (int c = 0; c < 3; c++)
        determinant += world_view->m[0][c] * cofactor(world_view, 0, c);
    double scale = determinant != 0 ? 1 / determinant : 1;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            target[i][j] = derive_narrow(cofactor(world_view, i, j) * scale);
}

/* A point (w = 1) or a direction (w = 0) times the matrix. */
static void transform(const float source[3], double w, const struct matrix *matrix, double target[3])
{
    for (int c = 0; c < 3; c++)
        target[c] = (double)source[0] * matrix->m[0][c] + (double)source[1] * matrix->m[1][c] +
                    (double)source[2] * matrix->m[2][c] + w * matrix->m[3][c];
}

static void fill_direction(const struct triptych_light *light, const struct matrix *view,
                           struct light_job *job)
{
    double d[3];
    transform(light->direction, 0, view, d);
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int c = 0; c < 3; c++)
        job->position[c] = length > 0 ? (float)(-d[c] / length) : 0;
}

static void fill_point(const struct triptych_light *light, const struct triptych_material *material,
                       const struct matrix *view, struct light_job *job)
{
    double p[3];
    transform(light->position, 1, view, p);
    for (int c = 0; c < 3; c++) {
        job->position[c] = derive_narrow(p[c]);
        job->ambient[c] = derive_narrow((double)light->ambient[c] * (double)material->ambient[c]);
    }
    job->range = light->range;
    job->attenuation0 = light->attenuation[0];
    job->attenuation1 = light->attenuation[1];
    job->attenuation2 = light->attenuation[2];
}

/* The lights, packed to the front like the key's, and the base colour with the directional ones' ambient
 * part. */
static void fill_lighting(const struct state *state, const struct matrix *view, struct job *job)
{
    const struct triptych_material *material = &state->material;
    double ambient[3];
    for (int c = 0; c < 3; c++)
        ambient[c] = (GET(ambient) >> (16 - 8 * c) & 255) / 255.0;
    struct light_job *to = job->light;
    for (int i = 0; i < LIGHT_COUNT; i++) {
        const struct triptych_light *light = state->light + i;
        if (!state->light_enabled[i])
            continue;
        for (int c = 0; c < 3; c++)
            to->diffuse[c] = derive_narrow((double)light->diffuse[c] * (double)material->diffuse[c]);
        if (light->type == TRIPTYCH_LIGHT_POINT)
            fill_point(light, material, view, to);
        else
            fill_direction(light, view, to);
        for (int c = 0; c < 3 && light->type == TRIPTYCH_LIGHT_DIRECTIONAL; c++)
            ambient[c] += (double)light->ambient[c];
        to++;
    }
    for (int c = 0; c < 3; c++)
        job->base_color[c] =
            derive_narrow((double)material->emissive[c] + (double)material->ambient[c] * ambient[c]);
    job->base_color[3] = material->diffuse[3];
}

/* |x| <= guard * w keeps |x / w * half + centre| <= GUARD_BAND_PIXELS. The bound on guard only matters for
 * viewports of a fraction of a pixel; it keeps guard * w from overflowing where w does not. */
static float guard_band(double half, double centre)
{
    return (float)fmin((GUARD_BAND_PIXELS - centre) / half, 0x1p20);
}

static void fill_viewport(const struct state *state, struct job *job)
{
    const struct triptych_viewport *viewport = &state->viewport;
    double half_width = (double)viewport->width / 2, half_height = (double)viewport->height / 2;
    double shift = 0.5 - pixel_centre(state); /* the rasterizer's pixel 0 has its centre at 0.5 */
    double centre_x = (double)viewport->x + half_width + shift;
    double centre_y = (double)viewport->y + half_height + shift;
    double subpixels = 1 << SUBPIXEL_BITS;
    job->guard_x = guard_band(half_width, centre_x);
    job->guard_y = guard_band(half_height, centre_y);
    job->scale_x = (float)(half_width * subpixels);
    job->offset_x = (float)(centre_x * subpixels);
    job->scale_y = (float)(-half_height * subpixels);
    job->offset_y = (float)(centre_y * subpixels);
    job->depth_scale = viewport->depth_far - viewport->depth_near;
    job->depth_offset = viewport->depth_near;
}

/* Vertices in the window: only the grid of 1/256 pixel is left to find, and depth is as it is. */
static void fill_window(const struct state *state, struct job *job)
{
    job->offset_x = job->offset_y = (float)((0.5 - pixel_centre(state)) * (1 << SUBPIXEL_BITS));
    job->guard_x = job->guard_y = (float)GUARD_BAND_PIXELS;
    job->scale_x = job->scale_y = 1 << SUBPIXEL_BITS;
    job->depth_scale = 1;
}

/* 0xAARRGGBB with red and blue exchanged. */
static uint32_t rgba_word(uint32_t color)
{
    return (color & 0xff00ff00) | (color >> 16 & 255) | (color & 255) << 16;
}

/* Positions are measured in 1/256 texels of the level whose size is in the job: 8 levels more than texels of
 * it, and that level's number more than those of the first. */
static void fill_detail(const struct state *state, const struct pixel_key *key, int stage,
                        struct texture_job *job)
{
    const struct triptych_texture *texture = state->texture[stage];
    uint32_t first = derive_first_level(state, stage);
    float bias = lane_from_bits(SAMPLER(stage, mipmaplodbias));
    bias = fminf(fmaxf(bias, -LOD_BIAS_MAXIMUM), LOD_BIAS_MAXIMUM);
    job->lod_offset = 256 * bias - 256 * 8 + (key->mip[stage] ? 0 : 256 * (float)first);
    if (!key->mip[stage])
        return;
    job->levels = texture->level;
    job->first_level_256 = 256 * (int32_t)first;
    job->last_level_256 = 256 * (int32_t)(texture->levels - 1);
}

static void fill_texture(const struct state *state, const struct pixel_key *key, int stage,
                         struct texture_job *job)
{
    const struct triptych_texture *texture = state->texture[stage];
    uint32_t first = derive_first_level(state, stage);
    const struct texture_level *level = &texture->level[key->mip[stage] ? 0 : first];
    job->texels = key->mip[stage] ? texture->texels : texture_level_texels(texture, 0, first);
    job->width = level->width;
    job->height = level->height;
    job->width_256 = level->width_256;
    job->height_256 = level->height_256;
    job->last_u = job->width - 1;
    job->last_v = job->height - 1;
    if (key->address_u[stage] == ADDRESS_BORDER || key->address_v[stage] == ADDRESS_BORDER ||
        key->address_w[stage] == ADDRESS_BORDER)
        job->border = rgba_word(SAMPLER(stage, bordercolor));
    if (key->texture[stage] == TEXTURE_CUBE)
        job->face_texels = (int32_t)texture->face_texels;
    if (key->texture[stage] == TEXTURE_VOLUME) {
        job->depth = level->depth;
        job->depth_256 = level->depth_256;
        job->last_w = job->depth - 1;
        job->slice_texels = level->slice_texels;
    }
    if (key->mip[stage] || key->minify[stage])
        fill_detail(state, key, stage, job);
}

static void fill_stages(const struct state *state, const struct pixel_key *key, struct job *job)
{
    for (int i = 0; i < key->stages; i++) {
        if (key->texture[i])
            fill_texture(state, key, i, &job->texture[i]);
        if (stage_reads(key, i, SOURCE_CONSTANT))
            job->stage_constant[i] = rgba_word(STAGE(i, constant));
        if (stage_reads(key, i, SOURCE_FACTOR))
            job->texture_factor = rgba_word(GET(texturefactor));
    }
}

static void fill_fog(const struct state *state, const struct pixel_key *key, struct job *job)
{
    if (!key->fog)
        return;
    job->fog_color = rgba_word(GET(fogcolor));
    if (key->fog != FOG_VARYING)
        derive_fog_formula(state, GET(fogtablemode), &job->fog_scale, &job->fog_offset);
}

static void fill_attributes(const struct state *state, const struct vertex_key *key, struct job *job)
{
    for (int i = 0; i < ATTRIBUTE_COUNT; i++)
        if (key->attribute[i] != ATTRIBUTE_FORMAT_NONE) {
            const struct state_stream *stream = state_stream_of(state, i);
            if (!stream->buffer)
                continue;
            job->attribute[i].data = stream->buffer->data + stream->offset + state->element[i].offset;
            if (stream->frequency != TRIPTYCH_FREQUENCY_INSTANCE)
                job->attribute[i].stride = (int32_t)stream->stride;
        }
}

/* Where the projection's near and far plane have w: z' = z m33 + m43 and w = z m34 + m44 of camera space's z
 * give z' = 0 and z' = w there. A w-buffer's depth runs from 0 to 1 between them, then over the viewport's
 * range; where a projection has no such planes, depth is w. */
static void fill_w_range(const struct state *state, struct job *job)
{
    struct matrix m = matrix_of((const float(*)[4])state->transform[TRIPTYCH_TRANSFORM_PROJECTION]);
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
    job->stencil_reference = (int32_t)(GET(stencilref) & bits);
    job->stencil_mask = (int32_t)(GET(stencilmask) & bits);
    job->stencil_write_mask = (int32_t)(GET(stencilwritemask) & bits);
}

/* Not inlined: the compiler may move arithmetic over a change of MXCSR, but not a call. */
__attribute__((noinline)) static void fill_job(const struct state *state, const struct vertex_key *vertex,
                                               const struct pixel_key *pixel, struct job *job)
{
    struct matrix world = matrix_of((const float(*)[4])state->transform[TRIPTYCH_TRANSFORM_WORLD]);
    struct matrix view = matrix_of((const float(*)[4])state->transform[TRIPTYCH_TRANSFORM_VIEW]);
    struct matrix projection = matrix_of((const float(*)[4])state->transform[TRIPTYCH_TRANSFORM_PROJECTION]);
    fold_depth_range(state, &projection);
    struct matrix view_projection = multiply(&view, &projection);
    struct matrix world_view = multiply(&world, &view);
    struct matrix world_view_projection = multiply(&world_view, &projection);
    fill_attributes(state, vertex, job);
    store_matrix(&world_view_projection, job->world_view_projection);
    if (vertex->lighting) {
        store_matrix(&world_view, job->world_view);
        store_normal_matrix(&world_view, job->normal);
        fill_lighting(state, &view, job);
    }
    if (vertex->attribute[ATTRIBUTE_POSITIONT] != ATTRIBUTE_FORMAT_NONE)
        fill_window(state, job);
    else
        fill_viewport(state, job);
    derive_setup_job(state, vertex, (const double(*)[4])view_projection.m, job);
    fill_depth(state, pixel, job);
    fill_stages(state, pixel, job);
    fill_fog(state, pixel, job);
    if (pixel->alpha_discard)
        job->alpha_reference = (int32_t)GET(alpharef);
    job->blend_constant = rgba_word(GET(blendfactor));
    job->srgb = &srgb_tables;
}

void derive_job(const struct state *state, const struct vertex_key *vertex, const struct pixel_key *pixel,
                struct job *job)
{
    unsigned saved = mxcsr_enter();
    memset(job, 0, sizeof *job);
    fill_job(state, vertex, pixel, job);
    mxcsr_leave(saved);
}
