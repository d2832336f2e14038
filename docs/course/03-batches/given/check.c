/* The program of lab 3's check.
 *
 *   check bytes              batch_bytes
 *   check same               compares batch_run with naive_run for many sizes and counts
 *   check run BATCH COUNT    executes the shader for 512 * COUNT elements; BATCH 0: with naive_run
 *
 * Ends with 1, after a line with what was expected, if something is wrong. */
#include "machine.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT_MAXIMUM = 4096, GUARD = 64 };

static uint32_t state = 1;

static uint32_t random_word(void)
{
    state = state * 1664525 + 1013904223;
    return state >> 8;
}

static void fill_inputs(float input[INPUTS][COUNT_MAXIMUM])
{
    for (int i = 0; i < INPUTS; i++)
        for (int e = 0; e < COUNT_MAXIMUM; e++)
            input[i][e] = (float)random_word() / 8388608 - 1;
}

/* A program that writes all registers, one after the other, each from earlier ones. */
static struct program make_program(void)
{
    struct program program = {.steps = 0};
    for (int result = INPUTS; result < REGISTERS; result++)
        program.step[program.steps++] = (struct step){.operation = (enum operation)(random_word() % 4),
                                                      .result = result,
                                                      .a = result - 1 - (int)(random_word() % 3),
                                                      .b = (int)(random_word() % (unsigned)result),
                                                      .c = (int)(random_word() % (unsigned)result)};
    return program;
}

static float input[INPUTS][COUNT_MAXIMUM], expected[COUNT_MAXIMUM], found[COUNT_MAXIMUM + GUARD];
static float frame[REGISTERS * COUNT_MAXIMUM + GUARD];
static const float *const inputs[INPUTS] = {input[0], input[1], input[2], input[3]};

static int compare(const struct program *program, size_t batch, size_t count)
{
    for (size_t i = 0; i < sizeof frame / sizeof *frame; i++)
        frame[i] = 12345;
    memset(found, 0x7f, sizeof found);
    naive_run(program, inputs, expected, count);
    batch_run(program, batch, frame, inputs, found, count);
    for (size_t e = 0; e < count; e++)
        if (memcmp(found + e, expected + e, sizeof *found)) {
            printf("batches of %zu, %zu elements: element %zu is %.9g, expected %.9g\n", batch, count, e,
                   (double)found[e], (double)expected[e]);
            return 1;
        }
    float untouched;
    memset(&untouched, 0x7f, sizeof untouched);
    if (memcmp(found + count, &untouched, sizeof untouched)) {
        printf("batches of %zu, %zu elements: output %zu was written too\n", batch, count, count);
        return 1;
    }
    for (size_t i = REGISTERS * batch; i < sizeof frame / sizeof *frame; i++)
        if (frame[i] != 12345) {
            printf("batches of %zu: number %zu of the frame was written, expected only 0 to %zu\n", batch, i,
                   REGISTERS * batch - 1);
            return 1;
        }
    return 0;
}

static int check_same(void)
{
    static const size_t batches[] = {1, 3, 4, 16, 64, 250, 1024}, counts[] = {1, 7, 64, 1000, 3333};
    fill_inputs(input);
    for (unsigned b = 0; b < sizeof batches / sizeof *batches; b++)
        for (unsigned c = 0; c < sizeof counts / sizeof *counts; c++) {
            struct program program = make_program();
            if (compare(&program, batches[b], counts[c]))
                return 1;
        }
    return 0;
}

static int check_bytes(void)
{
    for (size_t batch = 1; batch <= 4096; batch *= 4)
        if (batch_bytes(batch) != batch * REGISTERS * sizeof(float)) {
            printf("batch_bytes(%zu) is %zu, expected another number\n", batch, batch_bytes(batch));
            return 1;
        }
    return 0;
}

static int run(size_t batch, long count)
{
    state = 1;
    fill_inputs(input);
    struct program program = make_program();
    /* The same 1024 elements again, so that inputs and outputs stay in the cache. */
    for (long i = 0; i < (count + 1) / 2; i++)
        if (batch)
            batch_run(&program, batch, frame, inputs, found, 1024);
        else
            naive_run(&program, inputs, found, 1024);
    return 0;
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    if (!strcmp(command, "bytes"))
        return check_bytes();
    if (!strcmp(command, "run") && count == 4)
        return run((size_t)atol(argument[2]), atol(argument[3]));
    return check_same();
}
