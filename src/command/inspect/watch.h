/* An engine that observes: its routines are the emulator's, and it notes the primitives that meet one pixel,
 * with the result of each test and the values before and after, and counts how often each pixel is covered.
 *
 * Nothing of the pipeline is computed a second time. The tests and values are those that the specification
 * names (observe.h), the values before and after are the words of the target. Two parts of the pipeline run
 * again with one condition removed, for primitives that miss the pixel: the rasterizer without the scissor
 * rectangle, and setup with a key that culls nothing.
 *
 * The engine needs a device with one thread. Draws must be rendered one by one. */
#ifndef COMMAND_INSPECT_WATCH_H
#define COMMAND_INSPECT_WATCH_H

#include "command/inspect/observe.h"
#include "command/inspect/pixel.h"
#include "command/inspect/question.h"
#include "contract/engine.h"
#include "render/device/device.h"

/* The fate of a primitive at the pixel. */
enum touch_kind { TOUCH_DRAWN, TOUCH_CULLED, TOUCH_SCISSORED };

enum { TOUCHES_MAXIMUM = 16384, TOUCH_VERTICES = 3 };

/* Operands of the tests that are not values of the specification. */
struct touch_tests {
    uint8_t depth, alpha, stencil; /* enum compare */
    int32_t alpha_reference, stencil_reference, stencil_mask;
};

/* A primitive that meets the pixel. */
struct touch {
    enum touch_kind kind;
    uint32_t order;               /* in which the draw's were noted */
    uint32_t instance, primitive; /* of the draw, from 0 */
    uint32_t vertices, vertex[TOUCH_VERTICES];
    bool clipped; /* it is a part that the clipper left */
    /* TOUCH_DRAWN: */
    uint8_t seen[OBSERVED_COUNT];
    uint32_t value[OBSERVED_COUNT][OBSERVED_NUMBERS][OBSERVED_PARTS];
    struct touch_tests tests;
    struct pixel_words before, after;
};

/* Counts of a draw. */
struct watch_counts {
    uint64_t primitives; /* with instances */
    uint64_t covered, shaded, passed;
};

struct watch;

/* Null when there is no memory. */
struct watch *watch_create(void);
void watch_free(struct watch *watch);

/* A device of one thread with the engine and these settings. It must be destroyed before the watch. Null with
 * the reason. */
struct triptych_device *watch_device(struct watch *watch, const struct setting_values *settings,
                                     struct error *error);

/* From now on watches a pixel; x < 0: none. */
void watch_pixel(struct watch *watch, int32_t x, int32_t y);

/* From now on counts each pixel of the target in `count`, rows of the target's width;
 * null: none. */
void watch_count(struct watch *watch, uint32_t *count, enum watch_what what);

/* From now on notes the owner of each pixel in `owner`, in the same rows; null: none. */
void watch_owners(struct watch *watch, struct watch_owner *owner);

/* Before the draw of that number: forgets touches and counts. */
void watch_begin(struct watch *watch, uint32_t draw);

/* After the draw is rendered: its touches, by instance and primitive, and its counts. */
const struct touch *watch_touches(struct watch *watch, uint32_t *count);
struct watch_counts watch_totals(const struct watch *watch);

/* Returns true if memory was refused: touches and owners are missing. */
bool watch_is_starved(const struct watch *watch);

/* Returns true if touches are missing because there were more than TOUCHES_MAXIMUM. */
bool watch_is_incomplete(const struct watch *watch);

#endif
