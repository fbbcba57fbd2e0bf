// Text that comes from outside (names of files, channels, views) on its way to a log or a report.
#ifndef SSDO_BASE_TEXT_H
#define SSDO_BASE_TEXT_H

#include <stddef.h>
#include <stdio.h>

// Makes one line of it, in place: control characters, line ends among them, and bytes that are no UTF-8 become '?'. So a name
// cannot split a line, forge one for a supervisor that reads them, or command a terminal.
void text_one_line(char *text);

// fprintf of one line, made one by text_one_line whatever the arguments hold: line ends stand at the beginning and the end of the
// format only. Nothing is printed where memory runs out.
void text_print(FILE *to, const char *format, ...) __attribute__((format(printf, 2, 3)));

// A copy in UTF-8 of at most size - 1 bytes: every byte that is not part of a character becomes U+FFFD. What does not fit is cut
// between characters.
void text_utf8(const char *from, char *to, size_t size);

// The room that text_utf8 needs for the whole of `from`.
size_t text_utf8_room(const char *from);

#endif
