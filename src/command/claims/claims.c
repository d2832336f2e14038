/* `triptych claims`: starts the laboratory of bench/claims, a program in Python. */
#include "command/support/option.h"
#include "command/support/shard.h"
#include "command/support/tool.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct settings {
    const char *only, *results, *shard;
    bool list, resume, older, json, check, pdf;
};

enum { ARGUMENTS = 20, SHARD_TEXT = 32 };

/* Appends the folder of the laboratory to a folder. Returns true if it is there. */
static bool laboratory_in(const char *folder, char path[PATH_MAX])
{
    char program[PATH_MAX];
    if (snprintf(path, PATH_MAX, "%s/bench/claims", folder) >= PATH_MAX)
        return false;
    return snprintf(program, sizeof program, "%s/__main__.py", path) < PATH_MAX && !access(program, R_OK);
}

/* Finds the laboratory of the source tree that contains the command: `folder` is the command's path, and is
 * shortened until a tree is found. Returns 0, or -1. */
static int find_laboratory(char folder[PATH_MAX], char path[PATH_MAX])
{
    for (char *end = strrchr(folder, '/'); end; end = strrchr(folder, '/')) {
        *end = 0;
        if (laboratory_in(folder, path))
            return 0;
    }
    return -1;
}

/* Appends an option, and its value if that is not null. */
static void add(char *arguments[ARGUMENTS], unsigned *count, const char *option, const char *value)
{
    arguments[(*count)++] = (char *)option;
    if (value)
        arguments[(*count)++] = (char *)value;
}

static void add_settings(char *arguments[ARGUMENTS], unsigned *count, const struct settings *settings)
{
    if (settings->only)
        add(arguments, count, "--only", settings->only);
    if (settings->results)
        add(arguments, count, "--results", settings->results);
    if (settings->list)
        add(arguments, count, "--list", NULL);
    if (settings->resume)
        add(arguments, count, "--resume", NULL);
    if (settings->older)
        add(arguments, count, "--older", NULL);
    if (settings->json)
        add(arguments, count, "--json", NULL);
    if (settings->check)
        add(arguments, count, "--check", NULL);
    if (settings->pdf)
        add(arguments, count, "--pdf", NULL);
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    char command[PATH_MAX], folder[PATH_MAX], laboratory[PATH_MAX];
    char part[SHARD_TEXT];
    struct shard shard;
    char *arguments[ARGUMENTS] = {"python3", laboratory, "--triptych", command};
    unsigned count = 4;
    (void)operands;
    if (shard_read(self, ((const struct settings *)data)->shard, &shard))
        return STATUS_BAD;
    ssize_t bytes = readlink("/proc/self/exe", command, sizeof command - 1);
    if (bytes < 0)
        return tool_fail(self, "/proc/self/exe: %s", strerror(errno));
    command[bytes] = 0;
    memcpy(folder, command, (size_t)bytes + 1);
    if (find_laboratory(folder, laboratory))
        return tool_fail(self, "%s is in no source tree, expected one with bench/claims", command);
    add_settings(arguments, &count, data);
    snprintf(part, sizeof part, "%u/%u", shard.index, shard.count);
    if (((const struct settings *)data)->shard)
        add(arguments, &count, "--shard", part);
    execvp(arguments[0], arguments);
    return tool_fail(self, "python3: cannot start: %s (Debian: apt-get install python3)", strerror(errno));
}

static const char notes[] =
    "Runs the experiments of the claims that docs/claims.md explains, at most an hour on two cores, and "
    "prints\n"
    "a verdict for each claim. Without --only it writes DIR/claims.json and the report "
    "DIR/report/index.html.\n"
    "Outputs of experiments are kept in DIR/claims. --resume uses those of the same commands, commit and\n"
    "machine, for example after an interruption; --older also those of other commits, for example when a\n"
    "claim was added. The report names the commit of each experiment.\n"
    "Exit status 1: an experiment failed, so a claim has no verdict.";

static const struct option options[] = {
    {"only", "LIST", "these claims, separated by commas, such as C156,S9; all",
     OPTION_IS_LIST(struct settings, only)},
    {"list", NULL, "list the claims and their experiments, and run nothing",
     OPTION_IS_FLAG(struct settings, list)},
    OPTION_SHARD(struct settings, shard),
    {"resume", NULL, "use kept outputs of experiments", OPTION_IS_FLAG(struct settings, resume)},
    {"older", NULL, "use kept outputs of other commits too", OPTION_IS_FLAG(struct settings, older)},
    {"json", NULL, "print the verdicts as JSON", OPTION_IS_FLAG(struct settings, json)},
    {"check", NULL, "only check the registry", OPTION_IS_FLAG(struct settings, check)},
    {"pdf", NULL, "also print the report as PDF, with Chromium", OPTION_IS_FLAG(struct settings, pdf)},
    {"results", "DIR", "the folder of all results; results in the source tree",
     OPTION_IS_FOLDER(struct settings, results)},
    {0},
};

const struct command command_claims = {
    .name = "claims",
    .summary = "test the claims of the thesis and of other renderers",
    .options = options,
    .notes = notes,
    .settings_bytes = sizeof(struct settings),
    .run = run,
};
