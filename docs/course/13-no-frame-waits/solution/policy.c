/* Lab 13: when to build, what to build next, how long, and what to keep. */
#include "tiers.h"

enum { HYSTERESIS = 2, SHARE = 20 /* its inverse */ };

/* Each drop doubles the threshold, so that a routine that does not fit is not built again and again. */
bool policy_request(const struct routine *routine)
{
    double threshold = routine->build_us;
    for (unsigned i = 0; i < routine->drops && threshold < 1e12; i++)
        threshold *= HYSTERESIS;
    return routine->lost_us >= threshold;
}

/* The most saved time for a microsecond of building. */
size_t policy_next(const struct routine *const waiting[], size_t count)
{
    size_t best = 0;
    for (size_t i = 1; i < count; i++)
        if (waiting[i]->heat * waiting[best]->build_us > waiting[best]->heat * waiting[i]->build_us)
            best = i;
    return best;
}

/* The rest of the frame, and at least a small share of what it takes: otherwise slow frames stay slow. */
double policy_budget(double drawing_us, double frame_us)
{
    double left = frame_us - drawing_us, least = (drawing_us > frame_us ? drawing_us : frame_us) / SHARE;
    return left > least ? left : least;
}

bool policy_displaces(const struct routine *newcomer, const struct routine *resident)
{
    return newcomer->heat > HYSTERESIS * resident->heat;
}
