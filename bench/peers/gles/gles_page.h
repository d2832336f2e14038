/* Pages, drawn by GLES2 as their streams draw them. */
#ifndef BENCH_PEERS_GLES_PAGE_H
#define BENCH_PEERS_GLES_PAGE_H

/* Makes textures and buffers. Returns null, or a reason. */
const char *gles_page_open(const char *name);
/* Draws the page; the first frame makes the programs. Returns null, or a reason. */
const char *gles_page_frame(void);
void gles_page_close(void);

#endif
