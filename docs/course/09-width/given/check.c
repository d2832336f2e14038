/* The program of lab 9's check.
 *
 *   check split            the recording in two parts
 *   check same LANES       compares the outputs of the code with those of an interpreter, bit by bit
 *   check code LANES       prints the instructions of the code, its moves to and from the frame, its bytes
 *   check run LANES COUNT  computes COUNT blocks of 16 elements
 *
 * Ends with 1, after a line with what was expected, if something is wrong; with 3 if the processor has no
 * AVX. */
#define _DEFAULT_SOURCE
#include "width.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum { CODE_BYTES = 32768, GUARD = 64 };

/* --- The recording in two parts --- */

static bool is_part(const struct recorded *whole, const struct recorded *part, int number)
{
    bool two = whole->operation == OPERATION_MULTIPLY || whole->operation == OPERATION_ADD;
    bool one = two || whole->operation == OPERATION_STORE;
    return part->operation == whole->operation && part->index == whole->index && part->part == number &&
           (!one || part->left == 2 * whole->left + number) &&
           (!two || part->right == 2 * whole->right + number);
}

static int check_split(void)
{
    static struct recording whole, parts;
    shader_record(&whole);
    split(&whole, &parts);
    if (parts.count != 2 * whole.count) {
        printf("split gives %d operations, expected %d\n", parts.count, 2 * whole.count);
        return 1;
    }
    for (int n = 0; n < parts.count; n++)
        if (!is_part(whole.at + n / 2, parts.at + n, n % 2)) {
            printf("operation %d of the parts: expected part %d of operation %d, with the same part of its "
                   "operands\n",
                   n, n % 2, n / 2);
            return 1;
        }
    return 0;
}

/* --- Execution --- */

struct block {
    float in[INPUTS * BLOCK], out[OUTPUTS * BLOCK + GUARD], frame[FRAME_FLOATS];
};

static void fill(float *at, size_t count)
{
    static uint32_t state = 1;
    for (size_t i = 0; i < count; i++)
        at[i] = (float)((state = state * 1664525 + 1013904223) >> 8) / 8388608 - 1;
}

static void interpret(const struct recording *r, struct block *b)
{
    static float value[RECORDING_MAXIMUM];
    for (int e = 0; e < BLOCK; e++)
        for (int n = 0; n < r->count; n++) {
            const struct recorded *o = r->at + n;
            switch (o->operation) {
            case OPERATION_LOAD: value[n] = b->in[BLOCK * o->index + e]; break;
            case OPERATION_MULTIPLY: value[n] = value[o->left] * value[o->right]; break;
            case OPERATION_ADD: value[n] = value[o->left] + value[o->right]; break;
            case OPERATION_STORE: b->out[BLOCK * o->index + e] = value[o->left]; break;
            }
        }
}

static uint8_t *make(int lanes, size_t *bytes)
{
    static struct recording recording;
    uint8_t *code = mmap(NULL, CODE_BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    shader_record(&recording);
    *bytes = code == MAP_FAILED ? 0 : generate(&recording, lanes, code, CODE_BYTES);
    if (!*bytes || *bytes > CODE_BYTES) {
        printf("generate gives %zu bytes for %d lanes, expected 1 to %d\n", *bytes, lanes, CODE_BYTES);
        return NULL;
    }
    return mprotect(code, CODE_BYTES, PROT_READ | PROT_EXEC) ? NULL : code;
}

static void execute(const uint8_t *code, int lanes, struct block *b)
{
    shader_function *function;
    memcpy(&function, &code, sizeof function);
    for (int e = 0; e < BLOCK; e += lanes)
        function(b->in + e, b->out + e, b->frame);
}

static int check_same(int lanes)
{
    static struct recording recording;
    static struct block expected, found;
    size_t bytes;
    const uint8_t *code = make(lanes, &bytes);
    shader_record(&recording);
    for (int round = 0; code && round < 100; round++) {
        fill(expected.in, INPUTS * BLOCK);
        fill(expected.out, OUTPUTS * BLOCK + GUARD);
        found = expected;
        interpret(&recording, &expected);
        execute(code, lanes, &found);
        for (int i = 0; i < OUTPUTS * BLOCK + GUARD; i++)
            if (memcmp(expected.out + i, found.out + i, sizeof(float))) {
                printf("%d lanes: output %d of element %d is %a, expected %a\n", lanes, i / BLOCK, i % BLOCK,
                       (double)found.out[i], (double)expected.out[i]);
                return 1;
            }
    }
    return !code;
}

/* --- The code: instructions of 5 bytes, or of 9 with a displacement; a return --- */

static int print_code(int lanes)
{
    size_t bytes;
    const uint8_t *code = make(lanes, &bytes), *at = code;
    int instructions = 1, moves = 0;
    while (code && at < code + bytes && *at == 0xc4) {
        bool memory = at[4] >> 6 == 2;
        moves += memory && (at[4] & 7) == BASE_FRAME;
        at += memory ? 9 : 5;
        instructions++;
    }
    if (!code || at != code + bytes - 1 || *at != 0xc3) {
        puts("expected instructions of encode.c, and a return");
        return 1;
    }
    printf("%d %d %zu\n", instructions, moves, bytes);
    return 0;
}

static int run(int lanes, long count)
{
    static struct block block;
    size_t bytes;
    const uint8_t *code = make(lanes, &bytes);
    fill(block.in, INPUTS * BLOCK);
    for (long i = 0; code && i < count; i++)
        execute(code, lanes, &block);
    return !code;
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    int lanes = count > 2 ? atoi(argument[2]) : 0;
    if (!__builtin_cpu_supports("avx")) {
        puts("this processor has no AVX");
        return 3;
    }
    if (!strcmp(command, "split"))
        return check_split();
    if (!strcmp(command, "same"))
        return check_same(lanes);
    if (!strcmp(command, "code"))
        return print_code(lanes);
    if (!strcmp(command, "run") && count == 4)
        return run(lanes, atol(argument[3]));
    fputs("usage: check split | same LANES | code LANES | run LANES COUNT\n", stderr);
    return 2;
}
