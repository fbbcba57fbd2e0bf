// Pictures on their way to and from the device.
//
// On hardware (gpu.mapped) they pass through buffers that stay mapped: the device copies to and from them by itself, while the
// CPU and the next passes go on. The buffers are kept for the next frame. A software renderer gains nothing from that: there
// gpu_image_upload and gpu_image_download_rows copy at once, a few rows at a time.
#ifndef SSDO_GPU_TRANSFER_H
#define SSDO_GPU_TRANSFER_H

#include "gpu/gpu.h"

// Rows y .. y + rows - 1 of an image on their way down.
typedef struct gpu_transfer {
    gpu_pixel_buffer *buffer; // NULL: nothing is under way
    const float *pixels;      // tightly packed, to be read once gpu_transfer_wait has returned true, by any thread
} gpu_transfer;

// How many rows of the image make a band of at most gpu.band_bytes, at least one.
int gpu_transfer_rows(const gpu *g, const gpu_image *image);

// Asks the device for the rows, after the passes so far, and returns at once. False if no buffer can be had.
bool gpu_transfer_start(gpu *g, const gpu_image *image, int y, int rows, gpu_transfer *t, error *e);
// Waits until they have arrived, not for what was asked of the device afterwards.
bool gpu_transfer_wait(gpu *g, const gpu_transfer *t, error *e);
// Gives the buffer back, whether the rows have arrived or not. From any thread.
void gpu_transfer_end(gpu_transfer *t);

// A whole picture (level 0) up, as gpu_image_upload does it, by mapped buffers and gpu.threads threads where the device has a use
// for them. `pixels` may be freed when it returns. False only when the device was lost.
bool gpu_image_send(gpu *g, gpu_image *image, const float *pixels, error *e);

#endif
