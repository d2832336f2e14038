/* The Windows side's data of an object, in the member `host` of struct d3d9_head. */
#ifndef D3D9_PE_OBJECT_DATA_H
#define D3D9_PE_OBJECT_DATA_H

#include "front/d3d9/host.h"

/* The first member of such data. `free` is called when the object is freed. */
struct object_data {
    void (*free)(struct object_data *);
};

static inline void *object_data_of(const void *object)
{
    return (void *)(uintptr_t)((const struct d3d9_head *)object)->host;
}

static inline void object_data_set(void *object, struct object_data *data)
{
    ((struct d3d9_head *)object)->host = (uintptr_t)data;
}

static inline void object_data_free(struct object_data *data)
{
    data->free(data);
}

#endif
