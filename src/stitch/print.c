/* The listing of a plan: each part with its arguments by name and what it does, then its instructions. */
#include "stitch/plan.h"

#include "base/disassemble.h"

#include <string.h>

struct fragment_text fragment_text(const struct fragment *fragment)
{
    static const struct {
        const struct fragment *fragment;
        struct fragment_text text;
    } table[] = {
#define PARAMETER_flt(n) " " #n
#define PARAMETER_itg(n) " " #n
#define PARAMETER_fix(n) " " #n
#define PARAMETER_msk(n) " " #n
#define PARAMETER_non(n)
#define FRAGMENT(name, arguments, meaning) {&fragment_##name, {arguments, meaning}},
#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    {&fragment_##name, {"result" PARAMETER_##ta(a) PARAMETER_##tb(b) PARAMETER_##tc(c), #expression}},
#define OPK(name, result, ta, tb, tc, properties, expression) {&fragment_##name, {"result a k", #expression}},
#define CAST(name, result, from)
#include "def/fragment.def"
#include "def/op.def"
#undef FRAGMENT
#undef OP
#undef OPK
#undef CAST
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (table[i].fragment == fragment)
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

static void print_arguments(const struct part *part, const char *name, FILE *out)
{
    for (unsigned n = 0; *name; n++) {
        int length = (int)strcspn(name, " ");
        int32_t value = part->arguments.value[n];
        const char *form = !strncmp(name, "value", 5) && length == 5 ? " %.*s=0x%x" : " %.*s=%d";
        fprintf(out, form, length, name, value);
        name += length;
        name += *name == ' ';
    }
}

void plan_print(const struct plan *plan, const struct code_span *span, FILE *out)
{
    for (unsigned i = 0; i < plan->count; i++) {
        const struct part *part = plan->part + i;
        struct listing listing = {out, part->offset};
        struct fragment_text text = fragment_text(part->fragment);
        fprintf(out, "%u %s", i, part->fragment->name);
        print_arguments(part, text.arguments, out);
        fprintf(out, "  ; %s", text.meaning);
        if (part->file)
            fprintf(out, ", %s:%d", part->file, part->line);
        fputc('\n', out);
        disassemble(span->writable + part->offset, part->fragment->bytes, part->offset, print_instruction,
                    &listing);
    }
}
