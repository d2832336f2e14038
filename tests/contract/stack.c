/* Generated routines with large frames on a stack that is nearly full. They must touch the guard page below
 * the stack before any memory further down, which may belong to another thread and where the guard page does
 * not detect accesses. */
#define _GNU_SOURCE
#include "machine/code.h"
#include "machine/mxcsr.h"
#include "contract/arguments.h"
#include "engines/list.h"
#include "shader/program/program.h"
#include "tests/support/differential/trampoline.h"

#include <setjmp.h>
#include <signal.h>
#include <stdalign.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unity.h>

enum {
    PAGE = 4096,
    BELOW_PAGES = 16,
    ABOVE_PAGES = 8,
    LEFT = 256, /* bytes of the stack above the guard page */
    RSP = 4,
    RDI = 7,
    PATTERN = 0xa5,
    TEMPORARIES = 32,
    TEXT = 8192
};

/* In this order: the bytes below the guard page, the guard page, the stack. */
static uint8_t *memory;
static struct code_arena *arena;
static struct error error;

void setUp(void)
{
    error_clear(&error);
    memory = mmap(NULL, (BELOW_PAGES + 1 + ABOVE_PAGES) * PAGE, PROT_READ | PROT_WRITE,
                  MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    TEST_ASSERT_TRUE(memory != MAP_FAILED);
    memset(memory, PATTERN, BELOW_PAGES * PAGE);
    TEST_ASSERT_EQUAL_INT(0, mprotect(memory + BELOW_PAGES * PAGE, PAGE, PROT_NONE));
    arena = code_create(1 << 20, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
}

void tearDown(void)
{
    munmap(memory, (BELOW_PAGES + 1 + ABOVE_PAGES) * PAGE);
    code_destroy(arena);
}

/* --- A routine with a large frame ---------------------------------------------------------------------- */

/* All temporaries are computed, changed under a condition, and then read from the last to the first, so that
 * 128 values are live simultaneously. In engines with variables, the same number of variables is live too. */
static const struct program *large_program(void)
{
    static char text[TEXT];
    struct shader *shader;
    int length = snprintf(text, TEXT, "vs_3_0\ndcl_texcoord v0\ndcl_position o0\n");
    for (int r = 0; r < TEMPORARIES; r++)
        length += snprintf(text + length, (size_t)(TEXT - length), "mad r%d, v0, c%d, v0.w\n", r, r);
    length += snprintf(text + length, (size_t)(TEXT - length), "if_lt v0.x, c0.x\n");
    for (int r = 0; r < TEMPORARIES; r++)
        length += snprintf(text + length, (size_t)(TEXT - length), "mad r%d, r%d, c%d, v0\n", r, r, 31 - r);
    length += snprintf(text + length, (size_t)(TEXT - length), "endif\n");
    for (int r = TEMPORARIES - 2; r >= 0; r--)
        length += snprintf(text + length, (size_t)(TEXT - length), "mad r31, r31, r%d, v0\n", r);
    length += snprintf(text + length, (size_t)(TEXT - length), "mov o0, r31\n");
    int bad = shader_assemble("large", text, (size_t)length, &shader, &error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, bad || shader_validate(shader, NULL, &error), error.text);
    const struct program *program = program_acquire(shader, &error);
    shader_free(shader);
    TEST_ASSERT_NOT_NULL_MESSAGE(program, error.text);
    return program;
}

static struct routine *build(const struct engine *engine, const struct program *program)
{
    static union key key;
    memset(&key, 0, sizeof key);
    key_set_program(key.vertex.shader, program->number);
    key.vertex.input[0] = ATTRIBUTE_FORMAT_FLOAT4;
    struct routine *routine = engine_build(engine, arena, UNIT_VERTEX, &key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    return routine;
}

/* --- The overflow -------------------------------------------------------------------------------------- */

static sigjmp_buf back;
static void *volatile fault;

static void on_fault(int signal, siginfo_t *information, void *context)
{
    (void)signal;
    (void)context;
    fault = information->si_addr;
    siglongjmp(back, 1);
}

/* The address at which the routine runs into the guard page, with `left` bytes of stack; null if it returns.
 */
static void *run(const struct routine *routine, const struct vertex_arguments *call, size_t left)
{
    static uint8_t signal_stack[1 << 16];
    static struct machine_state in, out;
    const stack_t own = {.ss_sp = signal_stack, .ss_size = sizeof signal_stack};
    const struct sigaction catch = {.sa_sigaction = on_fault, .sa_flags = SA_SIGINFO | SA_ONSTACK};
    struct sigaction before;
    unsigned mxcsr = _mm_getcsr();
    uint8_t *top = memory + (BELOW_PAGES + 1) * PAGE + left;
    memset(&in, 0, sizeof in);
    memcpy(top - 8, &(const void *){trampoline_exit}, sizeof(void *));
    in.general[RSP] = (uint64_t)(uintptr_t)(top - 8);
    in.general[RDI] = (uint64_t)(uintptr_t)call;
    in.mxcsr = mxcsr;
    fault = NULL;
    TEST_ASSERT_EQUAL_INT(0, sigaltstack(&own, NULL));
    TEST_ASSERT_EQUAL_INT(0, sigaction(SIGSEGV, &catch, &before));
    if (!sigsetjmp(back, 1))
        trampoline_run(routine->code, &in, &out);
    mxcsr_leave(mxcsr);
    sigaction(SIGSEGV, &before, NULL);
    return fault;
}

static void check_engine(const struct engine *engine, const struct program *program,
                         const struct vertex_arguments *call)
{
    const uint8_t *guard = memory + BELOW_PAGES * PAGE;
    struct routine *routine = build(engine, program);
    TEST_ASSERT_NULL_MESSAGE(run(routine, call, (ABOVE_PAGES - 1) * PAGE), engine->name);
    const uint8_t *at = run(routine, call, LEFT);
    TEST_ASSERT_TRUE_MESSAGE(at >= guard && at < guard + PAGE, engine->name);
    for (size_t i = 0; i < BELOW_PAGES * PAGE; i++)
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(PATTERN, memory[i], engine->name);
    engine->free(arena, routine);
}

static void large_frames_run_into_the_guard_page(void)
{
    static const char *const names[] = {"stitch",       "stitch-operation", "specialize",   "specialize-1",
                                        "specialize-4", "specialize-8x2",   "specialize-16"};
    static alignas(64) float batch[SLOT_COUNT * VERTEX_CAPACITY];
    static const float vertices[16][4];
    static const uint32_t index[16];
    static struct job job;
    const struct program *program = large_program();
    float *constants = calloc(1, program_constant_bytes(program));
    TEST_ASSERT_NOT_NULL(constants);
    job.constants[STAGE_VERTEX] = constants;
    job.input[0] = (struct attribute_job){.data = (const uint8_t *)vertices, .stride = sizeof vertices[0]};
    const struct vertex_arguments call = {&job, index, batch, 16};
    for (unsigned i = 0; i < sizeof names / sizeof *names; i++) {
        const struct engine *engine = engine_find(names[i]);
        if (engine && !engine_unavailable(engine))
            check_engine(engine, program, &call);
    }
    program_release(program);
    free(constants);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(large_frames_run_into_the_guard_page);
    return UNITY_END();
}
