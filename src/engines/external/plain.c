/* Prints the operations of plain C: for each row of def/op.def a function that returns the row's own
 * expression. So a new row needs no other text for plain C. */
#include "engines/external/external.h"

#include <string.h>

struct row {
    const char *name, *result, *operand[3], *expression;
    bool shifts;
};

static const struct row rows[] = {
#define OP(name, result, a, b, c, properties, expression)  {#name, #result, {#a, #b, #c}, #expression, false},
#define OPK(name, result, a, b, c, properties, expression) {#name, #result, {#a, #b, #c}, #expression, true},
#define CAST(name, result, from)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
};

/* The operations that plain.h defines as flushed_NAME for machines that keep denormals. The others give the
 * same bits there. */
static const char *const flushed[] = {"add_f", "sub_f", "mul_f", "div_f", "mad_f", "sqrt_f",
                                      "min_f", "max_f", "lt_f",  "le_f",  "eq_f",  "ne_f"};

static bool is_flushed(const char *name)
{
    for (size_t i = 0; i < sizeof flushed / sizeof *flushed; i++)
        if (!strcmp(flushed[i], name))
            return true;
    return false;
}

static int count_operands(const struct row *row)
{
    int count = 0;
    while (count < 3 && strcmp(row->operand[count], "non"))
        count++;
    return count;
}

/* The parameters are a, b and c, as in the expressions. `half` is the type of a half, or null. */
static void print_head(const struct row *row, const char *half, FILE *out)
{
    int operands = count_operands(row);
    fprintf(out, "static inline %s %s%s(", half ? half : row->result, row->name, half ? "_half" : "");
    for (int o = 0; o < operands; o++)
        fprintf(out, "%s%s %c", o ? ", " : "", half ? half : row->operand[o], 'a' + o);
    fprintf(out, "%s)\n{\n    return ", row->shifts ? ", int k" : "");
}

static void print_arguments(const struct row *row, const char *before, const char *after, FILE *out)
{
    int operands = count_operands(row);
    for (int o = 0; o < operands; o++)
        fprintf(out, "%s%s%c%s", o ? ", " : "", before, 'a' + o, after);
    fprintf(out, "%s)", row->shifts ? ", k" : "");
}

/* An operation on pairs: a function of halves, and its use for both. */
static void print_pairs(const struct row *row, FILE *out)
{
    print_head(row, "uint16_t", out);
    fprintf(out, "(uint16_t)(%s);\n}\n\n", row->expression);
    print_head(row, NULL, out);
    fprintf(out, "two_halves(%s_half(", row->name);
    print_arguments(row, "(uint16_t)", "", out);
    fprintf(out, ",\n                      %s_half(", row->name);
    print_arguments(row, "(uint16_t)(", " >> 16)", out);
    fputs(");\n}\n\n", out);
}

static void print_lane(const struct row *row, bool flushes, FILE *out)
{
    print_head(row, NULL, out);
    if (!strcmp(row->name, "float_f"))
        fputs("(float)(itg)((uint32_t)a ^ opaque_zero)", out); /* for the reason that literal_f has */
    else if (flushes && is_flushed(row->name)) {
        fprintf(out, "flushed_%s(", row->name);
        print_arguments(row, "", "", out);
    } else
        fputs(row->expression, out);
    fputs(";\n}\n\n", out);
}

void external_print_operations(bool flushes, FILE *out)
{
    for (size_t n = 0; n < sizeof rows / sizeof *rows; n++)
        if (!strcmp(rows[n].result, "fix"))
            print_pairs(&rows[n], out);
        else
            print_lane(&rows[n], flushes, out);
}
