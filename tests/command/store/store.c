/* The cache (command/store/store.h): entries are found again or cost time, whatever happens to the folder. */
#define _GNU_SOURCE
#include "command/store/store.h"

#include "base/file.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

static char base[64], folder[STORE_PATH];

void setUp(void)
{
    strcpy(base, "/tmp/triptych-store.XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(base));
    setenv("XDG_CACHE_HOME", base, 1);
    store_off = false;
    TEST_ASSERT_TRUE(store_folder(folder));
}

void tearDown(void)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf %s", base);
    TEST_ASSERT_EQUAL_INT(0, system(command));
}

static struct digest key_of(const char *name)
{
    return digest_of(name, strlen(name));
}

static void keep(const char *name, const char *data)
{
    struct digest key = key_of(name);
    store_keep(&key, data, strlen(data));
}

/* Returns true if the entry is found with the data; fails if it is found with others. */
static bool has(const char *name, const char *data)
{
    struct digest key = key_of(name);
    struct store_entry entry;
    if (!store_find(&key, &entry))
        return false;
    TEST_ASSERT_EQUAL_UINT64(strlen(data), entry.bytes);
    TEST_ASSERT_TRUE(!memcmp(data, entry.data, entry.bytes));
    free(entry.file);
    return true;
}

static void path_of(const char *name, char path[static 2 * STORE_PATH])
{
    struct digest key = key_of(name);
    int length = sprintf(path, "%s/", folder);
    for (int i = 0; i < DIGEST_BYTES; i++)
        length += sprintf(path + length, "%02x", key.byte[i]);
}

static unsigned files_in_folder(void)
{
    unsigned count = 0;
    DIR *files = opendir(folder);
    for (struct dirent *entry; files && (entry = readdir(files));)
        count += entry->d_name[0] != '.';
    if (files)
        closedir(files);
    return count;
}

static void what_is_kept_is_found(void)
{
    TEST_ASSERT_FALSE(has("a", "data"));
    keep("a", "data");
    keep("b", "");
    TEST_ASSERT_TRUE(has("a", "data"));
    TEST_ASSERT_TRUE(has("b", ""));
    TEST_ASSERT_FALSE(has("c", "data"));
    keep("a", "newer");
    TEST_ASSERT_TRUE(has("a", "newer"));
    TEST_ASSERT_EQUAL_UINT(2, files_in_folder());
}

static void keys_depend_on_the_kind(void)
{
    struct digest_state a, b;
    TEST_ASSERT_TRUE(store_begin_key(&a, "mesh"));
    TEST_ASSERT_TRUE(store_begin_key(&b, "mess"));
    struct digest x = digest_end(&a), y = digest_end(&b);
    TEST_ASSERT_TRUE(memcmp(&x, &y, sizeof x) != 0);
}

static void every_damaged_byte_and_every_cut_is_found_and_the_entry_removed(void)
{
    char path[2 * STORE_PATH], *data, *damaged;
    size_t bytes;
    path_of("a", path);
    keep("a", "data");
    TEST_ASSERT_EQUAL_INT(0, file_read(path, 1 << 16, &data, &bytes, NULL));
    damaged = malloc(bytes + 1);
    for (size_t i = 0; i < bytes; i++) {
        memcpy(damaged, data, bytes);
        damaged[i] ^= 0x10;
        TEST_ASSERT_EQUAL_INT(0, file_write(path, damaged, bytes, NULL));
        TEST_ASSERT_FALSE(has("a", "data"));
        TEST_ASSERT_EQUAL_INT(-1, access(path, F_OK));
        TEST_ASSERT_EQUAL_INT(0, file_write(path, data, i, NULL));
        TEST_ASSERT_FALSE(has("a", "data"));
    }
    memcpy(damaged, data, bytes);
    TEST_ASSERT_EQUAL_INT(0, file_write(path, damaged, bytes + 1, NULL));
    TEST_ASSERT_FALSE(has("a", "data"));
    free(damaged);
    free(data);
}

static void an_entry_under_another_name_is_not_that_of_the_name(void)
{
    char a[2 * STORE_PATH], b[2 * STORE_PATH];
    path_of("a", a);
    path_of("b", b);
    keep("a", "data");
    TEST_ASSERT_EQUAL_INT(0, rename(a, b));
    TEST_ASSERT_FALSE(has("b", "data"));
}

static void files_of_other_kinds_are_not_entries(void)
{
    char a[2 * STORE_PATH], b[2 * STORE_PATH];
    path_of("a", a);
    path_of("b", b);
    keep("a", "data");
    TEST_ASSERT_EQUAL_INT(0, symlink(a, b));
    TEST_ASSERT_FALSE(has("b", "data"));
    unlink(b);
    TEST_ASSERT_EQUAL_INT(0, mkfifo(b, 0600)); /* reading would wait forever */
    TEST_ASSERT_FALSE(has("b", "data"));
    unlink(b);
    TEST_ASSERT_EQUAL_INT(0, mkdir(b, 0700));
    TEST_ASSERT_FALSE(has("b", "data"));
    keep("b", "data");
    TEST_ASSERT_FALSE(has("b", "data"));
}

static void a_folder_of_others_is_not_used(void)
{
    keep("a", "data");
    TEST_ASSERT_EQUAL_INT(0, chmod(folder, 0777));
    TEST_ASSERT_FALSE(has("a", "data"));
    keep("b", "data");
    TEST_ASSERT_EQUAL_UINT(1, files_in_folder());
    TEST_ASSERT_EQUAL_INT(0, chmod(folder, 0700));
    if (geteuid() == 0) {
        TEST_ASSERT_EQUAL_INT(0, chown(folder, 1, (gid_t)-1));
        TEST_ASSERT_FALSE(has("a", "data"));
        TEST_ASSERT_EQUAL_INT(0, chown(folder, 0, (gid_t)-1));
    }
    TEST_ASSERT_TRUE(has("a", "data"));
}

static void without_a_folder_nothing_is_kept(void)
{
    char path[128];
    snprintf(path, sizeof path, "%s/file", base);
    TEST_ASSERT_EQUAL_INT(0, file_write(path, "", 0, NULL));
    setenv("XDG_CACHE_HOME", strcat(path, "/inside"), 1);
    keep("a", "data");
    TEST_ASSERT_FALSE(has("a", "data"));
    setenv("XDG_CACHE_HOME", "/dev/null", 1);
    keep("a", "data");
    TEST_ASSERT_FALSE(has("a", "data"));
}

static void the_folder_follows_the_environment(void)
{
    char expected[128];
    setenv("HOME", base, 1);
    snprintf(expected, sizeof expected, "%s/triptych", base);
    TEST_ASSERT_EQUAL_STRING(expected, folder);
    snprintf(expected, sizeof expected, "%s/.cache/triptych", base);
    setenv("XDG_CACHE_HOME", "relative", 1);
    TEST_ASSERT_TRUE(store_folder(folder));
    TEST_ASSERT_EQUAL_STRING(expected, folder);
    setenv("XDG_CACHE_HOME", "", 1);
    TEST_ASSERT_TRUE(store_folder(folder));
    TEST_ASSERT_EQUAL_STRING(expected, folder);
    unsetenv("XDG_CACHE_HOME");
    keep("a", "data");
    TEST_ASSERT_TRUE(has("a", "data"));
    unsetenv("HOME");
    TEST_ASSERT_FALSE(store_folder(folder));
    TEST_ASSERT_FALSE(has("a", "data"));
}

static void a_disabled_cache_neither_reads_nor_writes(void)
{
    keep("a", "data");
    store_off = true;
    TEST_ASSERT_FALSE(has("a", "data"));
    keep("b", "data");
    store_off = false;
    TEST_ASSERT_TRUE(has("a", "data"));
    TEST_ASSERT_FALSE(has("b", "data"));
}

/* SIGXFSZ would end this process. */
static void a_limit_on_file_sizes_only_loses_the_entry(void)
{
    struct rlimit before, small;
    static char data[10000];
    memset(data, 'x', sizeof data - 1);
    getrlimit(RLIMIT_FSIZE, &before);
    small = before;
    small.rlim_cur = 1000;
    setrlimit(RLIMIT_FSIZE, &small);
    keep("a", data);
    keep("b", "data");
    setrlimit(RLIMIT_FSIZE, &before);
    TEST_ASSERT_FALSE(has("a", data));
    TEST_ASSERT_TRUE(has("b", "data"));
    TEST_ASSERT_EQUAL_UINT(1, files_in_folder());
}

static void set_time(const char *name, time_t seconds)
{
    char path[2 * STORE_PATH];
    struct timespec times[2] = {{seconds, 0}, {seconds, 0}};
    path_of(name, path);
    TEST_ASSERT_EQUAL_INT(0, utimensat(AT_FDCWD, path, times, 0));
}

static void the_entries_longest_without_use_leave_first(void)
{
    char name[2] = "a";
    for (; *name <= 'h'; ++*name) {
        keep(name, "data");
        set_time(name, 1000 + *name);
    }
    TEST_ASSERT_TRUE(has("a", "data")); /* used now */
    store_trim(UINT64_MAX, 8);
    TEST_ASSERT_EQUAL_UINT(8, files_in_folder());
    store_trim(UINT64_MAX, 7);
    TEST_ASSERT_EQUAL_UINT(5, files_in_folder());
    TEST_ASSERT_TRUE(has("a", "data"));
    TEST_ASSERT_FALSE(has("b", "data"));
    TEST_ASSERT_FALSE(has("d", "data"));
    TEST_ASSERT_TRUE(has("e", "data"));
}

static void the_bytes_of_the_folder_are_bounded(void)
{
    static char data[1000];
    memset(data, 'x', sizeof data - 1);
    for (char name[2] = "a"; *name <= 'h'; ++*name)
        keep(name, data);
    store_trim(4000, 100);
    TEST_ASSERT_EQUAL_UINT(2, files_in_folder());
    store_trim(1, 100);
    TEST_ASSERT_EQUAL_UINT(0, files_in_folder());
}

static void an_entry_larger_than_its_bound_is_not_kept(void)
{
    char *data = calloc(1, STORE_ENTRY_BYTES + 2);
    memset(data, 'x', STORE_ENTRY_BYTES + 1);
    keep("a", data);
    TEST_ASSERT_FALSE(has("a", data));
    data[STORE_ENTRY_BYTES] = 0;
    keep("a", data);
    TEST_ASSERT_TRUE(has("a", data));
    free(data);
}

static void what_killed_processes_left_is_removed_after_an_hour(void)
{
    char path[2 * STORE_PATH + 16];
    struct timespec old[2] = {{1000, 0}, {1000, 0}};
    keep("a", "data");
    path_of("a", path);
    strcat(path, ".1-0.new");
    TEST_ASSERT_EQUAL_INT(0, file_write(path, "", 0, NULL));
    keep("b", "data");
    TEST_ASSERT_EQUAL_INT(0, access(path, F_OK));
    TEST_ASSERT_EQUAL_INT(0, utimensat(AT_FDCWD, path, old, 0));
    keep("c", "data");
    TEST_ASSERT_EQUAL_INT(-1, access(path, F_OK));
}

/* Each keeps, finds and trims the same entries. An entry that is found is whole. */
static void use_together(unsigned number)
{
    static char data[5000];
    for (int round = 0; round < 300; round++) {
        char name[2] = {(char)('a' + (round * 7 + (int)number) % 10), 0};
        memset(data, *name, sizeof data - 1);
        if (!has(name, data))
            keep(name, data);
        if (round % 50 == 0)
            store_trim(20000, 5);
    }
}

static void processes_share_the_folder(void)
{
    enum { PROCESSES = 4 };
    pid_t process[PROCESSES];
    for (unsigned i = 0; i < PROCESSES; i++)
        if (!(process[i] = fork())) {
            use_together(i);
            _exit(0);
        }
    for (unsigned i = 0; i < PROCESSES; i++) {
        int status;
        TEST_ASSERT_EQUAL_INT(process[i], waitpid(process[i], &status, 0));
        TEST_ASSERT_EQUAL_INT(0, status);
    }
    TEST_ASSERT_LESS_OR_EQUAL_UINT(10, files_in_folder()); /* and no temporary file */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(what_is_kept_is_found);
    RUN_TEST(keys_depend_on_the_kind);
    RUN_TEST(every_damaged_byte_and_every_cut_is_found_and_the_entry_removed);
    RUN_TEST(an_entry_under_another_name_is_not_that_of_the_name);
    RUN_TEST(files_of_other_kinds_are_not_entries);
    RUN_TEST(a_folder_of_others_is_not_used);
    RUN_TEST(without_a_folder_nothing_is_kept);
    RUN_TEST(the_folder_follows_the_environment);
    RUN_TEST(a_disabled_cache_neither_reads_nor_writes);
    RUN_TEST(a_limit_on_file_sizes_only_loses_the_entry);
    RUN_TEST(the_entries_longest_without_use_leave_first);
    RUN_TEST(the_bytes_of_the_folder_are_bounded);
    RUN_TEST(an_entry_larger_than_its_bound_is_not_kept);
    RUN_TEST(what_killed_processes_left_is_removed_after_an_hour);
    RUN_TEST(processes_share_the_folder);
    return UNITY_END();
}
