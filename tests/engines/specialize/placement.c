/* Allocation under register pressure. Random programs, and routines of random keys, of all shaders of
 * tests/data/shaders, of random shaders and of all streams are compiled with few registers and random
 * choices. The test proves that their code reads the right values (tests/support/routine/placement.h), and
 * compares results with the interpreter, or with the same routine without register pressure.
 *
 * TRIPTYCH_SEED selects other programs, registers and choices. */
#include "base/bits.h"
#include "machine/code.h"
#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "contract/lane.h"
#include "engines/specialize/specialize.h"
#include "tests/support/avx512/avx512.h"
#include "tests/support/differential/differential.h"
#include "tests/support/differential/span_runs.h"
#include "tests/support/routine/placement.h"
#include "tests/support/shader/program.h"
#include "tests/support/routine/routines.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stdio.h>
#include <string.h>

enum { PROGRAMS = 1500 };

static struct code_arena *arena;
static struct builder *builder;
static struct program_data given, expected, got;
static struct ir made;
static char message[700];

void setUp(void)
{
    struct error error = {{0}};
    if (!cpu_has_avx2_fma())
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    arena = code_create(0, NULL, &error);
    builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
    if (test_stride() == 1) /* sanitizers do not check generated code */
        avx512_begin(arena);
}

void tearDown(void)
{
    if (!arena)
        return;
    avx512_end();
    if (builder)
        specialize_give(builder);
    code_destroy(arena);
    arena = NULL;
    builder = NULL;
}

/* Removes random registers from a set until `count` are left. Returns the set. */
static uint64_t random_registers(uint64_t registers, unsigned size, uint64_t *seed)
{
    for (unsigned left = (unsigned)__builtin_popcountll(registers); left > size; left--) {
        uint64_t from = registers;
        for (unsigned n = program_random(seed) % left; n; n--) /* removes the n-th of the rest */
            from &= from - 1;
        registers &= ~(from & -from);
    }
    return registers;
}

/* Any subset of the registers, masks included. */
static struct register_file random_file(unsigned width, uint64_t *seed)
{
    static const uint8_t sizes[] = {13, 29, 8, 5, 3, 2, 1, 0}, masks[] = {6, 6, 3, 2, 1, 0};
    struct register_file file = {.wide = width == 16, .scalar = width == 1};
    unsigned size = sizes[program_random(seed) % sizeof sizes];
    unsigned count = masks[program_random(seed) % sizeof masks];
    file.without = ~(random_registers(file.wide ? WIDE_REGISTERS : NARROW_REGISTERS, size, seed) |
                     random_registers(MASK_REGISTERS, count, seed));
    file.seed = program_random(seed) % 4 ? program_random(seed) : 0;
    file.allocator = program_random(seed) % 2 ? program_random(seed) % ALLOCATORS : ALLOCATOR_scan;
    return file;
}

static void fail(uint64_t number, unsigned width, const struct register_file *file, const char *what)
{
    snprintf(message, sizeof message,
             "program %llu, %u lanes, allocator %s, without registers 0x%llx, lots %llu: %s",
             (unsigned long long)number, width, allocate_name(file->allocator),
             (unsigned long long)file->without, (unsigned long long)file->seed, what);
    TEST_FAIL_MESSAGE(message);
}

static void expect_same(uint64_t number, unsigned width, const struct register_file *file)
{
    char what[120];
    int at = program_difference(&expected, &got);
    if (at < 0)
        return;
    snprintf(what, sizeof what, "lane %d of slot %d: expected %08x, got %08x", at % VERTEX_CAPACITY,
             at / VERTEX_CAPACITY, bits_of_float(expected.output[at]), bits_of_float(got.output[at]));
    fail(number, width, file, what);
}

/* Every fourth program has one lane. */
static unsigned choose_width(uint64_t number)
{
    return number % 4 == 3 ? 1 : program_width(number);
}

typedef void generator(struct ir *, unsigned length, uint64_t *seed);

/* Makes program `number`, optimises it with some set of passes, and computes its results. Returns the lanes
 * of a register. */
static unsigned prepare(generator *make, uint64_t number, unsigned longest, uint64_t *seed)
{
    static const uint32_t disabled[] = {0, ~0u, 0, 1u << PASS_phi};
    unsigned width = choose_width(number), parts = program_parts(number, width);
    *seed = test_seed() + number * 0x9e3779b97f4a7c15ull;
    *seed |= !*seed;
    make(&builder->ir, 3 + program_random(seed) % longest, seed);
    TEST_ASSERT_NULL(ir_verify(&builder->ir));
    program_fill(&given, seed);
    expected = given;
    ir_duplicate(&made, &builder->ir);
    unsigned saved = mxcsr_enter();
    builder->pass.lanes = width;
    builder->pass.parts = parts;
    pass_run_all(&builder->ir, &builder->pass,
                 pass_select(PROFILE_FULL, 0, disabled[program_random(seed) % 4]), NULL, NULL);
    mxcsr_leave(saved);
    program_interpret(&made, &expected, width * builder->ir.parts);
    return width;
}

static void try_program(generator *make, uint64_t number, unsigned longest)
{
    struct error error = {{0}};
    uint64_t seed;
    unsigned width = prepare(make, number, longest, &seed);
    struct register_file file = random_file(width, &seed);
    got = given;
    if (program_compile_with(builder, arena, width, &file, &got, &error))
        fail(number, width, &file, error.text);
    const char *wrong = placement_check(builder);
    if (wrong)
        fail(number, width, &file, wrong);
    expect_same(number, width, &file);
}

static void test_straight_programs(void)
{
    for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 9); n++)
        try_program(program_make, n, 100);
}

static void test_programs_with_loops_and_variables(void)
{
    for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 9); n++)
        try_program(program_make_loops, n, 40);
}

static void test_programs_with_forms_that_recordings_lack(void)
{
    for (uint64_t n = 1; n <= test_share_of(PROGRAMS, 9); n++)
        try_program(program_make_wild, n, 50);
}

/* --- Routines ------------------------------------------------------------------------------------------ */

static struct differential *differential;
static struct build_options options;
static uint64_t lots;
static unsigned visited, stretched;

static struct routine *build_under_pressure(const struct engine *self, struct code_arena *where,
                                            enum unit unit, const union key *key, struct error *error)
{
    (void)self;
    struct routine *routine = specialize_routine(&engine_specialize, &options, where, unit, key, error);
    if (routine || !strstr(error->text, "too many pointers"))
        return routine;
    options.addresses = ADDRESSES_LOADED;
    error_clear(error);
    return specialize_routine(&engine_specialize, &options, where, unit, key, error);
}

static struct build_options default_options(unsigned width)
{
    return (struct build_options){.width = width,
                                  .parts = program_parts(visited, width),
                                  .profile = PROFILE_FULL,
                                  .calls = visited % 2 ? CALLS_SAMPLING : CALLS_INLINE};
}

static struct build_options random_options(unsigned width)
{
    struct build_options random = {.width = width,
                                   .parts = program_parts(program_random(&lots), width),
                                   .profile = program_random(&lots) % 4 ? PROFILE_FULL : PROFILE_THESIS,
                                   .file = random_file(width, &lots)};
    random.allocator = random.file.allocator;
    random.addresses = (enum addresses)(program_random(&lots) % 3);
    random.calls = (enum calls)(program_random(&lots) % 3);
    return random;
}

/* Builds the key's code with the options, and proves it. Returns false if a recording has fewer operations
 * than the key needs; every engine refuses such a key. */
static bool expect_placed(enum unit unit, const union key *key)
{
    struct error error = {{0}};
    char text[KEY_TEXT_CAPACITY];
    static char complaint[KEY_TEXT_CAPACITY + 1000];
    const char *wrong = error.text;
    if (specialize_code(builder, &options, unit, key, NULL, NULL, &error)) {
        stretched += builder->ir.stretch_words != 0;
        wrong = placement_check(builder);
    } else if (strstr(error.text, "too many pointers"))
        wrong = NULL;
    else if (strstr(error.text, "operations"))
        return false;
    snprintf(complaint, sizeof complaint,
             "%u lanes, %u parts, allocator %s, without registers 0x%llx, lots %llu: %s; %s key: %s",
             options.width, options.parts, allocate_name(options.allocator),
             (unsigned long long)options.file.without, (unsigned long long)options.file.seed,
             wrong ? wrong : "", unit_name[unit], key_print(unit, key, text));
    TEST_ASSERT_NULL_MESSAGE(wrong, complaint);
    return true;
}

/* Checks a routine with the default allocation, and with random registers and choices. Executes every third
 * routine with these. */
static void check_widths(const unsigned width[2], enum unit unit, const union key *key)
{
    struct engine pressed = engine_specialize;
    const struct engine *engines[] = {&engine_specialize, &pressed};
    pressed.name = "specialize under pressure";
    pressed.build = build_under_pressure;
    options = default_options(width[0]);
    if (!expect_placed(unit, key))
        return;
    options = random_options(width[1]);
    if (!expect_placed(unit, key))
        return;
    const char *found = visited++ % 3 ? NULL : differential_run(differential, engines, 2, unit, key, lots);
    if (found)
        TEST_FAIL_MESSAGE(found);
}

static void check_routine(void *context, enum unit unit, const union key *key)
{
    static unsigned number;
    (void)context;
    if (number++ % test_stride_of(7))
        return;
    check_widths((unsigned[]){choose_width(visited), choose_width(program_random(&lots))}, unit, key);
}

static void begin_routines(void)
{
    visited = stretched = 0;
    lots = test_seed();
    differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
}

static void test_routines(void)
{
    begin_routines();
    visit_random_keys(test_share_of(450, 9), lots, check_routine, NULL);
    visit_shaders(lots, check_routine, NULL);
    visit_random_shaders(20 * test_share_of(200, 9), lots, check_routine, NULL);
    visit_streams(check_routine, NULL);
    differential_destroy(differential);
    TEST_ASSERT_GREATER_THAN(test_share_of(1000, 63), visited);
}

/* A key of the span reading with one texture, filtered so that most keys have stretched rows. The operations
 * after the filter are random. */
static void random_span(union key *key)
{
    static const uint8_t address[] = {ADDRESS_CLAMP, ADDRESS_WRAP_POWER},
                         compact[] = {COMPACT_NONE, COMPACT_A8};
    union key random;
    differential_key(UNIT_PIXEL, &lots, &random);
    *key =
        span_textured(FILTER_LINEAR, address[program_random(&lots) % 2], compact[program_random(&lots) % 2]);
    if (program_random(&lots) % 8 == 0)
        key->pixel.address_u[0] = key->pixel.address_v[0] = random.pixel.address_u[0];
    if (program_random(&lots) % 8 == 0)
        key->pixel.compact[0] = (uint8_t)(program_random(&lots) % COMPACT_COUNT);
    for (unsigned i = 0; i < BLEND_CHANNELS; i++) {
        key->pixel.blend[i] = random.pixel.blend[i];
        key->pixel.source_factor[i] = random.pixel.source_factor[i];
        key->pixel.target_factor[i] = random.pixel.target_factor[i];
    }
    key->pixel.color_stage[0] = random.pixel.color_stage[0];
    key->pixel.alpha_stage[0] = random.pixel.alpha_stage[0];
    key->pixel.varying[VARYING_diffuse] = random.pixel.varying[VARYING_diffuse];
}

/* Few random keys have stretched rows, and only with eight lanes. */
static void test_stretched_rows(void)
{
    const unsigned count = test_share_of(400, 9);
    begin_routines();
    for (unsigned n = 0; n < count; n++) {
        const unsigned width = n % 4 || !avx512_runs() ? 8 : 16;
        union key key;
        random_span(&key);
        check_widths((unsigned[]){width, width}, UNIT_PIXEL, &key);
    }
    differential_destroy(differential);
    TEST_ASSERT_GREATER_THAN(count / 4, stretched);
}

/* --- Sabotage ------------------------------------------------------------------------------------------ */

enum { ANOTHER_REGISTER, ANOTHER_SLOT, NO_RELOAD, NO_STORE, LOST_INSTRUCTION, DAMAGES };

/* A value that is in a register at first; a spilled one if the damage concerns spills. */
static unsigned choose_victim(unsigned damage, uint64_t *seed)
{
    const struct allocation *a = &builder->allocation;
    for (unsigned tries = 0; tries < 200; tries++) {
        unsigned value = 1 + program_random(seed) % (builder->ir.count - 1);
        if (a->residence[value] != RESIDENCE_REGISTER || allocate_web(a, value) != value)
            continue;
        if (damage == ANOTHER_REGISTER || damage == LOST_INSTRUCTION || a->slot[value] != NO_SLOT)
            return value;
    }
    return 0;
}

/* The encoder does not accept a gather whose result is its index. */
static int gathers_can_be_encoded(void)
{
    const struct allocation *a = &builder->allocation;
    for (uint32_t n = 1; n < builder->ir.count; n++)
        if (builder->ir.instruction[n].op == IR_gather && a->reg[n] != NO_REGISTER &&
            a->reg[n] == a->reg[allocate_web(a, builder->ir.instruction[n].operand[0])])
            return 0;
    return 1;
}

static bool is_moved_to(unsigned web)
{
    const struct allocation *a = &builder->allocation;
    for (unsigned value = web; value; value = a->webs ? a->member[value] : 0)
        if (builder->ir.instruction[value].op == IR_phi || builder->ir.instruction[value].op == IR_join)
            return true;
    return false;
}

/* Parallel moves never end if two of them have the same destination. */
static int moves_can_be_written(unsigned victim)
{
    const struct allocation *a = &builder->allocation;
    for (uint32_t n = 1; is_moved_to(victim) && n < builder->ir.count; n++)
        if (a->residence[n] == RESIDENCE_REGISTER && n != victim && allocate_web(a, n) == n &&
            is_moved_to(n) &&
            (a->reg[n] == a->reg[victim] || (a->slot[n] != NO_SLOT && a->slot[n] == a->slot[victim])))
            return 0;
    return 1;
}

static int damage_allocation(unsigned damage, uint64_t *seed)
{
    struct allocation *a = &builder->allocation;
    unsigned victim = choose_victim(damage, seed), first;
    if (!victim)
        return 0;
    switch (damage) {
    case ANOTHER_REGISTER:
        first = a->reg[victim] < MASKS ? 0 : MASKS + 1;
        a->reg[victim] = (uint8_t)(first + (a->reg[victim] - first + 1 + program_random(seed) % 2) % 3);
        break;
    case ANOTHER_SLOT: a->slot[victim] = (uint16_t)(program_random(seed) % a->slots); break;
    case NO_RELOAD: a->split[victim] = NEVER; break;
    case NO_STORE: a->slot[victim] = NO_SLOT; break;
    }
    return gathers_can_be_encoded() && moves_can_be_written(victim);
}

/* Replaces the code of one operation by nops. */
static int lose_instruction(uint64_t *seed)
{
    struct emitter *m = &builder->emitter;
    const struct code_line *line = &m->line[1 + program_random(seed) % (m->lines - 2)];
    unsigned op = builder->ir.instruction[line->instruction].op;
    uint32_t length = line[1].offset - line->offset;
    if (!line->instruction || !length || op == IR_when || op == IR_again || op == IR_end || op == IR_loop)
        return 0;
    memset(m->code + line->offset, 0x90, length);
    return 1;
}

/* Damage that is not detected must not change results. Returns true if it was detected. */
static int is_noticed(uint64_t number, unsigned damage, unsigned *tried)
{
    struct error error = {{0}};
    uint64_t seed;
    unsigned width = prepare(number % 2 ? program_make : program_make_loops, number, 40, &seed);
    struct register_file file = allocate_register_file(3, width);
    allocate_registers(&builder->ir, &builder->allocation, &file);
    if (damage != LOST_INSTRUCTION && !damage_allocation(damage, &seed))
        return 0;
    size_t bytes = program_emit(builder, width, &error);
    TEST_ASSERT_MESSAGE(bytes, error.text);
    if (damage == LOST_INSTRUCTION && !lose_instruction(&seed))
        return 0;
    ++*tried;
    if (placement_check(builder))
        return 1;
    got = given;
    TEST_ASSERT_EQUAL_MESSAGE(0, program_run(builder, bytes, arena, &got, &error), error.text);
    expect_same(number, width, &file);
    return 0;
}

static void test_damage_is_detected(void)
{
    for (unsigned damage = 0; damage < DAMAGES; damage++) {
        unsigned tried = 0, noticed = 0;
        for (uint64_t n = 1; n <= 400; n++)
            noticed += (unsigned)is_noticed(n, damage, &tried);
        TEST_ASSERT_GREATER_THAN(100, tried);
        TEST_ASSERT_GREATER_OR_EQUAL(damage == LOST_INSTRUCTION ? tried * 9 / 10 : tried / 3, noticed);
    }
}

int main(void)
{
    visit_fewer();
    UNITY_BEGIN();
    RUN_TEST(test_straight_programs);
    RUN_TEST(test_programs_with_loops_and_variables);
    RUN_TEST(test_programs_with_forms_that_recordings_lack);
    RUN_TEST(test_routines);
    RUN_TEST(test_stretched_rows);
    RUN_TEST(test_damage_is_detected);
    return UNITY_END();
}
