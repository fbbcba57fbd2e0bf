#include "plugin/images.h"

#include <stdlib.h>

#include "base/outfile.h"
#include "plugin/images_abi.h"
#include "plugin/module.h"

static const module images = {"ssdo-images.so", "OpenImageIO"};

bool images_read_rows(const char *path, int part, images_take_fn take, void *context, error *e)
{
    char message[MODULE_MESSAGE] = "";
    images_read_rows_fn read =
        (images_read_rows_fn)module_function(&images, "ssdo_images_read_rows", "reading this kind of image", ERR_INPUT, path, e);
    if (!read) return false;
    if (read(path, part, take, context, message, sizeof message)) return true;
    if (!message[0]) return false; // `take` knows why
    return err_set(e, ERR_INPUT, path, NULL, "cannot be read as an image: %s; check the file or convert it to EXR", message);
}

static images_encode_png_fn png_encoder(const char *path, error *e)
{
    return (images_encode_png_fn)module_function(&images, "ssdo_images_encode_png", "writing a PNG", ERR_OUTPUT, path, e);
}

bool images_check_png(const char *path, error *e) { return png_encoder(path, e) != NULL; }

bool images_write_png(const char *path, int width, int height, const uint8_t *rgb, const char *key, const char *label, error *e)
{
    char message[MODULE_MESSAGE] = "";
    void *bytes = NULL;
    size_t size = 0;
    images_encode_png_fn encode = png_encoder(path, e);
    if (!encode) return false;
    if (!encode(width, height, rgb, key, label, &bytes, &size, message, sizeof message))
        return err_set(e, ERR_OUTPUT, path, NULL, "cannot be made into a PNG: %s", message);
    bool ok = outfile_write(path, bytes, size, e);
    free(bytes);
    return ok;
}
