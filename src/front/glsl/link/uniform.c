/* Uniforms and samplers: those of both stages are one if they have one name. */
#include "front/glsl/link/link.h"

#include <string.h>

/* --- Types ---------------------------------------------------------------------------------------------- */

/* Types of two units: structures are equal if their names, and the names and types of their fields are. */
static bool same_type(struct glsl_type a, struct glsl_type b)
{
    if (a.base != b.base || a.rows != b.rows || a.columns != b.columns || a.array != b.array)
        return false;
    if (a.base != GLSL_STRUCT || a.record == b.record)
        return true;
    if (strcmp(a.record->name, b.record->name) || a.record->count != b.record->count)
        return false;
    for (unsigned i = 0; i < a.record->count; i++)
        if (strcmp(a.record->field[i].name, b.record->field[i].name) ||
            !same_type(a.record->field[i].type, b.record->field[i].type))
            return false;
    return true;
}

static bool same_precision(struct glsl_type a, struct glsl_type b)
{
    if (a.base != GLSL_STRUCT)
        return a.precision == b.precision;
    for (unsigned i = 0; i < a.record->count; i++)
        if (!same_precision(a.record->field[i].type, b.record->field[i].type))
            return false;
    return true;
}

static void check_pair(struct glsl_linker *linker, const struct glsl_variable *a,
                       const struct glsl_variable *b)
{
    if (!same_type(a->type, b->type))
        glsl_link_error(linker, "found the uniform '%s' as %s and as %s, expected the same type", a->name,
                        glsl_type_name(&linker->arena, a->type), glsl_type_name(&linker->arena, b->type));
    else if (a->read && b->read && !same_precision(a->type, b->type))
        glsl_link_error(linker, "found the uniform '%s' with two precisions, expected the same one", a->name);
}

void glsl_link_check_uniforms(struct glsl_linker *linker)
{
    const struct glsl_variable *other = linker->stage[GLSL_FRAGMENT].unit->global;
    for (const struct glsl_variable *a = linker->stage[GLSL_VERTEX].unit->global; a; a = a->next)
        for (const struct glsl_variable *b = a->storage == GLSL_UNIFORM ? other : NULL; b; b = b->next)
            if (b->storage == GLSL_UNIFORM && !strcmp(a->name, b->name))
                check_pair(linker, a, b);
}

/* --- Leaves --------------------------------------------------------------------------------------------- */

/* A part of a variable that is not a structure: an entry of the program. */
struct leaf {
    const char *name;
    struct glsl_type type;
    uint32_t first;
    unsigned elements; /* up to the last one that is used */
    bool relative;
};

struct visit {
    struct glsl_linker *linker;
    enum glsl_stage id;
    struct glsl_stage_link *stage;
    struct leaf *leaf;
    unsigned leaves, room;
};

static void add_leaf(struct visit *visit, const char *name, struct glsl_type type, uint32_t first)
{
    const uint8_t *use = visit->stage->uniform_use + first;
    uint32_t count = glsl_registers(type);
    struct leaf leaf = {name, type, first, 0, false};
    for (uint32_t r = 0; r < count; r++) {
        leaf.relative |= use[r] & GLSL_USED_RELATIVE;
        if (use[r] & GLSL_USED)
            leaf.elements = r / type.columns + 1;
    }
    if (!leaf.elements)
        return;
    if (visit->leaves == visit->room) {
        struct leaf *old = visit->leaf;
        visit->room = visit->room ? 2 * visit->room : 32;
        visit->leaf = glsl_take(&visit->linker->arena, visit->room * sizeof *old);
        if (old)
            memcpy(visit->leaf, old, visit->leaves * sizeof *old);
    }
    visit->leaf[visit->leaves++] = leaf;
}

static void visit_type(struct visit *visit, const char *name, struct glsl_type type, uint32_t first)
{
    struct glsl_arena *arena = &visit->linker->arena;
    if (type.base != GLSL_STRUCT) {
        add_leaf(visit, name, type, first);
    } else if (type.array) {
        struct glsl_type element = glsl_element_type(type);
        for (int i = 0; i < type.array; i++)
            visit_type(visit, glsl_format(arena, "%s[%d]", name, i), element,
                       first + (uint32_t)i * glsl_registers(element));
    } else {
        for (unsigned i = 0; i < type.record->count; i++) {
            const struct glsl_field *field = &type.record->field[i];
            visit_type(visit, glsl_format(arena, "%s.%s", name, field->name), field->type, first);
            first += glsl_registers(field->type);
        }
    }
}

static bool uses_slot(const struct glsl_stage_link *stage, const struct glsl_slot *slot, unsigned bits)
{
    for (uint32_t r = 0; r < slot->registers; r++)
        if (stage->uniform_use[slot->first + r] & bits)
            return true;
    return false;
}

/* --- Places --------------------------------------------------------------------------------------------- */

/* The registers of a structure with an index that is not constant stay as they are, up to the last used. */
static void add_whole(struct visit *visit, const struct glsl_slot *slot, struct glsl_block_to_place *block)
{
    unsigned count = slot->registers;
    while (!(visit->stage->uniform_use[slot->first + count - 1] & GLSL_USED))
        count--;
    *block = (struct glsl_block_to_place){4, count, &visit->stage->uniform[slot->first]};
}

static unsigned add_leaves(struct visit *visit, unsigned from, struct glsl_block_to_place *block)
{
    unsigned count = 0;
    for (unsigned i = from; i < visit->leaves; i++) {
        const struct leaf *leaf = &visit->leaf[i];
        if (!glsl_is_sampler(leaf->type))
            block[count++] = (struct glsl_block_to_place){
                leaf->type.rows, leaf->elements * leaf->type.columns, &visit->stage->uniform[leaf->first]};
    }
    return count;
}

static void place_constants(struct visit *visit)
{
    struct glsl_linker *linker = visit->linker;
    const struct glsl_slots *slots = &visit->stage->code->uniform;
    unsigned most = glsl_machines[visit->id].constants, count = 0;
    struct glsl_block_to_place *block = glsl_take(&linker->arena, (slots->registers + 1) * sizeof *block);
    for (unsigned i = 0; i < slots->count; i++) {
        const struct glsl_slot *slot = &slots->slot[i];
        unsigned before = visit->leaves;
        if (!uses_slot(visit->stage, slot, GLSL_USED))
            continue;
        visit_type(visit, slot->variable->name, slot->variable->type, slot->first);
        if (slot->variable->type.base == GLSL_STRUCT && uses_slot(visit->stage, slot, GLSL_USED_RELATIVE))
            add_whole(visit, slot, &block[count++]);
        else
            count += add_leaves(visit, before, &block[count]);
    }
    visit->stage->constants = glsl_link_place(linker, block, count, most);
    if (visit->stage->constants > most)
        glsl_link_error(linker, "found uniforms of the %s shader that need more than %u vectors",
                        glsl_stage_names[visit->id], most);
}

static void place_samplers(struct visit *visit)
{
    unsigned next = 0, most = glsl_machines[visit->id].samplers;
    for (unsigned i = 0; i < visit->leaves; i++) {
        const struct leaf *leaf = &visit->leaf[i];
        if (!glsl_is_sampler(leaf->type))
            continue;
        for (unsigned e = 0; e < leaf->elements && next + e < most; e++) {
            visit->stage->uniform[leaf->first + e] = (struct glsl_spot){(int16_t)(next + e), 0};
            visit->stage->sampler[next + e] = leaf->type.base;
        }
        next += leaf->elements;
    }
    if (next > most)
        glsl_link_error(visit->linker, "found %u samplers in the %s shader, expected at most %u", next,
                        glsl_stage_names[visit->id], most);
}

/* --- Entries -------------------------------------------------------------------------------------------- */

static struct glsl_uniform *entry_of(struct glsl_linker *linker, const struct leaf *leaf)
{
    for (unsigned i = 0; i < linker->uniforms; i++)
        if (!strcmp(linker->uniform[i].name, leaf->name))
            return &linker->uniform[i];
    if (linker->uniforms == linker->uniform_room) {
        struct glsl_uniform *old = linker->uniform;
        linker->uniform_room = linker->uniform_room ? 2 * linker->uniform_room : 32;
        linker->uniform = glsl_take(&linker->arena, linker->uniform_room * sizeof *old);
        if (old)
            memcpy(linker->uniform, old, linker->uniforms * sizeof *old);
    }
    struct glsl_uniform *entry = &linker->uniform[linker->uniforms++];
    *entry = (struct glsl_uniform){.name = leaf->name, .type = leaf->type};
    entry->type.array = 0;
    entry->stage[GLSL_VERTEX].first = entry->stage[GLSL_FRAGMENT].first = -1;
    entry->builtin = !strncmp(leaf->name, "gl_", 3);
    return entry;
}

static void add_entries(struct visit *visit)
{
    for (unsigned i = 0; i < visit->leaves; i++) {
        const struct leaf *leaf = &visit->leaf[i];
        struct glsl_uniform *entry = entry_of(visit->linker, leaf);
        struct glsl_spot spot = visit->stage->uniform[leaf->first];
        entry->stage[visit->id].first = spot.number;
        entry->stage[visit->id].component = spot.component;
        entry->stage[visit->id].elements = (uint16_t)leaf->elements;
        if (leaf->type.array && entry->type.array < (int)leaf->elements)
            entry->type.array = (int)leaf->elements;
    }
}

void glsl_link_place_uniforms(struct glsl_linker *linker)
{
    for (unsigned s = 0; s < GLSL_STAGES; s++) {
        struct glsl_stage_link *stage = &linker->stage[s];
        struct visit visit = {.linker = linker, .id = (enum glsl_stage)s, .stage = stage};
        stage->uniform =
            glsl_take(&linker->arena, (stage->code->uniform.registers + 1) * sizeof *stage->uniform);
        place_constants(&visit);
        place_samplers(&visit);
        if (!linker->errors)
            add_entries(&visit);
    }
}
