// The C++ side of plugin/dwa.h. See dwa_abi.h for the rules of the border: nothing may be thrown across it.
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>

#include "plugin/dwa_abi.h"

namespace
{
using namespace OPENEXR_IMF_NAMESPACE;
using IMATH_NAMESPACE::Box2i;
using IMATH_NAMESPACE::V2i;

class stream : public IStream
{
  public:
    explicit stream(const dwa_source &from) : IStream("the file"), source(from) {}
    bool read(char *to, int n) override
    {
        if (source.read(source.context, to, size_t(n), at) != size_t(n)) throw std::runtime_error("it ends early");
        at += uint64_t(n);
        return at < source.size;
    }
    uint64_t tellg() override { return at; }
    void seekg(uint64_t to) override { at = to; }

  private:
    dwa_source source;
    uint64_t at = 0;
};

// Without threads of its own, whose number belongs to the whole process, and without looking for chunks that no table knows.
struct decoder {
    decoder(const dwa_source &source, int part) : bytes(source), file(bytes, 0, false), input(file, part) {}
    stream bytes;
    MultiPartInputFile file;
    InputPart input;
};

// Runs `work`; whatever it throws becomes the message.
template <class F> dwa_result guarded(char *message, size_t size, F work)
{
    std::string text = "unknown failure in OpenEXR";
    dwa_result result = DWA_DAMAGED;
    try {
        work();
        return DWA_OK;
    } catch (const std::bad_alloc &) {
        text = "out of memory", result = DWA_MEMORY;
    } catch (const std::exception &x) {
        text = x.what();
    } catch (...) {
    }
    text = text.substr(0, text.find('\n'));
    if (size) message[text.copy(message, size - 1)] = '\0';
    return result;
}

std::unique_ptr<decoder> open(const dwa_source &source, const dwa_part &part)
{
    auto d = std::make_unique<decoder>(source, part.index);
    // Whoever called has seen the file before, and has taken memory of this size.
    if (d->input.header().dataWindow() != Box2i(V2i(part.x0, part.y0), V2i(part.x1, part.y1)))
        throw std::runtime_error("its data window changed while it was read");
    return d;
}

void decode(decoder &d, const dwa_channel *channels, int count, int first, int last)
{
    const Header &header = d.input.header();
    const Box2i window = header.dataWindow();
    const size_t width = size_t(window.max.x - window.min.x) + 1;
    FrameBuffer all;
    for (const dwa_channel *c = channels; c < channels + count; c++) {
        const Channel *stored = header.channels().findChannel(c->name);
        if (!stored || int(stored->type) != c->type)
            throw std::runtime_error(std::string("channel ") + c->name + " is not there, or changed its type");
        const size_t size = stored->type == HALF ? 2 : 4;
        all.insert(c->name, Slice::Make(stored->type, c->samples, window, size, size * width));
    }
    d.input.setFrameBuffer(all);
    d.input.readPixels(first, last);
}
} // namespace

extern "C" {
#define EXPORT __attribute__((visibility("default")))

EXPORT dwa_result ssdo_dwa_open(const dwa_source *source, const dwa_part *part, void **made, char *message, size_t message_size)
{
    return guarded(message, message_size, [&] { *made = open(*source, *part).release(); });
}

EXPORT dwa_result ssdo_dwa_decode(void *opened, const dwa_channel *channels, int count, int first, int last, char *message,
                                  size_t message_size)
{
    return guarded(message, message_size, [&] { decode(*static_cast<decoder *>(opened), channels, count, first, last); });
}

EXPORT void ssdo_dwa_close(void *opened) { delete static_cast<decoder *>(opened); }
}
