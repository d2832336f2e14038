/* Queries: what the application asks of the rendering between two points of the command sequence.
 *
 * Draws within an occlusion query count what passes (pixel key `count`); the others count nothing, so the sum
 * over all draws, taken where the query began and where it ended, differs by what it asks for. Places are
 * numbers of commands since the device was made, and are resolved when the commands before them are rendered.
 */
#ifndef DRAW_QUERY_H
#define DRAW_QUERY_H

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

/* What a device knows of queries; zero at first. */
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
