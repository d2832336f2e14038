/* Shards: their units, their text, and the environments of launchers. */
#include "command/support/shard.h"

#include <stdlib.h>
#include <unity.h>

static const struct command self = {.name = "test", .summary = "test"};
static struct shard shard;

static const char *const variables[] = {
    "SLURM_ARRAY_TASK_ID",
    "SLURM_ARRAY_TASK_MIN",
    "SLURM_ARRAY_TASK_MAX",
    "SLURM_ARRAY_TASK_COUNT",
    "SLURM_ARRAY_TASK_STEP",
    "OMPI_COMM_WORLD_RANK",
    "OMPI_COMM_WORLD_SIZE",
    "PMI_RANK",
    "PMI_SIZE",
    "PMIX_RANK",
    "PMIX_SIZE",
    "SLURM_PROCID",
    "SLURM_NTASKS",
    "SLURM_STEP_NUM_TASKS",
};

void setUp(void)
{
    for (size_t i = 0; i < sizeof variables / sizeof *variables; i++)
        unsetenv(variables[i]);
}

void tearDown(void)
{
}

static void the_parts_are_the_whole_and_nearly_equal(void)
{
    static const uint64_t alls[] = {0, 1, 3, 40, 97, 200000, 0xffffffff};
    static const unsigned counts[] = {1, 2, 3, 4, 7, 64, 1000};
    for (size_t a = 0; a < sizeof alls / sizeof *alls; a++)
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            uint64_t next = 0, first, count;
            for (unsigned i = 1; i <= counts[c]; i++, next += count) {
                shard_part(&(struct shard){i, counts[c]}, alls[a], &first, &count);
                TEST_ASSERT_EQUAL_UINT64(next, first);
                TEST_ASSERT_TRUE(count == alls[a] / counts[c] || count == alls[a] / counts[c] + 1);
            }
            TEST_ASSERT_EQUAL_UINT64(alls[a], next);
        }
}

static void expect(unsigned index, unsigned count, const char *text)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(STATUS_OK, shard_read(&self, text, &shard), text);
    TEST_ASSERT_EQUAL_UINT(index, shard.index);
    TEST_ASSERT_EQUAL_UINT(count, shard.count);
}

static void expect_refused(const char *text)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(STATUS_BAD, shard_read(&self, text, &shard), text);
}

static void a_pair_is_read_and_others_are_refused(void)
{
    static const char *const wrong[] = {"0/4", "5/4",   "1",    "1/",        "/1", "1/0",
                                        "a/b", "1/4/2", "-1/4", "1/1000001", ""};
    expect(1, 1, "1/1");
    expect(3, 4, "3/4");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        expect_refused(wrong[i]);
}

static void set_array(const char *task, const char *least, const char *most, const char *count,
                      const char *step)
{
    setenv("SLURM_ARRAY_TASK_ID", task, 1);
    setenv("SLURM_ARRAY_TASK_MIN", least, 1);
    setenv("SLURM_ARRAY_TASK_MAX", most, 1);
    setenv("SLURM_ARRAY_TASK_COUNT", count, 1);
    setenv("SLURM_ARRAY_TASK_STEP", step, 1);
}

static void without_the_option_the_environment_is_not_read(void)
{
    set_array("3", "1", "8", "8", "1");
    expect(1, 1, NULL);
}

static void tasks_of_an_array_are_parts(void)
{
    set_array("3", "1", "8", "8", "1");
    expect(3, 8, "auto");
    set_array("0", "0", "7", "8", "1");
    expect(1, 8, "auto");
    set_array("12", "4", "20", "3", "8");
    expect(2, 3, "auto");
}

static void irregular_arrays_are_refused(void)
{
    set_array("5", "1", "7", "3", "1"); /* 1,5,7 */
    expect_refused("auto");
    set_array("9", "1", "8", "8", "1");
    expect_refused("auto");
    set_array("x", "1", "8", "8", "1");
    expect_refused("auto");
}

static void ranks_of_launchers_are_parts(void)
{
    setenv("SLURM_PROCID", "0", 1);
    setenv("SLURM_STEP_NUM_TASKS", "1", 1);
    expect(1, 1, "auto");
    setenv("PMIX_RANK", "2", 1);
    setenv("PMIX_SIZE", "5", 1);
    expect(3, 5, "auto");
    setenv("PMI_RANK", "1", 1);
    setenv("PMI_SIZE", "3", 1);
    expect(2, 3, "auto");
    setenv("OMPI_COMM_WORLD_RANK", "7", 1);
    setenv("OMPI_COMM_WORLD_SIZE", "8", 1);
    expect(8, 8, "auto");
    setenv("OMPI_COMM_WORLD_RANK", "8", 1);
    expect_refused("auto");
}

static void ranks_in_an_array_divide_its_parts(void)
{
    set_array("2", "1", "4", "4", "1");
    setenv("SLURM_PROCID", "1", 1);
    setenv("SLURM_STEP_NUM_TASKS", "3", 1);
    expect(5, 12, "auto");
}

static void the_variables_of_a_batch_script_are_not_those_of_a_launcher(void)
{
    setenv("SLURM_PROCID", "0", 1);
    setenv("SLURM_NTASKS", "4", 1);
    expect_refused("auto");
}

static void nothing_in_the_environment_is_refused(void)
{
    expect_refused("auto");
    setenv("PMIX_RANK", "2", 1); /* without a size */
    expect_refused("auto");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_parts_are_the_whole_and_nearly_equal);
    RUN_TEST(a_pair_is_read_and_others_are_refused);
    RUN_TEST(without_the_option_the_environment_is_not_read);
    RUN_TEST(tasks_of_an_array_are_parts);
    RUN_TEST(irregular_arrays_are_refused);
    RUN_TEST(ranks_of_launchers_are_parts);
    RUN_TEST(ranks_in_an_array_divide_its_parts);
    RUN_TEST(the_variables_of_a_batch_script_are_not_those_of_a_launcher);
    RUN_TEST(nothing_in_the_environment_is_refused);
    return UNITY_END();
}
