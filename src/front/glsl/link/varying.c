/* Varyings of both stages: types, invariance, places (4.3.5, 4.6.4). */
#include "front/glsl/check/builtin.h"
#include "front/glsl/link/link.h"

#include <string.h>

static const struct glsl_variable *find_varying(const struct glsl_unit *unit, const char *name)
{
    const struct glsl_variable *v = unit->global;
    while (v && (v->storage != GLSL_VARYING || strcmp(v->name, name)))
        v = v->next;
    return v;
}

/* The pragma agrees with either declaration of the other stage: it concerns outputs (4.6.1), and a program
 * may have it in one shader only. */
static bool agree_on_invariance(const struct glsl_linker *linker, const struct glsl_variable *in,
                                const struct glsl_variable *out)
{
    enum glsl_stage plain = in->invariant ? GLSL_VERTEX : GLSL_FRAGMENT;
    return in->invariant == out->invariant || linker->stage[plain].unit->invariant_all;
}

static void check_varying(struct glsl_linker *linker, const struct glsl_variable *in)
{
    const struct glsl_variable *out = find_varying(linker->stage[GLSL_VERTEX].unit, in->name);
    if (!out && in->read)
        glsl_link_error(linker,
                        "found the varying '%s' in the fragment shader, expected it in the vertex shader too",
                        in->name);
    else if (out && !glsl_same_type(in->type, out->type))
        glsl_link_error(linker, "found the varying '%s' as %s and as %s, expected the same type", in->name,
                        glsl_type_name(&linker->arena, out->type), glsl_type_name(&linker->arena, in->type));
    else if (out && !agree_on_invariance(linker, in, out))
        glsl_link_error(linker, "found the varying '%s' invariant in the %s shader only, expected it in both",
                        in->name, glsl_stage_names[in->invariant]);
}

/* An invariant source of the fragment shader needs an invariant output. */
static void check_builtin(struct glsl_linker *linker, enum glsl_builtin_variable in,
                          enum glsl_builtin_variable out, const char *in_name, const char *out_name)
{
    bool source = linker->stage[GLSL_FRAGMENT].unit->invariants >> in & 1;
    const struct glsl_unit *vertex = linker->stage[GLSL_VERTEX].unit;
    bool result = vertex->invariant_all || vertex->invariants >> out & 1;
    if (source && !result)
        glsl_link_error(linker, "found %s invariant and %s not, expected both", in_name, out_name);
}

void glsl_link_check_varyings(struct glsl_linker *linker)
{
    for (const struct glsl_variable *v = linker->stage[GLSL_FRAGMENT].unit->global; v; v = v->next)
        if (v->storage == GLSL_VARYING)
            check_varying(linker, v);
    check_builtin(linker, GLSL_FRAG_COORD, GLSL_POSITION, "gl_FragCoord", "gl_Position");
    check_builtin(linker, GLSL_POINT_COORD, GLSL_POINT_SIZE, "gl_PointCoord", "gl_PointSize");
}

/* --- Use ------------------------------------------------------------------------------------------------ */

static const struct glsl_slot *find_slot(const struct glsl_code *code, const char *name)
{
    for (unsigned i = 0; i < code->varying.count; i++)
        if (!strcmp(code->varying.slot[i].variable->name, name))
            return &code->varying.slot[i];
    return NULL;
}

void glsl_link_need_varyings(struct glsl_linker *linker)
{
    struct glsl_code *code = linker->stage[GLSL_VERTEX].code;
    const struct glsl_stage_link *fragment = &linker->stage[GLSL_FRAGMENT];
    uint8_t *needed = glsl_take(&linker->arena, code->varying.registers + 1);
    for (unsigned i = 0; i < code->varying.count; i++) {
        const struct glsl_slot *slot = &code->varying.slot[i];
        const struct glsl_slot *in = find_slot(fragment->code, slot->variable->name);
        for (uint32_t r = 0; in && r < slot->registers; r++)
            needed[slot->first + r] = fragment->varying_use[in->first + r] ? 15 : 0;
    }
    code->needed = needed;
}

/* --- Places --------------------------------------------------------------------------------------------- */

static bool is_used(const struct glsl_stage_link *stage, const struct glsl_slot *slot)
{
    for (uint32_t r = 0; r < slot->registers; r++)
        if (stage->varying_use[slot->first + r])
            return true;
    return false;
}

/* The places of the fragment shader are those of the vertex shader. */
static void copy_places(struct glsl_linker *linker)
{
    struct glsl_stage_link *vertex = &linker->stage[GLSL_VERTEX], *fragment = &linker->stage[GLSL_FRAGMENT];
    const struct glsl_slots *slots = &vertex->code->varying;
    vertex->varying = glsl_take(&linker->arena, (slots->registers + 1) * sizeof *vertex->varying);
    for (unsigned i = 0; i < slots->count; i++) {
        const struct glsl_slot *in = find_slot(fragment->code, slots->slot[i].variable->name);
        for (uint32_t r = 0; in && r < slots->slot[i].registers; r++)
            vertex->varying[slots->slot[i].first + r] = fragment->varying[in->first + r];
    }
}

void glsl_link_place_varyings(struct glsl_linker *linker)
{
    struct glsl_stage_link *fragment = &linker->stage[GLSL_FRAGMENT];
    const struct glsl_slots *slots = &fragment->code->varying;
    struct glsl_block_to_place *block = glsl_take(&linker->arena, (slots->count + 1) * sizeof *block);
    unsigned count = 0;
    fragment->varying = glsl_take(&linker->arena, (slots->registers + 1) * sizeof *fragment->varying);
    for (unsigned i = 0; i < slots->count; i++)
        if (is_used(fragment, &slots->slot[i]))
            block[count++] =
                (struct glsl_block_to_place){slots->slot[i].variable->type.rows, slots->slot[i].registers,
                                             &fragment->varying[slots->slot[i].first]};
    linker->varyings = glsl_link_place(linker, block, count, GLSL_VARYING_VECTORS);
    if (linker->varyings > GLSL_VARYING_VECTORS)
        glsl_link_error(linker, "found varyings that need more than %d vectors, expected at most these",
                        GLSL_VARYING_VECTORS);
    else
        copy_places(linker);
}
