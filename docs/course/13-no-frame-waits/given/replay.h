/* The replay: frames of uses, and what they cost with a policy. */
#ifndef REPLAY_H
#define REPLAY_H

#include "tiers.h"

enum { ROUTINES_MAXIMUM = 64, USES_MAXIMUM = 64, FRAMES_MAXIMUM = 600 };

/* The uses of one routine in a frame. */
struct uses {
    unsigned routine, count;
};

struct trace {
    unsigned routines, frames;
    unsigned instructions[ROUTINES_MAXIMUM], bytes[ROUTINES_MAXIMUM];
    unsigned counts[FRAMES_MAXIMUM]; /* of uses */
    struct uses uses[FRAMES_MAXIMUM][USES_MAXIMUM];
};

enum manner {
    YOURS, /* policy.c */
    WAIT,  /* the first use of a routine waits for its second tier */
    NEVER  /* there is only the first tier */
};

struct setting {
    enum manner manner;
    double frame_us; /* what a frame should take */
    size_t room;     /* bytes for code of second tiers; 0: no limit */
    double first_build_us;
};

struct result {
    double total_us, drawing_us, building_us;
    double worst_us; /* the longest frame */
    double excess;   /* the largest quotient of a frame's time and that of its uses in the second tier */
    unsigned requests, builds, drops;
    unsigned longest_wait; /* frames from a request to the end of the build, or to the end of the trace */
};

/* Plays the trace. Changes the routines, one for each of the trace's. Exits with a line if the policy's
 * answer is not valid. */
struct result replay(const struct trace *trace, struct routine *routines, const struct setting *setting);

/* The time of the uses and builds together, if the policy can foresee all uses, and builds take no longer
 * than their time. */
double replay_optimum(const struct trace *trace, const struct routine *routines);

#endif
