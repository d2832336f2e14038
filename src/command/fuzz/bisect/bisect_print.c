#include "base/bits.h"
#include "command/fuzz/bisect/bisect.h"

#include <stdio.h>

static const char *const type_names[] = {[TYPE_non] = "bits",
                                         [TYPE_flt] = "float",
                                         [TYPE_itg] = "integer",
                                         [TYPE_fix] = "pair",
                                         [TYPE_msk] = "mask"};

/* A value as its type shows it, and its bits. */
static void print_value(struct text *out, uint8_t type, uint32_t bits)
{
    float number = bits_to_float(bits);
    switch (type) {
    case TYPE_flt: text_add(out, "%.9g (%08x)", (double)number, bits); break;
    case TYPE_itg: text_add(out, "%d (%08x)", (int32_t)bits, bits); break;
    case TYPE_fix: text_add(out, "%u %u (%08x)", bits & 0xffff, bits >> 16, bits); break;
    default: text_add(out, "%08x", bits); break;
    }
}

static void print_values(struct text *out, const struct bisection *b, const uint32_t value[2], uint8_t type)
{
    for (int i = 0; i < 2; i++) {
        text_add(out, "%s%s ", i ? ", " : "", b->engine[i]->name);
        print_value(out, type, value[i]);
    }
}

static void print_where(struct text *out, const struct bisection *b)
{
    if (b->unit == UNIT_PIXEL)
        text_add(out, "lane %u, pixel %d,%d", b->lane, b->x, b->y);
    else if (b->unit == UNIT_VERTEX)
        text_add(out, "lane %u, vertex %u", b->lane, b->element);
    else if (b->unit == UNIT_BLIT)
        text_add(out, "element %u", b->element);
    else
        text_add(out, "lane %u, triangle from lane %u of the batch", b->lane, b->element / 4);
    text_add(out, ", draw %llu, unit %s\n", (unsigned long long)b->draw, unit_name[b->unit]);
}

static void print_first_line(struct text *out, const struct bisection *b)
{
    if (b->outcome == BISECT_FOUND || (b->outcome == BISECT_NARROWED && b->operation)) {
        text_add(out, "%s: %s%s: ", *b->place ? b->place : "(no line)", *b->fragment ? "fragment " : "",
                 b->operation);
        print_values(out, b, b->value, b->type);
    } else {
        text_add(out, "%s routine, %s: ", unit_name[b->unit], b->output_name);
        print_values(out, b, b->output, TYPE_non);
    }
    text_add(out, ", ");
    print_where(out, b);
}

void bisection_print(const struct bisection *b, struct text *out)
{
    if (b->outcome == BISECT_SAME) {
        text_add(out, "the routines of %s and %s agree on every call\n", b->engine[0]->name,
                 b->engine[1]->name);
        return;
    }
    print_first_line(out, b);
    if (b->outcome == BISECT_FOUND && *b->place && !*b->fragment) {
        text_add(out, "  the recording, by the table of operations: ");
        print_value(out, b->type, b->expected);
        text_add(out, " (%%%u, %s%s)\n", b->instruction, type_names[b->type],
                 b->in_loop ? ", in a loop" : "");
        if (b->in_loop)
            text_add(out, "  in pass %u of the loop around it, from 0\n", b->visit_pass);
    }
    if (b->outcome != BISECT_CALL) {
        text_add(out, "  first output that differs: %s: ", b->output_name);
        print_values(out, b, b->output, TYPE_non);
        text_add(out, "\n");
    }
    text_add(out, "  frame %u, draw %u of it\n  key of the %s routine: %s\n", b->frame, b->draw_of_frame,
             unit_name[b->unit], b->key);
    if (*b->pass)
        text_add(out, "  caused by: %s\n", b->pass);
    if (*b->fragment)
        text_add(out, "  first fragment whose result differs: %s\n", b->fragment);
    if (*b->reason)
        text_add(out, "  %s\n", b->reason);
}
