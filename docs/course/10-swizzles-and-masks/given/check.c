/* The program of lab 10's check.
 *
 *   check letters      the functions of letters.c
 *   check pixel        translate_pixel, executed for masks, swizzles and registers that overlap
 *   check component    translate_component
 *   check count        prints the machine instructions for four pixels, in both layouts, of `add r2.xw, a, b`
 *                      of the lab's page, and of a shader
 *
 * Ends with 1, after a line with what was expected, if something is wrong. */
#include "swizzle.h"

#include <stdio.h>
#include <string.h>

static const char component_names[] = "xyzw";

/* --- letters --- */

typedef void letters_function(const char *mask, const char *swizzle, int source[COMPONENTS]);

struct letters_case {
    letters_function *function;
    const char *name, *mask, *swizzle;
    int source[COMPONENTS];
};

static const struct letters_case letters_cases[] = {
    {letters_by_position, "letters_by_position", "xyzw", "wzyx", {3, 2, 1, 0}},
    {letters_by_position, "letters_by_position", "yzw", "xzyx", {-1, 2, 1, 0}},
    {letters_by_position, "letters_by_position", "xw", "zy", {2, -1, -1, 1}},
    {letters_by_position, "letters_by_position", "z", "w", {-1, -1, 3, -1}},
    {letters_by_position, "letters_by_position", "xyzw", "xy", {0, 1, 1, 1}},
    {letters_in_order, "letters_in_order", "xyzw", "wzyx", {3, 2, 1, 0}},
    {letters_in_order, "letters_in_order", "yzw", "xzyx", {-1, 0, 2, 1}},
    {letters_in_order, "letters_in_order", "xw", "zy", {2, -1, -1, 1}},
    {letters_in_order, "letters_in_order", "yw", "x", {-1, 0, -1, 0}},
};

static int check_letters(void)
{
    for (unsigned i = 0; i < sizeof letters_cases / sizeof *letters_cases; i++) {
        const struct letters_case *c = letters_cases + i;
        int found[COMPONENTS] = {9, 9, 9, 9};
        c->function(c->mask, c->swizzle, found);
        if (memcmp(found, c->source, sizeof found)) {
            printf("%s(\"%s\", \"%s\") is {%d, %d, %d, %d}, expected {%d, %d, %d, %d}\n", c->name, c->mask,
                   c->swizzle, found[0], found[1], found[2], found[3], c->source[0], c->source[1],
                   c->source[2], c->source[3]);
            return 1;
        }
    }
    return 0;
}

/* --- Execution --- */

enum { MACHINE_REGISTERS = SHADER_REGISTERS * COMPONENTS + TEMPORARIES };

typedef double vector[COMPONENTS];

static void execute(const struct machine_instruction *at, vector *registers)
{
    vector result;
    const double *left = registers[at->left], *right = registers[at->right];
    for (int i = 0; i < COMPONENTS; i++)
        result[i] = at->operation == MACHINE_ADD       ? left[i] + right[i]
                    : at->operation == MACHINE_MOVE    ? left[i]
                    : at->operation == MACHINE_SHUFFLE ? left[at->control[i] & 3]
                    : at->control[i]                   ? right[i]
                                                       : left[i];
    memcpy(registers[at->result], result, sizeof result);
}

/* A number for each component of each register and pixel; no two sums of two of them are equal by chance. */
static double number(int shader_register, int component, int pixel)
{
    int index = (shader_register * COMPONENTS + component) * PIXELS + pixel;
    return (double)((unsigned)index * 2654435761u % 1000003u) + index * 1e-3;
}

static double expected(const struct shader_add *add, int shader_register, int component, int pixel)
{
    if (shader_register != add->result || add->left_source[component] < 0)
        return number(shader_register, component, pixel);
    return number(add->left, add->left_source[component], pixel) +
           number(add->right, add->right_source[component], pixel);
}

/* --- Messages --- */

static void print_operand(const int *source)
{
    putchar('.');
    for (int c = 0; c < COMPONENTS; c++)
        putchar(source[c] < 0 ? '_' : component_names[source[c]]);
}

static int wrong(const struct shader_add *add, const char *what)
{
    printf("add r%d.", add->result);
    for (int c = 0; c < COMPONENTS; c++)
        if (add->left_source[c] >= 0)
            putchar(component_names[c]);
    printf(", r%d", add->left);
    print_operand(add->left_source);
    printf(", r%d", add->right);
    print_operand(add->right_source);
    printf(": %s\n", what);
    return 1;
}

/* --- One pixel a register --- */

static int written(const struct shader_add *add)
{
    int count = 0;
    for (int c = 0; c < COMPONENTS; c++)
        count += add->left_source[c] >= 0;
    return count;
}

static int moves_numbers(const int *source)
{
    for (int c = 0; c < COMPONENTS; c++)
        if (source[c] >= 0 && source[c] != c)
            return 1;
    return 0;
}

static int check_pixel(const struct shader_add *add)
{
    struct machine_instruction code[INSTRUCTIONS_MAXIMUM];
    vector registers[MACHINE_REGISTERS];
    int count = translate_pixel(add, code);
    int limit =
        moves_numbers(add->left_source) + moves_numbers(add->right_source) + 1 + (written(add) < COMPONENTS);
    if (count < 1 || count > limit) {
        char text[80];
        snprintf(text, sizeof text, "%d instructions for a pixel, expected 1 to %d", count, limit);
        return wrong(add, text);
    }
    for (int r = 0; r < MACHINE_REGISTERS; r++)
        for (int c = 0; c < COMPONENTS; c++)
            registers[r][c] = r < SHADER_REGISTERS ? number(r, c, 0) : 0;
    for (int i = 0; i < count; i++)
        execute(code + i, registers);
    for (int r = 0; r < SHADER_REGISTERS; r++)
        for (int c = 0; c < COMPONENTS; c++)
            if (registers[r][c] != expected(add, r, c, 0))
                return wrong(add, "another result, or another register has changed");
    return 0;
}

/* --- One component a register --- */

/* True if a component is written and read later, when components are written in order. */
static int overlaps(const struct shader_add *add)
{
    for (int c = 0; c < COMPONENTS; c++)
        for (int later = c + 1; later < COMPONENTS; later++)
            if (add->left_source[c] >= 0 && ((add->left == add->result && add->left_source[later] == c) ||
                                             (add->right == add->result && add->right_source[later] == c)))
                return 1;
    return 0;
}

static int check_component_code(const struct shader_add *add, const struct machine_instruction *code,
                                int count)
{
    int limit = written(add) * (1 + overlaps(add));
    char text[96];
    if (count < 1 || count > limit) {
        snprintf(text, sizeof text, "%d instructions for four pixels, expected 1 to %d", count, limit);
        return wrong(add, text);
    }
    for (int i = 0; i < count; i++)
        if (code[i].operation != MACHINE_ADD && code[i].operation != MACHINE_MOVE)
            return wrong(add, "expected only MACHINE_ADD and MACHINE_MOVE");
    return 0;
}

static int check_component(const struct shader_add *add)
{
    struct machine_instruction code[INSTRUCTIONS_MAXIMUM];
    static vector registers[MACHINE_REGISTERS];
    int count = translate_component(add, code);
    if (check_component_code(add, code, count))
        return 1;
    for (int r = 0; r < SHADER_REGISTERS * COMPONENTS; r++)
        for (int pixel = 0; pixel < PIXELS; pixel++)
            registers[r][pixel] = number(r / COMPONENTS, r % COMPONENTS, pixel);
    for (int i = 0; i < count; i++)
        execute(code + i, registers);
    for (int r = 0; r < SHADER_REGISTERS * COMPONENTS; r++)
        for (int pixel = 0; pixel < PIXELS; pixel++)
            if (registers[r][pixel] != expected(add, r / COMPONENTS, r % COMPONENTS, pixel))
                return wrong(add, "another result, or another register has changed");
    return 0;
}

/* --- All cases --- */

/* A case: a mask, two swizzles of 256 each, and registers that are apart or the same. */
static struct shader_add make(int mask, int left_swizzle, int right_swizzle, int registers)
{
    static const int sets[][3] = {{2, 0, 1}, {2, 2, 1}, {2, 0, 2}, {2, 2, 2}, {2, 1, 1}};
    struct shader_add add = {
        .result = sets[registers][0], .left = sets[registers][1], .right = sets[registers][2]};
    for (int c = 0; c < COMPONENTS; c++) {
        int on = mask >> c & 1;
        add.left_source[c] = on ? left_swizzle >> 2 * c & 3 : -1;
        add.right_source[c] = on ? right_swizzle >> 2 * c & 3 : -1;
    }
    return add;
}

static int check_all(int check(const struct shader_add *))
{
    static const int rights[] = {0xe4, 0x1b, 0x00, 0x39, 0xff, 0x4e};
    for (int registers = 0; registers < 5; registers++)
        for (int mask = 15; mask > 0; mask--)
            for (int left = 0; left < 256; left++)
                for (unsigned right = 0; right < sizeof rights / sizeof *rights; right++) {
                    struct shader_add add = make(mask, left, rights[right], registers);
                    if (check(&add))
                        return 1;
                }
    return 0;
}

/* --- Counts --- */

struct text {
    const char *mask, *left, *right;
};

static struct shader_add add_of(const struct text *text, int result)
{
    struct shader_add add = {.result = result, .left = result + 1, .right = result + 2};
    letters_by_position(text->mask, text->left, add.left_source);
    letters_by_position(text->mask, text->right, add.right_source);
    return add;
}

static void count(const char *name, const struct text *text, int number_of_texts)
{
    int pixel = 0, component = 0;
    for (int i = 0; i < number_of_texts; i++) {
        struct machine_instruction code[INSTRUCTIONS_MAXIMUM];
        struct shader_add add = add_of(text + i, i % 4);
        pixel += PIXELS * translate_pixel(&add, code);
        component += translate_component(&add, code);
    }
    printf("%s %d %d\n", name, pixel, component);
}

static int print_counts(void)
{
    static const struct text one[] = {{"xw", "xxxy", "zzzw"}};
    static const struct text shader[] = {
        {"xyzw", "xyzw", "xyzw"}, {"xyz", "xyzz", "yzxx"}, {"xyz", "yzxx", "zxyy"}, {"w", "x", "w"},
        {"xy", "zwww", "xyyy"},   {"xyzw", "xyzw", "w"},   {"x", "w", "x"},         {"xyz", "xyzz", "xyzz"},
    };
    count("add", one, 1);
    count("shader", shader, sizeof shader / sizeof *shader);
    return 0;
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    if (!strcmp(command, "letters"))
        return check_letters();
    if (!strcmp(command, "pixel"))
        return check_all(check_pixel);
    if (!strcmp(command, "component"))
        return check_all(check_component);
    return print_counts();
}
