/* Statements of external:c=pixels: a vector has four values of one pixel. A pack is one operation on such
 * vectors. Operands that are in other lanes, or in several vectors, are shuffled first. Values that are not
 * computed are equal in all lanes, so they need no shuffle: words of memory, literals, variables. */
#include "engines/external/print_part.h"

#define OTHER_PIXEL "[(i & ~3) + (%d >> 2 * (i & 3) & 3)]"

static bool crosses(const struct printer *p, uint16_t number)
{
    uint16_t pack = p->packs->pack[number];
    if (!pack)
        return p->lanes->crosses[number];
    for (int l = 0; l < PACK_LANES; l++)
        if (p->packs->member[pack][l] && p->lanes->crosses[p->packs->member[pack][l]])
            return true;
    return false;
}

/* The value whose name a vector has. */
static uint16_t vector_of(const struct printer *p, uint16_t number)
{
    return p->packs->pack[number] ? p->packs->pack[number] : number;
}

/* Returns true if two values have the same vector: those of a pack, or equal literals and words of the draw,
 * which have the same name. */
static bool are_together(const struct printer *p, uint16_t a, uint16_t b)
{
    const struct ir_instruction *x = &p->ir->instruction[a], *y = &p->ir->instruction[b];
    bool named =
        x->op == IR_literal || (x->op == IR_uniform && (x->base == BASE_JOB || x->base == BASE_CONSTANT));
    return vector_of(p, a) == vector_of(p, b) ||
           (named && x->op == y->op && x->type == y->type && x->base == y->base && x->k == y->k);
}

/* The vector of a value, of this pixel, or of the one that permute k reads. */
static void print_vector(const struct printer *p, uint16_t number, const int *k)
{
    external_print_name(p, vector_of(p, number));
    if (crosses(p, number) && k)
        fprintf(p->out, OTHER_PIXEL, *k);
    else if (crosses(p, number))
        fputs("[i]", p->out);
}

/* A word of this pixel: an int. */
static void print_word(const struct printer *p, uint16_t number)
{
    fputs("((itg)", p->out);
    print_vector(p, number, NULL);
    fprintf(p->out, ")[%d]", p->packs->lane[number]);
}

/* --- Operands ------------------------------------------------------------------------------------------- */

/* The values that an operation needs in each lane; 0: any. */
struct wanted {
    uint16_t value[PACK_LANES];
    enum ir_type type;
    const int *k; /* of a permute */
};

static bool is_in_place(const struct printer *p, const struct wanted *w, int lane, uint16_t like)
{
    uint16_t value = w->value[lane];
    return !value ||
           (are_together(p, value, like) && (!p->packs->pack[value] || p->packs->lane[value] == lane));
}

static uint16_t first_wanted(const struct wanted *w)
{
    int lane = 0;
    while (!w->value[lane])
        lane++;
    return w->value[lane];
}

/* Returns true if the lanes are different words of one base. */
static bool are_words(const struct printer *p, const struct wanted *w)
{
    const struct ir_instruction *first = &p->ir->instruction[first_wanted(w)];
    bool differ = false;
    for (int l = 0; l < PACK_LANES; l++) {
        const struct ir_instruction *i = &p->ir->instruction[w->value[l] ? w->value[l] : first_wanted(w)];
        if (i->op != IR_uniform || i->base != first->base)
            return false;
        differ |= i->k != first->k;
    }
    return differ;
}

static void print_words(const struct printer *p, const struct wanted *w)
{
    external_begin_cast(p, w->type);
    fprintf(p->out, "words_%c(", w->type == TYPE_flt ? 'f' : 'i');
    for (int l = 0; l < PACK_LANES; l++) {
        fputs(l ? ", " : "", p->out);
        external_print_address(p, &p->ir->instruction[w->value[l] ? w->value[l] : first_wanted(w)]);
    }
    fputc(')', p->out);
    external_end_cast(p, w->type);
}

/* Writes a vector with the values of the lanes in `rest`: those of the vector of the last lane, shuffled into
 * a vector with the others. */
static void print_shuffled(const struct printer *p, const struct wanted *w, const bool rest[PACK_LANES])
{
    bool inner[PACK_LANES];
    int last = PACK_LANES - 1;
    while (!rest[last])
        last--;
    uint16_t value = w->value[last];
    bool more = false;
    for (int l = 0; l < PACK_LANES; l++) {
        inner[l] = rest[l] && !are_together(p, w->value[l], value);
        more |= inner[l];
    }
    fprintf(p->out, "shuffle(%s, ", external_type_word[w->type]);
    if (more)
        print_shuffled(p, w, inner);
    else
        print_vector(p, w->value[last], w->k);
    fputs(", ", p->out);
    print_vector(p, w->value[last], w->k);
    for (int l = 0; l < PACK_LANES; l++) {
        bool here = rest[l] && !inner[l];
        int lane = here && p->packs->pack[w->value[l]] ? p->packs->lane[w->value[l]] : l;
        fprintf(p->out, ", %d", here ? PACK_LANES + lane : l);
    }
    fputc(')', p->out);
}

static void print_wanted(const struct printer *p, const struct wanted *w)
{
    uint16_t first = first_wanted(w);
    bool in_place = true, rest[PACK_LANES];
    for (int l = 0; l < PACK_LANES; l++) {
        in_place &= is_in_place(p, w, l, first);
        rest[l] = w->value[l] != 0;
    }
    if (in_place)
        print_vector(p, first, w->k);
    else if (are_words(p, w))
        print_words(p, w);
    else
        print_shuffled(p, w, rest);
}

static void print_operand(const struct printer *p, uint16_t pack, unsigned o)
{
    const struct ir_instruction *first = &p->ir->instruction[pack];
    struct wanted w = {.type = p->ir->instruction[first->operand[o]].type};
    int k = first->k;
    w.k = first->op == IR_permute ? &k : NULL;
    for (int l = 0; l < PACK_LANES; l++)
        if (p->packs->member[pack][l])
            w.value[l] = p->ir->instruction[p->packs->member[pack][l]].operand[o];
    print_wanted(p, &w);
}

/* --- Statements ----------------------------------------------------------------------------------------- */

static void print_pack(const struct printer *p, uint16_t pack)
{
    const struct ir_instruction *i = &p->ir->instruction[pack];
    enum ir_type from = p->ir->instruction[i->operand[0]].type;
    if (i->op == IR_permute || (i->op == IR_copy && i->type == from)) {
        print_operand(p, pack, 0);
        return;
    }
    if (i->op == IR_copy)
        fprintf(p->out, "%s_of_%s(", external_type_word[i->type], external_type_word[from]);
    else
        fprintf(p->out, "%s(", ir_op_information[i->op].name);
    for (unsigned o = 0; o < ir_operands(i); o++) {
        fputs(o ? ", " : "", p->out);
        print_operand(p, pack, o);
    }
    if (ir_properties(i) & IR_SHIFTS)
        fprintf(p->out, ", %d", (int)i->k);
    fputc(')', p->out);
}

/* A value that is equal in all lanes. */
static void print_single(const struct printer *p, const struct ir_instruction *i)
{
    if (i->op == IR_get) {
        if (i->type != TYPE_itg)
            fprintf(p->out, "%s_of_itg(", external_type_word[i->type]);
        fprintf(p->out, i->type == TYPE_itg ? "all_lanes(x%d[i])" : "all_lanes(x%d[i]))", (int)i->k);
        return;
    }
    external_begin_cast(p, i->type);
    fprintf(p->out, "uniform_%c(", i->type == TYPE_flt ? 'f' : 'i');
    if (i->op == IR_gather && i->field != GATHER_DIRECT) {
        fprintf(p->out, "read_pointer(");
        struct ir_instruction at = *i;
        at.k = i->field;
        external_print_address(p, &at);
        fprintf(p->out, ") + %d", (int)i->k);
    } else
        external_print_address(p, i);
    if (i->op == IR_gather) {
        fputs(" + (long)", p->out);
        print_word(p, i->operand[0]);
        fprintf(p->out, " * %d", i->scale);
    } else
        fputs(" + 4 * i", p->out);
    fputc(')', p->out);
    external_end_cast(p, i->type);
}

/* A store, a scattered store, or a set. */
static void print_effect(const struct printer *p, const struct ir_instruction *i)
{
    if (i->op == IR_set)
        fprintf(p->out, "x%d[i] = ", (int)i->k);
    else {
        fputs("store_word(", p->out);
        external_print_address(p, i);
        fprintf(p->out, " + %d * i, ", i->op == IR_scatter ? (int)i->field : 4);
    }
    print_word(p, i->operand[0]);
    fputs(i->op == IR_set ? ";" : ");", p->out);
}

static void print_statement(const struct printer *p, uint16_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    external_begin_line(p);
    if (ir_properties(i) & IR_WRITES || i->op == IR_set) {
        print_effect(p, i);
        external_end_line(p, i);
        return;
    }
    if (!crosses(p, number))
        fprintf(p->out, "%s ", external_type_word[i->type]);
    print_vector(p, number, NULL);
    fputs(" = ", p->out);
    if (p->packs->pack[number])
        print_pack(p, number);
    else
        print_single(p, i);
    fputc(';', p->out);
    external_end_line(p, i);
}

static void print_needed(struct printer *p, uint16_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (p->lanes->group[i->operand[o]] == p->lanes->group[number])
            external_print_pixel(p, i->operand[o]);
}

void external_print_pixel(struct printer *p, uint32_t number)
{
    uint16_t vector = vector_of(p, (uint16_t)number);
    if (p->printed[vector] || external_is_one(&p->ir->instruction[number]) ||
        p->ir->instruction[number].op == IR_nop)
        return;
    p->printed[vector] = 1;
    for (int l = 0; l < PACK_LANES; l++)
        if (!p->packs->pack[number])
            print_needed(p, (uint16_t)number);
        else if (p->packs->member[vector][l])
            print_needed(p, p->packs->member[vector][l]);
    print_statement(p, vector);
}

void external_print_pixel_any(const struct printer *p, uint16_t number)
{
    bool one = external_is_one(&p->ir->instruction[number]);
    fputs(one ? "" : "any_of((const itg *)", p->out);
    external_print_name(p, vector_of(p, number));
    fprintf(p->out, one ? "[0]" : ", %d)", p->packs->lane[number]);
}

void external_declare_pixels(const struct printer *p, uint32_t number)
{
    if (vector_of(p, (uint16_t)number) != number || !crosses(p, (uint16_t)number))
        return;
    external_begin_line(p);
    fprintf(p->out, "%s v%u[WIDTH];\n", external_type_word[p->ir->instruction[number].type], number);
}
