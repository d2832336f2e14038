#define _GNU_SOURCE
#include "tests/fuzz/targets/target.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define TARGETS(T)                                                                                           \
    T(bezier) T(bytecode) T(container) T(dds) T(exr) T(model) T(png) T(shader) T(text) T(transfer)

#define DECLARE(name) extern const struct fuzz_target fuzz_##name;
TARGETS(DECLARE)
#undef DECLARE

static const struct fuzz_target *const targets[] = {
#define ROW(name) &fuzz_##name,
    TARGETS(ROW)
#undef ROW
};

enum { COUNT = sizeof targets / sizeof *targets };

const struct fuzz_target *fuzz_target_at(unsigned i)
{
    return i < COUNT ? targets[i] : NULL;
}

const struct fuzz_target *fuzz_target_named(const char *name)
{
    for (int i = 0; i < COUNT; i++)
        if (!strcmp(targets[i]->name, name))
            return targets[i];
    return NULL;
}

/* libFuzzer takes what stands in this section for counters of edges. */
enum { NOTES = 4096 };
static uint8_t notes[NOTES] __attribute__((section("__libfuzzer_extra_counters")));

void fuzz_note(uint32_t what)
{
    uint8_t *note = &notes[(what * 0x9e3779b1u) >> 20];
    *note += *note < 255;
}

/* FNV-1a, without numbers and what is quoted. */
static uint32_t hash_words(const char *text)
{
    uint32_t hash = 0x811c9dc5;
    for (char quote = 0; *text; text++) {
        if (*text == quote)
            quote = 0;
        else if (!quote && *text == '\'')
            quote = *text;
        else if (!quote && (*text < '0' || *text > '9'))
            hash = (hash ^ (uint8_t)*text) * 0x01000193;
    }
    return hash;
}

void expect_refusal(const struct error *error, const char *path)
{
    expect(!strncmp(error->text, path, strlen(path)), "%s", error->text);
    expect(error->text[strlen(path)] == ':', "%s", error->text);
    expect(!strchr(error->text, '\n'), "%s", error->text);
    fuzz_note(hash_words(error->text));
}

void expect_refusal_at(const struct error *error, const char *path)
{
    unsigned line, column;
    expect_refusal(error, path);
    expect(sscanf(error->text + strlen(path), ":%u:%u: ", &line, &column) == 2, "%s", error->text);
}

const char *fuzz_path(const char *ending)
{
    static char path[64];
    snprintf(path, sizeof path, "%s/fuzz-%ld.%s", access("/dev/shm", W_OK) ? "/tmp" : "/dev/shm",
             (long)getpid(), ending);
    return path;
}

const char *fuzz_file(const uint8_t *data, size_t bytes)
{
    static char path[64];
    static int descriptor = -1;
    if (descriptor < 0) {
        descriptor = memfd_create("fuzz", MFD_CLOEXEC);
        snprintf(path, sizeof path, "/proc/self/fd/%d", descriptor);
    }
    expect(descriptor >= 0 && !ftruncate(descriptor, 0) &&
               pwrite(descriptor, data, bytes, 0) == (ssize_t)bytes,
           "a file in memory");
    return path;
}
