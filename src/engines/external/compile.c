/* Compiles text to code: a private folder, the compiler as a separate process, the dynamic linker.
 *
 * No file remains: the loaded object is mapped, and its file is deleted. If the process is killed while
 * the compiler runs, its folder TMPDIR/triptych-PROCESS-NUMBER remains. A process holds a lock on its
 * folder, and the lock ends with the process. The first compilation of a process removes the user's
 * folders without a lock. The compiler is started without a shell. It inherits the environment, with TMPDIR
 * as an absolute path, because a relative one can look like an option on its command lines.
 *
 * A process with more rights than its user (setuid, setgid, capabilities: AT_SECURE) starts no compiler. Its
 * environment is the user's, and compilers read dozens of variables. */
#define _GNU_SOURCE /* secure_getenv */
#include "engines/external/external.h"
#include "base/file.h"
#include "base/leftover.h"

#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH_CAPACITY = 4096, LINE_CAPACITY = 256 };

#define FOLDER_NAME "triptych-%u-%u"

enum work_file { WORK_TEXT, WORK_OBJECT, WORK_MESSAGES, WORK_COUNT };

static const char *const file_name[WORK_COUNT] = {"routine.c", "routine.so", "messages"};

struct work {
    char temporary[PATH_CAPACITY]; /* the folder of temporary files, absolute */
    char folder[PATH_CAPACITY + 32];
    char path[WORK_COUNT][PATH_CAPACITY + 48];
    int lock; /* the folder, open */
    int leftover[WORK_COUNT + 1];
};

extern char **environ;

static const char *compiler(void)
{
    const char *name = secure_getenv("TRIPTYCH_CC");
    return name && *name ? name : "cc";
}

static const char no_rights[] =
    "needs to start a C compiler, which a process with more rights than its user (setuid) does not";

const char *external_no_compiler(void)
{
    const char *name = compiler();
    if (getauxval(AT_SECURE))
        return no_rights;
    if (file_is_program(name))
        return NULL;
    return "needs a C compiler at run time: cc, or the program that TRIPTYCH_CC names";
}

/* Tries to map the code of this process as the dynamic linker maps code. If the file cannot be opened, the
 * check passes. */
const char *external_no_loading(void)
{
    static _Thread_local char text[LINE_CAPACITY];
    int file = open("/proc/self/exe", O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return NULL;
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    void *code = mmap(NULL, page, PROT_READ | PROT_EXEC, MAP_PRIVATE, file, 0);
    int number = errno;
    close(file);
    if (code == MAP_FAILED) {
        snprintf(text, sizeof text, "needs to load code; cannot map a file executable: %s", strerror(number));
        return text;
    }
    munmap(code, page);
    return NULL;
}

/* Absolute, or as the environment has it if it does not exist. */
static void find_temporary_folder(char folder[static PATH_CAPACITY])
{
    const char *given = secure_getenv("TMPDIR");
    given = given && *given ? given : "/tmp";
    if (!realpath(given, folder))
        snprintf(folder, PATH_CAPACITY, "%s", given);
}

static void name_files(struct work *work)
{
    for (int i = 0; i < WORK_COUNT; i++)
        snprintf(work->path[i], sizeof work->path[i], "%s/%s", work->folder, file_name[i]);
}

/* Locks the folder. Returns false if another process that removes old folders has deleted it. */
static bool lock_work(struct work *work)
{
    struct stat status;
    work->lock = open(work->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
    if (work->lock < 0)
        return false;
    if (!flock(work->lock, LOCK_EX | LOCK_NB) && !fstat(work->lock, &status) && status.st_nlink)
        return true;
    close(work->lock);
    return false;
}

static void remove_work(const struct work *work)
{
    for (int i = 0; i < WORK_COUNT; i++)
        unlink(work->path[i]);
    rmdir(work->folder);
    close(work->lock);
}

static void note_work(struct work *work)
{
    for (int i = 0; i < WORK_COUNT; i++)
        work->leftover[i] = leftover_note(work->path[i]);
    work->leftover[WORK_COUNT] = leftover_note(work->folder);
}

static void close_work(const struct work *work)
{
    remove_work(work);
    for (int i = 0; i <= WORK_COUNT; i++)
        leftover_forget(work->leftover[i]);
}

/* Removes the folders of processes that were killed. */
static void remove_stale(struct work *work)
{
    DIR *folder = opendir(work->temporary);
    struct dirent *entry;
    struct stat status;
    unsigned process, number;
    int end;
    while (folder && (entry = readdir(folder))) {
        end = 0;
        if (sscanf(entry->d_name, FOLDER_NAME "%n", &process, &number, &end) < 2 || entry->d_name[end] ||
            snprintf(work->folder, sizeof work->folder, "%s/%s", work->temporary, entry->d_name) >=
                (int)sizeof work->folder ||
            lstat(work->folder, &status) || status.st_uid != geteuid())
            continue;
        name_files(work);
        if (lock_work(work))
            remove_work(work);
    }
    if (folder)
        closedir(folder);
}

static int make_folder(struct work *work, struct error *error)
{
    static atomic_uint serial;
    for (int attempt = 0; attempt < 100; attempt++) {
        snprintf(work->folder, sizeof work->folder, "%s/" FOLDER_NAME, work->temporary, (unsigned)getpid(),
                 atomic_fetch_add(&serial, 1));
        name_files(work);
        note_work(work);
        bool made = !mkdir(work->folder, 0700);
        if (made && lock_work(work))
            return 0;
        for (int i = 0; i <= WORK_COUNT; i++)
            leftover_forget(work->leftover[i]);
        if (!made && errno != EEXIST)
            break;
    }
    return error_set(error, "%s: cannot make a folder for the compiler: %s", work->temporary,
                     strerror(errno));
}

static int open_work(struct work *work, struct error *error)
{
    static atomic_flag cleaned = ATOMIC_FLAG_INIT;
    find_temporary_folder(work->temporary);
    if (!atomic_flag_test_and_set(&cleaned))
        remove_stale(work);
    return make_folder(work, error);
}

static int write_text(const struct work *work, const char *text, size_t bytes, struct error *error)
{
    const char *path = work->path[WORK_TEXT];
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0)
        return error_set(error, "%s: %s", path, strerror(errno));
    int result = file_put(file, text, bytes), number = errno;
    if (close(file) && !result) {
        result = -1;
        number = errno;
    }
    return result ? error_set(error, "%s: %s", path, strerror(number)) : 0;
}

/* The environment with another TMPDIR, an entry of the caller. Free the result; null: memory is refused. */
static char **make_environment(char *temporary)
{
    size_t count = 0;
    while (environ[count])
        count++;
    char **made = malloc((count + 2) * sizeof *made), **at = made;
    if (!made)
        return NULL;
    for (char **entry = environ; *entry; entry++)
        if (strncmp(*entry, "TMPDIR=", 7))
            *at++ = *entry;
    *at++ = temporary;
    *at = NULL;
    return made;
}

/* Starts the compiler with empty input, discarded output, messages in a file, and default signals. */
static int spawn_in(const struct work *work, char *const arguments[], char *const environment[],
                    pid_t *process)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    int result = posix_spawn_file_actions_init(&files);
    if (result)
        return result;
    result = posix_spawnattr_init(&attributes);
    if (result) {
        posix_spawn_file_actions_destroy(&files);
        return result;
    }
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    result = posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (!result)
        result = posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (!result)
        result = posix_spawn_file_actions_addopen(&files, STDERR_FILENO, work->path[WORK_MESSAGES],
                                                  O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (!result)
        result = posix_spawnp(process, arguments[0], &files, &attributes, arguments, environment);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return result;
}

static int spawn(const struct work *work, char *const arguments[], pid_t *process)
{
    char temporary[PATH_CAPACITY + 16];
    snprintf(temporary, sizeof temporary, "TMPDIR=%s", work->temporary);
    char **environment = make_environment(temporary);
    int result = environment ? spawn_in(work, arguments, environment, process) : ENOMEM;
    free(environment);
    return result;
}

/* Reads the first message with the word "error", else the first line. */
static void read_message(const struct work *work, char line[static LINE_CAPACITY])
{
    FILE *messages = fopen(work->path[WORK_MESSAGES], "re");
    char next[LINE_CAPACITY];
    line[0] = '\0';
    while (messages && fgets(next, sizeof next, messages)) {
        next[strcspn(next, "\r\n")] = '\0';
        bool is_error = strstr(next, "error") != NULL;
        if (is_error || !line[0])
            strcpy(line, next);
        if (is_error)
            break;
    }
    if (messages)
        fclose(messages);
}

static int wait_for(pid_t process, int *status)
{
    while (waitpid(process, status, 0) < 0)
        if (errno != EINTR)
            return -1;
    return 0;
}

/* The flags of the language's own. */
enum { OWN_FLAGS = 3 };
static const char *const own_flags[][OWN_FLAGS] = {
    [EXTERNAL_VECTORS] = {"-std=gnu17", "-fno-strict-aliasing",
                          "-fno-tree-ter"}, /* gcc 12 moves loads past stores to the same place with it */
    [EXTERNAL_PIXELS] = {"-std=gnu17", "-fno-strict-aliasing", "-fno-tree-ter"},
    [EXTERNAL_PLAIN] = {"-std=c11", "-fno-math-errno", "-fno-trapping-math"},
    [EXTERNAL_PORTABLE] = {"-std=c11", "-fno-math-errno", "-fno-trapping-math"},
};

static int run_compiler(const struct external_options *options, const struct work *work, struct error *error)
{
    char level[] = {'-', 'O', options->optimize, 0};
    const char *const *own = own_flags[options->language];
    char *arguments[] = {(char *)compiler(),
                         level,
                         (char *)own[0],
                         (char *)own[1],
                         (char *)own[2],
                         "-mavx2",
                         "-mfma",
                         "-mf16c",
                         "-mno-avx512f", /* even if the compiler's default is this machine */
                         "-ffp-contract=off",
                         "-fno-stack-protector",
                         "-fno-asynchronous-unwind-tables",
                         "-w",
                         "-pipe",
                         "-fPIC",
                         "-shared",
                         "-nostdlib",
                         "-o",
                         (char *)work->path[WORK_OBJECT],
                         (char *)work->path[WORK_TEXT],
                         "-lm", /* plain C calls its functions where the machine has no instruction */
                         NULL};
    pid_t process;
    int status, result = spawn(work, arguments, &process);
    char line[LINE_CAPACITY];
    if (result)
        return error_set(error, "cannot start the compiler %s: %s", arguments[0], strerror(result));
    /* If the application ignores SIGCHLD, the status is not available. Then the object shows whether the
     * compiler succeeded. */
    if (wait_for(process, &status))
        status = access(work->path[WORK_OBJECT], R_OK) ? 0x100 : 0;
    if (!status)
        return 0;
    if (WIFSIGNALED(status))
        return error_set(error, "the compiler %s was ended by signal %d", arguments[0], WTERMSIG(status));
    read_message(work, line);
    return error_set(error, "the compiler %s failed with status %d: %s", arguments[0], WEXITSTATUS(status),
                     line[0] ? line : "no message");
}

void *external_compile(const struct external_options *options, const char *text, size_t bytes,
                       struct error *error)
{
    if (getauxval(AT_SECURE)) {
        error_set(error, "%s", no_rights);
        return NULL;
    }
    struct work *work = malloc(sizeof *work);
    void *object = NULL;
    if (!work || open_work(work, error)) {
        if (!work)
            error_set(error, "out of memory for compiling");
        free(work);
        return NULL;
    }
    if (!write_text(work, text, bytes, error) && !run_compiler(options, work, error)) {
        object = dlopen(work->path[WORK_OBJECT], RTLD_NOW | RTLD_LOCAL);
        if (!object) {
            const char *reason = dlerror();
            error_set(error, "cannot load the compiled object: %s", reason ? reason : "no reason given");
        }
    }
    close_work(work);
    free(work);
    return object;
}
