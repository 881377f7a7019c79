// SPDX-License-Identifier: MIT
#include <memory>
#include <stdexcept>
#include <string>

#include <turbojpeg.h>

#include "sim/camera_picture.h"

namespace dynslam {

std::vector<std::uint8_t> encode_jpeg(const Picture& picture) {
  constexpr int kQuality = 80;
  const std::unique_ptr<void, int (*)(tjhandle)> encoder(tjInitCompress(), tjDestroy);
  if (!encoder) throw std::runtime_error("libjpeg-turbo gives no encoder");
  std::vector<std::uint8_t> bytes(tjBufSize(picture.width, picture.height, TJSAMP_420));
  unsigned long size = bytes.size();  // NOLINT(google-runtime-int): the library's type
  unsigned char* out = bytes.data();
  const auto* pixels = reinterpret_cast<const unsigned char*>(picture.pixels.data());
  // On little-endian machines, which all of ours are, 0x00RRGGBB lies as B, G, R, 0.
  const int failed = tjCompress2(encoder.get(), pixels, picture.width, 0, picture.height, TJPF_BGRX, &out,
                                 &size, TJSAMP_420, kQuality, TJFLAG_NOREALLOC | TJFLAG_FASTDCT);
  if (failed != 0) throw std::runtime_error(std::string("jpeg: ") + tjGetErrorStr2(encoder.get()));
  bytes.resize(size);
  return bytes;
}

}  // namespace dynslam
