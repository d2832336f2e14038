#include "front/gl/name.h"

#include <stdlib.h>

static unsigned home_of(const struct gl_names *names, GLuint name)
{
    return (name * 0x9e3779b1u) >> 7 & (names->slots - 1);
}

/* Linear probing. Returns the slot of the name, or the free one where it belongs. */
static struct gl_name *slot_of(const struct gl_names *names, GLuint name)
{
    unsigned i = home_of(names, name);
    while (names->slot[i].name && names->slot[i].name != name)
        i = (i + 1) & (names->slots - 1);
    return names->slot + i;
}

static bool grow(struct gl_names *names)
{
    struct gl_names larger = {
        .slots = names->slots ? names->slots * 2 : 64, .used = names->used, .next = names->next};
    larger.slot = calloc(larger.slots, sizeof *larger.slot);
    if (!larger.slot)
        return false;
    for (unsigned i = 0; i < names->slots; i++)
        if (names->slot[i].name)
            *slot_of(&larger, names->slot[i].name) = names->slot[i];
    free(names->slot);
    *names = larger;
    return true;
}

struct gl_object *gl_names_find(const struct gl_names *names, GLuint name)
{
    return name && names->slots ? slot_of(names, name)->object : NULL;
}

bool gl_names_has(const struct gl_names *names, GLuint name)
{
    return name && names->slots && slot_of(names, name)->name;
}

bool gl_names_put(struct gl_names *names, GLuint name, struct gl_object *object)
{
    if ((names->used + 1) * 2 > names->slots && !grow(names))
        return false;
    struct gl_name *slot = slot_of(names, name);
    names->used += !slot->name;
    *slot = (struct gl_name){name, object};
    return true;
}

/* The names that follow without a gap move up, as far as their own slots allow. */
void gl_names_remove(struct gl_names *names, GLuint name)
{
    if (!gl_names_has(names, name))
        return;
    unsigned mask = names->slots - 1, hole = (unsigned)(slot_of(names, name) - names->slot);
    for (unsigned i = (hole + 1) & mask; names->slot[i].name; i = (i + 1) & mask)
        if (((i - home_of(names, names->slot[i].name)) & mask) >= ((i - hole) & mask)) {
            names->slot[hole] = names->slot[i];
            hole = i;
        }
    names->slot[hole] = (struct gl_name){0};
    names->used--;
}

static bool reserve_one(struct gl_names *names, GLuint *name)
{
    do
        *name = ++names->next;
    while (!*name || gl_names_has(names, *name));
    return gl_names_put(names, *name, NULL);
}

bool gl_names_reserve(struct gl_names *names, GLsizei count, GLuint *out)
{
    for (GLsizei i = 0; i < count; i++)
        if (!reserve_one(names, out + i)) {
            while (i--)
                gl_names_remove(names, out[i]);
            return false;
        }
    return true;
}

struct gl_object *gl_names_take(struct gl_names *names)
{
    for (unsigned i = 0; i < names->slots; i++)
        if (names->slot[i].object) {
            struct gl_object *object = names->slot[i].object;
            gl_names_remove(names, names->slot[i].name);
            return object;
        }
    return NULL;
}

void gl_names_free(struct gl_names *names)
{
    free(names->slot);
    *names = (struct gl_names){0};
}
