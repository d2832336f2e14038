#include "render/draw/query.h"

#include "base/clock.h"

#include <stdatomic.h>
#include <stdlib.h>

struct triptych_query *query_create(struct queries *queries, enum triptych_query_type type)
{
    struct triptych_query *query = calloc(1, sizeof *query);
    if (!query)
        return NULL;
    query->type = type;
    query->next = queries->first;
    queries->first = query;
    return query;
}

void queries_destroy(struct queries *queries)
{
    for (struct triptych_query *query = queries->first, *next; query; query = next) {
        next = query->next;
        free(query);
    }
}

static enum triptych_result bad_call(struct error *error, const char *what)
{
    error_set(error, "%s", what);
    return TRIPTYCH_BAD_CALL;
}

enum triptych_result query_begin(struct queries *queries, struct triptych_query *query, uint32_t recorded,
                                 struct error *error)
{
    if (query->type != TRIPTYCH_QUERY_OCCLUSION)
        return bad_call(error, "begin of an event or timestamp: expected only its end");
    if (query->phase == QUERY_BEGUN)
        return bad_call(error, "begin of a query that has begun: expected its end first");
    queries->counting++;
    query->phase = QUERY_BEGUN;
    query->begin = queries->rendered + recorded;
    query->before_known = false;
    return TRIPTYCH_OK;
}

enum triptych_result query_end(struct queries *queries, struct triptych_query *query, uint32_t recorded,
                               struct error *error)
{
    if (query->type == TRIPTYCH_QUERY_OCCLUSION && query->phase != QUERY_BEGUN)
        return bad_call(error, "end of a query that has not begun: expected its beginning first");
    queries->counting -= query->phase == QUERY_BEGUN;
    query->phase = QUERY_ENDED;
    query->end = queries->rendered + recorded;
    return TRIPTYCH_OK;
}

static void resolve(struct triptych_query *query, uint64_t passed)
{
    switch (query->type) {
    case TRIPTYCH_QUERY_OCCLUSION: query->result = passed - query->before; break;
    case TRIPTYCH_QUERY_TIMESTAMP: query->result = clock_ns(); break;
    case TRIPTYCH_QUERY_EVENT: query->result = 1; break;
    case TRIPTYCH_QUERY_COUNT: break;
    }
    query->phase = QUERY_RESOLVED;
}

/* Updates all queries at the position before command number queries->rendered. */
static void reach(struct queries *queries)
{
    for (struct triptych_query *query = queries->first; query; query = query->next) {
        bool pending = query->phase == QUERY_BEGUN || query->phase == QUERY_ENDED;
        if (pending && !query->before_known && query->begin == queries->rendered) {
            query->before = queries->passed;
            query->before_known = true;
        }
        if (query->phase == QUERY_ENDED && query->end == queries->rendered)
            resolve(query, queries->passed);
    }
}

void queries_rendered(struct queries *queries, const _Atomic uint64_t *passed, uint32_t count)
{
    if (queries->first)
        reach(queries);
    for (uint32_t i = 0; i < count; i++) {
        queries->passed += atomic_load_explicit(passed + i, memory_order_relaxed);
        queries->rendered++;
        if (queries->first)
            reach(queries);
    }
}
