/* Kept meshes (command/assets/kept.h): the same as those read again, and only while nothing that determines
 * them has changed. */
#define _GNU_SOURCE
#include "command/assets/kept.h"

#include "base/file.h"
#include "command/assets/asset.h"
#include "command/store/store.h"

#include <dirent.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

enum { PATH = 128 };

static char folder[64];
static unsigned forks;
static struct error error;

static void count_fork(void)
{
    forks++;
}

void setUp(void)
{
    strcpy(folder, "/tmp/triptych-kept.XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    setenv("XDG_CACHE_HOME", folder, 1);
    store_off = false;
    forks = 0;
    error_clear(&error);
}

void tearDown(void)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    TEST_ASSERT_EQUAL_INT(0, system(command));
}

static const char *path_of(const char *name)
{
    static char path[PATH];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_text(const char *name, const char *text)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_write(path_of(name), text, strlen(text), &error), error.text);
}

/* Loads the mesh and returns the number of processes that this has started: 1 if Assimp has read it. */
static unsigned load(struct resource *resource, const char *path, const struct mesh_options *options)
{
    unsigned before = forks;
    *resource = (struct resource){.type = RESOURCE_MESH, .options = *options};
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, mesh_load(resource, path, &error), error.text);
    return forks - before;
}

static unsigned load_and_free(const char *path, const struct mesh_options *options)
{
    struct resource resource;
    unsigned started = load(&resource, path, options);
    asset_free(&resource);
    return started;
}

static void expect_same(const struct resource *a, const struct resource *b)
{
    TEST_ASSERT_EQUAL_MEMORY(&a->layout, &b->layout, sizeof a->layout);
    TEST_ASSERT_EQUAL_UINT(a->index_bits, b->index_bits);
    TEST_ASSERT_EQUAL_UINT64(a->vertex_bytes, b->vertex_bytes);
    TEST_ASSERT_EQUAL_MEMORY(a->vertices, b->vertices, a->vertex_bytes);
    TEST_ASSERT_EQUAL_UINT(a->index_count, b->index_count);
    TEST_ASSERT_EQUAL_MEMORY(a->indices, b->indices, (size_t)a->index_count * a->index_bits / 8);
}

static void expect_same_pose(const struct skeleton *a, const struct skeleton *b)
{
    static double x[SKELETON_BONES][4][4], y[SKELETON_BONES][4][4];
    TEST_ASSERT_EQUAL_UINT(a->bone_count, b->bone_count);
    TEST_ASSERT_EQUAL_UINT(a->animation_count, b->animation_count);
    TEST_ASSERT_EQUAL_INT(0, skeleton_pose(a, 0, 0.3, x));
    TEST_ASSERT_EQUAL_INT(0, skeleton_pose(b, 0, 0.3, y));
    TEST_ASSERT_EQUAL_MEMORY(x, y, a->bone_count * sizeof *x);
}

/* A triangle. */
static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

static const struct mesh_options plain = {.source = MESH_FILE, .fit = 2, .center = true};

static void a_kept_mesh_is_the_same_and_starts_no_process(void)
{
    static const char *const paths[] = {"build/glmark2/models/cat.3ds", "build/glmark2/models/cube.3ds"};
    for (int i = 0; i < 2; i++) {
        struct resource cold, warm, off;
        TEST_ASSERT_EQUAL_UINT(1, load(&cold, paths[i], &plain));
        TEST_ASSERT_EQUAL_UINT(0, load(&warm, paths[i], &plain));
        store_off = true;
        TEST_ASSERT_EQUAL_UINT(1, load(&off, paths[i], &plain));
        store_off = false;
        expect_same(&cold, &warm);
        expect_same(&cold, &off);
        asset_free(&cold);
        asset_free(&warm);
        asset_free(&off);
    }
}

static void a_kept_skeleton_poses_the_same(void)
{
    static const struct mesh_options options = {.source = MESH_FILE, .bones = true, .fit = 2, .center = true};
    struct resource cold, warm;
    TEST_ASSERT_EQUAL_UINT(1, load(&cold, "build/assimp/models/X/Testwuson.X", &options));
    TEST_ASSERT_EQUAL_UINT(0, load(&warm, "build/assimp/models/X/Testwuson.X", &options));
    expect_same(&cold, &warm);
    expect_same_pose(cold.skeleton, warm.skeleton);
    asset_free(&cold);
    asset_free(&warm);
}

static unsigned kept_files(void)
{
    unsigned count = 0;
    DIR *files = opendir(path_of("triptych"));
    for (struct dirent *entry; files && (entry = readdir(files));)
        count += entry->d_name[0] != '.';
    if (files)
        closedir(files);
    return count;
}

static void patches_are_kept_too(void)
{
    static const struct mesh_options options = {.source = MESH_BEZIER, .subdivisions = 3};
    static const char path[] = "bench/streams/assets/teapot.bez";
    struct resource cold, warm;
    load(&cold, path, &options);
    TEST_ASSERT_EQUAL_UINT(1, kept_files());
    load(&warm, path, &options);
    TEST_ASSERT_EQUAL_UINT(1, kept_files());
    expect_same(&cold, &warm);
    asset_free(&cold);
    asset_free(&warm);
}

static void every_option_makes_another_mesh(void)
{
    static const struct mesh_options options[] = {
        {.source = MESH_FILE},
        {.source = MESH_FILE, .normals = NORMALS_FLAT},
        {.source = MESH_FILE, .texcoords = TEXCOORDS_PLANAR},
        {.source = MESH_FILE, .texcoords = TEXCOORDS_PLANAR, .repeat = {2, 1}},
        {.source = MESH_FILE, .texcoords = TEXCOORDS_PLANAR, .repeat = {1, 2}},
        {.source = MESH_FILE, .center = true},
        {.source = MESH_FILE, .fit = 1},
        {.source = MESH_BEZIER, .subdivisions = 1},
        {.source = MESH_BEZIER, .subdivisions = 2},
    };
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        const char *path = options[i].source == MESH_BEZIER ? "bench/streams/assets/teapot.bez"
                                                            : "build/glmark2/models/cube.3ds";
        load_and_free(path, &options[i]);
        TEST_ASSERT_EQUAL_UINT(i + 1, kept_files());
    }
}

static void a_changed_file_is_read_again(void)
{
    write_text("a.obj", triangle);
    TEST_ASSERT_EQUAL_UINT(1, load_and_free(path_of("a.obj"), &plain));
    TEST_ASSERT_EQUAL_UINT(0, load_and_free(path_of("a.obj"), &plain));
    write_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
    TEST_ASSERT_EQUAL_UINT(1, load_and_free(path_of("a.obj"), &plain));
    write_text("a.obj", triangle);
    TEST_ASSERT_EQUAL_UINT(0, load_and_free(path_of("a.obj"), &plain));
}

/* Its ending chooses the reader. */
static void the_name_of_the_file_counts(void)
{
    write_text("a.obj", triangle);
    write_text("b.obj", triangle);
    TEST_ASSERT_EQUAL_UINT(1, load_and_free(path_of("a.obj"), &plain));
    TEST_ASSERT_EQUAL_UINT(1, load_and_free(path_of("b.obj"), &plain));
}

static void a_file_that_the_model_names_counts_if_it_appears_changes_or_is_removed(void)
{
    char text[256];
    snprintf(text, sizeof text, "mtllib a.mtl\n%s", triangle);
    write_text("a.obj", text);
    TEST_ASSERT_EQUAL_UINT(1, load_and_free(path_of("a.obj"), &plain));
    TEST_ASSERT_EQUAL_UINT(0, load_and_free(path_of("a.obj"), &plain));
    write_text("a.mtl", "newmtl red\nKd 1 0 0\n");
    TEST_ASSERT_EQUAL_UINT(1, load_and_free(path_of("a.obj"), &plain));
    TEST_ASSERT_EQUAL_UINT(0, load_and_free(path_of("a.obj"), &plain));
    write_text("a.mtl", "newmtl red\nKd 0 1 0\n");
    TEST_ASSERT_EQUAL_UINT(1, load_and_free(path_of("a.obj"), &plain));
    TEST_ASSERT_EQUAL_UINT(0, load_and_free(path_of("a.obj"), &plain));
    unlink(path_of("a.mtl"));
    TEST_ASSERT_EQUAL_UINT(1, load_and_free(path_of("a.obj"), &plain));
}

/* A triangle whose positions are in another file. */
static const char gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
    "\"min\":[0,0,0],\"max\":[2,2,0]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":36}],"
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"a.bin\"}]}";

static void positions_in_another_file_are_those_of_the_file(void)
{
    static const struct mesh_options options = {.source = MESH_FILE};
    float corner[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    write_text("a.gltf", gltf);
    for (int i = 1; i <= 2; i++) {
        struct resource resource;
        float position[3];
        corner[3] = (float)i;
        TEST_ASSERT_EQUAL_INT(0, file_write(path_of("a.bin"), corner, sizeof corner, &error));
        TEST_ASSERT_EQUAL_UINT(1, load(&resource, path_of("a.gltf"), &options));
        memcpy(position, resource.vertices + resource.layout.stride, sizeof position);
        TEST_ASSERT_EQUAL_FLOAT((float)i, position[0]);
        asset_free(&resource);
    }
    TEST_ASSERT_EQUAL_UINT(0, load_and_free(path_of("a.gltf"), &options));
}

/* Another program could write a file whose head is right, but not its data. */
static void wrong_data_with_the_right_hash_are_refused_and_removed(void)
{
    static const uint8_t wrong[200] = {0x6d, 0x65, 0x73, 0x68};
    char *file, name[600];
    size_t bytes;
    write_text("a.obj", triangle);
    load_and_free(path_of("a.obj"), &plain);
    DIR *files = opendir(path_of("triptych"));
    for (struct dirent *entry; (entry = readdir(files));)
        if (entry->d_name[0] != '.')
            snprintf(name, sizeof name, "%s/triptych/%s", folder, entry->d_name);
    closedir(files);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_read(name, 1 << 20, &file, &bytes, &error), error.text);
    free(file);
    struct digest key;
    const char *text = strrchr(name, '/') + 1;
    for (int i = 0; i < DIGEST_BYTES; i++)
        sscanf(text + 2 * i, "%2hhx", &key.byte[i]);
    store_keep(&key, wrong, sizeof wrong);
    TEST_ASSERT_EQUAL_UINT(1, load_and_free(path_of("a.obj"), &plain));
    TEST_ASSERT_EQUAL_UINT(0, load_and_free(path_of("a.obj"), &plain));
}

static void a_damaged_model_is_not_kept(void)
{
    struct resource resource = {.type = RESOURCE_MESH, .options = plain};
    write_text("a.obj", "v 0 0 0\n");
    TEST_ASSERT_EQUAL_INT(-1, mesh_load(&resource, path_of("a.obj"), &error));
    asset_free(&resource);
    TEST_ASSERT_EQUAL_UINT(0, kept_files());
}

int main(void)
{
    pthread_atfork(count_fork, NULL, NULL);
    UNITY_BEGIN();
    RUN_TEST(a_kept_mesh_is_the_same_and_starts_no_process);
    RUN_TEST(a_kept_skeleton_poses_the_same);
    RUN_TEST(patches_are_kept_too);
    RUN_TEST(every_option_makes_another_mesh);
    RUN_TEST(a_changed_file_is_read_again);
    RUN_TEST(the_name_of_the_file_counts);
    RUN_TEST(a_file_that_the_model_names_counts_if_it_appears_changes_or_is_removed);
    RUN_TEST(positions_in_another_file_are_those_of_the_file);
    RUN_TEST(wrong_data_with_the_right_hash_are_refused_and_removed);
    RUN_TEST(a_damaged_model_is_not_kept);
    return UNITY_END();
}
