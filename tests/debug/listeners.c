/* The registrations with GDB, perf's map and jitdump, read back: names, bytes and lines of every routine.
 * Nothing is registered unless enabled, and a failed registration results in one line, not in a failed draw.
 */
#include "debug/debug.h"
#include "engines/list.h"
#include "tests/support/system/sandbox.h"
#include "tests/support/picture/varied.h"

#include <elf.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <unity.h>

enum { STATES = 12, FILE_CAPACITY = 4 << 20 };

struct jit_code_entry {
    struct jit_code_entry *next_entry, *prev_entry;
    const char *symfile_addr;
    uint64_t symfile_size;
};

extern struct {
    uint32_t version, action_flag;
    struct jit_code_entry *relevant_entry, *first_entry;
} __jit_debug_descriptor;

static char folder[] = "/tmp/triptych-listeners-XXXXXX";
static char map_path[64], dump_path[128];
static struct varied_image expected;
static struct error error;
static char contents[FILE_CAPACITY];

void setUp(void)
{
    memset(&error, 0, sizeof error);
    varied_render(engine_find("emulate"), &(struct device_options){.threads = 1}, 0, STATES, &expected);
}

void tearDown(void)
{
}

static triptych_device *open_device(const char *engine, const struct device_options *options)
{
    triptych_device *device;
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        TRIPTYCH_OK, device_create(engine_named(engine, &error), options, &device, &error), error.text);
    return device;
}

static void draw_all(triptych_device *device)
{
    struct varied_image found;
    varied_begin(device);
    for (unsigned n = 0; n < STATES; n++)
        varied_draw(device, n);
    varied_read(device, &found);
    TEST_ASSERT_EQUAL_MEMORY(&expected, &found, sizeof found);
}

/* The name that a routine of a device must have. */
static void name_of(const struct routine *routine, char name[DEBUG_NAME_CAPACITY])
{
    struct packed_key packed = key_pack(routine->unit, &routine->key);
    snprintf(name, DEBUG_NAME_CAPACITY, "triptych_%s_%u_%s_%016llx", unit_name[routine->unit],
             routine->number, routine->engine->name, (unsigned long long)key_hash(routine->unit, &packed));
    for (char *at = name; *at; at++)
        *at = *at == '-' ? '_' : *at;
}

static size_t read_file(const char *path)
{
    FILE *file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    size_t bytes = fread(contents, 1, sizeof contents - 1, file);
    fclose(file);
    contents[bytes] = 0;
    return bytes;
}

/* --- GDB ----------------------------------------------------------------------------------------------- */

static unsigned count_entries(void)
{
    unsigned count = 0;
    const struct jit_code_entry *previous = NULL;
    for (const struct jit_code_entry *entry = __jit_debug_descriptor.first_entry; entry;
         entry = entry->next_entry) {
        TEST_ASSERT_EQUAL_PTR(previous, entry->prev_entry);
        previous = entry;
        count++;
    }
    return count;
}

static const Elf64_Shdr *section_of(const char *file, const char *name)
{
    const Elf64_Ehdr *header = (const void *)file;
    const Elf64_Shdr *section = (const void *)(file + header->e_shoff);
    for (int i = 0; i < header->e_shnum; i++)
        if (!strcmp(file + section[header->e_shstrndx].sh_offset + section[i].sh_name, name))
            return section + i;
    TEST_FAIL_MESSAGE(name);
    return NULL;
}

static bool is_file_of(const struct jit_code_entry *entry, const struct routine *routine)
{
    char name[DEBUG_NAME_CAPACITY];
    const char *file = entry->symfile_addr;
    const Elf64_Ehdr *header = (const void *)file;
    name_of(routine, name);
    TEST_ASSERT_EQUAL_MEMORY(ELFMAG, header->e_ident, SELFMAG);
    TEST_ASSERT_EQUAL_UINT64(entry->symfile_size, header->e_shoff + header->e_shnum * sizeof(Elf64_Shdr));
    const Elf64_Sym *symbol =
        (const Elf64_Sym *)(const void *)(file + section_of(file, ".symtab")->sh_offset) + 1;
    if (strcmp(file + section_of(file, ".strtab")->sh_offset + symbol->st_name, name))
        return false;
    TEST_ASSERT_EQUAL_UINT64((uintptr_t)routine->code, symbol->st_value);
    TEST_ASSERT_EQUAL_UINT64(routine->code_bytes - routine->constant_bytes, symbol->st_size);
    TEST_ASSERT_EQUAL_UINT64((uintptr_t)routine->code, section_of(file, ".text")->sh_addr);
    TEST_ASSERT_TRUE(section_of(file, ".debug_line")->sh_size > 100);
    TEST_ASSERT_TRUE(section_of(file, ".debug_frame")->sh_size > 60);
    return true;
}

static bool has_file(const struct routine *routine)
{
    for (const struct jit_code_entry *entry = __jit_debug_descriptor.first_entry; entry;
         entry = entry->next_entry)
        if (is_file_of(entry, routine))
            return true;
    return false;
}

static void gdb_has_a_file_for_each_routine_until_it_is_freed(void)
{
    static const char *const engines[] = {"specialize",   "specialize-1",    "specialize-4",
                                          "specialize-8", "specialize-8x2",  "specialize-16",
                                          "stitch",       "stitch-operation"};
    TEST_ASSERT_EQUAL_UINT(0, count_entries());
    for (size_t e = 0; e < sizeof engines / sizeof *engines; e++) {
        struct routine routine;
        unsigned count = 0;
        if (engine_unavailable(engine_find(engines[e])))
            continue;
        triptych_device *device =
            open_device(engines[e], &(struct device_options){.threads = 1, .debug = "gdb"});
        draw_all(device);
        for (; cache_get(device->cache, count, &routine); count++)
            TEST_ASSERT_TRUE(has_file(&routine));
        TEST_ASSERT_TRUE(count >= STATES);
        TEST_ASSERT_EQUAL_UINT(count, count_entries());
        triptych_device_destroy(device);
        TEST_ASSERT_EQUAL_UINT(0, count_entries());
    }
}

/* Two times the same draws: the second code is built after the first time. */
static void gdb_has_a_file_for_each_second_code(void)
{
    struct routine routine;
    unsigned count = 0, seconds = 0;
    if (engine_unavailable(engine_find("specialize-8")))
        return;
    triptych_device *device =
        open_device("specialize-8:sixteen=1", &(struct device_options){.threads = 1, .debug = "gdb"});
    draw_all(device);
    draw_all(device);
    for (; cache_get(device->cache, count, &routine); count++)
        seconds += routine.second && routine.second->routine;
    TEST_ASSERT_GREATER_THAN(0, seconds);
    TEST_ASSERT_EQUAL_UINT(count + seconds, count_entries());
    triptych_device_destroy(device);
    TEST_ASSERT_EQUAL_UINT(0, count_entries());
}

static void evicted_routines_are_not_in_gdbs_list(void)
{
    triptych_device *device = open_device(
        "specialize", &(struct device_options){.threads = 1, .debug = "gdb,unwind", .cache_bytes = 10000});
    draw_all(device);
    TEST_ASSERT_TRUE(cache_statistics(device->cache).evictions > STATES / 2);
    TEST_ASSERT_EQUAL_UINT(cache_statistics(device->cache).routines, count_entries());
    triptych_device_destroy(device);
}

static void nothing_is_registered_unless_enabled(void)
{
    triptych_device *device = open_device("specialize", &(struct device_options){.threads = 1});
    draw_all(device);
    TEST_ASSERT_EQUAL_UINT(0, count_entries());
    TEST_ASSERT_TRUE(access(map_path, F_OK));
    TEST_ASSERT_TRUE(access(dump_path, F_OK));
    TEST_ASSERT_EQUAL_STRING("", triptych_debug_error(device));
    triptych_device_destroy(device);
}

/* --- perf ---------------------------------------------------------------------------------------------- */

static void check_map(const struct routine *routine)
{
    char name[DEBUG_NAME_CAPACITY], line[DEBUG_NAME_CAPACITY + 64];
    name_of(routine, name);
    snprintf(line, sizeof line, "%zx %x %s\n", (size_t)(uintptr_t)routine->code,
             routine->code_bytes - routine->constant_bytes, name);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(contents, line), line);
}

static uint64_t number(const char *at, size_t bytes)
{
    uint64_t value = 0;
    memcpy(&value, at, bytes);
    return value;
}

/* Entries are in order, inside the code, and name the project's files. */
static void check_lines(const char *record, size_t bytes, const struct routine *routine)
{
    const char *at = record + 32, *end = record + bytes;
    uint64_t last = 0, count = number(record + 24, 8), specification = 0;
    TEST_ASSERT_EQUAL_UINT64((uintptr_t)routine->code, number(record + 16, 8));
    for (uint64_t i = 0; i < count; i++) {
        const char *path = at + 16;
        uint64_t offset = number(at, 8) - (uintptr_t)routine->code;
        TEST_ASSERT_TRUE(offset < routine->code_bytes && (!i || offset > last));
        TEST_ASSERT_TRUE(number(at + 8, 4) > 0 && number(at + 8, 4) < 5000);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, access(path, R_OK), path);
        specification += !strncmp(path, "src/spec/", 9);
        last = offset;
        at = path + strlen(path) + 1;
    }
    TEST_ASSERT_EQUAL_PTR(end, at);
    TEST_ASSERT_TRUE(count > 4 && (specification > 4 || !strcmp(routine->engine->name, "stitch")));
}

static void check_load(const char *record, size_t bytes, const struct routine *routine, uint64_t index)
{
    char name[DEBUG_NAME_CAPACITY];
    uint32_t size = routine->code_bytes - routine->constant_bytes;
    name_of(routine, name);
    TEST_ASSERT_EQUAL_UINT64((uint64_t)getpid(), number(record + 16, 4));
    TEST_ASSERT_EQUAL_UINT64((uintptr_t)routine->code, number(record + 24, 8));
    TEST_ASSERT_EQUAL_UINT64((uintptr_t)routine->code, number(record + 32, 8));
    TEST_ASSERT_EQUAL_UINT64(size, number(record + 40, 8));
    TEST_ASSERT_EQUAL_UINT64(index, number(record + 48, 8));
    TEST_ASSERT_EQUAL_STRING(name, record + 56);
    TEST_ASSERT_EQUAL_UINT64(56 + strlen(name) + 1 + size, bytes);
    TEST_ASSERT_EQUAL_MEMORY(routine->code, record + bytes - size, size);
}

/* Lines and load of each routine in the order of their numbers. */
static void check_dump(const char *dump, size_t bytes, struct cache *cache, uint64_t *index)
{
    struct routine routine;
    size_t at = 0;
    for (size_t i = 0; cache_get(cache, i, &routine); i++) {
        uint64_t lines = number(dump + at + 4, 4), time = number(dump + at + 8, 8);
        TEST_ASSERT_EQUAL_UINT64(2, number(dump + at, 4));
        check_lines(dump + at, lines, &routine);
        at += lines;
        uint64_t load = number(dump + at + 4, 4);
        TEST_ASSERT_EQUAL_UINT64(0, number(dump + at, 4));
        TEST_ASSERT_TRUE(number(dump + at + 8, 8) >= time);
        check_load(dump + at, load, &routine, (*index)++);
        at += load;
    }
    TEST_ASSERT_EQUAL_UINT64(bytes, at);
}

static void check_header(const char *dump)
{
    TEST_ASSERT_EQUAL_MEMORY("DTiJ", dump, 4);
    TEST_ASSERT_EQUAL_UINT64(1, number(dump + 4, 4));
    TEST_ASSERT_EQUAL_UINT64(40, number(dump + 8, 4));
    TEST_ASSERT_EQUAL_UINT64(EM_X86_64, number(dump + 12, 4));
    TEST_ASSERT_EQUAL_UINT64((uint64_t)getpid(), number(dump + 20, 4));
}

/* perf finds the file by this mapping. */
static bool is_mapped_executable(const char *path)
{
    size_t bytes = read_file("/proc/self/maps");
    contents[bytes] = 0;
    const char *at = strstr(contents, path);
    while (at && at > contents && at[-1] != '\n')
        at--;
    return at && strstr(at, " r-xp 00000000 ") && strstr(at, " r-xp 00000000 ") < strchr(at, '\n');
}

static void perf_has_all_routines_of_all_devices(void)
{
    static const char *const engines[] = {"specialize", "stitch", "stitch-operation"};
    uint64_t index = 0;
    size_t known = 40;
    for (size_t e = 0; e < sizeof engines / sizeof *engines; e++) {
        struct routine routine;
        triptych_device *device =
            open_device(engines[e], &(struct device_options){.threads = 1, .debug = "perf,jitdump"});
        draw_all(device);
        TEST_ASSERT_EQUAL_STRING("", triptych_debug_error(device));
        read_file(map_path);
        for (size_t i = 0; cache_get(device->cache, i, &routine); i++)
            check_map(&routine);
        size_t bytes = read_file(dump_path);
        check_header(contents);
        check_dump(contents + known, bytes - known, device->cache, &index);
        known = bytes;
        triptych_device_destroy(device);
    }
    TEST_ASSERT_TRUE(is_mapped_executable(dump_path));
    struct stat status;
    TEST_ASSERT_EQUAL_INT(0, stat(map_path, &status));
    TEST_ASSERT_EQUAL_INT(0600, status.st_mode & 0777);
}

/* --- Failed registrations ------------------------------------------------------------------------------- */

static void check_reason(triptych_device *device, const char *part)
{
    char reason[ERROR_CAPACITY];
    snprintf(reason, sizeof reason, "%s", triptych_debug_error(device));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(reason, part), reason);
    TEST_ASSERT_NULL(strchr(reason, '\n'));
}

static void dump_to_nowhere(const void *unused)
{
    (void)unused;
    setenv("JITDUMPDIR", "/nowhere", 1);
    triptych_device *device =
        open_device("stitch", &(struct device_options){.threads = 1, .debug = "jitdump"});
    check_reason(device, strerror(ENOENT));
    draw_all(device);
    triptych_device_destroy(device);
}

static void map_in_the_way(const void *unused)
{
    char path[64];
    (void)unused;
    snprintf(path, sizeof path, "/tmp/perf-%d.map", (int)getpid());
    TEST_ASSERT_EQUAL_INT(0, mkdir(path, 0700));
    triptych_device *device = open_device("stitch", &(struct device_options){.threads = 1, .debug = "perf"});
    rmdir(path);
    check_reason(device, strerror(EEXIST));
    draw_all(device);
    triptych_device_destroy(device);
}

/* Some routines fit, then the file is full, and ends with a whole record. */
static void full_disk(const void *unused)
{
    char path[128];
    (void)unused;
    signal(SIGXFSZ, SIG_IGN);
    triptych_device *device =
        open_device("stitch", &(struct device_options){.threads = 1, .debug = "jitdump"});
    TEST_ASSERT_EQUAL_STRING("", triptych_debug_error(device));
    setrlimit(RLIMIT_FSIZE, &(struct rlimit){20000, 20000});
    draw_all(device);
    check_reason(device, "later routines are omitted");
    snprintf(path, sizeof path, "%s/jit-%d.dump", folder, (int)getpid());
    size_t bytes = read_file(path), at = 40;
    while (at < bytes)
        at += number(contents + at + 4, 4);
    TEST_ASSERT_TRUE(at == bytes && at > 40);
    triptych_device_destroy(device);
}

/* The marker cannot be mapped, and engines without code run. */
static void no_executable_memory(const void *unused)
{
    (void)unused;
    sandbox_enter(&(struct sandbox){.protection = PROT_EXEC, .error = EACCES});
    triptych_device *device =
        open_device("emulate", &(struct device_options){.threads = 1, .debug = "jitdump"});
    check_reason(device, strerror(EACCES));
    draw_all(device);
    triptych_device_destroy(device);
}

static void a_failed_registration_is_one_line(void)
{
    char path[128];
    sandbox_child(dump_to_nowhere, NULL);
    sandbox_child(map_in_the_way, NULL);
    sandbox_child(full_disk, NULL);
    sandbox_child(no_executable_memory, NULL);
    snprintf(path, sizeof path, "rm -f %s/jit-*.dump", folder);
    TEST_ASSERT_EQUAL_INT(0, system(path));
}

/* --- Enabling --------------------------------------------------------------------------------------------
 */

static void enable_by_environment(const void *unused)
{
    char reason[512];
    triptych_device *device;
    (void)unused;
    setenv("TRIPTYCH_DEBUG", "gdb,nothing", 1);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_device_create(NULL, &device, reason, sizeof reason));
    TEST_ASSERT_EQUAL_STRING("debug is \"nothing\", expected one or more of: gdb, unwind, perf, jitdump",
                             reason);
    setenv("TRIPTYCH_DEBUG", "gdb", 1);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(NULL, &device, reason, sizeof reason));
    draw_all(device);
    TEST_ASSERT_TRUE(count_entries() >= STATES);
    triptych_device_destroy(device);
    const struct triptych_options none = {.debug = ""};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, triptych_device_create(&none, &device, reason, sizeof reason));
    draw_all(device);
    TEST_ASSERT_EQUAL_UINT(0, count_entries());
    triptych_device_destroy(device);
}

static void the_environment_enables_listeners_without_options(void)
{
    sandbox_child(enable_by_environment, NULL);
}

static void every_word_is_accepted_and_no_part_of_one(void)
{
    unsigned listeners;
    static const char *const wrong[] = {"gd", "gdbx", "gdb,,perf", ",gdb", "gdb perf", " gdb"};
    TEST_ASSERT_EQUAL_INT(0, debug_read("unwind,gdb", &listeners, &error));
    TEST_ASSERT_EQUAL_UINT(1u << DEBUG_unwind | 1u << DEBUG_gdb, listeners);
    TEST_ASSERT_EQUAL_INT(0, debug_read("", &listeners, &error));
    TEST_ASSERT_EQUAL_UINT(0, listeners);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        TEST_ASSERT_EQUAL_INT_MESSAGE(-1, debug_read(wrong[i], &listeners, NULL), wrong[i]);
}

int main(void)
{
    unsetenv("TRIPTYCH_DEBUG");
    if (!mkdtemp(folder))
        return 1;
    setenv("JITDUMPDIR", folder, 1);
    snprintf(map_path, sizeof map_path, "/tmp/perf-%d.map", (int)getpid());
    snprintf(dump_path, sizeof dump_path, "%s/jit-%d.dump", folder, (int)getpid());
    UNITY_BEGIN();
    RUN_TEST(nothing_is_registered_unless_enabled);
    RUN_TEST(gdb_has_a_file_for_each_routine_until_it_is_freed);
    RUN_TEST(gdb_has_a_file_for_each_second_code);
    RUN_TEST(evicted_routines_are_not_in_gdbs_list);
    RUN_TEST(a_failed_registration_is_one_line);
    RUN_TEST(the_environment_enables_listeners_without_options);
    RUN_TEST(every_word_is_accepted_and_no_part_of_one);
    RUN_TEST(perf_has_all_routines_of_all_devices);
    unlink(map_path);
    unlink(dump_path);
    rmdir(folder);
    return UNITY_END();
}
