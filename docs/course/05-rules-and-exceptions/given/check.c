/* The program of lab 5's check.
 *
 *   check rule NAME none       tries a rule with all 2^32 inputs
 *   check rule NAME BITS       tries it with one input, in hexadecimal: it must break the rule
 *   check range                compares ranges of examples, and tests ranges with random values
 *   check reduce               counts what is replaced in examples; compares random programs before and after
 *
 * Ends with 1, after a line with what was expected, if something is wrong. */
#include "rules.h"

#include <immintrin.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Numbers --- */

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static float number_of(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* All NaNs count as the same result. isnan and != may not be used: denormal numbers are equal to zero. */
static bool is_nan(float x)
{
    return (bits_of(x) & 0x7fffffff) > 0x7f800000;
}

static bool same(float a, float b)
{
    return bits_of(a) == bits_of(b) || (is_nan(a) && is_nan(b));
}

static uint32_t random_word(void)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005 + 1442695040888963407;
    return (uint32_t)(state >> 32);
}

/* --- Rules --- */

typedef float side(float y);

/* The compiler must not apply the rules by itself. */
static volatile float one = 1, zero = 0, minus_zero = -0.0f, two = 2;

static float left_identity(float y)
{
    return y;
}
static float left_zero(float y)
{
    (void)y;
    return 0;
}
static float right_times_one(float y)
{
    return y * one;
}
static float right_plus_zero(float y)
{
    return y + zero;
}
static float right_plus_minus_zero(float y)
{
    return y + minus_zero;
}
static float right_times_zero(float y)
{
    return y * zero;
}
static float right_minus_itself(float y)
{
    volatile float z = y;
    return y - z;
}
static float left_twice(float y)
{
    return y * two;
}
static float right_plus_itself(float y)
{
    volatile float z = y;
    return y + z;
}

static const struct rule {
    const char *name;
    side *simple, *original;
} rules[] = {
    {"y*1=y", left_identity, right_times_one},        {"y+0=y", left_identity, right_plus_zero},
    {"y+-0=y", left_identity, right_plus_minus_zero}, {"y*0=0", left_zero, right_times_zero},
    {"y-y=0", left_zero, right_minus_itself},         {"y+y=y*2", left_twice, right_plus_itself},
};

static int try_all(const struct rule *rule)
{
    uint32_t bits = 0;
    do
        if (!same(rule->simple(number_of(bits)), rule->original(number_of(bits)))) {
            printf("%s: some input breaks it\n", rule->name);
            return 1;
        }
    while (++bits);
    return 0;
}

static int try_one(const struct rule *rule, const char *text)
{
    char *end;
    uint32_t bits = (uint32_t)strtoul(text, &end, 16);
    float simple = rule->simple(number_of(bits)), original = rule->original(number_of(bits));
    if (*end || end == text)
        printf("%s: %s, expected bits in hexadecimal, or none\n", rule->name, text);
    else if (same(simple, original))
        printf("%s: y = 0x%08x gives 0x%08x on both sides, expected an input that breaks it\n", rule->name,
               bits, bits_of(simple));
    else
        return 0;
    return 1;
}

static int check_rule(const char *name, const char *text)
{
    for (unsigned i = 0; i < sizeof rules / sizeof *rules; i++)
        if (!strcmp(rules[i].name, name))
            return strcmp(text, "none") ? try_one(rules + i, text) : try_all(rules + i);
    printf("%s: no such rule\n", name);
    return 1;
}

/* --- Ranges --- */

typedef struct range range_function(struct range, struct range);

struct operation {
    const char *sign;
    enum node_operation operation;
    range_function *range;
};

static const struct operation operations[] = {{"+", NODE_ADD, range_of_add},
                                              {"-", NODE_SUBTRACT, range_of_subtract},
                                              {"*", NODE_MULTIPLY, range_of_multiply}};

static float compute(enum node_operation operation, float a, float b)
{
    volatile float x = a, y = b;
    return operation == NODE_ADD ? x + y : operation == NODE_SUBTRACT ? x - y : x * y;
}

#define INF INFINITY

static const struct range_example {
    int operation;
    struct range a, b, expected;
} range_examples[] = {
    {0, {0, 1, 0, 0}, {0, 1, 0, 0}, {0, 2, 0, 0}},
    {0, {-1, 1, 0, 1}, {2, 3, 0, 0}, {1, 4, 0, 0}},
    {0, {0, 1, 1, 0}, {0, 1, 0, 0}, {0, 2, 1, 0}},
    {0, {0, 3e38f, 0, 0}, {0, 3e38f, 0, 0}, {0, INF, 0, 0}},
    {0, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}},
    {0, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 0}},
    {0, {-INF, 0, 0, 0}, {0, INF, 0, 0}, {-INF, INF, 1, 1}},
    {1, {2, 3, 0, 0}, {0, 1, 0, 0}, {1, 3, 0, 0}},
    {1, {0, 1, 0, 0}, {0, 1, 0, 0}, {-1, 1, 0, 1}},
    {1, {0, INF, 0, 0}, {0, INF, 0, 0}, {-INF, INF, 1, 1}},
    {1, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 1}},
    {2, {0, 1, 0, 0}, {0, 1, 0, 0}, {0, 1, 0, 0}},
    {2, {-1, 1, 0, 0}, {0, 1, 0, 0}, {-1, 1, 0, 1}},
    {2, {-2, -1, 0, 0}, {-3, 4, 0, 0}, {-8, 6, 0, 1}},
    {2, {0, INF, 0, 0}, {0, 1, 0, 0}, {0, INF, 1, 0}},
    {2, {1, 2, 0, 0}, {1, INF, 0, 0}, {1, INF, 0, 0}},
    {2, {1e30f, 2e30f, 0, 0}, {1e30f, 1e30f, 0, 0}, {INF, INF, 0, 0}},
};

static void print_range(const char *before, struct range r)
{
    printf("%s[%g, %g]%s%s", before, (double)r.low, (double)r.high, r.nan ? " or NaN" : "",
           r.negative_zero ? " or -0" : "");
}

static int print_ranges(const struct operation *operation, struct range a, struct range b, struct range found)
{
    print_range("", a);
    printf(" %s ", operation->sign);
    print_range("", b);
    print_range(" is ", found);
    return 1;
}

static int check_range_examples(void)
{
    for (unsigned i = 0; i < sizeof range_examples / sizeof *range_examples; i++) {
        const struct range_example *e = range_examples + i;
        struct range found = operations[e->operation].range(e->a, e->b), expected = e->expected;
        if (found.low == expected.low && found.high == expected.high && found.nan == expected.nan &&
            found.negative_zero == expected.negative_zero)
            continue;
        print_ranges(operations + e->operation, e->a, e->b, found);
        print_range(", expected ", expected);
        putchar('\n');
        return 1;
    }
    return 0;
}

/* Bounds with which things happen: zeros, ones, the least normal numbers, the largest, infinities. */
static float random_bound(void)
{
    static const float bounds[] = {0, 1, 2, 0.5f, 1.17549435e-38f, 2.5e-38f, 1e-30f, 3e38f, 1e20f, INFINITY};
    float x = random_word() % 3 ? bounds[random_word() % 10] : (float)(random_word() % 1000) / 100;
    return random_word() & 1 ? -x : x;
}

static struct range random_range(void)
{
    float a = random_bound() + zero, b = random_word() % 4 ? random_bound() + zero : a;
    return (struct range){fminf(a, b), fmaxf(a, b), random_word() % 8 == 0, random_word() % 4 == 0};
}

static float random_member(struct range range)
{
    unsigned kind = random_word() % 8;
    float t = (float)(random_word() >> 8) / 16777216;
    float inside = range.low + t * (range.high - range.low) + zero;
    if (kind == 0 && range.nan)
        return NAN;
    if (kind == 1 && range.negative_zero)
        return -0.0f;
    if (kind <= 2 && range.low <= 0 && range.high >= 0)
        return 0;
    if (kind <= 4 || is_nan(inside) || inside < range.low || inside > range.high)
        return kind & 1 ? range.low : range.high;
    return inside;
}

static bool is_member(struct range range, float x)
{
    if (is_nan(x))
        return range.nan;
    if (bits_of(x) == 0x80000000)
        return range.negative_zero;
    return range.low <= x && x <= range.high;
}

static int check_random_range(const struct operation *operation)
{
    struct range a = random_range(), b = random_range(), found = operation->range(a, b);
    for (int i = 0; i < 40; i++) {
        float x = random_member(a), y = random_member(b), result = compute(operation->operation, x, y);
        if (is_member(found, result))
            continue;
        print_ranges(operation, a, b, found);
        printf(", but %g %s %g is %g\n", (double)x, operation->sign, (double)y, (double)result);
        return 1;
    }
    return 0;
}

static int check_range(void)
{
    if (check_range_examples())
        return 1;
    for (int i = 0; i < 300000; i++)
        if (check_random_range(operations + i % 3))
            return 1;
    return 0;
}

/* --- Programs --- */

static struct range literal_range(float x)
{
    bool minus = bits_of(x) == 0x80000000;
    /* Numbers from +0 to -1: none. */
    return minus ? (struct range){0, -1, false, true} : (struct range){x, x, false, false};
}

static struct node input(float low, float high)
{
    return (struct node){.operation = NODE_INPUT, .range = {low, high, false, false}};
}

static struct node literal(float x)
{
    return (struct node){.operation = NODE_LITERAL, .literal = x, .range = literal_range(x)};
}

static struct node binary(enum node_operation operation, int left, int right)
{
    return (struct node){.operation = operation, .left = left, .right = right};
}

static void print_program(const struct node *program, int count)
{
    static const char *const sign[] = {"input", "literal", "+", "-", "*", "copy"};
    for (int i = 0; i < count; i++) {
        const struct node *n = program + i;
        if (n->operation == NODE_INPUT)
            print_range("  input ", n->range);
        else if (n->operation == NODE_LITERAL)
            printf("  %g", (double)n->literal);
        else
            printf("  #%d %s #%d", n->left, sign[n->operation], n->right);
        printf(i + 1 < count ? "," : "\n");
    }
}

struct example {
    const char *title;
    int expected, count;
    struct node program[8];
};

static int check_example(struct example example)
{
    struct node before[8];
    memcpy(before, example.program, sizeof before);
    int found = reduce(example.program, example.count);
    if (found == example.expected)
        return 0;
    printf("%s: %d replaced, expected %d:", example.title, found, example.expected);
    print_program(before, example.count);
    return 1;
}

static int check_examples(void)
{
    const struct example examples[] = {
        {"a number times one", 1, 3, {input(-5, INF), literal(1), binary(NODE_MULTIPLY, 0, 1)}},
        {"a colour plus zero", 1, 3, {input(0, 1), literal(0), binary(NODE_ADD, 0, 1)}},
        {"zero plus a colour", 1, 3, {input(0, 1), literal(0), binary(NODE_ADD, 1, 0)}},
        {"a sum that may be -0 plus zero",
         0,
         5,
         {input(-1, 1), input(-1, 1), literal(0), binary(NODE_ADD, 0, 1), binary(NODE_ADD, 3, 2)}},
        {"the same minus zero",
         1,
         5,
         {input(-1, 1), input(-1, 1), literal(0), binary(NODE_ADD, 0, 1), binary(NODE_SUBTRACT, 3, 2)}},
        {"the same plus -0",
         1,
         5,
         {input(-1, 1), input(-1, 1), literal(-0.0f), binary(NODE_ADD, 0, 1), binary(NODE_ADD, 3, 2)}},
        {"a colour times zero", 1, 3, {input(0, 1), literal(0), binary(NODE_MULTIPLY, 0, 1)}},
        {"a negative number times zero", 0, 3, {input(-1, 1), literal(0), binary(NODE_MULTIPLY, 0, 1)}},
        {"a number that may be infinite times zero",
         0,
         3,
         {input(0, INF), literal(0), binary(NODE_MULTIPLY, 0, 1)}},
        {"a number minus itself", 1, 2, {input(-1, 1), binary(NODE_SUBTRACT, 0, 0)}},
        {"a number that may be infinite minus itself", 0, 2, {input(0, INF), binary(NODE_SUBTRACT, 0, 0)}},
        {"one rule makes the next possible",
         3,
         6,
         {input(0, 1), literal(0), literal(1), binary(NODE_MULTIPLY, 0, 2), binary(NODE_ADD, 3, 1),
          binary(NODE_SUBTRACT, 4, 0)}},
        {"a product that is zero is a literal",
         2,
         4,
         {input(0, 1), literal(0), binary(NODE_MULTIPLY, 0, 1), binary(NODE_ADD, 0, 2)}},
    };
    for (unsigned i = 0; i < sizeof examples / sizeof *examples; i++)
        if (check_example(examples[i]))
            return 1;
    return 0;
}

static void execute(const struct node *program, int count, const float *inputs, float *results)
{
    for (int i = 0; i < count; i++) {
        const struct node *n = program + i;
        results[i] = n->operation == NODE_INPUT     ? inputs[i]
                     : n->operation == NODE_LITERAL ? n->literal
                     : n->operation == NODE_COPY    ? results[n->left]
                                                 : compute(n->operation, results[n->left], results[n->right]);
    }
}

static int random_program(struct node *program)
{
    static const float literals[] = {0, 1, -0.0f, 2, 0, 1};
    int count = 12;
    for (int i = 0; i < count; i++)
        if (i < 3)
            program[i] = (struct node){.operation = NODE_INPUT, .range = random_range()};
        else if (i < 6)
            program[i] = literal(literals[random_word() % 6]);
        else
            program[i] = binary(NODE_ADD + random_word() % 3, (int)(random_word() % (unsigned)i),
                                (int)(random_word() % (unsigned)i));
    return count;
}

static int compare_programs(const struct node *before, const struct node *after, int count)
{
    float inputs[NODES_MAXIMUM] = {0}, expected[NODES_MAXIMUM], found[NODES_MAXIMUM];
    for (int i = 0; i < 3; i++)
        inputs[i] = random_member(before[i].range);
    execute(before, count, inputs, expected);
    execute(after, count, inputs, found);
    for (int i = 0; i < count; i++)
        if (!same(expected[i], found[i])) {
            printf("#%d is %g after the reduction, %g before:", i, (double)found[i], (double)expected[i]);
            print_program(before, count);
            printf("with inputs %g, %g, %g\n", (double)inputs[0], (double)inputs[1], (double)inputs[2]);
            return 1;
        }
    return 0;
}

static int check_random_programs(void)
{
    for (int i = 0; i < 20000; i++) {
        struct node before[NODES_MAXIMUM], after[NODES_MAXIMUM];
        int count = random_program(before);
        memcpy(after, before, sizeof after);
        reduce(after, count);
        for (int j = 0; j < 20; j++)
            if (compare_programs(before, after, count))
                return 1;
    }
    return 0;
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    _mm_setcsr(_mm_getcsr() | 0x8040); /* denormal operands and results are zero */
    if (!strcmp(command, "rule") && count == 4)
        return check_rule(argument[2], argument[3]);
    if (!strcmp(command, "range"))
        return check_range();
    return check_examples() || check_random_programs();
}
