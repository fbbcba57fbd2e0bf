// The C++ side of plugin/colour.h: nothing may be thrown across the border.
#include <cstdio>
#include <string>

#include <OpenColorIO/OpenColorIO.h>

#include "plugin/colour_abi.h"

namespace OCIO = OCIO_NAMESPACE;

namespace
{
std::string known_spaces(const OCIO::ConstConfigRcPtr &config)
{
    std::string list;
    for (int i = 0; i < config->getNumColorSpaces() && list.size() < 200; i++)
        list += std::string(i ? ", " : "") + config->getColorSpaceNameByIndex(i);
    return list;
}

std::string known_displays(const OCIO::ConstConfigRcPtr &config, const char *display)
{
    std::string list;
    int n = display ? config->getNumViews(display) : config->getNumDisplays();
    for (int i = 0; i < n && list.size() < 200; i++)
        list += std::string(i ? ", " : "") + (display ? config->getView(display, i) : config->getDisplay(i));
    return list;
}

bool has_view(const OCIO::ConstConfigRcPtr &config, const char *display, const char *view)
{
    for (int i = 0; i < config->getNumViews(display); i++)
        if (std::string(config->getView(display, i)) == view) return true;
    return false;
}

// In rows, because an image's width is a long but its strides are counted in bytes.
void apply(const OCIO::ConstCPUProcessorRcPtr &cpu, float *rgb, size_t n)
{
    const size_t row = 1 << 20;
    for (size_t at = 0; at < n; at += row) {
        OCIO::PackedImageDesc image(rgb + 3 * at, static_cast<long>(n - at < row ? n - at : row), 1, 3);
        cpu->apply(image);
    }
}

// Both throw; a sentence in `message` and no processor where a name is unknown.
OCIO::ConstProcessorRcPtr to_linear(const OCIO::ConstConfigRcPtr &config, const char *from, char *message, size_t size)
{
    if (config->getColorSpace(from)) return config->getProcessor(from, OCIO::ROLE_SCENE_LINEAR);
    std::snprintf(message, size, "has no colour space '%s'; it has %s", from, known_spaces(config).c_str());
    return nullptr;
}

OCIO::ConstProcessorRcPtr to_display(const OCIO::ConstConfigRcPtr &config, const char *display, const char *view, char *message,
                                     size_t size)
{
    if (!display) display = config->getDefaultDisplay();
    if (config->getNumViews(display) == 0) {
        std::snprintf(message, size, "has no display '%s'; it has %s", display, known_displays(config, nullptr).c_str());
        return nullptr;
    }
    if (!view) view = config->getDefaultView(display);
    if (!has_view(config, display, view)) {
        std::snprintf(message, size, "has no view '%s' for the display '%s'; it has %s", view, display,
                      known_displays(config, display).c_str());
        return nullptr;
    }
    return config->getProcessor(OCIO::ROLE_SCENE_LINEAR, display, view, OCIO::TRANSFORM_DIR_FORWARD);
}

// Catches what `work` throws.
template <typename Work> int guarded(char *message, size_t size, Work work)
{
    try {
        return work() ? 1 : 0;
    } catch (const std::exception &e) {
        std::snprintf(message, size, "cannot be used as an OpenColorIO config: %s", e.what());
    } catch (...) {
        std::snprintf(message, size, "cannot be used as an OpenColorIO config");
    }
    return 0;
}
} // namespace

extern "C" __attribute__((visibility("default"))) int ssdo_colour_to_linear(const char *path, const char *from, float *rgb,
                                                                            size_t n, char *message, size_t size)
{
    return guarded(message, size, [&] {
        OCIO::ConstProcessorRcPtr p = to_linear(OCIO::Config::CreateFromFile(path), from, message, size);
        if (p) apply(p->getDefaultCPUProcessor(), rgb, n);
        return p != nullptr;
    });
}

extern "C" __attribute__((visibility("default"))) int
ssdo_colour_to_display(const char *path, const char *display, const char *view, float *rgb, size_t n, char *message, size_t size)
{
    return guarded(message, size, [&] {
        OCIO::ConstProcessorRcPtr p = to_display(OCIO::Config::CreateFromFile(path), display, view, message, size);
        if (p) apply(p->getDefaultCPUProcessor(), rgb, n);
        return p != nullptr;
    });
}

extern "C" __attribute__((visibility("default"))) int ssdo_colour_identity(const char *path, const char *from,
                                                                           const char *display, const char *view, char *identity,
                                                                           size_t identity_size, char *message, size_t size)
{
    return guarded(message, size, [&] {
        OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromFile(path);
        OCIO::ConstProcessorRcPtr p =
            from ? to_linear(config, from, message, size) : to_display(config, display, view, message, size);
        if (p) std::snprintf(identity, identity_size, "%s", p->getCacheID());
        return p != nullptr;
    });
}
