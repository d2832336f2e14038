/* A model is the same stream as its mesh, its textures and the calls that draw them. The files are written by
 * the tests. */
#include "base/file.h"
#include "command/import/material.h"
#include "command/stream/stream.h"
#include "image/png.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

static struct error error;
static char folder[64], stream_path[128];

static void path_in(char path[256], const char *name)
{
    snprintf(path, 256, "%s/%s", folder, name);
}

static void write_file(const char *name, const char *text)
{
    char path[256];
    path_in(path, name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_write(path, text, strlen(text), &error), error.text);
}

static void write_picture(const char *name)
{
    static const uint32_t texels[4] = {0xff0000ff, 0xff00ff00, 0xffff0000, 0xffffffff};
    char path[256];
    path_in(path, name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, png_save(path, 2, 2, texels, &error), error.text);
}

static const char object[] = "mtllib house.mtl\n"
                             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\n"
                             "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n"
                             "usemtl wall\nf 1/1 2/2 3/3\n"
                             "usemtl roof\nf 2/1 4/2 3/3\n"
                             "usemtl wall\nf 1/1 2/2 5/3\n"
                             "usemtl door\nf 2/1 6/2 5/3\n";

static const char library[] = "newmtl wall\nKd 0.5 0.25 1\nmap_Kd brick.png\n"
                              "newmtl roof\nKd 1 0 0\nd 0.5\n"
                              "newmtl door\nKd 1 1 1\nmap_Kd ..\\elsewhere\\brick.png\n";

void setUp(void)
{
    error_clear(&error);
    strcpy(folder, "/tmp/triptych-model-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(stream_path, sizeof stream_path, "%s/s.tri", folder);
    setenv("XDG_CACHE_HOME", folder, 1);
    write_file("house.obj", object);
    write_file("house.mtl", library);
    write_picture("brick.png");
}

void tearDown(void)
{
    char line[128];
    snprintf(line, sizeof line, "rm -rf %s", folder);
    TEST_ASSERT_EQUAL_INT(0, system(line));
}

static char *canonical(const char *lines)
{
    char text[2048], *written;
    struct stream *stream;
    size_t bytes;
    int length = snprintf(text, sizeof text, "triptych 1\ntarget 8 8\n%s", lines);
    int result = stream_parse(stream_path, text, (size_t)length, &stream, &error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, result, error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_write(stream, stream_path, &written, &bytes, &error), error.text);
    stream_free(stream);
    return written;
}

static void expect_same(const char *lines, const char *written_out)
{
    char *a = canonical(lines), *b = canonical(written_out);
    TEST_ASSERT_EQUAL_STRING(b, a);
    free(a);
    free(b);
}

static void expect_refusal(const char *lines, const char *place, const char *reason)
{
    char text[2048], expected[256];
    struct stream *stream;
    int length = snprintf(text, sizeof text, "triptych 1\n%s", lines);
    TEST_ASSERT_EQUAL_INT(-1, stream_parse(stream_path, text, (size_t)length, &stream, &error));
    snprintf(expected, sizeof expected, "%s:%s: ", stream_path, place);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(expected, error.text, strlen(expected), error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, reason), error.text);
}

/* The triangles of a material are together, and the path that leads out of the folder is the same file, but
 * another name. */
static void a_model_is_a_mesh_with_textures_and_its_draws(void)
{
    expect_same("model h \"house.obj\" center fit 2\ndraw model h\n",
                "mesh h model \"house.obj\" center fit 2\n"
                "texture h.texture0 file \"brick.png\"\n"
                "texture h.texture1 file \"brick.png\"\n"
                "bind vertices h\nbind indices h\n"
                "material diffuse 0.5 0.25 1 1 ambient 0.5 0.25 1 1\nbind texture h.texture0\n"
                "draw-indexed triangles 0 0 2\n"
                "material diffuse 1 0 0 0.5 ambient 1 0 0 0.5\nbind texture none\n"
                "draw-indexed triangles 0 6 1\n"
                "material diffuse 1 1 1 1 ambient 1 1 1 1\nbind texture h.texture1\n"
                "draw-indexed triangles 0 9 1\n");
}

/* Also the second time, when the mesh comes from the cache. */
static void a_sequence_draws_a_model_without_textures(void)
{
    for (int i = 0; i < 2; i++)
        expect_same("model h untextured \"house.obj\" normals flat\nsequence s\ndraw model h\nend\nplay s\n",
                    "mesh h model \"house.obj\" normals flat\nsequence s\n"
                    "bind vertices h\nbind indices h\n"
                    "material diffuse 0.5 0.25 1 1 ambient 0.5 0.25 1 1\nbind texture none\n"
                    "draw-indexed triangles 0 0 2\n"
                    "material diffuse 1 0 0 0.5 ambient 1 0 0 0.5\nbind texture none\n"
                    "draw-indexed triangles 0 6 1\n"
                    "material ambient 1 1 1 1\nbind texture none\n"
                    "draw-indexed triangles 0 9 1\nend\nplay s\n");
}

static void missing_pictures_and_models_are_refused(void)
{
    char path[256];
    expect_refusal("mesh m model \"house.obj\"\ndraw model m\n", "3:12", "found a mesh without materials");
    error_clear(&error);
    expect_refusal("mesh m box\ndraw model m\n", "3:12", "expected the name of a model");
    error_clear(&error);
    expect_refusal("repeat 2\nmodel h \"house.obj\"\nend\n", "3:1", "found 'model', expected a call");
    error_clear(&error);
    expect_refusal("model a123456789012345678901234567890123456789012345678901234567 \"house.obj\"\n", "2:66",
                   "expected at most 64 bytes");
    path_in(path, "brick.png");
    unlink(path);
    error_clear(&error);
    expect_refusal("model h \"house.obj\"\n", "2:9", "brick.png: cannot open");
}

static void a_fault_in_a_model_has_its_line(void)
{
    write_file("house.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    expect_refusal("model h \"house.obj\"\n", "2:9",
                   "house.obj:4:7: found '4', expected the number of a vertex");
}

static void paths_of_textures_stay_in_the_folder(void)
{
    static const char *const rows[][2] = {
        {"a.png", "a.png"},
        {"./a.png", "a.png"},
        {"b/a.png", "b/a.png"},
        {"b\\a.png", "b/a.png"},
        {"../a.png", "a.png"},
        {"b/../../a.png", "a.png"},
        {"/etc/a.png", "a.png"},
        {"c:\\x\\a.png", "a.png"},
        {"b/..c/a.png", "b/..c/a.png"},
        {"\\\\host\\a.png", "a.png"},
        {"", ""},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *path = material_path(rows[i][0]);
        TEST_ASSERT_EQUAL_STRING(rows[i][1], path);
        free(path);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_model_is_a_mesh_with_textures_and_its_draws);
    RUN_TEST(a_sequence_draws_a_model_without_textures);
    RUN_TEST(missing_pictures_and_models_are_refused);
    RUN_TEST(a_fault_in_a_model_has_its_line);
    RUN_TEST(paths_of_textures_stay_in_the_folder);
    return UNITY_END();
}
