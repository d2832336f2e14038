/* A campaign: many cases, drawn by several processes, so that a case that crashes or hangs is one more
 * finding and does not end the campaign.
 *
 * The cases have the numbers `first`, first + 1, ..., without those that earlier results have. Of this list,
 * process j of n draws the cases at the positions with remainder j when divided by n. A process reports each
 * case to its parent through shared memory when the case is complete. If the process ends without a request,
 * or draws one case for too long, that case is a finding, and a new process continues after it. A finding
 * stores the number of its case, from which the text is made again.
 *
 * Results can be continued: a campaign that begins with the results of an interrupted one draws the other
 * cases and adds them. The sum is the result of a campaign that was not interrupted. */
#ifndef COMMAND_FUZZ_CAMPAIGN_H
#define COMMAND_FUZZ_CAMPAIGN_H

#include "command/fuzz/run.h"
#include "command/fuzz/case/text.h"
#include "command/results/ranges.h"

#include <stdbool.h>
#include <stdint.h>

enum { CAMPAIGN_JOBS = 64, CAMPAIGN_FINDINGS = 64 };

struct campaign_options {
    struct runner_options run;
    bool vary;                      /* each case has random settings of the renderer, or else: */
    struct setting_values settings; /* those of all cases */
    uint64_t seed, first, count;
    double seconds;                 /* 0: until all cases are drawn */
    double limit;                   /* seconds that a case may take */
    unsigned jobs;                  /* processes */
    unsigned enough;                /* findings that end the campaign */
    const struct campaign *earlier; /* the results to continue, or null */
};

struct campaign_finding {
    uint64_t number; /* of the case */
    struct finding finding;
};

/* The results. All members, except `seconds` and `interrupted`, count exactly the cases that `done` has. */
struct campaign {
    uint64_t cases, outcomes[OUTCOME_COUNT];
    uint64_t pixels; /* covered by the reference */
    double seconds;
    struct ranges done;                                 /* the numbers of the cases */
    struct campaign_finding finding[CAMPAIGN_FINDINGS]; /* at the end, by the numbers of their cases */
    unsigned findings;
    bool interrupted;
};

/* Called now and then with what there is so far; true ends the campaign. */
typedef bool campaign_watch(void *user, const struct campaign *campaign);

/* Replaces *campaign, which is zero or holds earlier results of this function; free it with campaign_free.
 * Returns 0, or -1 with the reason when the campaign cannot be held. */
int campaign_run(const struct campaign_options *options, campaign_watch *watch, void *user,
                 struct campaign *campaign, struct error *error);
void campaign_free(struct campaign *campaign);

/* The text of a case. */
void campaign_case(uint64_t seed, uint64_t number, struct text *text);

/* The smallest text that fails like `finding`: with the same outcome, engine and settings. Returns 0, or -1
 * with the reason, for example that the case does not fail in its own process. */
int campaign_minimize(const struct campaign_options *options, const struct finding *finding,
                      const struct text *text, struct text *smallest, struct error *error);

#endif
