#include "command/bench/execution.h"

#include <stdio.h>
#include <string.h>

enum { LANES_MOST = 65536 }; /* of a routine; more is a damaged file */

/* From the smallest to the largest, as triptych_get_routine() names them. */
static int rank_of(const char *set)
{
    static const char *const sets[] = {"SSE2", "AVX2", "AVX-512"};
    int rank = 0;
    for (int i = 0; i < 3 && set; i++)
        if (!strcmp(sets[i], set))
            rank = i + 1;
    return rank;
}

static void add(struct execution *execution, unsigned unit, unsigned lanes, const char *set)
{
    if (execution->lanes[unit] < lanes)
        execution->lanes[unit] = lanes;
    if (rank_of(execution->instruction_set) < rank_of(set))
        execution->instruction_set = set;
}

void execution_add(struct execution *execution, const struct routine *routine)
{
    add(execution, routine->unit, routine_lanes(routine), routine_instruction_set(routine));
}

void execution_add_device(struct execution *execution, triptych_device *device)
{
    struct triptych_routine_info routine;
    for (unsigned i = 0; triptych_get_routine(device, i, &routine); i++)
        for (unsigned unit = 0; unit < UNIT_COUNT; unit++)
            if (!strcmp(unit_name[unit], routine.unit))
                add(execution, unit, routine.lanes, routine.instruction_set);
}

void execution_add_all(struct execution *execution, const struct execution *other)
{
    for (unsigned unit = 0; unit < UNIT_COUNT; unit++)
        add(execution, unit, other->lanes[unit], other->instruction_set);
}

/* True if all units that have routines have the same lanes, which *lanes becomes. */
static bool is_uniform(const struct execution *execution, unsigned *lanes)
{
    *lanes = 0;
    for (unsigned unit = 0; unit < UNIT_COUNT; unit++) {
        if (*lanes && execution->lanes[unit] && execution->lanes[unit] != *lanes)
            return false;
        if (execution->lanes[unit])
            *lanes = execution->lanes[unit];
    }
    return true;
}

const char *execution_lanes(const struct execution *execution, char text[EXECUTION_TEXT])
{
    unsigned lanes;
    *text = 0;
    if (!is_uniform(execution, &lanes))
        snprintf(text, EXECUTION_TEXT, "%u/%u/%u", execution->lanes[UNIT_VERTEX],
                 execution->lanes[UNIT_SETUP], execution->lanes[UNIT_PIXEL]);
    else if (lanes)
        snprintf(text, EXECUTION_TEXT, "%u", lanes);
    return text;
}

const char *execution_set(const struct execution *execution)
{
    return execution->instruction_set ? execution->instruction_set : "";
}

void execution_json(const struct execution *execution, cJSON *object)
{
    char text[EXECUTION_TEXT];
    cJSON_AddStringToObject(object, "lanes", execution_lanes(execution, text));
    cJSON_AddStringToObject(object, "instruction_set", execution_set(execution));
}

void execution_json_units(const struct execution *execution, cJSON *object)
{
    cJSON *lanes = cJSON_AddArrayToObject(object, "unit_lanes");
    for (unsigned unit = 0; unit < UNIT_COUNT; unit++)
        cJSON_AddItemToArray(lanes, cJSON_CreateNumber(execution->lanes[unit]));
}

void execution_units(const cJSON *object, unsigned lanes[UNIT_COUNT])
{
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(object, "unit_lanes");
    for (unsigned unit = 0; unit < UNIT_COUNT; unit++) {
        const cJSON *value = cJSON_GetArrayItem(list, (int)unit);
        bool is_lanes = cJSON_IsNumber(value) && value->valuedouble >= 0 && value->valuedouble <= LANES_MOST;
        lanes[unit] = is_lanes ? (unsigned)value->valuedouble : 0;
    }
}
