#include "base/text.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char replacement[] = "\xEF\xBF\xBD";

// Bytes of the character that begins here, 0 if none does: RFC 3629, so no surrogate, nothing longer than it need be.
static size_t character(const unsigned char *p)
{
    static const uint32_t least[5] = {0, 0, 0x80, 0x800, 0x10000};
    size_t n = p[0] < 0x80                   ? 1
               : p[0] >= 0xc2 && p[0] < 0xe0 ? 2
               : (p[0] & 0xf0) == 0xe0       ? 3
               : p[0] >= 0xf0 && p[0] < 0xf5 ? 4
                                             : 0;
    uint32_t code = n < 2 ? p[0] : p[0] & (0xffu >> (n + 1));
    for (size_t i = 1; i < n; i++) {
        if ((p[i] & 0xc0) != 0x80) return 0; // the final 0 too
        code = code << 6 | (p[i] & 0x3fu);
    }
    return code < least[n] || (code >= 0xd800 && code < 0xe000) || code > 0x10ffff ? 0 : n;
}

// U+0080 to U+009F are control characters as well: a terminal may take U+009B for ESC [.
void text_one_line(char *text)
{
    for (unsigned char *p = (unsigned char *)text; *p;) {
        size_t n = character(p);
        bool plain = n > 1 ? p[0] != 0xc2 || p[1] >= 0xa0 : n == 1 && *p >= 0x20 && *p != 0x7f;
        if (!plain) memset(p, '?', n ? n : 1);
        p += n ? n : 1;
    }
}

void text_print(FILE *to, const char *format, ...)
{
    char *text = NULL;
    va_list args;
    va_start(args, format);
    int n = vasprintf(&text, format, args);
    va_end(args);
    if (n < 0) return;
    size_t before = strspn(format, "\n"), length = strlen(format), after = 0;
    while (after < length - before && format[length - 1 - after] == '\n') after++;
    text[(size_t)n - after] = '\0';
    text_one_line(text + before);
    fputs(text, to);
    for (size_t i = 0; i < after; i++) fputc('\n', to);
    free(text);
}

void text_utf8(const char *from, char *to, size_t size)
{
    size_t used = 0;
    while (*from && size > 0) {
        size_t n = character((const unsigned char *)from), wide = n ? n : sizeof replacement - 1;
        if (used + wide >= size) break;
        memcpy(to + used, n ? from : replacement, wide);
        used += wide;
        from += n ? n : 1;
    }
    if (size > 0) to[used] = 0;
}

size_t text_utf8_room(const char *from) { return (sizeof replacement - 1) * strlen(from) + 1; }
