/* The program of lab 8's check. FILE is a program, as `triptych dump --show hoist` prints it.
 *
 *   check intervals         find_intervals, for random programs
 *   check places            the proof that each operand is found in its place
 *   check few               the number of values in slots, and the number of slots
 *   check table FILE        both numbers for 4, 8 and 16 registers
 *   check draw FILE         the intervals and places for 8 registers
 *
 * Ends with 1, after a line with what was expected, if something is wrong. */
#include "registers.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Programs --- */

static uint32_t state = 1;

static int below(int limit)
{
    state = state * 1664525 + 1013904223;
    return (int)((state >> 8) % (uint32_t)limit);
}

/* Every value has a use: those without one are stored at the end. */
static void random_program(struct program *program)
{
    static bool used[PROGRAM_MAXIMUM];
    int values = 5 + below(60), reach = 2 + below(30);
    memset(program, 0, sizeof *program);
    memset(used, 0, sizeof used);
    for (int n = 1; n <= values; n++) {
        program->instruction[n].has_value = true;
        for (int o = 0; o < OPERANDS && n > 1; o++) {
            int from = n - 1 - below(n - 1 < reach ? n - 1 : reach);
            program->instruction[n].operand[o] = below(3) ? from : 0;
            used[program->instruction[n].operand[o]] = true;
        }
    }
    program->count = values + 1;
    for (int n = 1; n <= values; n++)
        if (!used[n])
            program->instruction[program->count++].operand[0] = n;
}

/* Literals, and words that a routine reads from memory, are operands in memory: they need no register. */
static bool is_in_memory(const char *operation)
{
    return !strcmp(operation, "literal") || !strcmp(operation, "uniform") || !strcmp(operation, "constant");
}

static bool is_type(const char *word)
{
    return !strcmp(word, "flt") || !strcmp(word, "itg") || !strcmp(word, "fix") || !strcmp(word, "msk");
}

/* The new number of each instruction of the text; 0 for those in memory. */
static int renumbered[65536];

static void parse(struct program *program, char *line)
{
    char *end = strchr(line, ';'), *word = strtok(line, " \n");
    int number = word ? atoi(word) : 0, operands = 0;
    if (!end || number <= 0 || number > 65535 || program->count >= PROGRAM_MAXIMUM)
        return;
    *end = 0;
    struct instruction *i = program->instruction + program->count;
    word = strtok(NULL, " \n");
    if (word && is_type(word)) {
        i->has_value = true;
        word = strtok(NULL, " \n");
    }
    if (!word || is_in_memory(word)) {
        *i = (struct instruction){.has_value = false};
        return;
    }
    while ((word = strtok(NULL, " \n")))
        if (*word == '%' && operands < OPERANDS)
            i->operand[operands++] = renumbered[atoi(word + 1) & 65535];
    renumbered[number] = i->has_value ? program->count : 0;
    program->count++;
}

/* Values without a use are left out of the proof: they have no interval. */
static bool read_program(struct program *program, const char *name)
{
    static bool used[PROGRAM_MAXIMUM];
    char line[400];
    FILE *file = fopen(name, "r");
    memset(program, 0, sizeof *program);
    program->count = 1;
    while (file && fgets(line, sizeof line, file))
        parse(program, line);
    if (file)
        fclose(file);
    for (int n = program->count - 1; n > 0; n--) {
        struct instruction *i = program->instruction + n;
        i->has_value &= used[n];
        for (int o = 0; o < OPERANDS; o++)
            used[i->operand[o]] = true;
    }
    if (program->count < 2)
        printf("%s: found no instruction, expected a program\n", name);
    return program->count > 1;
}

/* --- Intervals --- */

static void expected_intervals(const struct program *program, struct interval *interval)
{
    for (int n = 1; n < program->count; n++) {
        interval[n] = (struct interval){n, n};
        for (int o = 0; o < OPERANDS; o++)
            interval[program->instruction[n].operand[o]].last = n;
    }
}

static int check_intervals(void)
{
    static struct program program;
    static struct interval expected[PROGRAM_MAXIMUM], found[PROGRAM_MAXIMUM];
    for (int round = 0; round < 1000; round++) {
        random_program(&program);
        expected_intervals(&program, expected);
        memset(found, 0x7f, sizeof found);
        find_intervals(&program, found);
        for (int n = 1; n < program.count; n++)
            if (program.instruction[n].has_value &&
                (found[n].first != expected[n].first || found[n].last != expected[n].last)) {
                printf("value %d: the interval is %d to %d, expected %d to %d\n", n, found[n].first,
                       found[n].last, expected[n].first, expected[n].last);
                return 1;
            }
    }
    return 0;
}

/* --- The proof: a machine whose registers and slots contain the names of values --- */

struct machine {
    int reg[PROGRAM_MAXIMUM], slot[PROGRAM_MAXIMUM];
};

static int *cell(struct machine *m, const struct place *place)
{
    return place->reg != NOWHERE ? m->reg + place->reg : m->slot + place->slot;
}

static bool is_place(int value, const struct place *place, int registers, int slots)
{
    bool in_register = place->reg >= 0 && place->reg < registers && place->slot == NOWHERE;
    bool in_slot = place->slot >= 0 && place->slot < slots && place->reg == NOWHERE;
    if (!in_register && !in_slot)
        printf("value %d: register %d, slot %d; expected one of %d registers or of %d slots, and -1\n", value,
               place->reg, place->slot, registers, slots);
    return in_register || in_slot;
}

static bool proof(const struct program *program, const struct place *place, int registers, int slots)
{
    static struct machine m;
    memset(&m, 0, sizeof m);
    for (int n = 1; n < program->count; n++) {
        const struct instruction *i = program->instruction + n;
        for (int o = 0; o < OPERANDS; o++) {
            int value = i->operand[o];
            if (value && *cell(&m, place + value) != value) {
                printf("%d registers: instruction %d needs value %d and finds value %d in its place, %s %d\n",
                       registers, n, value, *cell(&m, place + value),
                       place[value].reg != NOWHERE ? "register" : "slot",
                       place[value].reg != NOWHERE ? place[value].reg : place[value].slot);
                return false;
            }
        }
        if (!i->has_value)
            continue;
        if (!is_place(n, place + n, registers, slots))
            return false;
        *cell(&m, place + n) = n;
    }
    return true;
}

struct result {
    int spilled, slots;
};

static bool run(const struct program *program, int registers, struct place *place, struct result *result)
{
    static struct interval interval[PROGRAM_MAXIMUM];
    expected_intervals(program, interval);
    for (int n = 0; n < PROGRAM_MAXIMUM; n++)
        place[n] = (struct place){-2, -2};
    result->slots = allocate(program, interval, registers, place);
    if (result->slots < 0 || result->slots > PROGRAM_MAXIMUM) {
        printf("allocate returns %d, expected the number of slots\n", result->slots);
        return false;
    }
    result->spilled = 0;
    for (int n = 1; n < program->count; n++)
        result->spilled += program->instruction[n].has_value && place[n].reg == NOWHERE;
    return proof(program, place, registers, result->slots);
}

static int check_places(void)
{
    static struct program program;
    static struct place place[PROGRAM_MAXIMUM];
    struct result result;
    for (int round = 0; round < 1000; round++) {
        random_program(&program);
        if (!run(&program, 1 + below(16), place, &result))
            return 1;
    }
    return 0;
}

/* --- The fewest --- */

/* The fewest values that must leave so that at most `room` of the others overlap anywhere. From front to
 * back, the one that ends last leaves wherever there are too many. */
static int fewest(const struct program *program, const struct interval *interval, int room)
{
    static bool gone[PROGRAM_MAXIMUM];
    int count = 0;
    memset(gone, 0, sizeof gone);
    for (int n = 1; n < program->count; n++) {
        int alive = 0, furthest = 0;
        for (int v = 1; v <= n; v++)
            if (program->instruction[v].has_value && !gone[v] && interval[v].last > n) {
                alive++;
                furthest = !furthest || interval[v].last > interval[furthest].last ? v : furthest;
            }
        if (alive > room) {
            gone[furthest] = true;
            count++;
        }
    }
    return count;
}

/* The largest number of values in slots that are alive together. */
static int overlap(const struct program *program, const struct interval *interval, const struct place *place)
{
    int most = 0;
    for (int n = 1; n < program->count; n++) {
        int alive = 0;
        for (int v = 1; v <= n; v++)
            alive += program->instruction[v].has_value && place[v].reg == NOWHERE && interval[v].last > n;
        most = alive > most ? alive : most;
    }
    return most;
}

static bool check_fewest(const struct program *program, int registers, struct result *result)
{
    static struct interval interval[PROGRAM_MAXIMUM];
    static struct place place[PROGRAM_MAXIMUM];
    if (!run(program, registers, place, result))
        return false;
    expected_intervals(program, interval);
    int spilled = fewest(program, interval, registers), slots = overlap(program, interval, place);
    if (result->spilled != spilled)
        printf("%d registers: %d values are in slots, expected %d: the fewest\n", registers, result->spilled,
               spilled);
    else if (result->slots != slots)
        printf("%d registers: %d values in %d slots, expected %d slots: the most that are alive together\n",
               registers, result->spilled, result->slots, slots);
    return result->spilled == spilled && result->slots == slots;
}

static int check_few(void)
{
    static struct program program;
    struct result result;
    for (int round = 0; round < 500; round++) {
        random_program(&program);
        if (!check_fewest(&program, 1 + below(12), &result))
            return 1;
    }
    return 0;
}

static int table(const char *name)
{
    static struct program program;
    if (!read_program(&program, name))
        return 1;
    for (int registers = 4; registers <= 16; registers *= 2) {
        struct result result;
        if (!check_fewest(&program, registers, &result))
            return 1;
        printf("%d %d %d\n", registers, result.spilled, result.slots);
    }
    return 0;
}

static int draw(const char *name)
{
    static struct program program;
    static struct interval interval[PROGRAM_MAXIMUM];
    static struct place place[PROGRAM_MAXIMUM];
    struct result result;
    if (!read_program(&program, name) || !run(&program, 8, place, &result))
        return 1;
    expected_intervals(&program, interval);
    for (int n = 1; n < program.count; n++) {
        if (!program.instruction[n].has_value)
            continue;
        bool in_register = place[n].reg != NOWHERE;
        printf("%4d to %4d  %s%-3d %*s", n, interval[n].last, in_register ? "r" : "m",
               in_register ? place[n].reg : place[n].slot, n / 2, "");
        for (int at = n; at < interval[n].last; at += 2)
            putchar(in_register ? '=' : '.');
        putchar('\n');
    }
    return 0;
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    if (!strcmp(command, "intervals"))
        return check_intervals();
    if (!strcmp(command, "places"))
        return check_places();
    if (!strcmp(command, "few"))
        return check_few();
    if (!strcmp(command, "table") && count == 3)
        return table(argument[2]);
    if (!strcmp(command, "draw") && count == 3)
        return draw(argument[2]);
    fputs("usage: check intervals | places | few | table FILE | draw FILE\n", stderr);
    return 2;
}
