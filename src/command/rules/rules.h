/* The peephole rules of the specializer in a report: how often each applies, and how many instructions and
 * bytes it removes (engines/specialize/parts.h). They are counts, the same in every run. */
#ifndef COMMAND_RULES_RULES_H
#define COMMAND_RULES_RULES_H

#include "command/list/keys.h"
#include "command/support/json.h"
#include "engines/specialize/parts.h"

/* The sums over routines. */
struct rule_sum {
    double fired, instructions, bytes;
};

/* By unit; those of all units are the last. */
struct rules {
    struct rule_sum rule[UNIT_COUNT + 1][PEEPHOLES];
    double instructions[UNIT_COUNT + 1]; /* of machine code */
};

/* Builds every routine with and without each rule. Returns 0, or -1 with the reason. */
int rules_count(const struct engine *engine, const struct keys *keys, struct rules *rules,
                struct error *error);

/* Prints the rules that apply anywhere as a table. */
void rules_print(const struct rules *rules);

/* Adds the rules of a unit, or of all with UNIT_COUNT, to a report. */
void rules_report(const struct rules *rules, unsigned unit, cJSON *json);

#endif
