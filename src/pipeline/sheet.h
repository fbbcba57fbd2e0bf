// A picture of 8-bit RGB to draw on: what --preview is made with.
#ifndef SSDO_PIPELINE_SHEET_H
#define SSDO_PIPELINE_SHEET_H

#include <stdint.h>

#include "base/error.h"

enum {
    SHEET_TEXT_HEIGHT = 14, // of a line of text
    SHEET_LETTER = 12,      // columns a letter takes, with the gap after it
};

typedef struct sheet {
    int width, height;
    uint8_t *rgb; // top row first, owned
} sheet;

// A sheet of one grey. False when memory is short.
bool sheet_make(sheet *s, int width, int height, uint8_t grey, error *e);
void sheet_free(sheet *s);

// What lies outside the sheet is not drawn, here and below.
void sheet_put(sheet *s, int x, int y, const uint8_t colour[3]);
void sheet_fill(sheet *s, int x, int y, int width, int height, const uint8_t colour[3]);
// Letters (all drawn as small ones), digits and . - + = _ , : ( ), twice the size of their pattern so that they can be read at
// 100 %; others are gaps.
void sheet_text(sheet *s, int x, int y, const char *text);

// The grey of the checkerboard that stands for "no surface" at a place of the sheet.
uint8_t sheet_checker(int x, int y);

#endif
