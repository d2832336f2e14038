/* Lab 15: what a block of pixels needs, and the time that follows from the rates of a core. */
#include "balance.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

static bool begins(const char *text, const char *start)
{
    return !strncmp(text, start, strlen(start));
}

static bool begins_with_one(const char *text, const char *const *starts)
{
    for (; *starts; starts++)
        if (begins(text, *starts))
            return true;
    return false;
}

/* Vector instructions that only move, or do not compute at all. */
static const char *const moves[] = {"vmov",     "vbroadcast", "vinsert",    "vshuf",
                                    "vldmxcsr", "vstmxcsr",   "vzeroupper", NULL};
/* Instructions that write their first operand without reading it. */
static const char *const writers[] = {"mov", "vmov", "vstmxcsr", NULL};

void balance_count(struct needs *needs, const char *instruction)
{
    const char *memory = strchr(instruction, '['), *comma = strchr(instruction, ',');
    if (begins(instruction, "nop"))
        return;
    needs->count[INSTRUCTIONS]++;
    needs->count[ARITHMETIC] += instruction[0] == 'v' && !begins_with_one(instruction, moves);
    if (!memory || begins(instruction, "lea"))
        return;
    bool first = !comma || memory < comma;
    needs->count[first && begins_with_one(instruction, writers) ? STORES : LOADS]++;
}

/* The time of a block if only this resource takes time. */
static double resource_ns(const struct needs *needs, const struct rates *rates, int resource)
{
    return needs->count[resource] / rates->each[resource];
}

enum resource balance_bottleneck(const struct needs *needs, const struct rates *rates)
{
    int slowest = INSTRUCTIONS;
    for (int r = 1; r < RESOURCES; r++)
        if (resource_ns(needs, rates, r) > resource_ns(needs, rates, slowest))
            slowest = r;
    return (enum resource)slowest;
}

double balance_block_ns(const struct needs *needs, const struct rates *rates)
{
    return resource_ns(needs, rates, balance_bottleneck(needs, rates));
}

/* Cores compute at the same time, but share the memory. A tile stays in the cache for all layers. */
double balance_frame_ms(const struct frame *frame, const struct needs *needs, const struct rates *rates)
{
    unsigned working = frame->threads < frame->cores ? frame->threads : frame->cores;
    double blocks = frame->pixels / BLOCK_PIXELS * frame->layers;
    double computing = blocks * balance_block_ns(needs, rates) / working;
    double moving = frame->pixels * frame->bytes / rates->memory;
    return (computing > moving ? computing : moving) * 1e-6;
}
