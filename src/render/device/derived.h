/* The values that the state derives to, kept up to date part by part.
 *
 * A setter names the parts that it may change (render/derive/change.h). They are derived again when the
 * next draw needs them; all other parts stay as they are. Programs return to few states again and again, so
 * the values of some sources of keys (render/device/key_source.h) are kept. A source that is found again
 * has its keys, and of its other parts only those are derived that were named in the meantime. */
#ifndef RENDER_DEVICE_DERIVED_H
#define RENDER_DEVICE_DERIVED_H

#include "render/device/key_source.h"
#include "render/draw/command.h"

/* World matrices of indexed vertex blending, as draws have them. */
struct palette {
    struct palette *next;
    struct palette_entry entry[WORLD_MATRICES];
};

/* The values that states with one source derive to. */
struct derived_source {
    union key key[UNIT_COUNT];
    struct job job;
    struct live_job live;   /* the bytes of the job that the routines read */
    struct pair_form pairs; /* of the keys, if a pixel has one sample */
    uint32_t sampled;       /* a bit for each sampler whose texture draws sample */
    bool steps;             /* some stream advances with the instance */
    uint64_t vertices; /* how many vertices every element has that is read; 0 if one has no buffer. Elements
                          of immediate vertices do not count */
    uint64_t streams;  /* a bit for each stream that is read */
    uint64_t
        overread; /* a bit for each of those with elements after which routines may read (contract/job.h) */
    uint32_t extent[STREAM_COUNT]; /* of those: bytes from the start of a vertex to the end of its elements */
    struct draw draw; /* what does not depend on the call. Its routines are null unless they are held for
                                 these keys; its job is null unless it is queued */
    uint32_t in_use[DRAW_ROUTINES]; /* the places of its routines (render/device/routines.h) */
    uint64_t epoch;                 /* the device's while its routines are held and its job is queued */
    struct key_source source;
};

enum { DERIVED_SOURCES = 16 };

struct device_derived {
    unsigned changed;           /* set of the parts (render/derive/derive.h) that may have changed since the
                                   last update */
    struct derived_source *now; /* one of `kept`: that of the last update; the state's if nothing changed */
    unsigned place;             /* its place */
    unsigned count;             /* of the sources that are kept */
    struct palette *palettes;   /* the newest is that of jobs; queued draws use the others */
    bool has_palette;           /* the newest is the state's */
    uint64_t updates;           /* with changes of the source */
    /* By place: the parts that must be derived again, when it was used, and its device_source_hash. */
    unsigned stale[DERIVED_SOURCES];
    uint64_t used[DERIVED_SOURCES];
    uint32_t hash[DERIVED_SOURCES];
    struct derived_source kept[DERIVED_SOURCES];
};

/* Starts without sources, in memory that is zero; everything is stale. */
void device_derived_initialize(struct device_derived *derived);

/* Derives the stale parts, for draws of a primitive. `epoch` is the device's. */
enum triptych_result device_derived_update(struct device_derived *derived, const struct state *state,
                                           enum triptych_primitive primitive, uint64_t epoch,
                                           struct error *error);

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
