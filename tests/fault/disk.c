/* A file is either complete or unchanged, whatever happens while it is written: a system call fails, writes
 * store only some bytes, or the process is killed. The tests write every kind of file that the command
 * writes, with a fault at each system call in turn. */
#define _GNU_SOURCE
#include "tests/support/system/fault_file.h"
#include "tests/support/system/seed.h"

#include "image/exr.h"
#include "base/file.h"
#include "image/png.h"
#include "command/store/store.h"
#include "command/tool/command_line.h"

#include <dirent.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unity.h>

enum { CONTENTS = 1 << 20, ARGUMENTS = 16, SIDE = 40 };

static char folder[] = "/dev/shm/triptych-disk-XXXXXX"; /* in memory, because disks are slow */
static char path[128];
static char said[4096]; /* on standard output and standard error */

struct contents {
    size_t bytes; /* SIZE_MAX: there is no file */
    char data[CONTENTS];
};

static struct contents before, after, now;

/* --- Files ---------------------------------------------------------------------------------------------- */

static void read_contents(struct contents *contents)
{
    FILE *file = fopen(path, "rb");
    contents->bytes = SIZE_MAX;
    if (!file)
        return;
    contents->bytes = fread(contents->data, 1, sizeof contents->data, file);
    TEST_ASSERT_LESS_THAN(sizeof contents->data, contents->bytes);
    fclose(file);
}

static bool same(const struct contents *a, const struct contents *b)
{
    return a->bytes == b->bytes && (a->bytes == SIZE_MAX || !memcmp(a->data, b->data, a->bytes));
}

/* Returns the number of temporary files, whose names base/file.h specifies. Fails if the folder has any other
 * file. */
static unsigned leftovers(bool remove_them)
{
    unsigned count = 0;
    DIR *files = opendir(folder);
    const char *name = strrchr(path, '/') + 1;
    for (struct dirent *entry; (entry = readdir(files));) {
        char whole[512];
        long process;
        unsigned number;
        int end = 0;
        if (entry->d_name[0] == '.' || !strcmp(entry->d_name, name))
            continue;
        TEST_ASSERT_EQUAL_STRING_LEN(name, entry->d_name, strlen(name));
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            2, sscanf(entry->d_name + strlen(name), ".%ld-%u.new%n", &process, &number, &end), entry->d_name);
        TEST_ASSERT_EQUAL_INT(0, entry->d_name[strlen(name) + (size_t)end]);
        snprintf(whole, sizeof whole, "%s/%s", folder, entry->d_name);
        count++;
        if (remove_them)
            unlink(whole);
    }
    closedir(files);
    return count;
}

static void put_before(bool exists)
{
    unlink(path);
    if (exists) {
        FILE *file = fopen(path, "wb");
        fputs("what was there before", file);
        fclose(file);
    }
    read_contents(&before);
}

/* --- Writers -------------------------------------------------------------------------------------------- */

/* Writes `path`. Returns 0, or another value with the reason in the buffer of messages. */
typedef int writer(const char *line);

static int write_plain(const char *line)
{
    struct error error = {{0}};
    int result = file_write(path, line, strlen(line), &error);
    snprintf(said, sizeof said, "%s\n", error.text);
    return result;
}

static int write_png(const char *line)
{
    static uint32_t image[SIDE * SIDE];
    struct error error = {{0}};
    (void)line;
    int result = png_save(path, SIDE, SIDE, image, &error);
    snprintf(said, sizeof said, "%s\n", error.text);
    return result;
}

static int write_exr(const char *line)
{
    static float image[SIDE * SIDE];
    struct error error = {{0}};
    struct exr_channel channel = {"Y", image, 1, EXR_FLOAT};
    (void)line;
    int result = exr_save(path, SIDE, SIDE, &channel, 1, &error);
    snprintf(said, sizeof said, "%s\n", error.text);
    return result;
}

/* Runs a command line whose word OUT is replaced by the path. */
static int run_command(const char *line)
{
    char words[1024], *arguments[ARGUMENTS] = {"triptych"};
    int count = 1;
    snprintf(words, sizeof words, "%s", line);
    for (char *word = strtok(words, " "); word; word = strtok(NULL, " ")) {
        TEST_ASSERT_LESS_THAN(ARGUMENTS, count);
        arguments[count++] = strcmp(word, "OUT") ? word : path;
    }
    bool armed = file_fault.armed;
    file_fault.armed = false;
    fflush(NULL);
    FILE *telling = tmpfile();
    int saved[2] = {dup(STDOUT_FILENO), dup(STDERR_FILENO)};
    dup2(fileno(telling), STDOUT_FILENO);
    dup2(fileno(telling), STDERR_FILENO);
    file_fault.armed = armed;
    int status = command_line_run(count, arguments);
    file_fault.armed = false;
    fflush(NULL);
    dup2(saved[0], STDOUT_FILENO);
    dup2(saved[1], STDERR_FILENO);
    close(saved[0]);
    close(saved[1]);
    rewind(telling);
    said[fread(said, 1, sizeof said - 1, telling)] = 0;
    fclose(telling);
    file_fault.armed = armed;
    return status == 1 ? 0 : status; /* 1: the pictures differ, and the difference picture is written */
}

static const struct {
    const char *file;
    writer *write;
    const char *line;
} writers[] = {
    {"plain", write_plain, "something else, and longer than what was there before"},
    {"image.png", write_png, NULL},
    {"image.exr", write_exr, NULL},
    {"stream.tri", run_command, "convert tests/data/streams/frames.tri OUT"},
    {"stream.trib", run_command, "convert tests/data/streams/frames.tri OUT"},
    {"render.png", run_command, "render tests/data/streams/odd-target.tri --engine emulate --out OUT"},
    {"report.json", run_command,
     "verify tests/data/streams/odd-target.tri --engines batch --threads 1 --json OUT"},
    {"shader.json", run_command, "shader validate tests/data/shaders/common/color.psa --json --out OUT"},
    {"tokens", run_command, "shader assemble tests/data/shaders/common/color.psa --out OUT"},
    {"measures.csv", run_command,
     "bench tests/data/streams/odd-target.tri --engines specialize --repetitions 3 --seconds 0 --csv OUT"},
    {"difference.png", run_command,
     "compare tests/data/goldens/stencil-operations.png tests/data/goldens/texture-addressing.png "
     "--difference OUT"},
};

enum { WRITERS = sizeof writers / sizeof *writers };

static void use(unsigned i)
{
    snprintf(path, sizeof path, "%s/%s", folder, writers[i].file);
}

/* Arms the fault and writes. Returns the writer's result, and in `calls` the number of system calls. */
static int attempt(unsigned i, enum file_fault fault, int reason, unsigned long at, unsigned long *calls)
{
    file_fault_arm(fault, reason, at);
    int result = writers[i].write(writers[i].line);
    *calls = file_fault_end();
    return result;
}

/* Writes without a fault, twice, and checks that the contents are equal. Returns false if the writer writes
 * no file. */
static bool write_undisturbed(unsigned i, unsigned long *calls)
{
    if (path[0])
        unlink(path);
    use(i);
    unlink(path);
    int result = attempt(i, FILE_FAULT_NONE, 0, 0, calls);
    TEST_ASSERT_TRUE_MESSAGE(result == 0, said);
    read_contents(&after);
    return after.bytes != SIZE_MAX;
}

void setUp(void)
{
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
}

void tearDown(void)
{
    file_fault_end();
    unlink(path);
    leftovers(true);
    rmdir(folder);
    strcpy(strrchr(folder, '-'), "-XXXXXX");
}

/* Returns true if the file is complete. Reports that contain times differ in each run, so only their end is
 * checked. */
static bool is_whole(void)
{
    return same(&now, &after) || (now.bytes != SIZE_MAX && !same(&now, &before) && now.bytes > 100 &&
                                  now.data[now.bytes - 1] == '\n');
}

/* --- Tests ---------------------------------------------------------------------------------------------- */

static void judge_failure(unsigned i, int reason, unsigned long at, int result)
{
    char message[5000];
    snprintf(message, sizeof message, "%s: call %lu, %s, fails with %s: result %d, %s", writers[i].file, at,
             file_fault.name, strerror(reason), result, said);
    read_contents(&now);
    if (result) {
        const char *end = strchr(said, '\n');
        TEST_ASSERT_TRUE_MESSAGE(same(&now, &before), message);
        TEST_ASSERT_TRUE_MESSAGE(strstr(said, strerror(reason)) && end, message);
    } else {
        TEST_ASSERT_TRUE_MESSAGE(is_whole(), message);
    }
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, leftovers(false), message);
}

/* This includes errors of close, which may report that data were lost. */
static void test_each_call_that_fails_before_the_new_name_is_reported(void)
{
    unsigned long calls, at = 0;
    write_undisturbed(0, &calls);
    do {
        put_before(false);
        int result = attempt(0, FILE_FAULT_ERROR, EIO, ++at, &calls);
        TEST_ASSERT_NOT_NULL(file_fault.name);
        TEST_ASSERT_TRUE_MESSAGE(result != 0, file_fault.name);
    } while (strcmp(file_fault.name, "rename"));
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(5, at); /* open, write, fsync, close */
}

/* After the rename only the folder is synced; errors there do not fail the command. A call fails for one or
 * two of the reasons, and for each with THOROUGH=1. */
static void test_each_call_that_fails_leaves_the_old_file_or_the_new_one(void)
{
    enum { REASONS = 3 };
    static const int reasons[REASONS] = {ENOSPC, EIO, EDQUOT};
    const unsigned step = test_step(2, 7);
    for (unsigned i = 0; i < WRITERS; i++) {
        unsigned long calls, failures = 0;
        bool writes = write_undisturbed(i, &calls);
        for (unsigned long n = 0; n < REASONS * calls && writes; n += step) {
            unsigned long ignored, at = n / REASONS + 1;
            int reason = reasons[n % REASONS];
            put_before(at % 2);
            int result = attempt(i, FILE_FAULT_ERROR, reason, at, &ignored);
            judge_failure(i, reason, at, result);
            failures += result != 0;
        }
        TEST_ASSERT_TRUE_MESSAGE(!writes || failures >= test_share(4), writers[i].file);
    }
}

static void test_short_and_interrupted_writes_are_continued(void)
{
    static const struct {
        enum file_fault fault;
        int reason;
    } faults[] = {{FILE_FAULT_SHORT, 0}, {FILE_FAULT_BYTES, 0}, {FILE_FAULT_ERROR, EINTR}};
    for (unsigned i = 0; i < 3; i++)
        for (unsigned f = 0; f < sizeof faults / sizeof *faults; f++) {
            unsigned long calls, ignored;
            write_undisturbed(i, &calls);
            for (unsigned long at = 1; at <= calls; at++) {
                put_before(true);
                int result = attempt(i, faults[f].fault, faults[f].reason, at, &ignored);
                /* a fault of another call than write may fail, with a correct error */
                bool is_write = file_fault.name && !strcmp(file_fault.name, "write");
                read_contents(&now);
                bool failed_well = faults[f].reason && !is_write && result && same(&now, &before);
                TEST_ASSERT_TRUE_MESSAGE(failed_well || (!result && same(&now, &after)), said);
                TEST_ASSERT_EQUAL_UINT(0, leftovers(false));
            }
        }
}

static void test_a_write_that_stores_nothing_fails(void)
{
    unsigned long calls, ignored, zeros = 0;
    write_undisturbed(0, &calls);
    for (unsigned long at = 1; at <= calls; at++) {
        put_before(true);
        int result = attempt(0, FILE_FAULT_ZERO, 0, at, &ignored);
        read_contents(&now);
        TEST_ASSERT_TRUE(result ? same(&now, &before) : same(&now, &after));
        zeros += result != 0;
    }
    TEST_ASSERT_EQUAL_UINT64(1, zeros);
}

/* --- Killed --------------------------------------------------------------------------------------------- */

/* Writes in a child process. Returns true if the child was killed. */
static bool write_and_be_killed(unsigned i, enum file_fault fault, unsigned long at)
{
    unsigned long calls;
    int status;
    fflush(NULL);
    pid_t process = fork();
    TEST_ASSERT_GREATER_OR_EQUAL(0, process);
    if (!process) {
        freopen("/dev/null", "w", stdout);
        freopen("/dev/null", "w", stderr);
        _exit(attempt(i, fault, 0, at, &calls) ? 1 : 0);
    }
    TEST_ASSERT_EQUAL_INT(process, waitpid(process, &status, 0));
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
}

static void test_killed_at_each_call_leaves_the_old_file_or_the_new_one(void)
{
    static const enum file_fault faults[] = {FILE_FAULT_KILL, FILE_FAULT_KILLED};
    for (unsigned i = 0; i < WRITERS; i++)
        for (unsigned f = 0; f < 2; f++) {
            unsigned long calls, tried = 0, killed = 0, left = 0;
            if (!write_undisturbed(i, &calls))
                continue;
            for (unsigned long at = 1; at <= calls; at += test_stride_of(3)) {
                put_before(at % 2);
                tried++;
                killed += write_and_be_killed(i, faults[f], at);
                read_contents(&now);
                TEST_ASSERT_TRUE_MESSAGE(same(&now, &before) || is_whole(), writers[i].file);
                left += leftovers(true);
            }
            TEST_ASSERT_GREATER_OR_EQUAL_UINT64_MESSAGE(tried - 1, killed, writers[i].file);
            TEST_ASSERT_GREATER_OR_EQUAL_UINT64_MESSAGE(test_share(2), left, writers[i].file);
        }
}

/* A child process writes two different contents in turn, without end, and is killed at any time. */
static void test_killed_at_any_time_leaves_one_of_two_files(void)
{
    enum { ROUNDS = 40, BYTES = 200000 };
    static char letters[2][BYTES];
    unsigned seen[2] = {0};
    use(0);
    memset(letters[0], 'a', BYTES);
    memset(letters[1], 'b', BYTES);
    TEST_ASSERT_EQUAL_INT(0, file_write(path, letters[0], BYTES, NULL));
    for (unsigned round = 0; round < ROUNDS; round++) {
        pid_t process = fork();
        TEST_ASSERT_GREATER_OR_EQUAL(0, process);
        if (!process)
            for (unsigned i = 1;; i++)
                if (file_write(path, letters[i % 2], BYTES, NULL))
                    _exit(1);
        nanosleep(&(struct timespec){0, 500000 + 37000 * round}, NULL);
        kill(process, SIGKILL);
        waitpid(process, NULL, 0);
        read_contents(&now);
        TEST_ASSERT_EQUAL_UINT64(BYTES, now.bytes);
        unsigned which = now.data[0] == 'b';
        TEST_ASSERT_EQUAL_MEMORY(letters[which], now.data, BYTES);
        seen[which]++;
        leftovers(true);
    }
    TEST_ASSERT_TRUE(seen[0] && seen[1]);
}

/* --- Full ----------------------------------------------------------------------------------------------- */

/* Runs in a child process that mounts a file system of 64 KiB on the folder. */
static int fill_the_disk(void)
{
    static char filling[4096];
    unsigned failures = 0;
    for (unsigned i = 0; i < WRITERS; i++) {
        char filler[160];
        struct error error = {{0}};
        use(i);
        if (file_write(path, "old", 3, &error))
            return 10;
        snprintf(filler, sizeof filler, "%s/filler", folder);
        FILE *file = fopen(filler, "wb");
        while (fwrite(filling, 1, sizeof filling, file) == sizeof filling && !fflush(file))
            ;
        fclose(file);
        int result = writers[i].write(writers[i].line);
        read_contents(&now);
        unlink(filler);
        if (result) {
            failures++;
            if (!strstr(said, "No space left on device") || now.bytes != 3 || memcmp(now.data, "old", 3))
                return 20 + (int)i;
        } else if (now.bytes != 3) {
            return 40 + (int)i;
        }
        unlink(path);
        if (leftovers(false))
            return 60 + (int)i;
    }
    return failures >= WRITERS - 1 ? 0 : 80;
}

static void test_a_disk_that_is_really_full(void)
{
    int status;
    fflush(NULL);
    pid_t process = fork();
    TEST_ASSERT_GREATER_OR_EQUAL(0, process);
    if (!process) {
        if (unshare(CLONE_NEWNS) && unshare(CLONE_NEWUSER | CLONE_NEWNS))
            _exit(1);
        if (mount("none", "/", NULL, MS_REC | MS_PRIVATE, NULL) ||
            mount("tmpfs", folder, "tmpfs", 0, "size=64k"))
            _exit(1);
        _exit(fill_the_disk());
    }
    TEST_ASSERT_EQUAL_INT(process, waitpid(process, &status, 0));
    if (WIFEXITED(status) && WEXITSTATUS(status) == 1)
        TEST_IGNORE_MESSAGE(
            "the system refuses a new file system; RLIMIT_FSIZE in tests/base/file.c tests the same");
    TEST_ASSERT_EQUAL_INT(0, status >> 8);
    TEST_ASSERT_TRUE(WIFEXITED(status));
}

int main(void)
{
    store_off = true; /* what it writes is not what is tested here */
    UNITY_BEGIN();
    RUN_TEST(test_each_call_that_fails_before_the_new_name_is_reported);
    RUN_TEST(test_each_call_that_fails_leaves_the_old_file_or_the_new_one);
    RUN_TEST(test_short_and_interrupted_writes_are_continued);
    RUN_TEST(test_a_write_that_stores_nothing_fails);
    RUN_TEST(test_killed_at_each_call_leaves_the_old_file_or_the_new_one);
    RUN_TEST(test_killed_at_any_time_leaves_one_of_two_files);
    RUN_TEST(test_a_disk_that_is_really_full);
    return UNITY_END();
}
