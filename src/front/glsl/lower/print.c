#include "front/glsl/lower/print.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ADDRESSES = 4, OUTPUTS_BEFORE_VARYINGS = 2 };

const struct glsl_machine glsl_machines[2] = {
    [GLSL_VERTEX] = {.constants = 256, .samplers = 4},
    [GLSL_FRAGMENT] = {.constants = 224, .samplers = 16},
};

/* A component of a0 and the scalar that it has; `known` false: none. */
struct address {
    bool known;
    uint32_t place;
    uint8_t component;
};

struct printer {
    struct glsl_code *code;
    const struct glsl_layout *layout;
    char *text;
    size_t used, room;
    int16_t literal[GLSL_LITERALS]; /* c#, or -1 */
    unsigned constants;             /* c# in use */
    struct address address[ADDRESSES];
    unsigned next_address, level; /* level: of blocks, for the indentation */
};

static void add(struct printer *p, const char *text, size_t length)
{
    if (p->used + length + 1 > p->room) {
        char *old = p->text;
        p->room = 2 * (p->used + length + 1) + 1024;
        p->text = glsl_take(p->code->arena, p->room);
        if (old)
            memcpy(p->text, old, p->used);
    }
    memcpy(p->text + p->used, text, length);
    p->used += length;
    p->text[p->used] = 0;
}

static void add_text(struct printer *p, const char *text)
{
    add(p, text, strlen(text));
}

static void add_number(struct printer *p, unsigned number)
{
    char digits[12];
    unsigned at = sizeof digits;
    do
        digits[--at] = (char)('0' + number % 10);
    while (number /= 10);
    add(p, digits + at, sizeof digits - at);
}

static void add_register(struct printer *p, const char *name, unsigned number)
{
    add_text(p, name);
    add_number(p, number);
}

static void indent(struct printer *p)
{
    for (unsigned i = 0; i < p->level; i++)
        add(p, "  ", 2);
}

/* --- Declarations --------------------------------------------------------------------------------------- */

/* Nine digits have the same bits; a number without digits is written as its bits. */
static void add_float(struct printer *p, float x)
{
    char text[32];
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    if (isfinite(x))
        snprintf(text, sizeof text, "%.9g", (double)x);
    else
        snprintf(text, sizeof text, "0x%08x", bits);
    add_text(p, text);
}

static void number_literals(struct printer *p)
{
    for (unsigned i = 0; i < GLSL_LITERALS; i++)
        p->literal[i] = -1;
    p->constants = p->layout->constants;
    for (uint32_t i = 0; i < p->code->count; i++) {
        const struct glsl_instruction *x = &p->code->instruction[i];
        for (unsigned k = 0; k < glsl_ops[x->op].sources; k++)
            if (x->from[k].file == GLSL_FILE_LITERAL && p->literal[x->from[k].number] < 0)
                p->literal[x->from[k].number] = (int16_t)p->constants++;
    }
}

static void define_literals(struct printer *p)
{
    for (unsigned i = 0; i < p->code->literals; i++) {
        if (p->literal[i] < 0)
            continue;
        add_register(p, "def c", (unsigned)p->literal[i]);
        for (unsigned c = 0; c < 4; c++) {
            add_text(p, ", ");
            add_float(p, p->code->literal[i].value[c]);
        }
        add_text(p, "\n");
    }
}

static void declare_sources(struct printer *p)
{
    static const char *const names[] = {"dcl vPos\n", "dcl vFace\n", "dcl vPoint\n"};
    unsigned found = 0;
    for (uint32_t i = 0; i < p->code->count; i++)
        for (unsigned k = 0; k < glsl_ops[p->code->instruction[i].op].sources; k++)
            if (p->code->instruction[i].from[k].file == GLSL_FILE_SOURCE)
                found |= 1u << p->code->instruction[i].from[k].number;
    for (unsigned i = 0; i < 3; i++)
        if (found >> i & 1)
            add_text(p, names[i]);
}

static void declare(struct printer *p, unsigned usage, const char *file, unsigned number)
{
    add_register(p, "dcl_texcoord", usage);
    add_register(p, file, number);
    add_text(p, "\n");
}

/* Aliased attributes share a register. */
static void declare_attributes(struct printer *p)
{
    uint32_t declared = 0;
    for (uint32_t i = 0; i < p->code->attribute.registers; i++) {
        int number = p->layout->attribute[i].number;
        if (number < 0 || declared >> number & 1)
            continue;
        declared |= 1u << number;
        declare(p, (unsigned)number, " v", (unsigned)number);
    }
}

static bool writes_point_size(const struct glsl_code *code)
{
    for (uint32_t i = 0; i < code->count; i++)
        if (code->instruction[i].to.file == GLSL_FILE_RESULT &&
            code->instruction[i].to.number == GLSL_RESULT_POINT_SIZE)
            return true;
    return false;
}

static void declare_samplers(struct printer *p)
{
    for (unsigned i = 0; i < glsl_machines[p->code->unit->stage].samplers; i++)
        if (p->layout->sampler[i]) {
            add_register(p, p->layout->sampler[i] == GLSL_SAMPLER_CUBE ? "dcl_cube s" : "dcl_2d s", i);
            add_text(p, "\n");
        }
}

static void declare_arrays(struct printer *p)
{
    for (uint32_t i = 0; i < p->code->temporaries; i++) {
        const struct glsl_temporary *x = &p->code->temporary[i];
        if (!x->registers || x->block != i)
            continue;
        add_register(p, "array r", x->place);
        add_register(p, ", r", x->place + x->registers - 1);
        add_text(p, "\n");
    }
}

static void declare_all(struct printer *p)
{
    bool vertex = p->code->unit->stage == GLSL_VERTEX;
    add_text(p, vertex ? "vs_gl\n" : "ps_gl\n");
    define_literals(p);
    declare_sources(p);
    if (vertex) {
        declare_attributes(p);
        add_text(p, "dcl_position o0\n");
        if (writes_point_size(p->code))
            add_text(p, "dcl_psize o1.x\n");
    }
    for (unsigned i = 0; i < p->layout->varyings; i++)
        declare(p, i, vertex ? " o" : " v", vertex ? i + OUTPUTS_BEFORE_VARYINGS : i);
    declare_samplers(p);
    declare_arrays(p);
}

/* --- Operands ------------------------------------------------------------------------------------------- */

/* The register of an operand, and the number of components before its first one. */
static unsigned add_name(struct printer *p, const struct glsl_operand *x, bool sampler)
{
    static const char *const sources[] = {"vPos", "vFace", "vPoint"};
    const struct glsl_layout *layout = p->layout;
    struct glsl_spot spot = {0};
    switch ((enum glsl_file)x->file) {
    case GLSL_FILE_TEMPORARY: add_register(p, "r", p->code->temporary[x->number].place); return 0;
    case GLSL_FILE_LITERAL: add_register(p, "c", (unsigned)p->literal[x->number]); return 0;
    case GLSL_FILE_SOURCE: add_text(p, sources[x->number]); return 0;
    case GLSL_FILE_UNIFORM:
        spot = layout->uniform[x->number];
        add_register(p, sampler ? "s" : "c", (unsigned)spot.number);
        return sampler ? 0 : spot.component;
    case GLSL_FILE_ATTRIBUTE: add_register(p, "v", (unsigned)layout->attribute[x->number].number); return 0;
    case GLSL_FILE_VARYING:
        spot = layout->varying[x->number];
        if (p->code->unit->stage == GLSL_VERTEX)
            add_register(p, "o", (unsigned)spot.number + OUTPUTS_BEFORE_VARYINGS);
        else
            add_register(p, "v", (unsigned)spot.number);
        return spot.component;
    case GLSL_FILE_RESULT:
        if (x->number >= GLSL_RESULT_COLOR)
            add_register(p, "oC", x->number == GLSL_RESULT_SECOND ? 1 : x->number - GLSL_RESULT_COLOR);
        else
            add_text(p, x->number == GLSL_RESULT_POSITION     ? "o0"
                        : x->number == GLSL_RESULT_POINT_SIZE ? "o1"
                                                              : "oDepth");
        return 0;
    case GLSL_FILE_NONE: break;
    }
    return 0;
}

static void add_swizzle(struct printer *p, unsigned swizzle, unsigned before)
{
    char text[6] = ".";
    for (unsigned i = 0; i < 4; i++) {
        unsigned c = glsl_component(swizzle, i) + before;
        text[i + 1] = "xyzw"[c < 4 ? c : 3];
    }
    if (!strcmp(text, ".xyzw"))
        return;
    bool same = text[1] == text[2] && text[1] == text[3] && text[1] == text[4];
    add(p, text, same ? 2 : 5);
}

static void add_address(struct printer *p, const struct glsl_operand *x)
{
    if (!x->access)
        return;
    uint32_t place = p->code->temporary[x->index].place;
    unsigned i = 0;
    while (i < ADDRESSES - 1 && !(p->address[i].known && p->address[i].place == place &&
                                  p->address[i].component == x->index_component))
        i++;
    add_text(p, "[a0.");
    add(p, &"xyzw"[i], 1);
    add_text(p, "]");
}

/* `shift`: the components of the result are moved by it, and so are those of a source. */
static void add_source(struct printer *p, const struct glsl_operand *x, unsigned shift, bool sampler)
{
    unsigned swizzle = (unsigned)x->swizzle << 2 * shift & 0xff;
    bool scalar = x->file == GLSL_FILE_SOURCE && x->number == GLSL_SOURCE_FACING;
    if (x->negative != (scalar && p->layout->turned))
        add_text(p, "-");
    unsigned before = add_name(p, x, sampler);
    add_address(p, x);
    if (x->absolute)
        add_text(p, "_abs");
    if (!sampler && !scalar) {
        for (unsigned i = 0; i < shift; i++)
            swizzle |= glsl_component(x->swizzle, 0) << 2 * i;
        add_swizzle(p, swizzle, before);
    }
}

static unsigned shift_of(const struct printer *p, const struct glsl_instruction *x)
{
    return x->to.file == GLSL_FILE_VARYING ? p->layout->varying[x->to.number].component : 0;
}

static void add_result(struct printer *p, const struct glsl_instruction *x)
{
    unsigned mask = (unsigned)x->mask << shift_of(p, x);
    add_name(p, &x->to, false);
    add_address(p, &x->to);
    if (mask == 15 || (x->to.file == GLSL_FILE_RESULT && x->to.number == GLSL_RESULT_DEPTH))
        return;
    add_text(p, ".");
    for (unsigned c = 0; c < 4; c++)
        if (mask >> c & 1)
            add(p, &"xyzw"[c], 1);
}

/* --- Addresses ------------------------------------------------------------------------------------------ */

static void load_address(struct printer *p, const struct glsl_operand *x, unsigned *in_use)
{
    if (!x->access)
        return;
    struct address wanted = {true, p->code->temporary[x->index].place, x->index_component};
    for (unsigned i = 0; i < ADDRESSES; i++)
        if (p->address[i].known && p->address[i].place == wanted.place &&
            p->address[i].component == wanted.component) {
            *in_use |= 1u << i;
            return;
        }
    while (*in_use >> p->next_address % ADDRESSES & 1)
        p->next_address++;
    unsigned i = p->next_address++ % ADDRESSES;
    p->address[i] = wanted;
    *in_use |= 1u << i;
    indent(p);
    add_text(p, "mova a0.");
    add(p, &"xyzw"[i], 1);
    add_register(p, ", r", wanted.place);
    add_text(p, ".");
    add(p, &"xyzw"[wanted.component], 1);
    add_text(p, "\n");
}

/* An instruction has at most four relative operands, each with an address of its own. */
static void load_addresses(struct printer *p, const struct glsl_instruction *x)
{
    unsigned in_use = 0;
    for (unsigned i = 0; i < glsl_ops[x->op].sources; i++)
        load_address(p, &x->from[i], &in_use);
    load_address(p, &x->to, &in_use);
}

/* After an instruction: an address whose scalar was written is not known. Blocks begin without any. */
static void forget_addresses(struct printer *p, const struct glsl_instruction *x)
{
    bool flow = glsl_ops[x->op].kind == GLSL_FLOW;
    for (unsigned i = 0; i < ADDRESSES; i++) {
        bool written = x->to.file == GLSL_FILE_TEMPORARY &&
                       (x->to.access || p->code->temporary[x->to.number].place == p->address[i].place);
        if (flow || written)
            p->address[i].known = false;
    }
}

/* --- Instructions --------------------------------------------------------------------------------------- */

static void print_instruction(struct printer *p, const struct glsl_instruction *x)
{
    static const char *const comparisons[] = {"gt", "eq", "ge", "lt", "ne", "le"};
    const struct glsl_op_row *row = &glsl_ops[x->op];
    bool flow = row->kind == GLSL_FLOW;
    load_addresses(p, x);
    indent(p);
    add_text(p, row->text);
    if (flow && row->sources)
        add_text(p, comparisons[x->comparison]);
    if (!flow) {
        add(p, " ", 1);
        add_result(p, x);
    }
    for (unsigned i = 0; i < row->sources; i++) {
        bool texture = x->op >= GLSL_OP_TEXLD && x->op <= GLSL_OP_TEXLDD && i == 1;
        add_text(p, flow && !i ? " " : ", ");
        add_source(p, &x->from[i], row->kind == GLSL_EACH ? shift_of(p, x) : 0, texture);
    }
    add(p, "\n", 1);
    forget_addresses(p, x);
}

/* The second colour is oC1, and then the other targets have none. */
static bool is_left_out(const struct printer *p, const struct glsl_operand *to)
{
    if (to->file != GLSL_FILE_RESULT || to->number <= GLSL_RESULT_COLOR)
        return false;
    return p->layout->second != (to->number == GLSL_RESULT_SECOND);
}

static void print_code(struct printer *p)
{
    for (uint32_t i = 0; i < p->code->count; i++) {
        const struct glsl_instruction *x = &p->code->instruction[i];
        unsigned op = x->op;
        p->level -= op == GLSL_OP_ELSE || op == GLSL_OP_ENDIF || op == GLSL_OP_ENDWHILE;
        if (!is_left_out(p, &x->to))
            print_instruction(p, x);
        p->level += op == GLSL_OP_ELSE || op == GLSL_OP_IF || op == GLSL_OP_WHILE;
    }
}

char *glsl_print(struct glsl_code *code, const struct glsl_layout *layout)
{
    struct printer p = {.code = code, .layout = layout};
    number_literals(&p);
    if (p.constants > glsl_machines[code->unit->stage].constants) {
        glsl_code_fail(code, "more uniforms and literals than there are registers");
        return NULL;
    }
    declare_all(&p);
    print_code(&p);
    return p.text;
}
