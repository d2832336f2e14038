/* The program of lab 6's check. FILE is a recording, as `triptych dump --show record` prints it.
 *
 *   check copy FILE     copies: random programs, then the recording
 *   check dead FILE     dead code, the same
 *   check color FILE    the recording without its colour
 *   check run COUNT     removes a chain of COUNT dead instructions
 *
 * Ends with 1, after a line with what was expected, if something is wrong. */
#include "program.h"

#include "contract/lane.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xmmintrin.h>

/* --- Recordings as text --- */

static bool is_type(const char *word)
{
    return !strcmp(word, "flt") || !strcmp(word, "itg") || !strcmp(word, "msk");
}

static void parse_operand(struct instruction *i, int *operands, const char *word)
{
    if (*word == '%' && *operands < 3)
        i->operand[(*operands)++] = atoi(word + 1);
    else {
        size_t used = strlen(i->place);
        snprintf(i->place + used, sizeof i->place - used, "%s%s", used ? " " : "", word);
    }
}

static void parse(struct program *program, char *line)
{
    char *end = strchr(line, ';'), *word = strtok(line, " \n");
    int number = word ? atoi(word) : 0, operands = 0;
    if (!end || number != program->count || number >= PROGRAM_MAXIMUM)
        return;
    *end = 0;
    struct instruction *i = program->instruction + program->count++;
    *i = (struct instruction){.kind = KIND_VALUE};
    word = strtok(NULL, " \n");
    if (word && is_type(word)) {
        memcpy(i->type, word, 3);
        word = strtok(NULL, " \n");
    }
    if (!word)
        return;
    snprintf(i->operation, sizeof i->operation, "%s", word);
    while ((word = strtok(NULL, " \n")))
        parse_operand(i, &operands, word);
    if (!strcmp(i->operation, "store"))
        i->kind = KIND_STORE;
    else if (!strcmp(i->operation, "copy"))
        i->kind = KIND_COPY;
}

static bool read_program(struct program *program, const char *name)
{
    char line[400];
    FILE *file = fopen(name, "r");
    memset(program, 0, sizeof *program);
    program->count = 1;
    while (file && fgets(line, sizeof line, file))
        parse(program, line);
    if (file)
        fclose(file);
    if (program->count < 2)
        printf("%s: found no instruction, expected a recording\n", name);
    return program->count > 1;
}

/* --- Random programs --- */

static uint32_t state = 1;

static unsigned below(unsigned limit)
{
    state = state * 1664525 + 1013904223;
    return (state >> 8) % limit;
}

/* Copies, chains of copies, and values that nothing needs are frequent. */
static void random_program(struct program *program)
{
    static const char *const operations[] = {"add_f", "mul_f", "max_f", "sub_f"};
    static int values[64];
    int count = 0;
    memset(program, 0, sizeof *program);
    program->count = 8 + (int)below(50);
    for (int n = 1; n < program->count; n++) {
        struct instruction *i = program->instruction + n;
        unsigned which = count ? below(10) : 0;
        *i = (struct instruction){.kind = KIND_VALUE, .type = "flt"};
        if (which < 1) {
            snprintf(i->operation, sizeof i->operation, "uniform");
            snprintf(i->place, sizeof i->place, "JOB+%d", 4 * n);
        } else if (which < 5) {
            snprintf(i->operation, sizeof i->operation, "copy");
            i->kind = KIND_COPY;
            i->operand[0] = values[(unsigned)count - 1 - below((unsigned)count) % 3 % (unsigned)count];
        } else if (which < 6) {
            snprintf(i->operation, sizeof i->operation, "store");
            snprintf(i->place, sizeof i->place, "OUTPUT+%d", 1024 * n);
            i->kind = KIND_STORE;
            i->type[0] = 0;
            i->operand[0] = values[below((unsigned)count)];
        } else {
            snprintf(i->operation, sizeof i->operation, "%s", operations[below(4)]);
            i->operand[0] = values[below((unsigned)count)];
            i->operand[1] = values[below((unsigned)count)];
        }
        if (i->kind != KIND_STORE)
            values[count++] = n;
    }
}

/* --- Execution --- */

typedef float value_flt;
typedef int32_t value_itg;
typedef int32_t value_msk;
typedef uint16_t value_fix;
typedef int value_non;

static float get_flt(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t put_flt(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

#define get_itg(x) (int32_t)(x)
#define get_msk(x) (int32_t)(x)
#define get_fix(x) (uint16_t)(x)
#define get_non(x) 0
#define put_itg(x) (uint32_t)(x)
#define put_msk(x) (uint32_t)(x)
#define put_fix(x) (uint32_t)((x)&0xffff)

/* Operations with an immediate do not occur in these programs. */
static uint32_t compute(const struct instruction *i, uint32_t x, uint32_t y, uint32_t z)
{
#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    if (!strcmp(i->operation, #name)) {                                                                      \
        value_##ta a = get_##ta(x);                                                                          \
        value_##tb b = get_##tb(y);                                                                          \
        value_##tc c = get_##tc(z);                                                                          \
        (void)a, (void)b, (void)c;                                                                           \
        return put_##result(expression);                                                                     \
    }
#define OPK(...)
#define CAST(...)
#include "def/op.def"
    return 0;
}

/* The contents of memory: a number that depends on the place and on the round. */
static uint32_t contents(const struct instruction *i, uint32_t index, uint32_t round)
{
    uint32_t hash = 2166136261u + round * 7919 + index;
    for (const char *c = i->place; *c; c++)
        hash = (hash ^ (uint8_t)*c) * 16777619;
    hash ^= hash >> 15;
    return !strcmp(i->type, "flt") ? put_flt((float)(hash % 20001) / 10000 - 1) : hash % 1000;
}

static uint32_t literal(const struct instruction *i)
{
    return strcmp(i->type, "flt") ? (uint32_t)strtoul(i->place, NULL, 0) : put_flt(strtof(i->place, NULL));
}

static void execute(const struct program *program, uint32_t round, uint32_t *value)
{
    for (int n = 0; n < program->count; n++) {
        const struct instruction *i = program->instruction + n;
        uint32_t a = value[i->operand[0]], b = value[i->operand[1]], c = value[i->operand[2]];
        if (i->kind == KIND_NOTHING)
            value[n] = 0xdeadbeef;
        else if (i->kind == KIND_STORE || i->kind == KIND_COPY)
            value[n] = a;
        else if (!strcmp(i->operation, "literal"))
            value[n] = literal(i);
        else
            value[n] = *i->place ? contents(i, a, round) : compute(i, a, b, c);
    }
}

/* Executes both; every store that `after` has must write the same. */
static bool same_results(const struct program *before, const struct program *after)
{
    static uint32_t expected[PROGRAM_MAXIMUM], found[PROGRAM_MAXIMUM];
    for (uint32_t round = 0; round < 20; round++) {
        execute(before, round, expected);
        execute(after, round, found);
        for (int n = 0; n < before->count; n++)
            if (after->instruction[n].kind == KIND_STORE && expected[n] != found[n]) {
                printf("store %d, of %s, writes %08x, expected %08x\n", n, after->instruction[n].place,
                       found[n], expected[n]);
                return false;
            }
    }
    return true;
}

/* --- What must hold after a pass --- */

static const char *describe(const struct program *program, int number)
{
    static char text[100];
    const struct instruction *i = program->instruction + number;
    snprintf(text, sizeof text, "instruction %d, %s", number, i->operation);
    return text;
}

static int removed(const struct program *before, const struct program *after)
{
    int count = 0;
    for (int n = 0; n < before->count; n++)
        count += before->instruction[n].kind != after->instruction[n].kind;
    return count;
}

static int count_kind(const struct program *program, enum kind kind)
{
    int count = 0;
    for (int n = 0; n < program->count; n++)
        count += program->instruction[n].kind == kind;
    return count;
}

static bool check_returned(const char *pass, int returned, int expected)
{
    if (returned != expected)
        printf("%s returns %d, expected %d: what it removed\n", pass, returned, expected);
    return returned == expected;
}

static bool without_copies(const struct program *before, const struct program *after)
{
    for (int n = 0; n < after->count; n++) {
        const struct instruction *i = after->instruction + n;
        if (i->kind != KIND_NOTHING && before->instruction[n].kind == KIND_COPY) {
            printf("%s is there still\n", describe(before, n));
            return false;
        }
        if (i->kind != before->instruction[n].kind && before->instruction[n].kind != KIND_COPY) {
            printf("%s is not a copy, and was changed\n", describe(before, n));
            return false;
        }
        for (int o = 0; o < 3 && i->kind != KIND_NOTHING; o++)
            if (before->instruction[i->operand[o]].kind == KIND_COPY) {
                printf("%s uses %d, which is a copy\n", describe(before, n), i->operand[o]);
                return false;
            }
    }
    return true;
}

/* Marks all that the stores need, slowly: until nothing changes. */
static void mark_needed(const struct program *program, bool *needed)
{
    memset(needed, 0, PROGRAM_MAXIMUM * sizeof *needed);
    for (bool changes = true; changes;) {
        changes = false;
        for (int n = 1; n < program->count; n++) {
            const struct instruction *i = program->instruction + n;
            if (i->kind == KIND_NOTHING || !(i->kind == KIND_STORE || needed[n]))
                continue;
            changes |= !needed[n];
            needed[n] = true;
            for (int o = 0; o < 3; o++) {
                changes |= i->operand[o] && !needed[i->operand[o]];
                needed[i->operand[o]] = true;
            }
        }
    }
}

static bool without_dead(const struct program *before, const struct program *after)
{
    static bool needed[PROGRAM_MAXIMUM];
    mark_needed(before, needed);
    for (int n = 1; n < before->count; n++) {
        bool there = after->instruction[n].kind != KIND_NOTHING;
        if (there == needed[n] || before->instruction[n].kind == KIND_NOTHING)
            continue;
        printf(there ? "%s is there still, and no store needs it\n" : "%s was removed, and is needed\n",
               describe(before, n));
        return false;
    }
    return true;
}

/* --- Passes on one program --- */

typedef bool invariant(const struct program *before, const struct program *after);

static bool check_pass(struct program *program, const char *name, int pass(struct program *),
                       invariant *holds)
{
    static struct program before;
    before = *program;
    int returned = pass(program);
    if (!holds(&before, program) || !same_results(&before, program) ||
        !check_returned(name, returned, removed(&before, program)))
        return false;
    returned = pass(program);
    if (returned)
        printf("a second run of %s removes %d more, expected 0\n", name, returned);
    return !returned;
}

static bool check_random(const char *name, int pass(struct program *), invariant *holds)
{
    static struct program program;
    for (int i = 0; i < 300; i++) {
        random_program(&program);
        if (!check_pass(&program, name, pass, holds))
            return false;
    }
    return true;
}

static int check_copy(const char *file)
{
    static struct program program;
    if (!check_random("pass_copy", pass_copy, without_copies) || !read_program(&program, file))
        return 1;
    printf("the recording has %d instructions, %d of them copies\n", program.count - 1,
           count_kind(&program, KIND_COPY));
    return !check_pass(&program, "pass_copy", pass_copy, without_copies);
}

static int check_dead(const char *file)
{
    static struct program program;
    if (!check_random("pass_dead", pass_dead, without_dead) || !read_program(&program, file))
        return 1;
    pass_copy(&program);
    int before = count_kind(&program, KIND_NOTHING);
    if (!check_pass(&program, "pass_dead", pass_dead, without_dead))
        return 1;
    printf("%d of %d instructions are dead although the colour is stored\n",
           count_kind(&program, KIND_NOTHING) - before, program.count - 1);
    return 0;
}

static int square_roots(const struct program *program)
{
    int count = 0;
    for (int n = 0; n < program->count; n++)
        count += program->instruction[n].kind != KIND_NOTHING &&
                 !strcmp(program->instruction[n].operation, "sqrt_f");
    return count;
}

static bool is_color(const struct instruction *i)
{
    return i->kind == KIND_STORE && !strncmp(i->place, "OUTPUT diffuse[", 15);
}

static int check_color(const char *file)
{
    static struct program program, before;
    if (!read_program(&program, file))
        return 1;
    pass_copy(&program);
    pass_dead(&program);
    before = program;
    int roots = square_roots(&program), returned = remove_color(&program);
    for (int n = 0; n < program.count; n++)
        if ((program.instruction[n].kind != before.instruction[n].kind) != is_color(before.instruction + n)) {
            printf("%s to %s: expected only stores of the colour to be removed, and all of them\n",
                   describe(&before, n), before.instruction[n].place);
            return 1;
        }
    if (!check_returned("remove_color", returned, 4))
        return 1;
    before = program;
    int gone = pass_dead(&program);
    printf("without the colour %d more instructions go, %d remain; square roots: %d before, %d after\n", gone,
           program.count - 1 - count_kind(&program, KIND_NOTHING), roots, square_roots(&program));
    if (gone <= 40 || square_roots(&program) || !roots) {
        puts("expected more than 40 to go, and no square root to stay");
        return 1;
    }
    if (pass_copy(&program) || pass_dead(&program)) {
        puts("expected a second run to change nothing");
        return 1;
    }
    return !without_dead(&before, &program) || !same_results(&before, &program);
}

/* A chain: only the next instruction uses each, and nothing uses the last. */
static int run(int count)
{
    static struct program program;
    program.count = count < PROGRAM_MAXIMUM ? count : PROGRAM_MAXIMUM;
    for (int n = 1; n < program.count; n++)
        program.instruction[n] = (struct instruction){.kind = KIND_VALUE, .operand = {n - 1}};
    return pass_dead(&program) != program.count - 1;
}

int main(int count, char **argument)
{
    const char *command = count == 3 ? argument[1] : "";
    _mm_setcsr(_mm_getcsr() | 0x8040); /* denormal operands and results are zero */
    if (!strcmp(command, "copy"))
        return check_copy(argument[2]);
    if (!strcmp(command, "dead"))
        return check_dead(argument[2]);
    if (!strcmp(command, "color"))
        return check_color(argument[2]);
    if (!strcmp(command, "run"))
        return run(atoi(argument[2]));
    fputs("usage: check copy FILE | dead FILE | color FILE | run COUNT\n", stderr);
    return 2;
}
