/* gnuplot reads the script from one memory file and writes the picture to another, so no pipe can fill. It
 * runs without the user's settings. Names in the script consist of letters, digits, `_`, `-` and `.`. */
#define _GNU_SOURCE /* memfd_create */
#include "command/bench/chart.h"
#include "base/file.h"
#include "command/support/option.h"
#include "triptych.h"

#include <ctype.h>
#include <errno.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH_CAPACITY = 4096, MESSAGE_CAPACITY = 256, PICTURE_MOST = 64 << 20 };

extern char **environ;

/* --- The script ----------------------------------------------------------------------------------------- */

static const struct terminal {
    const char *extension, *name;
    unsigned font; /* points */
} terminals[] = {{".svg", "svg", 13}, {".png", "pngcairo", 11}};

/* Pixels. The number over a bar is rotated. Up to the largest width, bars are as far apart as its digits are
 * high. */
enum { HEIGHT = 560, WIDTH_LEAST = 1500, WIDTH_MOST = 8000, BAR_WIDTH = 13, MARGIN = 150 };

/* The axis is logarithmic: equal lengths are equal factors. The dashed line is the baseline. */
static const char settings[] = "set style fill solid noborder\n"
                               "set logscale y\n"
                               "set format y '%g'\n"
                               "set grid ytics\n"
                               "set key above center horizontal samplen 1 noenhanced\n"
                               "set border 3\n"
                               "set ytics nomirror\n"
                               "set xtics scale 0 nomirror noenhanced rotate by 30 right\n"
                               "set arrow from graph 0, first 1 to graph 1, first 1 nohead dashtype 2\n";

/* From grey, the yardstick, to the colours of the contenders; distinct without colour vision too. */
static const char *const colors[] = {"9a9a9a", "e69f00", "d55e00", "56b4e9", "0072b2", "009e73", "cc79a7",
                                     "000000", "6a3d9a", "8c510a", "f0e442", "44aa99", "882255"};

static void print_name(FILE *out, const char *name)
{
    for (; *name; name++)
        fputc(isalnum((unsigned char)*name) || strchr("-._", *name) ? *name : '_', out);
}

/* Rows of an engine: place, height, ends of the interval. A missing interval is a point. */
static void print_rows(FILE *out, const struct bench *bench, unsigned engine, unsigned count)
{
    fprintf(out, "$run%u << EOD\n", engine);
    for (unsigned i = 0; i < bench->stream_count; i++) {
        const double *value = bench->streams[i].runs[engine].value;
        double low = value[COLUMN_speedup_low], high = value[COLUMN_speedup_high],
               speedup = value[COLUMN_speedup];
        if (speedup > 0)
            fprintf(out, "%g %g %g %g\n", 1 + i + (engine - (count - 1) / 2.0) * 0.8 / count, speedup,
                    low > 0 ? low : speedup, high > 0 ? high : speedup);
    }
    fputs("EOD\n", out);
}

static void print_plot(FILE *out, unsigned engine, const char *name)
{
    const char *color = colors[engine % (sizeof colors / sizeof *colors)];
    fprintf(out, "%s$run%u using 1:2 with boxes linecolor rgb '#%s' title '", engine ? ", \\\n" : "plot ",
            engine, color);
    print_name(out, name);
    fprintf(out,
            "', \\\n$run%u using 1:2:3:4 with yerrorbars pointsize 0 linecolor rgb '#606060' notitle, \\\n"
            "$run%u using 1:4:(sprintf($2 < 10 ? '%%.1f' : '%%.0f', $2)) with labels left rotate by 90 "
            "offset 0, 0.3 "
            "font ',9' notitle",
            engine, engine);
}

static double most_speedup(const struct bench *bench)
{
    double most = 1;
    for (unsigned i = 0; i < bench->stream_count; i++)
        for (unsigned j = 0; j < bench->streams[i].run_count; j++)
            if (bench->streams[i].runs[j].value[COLUMN_speedup] > most)
                most = bench->streams[i].runs[j].value[COLUMN_speedup];
    return most;
}

/* The bars of a stream take eight tenths of its width. */
static void print_terminal(FILE *out, const struct terminal *terminal, unsigned streams, unsigned bars)
{
    unsigned width = MARGIN + streams * bars * BAR_WIDTH * 10 / 8;
    if (width < WIDTH_LEAST)
        width = WIDTH_LEAST;
    if (width > WIDTH_MOST)
        width = WIDTH_MOST;
    fprintf(out, "set terminal %s size %u, %u font 'sans,%u' background 'white'\n", terminal->name, width,
            HEIGHT, terminal->font);
}

static void print_script(FILE *out, const struct bench *bench, const struct terminal *terminal)
{
    const struct bench_stream *first = bench->streams;
    unsigned count = first->run_count;
    for (unsigned j = 0; j < count; j++)
        print_rows(out, bench, j, count);
    print_terminal(out, terminal, bench->stream_count, count);
    fputs(settings, out);
    fprintf(out, "set boxwidth %g\nset yrange [0.5:%g]\nset xrange [0.4:%g]\nset ylabel 'times the speed of ",
            0.8 / count, 1.8 * most_speedup(bench), bench->stream_count + 0.6);
    print_name(out, triptych_engine_name(first->runs[first->baseline].engine));
    fputs("'\n", out);
    for (unsigned i = 0; i < bench->stream_count; i++) {
        fputs(i ? "set xtics add ('" : "set xtics ('", out);
        print_name(out, bench->streams[i].name);
        fprintf(out, "' %u)\n", i + 1);
    }
    for (unsigned j = 0; j < count; j++)
        print_plot(out, j, triptych_engine_name(first->runs[j].engine));
    fputc('\n', out);
}

/* --- gnuplot -------------------------------------------------------------------------------------------- */

/* Starts gnuplot with these files as its standard streams, and default signals. */
static int start(const int files[3], pid_t *process)
{
    char *arguments[] = {"gnuplot", "--default-settings", "-", NULL};
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    int result = posix_spawn_file_actions_init(&actions);
    if (result)
        return result;
    result = posix_spawnattr_init(&attributes);
    if (!result) {
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setsigdefault(&attributes, &all);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        for (int i = 0; i < 3 && !result; i++)
            result = posix_spawn_file_actions_adddup2(&actions, files[i], i);
        if (!result)
            result = posix_spawnp(process, arguments[0], &actions, &attributes, arguments, environ);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&actions);
    return result;
}

/* Returns the exit status of gnuplot, or -1 if it did not run to its end. */
static int run(const int files[3])
{
    pid_t process;
    int status, result = start(files, &process);
    if (result)
        return errno = result, -1;
    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR)
            return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* The file's bytes, which the caller frees; null if memory is short. */
static char *contents(int file, size_t *bytes)
{
    struct stat status;
    *bytes = 0;
    if (fstat(file, &status) || status.st_size > PICTURE_MOST || lseek(file, 0, SEEK_SET))
        return NULL;
    char *data = malloc((size_t)status.st_size + 1);
    for (ssize_t got = 1;
         data && got > 0 && *bytes<(size_t)status.st_size; *bytes += got> 0 ? (size_t)got : 0)
        got = read(file, data + *bytes, (size_t)status.st_size - *bytes);
    if (data)
        data[*bytes] = 0;
    return data;
}

/* Prints the first line of gnuplot's messages that is not empty. */
static int fail_gnuplot(const struct command *self, const char *path, int messages)
{
    size_t bytes;
    char *text = contents(messages, &bytes);
    const char *line = text ? text + strspn(text, " \r\n\t") : "";
    int length = (int)strcspn(line, "\r\n");
    tool_fail(self, "%s: gnuplot cannot draw it: %.*s", path,
              length < MESSAGE_CAPACITY ? length : MESSAGE_CAPACITY, *line ? line : "no reason was given");
    free(text);
    return STATUS_BAD;
}

static int draw(const struct command *self, const struct bench *bench, const char *path, const int files[3])
{
    struct error error = {""};
    size_t length = strlen(path), bytes;
    FILE *script = fdopen(dup(files[0]), "w");
    if (!script)
        return tool_fail(self, "%s: %s", path, strerror(errno));
    print_script(script, bench, &terminals[length > 4 && !strcmp(path + length - 4, terminals[1].extension)]);
    if (fclose(script) || lseek(files[0], 0, SEEK_SET))
        return tool_fail(self, "%s: %s", path, strerror(errno));
    if (run(files))
        return fail_gnuplot(self, path, files[2]);
    char *picture = contents(files[1], &bytes);
    if (!bytes)
        return free(picture), fail_gnuplot(self, path, files[2]);
    int bad = file_write(path, picture, bytes, &error);
    free(picture);
    return bad ? tool_fail(self, "%s", error.text) : STATUS_OK;
}

static int write_one(const struct command *self, const struct bench *bench, const char *path)
{
    static const char *const names[3] = {"script", "picture", "messages"};
    int files[3] = {-1, -1, -1}, status = STATUS_OK;
    for (int i = 0; i < 3 && !status; i++)
        if ((files[i] = memfd_create(names[i], MFD_CLOEXEC)) < 0)
            status = tool_fail(self, "%s: %s", path, strerror(errno));
    if (!status)
        status = draw(self, bench, path, files);
    for (int i = 0; i < 3; i++)
        if (files[i] >= 0)
            close(files[i]);
    return status;
}

int chart_check(const struct command *self, const char *paths)
{
    char path[PATH_CAPACITY];
    if (!paths)
        return STATUS_OK;
    for (const char *rest = paths; (rest = option_next_item(rest, path, sizeof path));) {
        size_t length = strlen(path);
        if (length < 5 || (strcmp(path + length - 4, terminals[0].extension) &&
                           strcmp(path + length - 4, terminals[1].extension)))
            return tool_fail(self, "--chart is \"%s\", expected files whose names end with .svg or .png",
                             paths);
        if (tool_check_output(self, path))
            return STATUS_BAD;
    }
    if (getauxval(AT_SECURE))
        return tool_fail(self,
                         "--chart runs gnuplot, which is refused with rights that the user does not have");
    if (!file_is_program("gnuplot"))
        return tool_fail(self,
                         "--chart needs gnuplot, which is not in PATH (Debian: apt-get install gnuplot-nox)");
    return STATUS_OK;
}

int chart_write(const struct command *self, const struct bench *bench, const char *paths)
{
    char path[PATH_CAPACITY];
    int status = STATUS_OK;
    if (!paths || !bench->stream_count)
        return STATUS_OK;
    for (const char *rest = paths; !status && (rest = option_next_item(rest, path, sizeof path));)
        status = write_one(self, bench, path);
    return status;
}
