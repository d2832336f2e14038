; The texts that the command explore contains: the parts of its page, each ended by a zero byte, and the
; specification, as pairs of a path and a text, ended by an empty path.

%macro text 2 ; symbol, file
    global %1:data hidden
%1:
    incbin %2
    db 0
%endmacro

section .rodata progbits alloc noexec nowrite

    text embed_page, "src/command/explore/page.html"
    text embed_style, "src/command/explore/page.css"
    text embed_script_model, "src/command/explore/model.js"
    text embed_script_panes, "src/command/explore/panes.js"
    text embed_script_pictures, "src/command/explore/pictures.js"
    text embed_script_page, "src/command/explore/page.js"
    text embed_spec, "spec.texts"
