/* A campaign: many cases, by several processes, so that a case that crashes or hangs is one finding more and not the end.
 *
 * The cases are numbers `first`, first + 1, ...; process j of n takes those that leave j when divided by n. A process tells
 * the one that started it through shared memory which case it draws; when it ends without having been asked to, or draws
 * one case for too long, that case is a finding and another process goes on behind it. Findings are cases by number: the
 * text is made again from it. */
#ifndef FUZZ_CAMPAIGN_H
#define FUZZ_CAMPAIGN_H

#include "fuzz/run.h"
#include "fuzz/text.h"

#include <stdbool.h>
#include <stdint.h>

enum { CAMPAIGN_JOBS = 64, CAMPAIGN_FINDINGS = 64 };

struct campaign_options {
    struct runner_options run;
    uint64_t seed, first, count;
    double seconds;  /* 0: until all cases are drawn */
    double limit;    /* seconds that a case may take */
    unsigned jobs;   /* processes */
    unsigned enough; /* findings that end the campaign */
};

struct campaign_finding {
    uint64_t number; /* of the case */
    struct finding finding;
};

struct campaign {
    uint64_t cases, outcomes[OUTCOME_COUNT];
    uint64_t pixels; /* covered by the reference */
    double seconds;
    uint64_t next; /* all cases below it have been drawn */
    struct campaign_finding finding[CAMPAIGN_FINDINGS];
    unsigned findings;
    bool interrupted;
};

/* Called now and then with what there is so far; true ends the campaign. */
typedef bool campaign_watch(void *user, const struct campaign *campaign);

/* Returns 0, or -1 with the reason when the campaign cannot be held. */
int campaign_run(const struct campaign_options *options, campaign_watch *watch, void *user,
                 struct campaign *campaign, struct error *error);

/* The text of a case. */
void campaign_case(uint64_t seed, uint64_t number, struct text *text);

/* Draws a text in a process of its own, so that a crash or a hang is an outcome like others. */
enum outcome campaign_try(const struct campaign_options *options, const char *path, const char *text,
                          size_t bytes, struct finding *finding);

/* The smallest text that fails as `finding` says: with the same outcome on the same engine. Returns 0, or -1 with the
 * reason, as when it cannot be seen to fail by itself. */
int campaign_minimize(const struct campaign_options *options, const struct finding *finding,
                      const struct text *text, struct text *smallest, struct error *error);

#endif
