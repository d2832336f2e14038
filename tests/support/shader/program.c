#include "program.h"

#include "base/bits.h"
#include "tests/support/shader/edges.h"
#include "machine/code.h"
#include "machine/cpu.h"
#include "tests/support/avx512/avx512.h"
#include "machine/mxcsr.h"
#include "contract/lane.h"

#include <stdlib.h>
#include <string.h>

uint32_t program_random(uint64_t *seed)
{
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return (uint32_t)(*seed * 0x2545f4914f6cdd1dull >> 32);
}

unsigned program_width(uint64_t number)
{
    static const unsigned widths[] = {4, 8, 16, 8, 16};
    unsigned width = widths[number % (sizeof widths / sizeof *widths)];
    return width == 16 && !avx512_runs() ? 8 : width;
}

unsigned program_parts(uint64_t number, unsigned width)
{
    unsigned parts = 1u << number / 5 % 3;
    return parts * width > LANES_MAXIMUM ? LANES_MAXIMUM / width : parts;
}

unsigned program_lanes(const struct ir *ir, unsigned width, unsigned parts)
{
    enum { QUAD = 4 };
    for (uint32_t number = 1; number < ir->count; number++)
        if (width * parts < QUAD && ir->instruction[number].op == IR_permute)
            return QUAD;
    return width * parts;
}

uint32_t program_word(uint64_t *seed)
{
    if (program_random(seed) % 3 == 0)
        return edges[program_random(seed) % edge_count];
    float value = (float)(int32_t)program_random(seed) * 0x1p-29f;
    return bits_of_float(value);
}

void program_fill(struct program_data *data, uint64_t *seed)
{
    memset(data, 0, sizeof *data);
    for (unsigned i = 0; i < sizeof data->input / 4; i++)
        data->input[i] = program_word(seed);
    uint32_t *job = (uint32_t *)(void *)&data->job;
    for (unsigned i = 0; i < sizeof data->job / 4; i++)
        job[i] = program_word(seed);
    for (unsigned i = 0; i < PROGRAM_TABLE; i++)
        data->table[i] = program_word(seed);
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        data->job.attribute[a].data = (const uint8_t *)(data->table + a);
    data->job.texture[0].texels = data->table;
    data->job.texture[0].pitch = PROGRAM_PITCH;
}

struct interpreter {
    const struct ir *ir;
    struct program_data *data;
    uint32_t value[IR_CAPACITY][PROGRAM_LANES];
    uint32_t variable[VARIABLES * IR_PARTS][PROGRAM_LANES];
    uint32_t next[IR_CAPACITY][PROGRAM_LANES]; /* of each phi */
    uint8_t ran[IR_CAPACITY];                  /* of each `end`: whether its region ran the last time */
    unsigned first;                            /* lane */
    unsigned width;
    program_observer *observer; /* may be null */
    void *context;
};

static const uint8_t *base_address(const struct interpreter *in, enum base base)
{
    switch (base) {
    case BASE_JOB: return (const uint8_t *)&in->data->job;
    case BASE_OUTPUT: return (const uint8_t *)(in->data->output + in->first);
    default: return (const uint8_t *)(in->data->input + in->first);
    }
}

static uint32_t read_word(const struct interpreter *in, const struct ir_instruction *i, unsigned lane)
{
    uint32_t word;
    memcpy(&word, base_address(in, i->base) + i->k + (i->op == IR_load ? 4 * lane : 0), 4);
    return word;
}

static uint32_t gather_word(const struct interpreter *in, const struct ir_instruction *i, uint32_t index)
{
    const uint8_t *start = base_address(in, i->base);
    uint32_t word;
    if (i->field != GATHER_DIRECT)
        memcpy(&start, start + i->field, sizeof start);
    memcpy(&word, start + (int32_t)index * i->scale + i->k, 4);
    return word;
}

/* Returns the number of the `end` of the region before a join. */
static uint32_t joined_end(const struct ir *ir, uint32_t number)
{
    while (ir->instruction[number].op != IR_end)
        number--;
    return number;
}

static void step(struct interpreter *in, uint32_t number, unsigned lane)
{
    const struct ir_instruction *i = &in->ir->instruction[number];
    uint32_t *to = &in->value[number][lane];
    uint32_t a = in->value[i->operand[0]][lane];
    switch (i->op) {
    case IR_literal: *to = (uint32_t)i->k; break;
    case IR_copy: *to = a; break;
    case IR_permute:
        *to = in->value[i->operand[0]][(lane & ~3u) | ((unsigned)i->k >> 2 * (lane & 3) & 3)];
        break;
    case IR_load:
    case IR_uniform: *to = read_word(in, i, lane); break;
    case IR_gather: *to = gather_word(in, i, a); break;
    case IR_constant: memcpy(to, (const uint8_t *)&in->data->job + in->ir->constant[i->k].offset, 4); break;
    case IR_phi: *to = a; break;
    case IR_section:
    case IR_repeat:
    case IR_window:
    case IR_near:
    case IR_near_column:
    case IR_near_row: break;
    case IR_next: in->next[i->operand[0]][lane] = in->value[i->operand[1]][lane]; break;
    case IR_join: *to = in->ran[joined_end(in->ir, number)] ? in->value[i->operand[1]][lane] : a; break;
    case IR_set: in->variable[i->k][lane] = a; break;
    case IR_get: *to = in->variable[i->k][lane]; break;
    case IR_store: memcpy((uint8_t *)in->data->output + i->k + 4 * (in->first + lane), &a, 4); break;
    case IR_store_where:
        if (in->value[i->operand[1]][lane])
            memcpy((uint8_t *)in->data->output + i->k + 4 * (in->first + lane), &a, 4);
        break;
    case IR_scatter:
        memcpy((uint8_t *)(in->data->output + in->first) + i->k + i->field * (int32_t)lane, &a, 4);
        break;
    default:
        *to = ir_evaluate(i->op, a, in->value[i->operand[1]][lane], in->value[i->operand[2]][lane], i->k);
        break;
    }
}

static int any_lane(const struct interpreter *in, unsigned mask)
{
    uint32_t any = 0;
    for (unsigned lane = 0; lane < in->width; lane++)
        any |= in->value[mask][lane];
    return any != 0;
}

/* Sets all phis of the loop that ends at `again` to their next values. */
static void give_next(struct interpreter *in, uint32_t again)
{
    for (uint32_t n = again - 1; in->ir->instruction[n].op == IR_next || in->ir->instruction[n].op == IR_nop;
         n--) {
        unsigned phi = in->ir->instruction[n].operand[0];
        memcpy(in->value[phi], in->next[phi], sizeof in->value[phi]);
        for (unsigned lane = 0; in->observer && phi && lane < in->width; lane++)
            in->observer(in->context, phi, in->value[phi][lane]);
    }
}

/* Returns the number of the instruction that is executed after the beginning or end of a region. */
static uint32_t follow(struct interpreter *in, uint32_t number)
{
    const struct ir_instruction *i = &in->ir->instruction[number];
    uint32_t other = number;
    if (i->op == IR_when) {
        other = ir_other_end(in->ir, number);
        in->ran[other] = (uint8_t)any_lane(in, i->operand[0]);
        return in->ran[other] ? number : other;
    }
    if (i->op == IR_again && any_lane(in, i->operand[0])) {
        give_next(in, number);
        return ir_other_end(in->ir, number);
    }
    return number;
}

static void run(struct interpreter *in, uint32_t number)
{
    for (unsigned lane = 0; lane < in->width; lane++) {
        step(in, number, lane);
        if (in->observer)
            in->observer(in->context, number, in->value[number][lane]);
    }
}

static void interpret_group(struct interpreter *in)
{
    for (uint32_t number = 1; number < in->ir->count; number++) {
        const struct ir_instruction *i = &in->ir->instruction[number];
        if (ir_op_information[i->op].properties & (IR_OPENS | IR_CLOSES))
            number = follow(in, number);
        else if (i->op != IR_nop)
            run(in, number);
    }
}

void program_observe(const struct ir *ir, struct program_data *data, unsigned width,
                     program_observer *observer, void *context)
{
    /* Not static itself: 39 MB in every program that links this file, which the leak checker reads. */
    static struct interpreter *in;
    if (!in && !(in = calloc(1, sizeof *in)))
        abort();
    unsigned saved = mxcsr_enter();
    in->ir = ir;
    in->data = data;
    in->width = width;
    in->observer = observer;
    in->context = context;
    memset(in->value[0], 0, sizeof in->value[0]);
    for (in->first = 0; in->first < PROGRAM_LANES; in->first += width * ir->parts)
        interpret_group(in);
    mxcsr_leave(saved);
}

void program_interpret(const struct ir *ir, struct program_data *data, unsigned width)
{
    program_observe(ir, data, width, NULL, NULL);
}

int program_compile_and_run(struct builder *b, struct code_arena *arena, unsigned width, unsigned registers,
                            struct program_data *data, struct error *error)
{
    struct register_file file = allocate_register_file(registers, width);
    return program_compile_with(b, arena, width, &file, data, error);
}

int program_compile_with(struct builder *b, struct code_arena *arena, unsigned width,
                         const struct register_file *file, struct program_data *data, struct error *error)
{
    struct register_file all = *file;
    all.wide = width == 16;
    all.scalar = width == 1;
    allocate_registers(&b->ir, &b->allocation, &all);
    size_t bytes = program_emit(b, width, error);
    return bytes ? program_run(b, bytes, arena, data, error) : -1;
}

size_t program_emit(struct builder *b, unsigned width, struct error *error)
{
    static const union key key;
    b->emitter.ir = &b->ir;
    b->emitter.allocation = &b->allocation;
    b->emitter.width = width;
    b->emitter.literal_pointers = false;
    b->emitter.length = emit_length_of(width);
    return emit_routine(&b->emitter, UNIT_VERTEX, &key, error);
}

int program_run(const struct builder *b, size_t bytes, struct code_arena *arena, struct program_data *data,
                struct error *error)
{
    struct code_span span;
    if (code_reserve(arena, bytes, &span, error))
        return -1;
    memcpy(span.writable, b->emitter.code, bytes);
    const void *code = code_commit(arena, &span, bytes);
    routine_function *run;
    memcpy(&run, &code, sizeof run);
    struct vertex_arguments call = {&data->job, data->input, data->output, PROGRAM_LANES};
    run(&call, NULL);
    code_free(arena, &span);
    return 0;
}

int program_difference(const struct program_data *a, const struct program_data *b)
{
    for (int i = 0; i < SLOT_COUNT * VERTEX_CAPACITY; i++) {
        uint32_t x = bits_of_float(a->output[i]), y = bits_of_float(b->output[i]);
        int both_nan = (x & 0x7fffffff) > 0x7f800000 && (y & 0x7fffffff) > 0x7f800000;
        if (x != y && !both_nan)
            return i;
    }
    return -1;
}
