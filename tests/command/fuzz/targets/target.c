#define _GNU_SOURCE
#include "tests/command/fuzz/targets/target.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define TARGETS(T)                                                                                           \
    T(bezier)                                                                                                \
    T(bytecode)                                                                                              \
    T(container)                                                                                             \
    T(dds) T(exr) T(gles) T(glsl) T(grammar) T(model) T(png) T(preprocess) T(program) T(recording) T(shader) \
        T(text) T(transfer)

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

/* libFuzzer reads this section as counters of edges. There are few counters, so that reasons with words of
 * the input do not fill corpora. */
enum { NOTES = 256 };
static uint8_t notes[NOTES] __attribute__((section("__libfuzzer_extra_counters")));

void fuzz_note(uint32_t what)
{
    uint8_t *note = &notes[(what * 0x9e3779b1u) >> 24];
    *note += *note < 255;
}

static int is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/* FNV-1a of the words, without those that have digits and what is quoted. */
static uint32_t hash_words(const char *text)
{
    uint32_t hash = 0x811c9dc5;
    while (*text) {
        size_t letters = 0, all;
        while (is_letter(text[letters]))
            letters++;
        for (all = letters; is_letter(text[all]) || (text[all] >= '0' && text[all] <= '9');)
            all++;
        for (size_t i = 0; i < letters && letters == all; i++)
            hash = (hash ^ (uint8_t)text[i]) * 0x01000193;
        const char *quoted = *text == '\'' ? strchr(text + 1, '\'') : NULL;
        text = quoted ? quoted + 1 : text + (all ? all : 1);
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
