#define _GNU_SOURCE /* sched_getaffinity */
#include "command/bench/machine.h"
#include "machine/cpu.h"

#include <sched.h>
#include <stdio.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#ifndef TRIPTYCH_COMMIT
#error "the build defines TRIPTYCH_COMMIT: the output of `git describe`"
#endif

#ifdef __clang__
#define COMPILER "clang " __clang_version__
#else
#define COMPILER "gcc " __VERSION__
#endif

static unsigned count_cores(void)
{
    cpu_set_t set;
    if (!sched_getaffinity(0, sizeof set, &set))
        return (unsigned)CPU_COUNT(&set);
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online > 0 ? (unsigned)online : 1;
}

struct machine machine_describe(void)
{
    struct machine machine = {.cores = count_cores(), .compiler = COMPILER, .commit = TRIPTYCH_COMMIT};
    snprintf(machine.model, sizeof machine.model, "%s", cpu_native()->model);
    struct utsname system;
    if (!uname(&system))
        snprintf(machine.kernel, sizeof machine.kernel, "%.48s %.64s %.40s", system.sysname, system.release,
                 system.machine);
    time_t now = time(NULL);
    struct tm utc;
    if (gmtime_r(&now, &utc))
        strftime(machine.date, sizeof machine.date, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return machine;
}

cJSON *machine_json(const struct machine *machine)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "cpu", machine->model);
    cJSON_AddNumberToObject(json, "cores", machine->cores);
    cJSON_AddStringToObject(json, "kernel", machine->kernel);
    cJSON_AddStringToObject(json, "compiler", machine->compiler);
    cJSON_AddStringToObject(json, "commit", machine->commit);
    cJSON_AddStringToObject(json, "date", machine->date);
    return json;
}
