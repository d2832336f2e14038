/* Trials of flow control: the models that have it, a trial on each of them, and the comparisons in C. */
#ifndef TESTS_SUPPORT_TRIAL_TRIAL_FLOW_H
#define TESTS_SUPPORT_TRIAL_TRIAL_FLOW_H

#include "trial.h"

/* The numbers of models with flow control by constants, and by values. */
enum { FLOW_STATICALLY = 5, FLOW_DYNAMICALLY = 4 };
extern const char *const flow_statically[FLOW_STATICALLY];
extern const char *const flow_dynamically[FLOW_DYNAMICALLY];

/* Returns a trial whose operands are the edges of arithmetic. */
struct trial flow_trial(const char *model, const char *body, unsigned results);

/* Runs the trial in each model. Its `requested` applies to models 3_0 only. */
void flow_on_all(const char *const *models, unsigned count, struct trial trial, trial_reference *reference);

/* Returns the result of a comparison, given by its number in def/shader/shader_comparison.def. */
int flow_holds(int comparison, double a, double b);

#endif
