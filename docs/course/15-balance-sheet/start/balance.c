/* Lab 15: what a block of pixels needs, and the time that follows from the rates of a core. */
#include "balance.h"

/* Step 1. */
void balance_count(struct needs *needs, const char *instruction)
{
    (void)instruction;
    needs->count[INSTRUCTIONS]++;
}

/* Step 2. */
enum resource balance_bottleneck(const struct needs *needs, const struct rates *rates)
{
    (void)needs;
    (void)rates;
    return INSTRUCTIONS;
}

double balance_block_ns(const struct needs *needs, const struct rates *rates)
{
    return needs->count[INSTRUCTIONS] / rates->each[INSTRUCTIONS];
}

/* Step 3. */
double balance_frame_ms(const struct frame *frame, const struct needs *needs, const struct rates *rates)
{
    return frame->pixels * balance_block_ns(needs, rates);
}
