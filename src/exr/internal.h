// What the files of this room share; nothing outside src/exr includes it.
#ifndef SSDO_EXR_INTERNAL_H
#define SSDO_EXR_INTERNAL_H

#include <pthread.h>

#include <openexr.h>

#include "exr/out_part.h"

// Limits of what is read. They bound memory for hostile headers and keep every product below 2^63 (the library multiplies some
// of these as int).
enum {
    EXRIO_MAX_SIDE = 65536,         // pixels, data window and tiles
    EXRIO_MAX_PIXELS = 1 << 28,     // 16384 x 16384, more than one GL texture holds
    EXRIO_MAX_CHANNELS = 1024,      // of one part
    EXRIO_MAX_NAME = 255,           // bytes, the format's own limit for long names
    EXRIO_SHORT_NAME = 31,          // longer ones need a flag in the file's version field
    EXRIO_MAX_PARTS = 1024,         //
    EXRIO_MAX_ATTRIBUTES = 4096,    // of one part
    EXRIO_MAX_CHUNK_BYTES = 1 << 30 // unpacked
};

// Keeps the library's first message while armed, instead of letting it print. The library calls from any thread.
typedef struct core_log {
    pthread_mutex_t lock;
    bool armed;
    char text[256];
    int refused; // errno of the first read that the system refused
} core_log;

// What exrio_file_open allocates; the public part comes first.
typedef struct exrio_reader {
    exrio_file file;
    core_log log;
    int fd; // what was checked is what is read, whatever the path names meanwhile
    size_t size;
    uint64_t tables;   // where the chunk tables begin: the end of the headers
    uint8_t *restored; // what the library is given in place of the tables, from exrio_restore_tables; NULL: the file's own
    size_t restored_size;
} exrio_reader;

void core_log_arm(core_log *log);
// The first message while armed.
void core_log_keep(core_log *log, const char *message);
// Stops listening and reports `code`: an allocation failure as ERR_MEMORY, a read that the system refused by its
// number, anything else as `kind` with `what` in front of the library's own words. Returns false.
bool core_log_report(core_log *log, exr_result_t code, error_code kind, const char *path, const char *what, error *e);

// Walks the headers of an open file of `size` bytes without the library: the magic number, version and flags, every name and
// size within its bounds and the file, the required attributes there and of their type, no deep part. Fills e and returns false
// otherwise. What passes cannot lead the library's parser astray. *end: the first byte after the headers.
bool exrio_check_header(const char *path, int fd, size_t size, uint64_t *end, error *e);

// For an open file whose parts are known: where a part's chunk table is all zero, as exrmultipart of OpenEXR 3.2 and later leaves
// it, the chunks are looked up one after the other, once, and the library is given a table of them: of flat and deep parts, lines
// and tiles, one level and several. A table is made only if every chunk of the file is there, whole and once; else it stays as it
// is, and the file is refused when its pixels are read. False only when memory runs out or the system refuses to read.
bool exrio_restore_tables(exrio_reader *r, error *e);

// The file's bytes from `offset` on, as they are but for tables that were restored; returns how many there are. Where the system
// refuses, errno and the log have its number; else errno is 0.
size_t exrio_read_bytes(exrio_reader *r, void *buffer, size_t size, uint64_t offset);

// Fills the views of a part whose channels are known, and the view of each channel.
bool exrio_fill_views(const exrio_file *file, int index, exrio_part *p, error *e);
void exrio_free_views(exrio_part *p);

// The end of what exrio_file_open_all made.
void exrio_merged_close(exrio_file *file);

// True for attributes that say how pixels are stored: they are the writer's and never copied.
bool exrio_attr_structural(const char *name);

// Bytes that the pointer of an attribute of this exr_attribute_type_t points at; 0 for values that are kept in its own place.
size_t exrio_attr_value_size(int type);

// Declares in part `part` of `to` a copy of every attribute of the parts that p names that is not structural and not one of p's
// own. The values are borrowed: those files must stay open until `to` is finished.
exr_result_t exrio_attr_copy_all(exr_context_t to, int part, const exrio_out_part *p);

// The number-th part that attributes are copied from, the first at 0; false beyond the last.
bool exrio_attr_source(const exrio_out_part *p, int number, exrio_source *out);

// Checks what exrio_write was given: names, windows, compression. ERR_OUTPUT names the part or channel that cannot be written.
bool exrio_check_parts(const char *path, const exrio_out_part *parts, int count, error *e);

// Declares all parts with their channels and attributes in a context opened for writing, and writes the header.
exr_result_t exrio_put_header(exr_context_t core, const exrio_out_part *parts, int count);

#endif
