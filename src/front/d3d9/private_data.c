/* Private data of objects: a list by identifier. A node of an interface that is no longer used moves to a
 * list of the process, until the host takes it, so freeing needs no memory. */
#include "object.h"
#include <stdlib.h>

struct d3d9_private_data {
    struct d3d9_private_data *next;
    struct d3d9_guid identifier;
    bool is_interface;
    uint32_t bytes;
    uint8_t data[];
};

static unsigned pointer_bytes = sizeof(void *);
static struct d3d9_private_data *unused; /* interfaces for d3d9_foreign_take */

void d3d9_object_set_pointer_bytes(unsigned bytes)
{
    pointer_bytes = bytes;
}

/* Returns the link to the data with this identifier; null: the first one. */
static struct d3d9_private_data **find(struct d3d9_object *object, const struct d3d9_guid *identifier)
{
    struct d3d9_private_data **link = &object->private_data;
    while (*link && identifier && !d3d9_guid_equal(&(*link)->identifier, identifier))
        link = &(*link)->next;
    return link;
}

static struct d3d9_private_data *make(const struct d3d9_guid *identifier, const void *data, uint32_t bytes,
                                      bool is_interface)
{
    uint64_t interface = (uintptr_t)data;
    struct d3d9_private_data *made = malloc(sizeof *made + bytes);
    if (!made)
        return NULL;
    made->identifier = *identifier;
    made->is_interface = is_interface;
    made->bytes = bytes;
    if (bytes)
        memcpy(made->data, is_interface ? &interface : data, bytes);
    return made;
}

int32_t d3d9_object_set_private_data(struct d3d9_object *object, const struct d3d9_guid *identifier,
                                     const void *data, uint32_t bytes, uint32_t flags)
{
    bool is_interface = flags & D3D9_PRIVATE_INTERFACE;
    if (is_interface && bytes != pointer_bytes)
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
    const struct d3d9_private_data *found = *find(object, identifier);
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

int32_t d3d9_object_free_private_data(struct d3d9_object *object, const struct d3d9_guid *identifier)
{
    struct d3d9_private_data **link = find(object, identifier), *found = *link;
    if (!found)
        return D3D9_NOT_FOUND;
    *link = found->next;
    if (found->is_interface) {
        found->next = unused;
        unused = found;
    } else {
        free(found);
    }
    return D3D9_OK;
}

int32_t d3d9_object_private_data_is_interface(struct d3d9_object *object, const struct d3d9_guid *identifier)
{
    const struct d3d9_private_data *found = *find(object, identifier);
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
