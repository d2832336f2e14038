/* Operands of trials as numbers, for references (tests/support/trial/trial.h). */
#ifndef TESTS_SPEC_SHADER_OPERAND_H
#define TESTS_SPEC_SHADER_OPERAND_H

#include "tests/support/trial/trial.h"

typedef const struct trial_operands *operands;

/* Returns a component of an operand. A denormal is a zero of its sign. */
static inline double at(operands o, int operand, int c)
{
    return trial_flush(o->v[operand][c]);
}

/* Returns the value, rounded to binary32 as trial_round() does. */
static inline double rounded(double value)
{
    return (double)trial_round(value);
}

static inline void copy(operands o, int operand, double r[4])
{
    for (int c = 0; c < 4; c++)
        r[c] = at(o, operand, c);
}

#endif
