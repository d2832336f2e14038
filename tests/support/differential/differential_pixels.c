/* Random triangles, textures and targets of a pixel routine, and the textures of a vertex routine. */
#include "tests/support/differential/differential_part.h"
#include "contract/key_query.h"

#include "base/bits.h"
#include "render/target/depth.h"
#include "render/tile/span.h"

#include <math.h>
#include <float.h>
#include <string.h>

static void make_plane(struct differential *d, uint8_t *record, size_t offset, float low, float high)
{
    float slope = differential_below(d, 4) ? 0.1f : 1.25f;
    struct plane plane = {differential_number(d, low, high), differential_number(d, -slope, slope),
                          differential_number(d, -slope, slope)};
    memcpy(record + offset, &plane, sizeof plane);
}

static void make_varying(struct differential *d, uint8_t *record, const struct pixel_key *key, int varying)
{
    float reach = !varying_is_texcoord(varying) ? 0.25f : differential_below(d, 4) ? 3 : 300;
    for (size_t c = 0; c < varying_components[varying]; c++) {
        float flat = differential_number(d, -reach, 1 + reach);
        if (varying == VARYING_blending && c == BLENDING_NUMBER)
            flat = (float)differential_below(d, BLENDING_SUBPIXEL + 1);
        size_t first = d->layout.varying[varying];
        if (key->varying[varying] == INTERPOLATION_FLAT)
            memcpy(record + first + sizeof flat * c, &flat, sizeof flat);
        else if (key->varying[varying] == INTERPOLATION_SMOOTH)
            make_plane(d, record, first + sizeof(struct plane) * c, -reach, 1 + reach);
    }
}

/* The plane of 1/w. In half of the triangles, it has no slope in one or both directions, and is often 1. */
static void make_reciprocal(struct differential *d, uint8_t *record)
{
    static const float some[] = {1, 1, 0.5f, 2};
    struct plane plane;
    make_plane(d, record, d->layout.reciprocal_w, 0.2f, 2);
    memcpy(&plane, record + d->layout.reciprocal_w, sizeof plane);
    unsigned kind = differential_below(d, 8);
    if (kind < 4)
        plane = (struct plane){some[kind], kind == 1 ? plane.dx : 0, 0};
    else if (kind == 4)
        plane = (struct plane){1, 0, plane.dy};
    memcpy(record + d->layout.reciprocal_w, &plane, sizeof plane);
}

/* 0, or from 2^-90 on: often exactly there, or what a distance of some pixels cancels. */
static float tame(struct differential *d, float number, float other)
{
    static const float edges[] = {0, 0, 0x1p-90f, -0x1p-90f, 0x1.fffffep-90f, 1};
    unsigned kind = differential_below(d, 6);
    float cancelled = -other * ((float)differential_between(d, -64, 64) * 0x1p-8f);
    number = kind == 0 ? edges[differential_below(d, 6)] : kind == 1 ? cancelled : number;
    return fabsf(number) >= 0x1p-90f && fabsf(number) < INFINITY ? number : 0;
}

/* The steps of a colour that reaches almost 0 or 1 at a corner of the entries' pixels, or exceeds it as far
 * as the class allows, or is constant. */
static void make_color(struct differential *d, struct plane *plane)
{
    const float far = 190 + 20, near = -84, steps = 0.99f / (2 * (far - near));
    float dx = differential_below(d, 3) ? differential_between(d, -1, 1) * steps : 0;
    float dy = differential_below(d, 3) ? differential_between(d, -1, 1) * steps : 0;
    float low = (dx < 0 ? far : near) * dx + (dy < 0 ? far : near) * dy;
    float high = (dx < 0 ? near : far) * dx + (dy < 0 ? near : far) * dy;
    float stray = differential_below(d, 2) ? 0.99f * (float)SPAN_STRAY : 0;
    float least = -stray - low, most = 1 + stray - high;
    unsigned kind = differential_below(d, 4);
    *plane = (struct plane){kind == 0   ? least
                            : kind == 1 ? most
                                        : least + (most - least) * differential_between(d, 0, 1),
                            dx, dy};
}

/* Moves the record to the class of the span reading. */
static void make_spanned(struct differential *d, uint8_t *record, const struct span_class *class)
{
    for (unsigned i = 0; i < class->count; i++) {
        struct plane plane;
        uint8_t *at = record + class->plane[i].offset;
        unsigned axes = class->plane[i].axes;
        float zero = differential_below(d, 2) ? 0.0f : -0.0f;
        memcpy(&plane, at, sizeof plane);
        plane.dx = axes & AXES_X ? tame(d, plane.dx, 0) : zero;
        plane.dy = axes & AXES_Y ? tame(d, plane.dy, 0) : zero;
        plane.value = tame(d, plane.value, axes & AXES_X ? plane.dx : plane.dy);
        if (axes == AXES_BOTH)
            make_color(d, &plane);
        if (class->plane[i].is_one)
            plane.value = 1;
        memcpy(at, &plane, class->plane[i].is_flat ? sizeof plane.value : sizeof plane);
    }
}

/* Edges near the tile, and numbers that setup computes. */
static void make_edge(struct differential *d, struct smooth_edge *edge)
{
    float slope = differential_below(d, 4) ? differential_between(d, 0, 1) : 0;
    edge->value = differential_below(d, 4) ? differential_between(d, -40, 40) : 1;
    edge->dx = differential_between(d, -1, 1);
    edge->dy = differential_below(d, 2) ? 1 : -1;
    edge->slope = slope;
    edge->reach = (1 + slope) / 2;
    edge->bend = 0.5f / (slope > 0 ? slope : 0x1p-24f);
}

static void make_coverage(struct differential *d, uint8_t *record, const struct pixel_key *key)
{
    void *coverage = record + RECORD_COVERAGE;
    struct smooth_triangle *triangle = coverage;
    struct smooth_line *line = coverage;
    struct smooth_point *point = coverage;
    for (int i = 0; i < 3 && key->coverage == COVERAGE_EDGES; i++) {
        make_edge(d, &triangle->edge[i]);
        triangle->overlap[i].product = differential_between(d, 0, 1);
        triangle->overlap[i].least = differential_between(d, 0, 1);
    }
    if (key->coverage == COVERAGE_LINE) {
        struct smooth_edge edge;
        make_edge(d, &edge);
        *line = (struct smooth_line){
            edge.dx, edge.dy, differential_between(d, 0, 20), edge.value, edge.slope, edge.reach, edge.bend};
    } else if (key->coverage == COVERAGE_POINT) {
        point->radius = differential_between(d, 0, 30);
        point->square = point->radius * point->radius;
    }
}

/* Moves the record to those of joined rectangles. */
static void make_joined(struct differential *d, uint8_t *record, const struct pixel_key *key)
{
    const struct plane one = {1, 0, 0};
    if (d->layout.smooth)
        memcpy(record + d->layout.reciprocal_w, &one, sizeof one);
    for (unsigned c = 0; c < 4 && key->varying[VARYING_diffuse] == INTERPOLATION_FLAT; c++) {
        const float ends[] = {0, 1, FLT_MIN, 0x1.fffffep-1f};
        const float color = differential_below(d, 3)
                                ? differential_between(d, 0, 1)
                                : ends[differential_below(d, sizeof ends / sizeof *ends)];
        memcpy(record + d->layout.varying[VARYING_diffuse] + sizeof color * c, &color, sizeof color);
    }
}

static void make_triangles(struct differential *d, const struct pixel_key *key)
{
    struct span_class class = span_class(key, key->span);
    for (int i = 0; i < TRIANGLES; i++) {
        uint8_t *record = d->triangles + i * d->layout.stride;
        differential_fill_numbers(d, record, d->layout.stride, -4, 4);
        struct triangle_head *head = (void *)record;
        head->visible = differential_below(d, 2) ? 1 : -1;
        head->origin_x = differential_between(d, -20, 84);
        head->origin_y = differential_between(d, -20, 84);
        if (key->coverage && differential_below(d, 8))
            make_coverage(d, record, key);
        if (d->layout.depth)
            make_plane(d, record, d->layout.depth, -0.25f, 1.25f);
        if (d->layout.smooth)
            make_reciprocal(d, record);
        for (int v = 0; v < VARYING_COUNT; v++)
            make_varying(d, record, key, v);
        if (key->span)
            make_spanned(d, record, &class);
        if (key->joined)
            make_joined(d, record, key);
    }
}

static uint16_t random_coverage(struct differential *d)
{
    static const uint16_t some[] = {0xffff, 0x00ff, 0xff00, 0x8001, 0x0100, 0xf000};
    uint16_t sparse = (uint16_t)(differential_word(d) & differential_word(d));
    if (differential_below(d, 2))
        return some[differential_below(d, sizeof some / sizeof *some)];
    return sparse ? sparse : 1;
}

/* The samples of a covered pixel: often all, never none. */
static void make_samples(struct differential *d, const struct pixel_key *key, int i)
{
    struct sample_coverage *coverage = &d->entries.coverage[i];
    uint16_t any = d->entries.entry[i].coverage, left = any;
    int samples = 1 << key->samples, whole = !differential_below(d, 3);
    memset(coverage, 0, sizeof *coverage);
    for (int s = 0; s < samples; s++) {
        coverage->sample[s] = whole ? any : any & (uint16_t)differential_word(d);
        left &= (uint16_t)~coverage->sample[s];
    }
    coverage->sample[differential_below(d, (uint32_t)samples)] |= left;
}

/* Whole blocks in runs of any length, for the span reading. The block after the last one of a row is the
 * first one of the next row. Those of a triangle increase, and follow each other: another block belongs to
 * the next triangle. */
static void make_spans(struct differential *d)
{
    enum { COLUMNS = TILE_SIZE / BLOCK_SIZE };
    for (int i = 0; i < ENTRIES; i++) {
        struct entry *entry = &d->entries.entry[i], *before = entry - (i > 0);
        entry->coverage = UINT16_MAX;
        bool other = i && (entry->block <= before->block || entry->triangle != before->triangle);
        if (!i || before->block == TILE_BLOCKS - 1 || !differential_below(d, 4)) {
            if (other)
                entry->triangle = (before->triangle + d->layout.stride) % (TRIANGLES * d->layout.stride);
            continue;
        }
        bool row_ends = before->block % COLUMNS == COLUMNS - 1;
        *entry = *before;
        entry->block++;
        entry->x += row_ends ? (float)(BLOCK_SIZE - TILE_SIZE) : (float)BLOCK_SIZE;
        entry->y += row_ends ? (float)BLOCK_SIZE : 0;
    }
}

/* Four in five entries begin a new block. The others shade the previous block again. */
static void make_entries(struct differential *d, const struct pixel_key *key)
{
    float left = 64 * (float)differential_below(d, 3), top = 64 * (float)differential_below(d, 3);
    d->count = 1 + differential_below(d, ENTRIES);
    for (int i = 0; i < ENTRIES; i++) {
        uint16_t block =
            i % 5 ? (uint16_t)differential_below(d, TILE_BLOCKS) : d->entries.entry[i ? i - 1 : 0].block;
        d->entries.entry[i] = (struct entry){.x = left + (float)(block % 16 * 4),
                                             .y = top + (float)(block / 16 * 4),
                                             .coverage = random_coverage(d),
                                             .block = block,
                                             .triangle = differential_below(d, TRIANGLES) * d->layout.stride};
        make_samples(d, key, i);
    }
    if (key->span)
        make_spans(d);
}

static int32_t texture_side(struct differential *d, int small, int address)
{
    int power = address == ADDRESS_WRAP_POWER || address == ADDRESS_MIRROR_POWER;
    return power ? 1 << differential_below(d, small ? 5 : 7)
                 : 1 + (int32_t)differential_below(d, small ? SMALL_SIDE : TEXTURE_SIDE);
}

static int32_t half(int32_t side, int level)
{
    return side >> level ? side >> level : 1;
}

static int32_t in_tiles(int32_t size)
{
    return (size + 3) & ~3;
}

static void order_level(struct texture_level *level, bool tiled)
{
    level->pitch = tiled ? in_tiles(level->width) : level->width + 1;
    level->slice_texels = level->pitch * (tiled ? in_tiles(level->height) : level->height);
}

/* Fills in the levels of one face. Returns its texels. */
static int32_t make_levels(const int32_t side[3], bool tiled, struct texture_level levels[LEVELS])
{
    int32_t offset = 0;
    for (int l = 0; l < LEVELS; l++) {
        struct texture_level *level = &levels[l];
        *level = (struct texture_level){.offset = offset,
                                        .width = half(side[0], l),
                                        .height = half(side[1], l),
                                        .depth = half(side[2], l)};
        order_level(level, tiled);
        offset += level->slice_texels * level->depth;
    }
    return offset;
}

/* The range of levels that may be sampled. A texture without levels has only the first. */
static void make_detail(struct differential *d, int sampler)
{
    struct texture_job *texture = &d->job.texture[sampler];
    uint32_t last = differential_below(d, LEVELS);
    texture->levels = d->levels[sampler];
    texture->first_level_256 = 256 * (int32_t)differential_below(d, last + 1);
    texture->last_level_256 = 256 * (int32_t)last;
    texture->lod_bias_256 = differential_number(d, -256 * 4, 256 * 4);
    texture->lod_offset = differential_number(d, -256 * 14, 256);
}

static int texel_bytes(const struct sampler_key *key)
{
    if (key->texel >= TEXEL_FLOATS)
        return 16;
    return key->compact ? storage_compact[key->compact].bytes : 4;
}

/* The padding after the image's last row ends with the last word before the fence. The padding of a row
 * differs from the row's first texels, so an engine must read the same ones as the specification. */
static void make_texture(struct differential *d, struct sampler_key key)
{
    struct texture_job *texture = &d->job.texture[key.number];
    int kind = key.kind, bytes = texel_bytes(&key);
    int small = kind == TEXTURE_VOLUME || bytes > 4;
    const int32_t side[3] = {texture_side(d, small, key.address[0]), texture_side(d, small, key.address[1]),
                             kind == TEXTURE_VOLUME ? texture_side(d, small, key.address[2]) : 1};
    struct texture_level *first = d->levels[key.number];
    int32_t chain = make_levels(side, key.tiled, first), image = first->slice_texels * side[2];
    texture->face_texels = key.mip ? chain : image;
    int32_t texels = kind == TEXTURE_CUBE ? 6 * texture->face_texels : texture->face_texels;
    int32_t margin = TEXTURE_MARGIN_ROWS * first->pitch + TEXTURE_MARGIN_TEXELS;
    const uint8_t *end = (const uint8_t *)d->texels + TEXTURE_BYTES;
    texture->texels = (const uint32_t *)(const void *)(end - (ptrdiff_t)bytes * (texels + margin));
    texture->width = side[0];
    texture->height = side[1];
    texture->depth = side[2];
    texture->width_256 = 256 * (float)side[0];
    texture->height_256 = 256 * (float)side[1];
    texture->depth_256 = 256 * (float)side[2];
    texture->last_u = side[0] - 1;
    texture->last_v = side[1] - 1;
    texture->last_w = side[2] - 1;
    texture->pitch = first->pitch;
    texture->last_u_256 = 256 * texture->last_u;
    texture->last_v_256 = 256 * texture->last_v;
    texture->last_w_256 = 256 * texture->last_w;
    texture->slice_texels = first->slice_texels;
    texture->border = differential_word(d);
    make_detail(d, key.number);
}

/* A mask at the pixels of some blocks, whose last texel and its overread end before the fence. */
static void make_clip_mask(struct differential *d, const struct pixel_key *key)
{
    struct clip_mask_job *mask = &d->job.clip_mask;
    bool tiled = key->clip_mask == CLIP_MASK_TILES;
    mask->last_u = (int32_t)differential_below(d, 64);
    mask->last_v = (int32_t)differential_below(d, 64);
    mask->pitch = tiled ? in_tiles(mask->last_u + 1) : mask->last_u + 2;
    mask->x = (int32_t)differential_below(d, 64) - 16;
    mask->y = (int32_t)differential_below(d, 64) - 16;
    int32_t texels = mask->pitch * (tiled ? in_tiles(mask->last_v + 1) : mask->last_v + 1);
    mask->texels = (const uint8_t *)d->texels + TEXTURE_BYTES - (texels + 3);
}

static void make_textures(struct differential *d, const struct pixel_key *key)
{
    differential_fill_words(d, d->texels, TEXTURE_BYTES);
    for (int i = 0; i < PIXEL_SAMPLERS; i++)
        make_texture(d, pixel_sampler(key, i));
    for (int i = 0; i < TEXTURE_STAGES; i++) {
        d->job.stage_constant[i] = differential_word(d);
        differential_fill_numbers(d, &d->job.bump[i], sizeof d->job.bump[i], -0.5f, 0.5f);
    }
    d->job.texture_factor = differential_word(d);
    make_clip_mask(d, key);
}

void differential_vertex_textures(struct differential *d, const struct vertex_key *key)
{
    if (key_next(key->texture, 0, VERTEX_SAMPLERS) == VERTEX_SAMPLERS)
        return;
    differential_fill_words(d, d->texels, TEXTURE_BYTES);
    for (int i = 0; i < VERTEX_SAMPLERS; i++)
        make_texture(d, vertex_sampler(key, i));
}

static void make_fog(struct differential *d, const struct pixel_key *key)
{
    int linear = key->fog == FOG_LINEAR_Z || key->fog == FOG_LINEAR_W;
    d->job.fog_color = differential_word(d);
    d->job.fog_scale = differential_number(d, -2, linear ? 2 : 0);
    d->job.fog_offset = differential_number(d, -1, 2);
}

/* A depth in the format of the key's storage class. */
static uint32_t depth_word(struct differential *d, const struct pixel_key *key, float depth)
{
    static const enum triptych_depth_format format[DEPTH_STORAGE_COUNT] = {
        TRIPTYCH_DEPTH_D32F_LOCKABLE, TRIPTYCH_DEPTH_D24S8, TRIPTYCH_DEPTH_D24FS8, TRIPTYCH_DEPTH_D32};
    int limited = depth >= 0 && depth <= 1;
    uint32_t stencil = key->depth_format == DEPTH_UNORM || key->depth_format == DEPTH_FLOAT24
                           ? differential_below(d, 256)
                           : 0;
    if (key->depth_format != DEPTH_FLOAT)
        return depth_encode(format[key->depth_format], limited ? depth : 0) | stencil;
    return bits_of_float(depth);
}

/* Planes that pass exactly through stored depths, so that EQUAL succeeds for some pixels. */
static void meet_stored_depths(struct differential *d, const struct pixel_key *key)
{
    struct plane plane = {0.5f, 0, 0};
    for (int i = 0; i < TRIANGLES; i++)
        memcpy(d->triangles + i * d->layout.stride + d->layout.depth, &plane, sizeof plane);
    for (int i = 0; i < TILE_PIXELS << key->samples; i++)
        d->initial.depth[i] = depth_word(d, key, 0.25f * (float)(1 + differential_below(d, 3)));
}

/* Values with few and with many bits. They often equal the reference. */
static void make_stencil_job(struct differential *d)
{
    struct job *job = &d->job;
    job->depth_maximum = 16777215;
    job->w_scale = differential_number(d, -0.1f, 1.5f);
    job->w_offset = differential_number(d, -0.5f, 0.5f);
    job->stencil_maximum = differential_below(d, 4) ? 255 : 15;
    job->stencil_reference = (int32_t)differential_below(d, 256) & job->stencil_maximum;
    job->stencil_mask =
        (int32_t)(differential_below(d, 2) ? 255 : differential_below(d, 8)) & job->stencil_maximum;
    job->stencil_write_mask =
        (int32_t)(differential_below(d, 2) ? 255 : differential_below(d, 256)) & job->stencil_maximum;
}

/* Often an alpha of saturated colours, or the next value. */
static int32_t alpha_reference(struct differential *d)
{
    static const uint8_t some[] = {0, 1, 127, 128, 254, 255};
    return differential_below(d, 2) ? some[differential_below(d, sizeof some)]
                                    : (int32_t)differential_below(d, 256);
}

/* Words, or planes of numbers. */
static void make_targets(struct differential *d, const struct pixel_key *key)
{
    uint32_t *plane = d->initial.color;
    for (int t = 0; t < (key->samples ? 1 : TARGETS); t++)
        for (int p = 0; p < storage_planes[key->target[t]] << key->samples; p++, plane += TILE_PIXELS)
            if (storage_planes[key->target[t]] > 1)
                differential_fill_numbers(d, plane, TILE_PLANE_BYTES, -0.5f, 1.5f);
            else
                differential_fill_words(d, plane, TILE_PLANE_BYTES);
}

/* In half of the triangles of the span reading, a pixel is a simple number of texels wide, so that texels are
 * close together: 1/w is 1, and u begins at any texel near the image, or between two. */
static void match_texels(struct differential *d, const struct pixel_key *key)
{
    static const float scales[] = {1,  1,  1,     0.5f, 0.25f,  2,      3,       0.875f,
                                   -1, -1, -0.5f, -2,   1.125f, 2.375f, -2.375f, 0};
    for (int i = 0; i < TRIANGLES && d->layout.smooth; i++) {
        uint8_t *record = d->triangles + i * d->layout.stride;
        const struct plane one = {1, 0, 0};
        if (differential_below(d, 2))
            continue;
        memcpy(record + d->layout.reciprocal_w, &one, sizeof one);
        for (int channel = 0; channel < TEXTURE_STAGES; channel++) {
            const int v = varying_texcoord(channel);
            float width = (float)d->job.texture[channel].width;
            float first = (float)differential_below(d, 2 * TEXTURE_SIDE) - 0.5f * TEXTURE_SIDE;
            const struct plane u = {(first + 0.25f * (float)differential_below(d, 4)) / width,
                                    scales[differential_below(d, sizeof scales / sizeof *scales)] / width, 0};
            if (key->varying[v] == INTERPOLATION_SMOOTH)
                memcpy(record + d->layout.varying[v], &u, sizeof u);
        }
    }
}

void differential_pixel_inputs(struct differential *d, const struct pixel_key *key)
{
    d->job.alpha_reference = alpha_reference(d);
    d->job.blend_constant = differential_word(d);
    make_stencil_job(d);
    d->layout = layout_of_pixel(key);
    make_triangles(d, key);
    make_entries(d, key);
    make_textures(d, key);
    if (key->span)
        match_texels(d, key);
    make_fog(d, key);
    make_targets(d, key);
    for (int i = 0; i < TILE_PIXELS << key->samples; i++)
        d->initial.depth[i] = depth_word(d, key,
                                         differential_below(d, 3) ? differential_number(d, 0, 1)
                                                                  : (float)differential_below(d, 2));
    struct lane_table lanes = lane_table;
    for (int lane = 0; lane < LANES_MAXIMUM; lane++)
        lanes.passed[lane] = (int32_t)differential_below(d, 1000);
    memcpy(d->initial.lanes + 4, &lanes, sizeof lanes);
    if (d->layout.depth && !differential_below(d, 3))
        meet_stored_depths(d, key);
}
