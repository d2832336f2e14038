; The alpha test (src/spec/pixel/alpha.h). Lanes whose alpha fails the comparison with the reference are no
; longer live. Alpha is the upper half of m5. Registers as in interpolate.asm.

%include "fragment.inc"

%define live            m2

; Alpha and the reference.
%macro alpha_and_reference 0
                vpsrld          m8, m5, 16
    fill .reference, vpbroadcastd    m9, [at_job]
%endmacro

; Argument: the reference in the job.
%macro keep_where 3 ; name, operands of "greater"
fragment %1, JOB | M(2) | M(5), M(2), M(8) | M(9)
                alpha_and_reference
                vpcmpgtd        m8, %2, %3
                vpand           live, live, m8
end_fragment
%endmacro

%macro keep_unless 3 ; name, operands of "greater"
fragment %1, JOB | M(2) | M(5), M(2), M(8) | M(9)
                alpha_and_reference
                vpcmpgtd        m8, %2, %3
                vpandn          live, m8, live
end_fragment
%endmacro

keep_where  alpha_less, m9, m8
keep_unless alpha_less_equal, m8, m9
keep_where  alpha_greater, m8, m9
keep_unless alpha_greater_equal, m9, m8

fragment alpha_equal, JOB | M(2) | M(5), M(2), M(8) | M(9)
                alpha_and_reference
                vpcmpeqd        m8, m8, m9
                vpand           live, live, m8
end_fragment

fragment alpha_not_equal, JOB | M(2) | M(5), M(2), M(8) | M(9)
                alpha_and_reference
                vpcmpeqd        m8, m8, m9
                vpandn          live, m8, live
end_fragment

fragment alpha_never, NOTHING, M(2), NOTHING
                vpxor           live, live, live
end_fragment
