// SPDX-License-Identifier: MIT
// The camera but for libcamera itself, on a source of made-up pictures.
#include <array>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <turbojpeg.h>

#include "device/device_error.h"
#include "drivers/camera/live_camera.h"

namespace dynslam {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

template <class F>
std::string complaint(F&& f) {
  try {
    f();
  } catch (const DeviceError& e) {
    return e.what();
  }
  return "nothing";
}

/// A picture with rows that are longer than they need to be.
struct Painted {
  Painted(int width, int height, std::size_t extra) {
    view.width = width, view.height = height;
    for (std::size_t p = 0; p < 3; ++p) {
      const std::size_t stride = static_cast<std::size_t>(view.width_of(p)) + extra;
      bytes[p].assign(stride * static_cast<std::size_t>(view.height_of(p)), 0x5a);
      view.planes[p] = {bytes[p].data(), stride};
    }
  }
  std::uint8_t& at(std::size_t plane, int x, int y) {
    return bytes[plane]
                [static_cast<std::size_t>(y) * view.planes[plane].stride + static_cast<std::size_t>(x)];
  }
  void fill(int from_column, int to_column, std::array<std::uint8_t, 3> colour) {
    for (std::size_t p = 0; p < 3; ++p) {
      const int half = p == 0 ? 1 : 2;
      for (int y = 0; y < view.height_of(p); ++y) {
        for (int x = from_column / half; x < to_column / half; ++x) at(p, x, y) = colour[p];
      }
    }
  }
  std::vector<std::uint8_t> bytes[3];
  YuvView view;
};

int at(const YuvView& view, std::size_t plane, int x, int y) {
  return view.planes[plane]
      .bytes[static_cast<std::size_t>(y) * view.planes[plane].stride + static_cast<std::size_t>(x)];
}

struct Decoded {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  std::array<int, 3> at(int x, int y) const {
    const std::size_t i =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
};

Decoded decode(const std::vector<std::uint8_t>& jpeg) {
  const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), tjDestroy);
  Decoded d;
  int sampling = 0, space = 0;
  if (tjDecompressHeader3(decoder.get(), jpeg.data(), jpeg.size(), &d.width, &d.height, &sampling, &space) !=
      0)
    return {};
  d.rgb.resize(3 * static_cast<std::size_t>(d.width) * static_cast<std::size_t>(d.height));
  if (tjDecompress2(decoder.get(), jpeg.data(), jpeg.size(), d.rgb.data(), d.width, 0, d.height, TJPF_RGB,
                    0) != 0)
    return {};
  return d;
}

void expect_colour(const std::array<int, 3>& seen, int r, int g, int b) {
  EXPECT_NEAR(seen[0], r, 6);
  EXPECT_NEAR(seen[1], g, 6);
  EXPECT_NEAR(seen[2], b, 6);
}

// By JPEG's equations: R = Y + 1.402 (V - 128), G = Y - 0.344136 (U - 128) - 0.714136 (V - 128),
// B = Y + 1.772 (U - 128). Y 76, U 85, V 255 is (254, 0, 0); Y 29, U 255, V 107 is (0, 0, 254).
constexpr std::array<std::uint8_t, 3> kRed = {76, 85, 255};
constexpr std::array<std::uint8_t, 3> kBlue = {29, 255, 107};

TEST(YuvPicture, CopiesEachPlaneWithoutTheRowsEnds) {
  for (const auto& [width, height] : {std::pair(8, 6), std::pair(6, 10), std::pair(2, 2)}) {
    Painted from(width, height, 13);
    std::mt19937 random(1);
    for (std::size_t p = 0; p < 3; ++p) {
      for (int y = 0; y < from.view.height_of(p); ++y) {
        for (int x = 0; x < from.view.width_of(p); ++x)
          from.at(p, x, y) = static_cast<std::uint8_t>(random());
      }
    }
    YuvPicture upright, turned;
    upright.copy(from.view, false);
    turned.copy(from.view, true);
    for (std::size_t p = 0; p < 3; ++p) {
      const int columns = from.view.width_of(p), rows = from.view.height_of(p);
      EXPECT_EQ(upright.view().planes[p].stride, static_cast<std::size_t>(columns));
      for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
          ASSERT_EQ(at(upright.view(), p, x, y), from.at(p, x, y));
          ASSERT_EQ(at(turned.view(), p, columns - 1 - x, rows - 1 - y), from.at(p, x, y));
        }
      }
    }
  }
}

TEST(JpegEncoder, GivesAPictureOfTheSameColoursWhateverTheStride) {
  JpegEncoder encoder(90);
  for (const std::size_t extra : {0U, 64U}) {
    Painted picture(64, 48, extra);
    picture.fill(0, 32, kRed);
    picture.fill(32, 64, kBlue);
    const Decoded seen = decode(encoder.encode(picture.view));
    ASSERT_EQ(seen.width, 64);
    ASSERT_EQ(seen.height, 48);
    expect_colour(seen.at(8, 24), 254, 0, 0);
    expect_colour(seen.at(56, 24), 0, 0, 254);
  }
}

TEST(JpegEncoder, TakesPicturesOfAnySizeOneAfterTheOther) {
  JpegEncoder encoder(80);
  for (const auto& [width, height] :
       {std::pair(16, 16), std::pair(962, 542), std::pair(2, 2), std::pair(34, 18)}) {
    const Painted picture(width, height, 5);
    const Decoded seen = decode(encoder.encode(picture.view));
    EXPECT_EQ(seen.width, width);
    EXPECT_EQ(seen.height, height);
  }
}

TEST(JpegEncoder, RefusesOddSizes) {
  JpegEncoder encoder(80);
  const Painted wide(33, 16, 64), high(32, 17, 64);
  EXPECT_THAT(complaint([&] { encoder.encode(wide.view); }), HasSubstr("must be even"));
  EXPECT_THAT(complaint([&] { encoder.encode(high.view); }), HasSubstr("must be even"));
}

TEST(JpegEncoder, BetterQualityTakesMoreBytes) {
  Painted noise(64, 64, 0);
  std::mt19937 random(1);
  for (auto& plane : noise.bytes) {
    for (auto& byte : plane) byte = static_cast<std::uint8_t>(random());
  }
  EXPECT_GT(JpegEncoder(95).encode(noise.view).size(), 2 * JpegEncoder(30).encode(noise.view).size());
}

/// What the made-up cameras of a test do, and did.
struct Studio {
  std::mutex mutex;
  std::string trouble;  ///< of opening or asking
  bool silent = false;
  Duration age = milliseconds(40);
  std::uint8_t grey = 100;
  int opened = 0, running = 0, taken = 0;
};

class MadeUpSource : public FrameSource {
 public:
  MadeUpSource(Studio& studio, const CameraConfig& config)
      : studio_(studio), picture_(config.width_px, config.height_px, 32) {
    ++studio_.opened;
    ++studio_.running;
  }
  ~MadeUpSource() override {
    const std::lock_guard lock(studio_.mutex);
    --studio_.running;
  }
  bool next(Clock::SteadyTime, const Take& take) override {
    const std::lock_guard lock(studio_.mutex);
    if (!studio_.trouble.empty()) throw DeviceError(studio_.trouble);
    if (studio_.silent) return false;
    picture_.fill(0, picture_.view.width / 2, {studio_.grey, 128, 128});
    picture_.fill(picture_.view.width / 2, picture_.view.width, {20, 128, 128});
    ++studio_.taken;
    take({picture_.view, studio_.age});
    return true;
  }

 private:
  Studio& studio_;
  Painted picture_;
};

class CameraTest : public testing::Test {
 protected:
  CameraTest() {
    config_.width_px = 64;
    config_.height_px = 32;
  }
  LiveCamera::Open open() {
    return [this](const CameraConfig& config) {
      const std::lock_guard lock(studio_.mutex);
      if (!studio_.trouble.empty()) throw DeviceError(studio_.trouble);
      return std::make_unique<MadeUpSource>(studio_, config);
    };
  }
  Time soon() const { return clock_.now() + milliseconds(10); }
  void set_trouble(const std::string& trouble) {
    const std::lock_guard lock(studio_.mutex);
    studio_.trouble = trouble;
  }
  int running() {
    const std::lock_guard lock(studio_.mutex);
    return studio_.running;
  }

  RunningClock clock_;
  CameraConfig config_;
  Studio studio_;
};

TEST_F(CameraTest, IsOffUntilSomebodyAsks) {
  LiveCamera camera(config_, clock_, open());
  EXPECT_EQ(studio_.opened, 0);
  ASSERT_TRUE(camera.next(soon()));
  EXPECT_EQ(running(), 1);
  EXPECT_EQ(studio_.taken, 1);
}

TEST_F(CameraTest, GivesPicturesWithTheTimeTheyWereTaken) {
  LiveCamera camera(config_, clock_, open());
  const Time before = clock_.now();
  const auto frame = camera.next(soon());
  ASSERT_TRUE(frame);
  EXPECT_GE(frame->stamp, before - milliseconds(40));
  EXPECT_LE(frame->stamp, clock_.now() - milliseconds(40));
  const Decoded seen = decode(frame->bytes);
  expect_colour(seen.at(8, 16), 100, 100, 100);
  expect_colour(seen.at(56, 16), 20, 20, 20);
}

TEST_F(CameraTest, AnAgeThatCannotBeIsNone) {
  LiveCamera camera(config_, clock_, open());
  for (const Duration age : {Duration(std::chrono::hours(5)), Duration(-milliseconds(1))}) {
    studio_.age = age;
    const Time before = clock_.now();
    EXPECT_GE(camera.next(soon()).value().stamp, before);
  }
}

TEST_F(CameraTest, MountedUpsideDownItsPicturesAreTurned) {
  config_.rotation_deg = 180;
  LiveCamera camera(config_, clock_, open());
  const Decoded seen = decode(camera.next(soon()).value().bytes);
  expect_colour(seen.at(8, 16), 20, 20, 20);
  expect_colour(seen.at(56, 16), 100, 100, 100);
}

TEST_F(CameraTest, IsSwitchedOffWhenNobodyAsksAnyMoreAndOnAgain) {
  LiveCamera camera(config_, clock_, open(), milliseconds(20));
  ASSERT_TRUE(camera.next(soon()));
  const auto end = steady_clock::now() + std::chrono::seconds(20);
  while (running() > 0 && steady_clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
  EXPECT_EQ(running(), 0);
  EXPECT_TRUE(camera.next(soon()));
  EXPECT_EQ(studio_.opened, 2);
}

TEST_F(CameraTest, AbsentItSaysSoAndIsThereASecondAfterItCame) {
  LiveCamera camera(config_, clock_, open());
  set_trouble("camera: there is none");
  EXPECT_EQ(complaint([&] { camera.next(soon()); }), "camera: there is none");
  set_trouble("");
  EXPECT_EQ(complaint([&] { camera.next(soon()); }), "camera: there is none") << "not tried again so soon";
  const auto end = steady_clock::now() + std::chrono::seconds(20);
  while (complaint([&] { camera.next(soon()); }) != "nothing" && steady_clock::now() < end)
    std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(running(), 1);
}

TEST_F(CameraTest, AFaultSwitchesItOff) {
  LiveCamera camera(config_, clock_, open());
  ASSERT_TRUE(camera.next(soon()));
  set_trouble("camera: it was unplugged");
  EXPECT_EQ(complaint([&] { camera.next(soon()); }), "camera: it was unplugged");
  EXPECT_EQ(running(), 0);
}

TEST_F(CameraTest, SilentFor2sItIsOpenedAnew) {
  LiveCamera camera(config_, clock_, open());
  studio_.silent = true;
  EXPECT_EQ(camera.next(soon()), std::nullopt);
  std::string said = "nothing";
  const auto begin = steady_clock::now();
  while (said == "nothing" && steady_clock::now() < begin + std::chrono::seconds(20)) {
    said = complaint([&] { EXPECT_EQ(camera.next(soon()), std::nullopt); });
    std::this_thread::sleep_for(milliseconds(20));
  }
  EXPECT_THAT(said, HasSubstr("camera: no picture for 2 s"));
  EXPECT_GE(steady_clock::now() - begin, milliseconds(1900));
  EXPECT_EQ(running(), 0);
}

TEST(Libcamera, WithoutACameraSaysWhatToLookAt) {
  if (!list_cameras().empty()) GTEST_SKIP() << "there is a camera";
  const std::string said = complaint([] { open_libcamera({}); });
  EXPECT_THAT(said, HasSubstr("camera: libcamera finds none: is the ribbon cable in"));
  EXPECT_THAT(said, testing::Not(HasSubstr("\n")));
  EXPECT_THAT(complaint([] { open_libcamera({}); }), HasSubstr("finds none")) << "and so once more";
}

TEST(CameraConfig, KnowsTwoRotationsAndEvenSizes) {
  CameraConfig config;
  EXPECT_EQ(config.problem(), std::nullopt);
  config.rotation_deg = 90;
  EXPECT_EQ(config.problem(), "camera.rotation_deg: not 0 or 180");
  config.rotation_deg = 180;
  config.width_px = 961;
  EXPECT_EQ(config.problem(), "camera: width_px and height_px must be even");
}

}  // namespace
}  // namespace dynslam
