; Triangles of up to nine pixels each way, AVX-512: all of a triangle's blocks, up to 2x2, at once and without a branch
; on how many there are. src/draw/raster.c is the reference, explains edges, rule and limits, and does all others.
;
; A vector of 32 words is two blocks side by side, in the order of lanes; two of them are 8x8 pixels. With i and j from
; 0 to 7, |a i + b j| <= 7 (|a| + |b|) < 7 * 2 * 9 * 256 = 32256, so words limited to 16 bits keep their signs.
;
; struct raster_progress raster_tiny_avx512(const struct raster_site *site, const uint8_t *records,
;                                           const uint32_t *offset, uint32_t count,
;                                           struct entry *next, const struct entry *last);
;
; From the first triangle on, while it is such a triangle and `next` is not behind `last`: its entries to `next` and
; following, where there is room for four even if it has fewer. Returns what `next` is then, and how many triangles are
; left. The scissor rectangle takes nothing from the tile.

    default rel

%define site        rdi
%define records     rsi
%define offset      rdx
%define count       ecx
%define next        r8
%define last        r9

%define LIMIT_LOW   0                   ; struct raster_site
%define LIMIT_HIGH  16
%define COLUMN      64
%define ROW         (COLUMN + 16 * 16)
%define HEAD_X      4                   ; struct triangle_head
%define HEAD_Y      16

MOST_PIXELS         equ 8               ; between the first centres behind the vertices: less than nine between these

section .rodata progbits alloc noexec nowrite align=64

across_words:       ; i of the 32 pixels
    dw 0, 1, 0, 1, 2, 3, 2, 3, 0, 1, 0, 1, 2, 3, 2, 3
    dw 4, 5, 4, 5, 6, 7, 6, 7, 4, 5, 4, 5, 6, 7, 6, 7
down_words:         ; j
    dw 0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 3, 3, 2, 2, 3, 3
    dw 0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 3, 3, 2, 2, 3, 3
coverage_words:     ; where the four blocks' coverages go
    dw 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0
    dw 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0
rotated_once:       ; words 1 2 0 of each half
    db 2, 3, 4, 5, 0, 1, 0, 1, 10, 11, 12, 13, 8, 9, 8, 9
rotated_twice:
    db 4, 5, 0, 1, 2, 3, 0, 1, 12, 13, 8, 9, 10, 11, 8, 9
word_pairs:         ; a0 a1 a2 . b0 b1 b2 . -> a0 b0 a1 b1 a2 b2 . .
    db 0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15
x_subpixels:        ; word 0 times 256 in each double word
    db 128, 0, 1, 128, 128, 0, 1, 128, 128, 0, 1, 128, 128, 0, 1, 128
y_subpixels:        ; word 4
    db 128, 8, 9, 128, 128, 8, 9, 128, 128, 8, 9, 128, 128, 8, 9, 128
before_centre:      times 4 dd 127
centre:             times 4 dd 128
one_double:         times 4 dd 1
one_word:           times 8 dw 1
two_words:          times 8 dw 2
too_large:          times 8 dw MOST_PIXELS + 1
block_start:        times 8 dw -4
kept_blocks:        ; blocks that are in the bounds, by whether there are second columns and rows
    dq 0x000000000000ffff, 0x00000000ffffffff, 0x0000ffff0000ffff, 0xffffffffffffffff

; In zmm5 a, in zmm6 b, in zmm7 the value at the first pixel.
%macro edge_at_pixels 2 ; results: upper and lower blocks
                vpmullw         zmm5, zmm5, zmm16
                vpmullw         zmm8, zmm6, zmm17
                vpsllw          zmm6, zmm6, 2
                vpaddw          zmm5, zmm5, zmm8
                vpaddw          zmm6, zmm6, zmm5
                vpaddsw         %1, zmm5, zmm7
                vpaddsw         %2, zmm6, zmm7
%endmacro

section .text progbits alloc exec nowrite align=16

    global raster_tiny_avx512:function hidden
raster_tiny_avx512:
                vmovdqa64       zmm16, [across_words]
                vmovdqa64       zmm17, [down_words]
                vmovdqa64       zmm18, [coverage_words]
                mov             eax, 1
                vpbroadcastw    zmm19, eax                      ; words 1 to 5 to all words
                vpaddw          zmm20, zmm19, zmm19
                vpaddw          zmm21, zmm20, zmm19
                vpaddw          zmm22, zmm21, zmm19
                vpaddw          zmm23, zmm22, zmm19
                mov             eax, 0x10101010
                kmovd           k1, eax                         ; words with a coverage
                mov             eax, 0x8888
                kmovd           k2, eax                         ; double words with a record
                vmovdqa         xmm14, [before_centre]
                vmovdqa         xmm15, [word_pairs]
                test            count, count
                jz              .end
.triangle:      cmp             next, last
                ja              .end
                mov             eax, [offset]
                vmovdqu         xmm0, [records + rax + HEAD_X]
                vmovdqu         xmm1, [records + rax + HEAD_Y]

                ; bounds, as whole_box() and cut_box() have them
                vpaddd          xmm2, xmm0, xmm14
                vpaddd          xmm3, xmm1, xmm14
                vpsrad          xmm2, xmm2, 8
                vpsrad          xmm3, xmm3, 8
                vpackssdw       xmm2, xmm2, xmm3
                vpshufb         xmm3, xmm2, [rotated_once]
                vpshufb         xmm4, xmm2, [rotated_twice]
                vpminsw         xmm5, xmm2, xmm3
                vpmaxsw         xmm6, xmm2, xmm3
                vpminsw         xmm5, xmm5, xmm4
                vpmaxsw         xmm6, xmm6, xmm4
                vpsubsw         xmm7, xmm6, xmm5                ; extent
                vpmaxsw         xmm5, xmm5, [site + LIMIT_LOW]
                vpminsw         xmm6, xmm6, [site + LIMIT_HIGH]
                vpcmpgtw        xmm8, xmm6, xmm5
                vpmovmskb       eax, xmm8
                not             eax
                test            eax, 0x101
                jnz             .next                           ; nothing in the tile

                ; first block, and whether there are second ones
                vpsubw          xmm6, xmm6, [one_word]
                vpsraw          xmm9, xmm5, 2
                vpsraw          xmm6, xmm6, 2
                vpsubw          xmm6, xmm6, xmm9
                vmovdqa         xmm8, [too_large]
                vpcmpgtw        xmm8, xmm8, xmm7
                vmovdqa         xmm10, [two_words]
                vpcmpgtw        xmm10, xmm10, xmm6
                vpand           xmm8, xmm8, xmm10
                vpmovmskb       eax, xmm8
                not             eax
                test            eax, 0x101
                jnz             .end                            ; not one of ours
                vpextrw         eax, xmm6, 0
                vpextrw         r10d, xmm6, 4
                lea             r10d, [rax + r10 * 2]
                lea             r11, [kept_blocks]
                kmovq           k5, [r11 + r10 * 8]
                vpextrw         eax, xmm9, 0
                vpextrw         r11d, xmm9, 4
                and             eax, 15
                and             r11d, 15
                shl             eax, 4
                shl             r11d, 4

                ; edges: a0 b0 a1 b1 a2 b2 in xmm4, values at the first pixel in xmm2
                vpshufd         xmm2, xmm1, 0xc9
                vpshufd         xmm3, xmm0, 0xc9
                vpsubd          xmm2, xmm1, xmm2
                vpsubd          xmm3, xmm3, xmm0
                vpackssdw       xmm4, xmm2, xmm3
                vpand           xmm5, xmm5, [block_start]
                vpshufb         xmm6, xmm5, [x_subpixels]
                vpshufb         xmm7, xmm5, [y_subpixels]
                vpor            xmm6, xmm6, [centre]
                vpor            xmm7, xmm7, [centre]
                vpsubd          xmm6, xmm6, xmm0
                vpsubd          xmm7, xmm7, xmm1
                vpackssdw       xmm6, xmm6, xmm7
                vpshufb         xmm6, xmm6, xmm15
                vpshufb         xmm4, xmm4, xmm15
                vpmaddwd        xmm6, xmm6, xmm4
                vpslld          xmm2, xmm2, 16                  ; a, then b: positive on left and top edges
                vpaddd          xmm2, xmm2, xmm3
                vmovdqa         xmm3, [one_double]
                vpcmpgtd        xmm2, xmm3, xmm2                ; the rule: -1 on the others
                vpaddd          xmm2, xmm2, xmm6
                vpsrad          xmm2, xmm2, 8
                vpackssdw       xmm2, xmm2, xmm2

                ; three edges at 64 pixels: the upper blocks, the lower ones
                vpbroadcastw    zmm5, xmm4                      ; a
                vpermw          zmm6, zmm19, zmm4               ; b
                vpbroadcastw    zmm7, xmm2                      ; value
                edge_at_pixels  zmm0, zmm1
                vpermw          zmm5, zmm20, zmm4
                vpermw          zmm6, zmm21, zmm4
                vpermw          zmm7, zmm19, zmm2
                edge_at_pixels  zmm9, zmm10
                vpermw          zmm5, zmm22, zmm4
                vpermw          zmm6, zmm23, zmm4
                vpermw          zmm7, zmm20, zmm2
                edge_at_pixels  zmm11, zmm12
                vpternlogq      zmm0, zmm9, zmm11, 0xfe
                vpternlogq      zmm1, zmm10, zmm12, 0xfe
                vpmovw2m        k3, zmm0
                vpmovw2m        k4, zmm1
                kunpckdq        k3, k4, k3
                kandnq          k3, k3, k5
                kmovq           r10, k3

                ; entries of the blocks that are covered
                vmovq           xmm0, r10
                vpermw          zmm0 {k1}{z}, zmm18, zmm0
                vptestmq        k3, zmm0, zmm0
                kshiftrb        k4, k3, 1
                korb            k3, k3, k4
                vpbroadcastd    zmm1 {k2}{z}, [offset]
                vbroadcasti64x4 zmm2, [site + COLUMN + rax]
                vmovdqu         ymm3, [site + ROW + r11]
                vshufi64x2      zmm3, zmm3, zmm3, 0x50
                vpternlogq      zmm0, zmm1, zmm2, 0xfe
                vporq           zmm0, zmm0, zmm3
                vpcompressq     zmm0 {k3}{z}, zmm0
                vmovdqu64       [next], zmm0
                kmovb           eax, k3
                popcnt          eax, eax
                lea             next, [next + rax * 8]
.next:          add             offset, 4
                dec             count
                jnz             .triangle
.end:           mov             rax, next
                mov             edx, count
                vzeroupper
                ret
