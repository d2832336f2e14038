; Stack frames: entry and exit of a routine, and the loops of the three units, for both granularities.
;
;       enter                   enter                   enter
;       vertex_begin            setup_begin             pixel_begin
;   +-> ...                 +-> ...                 +-> pixel_entry         a block of sixteen lanes
;   +-- vertex_next         +-- setup_next          |+> pixel_chunk --+     eight of them, if any is covered
;       leave                   leave               ||  ...           |
;                                                   ++- pixel_next <--+
;                                                       leave
;
; The stack frame, from rbp down: five saved registers, the caller's MXCSR, the routine's MXCSR, then the
; routine's slots.

%include "fragment.inc"

%define SAVED_BYTES     (5 * 8)
%define CALLER_MXCSR    rbp - SAVED_BYTES - 4
%define ROUTINE_MXCSR   rbp - SAVED_BYTES - 8

; Arguments: minus the bytes of the slots, the contract's MXCSR. A large frame is touched page by page from
; above, because the system extends a stack only when its guard page is touched.
fragment enter, FRAME | FRAME_END | CALLED, FRAME | FRAME_END | CONSTANTS, R_AX | R_CX
                push            rbp
    cfa                             NUMBER_RSP, 16
    saved                           NUMBER_RBP, 16
                mov             rbp, rsp
    cfa                             NUMBER_RBP, 16
                push            rbx
    saved                           NUMBER_RBX, 24
                push            r12
    saved                           12, 32
                push            r13
    saved                           13, 40
                push            r14
    saved                           14, 48
                push            r15
    saved                           15, 56
    fill .frame,     lea             rax, [frame - 40]           ; both MXCSR and what aligning may take
                jmp             .reached
.page:          sub             rsp, 4096
                mov             dword [rsp], 0
.reached:       lea             rcx, [rsp - 4096]
                cmp             rcx, rax
                ja              .page
                mov             rsp, rax
                and             rsp, -32
                stmxcsr         [CALLER_MXCSR]
    fill .mxcsr,     mov             dword [ROUTINE_MXCSR], strict dword 0
                ldmxcsr         [ROUTINE_MXCSR]
                mov             constants, strict qword 0
.end:           hole            .end - 8, HOLE_CONSTANTS, 0
end_fragment

fragment leave, FRAME_END, NOTHING, \
                FRAME | FRAME_END | CONSTANTS | STRIDE | COLOR | DEPTH | COVERED | M_TO(0, 15)
                vzeroupper
                ldmxcsr         [CALLER_MXCSR]
                lea             rsp, [rbp - SAVED_BYTES]
                pop             r15
    restored                        15, 0
                pop             r14
    restored                        14, 0
                pop             r13
    restored                        13, 0
                pop             r12
    restored                        12, 0
                pop             rbx
    restored                        NUMBER_RBX, 0
                pop             rbp
    cfa                             NUMBER_RSP, 8
    restored                        NUMBER_RBP, 0
                ret
end_fragment

; Once in a routine with a shader. Arguments: job of the unit's arguments, constants of struct job.
fragment shader_constants, CALLED, SHADER_CONSTANTS, NOTHING
    fill .job,       mov             r12, [at_call]
    fill .constants, mov             r12, [dword r12]
end_fragment

; ---- vertex: job, index, out and count of struct vertex_arguments; the part after the loop

fragment vertex_begin, CALLED, REMAINING | JOB | INPUT | OUTPUT, NOTHING
    fill .job,       mov             job, [at_call]
    fill .index,     mov             input, [at_call]
    fill .out,       mov             output, [at_call]
    fill .count,     mov             esi, [at_call]
                test            esi, esi
    jump .to_leave,  jz
end_fragment

fragment vertex_next, REMAINING | INPUT | OUTPUT, REMAINING | INPUT | OUTPUT, NOTHING
                add             input, 32
                add             output, 32
                sub             esi, 8
    jump .to_loop,   jnz
end_fragment

; ---- setup: job, index, vertices, out and count of struct setup_arguments; the part after the loop

fragment setup_begin, CALLED, REMAINING | JOB | INPUT | OUTPUT | VERTICES, NOTHING
    fill .job,       mov             job, [at_call]
    fill .index,     mov             input, [at_call]
    fill .vertices,  mov             vertices, [at_call]
    fill .out,       mov             output, [at_call]
    fill .count,     mov             esi, [at_call]
                test            esi, esi
    jump .to_leave,  jz
end_fragment

; Arguments: bytes of eight records, the loop's first part.
fragment setup_next, REMAINING | INPUT | OUTPUT, REMAINING | INPUT | OUTPUT, NOTHING
                add             input, 32
    fill .records,   lea             output, [at_output]
                sub             esi, 8
    jump .to_loop,   jnz
end_fragment

; ---- pixel: `remaining` is the end of the entries

; Arguments: job, entries and count of struct pixel_arguments.
fragment pixel_begin, CALLED, REMAINING | JOB | ENTRY, NOTHING
    fill .job,       mov             job, [at_call]
    fill .entries,   mov             entry, [at_call]
    fill .count,     mov             esi, [at_call]
                shl             remaining, ENTRY_SHIFT
                add             remaining, entry
end_fragment

; Arguments: triangle, coverage and block of struct entry; triangles, lanes, color and depth of struct
; pixel_arguments.
fragment pixel_entry, CALLED | ENTRY, TRIANGLE | LANES | COLOR | DEPTH | COVERED, R_AX
    fill .triangle,  mov             r10d, [at_entry]
    fill .coverage,  movzx           r15d, word [at_entry]
    fill .block,     movzx           eax, word [at_entry]
                shl             eax, 6                      ; a block's sixteen words
    fill .triangles, add             triangle, [at_call]
    fill .lanes,     mov             lanes, [at_call]
    fill .color,     mov             color, [at_call]
    fill .depth,     mov             depth, [at_call]
                add             color, rax
                add             depth, rax
end_fragment

; Argument: the part where the chunk ends.
fragment pixel_chunk, COVERED, NOTHING, NOTHING
                test            r15b, r15b
    jump .to_next,   jz
end_fragment

; Arguments: the parts pixel_chunk and pixel_entry. If the second chunk has no coverage, the block ends.
fragment pixel_next, REMAINING | ENTRY | LANES | COLOR | DEPTH | COVERED, \
                     ENTRY | LANES | COLOR | DEPTH | COVERED, NOTHING
                add             lanes, 32
                add             color, 32
                add             depth, 32
                shr             r15d, 8
    jump .to_chunk,  jnz
                add             entry, 1 << ENTRY_SHIFT
                cmp             entry, remaining
    jump .to_entry,  jne
end_fragment
