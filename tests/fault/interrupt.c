/* Interrupted commands: finished work is reported completely, and unfinished work leaves no file. The command
 * runs in its own process, which receives a signal some time after its start. */
#define _GNU_SOURCE
#include "base/file.h"
#include "base/leftover.h"
#include "engines/external/external.h"
#include "command/tool/command_line.h"
#include "command/support/interrupt.h"

#include <cjson/cJSON.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <unity.h>

enum { ARGUMENTS = 64, TEXT = 1 << 16, LATEST_MS = 60000 };

static char folder[64], report[128], stream[128], said[TEXT], complained[TEXT];

/* A stream that repeats the same lines after a triangle. */
static void write_stream(const char *size, const char *line, unsigned count)
{
    char *text = NULL;
    size_t bytes;
    FILE *out = open_memstream(&text, &bytes);
    fprintf(out,
            "triptych 1\ntarget %s\nvertices corner position:float3 diffuse:color {\n-1 -1 0 0xffff0000\n"
            "0 1 0.5 0xff00ff00\n1 -1 1 0xff0000ff\n}\nstate lighting false\nstate cullmode none\n"
            "bind vertices corner\n",
            size);
    for (unsigned i = 0; i < count; i++)
        fputs(line, out);
    fclose(out);
    TEST_ASSERT_EQUAL_INT(0, file_write(stream, text, bytes, NULL));
    free(text);
}

void setUp(void)
{
    strcpy(folder, "/dev/shm/triptych-stop-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(report, sizeof report, "%s/report.json", folder);
    snprintf(stream, sizeof stream, "%s/endless.tri", folder);
    write_stream("200 200", "clear color 0.1 0.1 0.2 1 depth 1\ndraw triangles 0 1\nframe\n", 20000);
    setenv("TMPDIR", folder, 1);
}

static unsigned count_files(const char *pattern)
{
    char whole[256];
    glob_t found;
    snprintf(whole, sizeof whole, "%s/%s", folder, pattern);
    unsigned count = glob(whole, 0, NULL, &found) ? 0 : (unsigned)found.gl_pathc;
    if (count)
        globfree(&found);
    return count;
}

void tearDown(void)
{
    char line[128];
    snprintf(line, sizeof line, "rm -rf %s", folder);
    TEST_ASSERT_EQUAL_INT(0, system(line));
}

/* --- A command in a process ----------------------------------------------------------------------------- */

static void sleep_ms(long ms)
{
    nanosleep(&(struct timespec){ms / 1000, ms % 1000 * 1000000}, NULL);
}

static pid_t start(const char *line)
{
    char words[1024], name[128], *arguments[ARGUMENTS] = {"triptych"};
    int count = 1;
    snprintf(words, sizeof words, "%s", line);
    for (char *word = strtok(words, " "); word; word = strtok(NULL, " "))
        arguments[count++] = !strcmp(word, "STREAM") ? stream : !strcmp(word, "REPORT") ? report : word;
    fflush(NULL);
    snprintf(name, sizeof name, "%s/out", folder);
    unlink(name); /* an output of an earlier process is none of this one, for which await() waits */
    pid_t process = fork();
    TEST_ASSERT_GREATER_OR_EQUAL(0, process);
    if (process)
        return process;
    freopen(name, "w", stdout);
    snprintf(name, sizeof name, "%s/err", folder);
    freopen(name, "w", stderr);
    signal(SIGINT, SIG_DFL);
    interrupt_catch();
    int status = command_line_run(count, arguments);
    fflush(NULL);
    _exit(status);
}

/* Waits until a file with this name exists and is not empty, or until a folder with this name exists. */
static void await(const char *name)
{
    char path[256];
    struct stat status;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    for (int i = 0; i < LATEST_MS / 10 && (stat(path, &status) || !status.st_size); i++)
        sleep_ms(10);
    sleep_ms(100);
}

/* Waits for the process and returns its status as a shell does. */
static int end(pid_t process)
{
    int status;
    char name[128], *text;
    size_t bytes;
    TEST_ASSERT_EQUAL_INT(process, waitpid(process, &status, 0));
    snprintf(name, sizeof name, "%s/out", folder);
    TEST_ASSERT_EQUAL_INT(0, file_read(name, TEXT - 1, &text, &bytes, NULL));
    strcpy(said, text);
    free(text);
    snprintf(name, sizeof name, "%s/err", folder);
    TEST_ASSERT_EQUAL_INT(0, file_read(name, TEXT - 1, &text, &bytes, NULL));
    strcpy(complained, text);
    free(text);
    return WIFSIGNALED(status) ? 256 + WTERMSIG(status) : WEXITSTATUS(status);
}

static cJSON *read_report(void)
{
    char *text;
    size_t bytes;
    TEST_ASSERT_EQUAL_INT(0, file_read(report, 1 << 20, &text, &bytes, NULL));
    cJSON *json = cJSON_Parse(text);
    free(text);
    TEST_ASSERT_NOT_NULL(json);
    return json;
}

/* --- Tests ---------------------------------------------------------------------------------------------- */

/* Returns 1 if the signal interrupted a stream in the middle, and 0 if it arrived between two streams. */
static int interrupt_verification(int number, const char *name)
{
    char last[128];
    pid_t process = start("verify tests/data/streams/odd-target.tri STREAM --engines batch --threads 1 "
                          "--frames all --json REPORT");
    await("out");
    TEST_ASSERT_EQUAL_INT(0, kill(process, number));
    TEST_ASSERT_EQUAL_INT_MESSAGE(128 + number, end(process), complained);
    TEST_ASSERT_EQUAL_STRING("", complained);
    snprintf(last, sizeof last, "interrupted by %s: ", name);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, last), said);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, " of 2 streams, 1 engine, identical\n"), said);
    cJSON *json = read_report();
    TEST_ASSERT_EQUAL_STRING(name, cJSON_GetStringValue(cJSON_GetObjectItem(json, "interrupted")));
    TEST_ASSERT_TRUE(cJSON_IsTrue(cJSON_GetObjectItem(json, "identical")));
    const cJSON *streams = cJSON_GetObjectItem(json, "streams"), *of;
    TEST_ASSERT_GREATER_THAN(0, cJSON_GetArraySize(streams));
    int complete = 0, partial = 0;
    cJSON_ArrayForEach(of, streams)
    {
        complete += cJSON_IsTrue(cJSON_GetObjectItem(of, "complete"));
        partial += cJSON_IsFalse(cJSON_GetObjectItem(of, "complete"));
    }
    TEST_ASSERT_LESS_OR_EQUAL(1, partial);
    TEST_ASSERT_LESS_OR_EQUAL(1, complete);
    cJSON_Delete(json);
    TEST_ASSERT_EQUAL_UINT(1, count_files("report*"));
    return partial;
}

static void stop_verification(int number, const char *name)
{
    enum { TRIES = 10 };
    for (int i = 0; i < TRIES; i++)
        if (interrupt_verification(number, name))
            return;
    TEST_FAIL_MESSAGE("no verification was interrupted in the middle of a stream");
}

static void test_an_interrupted_verification_reports_the_compared_streams(void)
{
    stop_verification(SIGINT, "SIGINT");
}

static void test_sigterm_and_sighup_are_requests_too(void)
{
    stop_verification(SIGTERM, "SIGTERM");
    stop_verification(SIGHUP, "SIGHUP");
}

/* Returns false if the signal arrived before the command was ready to report. */
static bool stop_early(long milliseconds)
{
    pid_t process = start("verify STREAM --engines batch --threads 1 --frames all --json REPORT");
    sleep_ms(milliseconds);
    TEST_ASSERT_EQUAL_INT(0, kill(process, SIGTERM));
    TEST_ASSERT_EQUAL_INT_MESSAGE(128 + SIGTERM, end(process), complained);
    return !access(report, F_OK);
}

static void test_a_verification_without_a_complete_stream_has_no_verdict(void)
{
    long milliseconds = 50;
    while (!stop_early(milliseconds) && milliseconds < LATEST_MS)
        milliseconds *= 2;
    TEST_ASSERT_NOT_NULL_MESSAGE(
        strstr(said, "interrupted by SIGTERM: 0 of 1 stream, 1 engine, no stream complete\n"), said);
    cJSON *json = read_report();
    TEST_ASSERT_TRUE(cJSON_IsNull(cJSON_GetObjectItem(json, "identical")));
    cJSON_Delete(json);
}

static void test_a_measurement_reports_the_streams_that_are_done(void)
{
    pid_t process = start("bench tests/data/streams/odd-target.tri tests/data/streams/odd-target.tri "
                          "tests/data/streams/frames.tri STREAM "
                          "--engines specialize --repetitions 1000 --seconds 0.2 --json REPORT");
    await("out");
    TEST_ASSERT_EQUAL_INT(0, kill(process, SIGINT));
    TEST_ASSERT_EQUAL_INT_MESSAGE(130, end(process), complained);
    TEST_ASSERT_EQUAL_STRING("", complained);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "\ninterrupted by SIGINT: "), said);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, " of 4 streams\n"), said);
    cJSON *json = read_report();
    TEST_ASSERT_EQUAL_STRING("SIGINT", cJSON_GetStringValue(cJSON_GetObjectItem(json, "interrupted")));
    TEST_ASSERT_GREATER_THAN(0, cJSON_GetArraySize(cJSON_GetObjectItem(json, "streams")));
    cJSON_Delete(json);
}

static cJSON *read_interrupted_report(void)
{
    cJSON *json = read_report();
    TEST_ASSERT_EQUAL_STRING("SIGINT", cJSON_GetStringValue(cJSON_GetObjectItem(json, "interrupted")));
    return json;
}

/* Three runs of a tenth of a second are enough for a report. */
static void test_a_measurement_reports_the_runs_of_the_stream_at_hand(void)
{
    pid_t process = start("bench tests/data/streams/odd-target.tri --engines specialize --repetitions 1000 "
                          "--seconds 100 --json REPORT");
    sleep_ms(4000);
    TEST_ASSERT_EQUAL_INT(0, kill(process, SIGINT));
    TEST_ASSERT_EQUAL_INT_MESSAGE(130, end(process), complained);
    TEST_ASSERT_EQUAL_STRING("", complained);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "\ninterrupted by SIGINT: 0 of 1 streams\n"), said);
    cJSON *json = read_interrupted_report(), *streams = cJSON_GetObjectItem(json, "streams");
    TEST_ASSERT_EQUAL_INT(1, cJSON_GetArraySize(streams));
    cJSON *stream = cJSON_GetArrayItem(streams, 0);
    TEST_ASSERT_TRUE(cJSON_IsTrue(cJSON_GetObjectItem(stream, "interrupted")));
    cJSON *run = cJSON_GetArrayItem(cJSON_GetObjectItem(stream, "engines"), 0);
    TEST_ASSERT_GREATER_OR_EQUAL(
        3, cJSON_GetArraySize(cJSON_GetObjectItem(cJSON_GetObjectItem(run, "samples"), "frame_ms")));
    cJSON_Delete(json);
}

static void test_a_measurement_without_a_result_writes_a_whole_report(void)
{
    static const char *const lines[] = {
        "bench STREAM --engines emulate --seconds 1000 --json REPORT",
        "bench --cold STREAM --engines emulate --repetitions 1000 --json REPORT",
        ("bench --builds tests/data/streams/lights.tri tests/data/streams/texture-operations.tri "
         "--engines specialize --repetitions 1000 --json REPORT")};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        pid_t process = start(lines[i]);
        sleep_ms(500);
        TEST_ASSERT_EQUAL_INT(0, kill(process, SIGINT));
        TEST_ASSERT_EQUAL_INT_MESSAGE(130, end(process), complained);
        TEST_ASSERT_EQUAL_STRING("", complained);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, "\ninterrupted by SIGINT"), said);
        cJSON_Delete(read_interrupted_report());
        unlink(report);
    }
}

static void test_fuzzing_reports_the_cases_so_far(void)
{
    char line[256];
    snprintf(line, sizeof line,
             "fuzz --count 1000000 --engines batch --threads 1 --output %s/findings --json REPORT", folder);
    pid_t process = start(line);
    await("findings");
    sleep_ms(300);
    TEST_ASSERT_EQUAL_INT(0, kill(process, SIGINT));
    TEST_ASSERT_EQUAL_INT_MESSAGE(130, end(process), complained);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, ", interrupted\n"), said);
    cJSON *json = read_report();
    TEST_ASSERT_TRUE(cJSON_IsTrue(cJSON_GetObjectItem(json, "interrupted")));
    cJSON_Delete(json);
    TEST_ASSERT_EQUAL_UINT(0, count_files("findings"));
}

/* The frame never ends. After the first signal the command waits for it, after the second it does not. */
static void test_a_second_signal_ends_immediately(void)
{
    write_stream("4096 4096", "draw triangles 0 1\n", 10000);
    pid_t process = start("verify STREAM --engines batch --threads 1 --json REPORT");
    sleep_ms(300);
    TEST_ASSERT_EQUAL_INT(0, kill(process, SIGINT));
    sleep_ms(100);
    TEST_ASSERT_EQUAL_INT(0, waitpid(process, NULL, WNOHANG));
    TEST_ASSERT_EQUAL_INT(0, kill(process, SIGTERM));
    TEST_ASSERT_EQUAL_INT(256 + SIGTERM, end(process));
    TEST_ASSERT_EQUAL_UINT(0, count_files("report*"));
}

/* The signal ends commands that have nothing to report. */
static void test_rendering_ends_by_the_signal_and_leaves_nothing(void)
{
    char line[256];
    write_stream("4096 4096", "draw triangles 0 1\n", 10000);
    snprintf(line, sizeof line, "render STREAM --engine emulate --out %s/picture.png", folder);
    pid_t process = start(line);
    sleep_ms(300);
    TEST_ASSERT_EQUAL_INT(0, kill(process, SIGINT));
    TEST_ASSERT_EQUAL_INT(256 + SIGINT, end(process));
    TEST_ASSERT_EQUAL_UINT(0, count_files("picture*"));
}

/* The child writes a file again and again, so the signal arrives during a write. */
static void test_a_signal_while_a_file_is_written_removes_the_temporary_file(void)
{
    fflush(NULL);
    pid_t process = fork();
    TEST_ASSERT_GREATER_OR_EQUAL(0, process);
    if (!process) {
        static char data[1 << 20];
        signal(SIGINT, SIG_DFL);
        interrupt_catch();
        for (;;)
            if (file_write(report, data, sizeof data, NULL))
                _exit(1);
    }
    sleep_ms(100);
    kill(process, SIGINT);
    int status;
    TEST_ASSERT_EQUAL_INT(process, waitpid(process, &status, 0));
    TEST_ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT);
    TEST_ASSERT_EQUAL_UINT(0, count_files("*.new"));
    TEST_ASSERT_EQUAL_UINT(1, count_files("report.json"));
}

/* --- The compiler's folders ----------------------------------------------------------------------------- */

/* Makes a compiler that does not end during the test. */
static void make_slow_compiler(void)
{
    char path[128];
    static const char text[] = "#!/bin/sh\nexec sleep 30\n";
    snprintf(path, sizeof path, "%s/cc", folder);
    TEST_ASSERT_EQUAL_INT(0, file_write(path, text, strlen(text), NULL));
    TEST_ASSERT_EQUAL_INT(0, chmod(path, 0755));
    setenv("TRIPTYCH_CC", path, 1);
}

/* Starts a compilation that hangs, while `others` other ones run, and waits for its folder. */
static pid_t start_compiling(unsigned others)
{
    fflush(NULL);
    pid_t process = fork();
    TEST_ASSERT_GREATER_OR_EQUAL(0, process);
    if (!process) {
        struct error error = {{0}};
        setpgid(0, 0);
        signal(SIGINT, SIG_DFL);
        interrupt_catch();
        external_compile(external_options(&engine_external), "", 0, &error);
        _exit(1);
    }
    setpgid(process, process);
    for (int i = 0; i < LATEST_MS / 10 && count_files("triptych-*-*/messages") <= others; i++)
        sleep_ms(10);
    TEST_ASSERT_EQUAL_UINT(others + 1, count_files("triptych-*-*/messages"));
    return process;
}

static void end_compiling(pid_t process, int number)
{
    int status;
    kill(process, number);
    TEST_ASSERT_EQUAL_INT(process, waitpid(process, &status, 0));
    TEST_ASSERT_EQUAL_INT(number, WTERMSIG(status));
    kill(-process, SIGKILL); /* the compiler */
}

static void test_a_signal_while_compiling_removes_the_folder(void)
{
    make_slow_compiler();
    end_compiling(start_compiling(0), SIGTERM);
    unsetenv("TRIPTYCH_CC");
    TEST_ASSERT_EQUAL_UINT(0, count_files("triptych-*"));
}

/* The next process removes the folders of processes that SIGKILL ended, and does not remove folders in
 * use. */
static void test_folders_of_processes_that_were_killed_are_removed_by_the_next_one(void)
{
    char line[128];
    make_slow_compiler();
    end_compiling(start_compiling(0), SIGKILL);
    TEST_ASSERT_EQUAL_UINT(1, count_files("triptych-*-*/routine.c"));
    /* start_compiling() recognizes the next folder by this file. */
    snprintf(line, sizeof line, "rm %s/triptych-*-*/messages", folder);
    TEST_ASSERT_EQUAL_INT(0, system(line));
    pid_t other = start_compiling(0);
    TEST_ASSERT_EQUAL_UINT(1, count_files("triptych-*-*"));
    pid_t third = start_compiling(1);
    TEST_ASSERT_EQUAL_UINT(2, count_files("triptych-*-*"));
    end_compiling(other, SIGTERM);
    end_compiling(third, SIGTERM);
    unsetenv("TRIPTYCH_CC");
    TEST_ASSERT_EQUAL_UINT(0, count_files("triptych-*"));
}

static void test_leftovers_are_files_then_folders_and_forgotten_ones_stay(void)
{
    char inner[128], file[160], kept[160];
    snprintf(inner, sizeof inner, "%s/inner", folder);
    snprintf(file, sizeof file, "%s/file", inner);
    snprintf(kept, sizeof kept, "%s/kept", folder);
    TEST_ASSERT_EQUAL_INT(0, mkdir(inner, 0777));
    TEST_ASSERT_EQUAL_INT(0, file_write(file, "x", 1, NULL));
    TEST_ASSERT_EQUAL_INT(0, file_write(kept, "x", 1, NULL));
    int numbers[3] = {leftover_note(inner), leftover_note(kept), leftover_note(file)};
    leftover_forget(numbers[1]);
    leftovers_remove();
    leftover_forget(numbers[0]);
    leftover_forget(numbers[2]);
    TEST_ASSERT_EQUAL_INT(-1, access(inner, F_OK));
    TEST_ASSERT_EQUAL_INT(0, access(kept, F_OK));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_interrupted_verification_reports_the_compared_streams);
    RUN_TEST(test_sigterm_and_sighup_are_requests_too);
    RUN_TEST(test_a_verification_without_a_complete_stream_has_no_verdict);
    RUN_TEST(test_a_measurement_reports_the_streams_that_are_done);
    RUN_TEST(test_a_measurement_reports_the_runs_of_the_stream_at_hand);
    RUN_TEST(test_a_measurement_without_a_result_writes_a_whole_report);
    RUN_TEST(test_fuzzing_reports_the_cases_so_far);
    RUN_TEST(test_a_second_signal_ends_immediately);
    RUN_TEST(test_rendering_ends_by_the_signal_and_leaves_nothing);
    RUN_TEST(test_a_signal_while_a_file_is_written_removes_the_temporary_file);
    RUN_TEST(test_a_signal_while_compiling_removes_the_folder);
    RUN_TEST(test_folders_of_processes_that_were_killed_are_removed_by_the_next_one);
    RUN_TEST(test_leftovers_are_files_then_folders_and_forgotten_ones_stay);
    return UNITY_END();
}
