/* The program of lab 1's check.
 *
 *   check written-out      compares product_written_out with product_generic
 *   check record           counts the operations of the recordings, and executes them
 *   check generate         compares the generated code with product_generic, then generates two recordings
 *                          with values that have many other results between them and their use
 *   check run KIND COUNT   calls generic, written-out or generated COUNT times, for size 2
 *
 * Ends with 1, after a line with what was expected, if something is wrong. */
#define _DEFAULT_SOURCE
#include "matrix.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum { TRIALS = 2000, CODE_BYTES = 8192, ELEMENTS = SIZE_MAXIMUM * SIZE_MAXIMUM };

static const float special[] = {0, -0.0f, 1, -1, INFINITY, -INFINITY, 1e-40f, -1e-40f, 3e38f, 1e-20f};

static int fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    putchar('\n');
    return 1;
}

/* --- Matrices --- */

static uint32_t random_word(void)
{
    static uint32_t state = 1;
    state = state * 1664525 + 1013904223;
    return state >> 8;
}

static void random_matrix(float *matrix)
{
    for (int i = 0; i < ELEMENTS; i++) {
        int which = (int)(random_word() % 40);
        int specials = (int)(sizeof special / sizeof *special);
        matrix[i] = which < specials ? special[which] : (float)random_word() / 8388608 - 1;
    }
}

/* Two results are the same if they have the same bits, or both are NaN. */
static int first_difference(int elements, const float *expected, const float *found)
{
    for (int i = 0; i < elements; i++)
        if (memcmp(expected + i, found + i, sizeof(float)) && !(isnan(expected[i]) && isnan(found[i])))
            return i;
    return -1;
}

static int compare(int size, product_function *product, const char *name)
{
    float a[ELEMENTS], b[ELEMENTS], expected[ELEMENTS], found[ELEMENTS];
    for (int trial = 0; trial < TRIALS; trial++) {
        random_matrix(a);
        random_matrix(b);
        memset(found, 0x7f, sizeof found);
        product_generic(size, a, b, expected);
        product(a, b, found);
        int i = first_difference(size * size, expected, found);
        if (i >= 0)
            return fail("%s, size %d: element (%d, %d) is %a, expected %a as product_generic computes", name,
                        size, i / size, i % size, (double)found[i], (double)expected[i]);
    }
    return 0;
}

/* --- Recordings --- */

static int is_value(const struct recording *recording, int user, int number)
{
    return number >= 0 && number < user && recording->at[number].operation != OPERATION_STORE_C;
}

static int check_operation(const struct recording *recording, int number, int size)
{
    const struct recorded *r = recording->at + number;
    if (r->operation == OPERATION_MULTIPLY || r->operation == OPERATION_ADD) {
        if (!is_value(recording, number, r->left) || !is_value(recording, number, r->right))
            return fail("operation %d uses %d and %d, expected numbers of earlier values", number, r->left,
                        r->right);
    } else if (r->element < 0 || r->element >= size * size)
        return fail("operation %d accesses element %d, expected 0 to %d", number, r->element,
                    size * size - 1);
    else if (r->operation == OPERATION_STORE_C && !is_value(recording, number, r->left))
        return fail("operation %d stores %d, expected the number of an earlier value", number, r->left);
    return 0;
}

static int check_count(const struct recording *recording, enum operation operation, const char *name,
                       int expected)
{
    int found = 0;
    for (int i = 0; i < recording->count; i++)
        found += recording->at[i].operation == operation;
    return found == expected ? 0 : fail("the recording has %d %s, expected %d", found, name, expected);
}

static const struct recording *executed; /* by execute */

/* Executes a recording, as an interpreter does. */
static void execute(const float *a, const float *b, float *c)
{
    float result[RECORDING_MAXIMUM];
    for (int i = 0; i < executed->count; i++) {
        const struct recorded *r = executed->at + i;
        switch (r->operation) {
        case OPERATION_LOAD_A: result[i] = a[r->element]; break;
        case OPERATION_LOAD_B: result[i] = b[r->element]; break;
        case OPERATION_MULTIPLY: result[i] = result[r->left] * result[r->right]; break;
        case OPERATION_ADD: result[i] = result[r->left] + result[r->right]; break;
        case OPERATION_STORE_C: c[r->element] = result[r->left]; break;
        }
    }
}

static int record(struct recording *recording, int size)
{
    memset(recording, 0, sizeof *recording);
    product_record(recording, size);
    if (recording->count <= 0 || recording->count > RECORDING_MAXIMUM)
        return fail("size %d: the recording has %d operations, expected 1 to %d", size, recording->count,
                    RECORDING_MAXIMUM);
    for (int i = 0; i < recording->count; i++)
        if (check_operation(recording, i, size))
            return 1;
    return 0;
}

static int check_recording(int size)
{
    static struct recording recording;
    int products = size * size * size, sums = size * size * (size - 1);
    if (record(&recording, size) || check_count(&recording, OPERATION_MULTIPLY, "products", products) ||
        check_count(&recording, OPERATION_ADD, "sums", sums) ||
        check_count(&recording, OPERATION_STORE_C, "stores", size * size))
        return 1;
    executed = &recording;
    printf("size %d: %d operations, %d products, %d sums\n", size, recording.count, products, sums);
    return compare(size, execute, "the recording");
}

/* --- Generated code --- */

static product_function *generate_recording(const struct recording *recording)
{
    uint8_t *code = mmap(NULL, CODE_BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (code == MAP_FAILED) {
        fail("no memory for %d bytes of code", CODE_BYTES);
        return NULL;
    }
    size_t bytes = product_generate(recording, code, CODE_BYTES);
    if (!bytes || bytes > CODE_BYTES || mprotect(code, CODE_BYTES, PROT_READ | PROT_EXEC)) {
        fail("product_generate gives %zu bytes, expected 1 to %d", bytes, CODE_BYTES);
        return NULL;
    }
    product_function *function;
    memcpy(&function, &code, sizeof function);
    return function;
}

static product_function *generate(int size)
{
    static struct recording recording;
    return record(&recording, size) ? NULL : generate_recording(&recording);
}

static int check_generated(int size)
{
    product_function *function = generate(size);
    return !function || compare(size, function, "the generated code");
}

/* Records c[0] = a[0] * (a[0] * b[0] + a[0] * b[1] + ...). The last use of a[0] is 30 operations after
 * its load. At most four values are needed at a time. */
enum { LONG_PRODUCTS = 10 };

static void record_long(struct recording *recording)
{
    memset(recording, 0, sizeof *recording);
    value a = load_a(recording, 0);
    value sum = multiply(recording, a, load_b(recording, 0));
    for (int i = 1; i < LONG_PRODUCTS; i++)
        sum = add(recording, sum, multiply(recording, a, load_b(recording, i)));
    store_c(recording, 0, multiply(recording, a, sum));
}

/* Records that c is a, backwards: all 16 elements are loaded before the first is stored. */
static void record_full(struct recording *recording)
{
    value loaded[ELEMENTS];
    memset(recording, 0, sizeof *recording);
    for (int i = 0; i < ELEMENTS; i++)
        loaded[i] = load_a(recording, i);
    for (int i = 0; i < ELEMENTS; i++)
        store_c(recording, ELEMENTS - 1 - i, loaded[i]);
}

static int check_lifetimes(void record_program(struct recording *recording), const char *lesson)
{
    static struct recording recording;
    float a[ELEMENTS], b[ELEMENTS], expected[ELEMENTS] = {0}, found[ELEMENTS] = {0};
    record_program(&recording);
    product_function *function = generate_recording(&recording);
    if (!function)
        return fail("%s", lesson);
    executed = &recording;
    for (int trial = 0; trial < TRIALS; trial++) {
        random_matrix(a);
        random_matrix(b);
        execute(a, b, expected);
        function(a, b, found);
        int i = first_difference(ELEMENTS, expected, found);
        if (i >= 0)
            return fail("c[%d] is %a, expected %a\n%s", i, (double)found[i], (double)expected[i], lesson);
    }
    return 0;
}

static int check_allocation(void)
{
    return check_lifetimes(record_long,
                           "This recording uses a[0] again 30 operations after its load: the register must "
                           "keep it until its last use.") ||
           check_lifetimes(record_full, "This recording has 16 values that are used later: each of the 16 "
                                        "registers must have one of them.");
}

/* --- Commands --- */

static int check_sizes(int check(int size))
{
    for (int size = 2; size <= SIZE_MAXIMUM; size++)
        if (check(size))
            return 1;
    return 0;
}

static void generic_of_two(const float *a, const float *b, float *c)
{
    product_generic(2, a, b, c);
}

static int run(const char *kind, long count)
{
    product_function *function = !strcmp(kind, "generic")       ? generic_of_two
                                 : !strcmp(kind, "written-out") ? product_written_out
                                                                : generate(2);
    float a[ELEMENTS], b[ELEMENTS], c[ELEMENTS];
    random_matrix(a);
    random_matrix(b);
    if (!function)
        return 1;
    for (long i = 0; i < count; i++)
        function(a, b, c);
    return 0;
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    if (!strcmp(command, "written-out"))
        return compare(2, product_written_out, "product_written_out");
    if (!strcmp(command, "record"))
        return check_sizes(check_recording);
    if (!strcmp(command, "generate"))
        return check_sizes(check_generated) || check_allocation();
    if (!strcmp(command, "run") && count == 4)
        return run(argument[2], atol(argument[3]));
    fputs("usage: check written-out | record | generate | run KIND COUNT\n", stderr);
    return 2;
}
