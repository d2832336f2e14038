/* A full standard output. Every command that writes to it reports that it could not. */
#define _GNU_SOURCE
#include "command/store/store.h"
#include "command/tool/command_line.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

enum { ARGUMENTS = 16 };

static char folder[] = "/dev/shm/triptych-output-XXXXXX"; /* in memory, because disks are slow */
static char path[128];

void setUp(void)
{
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/picture.png", folder);
}

void tearDown(void)
{
    unlink(path);
    rmdir(folder);
    strcpy(strrchr(folder, '-'), "-XXXXXX");
}

/* Runs a command line whose word OUT is replaced by the path, in a process of its own. Returns true if it
 * fails with one line that names standard output. */
static bool reports_full_output(const char *line)
{
    char words[256], said[4096], *arguments[ARGUMENTS] = {"triptych"};
    int count = 1;
    snprintf(words, sizeof words, "%s", line);
    for (char *word = strtok(words, " "); word && count < ARGUMENTS; word = strtok(NULL, " "))
        arguments[count++] = strcmp(word, "OUT") ? word : path;
    FILE *telling = tmpfile();
    freopen("/dev/full", "w", stdout);
    dup2(fileno(telling), STDERR_FILENO);
    int status = command_line_run(count, arguments);
    rewind(telling);
    said[fread(said, 1, sizeof said - 1, telling)] = 0;
    const char *end = strchr(said, '\n');
    return status == 2 && strstr(said, "cannot write to standard output") && end && !end[1];
}

static const char *const lines[] = {
#define COMMAND(name) #name " --help",
#include "command/support/command.def"
#undef COMMAND
    "--help",
    "--version",
    "render tests/data/streams/queries.tri --engine emulate --out OUT",
    "verify tests/data/streams/odd-target.tri --engines batch --threads 1",
    "bench tests/data/streams/odd-target.tri --engines specialize --repetitions 3 --seconds 0",
    "fuzz --print 1",
    "dump tests/data/streams/odd-target.tri",
    "shader disassemble tests/data/shaders/common/color.psa",
    "compare tests/data/goldens/odd-target.png tests/data/goldens/odd-target.png",
    "list states",
};

static void every_command_reports_a_full_standard_output(void)
{
    for (unsigned i = 0; i < sizeof lines / sizeof *lines; i++) {
        int status;
        fflush(NULL);
        pid_t process = fork();
        TEST_ASSERT_GREATER_OR_EQUAL(0, process);
        if (!process)
            _exit(reports_full_output(lines[i]) ? 0 : 1);
        TEST_ASSERT_EQUAL_INT(process, waitpid(process, &status, 0));
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, status, lines[i]);
    }
}

int main(void)
{
    store_off = true; /* what it writes is not what is tested here */
    UNITY_BEGIN();
    RUN_TEST(every_command_reports_a_full_standard_output);
    return UNITY_END();
}
