#include "object.h"
#include "host.h"
#include <stdlib.h>

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

_Static_assert(offsetof(struct d3d9_object, host) == offsetof(struct d3d9_head, host) &&
                   offsetof(struct d3d9_object, references) == offsetof(struct d3d9_head, references) &&
                   offsetof(struct d3d9_object, draws) == offsetof(struct d3d9_head, draws) &&
                   offsetof(struct d3d9_object, parent) == offsetof(struct d3d9_head, parent),
               "an object begins with a head");

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

static void remove_private_data(struct d3d9_private_data **link);

static void free_object(struct d3d9_object *object)
{
    if (object->destroy)
        object->destroy(object);
    while (object->private_data)
        remove_private_data(&object->private_data);
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
    if (!identifier)
        return D3D9_BAD_POINTER;
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

/* --- Private data ---
 *
 * A list by identifier. A node of an interface that is no longer used moves to a list of the process, until
 * the host takes it, so freeing needs no memory. */

struct d3d9_private_data {
    struct d3d9_private_data *next;
    struct d3d9_guid identifier;
    bool is_interface;
    uint32_t bytes;
    uint8_t data[];
};

/* Of the program's interfaces: the Windows side passes them as uint64_t, also for a program of 32 bits. */
enum { POINTER_BYTES = sizeof(uint64_t) };

static struct d3d9_private_data *unused; /* interfaces for d3d9_foreign_take */

/* Returns the link to the data with this identifier. */
static struct d3d9_private_data **find(struct d3d9_object *object, const struct d3d9_guid *identifier)
{
    struct d3d9_private_data **link = &object->private_data;
    while (*link && !d3d9_guid_equal(&(*link)->identifier, identifier))
        link = &(*link)->next;
    return link;
}

static struct d3d9_private_data *make(const struct d3d9_guid *identifier, const void *data, uint32_t bytes,
                                      bool is_interface)
{
    struct d3d9_private_data *made = malloc(sizeof *made + bytes);
    if (!made)
        return NULL;
    made->identifier = *identifier;
    made->is_interface = is_interface;
    made->bytes = bytes;
    if (bytes)
        memcpy(made->data, data, bytes);
    return made;
}

int32_t d3d9_object_set_private_data(struct d3d9_object *object, const struct d3d9_guid *identifier,
                                     const void *data, uint32_t bytes, uint32_t flags)
{
    bool is_interface = flags & D3D9_PRIVATE_INTERFACE;
    if (!identifier)
        return D3D9_INVALID_CALL;
    if (is_interface && bytes != POINTER_BYTES)
        return D3D9_INVALID_CALL;
    if (bytes && !data)
        return D3D9_INVALID_CALL;
    struct d3d9_private_data *made = make(identifier, data, bytes, is_interface);
    if (!made)
        return D3D9_OUT_OF_MEMORY;
    d3d9_object_free_private_data(object, identifier);
    made->next = object->private_data;
    object->private_data = made;
    return D3D9_OK;
}

int32_t d3d9_object_get_private_data(struct d3d9_object *object, const struct d3d9_guid *identifier,
                                     void *data, uint32_t *bytes)
{
    const struct d3d9_private_data *found = identifier ? *find(object, identifier) : NULL;
    if (!identifier)
        return D3D9_INVALID_CALL;
    if (!found)
        return D3D9_NOT_FOUND;
    if (!bytes)
        return D3D9_INVALID_CALL;
    uint32_t room = *bytes;
    *bytes = found->bytes;
    if (!data)
        return D3D9_OK;
    if (room < found->bytes)
        return D3D9_MORE_DATA;
    memcpy(data, found->data, found->bytes);
    return D3D9_OK;
}

static void remove_private_data(struct d3d9_private_data **link)
{
    struct d3d9_private_data *found = *link;
    *link = found->next;
    if (found->is_interface) {
        found->next = unused;
        unused = found;
    } else {
        free(found);
    }
}

int32_t d3d9_object_free_private_data(struct d3d9_object *object, const struct d3d9_guid *identifier)
{
    if (!identifier)
        return D3D9_INVALID_CALL;
    struct d3d9_private_data **link = find(object, identifier);
    if (!*link)
        return D3D9_NOT_FOUND;
    remove_private_data(link);
    return D3D9_OK;
}

int32_t d3d9_object_private_data_is_interface(struct d3d9_object *object, const struct d3d9_guid *identifier)
{
    const struct d3d9_private_data *found = identifier ? *find(object, identifier) : NULL;
    return found && found->is_interface;
}

bool d3d9_foreign_waits(void)
{
    return unused;
}

uint32_t d3d9_foreign_take(uint64_t *interfaces, uint32_t room)
{
    uint32_t count = 0;
    for (; unused && count < room; count++) {
        struct d3d9_private_data *first = unused;
        unused = first->next;
        interfaces[count] = 0;
        memcpy(&interfaces[count], first->data, first->bytes);
        free(first);
    }
    return count;
}
