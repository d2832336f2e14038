#include "machine.h"

#include <string.h>

size_t batch_bytes(size_t batch)
{
    return batch * REGISTERS * sizeof(float);
}

/* One decision for all elements of the batch. Register r of element e is frame[r * batch + e]. */
static void execute(const struct step *step, float *frame, size_t batch, size_t count)
{
    const float *a = frame + (size_t)step->a * batch, *b = frame + (size_t)step->b * batch;
    const float *c = frame + (size_t)step->c * batch;
    float *result = frame + (size_t)step->result * batch;
    switch (step->operation) {
    case OPERATION_ADD:
        for (size_t e = 0; e < count; e++)
            result[e] = a[e] + b[e];
        break;
    case OPERATION_MULTIPLY:
        for (size_t e = 0; e < count; e++)
            result[e] = a[e] * b[e];
        break;
    case OPERATION_MULTIPLY_ADD:
        for (size_t e = 0; e < count; e++)
            result[e] = a[e] * b[e] + c[e];
        break;
    case OPERATION_MAXIMUM:
        for (size_t e = 0; e < count; e++)
            result[e] = a[e] > b[e] ? a[e] : b[e];
        break;
    }
}

static void run_one(const struct program *program, size_t batch, float *frame,
                    const float *const input[INPUTS], size_t first, float *output, size_t count)
{
    for (int i = 0; i < INPUTS; i++)
        memcpy(frame + (size_t)i * batch, input[i] + first, count * sizeof(float));
    for (int i = 0; i < program->steps; i++)
        execute(program->step + i, frame, batch, count);
    memcpy(output + first, frame + (REGISTERS - 1) * batch, count * sizeof(float));
}

void batch_run(const struct program *program, size_t batch, float *frame, const float *const input[INPUTS],
               float *output, size_t count)
{
    for (size_t first = 0; first < count; first += batch) {
        size_t left = count - first;
        run_one(program, batch, frame, input, first, output, left < batch ? left : batch);
    }
}
