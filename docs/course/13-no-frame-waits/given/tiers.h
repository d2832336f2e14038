/* Lab 13: the tiers of routines, and the decisions about them.
 *
 * A routine has two tiers. Its first tier is built when the routine is used for the first time, by the
 * drawing thread. Its second tier is built on request, in a part of each frame's time. All times are in
 * microseconds (us) of a model, so that every run gives the same result. */
#ifndef TIERS_H
#define TIERS_H

#include <stdbool.h>
#include <stddef.h>

enum tier_state {
    FIRST,   /* uses run the first tier; nothing is requested */
    WAITING, /* they do, and the second tier is requested */
    SECOND   /* uses run the second tier */
};

/* A routine. Only the replay changes it. */
struct routine {
    double build_us;            /* time to build the second tier, above 0 */
    double first_us, second_us; /* time of one use in each tier; first_us > second_us */
    unsigned bytes;             /* code of the second tier */

    enum tier_state state;
    double
        lost_us; /* how much less the uses in the first tier would have taken in the second, since the start
                      * or since the code of the second tier was dropped */
    double heat; /* what the second tier saves in a frame, or would: half of it is from the last frame, a
                      * quarter from the one before, and so on; us */
    unsigned drops; /* how many times the code of the second tier was dropped */
};

/* --- policy.c, the student's file. The functions have no state, and do not depend on time. --- */

/* True if the second tier is to be requested. Called after each draw with a routine in the state FIRST. */
bool policy_request(const struct routine *routine);

/* The routine whose build begins now: its position in `waiting`, whose count is at least 1. The build is not
 * interrupted by others. */
size_t policy_next(const struct routine *const waiting[], size_t count);

/* Time for builds in this frame. Drawing took drawing_us, and the frame should take at most frame_us. A
 * build that takes longer continues in the next frame. Called in each frame with a waiting routine. */
double policy_budget(double drawing_us, double frame_us);

/* True if the code of `resident` is to be dropped for that of `newcomer`, whose build has ended. Called if
 * there is too little room, with the residents of least heat first, until there is room or the answer is
 * false. If it is false, the newcomer loses its code, and no resident does. */
bool policy_displaces(const struct routine *newcomer, const struct routine *resident);

#endif
