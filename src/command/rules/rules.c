#include "command/rules/rules.h"

#include "command/support/table.h"

#include <string.h>

static void add(struct rules *rules, unsigned unit, const struct build_rule routine[PEEPHOLES],
                uint32_t instructions)
{
    rules->instructions[unit] += instructions;
    for (unsigned r = 0; r < PEEPHOLES; r++) {
        rules->rule[unit][r].fired += routine[r].fired;
        rules->rule[unit][r].instructions += routine[r].instructions;
        rules->rule[unit][r].bytes += routine[r].bytes;
    }
}

int rules_count(const struct engine *engine, const struct keys *keys, struct rules *rules,
                struct error *error)
{
    memset(rules, 0, sizeof *rules);
    for (size_t n = 0; n < keys->count; n++) {
        const struct key_found *found = keys->found + n;
        struct build_rule routine[PEEPHOLES];
        uint32_t instructions;
        if (specialize_measure_rules(engine, found->unit, &found->key, routine, &instructions, error))
            return -1;
        add(rules, found->unit, routine, instructions);
        add(rules, UNIT_COUNT, routine, instructions);
    }
    return 0;
}

void rules_print(const struct rules *rules)
{
    struct table table = {0};
    table_column(&table, "rule", TABLE_LEFT);
    table_column(&table, "applies", TABLE_RIGHT);
    table_column(&table, "fewer instructions", TABLE_RIGHT);
    table_column(&table, "fewer bytes", TABLE_RIGHT);
    for (unsigned r = 0; r < PEEPHOLES; r++) {
        const struct rule_sum *sum = &rules->rule[UNIT_COUNT][r];
        if (sum->fired <= 0)
            continue;
        table_cell(&table, "%s", peephole_name(r));
        table_cell(&table, "%.0f", sum->fired);
        table_cell(&table, "%.0f", sum->instructions);
        table_cell(&table, "%.0f", sum->bytes);
    }
    table_print(&table, 0, stdout);
}

void rules_report(const struct rules *rules, unsigned unit, cJSON *json)
{
    cJSON *list = cJSON_AddArrayToObject(json, "rules");
    for (unsigned r = 0; r < PEEPHOLES; r++) {
        const struct rule_sum *sum = &rules->rule[unit][r];
        cJSON *row = cJSON_CreateObject();
        cJSON_AddItemToArray(list, row);
        cJSON_AddStringToObject(row, "rule", peephole_name(r));
        cJSON_AddNumberToObject(row, "fired", sum->fired);
        cJSON_AddNumberToObject(row, "instructions", sum->instructions);
        cJSON_AddNumberToObject(row, "bytes", sum->bytes);
    }
}
