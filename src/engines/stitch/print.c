/* The listing of a plan: each part with its arguments by name and what it does, then its instructions. */
#include "engines/stitch/plan.h"

#include "machine/disassemble.h"

#include <string.h>

struct fragment_text stitch_fragment_text(const struct fragment *fragment)
{
    static const struct {
        const struct fragment *fragment;
        struct fragment_text text;
    } table[] = {
#define PARAMETER_flt(n) ", " #n
#define PARAMETER_itg(n) ", " #n
#define PARAMETER_fix(n) ", " #n
#define PARAMETER_msk(n) ", " #n
#define PARAMETER_non(n)
#define TEXT(...)                          #__VA_ARGS__
#define FRAGMENT(name, arguments, meaning) {&fragment_##name, {TEXT arguments, meaning}},
#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    {&fragment_##name, {"result" PARAMETER_##ta(a) PARAMETER_##tb(b) PARAMETER_##tc(c), #expression}},
#define OPK(name, result, ta, tb, tc, properties, expression)                                                \
    {&fragment_##name, {"result, a, k", #expression}},
#define CAST(name, result, from)
#include "def/engine/fragment.def"
#include "def/op.def"
#undef FRAGMENT
#undef TEXT
#undef OP
#undef OPK
#undef CAST
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (table[i].fragment == fragment || (table[i].fragment->folded && table[i].fragment + 1 == fragment))
            return table[i].text;
    return (struct fragment_text){NULL, NULL};
}

struct listing {
    FILE *out;
    uint32_t part_offset;
};

static void print_instruction(void *context, size_t offset, size_t length, const char *text)
{
    const struct listing *listing = context;
    (void)length;
    fprintf(listing->out, "    %04zx  %s\n", listing->part_offset + offset, text);
}

static bool is_address(const struct fragment *fragment, unsigned n)
{
    for (unsigned i = 0; i < fragment->holes; i++)
        if (fragment->hole[i].kind == HOLE_ADDRESS && fragment->hole[i].argument == n)
            return true;
    return false;
}

static void print_argument(const struct part *part, unsigned n, const char *name, int length, FILE *out)
{
    const struct fragment *fragment = part->fragment;
    int32_t value = part->arguments.value[n];
    fprintf(out, " %.*s=", length, name);
    if ((fragment->given | fragment->read) >> n & 1)
        fprintf(out, "%s", stitch_register_name(REGISTER_VECTORS + (unsigned)value));
    else if (is_address(fragment, n))
        fprintf(out, "[%s%+d]", stitch_register_name((unsigned)part->arguments.value[ARGUMENT_BASE]), value);
    else
        fprintf(out, !strncmp(name, "value", 5) && length == 5 ? "0x%x" : "%d", value);
}

void plan_print_part(const struct part *part, FILE *out)
{
    const char *name = stitch_fragment_text(part->fragment).arguments;
    fputs(part->fragment->name, out);
    for (unsigned n = 0; *name; n++) {
        int length = (int)strcspn(name, ",");
        print_argument(part, n, name, length, out);
        name += length;
        name += strspn(name, ", ");
    }
}

static void print_counts(const struct plan *plan, FILE *out)
{
    const struct plan_counts *counts = &plan->counts;
    if (counts->operations)
        fprintf(out,
                "%u operations, %u of them fused: %u operands carried in registers, %u folded, %u loads, %u "
                "stores, %u literals\n",
                counts->operations, counts->fused, counts->carried, counts->folded, counts->loaded,
                counts->stored, plan->literals);
}

void plan_print(const struct plan *plan, const struct code_span *span, FILE *out)
{
    print_counts(plan, out);
    for (unsigned i = 0; i < plan->count; i++) {
        const struct part *part = plan->part + i;
        struct listing listing = {out, part->offset};
        fprintf(out, "%u ", i);
        plan_print_part(part, out);
        fprintf(out, "  ; %s", stitch_fragment_text(part->fragment).meaning);
        if (part->file)
            fprintf(out, ", %s:%d", part->file, part->line);
        fputc('\n', out);
        disassemble(span->writable + part->offset, part->fragment->bytes, part->offset, print_instruction,
                    &listing);
    }
}
