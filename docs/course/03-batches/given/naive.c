#include "machine.h"

static void execute(const struct step *step, float *registers)
{
    float a = registers[step->a], b = registers[step->b], *result = registers + step->result;
    switch (step->operation) {
    case OPERATION_ADD: *result = a + b; break;
    case OPERATION_MULTIPLY: *result = a * b; break;
    case OPERATION_MULTIPLY_ADD: *result = a * b + registers[step->c]; break;
    case OPERATION_MAXIMUM: *result = a > b ? a : b; break;
    }
}

void naive_run(const struct program *program, const float *const input[INPUTS], float *output, size_t count)
{
    float registers[REGISTERS];
    for (size_t element = 0; element < count; element++) {
        for (int i = 0; i < INPUTS; i++)
            registers[i] = input[i][element];
        for (int i = 0; i < program->steps; i++)
            execute(program->step + i, registers);
        output[element] = registers[REGISTERS - 1];
    }
}
