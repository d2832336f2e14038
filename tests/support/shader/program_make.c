/* Random programs. They contain every operation of def/op.def, every kind of memory access that a vertex
 * routine may make, stores that later loads read back, regions, loops and variables.
 *
 * Results must be defined, so two things are left out. The bits of a NaN are not defined, so a flt is not
 * cast and not read back as another type. The value of a variable that was never set is not read. */
#include "base/bits.h"
#include "program.h"

#include <string.h>

/* The values made so far that later instructions may read, by type. */
struct maker {
    struct ir *ir;
    uint64_t *seed;
    uint32_t limit; /* no region is opened after this number of instructions */
    int wild;       /* operations that recordings do not contain are made too */
    int counted;    /* half of the loops begin to count from a literal */
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
    default: i.k = (int32_t)program_word(maker->seed); break;
    }
    if (type == TYPE_fix && i.op == IR_literal)
        i.k = (int32_t)((uint32_t)(i.k & 0xffff) * 0x10001u);
    keep(maker, type, ir_append(maker->ir, i));
}

/* A literal mask. The lanes of a mask must be all ones or all zeros, so masks come only from comparisons and
 * such literals. */
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

/* A whole number divided by a whole constant. */
static void make_fraction(struct maker *maker)
{
    const float divisor = (float)(program_random(maker->seed) % 300);
    struct ir_instruction number = {.op = IR_float_f, .type = TYPE_flt, .operand = {pick(maker, TYPE_itg)}},
                          literal = {.op = IR_literal,
                                     .type = TYPE_flt,
                                     .k = (int32_t)bits_of_float(divisor)},
                          i = {.op = IR_div_f, .type = TYPE_flt, .line = 1};
    i.operand[0] = ir_append(maker->ir, number);
    i.operand[1] = ir_append(maker->ir, literal);
    keep(maker, TYPE_flt, ir_append(maker->ir, i));
}

static void make_operation(struct maker *maker)
{
    unsigned op = 1 + program_random(maker->seed) % IR_COMPUTED;
    if (program_random(maker->seed) % 32 == 0) {
        make_fraction(maker);
        return;
    }
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

/* One to five gathers of neighbouring words, which are compiled as loads of rows if enough registers are
 * free. */
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

static uint16_t make_index(struct maker *maker, int32_t last)
{
    struct ir_instruction i = {.op = IR_literal, .type = TYPE_itg, .k = last};
    uint16_t mask = ir_append(maker->ir, i);
    i = (struct ir_instruction){.op = IR_and_i, .type = TYPE_itg, .operand = {pick(maker, TYPE_itg), mask}};
    return ir_append(maker->ir, i);
}

/* A gather from the job itself, without a pointer. */
static void make_direct_gather(struct maker *maker)
{
    enum { WORDS = 16, LAST_PLACES = 48 };
    struct ir_instruction i = {.op = IR_gather,
                               .type = (uint8_t)(TYPE_flt + program_random(maker->seed) % 2),
                               .base = BASE_JOB,
                               .scale = 4,
                               .operand = {make_index(maker, WORDS - 1)},
                               .field = GATHER_DIRECT};
    i.k = (int32_t)(offsetof(struct job, world_view_projection) +
                    program_random(maker->seed) % LAST_PLACES * 4);
    keep(maker, i.type, ir_append(maker->ir, i));
}

static uint16_t make_integers(struct maker *maker, enum ir_op op, uint16_t a, uint16_t b)
{
    return ir_append(maker->ir,
                     (struct ir_instruction){.op = (uint8_t)op, .type = TYPE_itg, .operand = {a, b}});
}

/* Gathers the texel x + y * pitch, and with `pair` its neighbour. */
static void make_texel(struct maker *maker, uint16_t index, int pair)
{
    struct ir_instruction i = {.op = IR_gather,
                               .type = TYPE_itg,
                               .base = BASE_JOB,
                               .scale = 4,
                               .operand = {index},
                               .field = (int32_t)offsetof(struct job, texture[0].texels)};
    keep(maker, TYPE_itg, ir_append(maker->ir, i));
    i.k = 4;
    if (pair)
        keep(maker, TYPE_itg, ir_append(maker->ir, i));
}

/* Gathers of one texel or of four neighbours. The lanes' texels are near each other or not. The rows are
 * mostly y and y + 1. */
static void make_texels(struct maker *maker)
{
    static const int8_t most[] = {1, 3, 7};
    struct ir_instruction pitch = {.op = IR_uniform,
                                   .type = TYPE_itg,
                                   .base = BASE_JOB,
                                   .k = (int32_t)offsetof(struct job, texture[0].pitch)};
    struct ir_instruction one = {.op = IR_literal, .type = TYPE_itg, .k = 1};
    uint16_t x = make_index(maker, most[program_random(maker->seed) % 3]), indices[2], y[2];
    y[0] = make_index(maker, most[program_random(maker->seed) % 3]);
    y[1] = program_random(maker->seed) % 4 ? make_integers(maker, IR_add_i, y[0], ir_append(maker->ir, one))
                                           : make_index(maker, 7);
    uint16_t words = ir_append(maker->ir, pitch);
    int pair = program_random(maker->seed) % 2;
    for (int row = 0; row < 2; row++)
        indices[row] = make_integers(maker, IR_add_i, x, make_integers(maker, IR_dot_i, y[row], words));
    for (int row = 0; row < 1 + pair; row++)
        make_texel(maker, indices[row], pair);
}

/* Gathers of rows from one or two tables, or of texels. */
static void make_gathers(struct maker *maker)
{
    enum { LAST_PLACE = 0x3fc };
    if (program_random(maker->seed) % 3 == 0) {
        make_texels(maker);
        return;
    }
    if (program_random(maker->seed) % 4 == 0) {
        make_direct_gather(maker);
        return;
    }
    uint16_t index = make_index(maker, LAST_PLACE);
    make_row(maker, index);
    if (program_random(maker->seed) % 2)
        make_row(maker, index);
}

/* Casts do not start from flt. The NaN of an operation is not defined, because its operands may change
 * places, and a cast would show its bits. */
static void make_cast(struct maker *maker)
{
    enum ir_type from = TYPE_itg + program_random(maker->seed) % 3;
    enum ir_type to = TYPE_flt + program_random(maker->seed) % 3;
    struct ir_instruction i = {.op = IR_copy, .type = (uint8_t)to, .operand = {pick(maker, from)}};
    keep(maker, to, ir_append(maker->ir, i));
}

/* Only slots of OUTPUT below FLOAT_SLOTS may contain floats. */
enum { FLOAT_SLOTS = PROGRAM_STORES * 5 / 8 };

static int32_t slot_for(struct maker *maker, enum ir_type type)
{
    unsigned first = type == TYPE_flt ? 0 : program_random(maker->seed) % 4 ? FLOAT_SLOTS : 0;
    unsigned end = type == TYPE_flt ? FLOAT_SLOTS : PROGRAM_STORES;
    return (int32_t)(first + program_random(maker->seed) % (end - first)) * VERTEX_SLOT_BYTES;
}

/* A store of all lanes next to each other, or at a stride within the slot. */
static void make_store(struct maker *maker)
{
    static const int8_t strides[] = {4, 8, 12, -4};
    enum ir_type type = TYPE_flt + program_random(maker->seed) % 3;
    struct ir_instruction i = {.op = IR_store, .base = BASE_OUTPUT, .operand = {pick(maker, type)}};
    i.k = slot_for(maker, type);
    if (maker->wild && program_random(maker->seed) % 4 == 0) {
        i.op = IR_scatter;
        i.field = strides[program_random(maker->seed) % sizeof strides];
        i.k += i.field < 0 ? PROGRAM_LANES * 4 : 0;
    }
    ir_append(maker->ir, i);
}

/* Loads before and after a second store to the same slot: a load must not be moved across a store. */
static void make_reload(struct maker *maker)
{
    enum ir_type type = TYPE_flt + program_random(maker->seed) % 2;
    unsigned first = type == TYPE_flt ? 0 : FLOAT_SLOTS,
             end = type == TYPE_flt ? FLOAT_SLOTS : PROGRAM_STORES;
    struct ir_instruction i = {.op = IR_load, .type = (uint8_t)type, .base = BASE_OUTPUT};
    i.k = (int32_t)(first + program_random(maker->seed) % (end - first)) * VERTEX_SLOT_BYTES;
    if (maker->wild && program_random(maker->seed) % 3 == 0)
        i.k += (int32_t)(program_random(maker->seed) % 16) * 4;
    if (maker->wild && program_random(maker->seed) % 4 == 0)
        i.op = IR_uniform;
    keep(maker, type, ir_append(maker->ir, i));
    if (program_random(maker->seed) % 2)
        return;
    /* Again, after a store to the same address. */
    ir_append(maker->ir, (struct ir_instruction){
                             .op = IR_store, .base = BASE_OUTPUT, .operand = {pick(maker, type)}, .k = i.k});
    keep(maker, type, ir_append(maker->ir, i));
}

/* A store in which some lanes keep the previous value or get another one. */
static void make_merge(struct maker *maker)
{
    int32_t slot = slot_for(maker, TYPE_itg);
    struct ir_instruction load = {.op = IR_load, .type = TYPE_itg, .base = BASE_OUTPUT, .k = slot};
    struct ir_instruction store = {.op = IR_store, .base = BASE_OUTPUT, .k = slot};
    uint16_t before = ir_append(maker->ir, load), new = pick(maker, TYPE_itg);
    if (program_random(maker->seed) % 4 == 0)
        make_store(maker);
    store.operand[0] = ir_append(
        maker->ir, (struct ir_instruction){
                       .op = IR_select_i, .type = TYPE_itg, .operand = {pick(maker, TYPE_msk), new, before}});
    ir_append(maker->ir, store);
}

static void make_store_or_merge(struct maker *maker)
{
    if (program_random(maker->seed) % 3)
        make_store(maker);
    else
        make_merge(maker);
}

/* The comparison of two words of the job, which is the same in all lanes. Each outcome is as likely. */
static uint16_t compare_words(struct maker *maker)
{
    struct ir_instruction word = {.op = IR_uniform, .type = TYPE_itg, .base = BASE_JOB};
    struct ir_instruction compare = {.op = IR_gt_i, .type = TYPE_msk};
    for (int o = 0; o < 2; o++) {
        unsigned offset = program_random(maker->seed) % 64 * 4;
        word.k = (int32_t)(offsetof(struct job, world_view_projection) + offset);
        compare.operand[o] = ir_append(maker->ir, word);
    }
    return ir_append(maker->ir, compare);
}

/* The condition of a region. One that is the same in all lanes is mostly also used in the region. */
static uint16_t make_condition(struct maker *maker)
{
    if (program_random(maker->seed) % 4 == 0)
        return pick(maker, TYPE_msk);
    uint16_t condition = compare_words(maker);
    keep(maker, TYPE_msk, condition);
    return condition;
}

static void make_region(struct maker *maker, unsigned length)
{
    unsigned outside[TYPE_msk + 1];
    memcpy(outside, maker->count, sizeof outside);
    ir_append(maker->ir, (struct ir_instruction){.op = IR_when, .operand = {make_condition(maker)}});
    for (unsigned i = 0; i < length; i++)
        if (program_random(maker->seed) % 8)
            make_operation(maker);
        else if (program_random(maker->seed) % 2)
            make_gathers(maker);
        else
            make_reload(maker);
    make_store(maker);
    ir_append(maker->ir, (struct ir_instruction){.op = IR_end});
    memcpy(maker->count, outside, sizeof outside);
}

/* Starts a program with some values of each type. */
static void begin(struct maker *maker, struct ir *ir, uint64_t *seed, int wild)
{
    maker->ir = ir;
    maker->seed = seed;
    maker->wild = wild;
    memset(maker->count, 0, sizeof maker->count);
    ir_start(ir);
    ir->file[ir->file_count++] = "program";
    for (int type = TYPE_flt; type <= TYPE_fix; type++)
        for (int i = 0; i < 4; i++)
            make_source(maker, type);
    make_mask(maker);
}

static void make_source_or_reload(struct maker *maker)
{
    if (program_random(maker->seed) % 3)
        make_source(maker, TYPE_flt + program_random(maker->seed) % 3);
    else
        make_reload(maker);
}

static void make_straight(struct ir *ir, unsigned length, uint64_t *seed, int wild)
{
    static struct maker maker;
    begin(&maker, ir, seed, wild);
    for (unsigned i = 0; i < length; i++)
        switch (program_random(seed) % 16) {
        case 0: make_store_or_merge(&maker); break;
        case 1: make_cast(&maker); break;
        case 2: make_source_or_reload(&maker); break;
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

void program_make(struct ir *ir, unsigned length, uint64_t *seed)
{
    make_straight(ir, length, seed, 0);
}

/* --- With control flow ------------------------------------------------------------------------------- */

/* Variables: SHARED_VARIABLES numbers, whose types alternate, then one counter for each depth of loops. */
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

/* Exchanges the values of two or three variables of one type. */
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

/* Makes a loop with a counter in each lane, at most 3: counter = bound; loop ... counter -= 1; again while
 * 0 < counter, and in some loops while another mask is set. In counted programs some bounds are literals. */
static void make_loop(struct maker *maker, unsigned length, unsigned depth, unsigned loops)
{
    struct ir_instruction three = {.op = IR_literal, .type = TYPE_itg, .k = 3};
    struct ir_instruction one = {.op = IR_literal, .type = TYPE_itg, .k = 1};
    struct ir_instruction zero = {.op = IR_literal, .type = TYPE_itg, .k = 0};
    struct ir_instruction mask = {.op = IR_and_i, .type = TYPE_itg};
    bool constant = maker->counted && program_random(maker->seed) % 2;
    three.k -= constant ? (int32_t)(program_random(maker->seed) % 4) : 0;
    mask.operand[0] = pick(maker, TYPE_itg);
    mask.operand[1] = ir_append(maker->ir, three);
    make_set(maker, COUNTERS + loops, constant ? mask.operand[1] : ir_append(maker->ir, mask));
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
    if (loops < LOOP_DEPTH && program_random(maker->seed) % 2) {
        make_loop(maker, length, depth, loops);
        if (maker->wild)
            return;
    } else {
        ir_append(maker->ir, (struct ir_instruction){.op = IR_when, .operand = {make_condition(maker)}});
        make_body(maker, length, depth + 1, loops);
        ir_append(maker->ir, (struct ir_instruction){.op = IR_end});
    }
    memcpy(maker->count, outside, sizeof outside);
}

static void make_body(struct maker *maker, unsigned length, unsigned depth, unsigned loops)
{
    for (unsigned i = 0; i < length; i++)
        switch (program_random(maker->seed) % 16) {
        case 0: make_store_or_merge(maker); break;
        case 1: make_cast(maker); break;
        case 2: make_source_or_reload(maker); break;
        case 3:
            if (depth < REGION_DEPTHS && maker->ir->count < maker->limit)
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

static void make_controlled(struct ir *ir, unsigned length, uint64_t *seed, int wild, int counted)
{
    enum { GROWTH = 64, ROOM = IR_CAPACITY / 2 };
    static struct maker maker;
    begin(&maker, ir, seed, wild);
    maker.counted = counted;
    maker.limit = length < ROOM / GROWTH ? length * GROWTH : ROOM;
    for (int i = 0; i < 8; i++)
        make_operation(&maker);
    for (unsigned variable = 0; variable < SHARED_VARIABLES; variable++)
        make_set(&maker, variable, pick(&maker, variable_type(variable)));
    make_body(&maker, length, 0, 0);
    for (unsigned variable = 0; variable < SHARED_VARIABLES; variable++)
        if (variable_type(variable) != TYPE_msk)
            make_get(&maker, variable, variable_type(variable)), make_store(&maker);
}

void program_make_loops(struct ir *ir, unsigned length, uint64_t *seed)
{
    make_controlled(ir, length, seed, 0, 0);
}

void program_make_counted(struct ir *ir, unsigned length, uint64_t *seed)
{
    make_controlled(ir, length, seed, 0, 1);
}

void program_make_wild(struct ir *ir, unsigned length, uint64_t *seed)
{
    if (program_random(seed) % 2)
        make_straight(ir, length, seed, 1);
    else
        make_controlled(ir, length, seed, 1, 0);
}
