/* How much memory the arguments of calls refer to. */
#include "front/d3d9/size.h"

#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void nothing_has_size_0(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, d3d9_size_given(NULL));
    TEST_ASSERT_EQUAL_UINT64(0, d3d9_size_elements(NULL));
    TEST_ASSERT_EQUAL_UINT64(0, d3d9_size_code(NULL));
    TEST_ASSERT_EQUAL_UINT64(0, d3d9_size_region(NULL));
}

static void primitives_have_vertices(void)
{
    static const uint64_t vertices[] = {0, 5, 10, 6, 15, 7, 7, 0};
    for (uint32_t type = 0; type < 8; type++) {
        TEST_ASSERT_EQUAL_UINT64(vertices[type], d3d9_size_primitives(type, 5));
        TEST_ASSERT_EQUAL_UINT64(0, d3d9_size_primitives(type, 0));
    }
    TEST_ASSERT_EQUAL_UINT64(3ull * UINT32_MAX, d3d9_size_primitives(D3D9_SIZE_TRIANGLES, UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT64(2, d3d9_size_index(101));
    TEST_ASSERT_EQUAL_UINT64(4, d3d9_size_index(102));
}

static void a_declaration_ends_at_its_end(void)
{
    struct d3d9_vertex_element elements[80] = {{.stream = 0}, {.stream = 1}, {.stream = 0xff}};
    TEST_ASSERT_EQUAL_UINT64(3, d3d9_size_elements(elements));
    elements[2].stream = 0;
    TEST_ASSERT_EQUAL_UINT64(D3D9_SIZE_ELEMENTS, d3d9_size_elements(elements));
}

static void code_ends_at_its_end(void)
{
    static const uint32_t plain[] = {0xfffe0101, 0x0000ffff};
    static const uint32_t comment[] = {0xffff0101, 0x0002fffe, 0x0000ffff, 0x0000ffff, 0x0000ffff, 7};
    static const uint32_t integer[] = {0xfffe0200, 0x05000030, 0xf00f0000, 0x0000ffff, 0, 0, 0, 0x0000ffff};
    TEST_ASSERT_EQUAL_UINT64(2, d3d9_size_code(plain));
    TEST_ASSERT_EQUAL_UINT64(5, d3d9_size_code(comment));
    TEST_ASSERT_EQUAL_UINT64(8, d3d9_size_code(integer));
}

static void a_region_has_its_rectangles(void)
{
    struct d3d9_region region = {.count = 3};
    TEST_ASSERT_EQUAL_UINT64(32 + 3 * 16, d3d9_size_region(&region));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(nothing_has_size_0);
    RUN_TEST(primitives_have_vertices);
    RUN_TEST(a_declaration_ends_at_its_end);
    RUN_TEST(code_ends_at_its_end);
    RUN_TEST(a_region_has_its_rectangles);
    return UNITY_END();
}
