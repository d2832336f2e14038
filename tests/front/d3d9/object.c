/* Counts, interfaces and private data of objects (front/d3d9/object.h), without Windows. */
#include "front/d3d9/object.h"

#include <unity.h>

struct thing {
    struct d3d9_object object;
    int content;
};

static const struct d3d9_guid surface_guid = {
    0x0cfbaf3a, 0x9ff6, 0x429a, {0x99, 0xb3, 0xa2, 0x79, 0x6a, 0xf8, 0xb8, 0x9b}};
static const struct d3d9_guid resource_guid = {
    0x05eec05d, 0x8f7d, 0x4362, {0xb9, 0x99, 0xd1, 0xba, 0xf3, 0x57, 0xc7, 0x04}};
static const struct d3d9_guid unknown_guid = {0, 0, 0, {0xc0, 0, 0, 0, 0, 0, 0, 0x46}};
static const struct d3d9_guid device_ex_guid = {
    0xb18b10ce, 0x2649, 0x405a, {0x87, 0x0f, 0x95, 0xf7, 0x77, 0xd4, 0x31, 0x3a}};
static const struct d3d9_guid tag = {1, 2, 3, {4}}, other_tag = {1, 2, 3, {5}};

static struct d3d9_object *device;
static int destroyed;

static void count_destroyed(struct d3d9_object *object)
{
    (void)object;
    destroyed++;
}

static struct d3d9_object *make(enum d3d9_interface interface)
{
    return d3d9_object_make(sizeof(struct thing), interface, device, count_destroyed);
}

void setUp(void)
{
    device = NULL;
    device = make(D3D9_INTERFACE_DEVICE);
    destroyed = 0;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(device));
}

static void an_object_references_its_parent_while_it_has_references(void)
{
    struct d3d9_object *surface = make(D3D9_INTERFACE_SURFACE);
    TEST_ASSERT_EQUAL_UINT32(2, device->references);
    TEST_ASSERT_EQUAL_UINT32(2, d3d9_object_add_ref(surface));
    TEST_ASSERT_EQUAL_UINT32(2, device->references);
    TEST_ASSERT_EQUAL_UINT32(1, d3d9_object_release(surface));
    TEST_ASSERT_EQUAL_INT(0, destroyed);
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(surface));
    TEST_ASSERT_EQUAL_UINT32(1, device->references);
    TEST_ASSERT_EQUAL_INT(1, destroyed);
}

static void a_held_object_remains_without_references(void)
{
    struct d3d9_object *slot = NULL, *surface = make(D3D9_INTERFACE_SURFACE);
    d3d9_object_exchange(&slot, surface);
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(surface));
    TEST_ASSERT_EQUAL_INT(0, destroyed);
    TEST_ASSERT_EQUAL_UINT32(1, device->references);
    TEST_ASSERT_EQUAL_UINT32(1, d3d9_object_add_ref(surface));
    TEST_ASSERT_EQUAL_UINT32(2, device->references);
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(surface));
    d3d9_object_exchange(&slot, surface);
    TEST_ASSERT_EQUAL_INT(0, destroyed);
    d3d9_object_exchange(&slot, NULL);
    TEST_ASSERT_EQUAL_INT(1, destroyed);
}

static void an_implicit_object_can_be_referenced_again(void)
{
    struct d3d9_object *surface =
        d3d9_object_make_implicit(sizeof(struct thing), D3D9_INTERFACE_SURFACE, device, count_destroyed);
    TEST_ASSERT_EQUAL_UINT32(1, device->references);
    for (int round = 0; round < 2; round++) {
        TEST_ASSERT_EQUAL_UINT32(1, d3d9_object_add_ref(surface));
        TEST_ASSERT_EQUAL_UINT32(2, device->references);
        TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(surface));
        TEST_ASSERT_EQUAL_UINT32(1, device->references);
        TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(surface));
        TEST_ASSERT_EQUAL_UINT32(1, device->references);
    }
    TEST_ASSERT_EQUAL_INT(0, destroyed);
    d3d9_object_drop(surface);
    TEST_ASSERT_EQUAL_INT(1, destroyed);
}

static void a_part_has_the_counts_of_its_owner(void)
{
    struct d3d9_object *texture = make(D3D9_INTERFACE_TEXTURE);
    struct d3d9_object *level = d3d9_object_make_part(sizeof(struct thing), D3D9_INTERFACE_SURFACE, texture);
    TEST_ASSERT_EQUAL_UINT32(2, d3d9_object_add_ref(level));
    TEST_ASSERT_EQUAL_UINT32(2, texture->references);
    TEST_ASSERT_EQUAL_UINT32(1, d3d9_object_release(texture));
    void *container;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_object_query_container(level, &resource_guid, &container));
    TEST_ASSERT_EQUAL_PTR(texture, container);
    d3d9_object_release(container);
    TEST_ASSERT_EQUAL_INT32(D3D9_NO_INTERFACE, d3d9_object_query_container(level, &surface_guid, &container));
    d3d9_object_hold(level);
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_object_release(level));
    TEST_ASSERT_EQUAL_INT(0, destroyed);
    d3d9_object_free_part(level);
    d3d9_object_drop(texture);
    TEST_ASSERT_EQUAL_INT(1, destroyed);
}

static void an_object_answers_to_its_interface_and_to_the_bases(void)
{
    struct d3d9_object *surface = make(D3D9_INTERFACE_SURFACE);
    const struct d3d9_guid *yes[] = {&surface_guid, &resource_guid, &unknown_guid};
    for (unsigned i = 0; i < 3; i++) {
        void *out = NULL;
        TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_object_query_interface(surface, yes[i], &out));
        TEST_ASSERT_EQUAL_PTR(surface, out);
        TEST_ASSERT_EQUAL_UINT32(1, d3d9_object_release(surface));
    }
    void *out = surface;
    TEST_ASSERT_EQUAL_INT32(D3D9_NO_INTERFACE, d3d9_object_query_interface(device, &device_ex_guid, &out));
    TEST_ASSERT_NULL(out);
    TEST_ASSERT_EQUAL_INT32(D3D9_BAD_POINTER, d3d9_object_query_interface(device, &unknown_guid, NULL));
    d3d9_object_release(surface);
}

static void every_interface_extends_unknown_and_has_an_identifier_of_its_own(void)
{
    for (int i = D3D9_INTERFACE_UNKNOWN; i < D3D9_INTERFACE_COUNT; i++) {
        TEST_ASSERT_TRUE(d3d9_object_interface_is(i, D3D9_INTERFACE_UNKNOWN));
        TEST_ASSERT_EQUAL_INT(i == D3D9_INTERFACE_DEVICE || i == D3D9_INTERFACE_DEVICE_EX,
                              d3d9_object_interface_is(i, D3D9_INTERFACE_DEVICE));
    }
    TEST_ASSERT_EQUAL_STRING("IDirect3DSwapChain9Ex",
                             d3d9_object_interface_name(D3D9_INTERFACE_SWAPCHAIN_EX));
}

static void private_data_is_copied_by_identifier(void)
{
    uint32_t data[2] = {7, 8}, out[2] = {0}, bytes = sizeof out;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_object_set_private_data(device, &tag, data, sizeof data, 0));
    data[0] = 0;
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_FOUND, d3d9_object_get_private_data(device, &other_tag, out, &bytes));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_object_get_private_data(device, &tag, out, &bytes));
    TEST_ASSERT_EQUAL_UINT32(7, out[0]);
    bytes = 1;
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_object_get_private_data(device, &tag, NULL, &bytes));
    TEST_ASSERT_EQUAL_UINT32(8, bytes);
    bytes = 7;
    TEST_ASSERT_EQUAL_INT32(D3D9_MORE_DATA, d3d9_object_get_private_data(device, &tag, out, &bytes));
    TEST_ASSERT_EQUAL_UINT32(8, bytes);
    TEST_ASSERT_FALSE(d3d9_object_private_data_is_interface(device, &tag));
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_object_free_private_data(device, &tag));
    TEST_ASSERT_EQUAL_INT32(D3D9_NOT_FOUND, d3d9_object_free_private_data(device, &tag));
    TEST_ASSERT_EQUAL_UINT32(0, d3d9_foreign_take(&(uint64_t){0}, 1));
}

static void interfaces_in_private_data_are_returned_when_they_are_replaced_or_freed(void)
{
    int interfaces[3];
    uint64_t taken[3];
    struct d3d9_object *surface = make(D3D9_INTERFACE_SURFACE);
    int32_t bad = d3d9_object_set_private_data(surface, &tag, &interfaces[0], 4, D3D9_PRIVATE_INTERFACE);
    TEST_ASSERT_EQUAL_INT32(D3D9_INVALID_CALL, bad);
    for (int i = 0; i < 3; i++)
        d3d9_object_set_private_data(surface, i ? &tag : &other_tag, &(uint64_t){(uintptr_t)&interfaces[i]},
                                     8, D3D9_PRIVATE_INTERFACE);
    TEST_ASSERT_TRUE(d3d9_object_private_data_is_interface(surface, &tag));
    TEST_ASSERT_EQUAL_UINT32(1, d3d9_foreign_take(taken, 3));
    TEST_ASSERT_EQUAL_UINT64((uintptr_t)&interfaces[1], taken[0]);
    d3d9_object_release(surface);
    TEST_ASSERT_EQUAL_UINT32(1, d3d9_foreign_take(taken, 1));
    TEST_ASSERT_EQUAL_UINT32(1, d3d9_foreign_take(taken + 1, 2));
    TEST_ASSERT_EQUAL_UINT64((uintptr_t)&interfaces[0] + (uintptr_t)&interfaces[2], taken[0] + taken[1]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(an_object_references_its_parent_while_it_has_references);
    RUN_TEST(a_held_object_remains_without_references);
    RUN_TEST(an_implicit_object_can_be_referenced_again);
    RUN_TEST(a_part_has_the_counts_of_its_owner);
    RUN_TEST(an_object_answers_to_its_interface_and_to_the_bases);
    RUN_TEST(every_interface_extends_unknown_and_has_an_identifier_of_its_own);
    RUN_TEST(private_data_is_copied_by_identifier);
    RUN_TEST(interfaces_in_private_data_are_returned_when_they_are_replaced_or_freed);
    return UNITY_END();
}
