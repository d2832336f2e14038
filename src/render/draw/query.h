/* Queries of the application about the rendering between two positions in the sequence of commands.
 *
 * Draws within an occlusion query count the samples that pass (pixel key `count`); other draws count
 * nothing. So the difference of the sums at the query's end and at its beginning is its result. Positions
 * are numbers of commands since the device was created. They are resolved when the commands before them
 * are rendered. */
#ifndef RENDER_DRAW_QUERY_H
#define RENDER_DRAW_QUERY_H

#include "base/error.h"
#include "triptych.h"

#include <stdbool.h>

enum query_phase { QUERY_IDLE, QUERY_BEGUN, QUERY_ENDED, QUERY_RESOLVED };

struct triptych_query {
    struct triptych_query *next;
    enum triptych_query_type type;
    enum query_phase phase;
    uint64_t begin, end; /* commands recorded before them */
    uint64_t before;     /* passed before the beginning, once it is rendered */
    bool before_known;
    uint64_t result;
    uint32_t recorded; /* its number while calls are recorded */
};

/* The queries of a device; zero at first. */
struct queries {
    struct triptych_query *first;
    uint64_t rendered; /* commands */
    uint64_t passed;   /* samples, in all of them */
    unsigned counting; /* occlusion queries begun */
};

/* Null when memory is short. */
struct triptych_query *query_create(struct queries *queries, enum triptych_query_type type);
void queries_destroy(struct queries *queries);

/* `recorded` commands wait to be rendered. Both check the phase. */
enum triptych_result query_begin(struct queries *queries, struct triptych_query *query, uint32_t recorded,
                                 struct error *error);
enum triptych_result query_end(struct queries *queries, struct triptych_query *query, uint32_t recorded,
                               struct error *error);

/* Takes the counts of `count` commands that have been rendered. */
void queries_rendered(struct queries *queries, const _Atomic uint64_t *passed, uint32_t count);

#endif
