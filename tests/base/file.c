/* Whole files (base/file.h): the size limit, temporary files after failures, a full disk. */
#include "base/file.h"

#include <fcntl.h>
#include <glob.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <unity.h>

static char folder[64], path[128];
static struct error error;

void setUp(void)
{
    strcpy(folder, "/tmp/triptych-file.XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/data", folder);
    error_clear(&error);
}

static size_t files_in_folder(void)
{
    char pattern[128];
    glob_t found;
    snprintf(pattern, sizeof pattern, "%s/*", folder);
    size_t count = glob(pattern, GLOB_NOSORT, NULL, &found) ? 0 : found.gl_pathc;
    if (count)
        globfree(&found);
    return count;
}

void tearDown(void)
{
    unlink(path);
    TEST_ASSERT_EQUAL_INT(0, rmdir(folder));
}

static void expect_contents(const char *expected)
{
    char *data;
    size_t bytes;
    TEST_ASSERT_EQUAL_INT(0, file_read(path, 1 << 20, &data, &bytes, &error));
    TEST_ASSERT_EQUAL_UINT64(strlen(expected), bytes);
    TEST_ASSERT_EQUAL_STRING(expected, data);
    free(data);
}

static void written_bytes_are_read_back(void)
{
    TEST_ASSERT_EQUAL_INT(0, file_write(path, "first", 5, &error));
    expect_contents("first");
    TEST_ASSERT_EQUAL_INT(0, file_write(path, "", 0, &error));
    expect_contents("");
    TEST_ASSERT_EQUAL_UINT64(1, files_in_folder());
}

static void a_file_of_the_limit_is_read_and_one_more_byte_refused(void)
{
    char *data;
    size_t bytes;
    TEST_ASSERT_EQUAL_INT(0, file_write(path, "12345678", 8, &error));
    TEST_ASSERT_EQUAL_INT(0, file_read(path, 8, &data, &bytes, &error));
    free(data);
    TEST_ASSERT_EQUAL_INT(-1, file_read(path, 7, &data, &bytes, &error));
    TEST_ASSERT_NULL(data);
    TEST_ASSERT_NOT_NULL(strstr(error.text, "/data: more than 7 bytes"));
}

static void an_endless_device_stops_at_the_limit(void)
{
    char *data;
    size_t bytes;
    TEST_ASSERT_EQUAL_INT(-1, file_read("/dev/zero", 1 << 20, &data, &bytes, &error));
    TEST_ASSERT_EQUAL_STRING("/dev/zero: more than 1048576 bytes, the largest size that is read", error.text);
}

static void a_missing_file_and_a_folder_give_their_reason(void)
{
    char *data;
    size_t bytes;
    TEST_ASSERT_EQUAL_INT(-1, file_read("/nonexistent/x", 10, &data, &bytes, &error));
    TEST_ASSERT_EQUAL_STRING("/nonexistent/x: cannot open: No such file or directory", error.text);
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, file_read("/tmp", 10, &data, &bytes, &error));
    TEST_ASSERT_EQUAL_STRING("/tmp: cannot read: Is a directory", error.text);
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, file_write("/tmp", "x", 1, &error));
    TEST_ASSERT_EQUAL_STRING("/tmp: is a folder, expected a file to write", error.text);
}

static void an_empty_path_is_refused(void)
{
    char *data;
    size_t bytes;
    struct file_output output;
    TEST_ASSERT_EQUAL_INT(-1, file_read("", 10, &data, &bytes, &error));
    TEST_ASSERT_NULL(data);
    TEST_ASSERT_EQUAL_STRING("\"\": is not a path, expected that of a file", error.text);
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, file_begin(&output, "", &error));
    TEST_ASSERT_EQUAL_STRING("\"\": is not a path, expected that of a file", error.text);
    TEST_ASSERT_EQUAL_UINT64(0, files_in_folder());
}

static void permission_bits_of_an_existing_file_stay(void)
{
    struct stat status;
    TEST_ASSERT_EQUAL_INT(0, file_write(path, "a", 1, &error));
    TEST_ASSERT_EQUAL_INT(0, chmod(path, 0640));
    TEST_ASSERT_EQUAL_INT(0, file_write(path, "b", 1, &error));
    TEST_ASSERT_EQUAL_INT(0, stat(path, &status));
    TEST_ASSERT_EQUAL_INT(0640, status.st_mode & 07777);
}

/* /dev/stdout is such a link: replacing it would damage the machine. */
static void a_link_is_kept_and_its_target_is_replaced(void)
{
    char link[160];
    struct stat status;
    snprintf(link, sizeof link, "%s/link", folder);
    TEST_ASSERT_EQUAL_INT(0, file_write(path, "old", 3, &error));
    TEST_ASSERT_EQUAL_INT(0, symlink("data", link));
    TEST_ASSERT_EQUAL_INT(0, file_write(link, "new", 3, &error));
    TEST_ASSERT_EQUAL_INT(0, lstat(link, &status));
    unlink(link);
    TEST_ASSERT_TRUE(S_ISLNK(status.st_mode));
    expect_contents("new");
    TEST_ASSERT_EQUAL_UINT64(1, files_in_folder());
}

/* A limit on file sizes simulates a full disk: write stores a part, then fails. At the limit the kernel sends
 * SIGXFSZ, which would end this process. */
static void a_write_that_fails_half_way_changes_nothing(void)
{
    struct rlimit before, small;
    sigset_t pending;
    char *data = calloc(1, 1 << 20);
    TEST_ASSERT_NOT_NULL(data);
    TEST_ASSERT_EQUAL_INT(0, file_write(path, "old", 3, &error));
    getrlimit(RLIMIT_FSIZE, &before);
    small = before;
    small.rlim_cur = 1 << 16;
    setrlimit(RLIMIT_FSIZE, &small);
    int result = file_write(path, data, 1 << 20, &error);
    setrlimit(RLIMIT_FSIZE, &before);
    free(data);
    TEST_ASSERT_EQUAL_INT(-1, result);
    TEST_ASSERT_NOT_NULL(strstr(error.text, "/data: cannot write: File too large"));
    sigpending(&pending);
    TEST_ASSERT_FALSE(sigismember(&pending, SIGXFSZ));
    expect_contents("old");
    TEST_ASSERT_EQUAL_UINT64(1, files_in_folder());
}

static void a_full_device_is_reported(void)
{
    TEST_ASSERT_EQUAL_INT(-1, file_write("/dev/full", "x", 1, &error));
    TEST_ASSERT_EQUAL_STRING("/dev/full: cannot write: No space left on device", error.text);
}

static void a_device_is_written_to_and_not_replaced(void)
{
    struct stat status;
    TEST_ASSERT_EQUAL_INT(0, file_write("/dev/null", "x", 1, &error));
    TEST_ASSERT_EQUAL_INT(0, stat("/dev/null", &status));
    TEST_ASSERT_TRUE(S_ISCHR(status.st_mode));
}

static void a_missing_folder_is_reported(void)
{
    TEST_ASSERT_EQUAL_INT(-1, file_write("/nonexistent/x", "x", 1, &error));
    TEST_ASSERT_EQUAL_STRING("/nonexistent/x: cannot write: No such file or directory", error.text);
}

static void programs_are_found_in_the_path_and_by_their_own(void)
{
    char *before = strdup(getenv("PATH"));
    setenv("PATH", "/nonexistent::/bin", 1);
    TEST_ASSERT_TRUE(file_is_program("sh"));
    TEST_ASSERT_TRUE(file_is_program("/bin/sh"));
    TEST_ASSERT_FALSE(file_is_program("/bin/no-such-program"));
    TEST_ASSERT_FALSE(file_is_program("no-such-program"));
    setenv("PATH", "/nonexistent", 1);
    TEST_ASSERT_FALSE(file_is_program("sh"));
    unsetenv("PATH");
    TEST_ASSERT_FALSE(file_is_program("sh"));
    setenv("PATH", before, 1);
    free(before);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(written_bytes_are_read_back);
    RUN_TEST(a_file_of_the_limit_is_read_and_one_more_byte_refused);
    RUN_TEST(an_endless_device_stops_at_the_limit);
    RUN_TEST(a_missing_file_and_a_folder_give_their_reason);
    RUN_TEST(an_empty_path_is_refused);
    RUN_TEST(permission_bits_of_an_existing_file_stay);
    RUN_TEST(a_link_is_kept_and_its_target_is_replaced);
    RUN_TEST(a_write_that_fails_half_way_changes_nothing);
    RUN_TEST(a_full_device_is_reported);
    RUN_TEST(a_device_is_written_to_and_not_replaced);
    RUN_TEST(a_missing_folder_is_reported);
    RUN_TEST(programs_are_found_in_the_path_and_by_their_own);
    return UNITY_END();
}
