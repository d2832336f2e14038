#include "object.h"
#include "host.h"

static uint64_t faces[D3D9_INTERFACE_COUNT];

struct interface_row {
    const char *name;
    enum d3d9_interface base;
    struct d3d9_guid identifier;
};

static const struct interface_row rows[D3D9_INTERFACE_COUNT] = {
#define INTERFACE(NAME, name, com, BASE, a, b, c, ...)                                                       \
    [D3D9_INTERFACE_##NAME] = {#com, D3D9_INTERFACE_##BASE, {a, b, c, {__VA_ARGS__}}},
#include "interface.def"
#undef INTERFACE
};

void d3d9_object_set_face(enum d3d9_interface interface, uint64_t face)
{
    faces[interface] = face;
}

const char *d3d9_object_interface_name(enum d3d9_interface interface)
{
    return rows[interface].name;
}

bool d3d9_object_interface_is(enum d3d9_interface interface, enum d3d9_interface base)
{
    while (interface != D3D9_INTERFACE_NONE && interface != base)
        interface = rows[interface].base;
    return interface == base;
}

void *d3d9_object_make_implicit(size_t bytes, enum d3d9_interface interface, struct d3d9_object *parent,
                                void (*destroy)(struct d3d9_object *))
{
    struct d3d9_object *object = d3d9_memory_allocate(bytes);
    if (!object)
        return NULL;
    object->face = faces[interface];
    object->interface = interface;
    object->parent = parent;
    object->destroy = destroy;
    object->holds = 1;
    return object;
}

void *d3d9_object_make(size_t bytes, enum d3d9_interface interface, struct d3d9_object *parent,
                       void (*destroy)(struct d3d9_object *))
{
    struct d3d9_object *object = d3d9_object_make_implicit(bytes, interface, parent, destroy);
    if (!object)
        return NULL;
    object->references = 1; /* which has the hold */
    if (parent)
        d3d9_object_add_ref(parent);
    return object;
}

void *d3d9_object_make_part(size_t bytes, enum d3d9_interface interface, struct d3d9_object *owner)
{
    struct d3d9_object *object = d3d9_object_make_implicit(bytes, interface, owner->parent, NULL);
    if (!object)
        return NULL;
    object->owner = owner;
    object->container = owner;
    return object;
}

static void free_object(struct d3d9_object *object)
{
    if (object->destroy)
        object->destroy(object);
    while (object->private_data)
        d3d9_object_free_private_data(object, NULL);
    if (object->host)
        d3d9_host_event(D3D9_EVENT_FORGET, object->host);
    d3d9_memory_free(object);
}

void d3d9_object_free_part(struct d3d9_object *part)
{
    if (part)
        free_object(part);
}

static struct d3d9_object *counted(struct d3d9_object *object)
{
    return object->owner ? object->owner : object;
}

uint32_t d3d9_object_add_ref(struct d3d9_object *of)
{
    struct d3d9_object *object = counted(of);
    if (object->references++)
        return object->references;
    d3d9_object_hold(object);
    if (object->parent)
        d3d9_object_add_ref(object->parent);
    return 1;
}

uint32_t d3d9_object_release(struct d3d9_object *of)
{
    struct d3d9_object *object = counted(of), *parent = object->parent;
    if (!object->references)
        return 0;
    uint32_t left = --object->references;
    if (left)
        return left;
    /* The parent is last, because it may be freed. */
    d3d9_object_drop(object);
    if (parent)
        d3d9_object_release(parent);
    return 0;
}

void d3d9_object_hold(struct d3d9_object *object)
{
    if (object)
        counted(object)->holds++;
}

void d3d9_object_drop(struct d3d9_object *of)
{
    if (!of)
        return;
    struct d3d9_object *object = counted(of);
    if (!--object->holds)
        free_object(object);
}

void d3d9_object_exchange(struct d3d9_object **slot, struct d3d9_object *with)
{
    struct d3d9_object *old = *slot;
    d3d9_object_hold(with);
    *slot = with;
    d3d9_object_drop(old);
}

int32_t d3d9_object_query_interface(struct d3d9_object *object, const struct d3d9_guid *identifier,
                                    void **out)
{
    if (!out)
        return D3D9_BAD_POINTER;
    *out = NULL;
    enum d3d9_interface i = object->interface;
    while (i != D3D9_INTERFACE_NONE && !d3d9_guid_equal(&rows[i].identifier, identifier))
        i = rows[i].base;
    if (i == D3D9_INTERFACE_NONE)
        return D3D9_NO_INTERFACE;
    d3d9_object_add_ref(object);
    *out = object;
    return D3D9_OK;
}

int32_t d3d9_object_query_container(struct d3d9_object *object, const struct d3d9_guid *identifier,
                                    void **out)
{
    if (!out)
        return D3D9_BAD_POINTER;
    *out = NULL;
    return object->container ? d3d9_object_query_interface(object->container, identifier, out)
                             : D3D9_NO_INTERFACE;
}
