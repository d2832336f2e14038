; The routines of lab 7, with the sequences of the student's frc.inc.
default rel
bits 64
%include "routine.inc"
%include "frc.inc"

ROUTINE frc_mmx, FRC_MMX, 16, movups, xmm0
ROUTINE frc_sse41, FRC_SSE41, 16, movups, xmm0
ROUTINE frc_avx2, FRC_AVX2, 32, vmovups, ymm0
ROUTINE frc_avx512, FRC_AVX512, 64, vmovups, zmm0
