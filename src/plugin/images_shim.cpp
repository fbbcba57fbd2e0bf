// The C++ side of plugin/images.h. See images_abi.h for the rules of the border: nothing may be thrown across it.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "plugin/images_abi.h"

namespace
{
using namespace OIIO;

constexpr int64_t max_pixels = 1 << 28;
constexpr int max_channels = 1024;

struct free_memory {
    void operator()(void *p) const { std::free(p); }
};
using memory = std::unique_ptr<void, free_memory>;

memory allocate(size_t size)
{
    memory p(std::malloc(size ? size : 1));
    if (!p) throw std::runtime_error("out of memory");
    return p;
}

void tell(char *message, size_t size, const std::string &text)
{
    std::string line = text.substr(0, text.find('\n'));
    if (size) {
        std::strncpy(message, line.c_str(), size - 1);
        message[size - 1] = '\0';
    }
}

// Runs `work`; whatever it throws becomes the message.
template <class F> int guarded(char *message, size_t size, F work)
{
    try {
        work();
        return 1;
    } catch (const std::exception &x) {
        tell(message, size, x.what());
    } catch (...) {
        tell(message, size, "unknown failure in OpenImageIO");
    }
    return 0;
}

std::string reason(std::string said, const char *otherwise) { return said.empty() ? std::string(otherwise) : said; }

std::unique_ptr<ImageInput> open_part(const char *path, int part)
{
    auto in = ImageInput::open(path);
    if (!in) throw std::runtime_error(reason(OIIO::geterror(), "unknown format"));
    if (!in->seek_subimage(part, 0)) throw std::runtime_error("it has no part " + std::to_string(part));
    const ImageSpec &s = in->spec();
    if (s.width < 1 || s.height < 1 || int64_t(s.width) * s.height > max_pixels || s.nchannels < 1 || s.nchannels > max_channels)
        throw std::runtime_error("it is larger than what is read");
    if (s.deep || s.depth > 1) throw std::runtime_error("it is deep or a volume");
    return in;
}

// Rows [y, end) of the data window as float; of a tiled file, whole rows of tiles.
void read_band(ImageInput &in, int part, int y, int end, float *to)
{
    const ImageSpec &s = in.spec();
    const bool ok =
        s.tile_width ? in.read_tiles(part, 0, s.x, s.x + s.width, s.y + y, s.y + end, 0, 1, 0, s.nchannels, TypeDesc::FLOAT, to)
                     : in.read_scanlines(part, 0, s.y + y, s.y + end, 0, 0, s.nchannels, TypeDesc::FLOAT, to);
    if (!ok) throw std::runtime_error(reason(in.geterror(), "its pixels cannot be read"));
}

// False if `take` wants no more.
bool read_rows(const char *path, int part, images_take_fn take, void *context)
{
    auto in = open_part(path, part);
    const ImageSpec spec = in->spec();
    if (!take(context, spec.width, spec.height, spec.nchannels, 0, 0, nullptr)) return false;
    const int band = spec.tile_height ? spec.tile_height : 64;
    memory p = allocate(size_t(spec.width) * size_t(band) * size_t(spec.nchannels) * sizeof(float));
    float *rows = static_cast<float *>(p.get());
    for (int y = 0; y < spec.height; y += band) {
        const int end = std::min(y + band, spec.height);
        read_band(*in, part, y, end, rows);
        if (!take(context, spec.width, spec.height, spec.nchannels, y, end - y, rows)) return false;
    }
    return true;
}

// To memory: the library's own file writer does not tell when a disk is full.
void encode_png(int width, int height, const uint8_t *rgb, const char *key, const char *label, void **bytes, size_t *size)
{
    Filesystem::IOVecOutput file;
    auto out = ImageOutput::create("png", &file);
    if (!out) throw std::runtime_error(reason(OIIO::geterror(), "OpenImageIO was built without PNG"));
    ImageSpec spec(width, height, 3, TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute(key, label);
    if (!out->set_ioproxy(&file) || !out->open("memory.png", spec) || !out->write_image(TypeDesc::UINT8, rgb) || !out->close())
        throw std::runtime_error(reason(out->geterror(), "unknown failure"));
    memory copy = allocate(file.buffer().size());
    std::memcpy(copy.get(), file.buffer().data(), file.buffer().size());
    *size = file.buffer().size();
    *bytes = copy.release();
}
} // namespace

extern "C" {
#define EXPORT __attribute__((visibility("default")))

EXPORT int ssdo_images_read_rows(const char *path, int part, images_take_fn take, void *context, char *message,
                                 size_t message_size)
{
    bool whole = false;
    return guarded(message, message_size, [&] { whole = read_rows(path, part, take, context); }) && whole;
}

EXPORT int ssdo_images_encode_png(int width, int height, const uint8_t *rgb, const char *key, const char *label, void **bytes,
                                  size_t *size, char *message, size_t message_size)
{
    return guarded(message, message_size, [&] { encode_png(width, height, rgb, key, label, bytes, size); });
}
}
