/* Shared by the parts of the emulation of AVX-512 (avx512.h): signals and registers (avx512.c), instructions
 * that work across lanes or with masks (execute.c), and those that AVX2 executes (twin.c). */
#ifndef TESTS_SUPPORT_AVX512_AVX512_PART_H
#define TESTS_SUPPORT_AVX512_AVX512_PART_H

#include "tests/support/avx512/avx512.h"

#include <Zydis/Zydis.h>
#include <stdbool.h>
#include <stdint.h>
#include <ucontext.h>

enum { AVX512_WORDS = 16, AVX512_HALF = 8, AVX512_LANE = 4, AVX512_MASKS = 8, AVX512_ALL = 0xffff };

struct avx512_vector {
    uint32_t word[AVX512_WORDS];
};

/* The interrupted program. */
struct avx512_machine {
    greg_t *general;
    uint32_t (*low)[AVX512_LANE],
        (*high)[AVX512_LANE]; /* both lanes of the lower halves of registers 0 to 15 */
    uint32_t *mxcsr;
    uint16_t mask[AVX512_MASKS];
    uint32_t upper[AVX512_WORDS][AVX512_HALF];
    struct avx512_vector further[AVX512_WORDS]; /* registers 16 to 31 */
    ZydisDecoder decoder;
    ZydisDecodedInstruction instruction;
    ZydisDecodedOperand operand[ZYDIS_MAX_OPERAND_COUNT]; /* without the mask */
    unsigned words;                                       /* of a vector: 4, 8 or 16 */
    uint16_t writes;                                      /* the lanes that the mask selects */
    bool zeroes;                                          /* the other lanes become zero */
    size_t executed;
};

/* Ends the process with the instruction and the reason. */
_Noreturn void avx512_fail(const struct avx512_machine *machine, const char *reason);

struct avx512_vector avx512_read(const struct avx512_machine *machine, unsigned number);
void avx512_write(struct avx512_machine *machine, unsigned number, const struct avx512_vector *vector);
/* The number of a vector register or of a mask register; -1: neither. */
int avx512_vector_number(ZydisRegister reg);
int avx512_mask_number(ZydisRegister reg);
greg_t *avx512_general(const struct avx512_machine *machine, ZydisRegister reg);
uint8_t *avx512_address(const struct avx512_machine *machine, const ZydisDecodedOperand *operand);

/* The value of an operand: a register, words of memory, or one element for all. A move reads no memory of
 * lanes that the mask leaves out. */
struct avx512_vector avx512_operand(const struct avx512_machine *machine, const ZydisDecodedOperand *operand);

/* Writes the destination's lanes that the mask selects. */
void avx512_result(struct avx512_machine *machine, const struct avx512_vector *vector);

/* Returns true for an instruction that is not executed by the processor. */
bool avx512_is_own(const struct avx512_machine *machine);

/* Executes the decoded instruction. */
void avx512_execute(struct avx512_machine *machine);

/* Executes the instruction with AVX2. Returns false if none of AVX2 does the same in each half. For a
 * comparison the result has a word of ones for each lane that is true. */
bool avx512_twin(struct avx512_machine *machine, struct avx512_vector *result);
void avx512_prepare_twins(void);

#endif
