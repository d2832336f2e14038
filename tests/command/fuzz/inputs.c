/* Runs every fuzz target on every input of its corpus. The corpus has inputs that increased a fuzzer's
 * coverage and inputs of earlier findings. A target ends the program if a check fails, so the input's name is
 * printed before it runs. */
#include "tests/command/fuzz/targets/target.h"

#include <dirent.h>
#include <string.h>
#include <unity.h>

static const struct fuzz_target *target;

void setUp(void)
{
}

void tearDown(void)
{
}

static void run_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    uint8_t *data = NULL;
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    fseek(file, 0, SEEK_END);
    long bytes = ftell(file);
    rewind(file);
    /* Exactly as large as the input, so that the sanitizer finds reads after its end. */
    data = malloc(bytes ? (size_t)bytes : 1);
    TEST_ASSERT_NOT_NULL(data);
    TEST_ASSERT_EQUAL_UINT64(bytes, fread(data, 1, (size_t)bytes, file));
    fclose(file);
    target->run(data, (size_t)bytes);
    free(data);
}

static void survives_its_corpus(void)
{
    char folder[128], path[512];
    unsigned count = 0;
    snprintf(folder, sizeof folder, "tests/data/corpus/%s", target->name);
    DIR *directory = opendir(folder);
    TEST_ASSERT_NOT_NULL_MESSAGE(directory, folder);
    for (struct dirent *entry; (entry = readdir(directory));)
        if (entry->d_name[0] != '.') {
            snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
            fprintf(stderr, "%s\n", path);
            run_file(path);
            count++;
        }
    closedir(directory);
    TEST_ASSERT_TRUE_MESSAGE(count, folder);
}

static void inputs_without_a_byte_do_no_harm(void)
{
    static const uint8_t empty[1];
    for (unsigned i = 0; (target = fuzz_target_at(i)); i++)
        target->run(empty, 0);
}

int main(void)
{
    UNITY_BEGIN();
    for (unsigned i = 0; (target = fuzz_target_at(i)); i++) {
        char name[64];
        snprintf(name, sizeof name, "%s_survives_its_corpus", target->name);
        UnityDefaultTestRun(survives_its_corpus, name, __LINE__);
    }
    RUN_TEST(inputs_without_a_byte_do_no_harm);
    return UNITY_END();
}
