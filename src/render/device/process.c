/* Vertices after transformation: the vertex routine is run by itself, and its outputs are returned. */
#include "base/bits.h"
#include "contract/lane.h"
#include "machine/mxcsr.h"
#include "render/derive/derive.h"
#include "render/device/device_part.h"
#include "shader/program/program.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PROCESS_VERTICES = VERTEX_CAPACITY, PROCESS_ALIGNMENT = 64 };

/* All that a run of the routine reads and writes. */
struct process {
    alignas(PROCESS_ALIGNMENT) float slot[SLOT_COUNT][VERTEX_CAPACITY];
    alignas(PROCESS_ALIGNMENT) uint32_t index[VERTEX_CAPACITY];
    struct palette_entry palette[WORLD_MATRICES];
    struct job job;
    union key key;
    float constants[]; /* of the vertex shader */
};

/* --- What the routine reads --- */

static struct process *create_process(const struct state *state, struct error *error)
{
    const struct program *program = state->program[STAGE_VERTEX];
    size_t bytes = sizeof(struct process) + (program ? program_constant_bytes(program) : 0);
    struct process *process =
        aligned_alloc(PROCESS_ALIGNMENT, (bytes + PROCESS_ALIGNMENT - 1) & -(size_t)PROCESS_ALIGNMENT);
    if (!process) {
        error_set(error, "out of memory for processed vertices");
        return NULL;
    }
    memset(&process->key, 0, sizeof process->key);
    derive_process_key(state, &process->key.vertex);
    derive_process_job(state, &process->key.vertex, &process->job);
    if (process->key.vertex.indexed_matrices)
        derive_palette(state, process->palette);
    process->job.palette = process->palette;
    if (program)
        program_write_constants(program, (const float(*)[4])state->registers[STAGE_VERTEX]->floats,
                                (const int32_t(*)[4])state->registers[STAGE_VERTEX]->integers,
                                process->constants);
    process->job.constants[STAGE_VERTEX] = process->constants;
    return process;
}

/* Textures of the vertex shader have the texels that queued draws leave. */
static void store_textures(struct triptych_device *device, const struct vertex_key *key)
{
    for (int i = 0; i < VERTEX_SAMPLERS; i++)
        if (key->texture[i])
            device_store_texture(device, device->state.texture[PIXEL_SAMPLERS + i]);
}

/* --- What it writes --- */

/* From clip space to the window, in the pixels that positions in the window have: the job's position is that
 * of the rasterizer, whose pixel centres are at halves. */
static void project_vertex(const struct state *state, const float clip[4], float position[4])
{
    const struct triptych_viewport *v = &state->viewport;
    double w = 1 / (double)clip[3], half_width = (double)v->width / 2, half_height = (double)v->height / 2;
    position[0] = (float)((double)v->x + half_width + (double)clip[0] * w * half_width);
    position[1] =
        (float)((double)v->y + half_height + derive_window_up(state) * ((double)clip[1] * w * half_height));
    position[2] =
        (float)((double)clip[2] * w * ((double)v->depth_far - (double)v->depth_near) + (double)v->depth_near);
    position[3] = (float)w;
}

static void take_vertex(const struct process *process, const struct state *state, uint32_t lane,
                        struct triptych_processed_vertex *out)
{
    const struct vertex_key *key = &process->key.vertex;
    for (int c = 0; c < 4; c++) {
        out->clip[c] = out->position[c] = process->slot[SLOT_X + c][lane];
        out->color[0][c] = process->slot[SLOT_diffuse + c][lane];
        out->color[1][c] = process->slot[SLOT_specular + c][lane];
    }
    for (int channel = 0; channel < TEXTURE_STAGES; channel++)
        for (int c = 0; c < 4; c++) {
            int port = PORT_CHANNEL + channel,
                slot = varying_slot[port_varying(port, c)] + port_component(port, c);
            out->texcoord[channel][c] = process->slot[slot][lane];
        }
    bool sized = key->point_size != POINT_SIZE_CONSTANT || key->size_link >= LINK_OUTPUT;
    out->point_size = sized ? process->slot[SLOT_POINT_SIZE][lane] : process->job.point_size;
    bool without = key_program(key->shader) && state->value[STATE_fogenable]; /* the shader gives no fog */
    out->fog = key->varying[VARYING_fog] ? process->slot[SLOT_fog][lane] : !without;
    if (key->attribute[ATTRIBUTE_POSITIONT] == ATTRIBUTE_FORMAT_NONE)
        project_vertex(state, out->clip, out->position);
}

/* The payload of NaN is not defined until it is stored (docs/shader-semantics.md). */
static void store_nan(struct triptych_processed_vertex *vertex)
{
    enum { NAN_BITS = 0x7fc00000 };
    float number[sizeof *vertex / sizeof(float)];
    memcpy(number, vertex, sizeof number);
    for (unsigned i = 0; i < sizeof number / sizeof *number; i++)
        if (isnan(number[i]))
            number[i] = bits_to_float(NAN_BITS);
    memcpy(vertex, number, sizeof number);
}

/* --- Runs --- */

/* Runs the routine for up to PROCESS_VERTICES vertices; lanes up to the end of its last step repeat the last
 * one. */
static void run(struct process *process, const struct routine *routine, uint32_t first, uint32_t count)
{
    uint32_t padded = (count + routine->lanes - 1) & -routine->lanes;
    for (uint32_t i = 0; i < padded; i++)
        process->index[i] = first + (i < count ? i : count - 1);
    struct vertex_arguments call = {&process->job, process->index, process->slot[0], padded};
    unsigned saved = mxcsr_enter();
    routine_run(routine, &call, count);
    mxcsr_leave(saved);
}

static enum triptych_result run_all(struct triptych_device *device, struct process *process, uint32_t first,
                                    uint32_t count, struct triptych_processed_vertex *out,
                                    struct error *error)
{
    errno = 0;
    store_textures(device, &process->key.vertex);
    const struct routine *routine = cache_acquire(device->cache, UNIT_VERTEX, &process->key, error);
    if (!routine)
        return device_refusal(TRIPTYCH_ENGINE_FAILED);
    for (uint32_t done = 0; done < count;) {
        uint32_t some = count - done < PROCESS_VERTICES ? count - done : PROCESS_VERTICES;
        run(process, routine, first + done, some);
        for (uint32_t i = 0; i < some; i++) {
            take_vertex(process, &device->state, i, out + done + i);
            store_nan(out + done + i);
        }
        done += some;
    }
    cache_release(device->cache, routine);
    return TRIPTYCH_OK;
}

static enum triptych_result check(struct triptych_device *device, uint32_t first, uint32_t count,
                                  struct error *error)
{
    enum triptych_result result = device_check_vertex_input(device, error);
    if (result == TRIPTYCH_OK && (uint64_t)first + count > (uint64_t)UINT32_MAX + 1) {
        error_set(error, "vertices %" PRIu32 " to %" PRIu64 ": expected them below 2^32", first,
                  (uint64_t)first + count - 1);
        return TRIPTYCH_BAD_CALL;
    }
    return result;
}

enum triptych_result device_process_vertices(struct triptych_device *device, uint32_t first, uint32_t count,
                                             struct triptych_processed_vertex *out, struct error *error)
{
    enum triptych_result result = check(device, first, count, error);
    if (result != TRIPTYCH_OK || !count)
        return result;
    device_use_streams(device);
    struct process *process = create_process(&device->state, error);
    if (!process)
        return TRIPTYCH_NO_MEMORY;
    result = device_check_elements(&device->state, &process->key.vertex, (uint64_t)first + count - 1, error);
    if (result == TRIPTYCH_OK)
        result = run_all(device, process, first, count, out, error);
    free(process);
    return result;
}
