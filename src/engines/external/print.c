/* Prints the recording as C: one statement for each instruction, with its number and its line of the
 * specification.
 *
 * The function is the loop of engines/specialize/emit/frame.c around the body. Values are named v and
 * their number, variables x and theirs. Literals and words of the draw are loaded once before the loop,
 * because the compiler cannot prove that the loop does not store to them. The values of a region are in a
 * block of their own. The recording has the same scopes as C.
 *
 * A value is all lanes in a text of vectors. In plain C it is one lane, and the statements are in loops over
 * the lanes (lanes.h). A value that is used outside of its loop is an array there. */
#include "base/bits.h"
#include "engines/external/print_part.h"

#include <stdlib.h>

const char *const external_type_word[] = {"", "flt", "itg", "fix", "msk"};
static const char type_letter[] = {' ', 'f', 'i', 'i', 'i'};

static const char *const base_word[BASE_COUNT] = {
#define BASE(name, meaning) #name,
#include "def/base.def"
#undef BASE
};

void external_begin_line(const struct printer *p)
{
    fprintf(p->out, "%*s", 4 * p->depth, "");
}

void external_end_line(const struct printer *p, const struct ir_instruction *i)
{
    if (i->line)
        fprintf(p->out, " // %%%u %s:%u", (unsigned)(i - p->ir->instruction), p->ir->file[i->file], i->line);
    fputc('\n', p->out);
}

/* Returns true for a value that is the same in the whole run. It is printed before the loop. */
static bool is_outside(const struct ir_instruction *i)
{
    return i->op == IR_literal || (i->op == IR_uniform && (i->base == BASE_JOB || i->base == BASE_CONSTANT));
}

/* --- Names
 * ------------------------------------------------------------------------------------------------ */

void external_print_name(const struct printer *p, uint16_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    const char *type = external_type_word[i->type];
    if (i->op == IR_literal)
        fprintf(p->out, "%s_%08x", type, (unsigned)i->k);
    else if (is_outside(i))
        fprintf(p->out, "%s_%s_%d", type, base_word[i->base], (int)i->k);
    else
        fprintf(p->out, "v%u", number);
}

static void print_operand(const struct printer *p, uint16_t number)
{
    external_print_name(p, number);
    if (p->lanes && p->lanes->crosses[number])
        fputs("[i]", p->out);
}

void external_print_address(const struct printer *p, const struct ir_instruction *i)
{
    fprintf(p->out, "%s + %d", base_word[i->base], (int)i->k);
}

/* The address of the first lane, or of lane i in a loop over lanes. */
static void print_lane_address(const struct printer *p, const struct ir_instruction *i, int stride)
{
    external_print_address(p, i);
    if (p->lanes && i->op != IR_uniform)
        fprintf(p->out, " + %d * i", stride);
}

/* --- Statements
 * ------------------------------------------------------------------------------------------- */

static void print_call(const struct printer *p, const struct ir_instruction *i)
{
    fprintf(p->out, "%s(", ir_op_information[i->op].name);
    for (int o = 0; o < ir_op_information[i->op].operands; o++) {
        fputs(o ? ", " : "", p->out);
        print_operand(p, i->operand[o]);
    }
    if (ir_op_information[i->op].properties & IR_SHIFTS)
        fprintf(p->out, ", %d", (int)i->k);
    fputc(')', p->out);
}

static void print_copy(const struct printer *p, const struct ir_instruction *i)
{
    enum ir_type from = p->ir->instruction[i->operand[0]].type;
    if (i->type != from)
        fprintf(p->out, "%s_of_%s(", external_type_word[i->type], external_type_word[from]);
    print_operand(p, i->operand[0]);
    if (i->type != from)
        fputc(')', p->out);
}

/* Begins the conversion of a word in memory, which is a float or an integer, to a value of type `to`; then
 * external_end_cast ends it. Values of other types are the bits of integers. */
void external_begin_cast(const struct printer *p, enum ir_type to)
{
    if (to != TYPE_flt && to != TYPE_itg)
        fprintf(p->out, "%s_of_itg(", external_type_word[to]);
}

void external_end_cast(const struct printer *p, enum ir_type to)
{
    if (to != TYPE_flt && to != TYPE_itg)
        fputc(')', p->out);
}

static void print_gather(const struct printer *p, const struct ir_instruction *i)
{
    external_begin_cast(p, i->type);
    fprintf(p->out, "gather_%c(", type_letter[i->type]);
    if (i->field == GATHER_DIRECT)
        external_print_address(p, i);
    else
        fprintf(p->out, "read_pointer(%s + %d) + %d", base_word[i->base], (int)i->field, (int)i->k);
    fputs(", ", p->out);
    print_operand(p, i->operand[0]);
    fprintf(p->out, ", %d)", i->scale);
    external_end_cast(p, i->type);
}

static void print_permute(const struct printer *p, const struct ir_instruction *i)
{
    bool one = p->lanes && external_is_one(&p->ir->instruction[i->operand[0]]);
    fputs(one ? "" : "permute_f(", p->out);
    external_print_name(p, i->operand[0]);
    if (!one)
        fprintf(p->out, ", %d)", (int)i->k);
}

static void print_value(const struct printer *p, const struct ir_instruction *i)
{
    switch (i->op) {
    case IR_copy: print_copy(p, i); break;
    case IR_gather: print_gather(p, i); break;
    case IR_get: fprintf(p->out, "x%d%s", (int)i->k, p->lanes ? "[i]" : ""); break;
    case IR_permute: print_permute(p, i); break;
    case IR_load:
    case IR_uniform:
        external_begin_cast(p, i->type);
        fprintf(p->out, "%s_%c(", ir_op_information[i->op].name, type_letter[i->type]);
        print_lane_address(p, i, 4);
        fputc(')', p->out);
        external_end_cast(p, i->type);
        break;
    default: print_call(p, i); break;
    }
}

/* The type of a stored value is that of its instruction. Masks and pairs are stored as integers. */
static void print_write(const struct printer *p, const struct ir_instruction *i)
{
    enum ir_type type = p->ir->instruction[i->operand[0]].type;
    fprintf(p->out, "%s_%c(", p->lanes ? "store" : ir_op_information[i->op].name, type_letter[type]);
    print_lane_address(p, i, i->op == IR_scatter ? i->field : 4);
    if (i->op == IR_scatter && !p->lanes)
        fprintf(p->out, ", %d", (int)i->field);
    bool casts = type != TYPE_flt && type != TYPE_itg;
    fputs(", ", p->out);
    if (casts)
        fprintf(p->out, "itg_of_%s(", external_type_word[type]);
    print_operand(p, i->operand[0]);
    fputs(casts ? "));" : ");", p->out);
}

/* A condition: true if a lane of the mask is set. */
static void print_any(const struct printer *p, uint16_t number)
{
    bool one = p->lanes && external_is_one(&p->ir->instruction[number]);
    if (p->packs) {
        external_print_pixel_any(p, number);
        return;
    }
    fputs(one ? "" : "any(", p->out);
    external_print_name(p, number);
    fputs(one ? "" : ")", p->out);
}

/* Prints the begin or the end of a region and changes the depth for the following statements. */
static void print_control(struct printer *p, const struct ir_instruction *i)
{
    switch (i->op) {
    case IR_when:
        fputs("if (", p->out);
        print_any(p, i->operand[0]);
        fputs(") {", p->out);
        p->depth++;
        break;
    case IR_loop:
        fputs("for (;;) {", p->out);
        p->depth++;
        break;
    case IR_again:
        fputs("if (!", p->out);
        print_any(p, i->operand[0]);
        fputs(")\n", p->out);
        p->depth++;
        external_begin_line(p);
        p->depth -= 2;
        fputs("break;\n", p->out);
        external_begin_line(p);
        fputc('}', p->out);
        break;
    case IR_set:
        fprintf(p->out, p->lanes ? "x%d[i] = " : "x%d = ", (int)i->k);
        print_operand(p, i->operand[0]);
        fputc(';', p->out);
        break;
    default: fputc('}', p->out); break;
    }
}

static void print_instruction(struct printer *p, uint32_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    if (i->op == IR_nop || is_outside(i))
        return;
    if (i->op == IR_end)
        p->depth--;
    external_begin_line(p);
    if (i->op == IR_store || i->op == IR_scatter)
        print_write(p, i);
    else if (!i->type || i->op == IR_set)
        print_control(p, i);
    else {
        if (!p->lanes || !p->lanes->crosses[number])
            fprintf(p->out, "%s ", external_type_word[i->type]);
        print_operand(p, (uint16_t)number);
        fputs(" = ", p->out);
        print_value(p, i);
        fputc(';', p->out);
    }
    external_end_line(p, i);
}

/* --- Loops over lanes ----------------------------------------------------------------------------------- */

static bool is_in_loop(const struct ir_instruction *i)
{
    return i->op != IR_nop && !external_is_one(i) && !(ir_properties(i) & (IR_OPENS | IR_CLOSES));
}

/* Prints what precedes the loop of a group: values that are the same in all lanes, and arrays. Returns true
 * if the group has anything else. */
static bool print_before_loop(struct printer *p, uint32_t number)
{
    const uint32_t group = p->lanes->group[number];
    bool loops = false;
    for (; number < p->ir->count && p->lanes->group[number] == group; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        loops |= is_in_loop(i);
        if (external_is_one(i))
            print_instruction(p, number);
        if (p->packs)
            external_declare_pixels(p, number);
        if (p->packs || !p->lanes->crosses[number])
            continue;
        external_begin_line(p);
        fprintf(p->out, "%s v%u[WIDTH];\n", external_type_word[i->type], number);
    }
    return loops;
}

static void end_loop(struct printer *p)
{
    if (!p->group)
        return;
    p->group = 0;
    p->depth--;
    external_begin_line(p);
    fputs("}\n", p->out);
}

static void begin_loop(struct printer *p, uint32_t number)
{
    end_loop(p);
    if (!print_before_loop(p, number))
        return;
    external_begin_line(p);
    fputs("for (int i = 0; i < WIDTH; i++) {\n", p->out);
    p->depth++;
    p->group = p->lanes->group[number];
}

static void print_loops(struct printer *p)
{
    for (uint32_t number = 1; number < p->ir->count; number++) {
        if (p->lanes->group[number] != p->lanes->group[number - 1])
            begin_loop(p, number);
        if (p->packs && is_in_loop(&p->ir->instruction[number]))
            external_print_pixel(p, number);
        else if (!external_is_one(&p->ir->instruction[number]))
            print_instruction(p, number);
    }
    end_loop(p);
}

/* --- The function --------------------------------------------------------------------------------------- */

static int order_outside(const void *a, const void *b)
{
    const struct ir_instruction *x = *(const struct ir_instruction *const *)a;
    const struct ir_instruction *y = *(const struct ir_instruction *const *)b;
    int by_op = x->op - y->op, by_type = x->type - y->type, by_base = x->base - y->base;
    return by_op ? by_op : by_type ? by_type : by_base ? by_base : (x->k > y->k) - (x->k < y->k);
}

static void print_literal(const struct printer *p, const struct ir_instruction *i)
{
    float value = bits_to_float((uint32_t)i->k);
    if (i->type == TYPE_flt)
        fprintf(p->out, "literal_f(0x%08x); // %.9g\n", (unsigned)i->k, (double)value);
    else {
        external_begin_cast(p, i->type);
        fprintf(p->out, "all_lanes(0x%08x)", (unsigned)i->k);
        external_end_cast(p, i->type);
        fputs(";\n", p->out);
    }
}

static void print_outside(const struct printer *p, const struct ir_instruction **found, size_t count)
{
    qsort(found, count, sizeof *found, order_outside);
    for (size_t n = 0; n < count; n++) {
        if (n && !order_outside(found + n - 1, found + n))
            continue;
        external_begin_line(p);
        fprintf(p->out, "const %s ", external_type_word[found[n]->type]);
        print_operand(p, (uint16_t)(found[n] - p->ir->instruction));
        fputs(" = ", p->out);
        if (found[n]->op == IR_literal) {
            print_literal(p, found[n]);
            continue;
        }
        print_value(p, found[n]);
        fputc(';', p->out);
        external_end_line(p, found[n]);
    }
}

static int print_constants(const struct printer *p)
{
    const struct ir_instruction **found = malloc(p->ir->count * sizeof *found);
    size_t count = 0;
    if (!found)
        return -1;
    for (uint32_t number = 1; number < p->ir->count; number++)
        if (is_outside(&p->ir->instruction[number]))
            found[count++] = &p->ir->instruction[number];
    print_outside(p, found, count);
    free(found);
    return 0;
}

static void print_variables(const struct printer *p)
{
    uint8_t type[VARIABLES] = {0};
    for (uint32_t number = 1; number < p->ir->count; number++)
        if (p->ir->instruction[number].op == IR_set)
            type[p->ir->instruction[number].k] = p->ir->instruction[number].type;
    for (uint32_t variable = 0; variable < p->ir->variables; variable++)
        if (type[variable]) {
            external_begin_line(p);
            fprintf(p->out, "%s x%u%s;\n", p->packs ? "int" : external_type_word[type[variable]], variable,
                    p->lanes ? "[WIDTH]" : "");
        }
}

static void print_body(struct printer *p)
{
    print_variables(p);
    if (p->lanes)
        print_loops(p);
    for (uint32_t number = 1; !p->lanes && number < p->ir->count; number++)
        print_instruction(p, number);
}

#define FIELD(structure, field) (int)offsetof(struct structure, field)

static void print_job(const struct printer *p, int field, enum unit unit)
{
    int stage = unit == UNIT_PIXEL;
    fprintf(p->out, "    char *JOB = read_pointer(call + %d);\n", field);
    if (unit == UNIT_KERNEL || unit == UNIT_BLIT)
        return;
    fprintf(p->out, "    char *CONSTANT = read_pointer(JOB + %d);\n",
            FIELD(job, constants) + stage * (int)sizeof(float *));
}

static void print_list(struct printer *p, int index, int out, int count, int stride)
{
    fprintf(p->out,
            "    char *INPUT = read_pointer(call + %d), *OUTPUT = read_pointer(call + %d);\n"
            "    for (int left = read_int(call + %d); left > 0; left -= WIDTH) {\n",
            index, out, count);
    p->depth = 2;
    print_body(p);
    fprintf(p->out, "        INPUT += 4 * WIDTH;\n        OUTPUT += %d * WIDTH;\n    }\n", stride);
}

static void print_blocks(struct printer *p)
{
    fprintf(
        p->out,
        "    char *ENTRY = read_pointer(call + %d);\n"
        "    for (int left = read_int(call + %d); left > 0; left--, ENTRY += %d) {\n"
        "        char *TRIANGLE = read_pointer(call + %d) + (unsigned)read_int(ENTRY + %d);\n"
        "        int block = read_short(ENTRY + %d) * %d, coverage = read_short(ENTRY + %d);\n"
        "        char *LANES = read_pointer(call + %d);\n"
        "        char *COLOR = read_pointer(call + %d) + block, *DEPTH = read_pointer(call + %d) + block;\n"
        "        for (; coverage; coverage >>= WIDTH, LANES += 4 * WIDTH, COLOR += 4 * WIDTH, DEPTH += 4 * "
        "WIDTH) {\n"
        "            if (!(coverage & ((1 << WIDTH) - 1)))\n"
        "                continue;\n",
        FIELD(pixel_arguments, entries), FIELD(pixel_arguments, count), (int)sizeof(struct entry),
        FIELD(pixel_arguments, triangles), FIELD(entry, triangle), FIELD(entry, block), BLOCK_PIXELS * 4,
        FIELD(entry, coverage), FIELD(pixel_arguments, lanes), FIELD(pixel_arguments, color),
        FIELD(pixel_arguments, depth));
    p->depth = 3;
    print_body(p);
    fputs("        }\n    }\n", p->out);
}

static int print_function(struct printer *p, enum unit unit, const union key *key)
{
    static const int job_field[] = {FIELD(vertex_arguments, job), FIELD(setup_arguments, job),
                                    FIELD(pixel_arguments, job), FIELD(kernel_arguments, job),
                                    FIELD(blit_arguments, job)};
    FILE *out = p->out;
    fprintf(out, "void " EXTERNAL_FUNCTION "(const char *call)\n{\n");
    print_job(p, job_field[unit], unit);
    if (unit == UNIT_SETUP)
        fprintf(out, "    char *VERTICES = read_pointer(call + %d);\n", FIELD(setup_arguments, vertices));
    if (print_constants(p))
        return -1;
    switch (unit) {
    case UNIT_VERTEX:
        print_list(p, FIELD(vertex_arguments, index), FIELD(vertex_arguments, out),
                   FIELD(vertex_arguments, count), 4);
        break;
    case UNIT_SETUP:
        print_list(p, FIELD(setup_arguments, index), FIELD(setup_arguments, out),
                   FIELD(setup_arguments, count), layout_of_setup(&key->setup).stride);
        break;
    case UNIT_BLIT:
        print_list(p, FIELD(blit_arguments, index), FIELD(blit_arguments, out),
                   FIELD(blit_arguments, count), 4);
        break;
    case UNIT_KERNEL:
        print_list(p, FIELD(kernel_arguments, index), FIELD(kernel_arguments, out),
                   FIELD(kernel_arguments, count), key->kernel.stride);
        break;
    default: print_blocks(p); break;
    }
    fputs("}\n", out);
    return 0;
}

/* Prints a function with loops over lanes. */
static int print_with_loops(struct printer *p, bool packs, enum unit unit, const union key *key)
{
    struct lanes *lanes = malloc(sizeof *lanes);
    struct packs *pack = packs ? malloc(sizeof *pack) : NULL;
    uint8_t *printed = packs ? calloc(p->ir->count, 1) : NULL;
    int result = -1;
    if (lanes && (!packs || (pack && printed))) {
        external_group_lanes(p->ir, packs, lanes);
        if (packs)
            external_pack(p->ir, lanes, pack);
        p->lanes = lanes;
        p->packs = pack;
        p->printed = printed;
        result = print_function(p, unit, key);
    }
    free(lanes);
    free(pack);
    free(printed);
    return result;
}

int external_print(enum external_language language, const struct ir *ir, enum unit unit, const union key *key,
                   FILE *out)
{
    struct printer p = {.ir = ir, .out = out, .depth = 1};
    if (language == EXTERNAL_VECTORS)
        return print_function(&p, unit, key);
    return print_with_loops(&p, language == EXTERNAL_PIXELS, unit, key);
}
