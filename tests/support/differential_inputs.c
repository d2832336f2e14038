/* Random inputs of a routine: see differential.h for what they are like. */
#include "differential_part.h"

#include "base/srgb.h"
#include "draw/depth.h"
#include "shader/program.h"

#include <string.h>
#include <xxhash.h>

uint32_t differential_word(struct differential *d)
{
    d->seed ^= d->seed >> 12;
    d->seed ^= d->seed << 25;
    d->seed ^= d->seed >> 27;
    return (uint32_t)(d->seed * 0x2545f4914f6cdd1dull >> 32);
}

static uint32_t below(struct differential *d, uint32_t limit)
{
    return differential_word(d) % limit;
}

static float between(struct differential *d, float low, float high)
{
    return low + (high - low) * (float)(differential_word(d) >> 8) * 0x1p-24f;
}

static float special(struct differential *d)
{
    static const uint32_t edges[] = {0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x007fffff, 0x00800000,
                                     0x7f7fffff, 0xff7fffff, 0x7f800000, 0xff800000, 0x7fc00000, 0xffc12345,
                                     0x7f800001, 0x3f800000, 0xbf800000, 0x3f000000, 0x4b000000, 0x4f000000,
                                     0xcf000000, 0x5f000000, 0x34000000, 0x2b800000, 0x7149f2ca};
    uint32_t bits = below(d, 8) ? edges[below(d, sizeof edges / sizeof *edges)] : differential_word(d);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Plausible, or in the wild mood one time in eight anything. */
static float number(struct differential *d, float low, float high)
{
    return d->wild && !below(d, 8) ? special(d) : between(d, low, high);
}

static void fill(struct differential *d, void *memory, size_t bytes, float low, float high)
{
    for (size_t at = 0; at + 4 <= bytes; at += 4) {
        float value = number(d, low, high);
        memcpy((uint8_t *)memory + at, &value, sizeof value);
    }
}

static void fill_words(struct differential *d, void *memory, size_t bytes)
{
    for (size_t at = 0; at + 4 <= bytes; at += 4) {
        uint32_t value = differential_word(d);
        memcpy((uint8_t *)memory + at, &value, sizeof value);
    }
}

/* A multiple of 16 lanes: mostly few, sometimes none or as many as there may be. */
static uint32_t lane_count(struct differential *d, uint32_t capacity)
{
    return below(d, 8) ? 16 * (1 + below(d, 4)) : 16 * below(d, capacity / 16 + 1);
}

/* --- The job --- */

static void make_lights(struct differential *d)
{
    fill(d, d->job.base_color, sizeof d->job.base_color, -0.2f, 1);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        struct light_job *light = &d->job.light[i];
        fill(d, light->position, sizeof light->position, -3, 3);
        fill(d, light->diffuse, sizeof light->diffuse, -0.1f, 1);
        fill(d, light->ambient, sizeof light->ambient, 0, 0.3f);
        light->range = number(d, 0, 8);
        light->attenuation0 = number(d, 0, 1);
        light->attenuation1 = number(d, 0, 1);
        light->attenuation2 = number(d, 0, 1);
        fill(d, light->specular, sizeof light->specular, 0, 1);
        fill(d, light->axis, sizeof light->axis, -1, 1);
        light->outer_cosine = number(d, -0.5f, 0.5f);
        light->cone_scale = number(d, 0.5f, 4);
        light->falloff = below(d, 4) ? number(d, 0, 4) : 1;
    }
    fill(d, d->job.ambient_light, sizeof d->job.ambient_light, 0, 1);
    d->job.power = below(d, 4) ? number(d, 0, 30) : 0;
    d->job.specular_alpha = number(d, 0, 1);
}

/* What blends positions; the palette ends at a fence. */
static void make_skin(struct differential *d)
{
    fill(d, d->job.projection, sizeof d->job.projection, -2, 2);
    fill(d, d->job.blend, sizeof d->job.blend, -1, 1);
    fill(d, d->job.texture_matrix, sizeof d->job.texture_matrix, -1, 1);
    fill(d, d->palette, PALETTE_BYTES, -1, 1);
    d->job.palette = (const void *)d->palette;
    d->job.tween_factor = number(d, -0.5f, 1.5f);
}

/* Every vertex at the camera and every light at exactly its range, where "within" and "below" differ. */
static void put_lights_at_their_range(struct differential *d)
{
    memset(d->job.world_view, 0, sizeof d->job.world_view);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        struct light_job *light = &d->job.light[i];
        memset(light->position, 0, sizeof light->position);
        light->position[below(d, 3)] = light->range = (float)(1u << below(d, 4));
    }
}

static void make_job(struct differential *d)
{
    struct job *job = &d->job;
    memset(job, 0, sizeof *job);
    job->srgb = &srgb_tables;
    fill(d, job->world_view_projection, sizeof job->world_view_projection, -2, 2);
    fill(d, job->world_view, sizeof job->world_view, -2, 2);
    fill(d, job->normal, sizeof job->normal, -2, 2);
    make_lights(d);
    make_skin(d);
    if (!below(d, 8))
        put_lights_at_their_range(d);
    job->guard_x = between(d, 1, 50);
    job->guard_y = between(d, 1, 50);
    job->scale_x = number(d, 1, 100000);
    job->scale_y = number(d, -100000, -1);
    job->offset_x = number(d, 0, 100000);
    job->offset_y = number(d, 0, 100000);
    job->depth_scale = number(d, 0.1f, 1);
    job->depth_offset = number(d, -0.1f, 0.5f);
    job->depth_bias = number(d, -0.1f, 0.1f);
    job->depth_bias_slope = number(d, -2, 2);
    job->point_size = number(d, 0, 64);
    job->point_least = number(d, 0, 4);
    job->point_most = number(d, 2, 40);
    fill(d, job->point_scale, sizeof job->point_scale, 0, 1);
    job->viewport_height = number(d, 1, 100);
    fill(d, job->clip_plane, sizeof job->clip_plane, -2, 2);
}

/* --- Shaders --- */

/* Of all registers that the device has, those of the first models are random; others repeat them. */
static void fill_registers(struct differential *d, float (*floats)[4], int32_t (*integers)[4])
{
    enum { RANDOM_FLOATS = 256, RANDOM_INTEGERS = 16 };
    fill(d, floats, RANDOM_FLOATS * sizeof *floats, -2, 2);
    for (int i = 0; i < RANDOM_INTEGERS; i++) {
        integers[i][0] = (int32_t)below(d, 4);
        integers[i][1] = (int32_t)below(d, 12);
        integers[i][2] = (int32_t)below(d, 7) - 3;
        integers[i][3] = 0;
    }
    for (int i = RANDOM_FLOATS; i < CONSTANT_FLOATS; i += RANDOM_FLOATS)
        memcpy(floats[i], floats[0], RANDOM_FLOATS * sizeof *floats);
    for (int i = RANDOM_INTEGERS; i < CONSTANT_INTEGERS; i += RANDOM_INTEGERS)
        memcpy(integers[i], integers[0], RANDOM_INTEGERS * sizeof *integers);
}

/* The last of them ends at the fence. Loops are short, and most relative addresses small. */
static void make_constants(struct differential *d, enum unit unit, const union key *key)
{
    static float floats[CONSTANT_FLOATS][4];
    static int32_t integers[CONSTANT_INTEGERS][4];
    const struct program *program = key_shader(unit, key);
    d->constant_bytes = program ? program_constant_bytes(program) : 0;
    if (!program)
        return;
    uint8_t *constants = d->constants + CONSTANT_BYTES - d->constant_bytes;
    fill_registers(d, floats, integers);
    program_write_constants(program, (const float(*)[4])floats, (const int32_t(*)[4])integers, constants);
    d->job.constants[program->model->stage] = (const float *)(const void *)constants;
}

/* --- Vertices --- */

/* The last vertex that is fetched ends at the fence, or up to three bytes before it. */
static void make_stream(struct differential *d, uint8_t *stream, struct attribute_job *job, int format,
                        uint32_t last)
{
    job->stride = 4 * (int32_t)below(d, STRIDE_MAXIMUM / 4 + 1);
    job->data = stream + STREAM_BYTES - last * (uint32_t)job->stride - vertex_types[format].bytes;
    if (!below(d, 4))
        job->data -= below(d, 4);
    if (vertex_types[format].encoding != ENCODING_FLOAT)
        fill_words(d, stream, STREAM_BYTES);
    else
        fill(d, stream, STREAM_BYTES, -2, 2);
    if (!below(d, 16)) /* zero vectors, whose length has no reciprocal */
        memset(stream, 0, STREAM_BYTES);
}

static void make_vertex_inputs(struct differential *d, const struct vertex_key *key)
{
    uint32_t last = 0;
    d->count = lane_count(d, VERTEX_CAPACITY);
    for (uint32_t i = 0; i < d->count; i++) {
        differential_indices(d)[i] = below(d, VERTEX_CAPACITY);
        last = differential_indices(d)[i] > last ? differential_indices(d)[i] : last;
    }
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        make_stream(d, d->stream[a], &d->job.attribute[a], key->attribute[a], last);
    for (int i = 0; i < INPUTS && key_program(key->shader); i++) /* attributes are not read then */
        make_stream(d, d->stream[i], &d->job.input[i], key->input[i], last);
}

/* --- Triangles --- */

static void make_setup_inputs(struct differential *d, const struct setup_key *key)
{
    d->layout = setup_layout(key);
    d->count = lane_count(d, SETUP_CAPACITY);
    for (int slot = 0; slot < SLOT_COUNT; slot++)
        fill(d, d->initial.vertices + slot * VERTEX_CAPACITY, VERTEX_SLOT_BYTES, slot == SLOT_W ? 0.5f : -2,
             slot == SLOT_W ? 4 : 2);
    for (int i = 0; i < 4 * SETUP_CAPACITY; i++)
        differential_indices(d)[i] = 4 * below(d, VERTEX_CAPACITY);
    for (int i = 4 * SETUP_CAPACITY; i < SETUP_INDEX_ROWS * SETUP_CAPACITY; i++)
        differential_indices(d)[i] = -below(d, 2);
    for (int i = 0; i < SETUP_CAPACITY; i++)
        if (!below(d, 16)) /* without area */
            differential_indices(d)[i] = differential_indices(d)[i + SETUP_CAPACITY * (1 + (int)below(d, 2))];
}

/* --- Pixels --- */

static void make_plane(struct differential *d, uint8_t *record, size_t offset, float low, float high)
{
    float slope = below(d, 4) ? 0.1f : 1.25f;
    struct plane plane = {number(d, low, high), number(d, -slope, slope), number(d, -slope, slope)};
    memcpy(record + offset, &plane, sizeof plane);
}

static void make_varying(struct differential *d, uint8_t *record, const struct pixel_key *key, int varying)
{
    float reach = !varying_is_texcoord(varying) ? 0.25f : below(d, 4) ? 3 : 300;
    for (size_t c = 0; c < varying_components[varying]; c++) {
        float flat = number(d, -reach, 1 + reach);
        size_t first = d->layout.varying[varying];
        if (key->varying[varying] == INTERPOLATION_FLAT)
            memcpy(record + first + sizeof flat * c, &flat, sizeof flat);
        else if (key->varying[varying] == INTERPOLATION_SMOOTH)
            make_plane(d, record, first + sizeof(struct plane) * c, -reach, 1 + reach);
    }
}

/* 1/w, in half of the triangles without a slope one way or both, and then often 1. */
static void make_reciprocal(struct differential *d, uint8_t *record)
{
    static const float some[] = {1, 1, 0.5f, 2};
    struct plane plane;
    make_plane(d, record, d->layout.reciprocal_w, 0.2f, 2);
    memcpy(&plane, record + d->layout.reciprocal_w, sizeof plane);
    unsigned kind = below(d, 8);
    if (kind < 4)
        plane = (struct plane){some[kind], kind == 1 ? plane.dx : 0, 0};
    else if (kind == 4)
        plane = (struct plane){1, 0, plane.dy};
    memcpy(record + d->layout.reciprocal_w, &plane, sizeof plane);
}

static void make_triangles(struct differential *d, const struct pixel_key *key)
{
    for (int i = 0; i < TRIANGLES; i++) {
        uint8_t *record = d->triangles + i * d->layout.stride;
        fill(d, record, d->layout.stride, -4, 4);
        struct triangle_head *head = (void *)record;
        head->visible = below(d, 2) ? 1 : -1;
        head->origin_x = between(d, -20, 84);
        head->origin_y = between(d, -20, 84);
        if (d->layout.depth)
            make_plane(d, record, d->layout.depth, -0.25f, 1.25f);
        if (d->layout.smooth)
            make_reciprocal(d, record);
        for (int v = 0; v < VARYING_COUNT; v++)
            make_varying(d, record, key, v);
    }
}

static uint16_t random_coverage(struct differential *d)
{
    static const uint16_t some[] = {0xffff, 0x00ff, 0xff00, 0x8001, 0x0100, 0xf000};
    uint16_t sparse = (uint16_t)(differential_word(d) & differential_word(d));
    if (below(d, 2))
        return some[below(d, sizeof some / sizeof *some)];
    return sparse ? sparse : 1;
}

/* Samples of a covered pixel: often all, else some, never none. */
static void make_samples(struct differential *d, const struct pixel_key *key, int i)
{
    struct sample_coverage *coverage = &d->entries.coverage[i];
    uint16_t any = d->entries.entry[i].coverage, left = any;
    int samples = 1 << key->samples, whole = !below(d, 3);
    memset(coverage, 0, sizeof *coverage);
    for (int s = 0; s < samples; s++) {
        coverage->sample[s] = whole ? any : any & (uint16_t)differential_word(d);
        left &= (uint16_t)~coverage->sample[s];
    }
    coverage->sample[below(d, (uint32_t)samples)] |= left;
}

/* Four in five entries begin a new block; the others shade the one before again. */
static void make_entries(struct differential *d, const struct pixel_key *key)
{
    float left = 64 * (float)below(d, 3), top = 64 * (float)below(d, 3);
    d->count = 1 + below(d, ENTRIES);
    for (int i = 0; i < ENTRIES; i++) {
        uint16_t block = i % 5 ? (uint16_t)below(d, TILE_BLOCKS) : d->entries.entry[i ? i - 1 : 0].block;
        d->entries.entry[i] = (struct entry){.x = left + (float)(block % 16 * 4),
                                             .y = top + (float)(block / 16 * 4),
                                             .coverage = random_coverage(d),
                                             .block = block,
                                             .triangle = below(d, TRIANGLES) * d->layout.stride};
        make_samples(d, key, i);
    }
}

static int32_t texture_side(struct differential *d, int small, int address)
{
    int power = address == ADDRESS_WRAP_POWER || address == ADDRESS_MIRROR_POWER;
    return power ? 1 << below(d, small ? 5 : 7) : 1 + (int32_t)below(d, small ? SMALL_SIDE : TEXTURE_SIDE);
}

static int32_t half(int32_t side, int level)
{
    return side >> level ? side >> level : 1;
}

/* Fills in the levels of one face; returns its texels. */
static int32_t make_levels(const int32_t side[3], struct texture_level levels[LEVELS])
{
    int32_t offset = 0;
    for (int l = 0; l < LEVELS; l++) {
        struct texture_level *level = &levels[l];
        *level = (struct texture_level){.offset = offset,
                                        .width = half(side[0], l),
                                        .height = half(side[1], l),
                                        .depth = half(side[2], l)};
        level->pitch = level->width + 1;
        level->slice_texels = level->pitch * level->height;
        offset += level->slice_texels * level->depth;
    }
    return offset;
}

/* Which levels may be sampled: any range of them. Without levels the first is all there is. */
static void make_detail(struct differential *d, int sampler)
{
    struct texture_job *texture = &d->job.texture[sampler];
    uint32_t last = below(d, LEVELS);
    texture->levels = d->levels[sampler];
    texture->first_level_256 = 256 * (int32_t)below(d, last + 1);
    texture->last_level_256 = 256 * (int32_t)last;
    texture->lod_bias_256 = number(d, -256 * 4, 256 * 4);
    texture->lod_offset = number(d, -256 * 14, 256);
}

/* The margin behind the image's last row ends with the last word before the fence. Rows do not end with their first texels: which
 * of the two an engine reads, it has to read where the specification does. */
static void make_texture(struct differential *d, struct sampler_key key)
{
    struct texture_job *texture = &d->job.texture[key.number];
    int kind = key.kind, words = key.texel >= TEXEL_FLOATS ? 4 : 1;
    int small = kind == TEXTURE_VOLUME || words > 1;
    const int32_t side[3] = {texture_side(d, small, key.address[0]), texture_side(d, small, key.address[1]),
                             kind == TEXTURE_VOLUME ? texture_side(d, small, key.address[2]) : 1};
    int32_t chain = make_levels(side, d->levels[key.number]), image = (side[0] + 1) * side[1] * side[2];
    texture->face_texels = key.mip ? chain : image;
    int32_t texels = kind == TEXTURE_CUBE ? 6 * texture->face_texels : texture->face_texels;
    int32_t margin = TEXTURE_MARGIN_ROWS * (side[0] + 1) + TEXTURE_MARGIN_TEXELS;
    texture->texels = (const uint32_t *)(void *)(d->texels + TEXTURE_BYTES) - words * (texels + margin);
    texture->width = side[0];
    texture->height = side[1];
    texture->depth = side[2];
    texture->width_256 = 256 * (float)side[0];
    texture->height_256 = 256 * (float)side[1];
    texture->depth_256 = 256 * (float)side[2];
    texture->last_u = side[0] - 1;
    texture->last_v = side[1] - 1;
    texture->last_w = side[2] - 1;
    texture->pitch = side[0] + 1;
    texture->last_u_256 = 256 * texture->last_u;
    texture->last_v_256 = 256 * texture->last_v;
    texture->last_w_256 = 256 * texture->last_w;
    texture->slice_texels = texture->pitch * side[1];
    texture->border = differential_word(d);
    make_detail(d, key.number);
}

static void make_textures(struct differential *d, const struct pixel_key *key)
{
    fill_words(d, d->texels, TEXTURE_BYTES);
    for (int i = 0; i < PIXEL_SAMPLERS; i++)
        make_texture(d, pixel_sampler(key, i));
    for (int i = 0; i < TEXTURE_STAGES; i++) {
        d->job.stage_constant[i] = differential_word(d);
        fill(d, &d->job.bump[i], sizeof d->job.bump[i], -0.5f, 0.5f);
    }
    d->job.texture_factor = differential_word(d);
}

static void make_vertex_textures(struct differential *d, const struct vertex_key *key)
{
    if (key_next(key->texture, 0, VERTEX_SAMPLERS) == VERTEX_SAMPLERS)
        return;
    fill_words(d, d->texels, TEXTURE_BYTES);
    for (int i = 0; i < VERTEX_SAMPLERS; i++)
        make_texture(d, vertex_sampler(key, i));
}

static void make_fog(struct differential *d, const struct pixel_key *key)
{
    int linear = key->fog == FOG_LINEAR_Z || key->fog == FOG_LINEAR_W;
    d->job.fog_color = differential_word(d);
    d->job.fog_scale = number(d, -2, linear ? 2 : 0);
    d->job.fog_offset = number(d, -1, 2);
}

/* What a depth is stored as in the format that the key's storage class stands for. */
static uint32_t depth_word(struct differential *d, const struct pixel_key *key, float depth)
{
    static const enum triptych_depth_format format[DEPTH_STORAGE_COUNT] = {
        TRIPTYCH_DEPTH_d32f_lockable, TRIPTYCH_DEPTH_d24s8, TRIPTYCH_DEPTH_d24fs8, TRIPTYCH_DEPTH_d32};
    int limited = depth >= 0 && depth <= 1;
    uint32_t stencil =
        key->depth_format == DEPTH_UNORM || key->depth_format == DEPTH_FLOAT24 ? below(d, 256) : 0;
    if (key->depth_format != DEPTH_FLOAT)
        return depth_encode(format[key->depth_format], limited ? depth : 0) | stencil;
    uint32_t bits;
    memcpy(&bits, &depth, sizeof bits);
    return bits;
}

/* Planes that pass exactly through stored depths, so that EQUAL has something to find. */
static void meet_stored_depths(struct differential *d, const struct pixel_key *key)
{
    struct plane plane = {0.5f, 0, 0};
    for (int i = 0; i < TRIANGLES; i++)
        memcpy(d->triangles + i * d->layout.stride + d->layout.depth, &plane, sizeof plane);
    for (int i = 0; i < TILE_PIXELS << key->samples; i++)
        d->initial.depth[i] = depth_word(d, key, 0.25f * (float)(1 + below(d, 3)));
}

/* Few bits and many: often the reference is met. */
static void make_stencil_job(struct differential *d)
{
    struct job *job = &d->job;
    job->depth_maximum = 16777215;
    job->w_scale = number(d, -0.1f, 1.5f);
    job->w_offset = number(d, -0.5f, 0.5f);
    job->stencil_maximum = below(d, 4) ? 255 : 15;
    job->stencil_reference = (int32_t)below(d, 256) & job->stencil_maximum;
    job->stencil_mask = (int32_t)(below(d, 2) ? 255 : below(d, 8)) & job->stencil_maximum;
    job->stencil_write_mask = (int32_t)(below(d, 2) ? 255 : below(d, 256)) & job->stencil_maximum;
}

/* Often an alpha that saturated colours have, or its neighbour. */
static int32_t alpha_reference(struct differential *d)
{
    static const uint8_t some[] = {0, 1, 127, 128, 254, 255};
    return below(d, 2) ? some[below(d, sizeof some)] : (int32_t)below(d, 256);
}

/* Words, or planes of numbers. */
static void make_targets(struct differential *d, const struct pixel_key *key)
{
    uint32_t *plane = d->initial.color;
    for (int t = 0; t < (key->samples ? 1 : TARGETS); t++)
        for (int p = 0; p < target_planes[key->target[t]] << key->samples; p++, plane += TILE_PIXELS)
            if (target_planes[key->target[t]] > 1)
                fill(d, plane, TILE_PLANE_BYTES, -0.5f, 1.5f);
            else
                fill_words(d, plane, TILE_PLANE_BYTES);
}

static void make_pixel_inputs(struct differential *d, const struct pixel_key *key)
{
    d->job.alpha_reference = alpha_reference(d);
    d->job.blend_constant = differential_word(d);
    make_stencil_job(d);
    d->layout = pixel_layout(key);
    make_triangles(d, key);
    make_entries(d, key);
    make_textures(d, key);
    make_fog(d, key);
    make_targets(d, key);
    for (int i = 0; i < TILE_PIXELS << key->samples; i++)
        d->initial.depth[i] = depth_word(d, key, below(d, 3) ? number(d, 0, 1) : (float)below(d, 2));
    struct lane_table lanes = lane_table;
    for (int lane = 0; lane < LANES_MAXIMUM; lane++)
        lanes.passed[lane] = (int32_t)below(d, 1000);
    memcpy(d->initial.lanes + 4, &lanes, sizeof lanes);
    if (d->layout.depth && !below(d, 3))
        meet_stored_depths(d, key);
}

uint64_t differential_hash(const struct differential *d)
{
    XXH64_hash_t hash = XXH3_64bits(&d->job, sizeof d->job);
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        hash = XXH3_64bits_withSeed(d->stream[a], STREAM_BYTES, hash);
    hash = XXH3_64bits_withSeed(d->texels, TEXTURE_BYTES, hash);
    hash = XXH3_64bits_withSeed(d->levels, sizeof d->levels, hash);
    hash = XXH3_64bits_withSeed(d->palette, PALETTE_BYTES, hash);
    hash = XXH3_64bits_withSeed(d->constants + CONSTANT_BYTES - d->constant_bytes, d->constant_bytes, hash);
    hash = XXH3_64bits_withSeed(d->index_words, sizeof d->index_words, hash);
    hash = XXH3_64bits_withSeed(&d->entries, sizeof d->entries, hash);
    return XXH3_64bits_withSeed(d->triangles, sizeof d->triangles, hash);
}

void differential_fill(struct differential *d, enum unit unit, const union key *key, uint64_t seed)
{
    d->seed = seed * 0x9e3779b97f4a7c15ull | 1;
    d->wild = (int)below(d, 2);
    memset(&d->initial, UNTOUCHED, sizeof d->initial);
    make_job(d);
    make_constants(d, unit, key);
    switch (unit) {
    case UNIT_VERTEX:
        make_vertex_inputs(d, &key->vertex);
        make_vertex_textures(d, &key->vertex);
        break;
    case UNIT_SETUP: make_setup_inputs(d, &key->setup); break;
    default: make_pixel_inputs(d, &key->pixel); break;
    }
    d->inputs = differential_hash(d);
}
