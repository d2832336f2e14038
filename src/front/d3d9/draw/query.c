/* Queries. */
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"

#include <stdbool.h>
#include <string.h>

/* D3DQUERYTYPE, D3DISSUE. */
enum {
    QUERY_EVENT = 8,
    QUERY_OCCLUSION = 9,
    QUERY_TIMESTAMP = 10,
    QUERY_DISJOINT = 11,
    QUERY_FREQUENCY = 12
};
enum { ISSUE_END = 1, ISSUE_BEGIN = 2 };

enum phase { PHASE_NEW, PHASE_BEGUN, PHASE_ENDED };

struct d3d9_query {
    struct d3d9_object object;
    struct d3d9_device *device;
    uint32_t type;
    enum phase phase;
    triptych_query *query; /* null: the result needs no rendering */
};

/* The bytes of a result; 0: no such query. */
static uint32_t bytes_of(uint32_t type)
{
    switch (type) {
    case QUERY_EVENT:
    case QUERY_OCCLUSION:
    case QUERY_DISJOINT: return 4;
    case QUERY_TIMESTAMP:
    case QUERY_FREQUENCY: return 8;
    default: return 0;
    }
}

static void destroy_query(struct d3d9_object *object)
{
    struct d3d9_query *query = (struct d3d9_query *)object;
    triptych_query_destroy(query->device->renderer, query->query);
}

static bool make_renderer(struct d3d9_query *query)
{
    enum triptych_query_type type = query->type == QUERY_EVENT       ? TRIPTYCH_QUERY_EVENT
                                    : query->type == QUERY_OCCLUSION ? TRIPTYCH_QUERY_OCCLUSION
                                                                     : TRIPTYCH_QUERY_TIMESTAMP;
    if (query->type == QUERY_DISJOINT || query->type == QUERY_FREQUENCY)
        return true;
    return triptych_query_create(query->device->renderer, type, &query->query) == TRIPTYCH_OK;
}

/* Without `out` the result is that of a creation, and nothing is created. */
int32_t d3d9_device_create_query(struct d3d9_device *device, uint32_t type, struct d3d9_query **out)
{
    if (!bytes_of(type))
        return D3D9_NOT_AVAILABLE;
    if (!out)
        return D3D9_OK;
    struct d3d9_query *query =
        d3d9_object_make(sizeof *query, D3D9_INTERFACE_QUERY, &device->object, destroy_query);
    if (!query)
        return D3D9_OUT_OF_MEMORY;
    query->device = device;
    query->type = type;
    if (!make_renderer(query)) {
        d3d9_object_release(&query->object);
        return D3D9_OUT_OF_MEMORY;
    }
    *out = query;
    return D3D9_OK;
}

uint32_t d3d9_query_get_type(struct d3d9_query *query)
{
    return query->type;
}

uint32_t d3d9_query_get_data_size(struct d3d9_query *query)
{
    return bytes_of(query->type);
}

/* Only occlusion counts between two calls. An end without a begin counts nothing. */
int32_t d3d9_query_issue(struct d3d9_query *query, uint32_t flags)
{
    triptych_device *renderer = query->device->renderer;
    bool counts = query->type == QUERY_OCCLUSION;
    if (flags & ISSUE_BEGIN) {
        if (query->type == QUERY_EVENT || query->type == QUERY_FREQUENCY)
            return D3D9_INVALID_CALL;
        if (counts && query->phase == PHASE_BEGUN)
            triptych_query_end(renderer, query->query);
        if (counts)
            triptych_query_begin(renderer, query->query);
        query->phase = PHASE_BEGUN;
    }
    if (flags & ISSUE_END) {
        if (counts && query->phase != PHASE_BEGUN)
            triptych_query_begin(renderer, query->query);
        if (query->query)
            triptych_query_end(renderer, query->query);
        query->phase = PHASE_ENDED;
    }
    return D3D9_OK;
}

/* Returns false if there is no result yet. It is found without waiting. */
static bool find_result(struct d3d9_query *query, uint64_t *result)
{
    enum { NANOSECONDS = 1000000000 };
    int ready = 1;
    *result = query->type == QUERY_FREQUENCY ? NANOSECONDS : 0;
    if (query->query && query->type != QUERY_FREQUENCY)
        triptych_query_poll(query->device->renderer, query->query, &ready, result);
    if (query->type == QUERY_OCCLUSION && *result > UINT32_MAX)
        *result = UINT32_MAX;
    return ready;
}

/* The result of a query that was never issued is what Direct3D's runtime fills memory with. */
int32_t d3d9_query_get_data(struct d3d9_query *query, void *data, uint32_t bytes, uint32_t flags)
{
    enum { NOTHING = 0xdd };
    uint32_t all = bytes_of(query->type);
    (void)flags;
    if (query->phase == PHASE_BEGUN)
        return D3D9_FALSE;
    if (!data && bytes)
        return D3D9_INVALID_CALL;
    if (query->phase == PHASE_NEW) {
        if (bytes && query->type != QUERY_EVENT)
            memset(data, NOTHING, bytes < all ? bytes : all);
        else if (bytes)
            memcpy(data, &(uint64_t){1}, bytes < all ? bytes : all);
        return D3D9_OK;
    }
    uint64_t result;
    if (!find_result(query, &result))
        return D3D9_FALSE;
    if (bytes)
        memcpy(data, &result, bytes < sizeof result ? bytes : sizeof result);
    return D3D9_OK;
}
