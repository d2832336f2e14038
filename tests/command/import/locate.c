/* Faults in model files that are text: each is found at its place. Texts without a fault have none. */
#include "command/import/locate.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

static struct error error;

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

static void expect_fault(const char *path, const char *text, const char *reason)
{
    char expected[256];
    error_clear(&error);
    snprintf(expected, sizeof expected, "%s:%s", path, reason);
    TEST_ASSERT_TRUE_MESSAGE(locate_fault(path, text, strlen(text), &error), text);
    TEST_ASSERT_EQUAL_STRING(expected, error.text);
}

static void expect_none(const char *path, const char *text)
{
    TEST_ASSERT_FALSE_MESSAGE(locate_fault(path, text, strlen(text), &error), error.text);
    TEST_ASSERT_EQUAL_STRING("", error.text);
}

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

static void faults_of_obj_files_are_found(void)
{
    expect_fault("a.obj", TRIANGLE "f 1 2 9\n",
                 "4:7: found '9', expected the number of a vertex from 1 to 3");
    expect_fault("a.OBJ", TRIANGLE "f 0 2 3\n",
                 "4:3: found '0', expected the number of a vertex from 1 to 3");
    expect_fault("a.obj", TRIANGLE "f -4 2 3\n",
                 "4:3: found '-4', expected the number of a vertex from 1 to 3");
    expect_fault("a.obj", TRIANGLE "f a 2 3\n",
                 "4:3: found 'a', expected the number of a vertex from 1 to 3");
    expect_fault("a.obj", TRIANGLE "vn 0 0 1\nf 1//2 2 3\n",
                 "5:3: found '1//2', expected the number of a normal from 1 to 1");
    expect_fault("a.obj", TRIANGLE "f 1x 2 3\n",
                 "4:3: found '1x', expected numbers and / in the corner of a face");
    expect_fault("a.obj", "# comment\nv 0 zero 0\n", "2:5: found 'zero', expected 3 numbers of a vertex");
    expect_fault("a.obj", "v 0 0\r\n", "1:7: found the end of the line, expected 3 numbers of a vertex");
    expect_fault("a.obj", "vn 0 0", "1:7: found the end of the line, expected 3 numbers of a normal");
}

static void faults_of_ply_files_are_found(void)
{
    static const char head[] = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                               "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    char text[512];
    expect_fault("a.ply", "ply\nformat ascii 1.0\nelement vertex\n",
                 "3:15: found the end of the line, expected element NAME COUNT");
    expect_fault("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty blob x\n",
                 "4:10: found 'blob', expected a type: char, uchar, short, ushort, int, uint, float, double");
    snprintf(text, sizeof text, "%s0\nx\n3 0 1 0\n", head);
    expect_fault("a.ply", text, "9:1: found 'x', expected 1 values");
    snprintf(text, sizeof text, "%s0\n1\n3 0 1\n", head);
    expect_fault("a.ply", text, "10:6: found the end of the line, expected a list of 3 numbers");
    snprintf(text, sizeof text, "%s0", head);
    expect_fault("a.ply", text, "8:2: found the end of the line, expected 1 more rows");
}

static void faults_of_stl_and_gltf_files_are_found(void)
{
    expect_fault("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n",
                 "4:11: found the end of the line, expected 3 numbers of a vertex");
    expect_fault("a.stl", "solid a\nfacet normal 0 0 up\n",
                 "2:18: found 'up', expected 3 numbers of a normal");
    expect_fault("a.stl", "solid a\nfacet vertex 0 0 1\n",
                 "2:7: found 'vertex', expected normal and 3 numbers");
    expect_fault("a.gltf", "{\"asset\": {},\n \"meshes\": [ }\n", "2:14: found '}', expected valid JSON");
    expect_fault("a.gltf", "", "1:1: found the end of the line, expected valid JSON");
}

static void texts_without_a_fault_have_none(void)
{
    expect_none("a.obj",
                TRIANGLE "vt 0\nvn 0 0 1\nf 1/1/1 2//1 3/1 # whole\nf -1 -2 -3\nusemtl x\nf 1 2 \\\n3\n");
    expect_none("a.obj", "");
    expect_none("a.ply",
                "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nend_header\nzzzz");
    expect_none("a.stl", "\x01\x02 binary");
    expect_none("a.gltf", "{\"asset\": {\"version\": \"2.0\"}}");
    expect_none("a.dae", "<COLLADA");
    expect_none("none", "v x");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(faults_of_obj_files_are_found);
    RUN_TEST(faults_of_ply_files_are_found);
    RUN_TEST(faults_of_stl_and_gltf_files_are_found);
    RUN_TEST(texts_without_a_fault_have_none);
    return UNITY_END();
}
