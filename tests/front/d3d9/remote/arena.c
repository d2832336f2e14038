/* The allocator of shared memory (front/d3d9/remote/arena.h): random allocations, against a list of what is
 * in use. */
#include "front/d3d9/remote/arena.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { BYTES = 1 << 20, PIECES = 200, STEPS = 20000 };

static struct d3d9_arena arena;
static uint8_t *memory;

void setUp(void)
{
    memory = aligned_alloc(D3D9_ARENA_UNIT, BYTES);
    memset(memory, 0, BYTES);
    d3d9_arena_create(&arena, memory, BYTES);
}

void tearDown(void)
{
    free(memory);
}

static void what_is_allocated_is_aligned_and_zeros(void)
{
    uint8_t *a = d3d9_arena_allocate(&arena, 1), *b = d3d9_arena_allocate(&arena, 1000);
    TEST_ASSERT_EQUAL_UINT64(0, (uintptr_t)a % D3D9_ARENA_UNIT);
    TEST_ASSERT_EQUAL_UINT64(0, (uintptr_t)b % D3D9_ARENA_UNIT);
    TEST_ASSERT_EACH_EQUAL_UINT8(0, b, 1000);
}

static void all_of_it_can_be_had_again(void)
{
    size_t most = BYTES - D3D9_ARENA_UNIT;
    for (int i = 0; i < 3; i++) {
        void *a = d3d9_arena_allocate(&arena, most);
        TEST_ASSERT_NOT_NULL(a);
        TEST_ASSERT_NULL(d3d9_arena_allocate(&arena, 1));
        d3d9_arena_free(&arena, a);
        TEST_ASSERT_EQUAL_UINT64(0, d3d9_arena_used(&arena));
    }
    TEST_ASSERT_NULL(d3d9_arena_allocate(&arena, most + 1));
    TEST_ASSERT_NULL(d3d9_arena_allocate(&arena, SIZE_MAX));
}

struct piece {
    uint8_t *at;
    size_t bytes;
    uint8_t value;
};

static void release(struct piece *piece)
{
    TEST_ASSERT_EACH_EQUAL_UINT8(piece->value, piece->at, piece->bytes);
    d3d9_arena_free(&arena, piece->at);
    piece->at = NULL;
}

static void acquire(struct piece *piece)
{
    piece->bytes = (size_t)rand() % (rand() % 8 ? 600 : 60000) + 1;
    piece->value = (uint8_t)(rand() % 255 + 1);
    piece->at = d3d9_arena_allocate(&arena, piece->bytes);
    if (!piece->at)
        return;
    TEST_ASSERT_EACH_EQUAL_UINT8(0, piece->at, piece->bytes);
    memset(piece->at, piece->value, piece->bytes);
}

static void random_pieces_do_not_overlap(void)
{
    struct piece pieces[PIECES] = {{0}};
    srand(1);
    for (int i = 0; i < STEPS; i++) {
        struct piece *piece = &pieces[rand() % PIECES];
        if (piece->at)
            release(piece);
        else
            acquire(piece);
    }
    for (int i = 0; i < PIECES; i++)
        if (pieces[i].at)
            release(&pieces[i]);
    TEST_ASSERT_EQUAL_UINT64(0, d3d9_arena_used(&arena));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(what_is_allocated_is_aligned_and_zeros);
    RUN_TEST(all_of_it_can_be_had_again);
    RUN_TEST(random_pieces_do_not_overlap);
    return UNITY_END();
}
