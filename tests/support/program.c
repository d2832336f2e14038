#include "program.h"

#include "edges.h"
#include "base/code.h"
#include "base/mxcsr.h"
#include "def/lane.h"

#include <string.h>

uint32_t program_random(uint64_t *seed)
{
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return (uint32_t)(*seed * 0x2545f4914f6cdd1dull >> 32);
}

static uint32_t any_word(uint64_t *seed)
{
    if (program_random(seed) % 3 == 0)
        return edges[program_random(seed) % edge_count];
    float value = (float)(int32_t)program_random(seed) * 0x1p-29f;
    return lane_bits(value);
}

void program_fill(struct program_data *data, uint64_t *seed)
{
    memset(data, 0, sizeof *data);
    for (unsigned i = 0; i < sizeof data->input / 4; i++)
        data->input[i] = any_word(seed);
    uint32_t *job = (uint32_t *)(void *)&data->job;
    for (unsigned i = 0; i < sizeof data->job / 4; i++)
        job[i] = any_word(seed);
    for (unsigned i = 0; i < PROGRAM_TABLE; i++)
        data->table[i] = any_word(seed);
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        data->job.attribute[a].data = (const uint8_t *)(data->table + a);
}

/* Values made so far, by type, and how many of them belong to open regions. */
struct maker {
    struct ir *ir;
    uint64_t *seed;
    uint16_t value[TYPE_msk + 1][IR_CAPACITY];
    unsigned count[TYPE_msk + 1];
};

static void keep(struct maker *maker, enum ir_type type, uint16_t value)
{
    maker->value[type][maker->count[type]++] = value;
}

static void make_source(struct maker *maker, enum ir_type type)
{
    struct ir_instruction i = {.type = (uint8_t)type, .op = IR_literal};
    switch (program_random(maker->seed) % 3) {
    case 0:
        i.op = IR_load;
        i.base = BASE_INPUT;
        i.k = (int32_t)(program_random(maker->seed) % PROGRAM_ARRAYS * PROGRAM_LANES * 4);
        break;
    case 1:
        i.op = IR_uniform;
        i.base = BASE_JOB;
        i.k = (int32_t)(offsetof(struct job, world_view_projection) + program_random(maker->seed) % 64 * 4);
        break;
    default: i.k = (int32_t)any_word(maker->seed); break;
    }
    if (type == TYPE_fix && i.op == IR_literal)
        i.k = (int32_t)((uint32_t)(i.k & 0xffff) * 0x10001u);
    keep(maker, type, ir_append(maker->ir, i));
}

/* A mask's lanes must be all ones or zero: only comparisons and literals make one from nothing. */
static void make_mask(struct maker *maker)
{
    struct ir_instruction i = {.type = TYPE_msk, .op = IR_literal};
    i.k = -(int32_t)(program_random(maker->seed) & 1);
    keep(maker, TYPE_msk, ir_append(maker->ir, i));
}

static uint16_t pick(struct maker *maker, enum ir_type type)
{
    unsigned recent = maker->count[type] < 12 ? maker->count[type] : 12;
    unsigned back =
        program_random(maker->seed) % (program_random(maker->seed) % 4 ? recent : maker->count[type]);
    return maker->value[type][maker->count[type] - 1 - back];
}

static void make_operation(struct maker *maker)
{
    unsigned op = 1 + program_random(maker->seed) % (IR_copy - 1);
    const struct ir_op_information *information = &ir_op_information[op];
    struct ir_instruction i = {.op = (uint8_t)op, .type = information->result, .line = 1};
    for (int o = 0; o < information->operands; o++)
        i.operand[o] = pick(maker, information->operand[o]);
    if (information->properties & IR_SHIFTS)
        i.k = (int32_t)(program_random(maker->seed) % (information->result == TYPE_fix ? 16 : 32));
    keep(maker, information->result, ir_append(maker->ir, i));
}

static void make_permutation(struct maker *maker)
{
    struct ir_instruction i = {.op = IR_permute, .type = TYPE_flt, .operand = {pick(maker, TYPE_flt)}};
    i.k = (int32_t)(program_random(maker->seed) & 255);
    keep(maker, TYPE_flt, ir_append(maker->ir, i));
}

/* One to five gathers of neighbouring words: by rows, when registers allow. */
static void make_row(struct maker *maker, uint16_t index)
{
    unsigned attribute = program_random(maker->seed) % 2, count = 1 + program_random(maker->seed) % 5;
    struct ir_instruction i = {.op = IR_gather,
                               .type = (uint8_t)(TYPE_flt + program_random(maker->seed) % 2),
                               .base = BASE_JOB,
                               .scale = 1,
                               .operand = {index},
                               .field = (int32_t)offsetof(struct job, attribute[attribute].data)};
    for (; count; count--, i.k += 4)
        keep(maker, i.type, ir_append(maker->ir, i));
}

/* From one place of one table, or of two. */
static void make_gathers(struct maker *maker)
{
    enum { LAST_PLACE = 0x3fc };
    struct ir_instruction i = {.op = IR_literal, .type = TYPE_itg, .k = LAST_PLACE};
    uint16_t last = ir_append(maker->ir, i);
    i = (struct ir_instruction){.op = IR_and_i, .type = TYPE_itg, .operand = {pick(maker, TYPE_itg), last}};
    uint16_t index = ir_append(maker->ir, i);
    make_row(maker, index);
    if (program_random(maker->seed) % 2)
        make_row(maker, index);
}

/* Not from flt: which NaN an operation gives is not defined (operands may change places), and a cast would
 * show it. */
static void make_cast(struct maker *maker)
{
    enum ir_type from = TYPE_itg + program_random(maker->seed) % 3;
    enum ir_type to = TYPE_flt + program_random(maker->seed) % 3;
    struct ir_instruction i = {.op = IR_copy, .type = (uint8_t)to, .operand = {pick(maker, from)}};
    keep(maker, to, ir_append(maker->ir, i));
}

static void make_store(struct maker *maker)
{
    enum ir_type type = TYPE_flt + program_random(maker->seed) % 3;
    ir_append(maker->ir, (struct ir_instruction){.op = IR_store,
                                                 .base = BASE_OUTPUT,
                                                 .operand = {pick(maker, type)},
                                                 .k = (int32_t)(program_random(maker->seed) % PROGRAM_STORES *
                                                                VERTEX_SLOT_BYTES)});
}

static void make_region(struct maker *maker, unsigned length)
{
    unsigned outside[TYPE_msk + 1];
    memcpy(outside, maker->count, sizeof outside);
    ir_append(maker->ir, (struct ir_instruction){.op = IR_when, .operand = {pick(maker, TYPE_msk)}});
    for (unsigned i = 0; i < length; i++)
        if (program_random(maker->seed) % 8)
            make_operation(maker);
        else
            make_gathers(maker);
    make_store(maker);
    ir_append(maker->ir, (struct ir_instruction){.op = IR_end});
    memcpy(maker->count, outside, sizeof outside);
}

/* An empty program with some values of each type to begin with. */
static void begin(struct maker *maker, struct ir *ir, uint64_t *seed)
{
    maker->ir = ir;
    maker->seed = seed;
    memset(maker->count, 0, sizeof maker->count);
    ir_start(ir);
    ir->file[ir->file_count++] = "program";
    for (int type = TYPE_flt; type <= TYPE_fix; type++)
        for (int i = 0; i < 4; i++)
            make_source(maker, type);
    make_mask(maker);
}

void program_make(struct ir *ir, unsigned length, uint64_t *seed)
{
    static struct maker maker;
    begin(&maker, ir, seed);
    for (unsigned i = 0; i < length; i++)
        switch (program_random(seed) % 16) {
        case 0: make_store(&maker); break;
        case 1: make_cast(&maker); break;
        case 2: make_source(&maker, TYPE_flt + program_random(seed) % 3); break;
        case 3:
            if (program_random(seed) % 4 == 0)
                make_region(&maker, 1 + program_random(seed) % 12);
            break;
        case 4: make_gathers(&maker); break;
        case 5: make_permutation(&maker); break;
        default: make_operation(&maker); break;
        }
    for (int i = 0; i < 4; i++)
        make_store(&maker);
}

/* --- With control flow ------------------------------------------------------------------------------------- */

/* Of each type that variables have, some, numbered in turn; then a counter for each depth of loops. */
enum { SHARED_VARIABLES = 12, LOOP_DEPTH = 3, REGION_DEPTHS = 5, COUNTERS = SHARED_VARIABLES };

static enum ir_type variable_type(unsigned variable)
{
    static const uint8_t types[] = {TYPE_flt, TYPE_itg, TYPE_msk, TYPE_flt};
    return types[variable % 4];
}

static void make_set(struct maker *maker, unsigned variable, uint16_t value)
{
    struct ir_instruction i = {.op = IR_set, .operand = {value}, .k = (int32_t)variable};
    i.type = variable < COUNTERS ? variable_type(variable) : TYPE_itg;
    ir_append(maker->ir, i);
}

static uint16_t make_get(struct maker *maker, unsigned variable, enum ir_type type)
{
    struct ir_instruction i = {.op = IR_get, .type = (uint8_t)type, .k = (int32_t)variable};
    uint16_t value = ir_append(maker->ir, i);
    keep(maker, type, value);
    return value;
}

/* Two or three variables of one type change places. */
static void make_exchange(struct maker *maker, unsigned variable, enum ir_type type)
{
    unsigned second = (variable + 4) % SHARED_VARIABLES, third = (variable + 8) % SHARED_VARIABLES;
    uint16_t a = make_get(maker, variable, type), b = make_get(maker, second, type);
    if (program_random(maker->seed) % 2) {
        make_set(maker, variable, make_get(maker, third, type));
        make_set(maker, third, b);
    } else
        make_set(maker, variable, b);
    make_set(maker, second, a);
}

/* Reads a variable, sets it, copies one to another, exchanges some, or updates it. */
static void make_access(struct maker *maker)
{
    unsigned variable = program_random(maker->seed) % SHARED_VARIABLES;
    enum ir_type type = variable_type(variable);
    switch (program_random(maker->seed) % 6) {
    case 0: make_get(maker, variable, type); break;
    case 3: make_exchange(maker, variable, type); break;
    case 1: make_set(maker, variable, pick(maker, type)); break;
    case 2: make_set(maker, (variable + 4) % SHARED_VARIABLES, make_get(maker, variable, type)); break;
    default:
        make_get(maker, variable, type);
        for (unsigned n = program_random(maker->seed) % 3; n; n--)
            make_operation(maker);
        make_set(maker, variable, pick(maker, type));
        break;
    }
}

static void make_body(struct maker *maker, unsigned length, unsigned depth, unsigned loops);

/* counter = bound & 3 or so; loop ... counter -= 1; again 0 < counter [and some mask]. */
static void make_loop(struct maker *maker, unsigned length, unsigned depth, unsigned loops)
{
    struct ir_instruction three = {.op = IR_literal, .type = TYPE_itg, .k = 3};
    struct ir_instruction one = {.op = IR_literal, .type = TYPE_itg, .k = 1};
    struct ir_instruction zero = {.op = IR_literal, .type = TYPE_itg, .k = 0};
    struct ir_instruction mask = {.op = IR_and_i, .type = TYPE_itg};
    mask.operand[0] = pick(maker, TYPE_itg);
    mask.operand[1] = ir_append(maker->ir, three);
    make_set(maker, COUNTERS + loops, ir_append(maker->ir, mask));
    ir_append(maker->ir, (struct ir_instruction){.op = IR_loop});
    make_body(maker, length, depth + 1, loops + 1);
    struct ir_instruction less = {.op = IR_sub_i, .type = TYPE_itg};
    less.operand[0] = make_get(maker, COUNTERS + loops, TYPE_itg);
    less.operand[1] = ir_append(maker->ir, one);
    struct ir_instruction more = {.op = IR_gt_i, .type = TYPE_msk};
    more.operand[0] = ir_append(maker->ir, less);
    make_set(maker, COUNTERS + loops, more.operand[0]);
    more.operand[1] = ir_append(maker->ir, zero);
    uint16_t again = ir_append(maker->ir, more);
    if (program_random(maker->seed) % 2)
        again = ir_append(maker->ir, (struct ir_instruction){.op = IR_and_m,
                                                             .type = TYPE_msk,
                                                             .operand = {again, pick(maker, TYPE_msk)}});
    if (program_random(maker->seed) % 4 == 0)
        make_body(maker, 3, REGION_DEPTHS, LOOP_DEPTH);
    ir_append(maker->ir, (struct ir_instruction){.op = IR_again, .operand = {again}});
}

static void make_inner(struct maker *maker, unsigned length, unsigned depth, unsigned loops)
{
    unsigned outside[TYPE_msk + 1];
    memcpy(outside, maker->count, sizeof outside);
    if (loops < LOOP_DEPTH && program_random(maker->seed) % 2)
        make_loop(maker, length, depth, loops);
    else {
        ir_append(maker->ir, (struct ir_instruction){.op = IR_when, .operand = {pick(maker, TYPE_msk)}});
        make_body(maker, length, depth + 1, loops);
        ir_append(maker->ir, (struct ir_instruction){.op = IR_end});
    }
    memcpy(maker->count, outside, sizeof outside);
}

static void make_body(struct maker *maker, unsigned length, unsigned depth, unsigned loops)
{
    for (unsigned i = 0; i < length; i++)
        switch (program_random(maker->seed) % 16) {
        case 0: make_store(maker); break;
        case 1: make_cast(maker); break;
        case 2: make_source(maker, TYPE_flt + program_random(maker->seed) % 3); break;
        case 3:
            if (depth < REGION_DEPTHS)
                make_inner(maker, length / 2, depth, loops);
            break;
        case 4:
            if (program_random(maker->seed) % 4 == 0)
                make_gathers(maker);
            break;
        case 5:
        case 6:
        case 7:
        case 8: make_access(maker); break;
        default: make_operation(maker); break;
        }
}

void program_make_loops(struct ir *ir, unsigned length, uint64_t *seed)
{
    static struct maker maker;
    begin(&maker, ir, seed);
    for (int i = 0; i < 8; i++)
        make_operation(&maker);
    for (unsigned variable = 0; variable < SHARED_VARIABLES; variable++)
        make_set(&maker, variable, pick(&maker, variable_type(variable)));
    make_body(&maker, length, 0, 0);
    for (unsigned variable = 0; variable < SHARED_VARIABLES; variable++)
        if (variable_type(variable) != TYPE_msk)
            make_get(&maker, variable, variable_type(variable)), make_store(&maker);
}

struct interpreter {
    const struct ir *ir;
    struct program_data *data;
    uint32_t value[IR_CAPACITY][PROGRAM_LANES];
    uint32_t variable[VARIABLES][PROGRAM_LANES];
    uint32_t next[IR_CAPACITY][PROGRAM_LANES]; /* of each phi */
    uint8_t ran[IR_CAPACITY];                  /* of each `end`: whether its region ran the last time */
    unsigned first;                            /* lane */
    unsigned width;
    program_observer *observer; /* may be null */
    void *context;
};

static uint32_t read_word(const struct interpreter *in, const struct ir_instruction *i, unsigned lane)
{
    const uint8_t *base =
        (const uint8_t *)(i->base == BASE_JOB ? (const void *)&in->data->job
                                              : (const void *)(in->data->input + in->first));
    uint32_t word;
    memcpy(&word, base + i->k + (i->op == IR_load ? 4 * lane : 0), 4);
    return word;
}

static uint32_t gather_word(const struct interpreter *in, const struct ir_instruction *i, uint32_t index)
{
    const uint8_t *start;
    uint32_t word;
    memcpy(&start, (const uint8_t *)&in->data->job + i->field, sizeof start);
    memcpy(&word, start + (int32_t)index * i->scale + i->k, 4);
    return word;
}

/* The end of the region behind which a join stands. */
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
    case IR_next: in->next[i->operand[0]][lane] = in->value[i->operand[1]][lane]; break;
    case IR_join: *to = in->ran[joined_end(in->ir, number)] ? in->value[i->operand[1]][lane] : a; break;
    case IR_set: in->variable[i->k][lane] = a; break;
    case IR_get: *to = in->variable[i->k][lane]; break;
    case IR_store: memcpy((uint8_t *)in->data->output + i->k + 4 * (in->first + lane), &a, 4); break;
    default:
        *to = ir_evaluate(i->op, a, in->value[i->operand[1]][lane], in->value[i->operand[2]][lane], i->k);
        break;
    }
}

/* The other end of the region that begins (step 1) or ends (-1) at `number`. */
static uint32_t other_end(const struct ir *ir, uint32_t number, int step)
{
    for (int depth = 0;; number += (uint32_t)step) {
        unsigned properties = ir_op_information[ir->instruction[number].op].properties;
        depth += (properties & IR_OPENS) != 0;
        depth -= (properties & IR_CLOSES) != 0;
        if (!depth)
            return number;
    }
}

static int any_lane(const struct interpreter *in, unsigned mask)
{
    uint32_t any = 0;
    for (unsigned lane = 0; lane < in->width; lane++)
        any |= in->value[mask][lane];
    return any != 0;
}

/* All phis of the loop that ends at `again` become their next values. */
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

/* Where control goes on from a region's beginning or end. */
static uint32_t follow(struct interpreter *in, uint32_t number)
{
    const struct ir_instruction *i = &in->ir->instruction[number];
    uint32_t other = number;
    if (i->op == IR_when) {
        other = other_end(in->ir, number, 1);
        in->ran[other] = (uint8_t)any_lane(in, i->operand[0]);
        return in->ran[other] ? number : other;
    }
    if (i->op == IR_again && any_lane(in, i->operand[0])) {
        give_next(in, number);
        return other_end(in->ir, number, -1);
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
    static struct interpreter in;
    unsigned saved = mxcsr_enter();
    in.ir = ir;
    in.data = data;
    in.width = width;
    in.observer = observer;
    in.context = context;
    memset(in.value[0], 0, sizeof in.value[0]);
    for (in.first = 0; in.first < PROGRAM_LANES; in.first += width)
        interpret_group(&in);
    mxcsr_leave(saved);
}

void program_interpret(const struct ir *ir, struct program_data *data, unsigned width)
{
    program_observe(ir, data, width, NULL, NULL);
}

int program_compile_and_run(struct builder *b, struct code_arena *arena, unsigned width, unsigned registers,
                            struct program_data *data, struct error *error)
{
    static const union key key;
    allocate(&b->ir, &b->allocation, registers);
    b->emitter.ir = &b->ir;
    b->emitter.allocation = &b->allocation;
    b->emitter.width = width;
    b->emitter.length = width == 4 ? X86_128 : X86_256;
    size_t bytes = emit_routine(&b->emitter, UNIT_VERTEX, &key, error);
    struct code_span span;
    if (!bytes || code_reserve(arena, bytes, &span, error))
        return -1;
    memcpy(span.writable, b->emitter.code, bytes);
    const void *code = code_commit(arena, &span, bytes);
    routine_function *run;
    memcpy(&run, &code, sizeof run);
    struct vertex_call call = {&data->job, data->input, data->output, PROGRAM_LANES};
    run(&call, NULL);
    code_free(arena, &span);
    return 0;
}

int program_difference(const struct program_data *a, const struct program_data *b)
{
    for (int i = 0; i < SLOT_COUNT * VERTEX_CAPACITY; i++) {
        uint32_t x = lane_bits(a->output[i]), y = lane_bits(b->output[i]);
        int both_nan = (x & 0x7fffffff) > 0x7f800000 && (y & 0x7fffffff) > 0x7f800000;
        if (x != y && !both_nan)
            return i;
    }
    return -1;
}
