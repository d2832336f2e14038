/* The program of lab 11's check.
 *
 *   check holes                 the holes of the fragments
 *   check contract              executes each fragment, and compares all registers and the frame
 *   check stitch                compares stitched products with a loop
 *   check run KIND COUNT        calls loop or stitched COUNT times, for size 2
 *
 * Ends with 1, after a line with what was expected, if something is wrong. */
#define _DEFAULT_SOURCE
#include "stitch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define FRAGMENT(name) extern const uint8_t fragment_##name[], fragment_##name##_end[];
FRAGMENT(load_a)
FRAGMENT(load_b)
FRAGMENT(multiply)
FRAGMENT(add)
FRAGMENT(store_c)

const struct fragment fragments[OPERATIONS] = {
    [OPERATION_LOAD_A] = {fragment_load_a, fragment_load_a_end},
    [OPERATION_LOAD_B] = {fragment_load_b, fragment_load_b_end},
    [OPERATION_MULTIPLY] = {fragment_multiply, fragment_multiply_end},
    [OPERATION_ADD] = {fragment_add, fragment_add_end},
    [OPERATION_STORE_C] = {fragment_store_c, fragment_store_c_end},
};

const unsigned fragment_holes[OPERATIONS] = {
    [OPERATION_LOAD_A] = 1 << HOLE_ELEMENT | 1 << HOLE_RESULT,
    [OPERATION_LOAD_B] = 1 << HOLE_ELEMENT | 1 << HOLE_RESULT,
    [OPERATION_MULTIPLY] = 1 << HOLE_LEFT | 1 << HOLE_RIGHT | 1 << HOLE_RESULT,
    [OPERATION_ADD] = 1 << HOLE_LEFT | 1 << HOLE_RIGHT | 1 << HOLE_RESULT,
    [OPERATION_STORE_C] = 1 << HOLE_LEFT | 1 << HOLE_ELEMENT,
};

static const char *const operation_names[] = {"load_a", "load_b", "multiply", "add", "store_c"};
static const char *const hole_names[] = {"left", "right", "result", "element"};
static const uint32_t hole_values[] = HOLE_VALUES;

enum { CODE_BYTES = 65536, ELEMENTS = SIZE_MAXIMUM * SIZE_MAXIMUM };

/* --- Holes --- */

static int occurrences(const struct fragment *fragment, uint32_t value, int *last)
{
    int count = 0;
    for (const uint8_t *at = fragment->begin; at + sizeof value <= fragment->end; at++)
        if (!memcmp(at, &value, sizeof value)) {
            *last = (int)(at - fragment->begin);
            count++;
        }
    return count;
}

static int check_hole(int operation, enum hole hole)
{
    const struct fragment *fragment = fragments + operation;
    int offset = -1, expected = fragment_holes[operation] >> hole & 1;
    int found = occurrences(fragment, hole_values[hole], &offset);
    if (found != expected)
        printf("fragment %s has the hole %s %d times, expected %d\n", operation_names[operation],
               hole_names[hole], found, expected);
    else if (hole_offset(fragment, hole) != offset)
        printf("hole_offset(%s, %s) is %d, expected %d\n", operation_names[operation], hole_names[hole],
               hole_offset(fragment, hole), offset);
    else
        return 0;
    return 1;
}

static int check_holes(void)
{
    for (int operation = 0; operation < OPERATIONS; operation++)
        for (int hole = 0; hole < HOLES; hole++)
            if (check_hole(operation, hole))
                return 1;
    return 0;
}

/* --- Executable memory --- */

static uint8_t *allocate_code(void)
{
    uint8_t *code = mmap(NULL, CODE_BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return code == MAP_FAILED ? NULL : code;
}

static int protect(uint8_t *code)
{
    return mprotect(code, CODE_BYTES, PROT_READ | PROT_EXEC);
}

/* --- The contract --- */

struct registers {
    uint64_t general[16];
    float vector[16][4];
};

void call_between(const void *code, struct registers *registers);

static const char *const general_names[] = {"rax", "rcx", "rdx", "rbx", "rsp", "rbp", "rsi", "rdi",
                                            "r8",  "r9",  "r10", "r11", "r12", "r13", "r14", "r15"};

static int compare_registers(const char *name, const struct registers *before, const struct registers *after)
{
    for (int i = 0; i < 16; i++)
        if (i != 4 && before->general[i] != after->general[i]) {
            printf("fragment %s changes %s\n", name, general_names[i]);
            return 1;
        }
    for (int i = 2; i < 16; i++)
        if (memcmp(before->vector[i], after->vector[i], sizeof before->vector[i])) {
            printf("fragment %s changes xmm%d, expected changes of xmm0 and xmm1 only\n", name, i);
            return 1;
        }
    return 0;
}

struct data {
    float a[8], b[8], c[8], frame[8];
};

/* Performs the operation on the data: left 1, right 2, result 3, element 4. */
static void execute(int operation, struct data *data)
{
    switch ((enum operation)operation) {
    case OPERATION_LOAD_A: data->frame[3] = data->a[4]; break;
    case OPERATION_LOAD_B: data->frame[3] = data->b[4]; break;
    case OPERATION_MULTIPLY: data->frame[3] = data->frame[1] * data->frame[2]; break;
    case OPERATION_ADD: data->frame[3] = data->frame[1] + data->frame[2]; break;
    default: data->c[4] = data->frame[1];
    }
}

static void fill(void *from, size_t bytes)
{
    static uint32_t state = 7;
    for (size_t i = 0; i < bytes; i++)
        ((uint8_t *)from)[i] = (uint8_t)((state = state * 1664525 + 1013904223) >> 24) & 0x3f;
}

static int check_contract_of(int operation)
{
    const struct fragment *fragment = fragments + operation;
    const char *name = operation_names[operation];
    struct registers before, after;
    struct data data, expected;
    uint8_t *code = allocate_code();
    size_t bytes = (size_t)(fragment->end - fragment->begin);
    memcpy(code, fragment->begin, bytes);
    for (int hole = 0; hole < HOLES; hole++)
        if (fragment_holes[operation] >> hole & 1) {
            uint32_t displacement = (uint32_t)(4 * (hole + 1));
            memcpy(code + hole_offset(fragment, hole), &displacement, sizeof displacement);
        }
    code[bytes] = 0xc3;
    fill(&before, sizeof before);
    fill(&data, sizeof data);
    before.general[7] = (uintptr_t)data.a;
    before.general[6] = (uintptr_t)data.b;
    before.general[2] = (uintptr_t)data.c;
    before.general[1] = (uintptr_t)data.frame;
    after = before;
    expected = data;
    execute(operation, &expected);
    if (protect(code))
        return 1;
    call_between(code, &after);
    if (compare_registers(name, &before, &after))
        return 1;
    if (!memcmp(&data, &expected, sizeof data))
        return 0;
    printf("fragment %s: expected another result, or no change of other numbers\n", name);
    return 1;
}

static int check_contract(void)
{
    for (int operation = 0; operation < OPERATIONS; operation++)
        if (check_contract_of(operation))
            return 1;
    return 0;
}

/* --- Products --- */

typedef void stitched_function(const float *a, const float *b, float *c, float *frame);

static void product_loop(int size, const float *a, const float *b, float *c)
{
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            float sum = a[i * size] * b[j];
            for (int k = 1; k < size; k++)
                sum += a[i * size + k] * b[k * size + j];
            c[i * size + j] = sum;
        }
}

static stitched_function *make(int size)
{
    static struct recording recording;
    uint8_t *code = allocate_code();
    product_record(&recording, size);
    size_t bytes = stitch(&recording, code, CODE_BYTES);
    if (!bytes || bytes > CODE_BYTES || protect(code)) {
        printf("stitch gives %zu bytes for size %d, expected 1 to %d\n", bytes, size, CODE_BYTES);
        return NULL;
    }
    if (stitch(&recording, allocate_code(), bytes - 1)) {
        puts("stitch does not give 0 when the room is one byte too small");
        return NULL;
    }
    stitched_function *function;
    memcpy(&function, &code, sizeof function);
    return function;
}

static int check_product(int size)
{
    float a[ELEMENTS], b[ELEMENTS], expected[ELEMENTS], found[ELEMENTS], frame[RECORDING_MAXIMUM];
    stitched_function *function = make(size);
    if (!function)
        return 1;
    for (int trial = 0; trial < 1000; trial++) {
        fill(a, sizeof a);
        fill(b, sizeof b);
        fill(found, sizeof found);
        product_loop(size, a, b, expected);
        function(a, b, found, frame);
        if (memcmp(expected, found, sizeof(float) * (size_t)(size * size))) {
            printf("size %d: expected another product\n", size);
            return 1;
        }
    }
    return 0;
}

static int check_products(void)
{
    for (int size = 2; size <= SIZE_MAXIMUM; size++)
        if (check_product(size))
            return 1;
    return 0;
}

static int run(const char *kind, long count)
{
    float a[ELEMENTS], b[ELEMENTS], c[ELEMENTS], frame[RECORDING_MAXIMUM];
    stitched_function *function = make(2);
    fill(a, sizeof a);
    fill(b, sizeof b);
    for (long i = 0; function && i < count; i++)
        if (*kind == 'l')
            product_loop(2, a, b, c);
        else
            function(a, b, c, frame);
    return !function;
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    if (!strcmp(command, "holes"))
        return check_holes();
    if (!strcmp(command, "contract"))
        return check_contract();
    if (!strcmp(command, "run") && count == 4)
        return run(argument[2], atol(argument[3]));
    return check_products();
}
