/* The values that the state derives to, kept up to date part by part.
 *
 * A setter names the parts that it may change (render/derive/change.h). They are derived again when the
 * next draw needs them; all other parts stay as they are. */
#ifndef RENDER_DEVICE_DERIVED_H
#define RENDER_DEVICE_DERIVED_H

#include "render/derive/derive.h"
#include "render/draw/command.h"

/* World matrices of indexed vertex blending, as draws have them. */
struct palette {
    struct palette *next;
    struct palette_entry entry[WORLD_MATRICES];
};

struct device_derived {
    unsigned stale; /* set of the parts that must be derived again (render/derive/derive.h) */
    union key key[UNIT_COUNT];
    struct job job;
    struct live_job live;     /* the bytes of the job that the routines read */
    struct pair_form pairs;   /* of the keys, if a pixel has one sample */
    struct palette *palettes; /* the newest is the job's; queued draws use the others */
    bool steps;               /* some stream advances with the instance */
    uint64_t vertices; /* how many vertices every element has that is read; 0 if one has no buffer. Elements
                          of immediate vertices do not count */
    uint64_t streams;  /* a bit for each stream that is read */
    uint64_t
        overread; /* a bit for each of those with elements after which routines may read (contract/job.h) */
    uint32_t extent[STREAM_COUNT]; /* of those: bytes from the start of a vertex to the end of its elements */
    struct draw draw; /* what does not depend on the call. Its routines are null unless they are held for
                                 these keys; its job is null unless it is queued */
};

/* Derives the stale parts, for draws of a primitive. */
enum triptych_result device_derived_update(struct device_derived *derived, const struct state *state,
                                           enum triptych_primitive primitive, struct error *error);

/* Derives the stale parts if only streams have changed since device_derived_update. */
void device_derived_update_streams(struct device_derived *derived, const struct state *state);

/* Returns true if deriving everything from scratch gives the same, byte by byte: a check of builds that check
 * themselves. For checks: builds with JOBS_CHECKED compare what is derived. */
bool device_derived_is_exact(const struct device_derived *derived, const struct state *state);

/* Returns true if draws sample the texture of sampler number i. */
bool device_derived_samples(const struct device_derived *derived, int i);
/* Returns true if pixels read the clip mask. */
bool device_derived_masks(const struct device_derived *derived);

bool device_same_key(enum unit unit, const union key *a, const union key *b);

/* Removes the palettes that only queued draws use, and returns them. */
struct palette *device_derived_take_palettes(struct device_derived *derived);
void device_free_palettes(struct palette *palettes);

#endif
