#include "tests/support/trial/trial.h"

#include "machine/mxcsr.h"
#include "ir/bind.h"
#include "engines/specialize/build.h"
/* The header defines the three routines too, which are not used here. */
#pragma GCC diagnostic ignored "-Wunused-function"
#include "spec/spec.h"

#include "tests/support/trial/trial_spec.h"

static struct builder *builder; /* one for all trials, never freed */
static uint32_t value[IR_CAPACITY], variable[VARIABLES];
static uint32_t next[IR_CAPACITY]; /* of each phi */
static uint8_t ran[IR_CAPACITY];   /* of each `end`: whether its region ran the last time */
static const uint8_t *base[BASE_COUNT];
static unsigned recorded;
static int optimized;

static void verify(const struct ir *ir)
{
    const char *wrong = ir_verify(ir);
    TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
}

static void verify_after(void *context, enum pass pass, unsigned changed, const struct ir *ir)
{
    (void)context, (void)pass, (void)changed;
    verify(ir);
}

/* Records a trial unless it was the last one. */
static const struct ir *record_trial(const struct trial_memory *memory, int optimizes)
{
    static struct env e;
    struct error error = {{0}};
    if (!builder)
        builder = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(builder, error.text);
    struct ir *ir = &builder->ir;
    if (memory->number == recorded && optimizes == optimized)
        return ir;
    ir_start(ir);
    e = (struct env){.ir = ir, .program = memory->program};
    trial_run(&e, memory);
    TEST_ASSERT_FALSE_MESSAGE(ir->overflow, "too long a recording");
    verify(ir);
    if (optimizes)
        pass_run_all(ir, &builder->pass, pass_select(PROFILE_FULL, 0, 0), verify_after, NULL);
    recorded = memory->number;
    optimized = optimizes;
    return ir;
}

static uint32_t word_at(const uint8_t *address)
{
    uint32_t word;
    memcpy(&word, address, sizeof word);
    return word;
}

/* Sets the joins after a region that ran or was skipped. */
static uint32_t skip(const struct ir *ir, uint32_t when, int runs)
{
    uint32_t end = ir_other_end(ir, when);
    ran[end] = (uint8_t)runs;
    return runs ? when + 1 : end + 1;
}

/* Starts the loop's next pass: its phis simultaneously become their next values. */
static uint32_t repeat(const struct ir *ir, uint32_t again)
{
    for (uint32_t n = again - 1; ir->instruction[n].op == IR_next || ir->instruction[n].op == IR_nop; n--)
        value[ir->instruction[n].operand[0]] = next[ir->instruction[n].operand[0]];
    return ir_other_end(ir, again) + 1;
}

static uint32_t join(const struct ir *ir, uint32_t number)
{
    uint32_t end = number;
    while (ir->instruction[end].op != IR_end)
        end--;
    return value[ir->instruction[number].operand[ran[end]]];
}

static const uint8_t *place(const struct ir_instruction *i)
{
    return base[i->base] + i->k;
}

/* Executes one instruction in one lane. Returns the number of the next instruction. */
static uint32_t interpret(const struct ir *ir, uint32_t number, unsigned lane)
{
    const struct ir_instruction *i = &ir->instruction[number];
    uint32_t a = value[i->operand[0]], *to = &value[number];
    switch (i->op) {
    case IR_nop:
    case IR_section:
    case IR_repeat:
    case IR_end:
    case IR_loop: break;
    case IR_literal: *to = (uint32_t)i->k; break;
    case IR_copy: *to = a; break;
    case IR_load: *to = word_at(place(i) + 4 * lane); break;
    case IR_uniform: *to = word_at(place(i)); break;
    case IR_constant: *to = word_at(base[ir->constant[i->k].base] + ir->constant[i->k].offset); break;
    case IR_gather:
        TEST_ASSERT_EQUAL_INT(GATHER_DIRECT, i->field);
        *to = word_at(place(i) + (ptrdiff_t)(int32_t)a * i->scale);
        break;
    case IR_store: memcpy((uint8_t *)(uintptr_t)place(i) + 4 * lane, &a, sizeof a); break;
    case IR_set: variable[i->k] = a; break;
    case IR_get: *to = variable[i->k]; break;
    case IR_phi: *to = a; break;
    case IR_next: next[i->operand[0]] = value[i->operand[1]]; break;
    case IR_join: *to = join(ir, number); break;
    case IR_when: return skip(ir, number, a != 0);
    case IR_again: return a ? repeat(ir, number) : number + 1;
    default: *to = ir_evaluate(i->op, a, value[i->operand[1]], value[i->operand[2]], i->k);
    }
    return number + 1;
}

static void interpret_lanes(const struct trial_memory *memory, int optimizes, const float *input,
                            float *output)
{
    unsigned saved = mxcsr_enter();
    const struct ir *ir = record_trial(memory, optimizes);
    base[BASE_CONSTANT] = memory->constants;
    base[BASE_INPUT] = (const uint8_t *)input;
    base[BASE_OUTPUT] = (const uint8_t *)output;
    for (unsigned lane = 0; lane < TRIAL_LANES; lane++)
        for (uint32_t number = 1; number < ir->count;)
            number = interpret(ir, number, lane);
    mxcsr_leave(saved);
}

void trial_interpret(const struct trial_memory *memory, const float *input, float *output)
{
    interpret_lanes(memory, 0, input, output);
}

void trial_optimize(const struct trial_memory *memory, const float *input, float *output)
{
    interpret_lanes(memory, 1, input, output);
}
