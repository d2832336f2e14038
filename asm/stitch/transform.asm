; Transformation (src/spec/vertex/transform.h): row vector times matrix, rows summed last to first.
; Matrices are the job's, row-major, sixteen bytes a row. Registers as in fetch.asm.

%include "fragment.inc"
%include "constant.inc"

; One component: x * m0 + (y * m1 + (z * m2 + m3)), with w * m3 instead of m3 when there is a w.
%macro transform_point 5 ; result, scratch, argument, column, 1 if there is a w
    fill %3,    vbroadcastss    %1, [at_job + 48 + 4 * %4]
  %if %5
                vmulps          %1, %1, m3
  %endif
    fill %3,    vbroadcastss    %2, [at_job + 32 + 4 * %4]
                vfmadd231ps     %1, m2, %2
    fill %3,    vbroadcastss    %2, [at_job + 16 + 4 * %4]
                vfmadd231ps     %1, m1, %2
    fill %3,    vbroadcastss    %2, [at_job + 4 * %4]
                vfmadd231ps     %1, m0, %2
%endmacro

%macro clip_position 3 ; name, position's last register, 1 if there is a w
; Arguments: the matrix, slots of x, y, z and w.
fragment %1, JOB | OUTPUT | M_TO(0, %2), M_TO(8, 11), M(12) | M(13)
                transform_point m8, m12, .matrix, 0, %3
                transform_point m9, m13, .matrix, 1, %3
                transform_point m10, m12, .matrix, 2, %3
                transform_point m11, m13, .matrix, 3, %3
    fill .x,     vmovaps         [at_output], m8
    fill .y,     vmovaps         [at_output], m9
    fill .z,     vmovaps         [at_output], m10
    fill .w,     vmovaps         [at_output], m11
end_fragment
%endmacro

clip_position clip_position, 2, 0
clip_position clip_position_w, 3, 1

%macro camera_position 3 ; name, position's last register, 1 if there is a w
; Argument: the matrix.
fragment %1, JOB | M_TO(0, %2), M_TO(4, 6), M(8) | M(9)
                transform_point m4, m8, .matrix, 0, %3
                transform_point m5, m9, .matrix, 1, %3
                transform_point m6, m8, .matrix, 2, %3
end_fragment
%endmacro

camera_position camera_position, 2, 0
camera_position camera_position_w, 3, 1

; A direction has no translation.
%macro transform_direction 4 ; result, scratch, argument, column
    fill %3,    vbroadcastss    %1, [at_job + 32 + 4 * %4]
                vmulps          %1, %1, m10
    fill %3,    vbroadcastss    %2, [at_job + 16 + 4 * %4]
                vfmadd231ps     %1, m9, %2
    fill %3,    vbroadcastss    %2, [at_job + 4 * %4]
                vfmadd231ps     %1, m8, %2
%endmacro

; Argument: the matrix of normals.
fragment camera_normal, JOB | M_TO(8, 10), M_TO(0, 2), M(3) | M(7)
                transform_direction m0, m3, .matrix, 0
                transform_direction m1, m7, .matrix, 1
                transform_direction m2, m3, .matrix, 2
end_fragment

; Multiplies by 1 / sqrt(n . n), or by FLT_MAX where that is infinite, so that the zero vector is
; unchanged.
fragment normalize, CONSTANTS | M_TO(0, 2), M_TO(0, 2), M(3) | M(7)
                vmulps          m3, m2, m2
                vfmadd231ps     m3, m1, m1
                vfmadd231ps     m3, m0, m0
                vmovaps         m7, [constants + ONE_F]
                vsqrtps         m3, m3
                vdivps          m3, m7, m3
                vminps          m3, m3, [constants + MAXIMUM_F]
                vmulps          m0, m0, m3
                vmulps          m1, m1, m3
                vmulps          m2, m2, m3
end_fragment
