// SPDX-License-Identifier: MIT
#include "drivers/camera/jpeg_encoder.h"

#include <string>

#include <turbojpeg.h>

#include "device/device_error.h"

namespace dynslam {

JpegEncoder::JpegEncoder(int quality) : encoder_(tjInitCompress(), tjDestroy), quality_(quality) {
  if (!encoder_) throw DeviceError("camera: libjpeg-turbo gives no encoder");
}

std::vector<std::uint8_t> JpegEncoder::encode(const YuvView& picture) {
  if (picture.width < 2 || picture.height < 2 || picture.width % 2 != 0 || picture.height % 2 != 0)
    throw DeviceError("camera: width and height of a picture must be even");
  const unsigned char* planes[3];
  int strides[3];
  for (std::size_t p = 0; p < 3; ++p) {
    planes[p] = picture.planes[p].bytes;
    strides[p] = static_cast<int>(picture.planes[p].stride);
  }
  room_.resize(tjBufSize(picture.width, picture.height, TJSAMP_420));
  unsigned char* out = room_.data();
  unsigned long size = room_.size();  // NOLINT(google-runtime-int): the library's type
  const int failed =
      tjCompressFromYUVPlanes(encoder_.get(), planes, picture.width, strides, picture.height, TJSAMP_420,
                              &out, &size, quality_, TJFLAG_NOREALLOC | TJFLAG_FASTDCT);
  if (failed != 0) throw DeviceError(std::string("camera: jpeg: ") + tjGetErrorStr2(encoder_.get()));
  return {out, out + size};
}

}  // namespace dynslam
