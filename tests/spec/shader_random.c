/* Random shaders of many instructions, with conditions, loops, breaks, predication, relative addresses, modifiers and
 * masks, mean the same in
 * every way and on every engine, to the bit. */
#include "tests/support/seed.h"
#include "tests/support/trial.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { TEXT = 1 << 14, REGISTERS = 8, CONSTANTS = 8, SHADERS = 24, DEPTH = 4 };

static char text[TEXT];
static uint64_t seed;

void setUp(void)
{
}

void tearDown(void)
{
}

static unsigned below(unsigned limit)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (unsigned)((seed * 0x2545f4914f6cdd1dull >> 32) * limit >> 32);
}

static void put(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void put(const char *format, ...)
{
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, TEXT - used, format, arguments);
    va_end(arguments);
    TEST_ASSERT_TRUE(strlen(text) < TEXT - 1);
}

/* --- Operands ---------------------------------------------------------------------------------------------
 */

static int constants_left; /* an instruction can read one */
static int counters;       /* loops with aL around it */
static char stage;         /* v or p */
static int third;          /* models 3.0, which have more modifiers and room */
static int lines_left, loops_left;

static void put_components(unsigned count)
{
    put(".");
    for (unsigned c = 0; c < count; c++)
        put("%c", "xyzw"[below(4)]);
}

static void put_constant(void)
{
    if (stage == 'v' && counters && below(2))
        put("c[aL + %u]", below(CONSTANTS));
    else if (stage == 'v' && !below(3))
        put("c[a0.%c + %u]", "xyzw"[below(4)], below(CONSTANTS));
    else
        put("c%u", below(CONSTANTS));
}

enum { ANY_SWIZZLE, SCALAR, NO_SWIZZLE };

static void put_source(int kind, unsigned apart)
{
    unsigned number = below(REGISTERS);
    const char *behind = !third || below(4) ? "" : "_abs";
    if (number == apart)
        number = (number + 1) % REGISTERS;
    put(", %s", below(3) ? "" : "-");
    if (constants_left && !below(4)) {
        put_constant();
        put("%s", behind);
        constants_left--;
    } else
        put("r%u%s", number, behind);
    if (kind == SCALAR || (kind == ANY_SWIZZLE && !below(3)))
        put_components(kind == SCALAR ? 1 : 4);
}

static void put_mask(void)
{
    unsigned mask = below(16);
    if (!mask || mask == 15)
        return;
    put(".");
    for (int c = 0; c < 4; c++)
        if (mask >> c & 1)
            put("%c", "xyzw"[c]);
}

/* --- Instructions -----------------------------------------------------------------------------------------
 */

static const struct instruction {
    const char *name;
    int sources, kind, saturates;
    const char *mask; /* the one that it takes, or null: any */
    const char *stages;
} instructions[] = {
    {"mov", 1, ANY_SWIZZLE, 1, NULL, "vp"},  {"add", 2, ANY_SWIZZLE, 1, NULL, "vp"},
    {"sub", 2, ANY_SWIZZLE, 1, NULL, "vp"},  {"mul", 2, ANY_SWIZZLE, 1, NULL, "vp"},
    {"mad", 3, ANY_SWIZZLE, 1, NULL, "vp"},  {"dp3", 2, ANY_SWIZZLE, 1, NULL, "vp"},
    {"dp4", 2, ANY_SWIZZLE, 1, NULL, "vp"},  {"min", 2, ANY_SWIZZLE, 1, NULL, "vp"},
    {"max", 2, ANY_SWIZZLE, 1, NULL, "vp"},  {"lrp", 3, ANY_SWIZZLE, 1, NULL, "vp"},
    {"frc", 1, ANY_SWIZZLE, 0, NULL, "vp"},  {"abs", 1, ANY_SWIZZLE, 1, NULL, "vp"},
    {"rcp", 1, SCALAR, 1, NULL, "vp"},       {"rsq", 1, SCALAR, 1, NULL, "vp"},
    {"exp", 1, SCALAR, 1, NULL, "vp"},       {"log", 1, SCALAR, 1, NULL, "vp"},
    {"pow", 2, SCALAR, 1, NULL, "vp"},       {"sincos", 1, SCALAR, 0, ".xy", "vp"},
    {"crs", 2, NO_SWIZZLE, 1, ".xyz", "vp"}, {"nrm", 1, ANY_SWIZZLE, 1, ".xyz", "vp"},
    {"slt", 2, ANY_SWIZZLE, 1, NULL, "v"},   {"sge", 2, ANY_SWIZZLE, 1, NULL, "v"},
    {"lit", 1, ANY_SWIZZLE, 1, NULL, "v"},   {"dst", 2, ANY_SWIZZLE, 1, NULL, "v"},
    {"expp", 1, SCALAR, 1, NULL, "v"},       {"cmp", 3, ANY_SWIZZLE, 1, NULL, "p"},
};

static void put_instruction(void)
{
    const struct instruction *i;
    do
        i = &instructions[below(sizeof instructions / sizeof *instructions)];
    while (!strchr(i->stages, stage) || (!third && !strcmp(i->name, "sincos")));
    unsigned result = below(REGISTERS);
    int apart = !strcmp(i->name, "crs") || !strcmp(i->name, "nrm");
    if (!below(3))
        put("(%sp0%s) ", below(2) ? "!" : "", below(2) ? "" : ".y");
    put("%s%s r%u", i->name, i->saturates && (third || stage == 'p') && !below(4) ? "_sat" : "", result);
    if (i->mask)
        put("%s", i->mask);
    else
        put_mask();
    constants_left = 1;
    for (int source = 0; source < i->sources; source++)
        put_source(i->kind, apart ? result : REGISTERS);
    put("\n");
}

static const char *comparison(void)
{
    return shader_word_name(shader_comparisons, 1 + below(6));
}

static void put_comparison(const char *name)
{
    put("%s_%s r%u.%c", name, comparison(), below(REGISTERS), "xyzw"[below(4)]);
    constants_left = 1;
    put_source(SCALAR, REGISTERS);
    put("\n");
}

static void put_block(int depth, int loops, unsigned length);

static void put_condition(int depth, int loops)
{
    if (below(3))
        put_comparison("if");
    else
        put("if %sp0.%c\n", below(2) ? "!" : "", "xyzw"[below(4)]);
    put_block(depth + 1, loops, below(5));
    if (below(2)) {
        put("else\n");
        put_block(depth + 1, loops, below(5));
    }
    put("endif\n");
}

static void put_setp(void)
{
    put("setp_%s p0", comparison());
    put_mask();
    constants_left = 1;
    put_source(ANY_SWIZZLE, REGISTERS);
    put_source(ANY_SWIZZLE, REGISTERS);
    put("\n");
}

static void put_loop(int depth, int loops)
{
    int counts = (stage == 'v' || third) && below(2);
    put(counts ? "loop aL, i%u\n" : "rep i%u\n", below(4));
    counters += counts;
    put_block(depth + 1, loops + 1, 1 + below(5));
    counters -= counts;
    put(counts ? "endloop\n" : "endrep\n");
}

static void put_address(void)
{
    put("mova a0");
    put_mask();
    put(", r%u\n", below(REGISTERS));
}

/* Lines, or blocks of them. */
static void put_block(int depth, int loops, unsigned length)
{
    for (unsigned i = 0; i < length && lines_left-- > 0; i++) {
        unsigned which = below(16);
        if (which == 0 && depth < DEPTH)
            put_condition(depth, loops);
        else if (which == 1 && depth < DEPTH && loops < 2 && loops_left-- > 0)
            put_loop(depth, loops);
        else if (which == 2 && loops)
            put_comparison("break");
        else if (which == 3)
            put_setp();
        else if (which == 4 && stage == 'v')
            put_address();
        else
            put_instruction();
    }
}

static void try_shader(const char *model, unsigned number)
{
    static const int32_t integers[4][4] = {{0}, {1, 3, 1, 0}, {2, 0, 2, 0}, {5, 9, -3, 0}};
    static float constants[CONSTANTS][4];
    static struct trial_operands operands[40];
    stage = model[0];
    third = model[3] == '3';
    counters = 0;
    lines_left = third ? 300 : 50;
    loops_left = third ? 20 : 4;
    seed = (test_seed() + number) * 0x9e3779b97f4a7c15ull | 1;
    text[0] = 0;
    for (unsigned i = 0; i < CONSTANTS * 4; i++)
        constants[i / 4][i % 4] = (float)below(4096) / 512.0f - 4;
    for (unsigned s = 0; s < 40; s++)
        operands[s] =
            s < 20 ? trial_edges[below(trial_edge_sets)] : trial_ordinary[below(trial_ordinary_sets)];
    for (unsigned r = 0; r < REGISTERS; r++)
        if (r < 1 || r > TRIAL_OPERANDS)
            put("mov r%u, r%u.%s\n", r, 1 + r % 3, r % 2 ? "wzyx" : "yzwx");
    put("setp_ge p0, r1, r2\n");
    if (stage == 'v')
        put("mova a0, r2\n");
    put_block(third ? 0 : 2, 0, 10 + below(!third ? 10 : number % 8 ? 30 : 90));
    text[strlen(text) - 1] = 0;
    struct trial trial = {.model = model,
                          .body = text,
                          .results = 4,
                          .sets = 40,
                          .operands = operands,
                          .constant = (const float(*)[4])constants,
                          .constants = CONSTANTS,
                          .integer = integers,
                          .integers = 4,
                          .legacy = number % 3 == 0};
    trial_expect_agreement(&trial);
}

static void random_vertex_shaders_mean_the_same_everywhere(void)
{
    for (unsigned number = 1; number <= SHADERS; number++)
        try_shader(number % 4 ? "vs_3_0" : "vs_2_x", number);
}

static void random_pixel_shaders_mean_the_same_everywhere(void)
{
    for (unsigned number = 1; number <= SHADERS; number++)
        try_shader(number % 4 ? "ps_3_0" : "ps_2_x", SHADERS + number);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(random_vertex_shaders_mean_the_same_everywhere);
    RUN_TEST(random_pixel_shaders_mean_the_same_everywhere);
    return UNITY_END();
}
