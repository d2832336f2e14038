/* Runs a trial's vertex shader as a routine of an engine. Operands are the inputs v1 to v3, and results are
 * the texture coordinates of the vertices. */
#include "tests/support/trial/trial.h"

#include "machine/code.h"
#include "contract/arguments.h"
#include "engines/list.h"
#include "shader/program/program.h"

#include <string.h>

enum { BATCH = VERTEX_CAPACITY, CODE_BYTES = 1 << 24 };

static alignas(64) float batch[SLOT_COUNT * VERTEX_CAPACITY];
static struct code_arena *arena;

/* All trials use one arena, which is never freed. */
static void open_arena(void)
{
    struct error error = {{0}};
    if (!arena)
        arena = code_create(CODE_BYTES, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
}

static void make_key(const struct trial_memory *memory, struct vertex_key *key)
{
    const struct trial *trial = memory->trial;
    key_set_program(key->shader, memory->program->number);
    key->booleans[0] = (uint8_t)trial->booleans;
    key->booleans[1] = (uint8_t)(trial->booleans >> 8);
    key->legacy = (uint8_t)trial->legacy;
    for (int o = 1; o <= TRIAL_OPERANDS; o++)
        key->input[o] = ATTRIBUTE_FORMAT_FLOAT4;
    for (unsigned r = 0; r < trial->results; r++)
        for (int c = 0; c < 4; c++) {
            int port = PORT_CHANNEL + (int)r;
            key->link[4 * port + c] =
                (uint8_t)(LINK_OUTPUT + trial_cell(memory->program, r) - CELL_OUTPUT + (unsigned)c);
            key->varying[port_varying(port, c)] = 1;
        }
}

static void make_job(const struct trial_memory *memory, struct job *job)
{
    memset(job, 0, sizeof *job);
    job->constants[STAGE_VERTEX] = (const float *)memory->constants;
    for (int o = 1; o <= TRIAL_OPERANDS; o++)
        job->input[o] = (struct attribute_job){.data = (const uint8_t *)memory->trial->operands->v[o - 1],
                                               .stride = sizeof(struct trial_operands)};
}

static void take_results(const struct trial *trial, unsigned first, struct trial_results *results)
{
    for (unsigned i = 0; i < BATCH && first + i < trial->sets; i++)
        for (unsigned r = 0; r < trial->results; r++)
            for (int c = 0; c < 4; c++) {
                int port = PORT_CHANNEL + (int)r;
                int slot = varying_slot[port_varying(port, c)] + port_component(port, c);
                results[first + i].v[r][c] = batch[slot * VERTEX_CAPACITY + (int)i];
            }
}

void trial_run_vertices(const struct trial_memory *memory, const struct engine *engine,
                        struct trial_results *results)
{
    static union key key;
    static struct job job;
    alignas(64) uint32_t index[BATCH];
    struct error error = {{0}};
    const struct trial *trial = memory->trial;
    if (!engine->without_arena)
        open_arena();
    memset(&key, 0, sizeof key);
    make_key(memory, &key.vertex);
    make_job(memory, &job);
    struct routine *routine = engine_build(engine, arena, UNIT_VERTEX, &key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    for (unsigned first = 0; first < trial->sets; first += BATCH) {
        unsigned count = trial->sets - first < BATCH ? trial->sets - first : BATCH;
        uint32_t padded = (count + LANES_MAXIMUM - 1) / LANES_MAXIMUM * LANES_MAXIMUM;
        for (uint32_t i = 0; i < padded; i++)
            index[i] = first + (i < count ? i : count - 1);
        struct vertex_arguments call = {&job, index, batch, padded};
        routine->run(&call, routine);
        take_results(trial, first, results);
    }
    engine->free(arena, routine);
}
