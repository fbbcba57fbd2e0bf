// A picture of 8-bit RGB to draw on: what --preview is made with.
#ifndef SSDO_PIPELINE_CANVAS_H
#define SSDO_PIPELINE_CANVAS_H

#include <stdint.h>

#include "base/error.h"

enum {
    CANVAS_TEXT_HEIGHT = 14, // of a line of text
    CANVAS_LETTER = 12,      // columns a letter takes, with the gap after it
};

typedef struct canvas {
    int width, height;
    uint8_t *rgb; // top row first, owned
} canvas;

// A canvas of one grey. False when memory is short.
bool canvas_make(canvas *s, int width, int height, uint8_t grey, error *e);
void canvas_free(canvas *s);

// What lies outside the canvas is not drawn, here and below.
void canvas_put(canvas *s, int x, int y, const uint8_t colour[3]);
void canvas_fill(canvas *s, int x, int y, int width, int height, const uint8_t colour[3]);
// Letters (all drawn as small ones), digits and . - + = _ , : ( ), twice the size of their pattern so that they can be read at
// 100 %; others are gaps.
void canvas_text(canvas *s, int x, int y, const char *text);

// The grey of the checkerboard that stands for "no surface" at a place of the canvas.
uint8_t canvas_checker(int x, int y);

#endif
