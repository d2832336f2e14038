/* Refuses each memory request of a command once: while it reads, draws, compares and reports.
 *
 * Each command line first runs undisturbed. Then it runs with its n-th request refused, for n = 1, 2, 3 ...,
 * and with the n-th and all later requests refused. There are two correct ends: the result of the undisturbed
 * run; or status 2 with one line that reports the lack of memory and with an unchanged output file. A run
 * must not leak memory or leave a file open. Only the first of the requests with the same five callers is
 * refused, unless TRIPTYCH_SOAK is set. */
#define _GNU_SOURCE
#include "tests/support/system/fault.h"
#include "tests/support/system/seed.h"

#include "base/file.h"
#include "command/import/assimp.h"
#include "command/store/store.h"
#include "command/tool/command_line.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>
#include <unity.h>
#include <xxhash.h>

enum { ARGUMENTS = 16, SEEN = 1 << 14, OUTPUT = 1 << 20, CALLERS = 5 };

static char folder[] = "/dev/shm/triptych-fault-XXXXXX"; /* in memory, because disks are slow */
static char output[128], container[128];
static bool soak;
static unsigned long runs;

/* --- Time ----------------------------------------------------------------------------------------------- */

/* Replaces the clock, so that a measurement ends after a number of calls instead of half a second. */
int clock_gettime(clockid_t clock, struct timespec *time)
{
    static _Atomic uint64_t ns;
    uint64_t now = clock == CLOCK_MONOTONIC ? atomic_fetch_add(&ns, 20000000) : 1700000000000000000u;
    *time = (struct timespec){(time_t)(now / 1000000000u), (long)(now % 1000000000u)};
    return 0;
}

time_t time(time_t *seconds)
{
    return seconds ? *seconds = 1700000000 : 1700000000;
}

/* --- A run ---------------------------------------------------------------------------------------------- */

struct outcome {
    int status;
    size_t said, complained, written; /* bytes */
    char out[OUTPUT], error[4096], file[OUTPUT];
};

static struct outcome expected, got;
static int out_file, error_file;

static size_t take(int descriptor, char *text, size_t size)
{
    ssize_t bytes = pread(descriptor, text, size - 1, 0);
    TEST_ASSERT_TRUE(bytes >= 0 && (size_t)bytes < size - 1);
    text[bytes] = 0;
    TEST_ASSERT_EQUAL_INT(0, ftruncate(descriptor, 0));
    lseek(descriptor, 0, SEEK_SET);
    return (size_t)bytes;
}

static size_t read_output(char *text, size_t size)
{
    int descriptor = open(output, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return *text = 0, SIZE_MAX;
    ssize_t bytes = read(descriptor, text, size - 1);
    close(descriptor);
    TEST_ASSERT_TRUE(bytes >= 0 && (size_t)bytes < size - 1);
    text[bytes] = 0;
    return (size_t)bytes;
}

/* Runs the words of a command line; OUT is replaced by the path of the output file. */
static void run(const char *line, struct outcome *outcome, unsigned long at, bool onwards)
{
    char words[1024], *arguments[ARGUMENTS] = {"triptych"};
    static char out_name[160];
    int count = 1;
    unlink(output); /* of the run before, which may have another name */
    snprintf(words, sizeof words, "%s", line);
    for (char *word = strtok(words, " "); word; word = strtok(NULL, " ")) {
        TEST_ASSERT_LESS_THAN(ARGUMENTS, count);
        arguments[count++] = word;
        if (!strncmp(word, "OUT", 3)) {
            snprintf(output, sizeof output, "%s/output%s", folder, word + 3);
            snprintf(out_name, sizeof out_name, "%s", output);
            arguments[count - 1] = out_name;
        }
    }
    fflush(NULL);
    int saved[2] = {dup(STDOUT_FILENO), dup(STDERR_FILENO)};
    dup2(out_file, STDOUT_FILENO);
    dup2(error_file, STDERR_FILENO);
    fault_arm(at, onwards);
    outcome->status = command_line_run(count, arguments);
    fault_disarm();
    fflush(NULL);
    dup2(saved[0], STDOUT_FILENO);
    dup2(saved[1], STDERR_FILENO);
    close(saved[0]);
    close(saved[1]);
    outcome->said = take(out_file, outcome->out, sizeof outcome->out);
    outcome->complained = take(error_file, outcome->error, sizeof outcome->error);
    outcome->written = read_output(outcome->file, sizeof outcome->file);
    runs++;
}

/* --- Choice of requests --------------------------------------------------------------------------------- */

/* In memory that forks share. A child process continues to count requests from its parent's number. */
static struct {
    uint64_t stack[SEEN];
    unsigned long chosen[SEEN]; /* the requests of a run to refuse */
    unsigned choices;
} * seen;

static bool is_new(uint64_t stack)
{
    unsigned at = (unsigned)stack & (SEEN - 1);
    for (; seen->stack[at]; at = (at + 1) & (SEEN - 1))
        if (seen->stack[at] == stack)
            return false;
    seen->stack[at] = stack;
    return true;
}

static uint64_t hash_of(void *const *frames, int count)
{
    return XXH3_64bits(frames, (size_t)(count < CALLERS ? count : CALLERS) * sizeof *frames) | 1;
}

static uint64_t survey(void *const *frames, int count)
{
    if ((soak || is_new(hash_of(frames, count))) && seen->choices < SEEN)
        seen->chosen[seen->choices++] = fault.count;
    return 0;
}

/* --- Checks of a run ------------------------------------------------------------------------------------ */

static unsigned open_files(void)
{
    unsigned count = 0;
    DIR *files = opendir("/proc/self/fd");
    while (files && readdir(files))
        count++;
    closedir(files);
    return count;
}

static unsigned files_in_folder(void)
{
    unsigned count = 0;
    DIR *files = opendir(folder);
    for (struct dirent *entry; files && (entry = readdir(files));)
        count += entry->d_name[0] != '.';
    closedir(files);
    return count;
}

/* How results are compared. Measurements differ in each run. A container is larger if memory for compression
 * was refused, but has the same contents. A missing record for a debugger is reported in a line. */
enum comparison { EXACT, MEASURES, CONTAINER, DEBUGGING };

static char *expected_text;

/* Returns the container at `output` as text, or null if it cannot be read. */
static char *text_of_container(void)
{
    char path[160], *text = NULL, *arguments[] = {"triptych", "convert", output, path};
    size_t bytes;
    snprintf(path, sizeof path, "%s.text.tri", folder);
    if (!command_line_run(4, arguments))
        file_read(path, OUTPUT, &text, &bytes, NULL);
    unlink(path);
    return text;
}

static bool same_contents(enum comparison comparison)
{
    bool same = got.written == expected.written &&
                (got.written == SIZE_MAX || !memcmp(got.file, expected.file, got.written));
    if (comparison == MEASURES)
        return (got.written == SIZE_MAX) == (expected.written == SIZE_MAX);
    if (comparison != CONTAINER || got.written == SIZE_MAX)
        return same;
    char *text = same ? NULL : text_of_container();
    bool equal = same || (text && expected_text && !strcmp(text, expected_text));
    free(text);
    return equal;
}

static bool same_result(enum comparison comparison)
{
    bool told = comparison == DEBUGGING && strstr(got.error, ": debugging: out of memory for ");
    return got.status == expected.status && (told || got.complained == expected.complained) &&
           (comparison == MEASURES ||
            (got.said == expected.said && !memcmp(got.out, expected.out, got.said))) &&
           same_contents(comparison);
}

/* Returns true if the failure is correct. `elsewhere`: the refused request was made by the process that reads
 * models, and may have ended that process. */
static bool failed_well(enum comparison comparison, bool elsewhere)
{
    const char *end = strchr(got.error, '\n');
    return got.status == 2 && end && (!end[1] || comparison == DEBUGGING) && got.written == SIZE_MAX &&
           (strstr(got.error, "memory") || (elsewhere && strstr(got.error, ": reading it ended ")));
}

static void judge(const char *line, enum comparison comparison, unsigned long at, bool onwards,
                  unsigned files)
{
    char message[2048];
    bool elsewhere = !fault.refused && fault.count < at;
    bool good =
        same_result(comparison) || ((fault.refused || elsewhere) && failed_well(comparison, elsewhere));
    snprintf(message, sizeof message,
             "%s: request %lu%s of %lu: status %d, %zu bytes written (%zu), %zu printed (%zu), %zu of errors "
             "\"%.400s\"",
             line, at, onwards ? " and all later" : "", fault.count, got.status, got.written,
             expected.written, got.said, expected.said, got.complained, got.error);
    TEST_ASSERT_TRUE_MESSAGE(good, message);
    const char *lost = fault_lost();
    if (lost)
        snprintf(message + strlen(message), sizeof message - strlen(message), ": %s", lost);
    TEST_ASSERT_NULL_MESSAGE(lost, message);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(files, open_files(), message);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(got.written != SIZE_MAX, files_in_folder(), message);
}

/* Of seven requests the first is refused by itself and the second with all later ones. With THOROUGH=1 all
 * are, in both ways. Forks take ten times as long with sanitizers. */
static bool is_tried(unsigned i, int onwards)
{
    const unsigned stride = test_stride_of(59);
    if (soak || getenv("THOROUGH"))
        return true;
    return i % (stride > 1 ? stride : 7) == (unsigned)onwards;
}

static void refuse_each(const char *line, enum comparison comparison, int status)
{
    char message[5000];
    seen->choices = 0;
    run(line, &expected, 0, false); /* allocates the memory that the process keeps */
    fault.seen = survey;
    run(line, &expected, 0, false);
    fault.seen = NULL;
    expected_text = comparison == CONTAINER ? text_of_container() : NULL;
    snprintf(message, sizeof message, "%s: %s", line, expected.error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(status, expected.status, message);
    unsigned files = open_files();
    unsigned long count = fault.count;
    for (unsigned i = 0; i < seen->choices; i++)
        for (int onwards = 0; onwards < 2; onwards++) {
            if (!is_tried(i, onwards))
                continue;
            fault_watch();
            run(line, &got, seen->chosen[i], onwards);
            judge(line, comparison, seen->chosen[i], onwards, files);
        }
    free(expected_text);
    if (soak)
        printf("%s: %lu requests\n", line, count);
}

/* --- Tests ---------------------------------------------------------------------------------------------- */

void setUp(void)
{
}

void tearDown(void)
{
    fault_disarm();
    fault.seen = NULL;
    fault.watching = false;
    unsetenv("TRIPTYCH_DEBUG");
    unlink(output);
}

static void test_reading_and_writing_streams(void)
{
    static const char *const streams[] = {
        "tests/data/streams/meshes.tri",          "tests/data/streams/stencil-shadow.tri",
        "tests/data/streams/texture-formats.tri", "tests/data/streams/texture-detail.tri",
        "tests/data/streams/shaders.tri",         "tests/data/streams/vertex-formats.tri",
        "tests/data/streams/texture-cubes.tri",   "tests/data/streams/frames.tri",
        "tests/data/streams/vertex-blend.tri",    "tests/data/streams/texture-volumes.tri",
        "tests/data/streams/queries.tri",         "tests/data/streams/texture-levels.tri",
        "tests/data/scenes/skinning.tri",         "tests/data/scenes/shadow-volume.tri",
        "tests/data/streams/perspective.tri",     "tests/data/scenes/dxt.tri",
    };
    char line[256];
    for (size_t i = 0; i < sizeof streams / sizeof *streams; i++) {
        snprintf(line, sizeof line, "convert %s OUT.tri", streams[i]);
        refuse_each(line, EXACT, 0);
    }
}

/* The same with containers. One has texture files, one has a shader. The test writes them first. */
static void test_containers(void)
{
    static char *const streams[] = {"tests/data/streams/shaders.tri", "tests/data/scenes/cube-map.tri",
                                    "tests/data/streams/render-to-texture.tri"};
    char line[512];
    refuse_each("convert tests/data/streams/meshes.tri OUT.trib", CONTAINER, 0);
    refuse_each("convert tests/data/streams/frames.tri OUT.trib", CONTAINER, 0);
    for (unsigned i = 0; i < 3; i++) {
        char *arguments[] = {"triptych", "convert", streams[i], container};
        TEST_ASSERT_EQUAL_INT(0, command_line_run(4, arguments));
        snprintf(line, sizeof line, "convert %s OUT.tri", container);
        refuse_each(line, EXACT, 0);
    }
    snprintf(line, sizeof line, "convert %s OUT.trib --salvage", container);
    refuse_each(line, CONTAINER, 0);
    snprintf(line, sizeof line, "render %s --engine emulate --out OUT.png", container);
    refuse_each(line, EXACT, 0);
    unlink(container);
}

/* A capture of an application that creates and destroys objects. It is read in pieces. */
static void test_recordings(void)
{
    char line[512],
        *arguments[] = {"triptych", "render", "tests/data/streams/texture-changes.tri", "--engine", "emulate",
                        "--out",    output};
    snprintf(output, sizeof output, "%s/output.png", folder);
    setenv("TRIPTYCH_RECORD", container, 1);
    int status = command_line_run(7, arguments);
    unsetenv("TRIPTYCH_RECORD");
    TEST_ASSERT_EQUAL_INT(0, status);
    snprintf(line, sizeof line, "render %s --engine emulate --out OUT.png", container);
    refuse_each(line, EXACT, 0);
    unlink(container);
}

/* A routine's record for debuggers is left out if its memory is refused. */
static void test_debuggers(void)
{
    setenv("TRIPTYCH_DEBUG", "gdb,unwind", 1);
    refuse_each("render tests/data/streams/odd-target.tri --engine specialize --out OUT.png", DEBUGGING, 0);
    unsetenv("TRIPTYCH_DEBUG");
}

static void test_pictures(void)
{
    refuse_each("render tests/data/streams/queries.tri --engine emulate --out OUT.png", EXACT, 0);
    refuse_each("render tests/data/streams/target-formats.tri --engine specialize --threads 2 --out OUT.exr",
                EXACT, 0);
    refuse_each(
        "render tests/data/scenes/shadow-volume.tri --engine emulate --draws 0-1 --rate 5 --out OUT.apng",
        EXACT, 0);
    refuse_each("render tests/data/streams/primitives.tri --engine emulate --frames 0 --out OUT.y4m", EXACT,
                0);
    refuse_each(
        "render tests/data/streams/primitives.tri --engine emulate --frames all --sheet 2 --out OUT.png",
        EXACT, 0);
    refuse_each("verify tests/data/streams/targets.tri --engines batch --threads 1 --frames 1", EXACT, 0);
    refuse_each("compare tests/data/goldens/queries.png tests/data/goldens/queries.png", EXACT, 0);
    refuse_each("compare tests/data/goldens/stencil-operations.png tests/data/goldens/texture-addressing.png "
                "--difference OUT.png",
                EXACT, 1);
    refuse_each("compare tests/data/goldens/stencil-operations.png tests/data/goldens/texture-addressing.png "
                "--tolerance 255 --json OUT.json",
                EXACT, 0);
    refuse_each("verify tests/data/streams/queries.tri --engines batch --threads 1 --frames 1 --golden "
                "tests/data/goldens --json OUT.json",
                EXACT, 0);
}

static void test_verifying_and_measuring(void)
{
    refuse_each(
        "verify tests/data/streams/queries.tri --engines stitch,batch --threads 1 --frames 1 --json OUT.json",
        EXACT, 0);
    refuse_each(
        "bench tests/data/streams/shaders.tri --engines specialize --repetitions 3 --seconds 0 --frames 1 "
        "--shaders --json OUT.json",
        MEASURES, 0);
    refuse_each(
        "bench tests/data/streams/frames.tri --engines emulate --repetitions 3 --seconds 0 --frames 1 "
        "--csv OUT.csv",
        MEASURES, 0);
    refuse_each(
        "bench tests/data/streams/shaders.tri --builds --engines stitch --repetitions 3 --json OUT.json",
        MEASURES, 0);
    refuse_each(
        "bench --compare tests/data/measurements/before.json tests/data/measurements/after.json --json "
        "OUT.json",
        EXACT, 0);
    refuse_each("bench tests/data/streams/frames.tri --cold --engines emulate --repetitions 3 --frames 1",
                MEASURES, 0);
}

static void test_dumps_lists_and_shaders(void)
{
    refuse_each("dump tests/data/streams/shaders.tri --show all", MEASURES, 0);
    refuse_each("dump tests/data/streams/frames.tri --engine stitch --unit vertex", MEASURES, 0);
    refuse_each("dump tests/data/streams/frames.tri --engine external --show text", EXACT, 0);
    refuse_each(
        "mesh bench/streams/assets/teapot.bez build/assimp/models/OBJ/cube_usemtl.obj --json OUT.json", EXACT,
        0);
    refuse_each(
        "explore tests/data/shading/fractals.tri --engines specialize,stitch-operation --out OUT.html",
        MEASURES, 0);
    refuse_each("explore tests/data/streams/shaders.tri --engines batch --out OUT.html", MEASURES, 0);
    refuse_each("list states --json", EXACT, 0);
    refuse_each("list shaders --markdown", EXACT, 0);
    refuse_each("list formats", EXACT, 0);
    refuse_each("help render --as man", EXACT, 0);
    refuse_each("help --as zsh", EXACT, 0);
    refuse_each("fuzz --print 3", EXACT, 0);
    refuse_each("shader assemble tests/data/shaders/common/color.psa --json", EXACT, 0);
    refuse_each("shader disassemble tests/data/shaders/common/color.psa --out OUT.txt", EXACT, 0);
    refuse_each("shader validate tests/data/shaders/common/color.psa --json", EXACT, 0);
}

static void test_inspection(void)
{
    refuse_each("inspect tests/data/streams/stencil-shadow.tri --pixel 150,110 --overdraw OUT.png", EXACT, 0);
    refuse_each("inspect tests/data/streams/shaders.tri --draw 2 --json OUT.json", EXACT, 0);
}

/* Meshes that are kept and found. */
static void test_the_cache(void)
{
    char cache[64], remove[96];
    snprintf(cache, sizeof cache, "%s-cache", folder);
    snprintf(remove, sizeof remove, "rm -rf %s", cache);
    setenv("XDG_CACHE_HOME", cache, 1);
    store_off = false;
    refuse_each("convert tests/data/streams/meshes.tri OUT.tri", EXACT, 0);
    store_off = true;
    TEST_ASSERT_EQUAL_INT(0, system(remove));
}

/* The library's own requests are not refused, and those of loading it are not made. */
static void load_assimp(void)
{
    TEST_ASSERT_NOT_NULL(assimp_load("Assimp", NULL));
    fault.foreigners = 0;
    dl_iterate_phdr(fault_find_foreign, NULL);
}

int main(void)
{
    soak = getenv("TRIPTYCH_SOAK") != NULL;
    seen = fault_shared(sizeof *seen);
    out_file = memfd_create("out", MFD_CLOEXEC);
    error_file = memfd_create("error", MFD_CLOEXEC);
    UNITY_BEGIN();
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(container, sizeof container, "%s.trib", folder);
    load_assimp();
    store_off = true;
    RUN_TEST(test_reading_and_writing_streams);
    RUN_TEST(test_containers);
    RUN_TEST(test_recordings);
    RUN_TEST(test_debuggers);
    RUN_TEST(test_pictures);
    RUN_TEST(test_verifying_and_measuring);
    RUN_TEST(test_dumps_lists_and_shaders);
    RUN_TEST(test_inspection);
    RUN_TEST(test_the_cache);
    rmdir(folder);
    printf("%lu runs, %lu requests refused at %u places\n", runs, fault.total, fault_sites->count);
    return UNITY_END();
}
