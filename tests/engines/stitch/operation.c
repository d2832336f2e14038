/* Every operation fragment computes its row of def/op.def. Results are compared with the emulator's
 * binding, which is the expression of that row, on random bits and on edge values of each type: with
 * values in random registers, with the result in a register of its own or an operand's, and with an
 * operand in memory where possible. This includes operations that the specification does not use. NaN
 * payloads are not compared. */
#include "base/bits.h"
#include "machine/code.h"
#include "machine/mxcsr.h"
#include "emu/emulate/bind.h"
#include "engines/stitch/plan.h"
#include "engines/stitch/stitch.h"
#include "tests/support/differential/trampoline.h"

#include <unity.h>

enum {
    WIDTH = 8,
    HALVES = WIDTH / EMULATE_WIDTH,
    ROUNDS = 2000,
    OPERANDS = 4,
    SLOT = 4 * WIDTH,
    VECTORS = 15
};

static struct code_arena *arena;
static alignas(64) uint32_t frame[OPERANDS * WIDTH]; /* result, a, b, c */
static uint32_t expected[WIDTH];
static uint64_t seed;

static uint32_t random_word(void)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (uint32_t)(seed * 0x2545f4914f6cdd1dull >> 32);
}

static uint32_t random_flt(void)
{
    static const uint32_t edge[] = {0,          0x80000000, 0x7f800000, 0xff800000, 0x7fc00000, 0xffc12345,
                                    0x7f800001, 1,          0x80000001, 0x007fffff, 0x00800000, 0x7f7fffff,
                                    0x3f000000, 0x3fc00000, 0x40200000, 0xbf000000, 0x4effffff, 0x4f000000,
                                    0xcf000000, 0xcf000001, 0x4b000001};
    if (random_word() % 4 == 0)
        return edge[random_word() % (sizeof edge / sizeof *edge)];
    if (random_word() % 2)
        return random_word();
    float small = (float)(int32_t)random_word() * 0x1p-28f;
    return bits_of_float(small);
}

static uint32_t random_itg(void)
{
    static const uint32_t edge[] = {0,          1,          0xffffffff, 0x80000000,
                                    0x7fffffff, 0x00008000, 0xffff8000, 0x80008000};
    return random_word() % 4 ? random_word() : edge[random_word() % (sizeof edge / sizeof *edge)];
}

static uint32_t random_fix(void)
{
    return random_word() % 4 ? random_word() & 0x00ff00ff : random_itg();
}

static uint32_t random_msk(void)
{
    return -(random_word() & 1);
}

static uint32_t random_non(void)
{
    return random_word();
}

static int nan_bits(uint32_t bits)
{
    return (bits & 0x7fffffff) > 0x7f800000;
}

/* The arguments of a fragment: the registers of its values, then k. */
struct call {
    const struct fragment *fragment;
    int vector[OPERANDS]; /* of the result and of each operand; -1: in memory, in its slot of `frame` */
    int operands;
    int32_t k;
};

static const void *join(const struct call *call, struct code_span *span)
{
    static struct plan plan;
    uint8_t exit_code[14] = {0xff, 0x25}; /* jmp [rip + 0] */
    struct fragment exit = {.name = "exit", .code = exit_code, .bytes = sizeof exit_code};
    struct error error = {{0}};
    union arguments arguments = {{0}};
    memcpy(exit_code + 6, &(const char *){trampoline_exit}, 8);
    for (int i = 0; i <= call->operands; i++)
        arguments.value[i] = call->vector[i] < 0 ? i * SLOT : call->vector[i];
    if (call->operands < OPERANDS - 1)
        arguments.value[call->operands + 1] = call->k;
    arguments.value[ARGUMENT_BASE] = REGISTER_FRAME;
    plan_enter(&plan);
    plan.count = 0;
    plan_append(&plan, call->fragment, arguments);
    plan_append(&plan, &exit, (union arguments){{0}});
    if (plan_join(&plan, arena, span, &error))
        TEST_FAIL_MESSAGE(error.text);
    return span->executable;
}

/* The operands are in `frame`, where the result will be. */
static void run_fragment(const struct call *call)
{
    static struct machine_state in, out;
    static alignas(32) uint32_t sign[WIDTH];
    struct code_span span;
    const void *code = join(call, &span);
    for (int i = 0; i < WIDTH; i++)
        sign[i] = 0x80000000u;
    in.mxcsr = MXCSR_CONTRACT;
    in.general[REGISTER_FRAME] = (uint64_t)(uintptr_t)frame;
    in.general[REGISTER_CONSTANTS] = (uint64_t)(uintptr_t)sign;
    for (int i = 1; i <= call->operands; i++)
        if (call->vector[i] >= 0)
            memcpy(in.ymm[call->vector[i]], frame + i * WIDTH, SLOT);
    if (call->fragment->read & 1)
        memcpy(in.ymm[call->vector[0]], frame, SLOT);
    trampoline_run(code, &in, &out);
    memcpy(frame, out.ymm[call->vector[0]], SLOT);
    code_free(arena, &span);
}

/* Distinct registers. */
static void choose_vectors(struct call *call)
{
    for (int i = 0; i <= call->operands; i++) {
        call->vector[i] = (int)(random_word() % VECTORS);
        for (int before = 0; before < i; before++)
            if (call->vector[before] == call->vector[i])
                before = -1, call->vector[i] = (call->vector[i] + 1) % VECTORS;
    }
}

typedef void evaluate(struct env *e, int half, int k);

struct operation_row {
    const char *name;
    const struct fragment *fragment;
    evaluate *evaluate;
    uint32_t (*operand[3])(void);
    int operands;
    int gives_flt;
    int shifts; /* immediates are 0 to this - 1; 0: no immediate */
};

#define OPERAND(type, n, i)                                                                                  \
    type n;                                                                                                  \
    memcpy(&n, frame + i * WIDTH + half * EMULATE_WIDTH, sizeof n);
#define OPERAND_flt(n, i) OPERAND(flt, n, i)
#define OPERAND_itg(n, i) OPERAND(itg, n, i)
#define OPERAND_fix(n, i) OPERAND(fix, n, i)
#define OPERAND_msk(n, i) OPERAND(msk, n, i)
#define OPERAND_non(n, i)
#define PASS_flt(n) , n
#define PASS_itg(n) , n
#define PASS_fix(n) , n
#define PASS_msk(n) , n
#define PASS_non(n)
#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    static void evaluate_##name(struct env *e, int half, int k)                                              \
    {                                                                                                        \
        (void)k;                                                                                             \
        OPERAND_##ta(a, 1) OPERAND_##tb(b, 2) OPERAND_##tc(c, 3) result r =                                  \
            name(e PASS_##ta(a) PASS_##tb(b) PASS_##tc(c));                                                  \
        memcpy(expected + half * EMULATE_WIDTH, &r, sizeof r);                                               \
    }
#define OPK(name, result, ta, tb, tc, properties, expression)                                                \
    static void evaluate_##name(struct env *e, int half, int k)                                              \
    {                                                                                                        \
        OPERAND_##ta(a, 1) result r = name(e, a, k);                                                         \
        memcpy(expected + half * EMULATE_WIDTH, &r, sizeof r);                                               \
    }
#define CAST(name, result, from)
#include "def/op.def"
#undef OP
#undef OPK

#define GIVES_flt 1
#define GIVES_itg 0
#define GIVES_fix 0
#define GIVES_msk 0
#define COUNT_flt 1
#define COUNT_itg 1
#define COUNT_fix 1
#define COUNT_msk 1
#define COUNT_non 0
#define BITS_itg  32
#define BITS_fix  16
#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    {#name,                                                                                                  \
     &fragment_##name,                                                                                       \
     evaluate_##name,                                                                                        \
     {random_##ta, random_##tb, random_##tc},                                                                \
     COUNT_##ta + COUNT_##tb + COUNT_##tc,                                                                   \
     GIVES_##result,                                                                                         \
     0},
#define OPK(name, result, ta, tb, tc, properties, expression)                                                \
    {#name, &fragment_##name, evaluate_##name, {random_##ta}, 1, GIVES_##result, BITS_##ta},
static const struct operation_row operations[] = {
#include "def/op.def"
};
#undef OP
#undef OPK
#undef CAST

static void compare_lanes(const struct operation_row *operation, const struct call *call)
{
    for (int lane = 0; lane < WIDTH; lane++) {
        uint32_t got = frame[lane], wanted = expected[lane];
        if (got == wanted || (operation->gives_flt && nan_bits(got) && nan_bits(wanted)))
            continue;
        char text[200];
        snprintf(text, sizeof text, "%s(%08x, %08x, %08x) is %08x, expected %08x", call->fragment->name,
                 frame[WIDTH + lane], frame[2 * WIDTH + lane], frame[3 * WIDTH + lane], got, wanted);
        TEST_FAIL_MESSAGE(text);
    }
}

static void evaluate_row(const struct operation_row *operation, int k)
{
    static struct env e;
    for (int i = 0; i < WIDTH; i++)
        for (int n = 0; n < 3; n++)
            frame[(n + 1) * WIDTH + i] = operation->operand[n] ? operation->operand[n]() : random_word();
    unsigned saved = mxcsr_enter();
    for (int half = 0; half < HALVES; half++)
        operation->evaluate(&e, half, k);
    mxcsr_leave(saved);
}

/* Tries separate registers, the result in the register of an operand, and an operand in memory. */
static void try_operation(const struct operation_row *operation, int round)
{
    struct call call = {operation->fragment, {0}, operation->operands, 0};
    choose_vectors(&call);
    int shared = round % OPERANDS;
    if (shared && shared <= call.operands && !call.fragment->apart)
        call.vector[0] = call.vector[shared];
    if (operation->shifts)
        call.k = (int32_t)(random_word() % (uint32_t)operation->shifts);
    evaluate_row(operation, call.k);
    run_fragment(&call);
    compare_lanes(operation, &call);
    if (!call.fragment->folded)
        return;
    call.vector[call.fragment++->folded] = -1;
    run_fragment(&call);
    compare_lanes(operation, &call);
}

static void operation_fragments_compute_their_rows(void)
{
    for (size_t i = 0; i < sizeof operations / sizeof *operations; i++)
        for (int round = 0; round < ROUNDS; round++)
            try_operation(operations + i, round);
}

/* a * b + c where the result is in the register of one of them: rows of fragment.def, not of op.def. */
static void multiplying_and_adding_in_place_is_the_same(void)
{
    static const struct {
        const struct fragment *fragment;
        uint8_t place[3]; /* the argument that a, b and c are: 0 the result */
    } form[] = {{&fragment_mad_f_factor, {0, 1, 2}}, {&fragment_mad_f_sum, {1, 2, 0}}};
    const struct operation_row *row = operations;
    while (row->fragment != &fragment_mad_f)
        row++;
    for (int round = 0; round < ROUNDS; round++)
        for (int memory = 0; memory < 2; memory++) {
            size_t f = (size_t)round % 2;
            uint32_t operand[3][WIDTH];
            struct call call = {form[f].fragment + memory, {0}, 2, 0};
            choose_vectors(&call);
            evaluate_row(row, 0);
            memcpy(operand, frame + WIDTH, sizeof operand);
            for (int i = 0; i < 3; i++)
                memcpy(frame + form[f].place[i] * WIDTH, operand[i], SLOT);
            if (memory)
                call.vector[2] = -1;
            run_fragment(&call);
            memcpy(frame + WIDTH, operand, sizeof operand);
            compare_lanes(row, &call);
        }
}

/* permute is not a row of op.def: lanes are exchanged within each four. */
static void the_permutation_reads_the_lanes_that_it_names(void)
{
    for (int lanes = 0; lanes < 256; lanes++) {
        struct call call = {&fragment_permute, {lanes % VECTORS, (lanes + 1) / 2 % VECTORS}, 1, lanes};
        for (int i = 0; i < WIDTH; i++)
            frame[WIDTH + i] = random_word();
        run_fragment(&call);
        for (int i = 0; i < WIDTH; i++)
            TEST_ASSERT_EQUAL_HEX32(frame[WIDTH + (i & ~3) + (lanes >> 2 * (i & 3) & 3)], frame[i]);
    }
}

void setUp(void)
{
    struct error error = {{0}};
    if (engine_unavailable(&engine_stitch))
        TEST_IGNORE_MESSAGE(engine_unavailable(&engine_stitch));
    seed = 0x0b5e55ed;
    arena = code_create(1 << 20, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
}

void tearDown(void)
{
    code_destroy(arena);
    arena = NULL;
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_permutation_reads_the_lanes_that_it_names);
    RUN_TEST(operation_fragments_compute_their_rows);
    RUN_TEST(multiplying_and_adding_in_place_is_the_same);
    return UNITY_END();
}
