/* Prints the recording as C: one statement for each instruction, with its number and its line of the
 * specification.
 *
 * The function is the loop of engines/specialize/emit/frame.c around the body. Values are named v and
 * their number, variables x and theirs. Literals and words of the draw are loaded once before the loop,
 * because the compiler cannot prove that the loop does not store to them. The values of a region are in a
 * block of their own. The recording has the same scopes as C. */
#include "base/bits.h"
#include "engines/external/external.h"

#include <stdlib.h>

static const char *const type_word[] = {"", "flt", "itg", "fix", "msk"};
static const char type_letter[] = {' ', 'f', 'i', 'i', 'i'};

static const char *const base_word[BASE_COUNT] = {
#define BASE(name, meaning) #name,
#include "def/base.def"
#undef BASE
};

struct printer {
    const struct ir *ir;
    FILE *out;
    int depth;
};

static void begin_line(const struct printer *p)
{
    fprintf(p->out, "%*s", 4 * p->depth, "");
}

static void end_line(const struct printer *p, const struct ir_instruction *i)
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

static void print_operand(const struct printer *p, uint16_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    const char *type = type_word[i->type];
    if (i->op == IR_literal)
        fprintf(p->out, "%s_%08x", type, (unsigned)i->k);
    else if (is_outside(i))
        fprintf(p->out, "%s_%s_%d", type, base_word[i->base], (int)i->k);
    else
        fprintf(p->out, "v%u", number);
}

static void print_address(const struct printer *p, const struct ir_instruction *i)
{
    fprintf(p->out, "%s + %d", base_word[i->base], (int)i->k);
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
    fprintf(p->out, "%s(%s)", i->type == TYPE_flt ? "hide_f(" : "", type_word[i->type]);
    print_operand(p, i->operand[0]);
    fputs(i->type == TYPE_flt ? ")" : "", p->out);
}

/* Memory contains floats and integers. Values of other types are the bits of integers. */
static void print_cast(const struct printer *p, const struct ir_instruction *i)
{
    if (i->type != TYPE_flt && i->type != TYPE_itg)
        fprintf(p->out, "(%s)", type_word[i->type]);
}

static void print_gather(const struct printer *p, const struct ir_instruction *i)
{
    print_cast(p, i);
    fprintf(p->out, "gather_%c(", type_letter[i->type]);
    if (i->field == GATHER_DIRECT)
        print_address(p, i);
    else
        fprintf(p->out, "read_pointer(%s + %d) + %d", base_word[i->base], (int)i->field, (int)i->k);
    fputs(", ", p->out);
    print_operand(p, i->operand[0]);
    fprintf(p->out, ", %d)", i->scale);
}

static void print_value(const struct printer *p, const struct ir_instruction *i)
{
    switch (i->op) {
    case IR_copy: print_copy(p, i); break;
    case IR_gather: print_gather(p, i); break;
    case IR_get: fprintf(p->out, "x%d", (int)i->k); break;
    case IR_permute:
        fputs("permute_f(", p->out);
        print_operand(p, i->operand[0]);
        fprintf(p->out, ", %d)", (int)i->k);
        break;
    case IR_load:
    case IR_uniform:
        print_cast(p, i);
        fprintf(p->out, "%s_%c(", ir_op_information[i->op].name, type_letter[i->type]);
        print_address(p, i);
        fputc(')', p->out);
        break;
    default: print_call(p, i); break;
    }
}

/* The type of a stored value is that of its instruction. Masks and pairs are stored as integers. */
static void print_write(const struct printer *p, const struct ir_instruction *i)
{
    enum ir_type type = p->ir->instruction[i->operand[0]].type;
    fprintf(p->out, "%s_%c(", ir_op_information[i->op].name, type_letter[type]);
    print_address(p, i);
    if (i->op == IR_scatter)
        fprintf(p->out, ", %d", (int)i->field);
    fprintf(p->out, type == TYPE_flt ? ", " : ", (itg)");
    print_operand(p, i->operand[0]);
    fputs(");", p->out);
}

/* Prints the begin or the end of a region and changes the depth for the following statements. */
static void print_control(struct printer *p, const struct ir_instruction *i)
{
    switch (i->op) {
    case IR_when:
        fputs("if (any(", p->out);
        print_operand(p, i->operand[0]);
        fputs(")) {", p->out);
        p->depth++;
        break;
    case IR_loop:
        fputs("for (;;) {", p->out);
        p->depth++;
        break;
    case IR_again:
        fputs("if (!any(", p->out);
        print_operand(p, i->operand[0]);
        fputs("))\n", p->out);
        p->depth++;
        begin_line(p);
        p->depth -= 2;
        fputs("break;\n", p->out);
        begin_line(p);
        fputc('}', p->out);
        break;
    case IR_set:
        fprintf(p->out, "x%d = ", (int)i->k);
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
    begin_line(p);
    if (i->op == IR_store || i->op == IR_scatter)
        print_write(p, i);
    else if (!i->type || i->op == IR_set)
        print_control(p, i);
    else {
        fprintf(p->out, "%s v%u = ", type_word[i->type], number);
        print_value(p, i);
        fputc(';', p->out);
    }
    end_line(p, i);
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
    else
        fprintf(p->out, "(%s)all_lanes(0x%08x);\n", type_word[i->type], (unsigned)i->k);
}

static void print_outside(const struct printer *p, const struct ir_instruction **found, size_t count)
{
    qsort(found, count, sizeof *found, order_outside);
    for (size_t n = 0; n < count; n++) {
        if (n && !order_outside(found + n - 1, found + n))
            continue;
        begin_line(p);
        fprintf(p->out, "const %s ", type_word[found[n]->type]);
        print_operand(p, (uint16_t)(found[n] - p->ir->instruction));
        fputs(" = ", p->out);
        if (found[n]->op == IR_literal) {
            print_literal(p, found[n]);
            continue;
        }
        print_value(p, found[n]);
        fputc(';', p->out);
        end_line(p, found[n]);
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
            begin_line(p);
            fprintf(p->out, "%s x%u;\n", type_word[type[variable]], variable);
        }
}

static void print_body(struct printer *p)
{
    print_variables(p);
    for (uint32_t number = 1; number < p->ir->count; number++)
        print_instruction(p, number);
}

#define FIELD(structure, field) (int)offsetof(struct structure, field)

static void print_job(const struct printer *p, int field, int stage)
{
    fprintf(p->out, "    char *JOB = read_pointer(call + %d);\n", field);
    fprintf(p->out, "    char *CONSTANT = read_pointer(JOB + %d);\n",
            FIELD(job, constants) + stage * (int)sizeof(float *));
}

static void print_list(struct printer *p, int index, int out, int count, int stride)
{
    fprintf(p->out,
            "    char *INPUT = read_pointer(call + %d), *OUTPUT = read_pointer(call + %d);\n"
            "    for (int left = read_int(call + %d); left > 0; left -= %d) {\n",
            index, out, count, EXTERNAL_WIDTH);
    p->depth = 2;
    print_body(p);
    fprintf(p->out, "        INPUT += %d;\n        OUTPUT += %d;\n    }\n", EXTERNAL_WIDTH * 4, stride);
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
        "        for (; coverage; coverage >>= %d, LANES += %d, COLOR += %d, DEPTH += %d) {\n"
        "            if (!(coverage & %d))\n"
        "                continue;\n",
        FIELD(pixel_arguments, entries), FIELD(pixel_arguments, count), (int)sizeof(struct entry),
        FIELD(pixel_arguments, triangles), FIELD(entry, triangle), FIELD(entry, block), BLOCK_PIXELS * 4,
        FIELD(entry, coverage), FIELD(pixel_arguments, lanes), FIELD(pixel_arguments, color),
        FIELD(pixel_arguments, depth), EXTERNAL_WIDTH, EXTERNAL_WIDTH * 4, EXTERNAL_WIDTH * 4,
        EXTERNAL_WIDTH * 4, (1 << EXTERNAL_WIDTH) - 1);
    p->depth = 3;
    print_body(p);
    fputs("        }\n    }\n", p->out);
}

int external_print(const struct ir *ir, enum unit unit, const union key *key, FILE *out)
{
    static const int job_field[UNIT_COUNT] = {FIELD(vertex_arguments, job), FIELD(setup_arguments, job),
                                              FIELD(pixel_arguments, job)};
    struct printer p = {.ir = ir, .out = out, .depth = 1};
    fprintf(out, "void " EXTERNAL_FUNCTION "(const char *call)\n{\n");
    print_job(&p, job_field[unit], unit == UNIT_PIXEL);
    if (unit == UNIT_SETUP)
        fprintf(out, "    char *VERTICES = read_pointer(call + %d);\n", FIELD(setup_arguments, vertices));
    if (print_constants(&p))
        return -1;
    switch (unit) {
    case UNIT_VERTEX:
        print_list(&p, FIELD(vertex_arguments, index), FIELD(vertex_arguments, out),
                   FIELD(vertex_arguments, count), EXTERNAL_WIDTH * 4);
        break;
    case UNIT_SETUP:
        print_list(&p, FIELD(setup_arguments, index), FIELD(setup_arguments, out),
                   FIELD(setup_arguments, count), EXTERNAL_WIDTH * layout_of_setup(&key->setup).stride);
        break;
    default: print_blocks(&p); break;
    }
    fputs("}\n", out);
    return 0;
}
