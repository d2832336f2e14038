/* Locations of attributes: bindings, then the first free ones, long attributes first. */
#include "front/glsl/link/link.h"

#include <string.h>

static bool is_used(const struct glsl_stage_link *stage, const struct glsl_slot *slot)
{
    for (uint32_t r = 0; r < slot->registers; r++)
        if (stage->attribute_use[slot->first + r])
            return true;
    return false;
}

static int bound_location(const struct glsl_linker *linker, const char *name)
{
    for (unsigned i = linker->bindings; i-- > 0;)
        if (!strcmp(linker->binding[i].name, name))
            return (int)linker->binding[i].location;
    return -1;
}

static uint32_t bits_at(unsigned location, unsigned registers)
{
    return glsl_mask(registers) << location;
}

static void add(struct glsl_linker *linker, const struct glsl_slot *slot, unsigned location, uint32_t *taken)
{
    struct glsl_stage_link *stage = &linker->stage[GLSL_VERTEX];
    *taken |= bits_at(location, slot->registers);
    for (uint32_t r = 0; r < slot->registers; r++)
        stage->attribute[slot->first + r].number = (int16_t)(location + r);
    linker->attribute[linker->attributes++] =
        (struct glsl_attribute){slot->variable->name, slot->variable->type, location};
}

/* Two attributes can be bound to one location: then they are the same register. */
static void add_bound(struct glsl_linker *linker, const struct glsl_slot *slot, unsigned location,
                      uint32_t *taken)
{
    if (location >= GLSL_LOCATIONS || location + slot->registers > GLSL_LOCATIONS)
        glsl_link_error(linker, "found the attribute '%s' bound to location %u, expected at most %d",
                        slot->variable->name, location, (int)(GLSL_LOCATIONS - slot->registers));
    else
        add(linker, slot, location, taken);
}

static void add_free(struct glsl_linker *linker, const struct glsl_slot *slot, uint32_t *taken)
{
    unsigned location = 0;
    while (location + slot->registers <= GLSL_LOCATIONS && *taken & bits_at(location, slot->registers))
        location++;
    if (location + slot->registers > GLSL_LOCATIONS)
        glsl_link_error(linker, "found no free locations for the attribute '%s', expected %u of %d",
                        slot->variable->name, slot->registers, GLSL_LOCATIONS);
    else
        add(linker, slot, location, taken);
}

void glsl_link_place_attributes(struct glsl_linker *linker)
{
    struct glsl_stage_link *stage = &linker->stage[GLSL_VERTEX];
    const struct glsl_slots *slots = &stage->code->attribute;
    uint32_t taken = 0;
    stage->attribute = glsl_take(&linker->arena, (slots->registers + 1) * sizeof *stage->attribute);
    for (uint32_t r = 0; r < slots->registers; r++)
        stage->attribute[r].number = -1;
    linker->attribute = glsl_take(&linker->arena, (slots->count + 1) * sizeof *linker->attribute);
    for (unsigned i = 0; i < slots->count; i++) {
        int location = bound_location(linker, slots->slot[i].variable->name);
        if (is_used(stage, &slots->slot[i]) && location >= 0)
            add_bound(linker, &slots->slot[i], (unsigned)location, &taken);
    }
    for (unsigned registers = 4; registers > 0; registers--)
        for (unsigned i = 0; i < slots->count; i++)
            if (slots->slot[i].registers == registers && is_used(stage, &slots->slot[i]) &&
                bound_location(linker, slots->slot[i].variable->name) < 0)
                add_free(linker, &slots->slot[i], &taken);
}
