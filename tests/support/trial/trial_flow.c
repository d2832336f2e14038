#include "trial_flow.h"

const char *const flow_statically[FLOW_STATICALLY] = {"vs_2_0", "vs_2_x", "vs_3_0", "ps_2_x", "ps_3_0"};
const char *const flow_dynamically[FLOW_DYNAMICALLY] = {"vs_2_x", "vs_3_0", "ps_2_x", "ps_3_0"};

struct trial flow_trial(const char *model, const char *body, unsigned results)
{
    struct trial trial = {.model = model, .body = body, .results = results};
    trial.operands = trial_edges;
    trial.sets = trial_edge_sets;
    return trial;
}

void flow_on_all(const char *const *models, unsigned count, struct trial trial, trial_reference *reference)
{
    int requested = trial.requested;
    for (unsigned m = 0; m < count; m++) {
        trial.model = models[m];
        trial.requested = requested && models[m][3] == '3';
        trial_expect(&trial, reference);
    }
}

int flow_holds(int comparison, double a, double b)
{
    switch (comparison) {
    case 1: return a > b;
    case 2: return a == b;
    case 3: return a >= b;
    case 4: return a < b;
    case 5: return a != b;
    default: return a <= b;
    }
}
