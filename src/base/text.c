#include "base/text.h"

#include <stdint.h>
#include <string.h>

static const char replacement[] = "\xEF\xBF\xBD";

void text_one_line(char *text)
{
    for (unsigned char *p = (unsigned char *)text; *p; p++)
        if (*p < 0x20 || *p == 0x7f) *p = '?';
}

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
