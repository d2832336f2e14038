/* The arithmetic instructions of shaders: a row for each. Its reference computes the definition in
 * docs/shader-semantics.md in double precision. */
#ifndef TESTS_SUPPORT_TRIAL_TRIAL_ARITHMETIC_H
#define TESTS_SUPPORT_TRIAL_TRIAL_ARITHMETIC_H

#include "trial.h"

#include <stddef.h>

#define ARITHMETIC_BITS_21 (1.0 / (1 << 21)) /* the standard's bound for exp and log */
#define ARITHMETIC_BITS_15 (1.0 / (1 << 15)) /* and of pow */
#define ARITHMETIC_SERIES                                                                                    \
    "def c20, -1.5500992e-006, -2.1701389e-005, 0.0026041667, 0.00026041668\n"                               \
    "def c21, -0.020833334, -0.12500000, 1.0, 0.50000000\n"

/* Flags of a row: only ordinary numbers, only in models 1, only in models 2 and 3. */
enum { ARITHMETIC_ORDINARY = 1, ARITHMETIC_ONLY_1 = 2, ARITHMETIC_NOT_1 = 4 };

enum { ARITHMETIC_ROWS = 38, ARITHMETIC_MODELS = 7 };

/* In a body, a line with @ is repeated four times, once for each component. */
struct arithmetic_row {
    enum shader_opcode opcode;
    const char *body;
    trial_reference *reference;
    double relative, absolute;
    int flags;
    const char *setup;
};

extern const struct arithmetic_row arithmetic_rows[ARITHMETIC_ROWS];

/* Numbers of models of every generation. */
extern const int arithmetic_models[ARITHMETIC_MODELS];

/* Copies `body` to `text`, with four lines instead of each line with @. */
void arithmetic_unfold(const char *body, char *text, size_t bytes);

#endif
