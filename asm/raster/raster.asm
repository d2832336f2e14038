; Tiny triangles with AVX-512. Each step handles 2x2 blocks, and one step is enough for most triangles.
; src/render/raster/raster.c is the reference: it explains edges, the rule for edges and the limits, and
; rasterizes all other triangles.
;
; A vector of 32 words is two blocks side by side, in the order of lanes. Two vectors are 8x8 pixels. The
; edge values at the first pixels of the blocks are double words: four blocks of each edge in turn. They
; are limited to words, permuted to all pixels of their block, and added to the steps of the pixels.
;
; struct raster_progress raster_tiny_avx512(const struct raster_site *site, const uint8_t *records,
;                                           const uint32_t *offset, uint32_t count,
;                                           struct entry *next, const struct entry *last);
;
; The kernel begins with the first triangle. It stops before a triangle that is not tiny, and when `next`
; is after `last`. It writes the entries from `next` on, and up to four entries of no meaning after them.
; It returns the `next` after its last entry and the number of triangles that are left. The scissor
; rectangle must contain the whole tile.

    default rel

%define site        rdi
%define records     rsi
%define offset      rdx
%define count       ecx
%define next        r8
%define last        r9

%include "raster/offset.inc"

%define first_x     [rsp - 4]           ; 16 times the numbers of blocks in the tile
%define last_x      [rsp - 8]
%define last_y      [rsp - 12]
%define kept_blocks rsp - 16            ; blocks inside the bounds: by second row, second column

MOST_PIXELS         equ 20              ; pixels between the vertices of a tiny triangle, at most

section .rodata progbits alloc noexec nowrite align=64

across_words:       ; i of the 32 pixels in their blocks
    times 2 dw 0, 1, 0, 1, 2, 3, 2, 3, 0, 1, 0, 1, 2, 3, 2, 3
down_words:         ; j
    times 2 dw 0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 3, 3, 2, 2, 3, 3
upper_words:        ; indices that copy the values of two blocks to their pixels
    times 16 dw 0
    times 16 dw 1
edge_doubles:       ; indices that copy the values of three edges to four blocks
    times 4 dd 0
    times 4 dd 1
    times 8 dd 2
coverage_words:     ; indices that move the four blocks' coverages to their entries
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
too_large:          times 8 dw MOST_PIXELS + 1
block_start:        times 8 dw -4
block_bits:         times 8 dw 15 << 4              ; of the pixel's position times 4

; The differences between the values at the pixels of a block and at its first pixel.
%macro edge_steps 3 ; result; a and b in all words, which are lost
                vpmullw         %2, %2, zmm16
                vpmullw         %3, %3, zmm17
                vpaddw          %1, %2, %3
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
                vmovdqa64       zmm24, [upper_words]            ; edge 0: upper blocks, lower blocks
                vpaddw          zmm25, zmm24, zmm20
                vpsllw          zmm31, zmm20, 2
                vpaddw          zmm26, zmm24, zmm31             ; edges 1 and 2
                vpaddw          zmm27, zmm25, zmm31
                vpaddw          zmm28, zmm26, zmm31
                vpaddw          zmm29, zmm27, zmm31
                vmovdqa64       zmm30, [edge_doubles]
                mov             eax, 0x10101010
                kmovd           k1, eax                         ; words with a coverage
                mov             eax, 0x8888
                kmovd           k2, eax                         ; double words with a record
                mov             eax, 0xaaaa
                kmovd           k6, eax                         ; blocks on the right
                mov             eax, 0xcccc
                kmovd           k7, eax                         ; blocks below
                mov             dword [kept_blocks], 0xff330f03
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

                ; blocks of the tile from first to last
                vmovdqa         xmm8, [too_large]
                vpcmpgtw        xmm8, xmm8, xmm7
                vpmovmskb       eax, xmm8
                not             eax
                test            eax, 0x101
                jnz             .end                            ; not a tiny triangle
                vpsubw          xmm6, xmm6, [one_word]
                vpsllw          xmm9, xmm5, 2
                vpsllw          xmm6, xmm6, 2
                vpand           xmm9, xmm9, [block_bits]
                vpand           xmm6, xmm6, [block_bits]
                vpextrw         eax, xmm6, 0
                vpextrw         r10d, xmm6, 4
                mov             last_x, eax
                mov             last_y, r10d
                vpextrw         eax, xmm9, 0
                vpextrw         r11d, xmm9, 4
                mov             first_x, eax

                ; edges: a0 b0 a1 b1 a2 b2 in xmm4, values at the first pixel in xmm5
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
                vpslld          xmm5, xmm2, 16                  ; a, then b: positive on left and top edges
                vpaddd          xmm5, xmm5, xmm3
                vmovdqa         xmm7, [one_double]
                vpcmpgtd        xmm5, xmm7, xmm5                ; the rule: -1 on the others
                vpaddd          xmm5, xmm5, xmm6
                vpsrad          xmm5, xmm5, 8

                ; zmm0 to zmm2: the edges' steps in a block; zmm3: their values at four blocks;
                ; zmm4: at the first four of the row; zmm5 and zmm6: steps to the next four
                vpermd          zmm3, zmm30, zmm3
                vpermd          zmm2, zmm30, zmm2
                vpermd          zmm7, zmm30, zmm5
                vpslld          zmm6, zmm3, 2
                vpslld          zmm5, zmm2, 2
                vpaddd          zmm7 {k6}, zmm7, zmm5
                vpaddd          zmm7 {k7}, zmm7, zmm6
                vpaddd          zmm5, zmm5, zmm5
                vpaddd          zmm6, zmm6, zmm6
                vmovdqa64       zmm3, zmm7
                vpbroadcastw    zmm7, xmm4
                vpermw          zmm8, zmm19, zmm4
                edge_steps      zmm0, zmm7, zmm8
                vpermw          zmm7, zmm20, zmm4
                vpermw          zmm8, zmm21, zmm4
                edge_steps      zmm1, zmm7, zmm8
                vpermw          zmm7, zmm22, zmm4
                vpermw          zmm8, zmm23, zmm4
                edge_steps      zmm2, zmm7, zmm8
.row:           vmovdqa64       zmm4, zmm3
.blocks:        xor             r10d, r10d
                cmp             r11d, last_y
                setb            r10b                            ; there is a second row
                cmp             eax, last_x
                adc             r10d, r10d                      ; and a second column
                kmovb           k5, [kept_blocks + r10]
                vpackssdw       zmm13, zmm3, zmm3
                vpermw          zmm7, zmm24, zmm13
                vpermw          zmm8, zmm25, zmm13
                vpermw          zmm9, zmm26, zmm13
                vpermw          zmm10, zmm27, zmm13
                vpermw          zmm11, zmm28, zmm13
                vpermw          zmm12, zmm29, zmm13
                vpaddsw         zmm7, zmm7, zmm0
                vpaddsw         zmm8, zmm8, zmm0
                vpaddsw         zmm9, zmm9, zmm1
                vpaddsw         zmm10, zmm10, zmm1
                vpaddsw         zmm11, zmm11, zmm2
                vpaddsw         zmm12, zmm12, zmm2
                vpternlogq      zmm7, zmm9, zmm11, 0xfe
                vpternlogq      zmm8, zmm10, zmm12, 0xfe
                vpmovw2m        k3, zmm7
                vpmovw2m        k4, zmm8
                kunpckdq        k3, k4, k3
                knotq           k3, k3
                kmovq           r10, k3

                ; entries of the blocks that are covered
                vmovq           xmm7, r10
                vpermw          zmm7 {k1}{z}, zmm18, zmm7
                vptestmq        k3, zmm7, zmm7
                kshiftrb        k4, k3, 1
                korb            k3, k3, k4
                kandb           k3, k3, k5
                vpbroadcastd    zmm8 {k2}{z}, [offset]
                vbroadcasti64x4 zmm9, [site + COLUMN + rax]
                vmovdqu         ymm10, [site + ROW + r11]
                vshufi64x2      zmm10, zmm10, zmm10, 0x50
                vpternlogq      zmm7, zmm8, zmm9, 0xfe
                vporq           zmm7, zmm7, zmm10
                vpcompressq     zmm7 {k3}{z}, zmm7
                vmovdqu64       [next], zmm7
                kmovb           r10d, k3
                popcnt          r10d, r10d
                lea             next, [next + r10 * 8]

                add             eax, 32
                vpaddd          zmm3, zmm3, zmm5
                cmp             eax, last_x
                jle             .blocks
                add             r11d, 32
                mov             eax, first_x
                vpaddd          zmm3, zmm4, zmm6
                cmp             r11d, last_y
                jle             .row
.next:          add             offset, 4
                dec             count
                jnz             .triangle
.end:           mov             rax, next
                mov             edx, count
                vzeroupper
                ret
