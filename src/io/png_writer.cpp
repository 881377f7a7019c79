// SPDX-License-Identifier: MIT
#include "io/png_writer.h"

#include <exception>
#include <stdexcept>
#include <utility>

namespace dynslam {
namespace {

// More effort takes several times longer for a few percent: maps are mostly flat.
constexpr int kEffort = 2;

// libpng reports errors by longjmp to the setjmp of the call in progress; exceptions must not cross its C
// frames.
void on_error(png_structp png, png_const_charp message) {
  static_cast<std::string*>(png_get_error_ptr(png))->assign(message);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void append_bytes(png_structp png, png_bytep data, png_size_t size) {
  bool kept = true;
  try {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
  } catch (const std::exception&) {
    kept = false;
  }
  if (!kept) png_error(png, "out of memory");
}

void no_flush(png_structp) {}

}  // namespace

PngWriter::PngWriter(int width, int height) {
  png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error_, on_error, on_warning);
  info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
  try {
    if (info_ == nullptr) fail();
    write_header(width, height);
  } catch (...) {
    png_destroy_write_struct(&png_, &info_);
    throw;
  }
}

PngWriter::~PngWriter() { png_destroy_write_struct(&png_, &info_); }

void PngWriter::write_header(int width, int height) {
  if (setjmp(png_jmpbuf(png_)) != 0) fail();
  png_set_write_fn(png_, &bytes_, append_bytes, no_flush);
  png_set_compression_level(png_, kEffort);
  png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
  png_set_IHDR(png_, info_, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png_, info_);
}

void PngWriter::write_row(std::span<const Rgb> row) {
  if (setjmp(png_jmpbuf(png_)) != 0) fail();
  png_write_row(png_, reinterpret_cast<png_const_bytep>(row.data()));
}

std::string PngWriter::finish() {
  if (setjmp(png_jmpbuf(png_)) != 0) fail();
  png_write_end(png_, nullptr);
  return std::move(bytes_);
}

void PngWriter::fail() const { throw std::runtime_error("cannot make a PNG picture: " + error_); }

}  // namespace dynslam
