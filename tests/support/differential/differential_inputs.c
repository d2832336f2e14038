/* Random inputs of a routine, as differential.h describes them. */
#include "tests/support/differential/differential_part.h"
#include "contract/key_query.h"

#include "base/bits.h"
#include "base/srgb.h"
#include "render/target/depth.h"
#include "shader/program/program.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

uint32_t differential_word(struct differential *d)
{
    d->seed ^= d->seed >> 12;
    d->seed ^= d->seed << 25;
    d->seed ^= d->seed >> 27;
    return (uint32_t)(d->seed * 0x2545f4914f6cdd1dull >> 32);
}

uint32_t differential_below(struct differential *d, uint32_t limit)
{
    return differential_word(d) % limit;
}

float differential_between(struct differential *d, float low, float high)
{
    return low + (high - low) * (float)(differential_word(d) >> 8) * 0x1p-24f;
}

static float special(struct differential *d)
{
    static const uint32_t edges[] = {0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x007fffff, 0x00800000,
                                     0x7f7fffff, 0xff7fffff, 0x7f800000, 0xff800000, 0x7fc00000, 0xffc12345,
                                     0x7f800001, 0x3f800000, 0xbf800000, 0x3f000000, 0x4b000000, 0x4f000000,
                                     0xcf000000, 0x5f000000, 0x34000000, 0x2b800000, 0x7149f2ca};
    uint32_t bits = differential_below(d, 8) ? edges[differential_below(d, sizeof edges / sizeof *edges)]
                                             : differential_word(d);
    return bits_to_float(bits);
}

/* A plausible value; in wild inputs, one in eight is anything. */
float differential_number(struct differential *d, float low, float high)
{
    return d->wild && !differential_below(d, 8) ? special(d) : differential_between(d, low, high);
}

void differential_fill_numbers(struct differential *d, void *memory, size_t bytes, float low, float high)
{
    for (size_t at = 0; at + 4 <= bytes; at += 4) {
        float value = differential_number(d, low, high);
        memcpy((uint8_t *)memory + at, &value, sizeof value);
    }
}

void differential_fill_words(struct differential *d, void *memory, size_t bytes)
{
    for (size_t at = 0; at + 4 <= bytes; at += 4) {
        uint32_t value = differential_word(d);
        memcpy((uint8_t *)memory + at, &value, sizeof value);
    }
}

/* A multiple of 16 lanes: usually small, sometimes 0 or the maximum. */
static uint32_t lane_count(struct differential *d, uint32_t capacity)
{
    return differential_below(d, 8) ? 16 * (1 + differential_below(d, 4))
                                    : 16 * differential_below(d, capacity / 16 + 1);
}

/* --- The job --- */

static void make_lights(struct differential *d)
{
    differential_fill_numbers(d, d->job.base_color, sizeof d->job.base_color, -0.2f, 1);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        struct light_job *light = &d->job.light[i];
        differential_fill_numbers(d, light->position, sizeof light->position, -3, 3);
        differential_fill_numbers(d, light->diffuse, sizeof light->diffuse, -0.1f, 1);
        differential_fill_numbers(d, light->ambient, sizeof light->ambient, 0, 0.3f);
        light->range = differential_number(d, 0, 8);
        light->attenuation0 = differential_number(d, 0, 1);
        light->attenuation1 = differential_number(d, 0, 1);
        light->attenuation2 = differential_number(d, 0, 1);
        differential_fill_numbers(d, light->specular, sizeof light->specular, 0, 1);
        differential_fill_numbers(d, light->axis, sizeof light->axis, -1, 1);
        light->outer_cosine = differential_number(d, -0.5f, 0.5f);
        light->cone_scale = differential_number(d, 0.5f, 4);
        light->falloff = differential_below(d, 4) ? differential_number(d, 0, 4) : 1;
    }
    differential_fill_numbers(d, d->job.ambient_light, sizeof d->job.ambient_light, 0, 1);
    d->job.power = differential_below(d, 4) ? differential_number(d, 0, 30) : 0;
    d->job.specular_alpha = differential_number(d, 0, 1);
}

/* The inputs of vertex blending. The palette ends at a fence. */
static void make_skin(struct differential *d)
{
    differential_fill_numbers(d, d->job.projection, sizeof d->job.projection, -2, 2);
    differential_fill_numbers(d, d->job.blend, sizeof d->job.blend, -1, 1);
    differential_fill_numbers(d, d->job.texture_matrix, sizeof d->job.texture_matrix, -1, 1);
    differential_fill_numbers(d, d->palette, PALETTE_BYTES, -1, 1);
    d->job.palette = (const void *)d->palette;
    d->job.tween_factor = differential_number(d, -0.5f, 1.5f);
}

/* Every vertex at the camera and every light at exactly its range, where "within" and "below" differ. */
static void put_lights_at_their_range(struct differential *d)
{
    memset(d->job.world_view, 0, sizeof d->job.world_view);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        struct light_job *light = &d->job.light[i];
        memset(light->position, 0, sizeof light->position);
        light->position[differential_below(d, 3)] = light->range = (float)(1u << differential_below(d, 4));
    }
}

static void make_job(struct differential *d)
{
    struct job *job = &d->job;
    memset(job, 0, sizeof *job);
    job->srgb = &srgb_tables;
    differential_fill_numbers(d, job->world_view_projection, sizeof job->world_view_projection, -2, 2);
    differential_fill_numbers(d, job->world_view, sizeof job->world_view, -2, 2);
    differential_fill_numbers(d, job->normal, sizeof job->normal, -2, 2);
    make_lights(d);
    make_skin(d);
    if (!differential_below(d, 8))
        put_lights_at_their_range(d);
    job->guard_left = differential_between(d, -50, 1);
    job->guard_right = differential_between(d, -1, 50);
    job->guard_bottom = differential_between(d, -50, 1);
    job->guard_top = differential_between(d, -1, 50);
    job->scale_x = differential_number(d, 1, 100000);
    job->scale_y = differential_number(d, -100000, -1);
    job->offset_x = differential_number(d, 0, 100000);
    job->offset_y = differential_number(d, 0, 100000);
    job->depth_scale = differential_number(d, 0.1f, 1);
    job->depth_offset = differential_number(d, -0.1f, 0.5f);
    job->depth_bias = differential_number(d, -0.1f, 0.1f);
    job->depth_bias_slope = differential_number(d, -2, 2);
    job->point_size = differential_number(d, 0, 64);
    job->point_least = differential_number(d, 0, 4);
    job->point_most = differential_number(d, 2, 40);
    differential_fill_numbers(d, job->point_scale, sizeof job->point_scale, 0, 1);
    job->viewport_height = differential_number(d, 1, 100);
    differential_fill_numbers(d, job->clip_plane, sizeof job->clip_plane, -2, 2);
}

/* --- Shaders --- */

/* The registers of the first shader models are random. The other registers of the device repeat them. */
static void fill_registers(struct differential *d, float (*floats)[4], int32_t (*integers)[4])
{
    enum { RANDOM_FLOATS = 256, RANDOM_INTEGERS = 16 };
    differential_fill_numbers(d, floats, RANDOM_FLOATS * sizeof *floats, -2, 2);
    for (int i = 0; i < RANDOM_INTEGERS; i++) {
        integers[i][0] = (int32_t)differential_below(d, 4);
        integers[i][1] = (int32_t)differential_below(d, 12);
        integers[i][2] = (int32_t)differential_below(d, 7) - 3;
        integers[i][3] = 0;
    }
    for (int i = RANDOM_FLOATS; i < CONSTANT_FLOATS; i += RANDOM_FLOATS)
        memcpy(floats[i], floats[0], RANDOM_FLOATS * sizeof *floats);
    for (int i = RANDOM_INTEGERS; i < CONSTANT_INTEGERS; i += RANDOM_INTEGERS)
        memcpy(integers[i], integers[0], RANDOM_INTEGERS * sizeof *integers);
}

/* The last constant ends at the fence. Loops are short, and most relative addresses are small. */
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

/* The last word of the last vertex that is fetched ends at the fence, or up to three bytes before it: so far
 * routines may read. Vertices are any number of bytes apart. */
static void make_stream(struct differential *d, uint8_t *stream, struct attribute_job *job, int format,
                        uint32_t last)
{
    job->stride = (int32_t)differential_below(d, STRIDE_MAXIMUM + 1);
    uint32_t words = (key_vertex_types[format].bytes + 3u) / 4;
    job->data = stream + STREAM_BYTES - last * (uint32_t)job->stride - 4 * words;
    if (!differential_below(d, 4))
        job->data -= differential_below(d, 4);
    if (key_vertex_types[format].encoding != ENCODING_FLOAT)
        differential_fill_words(d, stream, STREAM_BYTES);
    else
        differential_fill_numbers(d, stream, STREAM_BYTES, -2, 2);
    if (!differential_below(d, 16)) /* zero vectors, which have no reciprocal length */
        memset(stream, 0, STREAM_BYTES);
}

static void make_vertex_inputs(struct differential *d, const struct vertex_key *key)
{
    uint32_t last = 0;
    d->count = lane_count(d, VERTEX_CAPACITY);
    for (uint32_t i = 0; i < d->count; i++) {
        differential_indices(d)[i] = differential_below(d, VERTEX_CAPACITY);
        last = differential_indices(d)[i] > last ? differential_indices(d)[i] : last;
    }
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        make_stream(d, d->stream[a], &d->job.attribute[a], key->attribute[a], last);
    for (int i = 0; i < INPUTS && key_program(key->shader); i++) /* attributes are not read then */
        make_stream(d, d->stream[i], &d->job.input[i], key->input[i], last);
    for (int i = 0; i < 2 && !key_program(key->shader) && key->varying[VARYING_blending]; i++)
        make_stream(d, d->stream[ATTRIBUTE_TEXCOORD6 + i], &d->job.input[i], key->input[i], last);
}

/* --- Triangles --- */

static void make_setup_inputs(struct differential *d, const struct setup_key *key)
{
    d->layout = layout_of_setup(key);
    d->count = lane_count(d, SETUP_CAPACITY);
    for (int slot = 0; slot < SLOT_COUNT; slot++)
        differential_fill_numbers(d, d->initial.vertices + slot * VERTEX_CAPACITY, VERTEX_SLOT_BYTES,
                                  slot == SLOT_W ? 0.5f : -2, slot == SLOT_W ? 4 : 2);
    for (int i = 0; i < 4 * SETUP_CAPACITY; i++)
        differential_indices(d)[i] = 4 * differential_below(d, VERTEX_CAPACITY);
    for (int i = 4 * SETUP_CAPACITY; i < SETUP_INDEX_ROWS * SETUP_CAPACITY; i++)
        differential_indices(d)[i] = -differential_below(d, 2);
    for (int i = 0; i < SETUP_CAPACITY && key->smooth;
         i++) { /* smooth edges, or the width of a smooth line */
        if (key->primitive == PRIMITIVE_TRIANGLE)
            differential_indices(d)[i + 3 * SETUP_CAPACITY] = differential_below(d, 8);
        differential_indices(d)[i + 4 * SETUP_CAPACITY] = differential_below(d, 2000);
    }
    for (int i = 0; i < SETUP_CAPACITY; i++)
        if (!differential_below(d, 16)) /* without area */
            differential_indices(d)[i] =
                differential_indices(d)[i + SETUP_CAPACITY * (1 + (int)differential_below(d, 2))];
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
    hash = XXH3_64bits_withSeed(&d->blit, sizeof d->blit, hash);
    hash = XXH3_64bits_withSeed(d->blit_input + BLIT_INPUT_BYTES - d->blit_input_bytes, d->blit_input_bytes,
                                hash);
    hash =
        XXH3_64bits_withSeed(d->blit_rows + BLIT_ROWS_BYTES - d->blit_rows_bytes, d->blit_rows_bytes, hash);
    hash = XXH3_64bits_withSeed(d->index_words, sizeof d->index_words, hash);
    hash = XXH3_64bits_withSeed(&d->entries, sizeof d->entries, hash);
    return XXH3_64bits_withSeed(d->triangles, sizeof d->triangles, hash);
}

void differential_fill(struct differential *d, enum unit unit, const union key *key, uint64_t seed)
{
    d->seed = seed * 0x9e3779b97f4a7c15ull | 1;
    d->wild = (int)differential_below(d, 2);
    memset(&d->initial, UNTOUCHED, sizeof d->initial);
    d->blit_input_bytes = d->blit_rows_bytes = 0;
    make_job(d);
    make_constants(d, unit, key);
    switch (unit) {
    case UNIT_BLIT: differential_blit_inputs(d, &key->blit); break;
    case UNIT_VERTEX:
        make_vertex_inputs(d, &key->vertex);
        differential_vertex_textures(d, &key->vertex);
        break;
    case UNIT_SETUP: make_setup_inputs(d, &key->setup); break;
    default: differential_pixel_inputs(d, &key->pixel); break;
    }
    if (d->layout.stride > RECORD_MAXIMUM)
        abort();
    d->inputs = differential_hash(d);
}
