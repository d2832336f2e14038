/* The bytes of a job that are read. A queue of draws that each have a job of their own copies only these. */
#include "render/derive/derive_part.h"
#include "shader/program/program.h"

static const struct {
    uint16_t begin, end;
} range[JOB_PARTS] = {
#define JOB_PART(name, keys, first, last, meaning)                                                           \
    {offsetof(struct job, first), offsetof(struct job, last) + sizeof((struct job *)0)->last},
#include "def/job_part.def"
#undef JOB_PART
};

static void add_run(struct live_job *live, size_t begin, size_t end)
{
    live->run[live->count].begin = (uint16_t)begin;
    live->run[live->count++].end = (uint16_t)end;
}

static void add_part(struct live_job *live, enum derived_part part)
{
    add_run(live, range[part].begin, range[part].end);
}

/* From the first to the last element of an array that the key uses. */
static void add_elements(struct live_job *live, size_t array, size_t bytes, const uint8_t *field,
                         unsigned count)
{
    unsigned first = key_next(field, 0, count), last = count;
    if (first == count)
        return;
    while (!field[last - 1])
        last--;
    add_run(live, array + first * bytes, array + last * bytes);
}

/* Fixed-function stages read constants and displacements. So do ps_1_x shaders, which refer to stages. */
static void add_stages(struct live_job *live, const struct pixel_key *pixel)
{
    uint32_t shader = key_program(pixel->shader);
    if (shader && shader_major(program_find(shader)->model) == 1)
        add_part(live, PART_STAGES);
    if (shader || !pixel->stages)
        return;
    add_run(live, offsetof(struct job, texture_factor), offsetof(struct job, bump));
    add_elements(live, offsetof(struct job, bump), sizeof(struct bump_job), pixel->bump, TEXTURE_STAGES);
}

/* The small parts at the start of the job are read by nearly every routine, so they are always live. */
void derive_live(const struct vertex_key *vertex, const struct pixel_key *pixel, struct live_job *live)
{
    live->count = 0;
    add_run(live, 0, offsetof(struct job, world_view_projection));
    if (!key_program(vertex->shader))
        add_part(live, PART_TRANSFORM);
    add_elements(live, offsetof(struct job, attribute), sizeof(struct attribute_job), vertex->attribute,
                 ATTRIBUTE_COUNT);
    add_elements(live, offsetof(struct job, input), sizeof(struct attribute_job), vertex->input, INPUTS);
    add_stages(live, pixel);
    add_elements(live, offsetof(struct job, texture), sizeof(struct texture_job), pixel->texture,
                 PIXEL_SAMPLERS);
    add_elements(live, offsetof(struct job, texture[PIXEL_SAMPLERS]), sizeof(struct texture_job),
                 vertex->texture, VERTEX_SAMPLERS);
    if (pixel->clip_mask)
        add_run(live, offsetof(struct job, clip_mask),
                offsetof(struct job, clip_mask) + sizeof(struct clip_mask_job));
    if (vertex->lighting)
        add_part(live, PART_LIGHTS);
    add_elements(live, offsetof(struct job, texture_matrix), sizeof(float[4][4]), vertex->texture_matrix,
                 TEXTURE_STAGES);
    if (vertex->matrices)
        add_part(live, PART_BLEND);
    if (vertex->clip_planes)
        add_part(live, PART_CLIP_PLANES);
    if (pixel->stencil_values)
        add_part(live, PART_CCW_STENCIL);
}
