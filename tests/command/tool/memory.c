/* The command without executable memory: it renders with the engines that need none. For the others it prints
 * one line and exits with status 2. */
#include "tests/support/system/sandbox.h"
#include "command/support/tool.h"
#include "command/tool/command_line.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static char picture[] = "/tmp/triptych-memory-XXXXXX.png";

static int run_render(char *engine)
{
    char *arguments[] = {"triptych", "render", "tests/data/streams/frames.tri", "--engine", engine,
                         "--out",    picture};
    return command_line_run(sizeof arguments / sizeof *arguments, arguments);
}

/* Runs the command with standard error in a file, and reads the file. */
static int render_telling(char *engine, char *text, size_t capacity)
{
    FILE *told = tmpfile();
    TEST_ASSERT_NOT_NULL(told);
    int before = dup(STDERR_FILENO);
    dup2(fileno(told), STDERR_FILENO);
    int status = run_render(engine);
    dup2(before, STDERR_FILENO);
    close(before);
    rewind(told);
    text[fread(text, 1, capacity - 1, told)] = 0;
    fclose(told);
    return status;
}

static void check_command(const void *argument)
{
    const struct sandbox *sandbox = argument;
    char text[1024];
    sandbox_enter(sandbox);
    unlink(picture);
    TEST_ASSERT_EQUAL_INT(STATUS_OK, run_render("emulate"));
    TEST_ASSERT_EQUAL_INT(0, access(picture, R_OK));
    unlink(picture);
    TEST_ASSERT_EQUAL_INT(STATUS_OK, run_render("batch"));
    TEST_ASSERT_EQUAL_INT(0, access(picture, R_OK));
    unlink(picture);
    TEST_ASSERT_EQUAL_INT(STATUS_BAD, render_telling("specialize", text, sizeof text));
    TEST_ASSERT_EQUAL_PTR(text + strlen(text) - 1, strchr(text, '\n'));
    *strchr(text, '\n') = 0;
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "engine specialize cannot run here"), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "needs executable memory"), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, strerror(sandbox->error)), text);
    TEST_ASSERT_TRUE(access(picture, F_OK));
}

static void the_command_renders_or_prints_the_reason(void)
{
    for (int i = 0; i < SANDBOX_REFUSALS; i++)
        sandbox_child(check_command, sandbox_refusals + i);
}

/* Starts this program again to render, under the filter that permits loading programs. */
static void start_program(const void *engine)
{
    sandbox_enter(&(struct sandbox){.protection = PROT_EXEC, .shared = 1, .error = EACCES});
    int child = fork(), status;
    if (!child) {
        execl("/proc/self/exe", "memory", engine, picture, NULL);
        _exit(99);
    }
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    TEST_ASSERT_EQUAL_INT(strcmp(engine, "emulate") ? STATUS_BAD << 8 : STATUS_OK, status);
}

static void a_program_renders_or_ends_with_status_2(void)
{
    sandbox_child(start_program, "emulate");
    TEST_ASSERT_EQUAL_INT(0, unlink(picture));
    sandbox_child(start_program, "stitch");
    TEST_ASSERT_TRUE(access(picture, F_OK));
}

int main(int count, char **arguments)
{
    if (count == 3) {
        memcpy(picture, arguments[2], sizeof picture);
        return run_render(arguments[1]);
    }
    int file = mkstemps(picture, 4);
    if (file < 0)
        return 1;
    close(file);
    UNITY_BEGIN();
    RUN_TEST(the_command_renders_or_prints_the_reason);
    RUN_TEST(a_program_renders_or_ends_with_status_2);
    unlink(picture);
    return UNITY_END();
}
